/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodyNodes.H"
#include "PstreamReduceOps.H"
#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

int64_t Foam::mpm::bodyNodes::nIds() const
{
    int64_t n = 1;
    for (label d = 0; d < grid_.nDim(); ++d) n *= width(d);
    return n;
}


Foam::mpm::index3 Foam::mpm::bodyNodes::coordinateOf(const int64_t id) const
{
    index3 at;
    at = 0;
    int64_t rest = id % nIds();
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        at[d] = label(rest % width(d)) - backgroundGrid::margin;
        rest /= width(d);
    }
    return at;
}


Foam::point Foam::mpm::bodyNodes::positionOf(const index3& at) const
{
    const lattice& cells = grid_.cells();
    point x(Zero);
    for (label d = 0; d < cells.nDim(); ++d)
    {
        x[cells.axis(d)] = cells.origin(d) + at[d]*cells.spacing(d);
    }
    if (cells.nDim() == 2) x[cells.axis(2)] = cells.midPlane();
    return x;
}


const Foam::mpm::plate* Foam::mpm::bodyNodes::plateAt
(
    const label number
) const
{
    return bodies_[nodes_[number].body].thinPlate();
}


int64_t Foam::mpm::bodyNodes::globalId
(
    const index3& at,
    const bool second
) const
{
    const lattice& cells = grid_.cells();
    int64_t id = second ? 1 : 0;
    for (label d = cells.nDim() - 1; d >= 0; --d)
    {
        const label n = cells.nCells(d);
        label i = at[d];
        if (cells.periodic(d)) i = ((i % n) + n) % n;
        id = id*width(d) + i + backgroundGrid::margin;
    }
    return id;
}


bool Foam::mpm::bodyNodes::range
(
    const body& b,
    index3& first,
    index3& last
) const
{
    const lattice& cells = grid_.cells();
    const boundBox bounds(b.reachedBounds(cells.minSpacing()));
    first = 0;
    last = 0;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        first[d] = max
        (
            label(0),
            cells.cellCoordinate(d, bounds.min()[axis]) - grid_.lower(d)
        );
        last[d] = min
        (
            grid_.nNodes(d) - 1,
            cells.cellCoordinate(d, bounds.max()[axis]) - grid_.lower(d) + 1
        );
        if (first[d] > last[d]) return false;
    }
    return true;
}


bool Foam::mpm::bodyNodes::findIds(const std::vector<scalar>& inverseVolume)
{
    const scalar far = body::reach*grid_.cells().minSpacing();

    // Of this rank, each copy once
    std::vector<std::pair<int64_t, label>> own;
    own.reserve(own_.size());
    for (label b = 0; b < bodies_.size(); ++b)
    {
        index3 first, last;
        if (!range(bodies_[b], first, last)) continue;
        index3 i;
        for (i[2] = first[2]; i[2] <= last[2]; ++i[2])
        for (i[1] = first[1]; i[1] <= last[1]; ++i[1])
        for (i[0] = first[0]; i[0] <= last[0]; ++i[0])
        {
            const label node = grid_.index(i);
            if (!(inverseVolume[node] > 0)) continue;
            index3 at;
            at = 0;
            for (label d = 0; d < grid_.nDim(); ++d)
            {
                at[d] = i[d] + grid_.lower(d);
            }
            if (!(mag(bodies_[b].distance(positionOf(at))) < far)) continue;
            own.emplace_back(globalId(at), node);

            const label second = bodies_[b].thinPlate()
              ? grid_.second(node) : -1;
            if (second >= 0) own.emplace_back(globalId(at, true), second);
        }
    }
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());

    const bool others = returnReduce(own != own_, orOp<bool>());
    own_.swap(own);
    return others;
}


