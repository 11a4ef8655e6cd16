/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "smoothWallFvPatchVectorField.H"
#include "addToRunTimeSelectionTable.H"
#include "fvPatchFieldMapper.H"
#include "volMesh.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(smoothWallFvPatchVectorField, 0);
    addToPatchFieldRunTimeSelection
    (
        fvPatchVectorField,
        smoothWallFvPatchVectorField
    );
}
}

// ************************************************************************* //
