/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "signedDistance.H"
#include "searchableSurface.H"
#include "DynamicList.H"
#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    using namespace Foam;

    //- Samples along a component
    label samples(const boundBox& region, const scalar spacing, const label axis)
    {
        const scalar length = region.max()[axis] - region.min()[axis];
        return label(std::ceil(max(length, scalar(0))/spacing)) + 1;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::signedDistance::signedDistance
(
    const searchableSurface& surface,
    const boundBox& region,
    const boundBox& within,
    const scalar spacing,
    const lattice& cells
)
:
    nDim_(cells.nDim()),
    spacing_(spacing),
    bounds_(region),
    thinnest_(GREAT),
    thinnestAt_(Zero)
{
    n_ = 1;
    label size = 1;
    for (label d = 0; d < nDim_; ++d)
    {
        axis_[d] = cells.axis(d);
        origin_[d] = region.min()[axis_[d]];
        n_[d] = samples(region, spacing, axis_[d]);
        bounds_.max()[axis_[d]] = origin_[d] + (n_[d] - 1)*spacing;
        size *= n_[d];
    }

    pointField position(size, point::uniform(cells.midPlane()));
    label i = 0;
    for (label z = 0; z < n_[2]; ++z)
    for (label y = 0; y < n_[1]; ++y)
    for (label x = 0; x < n_[0]; ++x, ++i)
    {
        const index3 at{x, y, z};
        for (label d = 0; d < nDim_; ++d)
        {
            position[i][axis_[d]] = origin_[d] + at[d]*spacing;
        }
    }

    List<pointIndexHit> nearest;
    surface.findNearest(position, scalarField(size, sqr(GREAT)), nearest);
    List<volumeType> side;
    surface.getVolumeType(position, side);

    value_.resize(size);
    for (i = 0; i < size; ++i)
    {
        const scalar distance = mag(nearest[i].hitPoint() - position[i]);
        value_[i] = side[i] == volumeType::INSIDE ? -distance : distance;
    }
    findThinnest(surface, within, position, nearest, side);
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::signedDistance::findThinnest
(
    const searchableSurface& surface,
    const boundBox& within,
    const pointField& position,
    const List<pointIndexHit>& nearest,
    const List<volumeType>& side
)
{
    // From outside through the nearest place of the surface to the other side
    const scalar skin = 1e-4*spacing_;
    DynamicList<point> start, end;
    forAll(position, i)
    {
        const vector way(nearest[i].hitPoint() - position[i]);
        const scalar distance = mag(way);
        if
        (
            side[i] == volumeType::INSIDE
         || distance > 1.5*spacing_
         || distance < skin
         || !within.contains(nearest[i].hitPoint())
        ) continue;
        const vector n(way/distance);
        start.append(nearest[i].hitPoint() + skin*n);
        end.append(nearest[i].hitPoint() + 2*spacing_*n);
    }
    List<pointIndexHit> exit;
    surface.findLine(pointField(start), pointField(end), exit);

    DynamicList<pointIndexHit> hits;
    DynamicList<label> line;
    forAll(exit, i)
    {
        if (!exit[i].hit()) continue;
        hits.append(exit[i]);
        line.append(i);
    }
    vectorField normal;
    surface.getNormal(hits, normal);
    forAll(hits, i)
    {
        const point& from = start[line[i]];
        const vector through(hits[i].hitPoint() - from);
        const scalar depth = mag(through);

        // Sides that meet at an edge are no plate, however thin they end: they
        // differ by 1:16 at least
        if (depth < skin || mag(through & normal[i]) < 0.998*depth) continue;
        if (depth + skin < thinnest_)
        {
            thinnest_ = depth + skin;
            thinnestAt_ = from;
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

int64_t Foam::mpm::signedDistance::nSamples
(
    const boundBox& region,
    const scalar spacing,
    const lattice& cells
)
{
    scalar n = 1;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        n *= max(region.max()[axis] - region.min()[axis], scalar(0))/spacing + 2;
    }
    return n < 1e18 ? int64_t(n) : int64_t(1e18);
}


Foam::scalar Foam::mpm::signedDistance::value(const point& x) const
{
    label first = 0;
    label stride[3];
    scalar f[3];
    label size = 1;
    for (label d = 0; d < nDim_; ++d)
    {
        const scalar xi = (x[axis_[d]] - origin_[d])/spacing_;
        if (!(xi >= 0 && xi <= n_[d] - 1)) return GREAT;
        const label lower = min(label(xi), n_[d] - 2);
        f[d] = xi - lower;
        stride[d] = size;
        first += lower*size;
        size *= n_[d];
    }

    scalar sum = 0;
    for (label corner = 0; corner < (1 << nDim_); ++corner)
    {
        scalar weight = 1;
        label at = first;
        for (label d = 0; d < nDim_; ++d)
        {
            const bool upper = (corner >> d) & 1;
            weight *= upper ? f[d] : 1 - f[d];
            if (upper) at += stride[d];
        }
        sum += weight*value_[at];
    }
    return sum;
}


Foam::vector Foam::mpm::signedDistance::gradient
(
    const point& x,
    const scalar length
) const
{
    vector g(Zero);
    for (label d = 0; d < nDim_; ++d)
    {
        // One-sided at the end of the samples
        point upper(x), lower(x);
        upper[axis_[d]] =
            min(x[axis_[d]] + 0.5*length, bounds_.max()[axis_[d]]);
        lower[axis_[d]] =
            max(x[axis_[d]] - 0.5*length, bounds_.min()[axis_[d]]);
        const scalar distance = upper[axis_[d]] - lower[axis_[d]];
        if (distance > 0)
        {
            g[axis_[d]] = (value(upper) - value(lower))/distance;
        }
    }
    return g;
}

// ************************************************************************* //
