/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "wallShares.H"
#include "patchValues.H"
#include <map>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::wallShares::wallShares
(
    const wallNodes& walls,
    const List<cellSides::kind>& kindOfPatch
)
:
    kind_(kindOfPatch)
{
    const backgroundGrid& grid = walls.grid();

    // Patches of processors come last, and differ
    const label nPatches =
        returnReduce(label(kind_.size()), minOp<label>());
    std::map<label, std::vector<share>> shares;
    for (label patchi = 0; patchi < nPatches; ++patchi)
    {
        const bool wall = cellSides::isWall(kind_[patchi]);
        if (!returnReduce(wall, orOp<bool>())) continue;

        HashTable<scalar, label, Hash<label>> one;
        one.set(patchi, 1);
        const patchValues values(walls, one);
        for (label node = 0; node < grid.nNodes(); ++node)
        {
            for (label side = 0; side < 2*grid.nDim(); ++side)
            {
                const scalar n = values.number(node, side);
                if (n > 0) shares[key(node, side)].push_back({patchi, n});
            }
        }
    }
    for (const auto& s : shares)
    {
        places_[s.first] =
            {shares_.size(), shares_.size() + s.second.size()};
        shares_.insert(shares_.end(), s.second.begin(), s.second.end());
    }
}

// ************************************************************************* //
