/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "XAPIC.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(XAPIC, 0);
    addToRunTimeSelectionTable(transferScheme, XAPIC, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::XAPIC::XAPIC
(
    const dictionary& dict,
    const scalar defaultRate
)
:
    rate_
    (
        readBoundedOrDefault
        (
            dict, "filterRate", dimless/dimTime, defaultRate/4, 0, GREAT, true
        )
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::XAPIC::picFraction(const scalar) const
{
    return 0;
}


bool Foam::mpm::XAPIC::advance(const scalar deltaT)
{
    due_ += rate_*deltaT;
    if (due_ < 1) return false;

    due_ = 0;
    return true;
}


void Foam::mpm::XAPIC::read(const dictionary& state)
{
    due_ = state.lookupOrDefault<scalar>("filterDue", 0);
}


void Foam::mpm::XAPIC::write(dictionary& state) const
{
    state.set("filterDue", due_);
}


Foam::string Foam::mpm::XAPIC::description() const
{
    return "XAPIC, filtered " + name(rate_) + " times per s";
}

// ************************************************************************* //
