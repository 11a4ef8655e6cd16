/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointCloud.H"
#include "effectsTable.H"
#include "dictionaryEntries.H"
#include "PstreamReduceOps.H"
#include "zeroGradientFvPatchFields.H"
#include "constrainedWallFvPatchVectorField.H"
#include "frictionalWall.H"
#include "patchTypes.H"
#include "OSspecific.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(materialPointCloud, 0);
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    //- The file of the velocity of a cloud, which must be there
    Foam::IOobject velocityFile
    (
        const Foam::word& cloud,
        const Foam::fvMesh& mesh
    )
    {
        using namespace Foam;

        IOobject io
        (
            "U." + cloud,
            mesh.time().timeName(),
            mesh,
            IOobject::MUST_READ,
            IOobject::AUTO_WRITE
        );
        const bool here = io.typeHeaderOk<volVectorField>(false);
        if (!returnReduce(here, andOp<bool>()))
        {
            const fileName original
            (
                mesh.time().globalPath()/"0.orig"/io.name()
            );
            FatalErrorInFunction
                << "file " << io.objectPath() << " is missing, or none of"
                << " class " << volVectorField::typeName << ": it says what"
                << " the patches are to the cloud " << cloud << '.' << nl
                << "    "
                << (
                       isFile(original)
                     ? "It is in 0.orig: cp -r 0.orig 0"
                     : "etc/caseDicts/annotated has an example"
                   )
                << (
                       Pstream::parRun()
                     ? ", and decomposePar again" : ""
                   )
                << exit(FatalError);
        }
        return io;
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointCloud::zeroNodes()
{
    for (const auto& range : order_.nodeRanges())
    {
        nodes_.zero(range.first, range.second);
    }
    if (nodes_.mirrorsRecorded()) nodes_.zeroMirrored();
}


void Foam::mpm::materialPointCloud::makeNodes()
{
    const label n = grid_.nNodes();
    bool energyBalance = false, recordWallLoads = false, filtered = false;
    for (const materialPointCloud* c : field_->clouds)
    {
        energyBalance = energyBalance || c->energyBalance_;
        recordWallLoads = recordWallLoads || c->recordWallLoads_;
        filtered =
            filtered || (c->transfer_.valid() && c->transfer_->filtered());
    }

    nodes_.resize(n, grid_.nDim());
    if (boundary_.nodeWalls()) nodes_.ghostMomentum.assign(n, nodeVector{});
    if (energyBalance || recordWallLoads)
    {
        nodes_.oldVelocity.assign(n, nodeVector{});
    }
    if (recordWallLoads)
    {
        boundary_.record();
        const size_t nSlots = boundary_.folding().slots().size();
        nodes_.mirrored.recorded = true;
        nodes_.mirrored.force.assign(nSlots, nodeVector{});
        nodes_.mirrored.momentum.assign(nSlots, nodeVector{});
        nodes_.mirrored.mass.assign(nSlots, nodeVector{});
    }
    if (filtered) filter_.assign(n, nodeVector{});
}


void Foam::mpm::materialPointCloud::checkBoundary() const
{
    const materialPointCloud& first = leader();
    auto text = [](const fvPatchVectorField& Up)
    {
        // Values are results, but where they are what is imposed
        OStringStream os;
        Up.write(os);
        IStringStream is(os.str());
        dictionary entries(is);
        if (!patchTypes::fixed.found(Up.type())) entries.remove("value");
        return entries.digest();
    };
    forAll(U_.boundaryField(), patchi)
    {
        const fvPatchVectorField& own = U_.boundaryField()[patchi];
        const fvPatchVectorField& others = first.U_.boundaryField()[patchi];
        if (own.type() == others.type() && text(own) == text(others)) continue;

        patchTypes::refuse
        (
            own,
            "differs from that of " + first.U_.name() + " (type "
          + others.type() + "), whose velocity field the cloud " + name()
          + " shares"
        );
    }
    const word corners(dict_.lookupOrDefault<word>("corners", word::null));
    const word ofFirst
    (
        first.dict_.lookupOrDefault<word>("corners", "stick")
    );
    if (corners.size() && corners != ofFirst)
    {
        FatalIOErrorInFunction(dict_)
            << "keyword corners is " << corners << ", but the cloud "
            << first.name() << " of the same velocity field has " << ofFirst
            << '.' << nl << "    Allowed: corners " << ofFirst
            << exit(FatalIOError);
    }
    if (open_.valid() && open_->inlets().size())
    {
        FatalIOErrorInFunction(dict_)
            << "keyword inflowOutflow has inlets, but the cloud " << name()
            << " shares the velocity field of " << first.name() << '.' << nl
            << "    Allowed: inlets in the cloud " << first.name()
            << ", outlets in any" << exit(FatalIOError);
    }
}


void Foam::mpm::materialPointCloud::activate(const bool sort)
{
    // Nodes that become inactive must be left zero
    zeroNodes();
    for (const auto& range : order_.nodeRanges())
    {
        nodes_.leave(range.first, range.second);
    }
    std::vector<const pointStorage*> all;
    for (const materialPointCloud* c : field_->clouds)
    {
        all.push_back(&c->points_);
    }
    order_.activate(all);
    boundary_.activate(order_.nodes());
    if (sort)
    {
        order_.sort(points_);
        nearGroup_.clear();
    }
}


Foam::mpm::index3 Foam::mpm::materialPointCloud::boxCoordinate
(
    const label point
) const
{
    const lattice& cells = grid_.cells();
    index3 i;
    i = 0;
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        i[d] = cells.cellCoordinate(d, x(d)[point]) - grid_.lower(d);
    }
    return i;
}


