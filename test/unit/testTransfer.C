/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "waterScene.H"
#include <algorithm>
#include <cmath>
#include <random>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

typedef std::map<std::string, std::string> typeMap;

const std::vector<std::string> shapes
    ({"linear", "quadraticBSpline", "cubicBSpline"});

//- Linear functions do not go with APIC
std::string transferOf(const std::string& shape)
{
    return shape == "linear" ? "transfer FLIP;" : "transfer APIC;";
}


meshPlan box(const int dim, const int nx, const int ny, const int nz)
{
    meshPlan plan;
    plan.n = Vector<label>(nx, ny, dim == 3 ? nz : 1);
    plan.size = vector(0.1, 0.2, 0.3);
    plan.origin = vector(-0.2, 1, 3);
    plan.empty = dim == 3 ? 3 : 2;

    const meshPlan bare(plan);
    plan.patch = [bare](const point& c, const vector& n)
    {
        return hullSides(bare, c, n);
    };
    return plan;
}

const std::vector<std::string> sides
    ({"left", "right", "bottom", "top", "back", "front"});


//- Column of a declared field
scalar* column(waterScene& s, const word& name, const label component = 0)
{
    pointStorage& points = const_cast<pointStorage&>(s.cloud().points());
    for (const pointStorage::field& f : points.fields())
    {
        if (f.name == name) return points.column(f.first + component);
    }
    FAIL("no field " << name);
    return nullptr;
}


//- Points at random places with random velocities (and gradients)
void fillRandomly(waterScene& s, const bool affine)
{
    std::mt19937 random(5);
    std::uniform_real_distribution<scalar> any(-1, 1);
    const lattice& cells = s.grid().cells();

    s.fill
    (
        2, [&](const point&) { return 1 + 0.3*any(random); },
        [&](const point&)
        {
            vector v(any(random), any(random), any(random));
            if (cells.nDim() == 2) v.z() = 0;
            return v;
        },
        [&](const point&) { return 1000*any(random); },
        [&](const point& x)
        {
            point moved(x);
            for (label d = 0; d < cells.nDim(); ++d)
            {
                moved[cells.axis(d)] += 0.249*any(random)*cells.spacing(d);
            }
            return moved;
        }
    );
    if (affine)
    {
        const label nDim = cells.nDim();
        for (label c = 0; c < nDim*nDim; ++c)
        {
            scalar* C = column(s, "velocityGradient", c);
            for (label p = 0; p < s.cloud().size(); ++p) C[p] = any(random);
        }
    }
    // Sorts, and finds the active nodes
    s.cloud().relocate(0);
}

//- Kinetic energy of the points, with that of their gradients, and of the
//  nodes
scalar energyOfPoints(waterScene& s, const bool affine)
{
    scalar kinetic = 0, potential = 0, elastic = 0;
    s.cloud().energy(vector(Zero), kinetic, potential, elastic);
    return kinetic + (affine ? s.cloud().affineEnergy() : 0);
}

scalar energyOfNodes(waterScene& s)
{
    const nodalFields& nodes = s.cloud().nodes();
    const label dim = s.grid().nDim();
    scalar sum = 0;
    for (label i = 0; i < s.grid().nNodes(); ++i)
    {
        for (label d = 0; d < dim; ++d)
        {
            sum += 0.5*s.grid().share(i)*nodes.momentum[i][dim]
               *sqr(nodes.velocity[i][d]);
        }
    }
    return sum;
}

} // End anonymous namespace


