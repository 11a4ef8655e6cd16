/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "PstreamReduceOps.H"

template<class Volume>
Foam::scalarList Foam::mpm::closedBasins::excess
(
    const std::vector<std::pair<label, label>>& nodeRanges,
    const Volume& volume,
    const std::vector<scalar>& inverseSpace,
    const scalar full
)
{
    const label n = nNodes_.size();
    const std::vector<scalar>& inverseVolume = boundary_.inverseVolume();

    // Of each basin: volume of water, space for it, nodes that are full
    scalarField sums(3*n, Zero);
    for (const auto& range : nodeRanges)
    {
        for (label i = range.first; i < range.second; ++i)
        {
            const label basin = ofNode_[i];
            if (basin < 0) continue;

            const scalar share = grid_.share(i);
            const scalar water = volume(i);
            const scalar space = 1/inverseSpace[i];
            const scalar control = 1/inverseVolume[i];
            scalar* sum = sums.data() + 3*basin;
            sum[0] += share*water;
            sum[1] += share*space;
            sum[2] += water + control - space > full*control ? share : 0;
        }
    }
    reduce(sums, sumOp<scalarField>());

    scalarList result(n, Zero);
    boolList kept(n);
    for (label basin = 0; basin < n; ++basin)
    {
        const scalar* sum = sums.cdata() + 3*basin;
        if (mag(sum[2] - nNodes_[basin]) < 0.5)
        {
            result[basin] = (sum[0] - sum[1])/sum[0];
        }
        kept[basin] = sum[0] > nearlyFull*sum[1];
    }

    // Nothing enters or leaves: what is half full stays so
    if (!chosen_)
    {
        chosen_ = true;
        keep(kept);
        label next = 0;
        for (label basin = 0; basin < n; ++basin)
        {
            if (kept[basin]) result[next++] = result[basin];
        }
        result.setSize(next);
    }
    return result;
}

// ************************************************************************* //
