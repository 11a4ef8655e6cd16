/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "PIC.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(PIC, 0);
    addToRunTimeSelectionTable(transferScheme, PIC, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::PIC::PIC
(
    const dictionary&,
    const scalar
)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::PIC::picFraction(const scalar) const
{
    return 1;
}


Foam::string Foam::mpm::PIC::description() const
{
    return "PIC";
}

// ************************************************************************* //
