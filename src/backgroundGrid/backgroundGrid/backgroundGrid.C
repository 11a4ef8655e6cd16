/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "backgroundGrid.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"
#include "bitSet.H"
#include <algorithm>
#include <vector>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::backgroundGrid::selectShapeFunction(const dictionary& mpmDict)
{
    shapeFunction_ =
        mpmDict.lookupOrDefault<word>("shapeFunction", quadraticBSpline::name);

    auto adopt = [&](const auto shape)
    {
        typedef decltype(shape) Shape;
        tileWidth_ = Shape::width;
        tileStart_ = Shape::start;
        nodeCentred_ = Shape::nodeCentred;
        reachWidth_ = Shape::reachWidth;
        reachStart_ = Shape::reachStart;
        secondMoment_ =
            Shape::gradientScale > 0 ? 1/Shape::gradientScale : 0;
        cellIntegral_.setSize(reachWidth_);
        for (label t = 0; t < reachWidth_; ++t)
        {
            cellIntegral_[t] = Shape::cellIntegral[t];
        }
    };

    if (shapeFunction_ == linear::name)
    {
        adopt(linear());
    }
    else if (shapeFunction_ == quadraticBSpline::name)
    {
        adopt(quadraticBSpline());
    }
    else if (shapeFunction_ == cubicBSpline::name)
    {
        adopt(cubicBSpline());
    }
    else
    {
        FatalIOErrorInFunction(mpmDict)
            << "keyword shapeFunction: unknown shape function "
            << shapeFunction_ << nl << "    Valid names: "
            << linear::name << ' ' << quadraticBSpline::name << ' '
            << cubicBSpline::name << exit(FatalIOError);
    }
}


void Foam::mpm::backgroundGrid::buildBox()
{
    const label nCells = mesh().nCells();

    index3 upper;
    for (label d = 0; d < 3; ++d)
    {
        lower_[d] = nCells ? labelMax : 0;
        upper[d] = nCells ? labelMin : -1;
    }
    for (label celli = 0; celli < nCells; ++celli)
    {
        const index3& i = lattice_->cellIndex(celli);
        for (label d = 0; d < 3; ++d)
        {
            lower_[d] = min(lower_[d], i[d]);
            upper[d] = max(upper[d], i[d]);
        }
    }

    for (label d = 0; d < 3; ++d)
    {
        const bool solved = d < nDim();
        const label m = solved ? margin : 0;
        lower_[d] -= m;
        nNodes_[d] = solved ? upper[d] + 2 + m - lower_[d] : 1;
    }
    stride_ = {1, nNodes_[0], nNodes_[0]*nNodes_[1]};

    meshCell_.setSize(nBoxNodes(), -1);
    boxCell_.setSize(nCells);
    for (label celli = 0; celli < nCells; ++celli)
    {
        index3 i = lattice_->cellIndex(celli);
        for (label d = 0; d < 3; ++d) i[d] -= lower_[d];
        boxCell_[celli] = index(i);
        meshCell_[boxCell_[celli]] = celli;
    }
}


void Foam::mpm::backgroundGrid::exchangeCellOwners()
{
    neighbours_.reset(new neighbourRanks(*lattice_, lower_, nNodes_));

    // Each rank gets the cells that lie in its box, with all images
    List<DynamicList<label>> cells(neighbours_->size());
    forAll(cells, r)
    {
        neighbours_->forShared
        (
            r,
            [&](const label mine, const label theirs)
            {
                if (ownCell(mine)) cells[r].append(theirs);
            }
        );
    }
    const labelListList found(neighbours_->exchange(cells));

    cellRank_.setSize(nBoxNodes());
    cellRank_ = missing;
    forAll(found, r)
    {
        for (const label cell : found[r])
        {
            cellRank_[cell] = neighbours_->ranks()[r];
        }
    }
}


