/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "placedRegions.H"
#include "bodies.H"
#include "cellZoneRegion.H"
#include "dictionaryEntries.H"
#include "inflowOutflow.H"
#include "listed.H"
#include "machineMemory.H"
#include "PstreamReduceOps.H"
#include "waterCloud.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- Bytes of a point while it is placed and written, beside its columns
const scalar bytesOfPlacing = 250;


//- Uniform in [-1, 1), a function of seed, point and direction only, so that
//  any decomposition places the same points (splitmix64)
scalar noise(const uint64_t seed, const uint64_t id, const label d)
{
    uint64_t z = seed*0x9E3779B97F4A7C15ULL + 4*id + d;
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30))*0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27))*0x94D049BB133111EBULL;
    z ^= z >> 31;
    return 2*scalar(z >> 11)/scalar(1ULL << 53) - 1;
}


//- The entries of a cloud, after a look at their keywords
const dictionary& checked(const dictionary& dict, const bool strictKeywords)
{
    mpm::checkKeywords
    (
        dict,
        {"pointsPerDirection", "placement", "jitter", "seed", "regions"},
        strictKeywords
    );
    return dict;
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::mpm::placedRegions::nPerCell() const
{
    const label n = nPerDirection_;
    return cells_.nDim() == 2 ? n*n : n*n*n;
}


void Foam::mpm::placedRegions::checkEntries
(
    const dictionary& dict,
    const wordList& foreign
) const
{
    for (const word& keyword : foreign)
    {
        if (dict.found(keyword))
        {
            FatalIOErrorInFunction(dict)
                << "keyword " << keyword << " has no meaning for the cloud "
                << cloud_.name() << '.' << nl
                << "    Allowed: regions without " << listed(foreign)
                << exit(FatalIOError);
        }
    }
}


void Foam::mpm::placedRegions::checkDensity() const
{
    if (isA<waterCloud>(cloud_) && nPerDirection_ < 2)
    {
        IOWarningInFunction(dict_)
            << "keyword pointsPerDirection is " << nPerDirection_
            << ": a liquid at rest may lose"
            << " a sixth of its depth within seconds." << nl
            << "    Usual: 2 to 4" << nl << endl;
    }
}


void Foam::mpm::placedRegions::checkMemory(const pointRegion& region) const
{
    // Cells whose centres it holds
    scalar nCells = 0;
    const vectorField& centres = cloud_.grid().mesh().cellCentres();
    const boundBox bounds(region.bounds());
    forAll(centres, celli)
    {
        if
        (
            bounds.contains(centres[celli])
         && region.contains(centres[celli], celli)
        )
        {
            ++nCells;
        }
    }
    reduce(nCells, sumOp<scalar>());

    machineMemory::check
    (
        region.dict(),
        cloud_.name(),
        nCells*nPerCell(),
        cloud_.points().bytesPerPoint() + bytesOfPlacing
    );
}


void Foam::mpm::placedRegions::sample
(
    const label d,
    const boundBox& bounds,
    const boundBox& domain,
    DynamicList<scalar>& position,
    DynamicList<scalar>& width
) const
{
    const label nDim = cells_.nDim();
    if (d == nDim)
    {
        position.append(cells_.midPlane());
        width.append(1);
        return;
    }
    const label n = nDim == 2 ? 100 : 25;
    const label c = cells_.axis(d);
    const scalar from = domain.min()[c], to = domain.max()[c];
    const bool endless = bounds.max()[c] - bounds.min()[c] > 0.1*GREAT;
    const scalar lower = endless ? from : bounds.min()[c];
    const scalar upper = endless ? to : bounds.max()[c];
    const scalar cut[4] =
    {
        lower, min(max(from, lower), upper), max(min(to, upper), lower), upper
    };
    for (label part = 0; part < 3; ++part)
    {
        const scalar length = cut[part + 1] - cut[part];
        if (length < 1e-6*cells_.spacing(d)) continue;
        for (label i = 0; i < n; ++i)
        {
            position.append(cut[part] + (i + 0.5)/n*length);
            width.append(length/n);
        }
    }
}


Foam::scalar Foam::mpm::placedRegions::shareOutside
(
    const pointRegion& region
) const
{
    // Cells are all it has
    if (isA<cellZoneRegion>(region)) return 0;

    const boundBox domain(cloud_.grid().mesh().points(), true);
    FixedList<DynamicList<scalar>, 3> position, width;
    for (label d = 0; d < 3; ++d)
    {
        sample(d, region.bounds(), domain, position[d], width[d]);
    }

    scalar all = 0, inside = 0;
    forAll(position[2], k)
    forAll(position[1], j)
    forAll(position[0], i)
    {
        point x(Zero);
        x[cells_.axis(0)] = position[0][i];
        x[cells_.axis(1)] = position[1][j];
        x[cells_.axis(2)] = position[2][k];
        if (!region.contains(x, -1)) continue;

        const scalar volume = width[0][i]*width[1][j]*width[2][k];
        all += volume;
        if (cellAt(x) >= 0) inside += volume;
    }
    reduce(inside, sumOp<scalar>());
    return all > 0 ? max(scalar(0), 1 - inside/all) : 0;
}


Foam::point Foam::mpm::placedRegions::position
(
    const point& corner,
    const vector& size,
    const label k,
    const int64_t id
) const
{
    const label n = nPerDirection_;
    point x(corner + 0.5*size);
    label rest = k;
    for (label d = 0; d < cells_.nDim(); ++d)
    {
        const label c = cells_.axis(d);
        scalar f = rest % n + 0.5;
        rest /= n;
        if (jittered_) f += jitter_*noise(seed_, id, d);
        x[c] = corner[c] + f/n*size[c];
    }
    return x;
}


const Foam::mpm::plate* Foam::mpm::placedRegions::plateThrough
(
    const point& x,
    const vector& size
) const
{
    const scalar reach = 0.5*mag(size)/nPerDirection_;
    for (const plate& thin : cloud_.grid().plates())
    {
        if (thin.depthAt(thin.local(x)) > -reach && mag(thin.height(x)) < reach)
        {
            return &thin;
        }
    }
    return nullptr;
}


Foam::scalar Foam::mpm::placedRegions::free
(
    point& x,
    const vector& size,
    const plate* cut,
    const label side
) const
{
    const bodies* all = cloud_.bodiesPtr();
    scalar phi;
    if (!all || all->nearest(x, phi) < 0) return 1;

    const label nDim = cells_.nDim();
    const scalar reach = 0.5*mag(size)/nPerDirection_;
    if (!cut && phi > reach) return 1;
    if (!cut && phi < -reach) return 0;

    // Its part of the cell, divided
    const label n = nDim == 2 ? 8 : 5;
    const label nParts = nDim == 2 ? n*n : n*n*n;
    scalar sum = 0;
    vector first(Zero);
    for (label k = 0; k < nParts; ++k)
    {
        vector dx(Zero);
        label rest = k;
        for (label d = 0; d < nDim; ++d)
        {
            const label c = cells_.axis(d);
            dx[c] = ((rest % n + 0.5)/n - 0.5)*size[c]/nPerDirection_;
            rest /= n;
        }
        all->nearest(x + dx, phi);
        const bool front = cut && cut->height(x + dx) >= 0;
        if (cut && front != (side == plate::front)) continue;
        const scalar part = min
        (
            scalar(1),
            max
            (
                scalar(0),
                0.5 + phi*n*nPerDirection_/cells_.minSpacing()
            )
        );
        sum += part;
        first += part*dx;
    }
    if (!(sum > 0)) return 0;
    x += first/sum;
    return sum/nParts;
}


bool Foam::mpm::placedRegions::holds
(
    const pointRegion& region,
    const point& x,
    const label celli
) const
{
    // In each direction another part of a cell, so that hardly an edge of the
    // region lies along it
    const scalar part[3] = {1e-6, 0.77e-6, 0.59e-6};
    point y(x);
    for (label d = 0; d < cells_.nDim(); ++d)
    {
        y[cells_.axis(d)] += part[d]*cells_.spacing(d);
    }
    return region.contains(y, celli);
}


Foam::mpm::placedRegions::places
Foam::mpm::placedRegions::fill(const pointRegion& region)
{
    const label perCell = nPerCell();
    const int64_t nAll =
        perCell*int64_t(cells_.nCells(0))*cells_.nCells(1)*cells_.nCells(2);
    const boundBox bounds(region.bounds());
    places result;

    for (label celli = 0; celli < cloud_.grid().mesh().nCells(); ++celli)
    {
        const index3& i = cells_.cellIndex(celli);
        point corner(Zero);
        vector size(Zero);
        for (label d = 0; d < 3; ++d)
        {
            const label c = cells_.axis(d);
            corner[c] = cells_.origin(d) + i[d]*cells_.spacing(d);
            size[c] = cells_.spacing(d);
        }
        if (!bounds.overlaps(boundBox(corner, corner + size))) continue;

        const int64_t cellId =
            i[0]
          + int64_t(cells_.nCells(0))
           *(i[1] + int64_t(cells_.nCells(1))*i[2]);

        // Less has no weight, and moves with all others
        const scalar leastPart = 0.02;
        auto place = [&](const point& x, const int64_t id, const scalar part)
        {
            if (!taken_.insert(id))
            {
                FatalIOErrorInFunction(region.dict())
                    << "region " << region.dict().dictName()
                    << " overlaps another region of the same cloud at " << x
                    << '.' << nl << "    Allowed: regions that do not overlap"
                    << exit(FatalIOError);
            }
            result.position.append(x);
            result.cell.append(celli);
            result.id.append(scalar(id));
            result.part.append(part);
        };
        for (label k = 0; k < perCell; ++k)
        {
            const int64_t id = cellId*perCell + k;
            point x(position(corner, size, k, id));
            const plate* cut = plateThrough(x, size);
            if (!cut)
            {
                if (!holds(region, x, celli)) continue;
                const scalar part = free(x, size);
                if (part >= leastPart) place(x, id, part);
                continue;
            }

            // A part for each side of a thin plate; ids of one of them follow
            // behind all others
            for (const label side : {plate::front, plate::back})
            {
                point y(x);
                const scalar part = free(y, size, cut, side);
                if (part < leastPart || !holds(region, y, celli)) continue;
                place(y, side == plate::front ? id : nAll + id, part);
            }
        }
    }
    return result;
}


Foam::scalar Foam::mpm::placedRegions::top(const places& p) const
{
    scalar highest = -GREAT;
    for (const point& x : p.position) highest = max(highest, up_ & x);
    reduce(highest, maxOp<scalar>());

    // Of the volume of the points
    scalar half = 0;
    for (label d = 0; d < cells_.nDim(); ++d)
    {
        half += 0.5*mag(up_[cells_.axis(d)])*cells_.spacing(d)/nPerDirection_;
    }
    return highest + half;
}


Foam::vectorField Foam::mpm::placedRegions::velocities
(
    const dictionary& dict,
    const places& p
) const
{
    const vector velocity(dict.lookupOrDefault<vector>("velocity", Zero));
    const tensor gradient
    (
        dict.lookupOrDefault<tensor>("velocityGradient", Zero)
    );
    const point centre(dict.lookupOrDefault<point>("centre", Zero));

    const scalar fastest = maxFlowSpeed;
    vectorField v(p.position.size());
    forAll(v, i)
    {
        v[i] = velocity + (gradient & (p.position[i] - centre));
        if (mag(v[i]) <= fastest) continue;

        FatalIOErrorInFunction(dict)
            << "keyword velocity of region " << dict.dictName() << " is "
            << velocity << ", with velocityGradient " << v[i] << " m/s at "
            << p.position[i] << '.' << nl << "    Allowed: up to "
            << fastest << " m/s, the speed of sound of water"
            << exit(FatalIOError);
    }
    return v;
}


void Foam::mpm::placedRegions::add
(
    const dictionary& dict,
    autoPtr<pointRegion> region
)
{
    if (regions_.empty()) checkDensity();
    checkMemory(*region);
    const places p(fill(*region));

    const int64_t n =
        returnReduce(int64_t(p.position.size()), sumOp<int64_t>());
    if (!n)
    {
        FatalIOErrorInFunction(dict)
            << "region " << dict.dictName() << " holds no points." << nl
            << "    It spans " << region->bounds() << ", the mesh "
            << cloud_.grid().mesh().bounds() << exit(FatalIOError);
    }
    const scalar outside = 100*shareOutside(*region);
    Info<< "Cloud " << cloud_.name() << ", region " << dict.dictName() << ": "
        << n << " points";
    if (outside > 1e-6)
    {
        Info<< "; " << (outside < 1 ? "less than " : "about ")
            << max(label(1), label(std::lround(outside)))
            << " % of its volume lies outside of the mesh";
    }
    Info<< endl;

    const scalar level = dict.lookupOrDefault<scalar>("level", top(p));
    const label first =
        cloud_.addPoints(p.position, p.cell, p.id, velocities(dict, p));
    if (cloud_.bodiesPtr())
    {
        part_.insert(part_.end(), p.part.begin(), p.part.end());
    }
    regions_.push_back
    (
        placed
        {
            label(regions_.size()), dict, std::move(region), first,
            cloud_.size(), level
        }
    );
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::placedRegions::placedRegions
(
    materialPointCloud& cloud,
    const dictionary& dict,
    const vector& up,
    const wordList& foreign,
    const bool strictKeywords
)
:
    cloud_(cloud),
    cells_(cloud.grid().cells()),
    dict_(checked(dict, strictKeywords)),
    up_(up),
    nPerDirection_(readInteger(dict, "pointsPerDirection", 1, 16)),
    jittered_
    (
        readChoiceOrDefault
        (
            dict, "placement", "regular", {"regular", "jittered"}
        ) == "jittered"
    ),
    jitter_
    (
        readBoundedOrDefault(dict, "jitter", dimless, 0.25, 0, 0.5, true, true)
    ),
    seed_(readIntegerOrDefault(dict, "seed", 1, labelMin))
{
    const dictionary& all = subDictOf(dict, "regions");
    for (const word& name : all.toc())
    {
        const dictionary& entries = subDictOf(all, name);
        checkEntries(entries, foreign);
        add
        (
            entries,
            pointRegion::New(cloud.grid().mesh(), entries, strictKeywords)
        );
    }
    // A cloud may be filled by its inlets
    const inflowOutflow* boundaries = cloud.openBoundaries();
    if (regions_.empty() && !(boundaries && boundaries->inlets().size()))
    {
        FatalIOErrorInFunction(dict)
            << "keyword regions: no region given." << nl
            << "    Allowed: one or more, <name> { type box; ... }"
            << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalarField Foam::mpm::placedRegions::pointVolumes
(
    const placed& region
) const
{
    scalarField V(region.size());
    forAll(V, i) V[i] = pointVolume(region.first + i);
    return V;
}


Foam::label Foam::mpm::placedRegions::cellAt(const point& x) const
{
    const backgroundGrid& grid = cloud_.grid();
    index3 i;
    i = 0;
    for (label d = 0; d < cells_.nDim(); ++d)
    {
        i[d] = cells_.cellCoordinate(d, x[cells_.axis(d)]) - grid.lower(d);
        if (i[d] < 0 || i[d] >= grid.nNodes(d) - 1) return -1;
    }
    const label cell = grid.index(i);
    return grid.ownCell(cell) ? grid.meshCell(cell) : -1;
}


Foam::label Foam::mpm::placedRegions::find
(
    const point& x,
    const label celli
) const
{
    for (size_t i = 0; i < regions_.size(); ++i)
    {
        if (holds(*regions_[i].region, x, celli)) return i;
    }
    return -1;
}

// ************************************************************************* //