TEST_CASE("transfer: a full domain has a saturation of one")
{
    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string& shape : shapes)
        {
            for (int n = 1; n <= 4; ++n)
            {
                if (dim == 3 && n > 2) continue;
                waterScene s
                (
                    box(dim, 5, 4, 3), vector(Zero), {}, shape,
                    transferOf(shape)
                );
                s.fill(n, [](const point&) { return 1; });
                s.cloud().relocate(0);
                s.cloud().particlesToGrid();
                // Finds the saturation first
                s.cloud().updateStress(0);

                scalar worst = 0;
                label nodes = 0;
                const auto& inverse = s.cloud().boundary().inverseVolume();
                for (label i = 0; i < s.grid().nNodes(); ++i)
                {
                    if (inverse[i] == 0) continue;
                    ++nodes;
                    worst = max
                        (worst, mag(s.cloud().nodes().saturation[i] - 1));
                }
                const std::string name = shape + ' ' + std::to_string(dim)
                  + "D, " + std::to_string(n) + " points per direction: ";
                equal(name + "nodes", nodes, 6*5*(dim == 3 ? 4 : 1));
                atMost(name + "|S - 1|", worst, 1e-13);
            }
        }
    }

    // At a step: sampling of the tails that fold differently there
    meshPlan plan = box(2, 9, 7, 1);
    plan.present = [](int i, int j, int) { return !(i >= 4 && j < 3); };
    waterScene s(plan, vector(Zero));
    s.fill(3, [](const point&) { return 1; });
    s.cloud().relocate(0);
    s.cloud().particlesToGrid();
    // Finds the saturation first
    s.cloud().updateStress(0);
    scalar worst = 0;
    for (label i = 0; i < s.grid().nNodes(); ++i)
    {
        if (s.cloud().boundary().inverseVolume()[i] == 0) continue;
        worst = max(worst, mag(s.cloud().nodes().saturation[i] - 1));
    }
    atMost("step: |S - 1|", worst, 1e-3);
}


TEST_CASE("transfer: mass and momentum in a cyclic box")
{
    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string& shape : shapes)
        {
            meshPlan plan = box(dim, 5, 3, 4);
            for (const std::string& side : sides) plan.type[side] = "cyclic";
            waterScene s(plan, vector(Zero), {}, shape, transferOf(shape));
            fillRandomly(s, shape != "linear");
            s.cloud().particlesToGrid();

            scalar mass = 0, massSum = 0;
            vector momentum(Zero), momentumSum(Zero);
            for (label p = 0; p < s.cloud().size(); ++p)
            {
                mass += s.cloud().mass()[p];
                for (label d = 0; d < dim; ++d)
                {
                    momentum[d] += s.cloud().mass()[p]*s.cloud().v(d)[p];
                }
            }
            for (label i = 0; i < s.grid().nNodes(); ++i)
            {
                const index3 c = s.grid().coordinate(i);
                bool counts = true;
                for (label d = 0; d < dim; ++d)
                {
                    const label g = c[d] + s.grid().lower(d);
                    counts = counts
                     && g >= 0 && g < s.grid().cells().nCells(d);
                }
                if (!counts) continue;

                const nodeVector& node = s.cloud().nodes().momentum[i];
                massSum += node[dim];
                for (label d = 0; d < dim; ++d) momentumSum[d] += node[d];
            }
            const std::string name = shape + ' ' + std::to_string(dim) + "D: ";
            atMost(name + "mass, relative", mag(massSum/mass - 1), 1e-14);
            atMost
            (
                name + "momentum, over mass times 1 m/s",
                mag(momentumSum - momentum)/mass, 1e-14
            );
        }
    }
}


