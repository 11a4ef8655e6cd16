/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "viscosityModel.H"
#include "dictionaryEntries.H"
#include "listed.H"

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

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        wordList names(dictionaryConstructorTablePtr_->sortedToc());
        names.append("Newtonian");
        FatalIOErrorInFunction(cloudDict)
            << "keyword viscosityModel: unknown model " << name << nl
            << "    Valid names: " << listed(names) << exit(FatalIOError);
    }
    return found()(subDictOf(cloudDict, name + "Coeffs"), strictKeywords);
}

// ************************************************************************* //
