/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "searchableRegion.H"
#include "dictionaryEntries.H"
#include "triSurfaceMesh.H"
#include "HashTable.H"
#include "Time.H"
#include "addToRunTimeSelectionTable.H"
#include <limits>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(searchableRegion, 0);
    addToRunTimeSelectionTable(pointRegion, searchableRegion, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::dictionary Foam::mpm::searchableRegion::entries
(
    const bool strictKeywords
) const
{
    // Of the others only OpenFOAM knows them
    const HashTable<wordList> own
    ({
        {"surface", {"file", "scale"}},
        {"box", {"min", "max"}},
        {"cylinder", {"point1", "point2", "radius"}},
        {"sphere", {"origin", "radius"}}
    });
    const word type(dict_.get<word>("type"));
    if (own.found(type))
    {
        checkKeywords(dict_, keywords(own[type]), strictKeywords);
    }
    else
    {
        checkNearMisses
        (
            dict_, keywords({}), {"origin", "centre"}, strictKeywords
        );
    }

    dictionary entries(dict_);
    if (type == "cylinder" || type == "sphere")
    {
        entries.set("radius", readPositive(dict_, "radius", dimLength));
    }
    if (type == "box")
    {
        const point lower(dict_.get<point>("min"));
        const point upper(dict_.get<point>("max"));
        if (cmptMin(upper - lower) <= 0)
        {
            FatalIOErrorInFunction(dict_)
                << "keyword max is " << upper << ", keyword min is "
                << lower << '.' << nl
                << "    Allowed: max > min in each component"
                << exit(FatalIOError);
        }
    }
    if
    (
        type == "cylinder"
     && dict_.get<point>("point1") == dict_.get<point>("point2")
    )
    {
        FatalIOErrorInFunction(dict_)
            << "keywords point1 and point2 are both "
            << dict_.get<point>("point1") << '.' << nl
            << "    Allowed: two different points" << exit(FatalIOError);
    }
    return entries;
}


void Foam::mpm::searchableRegion::checkClosed() const
{
    const bool fromFile = isA<triSurfaceMesh>(*surface_);
    const fileName file(surface_->objectPath());
    const string rounded(fromFile ? rounding(file) : string());

    if (!surface_->hasVolumeType())
    {
        if (fromFile)
        {
            FatalIOErrorInFunction(dict_)
                << "keyword file: the surface " << file << " is not closed."
                << rounded.c_str() << nl << "    Allowed: a closed surface"
                << exit(FatalIOError);
        }
        FatalIOErrorInFunction(dict_)
            << "keyword type is " << dict_.get<word>("type")
            << ", which has no inside." << nl
            << "    Allowed: a closed surface, as box or sphere"
            << exit(FatalIOError);
    }
    if (!rounded.empty())
    {
        IOWarningInFunction(dict_)
            << "keyword file: the surface " << file << " is rounded."
            << rounded.c_str() << endl;
    }
}


Foam::string Foam::mpm::searchableRegion::rounding(const fileName& file) const
{
    const fileName name(file.ext() == "gz" ? file.lessExt() : file);
    const word format(name.ext());
    if (format != "stl" && format != "STL" && format != "stlb") return string();

    const boundBox& bounds = surface_->bounds();
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

Foam::mpm::searchableRegion::searchableRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    position_(1)
{
    const word type(dict.get<word>("type"));
    const bool fromFile = type == typeName;
    const dictionary checked(entries(strictKeywords));

    surface_ = searchableSurface::New
    (
        fromFile ? word(triSurfaceMesh::typeName) : type,
        IOobject
        (
            fromFile ? dict.get<fileName>("file") : fileName(dict.dictName()),
            mesh.time().constant(),
            "triSurface",
            mesh.time(),
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            fromFile
        ),
        checked
    );
    checkClosed();

    // Some of OpenFOAM's have corners, but no bounds
    bounds_ = surface_->bounds();
    if (bounds_.empty()) bounds_ = boundBox(surface_->points(), false);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::searchableRegion::types()
{
    return searchableSurface::dictConstructorTablePtr_->sortedToc();
}


bool Foam::mpm::searchableRegion::contains(const point& x, const label) const
{
    position_[0] = x;
    surface_->getVolumeType(position_, side_);
    return side_[0] == volumeType::INSIDE;
}

// ************************************************************************* //
