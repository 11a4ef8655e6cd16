/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeBoundary.H"
#include "patchTypes.H"
#include "frictionalFvPatchVectorField.H"
#include "volFields.H"
#include "HashTable.H"
#include "PstreamReduceOps.H"
#include "debug.H"
#include "registerSwitch.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    //- Debug switch, on. Set to 0 in system/controlDict it takes the mirrors
    //  away: ghost nodes are nodes of their own, and the velocity that a wall
    //  gives its nodes holds there, too. Only to show what mirrors guard
    //  against. Read when a boundary is made.
    int mirrorWalls(Foam::debug::debugSwitch("mpmMirrorWalls", 1));

    Foam::RegisterSwitch<int> addMirrorWalls
    (
        Foam::debug::addDebugObject, "mpmMirrorWalls", mirrorWalls
    );

    //- The record with every slot one
    inline Foam::mpm::nodeVector ones()
    {
        return Foam::mpm::nodeVector{1, 1, 1, 1};
    }

    //- Side number of direction d, sign s
    inline Foam::label sideOf(const Foam::label d, const Foam::label s)
    {
        return 2*d + (s > 0);
    }


    //- Without mirrors: ghost nodes do as the nodes of the wall
    void constrainGhosts
    (
        const Foam::mpm::backgroundGrid& grid,
        Foam::DynamicList<Foam::label>& slip,
        std::vector<Foam::mpm::nodeVector>& slipMask,
        Foam::DynamicList<Foam::label>& fixed,
        std::vector<Foam::mpm::nodeVector>& fixedValue
    )
    {
        using namespace Foam;
        using namespace Foam::mpm;

        const label nDim = grid.nDim();

        // Next to a node of a wall and outside of the mesh
        auto forGhosts = [&](const label node, const auto& op)
        {
            index3 o;
            for (o[2] = (nDim == 3 ? -1 : 0); o[2] <= (nDim == 3); ++o[2])
            for (o[1] = -1; o[1] <= 1; ++o[1])
            for (o[0] = -1; o[0] <= 1; ++o[0])
            {
                label ghost = node;
                for (label d = 0; d < nDim; ++d) ghost += o[d]*grid.stride(d);

                bool outside = true;
                for (label corner = 0; corner < (1 << nDim); ++corner)
                {
                    label cell = ghost;
                    for (label d = 0; d < nDim; ++d)
                    {
                        if ((corner >> d) & 1) cell -= grid.stride(d);
                    }
                    outside = outside
                     && (
                            cell < 0 || cell >= grid.nBoxNodes()
                         || grid.cellRank(cell) == backgroundGrid::missing
                        );
                }
                if (outside) op(ghost, o);
            }
        };

        // A ghost stands still in the directions in which it lies behind the
        // wall, and in those of its wall's node
        const label nSlip = slip.size();
        for (label i = 0; i < nSlip; ++i)
        {
            const nodeVector mask = slipMask[i];
            forGhosts
            (
                slip[i],
                [&](const label ghost, const index3& o)
                {
                    // Behind a wall, not beside it
                    for (label d = 0; d < nDim; ++d)
                    {
                        if (o[d] && mask[d] != 0) return;
                    }
                    slip.append(ghost);
                    slipMask.push_back(mask);
                }
            );
        }
        const label nFixed = fixed.size();
        for (label i = 0; i < nFixed; ++i)
        {
            const nodeVector value = fixedValue[i];
            forGhosts
            (
                fixed[i],
                [&](const label ghost, const index3&)
                {
                    fixed.append(ghost);
                    fixedValue.push_back(value);
                }
            );
        }
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::nodeBoundary::findSides
(
    const volVectorField& U,
    const labelList& inflowOfCell,
    List<FixedList<sideType, 6>>& side,
    HashTable<nodeVector, label, Hash<label>>& wallVelocity
)
{
    const lattice& cells = grid_.cells();

    side.setSize(grid_.mesh().nCells(), FixedList<sideType, 6>(inner));

    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        const word& type = Up.type();
        sideType kind = inner;

        if (patchTypes::slip.found(type)) kind = slipWall;
        else if (patchTypes::fixed.found(type)) kind = fixedWall;
        else if (patchTypes::open.found(type)) kind = open;
        else if (!patchTypes::other.found(type))
        {
            patchTypes::refuse
                (Up, "is not a boundary condition of material points");
        }
        if (kind == inner) continue;

        const labelUList& faceCells = Up.patch().faceCells();
        const vectorField n(Up.patch().nf());

        forAll(faceCells, i)
        {
            label d, s;
            cells.faceDirection(n[i], d, s);
            if (d < 0) continue;

            side[faceCells[i]][2*d + s] = kind;
            if (isA<frictionalFvPatchVectorField>(Up))
            {
                friction_.set
                (
                    6*faceCells[i] + 2*d + s,
                    refCast<const frictionalFvPatchVectorField>(Up)
                   .coefficient()
                );
            }
            if (kind == open)
            {
                beyondOpening_.set
                (
                    grid_.boxCell(faceCells[i])
                  + (s ? 1 : -1)*grid_.stride(d),
                    Up.patch().index()
                );
            }
            else if (kind == fixedWall)
            {
                // A closed inlet is at rest
                const bool inlet =
                    !inflowOfCell.empty() && inflowOfCell[faceCells[i]] >= 0;
                nodeVector value{};
                for (label k = 0; !inlet && k < grid_.nDim(); ++k)
                {
                    value[k] = Up[i][cells.axis(k)];
                }
                wallVelocity.set(6*faceCells[i] + 2*d + s, value);
            }
        }
    }
}


