/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterCloud.H"
#include "bedFields.H"
#include "bodyWall.H"
#include "effectsTable.H"
#include "dictionaryEntries.H"
#include "lanes.H"
#include "PstreamReduceOps.H"
#include "zeroGradientFvPatchFields.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(waterCloud, 0);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    //- Warn of walls that hold the flow back over a cell
    static void checkNoSlip
    (
        const volVectorField& U,
        const weaklyCompressibleNewtonian& fluid,
        const scalar h
    )
    {
        // The viscous layer ends at y+ = 12; u* is 1/25 of the velocity
        const scalar velocity = 0.1*fluid.soundSpeed();
        const scalar layer = 300*fluid.mu()/fluid.rho0()/velocity;
        if (layer > h) return;

        string patches;
        forAll(U.boundaryField(), patchi)
        {
            // Of these there are as many on all ranks
            const fvPatchVectorField& patch = U.boundaryField()[patchi];
            if
            (
                patch.type() == "noSlip"
             && returnReduce(patch.size(), sumOp<label>())
            )
            {
                patches += ' ' + patch.patch().name();
            }
        }
        if (patches.empty()) return;

        WarningInFunction
            << U.name() << " is noSlip on the patches" << patches.c_str() << "."
            << nl << "    At " << velocity
            << " m/s, a tenth of the speed of sound, the viscous layer there"
            << " would be " << layer << " m thick, and cells are " << h << " m:"
            << nl << "    the wall holds the flow back over a cell, many times as"
            << " much as friction does." << nl
            << "    smoothWall and roughWall have the stress of the law of the"
            << " wall, slip has none" << endl;
    }
}
}


void Foam::mpm::waterCloud::select()
{
    if (settings_.coupled && turbulence_.valid() && turbulence_->needsWalls())
    {
        FatalIOErrorInFunction(dict_)
            << "keyword turbulence is " << turbulence_->type()
            << ", which needs the distance from walls; beside solids a bed would be one,"
            << " too." << nl << "    Allowed beside solids: none, Smagorinsky,"
            << " kEpsilon, realizableKE" << exit(FatalIOError);
    }

    // Plain APIC at its own time-step limit, and no more dissipative when the
    // time step is cut
    const scalar apicRate =
        2*fluid_.soundSpeed()/grid_.cells().minSpacing();

    // The eddies' viscosity damps what XAPIC leaves, and would be less than
    // that of APIC
    selectTransfer
    (
        turbulence_.valid() ? "XAPIC" : "APIC",
        settings_.coupled && !turbulence_.valid() ? coupledApicRate : apicRate
    );
    // What eddies it would drive, others damp
    cellQuadrature_ =
        readChoiceOrDefault
        (
            dict_,
            "pressureQuadrature",
            transfer_->affine() && transfer_->filtered() ? "cells" : "points",
            {"points", "cells"}
        )
     == "cells";
    makeKernels();

    // A mud has a viscosity that only the flow knows
    if (fluid_.viscous() && !viscosity_.valid())
    {
        checkNoSlip(U_, fluid_, grid_.cells().minSpacing());
    }
}


Foam::scalar Foam::mpm::waterCloud::schemeViscosity() const
{
    const scalar h = grid_.cells().minSpacing();
    const scalar ch = fluid_.soundSpeed()*h;
    if (transfer_->filtered()) return 4e-4*ch;

    // The rate of APIC
    const scalar moment = 1e-9*h/fluid_.soundSpeed();
    const scalar rate = transfer_->picFraction(moment)/moment;
    return 0.0083*rate*sqr(h) + 7e-4*ch;
}


void Foam::mpm::waterCloud::findPorosities()
{
    // Means over the corners of the cell
    const std::vector<scalar>& inverseVolume = boundary_.inverseVolume();
    porosity_.resize(size());
    for (label p = 0; p < size(); ++p)
    {
        scalar pores = 0, space = 0;
        for (label k = 0; k < (1 << grid_.nDim()); ++k)
        {
            label node = points_.cell()[p];
            for (label d = 0; d < grid_.nDim(); ++d)
            {
                if (k & (1 << d)) node += grid_.stride(d);
            }
            const scalar inversePores = coupling_->inversePoreVolume[node];
            if (!(inversePores > 0)) continue;
            pores += 1/inversePores;
            space += 1/inverseVolume[node];
        }
        porosity_[p] = space > 0 ? pores/space : 1;
    }
}


