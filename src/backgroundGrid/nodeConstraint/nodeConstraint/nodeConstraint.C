/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeConstraint.H"
#include "constrainedWallFvPatchVectorField.H"
#include "listed.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(nodeConstraint, 0);
    defineRunTimeSelectionTable(nodeConstraint, wall);
}
}


// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::nodeConstraint> Foam::mpm::nodeConstraint::New
(
    const backgroundGrid& grid,
    const wallPatches& patches
)
{
    const constrainedWallFvPatchVectorField& first = *patches[0];
    auto found = wallConstructorTablePtr_->cfind(first.constraint());

    if (!found.found())
    {
        FatalIOErrorInFunction(first.coeffs())
            << "patch " << first.patch().name()
            << ", keyword constraint: unknown constraint "
            << first.constraint() << nl << "    Valid names: "
            << listed(wallConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    return found()(grid, patches);
}

// ************************************************************************* //