void Foam::mpm::nodeBoundary::buildStencils
(
    const List<FixedList<sideType, 6>>& side,
    const HashTable<nodeVector, label, Hash<label>>& wallVelocity,
    const labelList& inflowOfCell
)
{
    const label nDim = grid_.nDim();
    const label T = grid_.reachWidth();
    const label reachSize = grid_.reachSize();

    stencilIndex_.setSize(grid_.nBoxNodes(), -1);
    if (!mirrorWalls) return;

    label nStencils = 0;

    std::vector<label> target(reachSize), ghost(reachSize);
    std::vector<nodeVector> sign(reachSize), shift(reachSize);
    const bool anyFriction = returnReduce(!friction_.empty(), orOp<bool>());
    std::vector<label> wallNode(anyFriction ? reachSize : 0);
    std::vector<nodeVector> wallFactor(anyFriction ? reachSize : 0);

    forAll(side, celli)
    {
        const label cell = grid_.boxCell(celli);
        bool plain = true;

        for (label t = 0; t < reachSize; ++t)
        {
            // Node relative to the lower corner of the cell, and on which
            // side of the cell it lies
            index3 o, s;
            label rest = t;
            for (label d = 0; d < 3; ++d)
            {
                const bool solved = d < nDim;
                o[d] = solved ? rest % T + grid_.reachStart() : 0;
                rest /= T;
                s[d] = o[d] < 0 ? -1 : o[d] > 1 ? 1 : 0;
            }

            nodeVector sg = ones();
            nodeVector sh{};

            // Direction and side of a wall with friction; in the edge of two
            // of them the other one is as slip
            label wallDirection = -1, wallSide = 0;

            for (label d = 0; d < nDim; ++d)
            {
                if (!s[d]) continue;
                const sideType kind = side[celli][sideOf(d, s[d])];

                if (kind == slipWall || kind == fixedWall)
                {
                    // Mirror about the wall
                    if
                    (
                        wallDirection < 0
                     && friction_.found(6*celli + sideOf(d, s[d]))
                    )
                    {
                        wallDirection = d;
                        wallSide = (s[d] > 0);
                    }
                    o[d] = s[d] < 0 ? -o[d] : 2 - o[d];
                    if (kind == slipWall)
                    {
                        sg[d] = -sg[d];
                        sh[d] = -sh[d];
                    }
                    else
                    {
                        const nodeVector& wall =
                            wallVelocity[6*celli + sideOf(d, s[d])];
                        for (label k = 0; k < nDim; ++k)
                        {
                            sg[k] = -sg[k];
                            sh[k] = 2*wall[k] - sh[k];
                        }
                    }
                    s[d] = 0;
                    plain = false;
                }
                else if (kind == open)
                {
                    s[d] = 0;
                }
            }

            // Convex corners: fold along the smallest set of directions
            // whose diagonal cell is missing
            for (label size = 2; size <= nDim; ++size)
            {
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
                    if
                    (
                        n == size
                     && grid_.cellRank(neighbour) == backgroundGrid::missing
                    )
                    {
                        for (label d = 0; d < nDim; ++d)
                        {
                            if (!(set & (1 << d))) continue;
                            o[d] = s[d] < 0 ? 0 : 1;
                            s[d] = 0;
                        }
                        plain = false;
                    }
                }
            }

            label node = cell;
            for (label d = 0; d < nDim; ++d) node += o[d]*grid_.stride(d);
            target[t] = node;
            ghost[t] =
                node == cell + grid_.reachOffset() + grid_.reachNode(t)
              ? node
              : grid_.ghostNode(cell, t);
            sign[t] = sg;
            shift[t] = sh;

            if (anyFriction)
            {
                // The node on the wall below the image. Along its normal, where
                // that has no velocity, the mirror is as any
                const label d = wallDirection;
                wallNode[t] =
                    d < 0 ? -1 : node + (wallSide - o[d])*grid_.stride(d);
                wallFactor[t] = 2*sg;
                if (d >= 0) wallFactor[t][d] = -wallFactor[t][d];
            }
        }

        if (!plain)
        {
            const label inlet =
                inflowOfCell.empty() ? -1 : inflowOfCell[celli];
            inflowOf_.push_back(inlet);
            for (label t = 0; inlet >= 0 && t < reachSize; ++t)
            {
                const nodeVector& s = sign[t];
                if (s[0] == 1 && s[1] == 1 && s[2] == 1) continue;
                inflows_[inlet].entries.push_back
                (
                    size_t(nStencils)*reachSize + t
                );
                inflows_[inlet].closedSign.push_back(s);
                inflows_[inlet].closedShift.push_back(shift[t]);
                if (anyFriction)
                {
                    inflows_[inlet].closedWall.push_back(wallNode[t]);
                }
            }

            stencilIndex_[cell] = nStencils++;
            target_.insert(target_.end(), target.begin(), target.end());
            ghost_.insert(ghost_.end(), ghost.begin(), ghost.end());
            sign_.insert(sign_.end(), sign.begin(), sign.end());
            shift_.insert(shift_.end(), shift.begin(), shift.end());
            wall_.insert(wall_.end(), wallNode.begin(), wallNode.end());
            wallFactor_.insert
            (
                wallFactor_.end(), wallFactor.begin(), wallFactor.end()
            );
        }
    }
}


