/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "transferScheme.H"
#include "selected.H"
#include <utility>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(transferScheme, 0);
    defineRunTimeSelectionTable(transferScheme, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::transferScheme> Foam::mpm::transferScheme::New
(
    const dictionary& cloudDict,
    const word& defaultScheme,
    const scalar defaultRate
)
{
    const word name
    (
        cloudDict.lookupOrDefault<word>("transfer", defaultScheme)
    );

    const auto made = selected
    (
        *dictionaryConstructorTablePtr_, cloudDict, "transfer",
        "transfer scheme", name
    );

    // The rate of another scheme would be ignored in silence
    const std::pair<const char*, const char*> rates[] =
        {
            {"apicRate", "APIC"},
            {"flipDampingRate", "FLIP"},
            {"filterRate", "XAPIC"}
        };
    for (const auto& [keyword, scheme] : rates)
    {
        if (name != scheme && cloudDict.found(keyword))
        {
            IOWarningInFunction(cloudDict)
                << "keyword " << keyword << " has no effect: it belongs to"
                << " transfer " << scheme << ", chosen is " << name << endl;
        }
    }

    return made(cloudDict, defaultRate);
}

// ************************************************************************* //
