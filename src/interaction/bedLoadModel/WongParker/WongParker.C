/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "WongParker.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(WongParker, 0);
    addToRunTimeSelectionTable(bedLoadModel, WongParker, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::WongParker::WongParker
(
    const dictionary& coeffs,
    const bed& b
)
:
    bedLoadModel(coeffs, b, 0.0495)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::WongParker::transport
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
        q[i] = 3.97*excess*std::sqrt(excess);
    }
}

// ************************************************************************* //
