/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    setMaterialPoints

Group
    grpPreProcessingUtilities

Description
    Fills regions of the mesh with material points, as described by
    system/setMaterialPointsDict, and writes them to the start time.

    Soil may be \c geostatic, with the vertical effective stress of the soil
    above it (buoyant where \c saturated) and K0 times that to the sides, or
    start with a \c uniform effective stress. Water points inside a soil
    region fill its pores.

    Regions are half open, to a millionth of a cell: a point on the face that
    two of them share belongs to the upper one.

    Runs in serial (before decomposePar) or in parallel (after it, without
    points), with the same points in both.

    With \c -weights it places nothing. It counts the points that are there at
    the start time (startFrom latestTime: later in a run, too) and writes the
    cost of each cell, \c pointWeights, by which decomposePar gives each rank
    the same work. A point of water counts 1, one of soil \c -soilWeight
    (default 3). In system/decomposeParDict:

    \verbatim
        method          hierarchical;   // or simple
        weightField     pointWeights;
    \endverbatim

    \c simple divides each direction by itself: with more than one of them its
    parts are equal in rows and columns only.

    With \c -decomposition it places nothing, either, but gives each rank the
    same part of \e each cloud, which with water and soil is worth more
    (columnDecomposition.H): columns of cells along the longest direction, for
    the numberOfSubdomains of system/decomposeParDict, to
    constant/cellDecomposition. There:

    \verbatim
        method          manual;
        manualCoeffs    { dataFile "cellDecomposition"; }
    \endverbatim

Usage
    \verbatim
    water
    {
        pointsPerDirection  4;
        placement           regular;        // or jittered
        regions
        {
            column
            {
                type        box;
                min         (0 0 -1);
                max         (0.1 0.2 1);
                velocity    (0 0 0);
                pressure    hydrostatic;
            }
        }
    }
    soil
    {
        pointsPerDirection  4;
        regions
        {
            bed
            {
                type        box;
                min         (0.1 0 -1);
                max         (0.4 0.05 1);
                stress      geostatic;
            }
        }
    }
    \endverbatim

    \table
        Property           | Description                        | Default
        pointsPerDirection | points per cell and direction      | required
        placement          | regular or jittered                | regular
        jitter             | largest displacement over spacing of points | 0.25
        seed               | of the jitter                      | 1
        regions            | sub-dictionaries, see pointRegion  | required
    \endtable

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "IOdictionary.H"
#include "PstreamReduceOps.H"
#include "sigFpe.H"
#include "FlatOutput.H"
#include "dictionaryEntries.H"
#include "columnDecomposition.H"
#include "labelIOList.H"
#include "materialPointSystem.H"
#include "cellZoneRegion.H"
#include "pointRegion.H"
#include "waterCloud.H"
#include "soilCloud.H"

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

//- Uniform in [-1, 1), a function of seed, point and direction only, so that
//  any decomposition places the same points (splitmix64)
static scalar noise(const uint64_t seed, const uint64_t id, const label d)
{
    uint64_t z = seed*0x9E3779B97F4A7C15ULL + 4*id + d;
    z += 0x9E3779B97F4A7C15ULL;
    z = (z ^ (z >> 30))*0xBF58476D1CE4E5B9ULL;
    z = (z ^ (z >> 27))*0x94D049BB133111EBULL;
    z ^= z >> 31;
    return 2*scalar(z >> 11)/scalar(1ULL << 53) - 1;
}


//- Is a position in a region. Regions are half open: what lies on the face of
//  two belongs to the upper one. A millionth of a cell decides, not the last
//  bit of the mesh; in each direction another part of it, so that hardly an
//  edge lies along it.
static bool holds
(
    const mpm::lattice& cells,
    const mpm::pointRegion& region,
    const point& x,
    const label celli
)
{
    const scalar part[3] = {1e-6, 0.77e-6, 0.59e-6};
    point y(x);
    for (label d = 0; d < cells.nDim(); ++d)
    {
        y[cells.axis(d)] += part[d]*cells.spacing(d);
    }
    return region.contains(y, celli);
}


//- Points of one region
struct regionPoints
{
    DynamicList<point> position;
    DynamicList<label> cell;
    DynamicList<scalar> id;
};


