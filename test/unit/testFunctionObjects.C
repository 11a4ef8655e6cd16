/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "waterScene.H"
#include "functionObject.H"
#include "StringStream.H"
#include "OSspecific.H"
#include "materialPointEnergy.H"
#include "frontPosition.H"
#include "waveGauge.H"
#include <cmath>
#include <fstream>
#include <sstream>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

const vector down(0, -9.81, 0);

meshPlan tank2D(const int nx, const int ny, const scalar h = 0.1)
{
    meshPlan plan;
    plan.n = Vector<label>(nx, ny, 1);
    plan.size = vector(h, h, h);
    return plan;
}


meshPlan tank3D(const int nx, const int ny, const int nz, const scalar h = 0.1)
{
    meshPlan plan;
    plan.n = Vector<label>(nx, ny, nz);
    plan.size = vector(h, h, h);
    plan.empty = 3;
    return plan;
}


//- A function object, by the table as OpenFOAM makes it
autoPtr<functionObject> make(waterScene& s, const std::string& entries)
{
    IStringStream is(entries);
    dictionary dict(is);
    dict.name() = "controlDict.functions.test";
    if (!dict.found("cloud")) dict.set("cloud", word("water"));
    return functionObject::New("test", s.test().time(), dict);
}


//- Rows of what it wrote, the time in front
std::vector<std::vector<scalar>> rows(waterScene& s, const std::string& file)
{
    std::ifstream is(s.test().path()/"postProcessing/test/0"/(file + ".dat"));
    std::vector<std::vector<scalar>> table;
    std::string line;
    while (std::getline(is, line))
    {
        if (line.empty() || line[0] == '#') continue;
        std::istringstream fields(line);
        std::vector<scalar> row;
        std::string field;
        while (fields >> field) row.push_back(std::stod(field));
        table.push_back(row);
    }
    return table;
}


//- Heights at the locations and the mean level, as written
std::vector<scalar> gauge(waterScene& s, const std::vector<point>& locations)
{
    OStringStream list;
    list << '(';
    list.precision(15);
    for (const point& x : locations) list << x << ' ';
    list << ')';

    make(s, "type waveGauge; writePrecision 16; points " + list.str() + ";");
    const auto table = rows(s, "waveGauge");
    REQUIRE(table.size() == 1);
    REQUIRE(table[0].size() == locations.size() + 2);
    rmDir(s.test().path()/"postProcessing");
    return std::vector<scalar>(table[0].begin() + 1, table[0].end());
}


//- Largest |height - expected(location)| in cell sizes
scalar gaugeError
(
    waterScene& s,
    const std::vector<point>& locations,
    const std::function<scalar(const point&)>& expected
)
{
    const std::vector<scalar> found(gauge(s, locations));
    scalar error = 0;
    for (size_t i = 0; i < locations.size(); ++i)
    {
        const scalar e = mag(found[i] - expected(locations[i]));
        if (!(e <= error)) error = e;
    }
    return error/s.grid().cells().spacing(0);
}


//- n + 1 locations along x, both ends included
std::vector<point> along(const scalar from, const scalar to, const int n)
{
    std::vector<point> x;
    for (int i = 0; i <= n; ++i)
    {
        x.push_back(point(from + (to - from)*i/n, 0.01, 0.01));
    }
    return x;
}

} // End anonymous namespace


TEST_CASE("waveGauge: flat tank in 2D")
{
    for (int n = 1; n <= 5; ++n)
    {
        // Surfaces between rows of points, not at cell faces
        const scalar depth = 0.1*(6 + scalar(n/2)/n);
        for
        (
            const std::string shape
          : {"linear", "quadraticBSpline", "cubicBSpline"}
        )
        {
            // FLIP: what moves the points does not matter to a gauge, and linear
            // is not admitted with APIC
            waterScene s(tank2D(8, 10), down, {}, shape, "transfer FLIP;");
            s.fill(n, [&](const point& x) { return x.y() < depth; });

            const std::string name =
                std::to_string(n) + " points per direction, " + shape + ": ";
            atMost
            (
                name + "error of the height / h",
                gaugeError
                (
                    s, along(0, 0.8, 37), [&](const point&) { return depth; }
                ),
                1e-12
            );
            atMost
            (
                name + "error of the mean level / h",
                mag(gauge(s, {}).back() - depth)/0.1, 1e-12
            );
        }
    }
}


