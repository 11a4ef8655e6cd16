/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterSoilInteraction.H"
#include "effectsTable.H"
#include "waterCloud.H"
#include "soilCloud.H"
#include "dictionaryEntries.H"
#include "addToRunTimeSelectionTable.H"
#include "debug.H"
#include "PstreamReduceOps.H"
#include "registerSwitch.H"
#include <algorithm>
#include <limits>

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(waterSoilInteraction, 0);
    addToRunTimeSelectionTable(phasePair, waterSoilInteraction, dictionary);
}
}

int Foam::mpm::waterSoilInteraction::implicitDrag
(
    Foam::debug::debugSwitch("mpmImplicitDrag", 1)
);

static Foam::RegisterSwitch<int> addImplicitDrag
(
    Foam::debug::addDebugObject,
    "mpmImplicitDrag",
    Foam::mpm::waterSoilInteraction::implicitDrag
);

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::mpm::waterSoilInteraction::waterVolume
(
    const label node
) const
{
    return water_.nodes().cloudVolume(node);
}


template<class Part>
void Foam::mpm::waterSoilInteraction::applyDrag
(
    const scalar deltaT,
    const Part& keptPart
)
{
    const label dim = grid_.nDim();
    const label n = nodes_.size();
    const bool held = soil_.model().held();
    const nodalFields& soil = soil_.nodes();
    const nodalFields& water = water_.nodes();
    nodeField<nodeVector>& vs = soil_.nodes().velocity;
    nodeField<nodeVector>& vw = water_.nodes().velocity;
    const bedWall* wall = wall_.valid() ? wall_.get() : nullptr;

    for (label k = 0; k < n; ++k)
    {
        const label i = nodes_[k];
        const scalar perWater = 1/water.mass(i);
        const scalar perSoil = held ? 0 : 1/soil.mass(i);
        const scalar factor = deltaT*bulkVolume_[k]*(perWater + perSoil);
        const scalar part = 1 - keptPart(factor, k);
        const scalar reduced = part/(perWater + perSoil);

        if (wall && wall->slips(i))
        {
            const nodeVector impulse = wallImpulse
                (i, vw[i] - vs[i], 1/(perWater + perSoil), part, deltaT);
            for (label d = 0; d < dim; ++d)
            {
                vw[i][d] -= perWater*impulse[d];
                vs[i][d] += perSoil*impulse[d];
            }
            continue;
        }
        for (label d = 0; d < dim; ++d)
        {
            const scalar impulse = reduced*(vw[i][d] - vs[i][d]);
            vw[i][d] -= perWater*impulse;
            vs[i][d] += perSoil*impulse;
        }
    }
}


Foam::mpm::nodeVector Foam::mpm::waterSoilInteraction::wallImpulse
(
    const label node,
    const nodeVector& dv,
    const scalar mass,
    const scalar part,
    const scalar deltaT
) const
{
    scalar speed = 0;
    const nodeVector along = alongBed(node, dv, speed);

    // Against the velocity that is left
    const scalar friction = deltaT*water_.fluid().rho0()*wall_->shear(node);
    return
        mass
       *(part*(dv - along) + bedWall::partTaken(friction, mass*speed)*along);
}


Foam::mpm::nodeVector Foam::mpm::waterSoilInteraction::wallForce
(
    const label node,
    const nodeVector& dv,
    const scalar resistance
) const
{
    scalar speed = 0;
    const nodeVector along = alongBed(node, dv, speed);
    return
        resistance*(dv - along)
      + water_.fluid().rho0()*wall_->shear(node)/max(speed, VSMALL)*along;
}


Foam::mpm::nodeVector Foam::mpm::waterSoilInteraction::alongBed
(
    const label node,
    const nodeVector& v,
    scalar& size
) const
{
    const label dim = grid_.nDim();
    const nodeVector& normal = wall_->normal(node);
    scalar across = 0;
    for (label d = 0; d < dim; ++d) across += v[d]*normal[d];
    nodeVector along{};
    scalar sizeSqr = 0;
    for (label d = 0; d < dim; ++d)
    {
        along[d] = v[d] - across*normal[d];
        sizeSqr += sqr(along[d]);
    }
    size = std::sqrt(sizeSqr);
    return along;
}


