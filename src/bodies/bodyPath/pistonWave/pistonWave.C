/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pistonWave.H"
#include "dictionaryEntries.H"
#include "gravityMeshObject.H"
#include "mathematicalConstants.H"
#include "Time.H"
#include "addToRunTimeSelectionTable.H"
#include <cmath>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(pistonWave, 0);
    addToRunTimeSelectionTable(bodyPath, pistonWave, dictionary);
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    using namespace Foam;

    constexpr scalar pi = constant::mathematical::pi;

    //- Height over depth from which on a solitary wave breaks
    constexpr scalar breaking = 0.78;

    //- Steepness over tanh(k d) from which on a regular wave breaks (Miche)
    constexpr scalar steepest = 0.142;

    //- H L^2/d^3 beyond which second order has a second crest (Madsen)
    constexpr scalar longest = 8*pi*pi/3;

    //- Argument of tanh at which the solitary wave is cut off
    constexpr scalar cutOff = 3.8;

    //- Wave number times depth, from k d tanh(k d) = x
    scalar dispersion(const scalar x)
    {
        // Newton, from the larger of the limits of deep and shallow water
        scalar kd = max(x, std::sqrt(x));
        for (label i = 0; i < 50; ++i)
        {
            const scalar t = std::tanh(kd);
            const scalar step = (kd*t - x)/(t + kd*(1 - t*t));
            kd -= step;
            if (mag(step) < 1e-14*kd) break;
        }
        return kd;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::pistonWave::setRegular(const dictionary& dict, const scalar g)
{
    const scalar period = readPositive(dict, "period", dimTime);
    ramp_ =
        dict.found("rampTime")
      ? readPositive(dict, "rampTime", dimTime) : period;

    omega_ = 2*pi/period;
    const scalar kd = dispersion(sqr(omega_)*depth_/g);
    const scalar length = 2*pi*depth_/kd;
    const scalar highest = steepest*length*std::tanh(kd);
    if (!(height_ < highest))
    {
        FatalIOErrorInFunction(dict)
            << "keyword height is " << height_ << " m: waves of the length "
            << length << " m break." << nl
            << "    Allowed: < " << highest << " m" << exit(FatalIOError);
    }

    const scalar ratio =
        2*(std::cosh(2*kd) - 1)/(std::sinh(2*kd) + 2*kd);
    stroke_ = height_/ratio;

    second_ = 0;
    if (readSwitchOrDefault(dict, "secondOrder", false))
    {
        const scalar ursell = height_*sqr(length)/pow3(depth_);
        if (!(ursell < longest))
        {
            FatalIOErrorInFunction(dict)
                << "keyword secondOrder is yes, but height length^2/depth^3 is "
                << ursell << ": the wave is too high for its length of "
                << length << " m." << nl
                << "    Allowed: < " << longest << ", or secondOrder no"
                << exit(FatalIOError);
        }
        second_ =
            sqr(height_)/(32*depth_)
           *(3*std::cosh(kd)/pow3(std::sinh(kd)) - 2/ratio);
    }
}


void Foam::mpm::pistonWave::setSolitary(const dictionary& dict, const scalar g)
{
    for (const char* unused : {"period", "rampTime", "secondOrder"})
    {
        if (!dict.found(unused)) continue;
        FatalIOErrorInFunction(dict)
            << "keyword " << unused << " is given, but wave is solitary." << nl
            << "    Allowed: without it, or wave regular"
            << exit(FatalIOError);
    }
    if (!(height_ < breaking*depth_))
    {
        FatalIOErrorInFunction(dict)
            << "keyword height is " << height_ << " m: the wave breaks." << nl
            << "    Allowed: < " << breaking*depth_ << " m, " << breaking
            << " of the depth" << exit(FatalIOError);
    }
    kappa_ = std::sqrt(0.75*height_/pow3(depth_));
    speed_ = std::sqrt(g*(depth_ + height_));
    stroke_ = 2*height_/(kappa_*depth_);
    duration_ = 2*(cutOff + height_/depth_)/(kappa_*speed_);
}


Foam::scalar Foam::mpm::pistonWave::solitaryWay(const scalar t) const
{
    // Monotonic in y: what Newton leaves of the bracket is halved
    scalar low = -0.5*stroke_, high = 0.5*stroke_;
    scalar y = max(low, min(high, 0.5*stroke_*std::tanh(kappa_*speed_*t)));
    for (label i = 0; i < 100; ++i)
    {
        const scalar th = std::tanh(kappa_*(speed_*t - y));
        const scalar f = y - 0.5*stroke_*th;
        (f > 0 ? high : low) = y;
        const scalar step = f/(1 + 0.5*stroke_*kappa_*(1 - th*th));
        scalar next = y - step;
        if (!(next >= low && next <= high)) next = 0.5*(low + high);
        if (mag(next - y) < 1e-15*stroke_) return next;
        y = next;
    }
    return y;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::pistonWave::pistonWave
(
    const dictionary& dict,
    const lattice& cells,
    const bool strict
)
:
    solitary_(readChoice(dict, "wave", {"regular", "solitary"}) == "solitary"),
    height_(readPositive(dict, "height", dimLength)),
    depth_(readPositive(dict, "depth", dimLength)),
    start_(readBoundedOrDefault(dict, "start", dimTime, 0, -GREAT, GREAT)),
    direction_(dict.lookupOrDefault<vector>("direction", vector(1, 0, 0))),
    stroke_(0),
    omega_(0),
    ramp_(0),
    second_(0),
    kappa_(0),
    speed_(0),
    duration_(0)
{
    checkKeywords
    (
        dict,
        {
            "type", "wave", "height", "depth", "period", "rampTime",
            "secondOrder", "direction", "start"
        },
        strict
    );
    if (!(mag(direction_) > 0))
    {
        FatalIOErrorInFunction(dict)
            << "keyword direction is " << direction_ << '.' << nl
            << "    Allowed: a vector that is not zero" << exit(FatalIOError);
    }
    direction_ /= mag(direction_);

    const scalar g =
        mag(meshObjects::gravity::New(cells.mesh().time()).value());
    if (!(g > 0))
    {
        FatalIOErrorInFunction(dict)
            << "a pistonWave needs gravity, but constant/g is zero." << nl
            << "    Allowed: a motion by functions of time, or gravity"
            << exit(FatalIOError);
    }
    if (solitary_) setSolitary(dict, g);
    else setRegular(dict, g);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::vector Foam::mpm::pistonWave::displacement(const scalar time) const
{
    const scalar t = time - start_;
    if (t <= 0) return Zero;

    if (solitary_)
    {
        const scalar half = 0.5*duration_;
        return direction_
           *(solitaryWay(min(t, duration_) - half) - solitaryWay(-half));
    }
    const scalar part = t < ramp_ ? 0.5*(1 - std::cos(pi*t/ramp_)) : 1;
    return direction_*part
       *(
            0.5*stroke_*std::sin(omega_*t)
          + second_*std::sin(2*omega_*t)
        );
}

// ************************************************************************* //
