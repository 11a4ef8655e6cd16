/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    mpmWaterOnly

Description
    The water of a case by the kernels of mpmFoam and nothing else: no soil, no
    system of clouds, no Time that advances, no writing, no log, no function
    objects, no table of effects. What mpmFoam executes beyond this is what it
    costs that it can do more (effects.py).

    Takes steps as mpmFoam does with adjustTimeStep; serial, no inlets.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "sigFpe.H"
#include "uniformDimensionedFields.H"
#include "waterCloud.H"
#include <cstdio>

using namespace Foam;

int main(int argc, char *argv[])
{
    argList::noParallel();
    argList::addNote("Steps of the water of a case, and nothing else");
    argList::addOption("steps", "N", "Number of steps (default: 10)");

    #include "setRootCase.H"

    sigFpe::unset(false);

    #include "createTime.H"

    const fvMesh mesh
    (
        IOobject
        (
            fvMesh::defaultRegion,
            runTime.timeName(),
            runTime,
            IOobject::MUST_READ
        )
    );
    auto readFile = [&](const word& name, const fileName& instance)
    {
        return IOobject
        (
            name, instance, runTime, IOobject::MUST_READ, IOobject::NO_WRITE,
            false
        );
    };
    const IOdictionary properties
    (
        readFile("materialPointProperties", runTime.constant())
    );
    const uniformDimensionedVectorField g(readFile("g", runTime.constant()));
    const IOdictionary state
    (
        readFile("materialPoints", runTime.timePath()/"uniform")
    );
    const dictionary control(mesh.solutionDict().subOrEmptyDict("MPM"));
    const scalar maxCo = control.lookupOrDefault<scalar>("maxCo", 0.5);

    const mpm::materialPointCloud::settings settings
    {
        control.lookupOrDefault<label>("sortInterval", 10),
        control.lookupOrDefault<Switch>("smoothing", true),
        control.lookupOrDefault<Switch>("volumeCorrection", true),
        false, false, true, {}, false, GREAT
    };
    const mpm::backgroundGrid grid(mesh, control);
    mpm::costMeter cost;
    mpm::waterCloud water
    (
        "water", mesh, grid, properties.subDict("water"), settings, cost,
        g.value()
    );
    water.readState(state.subDict("water"));
    water.readPoints();

    label nSteps = 10;
    args.readIfPresent("steps", nSteps);

    const scalar h = grid.cells().minSpacing();
    for (label step = 0; step < nSteps; ++step)
    {
        water.particlesToGrid();
        const scalar deltaT =
            maxCo*h/(water.maxWaveSpeed() + water.maxSpeed());
        water.updateStress(deltaT);
        water.updateNodes(deltaT);
        water.gridToParticles(deltaT);
        water.relocate(deltaT);
        if (!water.firstNonFinite().empty()) return 1;
    }

    // To compare with mpmFoam
    std::printf
    (
        "points %d steps %d max speed %.10g\n",
        int(water.size()), int(water.stepCount()), water.maxSpeed()
    );
    std::printf
    (
        "bytes of points %.0f of nodes %.0f\n",
        double(water.pointMemory()), double(water.nodeMemory())
    );
    return 0;
}

// ************************************************************************* //
