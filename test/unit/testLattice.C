/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "testMesh.H"
#include "backgroundGrid.H"
#include "latticeDiagnosis.H"
#include <cmath>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

meshPlan plan2D(const int nx, const int ny)
{
    meshPlan plan;
    plan.n = Vector<label>(nx, ny, 1);
    plan.size = vector(0.1, 0.2, 0.05);
    plan.origin = vector(-0.3, 1, 7);
    return plan;
}


std::string refusal(const meshPlan& plan)
{
    testMesh test(plan);
    return errorOf([&]() { backgroundGrid grid(test.mesh(), dictionary()); });
}

} // End anonymous namespace


TEST_CASE("lattice: origin, spacing and cells of a 2D mesh")
{
    // Empty in each direction in turn
    for (int empty = 0; empty < 3; ++empty)
    {
        meshPlan plan;
        plan.empty = empty;
        plan.n = Vector<label>(5, 4, 3);
        plan.n[empty] = 1;
        plan.size = vector(0.1, 0.2, 0.3);
        plan.origin = vector(-0.3, 1, 7);
        testMesh test(plan);
        const lattice cells(test.mesh());

        const int first = empty == 0 ? 1 : 0;
        const int second = empty == 2 ? 1 : 2;

        equal("solved directions", cells.nDim(), 2);
        equal("component of direction 0", cells.axis(0), first);
        equal("component of direction 1", cells.axis(1), second);
        equal("empty component", cells.axis(2), empty);
        equal("cells in direction 0", cells.nCells(0), plan.n[first]);
        equal("cells in direction 1", cells.nCells(1), plan.n[second]);
        atMost
        (
            "error of spacing, origin, thickness, middle",
            std::abs(cells.spacing(0) - plan.size[first])
          + std::abs(cells.spacing(1) - plan.size[second])
          + std::abs(cells.origin(0) - plan.origin[first])
          + std::abs(cells.origin(1) - plan.origin[second])
          + std::abs(cells.thickness() - plan.size[empty])
          + std::abs
            (
                cells.midPlane() - plan.origin[empty] - 0.5*plan.size[empty]
            ),
            1e-14
        );

        scalar off = 0;
        forAll(test.mesh().cellCentres(), celli)
        {
            for (label d = 0; d < 2; ++d)
            {
                const scalar centre = cells.origin(d)
                  + (cells.cellIndex(celli)[d] + 0.5)*cells.spacing(d);
                off = max
                (
                    off,
                    mag
                    (
                        centre
                      - test.mesh().cellCentres()[celli][cells.axis(d)]
                    )
                );
            }
        }
        atMost("cell centres by index and by mesh", off, 1e-13);
    }
}


TEST_CASE("backgroundGrid: cells and nodes of the box")
{
    meshPlan plan = plan2D(6, 5);
    plan.present = [](int i, int j, int) { return !(i >= 2 && j < 2); };
    testMesh test(plan);
    const backgroundGrid grid(test.mesh(), dictionary());

    equal
    (
        "shape function by default", grid.shapeFunction(), "quadraticBSpline"
    );

    label wrong = 0, own = 0;
    scalar off = 0;
    for (label celli = 0; celli < test.mesh().nCells(); ++celli)
    {
        const label cell = grid.boxCell(celli);
        wrong += grid.meshCell(cell) != celli;
        wrong += grid.index(grid.coordinate(cell)) != cell;
        wrong += !grid.ownCell(cell) || grid.cellRank(cell) != 0;

        // The cell has the index of its lower corner node
        const point corner = grid.nodePosition(cell);
        const point centre = test.mesh().cellCentres()[celli];
        off = max(off, mag(corner.x() + 0.5*plan.size.x() - centre.x()));
        off = max(off, mag(corner.y() + 0.5*plan.size.y() - centre.y()));
    }
    for (label cell = 0; cell < grid.nNodes(); ++cell)
    {
        own += grid.ownCell(cell);
        wrong += grid.ownCell(cell) != (grid.cellRank(cell) == 0);
    }
    equal("cells whose box cell is wrong", wrong, 0);
    equal("box cells that are mesh cells", own, test.mesh().nCells());
    atMost("corner node against cell centre", off, 1e-13);
}


