/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeFolding.H"
#include "wallShares.H"
#include "debug.H"
#include "registerSwitch.H"
#include <array>
#include <map>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

int Foam::mpm::nodeFolding::mirrors
(
    Foam::debug::debugSwitch("mpmMirrorWalls", 1)
);

namespace
{
    Foam::RegisterSwitch<int> addMirrorWalls
    (
        Foam::debug::addDebugObject,
        "mpmMirrorWalls",
        Foam::mpm::nodeFolding::mirrors
    );

    //- The record with every slot one
    inline Foam::mpm::nodeVector ones()
    {
        return Foam::mpm::nodeVector{1, 1, 1, 1};
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

bool Foam::mpm::nodeFolding::foldCorner
(
    const label cell,
    index3& o,
    index3& s
) const
{
    const label nDim = grid_.nDim();
    bool any = false;
    for (label size = 2; size <= nDim; ++size)
    for (label set = 1; set < (1 << nDim); ++set)
    {
        label n = 0, neighbour = cell;
        for (label d = 0; d < nDim; ++d)
        {
            if (!(set & (1 << d))) continue;
            if (s[d])
            {
                ++n;
                neighbour += s[d]*grid_.stride(d);
            }
            else
            {
                n = -nDim;
            }
        }
        if (n != size || grid_.cellRank(neighbour) != backgroundGrid::missing)
        {
            continue;
        }
        for (label d = 0; d < nDim; ++d)
        {
            if (!(set & (1 << d))) continue;
            o[d] = s[d] < 0 ? 0 : 1;
            s[d] = 0;
        }
        any = true;
    }
    return any;
}


bool Foam::mpm::nodeFolding::foldNode
(
    const cellSides& sides,
    const label celli,
    const label t,
    fold& f
) const
{
    const label nDim = grid_.nDim();
    const label cell = grid_.boxCell(celli);
    bool folds = false;

    // Node relative to the lower corner of the cell, and on which side of the
    // cell it lies
    index3 o, s;
    label rest = t;
    for (label d = 0; d < 3; ++d)
    {
        o[d] = d < nDim ? rest % grid_.reachWidth() + grid_.reachStart() : 0;
        rest /= grid_.reachWidth();
        s[d] = o[d] < 0 ? -1 : o[d] > 1 ? 1 : 0;
    }

    f.sign = ones();
    f.shift = nodeVector{};
    for (label& side : f.takenBy) side = -1;

    // Direction and side of a wall that mirrors about its nodes; in the edge of
    // two of them the other one is as slip
    label wallDirection = -1, wallSide = 0;

    for (label d = 0; d < nDim; ++d)
    {
        if (!s[d]) continue;
        const label side = cellSides::sideOf(d, s[d]);
        const cellSides::kind kind = sides(celli, side);

        if (kind == cellSides::open) s[d] = 0;
        if (!cellSides::isWall(kind)) continue;

        if (kind == cellSides::nodeWall && wallDirection < 0)
        {
            wallDirection = d;
            wallSide = (s[d] > 0);
        }
        o[d] = s[d] < 0 ? -o[d] : 2 - o[d];
        if (kind == cellSides::fixedWall)
        {
            const nodeVector& wall = sides.velocity(celli, side);
            for (label k = 0; k < nDim; ++k)
            {
                f.sign[k] = -f.sign[k];
                f.shift[k] = 2*wall[k] - f.shift[k];
                f.takenBy[k] = side;
            }
        }
        else
        {
            f.sign[d] = -f.sign[d];
            f.shift[d] = -f.shift[d];
            f.takenBy[d] = side;
        }
        s[d] = 0;
        folds = true;
    }
    folds = foldCorner(cell, o, s) || folds;
    f.image = o;

    f.target = cell;
    for (label d = 0; d < nDim; ++d) f.target += o[d]*grid_.stride(d);
    f.ghost =
        f.target == cell + grid_.reachOffset() + grid_.reachNode(t)
      ? f.target
      : grid_.ghostNode(cell, t);

    // The node on the wall below the image. Along its normal, where that has no
    // velocity, the mirror is as any
    const label d = wallDirection;
    f.wall = d < 0 ? -1 : f.target + (wallSide - o[d])*grid_.stride(d);
    f.wallFactor = 2*f.sign;
    if (d >= 0) f.wallFactor[d] = -f.wallFactor[d];
    return folds;
}


void Foam::mpm::nodeFolding::addStencil
(
    const cellSides& sides,
    const label celli,
    const bool nodeWalls,
    std::vector<fold>& folds
)
{
    bool any = false;
    for (label t = 0; t < grid_.reachSize(); ++t)
    {
        any = foldNode(sides, celli, t, folds[t]) || any;
    }
    if (!any) return;

    stencilIndex_[grid_.boxCell(celli)] =
        label(target_.size())/grid_.reachSize();
    for (const fold& f : folds)
    {
        target_.push_back(f.target);
        ghost_.push_back(f.ghost);
        sign_.push_back(f.sign);
        shift_.push_back(f.shift);
        if (nodeWalls)
        {
            wall_.push_back(f.wall);
            wallFactor_.push_back(f.wallFactor);
        }
    }
}


void Foam::mpm::nodeFolding::addViews(const label cell, const bool nodeWalls)
{
    const label size = grid_.reachSize();
    const label own = stencil(cell);
    for (const label view : {plate::front, plate::back})
    {
        viewStencil_[2*cell + view - plate::front] =
            label(target_.size())/size;
        for (label t = 0; t < size; ++t)
        {
            const label node = cell + grid_.reachOffset() + grid_.reachNode(t);
            auto seen = [&](const label first)
            {
                return first < 0 ? first : grid_.seen(first, view);
            };
            const size_t i = size_t(own)*size + t;
            const bool plain = own < 0;
            target_.push_back(seen(plain ? node : target_[i]));
            ghost_.push_back(seen(plain ? node : ghost_[i]));
            sign_.push_back(plain ? ones() : nodeVector(sign_[i]));
            shift_.push_back(plain ? nodeVector{} : nodeVector(shift_[i]));
            if (nodeWalls)
            {
                wall_.push_back(plain ? -1 : seen(wall_[i]));
                wallFactor_.push_back
                    (plain ? 2*ones() : nodeVector(wallFactor_[i]));
            }
        }
    }
}


void Foam::mpm::nodeFolding::addViews(const bool nodeWalls)
{
    if (!grid_.plated()) return;

    viewStencil_.setSize(2*grid_.nBoxNodes());
    viewStencil_ = -1;
    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const label cell = grid_.boxCell(celli);
        if (grid_.plateOf(cell) >= 0) addViews(cell, nodeWalls);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::nodeFolding::nodeFolding
(
    const backgroundGrid& grid,
    const cellSides& sides,
    const bool nodeWalls
)
:
    grid_(grid),
    stencilIndex_(grid.nBoxNodes(), -1)
{
    if (!mirrors)
    {
        WarningInFunction
            << "DebugSwitches: mpmMirrorWalls 0" << nl
            << "    Walls do not mirror. Results are not to be trusted."
            << endl;
    }

    std::vector<fold> folds(grid.reachSize());
    for (label celli = 0; mirrors && celli < grid.mesh().nCells(); ++celli)
    {
        addStencil(sides, celli, nodeWalls, folds);
    }
    nPlain_ = label(target_.size())/grid.reachSize();
    addViews(nodeWalls);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::nodeFolding::renewViews(const bool nodeWalls)
{
    const size_t n = size_t(nPlain_)*grid_.reachSize();
    target_.resize(n);
    ghost_.resize(n);
    sign_.resize(n);
    shift_.resize(n);
    if (nodeWalls)
    {
        wall_.resize(n);
        wallFactor_.resize(n);
    }
    addViews(nodeWalls);
}


Foam::label Foam::mpm::nodeFolding::stencilOfMiddle(const label cell) const
{
    if (grid_.plateOf(cell) < 0) return stencil(cell);

    const lattice& cells = grid_.cells();
    point middle(grid_.nodePosition(cell));
    for (label d = 0; d < cells.nDim(); ++d)
    {
        middle[cells.axis(d)] += 0.5*cells.spacing(d);
    }
    return stencil(cell, grid_.view(cell, middle));
}


void Foam::mpm::nodeFolding::foldPressureAs(const nodeFolding& other)
{
    pressure_ = &other;
    pressureStencil_.assign(sign_.size()/grid_.reachSize(), -1);
    forAll(stencilIndex_, cell)
    {
        const label here = stencilIndex_[cell];
        if (here >= 0) pressureStencil_[here] = other.stencil(cell);
        if (here < 0 || other.stencil(cell) < 0 || grid_.plateOf(cell) < 0)
        {
            continue;
        }
        for (const label view : {plate::front, plate::back})
        {
            pressureStencil_[stencil(cell, view)] = other.stencil(cell, view);
        }
    }
}


Foam::mpm::nodeField<Foam::mpm::nodeVector>
Foam::mpm::nodeFolding::foldedComponents() const
{
    nodeField<nodeVector> folded;
    folded.assign(grid_.nNodes(), nodeVector{});
    for (size_t i = 0; i < target_.size(); ++i)
    {
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            if (sign_[i][d] < 0) folded[target_[i]][d] = 1;
        }
    }
    grid_.exchange().sum(folded);
    for (nodeVector& f : folded)
    {
        for (label d = 0; d < grid_.nDim(); ++d) f[d] = (f[d] > 0);
    }
    return folded;
}


std::vector<Foam::scalar> Foam::mpm::nodeFolding::volumes() const
{
    const label T = grid_.reachWidth();
    std::vector<scalar> volume(grid_.nNodes(), 0);

    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const label cell = grid_.boxCell(celli);
        const label s = stencil(cell);

        for (label t = 0; t < grid_.reachSize(); ++t)
        {
            scalar v = grid_.cells().cellVolume()
               *grid_.cellIntegral(t % T)*grid_.cellIntegral((t/T) % T);
            if (grid_.nDim() == 3) v *= grid_.cellIntegral(t/(T*T));

            const label node =
                s < 0
              ? cell + grid_.reachOffset() + grid_.reachNode(t)
              : targets(s)[t];
            volume[node] += v;
        }
    }
    return volume;
}


void Foam::mpm::nodeFolding::record
(
    const cellSides& sides,
    const wallShares& shares
)
{
    const label nDim = grid_.nDim();
    slot_.assign(target_.size(), -1);
    slots_.clear();

    // Image, and node and side of the wall by component
    std::map<std::array<label, 7>, label> known;
    fold f;
    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const label cell = grid_.boxCell(celli);
        const label own = stencil(cell);
        const label nViews = grid_.plateOf(cell) < 0 ? 1 : 3;
        for (label view = 0; own >= 0 && view < nViews; ++view)
        for (label t = 0; t < grid_.reachSize(); ++t)
        {
            const label s = stencil(cell, view);
            foldNode(sides, celli, t, f);
            std::array<label, 7> key;
            key.fill(-1);
            key[0] = at(target_, s)[t];
            bool any = false;
            for (label d = 0; d < nDim; ++d)
            {
                const label side = f.takenBy[d];
                if (side < 0) continue;
                any = true;

                // The image on the wall, or where that ends the nearest corner
                // of the cell
                label node = cell, corner = cell;
                for (label k = 0; k < nDim; ++k)
                {
                    const label o = k == side/2 ? side % 2 : f.image[k];
                    node += o*grid_.stride(k);
                    corner += max(label(0), min(label(1), o))*grid_.stride(k);
                }
                key[1 + d] = shares.found(node, side) ? node : corner;
                key[4 + d] = side;
            }
            if (!any) continue;

            const auto added = known.emplace(key, label(slots_.size()));
            if (added.second)
            {
                slots_.push_back
                (
                    mirrorSlot
                    {
                        key[0], {key[1], key[2], key[3]},
                        {key[4], key[5], key[6]}
                    }
                );
            }
            slot_[size_t(s)*grid_.reachSize() + t] = added.first->second;
        }
    }
}


void Foam::mpm::nodeFolding::keepWalls(const bitSet& nodes)
{
    for (label& wall : wall_)
    {
        if (wall >= 0 && !nodes.test(wall)) wall = -1;
    }
}


Foam::mpm::nodeFolding::mirroredEntries Foam::mpm::nodeFolding::mirrored
(
    const std::vector<label>& meshCells
) const
{
    mirroredEntries m;
    for (const label celli : meshCells)
    {
        const label s = stencil(grid_.boxCell(celli));
        for (label t = 0; s >= 0 && t < grid_.reachSize(); ++t)
        {
            const size_t i = size_t(s)*grid_.reachSize() + t;
            const nodeVector& sign = sign_[i];
            if (sign[0] == 1 && sign[1] == 1 && sign[2] == 1) continue;
            m.entry.push_back(i);
            m.sign.push_back(sign);
            m.shift.push_back(shift_[i]);
            if (!wall_.empty()) m.wall.push_back(wall_[i]);
        }
    }
    return m;
}


void Foam::mpm::nodeFolding::setEven
(
    const mirroredEntries& entries,
    const bool even
)
{
    for (size_t i = 0; i < entries.entry.size(); ++i)
    {
        const size_t e = entries.entry[i];
        sign_[e] = even ? ones() : entries.sign[i];
        shift_[e] = even ? nodeVector{} : entries.shift[i];
        if (!wall_.empty()) wall_[e] = even ? -1 : entries.wall[i];
    }
}


size_t Foam::mpm::nodeFolding::memory() const
{
    return
        sizeof(label)
       *(
            stencilIndex_.size() + viewStencil_.size()
          + target_.size() + ghost_.size()
          + wall_.size() + slot_.size()
        )
      + sizeof(mirrorSlot)*slots_.size()
      + sizeof(nodeVector)
       *(sign_.size() + shift_.size() + wallFactor_.size());
}

// ************************************************************************* //
