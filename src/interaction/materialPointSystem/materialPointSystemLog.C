/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    What the log says: effects at the start, entries on the way, costs at the
    end.

\*---------------------------------------------------------------------------*/

#include "materialPointSystem.H"
#include "bodies.H"
#include "effectsTable.H"
#include "expectedFlow.H"
#include "expectedPoints.H"
#include "movingFrame.H"
#include "phasePair.H"
#include "relaxationZone.H"
#include "soilCloud.H"
#include "waterCloud.H"
#include "PstreamReduceOps.H"
#include <cmath>
#include <iomanip>
#include <sstream>

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointSystem::logBed(const Time& runTime) const
{
    // Where the surface of the bed has to be found for it, it costs half a step,
    // and the nodes have their sums at write times only
    bool followed = false;
    for (const phasePair& pair : pairs_)
    {
        followed = followed || pair.followsSurface();
    }
    soilCloud::bedState bed{};
    if
    (
        (followed || runTime.writeTime())
     && solids_[0]->bed(bed) && bed.stress > 0
    )
    {
        // The top row holds what is thinner than this (rowStress of
        // bedLoadModel)
        const scalar part = bed.movable/grid_.cells().minSpacing();
        Info<< solids_[0]->name() << ": stress on the bed " << bed.stress
            << " Pa (mean), which can move " << bed.movable << " m of it, "
            << part << " cells: bed load is "
            << (part < 0.25 ? "thinner than the grid resolves" : "resolved")
            << nl;
    }
}


void Foam::mpm::materialPointSystem::logDensity() const
{
    // The percentile only where it may be too large: more than one point
    // in a hundred is
    const scalar most = 0.03;
    const scalar* J = liquid_->J();
    label nAbove = 0;
    for (label p = 0; p < liquid_->size(); ++p)
    {
        nAbove += mag(1 - J[p]) > most*J[p];
    }
    const scalar variation = returnReduce
    (
        nAbove > 0.01*liquid_->size() ? liquid_->densityVariation() : 0,
        maxOp<scalar>()
    );
    if (variation > most)
    {
        Info<< "--> " << liquid_->name() << ": the density varies by "
            << 100*variation << " % (99th percentile); raise soundSpeed above "
            << liquid_->fluid().soundSpeed() << " m/s for less" << nl;
    }
}


