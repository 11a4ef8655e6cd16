/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "noBedLoad.H"
#include "addToRunTimeSelectionTable.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(noBedLoad, 0);
    addToRunTimeSelectionTable(bedLoadModel, noBedLoad, dictionary);
}
}

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::noBedLoad::transport
(
    const label n,
    const scalar*,
    const scalar*,
    scalar* q
) const
{
    std::fill(q, q + n, 0);
}

// ************************************************************************* //
