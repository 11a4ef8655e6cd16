/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "movingFrame.H"
#include "materialPointCloud.H"
#include "nodeBoundary.H"
#include "nodeFolding.H"
#include "reachWeights.H"
#include "dictionaryEntries.H"
#include "quaternion.H"
#include "timeFunction.H"
#include "unitConversion.H"
#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    using namespace Foam;

    //- Turns vectors about a unit vector [rad]
    tensor turnAbout(const vector& axis, const scalar angle)
    {
        return quaternion(axis, angle).R();
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::mpm::movingFrame::angleAt(const scalar time) const
{
    return
        angle_.valid() ? degToRad(angle_->value(time))
      : angularVelocity_.valid() ? angularVelocity_->integrate(0, time)
      : 0;
}


Foam::scalar Foam::mpm::movingFrame::omegaAt
(
    const scalar time,
    const scalar deltaT
) const
{
    if (angularVelocity_.valid()) return angularVelocity_->value(time);

    // Nothing is known before the start
    const scalar first = max(scalar(0), time - 0.5*deltaT);
    const scalar last = time + 0.5*deltaT;
    return (angleAt(last) - angleAt(first))/(last - first);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::movingFrame::movingFrame
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
:
    dict_(dict),
    acceleration_
    (
        vectorInTime::New(dict, "acceleration", dimAcceleration, cells)
    ),
    origin_(dict.lookupOrDefault<point>("origin", Zero)),
    axis_(Zero),
    omega_(0),
    alpha_(0),
    turn_(I),
    deltaT_(1)
{
    checkKeywords
    (
        dict,
        {"acceleration", "origin", "axis", "angle", "angularVelocity"},
        strict
    );
    if (dict.found("angle"))
    {
        angle_ = readTimeFunction<scalar>(dict, "angle", dimless);
    }
    if (dict.found("angularVelocity"))
    {
        angularVelocity_ = readTimeFunction<scalar>
            (dict, "angularVelocity", dimless/dimTime);
    }
    if (angle_.valid() && angularVelocity_.valid())
    {
        FatalIOErrorInFunction(dict)
            << "keywords angle and angularVelocity are both given." << nl
            << "    Allowed: one of them" << exit(FatalIOError);
    }
    if (!turns())
    {
        if (!acceleration_.valid())
        {
            FatalIOErrorInFunction(dict)
                << "the frame does not move." << nl
                << "    Allowed: acceleration, angle or angularVelocity, as"
                << " functions of time" << exit(FatalIOError);
        }
        return;
    }

    axis_ = dict.get<vector>("axis");
    const scalar length = mag(axis_);
    bool good = length > SMALL;
    for (label d = 0; cells.nDim() == 2 && d < 2; ++d)
    {
        good = good && mag(axis_[cells.axis(d)]) < SMALL*length;
    }
    if (!good)
    {
        FatalIOErrorInFunction(dict)
            << "keyword axis is " << axis_ << '.' << nl << "    Allowed: ";
        if (cells.nDim() == 2)
        {
            FatalIOError
                << "along " << vector::componentNames[cells.axis(2)]
                << ", in which the case is empty";
        }
        else FatalIOError<< "not zero";
        FatalIOError<< exit(FatalIOError);
    }
    axis_ /= length;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::vector Foam::mpm::movingFrame::uniform
(
    const vector& gravity,
    const scalar time
) const
{
    vector g(gravity);

    // About a vertical axis it stays, and the angle need not be known
    if (turns() && mag(axis_ ^ g) > SMALL*mag(g))
    {
        g = turnAbout(axis_, -angleAt(time)) & g;
    }
    if (acceleration_.valid()) g -= acceleration_->value(time);
    return g;
}


void Foam::mpm::movingFrame::start(const scalar time, const scalar deltaT)
{
    if (!turns()) return;

    const scalar before = omegaAt(time - deltaT, deltaT);
    const scalar after = omegaAt(time, deltaT);
    omega_ = 0.5*(before + after);
    alpha_ = (after - before)/deltaT;
    turn_ = turnAbout(axis_, -2*omega_*deltaT);
    deltaT_ = deltaT;
    if (!std::isfinite(omega_) || !std::isfinite(alpha_))
    {
        FatalIOErrorInFunction(dict_)
            << "the angular velocity of the frame is " << omega_
            << " rad/s at " << time << " s, its change " << alpha_
            << " rad/s2." << nl << "    Allowed: numbers"
            << exit(FatalIOError);
    }
}


void Foam::mpm::movingFrame::addForces(materialPointCloud& cloud) const
{
    // Walls fold what acts at points, as they do with weights
    const backgroundGrid& grid = cloud.grid();
    const lattice& cells = grid.cells();
    const nodeFolding& folding = cloud.boundary().folding();
    const label nDim = grid.nDim();
    const label T = grid.reachWidth();
    nodalFields& nodes = cloud.nodes();

    nodeField<nodeVector> force;
    force.assign(grid.nNodes(), nodeVector{});
    for (label p = 0; p < cloud.size(); ++p)
    {
        const label cell = cloud.points().cell()[p];
        const index3 lower = grid.coordinate(cell);
        scalar w[3][4] = {};
        for (label d = 0; d < nDim; ++d)
        {
            const scalar f =
                (cloud.x(d)[p] - cells.origin(d))/cells.spacing(d)
              - (lower[d] + grid.lower(d));
            scalar unused[4];
            reachWeights(grid, f, w[d], unused);
        }
        auto weightOf = [&](const label t)
        {
            const scalar inPlane = w[0][t % T]*w[1][(t/T) % T];
            return nDim == 3 ? inPlane*w[2][t/(T*T)] : inPlane;
        };
        const label view =
            cloud.boundary().tiles().viewOf(cloud.points().tile()[p]);
        const label s = folding.stencil(cell, view);
        const label first = cell + grid.reachOffset();

        // The velocity of the grid: within a step points may have another one
        nodeVector ofGrid{};
        for (label t = 0; t < grid.reachSize(); ++t)
        {
            const scalar weight = weightOf(t);
            if (weight == 0) continue;
            if (s < 0)
            {
                ofGrid += weight*nodes.velocity[first + grid.reachNode(t)];
                continue;
            }
            const nodeVector& image = nodes.velocity[folding.targets(s)[t]];
            const label* walls = folding.walls(s);
            if (walls && walls[t] >= 0)
            {
                const nodeVector& factor = folding.wallFactors(s)[t];
                ofGrid += weight*factor
                   *(nodes.velocity[walls[t]] - 0.5*image);
            }
            else
            {
                ofGrid += weight
                   *(folding.signs(s)[t]*image + folding.shifts(s)[t]);
            }
        }
        vector v(Zero);
        for (label d = 0; d < nDim; ++d) v[cells.axis(d)] = ofGrid[d];
        const vector a
        (
            cloud.mass()[p]*(this->force(cloud.position(p)) + deflection(v))
        );
        nodeVector ofPoint{};
        for (label d = 0; d < nDim; ++d) ofPoint[d] = a[cells.axis(d)];

        for (label t = 0; t < grid.reachSize(); ++t)
        {
            const scalar weight = weightOf(t);
            if (weight == 0) continue;
            const nodeVector f = weight*ofPoint;
            if (s < 0)
            {
                force[first + grid.reachNode(t)] += f;
                continue;
            }

            const label target = folding.targets(s)[t];
            const nodeVector& sign = folding.signs(s)[t];
            const label* walls = folding.walls(s);
            const bool nodeWall = walls && walls[t] >= 0;
            if (nodes.mirrorsRecorded() && folding.slotsOf(s)[t] >= 0)
            {
                nodeVector odd = 1 - sign;
                for (label d = 0; nodeWall && d < nDim; ++d)
                {
                    if (folding.wallFactors(s)[t][d] != 2*sign[d]) odd[d] = 0;
                }
                nodes.mirrored.force[folding.slotsOf(s)[t]] += odd*f;
            }
            if (nodeWall)
            {
                const nodeVector& factor = folding.wallFactors(s)[t];
                force[target] += -0.5*factor*f;
                force[walls[t]] += factor*f;
            }
            else force[target] += sign*f;
        }
    }
    grid.exchange().sum(force);
    for (const auto& range : cloud.nodeRanges())
    {
        for (label i = range.first; i < range.second; ++i)
        {
            nodes.force[i] += force[i];
        }
    }
    cloud.pressWalls(force);
}


void Foam::mpm::movingFrame::addWork(materialPointCloud& cloud) const
{
    // At the middle of the way
    const lattice& cells = cloud.grid().cells();
    scalar work = 0;
    for (label p = 0; p < cloud.size(); ++p)
    {
        vector v(Zero);
        for (label d = 0; d < cells.nDim(); ++d)
        {
            v[cells.axis(d)] = cloud.v(d)[p];
        }
        const point x(cloud.position(p) - 0.5*deltaT_*v);
        work += deltaT_*cloud.mass()[p]*(force(x) & v);
    }
    cloud.addWork(work);
}

// ************************************************************************* //
