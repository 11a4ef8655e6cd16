/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "wallDistance.H"
#include "constrainedWallFvPatchVectorField.H"
#include "patchWave.H"
#include "patchTypes.H"
#include "gaussGrad.H"
#include "calculatedFvPatchFields.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::wallDistance::wallDistance
(
    const backgroundGrid& grid,
    const volVectorField& U
)
:
    grid_(grid),
    distance_(grid.mesh().nCells(), GREAT),
    gradient_(grid.mesh().nCells(), Zero),
    roughness_(grid.mesh().nCells(), Zero),
    any_(false)
{
    const fvMesh& mesh = U.mesh();

    // By roughness: the nearest of all keeps its own
    HashTable<labelHashSet, scalar, Hash<scalar>> patches;
    forAll(U.boundaryField(), patchi)
    {
        const fvPatchVectorField& Up = U.boundaryField()[patchi];
        if (patchTypes::fixed.found(Up.type()))
        {
            patches(0).insert(patchi);
        }
        else if (isA<constrainedWallFvPatchVectorField>(Up))
        {
            const auto& wall =
                refCast<const constrainedWallFvPatchVectorField>(Up);
            if (wall.constraint() != "wallStress") continue;
            patches
            (
                wall.coeffs().lookupOrDefault<scalar>("ks", 0)
            ).insert(patchi);
        }
    }
    any_ = patches.size() > 0;

    labelHashSet walls;
    for (const scalar ks : patches.sortedToc())
    {
        walls |= patches[ks];
        const patchWave wave(mesh, patches[ks], false);
        forAll(distance_, celli)
        {
            if (wave.distance()[celli] < distance_[celli])
            {
                distance_[celli] = wave.distance()[celli];
                roughness_[celli] = ks;
            }
        }
    }
    if (!any_) return;

    // Zero on the walls, as in the cell on what is none
    volScalarField y
    (
        IOobject("wallDistance", mesh.time().timeName(), mesh),
        mesh,
        dimensionedScalar(dimLength, Zero)
    );
    y.primitiveFieldRef() = distance_;
    forAll(y.boundaryFieldRef(), patchi)
    {
        fvPatchScalarField& yp = y.boundaryFieldRef()[patchi];
        if (yp.coupled()) continue;
        if (walls.found(patchi)) yp == 0;
        else yp == scalarField(yp.patchInternalField());
    }
    for (fvPatchScalarField& yp : y.boundaryFieldRef())
    {
        if (yp.coupled()) yp.initEvaluate(Pstream::commsTypes::blocking);
    }
    for (fvPatchScalarField& yp : y.boundaryFieldRef())
    {
        if (yp.coupled()) yp.evaluate(Pstream::commsTypes::blocking);
    }
    gradient_ = fv::gaussGrad<scalar>(mesh).grad(y)().primitiveField();

    // Where walls meet, and half-way between them, it is shorter
    for (vector& g : gradient_)
    {
        if (mag(g) > 1) g /= mag(g);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::wallDistance::distance
(
    const label cell,
    const scalar (&x)[3]
) const
{
    const label celli = grid_.meshCell(cell);
    if (celli < 0) return GREAT;

    const point& centre = grid_.mesh().cellCentres()[celli];
    scalar y = distance_[celli];
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        const label axis = grid_.cells().axis(d);
        y += gradient_[celli][axis]*(x[d] - centre[axis]);
    }
    return max(y, 0.01*grid_.cells().minSpacing());
}


Foam::scalar Foam::mpm::wallDistance::roughness(const label cell) const
{
    const label celli = grid_.meshCell(cell);
    return celli < 0 ? 0 : roughness_[celli];
}

// ************************************************************************* //
