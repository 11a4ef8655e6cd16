/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "FLIP.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(FLIP, 0);
    addToRunTimeSelectionTable(transferScheme, FLIP, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::FLIP::FLIP
(
    const dictionary& dict,
    const scalar
)
:
    rate_
    (
        readBoundedOrDefault
        (
            dict, "flipDampingRate", dimless/dimTime, 20, 0, GREAT, true
        )
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::FLIP::picFraction(const scalar deltaT) const
{
    return -std::expm1(-rate_*deltaT);
}


Foam::string Foam::mpm::FLIP::description() const
{
    return "FLIP, damping rate " + name(rate_) + " 1/s";
}

// ************************************************************************* //