bool Foam::mpm::nodeBoundary::foldAlike
(
    const tileRecord& a,
    const tileRecord& b
) const
{
    if (a.stencil < 0 || b.stencil < 0) return a.stencil == b.stencil;

    // The zone of an inlet folds in another way while it is open
    if (inflowOf_[a.stencil] != inflowOf_[b.stencil]) return false;

    const label W = grid_.tileWidth();
    const label R = grid_.reachWidth();
    const label* targetA = targets(a.stencil) + a.offset;
    const label* targetB = targets(b.stencil) + b.offset;
    const label* ghostA = ghosts(a.stencil) + a.offset;
    const label* ghostB = ghosts(b.stencil) + b.offset;
    const nodeVector* signA = signs(a.stencil) + a.offset;
    const nodeVector* signB = signs(b.stencil) + b.offset;
    const nodeVector* shiftA = shifts(a.stencil) + a.offset;
    const nodeVector* shiftB = shifts(b.stencil) + b.offset;
    const label* wallA = walls(a.stencil);
    const label* wallB = walls(b.stencil);

    for (label k = 0; k < (grid_.nDim() == 3 ? W : 1); ++k)
    for (label j = 0; j < W; ++j)
    for (label i = 0; i < W; ++i)
    {
        const label t = i + R*(j + R*k);
        if (targetA[t] != targetB[t] || ghostA[t] != ghostB[t]) return false;
        if (wallA && wallA[a.offset + t] != wallB[b.offset + t]) return false;
        for (label c = 0; c < 4; ++c)
        {
            if (signA[t][c] != signB[t][c]) return false;
            if (shiftA[t][c] != shiftB[t][c]) return false;
        }
    }
    return true;
}


