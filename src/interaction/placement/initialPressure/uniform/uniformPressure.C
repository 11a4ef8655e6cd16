/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "uniformPressure.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(uniformPressure, 0);
    addToRunTimeSelectionTable(initialPressure, uniformPressure, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::uniformPressure::uniformPressure
(
    const dictionary& dict,
    const scene& s
)
:
    initialPressure(dict, s),
    p_(dict.lookupOrDefault<scalar>("p", 0))
{
    // Of no density and of the double
    const scalar least = s.water.fluid().pressure(scalar(GREAT));
    const scalar most = s.water.fluid().pressure(scalar(0.5));
    if (!(p_ > least && p_ < most))
    {
        FatalIOErrorInFunction(dict)
            << "keyword p of region " << dict.dictName() << " is "
            << p_ << " Pa, which the equation of state has not with"
            << " the speed of sound " << s.water.fluid().soundSpeed()
            << " m/s." << nl << "    Allowed: "
            << least << " < p < " << most << ", or a larger soundSpeed"
            << exit(FatalIOError);
    }
}

// ************************************************************************* //
