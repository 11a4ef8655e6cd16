/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "noDrag.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(noDrag, 0);
    addToRunTimeSelectionTable(dragModel, noDrag, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::noDrag::noDrag
(
    const medium& m,
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    dragModel(m)
{
    checkKeywords(coeffs, {}, strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::noDrag::coefficients
(
    const label n,
    const scalar*,
    const scalar*,
    scalar* a,
    scalar* b
) const
{
    std::fill(a, a + n, 0);
    std::fill(b, b + n, 0);
}

// ************************************************************************* //
