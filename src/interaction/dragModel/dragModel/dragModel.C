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

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        FatalIOErrorInFunction(dict)
            << "keyword drag: unknown drag model " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    // Those of other models may stay where one is tried after the other
    wordList known({"drag"});
    for (const word& model : dictionaryConstructorTablePtr_->sortedToc())
    {
        known.append(model + "Coeffs");
    }
    checkKeywords(dict, known, strictKeywords);

    return found()(m, subDictOrEmpty(dict, name + "Coeffs"), strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::dragModel::coefficients
(
    const label n,
    const scalar* solidFraction,
    const scalar* speed,
    const scalar* diameter,
    scalar* a,
    scalar* b
)
{
    for (label i = 0; i < n; ++i)
    {
        medium_.d = diameter[i];
        coefficients(1, solidFraction + i, speed + i, a + i, b + i);
    }
}

// ************************************************************************* //
