/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "boxRegion.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(boxRegion, 0);
    addToRunTimeSelectionTable(pointRegion, boxRegion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::boxRegion::boxRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    box_(dict.get<point>("min"), dict.get<point>("max"))
{
    checkKeywords(dict, keywords({"min", "max"}), strictKeywords);

    if (cmptMin(box_.span()) <= 0)
    {
        FatalIOErrorInFunction(dict)
            << "keyword max is " << box_.max() << ", keyword min is "
            << box_.min() << '.' << nl
            << "    Allowed: max > min in each component"
            << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::boxRegion::contains
(
    const point& x,
    const label
) const
{
    return box_.contains(x);
}


Foam::boundBox Foam::mpm::boxRegion::bounds() const
{
    return box_;
}

// ************************************************************************* //
