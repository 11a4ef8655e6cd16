/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeBoundary.H"
#include "constrainedWallFvPatchVectorField.H"
#include "convexCorners.H"
#include "inflow.H"
#include "mirrorWall.H"
#include "patchTypes.H"
#include "volFields.H"
#include "HashTable.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::List<Foam::mpm::cellSides::kind> Foam::mpm::nodeBoundary::makeWalls()
{
    List<cellSides::kind> kind(U_.boundaryField().size(), cellSides::inner);

    // The patches that ask for each constraint
    HashTable<nodeConstraint::wallPatches> patches;

    forAll(kind, patchi)
    {
        const fvPatchVectorField& Up = U_.boundaryField()[patchi];
        const word& type = Up.type();

        if (patchTypes::slip.found(type)) kind[patchi] = cellSides::slipWall;
        else if (patchTypes::fixed.found(type))
        {
            kind[patchi] = cellSides::fixedWall;
        }
        else if (patchTypes::open.found(type)) kind[patchi] = cellSides::open;
        else if (!patchTypes::other.found(type))
        {
            patchTypes::refuse
                (Up, "is not a boundary condition of material points");
        }

        if (isA<constrainedWallFvPatchVectorField>(Up))
        {
            const auto& wall =
                refCast<const constrainedWallFvPatchVectorField>(Up);
            patches(wall.constraint()).push_back(&wall);
        }
    }

    for (const word& name : patches.sortedToc())
    {
        constraints_.append(nodeConstraint::New(grid_, patches[name]));
        for (const auto* wall : patches[name])
        {
            kind[wall->patch().index()] = constraints_.last().mirror();
        }
    }
    return kind;
}


