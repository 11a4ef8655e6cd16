/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodies.H"
#include "dictionaryEntries.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::bodies::checkThickness() const
{
    const scalar h = grid_.cells().minSpacing();
    const scalar least = minThickness*h;
    for (const body& b : bodies_)
    {
        if (b.thinPlate()) continue;

        // Straight through the body from nodes just inside of its surface
        scalar thinnest = b.thinnest();
        point where(b.thinnestAt());
        const label nDim = grid_.nDim();
        const int64_t n = int64_t(grid_.nBoxNodes()) << nDim;
        for (int64_t i = 0; i < n; ++i)
        {
            // Nodes, and the middles between them
            point x(grid_.nodePosition(label(i >> nDim)));
            for (label d = 0; d < nDim; ++d)
            {
                const scalar half = 0.5*grid_.cells().spacing(d);
                if ((i >> d) & 1) x[grid_.cells().axis(d)] += half;
            }
            const scalar phi = b.distance(x);
            if (!(phi < 0 && phi > -h)) continue;
            const vector g(b.gradient(x, 0.5*h));
            if (!(mag(g) > 0.5)) continue;
            const vector n(g/mag(g));
            const point surface(x - phi*n);
            scalar depth = 0;
            while (depth < least)
            {
                const scalar inside =
                    b.distance(surface - (depth + 0.25*h)*n);

                // Behind the last sample nobody looks
                if (inside > 0.5*GREAT) depth = least;
                else if (inside >= 0) break;
                depth += 0.25*h;
            }

            // The other side lies within the last quarter
            if (depth + 0.25*h < thinnest)
            {
                thinnest = depth + 0.25*h;
                where = surface;
            }
        }
        const scalar found = returnReduce(thinnest, minOp<scalar>());
        if (found < least)
        {
            FatalIOErrorInFunction(b.dict())
                << "body " << b.name() << " is thinner than " << found
                << " m (" << found/h << " cells) at " << where
                << "; its two sides would feel each other." << nl
                << "    Allowed: " << least << " m or thicker ("
                << minThickness << " cells), or a finer mesh"
                << exit(FatalIOError);
        }
    }
}


void Foam::mpm::bodies::checkOverlap() const
{
    for (label i = 0; i < grid_.nBoxNodes(); ++i)
    {
        const point x(grid_.nodePosition(i));
        label inside = -1;
        forAll(bodies_, b)
        {
            const scalar h = grid_.cells().minSpacing();
            if (!(bodies_[b].distance(x) < -0.5*h)) continue;
            if (inside >= 0)
            {
                FatalIOErrorInFunction(bodies_[b].dict())
                    << "bodies " << bodies_[inside].name() << " and "
                    << bodies_[b].name() << " overlap at " << x << '.' << nl
                    << "    Allowed: bodies that are apart"
                    << exit(FatalIOError);
            }
            inside = b;
        }
    }
}


