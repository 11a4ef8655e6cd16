/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "body.H"
#include "dictionaryEntries.H"
#include "closedSurface.H"
#include "Time.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

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
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        if
        (
            !motion_->moves()
         && (
                bounds_.min()[axis] > mesh.max()[axis]
             || bounds_.max()[axis] < mesh.min()[axis]
            )
        )
        {
            FatalIOErrorInFunction(dict)
                << "body " << name_ << " is outside of the mesh: it goes from "
                << bounds_.min() << " to " << bounds_.max() << ", the mesh from "
                << mesh.min() << " to " << mesh.max() << '.' << nl
                << "    Allowed: a body of which a part is in the mesh"
                << exit(FatalIOError);
        }
    }

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
    sample(grid, strict);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::dictionary Foam::mpm::body::wallOf(const word& cloud) const
{
    return subDictOrEmpty(dict_, cloud);
}


Foam::boundBox Foam::mpm::body::bounds() const
{
    const boundBox& samples = distance_->bounds();
    if (!motion_->moves()) return samples;

    pointField corners(samples.points());
    for (point& x : corners) x = motion_->fromSurface(x);
    return boundBox(corners, false);
}

// ************************************************************************* //
