/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "Shields.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(Shields, 0);
    addToRunTimeSelectionTable(erosionCriterion, Shields, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::Shields::Shields(const dictionary&, const bed& b)
:
    erosionCriterion(b)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::Shields::shearStress() const
{
    return stressPerMillimetre*1e3*bed_.d;
}

// ************************************************************************* //