void Foam::mpm::bodies::checkPlates() const
{
    const scalar far = body::reach*grid_.cells().minSpacing();
    forAll(bodies_, p)
    {
        if (!bodies_[p].thinPlate()) continue;
        const boundBox around(bodies_[p].bounds());
        boolList near(bodies_.size(), false);
        forAll(bodies_, b)
        {
            if (b == p) continue;
            near[b] = around.overlaps(bodies_[b].bounds());
            if (!bodies_[b].motion().moves() || bodies_[b].thinPlate()) continue;
            FatalIOErrorInFunction(bodies_[p].dict())
                << "plate " << bodies_[p].name() << " is in a scene with body "
                << bodies_[b].name() << ", which moves and is no plate." << nl
                << "    Allowed: plates that move, other bodies that are fixed"
                << exit(FatalIOError);
        }
        if (!near.found(true)) continue;
        for (label i = 0; i < grid_.nBoxNodes(); ++i)
        {
            const point x(grid_.nodePosition(i));
            if (!(bodies_[p].distance(x) < far)) continue;
            forAll(bodies_, b)
            {
                if (!near[b] || !(bodies_[b].distance(x) < far)) continue;
                FatalIOErrorInFunction(bodies_[p].dict())
                    << "plate " << bodies_[p].name() << " and body "
                    << bodies_[b].name() << " are both nearer than " << far
                    << " m to " << x << " at time "
                    << grid_.mesh().time().timeName() << " s." << nl
                    << "    Allowed: " << 2*far << " m (" << 2*body::reach
                    << " cells) or more between a plate and another body"
                    << exit(FatalIOError);
            }
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bodies::bodies
(
    const backgroundGrid& grid,
    const dictionary& dict,
    const wordList& clouds,
    const bool strict
)
:
    grid_(grid),
    anyMoves_(false),
    anyPlateMoves_(false),
    anyPushed_(false)
{
    if (grid_.secondMoment() == 0)
    {
        FatalErrorInFunction
            << "bodies do not work with the shape function "
            << grid_.shapeFunction() << '.' << nl
            << "    Allowed: quadraticBSpline, cubicBSpline"
            << exit(FatalError);
    }
    for (const entry& e : dict)
    {
        if (!e.isDict())
        {
            FatalIOErrorInFunction(dict)
                << "keyword " << e.keyword() << " is no dictionary." << nl
                << "    Allowed: a dictionary for each body"
                << exit(FatalIOError);
        }
        bodies_.append(new body(e.dict(), grid_, clouds, strict));
        anyMoves_ = anyMoves_ || bodies_.last().motion().moves();
        anyPlateMoves_ = anyPlateMoves_
         || (bodies_.last().thinPlate() && bodies_.last().motion().moves());
        anyPushed_ = anyPushed_ || bodies_.last().motion().pushed();
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

std::vector<Foam::mpm::plate> Foam::mpm::bodies::plates() const
{
    std::vector<plate> all;
    for (const body& b : bodies_)
    {
        if (b.thinPlate()) all.push_back(*b.thinPlate());
    }
    return all;
}


Foam::label Foam::mpm::bodies::nearest
(
    const point& x,
    scalar& distance
) const
{
    label found = -1;
    distance = GREAT;
    forAll(bodies_, b)
    {
        const scalar phi = bodies_[b].distance(x);
        if (phi < distance)
        {
            distance = phi;
            found = b;
        }
    }
    return found;
}


void Foam::mpm::bodies::start(const scalar time)
{
    for (body& b : bodies_) b.motion().start(time);
    checkThickness();
    checkOverlap();
    checkPlates();
}


void Foam::mpm::bodies::findVelocities(const scalar time, const scalar deltaT)
{
    for (body& b : bodies_)
    {
        b.motion().findVelocity(time, deltaT);
    }
    const scalar most = grid_.cells().minSpacing()/deltaT;
    const scalar speed = anyMoves_ ? maxSpeed() : 0;
    if (!(speed < most))
    {
        FatalErrorInFunction
            << "a body moves at " << speed << " m/s at time " << time
            << " s, more than a cell in a step of " << deltaT << " s." << nl
            << "    Allowed: < " << most << " m/s; look at the keyword motion,"
            << " or set maxDeltaT" << exit(FatalError);
    }
}


void Foam::mpm::bodies::move(const scalar time, const scalar deltaT)
{
    for (body& b : bodies_) b.motion().move(time, deltaT);
    placePlates();
}


void Foam::mpm::bodies::placePlates()
{
    if (!anyPlateMoves_) return;

    for (body& b : bodies_)
    {
        if (b.thinPlate() && b.motion().moves()) b.placePlate(grid_);
    }
    checkPlates();
}


void Foam::mpm::bodies::readState(const dictionary& dict)
{
    for (body& b : bodies_)
    {
        if (b.motion().moves())
        {
            b.motion().readState(subDictOf(dict, b.name()));
        }
    }
    placePlates();
}


void Foam::mpm::bodies::writeState(dictionary& dict) const
{
    for (const body& b : bodies_)
    {
        dictionary state;
        b.motion().writeState(state);
        if (!state.empty()) dict.set(b.name(), state);
    }
}


Foam::scalar Foam::mpm::bodies::maxSpeed() const
{
    scalar most = 0;
    for (const body& b : bodies_)
    {
        if (!b.motion().moves()) continue;
        const pointField corners(b.bounds().points());
        for (const point& x : corners)
        {
            most = max(most, mag(b.motion().velocity(x)));
        }
    }
    return most;
}


Foam::scalar Foam::mpm::bodies::volumeInMesh
(
    const scalar from,
    const scalar to
) const
{
    const label nTimes = 100;
    const boundBox& mesh = grid_.mesh().bounds();
    scalar sum = 0;
    for (const body& b : bodies_)
    {
        const boundBox now(b.bounds());
        for (label i = 0; i < nTimes; ++i)
        {
            const scalar time = from + (i + 0.5)/nTimes*(to - from);
            const vector way(b.motion().centreAt(time) - b.motion().centre());
            const vector size
            (
                min(now.max() + way, mesh.max())
              - max(now.min() + way, mesh.min())
            );
            if (cmptMin(size) > 0) sum += cmptProduct(size)/nTimes;
        }
    }
    return sum;
}


size_t Foam::mpm::bodies::memory() const
{
    size_t bytes = 0;
    for (const body& b : bodies_) bytes += b.memory();
    return bytes;
}

// ************************************************************************* //
