/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bedNodes.H"
#include "backgroundGrid.H"
#include <algorithm>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bedNodes::bedNodes(const backgroundGrid& grid)
:
    grid_(grid),
    inner_(grid.nNodes(), 0),
    shared_(grid.exchange().sharedNodes())
{
    const label size = grid.reachSize();
    for (label celli = 0; celli < grid.mesh().nCells(); ++celli)
    {
        const label first = grid.boxCell(celli) + grid.reachOffset();
        for (label t = 0; t < size; ++t) inner_[first + grid.reachNode(t)] = 1;
    }

    // Those at the end of the array have no neighbours beyond it
    const label nNodes = grid.nNodes();
    const label rim =
        1 + grid.stride(1) + (grid.nDim() == 3 ? grid.stride(2) : 0);
    std::fill(inner_.begin(), inner_.begin() + min(rim, nNodes), 0);
    std::fill(inner_.end() - min(rim, nNodes), inner_.end(), 0);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::bedNodes::alone() const
{
    return grid_.exchange().idle();
}


void Foam::mpm::bedNodes::countCopies(std::vector<scalar>& perCopy) const
{
    if (alone()) return;

    nodeField<nodeVector> copies(grid_.nNodes(), nodeVector{});
    for (const label i : shared_) copies[i][0] = inner_[i];
    grid_.exchange().sum(copies);
    for (const label i : shared_)
    {
        perCopy[i] = copies[i][0] > 0 ? 1/copies[i][0] : 0;
    }
}


void Foam::mpm::bedNodes::share
(
    nodeField<nodeVector>& field,
    const std::vector<scalar>& perCopy
) const
{
    if (alone()) return;

    // Ranks that know all neighbours of a node say the same; the others hear
    // it
    for (const label i : shared_)
    {
        if (!inner_[i]) field[i] = nodeVector{};
    }
    grid_.exchange().sum(field);
    for (const label i : shared_) field[i] *= perCopy[i];
}

// ************************************************************************* //
