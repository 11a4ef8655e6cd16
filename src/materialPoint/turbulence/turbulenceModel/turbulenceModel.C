/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "turbulenceModel.H"
#include "dictionaryEntries.H"
#include "selected.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(turbulenceModel, 0);
    defineRunTimeSelectionTable(turbulenceModel, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::turbulenceModel> Foam::mpm::turbulenceModel::New
(
    const dictionary& cloudDict,
    const scene& s
)
{
    const word name(cloudDict.lookupOrDefault<word>("turbulence", "none"));
    if (name == "none") return autoPtr<turbulenceModel>();

    // All coefficients of most models have defaults
    return selected
    (
        *dictionaryConstructorTablePtr_, cloudDict, "turbulence", "model", name,
        {"none"}
    )(subDictOrEmpty(cloudDict, name + "Coeffs"), s);
}

// ************************************************************************* //
