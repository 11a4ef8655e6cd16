/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "closedSurface.H"
#include "dictionaryEntries.H"
#include "exactDigits.H"
#include "triSurfaceMesh.H"
#include "HashTable.H"
#include "Time.H"
#include <limits>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::dictionary Foam::mpm::closedSurface::entries
(
    const wordList& further,
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
        wordList known(own[type]);
        known.append("type");
        known.append(further);
        checkKeywords(dict_, known, strictKeywords);
    }
    else
    {
        checkNearMisses
        (
            dict_, further, {"origin", "centre"}, strictKeywords
        );
    }

    const exactDigits exact;
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


void Foam::mpm::closedSurface::checkClosed() const
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


Foam::string Foam::mpm::closedSurface::rounding(const fileName& file) const
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

Foam::mpm::closedSurface::closedSurface
(
    const Time& time,
    const dictionary& dict,
    const wordList& further,
    const bool strictKeywords
)
:
    dict_(dict)
{
    const word type(dict.get<word>("type"));
    const bool read = type == fromFile;
    if (!read && !types().found(type))
    {
        wordList allowed(types());
        allowed.append(fromFile);
        (void)readChoice(dict, "type", allowed);
    }
    const dictionary checked(entries(further, strictKeywords));

    surface_ = searchableSurface::New
    (
        read ? word(triSurfaceMesh::typeName) : type,
        IOobject
        (
            read ? dict.get<fileName>("file") : fileName(dict.dictName()),
            time.constant(),
            "triSurface",
            time,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            read
        ),
        checked
    );
    checkClosed();

    // Some of OpenFOAM's have corners, but no bounds
    bounds_ = surface_->bounds();
    if (bounds_.empty()) bounds_ = boundBox(surface_->points(), false);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::closedSurface::types()
{
    return searchableSurface::dictConstructorTablePtr_->sortedToc();
}

// ************************************************************************* //