void Foam::mpm::nodeBoundary::findControlVolumes()
{
    inverseVolume_ = folding_->volumes();
    grid_.exchange().sum(inverseVolume_);
    for (const nodeConstraint& c : constraints_) c.takeVolume(inverseVolume_);

    for (scalar& v : inverseVolume_)
    {
        v = v > 0 ? 1/v : 0;
    }
    grid_.copyToSeconds(inverseVolume_);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::nodeBoundary::nodeBoundary
(
    const backgroundGrid& grid,
    const volVectorField& U,
    const cornerType corners,
    const std::vector<const inflowZone*>& inlets
)
:
    grid_(grid),
    U_(U),
    corners_(corners),
    nodeWalls_(false)
{
    rebuild(inlets);
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::nodeBoundary::~nodeBoundary()
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::nodeBoundary::rebuild
(
    const std::vector<const inflowZone*>& inlets
)
{
    constraints_.clear();
    inflows_.clear();

    // What open inlets made of the folding is theirs
    const bool kept =
        grid_.cellsKept() && folding_.valid() && inlets.empty()
     && inlets_.empty();
    inlets_ = inlets;
    kind_ = makeWalls();
    nodeWalls_ = kind_.found(cellSides::nodeWall);

    const labelList zones(zoneOfCell());
    const cellSides sides(grid_, U_, kind_, zones);
    const wallNodes walls(grid_, sides);
    beyondOpening_ = sides.beyondOpenings();
    if (kept) folding_->renewViews(nodeWalls_);
    else folding_.reset(new nodeFolding(grid_, sides, nodeWalls_));
    if (nodeWalls_) folding_->keepWalls(walls.single());

    constraints_.append(new mirrorWall(grid_));
    for (const inflowZone* zone : inlets)
    {
        inflows_.push_back(new inflow(grid_, *zone, *folding_));
        constraints_.append(inflows_.back());
    }
    constraints_.append(new convexCorners(grid_, corners_ == stickCorners));
    for (nodeConstraint& c : constraints_) c.build(walls);
    activate(bitSet(grid_.nNodes(), true));

    if (kept)
    {
        tiles_->renewViews();
        inverseVolume_.resize(grid_.nNodes());
        grid_.copyToSeconds(inverseVolume_);
    }
    else
    {
        tiles_.reset(new nodeTiles(*folding_, zones));
        findControlVolumes();
    }
    setLiquid(rho_, nu_);
    for (nodeConstraint* c : further_) c->place();
    if (recorded_) record();
}


Foam::labelList Foam::mpm::nodeBoundary::zoneOfCell() const
{
    labelList zones;
    if (inlets_.empty()) return zones;

    zones.setSize(grid_.mesh().nCells(), -1);
    for (size_t i = 0; i < inlets_.size(); ++i)
    {
        for (const label celli : inlets_[i]->meshCells())
        {
            zones[celli] = label(i);
        }
    }
    return zones;
}


void Foam::mpm::nodeBoundary::record()
{
    recorded_ = true;
    const cellSides sides(grid_, U_, kind_, zoneOfCell());
    shares_.reset(new wallShares(wallNodes(grid_, sides), kind_));
    folding_->record(sides, *shares_);
}


Foam::List<Foam::mpm::nodeConstraint::load> Foam::mpm::nodeBoundary::loads
(
    const nodeMotion& nodes,
    const scalar deltaT,
    const scalar projected
) const
{
    const wallShares& shares = *shares_;
    List<nodeConstraint::load> loads(shares.nPatches());
    for (const nodeConstraint& c : constraints_)
    {
        c.take(nodes, deltaT, projected, shares, loads);
    }

    // And through ghost nodes, whose points are all of this rank
    const nodeMotion::mirrorSums& m = nodes.mirrored;
    for (size_t i = 0; i < folding_->slots().size(); ++i)
    {
        const nodeFolding::mirrorSlot& slot = folding_->slots()[i];
        const nodeVector& old = nodes.oldVelocity[slot.image];
        const nodeVector f = m.force[i]
          + m.mass[i]*(nodes.velocity[slot.image] - old)/deltaT
          + projected/deltaT*(m.momentum[i] + m.mass[i]*old);
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            const label side = slot.wallSide[d];
            if (side < 0) continue;
            nodeConstraint::give
            (
                grid_, slot.wallNode[d], side, d, f[d],
                [&](const label patch)
                {
                    return
                        side/2 == d
                     || shares.kind(patch) == cellSides::fixedWall;
                },
                shares, loads
            );
        }
    }

    // Patches of processors come last
    const label nPatches = returnReduce(loads.size(), minOp<label>());
    loads.setSize(nPatches);
    scalarList values;
    values.setSize(12*nPatches);
    forAll(loads, i)
    {
        for (direction d = 0; d < 3; ++d)
        {
            values[12*i + d] = loads[i].force[d];
            values[12*i + 3 + d] = loads[i].moment[d];
            values[12*i + 6 + d] = loads[i].friction[d];
            values[12*i + 9 + d] = loads[i].frictionMoment[d];
        }
    }
    Pstream::listCombineGather(values, plusEqOp<scalar>());
    Pstream::listCombineScatter(values);
    forAll(loads, i)
    {
        for (direction d = 0; d < 3; ++d)
        {
            loads[i].force[d] = values[12*i + d];
            loads[i].moment[d] = values[12*i + 3 + d];
            loads[i].friction[d] = values[12*i + 6 + d];
            loads[i].frictionMoment[d] = values[12*i + 9 + d];
        }
    }
    return loads;
}


void Foam::mpm::nodeBoundary::setLiquid(const scalar rho, const scalar nu)
{
    rho_ = rho;
    nu_ = nu;
    for (nodeConstraint& c : constraints_) c.setLiquid(rho, nu);
}


void Foam::mpm::nodeBoundary::add(nodeConstraint& further)
{
    further_.push_back(&further);
    further.place();
}


bool Foam::mpm::nodeBoundary::isOpening(const word& patchType)
{
    return patchTypes::open.found(patchType);
}


void Foam::mpm::nodeBoundary::foldPressureAs(const nodeBoundary& other)
{
    folding_->foldPressureAs(other.folding());
}


void Foam::mpm::nodeBoundary::setInflow
(
    const label inlet,
    const bool open,
    const nodeVector& velocity
)
{
    inflows_[inlet]->set(open, velocity);
}


std::vector<Foam::label> Foam::mpm::nodeBoundary::inflowNodes() const
{
    std::vector<label> nodes;
    for (const inflow* in : inflows_)
    {
        if (!in->open()) continue;
        nodes.insert(nodes.end(), in->active().begin(), in->active().end());
    }
    return nodes;
}


Foam::bitSet Foam::mpm::nodeBoundary::pressedNodes() const
{
    bitSet nodes(grid_.nNodes());
    for (const nodeConstraint& c : constraints_) c.findPressed(nodes);
    return nodes;
}


void Foam::mpm::nodeBoundary::activate(const bitSet& active)
{
    for (nodeConstraint& c : constraints_) c.activate(active);
}


void Foam::mpm::nodeBoundary::fold(nodeMotion& nodes) const
{
    for (const nodeConstraint& c : constraints_) c.fold(nodes);
}


void Foam::mpm::nodeBoundary::constrain
(
    nodeField<nodeVector>& velocity,
    const bool homogeneous
) const
{
    for (const nodeConstraint& c : constraints_)
    {
        c.constrain(velocity, homogeneous);
    }
    for (const nodeConstraint* c : further_)
    {
        c->constrain(velocity, homogeneous);
    }
}


void Foam::mpm::nodeBoundary::start(nodeMotion& nodes)
{
    for (nodeConstraint& c : constraints_) c.start(nodes);
    for (nodeConstraint* c : further_) c->start(nodes);
}


void Foam::mpm::nodeBoundary::press(const nodeField<nodeVector>& force)
{
    for (nodeConstraint& c : constraints_) c.press(force);
}


void Foam::mpm::nodeBoundary::relieve
(
    const nodeField<nodeVector>& force,
    const std::vector<scalar>& part
)
{
    for (nodeConstraint& c : constraints_) c.relieve(force, part);
}


void Foam::mpm::nodeBoundary::react(nodeMotion& nodes)
{
    for (nodeConstraint& c : constraints_) c.react(nodes);
    for (nodeConstraint* c : further_) c->react(nodes);
}


void Foam::mpm::nodeBoundary::finish(const scalar deltaT, nodeMotion& nodes)
{
    for (nodeConstraint& c : constraints_) c.finish(deltaT, nodes);
    for (nodeConstraint* c : further_) c->finish(deltaT, nodes);
}


size_t Foam::mpm::nodeBoundary::memory() const
{
    return
        folding_->memory() + tiles_->memory()
      + sizeof(scalar)*inverseVolume_.size()
      + (shares_.valid() ? shares_->memory() : 0);
}

// ************************************************************************* //
