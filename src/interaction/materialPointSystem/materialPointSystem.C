/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "listed.H"
#include "materialPointSystem.H"
#include "waterCloud.H"
#include "soilCloud.H"
#include "bodies.H"
#include "expectedPoints.H"
#include "momentumStep.H"
#include "movingFrame.H"
#include "phasePair.H"
#include "relaxationZone.H"
#include "functionNeeds.H"
#include "phaseRole.H"
#include "dictionaryEntries.H"
#include "uniformDimensionedFields.H"
#include "zeroGradientFvPatchFields.H"
#include "PstreamReduceOps.H"
#include "debug.H"
#include "registerSwitch.H"
#include <cmath>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    //- Names with blanks between
    Foam::string joined(const Foam::UList<Foam::word>& names)
    {
        Foam::string all;
        for (const Foam::word& name : names)
        {
            all += (all.empty() ? "" : " ") + name;
        }
        return all;
    }

    //- Debug switch, off. Steps between two rebuilds: they change no number.
    int rebuildInterval(Foam::debug::debugSwitch("mpmRebuildInterval", 0));

    Foam::RegisterSwitch<int> addRebuildInterval
    (
        Foam::debug::addDebugObject, "mpmRebuildInterval", rebuildInterval
    );
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointSystem::readSettings()
{
    settings_.strictKeywords =
        readSwitchOrDefault(control_, "strictKeywords", true);
    settings_.smoothing = readSwitchOrDefault(control_, "smoothing", true);
    settings_.volumeCorrection =
        readSwitchOrDefault(control_, "volumeCorrection", true);
    settings_.overlapCorrection =
        readSwitchOrDefault(control_, "overlapCorrection", false);
    if (settings_.overlapCorrection && !settings_.volumeCorrection)
    {
        FatalIOErrorInFunction(control_)
            << "keyword overlapCorrection is yes, but volumeCorrection is no."
            << nl << "    Allowed: no, or volumeCorrection yes"
            << exit(FatalIOError);
    }
    settings_.looseningCorrection =
        readSwitchOrDefault(control_, "looseningCorrection", false);
    settings_.sortInterval =
        readIntegerOrDefault(control_, "sortInterval", 10, 1, 999999);

    settings_.maxSoilSoundSpeed =
        control_.found("maxSoilSoundSpeed")
      ? readPositive(control_, "maxSoilSoundSpeed", dimVelocity)
      : GREAT;

    settings_.gravityInTime = control_.found("gravity");
    if (control_.found("relaxation"))
    {
        const dictionary& relaxation = control_.subDict("relaxation");
        checkKeywords
        (
            relaxation, {"until", "damping"}, settings_.strictKeywords
        );
        settings_.relaxationUntil = readPositive(relaxation, "until", dimTime);
        settings_.relaxationDamping =
            readBoundedOrDefault(relaxation, "damping", dimless, 0.7, 0, 1);
    }

    settings_.energyBalance.clear();
    functionNeeds::forAllFunctions
    (
        time_,
        [&](const dictionary& dict, const functionNeeds& needs)
        {
            if
            (
                needs.energyBalance
             && dict.lookupOrDefault<Switch>("enabled", true)
            )
            {
                settings_.energyBalance.append
                (
                    dict.lookupOrDefault<word>("cloud", word::null)
                );
            }
        }
    );

    checkKeywords
    (
        control_,
        {
            "shapeFunction", "maxCo", "sortInterval", "smoothing",
            "volumeCorrection", "overlapCorrection", "looseningCorrection",
            "maxSoilSoundSpeed", "pressureForm", "logInterval",
            "strictKeywords", "gravity", "relaxation", "momentum"
        },
        settings_.strictKeywords
    );

    // Others have their entries in controlDict, too
    checkNearMisses
    (
        time_.controlDict(),
        {
            "application", "startFrom", "startTime", "stopAt", "endTime",
            "deltaT", "adjustTimeStep", "maxCo", "maxDeltaT", "writeControl",
            "writeInterval", "purgeWrite", "writeFormat", "writePrecision",
            "writeCompression", "timeFormat", "timePrecision",
            "runTimeModifiable", "libs", "functions", "DebugSwitches",
            "InfoSwitches", "OptimisationSwitches"
        },
        {"minDeltaT", "maxAlphaCo", "maxDi", "graphFormat", "writeVersion"},
        settings_.strictKeywords
    );

    logInterval_ =
        readIntegerOrDefault(control_, "logInterval", 10, 1, 999999999);

    const dictionary& coDict =
        control_.found("maxCo") ? control_ : time_.controlDict();
    maxCo_ = readBoundedOrDefault
    (
        coDict, "maxCo", dimless, 0.5, 0, stepLimits::stableCo
    );
    if (maxCo_ > 0.7)
    {
        IOWarningInFunction(coDict)
            << "maxCo " << maxCo_ << " is beyond the range that was found"
            << " stable for water (0.7)." << endl;
    }
}


