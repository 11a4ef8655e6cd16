/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "twoEquation.H"
#include "dictionaryEntries.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::twoEquation::twoEquation
(
    const dictionary& coeffs,
    const scene& s,
    const coefficients& defaults,
    const wordList& keywords
)
:
    grid_(s.grid),
    storage_(s.storage),
    kIn_(readPositive(coeffs, "k", sqr(dimVelocity))),
    epsilonIn_(readPositive(coeffs, "epsilon", sqr(dimVelocity)/dimTime)),
    Cmu_(readBoundedOrDefault(coeffs, "Cmu", dimless, defaults.Cmu, 0, 1)),
    C2_(readBoundedOrDefault(coeffs, "C2", dimless, defaults.C2, 0, 10)),
    sigmak_
    (
        readBoundedOrDefault(coeffs, "sigmak", dimless, defaults.sigmak, 0, 10)
    ),
    sigmaEps_
    (
        readBoundedOrDefault
            (coeffs, "sigmaEps", dimless, defaults.sigmaEps, 0, 10)
    ),
    bedRoughness_
    (
        readBoundedOrDefault(coeffs, "bedRoughness", dimless, 2.5, 0, GREAT)
    ),
    walls_(s.grid, s.U),
    k_(storage_.add("k", pointStorage::scalarValue)),
    epsilon_(storage_.add("epsilon", pointStorage::scalarValue))
{
    wordList all
    {
        "k", "epsilon", "Cmu", "C2", "sigmak", "sigmaEps", "bedRoughness"
    };
    all.append(keywords);
    checkKeywords(coeffs, all, s.strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::twoEquation::setEntered(const label first, const label last)
{
    for (label i = first; i < last; ++i)
    {
        storage_.column(k_)[i] = kIn_;
        storage_.column(epsilon_)[i] = epsilonIn_;
    }
}


Foam::string Foam::mpm::twoEquation::description() const
{
    return
        type() + ", points start with k " + name(kIn_) + " m2/s2, epsilon "
      + name(epsilonIn_) + " m2/s3";
}

// ************************************************************************* //
