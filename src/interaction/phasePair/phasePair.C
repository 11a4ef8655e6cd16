/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "phasePair.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "soilCloud.H"
#include "waterCloud.H"
#include "waterSoilInteraction.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(phasePair, 0);
    defineRunTimeSelectionTable(phasePair, dictionary);
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- An error if the clouds given are not the liquid and a solid: there are no
//  other velocity fields
void checkClouds(const dictionary& dict, const mpm::phasePair::phases& all)
{
    if (!dict.found("clouds")) return;

    const wordList names(dict.get<wordList>("clouds"));
    DynamicList<word> solids;
    for (const mpm::soilCloud* s : all.solids) solids.append(s->name());

    const word& liquid = all.liquid.name();
    if
    (
        names.size() == 2
     && (
            (names[0] == liquid && solids.found(names[1]))
         || (names[1] == liquid && solids.found(names[0]))
        )
    )
    {
        return;
    }
    FatalIOErrorInFunction(dict)
        << "keyword clouds of the pair " << dict.dictName() << " is "
        << mpm::listed(names) << ", not two velocity fields of this case."
        << nl << "    Allowed: " << liquid << " and one of "
        << mpm::listed(solids) << exit(FatalIOError);
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::phasePair> Foam::mpm::phasePair::New
(
    const dictionary& dict,
    const phases& all
)
{
    const word name(dict.get<word>("type"));

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        FatalIOErrorInFunction(dict)
            << "keyword type: unknown pair of phases " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    checkClouds(dict, all);

    // What is left is the type's own
    dictionary own(dict);
    own.remove("type");
    own.remove("clouds");
    return found()(own, all);
}


Foam::PtrList<Foam::mpm::phasePair> Foam::mpm::phasePair::NewAll
(
    const phases& all
)
{
    const dictionary dict(subDictOrEmpty(all.properties, "interaction"));
    PtrList<phasePair> pairs;
    if (!dict.found("pairs"))
    {
        pairs.append(new waterSoilInteraction(dict, all));
        return pairs;
    }

    checkKeywords(dict, {"pairs"}, all.strictKeywords);
    const dictionary& entries = subDictOf(dict, "pairs");
    label n = 0;
    for (const word& name : entries.toc())
    {
        pairs.append(New(subDictOf(entries, name), all));
        if (isA<waterSoilInteraction>(pairs.last())) ++n;
    }
    if (n != 1)
    {
        FatalIOErrorInFunction(entries)
            << "keyword pairs has " << n << " pairs of the type "
            << waterSoilInteraction::typeName << '.' << nl
            << "    Allowed: one, and any number of other types"
            << exit(FatalIOError);
    }
    return pairs;
}

// ************************************************************************* //
