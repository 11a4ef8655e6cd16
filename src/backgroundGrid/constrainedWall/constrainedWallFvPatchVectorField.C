/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "constrainedWallFvPatchVectorField.H"
#include "addToRunTimeSelectionTable.H"
#include "fvPatchFieldMapper.H"
#include "volMesh.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(constrainedWallFvPatchVectorField, 0);
    addToPatchFieldRunTimeSelection
    (
        fvPatchVectorField,
        constrainedWallFvPatchVectorField
    );
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::constrainedWallFvPatchVectorField::constrainedWallFvPatchVectorField
(
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF
)
:
    slipFvPatchVectorField(p, iF)
{}


Foam::mpm::constrainedWallFvPatchVectorField::constrainedWallFvPatchVectorField
(
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF,
    const dictionary& dict
)
:
    constrainedWallFvPatchVectorField
    (
        p, iF, dict, dict.get<word>("constraint")
    )
{}


Foam::mpm::constrainedWallFvPatchVectorField::constrainedWallFvPatchVectorField
(
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF,
    const dictionary& dict,
    const word& constraint
)
:
    slipFvPatchVectorField(p, iF, dict),
    constraint_(constraint),
    coeffs_(dict)
{}


Foam::mpm::constrainedWallFvPatchVectorField::constrainedWallFvPatchVectorField
(
    const constrainedWallFvPatchVectorField& field,
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF,
    const fvPatchFieldMapper& mapper
)
:
    slipFvPatchVectorField(field, p, iF, mapper),
    constraint_(field.constraint_),
    coeffs_(field.coeffs_)
{}


Foam::mpm::constrainedWallFvPatchVectorField::constrainedWallFvPatchVectorField
(
    const constrainedWallFvPatchVectorField& field,
    const DimensionedField<vector, volMesh>& iF
)
:
    slipFvPatchVectorField(field, iF),
    constraint_(field.constraint_),
    coeffs_(field.coeffs_)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::constrainedWallFvPatchVectorField::write(Ostream& os) const
{
    slipFvPatchVectorField::write(os);
    for (const entry& e : coeffs_)
    {
        const keyType& key = e.keyword();
        if (key != "type" && key != "patchType" && key != "value") os << e;
    }

    // Who does not know the type, as decomposePar, asks for it
    writeEntry("value", os);
}

// ************************************************************************* //
