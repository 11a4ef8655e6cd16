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

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::frictionalFvPatchVectorField::frictionalFvPatchVectorField
(
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF
)
:
    slipFvPatchVectorField(p, iF),
    coefficient_(0)
{}


Foam::mpm::frictionalFvPatchVectorField::frictionalFvPatchVectorField
(
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF,
    const dictionary& dict
)
:
    slipFvPatchVectorField(p, iF, dict),
    coefficient_(dict.get<scalar>("frictionCoefficient"))
{
    if (!(coefficient_ >= 0))
    {
        FatalIOErrorInFunction(dict)
            << "patch " << p.name() << ", keyword frictionCoefficient is "
            << coefficient_ << '.' << nl << "    Allowed: >= 0"
            << exit(FatalIOError);
    }
    if (coefficient_ > 1.2)
    {
        IOWarningInFunction(dict)
            << "patch " << p.name() << ", keyword frictionCoefficient has the"
            << " value " << coefficient_ << '.' << nl
            << "    Usual, the tangent of an angle: 0 <= frictionCoefficient"
            << " <= 1.2" << nl << endl;
    }
}


Foam::mpm::frictionalFvPatchVectorField::frictionalFvPatchVectorField
(
    const frictionalFvPatchVectorField& field,
    const fvPatch& p,
    const DimensionedField<vector, volMesh>& iF,
    const fvPatchFieldMapper& mapper
)
:
    slipFvPatchVectorField(field, p, iF, mapper),
    coefficient_(field.coefficient_)
{}


Foam::mpm::frictionalFvPatchVectorField::frictionalFvPatchVectorField
(
    const frictionalFvPatchVectorField& field,
    const DimensionedField<vector, volMesh>& iF
)
:
    slipFvPatchVectorField(field, iF),
    coefficient_(field.coefficient_)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::frictionalFvPatchVectorField::write(Ostream& os) const
{
    slipFvPatchVectorField::write(os);
    os.writeEntry("frictionCoefficient", coefficient_);
}

// ************************************************************************* //
