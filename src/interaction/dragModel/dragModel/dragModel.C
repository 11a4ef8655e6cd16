/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "dragModel.H"
#include "dictionaryEntries.H"
#include "listed.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(dragModel, 0);
    defineRunTimeSelectionTable(dragModel, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::dragModel> Foam::mpm::dragModel::New
(
    const dictionary& dict,
    const medium& m,
    const bool strictKeywords
)
{
    const word name(dict.lookupOrDefault<word>("drag", "DarcyForchheimer"));
    const word coeffs(name + "Coeffs");

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        FatalIOErrorInFunction(dict)
            << "keyword drag: unknown drag model " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    checkKeywords(dict, {"drag", coeffs}, strictKeywords);

    return found()(m, subDictOrEmpty(dict, coeffs), strictKeywords);
}

// ************************************************************************* //
