/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "wallNodes.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::wallNodes::wallNodes
(
    const backgroundGrid& grid,
    const cellSides& sides
)
:
    grid_(grid),
    sides_(sides),
    count_(grid.nNodes(), packed<8>{}),
    given_(grid.nNodes(), nodeVector{})
{
    sides.forWallNodes
    (
        [&](const label celli, const label side, const label node)
        {
            count_[node][side] += 1;
            if (sides(celli, side) == cellSides::fixedWall)
            {
                nodeVector value = sides.velocity(celli, side);
                value[3] = 1;
                given_[node] += value;
            }
        }
    );
    grid.exchange().sum(count_);
    grid.exchange().sum(given_);
    grid.copyToSeconds(count_);
    grid.copyToSeconds(given_);
    for (label node = 0; node < grid_.nNodes(); ++node)
    {
        if (nSides(node) > 0) onWalls_.push_back(node);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::mpm::wallNodes::nSides(const label node) const
{
    label n = 0;
    for (label i = 0; i < 2*grid_.nDim(); ++i) n += count_[node][i] > 0;
    return n;
}


Foam::mpm::nodeVector Foam::mpm::wallNodes::velocity(const label node) const
{
    nodeVector value = given_[node]/given_[node][3];
    for (label k = grid_.nDim(); k < 4; ++k) value[k] = 0;
    return value;
}


bool Foam::mpm::wallNodes::blocked
(
    const label node,
    const index3& sign
) const
{
    for (label corner = 0; corner < (1 << grid_.nDim()); ++corner)
    {
        label cell = grid_.boxNode(node);
        bool inOrthant = true;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            const label c = ((corner >> d) & 1) ? 1 : -1;
            inOrthant = inOrthant && (sign[d] == 0 || sign[d] == c);
            if (c < 0) cell -= grid_.stride(d);
        }
        if
        (
            inOrthant
         && cell >= 0
         && grid_.cellRank(cell) != backgroundGrid::missing
        ) return false;
    }
    return true;
}


bool Foam::mpm::wallNodes::flat(const label node, const label side) const
{
    index3 into;
    into = 0;
    into[side/2] = side % 2 ? 1 : -1;
    return blocked(node, into);
}


Foam::label Foam::mpm::wallNodes::next
(
    const label node,
    const label side
) const
{
    label n =
        grid_.boxNode(node) - (side % 2 ? 1 : -1)*grid_.stride(side/2);
    if (grid_.plated()) n = grid_.seen(n, grid_.viewOf(node));
    return nSides(node) > 1 || nSides(n) > 0 ? -1 : n;
}


Foam::bitSet Foam::mpm::wallNodes::single() const
{
    bitSet nodes(grid_.nNodes());
    forFreeNodes
    (
        [&](const label node)
        {
            for (label side = 0; side < 2*grid_.nDim(); ++side)
            {
                if (count(node, side) > 0 && next(node, side) >= 0)
                {
                    nodes.set(node);
                }
            }
        }
    );
    return nodes;
}

// ************************************************************************* //