void Foam::mpm::materialPointSystem::readGravity()
{
    const uniformDimensionedVectorField g
    (
        IOobject
        (
            "g",
            time_.constant(),
            time_,
            IOobject::MUST_READ,
            IOobject::NO_WRITE,
            false
        )
    );
    if (g.dimensions() != dimAcceleration)
    {
        FatalErrorInFunction
            << "file " << g.objectPath() << ": keyword dimensions is "
            << g.dimensions() << "; it must be " << dimAcceleration
            << exit(FatalError);
    }
    g_ = g.value();

    label steepest = 0;
    for (label d = 1; d < 3; ++d)
    {
        if (mag(g_[d]) > mag(g_[steepest])) steepest = d;
    }
    if (g_[steepest] > 0)
    {
        WarningInFunction
            << "file " << g.objectPath() << ": keyword value is " << g_
            << ": things fall towards +" << vector::componentNames[steepest]
            << '.' << nl << "    Usual: a negative component, as (0 -9.81 0)"
            << nl << "    Levels and depths follow the gravity given."
            << nl << endl;
    }

    if (grid_.nDim() == 2)
    {
        const label e = grid_.cells().axis(2);
        if (mag(g_[e]) > SMALL)
        {
            FatalErrorInFunction
                << "file " << g.objectPath() << ": keyword value is " << g_
                << ", but the case is two-dimensional and empty in direction "
                << vector::componentNames[e] << ", where gravity must be zero."
                << exit(FatalError);
        }
    }
}


void Foam::mpm::materialPointSystem::readForces()
{
    gravityInTime_ =
        vectorInTime::New(control_, "gravity", dimAcceleration, grid_.cells());
    if (liquid_)
    {
        pressureGradient_ = vectorInTime::New
        (
            properties_.subDict(liquid_->name()), "pressureGradient",
            dimPressure/dimLength, grid_.cells()
        );
    }

    if (properties_.found("frame"))
    {
        frame_.reset
        (
            new movingFrame
            (
                subDictOf(properties_, "frame"), grid_.cells(),
                settings_.strictKeywords
            )
        );
        for (label b = 0; bodies_.valid() && b < bodies_->size(); ++b)
        {
            if (!frame_->turns() || !(*bodies_)[b].motion().pushed()) continue;
            FatalIOErrorInFunction(properties_)
                << "body " << (*bodies_)[b].name() << " is rigid, and the frame"
                << " of the mesh turns: what that does to it is not there."
                << nl << "    Allowed: bodies that are fixed or prescribed, or a"
                << " frame with acceleration only" << exit(FatalIOError);
        }
    }

    forced_ = false;
    for (materialPointCloud& cloud : clouds_)
    {
        if (frame_.valid()) cloud.setForced();
        if (pressureGradient_.valid()) cloud.setForced();
        forced_ = forced_ || cloud.forced();
    }
}


Foam::vector Foam::mpm::materialPointSystem::gravityAt(const scalar time) const
{
    const vector g(gravityInTime_.valid() ? gravityInTime_->value(time) : g_);
    return frame_.valid() ? frame_->uniform(g, time) : g;
}


void Foam::mpm::materialPointSystem::setForces(const scalar deltaT)
{
    // At mid-step
    const scalar time = time_.value() - 0.5*deltaT;

    if (forced_)
    {
        const vector common(gravityAt(time) - g_);
        const vector gradient
        (
            pressureGradient_.valid() ? pressureGradient_->value(time) : Zero
        );
        forAll(clouds_, i)
        {
            clouds_[i].setForce
            (
                common + clouds_[i].bodyForce(time) - gradient/density_[i]
            );
        }
    }
    if (settings_.relaxationDamping > 0)
    {
        const bool relaxes = time < settings_.relaxationUntil;
        for (materialPointCloud& cloud : clouds_)
        {
            cloud.setDamping(relaxes ? settings_.relaxationDamping : 0);
        }
        if (relaxed_ && !relaxes)
        {
            for (const materialPointCloud& cloud : clouds_)
            {
                Info<< cloud.name() << ": relaxation ended, it gave "
                    << returnReduce(cloud.relaxationWork(), sumOp<scalar>())
                    << " J and "
                    << returnReduce
                       (
                           cloud.relaxationImpulse(), sumOp<vector>()
                       )
                    << " kg m/s" << nl;
            }
            Info<< endl;
        }
        relaxed_ = relaxes;
    }
}


