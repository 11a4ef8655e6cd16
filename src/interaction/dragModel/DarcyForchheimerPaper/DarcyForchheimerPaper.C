/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "DarcyForchheimerPaper.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(DarcyForchheimerPaper, 0);
    addToRunTimeSelectionTable(dragModel, DarcyForchheimerPaper, dictionary);
}
}

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::DarcyForchheimerPaper::coefficients
(
    const label n,
    const scalar* solidFraction,
    const scalar*,
    scalar* a,
    scalar* b
) const
{
    const scalar mu = medium_.mu, rho = medium_.rho, d = medium_.d;

    for (label i = 0; i < n; ++i)
    {
        const scalar ns = solidFraction[i];
        const scalar nw = 1 - ns;
        a[i] = viscous_*mu*sqr(ns)/(sqr(nw)*sqr(d));
        b[i] = inertial_*rho*ns/(nw*d);
    }
}

// ************************************************************************* //
