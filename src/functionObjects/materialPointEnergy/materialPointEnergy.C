/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointEnergy.H"
#include "gravityMeshObject.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(materialPointEnergy, 0);
    addToRunTimeSelectionTable(functionObject, materialPointEnergy, dictionary);
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
    });
}


Foam::wordList Foam::mpm::materialPointEnergy::columns() const
{
    return wordList
    ({
        "kinetic", "potential", "elastic", "stressWork", "correctionWork",
        "total"
    });
}


Foam::scalarList Foam::mpm::materialPointEnergy::values() const
{
    scalarList e(6, Zero);
    scalar& kinetic = e[0];
    scalar& potential = e[1];
    scalar& elastic = e[2];
    scalar& stressWork = e[3];
    scalar& correctionWork = e[4];
    scalar& total = e[5];

    cloud().energy(g_, kinetic, potential, elastic);
    stressWork = cloud().stressWork();
    correctionWork = cloud().correctionWork();
    sumToMaster(e);

    total = kinetic + potential + stressWork;
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
