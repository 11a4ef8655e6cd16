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


inline Foam::scalar Foam::mpm::granularModel::liquidViscosity
(
    const soilPoints& points,
    const label i
) const
{
    return
        points.saturation
      ? points.liquidViscosity*points.saturation[i]
      : points.liquidViscosity;
}


template<int dim>
void Foam::mpm::granularModel::loadBlock
(
    const soilPoints& points,
    const label first,
    const label nPoints,
    const scalar deltaT,
    granularBlock<dim>& block
) const
{
    const scalar* const* L = points.velocityGradient;
    const scalar* const voidRatio = points.voidRatio + first;

    // Columns of the deviator, and the trace
    #pragma GCC ivdep
    for (label j = 0; j < nPoints; ++j)
    {
        const label i = first + j;
        scalar xx, yy, zz, shear;
        if constexpr (dim == 2)
        {
            xx = L[0][i];
            yy = L[3][i];
            zz = 0;
            const scalar xy = 0.5*(L[1][i] + L[2][i]);
            block.D[3][j] = xy;
            block.spin[0][j] = 0.5*(L[1][i] - L[2][i]);
            shear = xy*xy;
        }
        else
        {
            xx = L[0][i];
            yy = L[4][i];
            zz = L[8][i];
            const scalar xy = 0.5*(L[1][i] + L[3][i]);
            const scalar yz = 0.5*(L[5][i] + L[7][i]);
            const scalar zx = 0.5*(L[6][i] + L[2][i]);
            block.D[3][j] = xy;
            block.D[4][j] = yz;
            block.D[5][j] = zx;
            block.spin[0][j] = 0.5*(L[1][i] - L[3][i]);
            block.spin[1][j] = 0.5*(L[5][i] - L[7][i]);
            block.spin[2][j] = 0.5*(L[6][i] - L[2][i]);
            shear = xy*xy + yz*yz + zx*zx;
        }
        const scalar trace = xx + yy + zz;
        xx -= trace/3;
        yy -= trace/3;
        zz -= trace/3;
        block.D[0][j] = xx;
        block.D[1][j] = yy;
        block.D[2][j] = zz;
        block.trace[j] = trace;
        block.shearRateSqr[j] = 0.5*(xx*xx + yy*yy + zz*zz) + shear;

        // In this form constant volume keeps e to the last digit
        const scalar e0 = voidRatio[j];
        block.e0[j] = e0;
        block.e[j] = e0 + (1 + e0)*smallExpM1(trace*deltaT);
    }

    for (label j = 0; j < nPoints; ++j)
    {
        const scalar x = block.trace[j]*deltaT;
        if (!(mag(x) < maxSmallStrain))
        {
            block.e[j] = block.e0[j] + (1 + block.e0[j])*(std::exp(x) - 1);
        }
    }
}


template<int dim>
inline void Foam::mpm::granularModel::loadStress
(
    const soilPoints& points,
    const label i,
    const label j,
    const scalar deltaT,
    granularBlock<dim>& block
) const
{
    constexpr int n = nComponents<dim>;
    scalar s[n];
    scalar spin[dim == 2 ? 1 : 3];
    for (int c = 0; c < n; ++c) s[c] = points.stress[c][i];
    for (int c = 0; c < (dim == 2 ? 1 : 3); ++c) spin[c] = block.spin[c][j];
    rotate<dim>(s, spin, deltaT);
    const scalar mean = (s[0] + s[1] + s[2])/3;
    for (int c = 0; c < n; ++c) block.s[c][j] = s[c] - (c < 3 ? mean : 0);
    block.p[j] = max(-mean, pRes_);
}


