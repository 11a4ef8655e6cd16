/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "kEpsilon.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include "bedFields.H"
#include "wallLaw.H"
#include "lanes.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(kEpsilon, 0);
    addToRunTimeSelectionTable(turbulenceModel, kEpsilon, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::kEpsilon::kEpsilon
(
    const dictionary& coeffs,
    const backgroundGrid& grid,
    const volVectorField& U,
    pointStorage& storage,
    const bool strictKeywords
)
:
    grid_(grid),
    storage_(storage),
    kIn_(readPositive(coeffs, "k", sqr(dimVelocity))),
    epsilonIn_(readPositive(coeffs, "epsilon", sqr(dimVelocity)/dimTime)),
    Cmu_(readBoundedOrDefault(coeffs, "Cmu", dimless, 0.09, 0, 1)),
    C1_(readBoundedOrDefault(coeffs, "C1", dimless, 1.44, 0, 10)),
    C2_(readBoundedOrDefault(coeffs, "C2", dimless, 1.92, 0, 10)),
    sigmak_(readBoundedOrDefault(coeffs, "sigmak", dimless, 1.0, 0, 10)),
    sigmaEps_(readBoundedOrDefault(coeffs, "sigmaEps", dimless, 1.3, 0, 10)),
    bedRoughness_
    (
        readBoundedOrDefault(coeffs, "bedRoughness", dimless, 2.5, 0, GREAT)
    ),
    walls_(grid, U),
    k_(storage.add("k", pointStorage::scalarValue)),
    epsilon_(storage.add("epsilon", pointStorage::scalarValue))
{
    checkKeywords
    (
        coeffs,
        {
            "k", "epsilon", "Cmu", "C1", "C2", "sigmak", "sigmaEps",
            "bedRoughness"
        },
        strictKeywords
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::kEpsilon::correct
(
    const scalar deltaT,
    const scalar nu,
    const points& p,
    cloudKernels& kernels,
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

    react(deltaT, nu, p, k, epsilon);

    Dk_.resize(p.n + nLanes);
    Depsilon_.resize(p.n + nLanes);
    for (label i = 0; i < p.n; ++i)
    {
        const scalar eddy = eddyViscosity(k[i], epsilon[i]);
        Dk_[i] = nu + eddy/sigmak_;
        Depsilon_[i] = nu + eddy/sigmaEps_;
    }
    scalar* const values[2] = {k, epsilon};
    const scalar* const diffusivities[2] = {Dk_.data(), Depsilon_.data()};
    kernels.diffuse(deltaT, values, diffusivities);

    for (label i = 0; i < p.n; ++i)
    {
        nut[i] += eddyViscosity(k[i], epsilon[i])
           *(p.porosity ? p.porosity[i] : 1);
    }
}


void Foam::mpm::kEpsilon::react
(
    const scalar deltaT,
    const scalar nu,
    const points& p,
    scalar* k,
    scalar* epsilon
) const
{
    const scalar h = grid_.cells().minSpacing();

    // Water at rest at a wall has no eddies, and k^2/epsilon must exist: they
    // are then 9e-14 m2/s
    constexpr scalar least = 1e-12;

    auto setLaw = [&]
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
                setLaw
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
            setLaw
            (
                i, p.bedFrictionVelocity[i], max(bedDistance, 0.5*h), p.bed->ks
            );
            continue;
        }
        const scalar production = min
        (
            eddyViscosity(k[i], epsilon[i])*sqr(p.shearRate[i]),
            10*epsilon[i]
        );
        const scalar rate = epsilon[i]/k[i];
        k[i] = (k[i] + deltaT*production)/(1 + deltaT*rate);
        epsilon[i] *=
            (1 + deltaT*C1_*production/k[i])/(1 + deltaT*C2_*rate);
    }
}


void Foam::mpm::kEpsilon::setEntered(const label first, const label last)
{
    for (label i = first; i < last; ++i)
    {
        storage_.column(k_)[i] = kIn_;
        storage_.column(epsilon_)[i] = epsilonIn_;
    }
}


Foam::string Foam::mpm::kEpsilon::description() const
{
    return
        "kEpsilon, points start with k " + name(kIn_) + " m2/s2, epsilon "
      + name(epsilonIn_) + " m2/s3";
}

// ************************************************************************* //
