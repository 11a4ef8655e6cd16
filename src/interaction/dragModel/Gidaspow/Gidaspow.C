/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "Gidaspow.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(Gidaspow, 0);
    addToRunTimeSelectionTable(dragModel, Gidaspow, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::Gidaspow::Gidaspow
(
    const medium& m,
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    Ergun(m, coeffs, strictKeywords, {"denseFraction"}),
    denseFraction_
    (
        readBoundedOrDefault(coeffs, "denseFraction", dimless, 0.2, 0, 1)
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::Gidaspow::coefficients
(
    const label n,
    const scalar* solidFraction,
    const scalar* speed,
    scalar* a,
    scalar* b
) const
{
    const scalar mu = medium_.mu, rho = medium_.rho, d = medium_.d;

    for (label i = 0; i < n; ++i)
    {
        const scalar ns = solidFraction[i];
        const scalar nw = 1 - ns;

        if (ns > denseFraction_)
        {
            a[i] = viscous_*mu*sqr(ns)/(nw*sqr(d));
            b[i] = inertial_*rho*ns/d;
            continue;
        }
        const scalar hindrance = std::pow(nw, -2.65);
        const scalar Re = nw*rho*d*speed[i]/mu;
        if (Re < 1000)
        {
            // 3/4 C_d rho n_s n_w/d |dv| with C_d Re = 24 (...)
            a[i] = 18*mu*ns/sqr(d)*(1 + 0.15*std::pow(Re, 0.687))*hindrance;
            b[i] = 0;
        }
        else
        {
            a[i] = 0;
            b[i] = 0.75*0.44*rho*ns*nw/d*hindrance;
        }
    }
}

// ************************************************************************* //
