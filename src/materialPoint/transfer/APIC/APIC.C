/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "APIC.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(APIC, 0);
    addToRunTimeSelectionTable(transferScheme, APIC, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::APIC::APIC
(
    const dictionary& dict,
    const scalar defaultRate
)
:
    rate_
    (
        readBoundedOrDefault
        (
            dict, "apicRate", dimless/dimTime, defaultRate, 0, GREAT, true
        )
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::APIC::picFraction(const scalar deltaT) const
{
    return min(scalar(1), rate_*deltaT);
}


Foam::string Foam::mpm::APIC::description() const
{
    return "APIC, rate " + name(rate_) + " 1/s";
}

// ************************************************************************* //