TEST_CASE("waveGauge: empty direction and gravity along other axes")
{
    for (int empty = 0; empty < 3; ++empty)
    {
        for (int up = 0; up < 3; ++up)
        {
            if (up == empty) continue;
            const int along = 3 - empty - up;

            meshPlan plan;
            plan.n = Vector<label>(5, 5, 5);
            plan.n[empty] = 1;
            plan.empty = empty;
            plan.size = vector(0.1, 0.1, 0.1);
            plan.size[along] = 0.2;
            plan.size[empty] = 0.03;
            plan.origin = vector(1, -2, 3);
            vector g(Zero);
            g[up] = (up == 0 ? 9.81 : -9.81);
            g[along] = 1;

            waterScene s(plan, g);
            const scalar surface = plan.origin[up] + 0.25;
            s.fill(4, [&](const point& x) { return x[up] < surface; });

            point location(plan.origin);
            location[along] += 0.37;
            atMost
            (
                std::string("empty ") + char('x' + empty) + ", up "
              + char('x' + up) + ": error / h",
                mag(gauge(s, {location})[0] - 0.25)/0.1, 1e-12
            );
        }
    }
}


TEST_CASE("waveGauge: tank in 3D")
{
    waterScene s(tank3D(6, 5, 4), vector(0, 0, -9.81));
    s.fill(3, [](const point& x) { return x.z() < 0.2; });

    std::vector<point> locations;
    for (int i = 0; i <= 12; ++i)
    for (int j = 0; j <= 11; ++j)
    {
        locations.push_back(point(0.6*i/12, 0.5*j/11, 0));
    }
    atMost
    (
        "error of the height / h",
        gaugeError(s, locations, [](const point&) { return 0.2; }), 1e-12
    );
    atMost
    (
        "error of the mean level / h", mag(gauge(s, {}).back() - 0.2)/0.1, 1e-12
    );
}


TEST_CASE("waveGauge: step, obstacle and narrow channel")
{
    {
        // A step three cells high from x = 0.5 on
        meshPlan plan = tank2D(10, 10);
        plan.present = [](int i, int j, int) { return !(i >= 5 && j < 3); };
        waterScene s(plan, down);
        s.fill(4, [](const point& x) { return x.y() < 0.625; });

        atMost
        (
            "in front of a step: error / h",
            gaugeError
            (
                s, along(0, 0.499999, 23), [](const point&) { return 0.625; }
            ),
            1e-12
        );
        atMost
        (
            "above the step: error / h",
            gaugeError
            (
                s, along(0.500001, 1, 23), [](const point&) { return 0.325; }
            ),
            1e-12
        );
        atMost
        (
            "mean level: error / h",
            mag(gauge(s, {}).back() - 0.5*(0.625 + 0.325))/0.1,
            1e-12
        );
    }
    {
        // A block under water, two cells wide: above and below it is water
        meshPlan plan = tank2D(9, 10);
        plan.present = [](int i, int j, int)
        {
            return !(i >= 4 && i < 6 && j >= 2 && j < 5);
        };
        waterScene s(plan, down);
        s.fill(3, [](const point& x) { return x.y() < 0.7; });
        atMost
        (
            "beside a block: error / h",
            max
            (
                gaugeError
                (
                    s, along(0, 0.399999, 11), [](const point&) { return 0.7; }
                ),
                gaugeError
                (
                    s, along(0.600001, 0.9, 11),
                    [](const point&) { return 0.7; }
                )
            ),
            1e-12
        );
        atMost
        (
            "through a block: error / h",
            gaugeError
            (
                s, along(0.400001, 0.599999, 11),
                [](const point&) { return 0.4; }
            ),
            1e-12
        );
    }
    for (int width = 1; width <= 3; ++width)
    {
        waterScene s(tank2D(width, 6), down);
        s.fill(3, [](const point& x) { return x.y() < 0.4; });
        atMost
        (
            "channel " + std::to_string(width) + " cells wide: error / h",
            gaugeError
            (
                s, along(0, 0.1*width, 10), [](const point&) { return 0.4; }
            ),
            1e-12
        );
    }
}


