/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "testMesh.H"
#include "nodeBoundary.H"
#include <cmath>
#include <iostream>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

typedef std::map<std::string, std::string> typeMap;

//- A mesh and the walls that a cloud sees in it; h is 1
struct scene
{
    testMesh test;
    dictionary control;
    autoPtr<backgroundGrid> grid;
    autoPtr<nodeBoundary> boundary;

    scene
    (
        const meshPlan& plan,
        const typeMap& patchTypes = {},
        const std::string& shape = "quadraticBSpline",
        const std::map<std::string, vector>& values = {}
    )
    :
        test(plan)
    {
        control.set("shapeFunction", word(shape));
        grid.reset(new backgroundGrid(test.mesh(), control));

        tmp<volVectorField> U(test.velocity(patchTypes));
        for (const auto& value : values)
        {
            const label patchi =
                test.mesh().boundaryMesh().findPatchID(value.first);
            U.ref().boundaryFieldRef()[patchi] == value.second;
        }
        boundary.reset(new nodeBoundary(*grid, U()));
    }

    //- Index of the node (or cell) i, j, k of the lattice
    label at(const int i, const int j, const int k = 0) const
    {
        index3 n;
        n[0] = i - grid->lower(0);
        n[1] = j - grid->lower(1);
        n[2] = k - grid->lower(2);
        return grid->index(n);
    }

    scalar controlVolume(const int i, const int j, const int k = 0) const
    {
        const scalar inverse = boundary->inverseVolume()[at(i, j, k)];
        return inverse > 0 ? 1/inverse : 0;
    }

    //- Sum over all nodes, copies across cyclic ends counted once
    scalar sumOfControlVolumes() const
    {
        scalar sum = 0;
        for (label node = 0; node < grid->nNodes(); ++node)
        {
            const index3 i = grid->coordinate(node);
            bool counts = true;
            for (label d = 0; d < grid->nDim(); ++d)
            {
                const label g = i[d] + grid->lower(d);
                counts = counts
                 && (
                        !grid->cells().periodic(d)
                     || (g >= 0 && g < grid->cells().nCells(d))
                    );
            }
            const scalar inverse = boundary->inverseVolume()[node];
            if (counts && inverse > 0) sum += 1/inverse;
        }
        return sum;
    }

    //- Ghost node at (i, j) of the lattice for points of a cell; -1 if the
    //  node does not fold
    label ghost(const int cellI, const int cellJ, const int i, const int j) const
    {
        const label T = grid->reachWidth();
        const label t =
            i - cellI - grid->reachStart()
          + T*(j - cellJ - grid->reachStart());
        const label s = boundary->folding().stencil(at(cellI, cellJ));
        return
            s < 0 || boundary->folding().targets(s)[t] == at(i, j)
          ? -1
          : boundary->folding().ghosts(s)[t];
    }

    //- Where the node at (i, j, k) of the lattice folds for points of a cell,
    //  as text: node, signs, velocity added
    std::string image
    (
        const std::array<int, 3>& cell,
        const std::array<int, 3>& node
    ) const
    {
        const label T = grid->reachWidth();
        label t = 0, step = 1;
        for (label d = 0; d < grid->nDim(); ++d)
        {
            const label o = node[d] - cell[d] - grid->reachStart();
            if (o < 0 || o >= T) return "out of the tile";
            t += step*o;
            step *= T;
        }

        const nodeFolding& folding = boundary->folding();
        const label s = folding.stencil(at(cell[0], cell[1], cell[2]));
        if (s < 0) return "plain";

        const index3 to = grid->coordinate(folding.targets(s)[t]);
        const nodeVector sign = folding.signs(s)[t];
        const nodeVector shift = folding.shifts(s)[t];

        std::ostringstream os;
        for (label d = 0; d < grid->nDim(); ++d)
        {
            os  << to[d] + grid->lower(d) << ' ';
        }
        os  << "signs";
        for (label d = 0; d < grid->nDim(); ++d) os << ' ' << sign[d];
        os  << " mass " << sign[grid->nDim()] << " shift";
        for (label d = 0; d < grid->nDim(); ++d) os << ' ' << shift[d] + 0.0;
        return os.str();
    }
};