TEST_CASE("backgroundGrid: cyclic images of cells")
{
    // Also where the domain is narrower than a tile
    for (int n = 1; n <= 4; ++n)
    {
        meshPlan plan = plan2D(n, 4);
        plan.patch = [&](const point& c, const vector& normal)
        {
            const std::string side = hullSides(plan, c, normal);
            return side == "left" || side == "right" ? side : "";
        };
        plan.type = {{"left", "cyclic"}, {"right", "cyclic"}};
        testMesh test(plan);
        const backgroundGrid grid(test.mesh(), dictionary());

        equal("direction 0 is periodic", grid.cells().periodic(0), true);
        equal("direction 1 is periodic", grid.cells().periodic(1), false);

        label missing = 0;
        for (label celli = 0; celli < test.mesh().nCells(); ++celli)
        {
            const label cell = grid.boxCell(celli);
            missing += grid.cellRank(cell - 1) == backgroundGrid::missing;
            missing += grid.cellRank(cell + 1) == backgroundGrid::missing;
        }
        equal
        (
            std::to_string(n) + " cells: missing neighbours in the periodic"
            " direction",
            missing, 0
        );
    }
}


TEST_CASE("refused: unknown shape function")
{
    testMesh test(plan2D(4, 4));
    dictionary control;
    control.set("shapeFunction", word("quadratic"));
    contains
    (
        errorOf([&]() { backgroundGrid grid(test.mesh(), control); }),
        {
            "shapeFunction", "quadratic", "linear", "quadraticBSpline",
            "cubicBSpline"
        }
    );
}


TEST_CASE("refused: graded mesh")
{
    // The third column is the first of another width
    meshPlan plan = plan2D(4, 4);
    plan.map = [](const point& x)
    {
        const scalar i = (x.x() + 0.3)/0.1;
        return point(-0.3 + 0.1*(i <= 2.5 ? i : 2 + 1.3*(i - 2)), x.y(), x.z());
    };
    contains
    (
        refusal(plan),
        {"not uniform", "First offending cell: 0", "grading"}
    );

    // Slight grading, cell to cell 1 %
    plan.map = [](const point& x)
    {
        const scalar i = (x.x() + 0.3)/0.1;
        return point(-0.3 + 0.1*(i + 0.005*i*(i - 1)), x.y(), x.z());
    };
    contains(refusal(plan), {"not uniform", "First offending cell"});
}


TEST_CASE("digits of coordinates")
{
    equal
    (
        "of 4200000.006", latticeDiagnosis::digits(scalarList(1, 4200000.006)),
        10
    );
    equal
    (
        "of 0.1 and 0.25",
        latticeDiagnosis::digits(scalarList({0.1, 0.25})), 2
    );
    // To 4e-15, relative: the rounding of a product of three
    equal("of 1/3", latticeDiagnosis::digits(scalarList(1, 1.0/3)), 15);
    atMost
    (
        "unit of 4200000.006: error",
        mag(latticeDiagnosis::unit(4200000.006, 10)/1e-3 - 1), 1e-12
    );
}


TEST_CASE("refused: two sizes of cells")
{
    // 0.5 to the left, 0.28 to the right of 0.2: 14 cells of 0.0557 come
    // nearest to both, 9 and 5
    meshPlan plan = plan2D(7, 4);
    plan.map = [](const point& x)
    {
        return point
        (
            x.x() > 0.2 ? 0.2 + 1.4*(x.x() - 0.2) : x.x(), x.y(), x.z()
        );
    };
    contains
    (
        refusal(plan),
        {
            "Along x", "5 cells of 0.1 from -0.3 to 0.2",
            "2 cells of 0.14 from 0.2 to 0.48",
            "fits all these lengths within 1 % along x: 0.05571", "x (9 5)"
        }
    );
}


