/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cellSides.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::cellSides::cellSides
(
    const backgroundGrid& grid,
    const volVectorField& U,
    const List<kind>& ofPatch,
    const labelList& zoneOfCell
)
:
    grid_(grid),
    kind_(grid.mesh().nCells(), FixedList<kind, maxSides>(inner))
{
    const lattice& cells = grid.cells();

    forAll(ofPatch, patchi)
    {
        if (ofPatch[patchi] == inner) continue;

        const fvPatchVectorField& Up = U.boundaryField()[patchi];
        const labelUList& faceCells = Up.patch().faceCells();
        const vectorField n(Up.patch().nf());

        forAll(faceCells, i)
        {
            label d, s;
            cells.faceDirection(n[i], d, s);
            if (d < 0) continue;

            const label celli = faceCells[i];
            const label key = maxSides*celli + 2*d + s;
            kind_[celli][2*d + s] = ofPatch[patchi];
            patch_.set(key, patchi);

            if (ofPatch[patchi] == fixedWall)
            {
                const bool atRest =
                    !zoneOfCell.empty() && zoneOfCell[celli] >= 0;
                nodeVector value{};
                for (label k = 0; !atRest && k < grid.nDim(); ++k)
                {
                    value[k] = Up[i][cells.axis(k)];
                }
                velocity_.set(key, value);
            }
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::HashTable<Foam::label, Foam::label, Foam::Hash<Foam::label>>
Foam::mpm::cellSides::beyondOpenings() const
{
    HashTable<label, label, Hash<label>> beyond;
    forAllConstIters(patch_, iter)
    {
        const label celli = iter.key()/maxSides;
        const label side = iter.key() % maxSides;
        if (kind_[celli][side] != open) continue;
        beyond.set
        (
            grid_.boxCell(celli)
          + (side % 2 ? 1 : -1)*grid_.stride(side/2),
            iter.val()
        );
    }
    return beyond;
}

// ************************************************************************* //