meshPlan plan2D(const int nx, const int ny)
{
    meshPlan plan;
    plan.n = Vector<label>(nx, ny, 1);
    return plan;
}


meshPlan plan3D(const int nx, const int ny, const int nz)
{
    meshPlan plan;
    plan.n = Vector<label>(nx, ny, nz);
    plan.empty = 3;
    return plan;
}


//- Name the sides of the lattice
void nameHull(meshPlan& plan)
{
    const meshPlan bare(plan);
    plan.patch = [bare](const point& c, const vector& n)
    {
        return hullSides(bare, c, n);
    };
}


//- A step that fills x >= 4, y < 3; its convex corner is the node 4, 3, its
//  concave one 4, 0
meshPlan stepPlan(const int nz = 0)
{
    meshPlan plan = nz ? plan3D(9, 7, nz) : plan2D(9, 7);
    plan.present = [](int i, int j, int) { return !(i >= 4 && j < 3); };
    return plan;
}


const std::vector<std::string> shapes
    ({"linear", "quadraticBSpline", "cubicBSpline"});

//- Integral of a shape function over the cell next but one to its node
scalar tail(const std::string& shape)
{
    return
        shape == "linear" ? 0 : shape == "quadraticBSpline" ? 1.0/48 : 1.0/24;
}

} // End anonymous namespace


TEST_CASE("nodeBoundary: control volumes sum to the mesh")
{
    std::map<std::string, meshPlan> plans;

    plans["box"] = plan2D(6, 5);
    plans["one cell"] = plan2D(1, 1);
    plans["column one cell wide"] = plan2D(1, 6);
    plans["step"] = stepPlan();
    plans["obstacle"] = plan2D(9, 8);
    plans["obstacle"].present = [](int i, int j, int)
    {
        return !(i >= 3 && i < 6 && j >= 3 && j < 5);
    };
    plans["gate"] = plan2D(9, 8);
    plans["gate"].present = [](int i, int j, int)
    {
        return !(i >= 3 && i < 5 && j >= 2);
    };
    plans["staircase"] = plan2D(8, 8);
    plans["staircase"].present = [](int i, int j, int) { return i <= j + 2; };
    plans["box 3D"] = plan3D(4, 3, 5);
    plans["step 3D"] = stepPlan(4);
    plans["corner 3D"] = plan3D(6, 6, 6);
    plans["corner 3D"].present = [](int i, int j, int k)
    {
        return !(i >= 3 && j >= 3 && k >= 3);
    };
    plans["obstacle 3D"] = plan3D(7, 8, 7);
    plans["obstacle 3D"].present = [](int i, int j, int k)
    {
        return !(i >= 2 && i < 4 && j >= 3 && j < 5 && k < 4);
    };

    std::map<std::string, meshPlan> cyclic;
    for (int n = 1; n <= 4; ++n)
    {
        meshPlan plan = plan2D(n, 5);
        nameHull(plan);
        plan.type = {{"left", "cyclic"}, {"right", "cyclic"}};
        cyclic["cyclic, " + std::to_string(n) + " cells"] = plan;
    }
    {
        meshPlan plan = plan2D(8, 6);
        nameHull(plan);
        plan.present = [](int i, int j, int)
        {
            return !(i >= 2 && i < 5 && j < 3);
        };
        plan.type = {{"left", "cyclic"}, {"right", "cyclic"}};
        cyclic["cyclic with an obstacle"] = plan;

        plan = plan3D(3, 4, 2);
        nameHull(plan);
        for
        (
            const char* side
          : {"left", "right", "bottom", "top", "back", "front"}
        )
        {
            plan.type[side] = "cyclic";
        }
        cyclic["cyclic in all directions"] = plan;
    }
    plans.insert(cyclic.begin(), cyclic.end());

    for (const auto& entry : plans)
    {
        scalar worst = 0;
        for (const std::string& shape : shapes)
        {
            const scene s(entry.second, {}, shape);
            const scalar mesh = gSum(s.test.mesh().V());
            worst = max(worst, mag(s.sumOfControlVolumes()/mesh - 1));
        }
        atMost(entry.first + ": relative error", worst, 1e-14);
    }

    // Types of wall make no difference; nothing is lost beyond an opening
    meshPlan plan = plan2D(6, 5);
    nameHull(plan);
    for (const std::string type : {"noSlip", "fixedValue", "zeroGradient"})
    {
        const scene s(plan, {{"right", type}, {"top", type}});
        atMost(type, mag(s.sumOfControlVolumes()/30 - 1), 1e-14);
    }
}


