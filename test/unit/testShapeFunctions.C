/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "shapeFunctions.H"
#include <array>
#include <cmath>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- The functions by their textbook definitions
scalar definition(const linear&, const scalar d)
{
    return std::max(0.0, 1 - std::abs(d));
}

scalar definition(const quadraticBSpline&, const scalar x)
{
    const scalar d = std::abs(x);
    return d < 0.5 ? 0.75 - d*d : d < 1.5 ? 0.5*(1.5 - d)*(1.5 - d) : 0;
}

scalar definition(const cubicBSpline&, const scalar x)
{
    const scalar d = std::abs(x);
    return
        d < 1 ? 0.5*d*d*d - d*d + 2.0/3
      : d < 2 ? (2 - d)*(2 - d)*(2 - d)/6
      : 0;
}


//- Weights of all nodes of the tile for a point at the fraction f of the cell
template<class Shape>
struct reachWeights
{
    static constexpr int T = Shape::reachWidth;

    std::array<scalar, T> w{}, q{}, g{}, x{};

    explicit reachWeights(const scalar f)
    {
        const int first = Shape::nodeCentred && f >= 0.5;
        scalar wi[Shape::width], qi[Shape::width], gi[Shape::width];
        Shape::weights(f - first, wi, qi, gi);

        for (int t = 0; t < T; ++t) x[t] = t + Shape::reachStart;
        for (int i = 0; i < Shape::width; ++i)
        {
            w[first + i] = wi[i];
            q[first + i] = qi[i];
            g[first + i] = gi[i];
        }
    }
};


//- Largest absolute value of op(f, weights) over the cell
template<class Shape, class Op>
scalar worst(const Op& op)
{
    const int n = 1000;
    scalar largest = 0;
    for (int i = 0; i < n; ++i)
    {
        const scalar f = scalar(i)/n;
        const scalar value = std::abs(op(f, reachWeights<Shape>(f)));
        if (!(value <= largest)) largest = value;
    }
    return largest;
}


template<class Shape>
void checkShape()
{
    constexpr int T = Shape::reachWidth;
    const std::string name(Shape::name);

    atMost
    (
        name + ": N against its definition",
        worst<Shape>
        (
            [](const scalar f, const reachWeights<Shape>& t)
            {
                scalar e = 0;
                for (int i = 0; i < T; ++i)
                {
                    e = std::max
                    (
                        e, std::abs(t.w[i] - definition(Shape(), t.x[i] - f))
                    );
                }
                return e;
            }
        ),
        1e-15
    );

    atMost
    (
        name + ": weights of the whole tile against those in reach",
        worst<Shape>
        (
            [](const scalar f, const reachWeights<Shape>& t)
            {
                scalar w[T], q[T], g[T];
                Shape::reachWeights(f, w, q, g);
                scalar e = 0;
                for (int i = 0; i < T; ++i)
                {
                    e = std::max(e, std::abs(w[i] - t.w[i]));
                    e = std::max(e, std::abs(q[i] - t.q[i]));
                    e = std::max(e, std::abs(g[i] - t.g[i]));
                }
                return e;
            }
        ),
        2e-15
    );

    atMost
    (
        name + ": sum N - 1",
        worst<Shape>
        (
            [](const scalar, const reachWeights<Shape>& t)
            {
                scalar s = -1;
                for (int i = 0; i < T; ++i) s += t.w[i];
                return s;
            }
        ),
        1e-15
    );

    atMost
    (
        name + ": first moment, sum N d",
        worst<Shape>
        (
            [](const scalar, const reachWeights<Shape>& t)
            {
                scalar s = 0;
                for (int i = 0; i < T; ++i) s += t.q[i];
                return s;
            }
        ),
        1e-15
    );

    atMost
    (
        name + ": q - N d",
        worst<Shape>
        (
            [](const scalar f, const reachWeights<Shape>& t)
            {
                scalar e = 0;
                for (int i = 0; i < T; ++i)
                {
                    e = std::max(e, std::abs(t.q[i] - t.w[i]*(t.x[i] - f)));
                }
                return e;
            }
        ),
        1e-15
    );

    if (Shape::gradientScale > 0)
    {
        atMost
        (
            name + ": sum q d - D, D = 1/gradientScale",
            worst<Shape>
            (
                [](const scalar f, const reachWeights<Shape>& t)
                {
                    scalar s = -1/Shape::gradientScale;
                    for (int i = 0; i < T; ++i) s += t.q[i]*(t.x[i] - f);
                    return s;
                }
            ),
            1e-15
        );
    }

    atMost
    (
        name + ": gradient of the linear field 3 - 2 x",
        worst<Shape>
        (
            [](const scalar, const reachWeights<Shape>& t)
            {
                scalar s = 2;
                for (int i = 0; i < T; ++i) s += t.g[i]*(3 - 2*t.x[i]);
                return s;
            }
        ),
        2e-14
    );

    // Simpson's rule on the two halves, where N is one cubic at most
    scalar error = 0, total = 0;
    for (int i = 0; i < T; ++i)
    {
        scalar integral = 0;
        for (int half = 0; half < 2; ++half)
        {
            const scalar a = 0.5*half;
            integral += 0.5/6
               *(
                    definition(Shape(), a - (i + Shape::reachStart))
                  + 4*definition(Shape(), a + 0.25 - (i + Shape::reachStart))
                  + definition(Shape(), a + 0.5 - (i + Shape::reachStart))
                );
        }
        error = std::max(error, std::abs(integral - Shape::cellIntegral[i]));
        total += Shape::cellIntegral[i];
    }
    atMost(name + ": cellIntegral against quadrature", error, 1e-15);
    atMost(name + ": sum of cellIntegral - 1", std::abs(total - 1), 1e-15);
}


