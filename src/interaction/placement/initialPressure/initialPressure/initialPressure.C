/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "initialPressure.H"
#include "dictionaryEntries.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(initialPressure, 0);
    defineRunTimeSelectionTable(initialPressure, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::initialPressure> Foam::mpm::initialPressure::New
(
    const dictionary& dict,
    const scene& s
)
{
    const auto& table = *dictionaryConstructorTablePtr_;
    const word name
    (
        readChoiceOrDefault(dict, "pressure", "uniform", table.sortedToc())
    );
    return table[name](dict, s);
}

// ************************************************************************* //
