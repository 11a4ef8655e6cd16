/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "surfaceRegion.H"
#include "dictionaryEntries.H"
#include "Time.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(surfaceRegion, 0);
    addToRunTimeSelectionTable(pointRegion, surfaceRegion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::surfaceRegion::surfaceRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    surface_
    (
        IOobject
        (
            dict.get<fileName>("file"),
            mesh.time().constant(),
            "triSurface",
            mesh.time(),
            IOobject::MUST_READ,
            IOobject::NO_WRITE
        )
    )
{
    checkKeywords(dict, keywords({"file"}), strictKeywords);

    if (!surface_.hasVolumeType())
    {
        FatalIOErrorInFunction(dict)
            << "keyword file: the surface " << surface_.searchableSurface::objectPath()
            << " is not closed." << nl
            << "    Allowed: a closed surface" << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::surfaceRegion::contains
(
    const point& x,
    const label
) const
{
    List<volumeType> inside;
    surface_.getVolumeType(pointField(1, x), inside);
    return inside[0] == volumeType::INSIDE;
}


Foam::boundBox Foam::mpm::surfaceRegion::bounds() const
{
    return surface_.bounds();
}

// ************************************************************************* //
