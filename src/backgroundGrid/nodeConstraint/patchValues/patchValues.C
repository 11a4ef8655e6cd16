/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "patchValues.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::patchValues::patchValues
(
    const wallNodes& walls,
    const HashTable<scalar, label, Hash<label>>& ofPatch
)
:
    sum_(walls.grid().nNodes(), packed<8>{}),
    number_(walls.grid().nNodes(), packed<8>{})
{
    walls.sides().forWallNodes
    (
        [&](const label celli, const label side, const label node)
        {
            const auto found = ofPatch.cfind(walls.sides().patch(celli, side));
            if (found.found())
            {
                sum_[node][side] += found.val();
                number_[node][side] += 1;
            }
        }
    );
    walls.grid().exchange().sum(sum_);
    walls.grid().exchange().sum(number_);
    walls.grid().copyToSeconds(sum_);
    walls.grid().copyToSeconds(number_);
}

// ************************************************************************* //
