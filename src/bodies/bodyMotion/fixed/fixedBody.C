/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "fixedBody.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(fixedBody, 0);
    addToRunTimeSelectionTable(bodyMotion, fixedBody, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::fixedBody::fixedBody
(
    const dictionary& dict,
    const lattice&,
    const bool strict
)
{
    if (dict.found("motion"))
    {
        reportEntry
        (
            dict, "keyword motion is given, but type is fixed", strict
        );
    }
}

// ************************************************************************* //