Foam::wordList Foam::mpm::materialPointSystem::cloudNames() const
{
    if (!properties_.found("clouds"))
    {
        // The misspelt keyword is named, if there is one
        wordList entries({"clouds", "interaction", "bodies"});
        for (const entry& e : properties_)
        {
            if (e.isDict()) entries.append(e.keyword());
        }
        checkKeywords(properties_, entries, true);
    }
    const wordList names(properties_.get<wordList>("clouds"));

    if (names.empty())
    {
        FatalIOErrorInFunction(properties_)
            << "keyword clouds is empty." << nl
            << "    Allowed: names of clouds, as (water), (soil), (water soil)"
            << exit(FatalIOError);
    }

    // Of entries in the same dictionaries, and of fields on the mesh
    const wordList reserved
    ({
        "clouds", "interaction", "bodies", "case", "time", "complete", "mesh", "MPM",
        "gravity", "adjustTimeStep", "p", "phi"
    });
    forAll(names, i)
    {
        if (reserved.found(names[i]))
        {
            FatalIOErrorInFunction(properties_)
                << "keyword clouds names " << names[i] << ", which has another"
                << " meaning." << nl << "    Allowed: any name but "
                << listed(reserved) << exit(FatalIOError);
        }
        if (names.find(names[i]) != i)
        {
            FatalIOErrorInFunction(properties_)
                << "keyword clouds names " << names[i] << " twice." << nl
                << "    Allowed: each name once" << exit(FatalIOError);
        }
    }
    return names;
}


void Foam::mpm::materialPointSystem::checkDictionaries
(
    const wordList& names
) const
{
    const string clouds("clouds is (" + joined(names) + ").\n    Allowed: ");
    wordList known(names);
    known.append("clouds");
    known.append("bodies");
    known.append("frame");
    if (settings_.coupled) known.append("interaction");

    for (const entry& e : properties_)
    {
        const word& left = e.keyword();
        if (!e.isDict() || known.found(left)) continue;

        // Known is what it could be
        known.append(left);
        wordList more(names);
        more.append(left);
        reportEntry
        (
            properties_,
            "dictionary " + left + " is not used: " + clouds
          + (
                left == "interaction"
              ? string("a liquid and a solid in clouds")
              : "clouds (" + joined(more) + ')'
            )
          + ", or no dictionary " + left,
            settings_.strictKeywords
        );
    }
    checkKeywords(properties_, known, settings_.strictKeywords);
}


void Foam::mpm::materialPointSystem::checkVelocityFields
(
    const wordList& solids
) const
{
    // Clouds that name each other share the field of the first of them
    labelList field(identity(solids.size()));
    for (label pass = 0; pass < solids.size(); ++pass)
    {
        forAll(solids, i)
        {
            const dictionary& dict = properties_.subDict(solids[i]);
            const word name
            (
                dict.lookupOrDefault<word>("velocityField", solids[0])
            );
            const label other = solids.find(name);
            if (other < 0)
            {
                FatalIOErrorInFunction(dict)
                    << "keyword velocityField is " << name
                    << ", which is no solid cloud of this case." << nl
                    << "    Allowed: one of " << listed(solids)
                    << exit(FatalIOError);
            }
            const label first = min(field[i], field[other]);
            field[i] = field[other] = first;
        }
    }
    forAll(solids, i)
    {
        if (field[i] == 0) continue;
        const dictionary& dict = properties_.subDict(solids[i]);
        FatalIOErrorInFunction(dict)
            << "keyword velocityField is " << dict.get<word>("velocityField")
            << ": the clouds " << solids[i] << " and " << solids[0]
            << " would move through each other, as nothing acts between two"
            << " velocity fields of solids." << nl << "    Allowed: "
            << solids[0] << exit(FatalIOError);
    }
}


