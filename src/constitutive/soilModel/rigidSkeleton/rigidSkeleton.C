/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "rigidSkeleton.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(rigidSkeleton, 0);
    addToRunTimeSelectionTable(soilModel, rigidSkeleton, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::rigidSkeleton::rigidSkeleton
(
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    soilModel(coeffs)
{
    checkKeywords(coeffs, {"rhoS", "d", "e0"}, strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::rigidSkeleton::update
(
    const label dim,
    soilPoints& points,
    const scalar
) const
{
    for (label c = 0; c < (dim == 2 ? 4 : 6); ++c)
    {
        std::copy_n(points.stress[c], points.n, points.wholeStress[c]);
    }
    if (points.power) std::fill_n(points.power, points.n, 0);
    points.maxWaveSpeedSqr = 0;
    points.maxViscosity = 0;
}


void Foam::mpm::rigidSkeleton::elasticEnergy
(
    const label,
    const soilPoints& points,
    scalar* energy
) const
{
    std::fill_n(energy, points.n, 0);
}

// ************************************************************************* //
