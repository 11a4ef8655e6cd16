/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "Smagorinsky.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include "backgroundGrid.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(Smagorinsky, 0);
    addToRunTimeSelectionTable(turbulenceModel, Smagorinsky, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::Smagorinsky::Smagorinsky
(
    const dictionary& coeffs,
    const scene& s
)
:
    lengthSqr_(0)
{
    checkKeywords(coeffs, {"Ck", "Ce"}, s.strictKeywords);
    const scalar Ck =
        readBoundedOrDefault(coeffs, "Ck", dimless, 0.094, 0, GREAT);
    const scalar Ce =
        readBoundedOrDefault(coeffs, "Ce", dimless, 1.048, 0, GREAT);

    scalar volume = 1;
    const label nDim = s.grid.nDim();
    for (label d = 0; d < nDim; ++d) volume *= s.grid.cells().spacing(d);
    lengthSqr_ = Ck*std::sqrt(Ck/Ce)*std::pow(volume, 2.0/nDim);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::Smagorinsky::correct(const points& p, scalar* nut)
{
    for (label i = 0; i < p.n; ++i)
    {
        nut[i] += lengthSqr_*p.shearRate[i]*(p.porosity ? p.porosity[i] : 1);
    }
}


Foam::string Foam::mpm::Smagorinsky::description() const
{
    return "Smagorinsky, C_s Delta = " + name(std::sqrt(lengthSqr_)) + " m";
}

// ************************************************************************* //
