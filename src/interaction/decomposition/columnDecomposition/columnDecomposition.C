/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "columnDecomposition.H"
#include "SubList.H"
#include "DynamicList.H"

namespace Foam
{

//- Part of the work of each cloud before each column of a list, 0 .. 1
static List<scalarList> partsBefore
(
    const List<scalarList>& work,
    const labelUList& columns
)
{
    DynamicList<scalarList> parts;
    for (const scalarList& w : work)
    {
        scalarList before(columns.size() + 1, Zero);
        forAll(columns, i) before[i + 1] = before[i] + w[columns[i]];

        const scalar total = before.last();
        if (!(total > 0)) continue;
        for (scalar& b : before) b /= total;
        parts.append(before);
    }
    if (parts.empty())
    {
        // Nothing there yet: all columns count the same
        scalarList before(columns.size() + 1);
        forAll(before, i) before[i] = scalar(i)/columns.size();
        parts.append(before);
    }
    return List<scalarList>(parts);
}


//- Give the columns to ranks first .. first + n - 1
static void share
(
    const List<scalarList>& work,
    const labelUList& columns,
    const label first,
    const label n,
    labelList& rank
)
{
    if (n == 1)
    {
        for (const label c : columns) rank[c] = first;
        return;
    }

    // The interval that holds this part of each cloud, or is next to it. The
    // first of equals, which has the fewest cuts.
    const label nInside = n/2;
    const scalar wanted = scalar(nInside)/n;
    const List<scalarList> parts(partsBefore(work, columns));

    label begin = 0, end = 0;
    scalar least = GREAT;
    forAll(columns, b)
    {
        // No rank without a column
        const label most = columns.size() - (n - nInside);
        for (label e = b + nInside; e <= min(b + most, columns.size()); ++e)
        {
            scalar miss = 0;
            for (const scalarList& before : parts)
            {
                miss = max(miss, mag(before[e] - before[b] - wanted));
            }
            // Not for what rounding decides
            if (miss < least - 1e-9)
            {
                least = miss;
                begin = b;
                end = e;
            }
        }
    }

    const SubList<label> inside(columns, end - begin, begin);
    labelList outside(columns.size() - inside.size());
    label k = 0;
    forAll(columns, i)
    {
        if (i < begin || i >= end) outside[k++] = columns[i];
    }
    share(work, inside, first, nInside, rank);
    share(work, outside, first + nInside, n - nInside, rank);
}

} // End namespace Foam


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

Foam::labelList Foam::mpm::shareColumns
(
    const List<scalarList>& work,
    const label nRanks
)
{
    const label n = work.size() ? work[0].size() : 0;
    labelList rank(n, Zero);
    share(work, identity(n), 0, nRanks, rank);
    return rank;
}

// ************************************************************************* //