inline Foam::label Foam::mpm::materialPointCloud::partOf
(
    const label point,
    const index3& i
) const
{
    const lattice& cells = grid_.cells();
    label part = 0;
    if (grid_.nodeCentred())
    {
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            // The same arithmetic as in the kernels
            const scalar inverse = 1/cells.spacing(d);
            const scalar xi = (x(d)[point] - cells.origin(d))*inverse;
            if (xi >= i[d] + grid_.lower(d) + 0.5) part |= 1 << d;
        }
    }
    return part;
}


void Foam::mpm::materialPointCloud::setCell
(
    const label point,
    const index3& i
)
{
    const label cell = grid_.index(i);
    points_.cell()[point] = cell;
    points_.tile()[point] = boundary_.tiles().of(cell, partOf(point, i));
}


void Foam::mpm::materialPointCloud::findView(const label p)
{
    const label cell = points_.cell()[p];
    if (grid_.plateOf(cell) < 0) return;

    // Else it is still in the tile that it had
    const nodeTiles& tiles = boundary_.tiles();
    const label view = grid_.view(cell, position(p));
    if (view == tiles.viewOf(points_.tile()[p])) return;
    points_.tile()[p] =
        tiles.of(cell, partOf(p, grid_.coordinate(cell)), view);
}


void Foam::mpm::materialPointCloud::findViews()
{
    for (label p = 0; grid_.plated() && p < size(); ++p) findView(p);
}


void Foam::mpm::materialPointCloud::updateViews()
{
    if (grid_.plated()) forNearGroups([&](const label p) { findView(p); });
}


bool Foam::mpm::materialPointCloud::findCell
(
    const label point,
    const scalar tolerance
)
{
    const lattice& cells = grid_.cells();
    const label nDim = grid_.nDim();
    const index3 i = boxCoordinate(point);

    // The nearest plane of each direction, if it is near enough, and the cell
    // on its other side
    FixedList<scalar, 3> plane;
    index3 other = i;
    for (label d = 0; d < nDim; ++d)
    {
        const scalar xi = (x(d)[point] - cells.origin(d))/cells.spacing(d);
        plane[d] = std::round(xi);
        if (!(mag(xi - plane[d]) < tolerance)) continue;
        other[d] += (i[d] + grid_.lower(d) < plane[d] ? 1 : -1);
    }

    // Its own cell, else the one across a plane, an edge, a corner
    for (label nPlanes = 0; nPlanes <= nDim; ++nPlanes)
    {
        for (label across = 0; across < (1 << nDim); ++across)
        {
            index3 j = i;
            label n = 0;
            bool inBox = true;
            for (label d = 0; d < nDim; ++d)
            {
                if ((across >> d) & 1)
                {
                    ++n;
                    inBox = inBox && other[d] != i[d];
                    j[d] = other[d];
                }
                inBox = inBox && j[d] >= 0 && j[d] < grid_.nNodes(d) - 1;
            }
            if (n != nPlanes || !inBox || !grid_.ownCell(grid_.index(j)))
            {
                continue;
            }
            for (label d = 0; d < nDim; ++d)
            {
                if (j[d] == i[d]) continue;
                points_.column(x_ + d)[point] = cells.origin(d)
                  + (plane[d] + (j[d] - i[d])*wallGap)*cells.spacing(d);
            }
            setCell(point, j);
            return true;
        }
    }
    return false;
}


