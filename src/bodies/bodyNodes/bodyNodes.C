/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodyNodes.H"
#include "PstreamReduceOps.H"
#include <algorithm>
#include <unordered_map>

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


void Foam::mpm::bodyNodes::follow
(
    const int64_t id,
    int64_t& last,
    index3& at
) const
{
    const int64_t x = at[0] + id - last;
    if (last >= 0 && id >= last && x < width(0) - backgroundGrid::margin)
    {
        at[0] = label(x);
    }
    else at = coordinateOf(id);
    last = id;
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
    const lattice& cells = grid_.cells();
    std::vector<std::pair<int64_t, label>> own, seconds;
    own.reserve(own_.size());
    point x(positionOf(index3(label(0))));
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
                x[cells.axis(d)] = cells.origin(d) + at[d]*cells.spacing(d);
            }
            if (!(mag(bodies_[b].distance(x)) < far)) continue;
            own.emplace_back(globalId(at), node);

            const label second = bodies_[b].thinPlate()
              ? grid_.second(node) : -1;
            if (second >= 0) seconds.emplace_back(globalId(at, true), second);
        }
    }
    own.insert(own.end(), seconds.begin(), seconds.end());
    if (!std::is_sorted(own.begin(), own.end()))
    {
        std::sort(own.begin(), own.end());
    }
    own.erase(std::unique(own.begin(), own.end()), own.end());

    const bool others = returnReduce(own != own_, orOp<bool>());
    own_.swap(own);
    return others;
}


Foam::label Foam::mpm::bodyNodes::find(const int64_t id, label& next) const
{
    if (next > 0 && id_[next - 1] >= id)
    {
        next = label(std::lower_bound(id_.begin(), id_.end(), id) - id_.begin());
    }
    while (next < size() && id_[next] < id) ++next;
    return next < size() && id_[next] == id ? next++ : -1;
}


void Foam::mpm::bodyNodes::number(const std::vector<scalar>& inverseVolume)
{
    for (const local& l : local_) numberOf_[l.grid] = -1;
    local_.clear();
    id_.clear();

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
            if (Pstream::parRun()) giver.emplace(id, rank);
            id_.push_back(id);
        }
    }
    std::sort(id_.begin(), id_.end());
    id_.erase(std::unique(id_.begin(), id_.end()), id_.end());

    nodes_.resize(id_.size());
    std::vector<scalar> inverse(nodes_.size(), 0);
    int64_t last = -1;
    label next = 0;
    for (const auto& o : own_)
    {
        // No rank reaches some
        const label k = find(o.first, next);
        if (k < 0) continue;
        numberOf_[o.second] = k;
        const bool gives =
            o.first != last && reached(o.second)
         && (!Pstream::parRun() || giver[o.first] == Pstream::myProcNo());
        if (gives) last = o.first;
        local_.push_back(local{o.second, k, gives});
        if (gives) inverse[k] = inverseVolume[o.second];
    }
    sum(inverse);
    index3 at(label(0));
    int64_t before = -1;
    for (size_t k = 0; k < nodes_.size(); ++k)
    {
        follow(id_[k], before, at);
        nodes_[k].x = positionOf(at);
        nodes_[k].inverseVolume = inverse[k];
        nodes_[k].free = vector::one;
        nodes_[k].given = Zero;
    }
}


