/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "gaugeWeights.H"
#include "PstreamReduceOps.H"
#include "bitSet.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using Foam::scalar;

//- Quadratic B-spline
scalar spline(const scalar s)
{
    const scalar d = Foam::mag(s);
    return
        d < 0.5 ? 0.75 - d*d
      : d < 1.5 ? 0.5*Foam::sqr(1.5 - d)
      : 0;
}


//- Its integral from minus infinity to s
scalar splineIntegral(const scalar s)
{
    const scalar d = Foam::mag(s);
    const scalar half =
        d < 0.5 ? d*(0.75 - d*d/3)
      : d < 1.5 ? 0.5 - Foam::pow3(1.5 - d)/6
      : 0.5;
    return 0.5 + (s < 0 ? -half : half);
}


//- Call op(sign, shift) for each image sign*xi + shift of a place in the row.
//  Two reflections do for a row that is at least one cell long.
template<class Op>
void forImages(const scalar lower, const scalar upper, const Op& op)
{
    const bool below = lower > -Foam::GREAT;
    const bool above = upper < Foam::GREAT;

    op(1, 0);
    if (below) op(-1, 2*lower);
    if (above) op(-1, 2*upper);
    if (below && above)
    {
        op(1, 2*(upper - lower));
        op(1, 2*(lower - upper));
    }
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::mpm::gaugeWeights::nRows() const
{
    return grid_.cells().nCells(vertical_);
}


bool Foam::mpm::gaugeWeights::ownCell(index3 i) const
{
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        const label n = grid_.cells().nCells(d);
        if (grid_.cells().periodic(d)) i[d] = ((i[d] % n) + n) % n;
        i[d] -= grid_.lower(d);
        if (i[d] < 0 || i[d] >= grid_.nNodes(d)) return false;
    }
    return grid_.ownCell(grid_.index(i));
}


Foam::label Foam::mpm::gaugeWeights::columnIndex(label c0, label c1) const
{
    label index = 0;
    const label c[2] = {c0, c1};
    for (label k = nHorizontal_ - 1; k >= 0; --k)
    {
        const label d = horizontal_[k];
        const label n = grid_.cells().nCells(d);
        label i = c[k];
        if (grid_.cells().periodic(d)) i = ((i % n) + n) % n;
        if (i < 0 || i >= n) return -1;
        index = index*n + i;
    }
    return index;
}


void Foam::mpm::gaugeWeights::findSpans()
{
    const label width = 2*reach + 1;
    const label patch = nHorizontal_ == 2 ? width*width : width;
    const label reach1 = nHorizontal_ == 2 ? reach : 0;

    auto offsetIndex = [&](const label o0, const label o1)
    {
        return (o0 + reach) + width*(o1 + reach1);
    };

    // Cells around each gauge in each row, on any rank
    labelList present(gauges_.size()*nRows()*patch, label(0));
    label span = 0;
    for (const gauge& g : gauges_)
    {
        for (label row = 0; row < nRows(); ++row, ++span)
        {
            for (label o1 = -reach1; o1 <= reach1; ++o1)
            for (label o0 = -reach; o0 <= reach; ++o0)
            {
                index3 i;
                i = 0;
                i[vertical_] = row;
                i[horizontal_[0]] = g.column[0] + o0;
                if (nHorizontal_ == 2) i[horizontal_[1]] = g.column[1] + o1;
                present[span*patch + offsetIndex(o0, o1)] = ownCell(i);
            }
        }
    }
    Pstream::listCombineGather(present, plusEqOp<label>());
    Pstream::listCombineScatter(present);

    spans_.setSize(gauges_.size()*nRows());
    forAll(spans_, s)
    {
        const gauge& g = gauges_[s/nRows()];
        rowSpan& r = spans_[s];
        const label* cell = present.cdata() + s*patch;

        for (label k = 0; k < nHorizontal_; ++k)
        {
            auto solid = [&](const label o)
            {
                return !cell[k == 0 ? offsetIndex(o, 0) : offsetIndex(0, o)];
            };
            const label i = g.column[k];
            r.lower[k] = solid(-1) ? i : solid(-2) ? i - 1 : -GREAT;
            r.upper[k] = solid(1) ? i + 1 : solid(2) ? i + 2 : GREAT;
        }

        scalar covered = 0;
        for (label o1 = -reach1; o1 <= reach1; ++o1)
        for (label o0 = -reach; o0 <= reach; ++o0)
        {
            if (!cell[offsetIndex(o0, o1)]) continue;

            const label o[2] = {o0, o1};
            scalar part = 1;
            for (label k = 0; k < nHorizontal_; ++k)
            {
                const scalar a = g.column[k] + o[k];
                part *= mirroredIntegral
                (
                    a, a + 1, g.at[k], r.lower[k], r.upper[k]
                );
            }
            covered += part;
        }
        r.factor = cell[offsetIndex(0, 0)] ? 1/covered : 0;
    }
}