void Foam::mpm::materialPointCloud::selectTransfer
(
    const word& defaultScheme,
    const scalar defaultApicRate
)
{
    transfer_ = transferScheme::New(dict_, defaultScheme, defaultApicRate);

    if (transfer_->affine() && C_ < 0)
    {
        C_ = points_.add("velocityGradient", pointStorage::tensorValue);
    }
    if (transfer_->affine() && grid_.shapeFunction() == linear::name)
    {
        // The gradient of the linear function does not vanish where a node has
        // almost no mass: a free surface blows up within some 100 steps
        FatalIOErrorInFunction(dict_)
            << "keyword transfer is " << transfer_->type()
            << ", which is unstable at free surfaces with shapeFunction linear."
            << nl << "    Allowed: FLIP, PIC, XPIC, or a B-spline for"
            << " fvSolution/MPM/shapeFunction" << exit(FatalIOError);
    }
    if (transfer_->filtered()) makeNodes();
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::materialPointCloud::materialPointCloud
(
    const word& name,
    const fvMesh& mesh,
    const backgroundGrid& grid,
    const dictionary& dict,
    const settings& control,
    costMeter& cost,
    const vector& g,
    const word& corners,
    const bool solid,
    const materialPointCloud* leader
)
:
    cloud(mesh, name),
    mesh_(mesh),
    grid_(grid),
    dict_(dict),
    settings_(control),
    energyBalance_(control.energyBalance.found(name)),
    cost_(cost),
    g_(g),
    bodyForce_
    (
        vectorInTime::New(dict, "bodyForce", dimAcceleration, grid.cells())
    ),
    forced_(bodyForce_.valid() || control.gravityInTime),
    acceleration_(g),
    damping_(0),
    forceWork_(0),
    relaxationWork_(0),
    relaxationImpulse_(Zero),
    points_(grid.nDim()),
    x_(points_.add("x", pointStorage::vectorValue)),
    v_(points_.add("U", pointStorage::vectorValue)),
    C_(-1),
    mass_(points_.add("mass", pointStorage::scalarValue)),
    id_(points_.add("id", pointStorage::scalarValue)),
    U_(velocityFile(name, mesh), mesh),
    alpha_
    (
        IOobject
        (
            "alpha." + name,
            mesh.time().timeName(),
            mesh,
            IOobject::NO_READ,
            IOobject::AUTO_WRITE
        ),
        mesh,
        dimensionedScalar(dimless, Zero),
        zeroGradientFvPatchScalarField::typeName
    ),
    open_
    (
        inflowOutflow::New(dict, grid, U_, g, solid, control.strictKeywords)
    ),
    field_
    (
        leader
      ? leader->field_
      : std::make_shared<velocityField>
        (
            grid,
            U_,
            readChoiceOrDefault(dict, "corners", corners, {"slip", "stick"})
         == "slip"
          ? nodeBoundary::slipCorners
          : nodeBoundary::stickCorners,
            inflowOutflow::zones(open_)
        )
    ),
    boundary_(field_->boundary),
    order_(field_->order),
    nodes_(field_->nodes),
    filter_(field_->filter),
    bodies_(nullptr),
    putOut_(0),
    coupling_(nullptr),
    recordWallLoads_(false),
    extremeLeft_(false),
    globalMaxSpeed_(0),
    stepCount_(0),
    expectedPoints_(-1)
{
    if (U_.dimensions() != dimVelocity)
    {
        FatalErrorInFunction
            << "file " << U_.objectPath() << ": keyword dimensions is "
            << U_.dimensions() << '.' << nl << "    Allowed: " << dimVelocity
            << exit(FatalError);
    }

    for (const fvPatchVectorField& Up : U_.boundaryField())
    {
        if (!solid && isA<constrainedWallFvPatchVectorField>(Up))
        {
            const auto& wall =
                refCast<const constrainedWallFvPatchVectorField>(Up);
            if (wall.constraint() == frictionalWall::typeName)
            {
                patchTypes::refuse(Up, "holds grains, not water");
            }
        }
        if (Up.type() == "inletOutlet" && !mesh.foundObject<surfaceScalarField>("phi"))
        {
            phi_.reset
            (
                new surfaceScalarField
                (
                    IOobject("phi", mesh.time().timeName(), mesh),
                    mesh,
                    dimensionedScalar(dimVolume/dimTime, Zero)
                )
            );
        }
    }

    // decomposed lagrangian files need the base points of all ranks
    (void)mesh.tetBasePtIs();

    field_->clouds.push_back(this);
    if (!leads()) checkBoundary();
    makeNodes();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

size_t Foam::mpm::materialPointCloud::pointMemory() const
{
    return size_t(points_.allocated()*points_.bytesPerPoint());
}


size_t Foam::mpm::materialPointCloud::nodeMemory() const
{
    return
        leads() ? nodes_.memory() + boundary_.memory() + order_.memory() : 0;
}


Foam::label Foam::mpm::materialPointCloud::addPoints
(
    const UList<point>& position,
    const labelUList& meshCell,
    const UList<scalar>& id,
    const UList<vector>& velocity
)
{
    const label first = points_.size();
    points_.resize(first + position.size());

    forAll(position, i)
    {
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            const label axis = grid_.cells().axis(d);
            points_.column(x_ + d)[first + i] = position[i][axis];
            points_.column(v_ + d)[first + i] = velocity[i][axis];
        }
        points_.column(id_)[first + i] = id[i];
        setCell(first + i, grid_.coordinate(grid_.boxCell(meshCell[i])));
    }
    return first;
}


void Foam::mpm::materialPointCloud::finishPoints()
{
    findViews();
    findMaxSpeed();
    activate(true);
}


void Foam::mpm::materialPointCloud::finishNodes(const scalar deltaT)
{
    if (!leads()) return;

    boundary_.finish(deltaT, nodes_);
    findWallLoads(deltaT);
}


void Foam::mpm::materialPointCloud::findWallLoads(const scalar deltaT)
{
    if (!leads() || !nodes_.mirrorsRecorded()) return;

    wallLoads_ =
        boundary_.loads(nodes_, deltaT, transfer_->picFraction(deltaT));
}


void Foam::mpm::materialPointCloud::recordWallLoads()
{
    if (leader().recordWallLoads_) return;
    field_->clouds.front()->recordWallLoads_ = true;
    makeNodes();
    activate(false);
}


void Foam::mpm::materialPointCloud::rebuild()
{
    if (!leads()) return;

    if (open_.valid()) open_->rebuild(g_);
    boundary_.rebuild(inflowOutflow::zones(open_));
    if (open_.valid()) open_->giveSpeeds(boundary_);

    order_.clear();
    makeNodes();
    for (materialPointCloud* c : field_->clouds)
    {
        if (c != this && c->open_.valid()) c->open_->rebuild(g_);
        c->makeKernels();
        c->nearGroup_.clear();
        for (label p = 0; p < c->size(); ++p)
        {
            c->setCell(p, c->boxCoordinate(p));
        }
        c->findViews();
    }
    activate(false);
}


Foam::mpm::materialPointCloud::motion
Foam::mpm::materialPointCloud::startMotion(const vector& up)
{
    motion m{0, 0, GREAT, GREAT};
    if (open_.valid() && open_->inlets().size())
    {
        m.inletSpeed = open_->maxSpeed
        (
            time().startTime().value(), time().endTime().value()
        );
        m.inletBottom = open_->bottom(up);
    }

    findMaxSpeed();
    m.initialSpeed = maxSpeed();
    for (label p = 0; p < size(); ++p)
    {
        scalar height = 0;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            height += up[grid_.cells().axis(d)]*x(d)[p];
        }
        m.lowest = min(m.lowest, height);
    }
    reduce(m.lowest, minOp<scalar>());
    reduce(m.initialSpeed, maxOp<scalar>());
    return m;
}