void Foam::mpm::bodyNodes::number(const std::vector<scalar>& inverseVolume)
{
    for (const local& l : local_) numberOf_[l.grid] = -1;
    local_.clear();
    id_.clear();
    number_.clear();

    // Nodes that no own cell reaches, only its neighbours', may have values that
    // another rank knows better
    auto reached = [&](const label node)
    {
        const label first = grid_.boxNode(node) - grid_.reachOffset();
        for (label t = 0; Pstream::parRun() && t < grid_.reachSize(); ++t)
        {
            const label cell = first - grid_.reachNode(t);
            if (cell >= 0 && cell < grid_.nBoxNodes() && grid_.ownCell(cell))
            {
                return true;
            }
        }
        return !Pstream::parRun();
    };

    // Of all ranks; the first one that reaches a node gives it
    List<List<int64_t>> ids(Pstream::nProcs());
    DynamicList<int64_t> mine;
    for (const auto& o : own_)
    {
        if (reached(o.second)) mine.append(o.first);
    }
    ids[Pstream::myProcNo()] = mine;
    Pstream::gatherList(ids);
    Pstream::scatterList(ids);

    std::unordered_map<int64_t, label> giver;
    forAll(ids, rank)
    {
        for (const int64_t id : ids[rank])
        {
            if (giver.emplace(id, rank).second) id_.push_back(id);
        }
    }
    std::sort(id_.begin(), id_.end());
    number_.reserve(id_.size());
    for (size_t i = 0; i < id_.size(); ++i) number_[id_[i]] = label(i);

    nodes_.resize(id_.size());
    std::vector<scalar> inverse(nodes_.size(), 0);
    int64_t last = -1;
    for (const auto& o : own_)
    {
        const label k = number_[o.first];
        numberOf_[o.second] = k;
        const bool gives =
            o.first != last && giver[o.first] == Pstream::myProcNo()
         && reached(o.second);
        if (gives) last = o.first;
        local_.push_back(local{o.second, k, gives});
        if (gives) inverse[k] = inverseVolume[o.second];
    }
    sum(inverse);
    for (size_t k = 0; k < nodes_.size(); ++k)
    {
        nodes_[k].x = positionOf(coordinateOf(id_[k]));
        nodes_[k].inverseVolume = inverse[k];
        nodes_[k].free = vector::one;
        nodes_[k].given = Zero;
    }
}


void Foam::mpm::bodyNodes::measure()
{
    const lattice& cells = grid_.cells();
    const scalar h = cells.minSpacing();

    // How far the function of a node reaches
    vector support(Zero);
    for (label d = 0; d < cells.nDim(); ++d)
    {
        support[cells.axis(d)] = 0.5*grid_.tileWidth()*cells.spacing(d);
    }
    for (size_t k = 0; k < nodes_.size(); ++k)
    {
        node& n = nodes_[k];
        n.body = bodies_.nearest(n.x, n.phi);
        const plate* thin = bodies_[n.body].thinPlate();
        if (!thin)
        {
            const vector g(bodies_[n.body].gradient(n.x, h));
            n.smooth = magSqr(g) > 0.94;
            n.faced = true;
            n.view = plate::none;

            // In the middle of a body there is no nearest point of the surface
            const vector fine(bodies_[n.body].gradient(n.x, 0.5*h));
            const vector& longer = mag(fine) > mag(g) ? fine : g;
            n.n = mag(longer) > SMALL ? longer/mag(longer) : vector(Zero);
            n.buried = false;
            continue;
        }
        n.smooth = thin->smooth(n.x, h);
        n.view = thin->viewAt(n.x);
        if (id_[k] < nIds())
        {
            const plate::surface near(thin->nearest(n.x));
            n.n = near.normal;
            n.faced = near.face;
        }
        else
        {
            // Behind the face of the other side
            n.phi = -mag(thin->height(n.x)) - 0.5*thin->thickness();
            n.n = (n.view == plate::front ? -1 : 1)*thin->normal();
            n.view = plate::front + plate::back - n.view;
            n.faced = true;
        }
        n.buried = thin->hides(n.x, n.view, support);
    }
}


