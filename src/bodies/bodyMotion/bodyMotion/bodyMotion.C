/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodyMotion.H"
#include "dictionaryEntries.H"
#include "Time.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(bodyMotion, 0);
    defineRunTimeSelectionTable(bodyMotion, dictionary);
}
}

// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::tensor Foam::mpm::bodyMotion::rotationOf(const vector& angle)
{
    const scalar a = mag(angle);
    if (a < VSMALL) return I;

    // Rodrigues' formula
    const vector n(angle/a);
    const tensor cross(0, -n.z(), n.y(), n.z(), 0, -n.x(), -n.y(), n.x(), 0);
    return I + std::sin(a)*cross + (1 - std::cos(a))*(cross & cross);
}


Foam::vector Foam::mpm::bodyMotion::vectorOf(const tensor& rotation)
{
    // Twice the sine of the angle along the axis
    const vector axis
    (
        rotation.zy() - rotation.yz(),
        rotation.xz() - rotation.zx(),
        rotation.yx() - rotation.xy()
    );
    const scalar sine = 0.5*mag(axis);
    if (sine < VSMALL) return Zero;
    return std::atan2(sine, 0.5*(tr(rotation) - 1))/(2*sine)*axis;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bodyMotion::bodyMotion()
:
    reference_(Zero),
    centre_(Zero),
    rotation_(I),
    velocity_(Zero),
    angularVelocity_(Zero)
{}


Foam::autoPtr<Foam::mpm::bodyMotion> Foam::mpm::bodyMotion::New
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
{
    // Bodies that forces move have a library of their own, opened by those who
    // have such bodies: with OpenFOAM's sixDoFRigidBodyMotion come twenty
    // libraries, and every start would take 0.03 s longer
    const word asked(dict.lookupOrDefault<word>("type", word::null));
    if (!dictionaryConstructorTablePtr_->found(asked))
    {
        const_cast<Time&>(cells.mesh().time()).libs().open
            (fileName("libmpmRigidBodies.so"));
    }

    const word type
    (
        readChoice(dict, "type", dictionaryConstructorTablePtr_->sortedToc())
    );
    return dictionaryConstructorTablePtr_->cfind(type).val()
        (dict, cells, strict);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::bodyMotion::readState(const dictionary& dict)
{
    if (!moves()) return;
    centre_ = dict.get<point>("centre");
    rotation_ = dict.get<tensor>("rotation");
    velocity_ = dict.get<vector>("velocity");
    angularVelocity_ = dict.get<vector>("angularVelocity");
}


void Foam::mpm::bodyMotion::writeState(dictionary& dict) const
{
    if (!moves()) return;
    dict.set("centre", centre_);
    dict.set("rotation", rotation_);
    dict.set("velocity", velocity_);
    dict.set("angularVelocity", angularVelocity_);
}

// ************************************************************************* //