template<int dim, Foam::mpm::granularElasticity::law L, bool uniform>
inline void Foam::mpm::granularModel::trial
(
    const label j,
    const scalar time,
    granularBlock<dim>& block
) const
{
    constexpr int n = nComponents<dim>;

    const scalar middle = 0.5*(block.e0[j] + block.e[j]);
    const scalar p = block.p[j];
    const granularElasticity::range limits =
        uniform
      ? elasticity_.uncapped()
      : elasticity_.rangeOfStep<L>(middle, p);

    const scalar a = elasticity_.coefficient<L>(middle);
    const scalar kStart = elasticity_.stiffness<L>(p, limits);
    const scalar XStart = elasticity_.measure<L>(p, limits);
    const scalar XRes = elasticity_.measure<L>(pRes_, limits);
    const scalar XTrial = XStart - a*block.trace[j]*time;

    scalar k;
    const scalar pTrial =
        elasticity_.pressure<L>(max(XTrial, XRes), limits, k);
    const scalar halfModulus = 0.5*elasticity_.shearRatio()*a;
    const scalar G = halfModulus*(kStart + k);

    scalar s[n], D[n], t[n];
    for (int c = 0; c < n; ++c)
    {
        s[c] = block.s[c][j];
        D[c] = block.D[c][j];
        t[c] = s[c] + 2*G*time*D[c];
    }

    // q of the trial stress for any G: q^2 = c0 + 2 c1 G + c2 G^2
    block.c0[j] = 1.5*doubleDot<dim>(s, s);
    block.c1[j] = 3*time*doubleDot<dim>(s, D);
    block.c2[j] = 12*time*time*block.shearRateSqr[j];
    const scalar q = std::sqrt(1.5*doubleDot<dim>(t, t));

    block.time[j] = time;
    block.a[j] = a;
    block.kStart[j] = kStart;
    block.XStart[j] = XStart;
    block.XRes[j] = XRes;
    block.XTrial[j] = XTrial;
    block.pTrial[j] = pTrial;
    block.kTrial[j] = k;
    block.G[j] = G;
    block.q[j] = q;
    block.determinantRatio[j] =
        determinant<dim>(t)/max(q*q*q, VSMALL);
}


template<class Model, int dim, Foam::mpm::granularElasticity::law L>
void Foam::mpm::granularModel::trialBlock
(
    const Model& model,
    const soilPoints& points,
    const label first,
    const label nPoints,
    const scalar deltaT,
    granularBlock<dim>& block,
    typename Model::strengthBlock& strengths
) const
{
    #pragma GCC ivdep
    for (label j = 0; j < nPoints; ++j)
    {
        loadStress<dim>(points, first + j, j, deltaT, block);
    }
    if (elasticity_.uniform())
    {
        #pragma GCC ivdep
        for (label j = 0; j < nPoints; ++j)
        {
            trial<dim, L, true>(j, deltaT, block);
        }
    }
    else
    {
        for (label j = 0; j < nPoints; ++j)
        {
            trial<dim, L, false>(j, deltaT, block);
        }
    }
    #pragma GCC ivdep
    for (label j = 0; j < nPoints; ++j)
    {
        model.findStrength(j, block, strengths);
    }
}


template<int dim>
inline void Foam::mpm::granularModel::trialStress
(
    const granularBlock<dim>& block,
    const label j,
    const scalar G,
    scalar* t
) const
{
    for (int c = 0; c < nComponents<dim>; ++c)
    {
        t[c] = block.s[c][j] + 2*G*block.time[j]*block.D[c][j];
    }
}


template
<
    class Model, int dim, Foam::mpm::granularElasticity::law L, class FlowRule