void Foam::mpm::bodyNodes::measure()
{
    const lattice& cells = grid_.cells();
    const scalar h = cells.minSpacing();
    const int64_t firsts = nIds();

    // How far the function of a node reaches
    vector support(Zero);
    for (label d = 0; d < cells.nDim(); ++d)
    {
        support[cells.axis(d)] = 0.5*grid_.tileWidth()*cells.spacing(d);
    }
    std::vector<vector> extents(bodies_.size());
    for (label b = 0; b < bodies_.size(); ++b)
    {
        const plate* thin = bodies_[b].thinPlate();
        if (thin) extents[b] = thin->extents(support);
    }
    const bool one = bodies_.size() == 1;
    for (size_t k = 0; k < nodes_.size(); ++k)
    {
        node& n = nodes_[k];
        n.body = one ? 0 : bodies_.nearest(n.x, n.phi);
        const plate* thin = bodies_[n.body].thinPlate();
        if (!thin)
        {
            if (one) n.phi = bodies_[0].distance(n.x);
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
        const vector at(thin->local(n.x));
        n.smooth = thin->depthAt(at) > h;
        n.view = thin->viewOf(at);
        if (id_[k] < firsts)
        {
            const plate::surface near(thin->nearestTo(at));
            n.phi = near.distance;
            n.n = near.normal;
            n.faced = near.face;
        }
        else
        {
            // Behind the face of the other side
            n.phi = -mag(at[2]) - 0.5*thin->thickness();
            n.n = (n.view == plate::front ? -1 : 1)*thin->normal();
            n.view = plate::front + plate::back - n.view;
            n.faced = true;
        }
        n.buried = thin->hides(at, n.view, extents[n.body]);
    }
}


//- A cell in parts, for integrals with the functions of the nodes in its reach
class Foam::mpm::bodyNodes::dividedCell
{
    const backgroundGrid& grid_;
    const label n_;

    //- Middles of the parts and weights there by node, the same in each cell
    std::vector<scalar> middle_;
    std::vector<packed<4>> w_;

public:

    dividedCell(const backgroundGrid& grid, const label n)
    :
        grid_(grid),
        n_(n),
        middle_(n),
        w_(n)
    {
        scalar w[4] = {0, 0, 0, 0}, unused[4];
        for (label s = 0; s < n; ++s)
        {
            middle_[s] = (s + 0.5)/n;
            reachWeights(grid, middle_[s], w, unused);
            w_[s] = packed<4>{w[0], w[1], w[2], w[3]};
        }
    }

    //- Middles of the parts, from the lower corner of the cell
    std::vector<point> positions() const
    {
        const lattice& cells = grid_.cells();
        std::vector<point> all;
        for (label k = 0; k < (grid_.nDim() == 3 ? n_ : 1); ++k)
        for (label j = 0; j < n_; ++j)
        for (label i = 0; i < n_; ++i)
        {
            const index3 part{i, j, k};
            point x(Zero);
            for (label d = 0; d < grid_.nDim(); ++d)
            {
                x[cells.axis(d)] = middle_[part[d]]*cells.spacing(d);
            }
            all.push_back(x);
        }
        return all;
    }

    //- Moments by node in reach of volumes by part: direction by direction
    void findMoments
    (
        const std::vector<scalar>& volume,
        std::vector<moments>& m
    ) const
    {
        const label T = grid_.reachWidth();
        const bool is3D = grid_.nDim() == 3;
        std::fill(m.begin(), m.end(), moments());

        // All nodes along x at once: by power of the coordinate
        packed<4> ofRow[3], ofLayer[6][4];
        const scalar* v = volume.data();
        for (label k = 0; k < (is3D ? n_ : 1); ++k)
        {
            // Powers along x and y: 00, 10, 20, 01, 11, 02
            for (auto& power : ofLayer)
            {
                for (packed<4>& sum : power) sum = packed<4>{};
            }
            for (label j = 0; j < n_; ++j)
            {
                for (packed<4>& sum : ofRow) sum = packed<4>{};
                bool any = false;
                for (label i = 0; i < n_; ++i, ++v)
                {
                    if (!(*v > 0)) continue;
                    any = true;
                    const scalar x = middle_[i];
                    const scalar vx = *v*x;
                    ofRow[0] += *v*w_[i];
                    ofRow[1] += vx*w_[i];
                    ofRow[2] += vx*x*w_[i];
                }
                if (!any) continue;
                const scalar y = middle_[j];
                for (label u = 0; u < T; ++u)
                {
                    const scalar w = w_[j][u];
                    ofLayer[0][u] += w*ofRow[0];
                    ofLayer[1][u] += w*ofRow[1];
                    ofLayer[2][u] += w*ofRow[2];
                    ofLayer[3][u] += w*y*ofRow[0];
                    ofLayer[4][u] += w*y*ofRow[1];
                    ofLayer[5][u] += w*y*y*ofRow[0];
                }
            }
            const scalar z = is3D ? middle_[k] : 0;
            moments* to = m.data();
            for (label c = 0; c < (is3D ? T : 1); ++c)
            for (label u = 0; u < T; ++u)
            for (label t = 0; t < T; ++t, ++to)
            {
                const scalar w = is3D ? w_[k][c] : 1;
                const scalar V = w*ofLayer[0][u][t];
                const scalar x = w*ofLayer[1][u][t], y = w*ofLayer[3][u][t];
                const scalar xy = w*ofLayer[4][u][t];
                *to += moments
                {{
                    V, x, y, z*V,
                    w*ofLayer[2][u][t], xy, z*x,
                    xy, w*ofLayer[5][u][t], z*y,
                    z*x, z*y, z*z*V,
                    V, V, V
                }};
            }
        }
    }
};


Foam::mpm::bodyNodes::moments Foam::mpm::bodyNodes::aboutNode
(
    const moments& m,
    const label t,
    const vector& other
) const
{
    // int N, int N (x_I - x)_c, int N (x_I - x)_c (x_J - x)_d
    const vector& own = reached_[t];
    moments about(m);
    for (label c = 0; c < 3; ++c)
    {
        about.of[1 + c] = m.V()*own[c] - m.of[1 + c];
        for (label d = 0; d < 3; ++d)
        {
            about.of[4 + 3*c + d] =
                m.V()*own[c]*other[d]
              - own[c]*m.of[1 + d]
              - other[d]*m.of[1 + c]
              + m.of[4 + 3*c + d];
        }
    }
    return about;
}


void Foam::mpm::bodyNodes::addFolded
(
    const index3& coordinate,
    const label stencil,
    const label t,
    const label k,
    const moments& m,
    const nodeFolding& folding
)
{
    if (stencil < 0)
    {
        add(k, aboutNode(m, t, reached_[t]));
        return;
    }

    // To the target, with the signs of a vector
    const index3 target = grid_.coordinate(folding.targets(stencil)[t]);
    const nodeVector& signs = folding.signs(stencil)[t];
    vector place(Zero);
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        place[d] = target[d] - coordinate[d];
    }
    moments about(aboutNode(m, t, place));
    for (label c = 0; c < grid_.nDim(); ++c)
    {
        about.of[1 + c] *= signs[c];
        about.of[13 + c] *= signs[c];
        for (label d = 0; d < 3; ++d) about.of[4 + 3*c + d] *= signs[c];
    }
    add(k, about);
}