//- A cell in parts, for integrals with the functions of the nodes in its reach
class Foam::mpm::bodyNodes::dividedCell
{
    const backgroundGrid& grid_;
    const label n_;

    //- Weights at the middles of the parts, the same in each cell
    struct weights { scalar of[4]; };
    std::vector<weights> w_;

    index3 coordinate(const label sub) const
    {
        index3 s;
        label rest = sub;
        for (label d = 0; d < 3; ++d)
        {
            s[d] = d < grid_.nDim() ? rest % n_ : 0;
            rest /= n_;
        }
        return s;
    }

public:

    dividedCell(const backgroundGrid& grid, const label n)
    :
        grid_(grid),
        n_(n),
        w_(n)
    {
        scalar unused[4];
        for (label s = 0; s < n; ++s)
        {
            reachWeights(grid, (s + 0.5)/n, w_[s].of, unused);
        }
    }

    label size() const { return grid_.nDim() == 3 ? n_*n_*n_ : n_*n_; }

    //- Middle of a part, from the lower corner of the cell
    point position(const point& corner, const label sub) const
    {
        const lattice& cells = grid_.cells();
        const index3 s = coordinate(sub);
        point x(corner);
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            x[cells.axis(d)] += (s[d] + 0.5)/n_*cells.spacing(d);
        }
        return x;
    }

    //- Moments by node in reach of volumes by part: direction by direction
    void findMoments
    (
        const std::vector<scalar>& volume,
        std::vector<moments>& m
    ) const
    {
        const label T = grid_.reachWidth();
        const label nz = grid_.nDim() == 3 ? n_ : 1;

        // Along x: by power of the coordinate, node, and row of parts
        scalar ofRow[3][4], ofLayer[6][16];
        std::fill(m.begin(), m.end(), moments());
        for (label k = 0; k < nz; ++k)
        {
            // Powers along x and y: 00, 10, 20, 01, 11, 02
            std::fill(&ofLayer[0][0], &ofLayer[0][0] + 6*16, scalar(0));
            for (label j = 0; j < n_; ++j)
            {
                std::fill(&ofRow[0][0], &ofRow[0][0] + 3*4, scalar(0));
                bool any = false;
                for (label i = 0; i < n_; ++i)
                {
                    scalar v = volume[i + n_*(j + n_*k)];
                    if (!(v > 0)) continue;
                    any = true;
                    const scalar x = (i + 0.5)/n_;
                    for (label power = 0; power < 3; ++power, v *= x)
                    {
                        for (label t = 0; t < T; ++t)
                        {
                            ofRow[power][t] += v*w_[i].of[t];
                        }
                    }
                }
                if (!any) continue;
                const scalar y = (j + 0.5)/n_;
                for (label u = 0; u < T; ++u)
                for (label t = 0; t < T; ++t)
                {
                    const scalar w = w_[j].of[u];
                    const label at = t + T*u;
                    ofLayer[0][at] += w*ofRow[0][t];
                    ofLayer[1][at] += w*ofRow[1][t];
                    ofLayer[2][at] += w*ofRow[2][t];
                    ofLayer[3][at] += w*y*ofRow[0][t];
                    ofLayer[4][at] += w*y*ofRow[1][t];
                    ofLayer[5][at] += w*y*y*ofRow[0][t];
                }
            }
            const bool is3D = nz > 1;
            const scalar z = is3D ? (k + 0.5)/n_ : 0;
            for (size_t t = 0; t < m.size(); ++t)
            {
                const label at = label(t) % (T*T);
                const scalar w = is3D ? w_[k].of[label(t)/(T*T)] : 1;
                const scalar V = w*ofLayer[0][at];
                const scalar x = w*ofLayer[1][at], y = w*ofLayer[3][at];
                const scalar xy = w*ofLayer[4][at];
                m[t].V += V;
                m[t].first += vector(x, y, z*V);
                m[t].second += tensor
                (
                    w*ofLayer[2][at], xy, z*x,
                    xy, w*ofLayer[5][at], z*y,
                    z*x, z*y, z*z*V
                );
            }
        }
    }

    //- Add a volume in a part, by node in reach
    void add
    (
        std::vector<moments>& m,
        const label sub,
        const scalar volume
    ) const
    {
        const label T = grid_.reachWidth();
        const index3 s = coordinate(sub);
        vector y(Zero);
        for (label d = 0; d < grid_.nDim(); ++d) y[d] = (s[d] + 0.5)/n_;
        const tensor yy(y*y);
        for (size_t t = 0; t < m.size(); ++t)
        {
            const label i = label(t);
            scalar w = volume*w_[s[0]].of[i % T]*w_[s[1]].of[(i/T) % T];
            if (grid_.nDim() == 3) w *= w_[s[2]].of[i/(T*T)];
            m[t].V += w;
            m[t].first += w*y;
            m[t].second += w*yy;
        }
    }
};


