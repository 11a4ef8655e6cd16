/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "body.H"
#include "dictionaryEntries.H"
#include "closedSurface.H"
#include "Time.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::body::checkInside(const backgroundGrid& grid) const
{
    const lattice& cells = grid.cells();
    const boundBox& mesh = grid.mesh().bounds();
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        if
        (
            bounds_.min()[axis] > mesh.max()[axis]
         || bounds_.max()[axis] < mesh.min()[axis]
        )
        {
            FatalIOErrorInFunction(subDictOf(dict_, "surface"))
                << "body " << name_ << " is outside of the mesh: it goes from "
                << bounds_.min() << " to " << bounds_.max() << ", the mesh from "
                << mesh.min() << " to " << mesh.max() << '.' << nl
                << "    Allowed: a body of which a part is in the mesh"
                << exit(FatalIOError);
        }
    }
}


void Foam::mpm::body::checkCyclic(const backgroundGrid& grid) const
{
    // Images of the plate are not looked for
    const lattice& cells = grid.cells();
    const scalar h = cells.minSpacing();
    for (label d = 0; d < cells.nDim(); ++d)
    {
        if (!cells.periodic(d)) continue;
        const label axis = cells.axis(d);
        const scalar from = cells.origin(d);
        const scalar to = from + cells.nCells(d)*cells.spacing(d);
        const bool along = mag(plate_->normal()[axis]) < 1e-6;
        const bool inner =
            bounds_.min()[axis] > from + far_ && bounds_.max()[axis] < to - far_;
        const bool whole =
            along && bounds_.min()[axis] < from - 2*h
         && bounds_.max()[axis] > to + 2*h;
        if (inner || whole) continue;
        FatalIOErrorInFunction(subDictOf(dict_, "surface"))
            << "plate " << name_ << " goes from " << bounds_.min() << " to "
            << bounds_.max() << ", near to a cyclic patch." << nl
            << "    Allowed: " << far_ << " m or more away from it, or from one"
            << " end of the cyclic direction to the other, along it"
            << exit(FatalIOError);
    }
}


void Foam::mpm::body::readPlate
(
    const backgroundGrid& grid,
    const bool strict
)
{
    const dictionary& dict = subDictOf(dict_, "surface");
    const lattice& cells = grid.cells();
    const bool is3D = cells.nDim() == 3;
    wordList known({"type", "start", "end", "thickness"});
    if (is3D) known.append("across");
    checkKeywords(dict, known, strict);
    if (motion_->pushed())
    {
        FatalIOErrorInFunction(dict_)
            << "keyword type is " << dict_.get<word>("type") << ", but body "
            << name_ << " is a plate." << nl
            << "    Allowed: fixed, prescribed; a box of "
            << 2.5*cells.minSpacing() << " m (2.5 cells) or more may be rigid"
            << exit(FatalIOError);
    }

    point start(dict.get<point>("start"));
    point end(dict.get<point>("end"));
    vector across(Zero);
    if (is3D) across = dict.get<vector>("across");
    else
    {
        const label axis = cells.axis(2);
        start[axis] = end[axis] = cells.midPlane();
        across[axis] = 1;
    }
    const scalar h = cells.minSpacing();
    if (!(mag(end - start) > h))
    {
        FatalIOErrorInFunction(dict)
            << "keywords start and end are " << start << " and " << end
            << ", in the plane of the case " << mag(end - start) << " m apart."
            << nl << "    Allowed: more than " << h << " m, a cell"
            << exit(FatalIOError);
    }
    if
    (
        is3D
     && (
            !(mag(across) > h)
         || mag(across & (end - start)) > 1e-6*mag(across)*mag(end - start)
        )
    )
    {
        FatalIOErrorInFunction(dict)
            << "keyword across is " << across << ", the middle line "
            << end - start << '.' << nl << "    Allowed: more than " << h
            << " m, a cell, at a right angle to the middle line"
            << exit(FatalIOError);
    }
    given_.reset
    (
        new plate
        (
            start, end, across, readPositive(dict, "thickness", dimLength),
            !is3D
        )
    );
    far_ = (reach + 1)*h;
    bounds_ = given_->bounds();
    if (!motion_->moves()) checkInside(grid);
    motion_->start(grid.mesh().time().value());
    placePlate(grid);
}


