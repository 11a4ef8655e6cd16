/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "outlet.H"
#include "selected.H"

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
    return selected
        (*dictionaryConstructorTablePtr_, dict, "type", "outlet", type)
        (name, dict, U, strictKeywords);
}

// ************************************************************************* //
