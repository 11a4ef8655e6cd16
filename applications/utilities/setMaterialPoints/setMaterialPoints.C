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
    start with a \c uniform effective stress. Where gravity is inclined, and
    the soil reaches from end to end of the mesh with a surface along it, \c
    geostatic is the equilibrium of an endless slope; the log says what was
    assumed. Water points inside a soil region fill its pores.

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
#include "unitConversion.H"
#include "listed.H"
#include "dictionaryEntries.H"
#include "columnDecomposition.H"
#include "caseLock.H"
#include "labelIOList.H"
#include "localIOdictionary.H"
#include "machineMemory.H"
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


//- Points of a cloud per cell and direction
static label pointsPerDirection(const dictionary& dict)
{
    return mpm::readInteger(dict, "pointsPerDirection", 1, 16);
}


//- Bytes of a point while it is placed and written, beside its columns
static const scalar bytesOfPlacing = 250;


//- An error if a region holds more points than there is memory for. Collective.
static void checkMemory
(
    const mpm::materialPointCloud& cloud,
    const mpm::pointRegion& region,
    const dictionary& dict
)
{
    const scalar n = pointsPerDirection(dict);

    // Cells whose centres it holds
    scalar nCells = 0;
    const vectorField& centres = cloud.grid().mesh().cellCentres();
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

    mpm::machineMemory::check
    (
        region.dict(),
        cloud.name(),
        nCells*std::pow(n, cloud.grid().nDim()),
        cloud.points().bytesPerPoint() + bytesOfPlacing
    );
}


