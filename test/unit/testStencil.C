/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

// What g++ before version 12 does not know may be in no header of ours
#if defined(__GNUC__) && !defined(__clang__)
#ifdef __x86_64__
#include <immintrin.h>
#endif
#pragma GCC poison __builtin_shufflevector
#endif

#include "figures.H"
#include "stencil.H"
#include "label.H"
#include <array>
#include <cmath>
#include <memory>
#include <random>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- The functions by their definitions, and the weights that make gradients
struct linearDefinition
{
    static scalar N(const scalar d) { return std::max(0.0, 1 - std::abs(d)); }

    //- A point on a node belongs to the cell above it
    static scalar g(const scalar d)
    {
        return d < -1 || d >= 1 ? 0 : d < 0 ? 1 : -1;
    }
};

struct quadraticDefinition
{
    static scalar N(const scalar x)
    {
        const scalar d = std::abs(x);
        return d < 0.5 ? 0.75 - d*d : d < 1.5 ? 0.5*(1.5 - d)*(1.5 - d) : 0;
    }
    static scalar g(const scalar d) { return -4*d*N(d); }
};

struct cubicDefinition
{
    static scalar N(const scalar x)
    {
        const scalar d = std::abs(x);
        return
            d < 1 ? 0.5*d*d*d - d*d + 2.0/3
          : d < 2 ? (2 - d)*(2 - d)*(2 - d)/6
          : 0;
    }
    static scalar g(const scalar d) { return -3*d*N(d); }
};

template<class Shape> struct definitionOf;
template<> struct definitionOf<linear> { typedef linearDefinition type; };
template<> struct definitionOf<quadraticBSpline>
{
    typedef quadraticDefinition type;
};
template<> struct definitionOf<cubicBSpline> { typedef cubicDefinition type; };


//- A batch of points in one tile, what they give, and dense sums over the
//  tile, one node after the other
template<class Shape, int dim>
struct batch
{
    typedef typename definitionOf<Shape>::type definition;

    static constexpr int T = Shape::width;
    static constexpr int size = (dim == 2 ? T*T : T*T*T);

    lanes f[dim];
    pointRecord<dim> given[nLanes];
    nodeVector flux[dim][nLanes];
    nodeVector tile[size];

    explicit batch(std::mt19937& random)
    {
        std::uniform_real_distribution<scalar> fraction(0, 1), any(-1, 1);

        // Also the ends and the middle of the tile
        const scalar lower = Shape::nodeCentred ? -0.5 : 0;
        const std::array<scalar, 5> special
            ({0, 0.5, std::nextafter(0.5, 0), std::nextafter(1.0, 0), 0.25});

        for (int d = 0; d < dim; ++d)
        {
            for (int l = 0; l < nLanes; ++l)
            {
                f[d][l] = lower
                  + (random() % 3 ? fraction(random) : special[random() % 5]);
            }
        }
        auto fill = [&](nodeVector& v)
        {
            for (int c = 0; c < 4; ++c) v[c] = any(random);
        };
        for (pointRecord<dim>& r : given)
        {
            fill(r.value);
            for (nodeVector& v : r.slope) fill(v);
        }
        for (auto& direction : flux) for (nodeVector& v : direction) fill(v);
        for (nodeVector& v : tile) fill(v);
    }

    //- The points in the middle of a block, as production has them
    static constexpr int first = 5;

    std::unique_ptr<stencil<Shape, dim>> weights() const
    {
        auto s = std::make_unique<stencil<Shape, dim>>();
        s->set(first, f);
        return s;
    }

    //- Records of the block: values and slopes, or fluxes
    std::array<pointRecord<dim>, first + nLanes> records
    (
        const bool fluxes = false
    ) const
    {
        std::array<pointRecord<dim>, first + nLanes> r{};
        for (int l = 0; l < nLanes; ++l)
        {
            if (fluxes)
            {
                for (int d = 0; d < dim; ++d)
                {
                    r[first + l].slope[d] = flux[d][l];
                }
            }
            else r[first + l] = given[l];
        }
        return r;
    }

