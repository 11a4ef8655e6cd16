/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "neighbourRanks.H"
#include "Pstream.H"
#include <algorithm>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

bool Foam::mpm::neighbourRanks::images
(
    const box& other,
    index3& first,
    index3& last
) const
{
    auto roundedDown = [](const label a, const label n)
    {
        return a >= 0 ? a/n : -((n - 1 - a)/n);
    };

    for (label d = 0; d < 3; ++d)
    {
        // Moved by that much it still meets the own one
        const label least =
            own_.first()[d] - other.first()[d] - other.second()[d] + 1;
        const label most =
            own_.first()[d] - other.first()[d] + own_.second()[d] - 1;

        const label n = period_[d];
        first[d] = n ? -roundedDown(-least, n) : 0;
        last[d] = n ? roundedDown(most, n) : 0;
        if (n ? first[d] > last[d] : least > 0 || most < 0) return false;
    }
    return true;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::neighbourRanks::neighbourRanks
(
    const lattice& cells,
    const index3& lower,
    const index3& size
)
:
    own_(lower, size)
{
    for (label d = 0; d < 3; ++d)
    {
        const bool cyclic = d < cells.nDim() && cells.periodic(d);
        period_[d] = cyclic ? cells.nCells(d) : 0;
    }

    List<box> all(Pstream::nProcs());
    all[Pstream::myProcNo()] = own_;
    Pstream::gatherList(all);
    Pstream::scatterList(all);

    DynamicList<label> ranks;
    DynamicList<box> boxes;
    index3 first, last;
    forAll(all, rank)
    {
        if (!images(all[rank], first, last)) continue;
        ranks.append(rank);
        boxes.append(all[rank]);
    }
    ranks_.transfer(ranks);
    boxes_.transfer(boxes);
}


Foam::mpm::neighbourRanks::neighbourRanks(const labelUList& ranks)
:
    ranks_(ranks)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::mpm::neighbourRanks::place(const label rank) const
{
    const label* found = std::lower_bound(ranks_.begin(), ranks_.end(), rank);
    return
        found != ranks_.end() && *found == rank
      ? label(found - ranks_.begin())
      : -1;
}

// ************************************************************************* //
