/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "MeyerPeterMueller.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(MeyerPeterMueller, 0);
    addToRunTimeSelectionTable(bedLoadModel, MeyerPeterMueller, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::MeyerPeterMueller::MeyerPeterMueller
(
    const dictionary& coeffs,
    const bed& b
)
:
    bedLoadModel(coeffs, b, 0.047)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::MeyerPeterMueller::transport
(
    const label n,
    const scalar* shields,
    const scalar* critical,
    scalar* q
) const
{
    for (label i = 0; i < n; ++i)
    {
        const scalar excess = max(shields[i] - critical[i], scalar(0));
        q[i] = 8*excess*std::sqrt(excess);
    }
}

// ************************************************************************* //