TEST_CASE("nodeBoundary: control volume of each node of a box")
{
    for (const std::string& shape : shapes)
    {
        const scene s(plan3D(4, 5, 3), {}, shape);
        scalar error = 0, behind = 0;
        for (int i = -1; i <= 5; ++i)
        for (int j = -1; j <= 6; ++j)
        for (int k = -1; k <= 4; ++k)
        {
            if (i < 0 || i > 4 || j < 0 || j > 5 || k < 0 || k > 3)
            {
                behind = max(behind, s.controlVolume(i, j, k));
                continue;
            }
            // Half a cell for each wall that the node lies on
            const scalar expected =
                (i % 4 ? 1 : 0.5)*(j % 5 ? 1 : 0.5)*(k % 3 ? 1 : 0.5);
            error = max(error, mag(s.controlVolume(i, j, k) - expected));
        }
        atMost(shape + ": error of the nodes", error, 1e-14);
        atMost(shape + ": volume behind walls", behind, 0);
    }
}


TEST_CASE("nodeBoundary: control volumes at a step")
{
    for (const std::string& shape : shapes)
    {
        const scalar t = tail(shape);
        const scene s(stepPlan(), {}, shape);
        scalar error = 0, inside = 0;

        for (int i = 0; i <= 9; ++i)
        for (int j = 0; j <= 7; ++j)
        {
            const scalar found = s.controlVolume(i, j);
            if (i > 4 && j < 3)
            {
                inside = max(inside, found);
                continue;
            }
            scalar expected = (i % 9 ? 1 : 0.5)*(j % 7 ? 1 : 0.5);
            if (i == 4 && j < 3) expected *= 0.5;
            if (i > 4 && j == 3) expected *= 0.5;

            // Three quadrants and what the cell diagonally opposite gives to
            // the ghost node behind the corner. The cells beside the corner
            // mirror nodes that are there for others.
            if (i == 4 && j == 3) expected = 0.75 + t*t;
            if (i == 3 && j == 4) expected = 1 + t*t;
            if (i == 3 && j == 2) expected = 1 - t*t;
            if (i == 5 && j == 4) expected = 1 - t*t;
            error = max(error, mag(found - expected));
        }
        atMost(shape + ": error of the nodes", error, 1e-14);
        atMost(shape + ": volume inside the step", inside, 0);
    }
}


TEST_CASE("nodeBoundary: control volumes at a corner in 3D")
{
    meshPlan plan = plan3D(6, 6, 6);
    plan.present = [](int i, int j, int k)
    {
        return !(i >= 3 && j >= 3 && k >= 3);
    };
    for (const std::string& shape : shapes)
    {
        const scalar t = tail(shape);
        const scene s(plan, {}, shape);

        // Seven octants; ghost nodes behind the corner, and behind each of
        // the three edges, whose last node it is
        atMost
        (
            shape + ": corner",
            mag(s.controlVolume(3, 3, 3) - (0.875 + t*t*t + 1.5*t*t)), 1e-14
        );
        atMost
        (
            shape + ": next to it on an edge",
            mag(s.controlVolume(3, 4, 3) - (0.75 + t*t*(1 - t))), 1e-14
        );
        atMost
        (
            shape + ": on a face", mag(s.controlVolume(4, 4, 3) - 0.5), 1e-14
        );
    }
}