//- Volume of a node at x = 0, over its own, in water with n points per cell
//  that ends at the height top
template<class Shape>
scalar saturationBelow(const scalar top, const label n)
{
    scalar sum = 0;
    for (label j = 0; j < 8*n; ++j)
    {
        sum += definition(Shape(), top - (j + 0.5)/n)/n;
    }
    return sum;
}


//- What a plane surface takes from the volume of the node below it is never
//  more than surfaceDefect says, and about that at its most
template<class Shape>
void checkSurfaceDefect()
{
    const string name(Shape::name);
    scalar beyond = -GREAT, most = 0;
    for (label n = 1; n <= 4; ++n)
    {
        for (label i = 0; i < 3000; ++i)
        {
            const scalar top = 0.001*i;
            const scalar s = saturationBelow<Shape>(top - 1, n);
            if (s <= 0.55) continue;

            const scalar defect = 1 - saturationBelow<Shape>(top, n);
            beyond = std::max(beyond, defect - surfaceDefect<Shape>(s));
            most = std::max(most, defect);
        }
    }
    atMost(name + ": defect beyond surfaceDefect", beyond, 1e-15);
    atMost
    (
        name + ": surfaceDefect at 0.55 over the most that is lacking",
        surfaceDefect<Shape>(0.55), 1.12*most + 1e-15
    );
}

} // End anonymous namespace


TEST_CASE("shape functions: a plane surface")
{
    checkSurfaceDefect<linear>();
    checkSurfaceDefect<quadraticBSpline>();
    checkSurfaceDefect<cubicBSpline>();
}


TEST_CASE("shape functions: linear")
{
    checkShape<linear>();
}


TEST_CASE("shape functions: quadraticBSpline")
{
    checkShape<quadraticBSpline>();
    atMost("D - 1/4", std::abs(1/quadraticBSpline::gradientScale - 0.25), 0);
}


TEST_CASE("shape functions: cubicBSpline")
{
    checkShape<cubicBSpline>();
    atMost("D - 1/3", std::abs(1/cubicBSpline::gradientScale - 1.0/3), 0);
}

// ************************************************************************* //
