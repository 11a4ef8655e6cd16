/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cellOrder.H"
#include <algorithm>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::cellOrder::cellOrder(const backgroundGrid& grid)
:
    grid_(grid)
{
    clear();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::cellOrder::clear()
{
    cells_.clear();
    ranges_.clear();
    number_ = labelList(grid_.nBoxNodes(), -1);
    nodes_ = bitSet(grid_.nNodes());
    shared_ = grid_.exchange().sharedNodes();
}


void Foam::mpm::cellOrder::activate
(
    const std::vector<const pointStorage*>& clouds
)
{
    for (const label cell : cells_) number_[cell] = -1;
    cells_.clear();

    // Occupied cells
    label last = -1;
    for (const pointStorage* points : clouds)
    {
        const label* cell = points->cell();
        for (label p = 0; p < points->size(); ++p)
        {
            if (cell[p] == last) continue;
            last = cell[p];
            if (number_[last] < 0)
            {
                number_[last] = 0;
                cells_.push_back(last);
            }
        }
    }

    // Their neighbours on this rank
    const bool is3D = grid_.nDim() == 3;
    const size_t nOccupied = cells_.size();
    for (size_t c = 0; c < nOccupied; ++c)
    {
        for (label k = (is3D ? -1 : 0); k <= (is3D ? 1 : 0); ++k)
        for (label j = -1; j <= 1; ++j)
        for (label i = -1; i <= 1; ++i)
        {
            const label neighbour =
                cells_[c] + i + j*grid_.stride(1) + k*grid_.stride(2);
            if (grid_.ownCell(neighbour) && number_[neighbour] < 0)
            {
                number_[neighbour] = 0;
                cells_.push_back(neighbour);
            }
        }
    }
    std::sort(cells_.begin(), cells_.end());
    for (size_t c = 0; c < cells_.size(); ++c) number_[cells_[c]] = c;

    // Nodes in reach: row by row for each row of adjacent cells
    for (const auto& range : ranges_)
    {
        nodes_.unset(labelRange(range.first, range.second - range.first));
    }
    const label T = grid_.reachWidth();
    for (size_t c = 0; c < cells_.size();)
    {
        const label first = cells_[c];
        label n = 1;
        while (++c < cells_.size() && cells_[c] == first + n) ++n;

        for (label k = 0; k < (is3D ? T : 1); ++k)
        for (label j = 0; j < T; ++j)
        {
            const label node = first + grid_.reachOffset()
              + j*grid_.stride(1) + k*grid_.stride(2);
            nodes_.set(labelRange(node, n - 1 + T));
        }
    }
    for (const label node : shared_) nodes_.set(node);
    nodes_.set
    (
        labelRange(grid_.nBoxNodes(), grid_.nNodes() - grid_.nBoxNodes())
    );

    ranges_.clear();
    for (const label node : nodes_)
    {
        if (ranges_.size() && ranges_.back().second == node)
        {
            ++ranges_.back().second;
        }
        else
        {
            ranges_.emplace_back(node, node + 1);
        }
    }
}


void Foam::mpm::cellOrder::sort(pointStorage& points)
{
    const label n = points.size();
    const label* tile = points.tile();

    // From the first tile that holds a point to the last
    label first = labelMax, last = -1;
    for (label p = 0; p < n; ++p)
    {
        first = min(first, tile[p]);
        last = max(last, tile[p]);
    }
    const label nTiles = n ? last - first + 1 : 0;

    start_.assign(nTiles + 1, 0);
    for (label p = 0; p < n; ++p) ++start_[tile[p] - first + 1];
    for (label t = 0; t < nTiles; ++t) start_[t + 1] += start_[t];

    order_.setSize(n);
    for (label p = 0; p < n; ++p) order_[start_[tile[p] - first]++] = p;

    points.reorder(order_);
}


size_t Foam::mpm::cellOrder::memory() const
{
    return sizeof(label)
       *(cells_.capacity() + number_.size() + order_.size() + start_.capacity())
      + nodes_.size()/8;
}

// ************************************************************************* //