TEST_CASE("nodeBoundary: mirror images at walls")
{
    meshPlan plan = plan2D(6, 5);
    nameHull(plan);
    plan.type["top"] = "symmetryPlane";
    const scene s
    (
        plan, {{"left", "slip"}, {"right", "noSlip"}, {"bottom", "fixedValue"}},
        "quadraticBSpline", {{"bottom", vector(3, 0, 0)}}
    );

    equal("cell away from walls", s.image({2, 2, 0}, {1, 1, 0}), "plain");

    equal
    (
        "slip: ghost node", s.image({0, 2, 0}, {-1, 2, 0}),
        "1 2 signs -1 1 mass 1 shift 0 0"
    );
    equal
    (
        "slip: node on the wall", s.image({0, 2, 0}, {0, 2, 0}),
        "0 2 signs 1 1 mass 1 shift 0 0"
    );
    equal
    (
        "slip: node two cells away", s.image({0, 2, 0}, {2, 1, 0}),
        "2 1 signs 1 1 mass 1 shift 0 0"
    );
    equal
    (
        "noSlip: ghost node", s.image({5, 2, 0}, {7, 3, 0}),
        "5 3 signs -1 -1 mass 1 shift 0 0"
    );
    equal
    (
        "symmetryPlane: ghost node", s.image({2, 4, 0}, {3, 6, 0}),
        "3 4 signs 1 -1 mass 1 shift 0 0"
    );
    equal
    (
        "moving wall: ghost node", s.image({2, 0, 0}, {1, -1, 0}),
        "1 1 signs -1 -1 mass 1 shift 6 0"
    );

    // Both walls
    equal
    (
        "slip and symmetryPlane", s.image({0, 4, 0}, {-1, 6, 0}),
        "1 4 signs -1 -1 mass 1 shift 0 0"
    );
    equal
    (
        "noSlip and symmetryPlane", s.image({5, 4, 0}, {7, 6, 0}),
        "5 4 signs -1 1 mass 1 shift 0 0"
    );
    equal
    (
        "slip and moving wall", s.image({0, 0, 0}, {-1, -1, 0}),
        "1 1 signs 1 -1 mass 1 shift 6 0"
    );
}


TEST_CASE("nodeBoundary: mirror images at a step")
{
    const scene s(stepPlan());
    const std::string even(" signs 1 1 mass 1 shift 0 0");
    const std::string oddX(" signs -1 1 mass 1 shift 0 0");
    const std::string oddY(" signs 1 -1 mass 1 shift 0 0");
    const std::string odd(" signs -1 -1 mass 1 shift 0 0");

    // Concave corner at 4, 0: floor and face of the step
    equal
    (
        "concave: behind the step", s.image({3, 0, 0}, {5, 1, 0}), "3 1" + oddX
    );
    equal
    (
        "concave: below the floor", s.image({3, 0, 0}, {4, -1, 0}), "4 1" + oddY
    );
    equal("concave: both", s.image({3, 0, 0}, {5, -1, 0}), "3 1" + odd);

    // Convex corner at 4, 3: the node 5, 2 is seen from three sides
    equal
    (
        "convex: from the front", s.image({3, 2, 0}, {5, 2, 0}), "3 2" + oddX
    );
    equal("convex: from above", s.image({4, 3, 0}, {5, 2, 0}), "5 4" + oddY);
    equal
    (
        "convex: from the diagonal", s.image({3, 3, 0}, {5, 2, 0}), "4 3" + even
    );

    // Nodes on the step's faces are seen as they are
    equal("convex: the corner", s.image({3, 3, 0}, {4, 3, 0}), "4 3" + even);
    equal
    (
        "convex: top of the step", s.image({3, 3, 0}, {5, 3, 0}), "5 3" + even
    );
    equal
    (
        "convex: face of the step", s.image({3, 3, 0}, {4, 2, 0}), "4 2" + even
    );
}