void Foam::mpm::nodeBoundary::restrictFriction()
{
    bitSet mirrors(grid_.nNodes());
    for (const frictionNode& f : frictionNodes_)
    {
        if (f.next >= 0) mirrors.set(f.node);
    }
    for (label& wall : wall_)
    {
        if (wall >= 0 && !mirrors.test(wall)) wall = -1;
    }
    for (inflow& in : inflows_)
    {
        for (label& wall : in.closedWall)
        {
            if (wall >= 0 && !mirrors.test(wall)) wall = -1;
        }
    }
}


void Foam::mpm::nodeBoundary::buildTiles()
{
    const label nDim = grid_.nDim();
    const label R = grid_.reachWidth();
    const label W = grid_.tileWidth();

    nParts_ = grid_.nodeCentred() ? 1 << nDim : 1;
    tileIndex_.setSize(nParts_*grid_.nBoxNodes(), -1);

    // The parts of cells around each origin
    for (label node = 0; node < grid_.nBoxNodes(); ++node)
    {
        const label firstHere = nTiles();

        for (label part = 0; part < nParts_; ++part)
        {
            tileRecord tile{node, -1, 0, {0, 0, 0}};
            label cell = node;
            label reachStride = 1;
            for (label d = 0; d < nDim; ++d)
            {
                const label upper = (part >> d) & 1;
                cell -= upper*grid_.stride(d);
                tile.first += grid_.tileStart()*grid_.stride(d);
                tile.offset += reachStride
                   *(upper + grid_.tileStart() - grid_.reachStart());
                tile.origin[d] = grid_.coordinate(node)[d] + grid_.lower(d);
                reachStride *= R;
            }
            if (cell < 0 || !grid_.ownCell(cell)) continue;

            // Cells at a wall have parts that do not touch it
            if (stencil(cell) >= 0)
            {
                const label* target = targets(stencil(cell)) + tile.offset;
                bool plain = true;
                for (label k = 0; k < (nDim == 3 ? W : 1); ++k)
                for (label j = 0; j < W; ++j)
                for (label i = 0; i < W; ++i)
                {
                    plain = plain
                     && target[i + R*(j + R*k)]
                     == tile.first + i + j*grid_.stride(1) + k*grid_.stride(2);
                }
                if (!plain) tile.stencil = stencil(cell);
            }

            label t = firstHere;
            while (t < nTiles() && !foldAlike(tile, tiles_[t])) ++t;
            if (t == nTiles()) tiles_.push_back(tile);
            tileIndex_[nParts_*cell + part] = t;
        }
    }
}


