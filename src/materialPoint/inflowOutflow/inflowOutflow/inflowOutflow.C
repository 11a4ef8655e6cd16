/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "inflowOutflow.H"
#include "reachWeights.H"
#include "effectsTable.H"
#include "dictionaryEntries.H"
#include "volFields.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::inflowOutflow::makeInlets
(
    const dictionary& dict,
    const volVectorField& U,
    const vector& g,
    const bool solid
)
{
    const dictionary all(subDictOrEmpty(dict, "inlets"));
    const wordList names(all.toc());

    inlets_.setSize(names.size());
    labelHashSet taken;
    forAll(names, i)
    {
        const dictionary& entries = subDictOf(all, names[i]);
        inlets_.set
        (
            i, new inlet(names[i], entries, grid_, U, g, solid, strict_)
        );

        bool twice = false;
        for (const label celli : inlets_[i].zone().meshCells())
        {
            twice = !taken.insert(celli) || twice;
        }
        if (returnReduce(twice, orOp<bool>()))
        {
            FatalIOErrorInFunction(entries)
                << "inlet " << inlets_[i].name() << " has cells in its zone"
                << " that belong to an inlet before it." << nl
                << "    Allowed: inlets a cell apart" << exit(FatalIOError);
        }
    }
}


void Foam::mpm::inflowOutflow::makeOutlets
(
    const dictionary& dict,
    const volVectorField& U
)
{
    const dictionary all(subDictOrEmpty(dict, "outlets"));
    for (const word& name : all.toc())
    {
        const dictionary& entries = subDictOf(all, name);
        const label i = outlets_.size();
        outlets_.setSize(i + 1);
        outlets_.set(i, outlet::New(name, entries, U, strict_).ptr());

        for (label j = 0; j < i; ++j)
        {
            if
            (
                outlets_[i].patch() >= 0
             && outlets_[i].patch() == outlets_[j].patch()
            )
            {
                FatalIOErrorInFunction(entries)
                    << "keyword patch of outlet " << name
                    << ": the patch belongs to outlet " << outlets_[j].name()
                    << '.' << nl << "    Allowed: one outlet for each patch"
                    << exit(FatalIOError);
            }
        }
    }
}


void Foam::mpm::inflowOutflow::markCells()
{
    const lattice& cells = grid_.cells();
    marks_.assign(grid_.nNodes(), 0);

    for (label celli = 0; celli < grid_.mesh().nCells(); ++celli)
    {
        const index3& i = cells.cellIndex(celli);
        point lower(Zero), upper(Zero);
        for (label d = 0; d < 3; ++d)
        {
            lower[cells.axis(d)] = cells.origin(d) + i[d]*cells.spacing(d);
            upper[cells.axis(d)] = lower[cells.axis(d)] + cells.spacing(d);
        }
        for (const outlet& out : outlets_)
        {
            if (out.overlaps(boundBox(lower, upper)))
            {
                marks_[grid_.boxCell(celli)] |= outletRegion;
            }
        }
    }
}


