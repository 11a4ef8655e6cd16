/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointCloud.H"
#include "lagrangianGeometry.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- Header of a lagrangian field
IOobject fieldHeader
(
    const word& name,
    const objectRegistry& cloud,
    const IOobject::readOption read
)
{
    return IOobject
    (
        name, cloud.time().timeName(), cloud, read, IOobject::NO_WRITE, false
    );
}


//- Write a lagrangian field
template<class Type>
bool writeField
(
    const word& name,
    const objectRegistry& cloud,
    tmp<Field<Type>> field,
    MPM_WRITE_PARAMETERS
)
{
    IOField<Type> io
    (
        fieldHeader(name, cloud, IOobject::NO_READ),
        std::move(field.ref())
    );
    return io.writeObject(MPM_WRITE_ARGUMENTS);
}


//- Read a lagrangian field and hand each value to set(i, value)
template<class Type, class Set>
bool readValues
(
    const word& name,
    const objectRegistry& cloud,
    const label size,
    const Set& set
)
{
    IOobject header(fieldHeader(name, cloud, IOobject::MUST_READ));
    if (!header.typeHeaderOk<IOField<Type>>(true)) return false;

    const IOField<Type> field(header);
    if (field.size() != size)
    {
        FatalErrorInFunction
            << "file " << header.objectPath() << " has " << field.size()
            << " values for " << size << " points." << exit(FatalError);
    }
    forAll(field, i) set(i, field[i]);
    return true;
}


//- Make a field in a registry
template<class Type>
void storeField
(
    const word& name,
    tmp<Field<Type>> field,
    objectRegistry& obr
)
{
    cloud::createIOField<Type>(name, field().size(), obr) = field;
}

} // End anonymous namespace


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::direction Foam::mpm::materialPointCloud::symmComponent
(
    const lattice& cells,
    const label k
)
{
    static const direction component[3][3] =
    {
        {symmTensor::XX, symmTensor::XY, symmTensor::XZ},
        {symmTensor::XY, symmTensor::YY, symmTensor::YZ},
        {symmTensor::XZ, symmTensor::YZ, symmTensor::ZZ}
    };
    static const label c[6] = {0, 1, 2, 0, 1, 2}, d[6] = {0, 1, 2, 1, 2, 0};
    return component[cells.axis(c[k])][cells.axis(d[k])];
}



bool Foam::mpm::materialPointCloud::readField(const pointStorage::field& f)
{
    const label nDim = grid_.nDim();
    const lattice& cells = grid_.cells();

    if (f.rank == pointStorage::scalarValue)
    {
        scalar* column = points_.column(f.first);
        return readValues<scalar>
        (
            f.name, *this, size(),
            [&](const label i, const scalar s) { column[i] = s; }
        );
    }
    if (f.rank == pointStorage::vectorValue)
    {
        return readValues<vector>
        (
            f.name, *this, size(),
            [&](const label i, const vector& s)
            {
                for (label d = 0; d < nDim; ++d)
                {
                    points_.column(f.first + d)[i] = s[cells.axis(d)];
                }
            }
        );
    }
    if (f.rank == pointStorage::symmTensorValue)
    {
        return readValues<symmTensor>
        (
            f.name, *this, size(),
            [&](const label i, const symmTensor& s)
            {
                for (label k = 0; k < f.nColumns; ++k)
                {
                    points_.column(f.first + k)[i] =
                        s[symmComponent(cells, k)];
                }
            }
        );
    }
    return readValues<tensor>
    (
        f.name, *this, size(),
        [&](const label i, const tensor& s)
        {
            for (label c = 0; c < nDim; ++c)
            for (label d = 0; d < nDim; ++d)
            {
                points_.column(f.first + c*nDim + d)[i] =
                    s[3*cells.axis(c) + cells.axis(d)];
            }
        }
    );
}


