/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "wallLaw.H"
#include "bedFields.H"
#include "lanes.H"
#include <cmath>

// * * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * //

template<class Model>
void Foam::mpm::twoEquation::advance
(
    const Model& model,
    const points& p,
    scalar* nut
)
{
    scalar* k = storage_.column(k_);
    scalar* epsilon = storage_.column(epsilon_);

    // Points of a start that does not know them
    for (label i = 0; i < p.n; ++i)
    {
        if (k[i] > 0 && epsilon[i] > 0) continue;
        k[i] = kIn_;
        epsilon[i] = epsilonIn_;
    }

    react(model, p, k, epsilon);

    Dk_.resize(p.n + nLanes);
    Depsilon_.resize(p.n + nLanes);
    for (label i = 0; i < p.n; ++i)
    {
        const scalar eddy = eddyViscosity(model, p, i, k[i], epsilon[i]);
        Dk_[i] = p.nu + eddy/sigmak_;
        Depsilon_[i] = p.nu + eddy/sigmaEps_;
    }
    scalar* const values[2] = {k, epsilon};
    const scalar* const diffusivities[2] = {Dk_.data(), Depsilon_.data()};
    p.kernels->diffuse(p.deltaT, values, diffusivities);

    for (label i = 0; i < p.n; ++i)
    {
        nut[i] += eddyViscosity(model, p, i, k[i], epsilon[i])
           *(p.porosity ? p.porosity[i] : 1);
    }
}


template<class Model>
void Foam::mpm::twoEquation::react
(
    const Model& model,
    const points& p,
    scalar* k,
    scalar* epsilon
) const
{
    const scalar h = grid_.cells().minSpacing();
    const scalar deltaT = p.deltaT;
    const scalar nu = p.nu;

    // Water at rest at a wall has no eddies, and k^2/epsilon must exist: they
    // are then 9e-14 m2/s
    constexpr scalar least = 1e-12;

    const scalar root4Cmu = std::pow(Cmu_, 0.25);
    auto atWall = [&]
    (
        const label i,
        const scalar frictionVelocity,
        const scalar y,
        const scalar ks
    )
    {
        const scalar slope =
            root4Cmu*std::sqrt(k[i])/(wallLaw::kappa*(y + ks/30));
        k[i] = max
        (
            (k[i] + deltaT*sqr(frictionVelocity)*slope)
           /(1 + deltaT*std::sqrt(Cmu_)*slope),
            least
        );
        epsilon[i] = max
        (
            pow3(root4Cmu*std::sqrt(k[i]))/(wallLaw::kappa*(y + ks/30)), least
        );
    };
    auto atBed = [&]
    (
        const label i,
        const scalar frictionVelocity,
        const scalar y,
        const scalar ks
    )
    {
        const scalar uStar = max(frictionVelocity, VSMALL);
        k[i] = max(sqr(uStar)/std::sqrt(Cmu_), least);
        epsilon[i] = max(pow3(uStar)/(wallLaw::kappa*(y + ks/30)), least);
    };
    for (label i = 0; i < p.n; ++i)
    {
        const scalar bedDistance = p.bed ? p.bedDistance[i] : GREAT;
        if (bedDistance < 0)
        {
            // Drag of the grains; k/epsilon stays
            const scalar drag =
                deltaT*(p.bed->a + p.bed->b*std::sqrt(k[i]));
            const scalar rate = deltaT*epsilon[i]/k[i];
            k[i] = max(k[i]/(1 + drag + rate), least);
            epsilon[i] = max(epsilon[i]/(1 + drag + C2_*rate), least);
            continue;
        }
        if (walls_.any())
        {
            const scalar x[3] =
                {p.x[0][i], p.x[1][i], p.x[2] ? p.x[2][i] : 0};
            const scalar distance = walls_.distance(p.cell[i], x);
            if (distance < h && distance <= bedDistance)
            {
                // As a cell would: at its centre, where the velocity that
                // the grid has along the wall is about right
                const scalar y = max(distance, 0.5*h);
                scalar speedSqr = 0;
                for (label d = 0; d < grid_.nDim(); ++d)
                {
                    speedSqr += sqr(p.v[d][i]);
                }
                const scalar ks = walls_.roughness(p.cell[i]);
                atWall
                (
                    i,
                    wallLaw::frictionVelocity(std::sqrt(speedSqr), y, ks, nu),
                    y,
                    ks
                );
                continue;
            }
        }
        if (bedDistance < h && p.bedFrictionVelocity[i] > 0)
        {
            atBed
            (
                i, p.bedFrictionVelocity[i], max(bedDistance, 0.5*h), p.bed->ks
            );
            continue;
        }
        const scalar production = min
        (
            eddyViscosity(model, p, i, k[i], epsilon[i])*sqr(p.shearRate[i]),
            10*epsilon[i]
        );
        const scalar rate = epsilon[i]/k[i];
        k[i] = (k[i] + deltaT*production)/(1 + deltaT*rate);
        epsilon[i] *=
            (1 + deltaT*model.gain(p.shearRate[i], production, k[i], epsilon[i]))
           /(1 + deltaT*model.decay(nu, rate, epsilon[i]));
    }
}

// ************************************************************************* //