//- Mesh cell of this rank at a position, or -1
static label cellAt(const mpm::backgroundGrid& grid, const point& x)
{
    const mpm::lattice& cells = grid.cells();
    mpm::index3 i;
    i = 0;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        i[d] = cells.cellCoordinate(d, x[cells.axis(d)]) - grid.lower(d);
        if (i[d] < 0 || i[d] >= grid.nNodes(d) - 1) return -1;
    }
    const label cell = grid.index(i);
    return grid.ownCell(cell) ? grid.meshCell(cell) : -1;
}


//- Part of the volume of a region that no cell of the mesh holds, by samples.
//  Collective.
static scalar shareOutside
(
    const mpm::backgroundGrid& grid,
    const mpm::pointRegion& region
)
{
    // Cells are all it has
    if (isA<mpm::cellZoneRegion>(region)) return 0;

    const mpm::lattice& cells = grid.cells();
    const label nDim = cells.nDim();
    const boundBox domain(grid.mesh().points(), true);
    const boundBox bounds(region.bounds());

    // Each part of the region below, within and above the mesh has its own
    // samples, so that none is too thin. Without end, it ends with the mesh.
    const label n = nDim == 2 ? 100 : 25;
    FixedList<DynamicList<scalar>, 3> position, width;
    for (label d = 0; d < 3; ++d)
    {
        if (d == nDim)
        {
            position[d].append(cells.midPlane());
            width[d].append(1);
            continue;
        }
        const label c = cells.axis(d);
        const scalar from = domain.min()[c], to = domain.max()[c];
        const bool endless =
            bounds.max()[c] - bounds.min()[c] > 0.1*GREAT;
        const scalar lower = endless ? from : bounds.min()[c];
        const scalar upper = endless ? to : bounds.max()[c];
        const scalar cut[4] =
        {
            lower, min(max(from, lower), upper), max(min(to, upper), lower),
            upper
        };
        for (label part = 0; part < 3; ++part)
        {
            const scalar length = cut[part + 1] - cut[part];
            if (length < 1e-6*cells.spacing(d)) continue;
            for (label i = 0; i < n; ++i)
            {
                position[d].append(cut[part] + (i + 0.5)/n*length);
                width[d].append(length/n);
            }
        }
    }

    scalar all = 0, inside = 0;
    forAll(position[2], k)
    forAll(position[1], j)
    forAll(position[0], i)
    {
        point x(Zero);
        x[cells.axis(0)] = position[0][i];
        x[cells.axis(1)] = position[1][j];
        x[cells.axis(2)] = position[2][k];
        if (!region.contains(x, -1)) continue;

        const scalar volume = width[0][i]*width[1][j]*width[2][k];
        all += volume;
        if (cellAt(grid, x) >= 0) inside += volume;
    }
    reduce(inside, sumOp<scalar>());
    return all > 0 ? max(scalar(0), 1 - inside/all) : 0;
}


//- Fill a region; cells that another region filled before are passed over
static regionPoints fill
(
    const mpm::backgroundGrid& grid,
    const mpm::pointRegion& region,
    const dictionary& dict,
    labelHashSet& taken
)
{
    const mpm::lattice& cells = grid.cells();
    const label nDim = grid.nDim();
    const label n = label
    (
        mpm::readBounded(dict, "pointsPerDirection", dimless, 1, 16, true, true)
    );
    const bool jittered =
        mpm::readChoiceOrDefault
        (
            dict, "placement", "regular", {"regular", "jittered"}
        ) == "jittered";
    const scalar jitter = mpm::readBoundedOrDefault
    (
        dict, "jitter", dimless, 0.25, 0, 0.5, true, true
    );
    const uint64_t seed = dict.lookupOrDefault<label>("seed", 1);

    const label perCell = nDim == 2 ? n*n : n*n*n;
    const boundBox bounds(region.bounds());

    regionPoints result;

    for (label celli = 0; celli < grid.mesh().nCells(); ++celli)
    {
        const mpm::index3& i = cells.cellIndex(celli);
        point corner(Zero);
        vector size(Zero);
        for (label d = 0; d < 3; ++d)
        {
            corner[cells.axis(d)] = cells.origin(d) + i[d]*cells.spacing(d);
            size[cells.axis(d)] = cells.spacing(d);
        }
        if (!bounds.overlaps(boundBox(corner, corner + size))) continue;

        const int64_t cellId =
            i[0] + int64_t(cells.nCells(0))*(i[1] + int64_t(cells.nCells(1))*i[2]);

        for (label k = 0; k < perCell; ++k)
        {
            const int64_t id = cellId*perCell + k;
            point x(corner + 0.5*size);
            label rest = k;
            for (label d = 0; d < nDim; ++d)
            {
                scalar f = rest % n + 0.5;
                rest /= n;
                if (jittered) f += jitter*noise(seed, id, d);
                x[cells.axis(d)] = corner[cells.axis(d)]
                  + f/n*size[cells.axis(d)];
            }
            if (!holds(cells, region, x, celli)) continue;

            if (!taken.insert(celli*perCell + k))
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
        }
    }
    return result;
}