>
inline Foam::scalar Foam::mpm::granularModel::returnToYield
(
    FlowRule& flow,
    const scalar HTrial,
    scalar dH,
    scalar pdH,
    const label j,
    const granularBlock<dim>& block,
    contactState& state,
    scalar& plasticStrain
) const
{
    // Of q; the plastic strain is wrong by as much of the elastic strain. The
    // stress lies on the yield surface in any case
    constexpr scalar tolerance = 1e-6;
    constexpr int maxIterations = 100;

    // Error of the direction whose strength counts; the strength errs by less
    // than twice as much
    constexpr scalar maxTurn = 2e-3;

    scalar& p = state.p;
    scalar& k = state.k;
    scalar& G = state.G;
    scalar& q = state.q;

    const scalar a = block.a[j];
    const scalar kStart = block.kStart[j];
    const scalar XRes = block.XRes[j];
    const scalar XTrial = block.XTrial[j];
    const scalar c0 = block.c0[j], c1 = block.c1[j], c2 = block.c2[j];
    const scalar halfModulus = 0.5*elasticity_.shearRatio()*a;
    const granularElasticity::range limits =
        elasticity_.rangeOfStep<L>
        (
            0.5*(block.e0[j] + block.e[j]), block.p[j]
        );

    scalar dPlastic;
    scalar plasticContraction = 0;

    flow.setDilatancy();

    // d(residual)/d(dl), at the floor of the pressure or above
    auto slopeAt = [&](const scalar dl, const bool floor, const scalar H)
    {
        const scalar dX = floor ? 0 : -a*dPlastic;
        const scalar dG =
            halfModulus*elasticity_.stiffnessSlope<L>(p, k, limits)*dX;
        return
            (c1 + G*c2)*dG/q - 3*(G + dG*dl) - dH*p - (H + pdH)*k*dX;
    };

    // Beyond this even the softest elastic strain is used up
    const scalar farthest =
        std::sqrt(c2)/3 + std::sqrt(c0)/(3*halfModulus*kStart);

    scalar lower = 0, upper = farthest;

    // The first iterate, from the trial state
    flow.contraction(0, dPlastic);
    scalar dl = (HTrial*p - q)/slopeAt(0, XTrial <= XRes, HTrial);
    if (!(dl > lower && dl < upper)) dl = 0.5*upper;

    // Modulus that gave the direction of the trial stress
    scalar GTrial = G;
    bool converged = false;

    // Strength of the pressure and the direction found
    auto refresh = [&]()
    {
        scalar t[nComponents<dim>];
        trialStress<dim>(block, j, G, t);
        GTrial = G;
        flow.refresh(p, t, q);
    };

    for (int i = 0; i < maxIterations; ++i)
    {
        plasticContraction = flow.contraction(dl, dPlastic);
        const scalar X = XTrial - a*plasticContraction;
        const bool floor = X <= XRes;
        p = elasticity_.pressure<L>(max(X, XRes), limits, k);
        G = halfModulus*(kStart + k);
        q = std::sqrt(max(c0 + G*(2*c1 + G*c2), VSMALL));

        const scalar H = flow.ratio(dl, p, dH, pdH);
        const scalar residual = q - 3*G*dl - H*p;
        state.scale = min(H*p/q, scalar(1));

        const bool found =
            mag(residual) <= tolerance*q
         || upper - lower <= 1e-15*farthest;

        if (found || i == 0)
        {
            // The strength at another pressure or direction, and on from
            // here; asked after the first iterate, too, not to converge
            // twice. turn is the square of the angle between the trial
            // stresses
            const scalar turn =
                Model::strengthOfDirection
              ? sqr((G - GTrial)/(q*q))*(c0*c2 - c1*c1)
              : 0;
            if (flow.stale(p) || turn >= maxTurn*maxTurn)
            {
                refresh();
                lower = 0;
                upper = farthest;
                continue;
            }
            converged = found;
            if (found) break;
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
        state.scale = min(flow.ratio(dl, p, dH, pdH)*p/q, scalar(1));
    }
    plasticStrain += dl;
    return plasticContraction;
}


template<int dim, Foam::mpm::granularElasticity::law L>
inline Foam::scalar Foam::mpm::granularModel::voidRatioAtLoss
(
    const granularBlock<dim>& block,
    const label j,
    const scalar contraction,
    const scalar lost
) const
{
    const scalar stored = block.XStart[j] - block.XRes[j];

    // Moduli in the middle of the part with contact, as on the way back:
    // else cycles would pump
    scalar e = 0;
    scalar part = lost > 0 ? stored/(block.a[j]*lost) : 0;
    for (int i = 0; i < 3; ++i)
    {
        part = min(part, scalar(1));
        e = (1 + block.e0[j])*expStrain(-part*contraction) - 1;
        if (lost <= 0) break;
        part = stored/lost
           /elasticity_.coefficient<L>(0.5*(block.e0[j] + e));
    }
    return e;
}


template<class Model, int dim, Foam::mpm::granularElasticity::law L>
bool Foam::mpm::granularModel::contactStep
(
    const Model& model,
    const typename Model::strengthBlock& strengths,
    const label j,
    granularBlock<dim>& block,
    granularStep& step
) const
{
    contactState state
    {
        block.pTrial[j], block.kTrial[j], block.G[j], block.q[j], 1
    };
    const scalar contraction = -block.trace[j]*block.time[j];

    typename Model::template flowRule<dim> flow
    (
        model, strengths, j, block, step.plasticStrain
    );

    // Slope of H along the plastic strain, and along p times p
    scalar dH, pdH;
    scalar plasticContraction = 0;

    const scalar HTrial = flow.ratio(0, state.p, dH, pdH);
    if (state.q > HTrial*state.p)
    {
        plasticContraction = returnToYield<Model, dim, L>
        (
            flow, HTrial, dH, pdH, j, block, state, step.plasticStrain
        );
    }
    else if (flow.stale(state.p))
    {
        // Elastic by a strength that belongs to another pressure
        scalar t[nComponents<dim>];
        trialStress<dim>(block, j, state.G, t);
        flow.refresh(state.p, t, state.q);
        const scalar H = flow.ratio(0, state.p, dH, pdH);
        if (state.q > H*state.p) state.scale = H*state.p/state.q;
    }

    // Contact is lost where expansion leaves no pressure; what rounding makes
    // of a strain of constant volume is no expansion
    if
    (
        block.XTrial[j] - block.a[j]*plasticContraction <= block.XRes[j]
     && contraction < 0
     && sqr(contraction) > 1e-18*block.c2[j]
    )
    {
        step.contactVoidRatio = voidRatioAtLoss<dim, L>
        (
            block, j, contraction, plasticContraction - contraction
        );
        return false;
    }

    scalar t[nComponents<dim>];
    trialStress<dim>(block, j, state.G, t);
    for (int c = 0; c < nComponents<dim>; ++c)
    {
        block.s[c][j] = state.scale*t[c];
    }
    step.p = state.p;
    step.k = state.k;
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
    scalar* const plasticStrain = points.state[PLASTIC_STRAIN];
    scalar* const contactVoidRatio = points.state[CONTACT_VOID_RATIO];
    scalar* const regimes = points.state[REGIME];

    scalar maxModulus = 0;
    scalar maxViscosity = 0;

    granularBlock<dim> block;
    typename Model::strengthBlock strengths;

    for (label i = 0; i < points.n; ++i)
    {
        const label j = i % granularBlockSize;
        if (j == 0)
        {
            const label nPoints = min(points.n - i, granularBlockSize);
            loadBlock<dim>(points, i, nPoints, deltaT, block);

            label nContacts = 0;
            for (label m = i; m < i + nPoints; ++m)
            {
                nContacts += contactVoidRatio[m] <= 0;
            }
            if (nContacts)
            {
                trialBlock<Model, dim, L>
                (
                    model, points, i, nPoints, deltaT, block, strengths
                );
            }
        }
        scalar e = block.e[j];

        scalar p = 0;
        scalar where = separated;
        bool flows = true;

        const scalar contact = contactVoidRatio[i];
        bool carries = false;
        if (contact > 0 && e >= contact)
        {
            // Void ratio grows without end while nothing holds the point
            // together; where the grid shows more grains, it is right
            if (points.solidFraction)
            {
                e = min(e, 1/max(points.solidFraction[i], SMALL) - 1);
                e = max(e, contact);
            }
        }
        else if (e <= suspendedVoidRatio_)
        {
            granularStep step;
            step.plasticStrain = plasticStrain[i];
            if (contact > 0)
            {
                // Closes in this step; strain counts from there
                const scalar part = min
                (
                    scalar(1),
                    std::log((1 + contact)/(1 + e))
                   /max(-block.trace[j]*deltaT, VSMALL)
                );
                for (int c = 0; c < n; ++c) block.s[c][j] = 0;
                block.p[j] = pRes_;
                block.e0[j] = contact;
                step.plasticStrain = 0;
                trial<dim, L, false>(j, part*deltaT, block);
                model.findStrength(j, block, strengths);
            }

            if constexpr (Model::ownIntegrator)
            {
                carries = model.template integrate<dim, L>(j, block, step);
            }
            else
            {
                carries = contactStep<Model, dim, L>
                (
                    model, strengths, j, block, step
                );
            }
            if (carries)
            {
                p = step.p;
                for (int c = 0; c < n; ++c)
                {
                    stress[c][i] = block.s[c][j] - (c < 3 ? p : 0);
                }
                plasticStrain[i] = step.plasticStrain;
                contactVoidRatio[i] = 0;
                maxModulus = max(maxModulus, block.a[j]*step.k*(1 + e));
                where = staticBed;
            }
            else
            {
                contactVoidRatio[i] =
                    block.e0[j] < loosestContact_
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
                flows = false;
            }
        }
        points.voidRatio[i] = e;
        regimes[i] = where;
        block.e[j] = e;
        block.p[j] = p;
        block.flows[j] = flows;

        if (j == granularBlockSize - 1 || i == points.n - 1)
        {
            addViscous<Model, dim>(model, points, i - j, j + 1, block);
            for (label m = 0; m <= j; ++m)
            {
                maxViscosity = max(maxViscosity, block.viscosity[m]);
            }
        }
    }

    if (!recontact_)
    {
        for (label i = 0; i < points.n; ++i)
        {
            if (contactVoidRatio[i] > 0)
            {
                contactVoidRatio[i] = points.voidRatio[i];
            }
        }
    }

    points.maxWaveSpeedSqr = elasticity_.waveSpeedSqr(maxModulus, 0);
    points.maxViscosity = maxViscosity/rhoS_;
}


template<class Model, int dim>
void Foam::mpm::granularModel::addViscous
(
    const Model& model,
    soilPoints& points,
    const label first,
    const label nPoints,
    granularBlock<dim>& block
) const
{
    constexpr int n = nComponents<dim>;

    scalar* const regimes = points.state[REGIME] + first;
    scalar* const inertialNumber = points.state[INERTIAL_NUMBER] + first;

    // Of the flowing, with or without skeleton stress
    #pragma GCC ivdep
    for (label j = 0; j < nPoints; ++j)
    {
        scalar I = 0, viscosity = 0, pressure = 0;
        if constexpr (Model::hasViscousPart)
        {
            model.findViscosity
            (
                block.shearRateSqr[j], block.e[j], block.p[j],
                viscosity, pressure, I
            );
        }
        else
        {
            const scalar p = block.p[j];
            I = 2*d_*std::sqrt(block.shearRateSqr[j]*rhoS_/max(p, VSMALL));
            I = p > 0 ? I : 0;
        }
        const scalar flows = block.flows[j];
        inertialNumber[j] = flows*I;
        block.viscosity[j] = flows*viscosity;
        block.viscousPressure[j] = flows*pressure;
    }
    if constexpr (Model::hasViscousPart)
    {
        if (points.liquidViscosity > 0 && model.suspension().active())
        {
            #pragma GCC ivdep
            for (label j = 0; j < nPoints; ++j)
            {
                model.suspension().addViscosity
                (
                    block.shearRateSqr[j], block.e[j], block.p[j],
                    block.flows[j]*liquidViscosity(points, first + j),
                    block.viscosity[j], block.viscousPressure[j]
                );
            }
        }

        // In expansion faster than shear the pressure of the flow would do
        // more work than viscosity dissipates: grains that are large for
        // their cells would drive themselves apart without end
        #pragma GCC ivdep
        for (label j = 0; j < nPoints; ++j)
        {
            block.viscousPressure[j] = min
            (
                block.viscousPressure[j],
                2*block.viscosity[j]*block.shearRateSqr[j]
               /max(block.trace[j], VSMALL)
            );
        }
    }

    // Suspended grains in liquid. Twice the viscosity stands for that of D
    if (points.liquidViscosity > 0)
    {
        for (label j = 0; j < nPoints; ++j)
        {
            if (block.flows[j] == 0)
            {
                block.viscosity[j] =
                    2*liquidViscosity(points, first + j)
                   *viscosityFactor(block.e[j]);
            }
        }
    }

    // Fast points in contact are bed load
    for (label j = 0; j < nPoints; ++j)
    {
        const bool fast =
            inertialNumber[j] > bedLoadI_
         || (points.speed && points.speed[first + j] > bedLoadSpeed_);
        if (fast && regimes[j] == staticBed) regimes[j] = bedLoad;
    }

    const scalar* stress[n];
    scalar* whole[n];
    for (int c = 0; c < n; ++c)
    {
        stress[c] = points.stress[c] + first;
        whole[c] = points.wholeStress[c] + first;
    }
    #pragma GCC ivdep
    for (label j = 0; j < nPoints; ++j)
    {
        const scalar viscosity = block.viscosity[j];
        const scalar pressure = block.viscousPressure[j];
        for (int c = 0; c < n; ++c)
        {
            whole[c][j] =
                stress[c][j] + viscosity*block.D[c][j]
              - (c < 3 ? pressure : 0);
        }
        // Per mass of grains, for the limit of the time step
        block.viscosity[j] = viscosity*(1 + block.e[j]);
    }
    if (points.power)
    {
        scalar* const power = points.power + first;
        #pragma GCC ivdep
        for (label j = 0; j < nPoints; ++j)
        {
            // tr(sigma D), D = deviator + trace/3
            scalar sum =
                whole[0][j]*block.D[0][j] + whole[1][j]*block.D[1][j]
              + whole[2][j]*block.D[2][j] + 2*whole[3][j]*block.D[3][j]
              + block.trace[j]/3*(whole[0][j] + whole[1][j] + whole[2][j]);
            if constexpr (dim == 3)
            {
                sum +=
                    2*(
                        whole[4][j]*block.D[4][j] + whole[5][j]*block.D[5][j]
                    );
            }
            power[j] = sum;
        }
    }
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

        if (e > suspendedVoidRatio_ || (mag(p) <= pRes_ && q <= pRes_))
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
            if (!(p > 0))
            {
                FatalIOErrorInFunction(coeffs_)
                    << "start stress: the mean pressure p of the grains has"
                    << " the value " << p << " Pa." << nl
                    << "    Allowed: p > 0 (stress is positive in tension)"
                    << exit(FatalIOError);
            }
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