Foam::mpm::waterCloud* Foam::mpm::materialPointSystem::newLiquid
(
    const word& name
)
{
    const dictionary& dict = properties_.subDict(name);
    waterCloud::checkDictionary(dict, settings_.strictKeywords);
    return new waterCloud(name, mesh_, grid_, dict, settings_, cost_, g_);
}


Foam::mpm::soilCloud* Foam::mpm::materialPointSystem::newSolid
(
    const word& name,
    const label nSolids
)
{
    const dictionary& dict = properties_.subDict(name);
    soilCloud::checkDictionary(dict, settings_.strictKeywords);

    auto needsBed = [&](const word& keyword, const word& without)
    {
        const word value(dict.lookupOrDefault<word>(keyword, without));
        if (value == without || (settings_.coupled && nSolids == 1)) return;

        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " is " << value << ", but there is "
            << (nSolids > 1 ? "more than one solid." : "no liquid.") << nl
            << "    Allowed: " << without
            << ", or a liquid and one solid in clouds"
            << exit(FatalIOError);
    };
    needsBed("bedLoad", "none");
    needsBed("bedStress", "drag");
    return new soilCloud
    (
        name, mesh_, grid_, dict, settings_, cost_, g_,
        solids_.size() ? solids_[0] : nullptr
    );
}


void Foam::mpm::materialPointSystem::makeClouds()
{
    const wordList names(cloudNames());

    DynamicList<word> liquids, solids;
    for (const word& name : names)
    {
        if (!properties_.found(name))
        {
            // As above
            wordList known(names);
            known.append("clouds");
            known.append("interaction");
            known.append("bodies");
            known.append("frame");
            checkKeywords(properties_, known, true);
        }
        const phaseRole role = roleOf(subDictOf(properties_, name));
        (role == phaseRole::liquid ? liquids : solids).append(name);
    }
    if (liquids.size() > 1)
    {
        FatalIOErrorInFunction(properties_)
            << "keyword clouds has more than one cloud of the role liquid: "
            << listed(liquids) << nl
            << "    Allowed: one liquid, and any number of solids"
            << exit(FatalIOError);
    }
    settings_.coupled = liquids.size() && solids.size();
    checkDictionaries(names);
    checkVelocityFields(solids);

    clouds_.setSize(names.size());
    density_.setSize(names.size());
    forAll(names, i)
    {
        if (liquids.found(names[i]))
        {
            liquid_ = newLiquid(names[i]);
            clouds_.set(i, liquid_);
            density_[i] = liquid_->fluid().rho0();
        }
        else
        {
            soilCloud* solid = newSolid(names[i], solids.size());
            solids_.append(solid);
            clouds_.set(i, solid);
            density_[i] = solid->model().rhoS();
        }
    }
    if (liquid_)
    {
        zones_ = relaxationZone::NewAll
        (
            properties_.subDict(liquid_->name()), *liquid_,
            settings_.strictKeywords
        );
    }

    // Checked in a scene with one phase, too
    (void)readChoiceOrDefault
        (control_, "pressureForm", "gradient", {"gradient", "divergence"});
    if (settings_.coupled)
    {
        for (soilCloud* solid : solids_) solid->setLiquid(*liquid_);
        pairs_ = phasePair::NewAll
        (
            phasePair::phases
            {
                *liquid_, solids_, properties_, control_,
                settings_.strictKeywords, cost_
            }
        );
    }
}


void Foam::mpm::materialPointSystem::updateBodyDistance()
{
    // Where it is farther than bodies know
    const scalar far = (body::reach + 1)*grid_.cells().minSpacing();
    volScalarField& distance = *bodyDistance_;
    const vectorField& centres = mesh_.cellCentres();
    forAll(centres, celli)
    {
        scalar phi;
        bodies_->nearest(centres[celli], phi);
        distance[celli] = min(phi, far);
    }
    distance.correctBoundaryConditions();
}


void Foam::mpm::materialPointSystem::readBodies()
{
    if (!properties_.found("bodies")) return;

    bodies_.reset
    (
        new bodies
        (
            grid_, subDictOf(properties_, "bodies"), cloudNames(),
            settings_.strictKeywords
        )
    );
    if (!bodies_->size())
    {
        bodies_.clear();
        return;
    }

    // They have nodes of their own, which clouds have to know
    const std::vector<plate> plates(bodies_->plates());
    if (plates.size())
    {
        grid_.setPlates(plates);
        grid_.rebuild();
    }
}


