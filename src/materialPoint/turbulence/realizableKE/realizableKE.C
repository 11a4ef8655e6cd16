/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "realizableKE.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include "mathematicalConstants.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(realizableKE, 0);
    addToRunTimeSelectionTable(turbulenceModel, realizableKE, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::realizableKE::realizableKE
(
    const dictionary& coeffs,
    const scene& s
)
:
    twoEquation(coeffs, s, {0.09, 1.9, 1.0, 1.2}, {"A0"}),
    A0_(readBoundedOrDefault(coeffs, "A0", dimless, 4.0, 0, GREAT))
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::realizableKE::Cmu
(
    const points& p,
    const label i,
    const scalar k,
    const scalar epsilon
) const
{
    const scalar U =
        std::sqrt(0.5*sqr(p.shearRate[i]) + sqr(p.rotationRate[i]));
    scalar angle = constant::mathematical::pi/6;
    if (p.strainShape)
    {
        angle =
            std::acos(max(scalar(-1), min(scalar(1), p.strainShape[i])))/3;
    }
    return 1/(A0_ + std::sqrt(6.0)*std::cos(angle)*U*k/epsilon);
}


Foam::scalar Foam::mpm::realizableKE::gain
(
    const scalar shearRate,
    const scalar production,
    const scalar k,
    const scalar epsilon
) const
{
    const scalar eta = shearRate*k/epsilon;
    return max(scalar(0.43), eta/(eta + 5))*shearRate;
}


Foam::scalar Foam::mpm::realizableKE::decay
(
    const scalar nu,
    const scalar rate,
    const scalar epsilon
) const
{
    return C2()*epsilon/(epsilon/rate + std::sqrt(nu*epsilon));
}


void Foam::mpm::realizableKE::correct(const points& p, scalar* nut)
{
    advance(*this, p, nut);
}

// ************************************************************************* //
