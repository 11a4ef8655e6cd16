/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "criticalState.H"
#include "dictionaryEntries.H"
#include "unitConversion.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::criticalState::criticalState
(
    const dictionary& coeffs,
    const granularElasticity& elasticity
)
:
    tanPhiC_
    (
        std::tan(degToRad(readBounded(coeffs, "phiC", dimless, 0, 90)))
    ),
    eRef_(readBounded(coeffs, "eRef", dimless, 0, 2.97)),
    logERef_(std::log(eRef_)),
    lambda_(readBounded(coeffs, "lambda", dimless, 0, GREAT, true)),
    xi_(readPositive(coeffs, "xi", dimless)),
    Ad_(readBounded(coeffs, "Ad", dimless, 0, GREAT, true)),
    kp_(readPositive(coeffs, "kp", dimless)),
    kpExponent_
    (
        readBoundedOrDefault
        (
            coeffs, "kpPressureExponent", dimless, 1 - elasticity.n(), 0, 1,
            true, true
        )
    ),
    kpExponentBelow_
    (
        kpExponent_ == 1 - elasticity.n()
      ? 1
      : kpExponent_/(1 - elasticity.n())
    ),
    pE_(min(elasticity.uncapped().pE, granularElasticity::pAt)),
    inversePE_(1/max(pE_, VSMALL)),
    kpRoot_
    (
        kpExponent_ == 0.5 && kpExponentBelow_ == 1
      ? kp_/std::sqrt(granularElasticity::pAt)
      : 0
    ),
    np_(readBounded(coeffs, "np", dimless, 0, GREAT, true)),
    nd_(readBounded(coeffs, "nd", dimless, 0, GREAT, true))
{
    warnUnusual
    (
        coeffs,
        {
            {"phiC", 20, 45, "glass beads to angular sands, in degrees"},
            {"eRef", 0.4, 1.5, "sands"},
            {"lambda", 0, 0.3, "sands"},
            {"xi", 0.2, 1, "sands"},
            {"Ad", 0.5, 1.5, "the paper's Table A1"},
            {"kp", 1e-4, 1e-2, "the paper's Table A1"},
            {"np", 0, 10, "sands"},
            {"nd", 0, 10, "sands"}
        }
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::criticalState::keywords()
{
    return wordList
    ({
        "phiC", "eRef", "lambda", "xi", "Ad", "kp", "kpPressureExponent", "np",
        "nd"
    });
}

// ************************************************************************* //
