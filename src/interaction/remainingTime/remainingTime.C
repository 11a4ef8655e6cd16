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
    const std::vector<part>& parts
) const
{
    const std::chrono::duration<double> elapsed
    (
        std::chrono::steady_clock::now() - begin_
    );
    sample s
    {
        runTime.value(), scalar(std::clock())/CLOCKS_PER_SEC, elapsed.count(),
        runTime.timeIndex(), scalarList(label(parts.size()))
    };
    for (size_t i = 0; i < parts.size(); ++i) s.seconds[i] = parts[i].seconds;
    return s;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::remainingTime::remainingTime()
:
    begin_(std::chrono::steady_clock::now())
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::remainingTime::start(const Time& runTime)
{
    samples_.clear();
    samples_.append(now(runTime, std::vector<part>()));
}


Foam::string Foam::mpm::remainingTime::line
(
    const Time& runTime,
    const std::vector<part>& parts,
    const scalar deltaT
)
{
    if (samples_.empty()) start(runTime);

    const sample current(now(runTime, parts));
    const scalar done = current.time - samples_[0].time;
    const scalar left = max(scalar(0), runTime.endTime().value() - current.time);

    // The last one that is early enough
    label i = samples_.size() - 1;
    while (i > 0 && current.time - samples_[i].time < lastPart*done) --i;
    const sample from(samples_[i]);
    samples_.append(current);

    const scalar passed = current.time - from.time;
    if (!(passed > 0)) return string();

    scalar ratio = left/passed;
    if (left > 0 && current.clock > from.clock)
    {
        scalar factor = 1;
        forAll(current.seconds, k)
        {
            const scalar before = parts[k].load(from.time, current.time);
            const scalar ahead =
                parts[k].load(current.time, current.time + left);

            // The first one is of a start at which nothing was spent
            const scalar spent = current.seconds[k]
              - (k < from.seconds.size() ? from.seconds[k] : 0);
            const scalar share =
                min(spent/(current.clock - from.clock), scalar(1));
            if (before > 0) factor += share*(ahead/before - 1);
        }
        ratio *= max(factor, scalar(0));

        const label steps = current.step - from.step;
        if (steps > 0) ratio *= max(scalar(1), passed/steps/deltaT);
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