//- Water of one point per cell does not hold its depth
static void checkDensityOfPoints
(
    const mpm::materialPointCloud& cloud,
    const dictionary& dict
)
{
    const label n = pointsPerDirection(dict);
    if (cloud.name() == "water" && n < 2)
    {
        IOWarningInFunction(dict)
            << "keyword pointsPerDirection is " << n << ": still water may lose"
            << " a sixth of its depth within seconds." << nl
            << "    Usual: 2 to 4" << nl << endl;
    }
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
    HashSet<int64_t, Hash<int64_t>>& taken
)
{
    const mpm::lattice& cells = grid.cells();
    const label nDim = grid.nDim();
    const label n = pointsPerDirection(dict);
    const bool jittered =
        mpm::readChoiceOrDefault
        (
            dict, "placement", "regular", {"regular", "jittered"}
        ) == "jittered";
    const scalar jitter = mpm::readBoundedOrDefault
    (
        dict, "jitter", dimless, 0.25, 0, 0.5, true, true
    );
    const uint64_t seed =
        mpm::readIntegerOrDefault(dict, "seed", 1, labelMin);

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

            if (!taken.insert(id))
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
    const label n = pointsPerDirection(dict);
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
    // Ids of the places that points have
    HashSet<int64_t, Hash<int64_t>> taken;

    const dictionary& all = mpm::subDictOf(dict, "regions");
    for (const word& name : all.toc())
    {
        const dictionary& entries = mpm::subDictOf(all, name);
        for (const word& keyword : foreign)
        {
            if (entries.found(keyword))
            {
                FatalIOErrorInFunction(entries)
                    << "keyword " << keyword << " has no meaning for the cloud "
                    << cloud.name() << '.' << nl
                    << "    Allowed: regions without " << mpm::listed(foreign)
                    << exit(FatalIOError);
            }
        }
        autoPtr<mpm::pointRegion> region
        (
            mpm::pointRegion::New(mesh, entries, strict)
        );
        if (regions.empty()) checkDensityOfPoints(cloud, dict);
        checkMemory(cloud, *region, dict);
        const regionPoints filled(fill(cloud.grid(), *region, dict, taken));

        const int64_t n =
            returnReduce(int64_t(filled.position.size()), sumOp<int64_t>());
        if (!n)
        {
            FatalIOErrorInFunction(entries)
                << "region " << name << " holds no points." << nl
                << "    It spans " << region->bounds() << ", the mesh "
                << mesh.bounds() << exit(FatalIOError);
        }
        const scalar outside = 100*shareOutside(cloud.grid(), *region);
        Info<< "Cloud " << cloud.name() << ", region " << name << ": "
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
               /pointsPerDirection(dict);
        }
        const scalar level =
            entries.lookupOrDefault<scalar>("level", top + half);

        const vector velocity
        (
            entries.lookupOrDefault<vector>("velocity", Zero)
        );
        const tensor gradient
        (
            entries.lookupOrDefault<tensor>("velocityGradient", Zero)
        );
        const point centre(entries.lookupOrDefault<point>("centre", Zero));

        const scalar fastest = mpm::maxFlowSpeed;
        vectorField v(filled.position.size());
        forAll(v, i)
        {
            v[i] = velocity + (gradient & (filled.position[i] - centre));
            if (mag(v[i]) <= fastest) continue;

            FatalIOErrorInFunction(entries)
                << "keyword velocity of region " << name << " is " << velocity
                << ", with velocityGradient " << v[i] << " m/s at "
                << filled.position[i] << '.' << nl << "    Allowed: up to "
                << fastest << " m/s, the speed of sound of water"
                << exit(FatalIOError);
        }
        const label first =
            cloud.addPoints(filled.position, filled.cell, filled.id, v);
        regions.push_back
        (
            placedRegion
            {
                entries, std::move(region), first, cloud.size(), level
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


//- State fields of a point of soil with the void ratio and effective stress
//  that it starts with; an error of the model if it cannot
static scalarField startState
(
    const mpm::soilCloud& soil,
    scalar voidRatio,
    const symmTensor& stress
)
{
    const label nDim = soil.grid().nDim();
    const label nStress = (nDim == 2 ? 4 : 6);

    scalarField state(soil.model().stateFields().size(), Zero);
    scalarField values(nStress), whole(nStress);
    mpm::soilPoints point;
    point.n = 1;
    point.voidRatio = &voidRatio;
    for (label k = 0; k < nStress; ++k)
    {
        // xx yy zz xy yz zx of the mesh's directions
        const mpm::lattice& cells = soil.grid().cells();
        values[k] = tensor(stress)
        (
            cells.axis(k < 3 ? k : k - 3), cells.axis(k < 3 ? k : (k - 2) % 3)
        );
        point.stress[k] = &values[k];
        point.wholeStress[k] = &whole[k];
    }
    forAll(state, i) point.state[i] = &state[i];
    soil.model().initialise(nDim, point);
    return state;
}


//- Say where a region of soil is not what it was probably meant to be
static void checkSoilRegion(const mpm::soilCloud& soil, const placedRegion& r)
{
    mpm::warnUnusual
    (
        r.dict,
        {
            {"voidRatio", 0.2, GREAT, "packings of grains"},
            {"K0", 0.2, 3, "soils"}
        }
    );

    // Nothing but honeycombs of fine or flat grains stands so loose
    const scalar loosest = 0.5;
    const scalar e = voidRatioOf(soil, r.dict);
    const wordList fields(soil.model().stateFields());
    const label regime = fields.find("regime");
    if (regime < 0 || 1/(1 + e) >= loosest) return;

    if (label(startState(soil, e, Zero)[regime]) != mpm::soilModel::suspended)
    {
        IOWarningInFunction(r.dict)
            << "region " << r.dict.dictName() << " has the solid fraction "
            << 1/(1 + e) << " (void ratio " << e
            << "): its grains touch and carry, and do not settle." << nl
            << "    Usual: for a suspension, less than nsC of the model; for a"
            << " packing, more than " << loosest << " (void ratio < "
            << 1/loosest - 1 << ')' << nl << endl;
    }
}


//- Is a place in one of some regions
static bool inside
(
    const mpm::lattice& cells,
    const std::vector<placedRegion>& regions,
    const point& x,
    const label celli
)
{
    for (const placedRegion& r : regions)
    {
        if (holds(cells, *r.region, x, celli)) return true;
    }
    return false;
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

    scalar top = -GREAT, bottom = GREAT;
    for (const point& x : water.grid().mesh().points())
    {
        top = max(top, up & x);
        bottom = min(bottom, up & x);
    }
    reduce(top, maxOp<scalar>());
    reduce(bottom, minOp<scalar>());

    for (const placedRegion& r : regions)
    {
        const bool hydrostatic =
            mpm::readChoiceOrDefault
            (
                r.dict, "pressure", "uniform", {"uniform", "hydrostatic"}
            ) == "hydrostatic";

        // Below the noise of the pressure then, which is some thousandths
        const scalar highest = top + 100*(top - bottom);
        if (hydrostatic && !(r.level <= highest))
        {
            FatalIOErrorInFunction(r.dict)
                << "keyword level of region " << r.dict.dictName() << " is "
                << r.level << ", more than 100 times the height of the mesh"
                << " above it: nothing is left of the differences of pressure"
                << " inside." << nl << "    Allowed: level <= " << highest
                << ", or pressure uniform" << exit(FatalIOError);
        }
        if (hydrostatic && r.level > top + (top - bottom))
        {
            IOWarningInFunction(r.dict)
                << "keyword level of region " << r.dict.dictName() << " is "
                << r.level << ", far above the mesh, which ends at " << top
                << '.' << nl << "    The water starts under the pressure of "
                << r.level - top << " m of water on top" << nl
                << endl;
        }

        // Of no density and of the double
        const scalar least = water.fluid().pressure(scalar(GREAT));
        const scalar most = water.fluid().pressure(scalar(0.5));
        const scalar uniform = r.dict.lookupOrDefault<scalar>("p", 0);
        if (!(uniform > least && uniform < most))
        {
            FatalIOErrorInFunction(r.dict)
                << "keyword p of region " << r.dict.dictName() << " is "
                << uniform << " Pa, which the equation of state has not with"
                << " the speed of sound " << water.fluid().soundSpeed()
                << " m/s." << nl << "    Allowed: "
                << least << " < p < " << most << ", or a larger soundSpeed"
                << exit(FatalIOError);
        }
        scalarField p(r.last - r.first, uniform);
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
                    // Regions may overlap where no point of soil is
                    const scalar e = voidRatioOf(*soil, s.dict);
                    V[i] *= e/(1 + e);
                    break;
                }
            }
        }
        water.setState(r.first, V, p);
        forAll(p, i)
        {
            if (hydrostatic && p[i] > 0) water.setAtRest(r.first + i, -g*up);
        }
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


//- The soil above a place
struct cover
{
    //- Weight per area [Pa]
    scalar weight;

    //- Where it ends, along the direction upwards [m]
    scalar top;
};


//- The soil above a position, met on the way up through all regions in steps
//  of the given length
static cover soilAbove
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
    cover above{0, up & x};
    for (point y = x + 0.5*step*up; domain.contains(y); y += step*up)
    {
        const label celli = cellAt(grid, y);
        forAll(weights, i)
        {
            if (holds(grid.cells(), *regions[i].region, y, celli))
            {
                above.weight += weights[i]*step;
                above.top = (up & y) + 0.5*step;
                break;
            }
        }
    }
    return above;
}


//- Effective stress over the vertical one of grains at rest below level ground
static symmTensor levelStress(const vector& up, const scalar K0)
{
    return -(sqr(up) + K0*(symmTensor::I - sqr(up)));
}


//- Effective stress over the weight above, along the normal of an endless
//  slope: what is above a plane along the slope is carried by the normal and
//  the shear stress on it. Along the slope the grains press as at rest, or as
//  hard as a steep slope needs to stand: their mobilised friction is that of
//  K0 or that of the slope (the circle of Mohr, with t the shear over the
//  normal stress: (1 - K)^2 + 4 t^2 = m^2 (1 + K)^2).
static symmTensor slopeStress
(
    const vector& up,
    const vector& normal,
    const scalar K0
)
{
    const scalar cosine = up & normal;
    const vector along(up - cosine*normal);
    const scalar t = mag(along)/cosine;
    const scalar m = max(mag(1 - K0)/(1 + K0), mag(along));
    const scalar root =
        2*std::sqrt(max(scalar(0), sqr(m) - sqr(t)*(1 - sqr(m))));
    const scalar K =
        K0 > 1
      ? (1 + sqr(m) + root)/(1 - sqr(m))
      : (1 - sqr(m) + 4*sqr(t))/(1 + sqr(m) + root);

    return
       -cosine*(sqr(normal) + K*(symmTensor::I - sqr(normal)))
      - twoSymm(normal*along);
}


//- Why the model cannot carry a stress; empty if it can
static string refusal
(
    const mpm::soilCloud& soil,
    const scalar voidRatio,
    const symmTensor& stress
)
{
    const bool throwing = FatalIOError.throwExceptions(true);
    string reason;
    try
    {
        startState(soil, voidRatio, stress);
    }
    catch (const IOerror& e)
    {
        reason = e.message();
    }
    FatalIOError.throwExceptions(throwing);
    return reason;
}


//- Geostatic stress of the points of a region whose surface is to be found
static symmTensorField geostaticStress
(
    const mpm::soilCloud& soil,
    const std::vector<placedRegion>& regions,
    const label regioni,
    const scalarList& weights,
    const vector& up,
    const scalar K0,
    const label nPoints,
    const boundBox& domain
)
{
    const mpm::lattice& cells = soil.grid().cells();
    const placedRegion& r = regions[regioni];
    const label n = r.last - r.first;

    // The axis nearest to the vertical
    vector normal(Zero);
    for (label d = 0; d < cells.nDim(); ++d)
    {
        vector axis(Zero);
        axis[cells.axis(d)] = sign(up[cells.axis(d)]);
        if ((axis & up) > (normal & up)) normal = axis;
    }
    const scalar angle = std::acos(min(scalar(1), normal & up));
    const bool inclined = angle > 1e-3;

    // Does the region reach from end to end of the mesh along the slope
    bool endless = true;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label a = cells.axis(d);
        if (normal[a] != 0 || mag(up[a]) <= 1e-3) continue;

        scalar first = GREAT, last = -GREAT;
        for (label p = r.first; p < r.last; ++p)
        {
            const scalar x = soil.position(p)[a];
            first = min(first, x);
            last = max(last, x);
        }
        reduce(first, minOp<scalar>());
        reduce(last, maxOp<scalar>());
        endless = endless
         && first < domain.min()[a] + cells.spacing(d)
         && last > domain.max()[a] - cells.spacing(d);
    }

    // Whole steps from the point of a regular bed to a face of its cell
    auto stepAlong = [&](const vector& direction)
    {
        scalar step = GREAT;
        for (label d = 0; d < cells.nDim(); ++d)
        {
            const scalar part = mag(direction[cells.axis(d)]);
            if (part > SMALL) step = min(step, cells.spacing(d)/part);
        }
        return step/(8*nPoints);
    };

    scalarField weight(n);
    scalar highest = -GREAT, lowest = GREAT;
    auto findCover = [&](const vector& direction)
    {
        const scalar step = stepAlong(direction);
        highest = -GREAT;
        lowest = GREAT;
        forAll(weight, i)
        {
            const cover above = soilAbove
            (
                soil.grid(), soil.position(r.first + i), direction, step,
                domain, regions, weights
            );
            weight[i] = above.weight;
            highest = max(highest, above.top);
            lowest = min(lowest, above.top);
        }
        reduce(highest, maxOp<scalar>());
        reduce(lowest, minOp<scalar>());

        // To half of the distance of points
        return highest - lowest < 4.5*step;
    };

    const char* shear = "no shear stress, horizontal stress K0 times the weight"
        " of what is above";
    Info<< "    stress geostatic: ";
    const bool along = inclined && findCover(normal);
    if (along && endless)
    {
        const symmTensor stress(slopeStress(up, normal, K0));
        const scalar e = voidRatioOf(soil, r.dict);
        const scalar most = returnReduce(max(weight), maxOp<scalar>());
        if (refusal(soil, e, most*stress).empty())
        {
            Info<< "equilibrium of an endless slope of " << radToDeg(angle)
                << " degrees along the mesh" << endl;
            return weight*stress;
        }
        Info<< "--> a slope of " << radToDeg(angle) << " degrees along the mesh"
            << " is steeper than the soil stands;";
    }
    else if (inclined)
    {
        Info<< "--> gravity is inclined by " << radToDeg(angle)
            << " degrees, and the soil "
            << (along ? "ends within the mesh;" : "has no surface along it;");
    }

    const bool level = findCover(up);
    if (!inclined && level)
    {
        Info<< "level ground" << endl;
        return weight*levelStress(up, K0);
    }
    if (!inclined)
    {
        Info<< "--> the surface of the soil above is between " << lowest
            << " and " << highest << " m;";
    }
    Info<< nl << "        assumed as below level ground: " << shear << "." << nl
        << "        The soil moves until it has found its equilibrium" << endl;
    return weight*levelStress(up, K0);
}