    //- Scatter n points with fluxes, as the kernels do
    void scatterForce(nodalSums<Shape, dim>& sums, const int n) const
    {
        const auto s = weights();
        auto r = records();
        auto fluxes = records(true);
        if constexpr (stencil<Shape, dim>::moments)
        {
            for (int l = first; l < first + n; ++l)
            {
                for (int d = 0; d < dim; ++d)
                {
                    r[l].slope[d] += s->slopeScale*fluxes[l].slope[d];
                }
            }
        }
        else
        {
            s->scatterFlux(sums, first, first + n, fluxes.data());
        }
        s->scatter(sums, first, first + n, r.data());
    }

    //- Interpolate a tile: values and gradients
    void gather
    (
        lanes (&value)[dim + 1],
        lanes (&gradient)[dim + 1][dim]
    ) const
    {
        const auto s = weights();
        std::array<pointRecord<dim>, first + nLanes> r;
        s->gather
            (nodalValues<Shape, dim>(tile), first, first + nLanes, r.data());
        for (int l = 0; l < nLanes; ++l)
        for (int c = 0; c < dim + 1; ++c)
        {
            value[c][l] = r[first + l].value[c];
            for (int d = 0; d < dim; ++d)
            {
                gradient[c][d][l] = s->slopeScale*r[first + l].slope[d][c];
            }
        }
    }

    //- Coordinate of a node of the tile in cells from the origin of the tile
    static scalar x(const int t, const int d)
    {
        int i = t;
        for (int k = 0; k < d; ++k) i /= T;
        return i % T + Shape::start;
    }

    scalar N(const int l, const int t) const
    {
        scalar n = 1;
        for (int d = 0; d < dim; ++d) n *= definition::N(f[d][l] - x(t, d));
        return n;
    }

    scalar gradient(const int l, const int t, const int along) const
    {
        scalar g = 1;
        for (int d = 0; d < dim; ++d)
        {
            const scalar s = f[d][l] - x(t, d);
            g *= d == along ? definition::g(s) : definition::N(s);
        }
        return g;
    }
};


//- Largest difference of two tiles
template<int size>
scalar difference(const nodeVector (&a)[size], const nodeVector (&b)[size])
{
    scalar largest = 0;
    for (int t = 0; t < size; ++t)
    for (int c = 0; c < 4; ++c)
    {
        const scalar d = std::abs(a[t][c] - b[t][c]);
        if (!(d <= largest)) largest = d;
    }
    return largest;
}


//- Call op(name, shape, dimension) for all combinations
template<class Op>
void forAllStencils(const Op& op)
{
    auto both = [&](auto shape)
    {
        typedef decltype(shape) Shape;
        const std::string name(Shape::name);
        op(name + " 2D", shape, std::integral_constant<int, 2>());
        op(name + " 3D", shape, std::integral_constant<int, 3>());
    };
    both(linear());
    both(quadraticBSpline());
    both(cubicBSpline());
}

const int nTrials = 200;

} // End anonymous namespace


TEST_CASE("stencil: scatter against the dense sum")
{
    forAllStencils([](const std::string& name, auto shape, auto d)
    {
        typedef decltype(shape) Shape;
        constexpr int dim = decltype(d)::value;
        std::mt19937 random(1);
        scalar plain = 0, sloped = 0, force = 0;

        for (int trial = 0; trial < nTrials; ++trial)
        {
            batch<Shape, dim> b(random);
            const auto s = b.weights();
            const auto records = b.records();
            const int first = b.first;
            const int n = 1 + trial % nLanes;

            auto dense = [&](const bool withSlope, const bool withFlux)
            {
                batch<Shape, dim> sum(b);
                for (int l = 0; l < n; ++l)
                for (int t = 0; t < b.size; ++t)
                {
                    nodeVector v = b.given[l].value;
                    for (int k = 0; k < dim && withSlope; ++k)
                    {
                        v += (b.x(t, k) - b.f[k][l])*b.given[l].slope[k];
                    }
                    sum.tile[t] += b.N(l, t)*v;
                    for (int k = 0; k < dim && withFlux; ++k)
                    {
                        sum.tile[t] += b.gradient(l, t, k)*b.flux[k][l];
                    }
                }
                return sum;
            };

            batch<Shape, dim> found(b);
            auto finish = [&](const nodalSums<Shape, dim>& sums)
            {
                nodeVector tile[b.size];
                sums.finish(tile);
                for (int t = 0; t < b.size; ++t)
                {
                    found.tile[t] = b.tile[t] + tile[t];
                }
            };
            nodalSums<Shape, dim> plainSums, slopedSums, forceSums;

            s->scatterValues(plainSums, first, first + n, records.data());
            finish(plainSums);
            plain = std::max
                (plain, difference(found.tile, dense(false, false).tile));

            s->scatter(slopedSums, first, first + n, records.data());
            finish(slopedSums);
            sloped = std::max
                (sloped, difference(found.tile, dense(true, false).tile));

            b.scatterForce(forceSums, n);
            finish(forceSums);
            force = std::max
                (force, difference(found.tile, dense(true, true).tile));

            if constexpr (dim == 3)
            {
                lanes scalars;
                for (int l = 0; l < nLanes; ++l)
                {
                    scalars[l] = b.given[l].value[0];
                }
                nodalSums<Shape, 2> rows;
                nodeVector given[b.first + nLanes];
                s->scalarRows(first, scalars, given + first);
                s->scatterScalar(rows, first, first + n, given);
                nodeVector row[Shape::width*Shape::width];
                rows.finish(row);
                for (int t = 0; t < b.size; ++t)
                {
                    scalar sum = row[t/Shape::width][t % Shape::width];
                    for (int l = 0; l < n; ++l)
                    {
                        sum -= b.N(l, t)*b.given[l].value[0];
                    }
                    plain = std::max(plain, std::abs(sum));
                }
            }
        }
        atMost(name + ": values", plain, 1e-14);
        atMost(name + ": values and slopes", sloped, 1e-14);
        atMost(name + ": values, slopes and fluxes", force, 2e-14);
    });
}


