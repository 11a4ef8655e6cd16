/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "granularModel.H"
#include "dictionaryEntries.H"
#include "debug.H"
#include "registerSwitch.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

int Foam::mpm::granularModel::recontact
(
    Foam::debug::debugSwitch("mpmRecontact", 1)
);

static Foam::RegisterSwitch<int> addRecontact
(
    Foam::debug::addDebugObject,
    "mpmRecontact",
    Foam::mpm::granularModel::recontact
);

// Shear strength at pRes is sin(phi) pRes or less by up to sqrt(3) sin(phi)
// (triaxial compression); with this part of the Shields stress it stays below
// one hundredth of that stress
static const Foam::scalar maxResidualPart = 0.005;

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<int dim>
void Foam::mpm::granularModel::energyOf
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
        const scalar p = -(s[0] + s[1] + s[2])/3;
        if (p <= 0)
        {
            energy[i] = 0;
            continue;
        }
        for (int c = 0; c < 3; ++c) s[c] += p;
        const scalar e = points.voidRatio[i];
        const scalar G =
            elasticity_.shearRatio()*elasticity_.bulkModulus(p, e);
        energy[i] = elasticity_.volumetricEnergy(p, e)
          + doubleDot<dim>(s, s)/(4*G);
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::granularModel::keywords
(
    const bool constantElasticity,
    const wordList& own
)
{
    wordList all
    ({
        "rhoS", "d", "e0", "nsC", "pRes", "bedLoadI", "bedLoadSpeed",
        "suspensionViscosity"
    });
    all.append(granularElasticity::keywords(constantElasticity));
    all.append(own);
    return all;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::granularModel::granularModel
(
    const dictionary& coeffs,
    const bool constantElasticity
)
:
    soilModel(coeffs),
    elasticity_(coeffs, rhoS_, constantElasticity),
    loosestContact_(VGREAT),
    settledContact_(e0_),
    recontact_(recontact),
    bedLoadI_
    (
        readBoundedOrDefault
        (
            coeffs, "bedLoadI", dimless, 1e-2, 0, GREAT
        )
    ),
    bedLoadSpeed_
    (
        readBoundedOrDefault
        (
            coeffs, "bedLoadSpeed", dimVelocity, 1e-2, 0, GREAT
        )
    ),
    KriegerDougherty_
    (
        readChoiceOrDefault
        (
            coeffs, "suspensionViscosity", "liquid",
            {"liquid", "KriegerDougherty"}
        ) == "KriegerDougherty"
    )
{
    if (!recontact_)
    {
        WarningInFunction
            << "DebugSwitches: mpmRecontact 0" << nl
            << "    Soil that lost contact carries as soon as it contracts."
            << " Results are not to be trusted." << endl;
    }

    const scalar nsC =
        readBoundedOrDefault(coeffs, "nsC", dimless, 0.4, 0, 1);
    suspendedVoidRatio_ = (1 - nsC)/nsC;
    warnUnusual(coeffs, {{"nsC", 0.2, 0.56, "packings of grains"}});

    if (KriegerDougherty_ && nsC >= 0.64)
    {
        FatalIOErrorInFunction(coeffs)
            << "keyword nsC has the value " << nsC << '.' << nl
            << "    Allowed with KriegerDougherty: 0 < nsC < 0.64"
            << exit(FatalIOError);
    }

    const scalar most = maxResidualPart*shieldsStress();
    pRes_ = min(scalar(0.005), most);
    if (coeffs.found("pRes"))
    {
        pRes_ = readBounded
        (
            coeffs, "pRes", dimPressure, 0, most, false, true
        );
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::granularModel::stateFields() const
{
    return wordList
    ({
        "plasticStrain", "contactVoidRatio", "regime", "inertialNumber"
    });
}


void Foam::mpm::granularModel::limitWaveSpeed(const scalar maxSpeed)
{
    elasticity_.limitWaveSpeed(maxSpeed);
}


Foam::scalar Foam::mpm::granularModel::waveSpeedSqr
(
    const scalar pressure,
    const scalar voidRatio
) const
{
    return elasticity_.waveSpeedSqr
    (
        elasticity_.bulkModulus(pressure, voidRatio), voidRatio
    );
}


Foam::scalar Foam::mpm::granularModel::waveSpeedSqrGrowth
(
    const scalar compression,
    const scalar voidRatio
) const
{
    // That from no stress: what stress there is comes on top (exact at
    // n = 0.5, where the wave speed squared is linear in the strain)
    return elasticity_.waveSpeedSqr
    (
        elasticity_.compressedModulus(compression, voidRatio), voidRatio
    );
}


void Foam::mpm::granularModel::elasticCompression
(
    const soilPoints& points,
    scalar* compression
) const
{
    for (label i = 0; i < points.n; ++i)
    {
        const scalar e = points.voidRatio[i];
        const scalar contact = points.state[CONTACT_VOID_RATIO][i];
        if (contact > 0)
        {
            compression[i] = -std::log((1 + e)/(1 + contact));
        }
        else
        {
            const scalar p =
               -(points.stress[0][i] + points.stress[1][i]
              + points.stress[2][i])/3;
            compression[i] = elasticity_.compression(p, e);
        }
    }
}


void Foam::mpm::granularModel::elasticEnergy
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