void Foam::mpm::gaugeWeights::findNear()
{
    label n = 1;
    for (label k = 0; k < nHorizontal_; ++k)
    {
        n *= grid_.cells().nCells(horizontal_[k]);
    }
    List<DynamicList<label>> near(n);

    const label reach1 = nHorizontal_ == 2 ? reach : 0;
    forAll(gauges_, g)
    {
        for (label o1 = -reach1; o1 <= reach1; ++o1)
        for (label o0 = -reach; o0 <= reach; ++o0)
        {
            const label column = columnIndex
            (
                gauges_[g].column[0] + o0, gauges_[g].column[1] + o1
            );
            // Few cyclic columns may be met twice
            if (column >= 0 && !near[column].found(g)) near[column].append(g);
        }
    }

    near_.setSize(n);
    forAll(near, i) near_[i] = near[i];
}


Foam::scalar Foam::mpm::gaugeWeights::mirroredWeight
(
    const scalar xi,
    const scalar x,
    const scalar lower,
    const scalar upper
)
{
    if (xi < lower || xi > upper) return 0;

    scalar w = 0;
    forImages
    (
        lower, upper,
        [&](const label sign, const scalar shift)
        {
            w += spline(sign*xi + shift - x);
        }
    );
    return w;
}


Foam::scalar Foam::mpm::gaugeWeights::mirroredIntegral
(
    const scalar a,
    const scalar b,
    const scalar x,
    const scalar lower,
    const scalar upper
)
{
    if (b <= lower || a >= upper) return 0;

    scalar sum = 0;
    forImages
    (
        lower, upper,
        [&](const label sign, const scalar shift)
        {
            sum += sign
               *(
                    splineIntegral(sign*b + shift - x)
                  - splineIntegral(sign*a + shift - x)
                );
        }
    );
    return sum;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::gaugeWeights::gaugeWeights
(
    const backgroundGrid& grid,
    const label vertical,
    const UList<point>& locations
)
:
    grid_(grid),
    vertical_(vertical),
    nHorizontal_(0),
    horizontal_{0, 0},
    gauges_(locations.size())
{
    for (label d = 0; d < grid.nDim(); ++d)
    {
        if (d != vertical) horizontal_[nHorizontal_++] = d;
    }

    const lattice& cells = grid.cells();
    forAll(gauges_, g)
    {
        gauges_[g] = gauge{{0, 0}, {0, 0}};
        for (label k = 0; k < nHorizontal_; ++k)
        {
            const label d = horizontal_[k];
            const scalar xi =
                (locations[g][cells.axis(d)] - cells.origin(d))
               /cells.spacing(d);

            // The end of the domain belongs to the last cell
            gauges_[g].at[k] = xi;
            gauges_[g].column[k] =
                mag(xi - cells.nCells(d)) < 1e-6
              ? cells.nCells(d) - 1
              : label(std::floor(xi + 1e-6));
        }
    }
    findSpans();
    findNear();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::boolList Foam::mpm::gaugeWeights::inDomain() const
{
    boolList inside(gauges_.size(), false);
    forAll(spans_, s)
    {
        inside[s/nRows()] = inside[s/nRows()] || spans_[s].factor > 0;
    }
    return inside;
}


Foam::label Foam::mpm::gaugeWeights::nColumns() const
{
    labelList present(near_.size(), label(0));
    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const index3& i = grid_.cells().cellIndex(celli);
        present[columnIndex(i[horizontal_[0]], i[horizontal_[1]])] = 1;
    }
    Pstream::listCombineGather(present, maxEqOp<label>());
    Pstream::listCombineScatter(present);
    return sum(present);
}


Foam::scalar Foam::mpm::gaugeWeights::columnArea() const
{
    return grid_.cells().cellVolume()/grid_.cells().spacing(vertical_);
}


void Foam::mpm::gaugeWeights::add
(
    const FixedList<scalar, 3>& x,
    const label cell,
    const scalar volume,
    UList<scalar>& height
) const
{
    const lattice& cells = grid_.cells();
    index3 i = grid_.coordinate(cell);
    for (label d = 0; d < grid_.nDim(); ++d) i[d] += grid_.lower(d);

    const labelList& gauges =
        near_[columnIndex(i[horizontal_[0]], i[horizontal_[1]])];

    for (const label g : gauges)
    {
        const rowSpan& r = spans_[g*nRows() + i[vertical_]];
        scalar w = r.factor;

        for (label k = 0; k < nHorizontal_; ++k)
        {
            const label d = horizontal_[k];
            const label n = cells.nCells(d);
            const label images = cells.periodic(d) ? reach : 0;
            const scalar xi = (x[d] - cells.origin(d))/cells.spacing(d);

            scalar wk = 0;
            for (label m = -images; m <= images; ++m)
            {
                wk += mirroredWeight
                (
                    xi + m*n, gauges_[g].at[k], r.lower[k], r.upper[k]
                );
            }
            w *= wk;
        }
        height[g] += w*volume/columnArea();
    }
}

// ************************************************************************* //