TEST_CASE("refused: sheared mesh")
{
    meshPlan plan = plan2D(4, 4);
    plan.map = [](const point& x)
    {
        return point(x.x() + 0.05*(x.y() - 1), x.y(), x.z());
    };
    contains(refusal(plan), {"not uniform", "First offending cell: 0"});

    // One vertex out of place: cell 0 is right
    plan.map = [](const point& x)
    {
        return
            mag(x.x()) < 1e-6 && mag(x.y() - 1.4) < 1e-6
          ? point(0.002, 1.4, x.z()) : x;
    };
    contains(refusal(plan), {"not uniform", "First offending cell: 6"});
}


TEST_CASE("refused: hole in the empty patch")
{
    // What subsetMesh without -patch leaves: faces of the hole are empty
    meshPlan plan = plan2D(8, 8);
    plan.present = [](int i, int j, int)
    {
        return !(i >= 3 && i < 5 && j >= 3 && j < 5);
    };
    plan.patch = [&](const point& c, const vector& n) -> std::string
    {
        const bool hull = !hullSides(plan, c, n).empty();
        return !hull ? "oldInternalFaces" : "";
    };
    plan.type = {{"oldInternalFaces", "empty"}};
    contains
    (
        refusal(plan),
        {"oldInternalFaces", "empty", "does not face the empty direction z"}
    );
}


TEST_CASE("refused: wall one cell thick")
{
    meshPlan plan = plan2D(8, 6);
    plan.present = [](int i, int j, int) { return !(i == 4 && j >= 3); };
    contains
    (
        refusal(plan),
        {"walls one cell thick, at 1 place", "direction x, from (0.1 1.6"}
    );

    plan.present = [](int i, int j, int) { return !(j == 2 && i < 5); };
    contains
    (
        refusal(plan),
        {"walls one cell thick, at 1 place", "direction y, from (-0.3 1.4"}
    );

    // Two cells are a wall
    plan.present = [](int i, int j, int)
    {
        return !((i == 4 || i == 5) && j >= 3);
    };
    testMesh test(plan);
    const backgroundGrid grid(test.mesh(), dictionary());
    equal("cells beside a wall of two cells", test.mesh().nCells(), 42);
}


TEST_CASE("refused: wall without thickness")
{
    // The points between columns 3 and 4 doubled: the halves touch, but do
    // not share a face
    meshPlan plan = plan2D(8, 4);
    plan.n.x() = 9;
    plan.present = [](int i, int, int) { return i != 4; };
    plan.map = [](const point& x)
    {
        return point(x.x() > 0.15 ? x.x() - 0.1 : x.x(), x.y(), x.z());
    };
    contains(refusal(plan), {"walls", "wall without thickness", "(0.1 1.1"});
}


TEST_CASE("refused: wedge")
{
    meshPlan plan = plan2D(4, 4);
    plan.origin = vector(0, 0.4, -0.025);
    plan.map = [](const point& x)
    {
        const scalar angle = 2.5*3.14159265358979/180;
        return point
        (
            x.x(), x.y()*std::cos(angle),
            (x.z() > 0 ? 1 : -1)*x.y()*std::sin(angle)
        );
    };
    plan.patch = [](const point&, const vector& n) -> std::string
    {
        return n.z() > 0.9 ? "wedge1" : n.z() < -0.9 ? "wedge0" : "";
    };
    plan.type = {{"wedge0", "wedge"}, {"wedge1", "wedge"}};
    contains(refusal(plan), {"patch wedge0", "type wedge"});
}


TEST_CASE("refused: two cells in the empty direction")
{
    meshPlan plan = plan2D(3, 3);
    plan.n.z() = 2;
    contains(refusal(plan), {"2 cells in its empty direction"});
}

// ************************************************************************* //