TEST_CASE("transfer: walls mirror the points")
{
    // Nodes get what the points and their mirror images behind all walls
    // give; those on a wall half of it. Normal components on the wall itself
    // are left to constrain().
    typedef std::pair<std::string, std::string> wallType;
    for (const wallType& type : {wallType("slip", ""), wallType("noSlip", "")})
    {
        const bool slip = type.first == "slip";
        meshPlan plan = box(2, 5, 4, 1);
        typeMap types;
        for (const std::string& side : sides) types[side] = type.first;
        waterScene s
        (
            plan, vector(Zero), types, "quadraticBSpline", "transfer FLIP;"
        );
        fillRandomly(s, false);
        s.cloud().particlesToGrid();

        auto N = [](const scalar x)
        {
            const scalar d = mag(x);
            return d < 0.5 ? 0.75 - d*d : d < 1.5 ? 0.5*sqr(1.5 - d) : 0;
        };
        const label n[2] = {5, 4};
        scalar massError = 0, momentumError = 0, scale = 0;

        for (label i = 0; i <= n[0]; ++i)
        for (label j = 0; j <= n[1]; ++j)
        {
            const label at[2] = {i, j};
            scalar mass = 0, momentum[2] = {0, 0};

            for (label p = 0; p < s.cloud().size(); ++p)
            {
                scalar xi[2];
                for (label d = 0; d < 2; ++d)
                {
                    xi[d] =
                        (s.cloud().x(d)[p] - s.grid().cells().origin(d))
                       /s.grid().cells().spacing(d);
                }
                // None, behind the lower, behind the upper wall
                for (int a = 0; a < 3; ++a)
                for (int b = 0; b < 3; ++b)
                {
                    const int image[2] = {a, b};
                    scalar w = s.cloud().mass()[p];
                    scalar sign[2] = {1, 1};
                    for (label d = 0; d < 2; ++d)
                    {
                        const scalar x =
                            image[d] == 0 ? xi[d]
                          : image[d] == 1 ? -xi[d] : 2*n[d] - xi[d];
                        w *= N(x - at[d]);
                        if (!image[d]) continue;
                        for (label c = 0; c < 2; ++c)
                        {
                            if (c == d || !slip) sign[c] *= -1;
                        }
                    }
                    mass += w;
                    for (label c = 0; c < 2; ++c)
                    {
                        momentum[c] += w*sign[c]*s.cloud().v(c)[p];
                    }
                }
            }

            bool onWall[2];
            for (label d = 0; d < 2; ++d)
            {
                onWall[d] = at[d] == 0 || at[d] == n[d];
                if (onWall[d]) mass *= 0.5;
                for (label c = 0; c < 2; ++c)
                {
                    if (onWall[d]) momentum[c] *= 0.5;
                }
            }
            index3 node;
            node = 0;
            for (label d = 0; d < 2; ++d) node[d] = at[d] - s.grid().lower(d);
            const nodeVector& found =
                s.cloud().nodes().momentum[s.grid().index(node)];

            scale = max(scale, mass);
            massError = max(massError, mag(found[2] - mass));
            for (label c = 0; c < 2; ++c)
            {
                const bool given = slip ? onWall[c] : onWall[0] || onWall[1];
                if (!given)
                {
                    momentumError =
                        max(momentumError, mag(found[c] - momentum[c]));
                }
            }
        }
        atMost(type.first + ": mass, relative", massError/scale, 1e-14);
        atMost(type.first + ": momentum, relative", momentumError/scale, 1e-14);
    }
}


TEST_CASE("transfer: uniform pressure in a full vessel moves nothing")
{
    // Largest acceleration, over p/(rho h)
    auto acceleration = []
    (
        const meshPlan& plan, const std::string& shape, const int n,
        const std::string& wall
    )
    {
        typeMap types({{"walls", wall}});
        for (const std::string& side : sides) types[side] = wall;
        waterScene s(plan, vector(Zero), types, shape, "transfer FLIP;");
        const scalar p = 1000;
        s.fill
        (
            n, [](const point&) { return 1; },
            [](const point&) { return vector(Zero); },
            [&](const point&) { return p; }
        );
        s.cloud().relocate(0);
        const scalar deltaT = 1e-6;
        s.cloud().particlesToGrid();
        s.cloud().updateStress(deltaT);
        s.cloud().updateNodes(deltaT);

        scalar worst = 0;
        for (label i = 0; i < s.grid().nNodes(); ++i)
        {
            if (s.cloud().boundary().inverseVolume()[i] == 0) continue;
            for (label d = 0; d < s.grid().nDim(); ++d)
            {
                worst = max
                    (worst, mag(s.cloud().nodes().velocity[i][d]/deltaT));
            }
        }
        return worst*1000*s.grid().cells().minSpacing()/p;
    };

    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string& shape : shapes)
        {
            for (const std::string wall : {"slip", "noSlip"})
            {
                atMost
                (
                    shape + ' ' + std::to_string(dim) + "D, " + wall,
                    acceleration(box(dim, 5, 4, 3), shape, 2, wall), 1e-12
                );
            }
        }
    }

    meshPlan plan = box(2, 9, 7, 1);
    plan.size = vector(0.1, 0.1, 0.1);
    plan.present = [](int i, int j, int) { return !(i >= 4 && j < 3); };

    // At its convex corner, nodes one cell away would each need the same
    // ghost node, once mirrored and once as it is: a residue is left
    const std::map<std::string, scalar> residue
    ({
        {"linear", 1e-12}, {"quadraticBSpline", 2e-3}, {"cubicBSpline", 7e-3}
    });
    for (const std::string& shape : shapes)
    {
        for (int n = 2; n <= 4; ++n)
        {
            atMost
            (
                "step: " + shape + ", " + std::to_string(n)
              + " points per direction",
                acceleration(plan, shape, n, "slip"), residue.at(shape)
            );
        }
    }
}