void Foam::mpm::waterSoilInteraction::makeWall()
{
    water_.setBed(nullptr);
    soil_.setBedForce(nullptr);
    wall_.clear();
    const scalar factor = water_.bedRoughness();
    if (!(factor > 0) || !drag_->active()) return;

    const soilModel& model = soil_.model();
    const weaklyCompressibleNewtonian& fluid = water_.fluid();

    // Per mass of pore water, twice: k is a square
    const scalar solid = 1/(1 + model.e0()), still = 0;
    scalar a = 0, b = 0;
    drag_->coefficients(1, &solid, &still, &a, &b);
    const scalar perMass = 2/(fluid.rho0()*(1 - solid));
    wall_.reset
    (
        new bedWall
        (
            grid_, fields_, water_.boundary(), factor*model.d(),
            fluid.mu()/fluid.rho0(), perMass*a, perMass*b
        )
    );
    water_.setBed(&wall_->fields());
    soil_.setBedForce([this](List<nodeVector>& force) { bedForce(force); });
}


void Foam::mpm::waterSoilInteraction::findReach()
{
    // Nodes that both clouds may have; those that other ranks have, too, are
    // among them
    auto& reach = fields_.ranges;
    reach.clear();
    const auto& water = water_.nodeRanges();
    const auto& soil = soil_.nodeRanges();
    for (size_t w = 0, s = 0; w < water.size() && s < soil.size();)
    {
        const label first = max(water[w].first, soil[s].first);
        const label last = min(water[w].second, soil[s].second);
        if (first < last) reach.emplace_back(first, last);
        if (water[w].second < soil[s].second) ++w;
        else ++s;
    }

    // In each direction by what tiles that hold a node reach beyond it, with
    // whole ranges: first along x, then by copies in other rows
    auto merge = [&]()
    {
        std::sort(reach.begin(), reach.end());
        size_t n = 0;
        for (const auto& range : reach)
        {
            if (n && range.first <= reach[n - 1].second)
            {
                label& end = reach[n - 1].second;
                end = max(end, range.second);
            }
            else
            {
                reach[n++] = range;
            }
        }
        reach.resize(n);
    };
    const label nNodes = grid_.nNodes();
    const label beyond = grid_.tileWidth() - 1;
    for (auto& range : reach)
    {
        range.first = max(range.first - beyond, label(0));
        range.second = min(range.second + beyond, nNodes);
    }
    for (label d = 1; d < grid_.nDim(); ++d)
    {
        const size_t n = reach.size();
        for (label j = -beyond; j <= beyond; ++j)
        {
            const label shift = j*grid_.stride(d);
            for (size_t r = 0; j && r < n; ++r)
            {
                const label first = max(reach[r].first + shift, label(0));
                const label last = min(reach[r].second + shift, nNodes);
                if (first < last) reach.emplace_back(first, last);
            }
        }
        merge();
    }
}


void Foam::mpm::waterSoilInteraction::findInside()
{
    const std::vector<scalar>& inverseVolume =
        water_.boundary().inverseVolume();
    // Of a node whose cells are all there
    const scalar whole = (1 + 1e-6)/grid_.cells().cellVolume();

    for (const label i : inside_) pressureInside_[i] = nodeVector{};
    inside_.clear();
    fields_.forNodes
    (
        [&](const label i)
        {
            const scalar perVolume = inverseVolume[i];
            if
            (
                perVolume > 0 && perVolume < whole
             && soil_.nodes().mass(i) > 0
             && water_.nodes().mass(i) > 0
            )
            {
                nodeVector& here = pressureInside_[i];
                here = fields_.pressureForce[i];
                here[3] = solidVolume(i) + waterVolume(i);
                inside_.push_back(i);
            }
        }
    );
}


Foam::mpm::nodeVector
Foam::mpm::waterSoilInteraction::meanPressureGradient(const label node) const
{
    const label dim = grid_.nDim();

    nodeVector sum{}, volume{};
    auto add = [&](const label i, const scalar share)
    {
        const nodeVector& here = pressureInside_[i];
        for (label d = 0; d < dim; ++d)
        {
            // A folded force is no gradient
            const scalar weight = share*(1 - folded_[i][d]);
            sum[d] += weight*here[d];
            volume[d] += weight*here[3];
        }
    };
    if (!grid_.plated())
    {
        for (const auto& part : mean_) add(node + part.first, part.second);
    }
    else
    {
        const label at = grid_.boxNode(node);
        const label view = grid_.viewOf(node);
        for (const auto& part : mean_)
        {
            add(grid_.seen(at + part.first, view), part.second);
        }
    }

    const nodeVector& own = pressureInside_[node];
    nodeVector mean{};
    for (label d = 0; d < dim; ++d)
    {
        mean[d] = folded_[node][d] ? own[d]/own[3] : sum[d]/volume[d];
    }
    return mean;
}


