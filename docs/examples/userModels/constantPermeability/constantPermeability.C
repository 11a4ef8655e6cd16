/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "constantPermeability.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(constantPermeability, 0);
    addToRunTimeSelectionTable(dragModel, constantPermeability, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::constantPermeability::constantPermeability
(
    const medium& m,
    const dictionary& coeffs,
    const bool strictKeywords
)
:
    dragModel(m)
{
    checkKeywords(coeffs, {"kappa"}, strictKeywords);
    kappa_ = readPositive(coeffs, "kappa", dimArea);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::constantPermeability::coefficients
(
    const label n,
    const scalar* solidFraction,
    const scalar*,
    scalar* a,
    scalar* b
) const
{
    for (label i = 0; i < n; ++i)
    {
        a[i] = sqr(1 - solidFraction[i])*medium_.mu/kappa_;
        b[i] = 0;
    }
}

// ************************************************************************* //
