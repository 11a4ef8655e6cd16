/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pointStorage.H"
#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::pointStorage::setSize(const label n)
{
    if (n + parked_ > allocated_)
    {
        allocated_ = n + parked_;
        for (auto& column : columns_) column.resize(allocated_ + nLanes);
        cell_.resize(allocated_, -1);
        tile_.resize(allocated_, -1);
    }
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
        // Three cache lines apart, and the page is full after 21 columns
        const size_t lead = 24*(columns_.size() + 1) % 512;
        columns_.emplace_back(allocated_ + nLanes, lead);
    }
    return first;
}


void Foam::mpm::pointStorage::resize(const label n)
{
    const label old = size_;
    setSize(n);

    // Padding, and places of points that were removed, are not zero
    for (label p = old; p < n; ++p) cell_[p] = tile_[p] = -1;
    for (auto& column : columns_)
    {
        if (n > old)
        {
            std::fill(column.data() + old, column.data() + n + nLanes, 0);
        }
    }
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
    tile_[size_ - 1] = -1;
}


void Foam::mpm::pointStorage::remove(const label point)
{
    for (auto& column : columns_) column[point] = column[size_ - 1];
    cell_[point] = cell_[size_ - 1];
    tile_[point] = tile_[size_ - 1];
    setSize(size_ - 1);
}


void Foam::mpm::pointStorage::park(const label point)
{
    remove(point);
    ++parked_;
}


void Foam::mpm::pointStorage::reorder(const labelUList& order)
{
    scratch_.resize(allocated_ + nLanes);
    for (auto& column : columns_)
    {
        for (label i = 0; i < size_; ++i) scratch_[i] = column[order[i]];
        std::swap(column, scratch_);
    }

    labelScratch_.resize(allocated_);
    for (auto* labels : {&cell_, &tile_})
    {
        for (label i = 0; i < size_; ++i) labelScratch_[i] = (*labels)[order[i]];
        labels->swap(labelScratch_);
    }
}

// ************************************************************************* //