TEST_CASE("nodeBoundary: mirror images at the lip of a gate")
{
    // Two cells thick, 3 <= x <= 5, above y = 2: the node 4, 3 inside of it
    // belongs to three walls
    meshPlan plan = plan2D(9, 8);
    plan.present = [](int i, int j, int)
    {
        return !(i >= 3 && i < 5 && j >= 2);
    };
    const scene s(plan);

    equal
    (
        "from upstream", s.image({2, 2, 0}, {4, 3, 0}),
        "2 3 signs -1 1 mass 1 shift 0 0"
    );
    equal
    (
        "from downstream", s.image({5, 2, 0}, {4, 3, 0}),
        "6 3 signs -1 1 mass 1 shift 0 0"
    );
    equal
    (
        "from below", s.image({3, 1, 0}, {4, 3, 0}),
        "4 1 signs 1 -1 mass 1 shift 0 0"
    );
    equal
    (
        "from below and upstream", s.image({2, 1, 0}, {4, 3, 0}),
        "3 2 signs 1 1 mass 1 shift 0 0"
    );
    equal
    (
        "from below and downstream", s.image({5, 1, 0}, {4, 3, 0}),
        "5 2 signs 1 1 mass 1 shift 0 0"
    );
}


TEST_CASE("nodeBoundary: mirror images in 3D")
{
    meshPlan plan = plan3D(6, 6, 6);
    plan.present = [](int i, int j, int k)
    {
        return !(i >= 3 && j >= 3 && k >= 3);
    };
    const scene s(plan);
    const std::string even(" signs 1 1 1 mass 1 shift 0 0 0");

    equal
    (
        "edge of the domain", s.image({0, 0, 2}, {-1, -1, 2}),
        "1 1 2 signs -1 -1 1 mass 1 shift 0 0 0"
    );
    equal
    (
        "corner of the domain", s.image({0, 0, 0}, {-1, -1, -1}),
        "1 1 1 signs -1 -1 -1 mass 1 shift 0 0 0"
    );
    equal("convex edge", s.image({4, 2, 2}, {5, 4, 4}), "5 3 3" + even);
    equal("convex corner", s.image({2, 2, 2}, {4, 4, 4}), "3 3 3" + even);
    equal("face beside it", s.image({2, 2, 2}, {4, 4, 3}), "4 4 3" + even);
}


TEST_CASE("nodeBoundary: ghost nodes in a wall that both sides reach")
{
    for (const std::string& shape : shapes)
    {
        for (const int width : {2, 3})
        {
            // A plate that stands on the floor: cells 5 and 6 (and 7) up to 4
            meshPlan plan = plan2D(13, 9);
            plan.present = [width](int i, int j, int)
            {
                return !(i >= 5 && i < 5 + width && j < 5);
            };
            const scene s(plan, {}, shape);
            const std::string of = shape + ", " + std::to_string(width);

            // Behind the floor's corner, and up to the last node that only
            // cells beside the plate reach
            const bool shared = shape != "linear" && width == 2;
            equal
            (
                "twins, " + of,
                s.grid->nNodes() - s.grid->nBoxNodes(),
                shared ? 5 : 0
            );
            if (!shared) continue;

            for (const int j : {0, 1, 2})
            {
                const label left = s.ghost(4, j, 6, j);
                equal("left side, " + of, left, s.at(6, j));
                CHECK(s.ghost(7, j, 6, j) >= s.grid->nBoxNodes());
                equal
                (
                    "one for all cells of a side, " + of,
                    s.ghost(7, j + 1, 6, j), s.ghost(7, j, 6, j)
                );
            }

            // Around the end of the plate the water is one
            equal("end, left, " + of, s.ghost(4, 4, 6, 4), s.at(6, 4));
            equal("end, right, " + of, s.ghost(7, 4, 6, 4), s.at(6, 4));
        }
    }

    // Stairs of two cells: cells beyond the corner reach nodes of the other
    // side
    meshPlan plan = plan2D(12, 12);
    plan.present = [](int i, int j, int) { return i < j || i > j + 1; };
    const scene s(plan);
    for (int j = 2; j < 9; ++j)
    {
        // Corner of the cell (j + 2, j) behind the wall, seen from (j, j + 1)
        CHECK(s.ghost(j, j + 1, j + 2, j + 1) >= s.grid->nBoxNodes());
    }
}


