/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "inlet.H"
#include "dictionaryEntries.H"
#include "timeFunction.H"
#include "listed.H"
#include "TableBase.H"
#include "SubField.H"
#include "volFields.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- Part of a velocity or a cell that is put down to rounding
const scalar rounding = 1e-6;


//- Water is nearly incompressible: no flow comes near to its speed of sound
void checkSpeed
(
    const dictionary& dict,
    const char* keyword,
    const scalar speed,
    const scalar time
)
{
    if (!(speed <= mpm::maxFlowSpeed))
    {
        FatalIOErrorInFunction(dict)
            << "keyword " << keyword << " of inlet " << dict.dictName()
            << " gives " << speed << " m/s at time " << time << '.' << nl
            << "    Allowed: up to " << mpm::maxFlowSpeed
            << " m/s, the speed of sound of water" << exit(FatalIOError);
    }
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

template<class Type>
Foam::tmp<Foam::Field<Type>> Foam::mpm::inlet::tableValues
(
    const Function1<Type>& f
)
{
    const auto* table =
        dynamic_cast<const Function1Types::TableBase<Type>*>(&f);
    return table ? table->y() : tmp<Field<Type>>(new Field<Type>());
}


void Foam::mpm::inlet::readFlow()
{
    if (dict_.found("velocity") == dict_.found("discharge"))
    {
        FatalIOErrorInFunction(dict_)
            << "inlet " << name_ << " has "
            << (dict_.found("velocity") ? "both keywords" : "neither keyword")
            << " velocity and discharge." << nl << "    Allowed: one of them"
            << exit(FatalIOError);
    }
    if (dict_.found("velocity"))
    {
        velocity_ = readTimeFunction<vector>(dict_, "velocity", dimVelocity);
    }
    else
    {
        discharge_ = readTimeFunction<scalar>(dict_, "discharge", dimArea/dimTime);
    }
}


void Foam::mpm::inlet::findExtent
(
    const backgroundGrid& grid,
    const polyPatch& patch,
    const vector& g
)
{
    const lattice& cells = grid.cells();

    label direction = -1;
    forAll(patch, i)
    {
        label d, s;
        cells.faceDirection(patch.faceAreas()[i], d, s);
        direction = max(direction, d);
    }
    reduce(direction, maxOp<label>());

    // Without gravity the last one along the patch
    vertical_ = cells.along(g);
    for (label d = 0; !(mag(g) > 0) && d < grid.nDim(); ++d)
    {
        if (d != direction) vertical_ = d;
    }
    up_ = g[cells.axis(vertical_)] > 0 ? -1 : 1;
    gravity_ = mag(g[cells.axis(vertical_)]);

    if (vertical_ == direction)
    {
        vertical_ = -1;
        gravity_ = 0;
        for (const char* keyword : {"base", "depth"})
        {
            if (dict_.found(keyword))
            {
                FatalIOErrorInFunction(dict_)
                    << "keyword " << keyword << " of inlet " << name_
                    << ": patch " << patch.name()
                    << " looks up or down and has no height." << nl
                    << "    Allowed: no base and no depth"
                    << exit(FatalIOError);
            }
        }
        if (discharge_.valid())
        {
            FatalIOErrorInFunction(dict_)
                << "keyword discharge of inlet " << name_ << ": patch "
                << patch.name() << " looks up or down and has no depth." << nl
                << "    Allowed: velocity" << exit(FatalIOError);
        }
        return;
    }

    scalar lowest = GREAT, highest = -GREAT;
    for (const point& x : patch.localPoints())
    {
        const scalar height = up_*x[cells.axis(vertical_)];
        lowest = min(lowest, height);
        highest = max(highest, height);
    }
    reduce(lowest, minOp<scalar>());
    reduce(highest, maxOp<scalar>());

    // Rounding of the mesh
    const scalar small = rounding*cells.spacing(vertical_);
    base_ = readBoundedOrDefault
    (
        dict_, "base", dimLength, lowest, lowest - small, highest, true
    );
    depth_ = readBoundedOrDefault
    (
        dict_, "depth", dimLength, highest - base_,
        0, highest - base_ + small, false, true
    );
}


void Foam::mpm::inlet::makeLayer
(
    const backgroundGrid& grid,
    const label nPoints
)
{
    const lattice& cells = grid.cells();
    const label nDim = grid.nDim();
    const label normal = zone_->direction();

    spacing_ = cells.spacing(normal)/nPoints;
    layerVolume_ = 0;

    std::vector<char> own(zone_->faces().size(), 0);
    for (const label f : zone_->ownFaces()) own[f] = 1;

    for (size_t f = 0; f < zone_->faces().size(); ++f)
    {
        const inflowZone::face& face = zone_->faces()[f];

        // Points along the patch, evenly over the part that is open
        label n[3] = {1, 1, 1};
        scalar first[3] = {0, 0, 0}, part[3] = {1, 1, 1};
        scalar volume = cells.cellVolume()/nPoints;
        for (label d = 0; d < nDim; ++d)
        {
            if (d == normal) continue;
            if (d == vertical_)
            {
                first[d] = face.lower;
                part[d] = face.upper - face.lower;
            }
            n[d] = max(label(1), label(std::round(nPoints*part[d])));
            volume *= part[d]/n[d];
        }

        for (label k = 0; k < n[2]; ++k)
        for (label j = 0; j < n[1]; ++j)
        for (label i = 0; i < n[0]; ++i)
        {
            const label at[3] = {i, j, k};
            place p;
            p.x = scalar(0);
            p.volume = volume;
            p.depth = 0;
            p.own = own[f];
            for (label d = 0; d < nDim; ++d)
            {
                const scalar xi =
                    d == normal
                  ? scalar(zone_->side())
                  : first[d] + part[d]*(at[d] + 0.5)/n[d];
                p.x[d] = cells.origin(d)
                  + (face.cell[d] + xi)*cells.spacing(d);
            }
            if (vertical_ >= 0)
            {
                p.depth = base_ + depth_ - up_*p.x[vertical_];
            }
            layerVolume_ += volume;
            places_.push_back(p);
        }
    }
}


Foam::scalar Foam::mpm::inlet::speedOf
(
    const vector& velocity,
    const scalar time
) const
{
    const scalar normal = velocity & normal_;
    if (!(normal >= 0) || mag(velocity - normal*normal_) > rounding*normal)
    {
        FatalIOErrorInFunction(dict_)
            << "keyword velocity of inlet " << name_ << " is " << velocity
            << " at time " << time << '.' << nl
            << "    Allowed: velocities along " << normal_
            << ", into the domain, or zero" << exit(FatalIOError);
    }
    checkSpeed(dict_, "velocity", normal, time);
    return normal;
}


Foam::scalar Foam::mpm::inlet::speedOf
(
    const scalar discharge,
    const scalar time
) const
{
    if (!(discharge >= 0))
    {
        FatalIOErrorInFunction(dict_)
            << "keyword discharge of inlet " << name_ << " is " << discharge
            << " at time " << time << '.' << nl
            << "    Allowed: discharge >= 0" << exit(FatalIOError);
    }
    checkSpeed(dict_, "discharge", discharge/depth_, time);
    return discharge/depth_;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::inlet::inlet
(
    const word& name,
    const dictionary& dict,
    const backgroundGrid& grid,
    const volVectorField& U,
    const vector& g,
    const bool solid,
    const bool strictKeywords
)
:
    name_(name),
    dict_(dict),
    normal_(Zero),
    inward_(0),
    vertical_(-1),
    up_(1),
    base_(0),
    depth_(0),
    gravity_(0),
    voidRatio_(-1),
    spacing_(0),
    layerVolume_(0),
    slowness_(0),
    speed_(0),
    displacement_(0)
{
    wordList known
    ({
        "patch", "velocity", "discharge", "base", "depth",
        "pointsPerDirection", "zoneCells"
    });
    if (solid) known.append("voidRatio");
    checkKeywords(dict, known, strictKeywords);

    const polyBoundaryMesh& patches = grid.mesh().boundaryMesh();
    const word patchName(dict.get<word>("patch"));
    const label patchi = patches.findPatchID(patchName);
    DynamicList<word> fixed;
    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        if (Up.type() == "fixedValue") fixed.append(Up.patch().name());
    }
    if
    (
        patchi < 0
     || U.boundaryField()[patchi].type() != "fixedValue"
    )
    {
        FatalIOErrorInFunction(dict)
            << "keyword patch of inlet " << name << " is " << patchName
            << ", which is "
            << (
                   patchi < 0
                 ? string("no patch of the mesh")
                 : "of type " + U.boundaryField()[patchi].type() + " in "
                 + U.name()
               )
            << '.' << nl << "    Allowed: patches of type fixedValue in "
            << U.name() << ": " << listed(fixed) << exit(FatalIOError);
    }

    readFlow();
    findExtent(grid, patches[patchi], g);

    if (solid && dict.found("voidRatio"))
    {
        voidRatio_ = readPositive(dict, "voidRatio", dimless);
        warnUnusual(dict, {{"voidRatio", 0.2, GREAT, "packings of grains"}});
    }

    const label nPoints =
        readIntegerOrDefault(dict, "pointsPerDirection", 2, 1, 16);
    patch_ = patchi;
    zoneCells_ = readIntegerOrDefault(dict, "zoneCells", 1, 1, 100);
    makeZone(grid);
    if (zone_->bent() || zone_->faces().empty())
    {
        FatalIOErrorInFunction(dict)
            << "keyword patch of inlet " << name << ": patch " << patchName
            << (
                   zone_->bent()
                 ? " looks in different directions."
                 : " has no faces in the height of the inlet."
               )
            << nl << "    Allowed: a plane patch of the solved directions"
            << exit(FatalIOError);
    }
    inward_ = zone_->side() ? -1 : 1;
    normal_[grid.cells().axis(zone_->direction())] = inward_;
    makeLayer(grid, nPoints);

    // What can be checked before the run
    auto checkTable = [&](const auto& f)
    {
        using Type =
            typename std::decay_t<decltype(f)>::returnType;
        const auto* table =
            dynamic_cast<const Function1Types::TableBase<Type>*>(&f);
        if (!table) return;

        const tmp<scalarField> times(table->x());
        const tmp<Field<Type>> values(table->y());
        forAll(values(), i) speedOf(values()[i], times()[i]);
    };
    if (velocity_.valid()) checkTable(*velocity_);
    else checkTable(*discharge_);
    volumeSpeed(grid.mesh().time().value());
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::inlet::makeZone(const backgroundGrid& grid)
{
    const scalar lower = up_ > 0 ? base_ : -(base_ + depth_);
    zone_.reset
    (
        new inflowZone
        (
            grid, patch_, vertical_, lower, lower + depth_, zoneCells_
        )
    );
}


Foam::scalar Foam::mpm::inlet::top
(
    const backgroundGrid& grid,
    const vector& up
) const
{
    return bottom(grid, up)
      + (vertical_ < 0 ? 0 : depth_*up_*up[grid.cells().axis(vertical_)]);
}


Foam::scalar Foam::mpm::inlet::bottom
(
    const backgroundGrid& grid,
    const vector& up
) const
{
    scalar lowest = GREAT;
    for (const place& p : places_)
    {
        scalar height = 0;
        for (label d = 0; d < grid.nDim(); ++d)
        {
            // The lower end itself
            const scalar x = d == vertical_ ? up_*base_ : p.x[d];
            height += up[grid.cells().axis(d)]*x;
        }
        lowest = min(lowest, height);
    }
    return lowest;
}


Foam::scalar Foam::mpm::inlet::volumeSpeed(const scalar time) const
{
    return
        velocity_.valid()
      ? speedOf(velocity_->value(time), time)
      : speedOf(discharge_->value(time), time);
}


Foam::scalar Foam::mpm::inlet::maxSpeed
(
    const scalar start,
    const scalar end
) const
{
    // Tables by their values, other functions by samples
    const label nSamples = 1000;

    scalar largest = 0;
    for (label i = 0; i <= nSamples; ++i)
    {
        largest = max
        (
            largest, volumeSpeed(start + (end - start)*i/nSamples)
        );
    }
    if (velocity_.valid())
    {
        const tmp<vectorField> values(tableValues(*velocity_));
        for (const vector& v : values()) largest = max(largest, mag(v));
    }
    else
    {
        const tmp<scalarField> values(tableValues(*discharge_));
        for (const scalar q : values()) largest = max(largest, q/depth_);
    }
    return largest;
}


void Foam::mpm::inlet::setSpeed(const scalar time)
{
    speed_ = slowness_*volumeSpeed(time);
}


Foam::mpm::nodeVector Foam::mpm::inlet::velocity() const
{
    nodeVector v{};
    v[zone_->direction()] = inward_*speed_;
    return v;
}


void Foam::mpm::inlet::advance(const scalar deltaT)
{
    displacement_ += speed_*deltaT;
}


Foam::scalar Foam::mpm::inlet::takeLayer()
{
    displacement_ -= spacing_;
    return displacement_ + 0.5*spacing_;
}


void Foam::mpm::inlet::read(const dictionary& dict)
{
    displacement_ = dict.get<scalar>("displacement");
    entered_.read(dict, "entered");
}


void Foam::mpm::inlet::write(dictionary& dict) const
{
    dict.set("displacement", displacement_);
    entered_.write(dict, "entered");
}

// ************************************************************************* //