TEST_CASE("waveGauge: around an obstacle in 3D")
{
    meshPlan plan = tank3D(8, 8, 6);
    plan.present = [](int i, int j, int k)
    {
        return !(i >= 3 && i < 5 && j >= 3 && j < 5 && k < 2);
    };
    waterScene s(plan, vector(0, 0, -9.81));
    s.fill(3, [](const point& x) { return x.z() < 0.4; });

    std::vector<point> inLine, diagonal;
    for (int i = 0; i <= 16; ++i)
    {
        const scalar a = 0.8*i/16;
        inLine.push_back(point(a, 0.25, 0));
        inLine.push_back(point(a, 0.55, 0));
        inLine.push_back(point(0.1, a, 0));
        inLine.push_back(point(a, 0.299, 0));
    }
    for (int i = 1; i < 15; ++i)
    {
        diagonal.push_back(point(0.3 - 0.01*i, 0.3 - 0.009*i, 0));
    }
    inLine.push_back(point(0.4, 0.4, 0));

    atMost
    (
        "in line with its faces: error / h",
        gaugeError
        (
            s, inLine,
            [](const point& x)
            {
                const bool above =
                    x.x() >= 0.3 && x.x() < 0.5 && x.y() >= 0.3 && x.y() < 0.5;
                return above ? 0.2 : 0.4;
            }
        ),
        // Cut splines near the edges are not sampled exactly
        0.02
    );
    atMost
    (
        "diagonally beside its edge: error / h",
        gaugeError(s, diagonal, [](const point&) { return 0.4; }), 0.02
    );
}


TEST_CASE("waveGauge: cyclic ends")
{
    for (int n = 1; n <= 5; ++n)
    {
        meshPlan plan = tank2D(n, 6);
        const meshPlan bare(plan);
        plan.patch = [bare](const point& c, const vector& normal)
        {
            const std::string side = hullSides(bare, c, normal);
            return side == "left" || side == "right" ? side : "";
        };
        plan.type = {{"left", "cyclic"}, {"right", "cyclic"}};
        waterScene s(plan, down);
        s.fill(3, [](const point& x) { return x.y() < 0.4; });
        atMost
        (
            std::to_string(n) + " cells: error of the height / h",
            gaugeError
            (
                s, along(0, 0.1*n, 10), [](const point&) { return 0.4; }
            ),
            1e-12
        );
        atMost
        (
            std::to_string(n) + " cells: error of the mean level / h",
            mag(gauge(s, {}).back() - 0.4)/0.1, 1e-12
        );
    }
}


TEST_CASE("waveGauge: inclined surface")
{
    // Each column of points holds the volume below the surface
    auto surface = [](const scalar x) { return 0.3 + 0.25*x; };

    waterScene s(tank2D(12, 8), down);
    const scalar rows = 3*8;
    s.fill
    (
        3, [&](const point& x) { return surface(x.x())/(rows*0.1/3); }
    );
    atMost
    (
        "away from the walls: error / h",
        gaugeError
        (
            s, along(0.15, 1.05, 50),
            [&](const point& x) { return surface(x.x()); }
        ),
        1e-12
    );
    // The mirrored slope has a kink at the wall, and the spline's mean
    // distance from its middle is 13/32
    atMost
    (
        "at the walls: error / h",
        gaugeError
        (
            s, {point(0, 0, 0), point(1.2, 0, 0)},
            [&](const point& x)
            {
                const scalar kink = 0.25*0.1*13/32;
                return surface(x.x()) + (x.x() < 0.6 ? kink : -kink);
            }
        ),
        0.005
    );
}


TEST_CASE("waveGauge: crowded points")
{
    // Pressed together by a tenth, with the volumes they had
    waterScene s(tank2D(10, 24), down);
    s.fill
    (
        4, [](const point& x) { return x.y() < 2; },
        [](const point&) { return vector(Zero); },
        [](const point&) { return 0; },
        [](const point& x) { return point(x.x(), 0.9*x.y(), x.z()); }
    );
    atMost
    (
        "error of the height as the sum of volumes, 20 h, / h",
        gaugeError(s, along(0, 1, 20), [](const point&) { return 2; }), 1e-12
    );
    // Only the last three layers of nodes count the points' own volume
    const scalar level = gauge(s, {}).back();
    atMost("mean level of 18 h of crowded water, / h", level/0.1, 18.35);
    atLeast("mean level of 18 h of crowded water, / h", level/0.1, 18);
}