Foam::tmp<Foam::scalarField> Foam::mpm::materialPointCloud::scalars
(
    const pointStorage::field& f
) const
{
    tmp<scalarField> result(new scalarField(size()));
    const scalar* column = points_.column(f.first);
    forAll(result.ref(), i) result.ref()[i] = column[i];
    return result;
}


Foam::tmp<Foam::vectorField> Foam::mpm::materialPointCloud::vectors
(
    const pointStorage::field& f
) const
{
    tmp<vectorField> result(new vectorField(size(), Zero));
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        const scalar* column = points_.column(f.first + d);
        const label axis = grid_.cells().axis(d);
        forAll(result.ref(), i) result.ref()[i][axis] = column[i];
    }
    return result;
}


Foam::tmp<Foam::tensorField> Foam::mpm::materialPointCloud::tensors
(
    const pointStorage::field& f
) const
{
    const label nDim = grid_.nDim();
    tmp<tensorField> result(new tensorField(size(), Zero));
    for (label c = 0; c < nDim; ++c)
    for (label d = 0; d < nDim; ++d)
    {
        const scalar* column = points_.column(f.first + c*nDim + d);
        const label k = 3*grid_.cells().axis(c) + grid_.cells().axis(d);
        forAll(result.ref(), i) result.ref()[i][k] = column[i];
    }
    return result;
}


Foam::tmp<Foam::symmTensorField> Foam::mpm::materialPointCloud::symmTensors
(
    const pointStorage::field& f
) const
{
    tmp<symmTensorField> result(new symmTensorField(size(), Zero));
    for (label k = 0; k < f.nColumns; ++k)
    {
        const scalar* column = points_.column(f.first + k);
        const label component = symmComponent(grid_.cells(), k);
        forAll(result.ref(), i) result.ref()[i][component] = column[i];
    }
    return result;
}


Foam::tmp<Foam::pointField> Foam::mpm::materialPointCloud::positions() const
{
    tmp<pointField> result(vectors(points_.fields()[0]));
    if (grid_.nDim() == 2)
    {
        const label axis = grid_.cells().axis(2);
        for (point& x : result.ref()) x[axis] = grid_.cells().midPlane();
    }
    return result;
}


void Foam::mpm::materialPointCloud::geometry
(
    pointField& position,
    labelList& cell
) const
{
    position = positions();
    cell.setSize(size());
    forAll(cell, i) cell[i] = grid_.meshCell(points_.cell()[i]);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::materialPointCloud::readPoints()
{
    // The exact positions decide how many points there are
    label n = 0;
    {
        IOobject header(fieldHeader("x", *this, IOobject::MUST_READ));
        if (header.typeHeaderOk<IOField<vector>>(true))
        {
            n = IOField<vector>(header).size();
        }
    }

    const label total = returnReduce(n, sumOp<label>());
    if (!total && expectedPoints_ != 0)
    {
        FatalErrorInFunction
            << "cloud " << name() << " has no points in "
            << time().timePath()/cloud::prefix/name() << '.' << nl
            << "    Run setMaterialPoints first"
            << (Pstream::parRun()
               ? " (in parallel, or before decomposePar)." : ".")
            << exit(FatalError);
    }

    points_.resize(n);
    if (n)
    {
        for (const pointStorage::field& f : points_.fields())
        {
            if (!readField(f))
            {
                FatalErrorInFunction
                    << "file "
                    << time().timePath()/cloud::prefix/name()/f.name
                    << " is missing; a restart needs it." << nl
                    << "    Run setMaterialPoints, or start from another time."
                    << exit(FatalError);
            }
        }
    }

    // Cells from the exact positions
    for (label p = 0; p < n; ++p)
    {
        pullFromUpperWall(p);
        const index3 i = boxCoordinate(p);
        bool inside = true;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            inside = inside && i[d] >= 0 && i[d] < grid_.nNodes(d) - 1;
        }
        if (!inside || !grid_.ownCell(grid_.index(i)))
        {
            FatalErrorInFunction
                << "cloud " << name() << ": point " << p << " at "
                << position(p)
                << " in " << time().timePath()/cloud::prefix/name()
                << " lies outside of the mesh"
                << (Pstream::parRun() ? " of this rank." : ".") << nl
                << "    Were mesh or decomposition changed after"
                << " setMaterialPoints?" << exit(FatalError);
        }
        setCell(p, i);
    }
    if (open_.valid() && !open_->started())
    {
        scalar maxId = -1;
        for (label p = 0; p < n; ++p)
        {
            maxId = max(maxId, points_.column(id_)[p]);
        }
        open_->start(inside(), maxId);
    }
    findMaxSpeed();
    activate(false);
}


