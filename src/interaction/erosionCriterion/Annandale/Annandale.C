/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "Annandale.H"
#include "unitConversion.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(Annandale, 0);
    addToRunTimeSelectionTable(erosionCriterion, Annandale, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::Annandale::Annandale(const dictionary& dict, const bed& b)
:
    erosionCriterion(b)
{
    if (b.frictionAngle < 0)
    {
        FatalIOErrorInFunction(dict)
            << "keyword criteria: Annandale needs the friction angle of the"
            << " grains, but there is no keyword frictionAngle." << nl
            << "    Allowed: frictionAngle from 0 to 90 degrees"
            << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::Annandale::shearStress() const
{
    const scalar slope = std::tan(degToRad(bed_.frictionAngle));
    return 2.0/3.0*bed_.rho*bed_.g*bed_.submerged()*bed_.d*slope;
}

// ************************************************************************* //
