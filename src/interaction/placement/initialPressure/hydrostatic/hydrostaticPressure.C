/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "hydrostaticPressure.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(hydrostaticPressure, 0);
    addToRunTimeSelectionTable(initialPressure, hydrostaticPressure, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::hydrostaticPressure::hydrostaticPressure
(
    const dictionary& dict,
    const scene& s
)
:
    initialPressure(dict, s)
{
    // Below the noise of the pressure then, which is some thousandths
    const scalar highest = s.top + 100*(s.top - s.bottom);
    if (!(s.level <= highest))
    {
        FatalIOErrorInFunction(dict)
            << "keyword level of region " << dict.dictName() << " is "
            << s.level << ", more than 100 times the height of the mesh"
            << " above it: nothing is left of the differences of pressure"
            << " inside." << nl << "    Allowed: level <= " << highest
            << ", or pressure uniform" << exit(FatalIOError);
    }
    if (s.level > s.top + (s.top - s.bottom))
    {
        IOWarningInFunction(dict)
            << "keyword level of region " << dict.dictName() << " is "
            << s.level << ", far above the mesh, which ends at " << s.top
            << '.' << nl << "    The water starts under the pressure of "
            << s.level - s.top << " m of water on top" << nl
            << endl;
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::hydrostaticPressure::pressure(const point& x) const
{
    return scene_.water.fluid().hydrostaticPressure
    (
        scene_.g*max(scalar(0), scene_.level - (scene_.up & x))
    );
}

// ************************************************************************* //