TEST_CASE("nodeBoundary: openings")
{
    meshPlan plan = plan2D(6, 5);
    nameHull(plan);
    const scene s(plan, {{"right", "zeroGradient"}, {"top", "inletOutlet"}});

    equal("cell at an opening", s.image({5, 2, 0}, {7, 2, 0}), "plain");
    equal("both openings", s.image({5, 4, 0}, {7, 6, 0}), "plain");
    equal
    (
        "opening beside a wall", s.image({5, 0, 0}, {7, -1, 0}),
        "7 1 signs 1 -1 mass 1 shift 0 0"
    );
    auto patchBeyond = [&](const int i, const int j)
    {
        const label patchi = s.boundary->beyondOpening(s.at(i, j));
        return
            patchi < 0
          ? std::string("none")
          : std::string(s.grid->mesh().boundaryMesh()[patchi].name());
    };
    equal("beyond the right", patchBeyond(6, 2), "right");
    equal("beyond the top", patchBeyond(3, 5), "top");
    equal("beyond the left", patchBeyond(-1, 2), "none");
    equal("beyond the bottom", patchBeyond(3, -1), "none");
}


TEST_CASE("nodeBoundary: tiles fold their nodes as the cells of their points")
{
    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string& shape : shapes)
        {
            const scene s(stepPlan(dim == 3 ? 4 : 0), {}, shape);
            const backgroundGrid& grid = *s.grid;
            const label W = grid.tileWidth();
            const label T = grid.reachWidth();
            const nodeFolding& folding = s.boundary->folding();
            const nodeTiles& tiles = s.boundary->tiles();
            const label nParts = grid.nodeCentred() ? 1 << dim : 1;
            label wrong = 0, descents = 0;

            for (label i = 1; i < tiles.size(); ++i)
            {
                label before = 0, here = 0;
                for (label d = dim - 1; d >= 0; --d)
                {
                    before = 100*before + tiles[i - 1].origin[d];
                    here = 100*here + tiles[i].origin[d];
                }
                descents += here < before;
            }

            forAll(grid.mesh().cellCentres(), celli)
            {
                const label cell = grid.boxCell(celli);
                const label own = folding.stencil(cell);

                for (label part = 0; part < nParts; ++part)
                {
                    const nodeTiles::record& tile =
                        tiles[tiles.of(cell, part)];

                    for (label t = 0; t < W*W*(dim == 3 ? W : 1); ++t)
                    {
                        // The node from the lower corner of the cell, and its
                        // place in the reach of the cell and of the tile
                        label node = cell, plain = tile.first;
                        label inCell = 0, inTile = tile.offset;
                        label rest = t, step = 1;
                        for (label d = 0; d < dim; ++d)
                        {
                            const label o = rest % W;
                            const label fromCell =
                                o + ((part >> d) & 1) + grid.tileStart();
                            rest /= W;
                            node += fromCell*grid.stride(d);
                            plain += o*grid.stride(d);
                            inCell += step*(fromCell - grid.reachStart());
                            inTile += step*o;
                            step *= T;
                        }
                        nodeVector sign{1, 1, 1, 1}, found(sign);
                        label target = node, foundTarget = plain;
                        if (own >= 0)
                        {
                            target = folding.targets(own)[inCell];
                            sign = folding.signs(own)[inCell];
                        }
                        if (tile.stencil >= 0)
                        {
                            foundTarget =
                                folding.targets(tile.stencil)[inTile];
                            found = folding.signs(tile.stencil)[inTile];
                        }
                        wrong += node != plain || target != foundTarget;
                        for (label c = 0; c < 4; ++c)
                        {
                            wrong += sign[c] != found[c];
                        }
                    }
                }
            }
            const std::string name = shape + ' ' + std::to_string(dim) + "D: ";
            equal(name + "nodes folded in another way", wrong, 0);
            equal(name + "tiles out of order", descents, 0);
        }
    }

    // Around the convex corner three cells: the two beside the step mirror
    // its sides, the one across the corner folds the diagonal ghost
    const scene s(stepPlan());
    auto tileOf = [&](const int i, const int j, const label part)
    {
        return s.boundary->tiles().of(s.at(i, j), part);
    };
    equal("corner: left and across", label(tileOf(3, 2, 3) == tileOf(3, 3, 1)), 0);
    equal("corner: above and across", label(tileOf(4, 3, 0) == tileOf(3, 3, 1)), 0);
    equal("flat wall: one tile", tileOf(1, 0, 1), tileOf(2, 0, 0));
    equal("inside: one tile", tileOf(1, 1, 3), tileOf(2, 2, 0));
}


