/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "vanRijn.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(vanRijn, 0);
    addToRunTimeSelectionTable(erosionCriterion, vanRijn, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::vanRijn::vanRijn(const dictionary& dict, const bed& b)
:
    erosionCriterion(b)
{
    if (!(dimensionlessDiameter() > 1))
    {
        FatalIOErrorInFunction(dict)
            << "keyword criteria: vanRijn, but the dimensionless diameter of"
            << " the grains is " << dimensionlessDiameter() << " (d = " << b.d
            << " m)." << nl
            << "    Allowed: vanRijn with a dimensionless diameter > 1"
            << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::mpm::vanRijn::dimensionlessDiameter() const
{
    const scalar nu = bed_.mu/bed_.rho;
    return bed_.d*std::cbrt(bed_.submerged()*bed_.g/sqr(nu));
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::vanRijn::shearStress() const
{
    const scalar d = dimensionlessDiameter();
    const scalar theta =
        d <= 4 ? 0.24/d
      : d <= 10 ? 0.14*std::pow(d, -0.64)
      : d <= 20 ? 0.04*std::pow(d, -0.1)
      : d <= 150 ? 0.013*std::pow(d, 0.29)
      : 0.055;

    return theta*bed_.rho*bed_.g*bed_.submerged()*bed_.d;
}

// ************************************************************************* //
