/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "surfaceRegion.H"
#include "dictionaryEntries.H"
#include "Time.H"
#include "addToRunTimeSelectionTable.H"
#include <limits>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(surfaceRegion, 0);
    addToRunTimeSelectionTable(pointRegion, surfaceRegion, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::string Foam::mpm::surfaceRegion::rounding(const fileName& file) const
{
    const fileName name(file.ext() == "gz" ? file.lessExt() : file);
    const word format(name.ext());
    if (format != "stl" && format != "STL" && format != "stlb") return string();

    const boundBox& bounds = surface_.bounds();
    const scalar farthest =
        max(cmptMax(cmptMag(bounds.min())), cmptMax(cmptMag(bounds.max())));
    const scalar step = farthest*std::numeric_limits<float>::epsilon();
    if (step < 1e-3*cmptMin(bounds.span())) return string();

    OStringStream os;
    os  << nl << "    OpenFOAM reads STL in single precision: at " << farthest
        << " m it holds steps of " << step << " m only." << nl
        << "    Use the format obj, or move the origin of the coordinates near"
        << " to the mesh.";
    return os.str();
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

    const fileName file(surface_.searchableSurface::objectPath());
    const string rounded(rounding(file));

    if (!surface_.hasVolumeType())
    {
        FatalIOErrorInFunction(dict)
            << "keyword file: the surface " << file << " is not closed."
            << rounded.c_str() << nl << "    Allowed: a closed surface"
            << exit(FatalIOError);
    }
    if (!rounded.empty())
    {
        IOWarningInFunction(dict)
            << "keyword file: the surface " << file << " is rounded."
            << rounded.c_str() << endl;
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
