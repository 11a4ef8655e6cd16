/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "patchTypes.H"
#include "listed.H"
#include "localIOdictionary.H"
#include "volFields.H"

const Foam::wordList Foam::mpm::patchTypes::slip
({
    "slip", "symmetryPlane", "symmetry", "frictional", "smoothWall",
    "roughWall", "constrainedWall"
});
const Foam::wordList Foam::mpm::patchTypes::fixed({"noSlip", "fixedValue"});
const Foam::wordList Foam::mpm::patchTypes::open
({
    "zeroGradient", "inletOutlet"
});
const Foam::wordList Foam::mpm::patchTypes::other
({
    "cyclic", "empty", "processor", "processorCyclic"
});


// * * * * * * * * * * * * * * * Global Functions  * * * * * * * * * * * * * //

void Foam::mpm::patchTypes::refuse
(
    const fvPatchVectorField& Up,
    const string& reason
)
{
    const word& patch = Up.patch().name();
    const DimensionedField<vector, volMesh>& U = Up.internalField();
    const localIOdictionary file
    (
        IOobject
        (
            U.name(),
            U.instance(),
            U.db(),
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        ),
        volVectorField::typeName
    );
    FatalIOErrorInFunction(file.subDict("boundaryField").subDict(patch))
        << "patch " << patch << ", keyword type: " << Up.type() << ' '
        << reason.c_str() << '.' << nl << "    Allowed: " << listed(slip)
        << " (walls that slip, some with friction), "
        << listed(fixed) << " (walls that stick or move), "
        << listed(open) << " (openings), cyclic, empty"
        << exit(FatalIOError);
}

// ************************************************************************* //