//- A region whose points are in the cloud
struct placedRegion
{
    dictionary dict;
    autoPtr<mpm::pointRegion> region;

    //- First point, and the one after the last
    label first;
    label last;

    //- Height of zero pressure or of the surface [m]
    scalar level;
};


//- Volume of a point of a cloud with the given dictionary
static scalar pointVolume(const mpm::lattice& cells, const dictionary& dict)
{
    const label n = dict.get<label>("pointsPerDirection");
    return cells.cellVolume()/(cells.nDim() == 2 ? n*n : n*n*n);
}


//- Fill all regions of a cloud with points at rest or with the velocity given
static std::vector<placedRegion> place
(
    mpm::materialPointCloud& cloud,
    const dictionary& dict,
    const fvMesh& mesh,
    const vector& up,
    const wordList& foreign,
    const bool strict
)
{
    const mpm::lattice& cells = cloud.grid().cells();

    mpm::checkKeywords
    (
        dict,
        {"pointsPerDirection", "placement", "jitter", "seed", "regions"},
        strict
    );

    std::vector<placedRegion> regions;
    labelHashSet taken;

    for (const entry& e : dict.subDict("regions"))
    {
        if (!e.isDict())
        {
            FatalIOErrorInFunction(dict.subDict("regions"))
                << "entry " << e.keyword() << " is not a dictionary." << nl
                << "    Allowed: <name> { type box; ... }"
                << exit(FatalIOError);
        }
        for (const word& keyword : foreign)
        {
            if (e.dict().found(keyword))
            {
                FatalIOErrorInFunction(e.dict())
                    << "keyword " << keyword << " has no meaning for the cloud "
                    << cloud.name() << '.' << nl
                    << "    Allowed: regions without " << flatOutput(foreign)
                    << exit(FatalIOError);
            }
        }
        autoPtr<mpm::pointRegion> region
        (
            mpm::pointRegion::New(mesh, e.dict(), strict)
        );
        const regionPoints filled(fill(cloud.grid(), *region, dict, taken));

        const label n = returnReduce(filled.position.size(), sumOp<label>());
        if (!n)
        {
            FatalIOErrorInFunction(e.dict())
                << "region " << e.keyword() << " holds no points." << nl
                << "    It spans " << region->bounds() << ", the mesh "
                << mesh.bounds() << exit(FatalIOError);
        }
        const scalar outside = 100*shareOutside(cloud.grid(), *region);
        Info<< "Cloud " << cloud.name() << ", region " << e.keyword() << ": "
            << n << " points";
        if (outside > 1e-6)
        {
            Info<< "; " << (outside < 1 ? "less than " : "about ")
                << max(label(1), label(std::lround(outside)))
                << " % of its volume lies outside of the mesh";
        }
        Info<< endl;

        // The level is the top of the region, unless given
        scalar top = -GREAT;
        for (const point& x : filled.position) top = max(top, up & x);
        reduce(top, maxOp<scalar>());
        scalar half = 0;
        for (label d = 0; d < cells.nDim(); ++d)
        {
            half += 0.5*mag(up[cells.axis(d)])*cells.spacing(d)
               /dict.get<label>("pointsPerDirection");
        }
        const scalar level =
            e.dict().lookupOrDefault<scalar>("level", top + half);

        const vector velocity
        (
            e.dict().lookupOrDefault<vector>("velocity", Zero)
        );
        const tensor gradient
        (
            e.dict().lookupOrDefault<tensor>("velocityGradient", Zero)
        );
        const point centre(e.dict().lookupOrDefault<point>("centre", Zero));

        vectorField v(filled.position.size());
        forAll(v, i)
        {
            v[i] = velocity + (gradient & (filled.position[i] - centre));
        }
        const label first =
            cloud.addPoints(filled.position, filled.cell, filled.id, v);
        regions.push_back
        (
            placedRegion
            {
                e.dict(), std::move(region), first, cloud.size(), level
            }
        );
    }
    // A cloud may be filled by its inlets
    const mpm::inflowOutflow* open = cloud.openBoundaries();
    if (regions.empty() && !(open && open->inlets().size()))
    {
        FatalIOErrorInFunction(dict)
            << "keyword regions: no region given." << nl
            << "    Allowed: one or more, <name> { type box; ... }"
            << exit(FatalIOError);
    }
    return regions;
}