Foam::mpm::soilCloud::bedState
Foam::mpm::waterSoilInteraction::bedState() const
{
    // No step was made, or none with grains in water
    const scalar unknown = std::numeric_limits<scalar>::quiet_NaN();
    if (!returnReduce(label(speed_.size()), sumOp<label>()))
    {
        return soilCloud::bedState{unknown, unknown};
    }

    // The log and function objects ask for the same one
    soilCloud::bedState& b = bedState_;
    if (bedStep_ == water_.stepCount()) return b;
    bedStep_ = water_.stepCount();

    if (surface_.valid())
    {
        b.stress = surface_->meanStress();
    }
    else
    {
        // Only when it is asked for: its arrays do not last
        bedSurface surface(grid_, fields_, water_.boundary(), bedStress_);
        findSurface(surface);
        b.stress = surface.meanStress();
    }

    // Friction against the submerged weight of the layer
    const soilModel& model = soil_.model();
    b.movable =
        b.stress
       *(1 + model.e0())
       /(
            model.frictionCoefficient()
           *(model.rhoS() - water_.fluid().rho0())*mag(soil_.gravity())
        );
    return b;
}


void Foam::mpm::waterSoilInteraction::readBedStress(const dictionary& dict)
{
    const word form
    (
        readChoiceOrDefault(dict, "bedStress", "drag", {"drag", "wallLaw"})
    );
    bedStress_ = form == "drag" ? bedSurface::drag : bedSurface::wallLaw;
    if (bedStress_ == bedSurface::drag) return;

    const char* missing =
        !(water_.bedRoughness() > 0)
      ? "turbulence kEpsilon or realizableKE of the "
      : !drag_->active() ? "drag between the soil and the "
      : nullptr;
    if (missing)
    {
        FatalIOErrorInFunction(dict)
            << "keyword bedStress is " << form << ", which needs "
            << missing << water_.name() << '.' << nl
            << "    Allowed here: bedStress drag" << exit(FatalIOError);
    }
}


void Foam::mpm::waterSoilInteraction::bedForce(List<nodeVector>& force) const
{
    const label dim = grid_.nDim();
    const scalar rho = water_.fluid().rho0();
    const nodalFields& soil = soil_.nodes();
    const nodalFields& water = water_.nodes();
    const std::vector<scalar>& inverseVolume =
        water_.boundary().inverseVolume();

    force.setSize(grid_.mesh().nCells());
    forAll(force, celli)
    {
        // Each corner gives its cells equal parts
        nodeVector& here = force[celli];
        here = nodeVector{};
        const label first = grid_.boxCell(celli);
        for (label t = 0; t < (1 << dim); ++t)
        {
            label i = first;
            for (label d = 0; d < dim; ++d)
            {
                if (t & (1 << d)) i += grid_.stride(d);
            }
            const scalar part =
                wall_->area(i)*inverseVolume[i]/scalar(1 << dim);
            if (!(part > 0)) continue;
            here[3] += part;
            if (!wall_->slips(i) || !(water.mass(i) > 0 && soil.mass(i) > 0))
            {
                continue;
            }
            here += part*rho*wall_->stress(i);
        }
    }
}


