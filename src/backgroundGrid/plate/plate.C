/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "plate.H"
#include "pointField.H"
#include <cmath>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::plate::plate
(
    const point& start,
    const point& end,
    const vector& across,
    const scalar thickness,
    const bool endless
)
:
    centre_(0.5*(start + end)),
    halfThickness_(0.5*thickness)
{
    const scalar length = mag(end - start);
    const scalar width = mag(across);
    axes_[0] = (end - start)/length;
    axes_[1] = across/width;
    axes_[2] = axes_[0] ^ axes_[1];
    lower_[0] = -0.5*length;
    upper_[0] = 0.5*length;
    lower_[1] = endless ? -0.1*GREAT : -0.5*width;
    upper_[1] = endless ? 0.1*GREAT : 0.5*width;
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::mpm::plate::partInSpan
(
    const label k,
    const vector& local,
    const scalar size
) const
{
    return
        above(local[k] - lower_[k], size) + above(upper_[k] - local[k], size)
      - 1;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::pointField Foam::mpm::plate::edge
(
    const label i,
    const scalar beyond,
    const scalar spacing
) const
{
    const label k = i/2;
    const label other = 1 - k;
    const scalar at = i % 2 ? upper_[k] + beyond : lower_[k] - beyond;
    const point middle(centre_ + at*axes_[k]);
    const scalar length = upper_[other] - lower_[other];
    if (length > 0.01*GREAT) return pointField(1, middle);

    const label n = label(std::ceil(length/spacing)) + 1;
    pointField x(n);
    forAll(x, j)
    {
        x[j] = middle
          + (lower_[other] + (j + 0.5)/n*length)*axes_[other];
    }
    return x;
}


void Foam::mpm::plate::extend(const label i, const scalar length)
{
    if (i % 2) upper_[i/2] += length;
    else lower_[i/2] -= length;
}


Foam::vector Foam::mpm::plate::change
(
    const plate& before,
    const scalar radius
) const
{
    vector most;
    for (label k = 0; k < 3; ++k)
    {
        most[k] =
            mag(axes_[k] - before.axes_[k])*radius
          + mag(axes_[k] & (centre_ - before.centre_));
        if (k == 2) continue;
        most[k] += max
        (
            mag(lower_[k] - before.lower_[k]), mag(upper_[k] - before.upper_[k])
        );
    }
    return most;
}


Foam::mpm::plate::surface Foam::mpm::plate::nearestTo
(
    const vector& local
) const
{
    // Beyond which faces it is, by how much, and on which side of the middle
    FixedList<scalar, 3> beyond, sign;
    for (label k = 0; k < 3; ++k)
    {
        const scalar xi = local[k];
        const scalar lower = k < 2 ? lower_[k] - xi : -halfThickness_ - xi;
        const scalar upper = k < 2 ? xi - upper_[k] : xi - halfThickness_;
        beyond[k] = max(lower, upper);
        sign[k] = (k == 2 ? xi >= -skin() : upper >= lower) ? 1 : -1;
    }

    // What is as near to an end as to a face belongs to the end: flow around it
    // must not be held by nodes that are there for the faces. The edge itself is
    // off both.
    label farthest = 2, n = 0;
    vector way(Zero), off(Zero);
    for (label k = 2; k >= 0; --k)
    {
        if (beyond[k] > beyond[farthest] - skin()) farthest = k;
        if (!(beyond[k] > -skin())) continue;
        ++n;
        way += max(beyond[k], scalar(0))*sign[k]*axes_[k];
        off += sign[k]*axes_[k];
    }
    if (n < 2)
    {
        return surface
        {
            beyond[farthest], sign[farthest]*axes_[farthest], true
        };
    }
    const scalar distance = mag(way);
    return surface
    {
        distance, distance > skin() ? way/distance : off/mag(off), false
    };
}


Foam::FixedList<Foam::scalar, 4> Foam::mpm::plate::parts
(
    const vector& local,
    const scalar size
) const
{
    const scalar inSpan = partInSpan(0, local, size)*partInSpan(1, local, size);
    FixedList<scalar, 4> part(partsBetweenEdges(local[2], size));
    part[front] *= inSpan;
    part[back] *= inSpan;
    part[none] = 1 - inSpan;
    part[3] = max(scalar(0), inSpan - part[front] - part[back]);
    return part;
}


Foam::boundBox Foam::mpm::plate::bounds() const
{
    boundBox box;
    for (label corner = 0; corner < 8; ++corner)
    {
        point x(centre_);
        for (label k = 0; k < 3; ++k)
        {
            const bool upper = (corner >> k) & 1;
            const scalar at =
                k < 2
              ? (upper ? upper_[k] : lower_[k])
              : (upper ? halfThickness_ : -halfThickness_);
            x += at*axes_[k];
        }
        box.add(x);
    }
    return box;
}

// ************************************************************************* //