void Foam::mpm::bodyNodes::addFolded
(
    const label cell,
    const index3& coordinate,
    const label t,
    const label k,
    const moments& m,
    const nodeFolding& folding,
    std::vector<scalar>& sums
) const
{
    const lattice& cells = grid_.cells();
    const label nDim = cells.nDim();
    const label s = folding.stencil(cell);

    // x_I of the node in reach, and of its target, from the corner
    vector reached(Zero), own(Zero), scale(Zero), sign(Zero);
    label rest = t;
    for (label d = 0; d < nDim; ++d)
    {
        reached[d] = grid_.reachStart() + rest % grid_.reachWidth();
        rest /= grid_.reachWidth();
    }
    own = reached;
    if (s >= 0)
    {
        const index3 target = grid_.coordinate(folding.targets(s)[t]);
        for (label d = 0; d < nDim; ++d) own[d] = target[d] - coordinate[d];
    }
    for (label d = 0; d < nDim; ++d)
    {
        sign[d] = s < 0 ? 1 : folding.signs(s)[t][d];
        scale[d] = sign[d]/(grid_.secondMoment()*cells.spacing(d));
    }
    scalar* sum = sums.data() + size_t(k)*16;
    sum[0] += m.V;
    for (label c = 0; c < nDim; ++c)
    {
        sum[13 + cells.axis(c)] += sign[c]*m.V;
        sum[1 + cells.axis(c)] += scale[c]*(m.V*reached[c] - m.first[c]);
        for (label d = 0; d < nDim; ++d)
        {
            // int N (x_I - x)_c (x_J - x)_d
            const scalar product =
                m.V*reached[c]*own[d]
              - reached[c]*m.first[d]
              - own[d]*m.first[c]
              + m.second[3*c + d];
            sum[4 + 3*cells.axis(c) + cells.axis(d)] +=
                scale[c]*cells.spacing(d)*product;
        }
    }
}


template<class Op>
void Foam::mpm::bodyNodes::forCells(const body& b, const Op& op) const
{
    const lattice& cells = grid_.cells();
    index3 first, last, i;
    if (!range(b, first, last)) return;
    for (i[2] = first[2]; i[2] <= last[2]; ++i[2])
    for (i[1] = first[1]; i[1] <= last[1]; ++i[1])
    for (i[0] = first[0]; i[0] <= last[0]; ++i[0])
    {
        const label cell = grid_.index(i);
        if (!grid_.ownCell(cell)) continue;

        const point corner(grid_.nodePosition(cell));
        point middle(corner);
        for (label d = 0; d < cells.nDim(); ++d)
        {
            middle[cells.axis(d)] += 0.5*cells.spacing(d);
        }
        op(cell, i, corner, middle);
    }
}


