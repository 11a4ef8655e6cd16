/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "explicitMomentum.H"
#include "bodies.H"
#include "movingFrame.H"
#include "phasePair.H"
#include "relaxationZone.H"
#include "soilCloud.H"
#include "waterCloud.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(explicitMomentum, 0);
    addToRunTimeSelectionTable(momentumStep, explicitMomentum, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::explicitMomentum::pushBodies(const scalar deltaT)
{
    scene_.cost.start("bodies: motion");
    const vector g(scene_.gravity());
    bodies& all = *scene_.solidBodies;
    for (label b = 0; b < all.size(); ++b)
    {
        bodyMotion& motion = all[b].motion();
        if (!motion.pushed()) continue;

        scalar impulse[6] = {}, resistance[36] = {};
        for (const materialPointCloud& cloud : scene_.clouds)
        {
            cloud.pushBody(b, deltaT, impulse, resistance);
        }
        motion.react(deltaT, g, impulse, resistance);
    }
    for (materialPointCloud& cloud : scene_.clouds) cloud.followBodies(deltaT);
    scene_.cost.stop();
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::explicitMomentum::explicitMomentum
(
    const dictionary&,
    const scene& s
)
:
    momentumStep(s)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::explicitMomentum::addLimits(stepLimits& limits)
{
    for (materialPointCloud& cloud : scene_.clouds) cloud.addLimits(limits);
}


void Foam::mpm::explicitMomentum::solve(const scalar deltaT)
{
    PtrList<materialPointCloud>& clouds = scene_.clouds;
    PtrList<phasePair>& pairs = scene_.pairs;

    // The pressure of the liquid acts on points of solids, too
    if (scene_.liquid) scene_.liquid->updateStress(deltaT);
    for (phasePair& pair : pairs) pair.afterLiquidStress();
    for (soilCloud* solid : scene_.solids) solid->updateStress(deltaT);

    if (scene_.frame)
    {
        scene_.cost.start("moving frame");
        for (materialPointCloud& cloud : clouds) scene_.frame->addForces(cloud);
        scene_.cost.stop();
    }
    for (phasePair& pair : pairs) pair.addForces(deltaT);
    for (materialPointCloud& cloud : clouds) cloud.updateNodes(deltaT);
    for (phasePair& pair : pairs) pair.exchangeMomentum(deltaT);
    if (scene_.zones.size())
    {
        scene_.cost.start("relaxation zones");
        for (relaxationZone& zone : scene_.zones) zone.apply(deltaT);
        scene_.cost.stop();
    }

    for (materialPointCloud& cloud : clouds) cloud.finishNodes(deltaT);
    if (scene_.solidBodies && scene_.solidBodies->anyPushed())
    {
        pushBodies(deltaT);
    }
}

// ************************************************************************* //
