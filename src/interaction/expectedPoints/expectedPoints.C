/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "expectedPoints.H"
#include "materialPointCloud.H"
#include "remainingTime.H"
#include "PstreamReduceOps.H"
#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::expectedPoints::findCapacity
(
    const materialPointCloud& cloud,
    const vector& g
)
{
    const backgroundGrid& grid = cloud.grid();
    const lattice& cells = grid.cells();
    const polyMesh& mesh = grid.mesh();
    const scalar weight = mag(g);
    const vector up(weight > 0 ? vector(-g/weight) : vector(Zero));

    scalar most = 1;
    for (const inlet& in : open_.inlets())
    {
        most = max
        (
            most, in.dict().lookupOrDefault<label>("pointsPerDirection", 2)
        );
    }
    const scalar perCell = std::pow(most, scalar(cells.nDim()));
    const scalar present = cloud.globalSize();

    // Full up to the inlets
    const scalar level = open_.top(up);
    scalar nBelow = 0;
    for (const point& centre : mesh.cellCentres())
    {
        if ((centre & up) <= level) ++nBelow;
    }
    reduce(nBelow, sumOp<scalar>());
    capacity_ = max(present, nBelow*perCell);

    // Beside what was there, no more than runs off at critical depth
    // (q^2/g)^(1/3) along the mesh
    if (open_.outlets().empty() || !(weight > 0)) return;
    scalar along = 0, across = 1;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        vector e(Zero);
        e[cells.axis(d)] = 1;
        if (mag(e & up) > 0.5) continue;
        const scalar length = mesh.bounds().span()[cells.axis(d)];
        if (length > along)
        {
            if (along > 0) across = along;
            along = length;
        }
        else
        {
            across = length;
        }
    }
    if (cells.nDim() == 2) across = cells.thickness();

    const scalar volume = cells.cellVolume()/perCell;
    const scalar q = inflow(mesh.time().value())*volume/across;
    capacity_ = min
    (
        capacity_, present + along*across*std::cbrt(sqr(q)/weight)/volume
    );
}


Foam::scalar Foam::mpm::expectedPoints::entering
(
    const scalar from,
    const scalar to
) const
{
    const scalar step = (to - from)/nSteps;
    scalar sum = 0;
    for (label i = 0; i < nSteps; ++i) sum += inflow(from + (i + 0.5)*step);
    return sum*step;
}


Foam::scalar Foam::mpm::expectedPoints::at(const scalar time) const
{
    sample before = noted_[0];
    for (label i = 1; i <= noted_.size(); ++i)
    {
        const sample& next = i < noted_.size() ? noted_[i] : last_;
        if (next.time >= time)
        {
            const scalar length = next.time - before.time;
            return
                length > 0
              ? before.n + (next.n - before.n)*(time - before.time)/length
              : next.n;
        }
        before = next;
    }
    return last_.n;
}


void Foam::mpm::expectedPoints::findKept(scalar& kept, scalar& rate) const
{
    const scalar end = last_.time;
    const scalar half =
        0.5*remainingTime::lastPart*(end - noted_[0].time);
    scalar part[2];
    for (label i = 0; i < 2; ++i)
    {
        const scalar from = end - (2 - i)*half;
        const scalar n = entering(from, from + half);
        // Nothing enters yet: what will, stays
        part[i] = 1;
        if (n > 0)
        {
            const scalar more = (at(from + half) - at(from))/n;
            part[i] = min(max(more, scalar(0)), scalar(1));
        }
    }

    // Each is of the middle of its half
    kept = part[1];
    rate = 0;
    if (part[1] > 0 && part[1] < part[0])
    {
        rate = std::log(part[0]/part[1])/half;
        kept *= std::exp(-0.5*half*rate);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::expectedPoints::expectedPoints
(
    const materialPointCloud& cloud,
    const vector& g
)
:
    open_(*cloud.openBoundaries()),
    capacity_(0),
    last_{0, 0}
{
    const lattice& cells = cloud.grid().cells();
    for (const inlet& in : open_.inlets())
    {
        const scalar n =
            in.dict().lookupOrDefault<label>("pointsPerDirection", 2);
        perMetre_.append
        (
            in.places().size()*n/cells.spacing(in.zone().direction())
        );
    }
    findCapacity(cloud, g);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::expectedPoints::has(const materialPointCloud& cloud)
{
    return cloud.openBoundaries() && !cloud.openBoundaries()->inlets().empty();
}


Foam::scalar Foam::mpm::expectedPoints::inflow(const scalar time) const
{
    scalar sum = 0;
    forAll(perMetre_, i)
    {
        sum += perMetre_[i]*open_.inlets()[i].volumeSpeed(time);
    }
    return sum;
}


void Foam::mpm::expectedPoints::note(const scalar time, const scalar n)
{
    last_ = sample{time, n};
    noted_.append(last_);
}


Foam::scalar Foam::mpm::expectedPoints::mean
(
    const scalar from,
    const scalar to
) const
{
    const scalar step = (to - from)/nSteps;
    if (!(step > 0) || noted_.empty()) return last_.n;

    scalar sum = 0;
    if (from < last_.time)
    {
        for (label i = 0; i < nSteps; ++i) sum += at(from + (i + 0.5)*step);
        return sum/nSteps;
    }

    scalar kept, rate;
    findKept(kept, rate);
    const scalar most = max(capacity_, last_.n);
    scalar n = last_.n;
    for (label i = 0; i < nSteps; ++i)
    {
        const scalar middle = (i + 0.5)*step;
        const scalar more = step*inflow(from + middle)
           *kept*std::exp(-middle*rate);
        sum += min(most, n + 0.5*more);
        n = min(most, n + more);
    }
    return sum/nSteps;
}

// ************************************************************************* //
