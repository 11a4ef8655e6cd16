/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "limitOutlet.H"
#include "dictionaryEntries.H"
#include "volFields.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(limitOutlet, 0);
    addToRunTimeSelectionTable(outlet, limitOutlet, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::limitOutlet::limitOutlet
(
    const word& name,
    const dictionary& dict,
    const volVectorField& U,
    const bool strictKeywords
)
:
    outlet(name, dict),
    point_(dict.get<point>("point")),
    normal_(dict.get<vector>("normal"))
{
    checkKeywords(dict, {"type", "point", "normal"}, strictKeywords);

    if (!(mag(normal_) > 0))
    {
        FatalIOErrorInFunction(dict)
            << "keyword normal of outlet " << name << " is " << normal_ << '.'
            << nl << "    Allowed: a vector that is not zero"
            << exit(FatalIOError);
    }
    normal_ /= mag(normal_);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::string Foam::mpm::limitOutlet::description() const
{
    OStringStream os;
    os  << "beyond " << point_ << " along " << normal_;
    return os.str();
}


bool Foam::mpm::limitOutlet::overlaps(const boundBox& box) const
{
    // Named, or it would end before the loop begins
    const tmp<pointField> corners(box.points());
    for (const point& x : corners())
    {
        if (contains(x, -1)) return true;
    }
    return false;
}


bool Foam::mpm::limitOutlet::contains(const point& x, const label) const
{
    return ((x - point_) & normal_) > 0;
}

// ************************************************************************* //
