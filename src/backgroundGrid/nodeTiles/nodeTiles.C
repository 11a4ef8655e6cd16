/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeTiles.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Op>
bool Foam::mpm::nodeTiles::anyNode(const Op& op) const
{
    const backgroundGrid& grid = folding_.grid();
    const label W = grid.tileWidth();
    const label R = grid.reachWidth();

    for (label k = 0; k < (grid.nDim() == 3 ? W : 1); ++k)
    for (label j = 0; j < W; ++j)
    for (label i = 0; i < W; ++i)
    {
        if (op(i + j*grid.stride(1) + k*grid.stride(2), i + R*(j + R*k)))
        {
            return true;
        }
    }
    return false;
}


bool Foam::mpm::nodeTiles::foldAlike(const record& a, const record& b) const
{
    if (a.stencil < 0 || b.stencil < 0) return a.stencil == b.stencil;

    const label* targetA = folding_.targets(a.stencil) + a.offset;
    const label* targetB = folding_.targets(b.stencil) + b.offset;
    const label* ghostA = folding_.ghosts(a.stencil) + a.offset;
    const label* ghostB = folding_.ghosts(b.stencil) + b.offset;
    const nodeVector* signA = folding_.signs(a.stencil) + a.offset;
    const nodeVector* signB = folding_.signs(b.stencil) + b.offset;
    const nodeVector* shiftA = folding_.shifts(a.stencil) + a.offset;
    const nodeVector* shiftB = folding_.shifts(b.stencil) + b.offset;
    const label* wallA = folding_.walls(a.stencil);
    const label* wallB = folding_.walls(b.stencil);

    return !anyNode
    (
        [&](const label, const label t)
        {
            bool differs = targetA[t] != targetB[t] || ghostA[t] != ghostB[t];
            differs = differs
             || (wallA && wallA[a.offset + t] != wallB[b.offset + t]);
            for (label c = 0; c < 4; ++c)
            {
                differs = differs
                 || signA[t][c] != signB[t][c]
                 || shiftA[t][c] != shiftB[t][c];
            }
            return differs;
        }
    );
}


bool Foam::mpm::nodeTiles::makeTile
(
    const label node,
    const label part,
    const label view,
    label& cell,
    record& tile
) const
{
    const backgroundGrid& grid = folding_.grid();

    tile = record{node, -1, 0, {0, 0, 0}};
    cell = node;
    label reachStride = 1;
    for (label d = 0; d < grid.nDim(); ++d)
    {
        const label upper = (part >> d) & 1;
        cell -= upper*grid.stride(d);
        tile.first += grid.tileStart()*grid.stride(d);
        tile.offset +=
            reachStride*(upper + grid.tileStart() - grid.reachStart());
        tile.origin[d] = grid.coordinate(node)[d] + grid.lower(d);
        reachStride *= grid.reachWidth();
    }
    if (cell < 0 || !grid.ownCell(cell)) return false;

    // Cells at a wall have parts that do not touch it
    const label stencil = folding_.stencil(cell, view);
    if (stencil >= 0)
    {
        const label* target = folding_.targets(stencil) + tile.offset;
        const bool folded = anyNode
        (
            [&](const label offset, const label t)
            {
                return target[t] != tile.first + offset;
            }
        );
        if (folded) tile.stencil = stencil;
    }
    return true;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::nodeTiles::nodeTiles
(
    const nodeFolding& folding,
    const labelList& zoneOfCell
)
:
    folding_(folding)
{
    const backgroundGrid& grid = folding.grid();

    nParts_ = grid.nodeCentred() ? 1 << grid.nDim() : 1;
    tileIndex_.setSize(nParts_*grid.nBoxNodes(), -1);

    // The zone of each folded tile: it folds in another way while it is open
    std::vector<label> zone;

    // The parts of cells around each origin
    for (label node = 0; node < grid.nBoxNodes(); ++node)
    {
        const label firstHere = size();

        for (label part = 0; part < nParts_; ++part)
        {
            label cell;
            record tile;
            if (!makeTile(node, part, plate::none, cell, tile)) continue;

            const label own =
                zoneOfCell.empty() || tile.stencil < 0
              ? -1 : zoneOfCell[grid.meshCell(cell)];
            label t = firstHere;
            while
            (
                t < size()
             && (own != zone[t] || !foldAlike(tile, tiles_[t]))
            ) ++t;
            if (t == size())
            {
                tiles_.push_back(tile);
                zone.push_back(own);
            }
            tileIndex_[nParts_*cell + part] = t;
        }
    }
    nPlain_ = size();
    if (grid.plated()) addViews();
}


void Foam::mpm::nodeTiles::addViews()
{
    const backgroundGrid& grid = folding_.grid();
    viewIndex_.setSize(2*nParts_*grid.nBoxNodes());
    viewIndex_ = -1;

    // Origins of the tiles of cells beside plates: themselves and upper corners
    bitSet origins(grid.nBoxNodes());
    for (label cell = 0; cell < grid.nBoxNodes(); ++cell)
    {
        if (grid.plateOf(cell) < 0) continue;
        for (label part = 0; part < nParts_; ++part)
        {
            label node = cell;
            for (label d = 0; d < grid.nDim(); ++d)
            {
                node += ((part >> d) & 1)*grid.stride(d);
            }
            origins.set(node);
        }
    }
    for (const label node : origins)
    {
        for (const label view : {plate::front, plate::back})
        {
            const label firstHere = size();
            for (label part = 0; part < nParts_; ++part)
            {
                label cell;
                record tile;
                if
                (
                    !makeTile(node, part, view, cell, tile)
                 || grid.plateOf(cell) < 0
                ) continue;

                label t = firstHere;
                while (t < size() && !foldAlike(tile, tiles_[t])) ++t;
                if (t == size())
                {
                    tiles_.push_back(tile);
                    viewOf_.push_back(view);
                }
                viewIndex_[2*(nParts_*cell + part) + view - plate::front] = t;
            }
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::nodeTiles::renewViews()
{
    tiles_.resize(nPlain_);
    viewOf_.clear();
    if (folding_.grid().plated()) addViews();
}


std::vector<char> Foam::mpm::nodeTiles::with(const bitSet& nodes) const
{
    std::vector<char> found(tiles_.size(), 0);
    for (size_t i = 0; i < tiles_.size(); ++i)
    {
        const record& tile = tiles_[i];
        const bool plain = tile.stencil < 0;
        const label* target = plain ? nullptr : folding_.targets(tile.stencil);
        const label* wall = plain ? nullptr : folding_.walls(tile.stencil);
        found[i] = anyNode
        (
            [&](const label offset, const label t)
            {
                if (plain) return nodes.test(tile.first + offset);
                const label e = tile.offset + t;
                return
                    nodes.test(target[e])
                 || (wall && wall[e] >= 0 && nodes.test(wall[e]));
            }
        );
    }
    return found;
}


size_t Foam::mpm::nodeTiles::memory() const
{
    return
        sizeof(label)
       *(tileIndex_.size() + viewIndex_.size() + viewOf_.size())
      + sizeof(record)*tiles_.size();
}

// ************************************************************************* //
