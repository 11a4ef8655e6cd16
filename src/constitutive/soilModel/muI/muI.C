/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "muI.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(muI, 0);
    addToRunTimeSelectionTable(soilModel, muI, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::muI::muI
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    granularModel(coeffs, true),
    rheology_(coeffs, rhoS_, d_, false)
{
    checkKeywords
    (
        coeffs, keywords(true, muIRheology::keywords(false)), strictKeywords
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<int dim>
Foam::scalar Foam::mpm::muI::startStrain
(
    const scalar*,
    const scalar q,
    const scalar p,
    const scalar
) const
{
    const scalar M = flowRule<dim>::root3*rheology_.friction(0);
    if (!(q <= M*p))
    {
        FatalIOErrorInFunction(coeffs_)
            << "start stress: q/p has the value " << q/p << " at p = " << p
            << " Pa." << nl << "    Allowed: 0 <= q/p <= " << M
            << exit(FatalIOError);
    }
    return 0;
}


Foam::scalar Foam::mpm::muI::K0() const
{
    const scalar mu = rheology_.friction(0);
    return 1 - mu/std::sqrt(1 + mu*mu);
}


void Foam::mpm::muI::initialise
(
    const label dim,
    soilPoints& points
) const
{
    initialiseWith(*this, dim, points);
}


void Foam::mpm::muI::update
(
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    updateWith(*this, dim, points, deltaT);
}

// ************************************************************************* //