//- Say where soil lies under water but holds none
static void checkPoreWater
(
    const mpm::soilCloud& soil,
    const placedRegion& r,
    const std::vector<placedRegion>& inWater,
    const vector& up,
    const boundBox& domain
)
{
    // By default what is in a case with water is wet
    if (!mpm::readSwitchOrDefault(r.dict, "saturated", true)) return;

    const mpm::backgroundGrid& grid = soil.grid();
    const mpm::lattice& cells = grid.cells();
    const vector step(cells.minSpacing()*up);
    int64_t nDry = 0, nUnder = 0;
    for (label p = r.first; p < r.last; ++p)
    {
        const point x(soil.position(p));
        const label celli = grid.meshCell(soil.points().cell()[p]);
        if (inside(cells, inWater, x, celli)) continue;

        ++nDry;
        bool under = false;
        for (point y = x + step; !under && domain.contains(y); y += step)
        {
            under = inside(cells, inWater, y, cellAt(grid, y));
        }
        nUnder += under;
    }
    reduce(nDry, sumOp<int64_t>());
    reduce(nUnder, sumOp<int64_t>());
    const int64_t n =
        returnReduce(int64_t(r.last - r.first), sumOp<int64_t>());

    const bool buoyant =
        r.dict.lookupOrDefault<word>("stress", "none") == "geostatic";
    if (nUnder || (nDry && buoyant))
    {
        OSstream& os = IOWarningInFunction(r.dict);
        os  << "region " << r.dict.dictName() << ": " << nDry << " of " << n
            << " points of soil hold no water in their pores"
            << (buoyant ? ", but are as light as under water" : "");
        if (nUnder) os << ", and " << nUnder << " of them lie under water";
        os  << '.' << nl << "    Allowed: a region of the cloud water over the"
            << " soil as well, or saturated no; for soil that starts dry"
            << nl << endl;
    }
}