void Foam::mpm::nodeBoundary::buildConstraints
(
    const List<FixedList<sideType, 6>>& side,
    const HashTable<nodeVector, label, Hash<label>>& wallVelocity
)
{
    const label nDim = grid_.nDim();
    const label nCorners = 1 << nDim;

    // Walls on each side of a node, and the sum of velocities of those that
    // have one (number in slot 3)
    nodeField<packed<8>> walls(grid_.nNodes(), packed<8>{});
    nodeField<nodeVector> given(grid_.nNodes(), nodeVector{});
    nodeField<packed<8>> friction(grid_.nNodes(), packed<8>{});
    nodeField<packed<8>> frictional(grid_.nNodes(), packed<8>{});
    bitSet candidates(grid_.nNodes());

    forAll(side, celli)
    {
        for (label d = 0; d < nDim; ++d)
        for (label s = 0; s < 2; ++s)
        {
            const sideType kind = side[celli][2*d + s];
            if (kind != slipWall && kind != fixedWall) continue;

            for (label corner = 0; corner < nCorners; ++corner)
            {
                if (((corner >> d) & 1) != s) continue;

                label node = grid_.boxCell(celli);
                for (label k = 0; k < nDim; ++k)
                {
                    node += ((corner >> k) & 1)*grid_.stride(k);
                }
                walls[node][2*d + s] += 1;
                const auto found = friction_.cfind(6*celli + 2*d + s);
                if (found.found())
                {
                    friction[node][2*d + s] += found.val();
                    frictional[node][2*d + s] += 1;
                }
                if (kind == fixedWall)
                {
                    nodeVector value = wallVelocity[6*celli + 2*d + s];
                    value[3] = 1;
                    given[node] += value;
                }
            }
        }
    }
    grid_.exchange().sum(walls);
    grid_.exchange().sum(given);
    if (returnReduce(!friction_.empty(), orOp<bool>()))
    {
        grid_.exchange().sum(friction);
        grid_.exchange().sum(frictional);
    }

    DynamicList<label> slipNodes, fixedNodes;

    for (label node = 0; node < grid_.nBoxNodes(); ++node)
    {
        bool any = false;
        for (label i = 0; i < 2*nDim; ++i) any = any || walls[node][i] > 0;
        if (!any) continue;

        if (given[node][3] > 0)
        {
            nodeVector value = given[node]/given[node][3];
            for (label k = nDim; k < 4; ++k) value[k] = 0;
            fixedNodes.append(node);
            fixedValue_.push_back(value);
            continue;
        }

        label nWalls = 0;
        for (label i = 0; i < 2*nDim; ++i) nWalls += walls[node][i] > 0;
        for (label i = 0; i < 2*nDim; ++i)
        {
            if (frictional[node][i] > 0)
            {
                const label sign = i % 2 ? 1 : -1;
                label next = node - sign*grid_.stride(i/2);
                for (label k = 0; k < 2*nDim; ++k)
                {
                    if (nWalls > 1 || walls[next][k] > 0) next = -1;
                    if (next < 0) break;
                }

                // The mean over the sides that meet here
                frictionNodes_.push_back
                (
                    frictionNode
                    {
                        node, i/2, sign, friction[node][i]/walls[node][i], next
                    }
                );
            }
        }

        // Is every cell around the node in the given orthants missing?
        auto blocked = [&](const index3& s)
        {
            for (label corner = 0; corner < nCorners; ++corner)
            {
                label cell = node;
                bool inOrthant = true;
                for (label d = 0; d < nDim; ++d)
                {
                    const label c = ((corner >> d) & 1) ? 1 : -1;
                    inOrthant = inOrthant && (s[d] == 0 || s[d] == c);
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
        };

        // Flat walls
        nodeVector mask = ones();
        FixedList<bool, 6> convex(false);
        for (label d = 0; d < nDim; ++d)
        for (label s = -1; s < 2; s += 2)
        {
            if (walls[node][sideOf(d, s)] == 0) continue;
            index3 into;
            into = 0;
            into[d] = s;
            if (blocked(into)) mask[d] = 0;
            else convex[sideOf(d, s)] = true;
        }
        bool anyFlat = false;
        for (label d = 0; d < nDim; ++d) anyFlat = anyFlat || mask[d] == 0;
        if (anyFlat)
        {
            slipNodes.append(node);
            slipMask_.push_back(mask);
        }

        // Convex edges, then corners that no edge explains
        bool anyEdge = false;
        for (label d = 0; d < nDim; ++d)
        for (label k = d + 1; k < nDim; ++k)
        for (label sd = -1; sd < 2; sd += 2)
        for (label sk = -1; sk < 2; sk += 2)
        {
            if (!convex[sideOf(d, sd)] || !convex[sideOf(k, sk)]) continue;
            index3 into;
            into = 0;
            into[d] = sd;
            into[k] = sk;
            if (blocked(into))
            {
                cone c{node, nodeVector{}};
                c.intoSolid[d] = sd;
                c.intoSolid[k] = sk;
                cones_.push_back(c);
                anyEdge = true;
            }
        }
        if (nDim == 3 && !anyEdge)
        {
            for (label corner = 0; corner < nCorners; ++corner)
            {
                index3 into;
                bool all = true;
                cone c{node, nodeVector{}};
                for (label d = 0; d < 3; ++d)
                {
                    into[d] = ((corner >> d) & 1) ? 1 : -1;
                    c.intoSolid[d] = into[d];
                    all = all && convex[sideOf(d, into[d])];
                }
                if (all && blocked(into)) cones_.push_back(c);
            }
        }
    }
    if (!mirrorWalls)
    {
        constrainGhosts
        (
            grid_, slipNodes, slipMask_, fixedNodes, fixedValue_
        );
    }
    slipNodes_.transfer(slipNodes);
    fixedNodes_.transfer(fixedNodes);
}


void Foam::mpm::nodeBoundary::buildControlVolumes()
{
    const label nDim = grid_.nDim();
    const label T = grid_.reachWidth();

    inverseVolume_.assign(grid_.nNodes(), 0);

    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const label cell = grid_.boxCell(celli);
        const label s = stencil(cell);

        for (label t = 0; t < grid_.reachSize(); ++t)
        {
            scalar v = grid_.cells().cellVolume()
               *grid_.cellIntegral(t % T)*grid_.cellIntegral((t/T) % T);
            if (nDim == 3) v *= grid_.cellIntegral(t/(T*T));

            const label node =
                s < 0
              ? cell + grid_.reachOffset() + grid_.reachNode(t)
              : targets(s)[t];
            inverseVolume_[node] += v;
        }
    }
    grid_.exchange().sum(inverseVolume_);

    for (scalar& v : inverseVolume_)
    {
        v = v > 0 ? 1/v : 0;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::nodeBoundary::nodeBoundary
(
    const backgroundGrid& grid,
    const volVectorField& U,
    const cornerType corners,
    const std::vector<const inflowZone*>& inlets
)
:
    grid_(grid),
    corners_(corners),
    inflows_(inlets.size())
{
    if (!mirrorWalls)
    {
        WarningInFunction
            << "DebugSwitches: mpmMirrorWalls 0" << nl
            << "    Walls do not mirror. Results are not to be trusted."
            << endl;
    }

    List<FixedList<sideType, 6>> side;
    HashTable<nodeVector, label, Hash<label>> wallVelocity;

    labelList inflowOfCell;
    if (inlets.size())
    {
        inflowOfCell.setSize(grid.mesh().nCells(), -1);
        for (size_t i = 0; i < inlets.size(); ++i)
        {
            for (const label celli : inlets[i]->meshCells())
            {
                inflowOfCell[celli] = label(i);
            }
            inflows_[i].nodes = inlets[i]->nodes();
        }
    }

    findSides(U, inflowOfCell, side, wallVelocity);
    buildStencils(side, wallVelocity, inflowOfCell);
    buildConstraints(side, wallVelocity);
    restrictFriction();
    buildTiles();
    buildControlVolumes();

    activeSlip_ = identity(slipNodes_.size());
    activeFixed_ = identity(fixedNodes_.size());
    activeCones_ = identity(label(cones_.size()));
    activeFriction_ = identity(label(frictionNodes_.size()));
    for (inflow& in : inflows_)
    {
        in.active = UList<label>(in.nodes.data(), label(in.nodes.size()));
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::nodeBoundary::isOpening(const word& patchType)
{
    return patchTypes::open.found(patchType);
}


void Foam::mpm::nodeBoundary::activate(const bitSet& active)
{
    DynamicList<label> list;

    forAll(slipNodes_, i) if (active.test(slipNodes_[i])) list.append(i);
    activeSlip_ = list;

    list.clear();
    forAll(fixedNodes_, i) if (active.test(fixedNodes_[i])) list.append(i);
    activeFixed_ = list;

    list.clear();
    for (label i = 0; i < label(cones_.size()); ++i)
    {
        if (active.test(cones_[i].node)) list.append(i);
    }
    activeCones_ = list;

    list.clear();
    for (label i = 0; i < label(frictionNodes_.size()); ++i)
    {
        if (active.test(frictionNodes_[i].node)) list.append(i);
    }
    activeFriction_ = list;

    for (inflow& in : inflows_)
    {
        list.clear();
        for (const label node : in.nodes)
        {
            if (active.test(node)) list.append(node);
        }
        in.active = list;
    }
}


void Foam::mpm::nodeBoundary::foldPressureAs(const nodeBoundary& water)
{
    water_ = &water;
    waterStencil_.assign(sign_.size()/grid_.reachSize(), -1);
    forAll(stencilIndex_, cell)
    {
        const label here = stencilIndex_[cell];
        if (here >= 0) waterStencil_[here] = water.stencil(cell);
    }
}


Foam::mpm::nodeField<Foam::mpm::nodeVector>
Foam::mpm::nodeBoundary::foldedComponents() const
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


void Foam::mpm::nodeBoundary::setInflow
(
    const label inlet,
    const bool open,
    const nodeVector& velocity
)
{
    inflow& in = inflows_[inlet];
    in.velocity = velocity;
    if (in.open == open) return;

    in.open = open;
    for (size_t i = 0; i < in.entries.size(); ++i)
    {
        sign_[in.entries[i]] = open ? ones() : in.closedSign[i];
        shift_[in.entries[i]] = open ? nodeVector{} : in.closedShift[i];
        if (!wall_.empty())
        {
            wall_[in.entries[i]] = open ? -1 : in.closedWall[i];
        }
    }
}


void Foam::mpm::nodeBoundary::constrain
(
    nodeField<nodeVector>& velocity,
    const bool homogeneous
) const
{
    const label nDim = grid_.nDim();

    for (const label i : activeSlip_)
    {
        velocity[slipNodes_[i]] *= slipMask_[i];
    }

    for (const label i : activeFixed_)
    {
        nodeVector& v = velocity[fixedNodes_[i]];
        for (label d = 0; d < nDim; ++d)
        {
            v[d] = homogeneous ? 0 : fixedValue_[i][d];
        }
    }

    for (const inflow& in : inflows_)
    {
        if (!in.open) continue;
        for (const label node : in.active)
        {
            for (label d = 0; d < nDim; ++d)
            {
                velocity[node][d] = homogeneous ? 0 : in.velocity[d];
            }
        }
    }

    for (const label i : activeCones_)
    {
        const cone& c = cones_[i];
        nodeVector& v = velocity[c.node];

        bool into = true;
        for (label d = 0; corners_ == slipCorners && d < nDim; ++d)
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


void Foam::mpm::nodeBoundary::foldFriction
(
    const nodeField<nodeVector>& ghostMomentum,
    nodeField<nodeVector>& momentum
) const
{
    const label nDim = grid_.nDim();

    for (const label i : activeFriction_)
    {
        const frictionNode& f = frictionNodes_[i];
        const scalar m = momentum[f.node][nDim];
        if (f.next < 0 || !(m > 0)) continue;

        const nodeVector& ghost = ghostMomentum[f.node];
        for (label d = 0; d < nDim; ++d)
        {
            const scalar v =
                d == f.direction ? 0 : momentum[f.node][d]/m;
            momentum[f.next][d] += 2*ghost[nDim]*v - ghost[d];
        }
    }
}


void Foam::mpm::nodeBoundary::keepVelocities
(
    const nodeField<nodeVector>& velocity,
    std::vector<nodeVector>& kept
) const
{
    kept.resize(2*frictionNodes_.size());
    for (const label i : activeFriction_)
    {
        const frictionNode& f = frictionNodes_[i];
        if (f.next < 0) continue;
        kept[2*i] = velocity[f.node];
        kept[2*i + 1] = velocity[f.next];
    }
}


void Foam::mpm::nodeBoundary::findWallForces
(
    const nodeField<nodeVector>& force,
    std::vector<scalar>& wallForce
) const
{
    wallForce.resize(frictionNodes_.size());
    for (const label i : activeFriction_)
    {
        const frictionNode& f = frictionNodes_[i];
        wallForce[i] = f.sign*force[f.node][f.direction];
    }
}


std::vector<char> Foam::mpm::nodeBoundary::frictionTiles() const
{
    bitSet onWall(grid_.nNodes());
    for (const frictionNode& f : frictionNodes_) onWall.set(f.node);

    const label nDim = grid_.nDim();
    const label W = grid_.tileWidth();
    const label R = grid_.reachWidth();
    std::vector<char> found(tiles_.size(), 0);
    for (size_t i = 0; i < tiles_.size(); ++i)
    {
        const tileRecord& tile = tiles_[i];
        const label n = nDim == 2 ? W*W : W*W*W;
        for (label t = 0; !found[i] && t < n; ++t)
        {
            const label o[3] = {t % W, (t/W) % W, t/(W*W)};
            if (tile.stencil < 0)
            {
                label node = tile.first;
                for (label d = 0; d < nDim; ++d) node += o[d]*grid_.stride(d);
                found[i] = onWall.test(node);
                continue;
            }
            const label entry = tile.offset + o[0] + R*(o[1] + R*o[2]);
            const label* wall = walls(tile.stencil);
            found[i] =
                onWall.test(targets(tile.stencil)[entry])
             || (wall && wall[entry] >= 0);
        }
    }
    return found;
}


void Foam::mpm::nodeBoundary::applyFriction
(
    const std::vector<scalar>& wallForce,
    const std::vector<nodeVector>& kept,
    const nodeField<nodeVector>& ghostMomentum,
    const nodeField<nodeVector>& momentum,
    const scalar deltaT,
    nodeField<nodeVector>& velocity
) const
{
    const label nDim = grid_.nDim();

    for (const label i : activeFriction_)
    {
        const frictionNode& f = frictionNodes_[i];
        scalar m = momentum[f.node][nDim];
        if (!(m > 0)) continue;

        nodeVector& v = velocity[f.node];

        // What the mirror image adds to the next node as the wall's moves
        scalar part = 0;
        if (f.next >= 0)
        {
            const scalar ghost = 2*ghostMomentum[f.node][nDim];
            const scalar mNext = momentum[f.next][nDim];
            part = mNext > 0 ? ghost/mNext : 0;
            const scalar mWall = m + (2 - part)*ghost;
            nodeVector& vNext = velocity[f.next];
            for (label d = 0; d < nDim; ++d)
            {
                if (d == f.direction) continue;
                const scalar impulse = m*(v[d] - kept[2*i][d]);
                const scalar nextImpulse = mNext*(vNext[d] - kept[2*i + 1][d]);
                const scalar change = (impulse + part*nextImpulse)/mWall;
                v[d] = kept[2*i][d] + change;
                vNext[d] += part*change;
            }
            m = mWall;
        }

        scalar speedSqr = 0;
        for (label d = 0; d < nDim; ++d)
        {
            if (d != f.direction) speedSqr += sqr(v[d]);
        }
        const scalar speed = std::sqrt(speedSqr);
        const scalar lost = f.coefficient*deltaT/m*max(scalar(0), wallForce[i]);
        const scalar lostPart = lost < speed ? lost/speed : 1;
        for (label d = 0; d < nDim; ++d)
        {
            if (d == f.direction) continue;
            if (f.next >= 0) velocity[f.next][d] -= part*lostPart*v[d];
            v[d] *= 1 - lostPart;
        }
    }
}


size_t Foam::mpm::nodeBoundary::memory() const
{
    return
        sizeof(label)
       *(
            stencilIndex_.size() + target_.size() + ghost_.size()
          + tileIndex_.size() + wall_.size()
        )
      + sizeof(tileRecord)*tiles_.size()
      + sizeof(nodeVector)
       *(sign_.size() + shift_.size() + wallFactor_.size())
      + sizeof(scalar)*inverseVolume_.size();
}

// ************************************************************************* //
