/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "listed.H"
#include "searchableRegion.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(pointRegion, 0);
    defineRunTimeSelectionTable(pointRegion, dictionary);
}
}

// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::pointRegion::keywords(const wordList& own)
{
    wordList all
    ({
        "type", "velocity", "velocityGradient", "centre",
        "pressure", "p", "level",
        "voidRatio", "stress", "sigma", "K0", "saturated"
    });
    all.append(own);
    return all;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::pointRegion::pointRegion
(
    const polyMesh& mesh,
    const dictionary& dict
)
:
    mesh_(mesh),
    dict_(dict)
{}


Foam::autoPtr<Foam::mpm::pointRegion> Foam::mpm::pointRegion::New
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
{
    const word name(dict.get<word>("type"));
    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (found.found()) return found()(mesh, dict, strictKeywords);

    wordList names(closedSurface::types());
    if (!names.found(name))
    {
        names.append(dictionaryConstructorTablePtr_->sortedToc());
        FatalIOErrorInFunction(dict)
            << "keyword type: unknown region " << name << nl
            << "    Valid names: " << listed(names) << exit(FatalIOError);
    }
    return
        autoPtr<pointRegion>(new searchableRegion(mesh, dict, strictKeywords));
}

// ************************************************************************* //