TEST_CASE("transfer: affine points give the grid their linear field")
{
    // v = a + A x at the points and as their gradient: at every node as well
    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string shape : {"quadraticBSpline", "cubicBSpline"})
        {
            typeMap open;
            for (const std::string& side : sides) open[side] = "zeroGradient";
            waterScene s(box(dim, 5, 4, 3), vector(Zero), open, shape);
            fillRandomly(s, true);

            const scalar A[3][3] = {{1, -2, 3}, {0.5, -0.3, 2}, {-1, 4, 0.7}};
            auto field = [&](const scalar* x, const label c)
            {
                scalar v = 0.1*(c + 1);
                for (label d = 0; d < dim; ++d) v += A[c][d]*x[d];
                return v;
            };
            for (label p = 0; p < s.cloud().size(); ++p)
            {
                scalar x[3];
                for (label d = 0; d < dim; ++d) x[d] = s.cloud().x(d)[p];
                for (label c = 0; c < dim; ++c)
                {
                    column(s, "U", c)[p] = field(x, c);
                    for (label d = 0; d < dim; ++d)
                    {
                        column(s, "velocityGradient", c*dim + d)[p] = A[c][d];
                    }
                }
            }
            s.cloud().particlesToGrid();

            // An affine motion loses nothing, with the energy of gradients
            const scalar ofNodes = energyOfNodes(s);
            atMost
            (
                shape + ' ' + std::to_string(dim) + "D: energy of points and"
                " nodes, relative difference",
                mag(energyOfPoints(s, true)/ofNodes - 1), 1e-12
            );
            atLeast
            (
                "of it gradients",
                1 - energyOfPoints(s, false)/ofNodes, 1e-3
            );

            scalar worst = 0;
            label nodes = 0;
            for (label i = 0; i < s.grid().nNodes(); ++i)
            {
                // Nodes that the points all but miss are rounding
                const scalar m = s.cloud().nodes().momentum[i][dim];
                if (m < 1e-4*s.cloud().mass()[0]) continue;
                ++nodes;
                const point x = s.grid().nodePosition(i);
                const scalar at[3] = {x.x(), x.y(), x.z()};
                for (label c = 0; c < dim; ++c)
                {
                    worst = max
                    (
                        worst,
                        mag(s.cloud().nodes().velocity[i][c] - field(at, c))
                    );
                }
            }
            const std::string name = shape + ' ' + std::to_string(dim) + "D: ";
            atLeast(name + "nodes", nodes, dim == 2 ? 30 : 120);
            atMost(name + "nodal velocity - (a + A x)", worst, 1e-11);
        }
    }
}


TEST_CASE("transfer: APIC only loses energy, in both directions")
{
    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string shape : {"quadraticBSpline", "cubicBSpline"})
        {
            for (const std::string wall : {"slip", "noSlip"})
            {
                typeMap type;
                for (const std::string& side : sides) type[side] = wall;
                waterScene s
                (
                    box(dim, 5, 4, 3), vector(Zero), type, shape,
                    "transfer APIC; apicRate 1e12;"
                );
                fillRandomly(s, true);
                const scalar start = energyOfPoints(s, true);
                s.cloud().particlesToGrid();
                const scalar nodes = energyOfNodes(s);
                const scalar deltaT = 1e-9;
                s.cloud().updateStress(deltaT);
                s.cloud().gridToParticles(deltaT);
                const scalar end = energyOfPoints(s, true);

                const std::string name =
                    shape + ' ' + std::to_string(dim) + "D, " + wall + ": ";
                atMost(name + "nodes over points", nodes/start, 1);
                atMost(name + "points over nodes", end/nodes, 1);
                atLeast(name + "of it gradients", s.cloud().affineEnergy()/end, 0.01);
            }
        }
    }
}


