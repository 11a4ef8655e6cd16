/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "searchableRegion.H"
#include "polyMesh.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(searchableRegion, 0);
    addToRunTimeSelectionTable(pointRegion, searchableRegion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::searchableRegion::searchableRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    surface_(mesh.time(), dict, keywords({}), strictKeywords),
    position_(1)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::searchableRegion::contains(const point& x, const label) const
{
    position_[0] = x;
    surface_.surface().getVolumeType(position_, side_);
    return side_[0] == volumeType::INSIDE;
}

// ************************************************************************* //
