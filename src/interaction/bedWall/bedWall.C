/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bedWall.H"
#include "backgroundGrid.H"
#include "bodyNodes.H"
#include "couplingFields.H"
#include "nodalFields.H"
#include "nodeBoundary.H"
#include "wallLaw.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    //- Solid fraction at a node y over a plane bed, of the quadratic spline
    static scalar planeFraction(const scalar y)
    {
        if (y < 0) return 1 - planeFraction(-y);
        if (y >= 1.5) return 0;
        return y >= 0.5 ? pow3(1.5 - y)/6 : 0.5 - 0.75*y + pow3(y)/3;
    }

    //- The same smoothed by (1 2 1)/4
    static scalar smoothFraction(const scalar y)
    {
        return
            0.25*planeFraction(y - 1) + 0.5*planeFraction(y)
          + 0.25*planeFraction(y + 1);
    }

    //- The height at which it has a value; beyond reach 2.5
    static scalar planeHeight(const scalar phi, const scalar reach)
    {
        static const scalar least = smoothFraction(reach);
        if (phi <= least) return 2.5;
        if (phi >= 1 - least) return -2.5;

        scalar low = -reach, high = reach;
        for (int i = 0; i < 40; ++i)
        {
            const scalar y = 0.5*(low + high);
            (smoothFraction(y) > phi ? low : high) = y;
        }
        return 0.5*(low + high);
    }
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Op>
void Foam::mpm::bedWall::forInner(const Op& op) const
{
    // Behind walls there is neither soil nor water
    nodes_.forInner
    (
        [&](const label i) { if (inverseVolume_[i] > 0) op(i); }
    );
}


