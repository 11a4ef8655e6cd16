/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "testMesh.H"
#include "massAccount.H"
#include "StringStream.H"
#include "waitingZone.H"
#include "inflowZone.H"
#include "nodeBoundary.H"
#include "pointStorage.H"
#include <random>

using namespace Foam;
using namespace Foam::mpm;


namespace
{

//- Equal to the last bit
void same(const std::string& name, const scalar a, const scalar b)
{
    atMost(name, mag(a - b), 0);
}

void holds(const std::string& name, const bool condition)
{
    equal(name, label(condition), 1);
}

} // End anonymous namespace


TEST_CASE("exactSum: no order and no size makes a difference")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<scalar> exponent(-20, 20), sign(-1, 1);
    std::vector<scalar> masses(10000);
    for (scalar& m : masses) m = std::exp2(exponent(random))*sign(random);

    exactSum forward, backward;
    scalar plain = 0, plainBack = 0;
    for (const scalar m : masses)
    {
        forward += m;
        plain += m;
    }
    std::reverse(masses.begin(), masses.end());
    for (const scalar m : masses)
    {
        backward += m;
        plainBack += m;
    }
    holds("sum and sum in reverse are one", forward == backward);
    holds("sums of doubles are not", plain != plainBack);
    atMost
    (
        "difference to the sum of doubles", mag(forward.value() - plain), 1e-6
    );

    // Take everything away again
    for (const scalar m : masses) forward += -m;
    same("what is left", forward.value(), 0);
}


TEST_CASE("exactSum: text and digits")
{
    for (const scalar s : {0.0, 1.0/3, -1.0/3, 1e-8, 123456789.123, -5e12})
    {
        const exactSum sum(s);
        same("value", sum.value(), s);
        holds("from its text", exactSum::fromText(sum.text()) == sum);
        holds
        (
            "from its digits",
            exactSum(static_cast<const UList<scalar>&>(sum.digits())) == sum
        );
        holds("over one rank", sum.global() == sum);
    }
}


TEST_CASE("massAccount: over a dictionary")
{
    massAccount a;
    for (label i = 0; i < 1000; ++i) a.add(0.1 + 1e-7*i);

    // A dictionary keeps a number as text, of the digits of state files
    const unsigned precision = IOstream::defaultPrecision(17);
    dictionary dict;
    a.write(dict, "left");
    massAccount b;
    b.read(dict, "left");
    equal("number", b.n, 1000);
    holds("mass", b.mass == a.mass);

    // States of before have the mass only
    dict.remove("leftMassDigits");
    b.read(dict, "left");
    IOstream::defaultPrecision(precision);
    atMost("mass of an old state", mag(b.mass.value() - a.mass.value()), 1e-12);
}


TEST_CASE("waitingZone: those that left first enter first")
{
    waitingZone waiting(true);
    waiting.setNextId(100);
    waiting.arrive(7, 5, 0.5);
    waiting.arrive(7, 3, 0.3);
    waiting.arrive(4, 9, 0.9);
    equal("waiting", waiting.waiting().n, 3);
    atMost
    (
        "their mass", mag(waiting.waiting().mass.value() - 1.7), 1e-15
    );

    const scalarList first(waiting.take(2));
    same("first", first[0], 9);
    same("second", first[1], 3);

    // Over a restart
    dictionary dict;
    waiting.write(dict);
    waitingZone again(true);
    again.read(dict);
    const scalarList next(again.take(3));
    same("third", next[0], 5);
    same("a new one", next[1], 100);
    same("and another", next[2], 101);
    equal("used again", again.nReused(), 3);
    equal("waiting", again.waiting().n, 0);
}


TEST_CASE("waitingZone: without recycling all points are new")
{
    waitingZone waiting(false);
    waiting.setNextId(10);
    waiting.arrive(1, 2, 0.5);
    same("id", waiting.take(1)[0], 10);
    equal("waiting", waiting.waiting().n, 1);
    equal("used again", waiting.nReused(), 0);
}