void Foam::mpm::bodyNodes::integrateClosed
(
    const body& b,
    const nodeFolding& folding,
    std::vector<scalar>& sums
)
{
    const lattice& cells = grid_.cells();
    const label size = grid_.reachSize();
    const scalar h = cells.minSpacing();
    const scalar diagonal = 0.5*std::sqrt(scalar(cells.nDim()))*h;

    constexpr label nSub = 4;
    const dividedCell divided(grid_, nSub);
    const label nSubs = divided.size();
    const scalar dV = cells.cellVolume()/nSubs;
    std::vector<moments> full(size), cut(size);
    for (label sub = 0; sub < nSubs; ++sub) divided.add(full, sub, dV);

    forCells
    (
        b,
        [&]
        (
            const label cell,
            const index3& coordinate,
            const point& corner,
            const point& middle
        )
        {
            const scalar phi = b.distance(middle);
            if (phi < h + diagonal) nearCells_.set(cell);

            // The samples end somewhere in the middle of nowhere
            if (!(phi < diagonal + h/nSub)) return;
            const moments* m = full.data();
            if (!(phi < -diagonal - h/nSub))
            {
                std::fill(cut.begin(), cut.end(), moments());
                for (label sub = 0; sub < nSubs; ++sub)
                {
                    const point x(divided.position(corner, sub));
                    const scalar part = min
                    (
                        scalar(1),
                        max(scalar(0), 0.5 - nSub*b.distance(x)/h)
                    );
                    if (part > 0) divided.add(cut, sub, part*dV);
                }
                m = cut.data();
            }

            const label s = folding.stencil(cell);
            for (label t = 0; t < size; ++t)
            {
                if (!(m[t].V > 0)) continue;
                const label ghost =
                    cell + grid_.reachOffset() + grid_.reachNode(t);
                const label target = s < 0 ? ghost : folding.targets(s)[t];
                const label k = target < numberOf_.size()
                  ? numberOf_[target] : -1;
                if (k < 0) continue;
                addFolded(cell, coordinate, t, k, m[t], folding, sums);
            }
        }
    );
}


