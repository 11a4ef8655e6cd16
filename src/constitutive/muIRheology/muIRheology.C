/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "muIRheology.H"
#include "dictionaryEntries.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::muIRheology::muIRheology
(
    const dictionary& coeffs,
    const scalar rhoS,
    const scalar d,
    const bool dispersive
)
:
    rhoS_(rhoS),
    d_(d),
    I0_(readBoundedOrDefault(coeffs, "I0", dimless, 0.28, 0, GREAT)),
    muS_(readPositive(coeffs, "muS", dimless)),
    muD_(readBounded(coeffs, "muD", dimless, muS_, GREAT, true))
{
    if (dispersive)
    {
        PhiMax_ = readBoundedOrDefault
        (
            coeffs, "PhiMax", dimless, 0.65, 0, 1
        );
        PhiC_ = readBounded(coeffs, "PhiC", dimless, PhiMax_, 1, false, true);
        factor_ =
            2*d*readPositive(coeffs, "dPhi", dimless)*std::sqrt(rhoS);
    }
    warnUnusual
    (
        coeffs,
        {
            {"I0", 1e-3, 1, "grains"},
            {"muS", 0.2, 1.2, "grains, the tangent of an angle"},
            {"muD", 0.2, 1.5, "grains, the tangent of an angle"},
            {"PhiC", 0.5, 0.8, "packings of grains"},
            {"dPhi", 0.01, 1, "grains"}
        }
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::muIRheology::keywords(const bool dispersive)
{
    wordList names({"I0", "muS", "muD"});
    if (dispersive) names.append(wordList({"PhiC", "dPhi", "PhiMax"}));
    return names;
}

// ************************************************************************* //