template<class Op>
void Foam::mpm::bodyNodes::forCells(const body& b, const Op& op) const
{
    const lattice& cells = grid_.cells();
    index3 first, last, i;
    if (!range(b, first, last)) return;
    point corner(positionOf(index3(label(0)))), middle(corner);
    for (i[2] = first[2]; i[2] <= last[2]; ++i[2])
    for (i[1] = first[1]; i[1] <= last[1]; ++i[1])
    for (i[0] = first[0]; i[0] <= last[0]; ++i[0])
    {
        const label cell = grid_.index(i);
        if (!grid_.ownCell(cell)) continue;

        for (label d = 0; d < cells.nDim(); ++d)
        {
            const label axis = cells.axis(d);
            corner[axis] =
                cells.origin(d) + (i[d] + grid_.lower(d))*cells.spacing(d);
            middle[axis] = corner[axis] + 0.5*cells.spacing(d);
        }
        op(cell, i, corner, middle);
    }
}


void Foam::mpm::bodyNodes::integrateClosed
(
    const body& b,
    const nodeFolding& folding
)
{
    const lattice& cells = grid_.cells();
    const label size = grid_.reachSize();
    const scalar h = cells.minSpacing();
    const scalar diagonal = 0.5*std::sqrt(scalar(cells.nDim()))*h;

    constexpr label nSub = 4;
    const dividedCell divided(grid_, nSub);
    const std::vector<point> offset(divided.positions());
    const scalar dV = cells.cellVolume()/offset.size();
    std::vector<moments> full(size), fullAbout(size), cut(size);
    std::vector<scalar> volume(offset.size(), dV);
    divided.findMoments(volume, full);
    for (label t = 0; t < size; ++t)
    {
        fullAbout[t] = aboutNode(full[t], t, reached_[t]);
    }

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
                for (size_t sub = 0; sub < offset.size(); ++sub)
                {
                    const scalar part = min
                    (
                        scalar(1),
                        max
                        (
                            scalar(0),
                            0.5 - nSub*b.distance(corner + offset[sub])/h
                        )
                    );
                    volume[sub] = part*dV;
                }
                divided.findMoments(volume, cut);
                m = cut.data();
            }

            const label s = folding.stencil(cell);
            for (label t = 0; t < size; ++t)
            {
                if (!(m[t].V() > 0)) continue;
                const label target =
                    s < 0 ? cell + reachedNode_[t] : folding.targets(s)[t];
                const label k = numberOf_[target];
                if (k < 0) continue;
                if (s < 0 && m == full.data()) add(k, fullAbout[t]);
                else addFolded(coordinate, s, t, k, m[t], folding);
            }
        }
    );
}


