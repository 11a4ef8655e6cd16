/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "granularElasticity.H"
#include "dictionaryEntries.H"
#include "debug.H"
#include "registerSwitch.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

int Foam::mpm::granularElasticity::exactPressureLaw
(
    Foam::debug::debugSwitch("mpmExactPressureLaw", 1)
);

static Foam::RegisterSwitch<int> addExactPressureLaw
(
    Foam::debug::addDebugObject,
    "mpmExactPressureLaw",
    Foam::mpm::granularElasticity::exactPressureLaw
);


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- op(law) with the law as a compile-time constant
template<class Op>
Foam::scalar forLaw(const Foam::mpm::granularElasticity::law l, const Op& op)
{
    using E = Foam::mpm::granularElasticity;
    switch (l)
    {
        case E::constantLaw:
            return op(std::integral_constant<E::law, E::constantLaw>());
        case E::squareRootLaw:
            return op(std::integral_constant<E::law, E::squareRootLaw>());
        default:
            return op(std::integral_constant<E::law, E::powerLaw>());
    }
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::granularElasticity::granularElasticity
(
    const dictionary& coeffs,
    const scalar rhoS,
    const bool constantAllowed
)
:
    law_(powerLaw),
    nu_(readBounded(coeffs, "nu", dimless, 0, 0.5, true)),
    n_(0),
    shearRatio_(1.5*(1 - 2*nu_)/(1 + nu_)),
    rhoS_(rhoS),
    maxBulk_(VGREAT),
    rateForm_(!exactPressureLaw),
    uniform_(!rateForm_)
{
    if (rateForm_)
    {
        WarningInFunction
            << "DebugSwitches: mpmExactPressureLaw 0" << nl
            << "    The pressure of soil is not integrated exactly. Results"
            << " are not to be trusted." << endl;
    }
    scalar E = 0;
    if (constantAllowed && coeffs.found("E"))
    {
        law_ = constantLaw;
        E = readPositive(coeffs, "E", dimPressure);
        for (const char* other : {"E0", "n", "pE"})
        {
            if (coeffs.found(other))
            {
                FatalIOErrorInFunction(coeffs)
                    << "keyword " << other << " beside E." << nl
                    << "    Allowed: E, or E0 with n and pE"
                    << exit(FatalIOError);
            }
        }
    }
    else
    {
        n_ = readBoundedOrDefault(coeffs, "n", dimless, 0.5, 0, 1, true);
        E = readPositive(coeffs, "E0", dimless)*std::pow(pAt, 1 - n_);
        if (n_ == 0.5) law_ = squareRootLaw;
    }
    bulk_ = E/(3*(1 - 2*nu_));
    warnUnusual
    (
        coeffs,
        {
            {"E", 5e4, 1e10, "soils, in Pa"},
            {"E0", 20, 2000, "sands, dimensionless"},
            {"nu", 0.05, 0.45, "soils"}
        }
    );

    const scalar pE = readBoundedOrDefault
    (
        coeffs, "pE", dimPressure, 10, 0, GREAT
    );
    forLaw
    (
        law_,
        [&](auto l)
        {
            uncapped_ = makeRange<decltype(l)::value>(pE, VGREAT, VGREAT);
            return scalar(0);
        }
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::granularElasticity::keywords
(
    const bool constantAllowed
)
{
    wordList names({"E0", "n", "nu", "pE"});
    if (constantAllowed) names.append("E");
    return names;
}


void Foam::mpm::granularElasticity::limitWaveSpeed(const scalar maxSpeed)
{
    maxBulk_ = maxSpeed*maxSpeed*rhoS_/(1 + 4*shearRatio_/3);
    uniform_ = !capped() && !rateForm_;
}


Foam::scalar Foam::mpm::granularElasticity::bulkModulus
(
    const scalar p,
    const scalar e
) const
{
    return forLaw
    (
        law_,
        [&](auto l)
        {
            constexpr law L = decltype(l)::value;
            return coefficient<L>(e)*stiffness<L>(p, rangeAt<L>(e));
        }
    );
}


Foam::scalar Foam::mpm::granularElasticity::compressedModulus
(
    const scalar compression,
    const scalar e
) const
{
    return forLaw
    (
        law_,
        [&](auto l)
        {
            constexpr law L = decltype(l)::value;
            const scalar a = coefficient<L>(e);
            scalar k;
            pressure<L>(a*compression, rangeAt<L>(e), k);
            return a*k;
        }
    );
}


Foam::scalar Foam::mpm::granularElasticity::compression
(
    const scalar p,
    const scalar e
) const
{
    return forLaw
    (
        law_,
        [&](auto l)
        {
            constexpr law L = decltype(l)::value;
            return measure<L>(p, rangeAt<L>(e))/coefficient<L>(e);
        }
    );
}


Foam::scalar Foam::mpm::granularElasticity::volumetricEnergy
(
    const scalar p,
    const scalar e
) const
{
    return forLaw
    (
        law_,
        [&](auto l)
        {
            constexpr law L = decltype(l)::value;
            const scalar a = coefficient<L>(e);
            if constexpr (L == constantLaw) return p*p/(2*a);

            const range r = rangeAt<L>(e);
            const scalar low = min(p, r.pE);
            scalar sum = low*low/(2*r.kE);
            if (p > r.pE)
            {
                const scalar middle = min(p, r.pC);
                sum +=
                    (std::pow(middle, 2 - n_) - std::pow(r.pE, 2 - n_))
                   /(2 - n_);
            }
            if (p > r.pC) sum += (p*p - r.pC*r.pC)/(2*r.kC);
            return sum/a;
        }
    );
}

// ************************************************************************* //
