/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "HerschelBulkley.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(HerschelBulkley, 0);
    addToRunTimeSelectionTable(viscosityModel, HerschelBulkley, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::HerschelBulkley::HerschelBulkley
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    tau0_
    (
        readBounded(coeffs, "tau0", dimViscosity/dimTime, 0, GREAT, true)
    ),
    k_(readBounded(coeffs, "k", dimViscosity, 0, GREAT, true)),
    n_(readBounded(coeffs, "n", dimless, 0, 5)),
    nu0_(readPositive(coeffs, "nu0", dimViscosity))
{
    checkKeywords(coeffs, {"tau0", "k", "n", "nu0"}, strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::HerschelBulkley::nu(const scalar shearRate) const
{
    const scalar tau = tau0_ + k_*std::pow(shearRate, n_);
    return tau < nu0_*shearRate ? tau/shearRate : nu0_;
}


Foam::string Foam::mpm::HerschelBulkley::description() const
{
    return
        "HerschelBulkley, tau0 " + name(tau0_) + " m2/s2, k " + name(k_)
      + " m2/s, n " + name(n_);
}

// ************************************************************************* //
