/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "adaptiveSubstepping.H"

// Distance from the yield surface, over q, that counts as none: the Lode angle
// of triaxial stress has rounding errors of 1e-8
static const Foam::scalar onSurface = 1e-7;

static const Foam::label maxSubsteps = 2000000;

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<int dim>
Foam::scalar Foam::mpm::adaptiveSubstepping::peakAt
(
    const evolving<dim>& y,
    const scalar* direction
) const
{
    const scalar q = std::sqrt(1.5*doubleDot<dim>(direction, direction));
    const criticalState::lodeAngle theta
    (
        determinant<dim>(direction)/max(q*q*q, VSMALL)
    );
    return strength_.peak
    (
        strength_.stateParameter(strength_.pressureTerm(y.p()), y.e()), theta
    );
}


template<int dim>
Foam::scalar Foam::mpm::adaptiveSubstepping::yieldAt
(
    const evolving<dim>& y,
    const scalar* direction
) const
{
    return peakAt(y, direction)*y.p()
       *y.plasticStrain()/(strength_.kp(y.p()) + y.plasticStrain());
}


template<int dim, Foam::mpm::granularElasticity::law L>
bool Foam::mpm::adaptiveSubstepping::rates
(
    const increment<dim>& step,
    const evolving<dim>& y,
    const bool plastic,
    evolving<dim>& rate
) const
{
    constexpr int n = nComponents<dim>;

    const auto limits = elasticity_.rangeAt<L>(y.e());
    const scalar K =
        elasticity_.coefficient<L>(y.e())
       *elasticity_.stiffness<L>(y.p(), limits);
    const scalar G = elasticity_.shearRatio()*K;

    for (int c = 0; c < n; ++c) rate.v[c] = 2*G*step.de[c];
    rate.p() = K*step.contraction;
    rate.plasticStrain() = 0;
    rate.e() = -(1 + y.e())*step.contraction;

    if (!plastic) return true;

    const scalar q = y.q();
    const scalar deq = std::sqrt(doubleDot<dim>(step.de, step.de)*2/3);

    // Without a deviator yet, flow is along the strain rate
    const bool isotropic = q <= 1e-12*y.p();
    const scalar* direction = isotropic ? step.de : y.s();
    const scalar size = isotropic ? 1.5*deq : q;
    if (size <= 0) return false;

    const scalar Mp = peakAt(y, direction);
    const scalar kp = strength_.kp(y.p());
    const scalar hardening =
        Mp*kp/((kp + y.plasticStrain())*(kp + y.plasticStrain()));
    const scalar H = Mp*y.plasticStrain()/(kp + y.plasticStrain());

    const criticalState::lodeAngle theta
    (
        determinant<dim>(direction)
       /std::pow
        (
            std::sqrt(1.5*doubleDot<dim>(direction, direction)), 3
        )
    );
    const scalar Mpt = strength_.transformation
    (
        strength_.stateParameter(strength_.pressureTerm(y.p()), y.e()), theta
    );
    const scalar dilation = strength_.Ad()*(H - Mpt);

    // d(yield)/dt at constant plastic strain along the elastic rates, and
    // along dp
    const scalar yield = H*y.p();
    const scalar h =
        1e-6/max(mag(rate.p())/y.p() + 2*G*deq/max(q, y.p()), VSMALL);
    evolving<dim> there = y;
    for (int c = 0; c < n + 3; ++c) there.v[c] += h*rate.v[c];

    // Rounding in the Lode angle is large at its ends: where strain rate and
    // stress have one direction, it stays
    const scalar projection = doubleDot<dim>(direction, step.de);
    const bool coaxial =
        1 - projection*projection
       /(
            doubleDot<dim>(direction, direction)
           *doubleDot<dim>(step.de, step.de) + VSMALL
        ) < 1e-10;
    const scalar yieldRate =
        (yieldAt(there, coaxial ? direction : there.s()) - yield)/h;

    there = y;
    there.p() *= 1 + 1e-6;
    const scalar yieldSlope = (yieldAt(there, direction) - yield)/(1e-6*y.p());

    const scalar loading =
        1.5*doubleDot<dim>(direction, rate.s())/size - yieldRate;
    if (loading <= 0) return false;

    const scalar dl = loading
       /(3*G + hardening*y.p() + yieldSlope*K*dilation);

    for (int c = 0; c < n; ++c) rate.v[c] -= 3*G*dl*direction[c]/size;
    rate.p() += K*dilation*dl;
    rate.plasticStrain() = dl;
    return true;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::adaptiveSubstepping::adaptiveSubstepping
(
    const dictionary& coeffs,
    const bool strictKeywords,
    const scalar tolerance
)
:
    elastoplasticMuI(coeffs, strictKeywords),
    tolerance_(tolerance)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<int dim, Foam::mpm::granularElasticity::law L>
bool Foam::mpm::adaptiveSubstepping::integrate
(
    const label j,
    granularBlock<dim>& block,
    granularStep& result
) const
{
    constexpr int n = nComponents<dim>;

    increment<dim> step;
    evolving<dim> y;
    for (int c = 0; c < n; ++c)
    {
        step.de[c] = block.D[c][j]*block.time[j];
        y.v[c] = block.s[c][j];
    }
    step.contraction = -block.trace[j]*block.time[j];
    y.p() = block.p[j];
    y.plasticStrain() = result.plasticStrain;
    y.e() = block.e0[j];

    const scalar deq = std::sqrt(doubleDot<dim>(step.de, step.de)*2/3);

    scalar t = 0, h = 1;
    bool plastic =
        y.q() >= yieldAt(y, y.q() > 0 ? y.s() : step.de)*(1 - onSurface);

    for (label substep = 0; t < 1; ++substep)
    {
        if (substep > maxSubsteps)
        {
            FatalErrorInFunction
                << "more than " << maxSubsteps << " substeps at p = " << y.p()
                << " Pa, q = " << y.q() << " Pa, void ratio " << y.e()
                << ", strain increment " << deq << exit(FatalError);
        }
        h = min(h, 1 - t);

        // At the least pressure: liquefied, or contact is lost
        if (y.p() <= pRes_*(1 + 1e-9))
        {
            const scalar Mp = peakAt(y, step.de);
            const criticalState::lodeAngle theta
            (
                determinant<dim>(step.de)/max(std::pow(1.5*deq, 3), VSMALL)
            );
            const scalar Mpt = strength_.transformation
            (
                strength_.stateParameter
                (
                    strength_.pressureTerm(pRes_), y.e()
                ),
                theta
            );
            const scalar H =
                Mp*y.plasticStrain()
               /(strength_.kp(y.p()) + y.plasticStrain());

            if (step.contraction + strength_.Ad()*(H - Mpt)*deq <= 0)
            {
                if (step.contraction < 0)
                {
                    result.contactVoidRatio = y.e();
                    return false;
                }
                const scalar dt = min(1 - t, deq > 0 ? 1e-6/deq : 1);
                y.plasticStrain() += deq*dt;
                y.e() = (1 + y.e())*std::exp(-step.contraction*dt) - 1;
                y.p() = pRes_;
                const scalar q = yieldAt(y, step.de);
                for (int c = 0; c < n; ++c)
                {
                    y.v[c] = deq > 0 ? q*step.de[c]/(1.5*deq) : 0;
                }
                t += dt;
                h = 1e-9;
                plastic = true;
                continue;
            }
        }

        // Bogacki and Shampine
        evolving<dim> k1, k2, k3, k4, z;
        if (plastic && !rates<dim, L>(step, y, true, k1)) plastic = false;
        if (!plastic) rates<dim, L>(step, y, false, k1);

        auto stage = [&](const scalar a, const scalar b, const scalar c)
        {
            for (int i = 0; i < z.size; ++i)
            {
                z.v[i] = y.v[i] + h*(a*k1.v[i] + b*k2.v[i] + c*k3.v[i]);
            }
            z.p() = max(z.p(), pRes_);
        };
        k2 = k1;
        k3 = k1;
        stage(0.5, 0, 0);
        rates<dim, L>(step, z, plastic, k2);
        stage(0, 0.75, 0);
        rates<dim, L>(step, z, plastic, k3);
        stage(2.0/9, 3.0/9, 4.0/9);
        rates<dim, L>(step, z, plastic, k4);

        const scalar sizes[2] = {max(z.p(), z.q()), z.plasticStrain() + 1e-8};
        scalar error = 0;
        for (int i = 0; i < n + 2; ++i)
        {
            const scalar d = h*mag
            (
                (2.0/9 - 7.0/24)*k1.v[i] + (1.0/3 - 1.0/4)*k2.v[i]
              + (4.0/9 - 1.0/3)*k3.v[i] - k4.v[i]/8
            );
            error = max(error, d/(i < n + 1 ? sizes[0] : sizes[1]));
        }
        const scalar factor = 0.9*std::cbrt(tolerance_/max(error, VSMALL));
        if (error > tolerance_ && h > 1e-14)
        {
            h *= max(factor, scalar(0.2));
            continue;
        }

        if (!plastic)
        {
            const scalar q = z.q();
            const scalar yield = yieldAt(z, q > 0 ? z.s() : step.de);
            if (q > yield*(1 + onSurface))
            {
                // Shorten the step until it ends on the yield surface
                if (h > 1e-13)
                {
                    h *= 0.5;
                    continue;
                }
                plastic = true;
            }
        }
        else
        {
            const scalar q = z.q();
            if (q > 0)
            {
                const scalar scale = yieldAt(z, z.s())/q;
                for (int c = 0; c < n; ++c) z.v[c] *= scale;
            }
        }
        t += h;
        y = z;
        h *= min(max(factor, scalar(0.2)), scalar(4));
    }

    for (int c = 0; c < n; ++c) block.s[c][j] = y.v[c];
    result.p = y.p();
    result.plasticStrain = y.plasticStrain();
    result.k = elasticity_.stiffness<L>
    (
        y.p(), elasticity_.rangeAt<L>(y.e())
    );
    return true;
}


void Foam::mpm::adaptiveSubstepping::update
(
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    updateWith(*this, dim, points, deltaT);
}

// ************************************************************************* //