//- Void ratio that a region of soil starts with
static scalar voidRatioOf(const mpm::soilCloud& soil, const dictionary& dict)
{
    return mpm::readBoundedOrDefault
    (
        dict, "voidRatio", dimless, soil.model().e0(),
        soil.leastVoidRatio(), GREAT
    );
}


//- Soil that its own weight would compress beyond its voids is no soil: an
//  error names what is too soft
static void checkStiffness
(
    const mpm::soilCloud& soil,
    const placedRegion& region,
    const scalar weight,
    const vector& up,
    const dictionary& control
)
{
    const mpm::soilModel& model = soil.model();
    if (model.held()) return;

    scalar lowest = GREAT;
    for (label p = region.first; p < region.last; ++p)
    {
        lowest = min(lowest, up & soil.position(p));
    }
    reduce(lowest, minOp<scalar>());

    const scalar pressure = weight*(region.level - lowest);
    const scalar e = voidRatioOf(soil, region.dict);
    if (!(pressure > 0)) return;

    // By the stiffness that it has under this weight; of a suspension, that
    // of its deposit
    const scalar dense = min(e, model.e0());
    const scalar waveSpeedSqr = model.waveSpeedSqr(pressure, dense);
    const scalar strain = pressure*(1 + dense)/(model.rhoS()*waveSpeedSqr);
    const scalar most = std::log(1 + dense);
    if (strain <= most) return;

    const word cap("maxSoilSoundSpeed");
    const bool capped =
        control.found(cap)
     && waveSpeedSqr > 0.999*sqr(mpm::readPositive(control, cap, dimVelocity));
    const dictionary& dict = capped ? control : model.coeffs();
    const bool constant = dict.found("E");
    const word keyword(capped ? cap : constant ? word("E") : word("E0"));
    const scalar value = mpm::readPositive
    (
        dict, keyword, capped ? dimVelocity : constant ? dimPressure : dimless
    );

    FatalIOErrorInFunction(dict)
        << "keyword " << keyword << " has the value " << value
        << ": soil so soft is compressed beyond its void ratio, " << dense
        << ", by its own weight (" << pressure << " Pa in the region "
        << region.dict.dictName() << ")." << nl
        << "    Allowed: " << keyword << " > "
        << value*(capped ? std::sqrt(strain/most) : strain/most)
        << exit(FatalIOError);
}


//- Mass and pressure of the water; inside soil it fills the pores only
static void setWaterState
(
    mpm::waterCloud& water,
    const std::vector<placedRegion>& regions,
    const scalar volume,
    const vector& up,
    const scalar g,
    mpm::soilCloud* soil,
    const std::vector<placedRegion>& soilRegions
)
{
    scalar surface = -GREAT, landing = GREAT;
    for (const placedRegion& r : regions)
    {
        surface = max(surface, r.level);
        landing = min(landing, r.level);
    }
    water.findSoundSpeed
    (
        surface, landing, soil && !soil->model().held() ? soil : nullptr
    );

    for (const placedRegion& r : regions)
    {
        const bool hydrostatic =
            mpm::readChoiceOrDefault
            (
                r.dict, "pressure", "uniform", {"uniform", "hydrostatic"}
            ) == "hydrostatic";

        scalarField p
        (
            r.last - r.first, r.dict.lookupOrDefault<scalar>("p", 0)
        );
        scalarField V(r.last - r.first, volume);
        forAll(p, i)
        {
            const point x(water.position(r.first + i));
            if (hydrostatic)
            {
                p[i] = water.fluid().hydrostaticPressure
                (
                    g*max(scalar(0), r.level - (up & x))
                );
            }
            const label celli =
                water.grid().meshCell(water.points().cell()[r.first + i]);
            for (const placedRegion& s : soilRegions)
            {
                if (holds(water.grid().cells(), *s.region, x, celli))
                {
                    const scalar e = voidRatioOf(*soil, s.dict);
                    V[i] *= e/(1 + e);
                }
            }
        }
        water.setState(r.first, V, p);
    }
}


