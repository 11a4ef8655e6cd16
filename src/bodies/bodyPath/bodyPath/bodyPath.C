/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodyPath.H"
#include "functionPath.H"
#include "dictionaryEntries.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(bodyPath, 0);
    defineRunTimeSelectionTable(bodyPath, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::bodyPath> Foam::mpm::bodyPath::New
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
{
    const word type
    (
        readChoiceOrDefault
        (
            dict, "type", functionPath::typeName,
            dictionaryConstructorTablePtr_->sortedToc()
        )
    );
    return dictionaryConstructorTablePtr_->cfind(type).val()
        (dict, cells, strict);
}

// ************************************************************************* //