void Foam::mpm::waterSoilInteraction::readBedLoad
(
    const dictionary& properties,
    const bool strictKeywords
)
{
    const dictionary& dict = properties.subDict(soil_.name());
    const lattice& cells = grid_.cells();
    const vector& g = soil_.gravity();

    bedLoadModel::bed b;
    b.nDim = grid_.nDim();
    b.d = soil_.model().d();
    b.rhoS = soil_.model().rhoS();
    b.mu = soil_.model().frictionCoefficient();
    b.solidFraction = 1/(1 + soil_.model().e0());
    b.rho = water_.fluid().rho0();
    b.g = mag(g);
    b.down = nodeVector{};
    for (label d = 0; d < b.nDim; ++d)
    {
        b.down[d] = g[cells.axis(d)]/max(b.g, VSMALL);
    }
    b.h = cells.minSpacing();
    if
    (
        solids_.size() == 1
     && b.mu > 0 && b.g > 0 && b.rhoS > b.rho
     && !soil_.model().held() && drag_->active() && !divergenceForm_
    )
    {
        soil_.setBed([this] { return bedState(); });
    }

    readBedStress(dict);
    bedLoad_ = bedLoadModel::New(dict, b, strictKeywords);
    if (!bedLoad_->active())
    {
        bedLoad_.clear();
        return;
    }

    const char* missing =
        soil_.model().held() || !(b.mu > 0) ? "a soil that yields by friction"
      : !(b.g > 0) ? "gravity"
      : !(b.rhoS > b.rho) ? "grains heavier than the liquid"
      : !drag_->active() ? "drag"
      : divergenceForm_ ? "pressureForm gradient"
      : nullptr;
    if (missing)
    {
        FatalIOErrorInFunction(dict)
            << "keyword bedLoad is " << bedLoad_->type() << ", which needs "
            << missing << '.' << nl
            << "    Allowed here: bedLoad none" << exit(FatalIOError);
    }
    surface_.reset
    (
        new bedSurface(grid_, fields_, water_.boundary(), bedStress_)
    );
    soil_.addBedStress();
}


void Foam::mpm::waterSoilInteraction::findSurface(bedSurface& surface) const
{
    const label dim = grid_.nDim();
    const std::vector<scalar>& inverseVolume =
        water_.boundary().inverseVolume();
    const nodalFields& soil = soil_.nodes();
    const nodalFields& water = water_.nodes();
    const scalar perRhoS = 1/soil_.model().rhoS();
    const scalar e = soil_.model().e0();

    nodeVector gravity{};
    for (label d = 0; d < dim; ++d)
    {
        gravity[d] = water_.acceleration()[grid_.cells().axis(d)];
    }

    const scalar rho = water_.fluid().rho0();
    surface.update
    (
        1/(1 + e),
        rho,
        [&](const label i)
        {
            return
                bedStress_ == bedSurface::wallLaw && wall_->hasBodies()
              ? wall_->besideBody(i)/(1 + e)
              : soil.mass(i)*perRhoS*inverseVolume[i];
        },
        [&](const label i) { return water.mass(i) > 0; },
        soil,
        water,
        [&](const auto& set)
        {
            const label n = nodes_.size();
            for (label k = 0; k < n; ++k)
            {
                const label i = nodes_[k];
                if (bedStress_ == bedSurface::wallLaw)
                {
                    if (!wall_->slips(i)) continue;
                    set(i, rho*wall_->stress(i), nodeVector{});
                    continue;
                }
                const nodeVector dv = water.velocity[i] - soil.velocity[i];
                scalar speedSqr = 0;
                for (label d = 0; d < dim; ++d) speedSqr += sqr(dv[d]);

                // Water has what soil has no share of (addForces)
                nodeVector push = water.mass(i)*gravity;
                if (pressureInside_[i][3] > 0)
                {
                    push +=
                        fields_.pressureForce[i]
                      - solidVolume(i)*meanPressureGradient(i);
                }
                push[3] = waterVolume(i);

                const scalar resistance =
                    bulkVolume_[k]*(a_[k] + b_[k]*std::sqrt(speedSqr));
                nodeVector drag =
                    wall_.valid() && wall_->slips(i)
                  ? wallForce(i, dv, resistance)
                  : resistance*dv;
                drag[3] = min(e*solidVolume(i), waterVolume(i));
                set(i, drag, push);
            }
        }
    );
}