TEST_CASE("transfer: points take up a linear field of the grid")
{
    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string& shape : shapes)
        {
            typeMap open;
            for (const std::string& side : sides) open[side] = "zeroGradient";
            const bool affine = shape != "linear";
            // A rate that makes APIC plain within any time step
            waterScene s
            (
                box(dim, 5, 4, 3), vector(Zero), open, shape,
                affine ? "transfer APIC; apicRate 1e9;" : "transfer PIC;"
            );
            fillRandomly(s, affine);
            s.cloud().particlesToGrid();

            const scalar A[3][3] = {{1, -2, 3}, {0.5, -0.3, 2}, {-1, 4, 0.7}};
            auto field = [&](const scalar* x, const label c)
            {
                scalar v = 0.1*(c + 1);
                for (label d = 0; d < dim; ++d) v += A[c][d]*x[d];
                return v;
            };
            auto setNodes = [&]()
            {
                for (label i = 0; i < s.grid().nNodes(); ++i)
                {
                    const point x = s.grid().nodePosition(i);
                    const scalar at[3] = {x.x(), x.y(), x.z()};
                    nodeVector v{};
                    for (label c = 0; c < dim; ++c) v[c] = field(at, c);
                    s.cloud().nodes().velocity[i] = v;
                }
            };

            const scalar deltaT = 1e-6;
            std::vector<scalar> before[3];
            for (label d = 0; d < dim; ++d)
            {
                before[d].assign
                    (s.cloud().x(d), s.cloud().x(d) + s.cloud().size());
            }
            setNodes();
            s.cloud().updateStress(deltaT);
            setNodes();
            s.cloud().gridToParticles(deltaT);

            scalar velocity = 0, gradient = 0, position = 0;
            for (label p = 0; p < s.cloud().size(); ++p)
            {
                scalar x[3];
                for (label d = 0; d < dim; ++d) x[d] = before[d][p];
                for (label c = 0; c < dim; ++c)
                {
                    const scalar v = field(x, c);
                    velocity = max(velocity, mag(s.cloud().v(c)[p] - v));
                    position = max
                        (position, mag(s.cloud().x(c)[p] - x[c] - deltaT*v));
                    for (label d = 0; d < dim && affine; ++d)
                    {
                        gradient = max
                        (
                            gradient,
                            mag
                            (
                                column(s, "velocityGradient", c*dim + d)[p]
                              - A[c][d]
                            )
                        );
                    }
                }
            }
            const std::string name = shape + ' ' + std::to_string(dim) + "D: ";
            atMost(name + "velocity", velocity, 2e-13);
            atMost(name + "position", position, 1e-14);
            if (affine) atMost(name + "velocity gradient", gradient, 1e-11);
        }
    }
}


TEST_CASE("water: a volume that is not positive is an error")
{
    // Points run towards the middle
    waterScene s(box(2, 8, 16, 1), vector::zero);
    const point middle(-0.15, 1.1, 0);
    s.fill
    (
        2, [](const point&) { return 1; },
        [&](const point& x)
        {
            const vector d(x - middle);
            return -10*vector(d.x(), d.y(), 0);
        }
    );
    auto lowest = [&]()
    {
        return *std::min_element
            (s.cloud().J(), s.cloud().J() + s.cloud().size());
    };
    auto step = [&](const scalar deltaT)
    {
        s.cloud().particlesToGrid();
        s.cloud().updateStress(deltaT);
        s.cloud().updateNodes(deltaT);
        s.cloud().gridToParticles(deltaT);
    };
    step(1e-4);
    atLeast("lowest volume ratio after a stable step", lowest(), 0.9);
    atLeast("speed of sound", s.cloud().maxWaveSpeed(), 1);

    for (int i = 0; i < 3; ++i) step(0.1);
    atMost("lowest volume ratio after steps far too long", lowest(), 0);
    contains
    (
        errorOf([&]() { s.cloud().maxWaveSpeed(); }),
        {"cloud water, point ", "mesh cell ", "J = ", "maxCo"}
    );
}