void Foam::mpm::backgroundGrid::checkWallThickness() const
{
    // Cells that are left out, by lattice index, and the direction in which
    // there are cells on both sides
    DynamicList<index3> thin;
    DynamicList<label> direction;
    forAll(boxCell_, celli)
    {
        const label c = boxCell_[celli];
        for (label d = 0; d < nDim(); ++d)
        {
            if
            (
                cellRank_[c + stride_[d]] == missing
             && cellRank_[c + 2*stride_[d]] != missing
            )
            {
                index3 i = lattice_->cellIndex(celli);
                ++i[d];
                thin.append(i);
                direction.append(d);
            }
        }
    }
    if (!returnReduce(thin.size(), sumOp<label>())) return;

    // All places, of all ranks
    List<List<index3>> allThin(Pstream::nProcs());
    List<labelList> allDirections(Pstream::nProcs());
    allThin[Pstream::myProcNo()] = thin;
    allDirections[Pstream::myProcNo()] = direction;
    Pstream::gatherList(allThin);
    Pstream::scatterList(allThin);
    Pstream::gatherList(allDirections);
    Pstream::scatterList(allDirections);

    // Walls: neighbours of the same direction, as boxes
    struct wall { label direction; index3 lower; index3 upper; };
    std::vector<wall> walls;
    forAll(allThin, rank)
    {
        forAll(allThin[rank], k)
        {
            wall w
            {
                allDirections[rank][k], allThin[rank][k], allThin[rank][k]
            };

            // Walls that it joins are taken into it
            for (size_t other = 0; other < walls.size(); )
            {
                const wall& o = walls[other];
                bool joins = o.direction == w.direction;
                for (label d = 0; joins && d < 3; ++d)
                {
                    const label reach = d == w.direction ? 0 : 1;
                    joins =
                        o.lower[d] <= w.upper[d] + reach
                     && w.lower[d] <= o.upper[d] + reach;
                }
                if (!joins)
                {
                    ++other;
                    continue;
                }
                for (label d = 0; d < 3; ++d)
                {
                    w.lower[d] = min(w.lower[d], o.lower[d]);
                    w.upper[d] = max(w.upper[d], o.upper[d]);
                }
                walls[other] = walls.back();
                walls.pop_back();
                other = 0;
            }
            walls.push_back(w);
        }
    }
    std::sort
    (
        walls.begin(), walls.end(),
        [](const wall& a, const wall& b)
        {
            for (label d = 2; d >= 0; --d)
            {
                if (a.lower[d] != b.lower[d]) return a.lower[d] < b.lower[d];
            }
            return a.direction < b.direction;
        }
    );

    FatalErrorInFunction
        << "the mesh in " << mesh().pointsInstance()/mesh().meshDir()
        << " has walls one cell thick, at " << label(walls.size())
        << (walls.size() == 1 ? " place:" : " places:") << nl;
    for (const wall& w : walls)
    {
        point from(Zero), to(Zero);
        for (label d = 0; d < 3; ++d)
        {
            const label a = lattice_->axis(d);
            from[a] = lattice_->origin(d) + w.lower[d]*lattice_->spacing(d);
            to[a] =
                lattice_->origin(d) + (w.upper[d] + 1)*lattice_->spacing(d);
        }
        FatalError
            << "    thin in direction "
            << vector::componentNames[lattice_->axis(w.direction)]
            << ", from " << from << " to " << to << nl;
    }
    FatalError
        << "    Both sides mirror the flow at the wall; walls need at least two"
        << " cells." << exit(FatalError);
}


void Foam::mpm::backgroundGrid::findTwins()
{
    // The cells that reach a node, and which of them touch it
    const label R = reachWidth_;
    const label nBlock = reachSize();
    labelList offset(nBlock), step(nDim());
    boolList touches(nBlock, true);
    for (label d = 0; d < nDim(); ++d) step[d] = d ? R*step[d - 1] : 1;
    for (label b = 0; b < nBlock; ++b)
    {
        offset[b] = 0;
        for (label d = 0; d < nDim(); ++d)
        {
            const label o = (b/step[d]) % R - (reachStart_ + R - 1);
            offset[b] += o*stride_[d];
            touches[b] = touches[b] && (o == -1 || o == 0);
        }
    }

    // Sides of a node: the cells of each are connected by faces. Those that
    // touch the node are one side, as they share it.
    labelList side(nBlock);
    DynamicList<label> front;
    auto findSides = [&](const label node)
    {
        auto fill = [&](const label b, const label s)
        {
            if (side[b] >= 0 || cellRank_[node + offset[b]] == missing) return;
            side[b] = s;
            front.append(b);
        };
        auto spread = [&](const label s)
        {
            while (front.size())
            {
                const label b = front.remove();
                for (label d = 0; d < nDim(); ++d)
                {
                    const label i = (b/step[d]) % R;
                    if (i > 0) fill(b - step[d], s);
                    if (i < R - 1) fill(b + step[d], s);
                }
            }
        };
        side = -1;
        for (label b = 0; b < nBlock; ++b) if (touches[b]) fill(b, nBlock);
        spread(nBlock);
        for (label b = 0; b < nBlock; ++b)
        {
            fill(b, b);
            spread(b);
        }

        // The first side has the node itself
        label own = -1;
        for (label b = 0; own != nBlock && b < nBlock; ++b)
        {
            if (side[b] >= 0 && (own < 0 || touches[b])) own = side[b];
        }
        for (label& s : side) if (s == own) s = -1;
    };

    bitSet reached(nBoxNodes());
    for (const label cell : boxCell_)
    {
        for (label t = 0; t < nBlock; ++t)
        {
            reached.set(cell + reachOffset() + reachNode(t));
        }
    }
    for (const label node : reached)
    {
        bool wall = false;
        for (label b = 0; !wall && b < nBlock; ++b)
        {
            wall = cellRank_[node + offset[b]] == missing;
        }
        if (!wall) continue;

        findSides(node);
        const label firstOfNode = twinOf_.size();
        for (label b = 0; b < nBlock; ++b)
        {
            if (side[b] < 0 || !ownCell(node + offset[b])) continue;

            const Pair<label> twin(node, side[b]);
            label i = twinOf_.size();
            while (i > firstOfNode && twinOf_[i - 1] != twin) --i;
            if (i == firstOfNode)
            {
                twinOf_.append(twin);
                i = twinOf_.size();
            }
            // The node is that much before the last in reach of the cell
            twin_.set
            (
                int64_t(nBlock)*(node + offset[b]) + nBlock - 1 - b,
                nBoxNodes() + i - 1
            );
        }
    }

    // Twins are no cells
    meshCell_.setSize(nNodes(), -1);
    cellRank_.setSize(nNodes(), missing);
}


