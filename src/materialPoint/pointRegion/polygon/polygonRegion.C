/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "polygonRegion.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(polygonRegion, 0);
    addToRunTimeSelectionTable(pointRegion, polygonRegion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::polygonRegion::polygonRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    points_(dict.lookup("points"))
{
    checkKeywords(dict, keywords({"points", "plane"}), strictKeywords);

    const word plane(readChoiceOrDefault(dict, "plane", "xy", {"xy", "xz", "yz"}));
    first_ = plane[0] - 'x';
    second_ = plane[1] - 'x';

    if (points_.size() < 3)
    {
        FatalIOErrorInFunction(dict)
            << "keyword points has " << points_.size() << " corners." << nl
            << "    Allowed: 3 or more" << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::polygonRegion::contains
(
    const point& x,
    const label
) const
{
    // Edges that a ray along the first coordinate crosses
    const scalar u = x[first_], v = x[second_];
    bool inside = false;
    forAll(points_, i)
    {
        const vector2D& a = points_[i];
        const vector2D& b = points_[points_.fcIndex(i)];
        if
        (
            (a.y() > v) != (b.y() > v)
         && u < a.x() + (b.x() - a.x())*(v - a.y())/(b.y() - a.y())
        )
        {
            inside = !inside;
        }
    }
    return inside;
}


Foam::boundBox Foam::mpm::polygonRegion::bounds() const
{
    boundBox box(point(-GREAT, -GREAT, -GREAT), point(GREAT, GREAT, GREAT));
    box.min()[first_] = box.min()[second_] = GREAT;
    box.max()[first_] = box.max()[second_] = -GREAT;
    for (const vector2D& a : points_)
    {
        box.min()[first_] = min(box.min()[first_], a.x());
        box.max()[first_] = max(box.max()[first_], a.x());
        box.min()[second_] = min(box.min()[second_], a.y());
        box.max()[second_] = max(box.max()[second_], a.y());
    }
    return box;
}

// ************************************************************************* //
