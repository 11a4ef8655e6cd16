/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "prescribedBody.H"
#include "dictionaryEntries.H"
#include "unitConversion.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(prescribedBody, 0);
    addToRunTimeSelectionTable(bodyMotion, prescribedBody, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::tensor Foam::mpm::prescribedBody::rotationAt(const scalar time) const
{
    return rotationOf(path_->rotation(time));
}


void Foam::mpm::prescribedBody::checkPlane(const scalar time) const
{
    if (empty_ < 0) return;

    const vector way(path_->displacement(time));
    vector tilt(path_->rotation(time));
    tilt[empty_] = 0;
    if (way[empty_] != 0)
    {
        FatalIOErrorInFunction(dict_)
            << "the displacement is " << way << " m at " << time
            << " s, out of the plane of the case." << nl
            << "    Allowed: 0 in direction " << vector::componentNames[empty_]
            << exit(FatalIOError);
    }
    if (mag(tilt) > 0)
    {
        FatalIOErrorInFunction(dict_)
            << "the rotation is " << radToDeg()*path_->rotation(time)
            << " degrees at " << time << " s, not about the normal of the"
            << " case's plane." << nl
            << "    Allowed: direction " << vector::componentNames[empty_]
            << " only" << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::prescribedBody::prescribedBody
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
:
    dict_(subDictOf(dict, "motion")),
    empty_(cells.nDim() < 3 ? cells.axis(2) : -1),
    path_(bodyPath::New(dict_, cells, strict))
{
    reference_ = path_->centre();
    centre_ = reference_;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::point Foam::mpm::prescribedBody::centreAt(const scalar time) const
{
    return reference_ + path_->displacement(time);
}


void Foam::mpm::prescribedBody::start(const scalar time)
{
    checkPlane(time);
    centre_ = centreAt(time);
    rotation_ = rotationAt(time);

    // As fast as it is going to be
    const scalar soon = 1e-6;
    findVelocity(time + soon, soon);
}


void Foam::mpm::prescribedBody::findVelocity
(
    const scalar time,
    const scalar deltaT
)
{
    checkPlane(time);
    velocity_ = (centreAt(time) - centre_)/deltaT;
    angularVelocity_ = vectorOf(rotationAt(time) & rotation_.T())/deltaT;
}


void Foam::mpm::prescribedBody::move(const scalar time, const scalar)
{
    centre_ = centreAt(time);
    rotation_ = rotationAt(time);
}

// ************************************************************************* //
