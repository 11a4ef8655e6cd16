/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "denseSuspension.H"
#include "dictionaryEntries.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::denseSuspension::denseSuspension
(
    const dictionary& coeffs,
    const scalar criticalFraction
)
:
    active_
    (
        readChoiceOrDefault
        (
            coeffs, "viscousFlow", "BoyerGuazzelliPouliquen",
            {"BoyerGuazzelliPouliquen", "none"}
        ) != "none"
    )
{
    if (!active_)
    {
        for (const char* other : {"PhiJ", "J0", "JMin"})
        {
            if (coeffs.found(other))
            {
                FatalIOErrorInFunction(coeffs)
                    << "keyword " << other << " beside viscousFlow none." << nl
                    << "    Allowed: without it, or viscousFlow"
                    << " BoyerGuazzelliPouliquen" << exit(FatalIOError);
            }
        }
        return;
    }
    muS_ = readPositive(coeffs, "muS", dimless);
    muD_ = readBounded(coeffs, "muD", dimless, muS_, GREAT, true);
    PhiJ_ = readBoundedOrDefault
    (
        coeffs, "PhiJ", dimless, criticalFraction, 0, 1
    );
    J0_ = readBoundedOrDefault(coeffs, "J0", dimless, 0.005, 0, GREAT);
    maxRatio_ = 1/std::sqrt
    (
        readBoundedOrDefault(coeffs, "JMin", dimless, 1e-4, 0, 1)
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::denseSuspension::keywords()
{
    return wordList({"viscousFlow", "PhiJ", "J0", "JMin"});
}

// ************************************************************************* //
