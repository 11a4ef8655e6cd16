/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    Points that moved: other cells, ranks and openings.

\*---------------------------------------------------------------------------*/

#include "materialPointCloud.H"
#include "bodies.H"
#include "Pstream.H"
#include <algorithm>
#include <cmath>

// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointCloud::findNearGroups()
{
    const bitSet& nearCells = leader().nearBodies();
    const label* cell = points_.cell();
    nearGroup_.assign(size()/groupSize + 1, 0);
    for (label p = 0; p < size(); ++p)
    {
        if (nearCells.test(cell[p])) nearGroup_[p/groupSize] = 1;
    }
}


void Foam::mpm::materialPointCloud::findNearGroups
(
    const std::vector<label>& points
)
{
    const bitSet& nearCells = leader().nearBodies();
    const label* cell = points_.cell();
    for (const label p : points)
    {
        if (nearCells.test(cell[p])) nearGroup_[p/groupSize] = 1;
    }
}


template<class Op>
void Foam::mpm::materialPointCloud::forNearGroups(const Op& op)
{
    for (size_t group = 0; group < nearGroup_.size(); ++group)
    {
        if (!nearGroup_[group]) continue;
        const label first = groupSize*label(group);
        const label last = min(first + groupSize, size());
        for (label p = first; p < last; ++p) op(p);
    }
}


void Foam::mpm::materialPointCloud::putOutOfBodies(std::vector<label>& turned)
{
    const bitSet& nearCells = leader().nearBodies();
    const lattice& cells = grid_.cells();
    const nodeTiles& tiles = boundary_.tiles();
    const label nDim = grid_.nDim();
    const scalar h = cells.minSpacing();
    const label* cell = points_.cell();
    const size_t nMovers = movers_.size();

    // As position(), of many points
    const scalar* column[3];
    label axis[3];
    for (label d = 0; d < nDim; ++d)
    {
        column[d] = x(d);
        axis[d] = cells.axis(d);
    }
    point place(Zero);
    if (nDim == 2) place[cells.axis(2)] = cells.midPlane();

    if (nearGroup_.empty()) findNearGroups();
    auto putOut = [&](const label p)
    {
        if (!nearCells.test(cell[p])) return;
        point at(place);
        for (label d = 0; d < nDim; ++d) at[axis[d]] = column[d][p];

        // Beside a plate the side is that from which it comes: its tile and cell
        // are still those of the step
        const label thin = grid_.plateOf(cell[p]);
        const label view =
            thin < 0 ? label(plate::none) : tiles.viewOf(points_.tile()[p]);
        const scalar before =
            view == plate::none
          ? GREAT : grid_.plates()[thin].beforeFace(at, view);
        if (before < GREAT)
        {
            if (before >= 0) return;
            at = grid_.plates()[thin].returned(at, view, 1e-6*h);
        }
        else
        {
            if (thin >= 0 && grid_.plates()[thin].viewAt(at) != view)
            {
                turned.push_back(p);
            }
            scalar phi;
            const label b = bodies_->nearest(at, phi);
            if (!(phi < 0)) return;

            const vector g((*bodies_)[b].gradient(at, 0.5*h));
            if (!(mag(g) > SMALL)) return;
            at += (1e-6*h - phi)*g/mag(g);
        }
        for (label d = 0; d < nDim; ++d)
        {
            points_.column(x_ + d)[p] = at[cells.axis(d)];
        }
        movers_.push_back(p);
        ++putOut_;
    };
    forNearGroups(putOut);

    // In the order of the points, each once
    if (movers_.size() > nMovers)
    {
        std::sort(movers_.begin(), movers_.end());
        movers_.erase
            (std::unique(movers_.begin(), movers_.end()), movers_.end());
    }
}


Foam::mpm::index3 Foam::mpm::materialPointCloud::returnFromWall
(
    const label point
)
{
    const lattice& cells = grid_.cells();
    const index3 from = grid_.coordinate(points_.cell()[point]);
    const index3 to = boxCoordinate(point);

    // Clamp the direction that suffices, else all
    index3 clampTo = from;
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        if (to[d] == from[d]) continue;
        index3 trial = to;
        trial[d] = from[d];
        if (grid_.cellRank(grid_.index(trial)) != backgroundGrid::missing)
        {
            clampTo = trial;
            break;
        }
    }

    for (label d = 0; d < grid_.nDim(); ++d)
    {
        if (clampTo[d] == to[d]) continue;
        const label i = clampTo[d] + grid_.lower(d);
        const scalar gap = (to[d] < clampTo[d] ? wallGap : 1 - wallGap);
        points_.column(x_ + d)[point] =
            cells.origin(d) + (i + gap)*cells.spacing(d);
    }
    ++counters_.wallContacts;
    return clampTo;
}


