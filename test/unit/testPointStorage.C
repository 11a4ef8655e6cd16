/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "pointStorage.H"
#include "labelList.H"
#include <algorithm>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- Value of a column of the point with a number
scalar valueOf(const label number, const label column)
{
    return 1000*number + column + 0.25;
}

//- Storage of n points: each column and the cell tell which point it is
pointStorage numbered(const label nDim, const label n)
{
    pointStorage points(nDim);
    points.add("x", pointStorage::vectorValue);
    points.add("mass", pointStorage::scalarValue);
    points.add("C", pointStorage::tensorValue);
    points.resize(n);
    for (label p = 0; p < n; ++p)
    {
        for (label c = 0; c < points.nColumns(); ++c)
        {
            points.column(c)[p] = valueOf(p, c);
        }
        points.cell()[p] = 7*p;
    }
    return points;
}

//- Entries that do not belong to the points with these numbers
label wrongEntries
(
    const pointStorage& points,
    const std::vector<label>& numbers
)
{
    if (points.size() != label(numbers.size())) return -1;

    label wrong = 0;
    for (label p = 0; p < points.size(); ++p)
    {
        for (label c = 0; c < points.nColumns(); ++c)
        {
            wrong += points.column(c)[p] != valueOf(numbers[p], c);
        }
        wrong += points.cell()[p] != 7*numbers[p];
    }
    return wrong;
}

} // End anonymous namespace


TEST_CASE("pointStorage: fields and columns")
{
    for (const label nDim : {2, 3})
    {
        const pointStorage points(numbered(nDim, 3));
        equal("columns", points.nColumns(), nDim + 1 + nDim*nDim);
        equal("fields", label(points.fields().size()), 3);
        equal("first column of mass", points.fields()[1].first, nDim);
        equal("first column of C", points.fields()[2].first, nDim + 1);
        equal("columns of C", points.fields()[2].nColumns, nDim*nDim);
        equal("name of the third field", points.fields()[2].name, "C");
        equal("wrong entries", wrongEntries(points, {0, 1, 2}), 0);
    }

    // A field that is declared later is zero for the points that exist
    pointStorage points(numbered(2, 11));
    const label first = points.add("p", pointStorage::scalarValue);
    label nonZero = 0;
    for (label p = 0; p < points.size(); ++p)
    {
        nonZero += points.column(first)[p] != 0;
    }
    equal("values that are not zero", nonZero, 0);
    atLeast
    (
        "bytes per point", points.bytesPerPoint(),
        scalar((2 + 1 + 4 + 1)*sizeof(scalar) + sizeof(label))
    );
}


TEST_CASE("pointStorage: resize")
{
    pointStorage points(numbered(2, 5));
    points.resize(9);
    label nonZero = 0;
    for (label p = 5; p < 9; ++p)
    {
        for (label c = 0; c < points.nColumns(); ++c)
        {
            nonZero += points.column(c)[p] != 0;
        }
    }
    equal("size after growth", points.size(), 9);
    equal("values of new points that are not zero", nonZero, 0);

    points.resize(5);
    equal
    (
        "wrong entries of the old points",
        wrongEntries(points, {0, 1, 2, 3, 4}), 0
    );

    // What was cut off does not come back
    points.resize(2);
    points.resize(4);
    equal("mass of a point that is new again", label(points.column(2)[3]), 0);
}


TEST_CASE("pointStorage: reorder")
{
    for (const label n : {1, 2, 7, 64})
    {
        pointStorage points(numbered(3, n));
        std::vector<label> numbers(n);
        labelList order(n);
        for (label p = 0; p < n; ++p) numbers[p] = order[p] = (5*p + 3) % n;

        points.reorder(order);
        equal("wrong entries", wrongEntries(points, numbers), 0);

        // And back
        labelList back(n);
        std::vector<label> identity(n);
        for (label p = 0; p < n; ++p)
        {
            back[order[p]] = p;
            identity[p] = p;
        }
        points.reorder(back);
        equal
        (
            "wrong entries after the inverse", wrongEntries(points, identity), 0
        );
    }
}


TEST_CASE("pointStorage: remove")
{
    pointStorage points(numbered(2, 6));
    points.remove(1);
    equal("first removal", wrongEntries(points, {0, 5, 2, 3, 4}), 0);
    points.remove(4);
    equal("removal of the last", wrongEntries(points, {0, 5, 2, 3}), 0);
    points.remove(0);
    points.remove(0);
    points.remove(0);
    equal("three more", wrongEntries(points, {5}), 0);
    points.remove(0);
    equal("points left", points.size(), 0);
}


TEST_CASE("pointStorage: pack and append")
{
    // All points to another storage, from the back to the front, as between
    // ranks
    pointStorage from(numbered(3, 10));
    pointStorage to(numbered(3, 2));
    std::vector<scalar> buffer(from.nColumns());
    std::vector<label> numbers{0, 1};

    for (label p = 9; p >= 0; --p)
    {
        from.pack(p, buffer.data());
        to.append(buffer.data(), from.cell()[p]);
        from.remove(p);
        numbers.push_back(p);
    }
    equal("wrong entries", wrongEntries(to, numbers), 0);
    equal("points left behind", from.size(), 0);
}


TEST_CASE("pointStorage: points survive any sequence of changes")
{
    // Against a plain list of numbers
    pointStorage points(numbered(2, 20));
    std::vector<label> numbers(20);
    for (label p = 0; p < 20; ++p) numbers[p] = p;

    unsigned seed = 1;
    auto random = [&](const label n)
    {
        seed = 1103515245u*seed + 12345u;
        return label((seed >> 16) % n);
    };
    std::vector<scalar> buffer(points.nColumns());
    label wrong = 0, reached = 0;

    for (int step = 0; step < 500; ++step)
    {
        const label n = points.size();
        const label what = random(3);
        if (what == 0 && n > 1)
        {
            const label p = random(n);
            points.remove(p);
            numbers[p] = numbers.back();
            numbers.pop_back();
        }
        else if (what == 1)
        {
            const label p = random(n);
            points.pack(p, buffer.data());
            points.append(buffer.data(), points.cell()[p]);
            numbers.push_back(label(numbers[p]));
        }
        else
        {
            labelList order(n);
            std::vector<label> reordered(n);
            const label shift = random(n);
            for (label p = 0; p < n; ++p)
            {
                order[p] = (p + shift) % n;
                reordered[p] = numbers[order[p]];
            }
            points.reorder(order);
            numbers = reordered;
        }
        wrong += wrongEntries(points, numbers) != 0;
        reached = max(reached, points.size());
    }
    equal("steps with wrong entries", wrong, 0);
    atLeast("most points on the way", reached, 20);
}

// ************************************************************************* //