void Foam::mpm::waterCloud::findBed()
{
    const lattice& cells = grid_.cells();
    const label nDim = grid_.nDim();
    bedDistance_.resize(size());
    bedFrictionVelocity_.resize(size());
    for (label p = 0; p < size(); ++p)
    {
        const label cell = points_.cell()[p];
        const index3 lower = grid_.coordinate(cell);
        scalar f[3];
        for (label d = 0; d < nDim; ++d)
        {
            f[d] = (x(d)[p] - cells.origin(d))/cells.spacing(d)
              - (lower[d] + grid_.lower(d));
        }
        scalar y = 0, friction = 0, weights = 0;
        for (label corner = 0; corner < (1 << nDim); ++corner)
        {
            label node = cell;
            scalar weight = 1;
            for (label d = 0; d < nDim; ++d)
            {
                const label upper = (corner >> d) & 1;
                weight *= upper ? f[d] : 1 - f[d];
                node += upper*grid_.stride(d);
            }
            // Beyond what the nodes know
            y += weight*min(bed_->distance[node], 2.5*cells.minSpacing());
            if (bed_->frictionVelocity[node] > 0)
            {
                friction += weight*bed_->frictionVelocity[node];
                weights += weight;
            }
        }
        bedDistance_[p] = y;
        bedFrictionVelocity_[p] = weights > 0 ? friction/weights : 0;
    }
}


void Foam::mpm::waterCloud::findMaxViscosity()
{
    maxNut_ = 0;
    if (nut_ < 0) return;
    const scalar* nut = points_.column(nut_);
    for (label p = 0; p < size(); ++p) maxNut_ = max(maxNut_, nut[p]);
}


void Foam::mpm::waterCloud::addMeshMeans()
{
    for (const pointStorage::field& f : points_.fields())
    {
        const label power = f.name == "k" ? -2 : f.name == "epsilon" ? -3 : -1;
        if (power == -1 && f.name != "nut") continue;

        meshMeans_.emplace_back
        (
            f.first,
            autoPtr<volScalarField>::New
            (
                IOobject
                (
                    f.name,
                    mesh_.time().timeName(),
                    mesh_,
                    IOobject::NO_READ,
                    IOobject::AUTO_WRITE
                ),
                mesh_,
                dimensionedScalar(dimArea*pow(dimTime, power), Zero),
                zeroGradientFvPatchScalarField::typeName
            )
        );
    }
}


void Foam::mpm::waterCloud::correctViscosity(const scalar deltaT)
{
    cost_.start("viscosity");
    scalar* nut = points_.column(nut_);
    const scalar* rate = points_.column(nut_ + 1);
    std::fill(nut, nut + size(), 0);
    if (viscosity_.valid())
    {
        for (label p = 0; p < size(); ++p) nut[p] = viscosity_->nu(rate[p]);
    }
    if (turbulence_.valid())
    {
        turbulenceModel::points p{};
        p.deltaT = deltaT;
        p.nu = fluid_.mu()/fluid_.rho0();
        p.kernels = kernels_.get();
        p.n = size();
        p.cell = points_.cell();
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            p.x[d] = points_.column(x_ + d);
            p.v[d] = points_.column(v_ + d);
        }
        p.shearRate = rate;
        if (rotation_ >= 0)
        {
            p.rotationRate = points_.column(rotation_);
            if (grid_.nDim() == 3) p.strainShape = points_.column(rotation_ + 1);
        }
        if (coupling_)
        {
            findPorosities();
            p.porosity = porosity_.data();
        }
        if (bed_)
        {
            findBed();
            p.bed = bed_;
            p.bedDistance = bedDistance_.data();
            p.bedFrictionVelocity = bedFrictionVelocity_.data();
        }
        turbulence_->correct(p, nut);
    }
    findMaxViscosity();
    cost_.stop();
}


void Foam::mpm::waterCloud::findStages(const scalar deltaT)
{
    nStages_ = 0;
    if (!inStages_) return;

    // As in this step, which the limits did not know yet
    const scalar nu =
        fluid_.mu()/fluid_.rho0()
      + (nut_ < 0 ? 0 : returnReduce(maxNut_, maxOp<scalar>()));
    const lattice& cells = grid_.cells();
    if (deltaT*2*grid_.nDim()*nu <= sqr(cells.minSpacing())) return;

    scalar sum = 0;
    for (label d = 0; d < grid_.nDim(); ++d) sum += 1/sqr(cells.spacing(d));
    const scalar z = deltaT*2*nu*sum/grid_.secondMoment();
    nStages_ = label(std::ceil(0.5*(std::sqrt(1 + 4*z) - 1)));
}


void Foam::mpm::waterCloud::findMinVolumeRatio()
{
    minJ_ = 1;
    for (label p = 0; p < size(); ++p)
    {
        if (!(J()[p] > 0))
        {
            FatalErrorInFunction
                << "cloud " << name() << ": point " << p << " in "
                << time().timePath()/cloud::prefix/name()
                << " has the volume ratio J = " << J()[p]
                << "; it must be positive." << exit(FatalError);
        }
        minJ_ = min(minJ_, J()[p]);
    }
}


