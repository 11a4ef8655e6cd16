/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "frictionalWall.H"
#include "constrainedWallFvPatchVectorField.H"
#include "patchValues.H"
#include "addToRunTimeSelectionTable.H"
#include <cmath>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(frictionalWall, 0);
    addToRunTimeSelectionTable(nodeConstraint, frictionalWall, wall);
}
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::mpm::frictionalWall::moveImage
(
    const wallNode& w,
    const contact& c,
    nodeMotion& nodes,
    scalar& part
) const
{
    const label nDim = grid_.nDim();
    const scalar m = nodes.mass(w.node);
    part = 0;
    if (w.next < 0) return m;

    const scalar ghost = 2*nodes.massOfGhosts(w.node);
    const scalar mNext = nodes.mass(w.next);
    part = mNext > 0 ? ghost/mNext : 0;
    const scalar mWall = m + (2 - part)*ghost;
    nodeVector& v = nodes.velocity[w.node];
    nodeVector& vNext = nodes.velocity[w.next];
    for (label d = 0; d < nDim; ++d)
    {
        if (d == w.direction) continue;
        const scalar impulse = m*(v[d] - c.velocity[d]);
        const scalar nextImpulse = mNext*(vNext[d] - c.nextVelocity[d]);
        const scalar change = (impulse + part*nextImpulse)/mWall;
        v[d] = c.velocity[d] + change;
        vNext[d] += part*change;
    }
    return mWall;
}


Foam::mpm::nodeVector Foam::mpm::frictionalWall::rub
(
    const wallNode& w,
    const scalar impulse,
    const scalar part,
    nodeField<nodeVector>& velocity
) const
{
    const label nDim = grid_.nDim();
    nodeVector& v = velocity[w.node];

    scalar speedSqr = 0;
    for (label d = 0; d < nDim; ++d)
    {
        if (d != w.direction) speedSqr += sqr(v[d]);
    }
    const scalar speed = std::sqrt(speedSqr);
    const scalar lostPart = impulse < speed ? impulse/speed : 1;
    nodeVector taken{};
    for (label d = 0; d < nDim; ++d)
    {
        if (d == w.direction) continue;
        taken[d] = lostPart*v[d];
        if (w.next >= 0) velocity[w.next][d] -= part*lostPart*v[d];
        v[d] *= 1 - lostPart;
    }
    return taken;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::frictionalWall::frictionalWall
(
    const backgroundGrid& grid,
    const wallPatches& patches
)
:
    nodeConstraint(grid)
{
    for (const constrainedWallFvPatchVectorField* Up : patches)
    {
        const dictionary& dict = Up->coeffs();
        const word& patch = Up->patch().name();
        const scalar coefficient = dict.get<scalar>("frictionCoefficient");

        if (!(coefficient >= 0))
        {
            FatalIOErrorInFunction(dict)
                << "patch " << patch << ", keyword frictionCoefficient is "
                << coefficient << '.' << nl << "    Allowed: >= 0"
                << exit(FatalIOError);
        }
        if (coefficient > 1.2)
        {
            IOWarningInFunction(dict)
                << "patch " << patch << ", keyword frictionCoefficient has the"
                << " value " << coefficient << '.' << nl
                << "    Usual, the tangent of an angle: 0 <="
                << " frictionCoefficient <= 1.2" << nl << endl;
        }
        coefficient_.set(Up->patch().index(), coefficient);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::frictionalWall::build(const wallNodes& walls)
{
    const patchValues values(walls, coefficient_);

    walls.forFreeNodes
    (
        [&](const label node)
        {
            for (label side = 0; side < 2*grid_.nDim(); ++side)
            {
                if (!(values.number(node, side) > 0)) continue;

                // The mean over the sides that meet here
                nodes_.push_back
                (
                    wallNode
                    {
                        node,
                        side/2,
                        side % 2 ? 1 : -1,
                        values.sum(node, side)/walls.count(node, side),
                        walls.next(node, side)
                    }
                );
            }
        }
    );
    contacts_.assign(nodes_.size(), contact{});
}


void Foam::mpm::frictionalWall::activate(const bitSet& active)
{
    active_ = chosen
    (
        active,
        nodes_.size(),
        [&](const label i) { return nodes_[i].node; }
    );
}


void Foam::mpm::frictionalWall::findPressed(bitSet& nodes) const
{
    for (const wallNode& w : nodes_) nodes.set(w.node);
}


void Foam::mpm::frictionalWall::fold(nodeMotion& nodes) const
{
    const label nDim = grid_.nDim();
    nodeField<nodeVector>& momentum = nodes.momentum;

    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        const scalar m = nodes.mass(w.node);
        if (w.next < 0 || !(m > 0)) continue;

        const nodeVector& ghost = nodes.ghostMomentum[w.node];
        for (label d = 0; d < nDim; ++d)
        {
            const scalar v =
                d == w.direction ? 0 : momentum[w.node][d]/m;
            momentum[w.next][d] += 2*nodes.massOfGhosts(w.node)*v - ghost[d];
        }
    }
}


void Foam::mpm::frictionalWall::start(nodeMotion& nodes)
{
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        if (w.next < 0) continue;
        contacts_[i].velocity = nodes.velocity[w.node];
        contacts_[i].nextVelocity = nodes.velocity[w.next];
    }
}


void Foam::mpm::frictionalWall::press(const nodeField<nodeVector>& force)
{
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        contacts_[i].pressing = w.sign*force[w.node][w.direction];
    }
}


void Foam::mpm::frictionalWall::relieve
(
    const nodeField<nodeVector>& force,
    const std::vector<scalar>& part
)
{
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        contacts_[i].pressing -=
            part[w.node]*w.sign*force[w.node][w.direction];
    }
}


void Foam::mpm::frictionalWall::finish
(
    const scalar deltaT,
    nodeMotion& nodes
)
{
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        contact& c = contacts_[i];
        c.rubbed = nodeVector{};
        if (!(nodes.mass(w.node) > 0)) continue;

        scalar part;
        const scalar m = moveImage(w, c, nodes, part);
        c.rubbed = m*rub
        (
            w,
            w.coefficient*deltaT/m*max(scalar(0), c.pressing),
            part,
            nodes.velocity
        );
    }
}


void Foam::mpm::frictionalWall::take
(
    const nodeMotion& nodes,
    const scalar deltaT,
    const scalar projected,
    const wallShares& shares,
    List<load>& loads
) const
{
    // What is normal to it the mirror takes
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        nodeVector f = contacts_[i].rubbed/deltaT;
        if (w.next >= 0)
        {
            f += 2*projected/deltaT
               *(
                    nodes.ghostMomentum[w.node]
                  + nodes.massOfGhosts(w.node)
                   *(
                        nodes.oldVelocity[w.next]
                      - 2*nodes.oldVelocity[w.node]
                    )
                );
        }
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            if (d == w.direction) continue;
            give
            (
                grid_, w.node, cellSides::sideOf(w.direction, w.sign), d,
                grid_.share(w.node)*f[d],
                [&](const label patch) { return coefficient_.found(patch); },
                shares, loads
            );
        }
    }
}

// ************************************************************************* //
