/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "mixingLength.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(mixingLength, 0);
    addToRunTimeSelectionTable(turbulenceModel, mixingLength, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::mixingLength::mixingLength
(
    const dictionary& coeffs,
    const scene& s
)
:
    kappa_(readBoundedOrDefault(coeffs, "kappa", dimless, 0.41, 0, 1)),
    maxLength_
    (
        readBoundedOrDefault
        (
            coeffs, "maxLength", dimLength, GREAT, 0, GREAT, false, true
        )
    ),
    walls_(s.grid, s.U)
{
    checkKeywords(coeffs, {"kappa", "maxLength"}, s.strictKeywords);
    if (!walls_.any())
    {
        FatalErrorInFunction
            << "turbulence mixingLength needs walls that have a stress, and the"
            << " velocity of the cloud has none." << nl
            << "    Allowed: at least one patch of type smoothWall, roughWall,"
            << " noSlip or fixedValue; or turbulence Smagorinsky"
            << exit(FatalError);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::mixingLength::correct(const points& p, scalar* nut)
{
    for (label i = 0; i < p.n; ++i)
    {
        const scalar x[3] = {p.x[0][i], p.x[1][i], p.x[2] ? p.x[2][i] : 0};
        const scalar l = min
        (
            maxLength_,
            kappa_
           *(
                walls_.distance(p.cell[i], x)
              + walls_.roughness(p.cell[i])/30
            )
        );
        nut[i] += sqr(l)*p.shearRate[i];
    }
}


Foam::string Foam::mpm::mixingLength::description() const
{
    return
        "mixingLength, at most "
      + (maxLength_ < GREAT ? name(maxLength_) + " m" : word("as walls allow"));
}

// ************************************************************************* //
