/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "granularModel.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

inline Foam::scalar Foam::mpm::granularModel::viscosityFactor
(
    const scalar e
) const
{
    // Intrinsic viscosity 2.5, densest suspension 0.64
    return KriegerDougherty_ ? std::pow(1 - 1/(0.64*(1 + e)), -1.6) : 1;
}


template<class Model, int dim, Foam::mpm::granularElasticity::law L>
bool Foam::mpm::granularModel::contactStep
(
    const Model& model,
    const typename Model::strengthBlock& strengths,
    const label j,
    granularStep<dim>& step
) const
{
    constexpr int n = nComponents<dim>;

    // Of q; the plastic strain is wrong by as much of the elastic strain. The
    // stress lies on the yield surface in any case
    constexpr scalar tolerance = 1e-6;
    constexpr int maxIterations = 100;

    // Error of the direction whose strength counts; the strength errs by less
    // than twice as much
    constexpr scalar maxTurn = 2e-3;

    const auto& limits = step.limits;

    const scalar pStart = step.p;
    const scalar kStart = elasticity_.stiffness<L>(pStart, limits);
    const scalar XStart = elasticity_.measure<L>(pStart, limits);
    const scalar XRes = elasticity_.measure<L>(pRes_, limits);
    const scalar XTrial = XStart + step.a*step.contraction;

    // p(plastic contraction), k and whether the floor is reached
    auto pressureAt = [&](const scalar plastic, scalar& k)
    {
        const scalar X = XTrial - step.a*plastic;
        return elasticity_.pressure<L>(max(X, XRes), limits, k);
    };

    // q of the trial stress for any G: q^2 = c0 + 2 c1 G + c2 G^2
    const scalar c0 = 1.5*doubleDot<dim>(step.s, step.s);
    const scalar c1 = 3*doubleDot<dim>(step.s, step.de);
    const scalar c2 = 6*doubleDot<dim>(step.de, step.de);

    const scalar halfModulus = 0.5*elasticity_.shearRatio()*step.a;

    scalar k;
    scalar p = pressureAt(0, k);
    scalar G = halfModulus*(kStart + k);
    scalar q = std::sqrt(max(c0 + G*(2*c1 + G*c2), scalar(0)));

    scalar sTrial[n];
    for (int c = 0; c < n; ++c) sTrial[c] = step.s[c] + 2*G*step.de[c];

    typename Model::template flowRule<dim> flow
    (
        model, strengths, j, step, sTrial, q, pStart, p
    );

    scalar dH, dPlastic;
    scalar scale = 1;
    step.plasticContraction = 0;

    const scalar HTrial = flow.ratio(0, dH);
    if (q > HTrial*p)
    {
        flow.setDilatancy();

        // d(residual)/d(dl), at the floor of the pressure or above
        auto slopeAt = [&](const scalar dl, const bool floor, const scalar H)
        {
            const scalar dX = floor ? 0 : -step.a*dPlastic;
            const scalar dG =
                halfModulus*elasticity_.stiffnessSlope<L>(p, k, limits)*dX;
            return (c1 + G*c2)*dG/q - 3*(G + dG*dl) - dH*p - H*k*dX;
        };

        // Beyond this even the softest elastic strain is used up
        const scalar farthest =
            std::sqrt(c2)/3 + std::sqrt(c0)/(3*halfModulus*kStart);

        scalar lower = 0, upper = farthest;

        // The first iterate, from the trial state
        flow.contraction(0, dPlastic);
        scalar dl =
            (HTrial*p - q)/slopeAt(0, XTrial <= XRes, HTrial);
        if (!(dl > lower && dl < upper)) dl = 0.5*upper;

        // Modulus that gave the direction of the trial stress
        scalar GTrial = G;
        bool converged = false;

        // Strength of the pressure and the direction found
        auto refresh = [&]()
        {
            for (int c = 0; c < n; ++c)
            {
                sTrial[c] = step.s[c] + 2*G*step.de[c];
            }
            GTrial = G;
            flow.refresh(p, sTrial, q);
        };

        for (int i = 0; i < maxIterations; ++i)
        {
            const scalar plastic = flow.contraction(dl, dPlastic);
            const bool floor = XTrial - step.a*plastic <= XRes;
            p = pressureAt(plastic, k);
            G = halfModulus*(kStart + k);
            q = std::sqrt(max(c0 + G*(2*c1 + G*c2), VSMALL));

            const scalar H = flow.ratio(dl, dH);
            const scalar residual = q - 3*G*dl - H*p;
            scale = min(H*p/q, scalar(1));
            step.plasticContraction = plastic;

            if (mag(residual) <= tolerance*q || upper - lower <= 1e-15*farthest)
            {
                // The strength at another pressure, and on from here
                // Angle by which another G turns the trial stress, squared
                const scalar turn =
                    Model::strengthOfDirection
                  ? sqr((G - GTrial)/(q*q))*(c0*c2 - c1*c1)
                  : 0;
                if (!flow.stale(p) && turn < maxTurn*maxTurn)
                {
                    converged = true;
                    break;
                }
                refresh();
                lower = 0;
                upper = farthest;
                continue;
            }
            (residual > 0 ? lower : upper) = dl;

            dl -= residual/slopeAt(dl, floor, H);
            if (!(dl > lower && dl < upper)) dl = 0.5*(lower + upper);
        }
        if (!converged)
        {
            // Pressure and strength chase each other, in strain increments
            // that compress to tens of MPa: at least stay within the strength
            refresh();
            scale = min(flow.ratio(dl, dH)*p/q, scalar(1));
        }
        step.plasticStrain += dl;
    }
    else if (flow.stale(p))
    {
        // Elastic by a strength that belongs to another pressure
        flow.refresh(p, sTrial, q);
        const scalar H = flow.ratio(0, dH);
        if (q > H*p) scale = H*p/q;
    }

    // Contact is lost where expansion leaves no pressure; what rounding makes
    // of a strain of constant volume is no expansion
    if (step.contraction < -1e-9*std::sqrt(c2))
    {
        const scalar lost = step.plasticContraction - step.contraction;
        const scalar stored = (XStart - XRes)/step.a;
        if (lost >= stored)
        {
            // Moduli in the middle of the part with contact, as on the way
            // back: else cycles would pump
            scalar part = lost > 0 ? stored/lost : 0;
            for (int i = 0; i < 3; ++i)
            {
                part = min(part, scalar(1));
                step.contactVoidRatio =
                    (1 + step.e0)*expStrain(-part*step.contraction) - 1;
                if (lost <= 0) break;
                part = (XStart - XRes)/lost
                   /elasticity_.coefficient<L>
                    (
                        0.5*(step.e0 + step.contactVoidRatio)
                    );
            }
            return false;
        }
    }

    for (int c = 0; c < n; ++c)
    {
        step.s[c] = scale*(step.s[c] + 2*G*step.de[c]);
    }
    step.p = p;
    step.k = k;
    return true;
}