void Foam::mpm::materialPointSystem::makeBodies()
{
    if (!bodies_.valid()) return;

    bodies_->start(time_.value());
    for (materialPointCloud& cloud : clouds_) cloud.addBodies(*bodies_);
    bodyDistance_.reset
    (
        new volScalarField
        (
            IOobject
            (
                "bodyDistance",
                time_.timeName(),
                mesh_,
                IOobject::NO_READ,
                IOobject::AUTO_WRITE
            ),
            mesh_,
            dimensionedScalar(dimLength, Zero),
            zeroGradientFvPatchScalarField::typeName
        )
    );
    updateBodyDistance();
}


void Foam::mpm::materialPointSystem::makeMomentum()
{
    momentum_ = momentumStep::New
    (
        control_,
        momentumStep::scene
        {
            clouds_, liquid_, solids_, pairs_, zones_, bodies_.get(),
            frame_.valid() && frame_->turns() ? frame_.get() : nullptr,
            [this]()
            {
                return gravityAt(time_.value() - 0.5*time_.deltaTValue());
            },
            cost_
        }
    );
}


void Foam::mpm::materialPointSystem::findFieldControls()
{
    functionNeeds::forAllFunctions
    (
        time_,
        [&](const dictionary& dict, const functionNeeds& needs)
        {
            if (needs.fields == functionNeeds::NO_FIELDS) return;

            fieldControls_.append(new timeControl(time_, dict, "write"));
            if (needs.fields == functionNeeds::ANY_TIME)
            {
                fieldControls_.append(new timeControl(time_, dict, "execute"));
            }
        }
    );
}


void Foam::mpm::materialPointSystem::addWriteInterval
(
    const dictionary& dict,
    const word& keyword
)
{
    const scalar interval = readPositive(dict, keyword, dimTime);

    // Names of times at the end of a first step of deltaT
    const dictionary& control = time_.controlDict();
    const scalar deltaT = control.lookupOrDefault<scalar>("deltaT", 0);
    const scalar remaining = time_.endTime().value() - time_.value();
    const scalar later =
        time_.value() + max(scalar(0), min(deltaT, remaining));
    const label digits = control.lookupOrDefault<label>("timePrecision", 6);
    const word format(control.lookupOrDefault<word>("timeFormat", "general"));
    const scalar leading =
        format == "fixed" || later <= 0 ? 0 : std::floor(std::log10(later));
    const scalar resolution =
        std::pow(10.0, leading - digits + (format == "general"));

    if (interval < resolution)
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " is " << interval << " s, less than"
            << " the names of times tell apart (" << resolution << " s at "
            << later << " s, timePrecision " << digits << ")." << nl
            << "    Allowed: " << keyword << " >= " << resolution
            << ", or a larger timePrecision in controlDict"
            << exit(FatalIOError);
    }
    writeIntervals_.append(interval);
}


void Foam::mpm::materialPointSystem::findWriteIntervals()
{
    const dictionary& dict = time_.controlDict();

    if
    (
        dict.lookupOrDefault<word>("writeControl", "timeStep")
     == "adjustableRunTime"
    )
    {
        addWriteInterval(dict, "writeInterval");
    }
    for (const entry& e : subDictOrEmpty(dict, "functions"))
    {
        if (!e.isDict()) continue;
        for (const word& prefix : {word("write"), word("execute")})
        {
            const word control
            (
                e.dict().lookupOrDefault<word>(prefix + "Control", "none")
            );
            if (control == "adjustable" || control == "adjustableRunTime")
            {
                addWriteInterval(e.dict(), prefix + "Interval");
            }
        }
    }
}


