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

    Ends with a forecast of the run (runForecast): memory, time step, steps,
    time, output, what would be cheaper; not with \c -noForecast.

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

    For the entries of a cloud see placedRegions, for those of a region
    pointRegion, initialPressure and initialStress.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "IOdictionary.H"
#include "sigFpe.H"
#include "caseLock.H"
#include "cellDecomposition.H"
#include "dictionaryEntries.H"
#include "materialPointSystem.H"
#include "runForecast.H"
#include "waterPlacement.H"
#include <ctime>

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

static void addOptions()
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
    argList::addBoolOption
    (
        "noForecast",
        "Do not try some steps to say what the run will take"
    );
}


//- Cost of a point of soil over that of one of water
static scalar soilWeight(const argList& args)
{
    // In tutorials/wallJet a point of soil costs 3.2 times one of water
    const scalar weight = args.getOrDefault<scalar>("soilWeight", 3);
    if (!(weight > 0))
    {
        FatalErrorInFunction
            << "option -soilWeight is " << weight << '.' << nl
            << "    Allowed: a number > 0" << exit(FatalError);
    }
    return weight;
}


//- Fill the regions of all clouds
static void place(const fvMesh& mesh, mpm::materialPointSystem& points)
{
    const bool strict = points.settings().strictKeywords;
    const IOdictionary setDict
    (
        IOobject
        (
            "setMaterialPointsDict",
            mesh.time().system(),
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

    // All points first: a liquid needs to know the pores of the solids
    mpm::waterCloud* liquid = points.liquidPtr();
    PtrList<mpm::soilPlacement> solids;
    autoPtr<mpm::waterPlacement> inLiquid;
    for (mpm::soilCloud* solid : points.solids())
    {
        solids.append
        (
            new mpm::soilPlacement
            (
                *solid, mpm::subDictOf(setDict, solid->name()), points.g(),
                liquid, strict
            )
        );
        for (label i = 0; i < solids.size() - 1; ++i)
        {
            solids[i].checkOverlap(solids.last());
        }
    }
    if (liquid)
    {
        inLiquid.reset
        (
            new mpm::waterPlacement
            (
                *liquid, mpm::subDictOf(setDict, liquid->name()), points.g(),
                strict
            )
        );
        inLiquid->setState(solids);
    }
    for (mpm::soilPlacement& s : solids) s.findWeights(solids);
    for (mpm::soilPlacement& s : solids)
    {
        s.setState(inLiquid.valid() ? &inLiquid->regions() : nullptr);
    }
}


//- All that is asked for; the time directory that points were written to, empty
//  if none were placed, and the CPU time that writing took
static fileName fill
(
    const argList& args,
    Time& runTime,
    const bool weights,
    const bool decomposition,
    scalar& writing
)
{
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

    if (weights || decomposition)
    {
        const scalar ofSoil = weights ? soilWeight(args) : 1;
        points.read(runTime);
        const mpm::cellDecomposition work(mesh, points);
        if (weights) work.writeWeights(ofSoil);
        else work.writeRanks();
        return fileName();
    }

    place(mesh, points);

    for (mpm::materialPointCloud& cloud : points.clouds())
    {
        cloud.finishPoints();
        Info<< "Cloud " << cloud.name() << ": " << cloud.globalSize()
            << " points, mass " << cloud.globalMass() << " kg" << nl;
    }
    Info<< endl;

    const std::clock_t begin = std::clock();
    points.write();
    writing = scalar(std::clock() - begin)/CLOCKS_PER_SEC;

    Info<< "Written to " << runTime.timePath() << nl << endl;

    return runTime.timePath();
}


// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    addOptions();

    #include "setRootCase.H"

    sigFpe::unset(false);

    const bool weights = args.found("weights");
    const bool decomposition = args.found("decomposition");

    autoPtr<mpm::caseLock> lock;
    if (!weights && !decomposition) lock.reset(new mpm::caseLock(args));

    #include "createTime.H"

    scalar writing = 0;
    const fileName written
    (
        fill(args, runTime, weights, decomposition, writing)
    );
    if (written.empty()) return 0;

    // The points are no longer in memory
    if (Pstream::parRun() || args.found("noForecast"))
    {
        Info<< "No forecast of the run"
            << (Pstream::parRun() ? ": in serial only" : "") << nl << endl;
    }
    else
    {
        mpm::runForecast
        (
            runTime, mpm::runForecast::size(written), writing
        ).report();
    }

    Info<< "End\n" << endl;

    return 0;
}

// ************************************************************************* //
