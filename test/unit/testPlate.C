/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "testMesh.H"
#include "nodeBoundary.H"
#include <cmath>
#include <set>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- A plate in a mesh of 10 x 8 cells of 1 m; upwards from below the floor
struct platedScene
{
    testMesh test;
    dictionary control;
    backgroundGrid grid;
    tmp<volVectorField> U;
    autoPtr<nodeBoundary> boundary;

    static meshPlan plan()
    {
        meshPlan p;
        p.n = Vector<label>(10, 8, 1);
        return p;
    }

    platedScene(const std::vector<plate>& plates)
    :
        test(plan()),
        grid(test.mesh(), control)
    {
        if (plates.size())
        {
            grid.setPlates(plates);
            grid.rebuild();
        }
        U = test.velocity({});
        boundary.reset(new nodeBoundary(grid, U()));
    }

    label at(const int i, const int j) const
    {
        index3 n;
        n[0] = i - grid.lower(0);
        n[1] = j - grid.lower(1);
        n[2] = 0;
        return grid.index(n);
    }

    //- Records that the points of a part of a cell see
    std::set<label> seen(const label cell, const label part, const label view)
    {
        const nodeTiles& tiles = boundary->tiles();
        const nodeTiles::record& t = tiles[tiles.of(cell, part, view)];
        std::set<label> nodes;
        for (label j = 0; j < grid.tileWidth(); ++j)
        for (label i = 0; i < grid.tileWidth(); ++i)
        {
            nodes.insert
            (
                t.stencil < 0
              ? t.first + i + j*grid.stride(1)
              : boundary->folding().targets(t.stencil)
                [t.offset + i + j*grid.reachWidth()]
            );
        }
        return nodes;
    }
};


plate upright(const scalar x, const scalar top, const scalar thickness)
{
    return plate
        (point(x, -4, 0), point(x, top, 0), vector(0, 0, 1), thickness, true);
}

} // End anonymous namespace


TEST_CASE("plate: views, nearest places and parts")
{
    const scalar d = 0.2;
    const plate thin
        (point(1, 1, 0), point(4, 5, 0), vector(0, 0, 1), d, true);
    const vector n(thin.normal());
    atMost("error of the normal", mag(n - vector(0.8, -0.6, 0)), 1e-14);
    const point middle(2.5, 3, 0);

    equal("view in front", thin.viewAt(middle + 0.01*n), plate::front);
    equal("view behind", thin.viewAt(middle - 0.01*n), plate::back);
    equal
    (
        "view beyond the end",
        thin.viewAt(point(4, 5, 0) + 0.01*vector(0.6, 0.8, 0)), plate::none
    );

    // On the middle plane, whatever the rounding
    equal("view on the plane", thin.viewAt(middle + 1e-12*n), plate::front);
    equal("the same, behind", thin.viewAt(middle - 1e-12*n), plate::front);

    const plate::surface face(thin.nearest(middle - 0.7*n));
    atMost("error of the distance", mag(face.distance - 0.6), 1e-14);
    atMost("error of the direction", mag(face.normal + n), 1e-14);
    const vector t(0.6, 0.8, 0);
    const plate::surface corner
        (thin.nearest(point(4, 5, 0) + 0.3*t + 0.5*n));
    equal("a corner is no face", corner.face, false);
    atMost("error of its distance", mag(corner.distance - 0.5), 1e-14);
    const plate::surface end(thin.nearest(point(4, 5, 0) + 0.3*t + 0.05*n));
    equal("the end is a face", end.face, true);
    atMost("error of its direction", mag(end.normal - t), 1e-14);

    scalar worst = 0;
    for (label i = 0; i < 100; ++i)
    {
        const FixedList<scalar, 4> part
        (
            thin.parts(thin.local(point(0.05*i, 0.06*i, 0)), 0.25)
        );
        worst = max(worst, mag(part[0] + part[1] + part[2] + part[3] - 1));
    }
    atMost("error of the sum of parts", worst, 1e-12);
    equal("gone through", thin.passed(middle - 0.01*n, plate::front), true);
    equal("still there", thin.passed(middle + 0.2*n, plate::front), false);
    const point back(thin.returned(middle - 0.01*n, plate::front, 1e-6));
    atMost
    (
        "error of the place that it is put back to",
        mag(back - (middle + (0.5*d + 1e-6)*n)), 1e-14
    );
}


TEST_CASE("plate: wholly in one part, and moved by how much at most")
{
    const plate thin
        (point(1, 1, 0), point(4, 5, 0), vector(0, 0, 1), 1.1, true);

    // Cubes along it, in part of which as parts() says
    const scalar size = 0.6;
    label whole = 0, cut = 0, other = 0;
    for (label j = 0; j < 60; ++j)
    for (label i = 0; i < 60; ++i)
    {
        const vector at(thin.local(point(0.103*i - 0.5, 0.107*j, 0)));
        const FixedList<scalar, 4> parts(thin.parts(at, size));
        const label found = thin.whole(at, vector::uniform(0.5*size));
        if (found < 0) ++cut;
        else ++whole;
        for (label part = 0; part < 4; ++part)
        {
            other += (parts[part] > 1 - 1e-9) != (part == found);
        }
    }
    equal("some are whole, some are cut", whole > 100 && cut > 100, true);
    equal("differ from parts()", other, 0);

    atMost
    (
        "error of what a box takes",
        mag(thin.extents(vector(1, 2, 0)) - vector(2.2, 0, 2)), 1e-14
    );

    // Elsewhere
    const tensor rotation
        (0.8, -0.6, 0, 0.6, 0.8, 0, 0, 0, 1);
    const vector way(0.02, -0.01, 0);
    auto move = [&](const point& x) { return (rotation & x) + way; };
    const plate there(thin.moved(move, rotation));
    const plate further
        (thin.moved([&](const point& x) { return x + 0.3*vector(3, 4, 0); }, I));
    vector most(Zero), mostAlong(Zero);
    const scalar radius = 3;
    for (label i = 0; i < 100; ++i)
    {
        const point x
        (
            point(2.5, 3, 0)
          + 0.99*radius*vector(std::cos(0.7*i), std::sin(0.7*i), 0)
        );
        most = max(most, cmptMag(there.local(x) - thin.local(x)));
        mostAlong = max(mostAlong, cmptMag(further.local(x) - thin.local(x)));
    }
    const vector bound(there.change(thin, radius));
    const vector along(further.change(thin, radius));
    equal("bound holds", cmptMin(bound - most) >= 0, true);
    equal("bound holds along", cmptMin(along - mostAlong) >= -1e-12, true);
    atMost("error along", mag(along - vector(1.5, 0, 0)), 1e-12);
}