void Foam::mpm::materialPointCloud::readState(const dictionary& dict)
{
    stepCount_ = dict.lookupOrDefault<label>("stepCount", 0);
    expectedPoints_ = dict.get<label>("nPoints");
    counters_.left.read(dict, "left");

    // A global sum; one rank carries it on
    counters_.wallContacts =
        Pstream::master() ? dict.lookupOrDefault<label>("wallContacts", 0) : 0;

    if (Pstream::master())
    {
        forceWork_ = dict.lookupOrDefault<scalar>("forceWork", 0);
        relaxationWork_ = dict.lookupOrDefault<scalar>("relaxationWork", 0);
        relaxationImpulse_ =
            dict.lookupOrDefault<vector>("relaxationImpulse", Zero);
    }

    if (open_.valid()) open_->read(dict);
}


void Foam::mpm::materialPointCloud::writeState(dictionary& dict) const
{
    dict.set("nPoints", globalSize());
    dict.set("stepCount", stepCount_);
    counters_.left.write(dict, "left");
    dict.set
    (
        "wallContacts",
        returnReduce(counters_.wallContacts, sumOp<label>())
    );
    if (forced_)
    {
        dict.set("forceWork", returnReduce(forceWork_, sumOp<scalar>()));
    }
    if (relaxes())
    {
        dict.set
        (
            "relaxationWork", returnReduce(relaxationWork_, sumOp<scalar>())
        );
        dict.set
        (
            "relaxationImpulse",
            returnReduce(relaxationImpulse_, sumOp<vector>())
        );
    }
    if (open_.valid() && open_->started()) open_->write(dict);
}


void Foam::mpm::materialPointCloud::writeObjects(objectRegistry& obr) const
{
    pointField position;
    labelList cell;
    geometry(position, cell);
    cloud::createIOField<point>("position", size(), obr) = position;

    for (const pointStorage::field& f : points_.fields())
    {
        if (f.rank == pointStorage::scalarValue)
        {
            storeField(f.name, scalars(f), obr);
        }
        else if (f.rank == pointStorage::vectorValue)
        {
            storeField(f.name, vectors(f), obr);
        }
    }
    HashTable<tmp<scalarField>> derived;
    derivedFields(derived);
    forAllIters(derived, iter) storeField(iter.key(), iter.val(), obr);
}


bool Foam::mpm::materialPointCloud::writeObject(MPM_WRITE_PARAMETERS) const
{
    pointField position;
    labelList cell;
    geometry(position, cell);

    bool ok = true;
    for
    (
        const auto type :
        {
            cloud::geometryType::POSITIONS,
            cloud::geometryType::COORDINATES
        }
    )
    {
        ok = lagrangianGeometry(type, *this, mesh_, position, cell)
            .writeObject(MPM_WRITE_ARGUMENTS) && ok;
    }

    visitFields
    (
        [&](const word& field, const auto& values)
        {
            ok = writeField(field, *this, values(), MPM_WRITE_ARGUMENTS) && ok;
        }
    );
    return ok;
}


bool Foam::mpm::materialPointCloud::writeMeshFields() const
{
    const bool ok = alpha_.write();
    return U_.write() && ok;
}

// ************************************************************************* //