TEST_CASE("stencil: gather against the dense sum")
{
    forAllStencils([](const std::string& name, auto shape, auto d)
    {
        typedef decltype(shape) Shape;
        constexpr int dim = decltype(d)::value;
        std::mt19937 random(2);
        scalar values = 0, gradients = 0;

        for (int trial = 0; trial < nTrials; ++trial)
        {
            batch<Shape, dim> b(random);
            lanes value[dim + 1], gradient[dim + 1][dim];
            b.gather(value, gradient);

            for (int l = 0; l < nLanes; ++l)
            for (int c = 0; c < dim + 1; ++c)
            {
                scalar sum = 0;
                for (int t = 0; t < b.size; ++t) sum += b.N(l, t)*b.tile[t][c];
                values = std::max(values, std::abs(value[c][l] - sum));

                for (int k = 0; k < dim; ++k)
                {
                    scalar slope = 0;
                    for (int t = 0; t < b.size; ++t)
                    {
                        slope += b.gradient(l, t, k)*b.tile[t][c];
                    }
                    gradients = std::max
                        (gradients, std::abs(gradient[c][k][l] - slope));
                }
            }
        }
        atMost(name + ": values", values, 1e-14);
        atMost(name + ": gradients", gradients, 2e-14);
    });
}


TEST_CASE("stencil: scatter conserves mass, momentum and its moment")
{
    forAllStencils([](const std::string& name, auto shape, auto d)
    {
        typedef decltype(shape) Shape;
        constexpr int dim = decltype(d)::value;
        std::mt19937 random(3);
        scalar sums = 0, forces = 0, moments = 0, virial = 0;

        for (int trial = 0; trial < nTrials; ++trial)
        {
            batch<Shape, dim> b(random);
            batch<Shape, dim> found(b);
            nodalSums<Shape, dim> sumsOfTile;
            b.weights()->scatter
            (
                sumsOfTile, b.first, b.first + nLanes, b.records().data()
            );
            sumsOfTile.finish(found.tile);

            batch<Shape, dim> force(b);
            nodalSums<Shape, dim> forceNodes;
            b.scatterForce(forceNodes, nLanes);
            forceNodes.finish(force.tile);

            for (int c = 0; c < 4; ++c)
            {
                scalar sum = 0, forceSum = 0;
                for (int l = 0; l < nLanes; ++l)
                {
                    sum -= b.given[l].value[c];
                    forceSum -= b.given[l].value[c];
                }
                for (int t = 0; t < b.size; ++t)
                {
                    sum += found.tile[t][c];
                    forceSum += force.tile[t][c];
                }
                sums = std::max(sums, std::abs(sum));
                forces = std::max(forces, std::abs(forceSum));

                // Sum of x_i of what the nodes get: that of the points and
                // D times the slopes; the fluxes as they are
                for (int k = 0; k < dim; ++k)
                {
                    scalar moment = 0, forceMoment = 0;
                    for (int l = 0; l < nLanes; ++l)
                    {
                        const scalar f = b.f[k][l];
                        const scalar D =
                            Shape::gradientScale > 0
                          ? 1/Shape::gradientScale : f*(1 - f);
                        moment -= f*b.given[l].value[c]
                          + D*b.given[l].slope[k][c];
                        forceMoment -= b.flux[k][l][c];
                    }
                    for (int t = 0; t < b.size; ++t)
                    {
                        moment += b.x(t, k)*found.tile[t][c];
                        forceMoment +=
                            b.x(t, k)*(force.tile[t][c] - found.tile[t][c]);
                    }
                    moments = std::max(moments, std::abs(moment));
                    virial = std::max(virial, std::abs(forceMoment));
                }
            }
        }
        atMost
        (
            name + ": sum over the nodes - sum over the points", sums, 1e-14
        );
        atMost(name + ": the same with fluxes", forces, 5e-14);
        atMost(name + ": first moment", moments, 2e-14);
        atMost(name + ": first moment of the fluxes", virial, 1e-13);
    });
}


