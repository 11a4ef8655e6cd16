/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "listed.H"
#include "outlet.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(outlet, 0);
    defineRunTimeSelectionTable(outlet, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::outlet::outlet(const word& name, const dictionary& dict)
:
    name_(name),
    dict_(dict)
{}


Foam::autoPtr<Foam::mpm::outlet> Foam::mpm::outlet::New
(
    const word& name,
    const dictionary& dict,
    const volVectorField& U,
    const bool strictKeywords
)
{
    const word type(dict.get<word>("type"));
    auto found = dictionaryConstructorTablePtr_->cfind(type);

    if (!found.found())
    {
        FatalIOErrorInFunction(dict)
            << "keyword type: unknown outlet " << type << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    return found()(name, dict, U, strictKeywords);
}

// ************************************************************************* //