void Foam::mpm::bodyNodes::integratePlate
(
    const body& b,
    const nodeFolding& folding,
    std::vector<scalar>& sums
)
{
    const lattice& cells = grid_.cells();
    const label nDim = cells.nDim();
    const label size = grid_.reachSize();
    const scalar h = cells.minSpacing();
    const scalar diagonal = 0.5*std::sqrt(scalar(nDim))*h;
    const plate& thin = *b.thinPlate();

    // Coarser where that has to be done in each step
    const label nSub = (nDim == 3 ? 8 : 16)/(b.motion().moves() ? 2 : 1);
    const dividedCell divided(grid_, nSub);
    const label nSubs = divided.size();
    const scalar dV = cells.cellVolume()/nSubs;

    // Parts of a cell: of each view, and last in the plate; where they are from
    // the corner, the same in all cells
    constexpr label inPlate = 3;
    std::vector<vector> offset(nSubs);
    for (label sub = 0; sub < nSubs; ++sub)
    {
        offset[sub] = thin.components(divided.position(Zero, sub));
    }
    std::vector<moments> full(size), cut[4];
    std::vector<scalar> volume[4];
    for (label part = 0; part < 4; ++part)
    {
        volume[part].assign(nSubs, dV);
        cut[part].resize(size);
    }
    divided.findMoments(volume[0], full);

    forCells
    (
        b,
        [&]
        (
            const label cell,
            const index3& coordinate,
            const point& corner,
            const point& middle
        )
        {
            // No node in its reach knows of the plate
            const vector at(thin.local(middle));
            if (thin.farther(at, (body::reach + 2)*h + diagonal)) return;

            if (grid_.plateOf(cell) >= 0 || b.distance(middle) < h + diagonal)
            {
                nearCells_.set(cell);
            }

            // Wholly of one of them, or divided
            const moments* of[4] = {nullptr, nullptr, nullptr, nullptr};
            const FixedList<scalar, 4> whole
            (
                thin.parts(at, 2*diagonal + h/nSub)
            );
            bool isCut = true;
            for (label part = 0; part < 4; ++part)
            {
                if (whole[part] < 1) continue;
                of[part] = full.data();
                isCut = false;
            }
            if (isCut)
            {
                const vector first(thin.local(corner));
                bool any[4] = {false, false, false, false};

                const bool between = thin.depthAt(at) > 2*diagonal + h/nSub;
                for (label sub = 0; sub < nSubs; ++sub)
                {
                    const vector place(first + offset[sub]);
                    const FixedList<scalar, 4> parts
                    (
                        between
                      ? thin.partsBetweenEdges(place[2], h/nSub)
                      : thin.parts(place, h/nSub)
                    );
                    for (label part = 0; part < 4; ++part)
                    {
                        volume[part][sub] = parts[part]*dV;
                        any[part] = any[part] || parts[part] > 0;
                    }
                }
                for (label part = 0; part < 4; ++part)
                {
                    if (!any[part]) continue;
                    divided.findMoments(volume[part], cut[part]);
                    of[part] = cut[part].data();
                }
            }

            const label s = folding.stencil(cell);
            for (label t = 0; t < size; ++t)
            {
                const label node =
                    s < 0
                  ? cell + grid_.reachOffset() + grid_.reachNode(t)
                  : folding.targets(s)[t];
                for (const label record : {node, grid_.second(node)})
                {
                    const label k = record < 0 ? -1 : numberOf_[record];
                    if (k < 0 || nodes_[k].buried) continue;
                    const label view = grid_.viewOf(record);
                    moments unseen;
                    for (label part = 0; part < 4; ++part)
                    {
                        const bool sees =
                            part == plate::none ? record == node
                          : part == inPlate ? false
                          : view == plate::none || view == part;
                        if (of[part] && !sees) unseen += of[part][t];
                    }
                    if (!(unseen.V > 0)) continue;
                    addFolded(cell, coordinate, t, k, unseen, folding, sums);
                }
            }
        }
    );
}


void Foam::mpm::bodyNodes::integrate(const nodeFolding& folding)
{
    std::vector<scalar> sums(nodes_.size()*16, 0);
    nearCells_.reset();
    nearCells_.resize(grid_.nBoxNodes());
    for (label i = 0; i < bodies_.size(); ++i)
    {
        const body& b = bodies_[i];
        if (b.thinPlate()) integratePlate(b, folding, sums);
        else integrateClosed(b, folding, sums);
    }
    sum(sums);
    for (size_t k = 0; k < nodes_.size(); ++k)
    {
        const scalar* s = sums.data() + k*16;
        nodes_[k].V =
            nodes_[k].buried && nodes_[k].inverseVolume > 0
          ? 1/nodes_[k].inverseVolume : s[0];
        nodes_[k].A = vector(s[1], s[2], s[3]);
        for (label c = 0; c < 9; ++c) nodes_[k].T[c] = s[4 + c];
        nodes_[k].W = vector(s[13], s[14], s[15]);
    }
}