//- Effective weight of soil in a region per volume [N/m3]
static scalar effectiveWeight
(
    const mpm::soilCloud& soil,
    const dictionary& dict,
    const scalar g,
    const mpm::waterCloud* water
)
{
    const bool saturated =
        mpm::readSwitchOrDefault(dict, "saturated", water != nullptr);
    if (saturated && !water)
    {
        FatalIOErrorInFunction(dict)
            << "keyword saturated is yes, but the scene has no water." << nl
            << "    Allowed: no, or clouds (water soil) in"
            << " constant/materialPointProperties" << exit(FatalIOError);
    }
    const scalar buoyancy = saturated ? water->fluid().rho0() : 0;

    return (soil.model().rhoS() - buoyancy)/(1 + voidRatioOf(soil, dict))*g;
}


//- Weight of the soil above a position per area [Pa], met on the way up
//  through all regions in steps of the given length
static scalar overburden
(
    const mpm::backgroundGrid& grid,
    const point& x,
    const vector& up,
    const scalar step,
    const boundBox& domain,
    const std::vector<placedRegion>& regions,
    const UList<scalar>& weights
)
{
    scalar pressure = 0;
    for (point y = x + 0.5*step*up; domain.contains(y); y += step*up)
    {
        const label celli = cellAt(grid, y);
        forAll(weights, i)
        {
            if (holds(grid.cells(), *regions[i].region, y, celli))
            {
                pressure += weights[i]*step;
                break;
            }
        }
    }
    return pressure;
}


//- Void ratio and effective stress of the soil
static void setSoilState
(
    mpm::soilCloud& soil,
    const std::vector<placedRegion>& regions,
    const dictionary& cloudDict,
    const vector& up,
    const scalar g,
    const mpm::waterCloud* water
)
{
    const mpm::lattice& cells = soil.grid().cells();
    const scalar volume = pointVolume(cells, cloudDict);

    // Whole steps from the point of a regular bed to a face of its cell
    scalar step = GREAT;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const scalar along = mag(up[cells.axis(d)]);
        if (along > SMALL) step = min(step, cells.spacing(d)/along);
    }
    step /= 8*cloudDict.get<label>("pointsPerDirection");

    // Of the whole case: what lies above may be on another rank
    boundBox domain(soil.grid().mesh().points(), true);

    scalarList weights;
    bool anyZone = false;
    for (const placedRegion& r : regions)
    {
        anyZone = anyZone || isA<mpm::cellZoneRegion>(*r.region);
        weights.append(effectiveWeight(soil, r.dict, g, water));
        checkStiffness
        (
            soil, r, weights.last(), up,
            soil.grid().mesh().solutionDict().subOrEmptyDict("MPM")
        );
    }

    forAll(weights, regioni)
    {
        const placedRegion& r = regions[regioni];
        const label n = r.last - r.first;
        const scalar e = voidRatioOf(soil, r.dict);
        const word stress
        (
            mpm::readChoiceOrDefault
            (
                r.dict, "stress", "none", {"none", "geostatic", "uniform"}
            )
        );
        const scalar K0 = mpm::readBoundedOrDefault
        (
            r.dict, "K0", dimless, soil.model().K0(), 0, GREAT, true
        );

        symmTensorField sigma(n, Zero);
        if (stress == "uniform")
        {
            sigma = r.dict.get<symmTensor>("sigma");
        }
        else if (stress == "geostatic")
        {
            const symmTensor direction =
                sqr(up) + K0*(symmTensor::I - sqr(up));

            const bool flat = g == 0 || r.dict.found("level");
            if (!flat && Pstream::parRun() && anyZone)
            {
                FatalIOErrorInFunction(r.dict)
                    << "keyword stress is geostatic, and a region is a cellZone:"
                    << " its cells that lie above may be on another rank." << nl
                    << "    Allowed: give the level of the surface, or run"
                    << " setMaterialPoints before decomposePar"
                    << exit(FatalIOError);
            }
            forAll(sigma, i)
            {
                const point x(soil.position(r.first + i));
                const scalar pressure =
                    flat
                  ? weights[regioni]*max(scalar(0), r.level - (up & x))
                  : overburden(soil.grid(), x, up, step, domain, regions, weights);
                sigma[i] = -pressure*direction;
            }
        }
        soil.setState(r.first, scalarField(n, volume), scalarField(n, e), sigma);
    }
}