Foam::mpm::backgroundGrid::platedRecords
Foam::mpm::backgroundGrid::findPlated()
{
    platedRecords found;
    found.nodes.reserve(plated_.nodes.size());
    found.cells.reserve(plated_.cells.size());
    const scalar h = lattice_->minSpacing();
    const scalar far = platedReach*h;
    const scalar near = 2*h;
    nodeView_.resize(nFirst(), plate::none);
    nodePlate_.resize(nBoxNodes(), -1);
    point place(Zero);
    if (nDim() == 2) place[lattice_->axis(2)] = lattice_->midPlane();

    // Call op(node, its place in coordinates of the plate) for what is around
    // one, so much farther [nodes]
    auto forRange = [&](const plate& thin, const label more, const auto& op)
    {
        const boundBox bounds(thin.bounds());
        index3 first, last, i;
        first = 0;
        last = 0;
        for (label d = 0; d < nDim(); ++d)
        {
            const label axis = lattice_->axis(d);
            const scalar from = bounds.min()[axis] - far;
            const scalar to = bounds.max()[axis] + far;
            first[d] = max
            (
                label(0), lattice_->cellCoordinate(d, from) - lower_[d] - more
            );
            last[d] = min
            (
                nNodes_[d] - 1,
                lattice_->cellCoordinate(d, to) - lower_[d] + 1 + more
            );
            if (first[d] > last[d]) return;
        }
        point x(place);
        for (i[2] = first[2]; i[2] <= last[2]; ++i[2])
        for (i[1] = first[1]; i[1] <= last[1]; ++i[1])
        for (i[0] = first[0]; i[0] <= last[0]; ++i[0])
        {
            for (label d = 0; d < nDim(); ++d)
            {
                // As nodePosition()
                x[lattice_->axis(d)] = lattice_->origin(d)
                  + (i[d] + lower_[d])*lattice_->spacing(d);
            }
            op(index(i), thin.local(x));
        }
    };

    looked_.clear();
    for (size_t p = 0; p < plates_.size(); ++p)
    {
        const plate& thin = plates_[p];
        looked_.push_back(lookedAt{thin, 0, 0.25*h, 0.25*h});
        lookedAt& looked = looked_.back();
        auto part = [&](const label node, const vector& at)
        {
            looked.radius = max(looked.radius, magSqr(at));
            looked.normal = min(looked.normal, mag(mag(at[2]) - far));
            if (mag(at[2]) > far) return;
            looked.normal = min(looked.normal, mag(at[2] + thin.skin()));
            looked.along =
                min(looked.along, mag(thin.depthAt(at) - thin.skin()));
            if (nodeView_[node] != plate::none) return;
            const label own = thin.viewOf(at);
            if (own == plate::none) return;
            nodeView_[node] = own;
            nodePlate_[boxNode(node)] = label(p);
            found.nodes.emplace_back(node, own);
        };
        forRange(thin, 1, part);
        for (label i = nBoxNodes(); i < nFirst(); ++i)
        {
            part(i, thin.local(nodePosition(i)));
        }
        looked.radius = std::sqrt(looked.radius) + h;
    }
    std::sort(found.nodes.begin(), found.nodes.end());

    // Cells that reach nodes of both sides, or are near
    const label farthest = max(-reachStart_, reachStart_ + reachWidth_ - 1);
    for (lookedAt& looked : looked_)
    {
        // By the height of their lower corner
        const plate& thin = looked.where;
        const vector n(cmptMag(thin.normal()));
        const scalar both =
            max(near, 1.001*farthest*h*(n.x() + n.y() + n.z()));
        auto add = [&](const label cell, const vector& at)
        {
            looked.normal = min(looked.normal, mag(mag(at[2]) - near));
            if (mag(at[2]) > both || !ownCell(cell)) return;
            label p = -1;
            bool sides[3] = {false, false, false};
            for (label t = 0; t < reachSize(); ++t)
            {
                const label node = cell + reachOffset() + reachNode(t);
                if (nodePlate_[node] >= 0) p = nodePlate_[node];
                sides[nodeView_[node]] = true;
            }
            if
            (
                (sides[plate::front] && sides[plate::back])
             || (p >= 0 && mag(plates_[p].height(nodePosition(cell))) < near)
            )
            {
                found.cells.emplace_back(cell, p);
            }
        };
        forRange(thin, reachWidth_, add);
    }
    std::sort(found.cells.begin(), found.cells.end());
    found.cells.erase
    (
        std::unique(found.cells.begin(), found.cells.end()), found.cells.end()
    );

    for (const auto& node : found.nodes)
    {
        nodeView_[node.first] = plate::none;
        nodePlate_[boxNode(node.first)] = -1;
    }
    return found;
}


