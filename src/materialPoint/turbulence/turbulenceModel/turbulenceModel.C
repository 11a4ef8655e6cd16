/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "turbulenceModel.H"
#include "dictionaryEntries.H"
#include "listed.H"

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
    const backgroundGrid& grid,
    const volVectorField& U,
    pointStorage& storage,
    const bool strictKeywords
)
{
    const word name(cloudDict.lookupOrDefault<word>("turbulence", "none"));
    if (name == "none") return autoPtr<turbulenceModel>();

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        wordList names(dictionaryConstructorTablePtr_->sortedToc());
        names.append("none");
        FatalIOErrorInFunction(cloudDict)
            << "keyword turbulence: unknown model " << name << nl
            << "    Valid names: " << listed(names) << exit(FatalIOError);
    }

    // All coefficients of most models have defaults
    const word coeffs(name + "Coeffs");
    return found()
    (
        cloudDict.found(coeffs) ? subDictOf(cloudDict, coeffs) : dictionary(),
        grid, U, storage, strictKeywords
    );
}

// ************************************************************************* //
