/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "functionPath.H"
#include "dictionaryEntries.H"
#include "unitConversion.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(functionPath, 0);
    addToRunTimeSelectionTable(bodyPath, functionPath, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::functionPath::functionPath
(
    const dictionary& dict,
    const lattice&,
    const bool strict
)
:
    centre_(dict.lookupOrDefault<point>("centre", Zero))
{
    checkKeywords
    (
        dict, {"type", "displacement", "rotation", "centre"}, strict
    );

    if (dict.found("displacement"))
    {
        displacement_ = Function1<vector>::New("displacement", dict);
    }
    if (dict.found("rotation"))
    {
        rotation_ = Function1<vector>::New("rotation", dict);
    }
    if (!displacement_.valid() && !rotation_.valid())
    {
        FatalIOErrorInFunction(dict)
            << "neither displacement nor rotation is given." << nl
            << "    Allowed: one of them or both, as functions of time, or type"
            << " fixed" << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::vector Foam::mpm::functionPath::displacement(const scalar time) const
{
    return displacement_.valid() ? displacement_->value(time) : vector(Zero);
}


Foam::vector Foam::mpm::functionPath::rotation(const scalar time) const
{
    return
        rotation_.valid() ? degToRad()*rotation_->value(time) : vector(Zero);
}

// ************************************************************************* //