namespace
{

//- Momentum of the points
vector momentum(const materialPointCloud& cloud)
{
    const lattice& cells = cloud.grid().cells();
    vector sum(Zero);
    for (label p = 0; p < cloud.size(); ++p)
    {
        for (label d = 0; d < cells.nDim(); ++d)
        {
            sum[cells.axis(d)] += cloud.mass()[p]*cloud.v(d)[p];
        }
    }
    return sum;
}

//- Take a step, and return the force on the walls
vector step(waterScene& s, const scalar deltaT)
{
    waterCloud& c = s.cloud();
    c.particlesToGrid();
    c.updateStress(deltaT);
    c.updateNodes(deltaT);
    c.finishNodes(deltaT);
    c.gridToParticles(deltaT);
    c.relocate(deltaT);

    vector sum(Zero);
    for (const auto& load : c.wallLoads()) sum += load.force;
    return sum;
}

} // End anonymous namespace


TEST_CASE("wall loads: what walls take is what the points lose")
{
    // Slip, moving and sticking walls, and a step with a convex corner
    const vector g(2, -9.81, 1);
    const scalar deltaT = 2e-4;

    for (int dim = 2; dim <= 3; ++dim)
    {
        for (const std::string transfer : {"APIC", "FLIP", "PIC"})
        {
            meshPlan plan = box(dim, 6, 5, 3);
            plan.present = [](int i, int j, int) { return i < 4 || j > 1; };
            waterScene s
            (
                plan, g, {{"left", "noSlip"}, {"top", "noSlip"}},
                "quadraticBSpline", "transfer " + transfer + ';'
            );
            s.fill
            (
                2,
                [](const point& x) { return x.x() < 0.25 || x.y() > 1.5; },
                [](const point& x)
                {
                    return vector(2*x.y() - 1, -x.x() - 0.4, 0.3*x.z());
                }
            );
            s.cloud().relocate(0);
            s.cloud().recordWallLoads();

            scalar worst = 0;
            scalar scale = 0;
            for (int i = 0; i < 20; ++i)
            {
                const vector before = momentum(s.cloud());
                scalar mass = 0;
                for (label p = 0; p < s.cloud().size(); ++p)
                {
                    mass += s.cloud().mass()[p];
                }
                vector weight = mass*g;
                if (dim == 2) weight.z() = 0;

                const vector force = step(s, deltaT);
                const vector after = momentum(s.cloud());
                scale = max(scale, mag(force));
                worst = max
                (
                    worst,
                    mag((after - before)/deltaT - (weight - force))
                );
            }
            atMost
            (
                std::to_string(dim) + "D, " + transfer
              + ": error over the largest force",
                worst/scale, 1e-10
            );
        }
    }
}


TEST_CASE("wall loads: water at rest")
{
    // 0.6 m wide, 0.3 m thick, 0.8 m high
    const vector g(0, -9.81, 0);
    waterScene s(box(2, 6, 5, 1), g);
    const scalar depth = 0.8;
    s.fill
    (
        2,
        [&](const point& x) { return x.y() - 1 < depth; },
        [](const point&) { return vector::zero; },
        [&](const point& x)
        {
            return waterScene::rho0*9.81*(depth - (x.y() - 1));
        }
    );
    s.cloud().relocate(0);
    s.cloud().recordWallLoads();

    scalar mass = 0;
    for (label p = 0; p < s.cloud().size(); ++p) mass += s.cloud().mass()[p];
    const vector force = step(s, 1e-5);
    nodeConstraint::load load;
    for (const auto& ofPatch : s.cloud().wallLoads()) load += ofPatch;
    const scalar weight = 9.81*mass;

    // The points of the top row are not at rest from the first step on
    atMost("floor bears the weight", mag(force.y()/-weight - 1), 2e-2);
    atMost("sides push alike", mag(force.x())/weight, 1e-10);
    // About the origin: the middle of the floor is at x = 0.1, z = 3.15
    atMost
    (
        "moment of the weight", mag(load.moment.z()/(-0.1*weight) - 1), 2e-2
    );
    equal
    (
        "without being asked",
        waterScene(box(2, 3, 3, 1), g).cloud().wallLoads().size(), 0
    );
}

// ************************************************************************* //