//- Void ratio and effective stress of the soil
static void setSoilState
(
    mpm::soilCloud& soil,
    const std::vector<placedRegion>& regions,
    const dictionary& cloudDict,
    const vector& up,
    const scalar g,
    const mpm::waterCloud* water,
    const std::vector<placedRegion>& inWater
)
{
    const mpm::lattice& cells = soil.grid().cells();
    const scalar volume = pointVolume(cells, cloudDict);
    const label nPoints = pointsPerDirection(cloudDict);

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
            refCast<const fvMesh>(soil.grid().mesh()).solutionDict().subOrEmptyDict("MPM")
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
        checkSoilRegion(soil, r);
        if (water && g > 0) checkPoreWater(soil, r, inWater, up, domain);

        symmTensorField sigma(n, Zero);
        if (stress == "uniform")
        {
            const symmTensor given(r.dict.get<symmTensor>("sigma"));
            const string reason(refusal(soil, e, given));
            if (!reason.empty())
            {
                FatalIOErrorInFunction(r.dict)
                    << "keyword sigma of region " << r.dict.dictName() << " is "
                    << given << '.' << nl << "    " << reason.c_str()
                    << exit(FatalIOError);
            }
            sigma = given;
        }
        else if (stress == "geostatic" && g > 0)
        {
            if (weights[regioni] <= 0)
            {
                FatalIOErrorInFunction(r.dict)
                    << "keyword stress of region " << r.dict.dictName()
                    << " is geostatic, but the grains are lighter than the"
                    << " water: rhoS " << soil.model().rhoS() << ", rho0 "
                    << water->fluid().rho0() << " kg/m3." << nl
                    << "    Allowed: none, uniform, or heavier grains"
                    << exit(FatalIOError);
            }
            const bool flat = r.dict.found("level");
            if (!flat && Pstream::parRun() && anyZone)
            {
                FatalIOErrorInFunction(r.dict)
                    << "keyword stress is geostatic, and a region is a cellZone:"
                    << " its cells that lie above may be on another rank." << nl
                    << "    Allowed: give the level of the surface, or run"
                    << " setMaterialPoints before decomposePar"
                    << exit(FatalIOError);
            }
            if (flat)
            {
                const symmTensor direction(levelStress(up, K0));
                forAll(sigma, i)
                {
                    const point x(soil.position(r.first + i));
                    const scalar depth = max(scalar(0), r.level - (up & x));
                    sigma[i] = weights[regioni]*depth*direction;
                }
            }
            else
            {
                sigma = geostaticStress
                (
                    soil, regions, regioni, weights, up, K0, nPoints, domain
                );
            }
        }
        soil.setState(r.first, scalarField(n, volume), scalarField(n, e), sigma);
    }
}


