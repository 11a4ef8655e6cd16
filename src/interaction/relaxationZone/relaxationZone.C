/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "relaxationZone.H"
#include "materialPointCloud.H"
#include "nodeBoundary.H"
#include "dictionaryEntries.H"
#include "PstreamReduceOps.H"
#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::relaxationZone::readDirection(const dictionary& dict)
{
    if (!dict.found("direction")) return;

    const vector direction(dict.get<vector>("direction"));
    const lattice& cells = grid_.cells();
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        vector others(direction);
        others[axis] = 0;
        if (mag(direction[axis]) > 0 && !(mag(others) > 0))
        {
            along_ = axis;
            backwards_ = direction[axis] < 0;
        }
    }
    if (along_ < 0)
    {
        FatalIOErrorInFunction(dict)
            << "keyword direction is " << direction << '.' << nl
            << "    Allowed: along an axis of the case, as (1 0 0) or (-1 0 0)"
            << exit(FatalIOError);
    }
}


Foam::scalar Foam::mpm::relaxationZone::rateAt(const point& x) const
{
    const lattice& cells = grid_.cells();
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        if (x[axis] < box_.min()[axis] || x[axis] > box_.max()[axis]) return 0;
    }
    if (along_ < 0) return rate_;
    const scalar way =
        backwards_
      ? box_.max()[along_] - x[along_] : x[along_] - box_.min()[along_];
    return rate_*sqr(way/(box_.max()[along_] - box_.min()[along_]));
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::relaxationZone::relaxationZone
(
    const dictionary& dict,
    materialPointCloud& cloud,
    const bool strict
)
:
    name_(dict.dictName()),
    cloud_(cloud),
    grid_(cloud.grid()),
    box_(dict.get<point>("min"), dict.get<point>("max")),
    rate_(readPositive(dict, "rate", dimless/dimTime)),
    along_(-1),
    backwards_(false),
    velocity_
    (
        vectorInTime::New(dict, "velocity", dimVelocity, grid_.cells())
    ),
    power_(0)
{
    checkKeywords
    (
        dict, {"min", "max", "rate", "direction", "velocity"}, strict
    );
    const lattice& cells = grid_.cells();
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label axis = cells.axis(d);
        if (!(box_.min()[axis] < box_.max()[axis]))
        {
            FatalIOErrorInFunction(dict)
                << "keywords min and max are " << box_.min() << " and "
                << box_.max() << '.' << nl << "    Allowed: min < max"
                << exit(FatalIOError);
        }
    }
    readDirection(dict);
    place();
    if (returnReduce(nodes_.empty(), andOp<bool>()))
    {
        FatalIOErrorInFunction(dict)
            << "the box from " << box_.min() << " to " << box_.max()
            << " has no node of the grid in it." << nl
            << "    Allowed: a box in the mesh" << exit(FatalIOError);
    }
}


Foam::PtrList<Foam::mpm::relaxationZone> Foam::mpm::relaxationZone::NewAll
(
    const dictionary& dict,
    materialPointCloud& cloud,
    const bool strict
)
{
    PtrList<relaxationZone> zones;
    for (const Foam::entry& e : subDictOrEmpty(dict, "relaxationZones"))
    {
        if (!e.isDict())
        {
            FatalIOErrorInFunction(dict)
                << "keyword " << e.keyword() << " of relaxationZones is no"
                << " dictionary." << nl
                << "    Allowed: a dictionary for each zone"
                << exit(FatalIOError);
        }
        zones.append(new relaxationZone(e.dict(), cloud, strict));
    }
    return zones;
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::relaxationZone::~relaxationZone()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::relaxationZone::place()
{
    const lattice& cells = grid_.cells();
    nodes_.clear();
    for (label i = 0; i < grid_.nBoxNodes(); ++i)
    {
        // Nodes beyond cyclic ends move as those that they repeat
        point x(grid_.nodePosition(i));
        for (label d = 0; d < cells.nDim(); ++d)
        {
            if (!cells.periodic(d)) continue;
            const label axis = cells.axis(d);
            const scalar length = cells.nCells(d)*cells.spacing(d);
            const scalar way = x[axis] - cells.origin(d);
            x[axis] -= length*std::floor(way/length + SMALL);
        }
        const scalar rate = rateAt(x);
        if (rate > 0) nodes_.push_back({i, rate});
    }
}


void Foam::mpm::relaxationZone::apply(const scalar deltaT)
{
    const lattice& cells = grid_.cells();
    const label nDim = cells.nDim();
    nodeVector target{};
    if (velocity_.valid())
    {
        // In the middle of the step
        const vector v
        (
            velocity_->value(cloud_.time().value() - 0.5*deltaT)
        );
        for (label d = 0; d < nDim; ++d) target[d] = v[cells.axis(d)];
    }

    nodalFields& nodes = cloud_.nodes();
    scalar before = 0, after = 0;
    for (const entry& e : nodes_)
    {
        const scalar m = grid_.share(e.node)*nodes.mass(e.node);
        if (!(m > 0)) continue;
        const scalar part = e.rate*deltaT/(1 + e.rate*deltaT);
        for (label d = 0; d < nDim; ++d)
        {
            scalar& v = nodes.velocity[e.node][d];
            before += 0.5*m*sqr(v);
            v += part*(target[d] - v);
            after += 0.5*m*sqr(v);
        }
    }
    power_ = (before - after)/deltaT;

    // Walls stay walls where the velocity leads through them
    if (velocity_.valid()) cloud_.boundary().constrain(nodes.velocity);
}


Foam::scalar Foam::mpm::relaxationZone::power() const
{
    return returnReduce(power_, sumOp<scalar>());
}

// ************************************************************************* //