void Foam::mpm::inflowOutflow::makeLevelZones(const vector& g)
{
    levelZones_.setSize(outlets_.size());
    if (!anyWaterLevel()) return;

    levelOf_.assign(grid_.nNodes(), -1);
    forAll(outlets_, i)
    {
        if (!(outlets_[i].waterLevel() > -GREAT)) continue;

        levelZones_.set
        (
            i,
            new inflowZone(grid_, outlets_[i].patch(), -1, 0, 0, levelCells)
        );
        if (levelZones_[i].bent())
        {
            FatalIOErrorInFunction(outlets_[i].dict())
                << "keyword waterLevel of outlet " << outlets_[i].name()
                << ": its patch looks in different directions." << nl
                << "    Allowed: a plane patch" << exit(FatalIOError);
        }
        if (levelZones_[i].direction() == grid_.cells().along(g))
        {
            FatalIOErrorInFunction(outlets_[i].dict())
                << "keyword waterLevel of outlet " << outlets_[i].name()
                << ": its patch looks up or down, where water has no level."
                << nl << "    Allowed: a patch that looks to the side"
                << exit(FatalIOError);
        }
        for (const label celli : levelZones_[i].meshCells())
        {
            const label cell = grid_.boxCell(celli);
            levelOf_[cell] = i;
            marks_[cell] |= levelZone;
        }
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::inflowOutflow::inflowOutflow
(
    const dictionary& dict,
    const backgroundGrid& grid,
    const volVectorField& U,
    const vector& g,
    const bool solid,
    const bool strictKeywords
)
:
    grid_(grid),
    strict_(strictKeywords),
    started_(false),
    loadsKnown_(false)
{
    checkKeywords(dict, {"inlets", "outlets", "recycle"}, strictKeywords);

    waiting_.reset(new waitingZone(readSwitchOrDefault(dict, "recycle", true)));
    makeInlets(dict, U, g, solid);
    makeOutlets(dict, U);
    for (const outlet& out : outlets_)
    {
        if (!solid || !(out.waterLevel() > -GREAT)) continue;
        FatalIOErrorInFunction(out.dict())
            << "keyword waterLevel of outlet " << out.name()
            << " has no meaning for " << U.name() << ": its cloud is solid."
            << nl << "    Allowed: waterLevel in the cloud of role liquid"
            << exit(FatalIOError);
    }
    markCells();
    if (anyWaterLevel() && !(mag(g) > 0))
    {
        FatalIOErrorInFunction(dict)
            << "keyword waterLevel needs gravity." << nl
            << "    Allowed: constant/g other than zero" << exit(FatalIOError);
    }
    makeLevelZones(g);
}


Foam::autoPtr<Foam::mpm::inflowOutflow> Foam::mpm::inflowOutflow::New
(
    const dictionary& cloudDict,
    const backgroundGrid& grid,
    const volVectorField& U,
    const vector& g,
    const bool solid,
    const bool strictKeywords
)
{
    if (!cloudDict.found("inflowOutflow")) return autoPtr<inflowOutflow>();

    return autoPtr<inflowOutflow>
    (
        new inflowOutflow
        (
            subDictOf(cloudDict, "inflowOutflow"), grid, U, g, solid,
            strictKeywords
        )
    );
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

std::vector<const Foam::mpm::inflowZone*> Foam::mpm::inflowOutflow::zones
(
    const autoPtr<inflowOutflow>& open
)
{
    std::vector<const inflowZone*> result;
    if (open.valid())
    {
        for (const inlet& in : open->inlets_) result.push_back(&in.zone());
    }
    return result;
}


bool Foam::mpm::inflowOutflow::anyOpen() const
{
    for (const inlet& in : inlets_) if (in.open()) return true;
    return false;
}


bool Foam::mpm::inflowOutflow::anyRegion() const
{
    for (const outlet& out : outlets_) if (out.patch() < 0) return true;
    return false;
}


bool Foam::mpm::inflowOutflow::anyWaterLevel() const
{
    for (const outlet& out : outlets_)
    {
        if (out.waterLevel() > -GREAT) return true;
    }
    return false;
}


void Foam::mpm::inflowOutflow::reachWeights
(
    const backgroundGrid& grid,
    const scalar f,
    scalar (&w)[4],
    scalar (&g)[4]
)
{
    mpm::reachWeights(grid, f, w, g);
}


Foam::scalar Foam::mpm::inflowOutflow::speed(const scalar time) const
{
    scalar v = 0;
    for (const inlet& in : inlets_) v = max(v, in.volumeSpeed(time));
    return v;
}


Foam::scalar Foam::mpm::inflowOutflow::maxSpeed
(
    const scalar start,
    const scalar end
) const
{
    scalar v = 0;
    for (const inlet& in : inlets_) v = max(v, in.maxSpeed(start, end));
    return v;
}


Foam::scalar Foam::mpm::inflowOutflow::top(const vector& up) const
{
    scalar height = -GREAT;
    for (const inlet& in : inlets_) height = max(height, in.top(grid_, up));
    return height;
}


Foam::scalar Foam::mpm::inflowOutflow::bottom(const vector& up) const
{
    scalar height = GREAT;
    for (const inlet& in : inlets_) height = min(height, in.bottom(grid_, up));
    return height;
}


void Foam::mpm::inflowOutflow::setSpeeds
(
    const scalar time,
    nodeBoundary& boundary
)
{
    for (inlet& in : inlets_) in.setSpeed(time);
    giveSpeeds(boundary);
}


void Foam::mpm::inflowOutflow::giveSpeeds(nodeBoundary& boundary)
{
    forAll(inlets_, i)
    {
        const inlet& in = inlets_[i];
        boundary.setInflow(i, in.open(), in.velocity());
        for (const label celli : in.zone().meshCells())
        {
            char& mark = marks_[grid_.boxCell(celli)];
            mark = char(in.open() ? mark | openInlet : mark & ~openInlet);
        }
    }
}


void Foam::mpm::inflowOutflow::rebuild(const vector& g)
{
    for (inlet& in : inlets_) in.makeZone(grid_);
    markCells();
    makeLevelZones(g);
    loadsKnown_ = false;
}


Foam::label Foam::mpm::inflowOutflow::outletOfPatch(const label patchi) const
{
    forAll(outlets_, i) if (outlets_[i].patch() == patchi) return i;
    return -1;
}


Foam::label Foam::mpm::inflowOutflow::outletAt
(
    const point& x,
    const label celli
) const
{
    forAll(outlets_, i) if (outlets_[i].contains(x, celli)) return i;
    return -1;
}


void Foam::mpm::inflowOutflow::leave
(
    const label outlet,
    const label step,
    const scalar id,
    const scalar mass
)
{
    (outlet < 0 ? elsewhere_ : outlets_[outlet].left()).add(mass);
    waiting_->arrive(step, id, mass);
}


void Foam::mpm::inflowOutflow::start
(
    const massAccount& inside,
    const scalar maxId
)
{
    started_ = true;

    // One rank carries the sum
    const massAccount all(inside.global());
    initial_ = Pstream::master() ? all : massAccount();
    waiting_->setNextId(returnReduce(maxId, maxOp<scalar>()) + 1);
}


Foam::mpm::inflowOutflow::balance Foam::mpm::inflowOutflow::accounts
(
    const massAccount& inside
) const
{
    balance b;
    b.initial = initial_.global();
    b.inside = inside.global();
    b.elsewhere = elsewhere_.global();
    massAccount entered, left;
    for (const inlet& in : inlets_) entered += in.entered();
    for (const outlet& out : outlets_) left += out.left();
    b.entered = entered.global();
    b.left = left.global();
    b.waiting = waiting_->waiting();
    b.allocated = b.initial.n + b.entered.n - waiting_->nReused();
    return b;
}


void Foam::mpm::inflowOutflow::read(const dictionary& dict)
{
    started_ = dict.found("inflowOutflow");
    if (!started_) return;

    const dictionary& state = dict.subDict("inflowOutflow");
    initial_.read(state, "initial");
    elsewhere_.read(state, "elsewhere");
    waiting_->read(state);

    // What an inlet or outlet that is gone has counted goes to the start
    for (const bool in : {true, false})
    {
        const dictionary& all = state.subDict(in ? "inlets" : "outlets");
        for (const entry& e : all)
        {
            bool found = false;
            if (in)
            {
                for (inlet& i : inlets_)
                {
                    if (i.name() != e.keyword()) continue;
                    i.read(e.dict());
                    found = true;
                }
            }
            else
            {
                for (outlet& o : outlets_)
                {
                    if (o.name() != e.keyword()) continue;
                    o.left().read(e.dict(), "left");
                    found = true;
                }
            }
            if (found) continue;

            massAccount old;
            old.read(e.dict(), in ? "entered" : "left");
            if (in) initial_ += old;
            else initial_ -= old;
        }
    }
}


void Foam::mpm::inflowOutflow::write(dictionary& dict) const
{
    dictionary state, in, out;
    initial_.write(state, "initial");
    elsewhere_.write(state, "elsewhere");
    waiting_->write(state);
    for (const inlet& i : inlets_)
    {
        dictionary own;
        i.write(own);
        in.set(i.name(), own);
    }
    for (const outlet& o : outlets_)
    {
        dictionary own;
        o.left().write(own, "left");
        out.set(o.name(), own);
    }
    state.set("inlets", in);
    state.set("outlets", out);
    dict.set("inflowOutflow", state);
}


void Foam::mpm::inflowOutflow::effects(effectsTable& table) const
{
    table.add
    (
        "  open boundaries", true,
        recycle() ? "points are recycled" : "memory of points that left is kept"
    );
    for (const inlet& in : inlets_)
    {
        table.add
        (
            "    inlet " + in.name(), true,
            Foam::name(label(in.places().size())) + " points in a layer of "
          + Foam::name(in.layerVolume()) + " m3"
        );
    }
    for (const outlet& out : outlets_)
    {
        table.add("    outlet " + out.name(), true, out.description());
    }
}

// ************************************************************************* //