TEST_CASE("frontPosition: drops ahead of the front")
{
    auto front = [](waterScene& s, const std::string& entries)
    {
        make(s, "type frontPosition; writePrecision 16; " + entries);
        const auto table = rows(s, "front");
        REQUIRE(table.size() == 1);
        REQUIRE(table[0].size() == 3);
        rmDir(s.test().path()/"postProcessing");
        return table[0];
    };

    // A block up to 0.4, and in the cell 6, 0 as many of its 16 points as
    // asked for; three neighbours at the floor, so that 6.4 are a tenth
    for (const int n : {0, 1, 6, 7, 16})
    {
        waterScene s(tank2D(10, 6), down);
        int count = 0;
        s.fill
        (
            4,
            [&](const point& x)
            {
                if (x.x() < 0.4 && x.y() < 0.3) return true;
                return x.x() > 0.6 && x.x() < 0.7 && x.y() < 0.1 && count++ < n;
            }
        );
        const scalar drop = n >= 4 ? 0.6875 : 0.6 + 0.1*(n - 0.5)/4;
        const scalar farthest = n ? drop : 0.3875;
        const auto row = front(s, "direction (2 0 0);");
        const std::string name = std::to_string(n) + " points in a cell: ";
        atMost(name + "error of max", mag(row[1] - farthest), 1e-12);
        atMost
        (
            name + "error of front",
            mag(row[2] - (n >= 7 ? farthest : 0.3875)), 1e-12
        );
    }

    // Directions, and another threshold
    waterScene s(tank2D(10, 6), down);
    s.fill
    (
        4,
        [](const point& x)
        {
            return
                (x.x() > 0.2 && x.x() < 0.6 && x.y() < 0.3)
             || (mag(x.x() - 0.8125) < 1e-6 && mag(x.y() - 0.5125) < 1e-6);
        }
    );
    const scalar r2 = std::sqrt(2.0);
    auto row = front(s, "direction (-1 0 0);");
    atMost("backwards: max", mag(row[1] + 0.2125), 1e-12);
    atMost("backwards: front", mag(row[2] + 0.2125), 1e-12);
    row = front(s, "direction (0 1 0);");
    atMost("upwards: max", mag(row[1] - 0.5125), 1e-12);
    atMost("upwards: front", mag(row[2] - 0.2875), 1e-12);
    row = front(s, "direction (1 1 0);");
    atMost("diagonally: max", mag(row[1] - 1.325/r2), 1e-12);
    atMost("diagonally: front", mag(row[2] - 0.875/r2), 1e-12);
    row = front(s, "direction (1 0 0); minFraction 1e-3;");
    atMost("any point: front", mag(row[2] - 0.8125), 1e-12);

    // Nothing there
    waterScene none(tank2D(4, 4), down);
    row = front(none, "direction (1 0 0);");
    equal("no points: max is nan", label(std::isnan(row[1])), 1);
    equal("no points: front is nan", label(std::isnan(row[2])), 1);
}


TEST_CASE("frontPosition: neighbours across a cyclic end")
{
    for (const bool cyclic : {false, true})
    {
        meshPlan plan = tank2D(6, 4);
        const meshPlan bare(plan);
        plan.patch = [bare](const point& c, const vector& normal)
        {
            const std::string side = hullSides(bare, c, normal);
            return side == "left" || side == "right" ? side : "";
        };
        if (cyclic) plan.type = {{"left", "cyclic"}, {"right", "cyclic"}};

        // One point at the right end, water at the left
        waterScene s(plan, down);
        s.fill
        (
            4,
            [](const point& x)
            {
                return
                    x.x() < 0.2
                 || (mag(x.x() - 0.5875) < 1e-6 && mag(x.y() - 0.1125) < 1e-6);
            }
        );
        make(s, "type frontPosition; direction (1 0 0);");
        atMost
        (
            std::string(cyclic ? "cyclic" : "walls") + ": error of front",
            mag(rows(s, "front")[0][2] - (cyclic ? 0.5875 : 0.1875)), 1e-6
        );
    }
}


TEST_CASE("materialPointEnergy: against sums over the points")
{
    // Water that rotates and is compressed
    const vector g(1, -9.81, 0);
    waterScene s(tank2D(6, 5), g);
    auto velocity = [](const point& x) { return vector(-2*x.y(), 3*x.x(), 0); };
    auto pressure = [](const point& x) { return 5e4*x.x(); };
    s.fill(2, [](const point& x) { return x.y() < 0.4; }, velocity, pressure);

    // With the gradient of that velocity, which APIC carries
    pointStorage& points = const_cast<pointStorage&>(s.cloud().points());
    for (const pointStorage::field& f : points.fields())
    {
        if (f.name != "velocityGradient") continue;
        for (label p = 0; p < s.cloud().size(); ++p)
        {
            points.column(f.first + 1)[p] = -2;
            points.column(f.first + 2)[p] = 3;
        }
    }

    // The same by hand: mass rho V, energy of the equation of state, and of
    // the motion in the second moment h^2/4 of the shape function
    scalar kinetic = 0, potential = 0, elastic = 0, affine = 0;
    const scalar B = 20.0*20*1000/7;
    for (int i = 0; i < 12; ++i)
    for (int j = 0; j < 8; ++j)
    {
        const point x(0.05*(i + 0.5), 0.05*(j + 0.5), 0.05);
        const scalar V = 0.05*0.05*0.1;
        const scalar J = std::pow(1 + pressure(x)/B, -1.0/7);
        const scalar m = 1000*V/J;
        kinetic += 0.5*m*magSqr(velocity(x));
        potential -= m*(g & x);
        elastic += V/J*B*((std::pow(J, -6) - 1)/6 + J - 1);
        affine += 0.5*m*(4 + 9)*sqr(0.1)/4;
    }

    make(s, "type materialPointEnergy; writePrecision 16;");
    const auto row = rows(s, "energy")[0];
    REQUIRE(row.size() == 8);

    atMost("kinetic, relative", mag(row[1]/kinetic - 1), 1e-12);
    atMost("potential, relative", mag(row[2]/potential - 1), 1e-12);
    atMost("elastic, relative", mag(row[3]/elastic - 1), 1e-12);
    atMost("stressWork at the start", mag(row[4]), 0);
    atMost("correctionWork at the start", mag(row[5]), 0);
    atMost
    (
        "total, relative",
        mag(row[6]/(kinetic + potential + affine) - 1), 1e-12
    );
    atMost("affine, relative", mag(row[7]/affine - 1), 1e-12);
}