void Foam::mpm::bodyNodes::integratePlate
(
    const body& b,
    const nodeFolding& folding
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

    // Where the parts of a cell are from its corner, the same in all cells
    std::vector<point> offset(divided.positions());
    for (vector& place : offset) place = thin.components(place);
    const scalar dV = cells.cellVolume()/offset.size();

    // Half of what they take together; and how far from the plate all nodes in
    // reach of a cell that have another view than it are buried
    vector spacing(Zero);
    for (label d = 0; d < nDim; ++d)
    {
        spacing[cells.axis(d)] = cells.spacing(d);
    }
    const vector taken
    (
        thin.extents(0.5*(1 - 1.0/nSub)*spacing)
      + vector::uniform(0.500001*h/nSub)
    );
    const vector reach
    (
        thin.extents(0.5*(grid_.reachWidth() - 1 + grid_.tileWidth())*spacing)
    );

    constexpr label inPlate = 3;
    constexpr label nKinds = 5;
    label latest = 0;
    std::vector<moments> full(size), fullAbout(size);
    std::vector<scalar> volume[4];
    for (auto& ofPart : volume) ofPart.assign(offset.size(), dV);
    cuts_.resize(4);
    for (cutCell& cut : cuts_)
    {
        cut.height = GREAT;
        for (auto& ofPart : cut.of) ofPart.resize(size);
        cut.unseen.resize(nKinds*size);
    }
    divided.findMoments(volume[0], full);
    for (label t = 0; t < size; ++t)
    {
        fullAbout[t] = aboutNode(full[t], t, reached_[t]);
    }

    auto cutAt = [&](const vector& corner, const bool between) -> cutCell&
    {
        for (cutCell& cut : cuts_)
        {
            if (between && cut.height == corner[2]) return cut;
        }
        latest = (latest + 1) % 4;
        cutCell& cut = cuts_[latest];
        cut.height = between ? corner[2] : GREAT;
        for (bool& any : cut.any) any = false;
        cut.known.assign(nKinds*size, false);
        for (size_t sub = 0; sub < offset.size(); ++sub)
        {
            const vector place(corner + offset[sub]);
            const FixedList<scalar, 4> parts
            (
                between
              ? thin.partsBetweenEdges(place[2], h/nSub)
              : thin.parts(place, h/nSub)
            );
            for (label part = 0; part < 4; ++part)
            {
                volume[part][sub] = parts[part]*dV;
                cut.any[part] = cut.any[part] || parts[part] > 0;
            }
        }
        for (label part = 0; part < 4; ++part)
        {
            if (cut.any[part]) divided.findMoments(volume[part], cut.of[part]);
        }
        return cut;
    };

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

            if (grid_.plateOf(cell) >= 0 || !thin.farther(at, h + diagonal))
            {
                nearCells_.set(cell);
            }

            // Wholly in one part, or divided
            const label whole = thin.whole(at, taken);
            const scalar depth = thin.depthAt(at);
            if
            (
                (whole == plate::front || whole == plate::back)
             && mag(at[2]) > reach[2] && depth > 2*max(reach[0], reach[1])
            )
            {
                return;
            }
            cutCell* cut =
                whole >= 0 ? nullptr
              : &cutAt(thin.local(corner), depth > max(taken[0], taken[1]));

            const label s = folding.stencil(cell);
            for (label t = 0; t < size; ++t)
            {
                const label node =
                    s < 0 ? cell + reachedNode_[t] : folding.targets(s)[t];
                const label second = grid_.second(node);
                const label own =
                    second < 0 ? label(plate::none) : grid_.viewOf(node);
                if (second < 0 && whole >= 0 && whole != inPlate) continue;

                auto take = [&](const label record, const label view)
                {
                    auto sees = [&](const label part)
                    {
                        return
                            part == plate::none ? record == node
                          : part != inPlate
                         && (view == plate::none || view == part);
                    };
                    if (whole >= 0 && sees(whole)) return;
                    const label k = numberOf_[record];
                    if (k < 0 || nodes_[k].buried) return;
                    if (!cut && s < 0)
                    {
                        add(k, fullAbout[t]);
                        return;
                    }
                    const label kind = record == node ? view : 2 + view;
                    const size_t i = size_t(kind)*size + t;
                    if (s < 0 && cut->known[i])
                    {
                        add(k, cut->unseen[i]);
                        return;
                    }
                    moments unseen;
                    for (label part = 0; cut && part < 4; ++part)
                    {
                        if (cut->any[part] && !sees(part))
                        {
                            unseen += cut->of[part][t];
                        }
                    }
                    if (s >= 0)
                    {
                        const moments& m = cut ? unseen : full[t];
                        addFolded(coordinate, s, t, k, m, folding);
                        return;
                    }
                    cut->unseen[i] = aboutNode(unseen, t, reached_[t]);
                    cut->known[i] = true;
                    add(k, cut->unseen[i]);
                };
                take(node, own);
                if (second >= 0) take(second, plate::front + plate::back - own);
            }
        }
    );
}


