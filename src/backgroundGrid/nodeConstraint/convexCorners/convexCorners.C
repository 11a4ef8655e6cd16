/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "convexCorners.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(convexCorners, 0);
}
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::mpm::convexCorners::cone Foam::mpm::convexCorners::coneOf
(
    const label node,
    const index3& into
) const
{
    cone c{node, nodeVector{}};
    for (label d = 0; d < grid_.nDim(); ++d) c.intoSolid[d] = into[d];
    return c;
}


void Foam::mpm::convexCorners::findCones
(
    const wallNodes& walls,
    const label node
)
{
    const label nDim = grid_.nDim();

    // Sides with a wall that ends here
    FixedList<bool, cellSides::maxSides> convex(false);
    for (label side = 0; side < 2*nDim; ++side)
    {
        convex[side] = walls.count(node, side) > 0 && !walls.flat(node, side);
    }

    bool anyEdge = false;
    for (label d = 0; d < nDim; ++d)
    for (label k = d + 1; k < nDim; ++k)
    for (label sd = -1; sd < 2; sd += 2)
    for (label sk = -1; sk < 2; sk += 2)
    {
        index3 into;
        into = 0;
        into[d] = sd;
        into[k] = sk;
        if
        (
            convex[cellSides::sideOf(d, sd)]
         && convex[cellSides::sideOf(k, sk)]
         && walls.blocked(node, into)
        )
        {
            cones_.push_back(coneOf(node, into));
            anyEdge = true;
        }
    }
    if (nDim == 2 || anyEdge) return;

    for (label corner = 0; corner < (1 << nDim); ++corner)
    {
        index3 into;
        bool all = true;
        for (label d = 0; d < nDim; ++d)
        {
            into[d] = ((corner >> d) & 1) ? 1 : -1;
            all = all && convex[cellSides::sideOf(d, into[d])];
        }
        if (all && walls.blocked(node, into))
        {
            cones_.push_back(coneOf(node, into));
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::convexCorners::build(const wallNodes& walls)
{
    walls.forFreeNodes([&](const label node) { findCones(walls, node); });
}


void Foam::mpm::convexCorners::activate(const bitSet& active)
{
    active_ = chosen
    (
        active,
        cones_.size(),
        [&](const label i) { return cones_[i].node; }
    );
}


void Foam::mpm::convexCorners::constrain
(
    nodeField<nodeVector>& velocity,
    const bool
) const
{
    const label nDim = grid_.nDim();
    for (const label i : active_)
    {
        const cone& c = cones_[i];
        nodeVector& v = velocity[c.node];

        bool into = true;
        for (label d = 0; !stick_ && d < nDim; ++d)
        {
            into = into && (c.intoSolid[d] == 0 || v[d]*c.intoSolid[d] > 0);
        }
        if (into)
        {
            for (label d = 0; d < nDim; ++d)
            {
                if (c.intoSolid[d] != 0) v[d] = 0;
            }
        }
    }
}


void Foam::mpm::convexCorners::take
(
    const nodeMotion& nodes,
    const scalar deltaT,
    const scalar projected,
    const wallShares& shares,
    List<load>& loads
) const
{
    for (const label i : active_)
    {
        const cone& c = cones_[i];
        const nodeVector f =
            grid_.share(c.node)*lost(nodes, c.node, deltaT, projected);
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            if (c.intoSolid[d] == 0) continue;
            give
            (
                grid_, c.node, cellSides::sideOf(d, c.intoSolid[d]), d, f[d],
                [](const label) { return true; }, shares, loads
            );
        }
    }
}

// ************************************************************************* //
