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

    Runs in serial (before decomposePar) or in parallel (after it, without
    points), with the same points in both.

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
#include "materialPointSystem.H"
#include "pointRegion.H"
#include "waterCloud.H"

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


//- Points of one region
struct regionPoints
{
    DynamicList<point> position;
    DynamicList<label> cell;
    DynamicList<scalar> id;
};


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
            if (!region.contains(x, celli)) continue;

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


// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    argList::addNote
    (
        "Fill regions of the mesh with material points"
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

    mpm::waterCloud& water = points.water("setMaterialPoints");
    const dictionary& dict = setDict.subDict(water.name());
    mpm::checkKeywords
    (
        dict,
        {"pointsPerDirection", "placement", "jitter", "seed", "regions"},
        strict
    );

    // Place all points first: the speed of sound depends on all of them
    struct placed
    {
        dictionary dict;
        label first;
        scalar level;
    };
    std::vector<placed> regions;
    scalar surface = -GREAT;
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
        autoPtr<mpm::pointRegion> region
        (
            mpm::pointRegion::New(mesh, e.dict(), strict)
        );
        const regionPoints filled
        (
            fill(points.grid(), *region, dict, taken)
        );

        const label n = returnReduce(filled.position.size(), sumOp<label>());
        if (!n)
        {
            FatalIOErrorInFunction(e.dict())
                << "region " << e.keyword() << " holds no points." << nl
                << "    It spans " << region->bounds() << ", the mesh "
                << mesh.bounds() << exit(FatalIOError);
        }
        Info<< "Cloud " << water.name() << ", region " << e.keyword() << ": "
            << n << " points" << endl;

        // Zero pressure at the top of the region, unless given
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
        surface = max(surface, level);

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
        regions.push_back
        (
            placed
            {
                e.dict(),
                water.addPoints(filled.position, filled.cell, filled.id, v),
                level
            }
        );
    }
    if (regions.empty())
    {
        FatalIOErrorInFunction(dict)
            << "keyword regions: no region given." << nl
            << "    Allowed: one or more, <name> { type box; ... }"
            << exit(FatalIOError);
    }

    water.findSoundSpeed(surface, 0);

    const label n = dict.get<label>("pointsPerDirection");
    const scalar volume =
        cells.cellVolume()/(cells.nDim() == 2 ? n*n : n*n*n);

    for (size_t r = 0; r < regions.size(); ++r)
    {
        const label first = regions[r].first;
        const label last =
            r + 1 < regions.size() ? regions[r + 1].first : water.size();
        const bool hydrostatic =
            mpm::readChoiceOrDefault
            (
                regions[r].dict, "pressure", "uniform",
                {"uniform", "hydrostatic"}
            ) == "hydrostatic";
        const scalar uniform = regions[r].dict.lookupOrDefault<scalar>("p", 0);

        scalarField p(last - first, uniform);
        if (hydrostatic)
        {
            forAll(p, i)
            {
                scalar height = 0;
                for (label d = 0; d < cells.nDim(); ++d)
                {
                    height += up[cells.axis(d)]*water.x(d)[first + i];
                }
                p[i] = water.fluid().hydrostaticPressure
                (
                    g*max(scalar(0), regions[r].level - height)
                );
            }
        }
        water.setState(first, scalarField(last - first, volume), p);
    }
    water.finishPoints();

    Info<< "Cloud " << water.name() << ": " << water.globalSize()
        << " points, mass " << water.globalMass() << " kg" << nl << endl;

    points.write();

    Info<< "Written to " << runTime.timePath() << nl << nl << "End\n" << endl;

    return 0;
}

// ************************************************************************* //