void Foam::mpm::bodyNodes::integrate(const nodeFolding& folding)
{
    const lattice& cells = grid_.cells();
    sums_.assign(nodes_.size()*16, 0);
    nearCells_.reset();
    nearCells_.resize(grid_.nBoxNodes());
    for (label i = 0; i < bodies_.size(); ++i)
    {
        const body& b = bodies_[i];
        if (b.thinPlate()) integratePlate(b, folding);
        else integrateClosed(b, folding);
    }
    sum(sums_);
    for (size_t k = 0; k < nodes_.size(); ++k)
    {
        const scalar* s = sums_.data() + k*16;
        nodes_[k].V =
            nodes_[k].buried && nodes_[k].inverseVolume > 0
          ? 1/nodes_[k].inverseVolume : s[0];
        for (label c = 0; c < 3; ++c)
        {
            const label axis = cells.axis(c);
            nodes_[k].A[axis] = s[1 + c];
            nodes_[k].W[axis] = s[13 + c];
            for (label d = 0; d < 3; ++d)
            {
                nodes_[k].T[3*axis + cells.axis(d)] = s[4 + 3*c + d];
            }
        }
    }
}


void Foam::mpm::bodyNodes::findNeighbours()
{
    const lattice& cells = grid_.cells();
    const bool is3D = cells.nDim() == 3;
    neighbours_.clear();
    neighbours_.reserve(size_t(size())*nNeighbours());

    // Numbers follow each other, by way and record
    const int64_t n = nIds();
    const int64_t stride[3] =
        {1, width(0), is3D ? int64_t(width(0))*width(1) : 0};
    bool periodic = false;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        periodic = periodic || cells.periodic(d);
    }
    std::vector<label> next(2*nNeighbours(), 0);
    index3 at(label(0));
    int64_t last = -1;
    for (label number = 0; number < size(); ++number)
    {
        follow(id_[number], last, at);
        const int64_t first = id_[number] < n ? id_[number] : id_[number] - n;
        const node& own = nodes_[number];
        label way = 0;
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
            const int64_t id =
                periodic ? globalId(there)
              : first + i*stride[0] + j*stride[1] + k*stride[2];
            label found = inside ? find(id, next[way]) : -1;

            // What it sees beside a plate: its own side
            if (found >= 0 && own.view != plate::none)
            {
                const node& other = nodes_[found];
                const bool across =
                    other.body == own.body && other.view != plate::none
                 && other.view != own.view;
                if (across) found = find(id + n, next[way + 1]);
            }
            neighbours_.push_back(found);
            way += 2;
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
    bodies_(all),
    scale_(scalar(0))
{
    const label T = grid_.reachWidth();
    for (label t = 0; t < grid_.reachSize(); ++t)
    {
        const index3 place{t % T, (t/T) % T, t/(T*T)};
        vector x(Zero);
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            x[d] = grid_.reachStart() + place[d];
        }
        reached_.push_back(x);
    }
    scale_[0] = 1;
    for (label c = 0; c < grid_.nDim(); ++c)
    {
        const scalar scale =
            1/(grid_.secondMoment()*grid_.cells().spacing(c));
        scale_[1 + c] = scale;
        scale_[13 + c] = 1;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            scale_[4 + 3*c + d] = scale*grid_.cells().spacing(d);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::bodyNodes::build
(
    const nodeFolding& folding,
    const std::vector<scalar>& inverseVolume,
    const bool renewed
)
{
    if (renewed)
    {
        reachedNode_.clear();
        for (label t = 0; t < grid_.reachSize(); ++t)
        {
            reachedNode_.push_back(grid_.reachOffset() + grid_.reachNode(t));
        }
    }
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
      + sizeof(scalar)*sums_.capacity() + nearCells_.size()/8;
}

// ************************************************************************* //
