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
    strength_(coeffs),
    rheology_(coeffs, rhoS_, d_, true)
{
    wordList own(criticalState::keywords());
    own.append(muIRheology::keywords(true));
    checkKeywords(coeffs, keywords(false, own), strictKeywords);

    readBounded(coeffs, "PhiC", dimless, 1/(1 + e0_), 1, false, true);
    warnOutside
    (
        coeffs, "nu", elasticity_.nu(), 0.2, 0.25, "the paper's Table A1"
    );
    warnOutside
    (
        coeffs, "n", elasticity_.n(), 0.5, 0.7, "the paper's Table A1"
    );

    loosestContact_ = strength_.eRef();
    settledContact_ = strength_.eRef();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<int dim>
void Foam::mpm::elastoplasticMuI::findStrengths
(
    const soilPoints& points,
    const label first,
    const label last,
    const scalar deltaT,
    strengthBlock& block
) const
{
    const scalar* const open = points.state[CONTACT_VOID_RATIO];
    // Separated points need none, unless they close in this step; counts, not
    // flags, make vector loops
    const scalar* const* L = points.velocityGradient;
    int64_t needed = 0;
    for (label i = first; i < last; ++i)
    {
        const scalar trace =
            dim == 2 ? L[0][i] + L[3][i] : L[0][i] + L[4][i] + L[8][i];
        needed += (open[i] <= 0) | (trace < 0);
    }
    if (!needed) return;

    const scalar* const xx = points.stress[0] + first;
    const scalar* const yy = points.stress[1] + first;
    const scalar* const zz = points.stress[2] + first;
    const scalar* const voidRatio = points.voidRatio + first;
    const scalar* const Lxx = points.velocityGradient[0] + first;
    const scalar* const Lyy = points.velocityGradient[dim == 2 ? 3 : 4] + first;
    const scalar* const Lzz = points.velocityGradient[dim == 2 ? 0 : 8] + first;

    for (label j = 0; j < last - first; ++j)
    {
        const scalar p = max(-(xx[j] + yy[j] + zz[j])/3, pRes_);
        const scalar trace = Lxx[j] + Lyy[j] + (dim == 2 ? 0 : Lzz[j]);
        // The volume to second order serves the strength
        const scalar x = trace*deltaT;
        const scalar e = max
        (
            (1 + voidRatio[j])*(1 + x*(1 + 0.5*x)) - 1, minVoidRatio
        );
        const scalar term = strength_.columnPressureTerm(p);
        const scalar state = strength_.columnState(term, e);
        block.pressureTerm[j] = term;
        block.tanPeak[j] = strength_.columnTanPeak(state);
        block.tanTransformation[j] = strength_.columnTanTransformation(state);
    }
}


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
    return strength_.kp()*q/(Mp*p - q);
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
