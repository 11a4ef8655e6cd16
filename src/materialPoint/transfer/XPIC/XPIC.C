/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "XPIC.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(XPIC, 0);
    addToRunTimeSelectionTable(transferScheme, XPIC, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::XPIC::XPIC
(
    const dictionary&,
    const scalar
)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::XPIC::picFraction(const scalar) const
{
    // The whole sub-grid velocity goes into the filter
    return 0;
}


Foam::string Foam::mpm::XPIC::description() const
{
    return "XPIC, order 2";
}

// ************************************************************************* //