Foam::scalar Foam::mpm::materialPointSystem::nextWriteTime()
{
    // What counts as the same time, in intervals
    const scalar same = 1e-6;

    // The relaxation ends with a step, too
    scalar next =
        time_.value() < settings_.relaxationUntil
      ? settings_.relaxationUntil : GREAT;
    forAll(writeIntervals_, i)
    {
        const scalar interval = writeIntervals_[i];
        scalar& named = writeTimes_[i];

        // The same until time comes to it: names cost as much as 20 points
        if (time_.value() < named - same*interval)
        {
            next = min(next, named);
            continue;
        }

        // Time counts intervals from its start; most starts are multiples
        const scalar start = time_.startTime().value();
        scalar base = start - interval*std::round(start/interval);
        if (mag(base) < same*interval) base = 0;

        // As a restart reads it from the name of the directory; that may be
        // short of a multiple (a third of a second), which is then passed
        // Several multiples may share a name: names do not decrease with the
        // count, so that the first later one is found by halving
        auto name = [&](const scalar count)
        {
            return readScalar(Time::timeName(base + count*interval));
        };
        scalar passed = std::floor((time_.value() - base)/interval + same);
        const scalar one = max(scalar(1), 1e-15*passed);
        scalar ahead = passed + one;
        while ((named = name(ahead)) <= time_.value())
        {
            const scalar step = 2*(ahead - passed);
            passed = ahead;
            ahead += step;
        }
        while (ahead - passed > one)
        {
            const scalar middle = std::floor(0.5*(passed + ahead));
            if (name(middle) <= time_.value()) passed = middle;
            else ahead = middle;
        }
        named = name(ahead);
        next = min(next, named);
    }
    return next;
}


void Foam::mpm::materialPointSystem::addLimits()
{
    limits_.reset(new stepLimits(maxCo_));
    momentum_->addLimits(*limits_);

    limits_->addMaximum
    (
        stepLimits::end,
        [this]()
        {
            nonFinite_.clear();
            for (const materialPointCloud& cloud : clouds_)
            {
                if (nonFinite_.empty()) nonFinite_ = cloud.firstNonFinite();
            }
            return scalar(!nonFinite_.empty());
        },
        anyNonFinite_
    );
}