bool Foam::mpm::materialPointCloud::inBox
(
    const label point,
    index3& i,
    const scalar deltaT
) const
{
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        // The time step is checked for non-finite values as a whole
        if (!std::isfinite(x(d)[point])) return false;
    }

    i = boxCoordinate(point);
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        if (i[d] >= 0 && i[d] < grid_.nNodes(d) - 1) continue;
        FatalErrorInFunction
            << "cloud " << name() << ": a point moved across more than "
            << backgroundGrid::margin << " cells in one time step of "
            << deltaT << " s, to " << position(point) << '.' << nl
            << "    The time step is too large or the flow unstable:"
            << " lower maxCo (or deltaT if adjustTimeStep is no). Where"
            << " the log has warned of density or of maxSoilSoundSpeed,"
            << " raise soundSpeed or that."
            << exit(FatalError);
    }
    return true;
}


void Foam::mpm::materialPointCloud::wrap(const label point, index3& i)
{
    const lattice& cells = grid_.cells();
    bool wrapped = false;
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        if (!cells.periodic(d)) continue;
        const label g = i[d] + grid_.lower(d);
        const label n = cells.nCells(d);
        if (g >= 0 && g < n) continue;

        scalar& xd = points_.column(x_ + d)[point];
        xd += (g < 0 ? 1 : -1)*n*cells.spacing(d);
        wrapped = true;
    }
    if (!wrapped) return;

    i = boxCoordinate(point);
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        // Rounding may land on the far end itself
        const label g = i[d] + grid_.lower(d);
        if (cells.periodic(d) && g >= cells.nCells(d))
        {
            points_.column(x_ + d)[point] = cells.origin(d)
              + (cells.nCells(d) - wallGap)*cells.spacing(d);
            --i[d];
        }
    }
}


void Foam::mpm::materialPointCloud::findDepartures
(
    const scalar deltaT,
    std::vector<departure>& departures,
    bool& inactive
)
{
    bool cyclic = false;
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        cyclic = cyclic || grid_.cells().periodic(d);
    }

    for (size_t m = 0; m < movers_.size(); ++m)
    {
        const label p = movers_[m];

        // Movers are too far apart for the processor to see them coming
        if (m + 8 < movers_.size())
        {
            const label next = movers_[m + 8];
            for (label d = 0; d < grid_.nDim(); ++d)
            {
                __builtin_prefetch(x(d) + next);
            }
            __builtin_prefetch(points_.cell() + next, 1);
            __builtin_prefetch(points_.tile() + next, 1);
        }

        index3 i;
        if (!inBox(p, i, deltaT)) continue;

        if (grid_.cellRank(grid_.index(i)) == backgroundGrid::missing)
        {
            const label patch = boundary_.beyondOpening(grid_.index(i));
            if (patch >= 0)
            {
                departures.push_back(departure{p, -1, patch});
                continue;
            }
            i = returnFromWall(p);
        }
        const label rank = grid_.cellRank(grid_.index(i));
        if (cyclic) wrap(p, i);

        if (rank == Pstream::myProcNo())
        {
            setCell(p, i);
            inactive = inactive || !order_.active(points_.cell()[p]);
        }
        else
        {
            departures.push_back(departure{p, rank, -1});
        }
    }
    movers_.clear();

    // Removal puts the last point into the gap: from the back to the front
    std::sort
    (
        departures.begin(),
        departures.end(),
        [](const departure& a, const departure& b) { return a.point > b.point; }
    );
}


void Foam::mpm::materialPointCloud::migrate
(
    const std::vector<departure>& departures,
    bool& inactive
)
{
    // What moves to another rank and leaves there in the same step may be the
    // fastest of all: it must not be counted here any more
    const bool byRegion = open_.valid() && open_->anyRegion();

    const neighbourRanks& neighbours = grid_.neighbours();
    const label nColumns = points_.nColumns();
    List<DynamicList<scalar>> outgoing(neighbours.size());
    List<scalar> buffer(nColumns);

    for (const departure& d : departures)
    {
        if (d.rank < 0)
        {
            leave(d.point, open_.valid() ? open_->outletOfPatch(d.patch) : -1);
        }
        else
        {
            extremeLeft_ = extremeLeft_ || (byRegion && extreme(d.point));
            points_.pack(d.point, buffer.data());
            outgoing[neighbours.place(d.rank)].append(buffer);
            points_.remove(d.point);
        }
    }
    if (!Pstream::parRun()) return;

    const List<scalarList> from(neighbours.exchange(outgoing));
    for (const scalarList& incoming : from)
    {
        for (label k = 0; k < incoming.size(); k += nColumns)
        {
            points_.append(incoming.cdata() + k, 0);
            const label p = points_.size() - 1;
            setCell(p, boxCoordinate(p));
            inactive = inactive || !order_.active(points_.cell()[p]);
            extremeLeft_ = extremeLeft_ || (byRegion && extreme(p));
        }
    }
}


