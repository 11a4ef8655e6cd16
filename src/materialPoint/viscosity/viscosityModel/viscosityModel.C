/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "viscosityModel.H"
#include "dictionaryEntries.H"
#include "selected.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(viscosityModel, 0);
    defineRunTimeSelectionTable(viscosityModel, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::viscosityModel> Foam::mpm::viscosityModel::New
(
    const dictionary& cloudDict,
    const bool strictKeywords
)
{
    const word name
    (
        cloudDict.lookupOrDefault<word>("viscosityModel", "Newtonian")
    );
    if (name == "Newtonian") return autoPtr<viscosityModel>();

    return selected
    (
        *dictionaryConstructorTablePtr_, cloudDict, "viscosityModel", "model",
        name, {"Newtonian"}
    )(subDictOf(cloudDict, name + "Coeffs"), strictKeywords);
}

// ************************************************************************* //