Foam::scalar Foam::mpm::waterCloud::volumeRatioAhead
(
    const inlet& in,
    const label p
) const
{
    // Without smoothing the nodes do not know it
    if (!settings_.smoothing) return 0;

    const lattice& cells = grid_.cells();
    const label nDim = grid_.nDim();
    const label cell = points_.cell()[p];
    const index3 lower = grid_.coordinate(cell);

    // The last line that this rank is sure to know, ahead of the points
    // that entered before: from those the pressure would only be
    // extrapolated, with nothing to hold it
    const label normal = in.zone().direction();
    const label line =
        in.zone().side()
      ? grid_.reachStart()
      : grid_.reachStart() + grid_.reachWidth() - 1;

    scalar sum = 0, weights = 0;
    for (label corner = 0; corner < (1 << nDim); ++corner)
    {
        label node = cell;
        scalar weight = 1;
        for (label d = 0; d < nDim; ++d)
        {
            const label upper = (corner >> d) & 1;
            if (d == normal)
            {
                weight *= upper;
                node += line*grid_.stride(d);
                continue;
            }
            const scalar f = (x(d)[p] - cells.origin(d))/cells.spacing(d)
              - (lower[d] + grid_.lower(d));
            weight *= upper ? f : 1 - f;
            node += upper*grid_.stride(d);
        }
        const scalar ratio = nodes_.smoothed(node);
        if (nodes_.mass(node) > 0 && ratio > 0)
        {
            sum += weight*ratio;
            weights += weight;
        }
    }

    // A mean of some corners only is not linear any more
    return weights > 1 - 1e-6 ? sum/weights : 0;
}


Foam::scalarList Foam::mpm::waterCloud::basinSums()
{
    if (!basins_.valid()) basins_.reset(new closedBasins(boundary_, U_));
    if (basins_->empty()) return scalarList();

    const bool plane = grid_.nDim() == 2;
    return basins_->sums
    (
        order_.nodeRanges(),
        [&](const label i)
        {
            return plane ? nodes_.momentum[i][3] : nodes_.volume[i];
        },
        coupling_ ? coupling_->inversePoreVolume : boundary_.inverseVolume(),
        fullBasinSaturation
    );
}


void Foam::mpm::waterCloud::correctBasins(const scalar deltaT)
{
    if (basinSums_.empty()) return;

    const scalarList excess(basins_->excess(basinSums_));
    bool any = false;
    for (const scalar e : excess) any = any || e != 0;
    if (!any) return;

    const scalar most =
        basinCorrectionRate*fluid_.soundSpeed()*deltaT
       /grid_.cells().minSpacing();
    scalar* J = points_.column(J_);
    for (label p = 0; p < size(); ++p)
    {
        const label basin =
            basins_->ofCell(grid_.meshCell(points_.cell()[p]));
        if (basin < 0) continue;

        const scalar shrink = max(-most, min(most, excess[basin]));
        J[p] *= 1 - shrink;
        correctionWork_ += fluid_.pressure(J[p])*volume(p)*shrink;
    }
}


