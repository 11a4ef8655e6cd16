/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pointStorage.H"
#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::pointStorage::setSize(const label n)
{
    for (auto& column : columns_) column.resize(n + nLanes, 0);
    cell_.resize(n, -1);
    tile_.resize(n, -1);
    size_ = n;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::mpm::pointStorage::add
(
    const word& name,
    const valueRank rank
)
{
    const label n =
        rank == scalarValue ? 1
      : rank == vectorValue ? nDim_
      : rank == tensorValue ? nDim_*nDim_
      : nDim_ == 2 ? 4 : 6;
    const label first = columns_.size();

    fields_.push_back(field{name, rank, first, n});
    for (label i = 0; i < n; ++i)
    {
        columns_.emplace_back(size_ + nLanes, scalar(0));
    }
    return first;
}


void Foam::mpm::pointStorage::resize(const label n)
{
    // What lies in the padding is not zero
    for (auto& column : columns_)
    {
        if (n > size_)
        {
            column.resize(n + nLanes);
            std::fill(column.begin() + size_, column.end(), scalar(0));
        }
    }
    setSize(n);
}


void Foam::mpm::pointStorage::pack(const label point, scalar* buffer) const
{
    for (const auto& column : columns_) *buffer++ = column[point];
}


void Foam::mpm::pointStorage::append(const scalar* buffer, const label cell)
{
    setSize(size_ + 1);
    for (auto& column : columns_) column[size_ - 1] = *buffer++;
    cell_[size_ - 1] = cell;
}


void Foam::mpm::pointStorage::remove(const label point)
{
    for (auto& column : columns_) column[point] = column[size_ - 1];
    cell_[point] = cell_[size_ - 1];
    tile_[point] = tile_[size_ - 1];
    setSize(size_ - 1);
}


void Foam::mpm::pointStorage::reorder(const labelUList& order)
{
    scratch_.resize(size_ + nLanes);
    for (auto& column : columns_)
    {
        for (label i = 0; i < size_; ++i) scratch_[i] = column[order[i]];
        column.swap(scratch_);
    }

    labelScratch_.resize(size_);
    for (auto* labels : {&cell_, &tile_})
    {
        for (label i = 0; i < size_; ++i) labelScratch_[i] = (*labels)[order[i]];
        labels->swap(labelScratch_);
    }
}

// ************************************************************************* //
