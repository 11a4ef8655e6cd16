/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "soilCloud.H"
#include "bodyContact.H"
#include "effectsTable.H"
#include "waterCloud.H"
#include "dictionaryEntries.H"
#include "PstreamReduceOps.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(soilCloud, 0);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::mpm::soilPoints Foam::mpm::soilCloud::modelPoints
(
    const label begin,
    const label end
) const
{
    // The model writes to the columns; who may change the cloud is decided by
    // the caller
    pointStorage& points = const_cast<pointStorage&>(points_);

    soilPoints s;
    s.n = end - begin;
    const label nStress = (grid_.nDim() == 2 ? 4 : 6);
    for (label i = 0; i < nStress; ++i)
    {
        s.stress[i] = points.column(sigma_ + i) + begin;
    }
    s.voidRatio = points.column(voidRatio_) + begin;
    forAll(state_, i) s.state[i] = points.column(state_[i]) + begin;
    if (liquid_) s.liquidViscosity = liquid_->fluid().mu();
    return s;
}


Foam::scalar Foam::mpm::soilCloud::pressure(const label p) const
{
    scalar sum = 0;
    for (label d = 0; d < 3; ++d) sum -= points_.column(sigma_ + d)[p]/3;
    return sum;
}


void Foam::mpm::soilCloud::findWaveSpeed()
{
    waveSpeedSqr_ = 0;
    minVoidRatio_ = GREAT;
    for (label p = 0; p < size(); ++p)
    {
        waveSpeedSqr_ = max
        (
            waveSpeedSqr_, model_->waveSpeedSqr(pressure(p), voidRatio()[p])
        );
        minVoidRatio_ = min(minVoidRatio_, voidRatio()[p]);
    }
}


