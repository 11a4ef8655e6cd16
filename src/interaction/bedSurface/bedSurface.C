/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bedSurface.H"
#include "backgroundGrid.H"
#include "nodeBoundary.H"
#include "couplingFields.H"
#include "PstreamReduceOps.H"
#include "nodalFields.H"
#include <cmath>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::bedSurface::zero(nodeField<nodeVector>& field) const
{
    nodes_.forTouched([&](const label i) { field[i] = nodeVector{}; });
}


void Foam::mpm::bedSurface::smooth(nodeField<nodeVector>& field)
{
    // What does not take part reflects, so that nothing is lost
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        const label stride = grid_.stride(d);
        zero(work_);
        nodes_.forInner
        (
            [&](const label i)
            {
                if (!(perCopy_[i] > 0)) return;
                nodeVector mean = field[i];
                for (const label j : {i - stride, i + stride})
                {
                    if (perCopy_[j] > 0) mean += 0.25*(field[j] - field[i]);
                }
                work_[i] = mean;
            }
        );
        field.swap(work_);
        nodes_.share(field, perCopy_);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bedSurface::bedSurface
(
    const backgroundGrid& grid,
    const couplingFields& fields,
    const nodeBoundary& boundary,
    const stressForm form
)
:
    grid_(grid),
    fields_(fields),
    inverseVolume_(boundary.inverseVolume()),
    form_(form),
    nodes_(grid),
    force_(grid.nNodes(), nodeVector{}),
    area_(grid.nNodes(), nodeVector{}),
    weight_(grid.nNodes(), 0),
    perCopy_(grid.nNodes(), 0),
    push_(grid.nNodes(), nodeVector{}),
    flow_(grid.nNodes(), nodeVector{}),
    work_(grid.nNodes(), nodeVector{}),
    meanStress_(0)
{
    if (form_ == wallLaw)
    {
        perKnown_.assign(grid.nNodes(), 1);
        nodes_.countCopies(perKnown_);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::bedSurface::update
(
    const scalar bedFraction,
    const scalar density,
    const std::function<scalar(const label)>& solidFraction,
    const std::function<bool(const label)>& wet,
    const nodalFields& soil,
    const nodalFields& water,
    const std::function
    <
        void(const setForces&)
    >& forces
)
{
    const label dim = grid_.nDim();
    const lattice& cells = grid_.cells();

    // Of a node whose cells are all there
    const scalar whole = (1 + 1e-6)/cells.cellVolume();
    const scalar volume = cells.cellVolume();
    const scalar h = cells.minSpacing();

    // What was, and what is
    zero(force_);
    zero(area_);
    zero(push_);
    zero(flow_);
    zero(work_);
    nodes_.forTouched([&](const label i) { perCopy_[i] = 0; });
    nodes_.setRanges(fields_.ranges);

    // Nodes with water that have soil, or a neighbour with soil
    nodes_.forInner
    (
        [&](const label i)
        {
            if (!wet(i) || !(inverseVolume_[i] > 0 && inverseVolume_[i] < whole))
            {
                return;
            }
            bool beside = solidFraction(i) > 0;
            nodeVector area{};
            scalar slopeSqr = 0;
            for (label d = 0; d < dim; ++d)
            {
                const label s = grid_.stride(d);
                const scalar below = solidFraction(i - s);
                const scalar above = solidFraction(i + s);
                beside = beside || below > 0 || above > 0;
                const scalar slope =
                    (below - above)/(2*cells.spacing(d)*bedFraction);
                slopeSqr += sqr(slope);
                area[d] = volume*slope;
            }
            if (!beside) return;

            perCopy_[i] = 1;
            area_[i] = area;
            const scalar phi = solidFraction(i)/bedFraction;
            weight_[i] =
                min(max(2*(1 - phi), scalar(0)), scalar(1))
               *min(4*h*std::sqrt(slopeSqr), scalar(1));
            force_[i][3] = weight_[i]*solidFraction(i)*volume;
            if (form_ == wallLaw) return;

            // Water over the bed, relative to the soil beside it
            scalar near = phi;
            nodeVector grains = soil.momentum[i];
            for (label d = 0; d < dim; ++d)
            {
                for (const label s : {-grid_.stride(d), grid_.stride(d)})
                {
                    near = max(near, solidFraction(i + s)/bedFraction);
                    grains += soil.momentum[i + s];
                }
            }
            const scalar part =
                min(2*near, scalar(1))*max(1 - phi, scalar(0))
               *water.mass(i);
            for (label d = 0; d < dim; ++d)
            {
                const scalar grain = grains[d]/max(grains[dim], VSMALL);
                flow_[i][d] = part*(water.velocity[i][d] - grain);
            }
            flow_[i][3] = part;
        }
    );
    forces
    (
        [&](const label i, const nodeVector& drag, const nodeVector& push)
        {
            if (!(perCopy_[i] > 0)) return;
            if (form_ == wallLaw)
            {
                // Of the part of the surface where the law knows the stress
                scalar areaSqr = 0;
                for (label d = 0; d < dim; ++d) areaSqr += sqr(area_[i][d]);
                const scalar area = std::sqrt(areaSqr);
                for (label d = 0; d < dim; ++d) force_[i][d] = area*drag[d];
                area_[i][3] = area;
                return;
            }
            for (label d = 0; d < dim; ++d) force_[i][d] = drag[d];
            area_[i][3] = drag[3];
            push_[i] = push;
        }
    );
    if (!nodes_.alone())
    {
        grid_.exchange().sum(perCopy_);
        for (const label i : nodes_.shared())
        {
            perCopy_[i] = perCopy_[i] > 0 ? 1/perCopy_[i] : 0;
        }
    }
    std::vector<nodeField<nodeVector>*> averaged({&force_, &area_});
    if (form_ == drag)
    {
        averaged.push_back(&push_);
        averaged.push_back(&flow_);
    }
    for (nodeField<nodeVector>* field : averaged)
    {
        nodes_.share(*field, perCopy_);
    }
    const label n = form_ == drag ? nPasses : nPassesOfLaw;
    for (label pass = 0; pass < n; ++pass)
    {
        for (nodeField<nodeVector>* field : averaged) smooth(*field);
    }

    if (form_ == drag) shareOutDrag(density);
    else findLocalStress();
}


Foam::scalar Foam::mpm::bedSurface::areaOf(const label node) const
{
    scalar areaSqr = 0;
    for (label d = 0; d < grid_.nDim(); ++d) areaSqr += sqr(area_[node][d]);
    const scalar area = std::sqrt(areaSqr);
    const lattice& cells = grid_.cells();
    return
        area < leastArea*cells.cellVolume()/cells.minSpacing() ? 0 : area;
}


bool Foam::mpm::bedSurface::readSurface
(
    const label node,
    scalar& area,
    scalar& thickness,
    nodeVector& normal
)
{
    if (!(perCopy_[node] > 0)) return false;
    area = areaOf(node);
    if (!(area > 0))
    {
        area_[node] = force_[node] = nodeVector{};
        return false;
    }
    thickness = force_[node][3]/area;
    normal = area_[node]*(1/area);
    for (label d = grid_.nDim(); d < 4; ++d) normal[d] = 0;
    return true;
}


void Foam::mpm::bedSurface::setNormal
(
    const label node,
    const nodeVector& normal,
    const scalar thickness
)
{
    area_[node] = normal;
    area_[node][grid_.nDim()] = thickness > 0 ? weight_[node]/thickness : 0;
}


void Foam::mpm::bedSurface::findLocalStress()
{
    const label dim = grid_.nDim();
    scalarField sums(1 + dim, Zero);
    nodes_.forInner
    (
        [&](const label i)
        {
            scalar area, thickness;
            nodeVector normal;
            if (!readSurface(i, area, thickness, normal)) return;
            const scalar known = area_[i][3];

            nodeVector stress{};
            if (known > 0)
            {
                stress = force_[i]*(1/known);
                scalar into = 0;
                for (label d = 0; d < dim; ++d) into += stress[d]*normal[d];
                stress -= into*normal;
                for (label d = dim; d < 4; ++d) stress[d] = 0;
            }
            const scalar part = perCopy_[i]*area;
            sums[0] += part;
            for (label d = 0; d < dim; ++d) sums[1 + d] += part*stress[d];

            force_[i] = stress;
            setNormal(i, normal, thickness);
        }
    );
    reduce(sums, sumOp<scalarField>());
    scalar sumSqr = 0;
    for (label d = 0; d < dim; ++d) sumSqr += sqr(sums[1 + d]);
    meanStress_ = sums[0] > 0 ? std::sqrt(sumSqr)/sums[0] : 0;

    nodes_.share(force_, perKnown_);
    nodes_.share(area_, perKnown_);
    goOnBehindWalls();
}


void Foam::mpm::bedSurface::goOnBehindWalls()
{
    const label dim = grid_.nDim();
    const scalar whole = (1 + 1e-6)/grid_.cells().cellVolume();

    // From the wall, and from there a row behind it
    for (label row = 0; row < 2; ++row)
    {
        zero(work_);
        zero(push_);
        nodes_.forInner
        (
            [&](const label i)
            {
                const bool inside =
                    inverseVolume_[i] > 0 && inverseVolume_[i] < whole;
                scalar size = 0;
                for (label d = 0; d < dim; ++d) size += sqr(area_[i][d]);
                if (inside || size > 0) return;

                label n = 0;
                for (label d = 0; d < dim; ++d)
                {
                    for (const label s : {-grid_.stride(d), grid_.stride(d)})
                    {
                        const nodeVector& normal = area_[i + s];
                        scalar there = 0;
                        for (label e = 0; e < dim; ++e) there += sqr(normal[e]);
                        if (!(there > 0)) continue;
                        work_[i] += force_[i + s];
                        push_[i] += normal;
                        ++n;
                    }
                }
                if (!n) return;
                work_[i] *= scalar(1)/n;
                push_[i] *= scalar(1)/n;
            }
        );
        nodes_.share(work_, perKnown_);
        nodes_.share(push_, perKnown_);
        nodes_.forTouched
        (
            [&](const label i)
            {
                scalar size = 0;
                for (label d = 0; d < dim; ++d) size += sqr(area_[i][d]);
                if (size > 0) return;
                force_[i] = work_[i];
                area_[i] = push_[i];
            }
        );
    }
}


void Foam::mpm::bedSurface::shareOutDrag(const scalar density)
{
    const label dim = grid_.nDim();

    scalar sumArea = 0;
    nodeVector sumForce{};
    scalar sumDrag = 0, sumResistance = 0;
    nodes_.forInner
    (
        [&](const label i)
        {
            scalar area, thickness;
            nodeVector normal;
            if (!readSurface(i, area, thickness, normal)) return;

            // Less what would push the pore water through a bed at rest
            if (push_[i][3] > 0)
            {
                const scalar part = area_[i][3]/push_[i][3];
                for (label d = 0; d < dim; ++d)
                {
                    force_[i][d] -= part*push_[i][d];
                }
            }
            scalar into = 0;
            for (label d = 0; d < dim; ++d) into += force_[i][d]*normal[d];
            nodeVector stress = (force_[i] - into*normal)*(1/area);

            // Along the bed, to the power of the resistance
            nodeVector flow{};
            if (flow_[i][3] > 0) flow = flow_[i]*(1/flow_[i][3]);
            scalar flowInto = 0;
            for (label d = 0; d < dim; ++d) flowInto += flow[d]*normal[d];
            flow -= flowInto*normal;
            scalar flowSqr = 0, along = 0;
            for (label d = 0; d < dim; ++d)
            {
                flowSqr += sqr(flow[d]);
                along += flow[d]*stress[d];
            }
            const scalar speed = std::sqrt(flowSqr);
            const scalar part = perCopy_[i]*area;
            if (speed > 0)
            {
                sumDrag += part*along/speed;
                sumResistance += part*std::pow(speed, exponent);
                flow *= std::pow(speed, exponent - 1);
            }
            for (label d = dim; d < 4; ++d) flow[d] = 0;

            sumArea += part;
            sumForce += part*stress;

            force_[i] = flow;
            setNormal(i, normal, thickness);
        }
    );
    // Together: each reduction waits for all ranks
    scalarField sums(3 + dim);
    sums[0] = sumDrag;
    sums[1] = sumResistance;
    sums[2] = sumArea;
    for (label d = 0; d < dim; ++d) sums[3 + d] = sumForce[d];
    reduce(sums, sumOp<scalarField>());
    sumDrag = sums[0];
    sumResistance = sums[1];
    sumArea = sums[2];
    scalar sumSqr = 0;
    for (label d = 0; d < dim; ++d) sumSqr += sqr(sums[3 + d]);
    meanStress_ = sumArea > 0 ? std::sqrt(sumSqr)/sumArea : 0;

    // Not bounded at each step: what is noise cancels in the points' mean
    const scalar coefficient = sumResistance > 0 ? sumDrag/sumResistance : 0;
    const scalar most = maxFriction*density;
    nodes_.forInner
    (
        [&](const label i)
        {
            scalar sizeSqr = 0;
            for (label d = 0; d < dim; ++d) sizeSqr += sqr(force_[i][d]);
            const scalar stress = mag(coefficient)*std::sqrt(sizeSqr);
            if (!(stress > 0)) return;
            const scalar bound = most*std::pow(sizeSqr, 1/exponent);
            force_[i] *= coefficient*min(scalar(1), bound/stress);
        }
    );
}

// ************************************************************************* //