void Foam::mpm::waterCloud::addOutletLoads()
{
    if (!open_.valid() || !open_->anyWaterLevel()) return;

    const lattice& cells = grid_.cells();
    const label nDim = grid_.nDim();
    const label T = grid_.reachWidth();

    const label vertical = cells.along(g_);
    const scalar g = g_[cells.axis(vertical)];
    auto pressure = [&](const scalar level, const scalar z) -> scalar
    {
        // Heights count against gravity
        const scalar depth = level - (g > 0 ? -z : z);
        return depth > 0 ? fluid_.hydrostaticPressure(mag(g)*depth) : 0;
    };
    if (!open_->loadsKnown())
    {
        open_->setLoads(boundary_.folding(), vertical, pressure);
    }

    // Integral over the end of the water = integral over the plane where the
    // zone begins + volume integral of p grad N from there on: points that
    // leave take their part along
    for (const auto& load : open_->loads())
    {
        const label i = load.first;
        const scalar part = min
        (
            scalar(1), nodes_.cloudVolume(i)*boundary_.inverseVolume()[i]
        );
        nodes_.force[i] += part*load.second;
    }

    const std::vector<char>& marks = open_->marks();
    for (label p = 0; p < size(); ++p)
    {
        const label cell = points_.cell()[p];
        if (!(marks[cell] & inflowOutflow::levelZone)) continue;

        const label normal = open_->directionOf(cell);
        const index3 lower = grid_.coordinate(cell);
        scalar w[3][4] = {};
        for (label d = 0; d < nDim; ++d)
        {
            const scalar f = (x(d)[p] - cells.origin(d))/cells.spacing(d)
              - (lower[d] + grid_.lower(d));
            scalar gradient[4];
            inflowOutflow::reachWeights(grid_, f, w[d], gradient);
            for (label t = 0; d == normal && t < T; ++t)
            {
                w[d][t] = gradient[t]/cells.spacing(d);
            }
        }
        const scalar pV =
            pressure(open_->levelOf(cell), x(vertical)[p])*volume(p);
        const label stencil = boundary_.folding().stencil(cell);

        for (label t = 0; t < grid_.reachSize(); ++t)
        {
            scalar weight = w[0][t % T]*w[1][(t/T) % T];
            if (nDim == 3) weight *= w[2][t/(T*T)];
            nodeVector f{};
            f[normal] = -pV*weight;
            if (stencil < 0)
            {
                nodes_.force
                    [cell + grid_.reachOffset() + grid_.reachNode(t)] += f;
            }
            else
            {
                nodes_.force[boundary_.folding().targets(stencil)[t]] +=
                    boundary_.folding().signs(stencil)[t]*f;
            }
        }
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::waterCloud::makeKernels()
{
    const word& shape = grid_.shapeFunction();
    kernels_ =
        shape == linear::name ? newWaterKernels<linear>(*this)
      : shape == cubicBSpline::name ? newWaterKernels<cubicBSpline>(*this)
      : newWaterKernels<quadraticBSpline>(*this);
}


Foam::scalar Foam::mpm::waterCloud::slowness(const inlet& in) const
{
    scalar mass = 0;
    for (const inlet::place& place : in.places())
    {
        mass += place.volume/fluid_.volumeRatio
        (
            fluid_.hydrostaticPressure(in.gravity()*place.depth)
        );
    }
    return in.layerVolume()/mass;
}


void Foam::mpm::waterCloud::setEntered
(
    const inlet& in,
    const label first,
    const UList<scalar>& volume,
    const UList<scalar>& depth
)
{
    scalarField pressure(depth.size());
    forAll(pressure, i)
    {
        pressure[i] = fluid_.hydrostaticPressure(in.gravity()*depth[i]);
    }
    setState(first, volume, pressure);

    if (turbulence_.valid())
    {
        turbulence_->setEntered(first, first + depth.size());
    }

    // Density falls with height
    const scalar g = mag(g_);
    forAll(pressure, i)
    {
        const label p = first + i;
        const scalar ratio = volumeRatioAhead(in, p);
        if (ratio > 0) points_.column(J_)[p] = ratio;
        minJ_ = min(minJ_, J()[p]);

        setAtRest(p, g > 0 && in.gravity() > 0 ? g_ : vector::zero);
    }
}


bool Foam::mpm::waterCloud::extreme(const label p) const
{
    return materialPointCloud::extreme(p) || J()[p] <= minJ_;
}


void Foam::mpm::waterCloud::findExtremes()
{
    materialPointCloud::findExtremes();
    findMinVolumeRatio();
}


void Foam::mpm::waterCloud::derivedFields
(
    HashTable<tmp<scalarField>>& fields
) const
{
    // Once there is a flow to speak of; the largest is the same on all ranks
    if
    (
        turbulence_.valid() && transfer_->affine() && !warnedOfScheme_
     && globalMaxNut_ > 0 && globalMaxNut_ < schemeViscosity()
    )
    {
        warnedOfScheme_ = true;
        WarningInFunction
            << "cloud " << name() << ": the largest eddy viscosity, "
            << globalMaxNut_ << " m2/s, is less than that of the scheme, "
            << schemeViscosity() << " m2/s for eddies of 16 cells." << nl
            << "    What turbulence would do is lost in it; less have transfer"
            << " XAPIC, a lower soundSpeed and finer cells" << endl;
    }

    tmp<scalarField> p(new scalarField(size()));
    tmp<scalarField> rho(new scalarField(size()));
    for (label i = 0; i < size(); ++i)
    {
        p.ref()[i] = max(fluid_.pressure(J()[i]), minPressure_);
        rho.ref()[i] = fluid_.rho0()/J()[i];
    }
    fields.set("p", p);
    fields.set("rho", rho);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::waterCloud::waterCloud
(
    const word& name,
    const fvMesh& mesh,
    const backgroundGrid& grid,
    const dictionary& dict,
    const settings& control,
    costMeter& cost,
    const vector& g
)
:
    materialPointCloud
    (
        name, mesh, grid, dict, control, cost, g, "slip", false
    ),
    fluid_(dict, control.strictKeywords),
    J_(points_.add("J", pointStorage::scalarValue)),
    gradJ_
    (
        control.smoothing ? points_.add("gradJ", pointStorage::vectorValue) : -1
    ),
    minPressure_
    (
        readSwitchOrDefault(dict, "tensionCutOff", false) ? 0 : -VGREAT
    ),
    cellQuadrature_(false),
    viscosity_(viscosityModel::New(dict, control.strictKeywords)),
    turbulence_
    (
        turbulenceModel::New
            (dict, {grid, U_, points_, control.strictKeywords})
    ),
    inStages_
    (
        readChoiceOrDefault
        (
            dict, "viscousStep", "explicit", {"explicit", "stages"}
        )
     == "stages"
    ),
    nStages_(0),
    nut_
    (
        viscosity_.valid() || turbulence_.valid()
      ? points_.add("nut", pointStorage::scalarValue)
      : -1
    ),
    rotation_(-1),
    bed_(nullptr),
    maxNut_(viscosity_.valid() ? viscosity_->nu(0) : 0),
    globalMaxNut_(0),
    warnedOfScheme_(false),
    p_
    (
        IOobject
        (
            "p",
            mesh.time().timeName(),
            mesh,
            IOobject::NO_READ,
            IOobject::AUTO_WRITE
        ),
        mesh,
        dimensionedScalar(dimPressure, Zero),
        zeroGradientFvPatchScalarField::typeName
    ),
    stressWork_(0),
    correctionWork_(0),
    minJ_(1),
    globalMinJ_(1)
{
    // After nut: the columns lie side by side
    if (nut_ >= 0)
    {
        addMeshMeans();
        points_.add("shearRate", pointStorage::scalarValue);
        if (turbulence_.valid() && turbulence_->needsRotation())
        {
            rotation_ = points_.add("rotationRate", pointStorage::scalarValue);
            if (grid.nDim() == 3)
            {
                points_.add("strainShape", pointStorage::scalarValue);
            }
        }
    }
    if (inStages_ && grid.shapeFunction() == linear::name)
    {
        FatalIOErrorInFunction(dict)
            << "keyword viscousStep is stages, with shapeFunction "
            << linear::name << " in system/fvSolution, MPM: nodes may have next"
            << " to no mass there, and no number of stages is stable." << nl
            << "    Allowed: viscousStep explicit, or another shapeFunction"
            << exit(FatalIOError);
    }
    boundary_.setLiquid(fluid_.rho0(), fluid_.mu()/fluid_.rho0());
    if (!fluid_.autoSoundSpeed()) select();
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::waterCloud::~waterCloud()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::waterCloud::checkDictionary
(
    const dictionary& dict,
    const bool strictKeywords
)
{
    checkKeywords
    (
        dict,
        {
            "constitutiveModel",
            word(weaklyCompressibleNewtonian::typeName) + "Coeffs",
            "transfer",
            "apicRate",
            "filterRate",
            "flipDampingRate",
            "corners",
            "tensionCutOff",
            "pressureQuadrature",
            "viscosityModel",
            dict.lookupOrDefault<word>("viscosityModel", "Newtonian")
          + "Coeffs",
            "viscousStep",
            "turbulence",
            dict.lookupOrDefault<word>("turbulence", "none") + "Coeffs",
            "bodyForce",
            "pressureGradient",
            "inflowOutflow",
            "relaxationZones",
            "role"
        },
        strictKeywords
    );
}


void Foam::mpm::waterCloud::findSoundSpeed
(
    const scalar surface,
    const scalar landing,
    const UList<materialPointCloud*>& solids
)
{
    if (!fluid_.autoSoundSpeed()) return;

    // Heights are measured against gravity, from the lowest floor
    const scalar g = mag(g_);
    const vector up = (g > 0 ? -g_/g : vector(Zero));

    scalar floor = GREAT;
    for (const point& x : mesh_.points()) floor = min(floor, up & x);
    reduce(floor, minOp<scalar>());

    scalar highest = surface;
    if (open_.valid() && open_->inlets().size())
    {
        highest = max(highest, open_->top(up));
    }
    const scalar wave = std::sqrt(g*max(scalar(0), highest - floor));
    scalar reference = wave;

    const scalar spacing = grid_.cells().minSpacing();
    auto speeds = [&](materialPointCloud& cloud, const scalar ground)
    {
        const motion m(cloud.startMotion(up));
        const scalar fall = std::sqrt(2*g*m.drop(ground, spacing));
        reference = max
        (
            reference, max(m.inletSpeed, max(m.initialSpeed, fall))
        );
        OStringStream os;
        os  << "inlet " << m.inletSpeed << ", initial " << m.initialSpeed
            << ", sqrt(2 g drop) " << fall;
        return os.str();
    };
    const std::string own(speeds(*this, floor));

    // Soil hits the water as water would
    std::string others;
    for (materialPointCloud* solid : solids)
    {
        others += "; " + solid->name() + ": "
          + speeds(*solid, landing < GREAT ? landing : floor);
    }

    if (reference <= SMALL)
    {
        FatalIOErrorInFunction
        (
            subDictOf
            (
                dict_, word(weaklyCompressibleNewtonian::typeName) + "Coeffs"
            )
        )   << "keyword soundSpeed is auto, but the scene has neither gravity"
            << " nor speed to find it from (c = 0)." << nl
            << "    Allowed: soundSpeed > 0 m/s, about 10 times the fastest"
            << " flow expected" << exit(FatalIOError);
    }
    fluid_.setSoundSpeed(10*reference);
    select();

    Info<< "Speed of sound of " << name() << ": " << fluid_.soundSpeed()
        << " m/s = 10 max(" << own.c_str() << ", sqrt(g H) " << wave
        << others.c_str() << ')' << endl;
}


void Foam::mpm::waterCloud::setState
(
    const label first,
    const UList<scalar>& volume,
    const UList<scalar>& pressure
)
{
    forAll(volume, i)
    {
        const scalar J = fluid_.volumeRatio(pressure[i]);
        points_.column(J_)[first + i] = J;
        points_.column(mass_)[first + i] = fluid_.rho0()*volume[i]/J;
    }
}


void Foam::mpm::waterCloud::setAtRest(const label p, const vector& gravity)
{
    const scalar compression = J()[p]/sqr(fluid_.soundSpeed(J()[p]));
    for (label d = 0; gradJ_ >= 0 && d < grid_.nDim(); ++d)
    {
        points_.column(gradJ_ + d)[p] =
            -compression*gravity[grid_.cells().axis(d)];
    }
}


void Foam::mpm::waterCloud::addBodies(const bodies& all)
{
    materialPointCloud::addBodies(all);
    if (!settings_.smoothing)
    {
        FatalErrorInFunction
            << "cloud " << name() << " meets bodies, but smoothing in"
            << " system/fvSolution, MPM is no: the pressure at their surface"
            << " is that of the smoothed nodes." << nl
            << "    Allowed: smoothing yes" << exit(FatalError);
    }
    wall_.reset
    (
        new bodyWall
        (
            grid_, boundary_, all, name(), fluid_.rho0(),
            settings_.strictKeywords
        )
    );
    boundary_.add(*wall_);
}


const Foam::mpm::bodyNodes* Foam::mpm::waterCloud::nodesAtBodies() const
{
    return wall_.valid() ? &wall_->nodes() : nullptr;
}


void Foam::mpm::waterCloud::addBodySaturation
(
    const std::vector<scalar>& inverseVolume
)
{
    wall_->addSaturation(nodes_.saturation, inverseVolume, order_.nodes());
}


void Foam::mpm::waterCloud::pressAtBodies()
{
    cost_.start("bodies: pressure");
    const std::vector<bodyNodes::local>& near = wall_->nodes().locals();
    const std::vector<scalar>& inverseSpace =
        coupling_ ? coupling_->inversePoreVolume : boundary_.inverseVolume();
    std::vector<scalar> pressure(near.size()), water(near.size());
    std::vector<scalar> space(near.size());
    for (size_t i = 0; i < near.size(); ++i)
    {
        const scalar J = meanVolumeRatio(near[i].grid);
        pressure[i] = J > 0 ? max(fluid_.pressure(J), minPressure_) : 0;
        water[i] = nodes_.cloudVolume(near[i].grid);
        space[i] = 1/inverseSpace[near[i].grid];
    }
    wall_->press(pressure, water, space, nodes_);

    // Where there is soil it bears its part, as of the pressure of the points.
    // That is summed over ranks later.
    const std::vector<scalar>& inverseVolume = boundary_.inverseVolume();
    for (const bodyNodes::local& l : near)
    {
        if (!wall_->presses(l)) continue;
        const label i = l.grid;
        const nodeVector force(wall_->wallForce(l));
        if
        (
            coupling_
         && coupling_->inversePoreVolume[i] > (1 + 1e-9)*inverseVolume[i]
        )
        {
            coupling_->pressureForce[i] += grid_.share(i)*force;
        }
        else nodes_.force[i] += force;
    }
}


void Foam::mpm::waterCloud::placeBodies()
{
    wall_->move();
}


void Foam::mpm::waterCloud::pushBody
(
    const label body,
    const scalar deltaT,
    scalar (&impulse)[6],
    scalar (&resistance)[36]
) const
{
    wall_->push(body, deltaT, transfer_->picFraction(deltaT), impulse, resistance);
}


void Foam::mpm::waterCloud::followBodies(const scalar deltaT)
{
    wall_->react(nodes_);
    wall_->findLoads(deltaT, transfer_->picFraction(deltaT));
    findWallLoads(deltaT);
}


Foam::mpm::nodeConstraint::load Foam::mpm::waterCloud::loadOn
(
    const label body
) const
{
    return wall_->loadOn(body);
}


void Foam::mpm::waterCloud::finishNodes(const scalar deltaT)
{
    materialPointCloud::finishNodes(deltaT);
    if (wall_.valid())
    {
        wall_->findLoads(deltaT, transfer_->picFraction(deltaT));
    }
}


const Foam::bitSet& Foam::mpm::waterCloud::nearBodies() const
{
    return wall_->nodes().nearCells();
}


void Foam::mpm::waterCloud::rebuild()
{
    basins_.clear();
    materialPointCloud::rebuild();
}


void Foam::mpm::waterCloud::finishPoints()
{
    materialPointCloud::finishPoints();
    findMinVolumeRatio();
}


Foam::scalar Foam::mpm::waterCloud::maxWaveSpeed() const
{
    // Else the speed of sound would be negative, and the time step
    for (label p = 0; !(minJ_ > 0) && p < size(); ++p)
    {
        if (J()[p] > 0) continue;
        FatalErrorInFunction
            << "cloud " << name() << ", point " << label(points_.column(id_)[p])
            << ", mesh cell " << grid_.meshCell(points_.cell()[p])
            << " has the volume ratio J = " << J()[p]
            << "; it must be positive." << nl
            << "    The flow is unstable: raise soundSpeed if the log has"
            << " warned of density, else lower maxCo (or deltaT if"
            << " adjustTimeStep is no)." << exit(FatalError);
    }

    // Water may come in before there is any, and the last may have left
    return fluid_.soundSpeed(min(minJ_, scalar(1)));
}


Foam::scalar Foam::mpm::waterCloud::scatteredDeltaT() const
{
    // omega dt < 2 with omega^2 = 4 dim (c/h)^2, that of a point which shares
    // its nodes with no other. Points within a body of water are less stiff,
    // those at the edge of a film are on their way to it
    return
        grid_.cells().minSpacing()
       /(fluid_.soundSpeed(min(globalMinJ_, scalar(1)))*sqrt(scalar(grid_.nDim())));
}


void Foam::mpm::waterCloud::addLimits(stepLimits& limits)
{
    limits.addMinimum
    (
        stepLimits::end, [this]() { return minJ_; }, globalMinJ_
    );
    materialPointCloud::addLimits(limits);
    const scalar maxCo = limits.maxCo();
    limits.add
    (
        name() + " scattered sound",
        [this, maxCo]() { return scatteredDeltaT()/maxCo; }
    );
    if (nut_ >= 0)
    {
        limits.addMaximum
        (
            stepLimits::end, [this]() { return maxNut_; }, globalMaxNut_
        );
    }

    // Through inlets and outlets anything may come and go
    if (settings_.volumeCorrection && !open_.valid() && !bodies_)
    {
        limits.addSums
        (
            stepLimits::start, [this]() { return basinSums(); }, basinSums_
        );
    }
}


Foam::scalar Foam::mpm::waterCloud::waveSpeed() const
{
    // The densest is the stiffest
    return max
    (
        maxWaveSpeed(), fluid_.soundSpeed(min(globalMinJ_, scalar(1)))
    );
}


Foam::scalar Foam::mpm::waterCloud::viscosity() const
{
    return inStages_ ? 0 : fluid_.mu()/fluid_.rho0() + globalMaxNut_;
}


void Foam::mpm::waterCloud::energy
(
    const vector& g,
    scalar& kinetic,
    scalar& potential,
    scalar& elastic
) const
{
    materialPointCloud::energy(g, kinetic, potential, elastic);
    for (label p = 0; p < size(); ++p)
    {
        elastic += mass()[p]/fluid_.rho0()*fluid_.elasticEnergy(J()[p]);
    }
}


bool Foam::mpm::waterCloud::writeMeshFields() const
{
    bool ok = p_.write();
    for (const auto& [column, mean] : meshMeans_) ok = mean->write() && ok;
    return materialPointCloud::writeMeshFields() && ok;
}


void Foam::mpm::waterCloud::readPoints()
{
    materialPointCloud::readPoints();
    findMinVolumeRatio();
}


void Foam::mpm::waterCloud::describe
(
    dictionary& basis,
    dictionary& settings
) const
{
    materialPointCloud::describe(basis, settings);

    basis.set("rho0", fluid_.rho0());
    basis.set("gamma", fluid_.gamma());

    // If it is auto, the state file says what it is
    if (fluid_.soundSpeed() > 0) basis.set("soundSpeed", fluid_.soundSpeed());

    dictionary& coeffs = settings.subDict
    (
        word(weaklyCompressibleNewtonian::typeName) + "Coeffs"
    );
    for (const char* keyword : {"rho0", "gamma", "soundSpeed"})
    {
        coeffs.remove(keyword);
    }
}


void Foam::mpm::waterCloud::readState(const dictionary& dict)
{
    materialPointCloud::readState(dict);

    if (fluid_.autoSoundSpeed())
    {
        fluid_.setSoundSpeed(readPositive(dict, "soundSpeed", dimVelocity));
        select();
        transfer_->read(dict);
    }
    if (stepCount() > 0)
    {
        maxNut_ = dict.lookupOrDefault<scalar>("viscosity", maxNut_);
    }
    if (Pstream::master())
    {
        stressWork_ = dict.lookupOrDefault<scalar>("stressWork", 0);
        correctionWork_ = dict.lookupOrDefault<scalar>("correctionWork", 0);
    }
}


void Foam::mpm::waterCloud::writeState(dictionary& dict) const
{
    materialPointCloud::writeState(dict);

    dict.set("soundSpeed", fluid_.soundSpeed());
    if (nut_ >= 0)
    {
        dict.set("viscosity", returnReduce(maxNut_, maxOp<scalar>()));
    }
    dict.set("stressWork", returnReduce(stressWork_, sumOp<scalar>()));
    dict.set("correctionWork", returnReduce(correctionWork_, sumOp<scalar>()));
}


void Foam::mpm::waterCloud::effects(effectsTable& table) const
{
    table.add("cloud " + name(), true, Foam::name(globalSize()) + " points");
    table.add("  transfer", true, transfer_->description());
    table.add
    (
        "  viscous stress", fluid_.viscous(),
        "mu = " + Foam::name(fluid_.mu()) + " Pa s"
    );

    // PIC and XPIC dissipate by step, whatever that is
    const scalar nu = transfer_->affine() ? schemeViscosity() : 0;
    string text("about " + Foam::name(nu) + " m2/s for eddies of 16 cells");
    if (fluid_.viscous() && nu*fluid_.rho0() > fluid_.mu())
    {
        text += ", " + Foam::name(nu*fluid_.rho0()/fluid_.mu())
          + " times mu/rho0";
    }
    if (transfer_->affine())
    {
        table.add("  viscosity of the scheme", true, text);
    }
    table.add
    (
        "  pressure smoothing", settings_.smoothing,
        "fvSolution/MPM/smoothing"
    );
    table.add
    (
        "  volume correction", settings_.volumeCorrection,
        "fvSolution/MPM/volumeCorrection"
    );
    if (settings_.coupled)
    {
        table.add
        (
            "  overlap correction",
            settings_.volumeCorrection && settings_.overlapCorrection,
            "fvSolution/MPM/overlapCorrection"
        );
    }
    table.add("  tension cut-off", minPressure_ == 0, "tensionCutOff");
    table.add
    (
        "  pressure by cells", cellQuadrature_, "pressureQuadrature cells"
    );
    table.add
    (
        "  shear-rate viscosity", viscosity_.valid(),
        viscosity_.valid() ? viscosity_->description() : "viscosityModel"
    );
    table.add
    (
        "  viscous stages", inStages_,
        inStages_
      ? "where steps are longer than h^2/(2 dim nu)" : "viscousStep"
    );
    table.add
    (
        "  turbulence", turbulence_.valid(),
        turbulence_.valid() ? turbulence_->description() : "turbulence"
    );
    openEffects(table);
}


Foam::scalar Foam::mpm::waterCloud::densityVariation() const
{
    if (!size()) return 0;

    std::vector<scalar> variation(size());
    for (label p = 0; p < size(); ++p) variation[p] = mag(1/J()[p] - 1);
    const auto percentile = variation.begin() + label(0.99*(size() - 1));
    std::nth_element(variation.begin(), percentile, variation.end());
    return *percentile;
}


Foam::string Foam::mpm::waterCloud::nonFiniteState() const
{
    for (label p = 0; p < size(); ++p)
    {
        if (std::isfinite(J()[p])) continue;
        return pointText(p) + ", volume ratio " + Foam::name(J()[p]);
    }
    return string();
}

// ************************************************************************* //