void Foam::mpm::bedWall::lookBeside
(
    const std::function<scalar(const label)>& solidFraction,
    const bodyNodes& bodies
)
{
    inBody_.assign(grid_.nNodes(), 0);
    besideBody_.assign(grid_.nNodes(), nodeVector{});
    for (const bodyNodes::local& l : bodies.locals())
    {
        const bodyNodes::node& node = bodies[l.number];
        inBody_[l.grid] = node.V*node.inverseVolume;
    }

    forInner
    (
        [&](const label i)
        {
            const scalar open = 1 - inBody_[i];
            if (open < leastOpen) return;
            besideBody_[i] = nodeVector{solidFraction(i)/open, 1, 0, 0};
        }
    );
    nodes_.share(besideBody_, perCopy_);
    forInner
    (
        [&](const label i)
        {
            if (besideBody_[i][1] > 0) return;
            scalar sum = 0, weights = 0;
            for (size_t t = 0; t < around_.size(); ++t)
            {
                const nodeVector& from = besideBody_[i + around_[t]];
                if (!(from[1] > 0)) continue;
                sum += weight_[t]*from[0];
                weights += weight_[t];
            }
            if (weights > 0) besideBody_[i][0] = sum/weights;
        }
    );
    nodes_.share(besideBody_, perCopy_);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bedWall::bedWall
(
    const backgroundGrid& grid,
    const couplingFields& coupling,
    const nodeBoundary& boundary,
    const scalar ks,
    const scalar nu,
    const scalar a,
    const scalar b
)
:
    grid_(grid),
    coupling_(coupling),
    inverseVolume_(boundary.inverseVolume()),
    nu_(nu),
    nodes_(grid),
    perCopy_(grid.nNodes(), 1),
    smooth_(grid.nNodes(), nodeVector{}),
    surface_(grid.nNodes(), nodeVector{}),
    stress_(grid.nNodes(), nodeVector{})
{
    fields_.ks = ks;
    fields_.a = a;
    fields_.b = b;
    fields_.distance.assign(grid.nNodes(), GREAT);
    fields_.frictionVelocity.assign(grid.nNodes(), 0);

    nodes_.countCopies(perCopy_);

    const label depth = grid.nDim() == 3 ? 1 : 0;
    for (label k = -depth; k <= depth; ++k)
    for (label j = -1; j <= 1; ++j)
    for (label i = -1; i <= 1; ++i)
    {
        around_.push_back(i + j*grid.stride(1) + k*grid.stride(2));
        weight_.push_back
        (
            (i ? 0.25 : 0.5)*(j ? 0.25 : 0.5)*(depth ? (k ? 0.25 : 0.5) : 1)
        );
        step_.push_back(nodeVector{scalar(i), scalar(j), scalar(k), 0});
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::bedWall::h() const
{
    return grid_.cells().minSpacing();
}


void Foam::mpm::bedWall::update
(
    const std::function<scalar(const label)>& alone,
    const bodyNodes* bodies,
    const nodalFields& soil,
    const nodalFields& water
)
{
    const label dim = grid_.nDim();
    const label n = around_.size();
    const scalar h = this->h();

    // What was
    auto clear = [&](const label i)
    {
        smooth_[i] = surface_[i] = stress_[i] = nodeVector{};
        fields_.distance[i] = GREAT;
        fields_.frictionVelocity[i] = 0;
    };
    nodes_.forTouched(clear);
    nodes_.setRanges(coupling_.ranges);

    if (bodies) lookBeside(alone, *bodies);
    auto solidFraction = [&](const label i)
    {
        return bodies ? besideBody(i) : alone(i);
    };

    // Is there a bed here, next to here, and next but one
    auto near = [&](const label slot)
    {
        nodes_.share(smooth_, perCopy_);
        forInner
        (
            [&](const label i)
            {
                scalar most = 0;
                for (const label o : around_)
                {
                    most = max(most, smooth_[i + o][slot]);
                }
                smooth_[i][slot + 1] = most;
            }
        );
    };
    forInner
    (
        [&](const label i)
        {
            scalar phi = 0;
            for (label t = 0; t < n; ++t)
            {
                const label j = i + around_[t];
                phi += weight_[t]*solidFraction(inverseVolume_[j] > 0 ? j : i);
            }
            smooth_[i][0] = phi;
            smooth_[i][1] = solidFraction(i) > leastFraction;
        }
    );
    near(1);
    near(2);
    nodes_.share(smooth_, perCopy_);

    forInner
    (
        [&](const label i)
        {
            const scalar phi = smooth_[i][0];
            if (!(phi > 0) || !(smooth_[i][3] > 0)) return;
            const scalar y = h*planeHeight(phi, reach);
            fields_.distance[i] = y;
            if (mag(y) > reach*h) return;

            nodeVector area{};
            scalar slopeSqr = 0;
            for (label d = 0; d < dim; ++d)
            {
                const label s = grid_.stride(d);
                if (!(inverseVolume_[i - s] > 0 && inverseVolume_[i + s] > 0))
                {
                    continue;
                }
                area[d] =
                    (smooth_[i - s][0] - smooth_[i + s][0])
                   /(2*grid_.cells().spacing(d));
                slopeSqr += sqr(area[d]);
            }
            const scalar slope = std::sqrt(slopeSqr);
            const scalar plane =
                0.5*(smoothFraction(y/h - 1) - smoothFraction(y/h + 1))/h;
            if (!(slope > leastSlope*plane)) return;

            nodeVector s = area*(1/slope);
            for (label d = dim; d < 4; ++d) s[d] = 0;
            s[3] = slope/inverseVolume_[i];

            // Water away from the bed, relative to the soil
            nodeVector u{};
            scalar weights = 0, height = 0;
            for (label t = 0; t < n; ++t)
            {
                scalar up = 0;
                for (label d = 0; d < dim; ++d) up += step_[t][d]*s[d];
                const label j = i + around_[t];
                if (up <= 0 || !(water.mass(j) > 0)) continue;
                const scalar w = sqr(up)*weight_[t]*water.mass(j);
                u += w*water.velocity[j];
                height += w*(y + up*h);
                weights += w;
            }
            if (!(weights > 0)) return;

            const scalar m = soil.mass(i);
            scalar along = 0, across = 0;
            for (label d = 0; d < dim; ++d)
            {
                u[d] = u[d]/weights - (m > 0 ? soil.velocity[i][d] : 0);
                across += u[d]*s[d];
                along += sqr(u[d]);
            }
            surface_[i] = s;
            const scalar speed =
                std::sqrt(max(along - sqr(across), scalar(0)));
            const scalar uStar = wallLaw::frictionVelocity
            (
                speed, max(height/weights, 0.5*h), fields_.ks, nu_
            );
            fields_.frictionVelocity[i] = uStar;
            for (label d = 0; d < dim; ++d)
            {
                stress_[i][d] =
                    (u[d] - across*s[d])*sqr(uStar)/max(speed, VSMALL);
            }
        }
    );

    if (nodes_.alone()) return;
    nodes_.share(surface_, perCopy_);
    nodes_.share(stress_, perCopy_);
    for (const label i : nodes_.shared())
    {
        smooth_[i] = nodeVector{};
        if (fields_.distance[i] < GREAT)
        {
            smooth_[i] = nodeVector
            {
                fields_.distance[i], fields_.frictionVelocity[i], 1, 0
            };
        }
    }
    nodes_.share(smooth_, perCopy_);
    for (const label i : nodes_.shared())
    {
        fields_.distance[i] = smooth_[i][2] > 0 ? smooth_[i][0] : GREAT;
        fields_.frictionVelocity[i] = smooth_[i][1];
    }
}

// ************************************************************************* //