void Foam::mpm::bodyNodes::findNeighbours()
{
    const lattice& cells = grid_.cells();
    const bool is3D = cells.nDim() == 3;
    neighbours_.clear();
    neighbours_.reserve(size_t(size())*nNeighbours());
    for (label number = 0; number < size(); ++number)
    {
        const int64_t id = id_[number];
        const index3 at(coordinateOf(id));

        // What it sees beside a plate: its own side
        const plate* thin = plateAt(number);
        const label view = nodes_[number].view;
        for (label k = (is3D ? -1 : 0); k <= (is3D ? 1 : 0); ++k)
        for (label j = -1; j <= 1; ++j)
        for (label i = -1; i <= 1; ++i)
        {
            if (!i && !j && !k) continue;
            const index3 o{i, j, k};
            index3 there;
            there = 0;
            bool inside = true;
            for (label d = 0; d < cells.nDim(); ++d)
            {
                there[d] = at[d] + o[d];
                inside = inside
                 && (
                        cells.periodic(d)
                     || (
                            there[d] >= -backgroundGrid::margin
                         && there[d] <= cells.nCells(d) + backgroundGrid::margin
                        )
                    );
            }
            const label ofThere =
                view == plate::none
              ? label(plate::none) : thin->viewAt(positionOf(there));
            const bool across = ofThere != plate::none && ofThere != view;
            const auto found =
                inside ? number_.find(globalId(there, across)) : number_.end();
            neighbours_.push_back
                (found == number_.end() ? -1 : found->second);
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bodyNodes::bodyNodes
(
    const backgroundGrid& grid,
    const bodies& all
)
:
    grid_(grid),
    bodies_(all)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::bodyNodes::build
(
    const nodeFolding& folding,
    const std::vector<scalar>& inverseVolume,
    const bool renewed
)
{
    if (numberOf_.size() != grid_.nNodes())
    {
        local_.clear();
        numberOf_.setSize(grid_.nNodes());
        numberOf_ = -1;
    }

    // Bodies move between the same nodes for many steps
    const bool others = findIds(inverseVolume) || renewed;
    if (others) number(inverseVolume);
    measure();
    if (others) findNeighbours();
    integrate(folding);
    return others;
}


void Foam::mpm::bodyNodes::gather
(
    const nodeField<nodeVector>& field,
    const label nScalars,
    std::vector<vector>& v,
    std::vector<scalar>& w
) const
{
    const lattice& cells = grid_.cells();
    v.assign(size(), Zero);
    if (nScalars) w.resize(size());
    if (!Pstream::parRun())
    {
        for (const local& l : local_)
        {
            if (!l.gives) continue;
            const nodeVector& value = field[l.grid];
            for (label d = 0; d < cells.nDim(); ++d)
            {
                v[l.number][cells.axis(d)] = value[d];
            }
            if (nScalars) w[l.number] = value[cells.nDim()];
        }
        return;
    }
    const label n = cells.nDim() + nScalars;
    std::vector<scalar> values(size_t(n)*size(), 0);
    for (const local& l : local_)
    {
        if (!l.gives) continue;
        for (label d = 0; d < n; ++d)
        {
            values[size_t(l.number)*n + d] = field[l.grid][d];
        }
    }
    sum(values);
    for (label k = 0; k < size(); ++k)
    {
        const scalar* value = values.data() + size_t(k)*n;
        for (label d = 0; d < cells.nDim(); ++d) v[k][cells.axis(d)] = value[d];
        if (nScalars) w[k] = value[cells.nDim()];
    }
}


void Foam::mpm::bodyNodes::sum(std::vector<scalar>& values)
{
    if (!Pstream::parRun() || values.empty()) return;
    List<scalar> all(label(values.size()));
    std::copy(values.begin(), values.end(), all.begin());
    Pstream::listCombineGather(all, plusEqOp<scalar>());
    Pstream::listCombineScatter(all);
    std::copy(all.begin(), all.end(), values.begin());
}


void Foam::mpm::bodyNodes::scatter
(
    const std::vector<vector>& v,
    nodeField<nodeVector>& field
) const
{
    const lattice& cells = grid_.cells();
    for (const local& l : local_)
    {
        for (label d = 0; d < cells.nDim(); ++d)
        {
            field[l.grid][d] = v[l.number][cells.axis(d)];
        }
    }
}


size_t Foam::mpm::bodyNodes::memory() const
{
    return
        sizeof(node)*nodes_.capacity() + sizeof(int64_t)*id_.capacity()
      + sizeof(local)*local_.capacity()
      + sizeof(label)*(numberOf_.size() + neighbours_.capacity())
      + 40*number_.size() + nearCells_.size()/8;
}

// ************************************************************************* //
