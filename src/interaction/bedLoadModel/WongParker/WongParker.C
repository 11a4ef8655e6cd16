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
    bedLoadModel(coeffs, b, 0.0495, 3.97)
{}

// ************************************************************************* //
