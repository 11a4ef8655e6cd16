/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    mpmFoam

Group
    grpLagrangianSolvers

Description
    Water, soil, and the erosion of soil by water with the Material Point
    Method: material points carry the state, the mesh is the background grid
    on which they exchange momentum.

    Ctrl-C, SIGTERM and stopAt writeNow end the run after the step, with a
    restart written.

See also
    docs/theory.md

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "sigFpe.H"
#include "PstreamReduceOps.H"
#include "caseLock.H"
#include "materialPointSystem.H"
#include "endSignals.H"

// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    using namespace Foam;

    argList::addNote
    (
        "Material point method for water, soil, and erosion of soil by water"
    );

    #include "setRootCase.H"

    // The kernels are compiled for machines that do not trap; non-finite
    // values are looked for after each step instead
    sigFpe::unset(false);

    const mpm::caseLock lock(args);
    mpm::materialPointSystem::setIncompleteTimesAside(args);

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
    points.read(runTime);
    points.reportEffects();

    const mpm::endSignals signals;
    scalar signal = 0;
    points.limits().addMaximum
    (
        mpm::stepLimits::end,
        [&]() { return scalar(signals.own()); },
        signal
    );

    points.startDeltaT(runTime);

    Info<< "Starting time loop\n" << endl;

    while (runTime.run())
    {
        // First, because the time step depends on how the soil deforms
        points.particlesToGrid();

        points.setDeltaT(runTime);
        points.advance(runTime);

        // How: keyword momentum of fvSolution/MPM
        points.moveNodes();

        points.gridToParticles();
        points.relocate();

        points.endStep(runTime);

        const string reason(signals.reason(label(signal)));
        if (!reason.empty())
        {
            points.stop(runTime, reason);
        }

        points.updateMeshFields();
        points.cost().start("output");
        points.writeTime(runTime);
        points.cost().stop();

        points.log(runTime);
        points.cost().start("function objects");
    }
    points.cost().stop();

    points.reportCosts();

    Info<< "End\n" << endl;

    return 0;
}

// ************************************************************************* //
