/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "kEpsilon.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(kEpsilon, 0);
    addToRunTimeSelectionTable(turbulenceModel, kEpsilon, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::kEpsilon::kEpsilon
(
    const dictionary& coeffs,
    const scene& s
)
:
    // Launder and Spalding's
    twoEquation(coeffs, s, {0.09, 1.92, 1.0, 1.3}, {"C1"}),
    C1_(readBoundedOrDefault(coeffs, "C1", dimless, 1.44, 0, 10))
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::kEpsilon::correct(const points& p, scalar* nut)
{
    advance(*this, p, nut);
}

// ************************************************************************* //
