/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "UIPstream.H"
#include "UOPstream.H"
#include <type_traits>

template<class Op>
void Foam::mpm::neighbourRanks::forShared(const label r, const Op& op) const
{
    const box& other = boxes_[r];
    const index3& n = own_.second();
    const index3& m = other.second();

    index3 firstImage, lastImage, w;
    images(other, firstImage, lastImage);
    for (w[2] = firstImage[2]; w[2] <= lastImage[2]; ++w[2])
    for (w[1] = firstImage[1]; w[1] <= lastImage[1]; ++w[1])
    for (w[0] = firstImage[0]; w[0] <= lastImage[0]; ++w[0])
    {
        // First cell of the moved box as seen from the own one
        index3 at, first, last;
        for (label d = 0; d < 3; ++d)
        {
            at[d] = other.first()[d] + w[d]*period_[d] - own_.first()[d];
            first[d] = max(label(0), at[d]);
            last[d] = min(n[d], at[d] + m[d]);
        }
        for (label k = first[2]; k < last[2]; ++k)
        for (label j = first[1]; j < last[1]; ++j)
        {
            const label mine = n[0]*(j + n[1]*k);
            const label theirs = m[0]*(j - at[1] + m[1]*(k - at[2])) - at[0];
            for (label i = first[0]; i < last[0]; ++i) op(mine + i, theirs + i);
        }
    }
}


template<class T>
Foam::List<Foam::List<T>> Foam::mpm::neighbourRanks::exchange
(
    const UList<DynamicList<T>>& to
) const
{
    static_assert(std::is_trivially_copyable<T>::value, "sent as bytes");

    List<List<T>> from(size());
    labelList nTo(size()), nFrom(size(), Zero);

    // How many, then the lists that are not empty
    for (const bool lists : {false, true})
    {
        const label firstRequest = UPstream::nRequests();
        forAll(ranks_, r)
        {
            if (ranks_[r] == UPstream::myProcNo())
            {
                if (lists) from[r] = to[r];
                continue;
            }
            if (lists) from[r].resize(nFrom[r]);
            else nTo[r] = to[r].size();

            if (!lists || nFrom[r])
            {
                UIPstream::read
                (
                    UPstream::commsTypes::nonBlocking,
                    ranks_[r],
                    lists
                  ? reinterpret_cast<char*>(from[r].data())
                  : reinterpret_cast<char*>(&nFrom[r]),
                    lists ? nFrom[r]*sizeof(T) : sizeof(label)
                );
            }
            if (!lists || nTo[r])
            {
                UOPstream::write
                (
                    UPstream::commsTypes::nonBlocking,
                    ranks_[r],
                    lists
                  ? reinterpret_cast<const char*>(to[r].cdata())
                  : reinterpret_cast<const char*>(&nTo[r]),
                    lists ? nTo[r]*sizeof(T) : sizeof(label)
                );
            }
        }
        UPstream::waitRequests(firstRequest);
    }
    return from;
}

// ************************************************************************* //