void Foam::mpm::waterSoilInteraction::makeNodes()
{
    fields_ = couplingFields(water_.boundary().inverseVolume());
    folded_ = water_.boundary().folding().foldedComponents();
    mixed_.clear();
    inside_.clear();
    mean_.clear();
    touching_.clear();

    solid_ = &soil_.nodes().momentum;
    solidSlot_ = grid_.nDim();
    solidDensity_ = soil_.model().rhoS();
    if (mixedGrains_)
    {
        solidOfMixed_.assign(grid_.nNodes(), nodeVector{});
        solid_ = &solidOfMixed_;
        solidSlot_ = 0;
        solidDensity_ = 1;
    }

    water_.couple(fields_, water_.boundary());
    for (soilCloud* solid : solids_)
    {
        solid->couple(fields_, water_.boundary());
    }

    pressureInside_.assign(fields_.saturation.size(), nodeVector{});
    const label depth = (grid_.nDim() == 3 ? 1 : 0);
    for (label k = -depth; k <= depth; ++k)
    for (label j = -1; j <= 1; ++j)
    for (label i = -1; i <= 1; ++i)
    {
        mean_.emplace_back
        (
            i + j*grid_.stride(1) + k*grid_.stride(2),
            1.0/(1 << (mag(i) + mag(j) + mag(k)))
        );
    }

    const label W = grid_.tileWidth();
    for (label k = 0; k < (grid_.nDim() == 3 ? W : 1); ++k)
    for (label j = 0; j < W; ++j)
    for (label i = 0; i < W; ++i)
    {
        touching_.push_back(-(i + j*grid_.stride(1) + k*grid_.stride(2)));
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::waterSoilInteraction::waterSoilInteraction
(
    const dictionary& dict,
    const phases& all
)
:
    grid_(all.liquid.grid()),
    water_(all.liquid),
    solids_(all.solids),
    soil_(*solids_[0]),
    mixedGrains_(soil_.grains().grainsDiffer() ? &soil_.grains() : nullptr),
    cost_(all.cost),
    divergenceForm_
    (
        readChoiceOrDefault
            (all.control, "pressureForm", "gradient", {"gradient", "divergence"})
     == "divergence"
    ),
    implicitDrag_(implicitDrag),
    fields_(water_.boundary().inverseVolume()),
    nPacked_(0),
    bedStress_(bedSurface::drag),
    bedState_{0, 0},
    bedStep_(-1)
{
    if (!implicitDrag_)
    {
        WarningInFunction
            << "DebugSwitches: mpmImplicitDrag 0" << nl
            << "    Drag is explicit. Results are not to be trusted." << endl;
    }

    drag_ = dragModel::New
    (
        dict,
        dragModel::medium
        {
            soil_.model().d(), water_.fluid().mu(), water_.fluid().rho0()
        },
        all.strictKeywords
    );

    for (const soilCloud* solid : solids_)
    {
        const scalar rhoS = solid->model().rhoS();
        if (rhoS > water_.fluid().rho0()) continue;

        IOWarningInFunction(all.properties)
            << "keyword rhoS of the " << solid->name() << " is " << rhoS
            << ", rho0 of the " << water_.name() << ' '
            << water_.fluid().rho0()
            << " kg/m3: the grains float." << nl
            << "    Usual: rhoS > rho0 (rhoS is of the solid, without pores)"
            << nl << endl;
    }

    readBedLoad(all.properties, all.strictKeywords);

    makeNodes();
    makeWall();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::waterSoilInteraction::rebuild()
{
    makeNodes();
    makeWall();
    if (surface_.valid())
    {
        surface_.reset
        (
            new bedSurface(grid_, fields_, water_.boundary(), bedStress_)
        );
    }
}


void Foam::mpm::waterSoilInteraction::startNodes()
{
    cost_.start("coupling");

    const label dim = grid_.nDim();
    const std::vector<scalar>& inverseVolume =
        water_.boundary().inverseVolume();
    const nodalFields& soil = soil_.nodes();
    const nodalFields& water = water_.nodes();

    for (const label first : mixed_) fields_.mixed[first] = 0;
    mixed_.clear();
    nodes_.clear();
    solidFraction_.clear();
    fields_.recorded =
        water.mirrorsRecorded() && soil.mirrorsRecorded();
    if (fields_.recorded)
    {
        fields_.mirroredForce.assign
            (water.mirrored.force.size(), nodeVector{});
        fields_.mirroredForceOfSolids.assign
            (soil.mirrored.force.size(), nodeVector{});
    }
    bulkVolume_.clear();
    nPacked_ = 0;

    // As water alone, where the two were near
    fields_.forNodes
    (
        [&](const label i)
        {
            fields_.inversePoreVolume[i] = inverseVolume[i];
            fields_.pressureForce[i] = nodeVector{};
        }
    );
    findReach();
    if (mixedGrains_)
    {
        fields_.forNodes
        (
            [&](const label i)
            {
                solidOfMixed_[i][0] = mixedGrains_->solidVolume(i);
            }
        );
    }
    const bool plated = grid_.plated();
    fields_.forNodes
    (
        [&](const label i)
        {
            const bool wet = water.mass(i) > 0;

            if (!(soil.mass(i) > 0))
            {
                nodeVector flux = water.velocity[i];
                flux[dim] = 1;
                fields_.mixture[i] = flux;
                fields_.saturation[i] = wet;
                return;
            }

            const label at = plated ? grid_.boxNode(i) : i;
            for (const label offset : touching_)
            {
                const label first = at + offset;
                if (first >= 0 && !fields_.mixed[first])
                {
                    fields_.mixed[first] = 1;
                    mixed_.push_back(first);
                }
            }

            const scalar control = 1/inverseVolume[i];
            const scalar solid = solidVolume(i);
            const scalar liquid = wet ? waterVolume(i) : 0;
            const scalar occupied =
                min(control, max(soil.cloudVolume(i), solid + liquid));

            scalar ns = solid/occupied;
            if (ns > 1 - minPorosity)
            {
                ns = 1 - minPorosity;
                ++nPacked_;
            }

            const nodeVector& vs = soil.velocity[i];
            const nodeVector& vw = wet ? water.velocity[i] : vs;
            nodeVector flux{};
            for (label d = 0; d < dim; ++d)
            {
                flux[d] = (1 - ns)*vw[d] + ns*vs[d];
            }
            flux[dim] = 1 - ns;

            fields_.mixture[i] = flux;
            fields_.inversePoreVolume[i] =
                1/max(control - solid, minPorosity*control);
            fields_.saturation[i] =
                min(scalar(1), liquid/((1 - ns)*occupied));

            if (wet)
            {
                nodes_.push_back(i);
                solidFraction_.push_back(ns);
                bulkVolume_.push_back(occupied*fields_.saturation[i]);
            }
        }
    );
    fields_.contact = !nodes_.empty();

    if (wall_.valid())
    {
        cost_.start("bed as a wall");
        const scalar perBed = 1 + soil_.model().e0();
        wall_->update
        (
            [&](const label i)
            {
                return perBed*solidVolume(i)*inverseVolume[i];
            },
            water_.nodesAtBodies(),
            soil,
            water
        );
    }
    cost_.stop();
}


void Foam::mpm::waterSoilInteraction::afterLiquidStress()
{
    if (!divergenceForm_) return;

    cost_.start("coupling");

    grid_.exchange().sum(fields_.pressureForce);
    fields_.forNodes
    (
        [&](const label i)
        {
            if (water_.nodes().mass(i) > 0)
            {
                water_.nodes().force[i] += fields_.pressureForce[i];
            }
            fields_.pressureForce[i] = nodeVector{};
        }
    );
    cost_.stop();
}


void Foam::mpm::waterSoilInteraction::addForces(const scalar)
{
    cost_.start("coupling");

    const label dim = grid_.nDim();
    nodalFields& soil = soil_.nodes();
    nodalFields& water = water_.nodes();

    grid_.exchange().sum(fields_.pressureForce);
    if (fields_.recorded)
    {
        auto add = [](const auto& from, auto& to)
        {
            for (size_t i = 0; i < to.size(); ++i) to[i] += from[i];
        };
        add(fields_.mirroredForce, water.mirrored.force);
        add(fields_.mirroredForceOfSolids, soil.mirrored.force);
    }

    if (divergenceForm_)
    {
        // What is left is of the points of soil
        fields_.forNodes
        (
            [&](const label i)
            {
                if (soil.mass(i) > 0)
                {
                    soil.force[i] += fields_.pressureForce[i];
                }
            }
        );
        cost_.stop();
        return;
    }

    // Water takes all of it, and gives soil its share. Inside the bed grains
    // feel the mean of their neighbourhood: points of sheared water integrate
    // the pressure with an error that changes from node to node, and is several
    // times what drag and weight of a grain are. What folds at walls is no gradient,
    // and in water alone the gradient is another: neither takes part.
    findInside();
    fields_.forNodes
    (
        [&](const label i)
        {
            const bool wet = water.mass(i) > 0;
            if (wet) water.force[i] += fields_.pressureForce[i];
            if (!(soil.mass(i) > 0)) return;

            const scalar solid = solidVolume(i);
            nodeVector share{};
            if (pressureInside_[i][3] > 0)
            {
                share = solid*meanPressureGradient(i);
            }
            else
            {
                const scalar liquid = wet ? waterVolume(i) : 0;
                share = solid/(liquid + solid)*fields_.pressureForce[i];
            }
            for (label d = dim; d < 4; ++d) share[d] = 0;
            soil.force[i] += share;
            if (wet) water.force[i] -= share;
        }
    );
    cost_.stop();
}


void Foam::mpm::waterSoilInteraction::exchangeMomentum(const scalar deltaT)
{
    if (!drag_->active()) return;

    cost_.start("drag");

    const label dim = grid_.nDim();
    const label n = nodes_.size();
    nodeField<nodeVector>& vs = soil_.nodes().velocity;
    nodeField<nodeVector>& vw = water_.nodes().velocity;

    speed_.resize(n);
    a_.resize(n);
    b_.resize(n);
    for (label k = 0; k < n; ++k)
    {
        const label i = nodes_[k];
        scalar speedSqr = 0;
        for (label d = 0; d < dim; ++d) speedSqr += sqr(vw[i][d] - vs[i][d]);
        speed_[k] = std::sqrt(speedSqr);
    }
    if (mixedGrains_)
    {
        diameter_.resize(n);
        for (label k = 0; k < n; ++k)
        {
            const label i = nodes_[k];
            diameter_[k] =
                mixedGrains_->diameter(i, soil_.nodes().mass(i));
        }
        drag_->coefficients
        (
            n, solidFraction_.data(), speed_.data(), diameter_.data(),
            a_.data(), b_.data()
        );
    }
    else
    {
        drag_->coefficients
        (
            n, solidFraction_.data(), speed_.data(), a_.data(), b_.data()
        );
    }

    if (implicitDrag_)
    {
        applyDrag
        (
            deltaT,
            [&](const scalar factor, const label k)
            {
                const scalar linear = 1 + factor*a_[k];
                return
                    2
                   /(
                        linear
                      + std::sqrt(sqr(linear) + 4*factor*b_[k]*speed_[k])
                    );
            }
        );
    }
    else
    {
        applyDrag
        (
            deltaT,
            [&](const scalar factor, const label k)
            {
                return 1 - factor*(a_[k] + b_[k]*speed_[k]);
            }
        );
    }

    // Walls take what drag brings to them
    water_.boundary().constrain(vw);
    soil_.boundary().constrain(vs);
    cost_.stop();

    if (surface_.valid())
    {
        cost_.start("surface of the bed");
        findSurface(*surface_);
        cost_.stop();
    }
}


void Foam::mpm::waterSoilInteraction::finishPoints(const scalar deltaT)
{
    if (!surface_.valid()) return;
    soil_.slip(deltaT, surface_->stress(), surface_->normal(), *bedLoad_);
}


void Foam::mpm::waterSoilInteraction::log() const
{
    const int64_t packed = returnReduce(int64_t(nPacked_), sumOp<int64_t>());
    if (!packed) return;

    Info<< "--> ";
    forAll(solids_, i) Info<< (i ? ", " : "") << solids_[i]->name();
    Info<< ": " << packed << " nodes with less than 10 % porosity; the soil is"
        << " over-compacted there" << nl;
}


void Foam::mpm::waterSoilInteraction::effects(effectsTable& table) const
{
    table.add
    (
        "coupling", true,
        divergenceForm_
      ? "pressure in divergence form: for comparison only"
      : "pressure in gradient form"
    );
    table.add
    (
        "  drag", drag_->active(),
        drag_->type() + (mixedGrains_ ? " of the mass-weighted diameter" : "")
    );
    table.add
    (
        "  bed as a wall", wall_.valid(),
        wall_.valid()
      ? "ks " + Foam::name(wall_->fields().ks) + " m, stress of the law of the"
        " wall on its surface"
      : string("turbulence kEpsilon, realizableKE")
    );
    table.add
    (
        "  bed load", bedLoad_.valid(),
        bedLoad_.valid()
      ? bedLoad_->type()
      + (bedStress_ == bedSurface::wallLaw ? ", stress of the law of the wall"
         : ", stress of drag")
      + " averaged over "
      + Foam::name(bedLoad_->averagingTime()) + " s"
      : string(soil_.name() + "/bedLoad")
    );
}

// ************************************************************************* //