//- Say what decomposePar will need: it knows no patch type of ours, and reads
//  one that it does not know by its value
static void checkDecomposition(const fvMesh& mesh, const word& cloud)
{
    const localIOdictionary file
    (
        IOobject
        (
            "U." + cloud,
            mesh.time().timeName(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        ),
        volVectorField::typeName
    );
    const dictionary& control = mesh.time().controlDict();
    if
    (
        control.found("libs")
     && control.lookup("libs").toString().find("mpmBackgroundGrid")
     != std::string::npos
    )
    {
        return;
    }
    for (const entry& e : file.subDict("boundaryField"))
    {
        if
        (
            e.isDict() && !e.dict().found("value")
         && e.dict().lookupOrDefault<word>("type", word::null) == "frictional"
        )
        {
            Info<< "--> " << file.objectPath() << ", patch " << e.keyword()
                << ": decomposePar does not know the type frictional and asks"
                << " for its value." << nl << "    For it, add"
                << " libs (\"libmpmBackgroundGrid.so\"); to"
                << " system/controlDict" << nl << endl;
            return;
        }
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
    points.writeOrStop([&] { return weights.write(); }, weights.objectPath());
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
    const label nRanks =
        mpm::readInteger(dict, "numberOfSubdomains", 1, 1000000);

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
            << mpm::listed(ofRank) << nl;
    }
    points.writeOrStop([&] { return cellRank.write(); }, cellRank.objectPath());
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

    autoPtr<mpm::caseLock> lock;
    if (!args.found("weights") && !args.found("decomposition"))
    {
        lock.reset(new mpm::caseLock(args));
    }

    #include "createTime.H"

    mpm::lattice::checkFiles(runTime);

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
            *soil, mpm::subDictOf(setDict, soil->name()), mesh, up,
            {"pressure", "p"}, strict
        );
    }
    if (water)
    {
        const dictionary& dict = mpm::subDictOf(setDict, water->name());
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
            *soil, inSoil, mpm::subDictOf(setDict, soil->name()), up, g, water,
            inWater
        );
    }

    for (mpm::materialPointCloud& cloud : points.clouds())
    {
        if (!Pstream::parRun()) checkDecomposition(mesh, cloud.name());
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
