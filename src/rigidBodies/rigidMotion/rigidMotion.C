/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "rigidMotion.H"
#include "dictionaryEntries.H"
#include "exactDigits.H"
#include "SquareMatrix.H"
#include "scalarMatrices.H"
#include "pointConstraint.H"
#include "sixDoFRigidBodyMotion.H"
#include "sixDoFRigidBodyMotionConstraint.H"
#include "sixDoFRigidBodyMotionRestraint.H"
#include "Time.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(rigidMotion, 0);
    addToRunTimeSelectionTable(bodyMotion, rigidMotion, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::rigidMotion::findConstraints(const lattice& cells)
{
    pointConstraint translation, rotation;
    const sixDoFRigidBodyMotion none(cells.mesh().time());
    for (const entry& e : subDictOrEmpty(dict_, "constraints"))
    {
        const autoPtr<sixDoFRigidBodyMotionConstraint> constraint
        (
            sixDoFRigidBodyMotionConstraint::New(e.keyword(), e.dict(), none)
        );
        constraint->constrainTranslation(translation);
        constraint->constrainRotation(rotation);
    }
    freeTranslation_ = translation.constraintTransformation();
    freeRotation_ = rotation.constraintTransformation();
    if (cells.nDim() < 3)
    {
        vector out(Zero);
        out[cells.axis(2)] = 1;
        freeTranslation_ = freeTranslation_ & (tensor(I) - out*out);
        freeRotation_ = freeRotation_ & tensor(out*out);
    }
}


void Foam::mpm::rigidMotion::readRestraints()
{
    for (const entry& e : subDictOrEmpty(dict_, "restraints"))
    {
        restraints_.append
        (
            sixDoFRigidBodyMotionRestraint::New(e.keyword(), e.dict())
        );
    }
}


void Foam::mpm::rigidMotion::restrain(vector& force, vector& moment) const
{
    if (restraints_.empty()) return;

    // What OpenFOAM's restraints look at
    const exactDigits exact;
    dictionary solver, state, coeffs;
    solver.add("type", "symplectic");
    coeffs.add("solver", solver);
    coeffs.add("mass", mass_);
    coeffs.add("momentOfInertia", inertia_);
    coeffs.add("centreOfMass", reference_);
    state.add("centreOfRotation", centre_);
    state.add("orientation", rotation_);
    state.add("velocity", velocity_);
    state.add("angularMomentum", inertia_ & (rotation_.T() & angularVelocity_));
    const Time& time = *time_;
    const sixDoFRigidBodyMotion motion(coeffs, state, time);
    for (const sixDoFRigidBodyMotionRestraint& restraint : restraints_)
    {
        vector at(Zero), F(Zero), M(Zero);
        restraint.restrain(motion, at, F, M);
        force += F;
        moment += M + ((at - centre_) ^ F);
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::rigidMotion::rigidMotion
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
:
    dict_(subDictOf(dict, "motion")),
    time_(&cells.mesh().time()),
    mass_(readPositive(dict_, "mass", dimMass))
{
    checkKeywords
    (
        dict_,
        {
            "mass", "centreOfMass", "momentOfInertia", "velocity",
            "angularVelocity", "constraints", "restraints"
        },
        strict
    );
    reference_ = dict_.get<point>("centreOfMass");
    centre_ = reference_;
    velocity_ = dict_.lookupOrDefault<vector>("velocity", Zero);
    angularVelocity_ = dict_.lookupOrDefault<vector>("angularVelocity", Zero);

    const vector inertia(dict_.get<vector>("momentOfInertia"));
    if (cmptMin(inertia) <= 0)
    {
        FatalIOErrorInFunction(dict_)
            << "keyword momentOfInertia is " << inertia << " kg m2." << nl
            << "    Allowed: three numbers > 0" << exit(FatalIOError);
    }
    inertia_ = diagTensor(inertia.x(), inertia.y(), inertia.z());
    findConstraints(cells);
    readRestraints();
    velocity_ = freeTranslation_ & velocity_;
    angularVelocity_ = freeRotation_ & angularVelocity_;
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::rigidMotion::~rigidMotion()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::rigidMotion::react
(
    const scalar deltaT,
    const vector& gravity,
    const scalar (&impulse)[6],
    const scalar (&resistance)[36]
)
{
    vector force(mass_*gravity), moment(Zero);
    restrain(force, moment);
    const tensor theta(inertia());

    // Gyroscopic moment at the start of the step
    moment -= angularVelocity_ ^ (theta & angularVelocity_);

    vector forward(Zero), turn(Zero);
    scalarSquareMatrix A(6, Zero);
    scalarField b(6);
    for (direction i = 0; i < 3; ++i)
    {
        forward[i] = impulse[i] + deltaT*force[i];
        turn[i] = impulse[3 + i] + deltaT*moment[i];
        A(i, i) = mass_;
        for (direction j = 0; j < 3; ++j) A(3 + i, 3 + j) = theta(i, j);
        for (direction j = 0; j < 3; ++j)
        {
            A(i, j) += resistance[6*i + j];
            A(i, 3 + j) += resistance[6*i + 3 + j];
            A(3 + i, j) += resistance[6*(3 + i) + j];
            A(3 + i, 3 + j) += resistance[6*(3 + i) + 3 + j];
        }
    }

    // Only in the directions that are free: P A P + 1 - P
    auto P = [&](const label i, const label j) -> scalar
    {
        return
            i < 3 && j < 3 ? freeTranslation_(i, j)
          : i >= 3 && j >= 3 ? freeRotation_(i - 3, j - 3)
          : 0;
    };
    scalarSquareMatrix free(6, Zero);
    for (label i = 0; i < 6; ++i)
    {
        b[i] = 0;
        for (label j = 0; j < 6; ++j)
        {
            b[i] += P(i, j)*(j < 3 ? forward[j] : turn[j - 3]);
            scalar sum = 0;
            for (label k = 0; k < 6; ++k)
            for (label l = 0; l < 6; ++l)
            {
                sum += P(i, k)*A(k, l)*P(l, j);
            }
            free(i, j) = sum + (i == j) - P(i, j);
        }
    }
    LUsolve(free, b);
    velocity_ += freeTranslation_ & vector(b[0], b[1], b[2]);
    angularVelocity_ += freeRotation_ & vector(b[3], b[4], b[5]);
}


void Foam::mpm::rigidMotion::move(const scalar, const scalar deltaT)
{
    centre_ += deltaT*velocity_;
    rotation_ = rotationOf(deltaT*angularVelocity_) & rotation_;

    // Rounding may not add up
    vector x(rotation_.x()), y(rotation_.y());
    x /= mag(x);
    y -= (x & y)*x;
    y /= mag(y);
    const vector z(x ^ y);
    rotation_ = tensor(x.x(), x.y(), x.z(), y.x(), y.y(), y.z(), z.x(), z.y(), z.z());
}


Foam::scalar Foam::mpm::rigidMotion::kineticEnergy() const
{
    return
        0.5*mass_*magSqr(velocity_)
      + 0.5*(angularVelocity_ & (inertia() & angularVelocity_));
}

// ************************************************************************* //