void Foam::mpm::body::sample
(
    const backgroundGrid& grid,
    const bool strict
)
{
    const dictionary& dict = subDictOf(dict_, "surface");
    const closedSurface surface(grid.mesh().time(), dict, {}, strict);
    bounds_ = surface.bounds();

    const lattice& cells = grid.cells();
    const scalar h = cells.minSpacing();
    const scalar far = (reach + 1)*h;
    if (cells.nDim() < 3)
    {
        const label axis = cells.axis(2);
        const scalar front = cells.midPlane() + 0.5*cells.thickness();
        const scalar back = cells.midPlane() - 0.5*cells.thickness();
        if
        (
            bounds_.max()[axis] < front + reach*h
         || bounds_.min()[axis] > back - reach*h
        )
        {
            FatalIOErrorInFunction(dict)
                << "body " << name_ << " goes from " << bounds_.min()[axis]
                << " to " << bounds_.max()[axis]
                << " m across the plane of the case." << nl
                << "    Allowed: from " << back - reach*h << " or less to "
                << front + reach*h << " m or more, three cells beyond the mesh"
                << exit(FatalIOError);
        }
    }

    boundBox region(bounds_.min() - vector::uniform(far), bounds_.max());
    region.max() += vector::uniform(far);
    const boundBox& mesh = grid.mesh().bounds();
    if (!motion_->moves())
    {
        // Far from the mesh nobody asks
        region.min() = max(region.min(), mesh.min() - vector::uniform(far));
        region.max() = min(region.max(), mesh.max() + vector::uniform(far));
    }
    if (!motion_->moves()) checkInside(grid);

    const scalar spacing = 0.5*h;
    const int64_t n = signedDistance::nSamples(region, spacing, cells);
    if (n > signedDistance::maxSamples)
    {
        FatalIOErrorInFunction(dict)
            << "body " << name_ << " asks for " << scalar(n)
            << " samples of its distance, every " << spacing << " m." << nl
            << "    Allowed: " << scalar(signedDistance::maxSamples)
            << " or less; a smaller body, or a coarser mesh"
            << exit(FatalIOError);
    }
    distance_.reset
    (
        new signedDistance
        (
            surface.surface(),
            region,
            motion_->moves() ? region : mesh,
            spacing,
            cells
        )
    );
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::body::body
(
    const dictionary& dict,
    const backgroundGrid& grid,
    const wordList& clouds,
    const bool strict
)
:
    name_(dict.dictName()),
    dict_(dict)
{
    wordList known({"type", "surface", "motion"});
    known.append(clouds);
    checkKeywords(dict_, known, strict);

    motion_ = bodyMotion::New(dict_, grid.cells(), strict);
    const dictionary surface(subDictOrEmpty(dict_, "surface"));
    if (surface.lookupOrDefault<word>("type", word::null) == "plate")
    {
        readPlate(grid, strict);
    }
    else sample(grid, strict);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::body::placePlate(const backgroundGrid& grid)
{
    const scalar h = grid.cells().minSpacing();
    const bool moves = motion_->moves();
    plate_.reset
    (
        moves
      ? new plate
        (
            given_->moved
            (
                [&](const point& X) { return motion_->fromSurface(X); },
                motion_->rotation()
            )
        )
      : new plate(*given_)
    );

    // Behind walls it goes on as far as nodes are in reach: from the first place
    // that tells
    const label nEdges = grid.nDim() == 3 ? 4 : 2;
    const scalar step = 0.25*h;
    const scalar nearest = (moves ? 0.5 : 1e-3)*h;
    const label nSteps = 8*reach;
    for (label edge = 0; edge < nEdges; ++edge)
    {
        DynamicList<point> places;
        for (label i = 0; i < nSteps; ++i)
        {
            places.append(plate_->edge(edge, max(i*step, nearest), step));
        }
        const label first = grid.inMesh(pointField(places)).find(true);
        const label nOutside =
            first < 0 ? nSteps : first/(places.size()/nSteps);
        if (nOutside > 1) plate_->extend(edge, (nOutside - 1)*step);
    }
    bounds_ = plate_->bounds();
    checkCyclic(grid);
}


Foam::dictionary Foam::mpm::body::wallOf(const word& cloud) const
{
    return subDictOrEmpty(dict_, cloud);
}


Foam::boundBox Foam::mpm::body::reachedBounds(const scalar spacing) const
{
    if (!plate_.valid()) return bounds();

    const vector far(vector::uniform((reach + 2)*spacing));
    return boundBox(bounds_.min() - far, bounds_.max() + far);
}


Foam::boundBox Foam::mpm::body::bounds() const
{
    if (plate_.valid())
    {
        // As far as second records, and all cells in whose reach they are
        const vector far(vector::uniform(2*far_));
        return boundBox(bounds_.min() - far, bounds_.max() + far);
    }
    const boundBox& samples = distance_->bounds();
    if (!motion_->moves()) return samples;

    pointField corners(samples.points());
    for (point& x : corners) x = motion_->fromSurface(x);
    return boundBox(corners, false);
}

// ************************************************************************* //
