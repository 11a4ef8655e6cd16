/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "linearElastic.H"
#include "soilTensor.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(linearElastic, 0);
    addToRunTimeSelectionTable(soilModel, linearElastic, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<int dim>
void Foam::mpm::linearElastic::advance
(
    soilPoints& points,
    const scalar deltaT
) const
{
    constexpr int n = nComponents<dim>;
    const scalar twoG = 2*K_*shearRatio_;
    scalar maxVolume = 0;

    for (label i = 0; i < points.n; ++i)
    {
        const soilRates<dim> rates(points, i);
        const scalar trace = rates.trace();

        scalar stress[n];
        for (int c = 0; c < n; ++c) stress[c] = points.stress[c][i];
        rotate<dim>(stress, rates.spin, deltaT);

        const scalar volumetric = (K_ - twoG/3)*trace*deltaT;
        for (int c = 0; c < n; ++c)
        {
            stress[c] += twoG*deltaT*rates.D[c] + (c < 3 ? volumetric : 0);
            points.stress[c][i] = stress[c];
            points.wholeStress[c][i] = stress[c];
        }

        const scalar volume =
            (1 + points.voidRatio[i])*expStrain(trace*deltaT);
        points.voidRatio[i] = volume - 1;
        maxVolume = max(maxVolume, volume);

        if (points.power)
        {
            points.power[i] = doubleDot<dim>(stress, rates.D);
        }
    }
    points.maxWaveSpeedSqr = waveSpeedSqr(0, maxVolume - 1);
    points.maxViscosity = 0;
}


template<int dim>
void Foam::mpm::linearElastic::energyOf
(
    const soilPoints& points,
    scalar* energy
) const
{
    constexpr int n = nComponents<dim>;
    for (label i = 0; i < points.n; ++i)
    {
        scalar s[n];
        for (int c = 0; c < n; ++c) s[c] = points.stress[c][i];
        const scalar mean = (s[0] + s[1] + s[2])/3;
        for (int c = 0; c < 3; ++c) s[c] -= mean;

        energy[i] = mean*mean/(2*K_)
          + doubleDot<dim>(s, s)/(4*K_*shearRatio_);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::linearElastic::linearElastic
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    soilModel(coeffs)
{
    checkKeywords(coeffs, {"rhoS", "d", "e0", "E", "nu"}, strictKeywords);

    E_ = readPositive(coeffs, "E", dimPressure);
    nu_ = readBounded(coeffs, "nu", dimless, 0, 0.5, true);
    K_ = E_/(3*(1 - 2*nu_));
    shearRatio_ = 1.5*(1 - 2*nu_)/(1 + nu_);
    warnUnusual(coeffs, {{"E", 5e4, 1e10, "soils, in Pa"}});
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::linearElastic::limitWaveSpeed(const scalar maxSpeed)
{
    const scalar sqr = waveSpeedSqr(0, e0_);
    K_ *= min(scalar(1), maxSpeed*maxSpeed/sqr);
}


void Foam::mpm::linearElastic::update
(
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    if (dim == 2) advance<2>(points, deltaT);
    else advance<3>(points, deltaT);
}


Foam::scalar Foam::mpm::linearElastic::waveSpeedSqr
(
    const scalar,
    const scalar voidRatio
) const
{
    return K_*(1 + 4*shearRatio_/3)*(1 + voidRatio)/rhoS_;
}


void Foam::mpm::linearElastic::elasticEnergy
(
    const label dim,
    const soilPoints& points,
    scalar* energy
) const
{
    if (dim == 2) energyOf<2>(points, energy);
    else energyOf<3>(points, energy);
}

// ************************************************************************* //
