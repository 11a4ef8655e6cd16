/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "elementTest.H"
#include "dictionaryEntries.H"
#include <cmath>

const Foam::wordList Foam::mpm::elementTest::testNames
({
    "drainedTriaxial", "undrainedTriaxial", "oedometer", "isotropic",
    "simpleShear"
});


// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

Foam::scalar meanOf(const std::array<Foam::scalar, 6>& stress)
{
    return -(stress[0] + stress[1] + stress[2])/3;
}


Foam::scalar deviatorOf(const std::array<Foam::scalar, 6>& stress)
{
    const Foam::scalar p = meanOf(stress);
    Foam::scalar sum = 0;
    for (int c = 0; c < 6; ++c)
    {
        const Foam::scalar s = stress[c] + (c < 3 ? p : 0);
        sum += (c < 3 ? 1 : 2)*s*s;
    }
    return std::sqrt(1.5*sum);
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

bool Foam::mpm::elementTest::mixed() const
{
    return
        settings_.test == drainedTriaxial
     || (settings_.test == simpleShear && !settings_.constantVolume);
}


void Foam::mpm::elementTest::setGradient
(
    const scalar given,
    const scalar free
)
{
    gradient_ = {};
    scalar& x = gradient_[0];
    scalar& y = gradient_[4];
    scalar& z = gradient_[8];
    switch (settings_.test)
    {
        case drainedTriaxial:
            y = -given;
            x = z = -free;
            break;
        case undrainedTriaxial:
            y = -given;
            x = z = 0.5*given;
            break;
        case oedometer:
            y = -given;
            break;
        case isotropic:
            x = y = z = -given/3;
            break;
        case simpleShear:
            gradient_[1] = given;
            y = -free;
            break;
    }
}


Foam::scalar Foam::mpm::elementTest::misfit
(
    const variables& start,
    const scalar given,
    const scalar free,
    const scalar deltaT
)
{
    now_ = start;
    setGradient(given, free);
    model_.update(3, points_, deltaT);
    return stress(settings_.test == simpleShear ? 1 : 0) - held_;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::elementTest::elementTest
(
    const soilModel& model,
    const settings& s
)
:
    model_(model),
    settings_(s)
{
    points_.n = 1;
    for (label c = 0; c < nStress; ++c)
    {
        points_.stress[c] = &now_.stress[c];
        points_.wholeStress[c] = &now_.whole[c];
    }
    for (label c = 0; c < 9; ++c) points_.velocityGradient[c] = &gradient_[c];
    for (label i = 0; i < nState; ++i) points_.state[i] = &now_.state[i];
    points_.voidRatio = &now_.voidRatio;
    points_.speed = &speed_;
    points_.power = &now_.power;

    // p0 = (1 + 2 K0)/3 of the axial stress
    const scalar axial = 3*s.p0/(1 + 2*s.K0);
    now_.stress = {-s.K0*axial, -axial, -s.K0*axial, 0, 0, 0};
    now_.voidRatio = s.e0;
    model_.initialise(3, points_);
    now_.whole = now_.stress;
    held_ = s.test == simpleShear ? axial : s.K0*axial;
}


Foam::mpm::elementTest::settings Foam::mpm::elementTest::readSettings
(
    const dictionary& dict,
    const soilModel& model
)
{
    settings s;
    s.test = testType(testNames.find(readChoice(dict, "test", testNames)));
    s.p0 = readBounded(dict, "p0", dimPressure, 0, GREAT, true);
    s.e0 = readBoundedOrDefault(dict, "e0", dimless, model.e0(), 0, 2.97);
    s.K0 = readBoundedOrDefault(dict, "K0", dimless, 1, 0, GREAT);
    s.extension =
        readChoiceOrDefault
        (
            dict, "direction", "compression", {"compression", "extension"}
        ) == "extension";
    s.constantVolume =
        readChoiceOrDefault
        (
            dict, "volume", "drained", {"drained", "constant"}
        ) == "constant";
    s.strainRate = readBoundedOrDefault
    (
        dict, "strainRate", dimless/dimTime, 1e-6, 0, GREAT
    );
    return s;
}


Foam::wordList Foam::mpm::elementTest::keywords()
{
    return wordList
    ({
        "test", "p0", "e0", "K0", "direction", "volume", "strainRate"
    });
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::elementTest::advance(const scalar increment)
{
    const scalar deltaT = mag(increment)/settings_.strainRate;
    const scalar given =
        sign(increment)*settings_.strainRate*(settings_.extension ? -1 : 1);

    const variables start = now_;
    scalar free = 0;

    if (!mixed())
    {
        misfit(start, given, 0, deltaT);
    }
    else
    {
        // Secant steps inside a bracket; more compression, more stress
        const scalar tolerance = 1e-9*held_ + 1e-12;
        scalar low = 0, high = 0, fLow = 0, fHigh = 0;
        free = freePerGiven_*given;
        scalar f = misfit(start, given, free, deltaT);
        scalar reach = 0.05*settings_.strainRate;
        bool hasLow = false, hasHigh = false;
        for (label i = 0; i < 200 && mag(f) > tolerance; ++i)
        {
            if (f < 0)
            {
                low = free;
                fLow = f;
                hasLow = true;
            }
            else
            {
                high = free;
                fHigh = f;
                hasHigh = true;
            }

            if (!hasLow || !hasHigh)
            {
                free += (hasLow ? reach : -reach);
                reach *= 2;
            }
            else if (i % 3 == 2)
            {
                free = 0.5*(low + high);
            }
            else
            {
                free = low - fLow*(high - low)/(fHigh - fLow);
            }
            if (hasLow && hasHigh && high - low <= 1e-15*mag(given)) break;

            f = misfit(start, given, free, deltaT);
        }
        freePerGiven_ = free/given;
    }

    const scalar trace = gradient_[0] + gradient_[4] + gradient_[8];
    strain_ += increment;
    volumetricStrain_ -= trace*deltaT;
    work_ += now_.power*deltaT;
}


bool Foam::mpm::elementTest::finite() const
{
    bool all = std::isfinite(now_.voidRatio);
    for (label c = 0; c < nStress; ++c)
    {
        all = all && std::isfinite(now_.stress[c]);
        all = all && std::isfinite(now_.whole[c]);
    }
    for (label i = 0; i < nState; ++i)
    {
        all = all && std::isfinite(now_.state[i]);
    }
    return all;
}


Foam::scalar Foam::mpm::elementTest::skeletonPressure() const
{
    return meanOf(now_.stress);
}


Foam::scalar Foam::mpm::elementTest::pressure() const
{
    return meanOf(now_.whole);
}


Foam::scalar Foam::mpm::elementTest::skeletonDeviator() const
{
    return deviatorOf(now_.stress);
}


Foam::scalar Foam::mpm::elementTest::deviator() const
{
    return deviatorOf(now_.whole);
}


Foam::scalar Foam::mpm::elementTest::elasticEnergy() const
{
    scalar energy = 0;
    model_.elasticEnergy(3, points_, &energy);
    return energy;
}

// ************************************************************************* //
