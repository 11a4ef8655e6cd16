/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "runForecast.H"
#include "IOdictionary.H"
#include "memInfo.H"
#include "messageStream.H"
#include "OSspecific.H"
#include "functionNeeds.H"
#include "functionObject.H"
#include "expectedFlow.H"
#include "expectedPoints.H"
#include "bodies.H"
#include "soilCloud.H"
#include "waterCloud.H"
#include <cmath>
#include <ctime>
#include <vector>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- The trial: CPU time that is enough, of a short run and of a long one, in
//  which it is that part of the run: the speed of a machine that is shared
//  varies by a third from one second to the next [s, s, -]
const scalar enoughTime = 0.1;
const scalar longTime = 1;
const scalar enoughPart = 0.02;

//- Steps that are at least made for it, at most, and always [-]
const label enoughSteps = 20;
const label mostSteps = 1000;
const label fewestSteps = 3;

//- CPU time of the points of a liquid that falls, once they are mixed and
//  spread, over that at the start in order: 1.35 in tutorials/damBreak at 0.3 s,
//  1.1 and 1.5 in damBreakObstacle3D at 0.5 and 1.5 s (of the kernels, perf)
const scalar mixedTime = 1.3;

//- Times that function objects are tried; the first one allocates
const label nFunctionTrials = 4;

//- CPU time of a point and step where it cannot be measured, as nothing is
//  there yet: figures of tutorials/waterInjection and damBreakObstacle3D [s]
const scalar pointTime[2] = {1.7e-7, 4e-7};

scalar cpuSeconds()
{
    return scalar(std::clock())/CLOCKS_PER_SEC;
}

//- A number with few digits
string digits(const scalar value)
{
    OStringStream os;
    os.precision(3);
    os << value;
    return os.str();
}

//- A count with three digits
string count(const scalar value)
{
    const scalar unit =
        std::pow(10.0, max(0.0, std::floor(std::log10(max(value, 1.0))) - 2));
    OStringStream os;
    os  << int64_t(unit*std::round(value/unit));
    return os.str();
}

//- A time as people say it
string duration(const scalar seconds)
{
    if (seconds < 120) return digits(seconds) + " s";
    if (seconds < 7200) return digits(seconds/60) + " min";
    return digits(seconds/3600) + " h";
}