Foam::point Foam::mpm::materialPointCloud::position(const label p) const
{
    point result(Zero);
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        result[grid_.cells().axis(d)] = x(d)[p];
    }
    if (grid_.nDim() == 2)
    {
        result[grid_.cells().axis(2)] = grid_.cells().midPlane();
    }
    return result;
}


void Foam::mpm::materialPointCloud::setInflow(const scalar before)
{
    for (inlet& in : open_->inlets())
    {
        if (in.slowness() == 0) in.setSlowness(slowness(in));
    }
    open_->setSpeeds(time().value() - before, boundary_);
}


void Foam::mpm::materialPointCloud::openEffects(effectsTable& table) const
{
    if (open_.valid()) open_->effects(table);
    else table.add("  open boundaries", false, "no inflowOutflow");
}


Foam::mpm::massAccount Foam::mpm::materialPointCloud::inside() const
{
    massAccount a;
    for (label p = 0; p < size(); ++p) a.add(mass()[p]);
    return a;
}


void Foam::mpm::materialPointCloud::findMaxSpeed()
{
    sums_.maxSpeedSqr =
        open_.valid() ? sqr(open_->speed(time().value())) : 0;
    for (label p = 0; p < size(); ++p)
    {
        scalar sqr = 0;
        for (label d = 0; d < grid_.nDim(); ++d) sqr += Foam::sqr(v(d)[p]);
        sums_.maxSpeedSqr = max(sums_.maxSpeedSqr, sqr);
    }
}


