/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "remainingTime.H"
#include "OStringStream.H"
#include <ctime>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::mpm::remainingTime::sample Foam::mpm::remainingTime::now
(
    const Time& runTime,
    const scalar bodies
) const
{
    const std::chrono::duration<double> elapsed
    (
        std::chrono::steady_clock::now() - begin_
    );
    return sample
    {
        runTime.value(), scalar(std::clock())/CLOCKS_PER_SEC, elapsed.count(),
        bodies
    };
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::remainingTime::remainingTime()
:
    samples_(maxSamples),
    stride_(1),
    since_(0),
    begin_(std::chrono::steady_clock::now())
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::remainingTime::start(const Time& runTime)
{
    samples_.clear();
    samples_.append(now(runTime, 0));
}


Foam::string Foam::mpm::remainingTime::line
(
    const Time& runTime,
    const scalar bodies,
    const load& loadOfBodies
)
{
    if (samples_.empty()) start(runTime);

    const sample current(now(runTime, bodies));
    const scalar done = current.time - samples_[0].time;
    const scalar left = max(scalar(0), runTime.endTime().value() - current.time);

    // The last one that is early enough
    label i = samples_.size() - 1;
    while (i > 0 && current.time - samples_[i].time < lastPart*done) --i;
    const sample& from = samples_[i];

    if (++since_ >= stride_)
    {
        since_ = 0;
        samples_.append(current);
        if (samples_.size() >= maxSamples)
        {
            for (label k = 0; 2*k < samples_.size(); ++k)
            {
                samples_[k] = samples_[2*k];
            }
            samples_.setSize((samples_.size() + 1)/2);
            stride_ *= 2;
        }
    }

    const scalar passed = current.time - from.time;
    if (!(passed > 0)) return string();

    scalar ratio = left/passed;
    if (loadOfBodies && current.clock > from.clock && left > 0)
    {
        const scalar before = loadOfBodies(from.time, current.time);
        const scalar ahead =
            loadOfBodies(current.time, current.time + left);
        const scalar share = min
        (
            (current.bodies - from.bodies)/(current.clock - from.clock),
            scalar(1)
        );
        if (before > 0) ratio *= 1 - share*(1 - ahead/before);
    }
    const scalar clock = ratio*(current.clock - from.clock);

    OStringStream os;
    os.precision(3);
    os  << "Remaining = " << ratio*(current.cpu - from.cpu) << " s  on the"
        << " clock = " << clock << " s";

    // Runs that are stopped by other means than their end may have a thousand
    // years to go, for which no calendar is asked
    constexpr scalar year = 366*86400;
    if (clock > 60 && clock < year)
    {
        // When, as a clock says it
        const std::time_t end = std::time(nullptr) + std::time_t(clock);
        char text[32];
        if
        (
            std::strftime
            (
                text, sizeof(text),
                clock < 43200 ? "%H:%M" : "%a %d %b %H:%M",
                std::localtime(&end)
            )
        )
        {
            os << "  until " << text;
        }
    }
    return os.str();
}

// ************************************************************************* //
