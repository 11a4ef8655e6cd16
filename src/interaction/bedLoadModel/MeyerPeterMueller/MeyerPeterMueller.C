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
    bedLoadModel(coeffs, b, 0.047, 8)
{}

// ************************************************************************* //