void Foam::mpm::backgroundGrid::findSeconds()
{
    plated_ = platedRecords();
    second_.clear();
    ownView_.clear();
    firstOf_.clear();
    plateOf_.clear();
    nodeView_.clear();
    nodePlate_.clear();
    if (!plated()) return;

    plated_ = findPlated();
    second_.setSize(nFirst(), -1);
    ownView_.setSize(nFirst(), plate::none);
    const label nFirst = this->nFirst();
    labelList firsts(label(plated_.nodes.size()));
    forAll(firsts, i)
    {
        const auto& node = plated_.nodes[i];
        firsts[i] = node.first;
        second_[node.first] = nFirst + i;
        ownView_[node.first] = node.second;
    }
    firstOf_.transfer(firsts);
    plateOf_.setSize(nBoxNodes(), -1);
    for (const auto& cell : plated_.cells) plateOf_[cell.first] = cell.second;

    // Nor are seconds cells
    meshCell_.setSize(nNodes(), -1);
    cellRank_.setSize(nNodes(), missing);
}


void Foam::mpm::backgroundGrid::buildExchange()
{
    // Candidates of one rank are images in cyclic directions
    bool copies = Pstream::parRun();
    for (label d = 0; d < nDim(); ++d)
    {
        copies = copies || lattice_->periodic(d);
    }

    // Nodes in reach of own cells, and their neighbours
    bitSet used(nBoxNodes());
    const label lo = min(reachStart_, label(0)) - 1;
    const label hi = max(reachStart_ + reachWidth_ - 1, label(1)) + 1;
    const bool is3D = nDim() == 3;

    for (label celli = 0; copies && celli < boxCell_.size(); ++celli)
    {
        for (label k = (is3D ? lo : 0); k <= (is3D ? hi : 0); ++k)
        for (label j = lo; j <= hi; ++j)
        for (label i = lo; i <= hi; ++i)
        {
            used.set(boxCell_[celli] + i + j*stride_[1] + k*stride_[2]);
        }
    }

    // The same on each rank, with room for the ghost nodes outside of the
    // lattice
    int64_t nIds = 1;
    for (label d = 0; d < nDim(); ++d)
    {
        nIds *= lattice_->nCells(d) + 2*margin + 2;
    }
    auto globalId = [&](const label node)
    {
        const index3 i = coordinate(node);
        int64_t id = 0;
        for (label d = nDim() - 1; d >= 0; --d)
        {
            label g = i[d] + lower_[d];
            const label n = lattice_->nCells(d);
            if (lattice_->periodic(d)) g = ((g % n) + n) % n;
            id = id*(n + 2*margin + 2) + (g + margin);
        }
        return id;
    };

    // Twins follow each other by node
    Map<label> firstTwin;
    forAll(twinOf_, i) firstTwin.insert(twinOf_[i].first(), i);

    // Only those can have copies that lie in the box of another rank, or in
    // another place of the own one
    std::vector<std::vector<nodeExchange::candidate>>
        candidates(neighbours_->size());
    const label own = neighbours_->place(Pstream::myProcNo());
    forAll(neighbours_->ranks(), r)
    {
        neighbours_->forShared
        (
            r,
            [&](const label node, const label theirs)
            {
                if (!used[node] || (r == own && node == theirs)) return;
                const int64_t id = globalId(node);
                const int64_t nSides = reachSize() + 2;
                auto add = [&](const int64_t side, const label copy)
                {
                    candidates[r].push_back({id + nIds*side, copy});
                    if (plated() && second_[copy] >= 0)
                    {
                        candidates[r].push_back
                            ({id + nIds*(nSides + side), second_[copy]});
                    }
                };
                add(0, node);

                label i = firstTwin.lookup(node, twinOf_.size());
                for (; i < twinOf_.size() && twinOf_[i].first() == node; ++i)
                {
                    add(1 + int64_t(twinOf_[i].second()), nBoxNodes() + i);
                }
            }
        );
    }
    exchange_.reset(new nodeExchange(*neighbours_, candidates));

    if (!exchange_->idle())
    {
        share_.assign(nNodes(), 1);
        exchange_->sum(share_);
        for (scalar& copies : share_) copies = 1/copies;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::backgroundGrid::backgroundGrid
(
    const polyMesh& mesh,
    const dictionary& mpmDict
)
:
    mesh_(mesh)
{
    selectShapeFunction(mpmDict);
    rebuild();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::backgroundGrid::rebuild()
{
    meshCell_.clear();
    cellRank_.clear();
    twin_.clear();
    twinOf_.clear();
    share_.clear();

    lattice_.reset(new lattice(mesh_));
    buildBox();
    exchangeCellOwners();
    checkWallThickness();
    findTwins();
    findSeconds();
    buildExchange();
    cellsKept_ = false;
}


void Foam::mpm::backgroundGrid::renewRecords()
{
    share_.clear();
    findSeconds();
    buildExchange();
    cellsKept_ = true;
}


void Foam::mpm::backgroundGrid::setPlates(const std::vector<plate>& plates)
{
    plates_ = plates;
}


bool Foam::mpm::backgroundGrid::recordsStale()
{
    // Most steps are too short for that. What goes along itself on the grid, as
    // gates do, keeps nodes that are exactly as high as it is asked for
    bool moved = looked_.size() != plates_.size();
    for (size_t p = 0; !moved && p < plates_.size(); ++p)
    {
        const lookedAt& looked = looked_[p];
        const vector change(plates_[p].change(looked.where, looked.radius));
        const scalar rounding = 1e-9*lattice_->minSpacing();
        moved =
            (change[2] > 0 && change[2] + rounding > looked.normal)
         || max(change[0], change[1]) + rounding > looked.along;
    }
    return returnReduce(moved && findPlated() != plated_, orOp<bool>());
}


Foam::boolList Foam::mpm::backgroundGrid::inMesh(const pointField& x) const
{
    boolList in(x.size(), false);
    forAll(x, k)
    {
        index3 i;
        i = 0;
        bool found = true;
        for (label d = 0; d < nDim(); ++d)
        {
            i[d] =
                lattice_->cellCoordinate(d, x[k][lattice_->axis(d)]) - lower_[d];
            found = found && i[d] >= 0 && i[d] < nNodes_[d];
        }
        in[k] = found && ownCell(index(i));
    }
    Pstream::listCombineGather(in, orEqOp<bool>());
    Pstream::listCombineScatter(in);
    return in;
}


Foam::point Foam::mpm::backgroundGrid::nodePosition(const label node) const
{
    const index3 i = coordinate(boxNode(node));
    point x(Zero);
    for (label d = 0; d < nDim(); ++d)
    {
        x[lattice_->axis(d)] =
            lattice_->origin(d) + (i[d] + lower_[d])*lattice_->spacing(d);
    }
    if (nDim() == 2) x[lattice_->axis(2)] = lattice_->midPlane();
    return x;
}


size_t Foam::mpm::backgroundGrid::memory() const
{
    return sizeof(label)
       *size_t
        (
            cellRank_.size() + meshCell_.size() + boxCell_.size()
          + second_.size() + ownView_.size() + firstOf_.size()
          + plateOf_.size() + nodeView_.size() + nodePlate_.size()
          + 2*(plated_.nodes.size() + plated_.cells.size())
        );
}

// ************************************************************************* //