TEST_CASE("nodeBoundary: cyclic images of nodes")
{
    meshPlan plan = plan2D(5, 4);
    nameHull(plan);
    plan.type = {{"left", "cyclic"}, {"right", "cyclic"}};
    const scene s(plan);

    equal("stencil at a cyclic end", s.image({0, 2, 0}, {-1, 2, 0}), "plain");

    // Each node holds a number of its own; copies hold parts of a sum
    nodeField<scalar> field(s.grid->nNodes(), 0);
    field[s.at(-1, 2)] = 1;
    field[s.at(4, 2)] = 10;
    field[s.at(0, 2)] = 100;
    field[s.at(5, 2)] = 1000;
    field[s.at(1, 2)] = 5;
    field[s.at(2, 2)] = 3;
    s.grid->exchange().sum(field);

    equal("node -1", label(field[s.at(-1, 2)]), 11);
    equal("node 4", label(field[s.at(4, 2)]), 11);
    equal("node 0", label(field[s.at(0, 2)]), 1100);
    equal("node 5", label(field[s.at(5, 2)]), 1100);
    equal("node 6", label(field[s.at(6, 2)]), 5);
    equal("node 2", label(field[s.at(2, 2)]), 3);

    atMost("control volume at the end", mag(s.controlVolume(0, 2) - 1), 1e-14);
    atMost("and at its copy", mag(s.controlVolume(5, 2) - 1), 1e-14);
    atMost("at the corner", mag(s.controlVolume(5, 0) - 0.5), 1e-14);
}


