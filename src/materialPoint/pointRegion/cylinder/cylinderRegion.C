/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cylinderRegion.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(cylinderRegion, 0);
    addToRunTimeSelectionTable(pointRegion, cylinderRegion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::cylinderRegion::cylinderRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    a_(dict.get<point>("point1")),
    b_(dict.get<point>("point2"))
{
    checkKeywords(dict, keywords({"point1", "point2", "radius"}), strictKeywords);
    radius_ = readPositive(dict, "radius", dimLength);

    if (mag(b_ - a_) <= 0)
    {
        FatalIOErrorInFunction(dict)
            << "keywords point1 and point2 are both " << a_ << '.' << nl
            << "    Allowed: two different points" << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::cylinderRegion::contains
(
    const point& x,
    const label
) const
{
    const vector axis = b_ - a_;
    const scalar along = ((x - a_) & axis)/magSqr(axis);
    return
        along >= 0 && along <= 1
     && magSqr(x - a_ - along*axis) <= sqr(radius_);
}


Foam::boundBox Foam::mpm::cylinderRegion::bounds() const
{
    const vector r(radius_, radius_, radius_);
    return boundBox(min(a_, b_) - r, max(a_, b_) + r);
}

// ************************************************************************* //