TEST_CASE("plate: no records without one")
{
    platedScene s({});
    equal("nodes", s.grid.nNodes(), s.grid.nFirst());
    equal("plated", s.grid.plated(), false);
    const label cell = s.at(4, 2);
    equal("plate of a cell", s.grid.plateOf(cell), -1);
}


TEST_CASE("plate: the two sides share no record, below its edge all do")
{
    for (const scalar thickness : {0.1, 2.0})
    {
        // From the floor to y = 5
        platedScene s({upright(4.3, 5, thickness)});
        equal("plated", s.grid.plated(), true);

        label shared = 0, sides = 0;
        for (label j = 0; j < 8; ++j)
        {
            for (label part = 0; part < 4; ++part)
            for (label i = 4; i < 10; ++i)
            for (label k = 0; k < 5; ++k)
            {
                const std::set<label> front
                    (s.seen(s.at(i, j), part, plate::front));
                const std::set<label> back
                    (s.seen(s.at(k, j), part, plate::back));
                if (s.grid.plateOf(s.at(i, j)) < 0) continue;
                if (s.grid.plateOf(s.at(k, j)) < 0) continue;
                for (const label node : front)
                {
                    if (s.grid.nodePosition(node).y() > 4.9) continue;
                    ++sides;
                    shared += back.count(node);
                }
            }
        }
        equal("records of both sides", shared, 0);
        atLeast("records looked at", sides, 100);

        // Node 4 4 lies behind, or to the left: in front is its second record
        const label node = s.at(4, 4), beyond = s.at(4, 6);
        equal("second of a node beyond the end", s.grid.second(beyond), -1);
        const label view = s.grid.viewOf(node);
        equal("own record", s.grid.seen(node, view), node);
        const label second = s.grid.second(node);
        equal
        (
            "seen across", s.grid.seen(node, plate::front + plate::back - view),
            second
        );
        atMost
        (
            "place of the second record",
            mag(s.grid.nodePosition(second) - vector(4, 4, 0.5)), 1e-12
        );
        const std::vector<scalar>& inverse = s.boundary->inverseVolume();
        atMost("control volume", mag(inverse[second] - inverse[node]), 0);

        // Walls hold both
        nodeField<nodeVector> v(s.grid.nNodes(), nodeVector{1, 1, 1, 1});
        s.boundary->constrain(v);
        const label floor = s.at(4, 0);
        equal("wall, own", label(v[floor][1]), 0);
        equal("wall, second", label(v[s.grid.second(floor)][1]), 0);
        equal("along it", label(v[s.grid.second(floor)][0]), 1);
    }
}


TEST_CASE("plate: a view sees each node once, and all points the same far away")
{
    platedScene s({upright(4.3, 5, 0.1)});
    for (const label view : {plate::front, plate::back})
    {
        // In the middle of the mesh nothing folds
        const std::set<label> nodes(s.seen(s.at(4, 3), 0, view));
        equal("records", label(nodes.size()), 9);
        std::set<label> places;
        for (const label node : nodes) places.insert(s.grid.boxNode(node));
        equal("places", label(places.size()), 9);
    }
    equal("plate of a cell far away", s.grid.plateOf(s.at(9, 3)), -1);
}


TEST_CASE("plate: what it parts is found again as if it had been there")
{
    // It is lifted, goes aside, and down again
    platedScene moved({upright(4.3, 5, 0.1)});
    for (const plate& there : {upright(4.3, 6.2, 0.1), upright(6.6, 4.4, 0.1)})
    {
        moved.grid.setPlates({there});
        equal("others", moved.grid.recordsStale(), true);
        moved.grid.renewRecords();
        moved.boundary->rebuild({});
        equal("others, now", moved.grid.recordsStale(), false);

        platedScene made({there});
        equal("nodes", moved.grid.nNodes(), made.grid.nNodes());
        label differ = 0, cells = 0;
        for (label cell = 0; cell < made.grid.nBoxNodes(); ++cell)
        {
            differ += moved.grid.plateOf(cell) != made.grid.plateOf(cell);
            differ += moved.grid.second(cell) != made.grid.second(cell);
            if (!made.grid.ownCell(cell)) continue;
            cells += made.grid.plateOf(cell) >= 0;
            for (const label view : {plate::none, plate::front, plate::back})
            for (label part = 0; part < 4; ++part)
            {
                differ +=
                    moved.seen(cell, part, view) != made.seen(cell, part, view);
            }
        }
        equal("what differs", differ, 0);
        atLeast("cells beside it", cells, 20);
        equal
        (
            "control volumes are the same",
            moved.boundary->inverseVolume() == made.boundary->inverseVolume(),
            true
        );
    }
}