TEST_CASE("nodeBoundary: constrained velocities")
{
    meshPlan plan = stepPlan();
    nameHull(plan);
    scene s
    (
        plan,
        {
            {"left", "slip"}, {"right", "noSlip"}, {"top", "fixedValue"},
            {"bottom", "slip"}, {"walls", "slip"}
        },
        "quadraticBSpline", {{"top", vector(3, 0, 0)}}
    );

    auto velocityAt = [&]
    (
        const int i, const int j, const scalar u, const scalar v,
        const bool homogeneous = false
    )
    {
        nodeField<nodeVector> field(s.grid->nNodes(), nodeVector{u, v, 7, 8});
        s.boundary->constrain(field, homogeneous);
        const nodeVector& f = field[s.at(i, j)];
        std::ostringstream os;
        os  << f[0] << ' ' << f[1];
        return os.str();
    };

    equal("inside", velocityAt(2, 2, 1, 2), "1 2");
    equal("slip: left", velocityAt(0, 2, 1, 2), "0 2");
    equal("slip: bottom", velocityAt(2, 0, 1, 2), "1 0");
    equal("slip: corner of left and bottom", velocityAt(0, 0, 1, 2), "0 0");
    equal("slip: front of the step", velocityAt(4, 1, 1, 2), "0 2");
    equal("slip: top of the step", velocityAt(6, 3, 1, 2), "1 0");
    equal("concave corner", velocityAt(4, 0, 1, 2), "0 0");
    equal("noSlip: right", velocityAt(9, 5, 1, 2), "0 0");
    equal("fixedValue: top", velocityAt(5, 7, 1, 2), "3 0");
    equal("fixedValue: differences", velocityAt(5, 7, 1, 2, true), "0 0");

    // Solid to the right and below of the convex corner 4, 3
    equal("convex: into the solid", velocityAt(4, 3, 1, -2), "0 0");
    equal("convex: along the top", velocityAt(4, 3, 1, 0), "1 0");
    equal("convex: along the front", velocityAt(4, 3, 0, -2), "0 -2");
    equal("convex: upwards past the front", velocityAt(4, 3, 1, 2), "1 2");
    equal("convex: off the edge", velocityAt(4, 3, -1, -2), "-1 -2");

    // Inactive nodes are left alone
    bitSet active(s.grid->nNodes());
    active.set(s.at(0, 2));
    s.boundary->activate(active);
    equal("active", velocityAt(0, 2, 1, 2), "0 2");
    equal("inactive slip", velocityAt(0, 3, 1, 2), "1 2");
    equal("inactive noSlip", velocityAt(9, 5, 1, 2), "1 2");
    equal("inactive convex corner", velocityAt(4, 3, 1, -2), "1 -2");
}


TEST_CASE("nodeBoundary: constrained velocities in 3D")
{
    // Solid in x, y, z >= 3; a convex edge along each direction
    meshPlan plan = plan3D(6, 6, 6);
    plan.present = [](int i, int j, int k)
    {
        return !(i >= 3 && j >= 3 && k >= 3);
    };
    scene s(plan);

    auto velocityAt = [&]
    (
        const std::array<int, 3>& i,
        const std::array<scalar, 3>& v
    )
    {
        nodeField<nodeVector> field
        (
            s.grid->nNodes(), nodeVector{v[0], v[1], v[2], 9}
        );
        s.boundary->constrain(field);
        const nodeVector& f = field[s.at(i[0], i[1], i[2])];
        std::ostringstream os;
        os  << f[0] << ' ' << f[1] << ' ' << f[2];
        return os.str();
    };

    equal("inside", velocityAt({2, 2, 2}, {1, 2, 3}), "1 2 3");
    equal("wall", velocityAt({0, 2, 2}, {1, 2, 3}), "0 2 3");
    equal("edge of the domain", velocityAt({0, 0, 2}, {1, 2, 3}), "0 0 3");
    equal("corner of the domain", velocityAt({0, 0, 0}, {1, 2, 3}), "0 0 0");
    equal("face of the solid", velocityAt({4, 4, 3}, {1, 2, 3}), "1 2 0");
    equal("edge, into", velocityAt({4, 3, 3}, {1, 2, 3}), "1 0 0");
    equal("edge, along one face", velocityAt({4, 3, 3}, {1, 2, -3}), "1 2 -3");
    equal("corner, into", velocityAt({3, 3, 3}, {1, 2, 3}), "0 0 0");
    equal("corner, past one face", velocityAt({3, 3, 3}, {1, 2, -3}), "1 2 -3");
}


TEST_CASE("refused: patch types that are no walls")
{
    meshPlan plan = plan2D(4, 4);
    nameHull(plan);
    testMesh test(plan);
    const backgroundGrid grid(test.mesh(), dictionary());
    const tmp<volVectorField> U(test.velocity({{"top", "calculated"}}));
    U().write();

    contains
    (
        errorOf([&]() { nodeBoundary boundary(grid, U()); }),
        {"patch top", "keyword type", "calculated", "slip", "noSlip",
         "zeroGradient"}
    );
}

// ************************************************************************* //