TEST_CASE("pointStorage: memory of points that left")
{
    for (const bool park : {false, true})
    {
        pointStorage points(2);
        points.add("x", pointStorage::vectorValue);
        points.resize(10);
        for (label p = 0; p < 10; ++p) points.column(0)[p] = p;

        for (label i = 0; i < 4; ++i)
        {
            if (park) points.park(0);
            else points.remove(0);
        }
        equal("points", points.size(), 6);
        equal("places", points.allocated(), 10);

        const scalar buffer[2] = {77, 78};
        for (label i = 0; i < 4; ++i) points.append(buffer, 3);
        equal("points", points.size(), 10);
        equal("places", points.allocated(), park ? 14 : 10);
        same("last point", points.column(1)[9], 78);
        equal("its cell", points.cell()[9], 3);

        points.resize(12);
        same("new points are zero", points.column(0)[11], 0);
    }
}


namespace
{

//- Box of 6 x 5 cells of 1 m, inlet on the left
meshPlan inletBox()
{
    meshPlan plan;
    plan.n = Vector<label>(6, 5, 1);
    plan.patch = [](const point&, const vector& n)
    {
        return n.x() < -0.5 ? "inlet" : "";
    };
    return plan;
}

} // End anonymous namespace


TEST_CASE("inflowZone: faces, cells and nodes of an inlet")
{
    testMesh test(inletBox());
    const backgroundGrid grid(test.mesh(), dictionary());
    const label patchi = test.mesh().boundaryMesh().findPatchID("inlet");

    // From 1 to 3.5 m, two cells long
    const inflowZone zone(grid, patchi, 1, 1, 3.5, 2);
    equal("normal", zone.direction(), 0);
    equal("low side", zone.side(), 0);
    equal("faces", label(zone.faces().size()), 3);
    equal("of this rank", label(zone.ownFaces().size()), 3);
    equal("cells", label(zone.meshCells().size()), 6);
    same("part of the highest", zone.faces()[2].upper, 0.5);

    // Lines 0 to 3, rows 1 to 4
    equal("nodes", label(zone.nodes().size()), 4*4);

    const inflowZone none(grid, patchi, 1, 7, 8, 1);
    equal("faces out of the patch's height", label(none.faces().size()), 0);
}


TEST_CASE("nodeBoundary: an inlet is a wall at rest or a plug that moves")
{
    testMesh test(inletBox());
    const backgroundGrid grid(test.mesh(), dictionary());
    const label patchi = test.mesh().boundaryMesh().findPatchID("inlet");
    const inflowZone zone(grid, patchi, 1, 0, 5, 1);
    const tmp<volVectorField> U(test.velocity({{"inlet", "fixedValue"}}));
    nodeBoundary boundary(grid, U(), nodeBoundary::slipCorners, {&zone});

    auto moving = [&]()
    {
        nodeField<nodeVector> v(grid.nNodes(), nodeVector{9, 9, 9, 9});
        boundary.constrain(v);
        label n = 0;
        for (label i = 0; i < grid.nNodes(); ++i) n += v[i][0] == 3;
        return n;
    };
    auto odd = [&]()
    {
        const label s =
            boundary.folding().stencil
            (
                grid.boxCell(zone.meshCells().front())
            );
        label n = 0;
        for (label t = 0; t < grid.reachSize(); ++t)
        {
            const nodeVector& sign = boundary.folding().signs(s)[t];
            n += sign[0] < 0 || sign[1] < 0;
        }
        return n;
    };

    const label closed = odd();
    atLeast("entries that mirror oddly while it is closed", closed, 4);
    equal("nodes that move", moving(), 0);

    boundary.setInflow(0, true, nodeVector{3, 0, 0, 0});
    equal("entries that mirror oddly while it is open", odd(), 0);
    equal("nodes that move: lines 0, 1, 2 of 6 rows", moving(), 18);

    boundary.setInflow(0, false, nodeVector{});
    equal("closed again: entries", odd(), closed);
    equal("nodes that move", moving(), 0);
}

// ************************************************************************* //
