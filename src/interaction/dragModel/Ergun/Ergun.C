/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "Ergun.H"
#include "dictionaryEntries.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::Ergun::Ergun
(
    const medium& m,
    const dictionary& coeffs,
    const bool strictKeywords,
    const wordList& further
)
:
    dragModel(m),
    viscous_
    (
        readBoundedOrDefault(coeffs, "viscous", dimless, 150, 0, GREAT, true)
    ),
    inertial_
    (
        readBoundedOrDefault(coeffs, "inertial", dimless, 1.75, 0, GREAT, true)
    )
{
    wordList known({"viscous", "inertial"});
    known.append(further);
    checkKeywords(coeffs, known, strictKeywords);
}

// ************************************************************************* //