bool Foam::mpm::materialPointCloud::extreme(const label p) const
{
    scalar sqr = 0;
    for (label d = 0; d < grid_.nDim(); ++d) sqr += Foam::sqr(v(d)[p]);

    // But for rounding
    return sqr >= (1 - 1e-9)*sums_.maxSpeedSqr;
}


void Foam::mpm::materialPointCloud::leave(const label p, const label outlet)
{
    extremeLeft_ = extremeLeft_ || extreme(p);
    counters_.left.add(mass()[p]);

    if (open_.valid())
    {
        open_->leave(outlet, stepCount_, points_.column(id_)[p], mass()[p]);
        if (!open_->recycle())
        {
            points_.park(p);
            return;
        }
    }
    points_.remove(p);
}


void Foam::mpm::materialPointCloud::leaveByRegion()
{
    if (!open_->anyRegion()) return;

    const std::vector<char>& marks = open_->marks();

    // The last point fills the gap: from the back to the front
    for (label p = size() - 1; p >= 0; --p)
    {
        const label cell = points_.cell()[p];
        if (!(marks[cell] & inflowOutflow::outletRegion)) continue;

        const label outlet = open_->outletAt(position(p), grid_.meshCell(cell));
        if (outlet >= 0) leave(p, outlet);
    }
}


void Foam::mpm::materialPointCloud::enter
(
    const scalar deltaT,
    bool& inactive
)
{
    PtrList<inlet>& inlets = open_->inlets();

    for (inlet& in : inlets)
    {
        in.advance(deltaT);

        while (in.due())
        {
            const scalar distance = in.takeLayer();
            const scalarList ids
            (
                open_->takeIds(label(in.places().size()))
            );
            const nodeVector velocity = in.velocity();
            const label first = size();

            label n = 0;
            for (const inlet::place& place : in.places()) n += place.own;
            points_.resize(first + n);

            scalarList volume(n), depth(n);
            label p = first;
            forAll(ids, k)
            {
                const inlet::place& place = in.places()[k];
                if (!place.own) continue;

                for (label d = 0; d < grid_.nDim(); ++d)
                {
                    points_.column(x_ + d)[p] =
                        d == in.zone().direction()
                      ? in.coordinate(place, distance)
                      : place.x[d];
                    points_.column(v_ + d)[p] = velocity[d];
                }
                points_.column(id_)[p] = ids[k];

                const index3 i = boxCoordinate(p);
                if (!grid_.ownCell(grid_.index(i)))
                {
                    FatalErrorInFunction
                        << "cloud " << name() << ", inlet " << in.name()
                        << ": a layer enters " << distance
                        << " m behind its patch, beyond the first cell." << nl
                        << "    Material moves further than a cell in a time"
                        << " step of " << deltaT << " s: raise soundSpeed above"
                        << " the inlet's speed." << exit(FatalError);
                }
                setCell(p, i);
                inactive = inactive || !order_.active(points_.cell()[p]);
                volume[p - first] = place.volume;
                depth[p - first] = place.depth;
                ++p;
            }
            setEntered(in, first, volume, depth);
            for (p = first; p < size(); ++p) in.entered().add(mass()[p]);
        }
    }
    if (inlets.size())
    {
        sums_.maxSpeedSqr =
            max(sums_.maxSpeedSqr, sqr(open_->speed(time().value())));
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::materialPointCloud::relocate(const scalar deltaT)
{
    std::vector<label> moved;
    if (bodies_)
    {
        cost_.start("bodies: points put out");

        // What is near follows the bodies
        if (bodies_->anyMoves()) nearGroup_.clear();
        putOutOfBodies(moved);
    }
    cost_.start("relocate and sort");

    std::vector<departure> departures;
    bool inactive = false;
    if (bodies_) moved.insert(moved.end(), movers_.begin(), movers_.end());
    findDepartures(deltaT, departures, inactive);
    const label nPoints = size();
    migrate(departures, inactive);

    if (open_.valid())
    {
        leaveByRegion();
        if (extremeLeft_) findExtremes();
        enter(deltaT, inactive);
    }
    else if (extremeLeft_) findExtremes();
    extremeLeft_ = false;
    if (bodies_)
    {
        // Points that leave give their places to others
        if (departures.size() || size() != nPoints || open_.valid())
        {
            findNearGroups();
            updateViews();
        }
        else
        {
            findNearGroups(moved);
            if (grid_.plated()) for (const label p : moved) findView(p);
        }
    }

    ++stepCount_;
    const bool sort = stepCount_ % settings_.sortInterval == 0;
    if (sort || inactive) activate(sort);

    cost_.stop();
}

// ************************************************************************* //
