/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "BinghamPapanastasiou.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(BinghamPapanastasiou, 0);
    addToRunTimeSelectionTable(viscosityModel, BinghamPapanastasiou, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::BinghamPapanastasiou::BinghamPapanastasiou
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    tau0_(readPositive(coeffs, "tau0", dimViscosity/dimTime)),
    m_(readPositive(coeffs, "m", dimTime))
{
    checkKeywords(coeffs, {"tau0", "m"}, strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::BinghamPapanastasiou::nu(const scalar shearRate) const
{
    // Its limit at rest, where the quotient loses its digits
    const scalar x = m_*shearRate;
    return x > 1e-6 ? -tau0_*std::expm1(-x)/shearRate : tau0_*m_;
}


Foam::string Foam::mpm::BinghamPapanastasiou::description() const
{
    return "BinghamPapanastasiou, tau0 " + name(tau0_) + " m2/s2";
}

// ************************************************************************* //
