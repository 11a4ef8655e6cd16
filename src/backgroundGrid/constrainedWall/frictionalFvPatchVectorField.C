/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "frictionalFvPatchVectorField.H"
#include "addToRunTimeSelectionTable.H"
#include "fvPatchFieldMapper.H"
#include "volMesh.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(frictionalFvPatchVectorField, 0);
    addToPatchFieldRunTimeSelection
    (
        fvPatchVectorField,
        frictionalFvPatchVectorField
    );
}
}

// ************************************************************************* //
