/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "mirrorWall.H"
#include "nodeFolding.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(mirrorWall, 0);
}
}


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    using namespace Foam;
    using namespace Foam::mpm;

    //- Is no cell around a node
    bool outside(const backgroundGrid& grid, const label node)
    {
        for (label corner = 0; corner < (1 << grid.nDim()); ++corner)
        {
            label cell = node;
            for (label d = 0; d < grid.nDim(); ++d)
            {
                if ((corner >> d) & 1) cell -= grid.stride(d);
            }
            if
            (
                cell >= 0
             && cell < grid.nBoxNodes()
             && grid.cellRank(cell) != backgroundGrid::missing
            ) return false;
        }
        return true;
    }

    //- Call op(ghost, its offset) for nodes next to one and outside
    template<class Op>
    void forGhosts(const backgroundGrid& grid, const label node, const Op& op)
    {
        const label nDim = grid.nDim();
        index3 o;
        for (o[2] = (nDim == 3 ? -1 : 0); o[2] <= (nDim == 3); ++o[2])
        for (o[1] = -1; o[1] <= 1; ++o[1])
        for (o[0] = -1; o[0] <= 1; ++o[0])
        {
            label ghost = node;
            for (label d = 0; d < nDim; ++d) ghost += o[d]*grid.stride(d);
            if (outside(grid, ghost)) op(ghost, o);
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::mirrorWall::addGhosts()
{
    // A ghost stands still in the directions in which it lies behind the
    // wall, and in those of its wall's node
    const label nSlip = slipNodes_.size();
    for (label i = 0; i < nSlip; ++i)
    {
        const nodeVector mask = slipMask_[i];
        forGhosts
        (
            grid_,
            slipNodes_[i],
            [&](const label ghost, const index3& o)
            {
                // Behind a wall, not beside it
                for (label d = 0; d < grid_.nDim(); ++d)
                {
                    if (o[d] && mask[d] != 0) return;
                }
                slipNodes_.append(ghost);
                slipMask_.push_back(mask);
            }
        );
    }
    const label nFixed = fixedNodes_.size();
    for (label i = 0; i < nFixed; ++i)
    {
        const nodeVector value = fixedValue_[i];
        forGhosts
        (
            grid_,
            fixedNodes_[i],
            [&](const label ghost, const index3&)
            {
                fixedNodes_.append(ghost);
                fixedValue_.push_back(value);
            }
        );
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::mirrorWall::build(const wallNodes& walls)
{
    for (const label node : walls.onWalls())
    {
        if (!walls.given(node)) continue;
        fixedNodes_.append(node);
        fixedValue_.push_back(walls.velocity(node));
    }
    walls.forFreeNodes
    (
        [&](const label node)
        {
            nodeVector mask{1, 1, 1, 1};
            bool any = false;
            for (label side = 0; side < 2*grid_.nDim(); ++side)
            {
                if (walls.count(node, side) > 0 && walls.flat(node, side))
                {
                    mask[side/2] = 0;
                    any = true;
                }
            }
            if (any)
            {
                slipNodes_.append(node);
                slipMask_.push_back(mask);
            }
        }
    );
    if (!nodeFolding::mirrors) addGhosts();
}


void Foam::mpm::mirrorWall::activate(const bitSet& active)
{
    activeSlip_ = chosen
    (
        active,
        slipNodes_.size(),
        [&](const label i) { return slipNodes_[i]; }
    );
    activeFixed_ = chosen
    (
        active,
        fixedNodes_.size(),
        [&](const label i) { return fixedNodes_[i]; }
    );
}


void Foam::mpm::mirrorWall::constrain
(
    nodeField<nodeVector>& velocity,
    const bool homogeneous
) const
{
    for (const label i : activeSlip_) velocity[slipNodes_[i]] *= slipMask_[i];

    // Slots beyond the components are left alone
    for (const label i : activeFixed_)
    {
        nodeVector& v = velocity[fixedNodes_[i]];
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            v[d] = homogeneous ? 0 : fixedValue_[i][d];
        }
    }
}


void Foam::mpm::mirrorWall::take
(
    const nodeMotion& nodes,
    const scalar deltaT,
    const scalar projected,
    const wallShares& shares,
    List<load>& loads
) const
{
    auto any = [](const label) { return true; };
    auto fixed = [&](const label patch)
    {
        return shares.kind(patch) == cellSides::fixedWall;
    };
    auto giveComponent = [&]
    (
        const label node,
        const label d,
        const scalar force
    )
    {
        // To the walls across it, or else those that hold all components
        DynamicList<label> sides(cellSides::maxSides);
        auto collect = [&](const auto& fits)
        {
            for (label side = 0; side < 2*grid_.nDim(); ++side)
            {
                if (shares.found(node, side) && fits(side)) sides.append(side);
            }
        };
        collect([&](const label side) { return side/2 == d; });
        const bool across = !sides.empty();
        if (!across)
        {
            collect
            (
                [&](const label side)
                {
                    bool holds = false;
                    shares.forShares
                    (
                        node, side, fixed,
                        [&](const label, const scalar) { holds = true; }
                    );
                    return holds;
                }
            );
        }
        for (const label side : sides)
        {
            const scalar f = force/sides.size();
            if (across) give(grid_, node, side, d, f, any, shares, loads);
            else give(grid_, node, side, d, f, fixed, shares, loads);
        }
    };
    for (const label i : activeSlip_)
    {
        const label node = slipNodes_[i];
        const nodeVector f =
            grid_.share(node)*lost(nodes, node, deltaT, projected);
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            if (slipMask_[i][d] == 0) giveComponent(node, d, f[d]);
        }
    }
    for (const label i : activeFixed_)
    {
        const label node = fixedNodes_[i];
        const nodeVector f =
            grid_.share(node)*lost(nodes, node, deltaT, projected);
        for (label d = 0; d < grid_.nDim(); ++d) giveComponent(node, d, f[d]);
    }
}

// ************************************************************************* //