TEST_CASE("stencil: gather reproduces linear fields")
{
    forAllStencils([](const std::string& name, auto shape, auto d)
    {
        typedef decltype(shape) Shape;
        constexpr int dim = decltype(d)::value;
        std::mt19937 random(4);
        std::uniform_real_distribution<scalar> any(-1, 1);
        scalar values = 0, gradients = 0;

        for (int trial = 0; trial < nTrials; ++trial)
        {
            batch<Shape, dim> b(random);
            scalar a[dim + 1], A[dim + 1][dim];
            for (int c = 0; c < dim + 1; ++c)
            {
                a[c] = any(random);
                for (int k = 0; k < dim; ++k) A[c][k] = any(random);
            }
            for (int t = 0; t < b.size; ++t)
            for (int c = 0; c < dim + 1; ++c)
            {
                b.tile[t][c] = a[c];
                for (int k = 0; k < dim; ++k) b.tile[t][c] += A[c][k]*b.x(t, k);
            }

            lanes value[dim + 1], gradient[dim + 1][dim];
            b.gather(value, gradient);
            for (int l = 0; l < nLanes; ++l)
            for (int c = 0; c < dim + 1; ++c)
            {
                scalar expected = a[c];
                for (int k = 0; k < dim; ++k)
                {
                    expected += A[c][k]*b.f[k][l];
                    gradients = std::max
                        (gradients, std::abs(gradient[c][k][l] - A[c][k]));
                }
                values = std::max(values, std::abs(value[c][l] - expected));
            }
        }
        atMost(name + ": values", values, 1e-14);
        atMost(name + ": gradients", gradients, 5e-14);
    });
}


TEST_CASE("lanes: records, masks and sums")
{
    const lanes a{1, 2, 3, 4}, b{5, 6, 7, 8};
    const lanes c{9, 10, 11, 12}, e{13, 14, 15, 16};
    nodeVector record[nLanes];
    toRecords(a, b, c, e, record);
    label wrong = 0;
    for (int l = 0; l < nLanes; ++l)
    {
        wrong += record[l][0] != a[l] || record[l][1] != b[l];
        wrong += record[l][2] != c[l] || record[l][3] != e[l];
    }
    equal("wrong records", wrong, 0);

    wrong = 0;
    for (int n = 0; n <= nLanes; ++n)
    {
        scalar stored[nLanes] = {-1, -1, -1, -1};
        storeLanes(stored, a, firstLanes(n));
        for (int l = 0; l < nLanes; ++l)
        {
            wrong += stored[l] != (l < n ? a[l] : -1);
        }
        wrong += laneBits(firstLanes(n)) != (1u << n) - 1;
    }
    equal("wrong masks", wrong, 0);
    atMost("sum", std::abs(sumLanes(a) - 10), 0);
    atMost
    (
        "sum of the smaller",
        std::abs(sumLanes(minLanes(a, allLanes(2.5))) - 8),
        0
    );
    atMost
    (
        "sum of the larger",
        std::abs(sumLanes(maxLanes(a, allLanes(2.5))) - 12),
        0
    );
}

// ************************************************************************* //
