/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "kEpsilon.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(kEpsilon, 0);
    addToRunTimeSelectionTable(turbulenceModel, kEpsilon, dictionary);

    // Launder and Spalding's
    static constexpr kEpsilon::coefficients standard{0.09, 1.44, 1.92, 1.0, 1.3};
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::kEpsilon::kEpsilon
(
    const dictionary& coeffs,
    const backgroundGrid& grid,
    const volVectorField& U,
    pointStorage& storage,
    const bool strictKeywords
)
:
    kEpsilon(coeffs, grid, U, storage, strictKeywords, standard, {"C1"})
{}


Foam::mpm::kEpsilon::kEpsilon
(
    const dictionary& coeffs,
    const backgroundGrid& grid,
    const volVectorField& U,
    pointStorage& storage,
    const bool strictKeywords,
    const coefficients& defaults,
    const wordList& keywords
)
:
    grid_(grid),
    storage_(storage),
    kIn_(readPositive(coeffs, "k", sqr(dimVelocity))),
    epsilonIn_(readPositive(coeffs, "epsilon", sqr(dimVelocity)/dimTime)),
    Cmu_(readBoundedOrDefault(coeffs, "Cmu", dimless, defaults.Cmu, 0, 1)),
    C1_(readBoundedOrDefault(coeffs, "C1", dimless, defaults.C1, 0, 10)),
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
    walls_(grid, U),
    k_(storage.add("k", pointStorage::scalarValue)),
    epsilon_(storage.add("epsilon", pointStorage::scalarValue))
{
    wordList all
    {
        "k", "epsilon", "Cmu", "C2", "sigmak", "sigmaEps", "bedRoughness"
    };
    all.append(keywords);
    checkKeywords(coeffs, all, strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::kEpsilon::correct
(
    const scalar deltaT,
    const scalar nu,
    const points& p,
    cloudKernels& kernels,
    scalar* nut
)
{
    advance(*this, deltaT, nu, p, kernels, nut);
}


void Foam::mpm::kEpsilon::setEntered(const label first, const label last)
{
    for (label i = first; i < last; ++i)
    {
        storage_.column(k_)[i] = kIn_;
        storage_.column(epsilon_)[i] = epsilonIn_;
    }
}


Foam::string Foam::mpm::kEpsilon::description() const
{
    return
        type() + ", points start with k " + name(kIn_) + " m2/s2, epsilon "
      + name(epsilonIn_) + " m2/s3";
}

// ************************************************************************* //