TEST_CASE("function objects: a line at the start and for each write")
{
    waterScene s(tank2D(4, 4), down);
    s.fill(2, [](const point& x) { return x.y() < 0.2; });

    autoPtr<functionObject> energy
    (
        make(s, "type materialPointEnergy; writePrecision 10;")
    );
    equal("rows after the start", label(rows(s, "energy").size()), 1);

    s.test().time().setTime(0.25, 1);
    energy->execute();
    equal("rows after execute", label(rows(s, "energy").size()), 1);
    energy->write();
    s.test().time().setTime(0.5, 2);
    energy->execute();
    energy->write();

    const auto table = rows(s, "energy");
    equal("rows after two writes", label(table.size()), 3);
    atMost("time of row 0", mag(table[0][0]), 0);
    atMost("time of row 1", mag(table[1][0] - 0.25), 0);
    atMost("time of row 2", mag(table[2][0] - 0.5), 0);

    // The run begins again: a new file, the old one beside it
    energy.clear();
    s.test().time().setTime(scalar(0), 0);
    make(s, "type materialPointEnergy;");
    equal("rows of a second run", label(rows(s, "energy").size()), 1);
    equal
    (
        "the file of the first one is kept",
        label
        (
            isFile(s.test().path()/"postProcessing/test/0/energy.dat.bak")
        ),
        1
    );

    // Nothing before its own start time
    waterScene later(tank2D(4, 4), down);
    make(later, "type materialPointEnergy; timeStart 0.1;");
    equal("rows before timeStart", label(rows(later, "energy").size()), 0);
}


TEST_CASE("function objects: refused entries")
{
    waterScene s(tank2D(6, 5), down);
    s.fill(2, [](const point& x) { return x.y() < 0.2; });
    auto refusal = [&](const std::string& entries)
    {
        return errorOf([&]() { make(s, entries); });
    };

    contains
    (
        refusal("type materialPointEnergy; cloud soil;"),
        {"keyword cloud", "soil", "Clouds of this case: (water)"}
    );
    contains
    (
        refusal("type materialPointEnergy; clouds water;"),
        {"clouds", "Did you mean cloud?"}
    );
    contains(refusal("type frontPosition;"), {"direction"});
    contains
    (
        refusal("type frontPosition; direction (0 0 0);"),
        {"direction", "(0 0 0)", "Allowed: a vector that is not zero"}
    );
    contains
    (
        refusal("type frontPosition; direction (1 0 1);"),
        {"direction", "(1 0 1)", "no component in the empty direction z"}
    );
    contains
    (
        refusal("type frontPosition; direction (1 0 0); minFraction -1;"),
        {"minFraction", "-1", "0 < minFraction < 1"}
    );
    contains(refusal("type waveGauge;"), {"points"});
    contains
    (
        refusal("type waveGauge; points ((0.1 0 0) (0.7 0 0));"),
        {"keyword points", "location 1, (0.7 0 0)", "(0.6 0.5 0.1)"}
    );
    contains
    (
        refusal("type waveGauge; points ((-0.001 0 0));"),
        {"keyword points", "location 0, (-0.001 0 0)"}
    );

    waterScene weightless(tank2D(4, 4), vector(Zero));
    contains
    (
        errorOf([&]() { make(weightless, "type waveGauge; points ();"); }),
        {"needs gravity", "(0 0 0)"}
    );
}

// ************************************************************************* //
