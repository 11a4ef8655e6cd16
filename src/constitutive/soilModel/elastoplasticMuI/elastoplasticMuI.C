/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "elastoplasticMuI.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(elastoplasticMuI, 0);
    addToRunTimeSelectionTable(soilModel, elastoplasticMuI, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::elastoplasticMuI::elastoplasticMuI
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    granularModel(coeffs, false),
    strength_(coeffs, elasticity_),
    rheology_(coeffs, rhoS_, d_, true),
    suspension_(coeffs, 1/(1 + strength_.eRef()))
{
    wordList own(criticalState::keywords());
    own.append(muIRheology::keywords(true));
    own.append(denseSuspension::keywords());
    checkKeywords(coeffs, keywords(false, own), strictKeywords);

    readBounded(coeffs, "PhiC", dimless, 1/(1 + e0_), 1, false, true);
    warnUnusual
    (
        coeffs,
        {
            {"nu", 0.2, 0.25, "the paper's Table A1"},
            {"n", 0.5, 0.7, "the paper's Table A1"}
        }
    );

    loosestContact_ = strength_.eRef();
    settledContact_ = strength_.eRef();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<int dim>
Foam::scalar Foam::mpm::elastoplasticMuI::startStrain
(
    const scalar* s,
    const scalar q,
    const scalar p,
    const scalar e
) const
{
    const criticalState::lodeAngle theta
    (
        determinant<dim>(s)/max(q*q*q, VSMALL)
    );
    const scalar Mp = strength_.peak
    (
        strength_.stateParameter(strength_.pressureTerm(p), e), theta
    );
    if (!(q < Mp*p))
    {
        FatalIOErrorInFunction(coeffs_)
            << "start stress: q/p has the value " << q/p << " at p = " << p
            << " Pa and the void ratio " << e << '.' << nl
            << "    Allowed: 0 <= q/p < " << Mp
            << ", the peak strength there" << exit(FatalIOError);
    }
    return strength_.kp(p)*q/(Mp*p - q);
}


void Foam::mpm::elastoplasticMuI::initialise
(
    const label dim,
    soilPoints& points
) const
{
    initialiseWith(*this, dim, points);
}


void Foam::mpm::elastoplasticMuI::update
(
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    updateWith(*this, dim, points, deltaT);
}

// ************************************************************************* //