void Foam::mpm::soilCloud::beginSmoothing(const label first, const label last)
{
    if (compression_ < 0) return;

    scalar* own = points_.column(compression_) + first;
    model_->elasticCompression(modelPoints(first, last), own);
    std::copy
    (
        own, own + (last - first), points_.column(compressionMean_) + first
    );
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::soilCloud::makeKernels()
{
    const word& shape = grid_.shapeFunction();
    kernels_ =
        shape == linear::name ? newSoilKernels<linear>(*this)
      : shape == cubicBSpline::name ? newSoilKernels<cubicBSpline>(*this)
      : newSoilKernels<quadraticBSpline>(*this);
}


void Foam::mpm::soilCloud::beginFields(const wordList& names)
{
    if (names.found("compressionMean")) beginSmoothing(0, size());
}


void Foam::mpm::soilCloud::derivedFields
(
    HashTable<tmp<scalarField>>& fields
) const
{
    tmp<scalarField> p(new scalarField(size()));
    tmp<scalarField> q(new scalarField(size()));
    const label nStress = (grid_.nDim() == 2 ? 4 : 6);

    for (label i = 0; i < size(); ++i)
    {
        const scalar s0 = points_.column(sigma_)[i];
        const scalar s1 = points_.column(sigma_ + 1)[i];
        const scalar s2 = points_.column(sigma_ + 2)[i];
        const scalar mean = (s0 + s1 + s2)/3;

        scalar sqr2 = sqr(s0 - mean) + sqr(s1 - mean) + sqr(s2 - mean);
        for (label k = 3; k < nStress; ++k)
        {
            sqr2 += 2*sqr(points_.column(sigma_ + k)[i]);
        }
        p.ref()[i] = -mean;
        q.ref()[i] = std::sqrt(1.5*sqr2);
    }
    fields.set("p", p);
    fields.set("q", q);
}


void Foam::mpm::soilCloud::setEntered
(
    const inlet& in,
    const label first,
    const UList<scalar>& volume,
    const UList<scalar>&
)
{
    const label n = volume.size();
    const scalar e = in.voidRatio() < 0 ? model_->e0() : in.voidRatio();
    setState
    (
        first, volume, scalarField(n, e), symmTensorField(n, Zero)
    );
    waveSpeedSqr_ = max(waveSpeedSqr_, model_->waveSpeedSqr(0, e));
    minVoidRatio_ = min(minVoidRatio_, e);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::soilCloud::soilCloud
(
    const word& name,
    const fvMesh& mesh,
    const backgroundGrid& grid,
    const dictionary& dict,
    const settings& control,
    costMeter& cost,
    const vector& g,
    const soilCloud* leader
)
:
    materialPointCloud
    (
        name, mesh, grid, dict, control, cost, g, "stick", true, leader
    ),
    model_(soilModel::New(dict, control.strictKeywords)),
    skeleton_(leader ? leader->skeleton_ : std::make_shared<skeleton>()),
    sigma_(points_.add("sigma", pointStorage::symmTensorValue)),
    voidRatio_(points_.add("voidRatio", pointStorage::scalarValue)),
    regime_(-1),
    compression_(-1),
    compressionMean_(-1),
    compressionGradient_(-1),
    bedStress_(-1),
    liquid_(nullptr),
    compressionRate_(0),
    shearSqr_(0),
    waveSpeedSqr_(0),
    viscosity_(0),
    minVoidRatio_(GREAT),
    stressWork_(0)
{
    const wordList fields(model_->stateFields());
    state_.setSize(fields.size());
    forAll(fields, i)
    {
        state_[i] = points_.add(fields[i], pointStorage::scalarValue);
        if (fields[i] == "regime") regime_ = state_[i];
    }
    if (control.smoothing && model_->hasCompression())
    {
        compression_ =
            points_.add("elasticCompression", pointStorage::scalarValue);
        compressionMean_ =
            points_.add("compressionMean", pointStorage::scalarValue);
        compressionGradient_ =
            points_.add("compressionGradient", pointStorage::vectorValue);
    }
    if (control.coupled)
    {
        // Named if it is too small
        readBounded
        (
            model_->coeffs(), "e0", dimless, leastVoidRatio(), GREAT
        );
    }
    if (control.maxSoilSoundSpeed < GREAT)
    {
        model_->limitWaveSpeed(control.maxSoilSoundSpeed);
    }
    selectTransfer
    (
        grid.shapeFunction() == linear::name ? "FLIP" : "APIC",
        apicRate*fallRate()
    );
    skeleton_->add(*this);
    makeKernels();
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::soilCloud::~soilCloud()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::soilCloud::addBodies(const bodies& all)
{
    materialPointCloud::addBodies(all);

    // The leader's contact is that of the nodes of all
    if (!leads()) return;
    contact_.reset
    (
        new bodyContact
            (grid_, boundary_, all, name(), settings_.strictKeywords)
    );
    boundary_.add(*contact_);
}


void Foam::mpm::soilCloud::placeBodies()
{
    if (contact_.valid()) contact_->move();
}


void Foam::mpm::soilCloud::pushBody
(
    const label body,
    const scalar deltaT,
    scalar (&impulse)[6],
    scalar (&resistance)[36]
) const
{
    if (contact_.valid()) contact_->push(body, deltaT, impulse, resistance);
}


void Foam::mpm::soilCloud::followBodies(const scalar deltaT)
{
    if (contact_.valid()) contact_->follow(deltaT, nodes_);
    findWallLoads(deltaT);
}


Foam::mpm::nodeConstraint::load Foam::mpm::soilCloud::loadOn
(
    const label body
) const
{
    return contact_.valid() ? contact_->loadOn(body) : nodeConstraint::load();
}


void Foam::mpm::soilCloud::finishNodes(const scalar deltaT)
{
    if (contact_.valid())
    {
        // A column of some cells on the body vibrates that slowly
        const scalar lengths = 25*grid_.cells().minSpacing();
        const scalar c = waveSpeed();
        contact_->setMemory(c > 0 ? lengths/c : deltaT);
        if (grid_.plated()) findSideMemories(lengths, deltaT);
    }
    materialPointCloud::finishNodes(deltaT);
}


void Foam::mpm::soilCloud::findSideMemories
(
    const scalar lengths,
    const scalar deltaT
)
{
    // The largest speed on one side is nothing that the other one may know
    const nodeTiles& tiles = boundary_.tiles();
    const size_t nSides = 2*grid_.plates().size();
    scalarList largest(label(nSides), scalar(0));
    scalarList leastVoid(label(nSides), -GREAT);
    for (soilCloud* soil : skeleton_->clouds())
    {
        const label* tile = soil->points_.tile();
        const label* cell = soil->points_.cell();
        auto add = [&](const label p)
        {
            const label view = tiles.viewOf(tile[p]);
            if (view == plate::none) return;
            const label side = 2*grid_.plateOf(cell[p]) + view - plate::front;
            const scalar e = soil->voidRatio()[p];
            largest[side] = max
            (
                largest[side], soil->model_->waveSpeedSqr(soil->pressure(p), e)
            );
            leastVoid[side] = max(leastVoid[side], -e);
        };

        // What is near follows the bodies
        if (soil->nearGroup_.empty() || bodies_->anyMoves())
        {
            soil->findNearGroups();
        }
        soil->forNearGroups(add);
    }
    Pstream::listCombineGather(largest, maxEqOp<scalar>());
    Pstream::listCombineScatter(largest);
    Pstream::listCombineGather(leastVoid, maxEqOp<scalar>());
    Pstream::listCombineScatter(leastVoid);

    std::vector<scalar> times(nSides);
    for (size_t side = 0; side < nSides; ++side)
    {
        const scalar c = waveSpeed(largest[side], -leastVoid[side]);
        times[side] = c > 0 ? lengths/c : deltaT;
    }
    contact_->setMemory(times);
}


const Foam::bitSet& Foam::mpm::soilCloud::nearBodies() const
{
    return contact_->nodes().nearCells();
}



void Foam::mpm::soilCloud::checkDictionary
(
    const dictionary& dict,
    const bool strictKeywords
)
{
    const word model(dict.lookupOrDefault<word>("constitutiveModel", "none"));

    // The constructor says which models there are
    const auto& models = *soilModel::dictionaryConstructorTablePtr_;
    if (!models.found(model)) return;

    checkKeywords
    (
        dict,
        {
            "constitutiveModel",
            model + "Coeffs",
            "transfer",
            "apicRate",
            "filterRate",
            "flipDampingRate",
            "corners",
            "bodyForce",
            "inflowOutflow",
            "bedLoad",
            "bedStress",
            "role",
            "velocityField",
            dict.lookupOrDefault<word>("bedLoad", "none") + "Coeffs"
        },
        strictKeywords
    );
}


void Foam::mpm::soilCloud::addBedStress()
{
    bedStress_ = points_.add("bedStress", pointStorage::vectorValue);
}


void Foam::mpm::soilCloud::slip
(
    const scalar deltaT,
    const nodeField<nodeVector>& stress,
    const nodeField<nodeVector>& normal,
    const surfaceSlip& law
)
{
    startCost("bed load");
    kernels_->slip(deltaT, stress, normal, law);
    cost_.stop();
}


void Foam::mpm::soilCloud::setState
(
    const label first,
    const UList<scalar>& volume,
    const UList<scalar>& voidRatio,
    const UList<symmTensor>& stress
)
{
    const lattice& cells = grid_.cells();
    const label nStress = (grid_.nDim() == 2 ? 4 : 6);

    forAll(volume, i)
    {
        points_.column(voidRatio_)[first + i] = voidRatio[i];
        points_.column(mass_)[first + i] =
            model_->rhoS()*volume[i]/(1 + voidRatio[i]);
        for (label k = 0; k < nStress; ++k)
        {
            points_.column(sigma_ + k)[first + i] =
                stress[i][symmComponent(cells, k)];
        }
    }
    soilPoints s(modelPoints(first, first + volume.size()));
    List<scalarField> whole(nStress, scalarField(volume.size()));
    forAll(whole, k) s.wholeStress[k] = whole[k].data();
    model_->initialise(grid_.nDim(), s);
    beginSmoothing(first, first + volume.size());
}


size_t Foam::mpm::soilCloud::nodeMemory() const
{
    return
        materialPointCloud::nodeMemory() + (leads() ? skeleton_->memory() : 0);
}


void Foam::mpm::soilCloud::finishPoints()
{
    materialPointCloud::finishPoints();
    findWaveSpeed();
}


void Foam::mpm::soilCloud::rebuild()
{
    if (leads()) skeleton_->makeNodes(grid_.nNodes());
    materialPointCloud::rebuild();
}


void Foam::mpm::soilCloud::addLimits(stepLimits& limits)
{
    if (leads()) skeleton_->addLimits(limits);
    materialPointCloud::addLimits(limits);

    // What meets may be as stiff at the end of the step as an impact makes it;
    // only then the step comes near the limit of stability
    const scalar maxCo = limits.maxCo();
    limits.add
    (
        "impact",
        [this, maxCo]()
        {
            return impactDeltaT(max(maxCo, stepLimits::stableCo))/maxCo;
        }
    );
}


Foam::scalar Foam::mpm::soilCloud::waveSpeed() const
{
    // Undrained, the liquid in the pores stiffens the skeleton. The stiffest
    // and the densest point may be on different ranks: together they limit the
    // step, or it would depend on the decomposition
    return waveSpeed
    (
        skeleton_->global().waveSpeedSqr, skeleton_->global().minVoidRatio
    );
}


Foam::scalar Foam::mpm::soilCloud::waveSpeed
(
    scalar waveSpeedSqr,
    const scalar voidRatio
) const
{
    const bool empty = !(voidRatio < GREAT);

    // As the nodes have it
    const scalar porosity =
        empty
      ? 1
      : max(voidRatio/(1 + voidRatio), couplingFields::minPorosity);

    // Soil may come in before there is any
    if (empty) waveSpeedSqr = model_->waveSpeedSqr(0, model_->e0());
    if (liquid_) waveSpeedSqr += sqr(liquid_->fluid().soundSpeed())/porosity;
    return std::sqrt(waveSpeedSqr);
}


void Foam::mpm::soilCloud::findStrainRates()
{
    if (!leads()) return;

    const label dim = grid_.nDim();
    const lattice& cells = grid_.cells();

    label toUpperCorner = 0;
    for (label d = 0; d < dim; ++d) toUpperCorner += grid_.stride(d);

    compressionRate_ = 0;
    shearSqr_ = 0;

    // By own cells, whose corners are all known: node i is a lower corner of
    // cell i
    for (const auto& range : order_.nodeRanges())
    {
        for (label cell = range.first; cell < range.second; ++cell)
        {
            if (!grid_.ownCell(cell)) continue;

            // One-sided at two opposite corners: no gradient at a point is
            // larger than the largest
            for (const label side : {1, -1})
            {
                const label i = side > 0 ? cell : cell + toUpperCorner;
                if (!(nodes_.mass(i) > 0)) continue;

                tensor L(Zero);
                for (label d = 0; d < dim; ++d)
                {
                    const label j = i + side*grid_.stride(d);
                    if (!(nodes_.mass(j) > 0)) continue;

                    for (label c = 0; c < dim; ++c)
                    {
                        L(c, d) =
                            side
                           *(nodes_.velocity[j][c] - nodes_.velocity[i][c])
                           /cells.spacing(d);
                    }
                }
                compressionRate_ = max(compressionRate_, -tr(L));
                shearSqr_ = max(shearSqr_, 0.5*magSqr(dev(symm(L))));
            }
        }
    }
}


Foam::scalar Foam::mpm::soilCloud::impactDeltaT(const scalar courant) const
{
    const scalar h = courant*grid_.cells().minSpacing();
    const scalar cSqr = sqr(waveSpeed());
    const scalar rate = skeleton_->global().compressionRate;
    const scalar e = min(skeleton_->global().minVoidRatio, model_->e0());

    auto tooLarge = [&](const scalar deltaT)
    {
        return
            sqr(deltaT)
           *(cSqr + model_->waveSpeedSqrGrowth(rate*deltaT, e))
          > sqr(h);
    };

    // As large as the flow allows; where that is too large, the root of a
    // growing function, to a thousandth
    scalar high = h/max(waveSpeed(), SMALL);
    if (rate*high < SMALL || !tooLarge(high)) return GREAT;

    high = min(high, 1/rate);
    while (tooLarge(high)) high *= 0.5;

    scalar low = high;
    for (scalar step = 0.5*high; step > 1e-3*high; step *= 0.5)
    {
        if (!tooLarge(low + step)) low += step;
    }
    return low;
}


Foam::scalar Foam::mpm::soilCloud::viscosity() const
{
    const scalar e = min(skeleton_->global().minVoidRatio, model_->e0());
    return max
    (
        skeleton_->global().viscosity,
        model_->viscosity(std::sqrt(skeleton_->global().shearSqr), e)
    );
}


void Foam::mpm::soilCloud::energy
(
    const vector& g,
    scalar& kinetic,
    scalar& potential,
    scalar& elastic
) const
{
    materialPointCloud::energy(g, kinetic, potential, elastic);

    scalarField density(size());
    model_->elasticEnergy
    (
        grid_.nDim(), modelPoints(0, size()), density.data()
    );
    forAll(density, p) elastic += volume(p)*density[p];
}


void Foam::mpm::soilCloud::readPoints()
{
    materialPointCloud::readPoints();

    for (label p = 0; p < size(); ++p)
    {
        if (voidRatio()[p] > 0) continue;
        FatalErrorInFunction
            << "file " << fileOf("voidRatio") << ": point " << p
            << " has the void ratio " << voidRatio()[p] << '.' << nl
            << "    Allowed: voidRatio > 0" << exit(FatalError);
    }

    // The state file has what the last step found
    if (waveSpeedSqr_ == 0) findWaveSpeed();
}


void Foam::mpm::soilCloud::describe
(
    dictionary& basis,
    dictionary& settings
) const
{
    materialPointCloud::describe(basis, settings);

    basis.set("rhoS", model_->rhoS());
    basis.set("d", model_->d());
    basis.set("e0", model_->e0());

    dictionary& coeffs = settings.subDict(model_->type() + "Coeffs");
    for (const char* keyword : {"rhoS", "d", "e0"}) coeffs.remove(keyword);
}


void Foam::mpm::soilCloud::readState(const dictionary& dict)
{
    materialPointCloud::readState(dict);

    waveSpeedSqr_ = dict.lookupOrDefault<scalar>("waveSpeedSqr", 0);
    minVoidRatio_ = dict.lookupOrDefault<scalar>("minVoidRatio", GREAT);
    viscosity_ = dict.lookupOrDefault<scalar>("viscosity", 0);
    if (Pstream::master())
    {
        stressWork_ = dict.lookupOrDefault<scalar>("stressWork", 0);
    }
    if (contact_.valid()) contact_->readState(dict);
}


void Foam::mpm::soilCloud::writeState(dictionary& dict) const
{
    materialPointCloud::writeState(dict);

    dict.set("waveSpeedSqr", returnReduce(waveSpeedSqr_, maxOp<scalar>()));
    dict.set("minVoidRatio", returnReduce(minVoidRatio_, minOp<scalar>()));
    dict.set("viscosity", returnReduce(viscosity_, maxOp<scalar>()));
    dict.set("stressWork", returnReduce(stressWork_, sumOp<scalar>()));
    if (contact_.valid()) contact_->writeState(dict);
}


void Foam::mpm::soilCloud::effects(effectsTable& table) const
{
    table.add("cloud " + name(), true, Foam::name(globalSize()) + " points");
    table.add("  transfer", true, transfer_->description());
    table.add("  skeleton stress", true, model_->type());
    table.add
    (
        "  pressure smoothing", compression_ >= 0, "fvSolution/MPM/smoothing"
    );
    table.add
    (
        "  wall friction", boundary_.nodeWalls(),
        "patch type frictional"
    );
    table.add
    (
        "  stiffness cap", settings_.maxSoilSoundSpeed < GREAT,
        "fvSolution/MPM/maxSoilSoundSpeed"
    );
    table.add
    (
        "  loosening correction", settings_.looseningCorrection,
        "fvSolution/MPM/looseningCorrection"
    );
    openEffects(table);
}


Foam::string Foam::mpm::soilCloud::nonFiniteState() const
{
    for (label p = 0; p < size(); ++p)
    {
        scalar pressure = 0;
        for (label d = 0; d < 3; ++d)
        {
            pressure -= points_.column(sigma_ + d)[p]/3;
        }
        if (std::isfinite(pressure) && std::isfinite(voidRatio()[p])) continue;
        return
            pointText(p) + ", void ratio " + Foam::name(voidRatio()[p])
          + ", mean effective stress " + Foam::name(pressure) + " Pa";
    }
    return string();
}

// ************************************************************************* //
