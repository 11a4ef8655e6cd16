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

Foam::point Foam::mpm::prescribedBody::centreAt(const scalar time) const
{
    return displacement_.valid()
      ? reference_ + displacement_->value(time) : reference_;
}


Foam::tensor Foam::mpm::prescribedBody::rotationAt(const scalar time) const
{
    return turn_.valid() ? rotationOf(degToRad()*turn_->value(time)) : tensor(I);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::prescribedBody::prescribedBody
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
{
    const dictionary& motion = subDictOf(dict, "motion");
    checkKeywords(motion, {"displacement", "rotation", "centre"}, strict);

    if (motion.found("displacement"))
    {
        displacement_ = Function1<vector>::New("displacement", motion);
    }
    if (motion.found("rotation"))
    {
        turn_ = Function1<vector>::New("rotation", motion);
    }
    if (!displacement_.valid() && !turn_.valid())
    {
        FatalIOErrorInFunction(motion)
            << "neither displacement nor rotation is given." << nl
            << "    Allowed: one of them or both, as functions of time, or type"
            << " fixed" << exit(FatalIOError);
    }
    reference_ = motion.lookupOrDefault<point>("centre", Zero);
    centre_ = reference_;

    if (cells.nDim() < 3)
    {
        // What would leave the plane would be projected, unseen
        const label empty = cells.axis(2);
        for (const scalar t : {0.0, 0.371, 1.93, 7.7})
        {
            if (displacement_.valid() && displacement_->value(t)[empty] != 0)
            {
                FatalIOErrorInFunction(motion)
                    << "keyword displacement is " << displacement_->value(t)
                    << " m at " << t << " s, out of the plane of the case."
                    << nl << "    Allowed: 0 in component " << empty
                    << exit(FatalIOError);
            }
            if (turn_.valid())
            {
                vector out(turn_->value(t));
                out[empty] = 0;
                if (mag(out) > 0)
                {
                    FatalIOErrorInFunction(motion)
                        << "keyword rotation is " << turn_->value(t)
                        << " degrees at " << t
                        << " s, not about the normal of the case's plane." << nl
                        << "    Allowed: component " << empty << " only"
                        << exit(FatalIOError);
                }
            }
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::prescribedBody::start(const scalar time)
{
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
    velocity_ = (centreAt(time) - centre_)/deltaT;
    angularVelocity_ = vectorOf(rotationAt(time) & rotation_.T())/deltaT;
}


void Foam::mpm::prescribedBody::move(const scalar time, const scalar)
{
    centre_ = centreAt(time);
    rotation_ = rotationAt(time);
}

// ************************************************************************* //
