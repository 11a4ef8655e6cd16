/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "DruckerPrager.H"
#include "dictionaryEntries.H"
#include "unitConversion.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(DruckerPrager, 0);
    addToRunTimeSelectionTable(soilModel, DruckerPrager, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::DruckerPrager::DruckerPrager
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    granularModel(coeffs, true)
{
    checkKeywords
    (
        coeffs, keywords(true, {"phi", "psi", "cone"}), strictKeywords
    );

    const scalar phi = readBounded(coeffs, "phi", dimless, 0, 90);
    const scalar psi = readBoundedOrDefault
    (
        coeffs, "psi", dimless, 0, 0, phi, true, true
    );
    warnUnusual
    (
        coeffs,
        {
            {"phi", 15, 50, "grains, in degrees"},
            {"psi", 0, 25, "dense sands, in degrees"}
        }
    );
    const word cone = readChoiceOrDefault
    (
        coeffs, "cone", "compression",
        {"compression", "extension", "planeStrain"}
    );
    auto slope = [&](const scalar sine)
    {
        if (cone == "planeStrain") return std::sqrt(scalar(3))*sine;
        return 6*sine/(cone == "compression" ? 3 - sine : 3 + sine);
    };
    sinPhi_ = std::sin(degToRad(phi));
    M_ = slope(sinPhi_);
    dilatancy_ = slope(std::sin(degToRad(psi)));
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

template<int dim>
Foam::scalar Foam::mpm::DruckerPrager::startStrain
(
    const scalar*,
    const scalar q,
    const scalar p,
    const scalar
) const
{
    if (!(q <= M_*p))
    {
        FatalIOErrorInFunction(coeffs_)
            << "start stress: q/p has the value " << q/p << " at p = " << p
            << " Pa." << nl << "    Allowed: 0 <= q/p <= " << M_
            << exit(FatalIOError);
    }
    return 0;
}


void Foam::mpm::DruckerPrager::initialise
(
    const label dim,
    soilPoints& points
) const
{
    initialiseWith(*this, dim, points);
}


void Foam::mpm::DruckerPrager::update
(
    const label dim,
    soilPoints& points,
    const scalar deltaT
) const
{
    updateWith(*this, dim, points, deltaT);
}

// ************************************************************************* //
