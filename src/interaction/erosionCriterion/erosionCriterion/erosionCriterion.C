/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "erosionCriterion.H"
#include "listed.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(erosionCriterion, 0);
    defineRunTimeSelectionTable(erosionCriterion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::erosionCriterion> Foam::mpm::erosionCriterion::New
(
    const word& name,
    const dictionary& dict,
    const bed& b
)
{
    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        FatalIOErrorInFunction(dict)
            << "keyword criteria: unknown erosion criterion " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    return found()(dict, b);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::erosionCriterion::shearVelocity() const
{
    return std::sqrt(shearStress()/bed_.rho);
}


Foam::scalar Foam::mpm::erosionCriterion::shieldsNumber() const
{
    return shearStress()/(bed_.rho*bed_.g*bed_.submerged()*bed_.d);
}


Foam::scalar Foam::mpm::erosionCriterion::streamPower() const
{
    return shearStress()*shearVelocity();
}

// ************************************************************************* //
