/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "roughWallFvPatchVectorField.H"
#include "addToRunTimeSelectionTable.H"
#include "fvPatchFieldMapper.H"
#include "volMesh.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(roughWallFvPatchVectorField, 0);
    addToPatchFieldRunTimeSelection
    (
        fvPatchVectorField,
        roughWallFvPatchVectorField
    );
}
}

// ************************************************************************* //