//- Write the cost of each cell by its points
static void writeWeights
(
    const fvMesh& mesh,
    mpm::materialPointSystem& points,
    const scalar soilWeight
)
{
    volScalarField weights
    (
        IOobject("pointWeights", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimless, Zero)
    );
    for (const mpm::materialPointCloud& cloud : points.clouds())
    {
        const scalar weight = (&cloud == points.soilPtr() ? soilWeight : 1);
        for (label p = 0; p < cloud.size(); ++p)
        {
            weights[cloud.grid().meshCell(cloud.points().cell()[p])] += weight;
        }
        Info<< "Cloud " << cloud.name() << ": " << cloud.globalSize()
            << " points of weight " << weight << nl;
    }
    if (!weights.write())
    {
        FatalErrorInFunction
            << "cannot write " << weights.objectPath() << "; is the disk full?"
            << exit(FatalError);
    }
    Info<< nl << "Written " << weights.name() << " to "
        << mesh.time().timePath() << nl << nl << "End\n" << endl;
}


//- Write the rank of each cell, by its points
static void writeDecomposition
(
    const fvMesh& mesh,
    mpm::materialPointSystem& points
)
{
    if (Pstream::parRun())
    {
        FatalErrorInFunction
            << "option -decomposition: the case is decomposed already." << nl
            << "    Allowed: in serial, before decomposePar"
            << exit(FatalError);
    }
    const IOdictionary dict
    (
        IOobject
        (
            "decomposeParDict",
            mesh.time().system(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        )
    );
    const label nRanks = label
    (
        mpm::readBounded
            (dict, "numberOfSubdomains", dimless, 1, 1e6, true, true)
    );

    // Columns of the longest direction
    const mpm::lattice& cells = points.grid().cells();
    const boundBox& bounds = mesh.bounds();
    label along = 0;
    for (label d = 1; d < cells.nDim(); ++d)
    {
        const scalar n = bounds.span()[cells.axis(d)]/cells.spacing(d);
        const label a = cells.axis(along);
        if (n > bounds.span()[a]/cells.spacing(along) + 0.5) along = d;
    }
    const label axis = cells.axis(along);
    const scalar spacing = cells.spacing(along);
    auto column = [&](const label celli)
    {
        return label((mesh.C()[celli][axis] - bounds.min()[axis])/spacing);
    };

    const label nColumns = label(bounds.span()[axis]/spacing + 0.5);
    if (nRanks > nColumns)
    {
        FatalIOErrorInFunction(dict)
            << "keyword numberOfSubdomains is " << nRanks << '.' << nl
            << "    Allowed for -decomposition: up to the number of cells in"
            << " the longest direction of the mesh, " << nColumns
            << exit(FatalIOError);
    }

    List<scalarList> work(points.clouds().size());
    forAll(work, k)
    {
        const mpm::materialPointCloud& cloud = points.clouds()[k];
        work[k].resize(nColumns, Zero);
        for (label p = 0; p < cloud.size(); ++p)
        {
            ++work[k][column(cloud.grid().meshCell(cloud.points().cell()[p]))];
        }
    }

    const labelList rank(mpm::shareColumns(work, nRanks));
    labelIOList cellRank
    (
        IOobject
        (
            "cellDecomposition",
            mesh.facesInstance(),
            mesh,
            IOobject::NO_READ,
            IOobject::NO_WRITE,
            false
        ),
        mesh.nCells()
    );
    forAll(cellRank, celli) cellRank[celli] = rank[column(celli)];

    forAll(work, k)
    {
        scalarList ofRank(nRanks, Zero);
        forAll(rank, c) ofRank[rank[c]] += work[k][c];
        Info<< "Cloud " << points.clouds()[k].name() << ": points of the ranks "
            << flatOutput(ofRank) << nl;
    }
    if (!cellRank.write())
    {
        FatalErrorInFunction
            << "cannot write " << cellRank.objectPath()
            << "; is the disk full?" << exit(FatalError);
    }
    Info<< nl << "Written " << cellRank.objectPath() << nl << nl << "End\n"
        << endl;
}


// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    argList::addNote
    (
        "Fill regions of the mesh with material points"
    );
    argList::addBoolOption
    (
        "weights",
        "Place nothing; write the cost of the cells, pointWeights, for the"
        " weightField of decomposePar"
    );
    argList::addBoolOption
    (
        "decomposition",
        "Place nothing; write the rank of the cells, cellDecomposition, for the"
        " method manual of decomposePar: the same part of each cloud"
    );
    argList::addOption
    (
        "soilWeight",
        "number",
        "Cost of a point of soil over that of one of water (default: 3)"
    );

    #include "setRootCase.H"

    sigFpe::unset(false);

    #include "createTime.H"

    fvMesh mesh
    (
        IOobject
        (
            fvMesh::defaultRegion,
            runTime.timeName(),
            runTime,
            IOobject::MUST_READ
        )
    );

    mpm::materialPointSystem points(mesh);
    const mpm::lattice& cells = points.grid().cells();
    const bool strict = points.settings().strictKeywords;

    if (args.found("weights"))
    {
        // In tutorials/wallJet a point of soil costs 3.2 times one of water
        const scalar soilWeight = args.getOrDefault<scalar>("soilWeight", 3);
        if (!(soilWeight > 0))
        {
            FatalErrorInFunction
                << "option -soilWeight is " << soilWeight << '.' << nl
                << "    Allowed: a number > 0" << exit(FatalError);
        }
        points.read(runTime);
        writeWeights(mesh, points, soilWeight);
        return 0;
    }

    if (args.found("decomposition"))
    {
        points.read(runTime);
        writeDecomposition(mesh, points);
        return 0;
    }

    const IOdictionary setDict
    (
        IOobject
        (
            "setMaterialPointsDict",
            runTime.system(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE
        )
    );

    DynamicList<word> names;
    for (const mpm::materialPointCloud& cloud : points.clouds())
    {
        names.append(cloud.name());
    }
    mpm::checkKeywords(setDict, names, strict);

    const scalar g = mag(points.g());
    const vector up = (g > 0 ? -points.g()/g : vector(Zero));

    mpm::soilCloud* soil = points.soilPtr();
    mpm::waterCloud* water = points.waterPtr();

    // Place all points first: water needs to know the pores of the soil
    std::vector<placedRegion> inSoil, inWater;
    if (soil)
    {
        inSoil = place
        (
            *soil, setDict.subDict(soil->name()), mesh, up,
            {"pressure", "p"}, strict
        );
    }
    if (water)
    {
        const dictionary& dict = setDict.subDict(water->name());
        inWater = place
        (
            *water, dict, mesh, up,
            {"voidRatio", "stress", "sigma", "K0", "saturated"}, strict
        );
        setWaterState
        (
            *water, inWater, pointVolume(cells, dict), up, g, soil, inSoil
        );
    }
    if (soil)
    {
        setSoilState
        (
            *soil, inSoil, setDict.subDict(soil->name()), up, g, water
        );
    }

    for (mpm::materialPointCloud& cloud : points.clouds())
    {
        cloud.finishPoints();
        Info<< "Cloud " << cloud.name() << ": " << cloud.globalSize()
            << " points, mass " << cloud.globalMass() << " kg" << nl;
    }
    Info<< endl;

    points.write();

    Info<< "Written to " << runTime.timePath() << nl << nl << "End\n" << endl;

    return 0;
}

// ************************************************************************* //