void Foam::mpm::materialPointSystem::logImpacts() const
{
    // Softened soil that meets at such a speed stores the impact, instead of
    // yielding to it, and throws it back
    const scalar cap = settings_.maxSoilSoundSpeed;
    const scalar most = cap/3;
    for (const soilCloud* solid : solids_)
    {
        const scalar fastest = solid->globalMaxSpeed();
        if (!(fastest > most)) continue;

        const scalar nFaster =
            returnReduce(scalar(solid->nFaster(most)), sumOp<scalar>());
        const scalar share = nFaster/max(int64_t(1), solid->globalSize());

        // As for a liquid: single grains in the air do not matter
        if (share > 0.01)
        {
            Info<< "--> " << solid->name() << ": " << 100*share
                << " % of the points are faster"
                << " than a third of maxSoilSoundSpeed " << cap
                << " m/s (the fastest: " << fastest << " m/s); impacts"
                << " bounce like rubber. Raise maxSoilSoundSpeed above "
                << 3*fastest << " m/s, or leave it out" << nl;
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::materialPointSystem::reportEffects() const
{
    const lattice& cells = grid_.cells();
    OStringStream spacing;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        spacing << (d ? " x " : "") << cells.spacing(d);
    }

    Info<< nl << "Background grid" << nl
        << "    " << returnReduce(int64_t(mesh_.nCells()), sumOp<int64_t>())
        << " cells of " << spacing.str().c_str() << " m, " << cells.nDim()
        << "D, " << grid_.shapeFunction() << nl << nl
        << "Effects" << nl;

    effectsTable table;
    for (const materialPointCloud& cloud : clouds_) cloud.effects(table);
    for (const phasePair& pair : pairs_) pair.effects(table);
    if (pairs_.empty())
    {
        table.add
        (
            "coupling", false, clouds_.size() == 1 ? "one cloud" : "no liquid"
        );
    }
    OStringStream names;
    for (label b = 0; bodies_.valid() && b < bodies_->size(); ++b)
    {
        names
            << (b ? ", " : "") << (*bodies_)[b].name() << " ("
            << (*bodies_)[b].motion().type() << ')';
    }
    table.add
    (
        "bodies", bodies_.valid(),
        bodies_.valid()
      ? string(names.str()) : string("materialPointProperties/bodies")
    );
    OStringStream zones;
    forAll(zones_, i) zones << (i ? ", " : "") << zones_[i].name();
    table.add
    (
        "relaxation zones", zones_.size() > 0,
        zones_.size()
      ? string(zones.str()) : string("relaxationZones of the liquid")
    );
    table.add
    (
        "body forces", forced_,
        forced_ ? "beside gravity of constant/g" : "gravity alone"
    );
    table.add
    (
        "moving frame", frame_.valid(),
        !frame_.valid() ? "materialPointProperties/frame"
      : frame_->turns() ? "accelerated and turning" : "accelerated"
    );
    table.add
    (
        "relaxation", settings_.relaxationDamping > 0,
        settings_.relaxationDamping > 0
      ? "until " + Foam::name(settings_.relaxationUntil) + " s"
      : string("fvSolution/MPM/relaxation")
    );
    table.add
    (
        "time step",
        string
        (
            time_.controlDict().lookupOrDefault<Switch>("adjustTimeStep", false)
          ? "auto" : "set"
        ),
        "maxCo " + Foam::name(maxCo_)
    );
    table.print(Info);

    Info<< nl << "Memory" << nl;
    for (const materialPointCloud& cloud : clouds_)
    {
        const scalar n = max(int64_t(1), cloud.globalSize());
        scalar points = cloud.pointMemory(), nodes = cloud.nodeMemory();
        reduce(points, sumOp<scalar>());
        reduce(nodes, sumOp<scalar>());
        Info<< "    " << cloud.name() << ": " << points/n
            << " bytes per point, " << nodes/1e6 << " MB on nodes, mass "
            << cloud.globalMass() << " kg" << nl;
    }
    if (pairs_.size())
    {
        scalar nodes = 0;
        for (const phasePair& pair : pairs_) nodes += pair.memory();
        reduce(nodes, sumOp<scalar>());
        Info<< "    coupling: " << nodes/1e6 << " MB on nodes" << nl;
    }
    Info<< endl;
}


void Foam::mpm::materialPointSystem::startRemaining(const Time& runTime)
{
    remaining_.start(runTime);
    startTime_ = runTime.value();
    startSpeed_ = liquid_ ? liquid_->globalMaxSpeed() : 0;
    fallsKnown_ = falls_ = false;

    expected_.setSize(clouds_.size());
    forAll(clouds_, i)
    {
        if (!expectedPoints::has(clouds_[i])) continue;
        expected_.set(i, new expectedPoints(clouds_[i], g_));
        expected_[i].note(startTime_, clouds_[i].globalSize());
    }
}


Foam::scalar Foam::mpm::materialPointSystem::expectedDeltaT() const
{
    if
    (
        !falls_ || limiter_ != liquid_->waveName()
     || !time_.controlDict().lookupOrDefault<Switch>("adjustTimeStep", false)
    )
    {
        return GREAT;
    }

    const scalar sound = liquid_->fluid().soundSpeed();
    const scalar speed = liquid_->globalMaxSpeed();
    const scalar ahead = max(speed, expectedFlow::speed(sound));
    const scalar reach = maxCo_*grid_.cells().minSpacing();

    const scalar interval =
        writeIntervals_.size() ? min(writeIntervals_) : GREAT;
    return expectedFlow::wholeSteps(reach/(sound + ahead), interval);
}


void Foam::mpm::materialPointSystem::logRemaining(const Time& runTime)
{
    const scalar now = runTime.value();
    if (!fallsKnown_)
    {
        fallsKnown_ = true;
        falls_ = liquid_ && expectedFlow::falls
        (
            liquid_->globalMaxSpeed() - startSpeed_, mag(g_), now - startTime_
        );
    }

    std::vector<remainingTime::part> parts;

    if (bodies_.valid() && bodies_->anyMoves())
    {
        parts.push_back
        (
            remainingTime::part
            {
                0,
                [&](const scalar from, const scalar to)
                {
                    return bodies_->volumeInMesh(from, to);
                }
            }
        );
    }

    // Parts of a cloud go with its points, what is of none, with those of all
    scalar still = 0, shared = 0;
    const size_t nBodies = parts.size();
    labelList partOf(clouds_.size(), -1);
    forAll(clouds_, i)
    {
        const scalar n = clouds_[i].globalSize();
        if (!expected_.set(i))
        {
            still += n;
            continue;
        }
        expected_[i].note(now, n);
        partOf[i] = parts.size();
        parts.push_back
        (
            remainingTime::part
            {
                0,
                [this, i](const scalar from, const scalar to)
                {
                    return expected_[i].mean(from, to);
                }
            }
        );
    }
    for (size_t k = 0; k < cost_.size(); ++k)
    {
        const std::string name(cost_.name(k));
        if (name == "bodies: geometry")
        {
            if (nBodies) parts[0].seconds = cost_.seconds(k);
            continue;
        }
        bool ofCloud = false;
        forAll(clouds_, i)
        {
            if (name.compare(0, clouds_[i].name().size() + 2,
                clouds_[i].name() + ": ") != 0) continue;
            ofCloud = true;
            if (partOf[i] >= 0) parts[partOf[i]].seconds += cost_.seconds(k);
        }
        if (!ofCloud) shared += cost_.seconds(k);
    }
    if (parts.size() > nBodies)
    {
        parts.push_back
        (
            remainingTime::part
            {
                shared,
                [this, still](const scalar from, const scalar to)
                {
                    scalar n = still;
                    forAll(expected_, i)
                    {
                        if (expected_.set(i)) n += expected_[i].mean(from, to);
                    }
                    return n;
                }
            }
        );
    }

    const string remaining
    (
        remaining_.line(runTime, parts, expectedDeltaT())
    );
    if (remaining.size()) Info<< remaining.c_str() << nl;
}


void Foam::mpm::materialPointSystem::log(const Time& runTime)
{
    const label step = clouds_[0].stepCount();
    logThisStep_ = step % logInterval_ == 0 || runTime.writeTime();
    if (!logThisStep_) return;

    const scalar h = grid_.cells().minSpacing();
    const scalar deltaT = runTime.deltaTValue();

    Info<< "Time = " << runTime.timeName() << nl << nl
        << "Courant Number mean: " << flowSpeed_*deltaT/h
        << " max: " << signalSpeed_*deltaT/h << nl
        << "deltaT = " << deltaT << " limiter: " << limiter_
        << " step: " << step << nl;

    for (const materialPointCloud& cloud : clouds_)
    {
        const int64_t contacts =
            returnReduce(cloud.counts().wallContacts, sumOp<int64_t>());
        const int64_t left =
            returnReduce(cloud.counts().left.n, sumOp<int64_t>());

        Info<< cloud.name() << ": points " << cloud.globalSize()
            << ", max speed " << cloud.globalMaxSpeed() << " m/s";
        if (left) Info<< ", left through openings " << left;
        if (contacts) Info<< ", put back from walls " << contacts;
        if (bodies_.valid())
        {
            const int64_t out =
                returnReduce(cloud.nPutOut(), sumOp<int64_t>());
            if (out) Info<< ", put out of bodies " << out;
        }
        Info<< nl;
        if (cloud.openBoundaries())
        {
            const inflowOutflow::balance b(cloud.accounts());
            Info<< cloud.name() << ": entered " << b.entered.n << ", left "
                << b.left.n << ", left elsewhere " << b.elsewhere.n
                << ", waiting " << b.waiting.n << ", allocated "
                << b.allocated << ", balance " << b.imbalance() << ", mass "
                << b.massImbalance() << " kg" << nl;
        }
    }

    for (label b = 0; bodies_.valid() && b < bodies_->size(); ++b)
    {
        Info<< "body " << (*bodies_)[b].name() << ':';
        for (const materialPointCloud& cloud : clouds_)
        {
            Info<< " force of " << cloud.name() << ' '
                << cloud.loadOn(b).force << " N";
        }
        Info<< nl;
    }
    for (const relaxationZone& zone : zones_)
    {
        Info<< "relaxation zone " << zone.name() << ": took " << zone.power()
            << " W" << nl;
    }
    for (const phasePair& pair : pairs_) pair.log();
    if (solids_.size()) logBed(runTime);
    if (liquid_) logDensity();
    if (settings_.maxSoilSoundSpeed < GREAT) logImpacts();
    logRemaining(runTime);
    Info<< "ExecutionTime = " << runTime.elapsedCpuTime() << " s"
        << "  ClockTime = " << runTime.elapsedClockTime() << " s" << nl
        << endl;
}


void Foam::mpm::materialPointSystem::reportCosts() const
{
    const scalar nRanks = Pstream::nProcs();
    const scalar total = returnReduce(cost_.total(), sumOp<scalar>())/nRanks;
    const scalar pointSteps = returnReduce(pointSteps_, sumOp<scalar>());
    const label steps = clouds_[0].stepCount() - firstStep_;

    if (!steps || pointSteps == 0) return;

    auto row = [&](const char* name, const scalar seconds)
    {
        std::ostringstream os;
        os << "    " << std::left << std::setw(28) << name << std::right
           << std::fixed << std::setprecision(4) << std::setw(10) << seconds
           << std::setw(8) << std::setprecision(1) << 100*seconds/total
           << std::setw(10) << 1e9*seconds*nRanks/pointSteps;
        Info<< os.str().c_str() << nl;
    };

    Info<< "Cost" << nl
        << "    part                          seconds   % run   "
        << "ns per point and step" << nl;

    // By name: a rank that liquid and solids never share has no pore pressure
    List<stringList> names(Pstream::nProcs());
    List<scalarList> seconds(Pstream::nProcs());
    for (size_t i = 0; i < cost_.size(); ++i)
    {
        names[Pstream::myProcNo()].append(string(cost_.name(i)));
        seconds[Pstream::myProcNo()].append(cost_.seconds(i));
    }
    Pstream::gatherList(names);
    Pstream::gatherList(seconds);

    DynamicList<string> parts;
    DynamicList<scalar> sums;
    forAll(names, rank)
    {
        forAll(names[rank], i)
        {
            label part = parts.find(names[rank][i]);
            if (part < 0)
            {
                part = parts.size();
                parts.append(names[rank][i]);
                sums.append(0);
            }
            sums[part] += seconds[rank][i]/nRanks;
        }
    }
    forAll(parts, part) row(parts[part].c_str(), sums[part]);
    row("other", total - sum(sums));
    row("total", total);

    Info<< nl << "Steps: " << steps
        << "  points: " << label(std::round(pointSteps/steps))
        << "  ns per point and step: " << 1e9*total*nRanks/pointSteps
        << "  limiter: " << limiter_ << nl << endl;
}

// ************************************************************************* //
