/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "testMesh.H"
#include "addToRunTimeSelectionTable.H"
#include "constrainedWallFvPatchVectorField.H"
#include "nodeBoundary.H"
#include "nodeConstraint.H"

using namespace Foam;
using namespace Foam::mpm;

namespace Foam
{
namespace mpm
{

//- A wall as a library of one's own would add it: it takes a part of the
//  control volume of its nodes, and drags their velocity along it
class draggingWall
:
    public nodeConstraint
{
    scalar keep_;
    std::vector<label> nodes_, active_;

public:

    TypeName("draggingWall");

    draggingWall(const backgroundGrid& grid, const wallPatches& patches)
    :
        nodeConstraint(grid),
        keep_(patches[0]->coeffs().get<scalar>("keep"))
    {}

    virtual void build(const wallNodes& walls)
    {
        walls.forFreeNodes
        (
            [&](const label node)
            {
                if (walls.count(node, cellSides::sideOf(1, -1)) > 0)
                {
                    nodes_.push_back(node);
                }
            }
        );
    }

    virtual void takeVolume(std::vector<scalar>& volume) const
    {
        for (const label node : nodes_) volume[node] *= 0.75;
    }

    virtual void activate(const bitSet& active)
    {
        active_ = chosen
            (active, nodes_.size(), [&](const label i) { return nodes_[i]; });
    }

    virtual void finish(const scalar, nodeMotion& nodes)
    {
        for (const label i : active_) nodes.velocity[nodes_[i]][0] *= keep_;
    }
};

defineTypeNameAndDebug(draggingWall, 0);
addToRunTimeSelectionTable(nodeConstraint, draggingWall, wall);

}
}

namespace
{

//- A box of 6 x 5 cells, h = 1, its floor a wall with entries of its own
struct scene
{
    testMesh test;
    backgroundGrid grid;
    tmp<volVectorField> U;
    autoPtr<nodeBoundary> boundary;
    nodeMotion nodes;

    static meshPlan plan()
    {
        meshPlan box;
        box.n = Vector<label>(6, 5, 1);
        const meshPlan bare(box);
        box.patch = [bare](const point& c, const vector& n)
        {
            return hullSides(bare, c, n);
        };
        return box;
    }

    explicit scene(const std::string& entries)
    :
        test(plan()),
        grid(test.mesh(), dictionary()),
        U(test.velocity({}))
    {
        const label patchi = test.mesh().boundaryMesh().findPatchID("bottom");
        U.ref().boundaryFieldRef().set
        (
            patchi,
            fvPatchVectorField::New
            (
                test.mesh().boundary()[patchi],
                U().internalField(),
                dictionary(IStringStream(entries)())
            )
        );
        boundary.reset(new nodeBoundary(grid, U()));

        const size_t n = grid.nNodes();
        nodes.nDim = 2;
        nodes.momentum.assign(n, nodeVector{0, 0, 1, 0});
        nodes.velocity.assign(n, nodeVector{});
        nodes.force.assign(n, nodeVector{});
        nodes.ghostMomentum.assign(n, nodeVector{});
    }

    label at(const label i, const label j) const
    {
        index3 n;
        n[0] = i - grid.lower(0);
        n[1] = j - grid.lower(1);
        n[2] = 0;
        return grid.index(n);
    }

    //- Speed along the floor at a node (3, 0) that slides with the speed u
    //  while the force f presses it down, of which others bear a part,
    //  after a step of 0.1 s
    scalar slide(const scalar u, const scalar f, const scalar borne = 0)
    {
        const std::vector<scalar> part(nodes.force.size(), borne);
        nodes.velocity[at(3, 0)] = nodeVector{u, 0, 0, 0};
        nodes.force[at(3, 0)] = nodeVector{0, -f, 0, 0};

        boundary->start(nodes);
        boundary->press(nodes.force);
        boundary->relieve(nodes.force, part);
        boundary->constrain(nodes.velocity);
        boundary->finish(0.1, nodes);
        return nodes.velocity[at(3, 0)][0];
    }
};

} // End anonymous namespace


TEST_CASE("nodeConstraint: Coulomb friction takes mu N dt, and no more")
{
    const std::vector<std::string> walls
    ({
        "type frictional; frictionCoefficient 0.5;",
        "type constrainedWall; constraint frictionalWall;"
        " frictionCoefficient 0.5;"
    });
    for (const std::string& wall : walls)
    {
        // Of the mass 1 kg: 0.5 x 8 N x 0.1 s
        scene s(wall);
        atMost("slides", mag(s.slide(2, 8) - 1.6), 1e-14);
        atMost("the other way", mag(s.slide(-2, 8) + 1.6), 1e-14);
        atMost("held", mag(s.slide(2, 80)), 0);
        atMost("pulled off the wall", mag(s.slide(2, -8) - 2), 0);
        atMost("half of it borne", mag(s.slide(2, 8, 0.5) - 1.8), 1e-14);
        atMost("only where it is pressed", s.boundary->pressedNodes().count(), 7);
        atLeast("all along the floor", s.boundary->pressedNodes().count(), 7);
        equal("mirrors about its nodes", label(s.boundary->nodeWalls()), 1);

        s.boundary->activate(bitSet(s.grid.nNodes()));
        atMost("inactive", mag(s.slide(2, 8) - 2), 0);
    }
    equal("slip: no such walls", label(scene("type slip;").boundary->nodeWalls()), 0);
}


TEST_CASE("nodeConstraint: a wall that a library adds")
{
    scene s("type constrainedWall; constraint draggingWall; keep 0.25;");

    atMost("drags", mag(s.slide(2, 8) - 0.5), 0);
    atMost
    (
        "takes its part of the control volume",
        mag(1/s.boundary->inverseVolume()[s.at(3, 0)] - 0.375), 1e-14
    );
    atMost
    (
        "and nothing elsewhere",
        mag(1/s.boundary->inverseVolume()[s.at(3, 1)] - 1), 1e-14
    );
    nodeField<nodeVector> v(s.grid.nNodes(), nodeVector{1, 1, 1, 1});
    s.boundary->constrain(v);
    equal("is a wall", label(v[s.at(3, 0)][1]), 0);

    // Its entries are written
    OStringStream os;
    const label patchi = s.test.mesh().boundaryMesh().findPatchID("bottom");
    s.U().boundaryField()[patchi].write(os);
    contains
    (
        os.str(), {"constrainedWall", "constraint", "draggingWall", "keep"}
    );
}


TEST_CASE("refused: constraints that nobody has")
{
    contains
    (
        errorOf
        (
            []() { scene s("type constrainedWall; constraint sticky;"); }
        ),
        {"patch bottom", "keyword constraint", "sticky", "draggingWall",
         "frictionalWall"}
    );
    contains
    (
        errorOf
        (
            []() { scene s("type frictional; frictionCoefficient -1;"); }
        ),
        {"patch bottom", "keyword frictionCoefficient is -1", "Allowed: >= 0"}
    );
}

// ************************************************************************* //
