/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointEnergy.H"
#include "gravityMeshObject.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(materialPointEnergy, 0);
    addToRunTimeSelectionTable(functionObject, materialPointEnergy, dictionary);

    static const functionNeeds::add needsOfMaterialPointEnergy
    (
        "materialPointEnergy", functionNeeds::NO_FIELDS, true
    );
}
}

// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointEnergy::readEntries(const dictionary& dict)
{
    if (!cloud().energyBalance())
    {
        IOWarningInFunction(dict)
            << "function object " << name() << " was not there when the run"
            << " began: stressWork lacks what is of second order in the time"
            << " step. A restart has it." << endl;
    }
    g_ = meshObjects::gravity::New(mesh_.time()).value();
}


Foam::stringList Foam::mpm::materialPointEnergy::description() const
{
    return stringList
    ({
        "Energies and works [J]; total = kinetic + potential + stressWork"
      + string(cloud().affine() ? " + affine" : "")
      + string(cloud().forced() ? " - forceWork" : "")
      + string(cloud().relaxes() ? " - relaxationWork" : "")
    });
}


Foam::wordList Foam::mpm::materialPointEnergy::columns() const
{
    wordList names
    ({
        "kinetic", "potential", "elastic", "stressWork", "correctionWork",
        "total"
    });
    if (cloud().forced()) names.append("forceWork");
    if (cloud().relaxes()) names.append("relaxationWork");
    if (cloud().affine()) names.append("affine");
    return names;
}


Foam::scalarList Foam::mpm::materialPointEnergy::values() const
{
    // Beside those that are always there
    const label forced = cloud().forced();
    const label relaxes = cloud().relaxes();
    const label affine = cloud().affine();
    scalarList e(6 + forced + relaxes + affine, Zero);
    scalar& kinetic = e[0];
    scalar& potential = e[1];
    scalar& elastic = e[2];
    scalar& stressWork = e[3];
    scalar& correctionWork = e[4];
    scalar& total = e[5];

    cloud().energy(g_, kinetic, potential, elastic);
    stressWork = cloud().stressWork();
    correctionWork = cloud().correctionWork();
    if (forced) e[6] = cloud().forceWork();
    if (relaxes) e[6 + forced] = cloud().relaxationWork();
    if (affine) e.last() = cloud().affineEnergy();
    sumToMaster(e);

    total = kinetic + potential + stressWork;
    for (label i = 6; i < 6 + forced + relaxes; ++i) total -= e[i];
    if (affine) total += e.last();
    return e;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::materialPointEnergy::materialPointEnergy
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudTimeSeries(name, runTime, dict, "energy"),
    g_(Zero)
{
    start(dict);
}

// ************************************************************************* //
