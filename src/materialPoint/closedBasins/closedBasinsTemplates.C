/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

template<class Volume>
Foam::scalarList Foam::mpm::closedBasins::sums
(
    const std::vector<std::pair<label, label>>& nodeRanges,
    const Volume& volume,
    const std::vector<scalar>& inverseSpace,
    const scalar full
) const
{
    const label n = nNodes_.size();
    const std::vector<scalar>& inverseVolume = boundary_.inverseVolume();

    scalarList sums(3*n, Zero);
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
    return sums;
}

// ************************************************************************* //