Foam::scalar Foam::mpm::materialPointSystem::limitDeltaT()
{
    // No step was made yet
    limits_->reduceFirst(stepLimits::end);
    limits_->reduce(stepLimits::start);

    flowSpeed_ = 0;
    signalSpeed_ = 0;
    for (const materialPointCloud& cloud : clouds_)
    {
        const scalar speed = cloud.globalMaxSpeed();
        flowSpeed_ = max(flowSpeed_, speed);
        signalSpeed_ = max(signalSpeed_, cloud.waveSpeed() + speed);
    }
    const scalar limit = limits_->smallest(limiter_);
    if (!bodies_.valid() || !bodies_->anyMoves()) return limit;

    // The water that it pushes is not as fast yet
    const scalar speed = bodies_->maxSpeed();
    const scalar h = grid_.cells().minSpacing();
    if (speed*limit <= h) return limit;
    limiter_ = "body speed";
    return h/speed;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::materialPointSystem::materialPointSystem(const fvMesh& mesh)
:
    mesh_(mesh),
    time_(mesh.time()),
    properties_
    (
        IOobject
        (
            "materialPointProperties",
            time_.constant(),
            mesh,
            IOobject::MUST_READ,
            IOobject::NO_WRITE
        )
    ),
    control_(subDictOrEmpty(mesh.solutionDict(), "MPM")),
    grid_(mesh, control_),
    liquid_(nullptr),
    bodiesMoved_(false),
    forced_(false),
    relaxed_(false),
    limiter_("none"),
    flowSpeed_(0),
    signalSpeed_(0),
    anyNonFinite_(0),
    firstStep_(0),
    pointSteps_(0),
    maxPoints_(0),
    logThisStep_(true),
    startTime_(0),
    startSpeed_(0),
    falls_(false),
    fallsKnown_(false),
    fieldsCurrent_(false),
    stepsSinceRebuild_(0),
    target_(GREAT),
    stopped_(false)
{
    readSettings();
    readGravity();
    readBodies();
    makeClouds();
    makeBodies();
    readForces();
    makeMomentum();
    findFieldControls();
    findWriteIntervals();
    writeTimes_.setSize(writeIntervals_.size(), -GREAT);
    addLimits();
    record_.addMesh(grid_.cells());
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::materialPointSystem::~materialPointSystem()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::mpm::waterCloud& Foam::mpm::materialPointSystem::liquid(const word& user)
{
    if (!liquid_)
    {
        FatalIOErrorInFunction(properties_)
            << user << " needs a cloud of the role liquid." << nl
            << "    keyword clouds: add one" << exit(FatalIOError);
    }
    return *liquid_;
}


Foam::mpm::materialPointCloud& Foam::mpm::materialPointSystem::cloud
(
    const word& name
)
{
    DynamicList<word> names;
    for (materialPointCloud& c : clouds_)
    {
        if (c.name() == name) return c;
        names.append(c.name());
    }
    FatalIOErrorInFunction(properties_)
        << "there is no cloud " << name << nl << "    Clouds of this case: "
        << listed(names) << exit(FatalIOError);
    return clouds_[0];
}


void Foam::mpm::materialPointSystem::startDeltaT(Time& runTime)
{
    startRemaining(runTime);

    // A run that ended may have a little left
    if (runTime.timeIndex() > 0) return;

    const scalar whole = runTime.endTime().value() - runTime.value();
    if
    (
        0.5*runTime.deltaTValue() < whole
     || whole <= 0
     || Time::timeName(runTime.endTime().value()) == runTime.timeName()
    )
    {
        return;
    }
    if (runTime.controlDict().lookupOrDefault<Switch>("adjustTimeStep", false))
    {
        runTime.setDeltaT(whole, false);
    }
    else
    {
        FatalIOErrorInFunction(runTime.controlDict())
            << "keyword deltaT is " << runTime.deltaTValue()
            << " s, longer than the run from " << runTime.timeName() << " to "
            << runTime.endTime().value() << " s." << nl
            << "    Allowed: deltaT <= " << whole
            << " s, or adjustTimeStep yes" << exit(FatalIOError);
    }
}


void Foam::mpm::materialPointSystem::setDeltaT(Time& runTime)
{
    cost_.start("time step");
    const scalar limit = limitDeltaT();
    cost_.stop();

    if (runTime.controlDict().lookupOrDefault<Switch>("adjustTimeStep", false))
    {
        const scalar maxDeltaT =
            runTime.controlDict().lookupOrDefault<scalar>("maxDeltaT", GREAT);
        if (!(maxDeltaT > 0))
        {
            // Only for its message: costly each step
            readPositive(runTime.controlDict(), "maxDeltaT", dimTime);
        }
        scalar deltaT = maxCo_*limit;
        if (maxDeltaT < deltaT)
        {
            deltaT = maxDeltaT;
            limiter_ = "maxDeltaT";
        }

        // Only the last two steps before a write time are cut, and time is
        // set to it exactly (advance): a restarted run takes the same steps
        // as one that went on
        const scalar next = nextWriteTime();
        const scalar remaining = next - runTime.value();
        target_ = GREAT;
        if (deltaT >= (1 - 1e-9)*remaining)
        {
            deltaT = remaining;
            target_ = next;
        }
        else if (2*deltaT > remaining)
        {
            deltaT = 0.5*remaining;
        }
        runTime.setDeltaT(deltaT, false);
    }
    else
    {
        limiter_ = "deltaT";
        const scalar Co = runTime.deltaTValue()/limit;
        if (Co > stepLimits::stableCo)
        {
            FatalIOErrorInFunction(runTime.controlDict())
                << "keyword deltaT is " << runTime.deltaTValue()
                << " s: the Courant number of sound plus flow is " << Co
                << ", beyond the limit of stability." << nl
                << "    Allowed: deltaT <= " << maxCo_*limit
                << " s (maxCo " << maxCo_ << "), or adjustTimeStep yes"
                << exit(FatalIOError);
        }
    }
}


void Foam::mpm::materialPointSystem::advance(Time& runTime)
{
    ++runTime;
    if (target_ < GREAT)
    {
        runTime.setTime(target_, runTime.timeIndex());
        target_ = GREAT;
    }
}


void Foam::mpm::materialPointSystem::stop(Time& runTime, const string& reason)
{
    if (stopped_) return;

    Info<< reason.c_str() << ": writing a restart and ending the run" << nl
        << endl;
    runTime.stopAt(Time::stopAtControls::saWriteNow);
    stopped_ = true;
}


void Foam::mpm::materialPointSystem::particlesToGrid()
{
    if (rebuildInterval > 0 && ++stepsSinceRebuild_ > rebuildInterval)
    {
        rebuild();
    }
    if (bodiesMoved_)
    {
        cost_.start("bodies: geometry");
        if (bodies_->anyPlateMoves() && grid_.recordsStale()) rebuild(true);
        else for (materialPointCloud& cloud : clouds_) cloud.placeBodies();
        cost_.stop();
        bodiesMoved_ = false;
    }
    for (materialPointCloud& cloud : clouds_) cloud.particlesToGrid();
    if (solids_.size())
    {
        cost_.start("strain rates", &solids_[0]->name());
        solids_[0]->findStrainRates();
        cost_.stop();
    }
    for (phasePair& pair : pairs_) pair.startNodes();
    fieldsCurrent_ = false;
}


void Foam::mpm::materialPointSystem::moveNodes()
{
    const scalar deltaT = time_.deltaTValue();

    if (frame_.valid()) frame_->start(time_.value(), deltaT);
    setForces(deltaT);
    if (bodies_.valid()) bodies_->findVelocities(time_.value(), deltaT);
    momentum_->solve(deltaT);
}


void Foam::mpm::materialPointSystem::gridToParticles()
{
    const scalar deltaT = time_.deltaTValue();
    for (materialPointCloud& cloud : clouds_)
    {
        pointSteps_ += cloud.size();
        cloud.gridToParticles(deltaT);
        if (forced_ && cloud.energyBalance())
        {
            cost_.start("work of body forces");
            cloud.addForceWork(deltaT);
            if (frame_.valid() && frame_->turns()) frame_->addWork(cloud);
            cost_.stop();
        }
    }
    for (phasePair& pair : pairs_) pair.finishPoints(deltaT);
    if (bodies_.valid() && bodies_->anyMoves())
    {
        bodies_->move(time_.value(), deltaT);
        if (bodies_->anyPlateMoves()) grid_.setPlates(bodies_->plates());
        bodiesMoved_ = true;
    }
}


void Foam::mpm::materialPointSystem::rebuild(const bool recordsOnly)
{
    stepsSinceRebuild_ = 1;
    if (recordsOnly) grid_.renewRecords();
    else grid_.rebuild();
    for (materialPointCloud& cloud : clouds_) cloud.rebuild();
    for (phasePair& pair : pairs_) pair.rebuild();
    for (relaxationZone& zone : zones_) zone.place();
}


void Foam::mpm::materialPointSystem::relocate()
{
    const scalar deltaT = time_.deltaTValue();
    for (materialPointCloud& cloud : clouds_) cloud.relocate(deltaT);
}


void Foam::mpm::materialPointSystem::endStep(Time& runTime)
{
    cost_.start("time step");
    limits_->reduce(stepLimits::end);
    cost_.stop();

    if (anyNonFinite_ > 0)
    {
        string found(nonFinite_);

        // Velocities spread over the nodes to all clouds in one step; a state
        // that is not finite is nearer to the cause
        string state;
        for (const soilCloud* solid : solids_)
        {
            if (state.empty()) state = solid->nonFiniteState();
        }
        if (state.empty() && liquid_) state = liquid_->nonFiniteState();

        List<stringList> ofRank(Pstream::nProcs());
        ofRank[Pstream::myProcNo()] = stringList({state, found});
        Pstream::gatherList(ofRank);
        if (Pstream::master())
        {
            found = string();
            for (const label what : {0, 1})
            {
                for (const stringList& texts : ofRank)
                {
                    if (found.empty()) found = texts[what];
                }
            }
        }
        Info<< "--> non-finite value at time " << runTime.timeName() << ": "
            << found.c_str() << nl << endl;

        // For inspection; without its state file no run restarts from it
        runTime.writeNow();

        FatalErrorInFunction
            << "non-finite value at time " << runTime.timeName() << " (step "
            << clouds_[0].stepCount() << "): " << found.c_str() << nl
            << "    Time step " << runTime.deltaTValue() << " s, limiter: "
            << limiter_ << nl << "    The state was written to "
            << runTime.timePath() << " for inspection." << nl
            << "    Restart from the write time before it, with a smaller"
            << " maxCo; if it stops again, look at the state named above: a"
            << " void ratio or volume ratio near zero asks for stiffer soil"
            << " (E0, E, maxSoilSoundSpeed) or a higher soundSpeed."
            << exit(FatalError);
    }
}


void Foam::mpm::materialPointSystem::updateMeshFields()
{
    bool due = time_.writeTime();
    for (timeControl& control : fieldControls_)
    {
        due = control.execute() || due;
    }
    if (due && !fieldsCurrent_)
    {
        cost_.start("fields on the mesh");
        for (materialPointCloud& cloud : clouds_) cloud.updateMeshFields();
        if (bodies_.valid() && bodies_->anyMoves()) updateBodyDistance();
        cost_.stop();
        fieldsCurrent_ = true;
    }
}

// ************************************************************************* //