template<class Model, int dim, Foam::mpm::granularElasticity::law L>
void Foam::mpm::granularModel::advance
(
    const Model& model,
    soilPoints& points,
    const scalar deltaT
) const
{
    constexpr int n = nComponents<dim>;

    scalar* const* stress = points.stress;
    scalar* const* whole = points.wholeStress;
    scalar* const plasticStrain = points.state[PLASTIC_STRAIN];
    scalar* const contactVoidRatio = points.state[CONTACT_VOID_RATIO];
    scalar* const regimes = points.state[REGIME];
    scalar* const inertialNumber = points.state[INERTIAL_NUMBER];

    scalar maxModulus = 0;
    scalar maxViscosity = 0;

    typename Model::strengthBlock strengths;

    for (label i = 0; i < points.n; ++i)
    {
        const label j = i % strengthBlockSize;
        if (j == 0)
        {
            model.template findStrengths<dim>
            (
                points, i, min(points.n, i + strengthBlockSize), deltaT,
                strengths
            );
        }
        const soilRates<dim> rates(points, i);
        const scalar trace = rates.trace();
        const scalar e0 = points.voidRatio[i];
        // In this form constant volume keeps e to the last digit
        scalar e = e0 + (1 + e0)*(expStrain(trace*deltaT) - 1);

        scalar de[n];
        for (int c = 0; c < n; ++c)
        {
            de[c] = rates.D[c] - (c < 3 ? trace/3 : 0);
        }
        const scalar shearRateSqr = 0.5*doubleDot<dim>(de, de);

        // Stress without and with its viscous part
        scalar p = 0;
        scalar sum[n] = {};
        scalar I = 0;
        label where = separated;

        const scalar open = contactVoidRatio[i];
        bool carries = false;
        if (open > 0 && e >= open)
        {
            // Void ratio grows without end while nothing holds the point
            // together; where the grid shows more grains, it is right
            if (points.solidFraction)
            {
                e = min(e, 1/max(points.solidFraction[i], SMALL) - 1);
                e = max(e, open);
            }
        }
        else if (e <= suspendedVoidRatio_)
        {
            granularStep<dim> step;
            scalar part = 1;
            if (open > 0)
            {
                // Closes in this step; strain counts from there
                part = min
                (
                    scalar(1),
                    std::log((1 + open)/(1 + e))
                   /max(-trace*deltaT, VSMALL)
                );
                for (int c = 0; c < n; ++c) step.s[c] = 0;
                step.p = pRes_;
                step.plasticStrain = 0;
                step.e0 = open;
            }
            else
            {
                for (int c = 0; c < n; ++c) step.s[c] = stress[c][i];
                rotate<dim>(step.s, rates.spin, deltaT);
                const scalar mean = (step.s[0] + step.s[1] + step.s[2])/3;
                for (int c = 0; c < 3; ++c) step.s[c] -= mean;
                step.p = -mean;
                step.plasticStrain = plasticStrain[i];
                step.e0 = e0;
            }
            const scalar time = part*deltaT;
            for (int c = 0; c < n; ++c) step.de[c] = de[c]*time;
            step.contraction = -trace*time;
            step.deltaT = time;
            step.e = e;
            const scalar middle = 0.5*(step.e0 + e);
            step.a = elasticity_.coefficient<L>(middle);
            step.limits = elasticity_.rangeAt<L>(middle);

            if constexpr (Model::ownIntegrator)
            {
                carries = model.template integrate<dim, L>(step);
            }
            else
            {
                carries = contactStep<Model, dim, L>
                (
                    model, strengths, j, step
                );
            }
            if (carries)
            {
                p = step.p;
                for (int c = 0; c < n; ++c)
                {
                    sum[c] = step.s[c] - (c < 3 ? p : 0);
                    stress[c][i] = sum[c];
                }
                plasticStrain[i] = step.plasticStrain;
                contactVoidRatio[i] = 0;
                maxModulus = max(maxModulus, step.a*step.k*(1 + e));
                where = staticBed;
            }
            else
            {
                contactVoidRatio[i] =
                    step.e0 < loosestContact_
                  ? min(step.contactVoidRatio, loosestContact_)
                  : step.contactVoidRatio;
            }
        }

        if (!carries)
        {
            for (int c = 0; c < n; ++c) stress[c][i] = 0;
            plasticStrain[i] = 0;
            if (e > suspendedVoidRatio_)
            {
                contactVoidRatio[i] = settledContact_;
                where = suspended;
            }
        }
        points.voidRatio[i] = e;

        // Viscous part
        if (where == suspended)
        {
            if (points.liquidViscosity > 0)
            {
                const scalar mu = points.liquidViscosity*viscosityFactor(e);
                for (int c = 0; c < n; ++c) sum[c] = 2*mu*de[c];
                maxViscosity = max(maxViscosity, mu*(1 + e));
            }
        }
        else if (shearRateSqr > 0)
        {
            if constexpr (Model::hasViscousPart)
            {
                maxViscosity = max
                (
                    maxViscosity,
                    model.template viscousStress<dim>
                    (
                        de, shearRateSqr, e, p, sum, I
                    )*(1 + e)
                );
            }
            else if (p > 0)
            {
                I = 2*d_*std::sqrt(shearRateSqr*rhoS_/p);
            }
        }
        if
        (
            where == staticBed
         && (I > bedLoadI_ || (points.speed && points.speed[i] > bedLoadSpeed_))
        )
        {
            where = bedLoad;
        }
        regimes[i] = where;
        inertialNumber[i] = I;

        for (int c = 0; c < n; ++c) whole[c][i] = sum[c];
        if (points.power) points.power[i] = doubleDot<dim>(sum, rates.D);
    }

    points.maxWaveSpeedSqr = elasticity_.waveSpeedSqr(maxModulus, 0);
    points.maxViscosity = maxViscosity/rhoS_;
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

template<class Model>
void Foam::mpm::granularModel::updateWith
(
    const Model& model,
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    using E = granularElasticity;
    auto ofLaw = [&](auto l)
    {
        constexpr E::law L = decltype(l)::value;
        if (dim == 2) advance<Model, 2, L>(model, points, deltaT);
        else advance<Model, 3, L>(model, points, deltaT);
    };
    switch (elasticity_.type())
    {
        case E::squareRootLaw:
            ofLaw(std::integral_constant<E::law, E::squareRootLaw>());
            break;
        case E::powerLaw:
            ofLaw(std::integral_constant<E::law, E::powerLaw>());
            break;
        case E::constantLaw:
            ofLaw(std::integral_constant<E::law, E::constantLaw>());
            break;
    }
}


template<class Model>
void Foam::mpm::granularModel::initialiseWith
(
    const Model& model,
    const label dim,
    soilPoints& points
) const
{
    const label n = dim == 2 ? 4 : 6;

    for (label i = 0; i < points.n; ++i)
    {
        const scalar e = points.voidRatio[i];
        scalar s[6] = {};
        for (label c = 0; c < n; ++c) s[c] = points.stress[c][i];
        const scalar p = -(s[0] + s[1] + s[2])/3;
        for (label c = 0; c < 3; ++c) s[c] += p;
        const scalar q = std::sqrt
        (
            1.5*(dim == 2 ? doubleDot<2>(s, s) : doubleDot<3>(s, s))
        );

        points.state[PLASTIC_STRAIN][i] = 0;
        points.state[CONTACT_VOID_RATIO][i] = 0;
        points.state[INERTIAL_NUMBER][i] = 0;
        points.state[REGIME][i] = staticBed;

        if (e > suspendedVoidRatio_ || (p <= pRes_ && q <= pRes_))
        {
            // Touching grains without stress carry as soon as e falls
            const bool floats = e > suspendedVoidRatio_;
            for (label c = 0; c < n; ++c) points.stress[c][i] = 0;
            points.state[CONTACT_VOID_RATIO][i] =
                floats ? settledContact_ : e;
            points.state[REGIME][i] = floats ? suspended : separated;
        }
        else
        {
            points.state[PLASTIC_STRAIN][i] =
                dim == 2
              ? model.template startStrain<2>(s, q, p, e)
              : model.template startStrain<3>(s, q, p, e);
        }
        for (label c = 0; c < n; ++c)
        {
            points.wholeStress[c][i] = points.stress[c][i];
        }
    }
}

// ************************************************************************* //