string bytes(const scalar n)
{
    return n < 1e9 ? digits(n/1e6) + " MB" : digits(n/1e9) + " GB";
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::runForecast::findInflow(materialPointSystem& points)
{
    inflow_.setSize(clouds_.size(), 0);
    capacity_ = points_;
    forAll(clouds_, i)
    {
        if (!expectedPoints::has(points.clouds()[i])) continue;
        const expectedPoints expected(points.clouds()[i], points.g());
        inflow_[i] = expected.inflow(start_);
        capacity_[i] = expected.capacity();
    }
}


void Foam::mpm::runForecast::findScene
(
    const Time& runTime,
    materialPointSystem& points
)
{
    nDim_ = points.grid().cells().nDim();
    start_ = runTime.value();
    end_ = runTime.endTime().value();
    maxCo_ = points.maxCo();
    capped_ = points.settings().maxSoilSoundSpeed < GREAT;
    adjusts_ = runTime.controlDict().lookupOrDefault<Switch>
    (
        "adjustTimeStep", false
    );

    const IOdictionary placement
    (
        IOobject
        (
            "setMaterialPointsDict", runTime.system(), runTime,
            IOobject::MUST_READ, IOobject::NO_WRITE, false
        )
    );
    for (const materialPointCloud& cloud : points.clouds())
    {
        clouds_.append(cloud.name());
        placed_.append
        (
            placement.subOrEmptyDict(cloud.name())
                .lookupOrDefault<label>("pointsPerDirection", 0)
        );
        liquid_.append(&cloud == points.liquidPtr());
        points_.append(cloud.globalSize());
        pointMemory_ += cloud.pointMemory();
        nodeMemory_ += cloud.nodeMemory();
    }
}


void Foam::mpm::runForecast::takeStep
(
    Time& runTime,
    materialPointSystem& points
)
{
    points.particlesToGrid();
    points.setDeltaT(runTime);
    points.advance(runTime);
    points.moveNodes();
    points.gridToParticles();
    points.relocate();
    points.endStep(runTime);
}


Foam::scalar Foam::mpm::runForecast::enough
(
    const Time& runTime,
    const scalar stepTime
) const
{
    const scalar steps = (end_ - start_)/max(runTime.deltaTValue(), SMALL);
    return min(longTime, enoughPart*steps*stepTime);
}


void Foam::mpm::runForecast::findBodies
(
    const Time& runTime,
    const materialPointSystem& points
)
{
    const bodies* all = points.bodiesPtr();
    if (!all || !all->anyMoves()) return;

    const scalar before = all->volumeInMesh(start_, runTime.value());
    if (before > 0) bodyShare_ = all->volumeInMesh(start_, end_)/before;
}


Foam::scalar Foam::mpm::runForecast::nTimes
(
    const dictionary& dict,
    const word& prefix
) const
{
    word kind(dict.lookupOrDefault<word>(prefix + "Control", "timeStep"));
    scalar interval = dict.lookupOrDefault<scalar>(prefix + "Interval", 1);
    if (prefix == "write" && dict.found("outputControl"))
    {
        kind = dict.get<word>("outputControl");
        interval = dict.lookupOrDefault<scalar>("outputInterval", 1);
    }
    const scalar start = max
    (
        start_, dict.lookupOrDefault<scalar>("timeStart", start_)
    );
    const scalar end = min(end_, dict.lookupOrDefault<scalar>("timeEnd", end_));
    const scalar duration = max(scalar(0), end - start);
    const scalar whole = max(scalar(1), interval);

    if
    (
        kind == "adjustableRunTime" || kind == "adjustable"
     || kind == "runTime"
    )
    {
        return interval > 0 ? std::floor(duration/interval*(1 + 1e-9)) : 0;
    }
    if (kind == "timeStep") return std::floor(duration/meanDeltaT()/whole);
    if (kind == "always") return duration/meanDeltaT();
    if (kind == "writeTime" || kind == "outputTime") return nMade_/whole;
    return kind == "onEnd";
}


void Foam::mpm::runForecast::findWriteInterval(const Time& runTime)
{
    auto take = [&](const dictionary& dict, const word& prefix)
    {
        const word kind
        (
            dict.lookupOrDefault<word>(prefix + "Control", "none")
        );
        const scalar interval =
            dict.lookupOrDefault<scalar>(prefix + "Interval", 0);
        if
        (
            (kind == "adjustableRunTime" || kind == "adjustable")
         && interval > 0
        )
        {
            writeInterval_ = min(writeInterval_, interval);
        }
    };
    const dictionary& control = runTime.controlDict();
    take(control, "write");
    functionNeeds::forAllFunctions
    (
        runTime,
        [&](const dictionary& dict, const functionNeeds&)
        {
            take(dict, "write");
            take(dict, "execute");
        }
    );
}


void Foam::mpm::runForecast::findFunctions
(
    Time& runTime,
    materialPointSystem& points
)
{
    struct tried
    {
        autoPtr<functionObject> object;
        scalar nWrites, nExecutions, writing, executing;
    };
    std::vector<tried> all;

    scalar nFields = 0;
    functionNeeds::forAllFunctions
    (
        runTime,
        [&](const dictionary& dict, const functionNeeds& needs)
        {
            const wordList libraries
            (
                dict.lookupOrDefault<wordList>("libs", wordList())
            );
            const word type(dict.lookupOrDefault<word>("type", word::null));
            if
            (
                !libraries.found("libmpmFunctionObjects.so")
             || type == "materialPointHDF5"
             || !dict.lookupOrDefault<bool>("enabled", true)
            )
            {
                return;
            }
            dictionary silent(dict);
            silent.set("writeToFile", false);
            silent.set("log", false);
            all.push_back
            (
                tried
                {
                    functionObject::New(dict.dictName(), runTime, silent),
                    nTimes(dict, "write"), nTimes(dict, "execute"), 0, 0
                }
            );
            if (needs.fields != functionNeeds::NO_FIELDS)
            {
                nFields = max(nFields, all.back().nWrites);
            }
        }
    );
    if (all.empty()) return;

    scalar fields = 0;
    label n = 0;
    for (label trial = 0; trial < nFunctionTrials && !runTime.end(); ++trial)
    {
        takeStep(runTime, points);
        const bool counts = trial > 0;
        n += counts;

        scalar begin = cpuSeconds();
        auto passed = [&]()
        {
            const scalar now = cpuSeconds();
            const scalar time = counts ? now - begin : 0;
            begin = now;
            return time;
        };
        if (nFields > 0)
        {
            for (materialPointCloud& cloud : points.clouds())
            {
                cloud.updateMeshFields();
            }
            fields += passed();
        }
        for (tried& f : all)
        {
            f.object->execute();
            f.executing += passed();
            f.object->write();
            f.writing += passed();
        }
    }
    if (!n) return;

    functionTime_ += nFields*fields/n;
    for (const tried& f : all)
    {
        functionTime_ += (f.nWrites*f.writing + f.nExecutions*f.executing)/n;
    }
}


void Foam::mpm::runForecast::takeSteps
(
    Time& runTime,
    materialPointSystem& points
)
{
    const scalar startSpeed =
        points.liquidPtr() ? points.liquidPtr()->globalMaxSpeed() : 0;

    // The first one allocates
    scalar begin = 0;
    DynamicList<scalar> deltaT;
    DynamicList<word> limiter;
    for (label step = -1;; ++step)
    {
        if (step == 0)
        {
            begin = cpuSeconds();
            points.cost().reset();
        }
        if (step >= fewestSteps)
        {
            const scalar used = cpuSeconds() - begin;
            if
            (
                step >= enoughSteps
             && used > enoughTime && used > enough(runTime, used/step)
            )
            {
                break;
            }
            if (used > longTime || step >= mostSteps) break;
        }
        if (runTime.end()) break;

        takeStep(runTime, points);

        deltaT.append(runTime.deltaTValue());
        limiter.append(points.limiter());
        nTrial_ = step + 1;
    }
    if (nTrial_ < 1) return;
    stepTime_ = (cpuSeconds() - begin)/nTrial_;

    // Of the later ones: soil comes under load in the first steps. The longest,
    // as steps before write times are cut
    for (label i = deltaT.size()/2; i < deltaT.size(); ++i)
    {
        if (deltaT[i] > deltaT_)
        {
            deltaT_ = deltaT[i];
            limiter_ = limiter[i];
        }
    }

    // Parts of the clouds and of bodies, by their share of the time on the
    // clock
    points.cost().stop();
    const costMeter& cost = points.cost();
    cloudTime_.setSize(clouds_.size(), 0);
    scalar all = 0;
    for (size_t part = 0; part < cost.size(); ++part)
    {
        all += cost.seconds(part);
    }
    for (size_t part = 0; part < cost.size(); ++part)
    {
        forAll(clouds_, i)
        {
            const std::string start(clouds_[i] + ": ");
            if (cost.name(part).compare(0, start.size(), start) == 0)
            {
                cloudTime_[i] += cost.seconds(part)/all*stepTime_;
            }
        }
        if (cost.name(part) == "bodies: geometry")
        {
            bodyTime_ += cost.seconds(part)/all*stepTime_;
        }
    }
    findBodies(runTime, points);

    const scalar h = points.grid().cells().minSpacing();
    for (const soilCloud* solid : points.solids())
    {
        soilSpeed_ = max(soilSpeed_, solid->waveSpeed());
    }
    if (points.liquidPtr())
    {
        const waterCloud& liquid = *points.liquidPtr();
        soundSpeed_ = liquid.fluid().soundSpeed();
        flowSpeed_ = liquid.globalMaxSpeed();
        if
        (
            expectedFlow::falls
            (
                flowSpeed_ - startSpeed, mag(points.g()),
                runTime.value() - start_
            )
        )
        {
            mixing_ = mixedTime;
        }
        liquidDeltaT_ = maxCo_*h/(soundSpeed_ + flowSpeed_);
        usefulCo_ = min(usefulCo_, floor(100*liquid.scatteredDeltaT()/h
            *(soundSpeed_ + flowSpeed_))/100);
    }
}


void Foam::mpm::runForecast::findOutput
(
    const Time& runTime,
    const fvMesh& mesh
)
{
    const dictionary& control = runTime.controlDict();
    const word kind(control.lookupOrDefault<word>("writeControl", "timeStep"));
    const scalar interval = control.lookupOrDefault<scalar>("writeInterval", 0);
    if (interval > 0)
    {
        const scalar duration = max(scalar(0), end_ - start_);
        if (kind == "adjustableRunTime" || kind == "runTime")
        {
            nWrites_ = std::floor(duration/interval*(1 + 1e-9));
        }
        else if (kind == "timeStep")
        {
            nWrites_ = std::floor(duration/meanDeltaT()/interval);
        }
        nMade_ = nWrites_;
        const label kept = control.lookupOrDefault<label>("purgeWrite", 0);
        if (kept > 0) nWrites_ = min(nWrites_, scalar(kept));
    }

    // The start has all but the velocities on the mesh
    writeSize_ = startSize_
      + clouds_.size()*3*mesh.nCells()
       *(runTime.writeFormat() == IOstream::BINARY ? 8 : 12);
    scalar now = 0, later = 0;
    forAll(clouds_, i)
    {
        now += points_[i];
        later += meanPoints(i, end_ - start_);
    }
    if (now > 0) writeSize_ *= later/now;
}


void Foam::mpm::runForecast::tryCase(Time& runTime)
{
    fvMesh mesh
    (
        IOobject
        (
            fvMesh::defaultRegion,
            runTime.timeName(),
            runTime,
            IOobject::MUST_READ
        )
    );
    materialPointSystem points(mesh);
    points.read(runTime);
    points.startDeltaT(runTime);

    nCells_ = mesh.nCells();
    findScene(runTime, points);
    findInflow(points);
    takeSteps(runTime, points);
    findWriteInterval(runTime);
    if (nTrial_ > 0)
    {
        findOutput(runTime, mesh);
        findFunctions(runTime, points);
    }

    memInfo memory;
    rss_ = 1024.0*memory.update().rss();
}


Foam::scalar Foam::mpm::runForecast::meanPoints
(
    const label cloud,
    const scalar duration
) const
{
    const scalar first = points_[cloud];
    const scalar more = capacity_[cloud] - first;
    const scalar rate = inflow_[cloud];
    if (!(rate > 0) || !(more > 0) || !(duration > 0)) return first;

    // Until it is full
    const scalar filling = min(duration, more/rate);
    const scalar last = min(more, rate*duration);
    return first + last - 0.5*last*filling/duration;
}


Foam::scalar Foam::mpm::runForecast::flowDeltaT() const
{
    // As fast as its speed of sound was chosen for
    const scalar expected = expectedFlow::speed(soundSpeed_);
    if (!adjusts_ || liquidDeltaT_ > 1.05*deltaT_ || flowSpeed_ > expected)
    {
        return deltaT_;
    }
    return min
    (
        deltaT_,
        liquidDeltaT_*(soundSpeed_ + flowSpeed_)/(soundSpeed_ + expected)
    );
}


Foam::scalar Foam::mpm::runForecast::meanDeltaT() const
{
    const scalar deltaT = flowDeltaT();
    return adjusts_ ? expectedFlow::wholeSteps(deltaT, writeInterval_) : deltaT;
}


Foam::scalar Foam::mpm::runForecast::meanStepTime() const
{
    scalar time = stepTime_ + bodyTime_*(bodyShare_ - 1);
    forAll(clouds_, i)
    {
        const scalar later = liquid_[i] ? mixing_ : 1;
        const scalar each =
            points_[i] > 500
          ? cloudTime_[i]/points_[i] : pointTime[nDim_ - 2];
        time += (later*meanPoints(i, end_ - start_) - points_[i])*each;
    }
    return time;
}


void Foam::mpm::runForecast::cheaper
(
    const string& what,
    const scalar share,
    const string& cost
)
{
    Info<< "        " << what.c_str() << ": " << digits(share).c_str()
        << " of the time; " << cost.c_str() << nl;
}


void Foam::mpm::runForecast::reportCheaper() const
{
    Info<< "    cheaper (errors of other scenes, docs/results.md; of this one:"
        << " accuracyCost)" << nl;

    const bool waves = limiter_.find("sound") != std::string::npos
        || limiter_.find("stiffness") != std::string::npos;
    if (adjusts_ && waves && maxCo_ < usefulCo_)
    {
        cheaper
        (
            "maxCo " + Foam::name(usefulCo_), maxCo_/usefulCo_,
            "no change of the error in five scenes"
        );
    }
    if
    (
        adjusts_ && !capped_
     && limiter_.find("stiffness") != std::string::npos
    )
    {
        // Below the liquid's it buys nothing
        const scalar share =
            max(0.25, liquidDeltaT_ < GREAT ? deltaT_/liquidDeltaT_ : 0.25);
        if (share < 0.8)
        {
            cheaper
            (
                "maxSoilSoundSpeed " + digits(share*soilSpeed_) + " (m/s; now "
              + digits(soilSpeed_) + ')',
                share,
                "error of a collapse 2.0 for 1.9 %, of a scour hole within its"
                " scatter; not where settlement or waves in soil are asked for"
            );
        }
    }
    if (adjusts_ && liquidDeltaT_ < 1.05*deltaT_)
    {
        cheaper
        (
            "soundSpeed " + digits(0.7*soundSpeed_), 0.72,
            "density varies by 2 instead of 1 %; front and energy of a dam"
            " break within 0.1 %"
        );
    }
    forAll(clouds_, i)
    {
        const label n = placed_[i];
        if (n < 3) continue;
        const scalar left = std::pow(2.0/n, scalar(nDim_));
        cheaper
        (
            clouds_[i] + " pointsPerDirection 2",
            1 - cloudTime_[i]/stepTime_*(1 - left),
            liquid_[i]
          ? "error of a dam break the same, of waves 4.3 for 3.5 %"
          : "error of a collapse 1.9 for 2.1 % (of 3)"
        );
    }
    cheaper
    (
        "cells twice as large", nDim_ == 2 ? 0.125 : 0.0625,
        "error three to five times"
    );
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::runForecast::runForecast
(
    Time& runTime,
    const scalar startSize,
    const scalar startTime
)
:
    startSize_(startSize),
    startTime_(startTime),
    nDim_(0),
    nCells_(0),
    start_(0),
    end_(0),
    pointMemory_(0),
    nodeMemory_(0),
    rss_(0),
    adjusts_(false),
    maxCo_(0),
    usefulCo_(0.7),
    limiter_("none"),
    deltaT_(0),
    liquidDeltaT_(GREAT),
    soilSpeed_(0),
    capped_(false),
    soundSpeed_(0),
    flowSpeed_(0),
    mixing_(1),
    stepTime_(0),
    nTrial_(0),
    bodyTime_(0),
    bodyShare_(1),
    functionTime_(0),
    writeInterval_(GREAT),
    nWrites_(0),
    nMade_(0),
    writeSize_(0)
{
    // What it says was said, or is the solver's to say
    const int level = messageStream::level;
    messageStream::level = 0;
    const bool throwing = FatalError.throwExceptions();
    const bool throwingIO = FatalIOError.throwExceptions();
    try
    {
        tryCase(runTime);
    }
    catch (const Foam::error& e)
    {
        failure_ = e.message();
    }
    FatalError.throwExceptions(throwing);
    FatalIOError.throwExceptions(throwingIO);
    messageStream::level = level;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::runForecast::report() const
{
    Info<< "Forecast of mpmFoam on this machine, one core" << nl;
    if (!failure_.empty())
    {
        Info<< "    none: mpmFoam refuses this case:" << nl
            << failure_.c_str() << nl << endl;
        return;
    }
    if (nTrial_ < 1 || !(end_ > start_))
    {
        Info<< "    none: endTime of controlDict is reached" << nl << endl;
        return;
    }

    const scalar duration = end_ - start_;
    const scalar deltaT = meanDeltaT();
    const scalar steps = duration/deltaT;
    const scalar stepTime = meanStepTime();
    scalar later = 0, now = 0;
    OStringStream names;
    forAll(clouds_, i)
    {
        later += meanPoints(i, duration);
        now += points_[i];
        names << (i ? ", " : "") << clouds_[i] << ' ' << label(points_[i]);
    }

    const scalar writing = nMade_*startTime_*writeSize_/max(startSize_, SMALL);
    const scalar total = steps*stepTime + writing + functionTime_;

    Info<< "    points:    " << names.str().c_str();
    if (later > 1.01*now)
    {
        Info<< "; with inlets about " << count(later).c_str()
            << " in the mean of the run";
    }
    Info<< nl
        << "    memory:    " << bytes(rss_).c_str() << ", of it points "
        << bytes(pointMemory_).c_str() << ", nodes "
        << bytes(nodeMemory_).c_str() << nl
        << "    time step: " << digits(deltaT).c_str() << " s, limited by "
        << limiter_;
    if (deltaT < 0.99*deltaT_)
    {
        Info<< " (" << digits(deltaT_).c_str() << " s at the start";
        if (flowDeltaT() < 0.99*deltaT_)
        {
            Info<< "; for a flow of " << digits(expectedFlow::speed(soundSpeed_)).c_str()
                << " m/s";
        }
        if (deltaT < 0.99*flowDeltaT())
        {
            Info<< "; whole steps to times that are written, every "
                << digits(writeInterval_).c_str() << " s";
        }
        Info<< ')';
    }
    Info<< nl
        << "    steps:     " << count(steps).c_str() << " to " << end_ << " s"
        << nl
        << "    time:      " << ::duration(total).c_str()
        << " (" << digits(total/3600).c_str() << " h), "
        << digits(1e3*stepTime).c_str() << " ms of CPU time per step";
    if (now > 0)
    {
        Info<< ", " << digits(1e9*stepTime/max(later, scalar(1))).c_str()
            << " ns per point: " << nTrial_ << " steps of this case, timed"
            << " just now";
    }
    if (functionTime_ > 0.005*total)
    {
        Info<< "; function objects " << ::duration(functionTime_).c_str();
    }
    if (writing > 0.005*total)
    {
        Info<< "; output " << ::duration(writing).c_str();
    }
    Info<< nl
        << "    output:    " << label(nWrites_) << " times of "
        << bytes(writeSize_).c_str() << ", together "
        << bytes(nWrites_*writeSize_).c_str()
        << " (function objects apart)" << nl;
    reportCheaper();
    Info<< endl;
}



Foam::scalar Foam::mpm::runForecast::size(const fileName& directory)
{
    scalar sum = 0;
    for (const fileName& name : readDir(directory, fileName::FILE, false))
    {
        sum += fileSize(directory/name);
    }
    for (const fileName& name : readDir(directory, fileName::DIRECTORY))
    {
        sum += size(directory/name);
    }
    return sum;
}

// ************************************************************************* //
