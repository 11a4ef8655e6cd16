/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "initialStress.H"
#include "dictionaryEntries.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(initialStress, 0);
    defineRunTimeSelectionTable(initialStress, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::initialStress> Foam::mpm::initialStress::New
(
    const dictionary& dict,
    const soilPlacement& placement
)
{
    const auto& table = *dictionaryConstructorTablePtr_;
    const word name
    (
        readChoiceOrDefault(dict, "stress", "none", table.sortedToc())
    );
    return table[name](dict, placement);
}

// ************************************************************************* //