void Foam::mpm::materialPointCloud::addLimits(stepLimits& limits)
{
    const scalar h = grid_.cells().minSpacing();

    limits.addMaximum
    (
        stepLimits::end, [this]() { return maxSpeed(); }, globalMaxSpeed_
    );
    limits.add
    (
        [this]()
        {
            return
                globalMaxSpeed_ > waveSpeed() ? word("advection") : waveName();
        },
        [this, h]() { return h/(waveSpeed() + globalMaxSpeed_); }
    );

    // Explicit diffusion of momentum; maxCo applies to waves only
    const scalar maxCo = limits.maxCo();
    limits.add
    (
        "viscosity",
        [this, h, maxCo]()
        {
            const scalar nu = viscosity();
            return nu > 0 ? sqr(h)/(2*grid_.nDim()*nu)/maxCo : GREAT;
        }
    );
}


Foam::label Foam::mpm::materialPointCloud::nFaster(const scalar speed) const
{
    label n = 0;
    for (label p = 0; p < size(); ++p)
    {
        scalar sqr = 0;
        for (label d = 0; d < grid_.nDim(); ++d) sqr += Foam::sqr(v(d)[p]);
        n += sqr > Foam::sqr(speed);
    }
    return n;
}


Foam::string Foam::mpm::materialPointCloud::pointText(const label p) const
{
    vector velocity(Zero);
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        velocity[grid_.cells().axis(d)] = v(d)[p];
    }
    OStringStream os;
    os  << "cloud " << name() << ", point " << int64_t(points_.column(id_)[p])
        << ", mesh cell " << grid_.meshCell(points_.cell()[p])
        << ", position " << position(p) << ", velocity " << velocity;
    return os.str();
}


Foam::string Foam::mpm::materialPointCloud::firstNonFinite() const
{
    if (std::isfinite(sums_.sumSpeedSqr)) return string();

    for (label p = 0; p < size(); ++p)
    {
        bool finite = true;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            finite = finite && std::isfinite(v(d)[p]);
        }
        if (!finite) return pointText(p);
    }
    return "cloud " + name() + ", sum of squared speeds overflows";
}


void Foam::mpm::materialPointCloud::energy
(
    const vector& g,
    scalar& kinetic,
    scalar& potential,
    scalar& elastic
) const
{
    kinetic = 0;
    potential = 0;
    elastic = 0;
    for (label p = 0; p < size(); ++p)
    {
        scalar vv = 0, gx = 0;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            vv += sqr(v(d)[p]);
            gx += g[grid_.cells().axis(d)]*x(d)[p];
        }
        kinetic += 0.5*mass()[p]*vv;
        potential -= mass()[p]*gx;
    }
}


Foam::scalar Foam::mpm::materialPointCloud::affineEnergy() const
{
    scalar sum = 0;
    for (label d = 0; affine() && d < grid_.nDim(); ++d)
    {
        const scalar moment =
            grid_.secondMoment()*sqr(grid_.cells().spacing(d));
        for (label c = 0; c < grid_.nDim(); ++c)
        {
            const scalar* C = points_.column(C_ + c*grid_.nDim() + d);
            for (label p = 0; p < size(); ++p)
            {
                sum += 0.5*mass()[p]*moment*sqr(C[p]);
            }
        }
    }
    return sum;
}


void Foam::mpm::materialPointCloud::addForceWork(const scalar deltaT)
{
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        const label axis = grid_.cells().axis(d);
        const scalar force = acceleration_[axis] - g_[axis];
        if (force == 0) continue;

        scalar momentum = 0;
        for (label p = 0; p < size(); ++p) momentum += mass()[p]*v(d)[p];
        forceWork_ += deltaT*force*momentum;
    }
}


int64_t Foam::mpm::materialPointCloud::globalSize() const
{
    return returnReduce(int64_t(size()), sumOp<int64_t>());
}


Foam::scalar Foam::mpm::materialPointCloud::globalMass() const
{
    scalar m = 0;
    for (label p = 0; p < size(); ++p) m += mass()[p];
    return returnReduce(m, sumOp<scalar>());
}

// ************************************************************************* //
