/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointCloud.H"
#include "lagrangianGeometry.H"
#include "lagrangianOutput.H"
#include "machineMemory.H"
#include "FlatOutput.H"
#include "PstreamBuffers.H"
#include "PstreamReduceOps.H"
#include <algorithm>
#include <fstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- Largest unit of the last digit of a position, in cells
const scalar positionUnit = 1e-3;

//- Distance behind a wall, in cells, that is put down to rounding of numbers
const scalar binaryRounding = 1e-6;


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


//- Write a lagrangian field in numbers of 4 bytes, uncompressed. The header of
//  OpenFOAM speaks of its own numbers.
template<class Type>
bool writeSingle
(
    const word& name,
    const objectRegistry& cloud,
    const Field<Type>& field
)
{
    IOField<Type> io(fieldHeader(name, cloud, IOobject::NO_READ));
    OStringStream os(IOstream::BINARY);
    io.writeHeader(os);
    std::string header(os.str());
    const std::string own("scalar=" + std::to_string(8*sizeof(scalar)));
    const auto at = header.find(own);
    if (at == std::string::npos) return false;
    header.replace(at, own.size(), "scalar=32");

    mkDir(io.objectPath().path());
    std::ofstream file(io.objectPath(), std::ios::binary);
    file << header << field.size();
    if (field.size())
    {
        const label n = pTraits<Type>::nComponents;
        std::vector<float> values(size_t(field.size())*n);
        forAll(field, i)
        {
            for (label c = 0; c < n; ++c)
            {
                values[size_t(i)*n + c] = float(component(field[i], c));
            }
        }
        file << '(';
        file.write
        (
            reinterpret_cast<const char*>(values.data()),
            values.size()*sizeof(float)
        );
        file << ')';
    }
    else
    {
        file << "()";
    }
    file << "\n";
    file.close();
    return file.good();
}


//- Read a lagrangian field and hand each value to set(i, value); false if
//  there is no such file. To be called on all ranks, as file handlers that
//  read by the master need it.
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
    const bool here = header.typeHeaderOk<IOField<Type>>(true);

    const IOField<Type> field(header, here);
    if (here && field.size() != size)
    {
        FatalErrorInFunction
            << "file " << header.objectPath() << " has " << field.size()
            << " values for " << size << " points." << exit(FatalError);
    }
    forAll(field, i) set(i, field[i]);
    return here;
}


//- All digits of an id
std::string idText(const scalar id)
{
    OStringStream os;
    os.precision(16);
    os << id;
    return os.str();
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

//- Write a part of a cloud
bool writePart
(
    const mpm::materialPointCloud& cloud,
    const polyMesh& mesh,
    const mpm::lagrangianOutput::part& part,
    const pointField& position,
    const labelList& cell,
    MPM_WRITE_PARAMETERS
)
{
    const labelList points(part.points.points(cloud));
    const pointField at(position, points);
    labelList in(points.size());
    forAll(in, i) in[i] = cell[points[i]];

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
        // What reconstructPar goes by
        if (type == cloud::geometryType::COORDINATES && !Pstream::parRun())
        {
            continue;
        }
        ok = mpm::lagrangianGeometry(type, cloud, mesh, at, in)
            .writeObject(MPM_WRITE_ARGUMENTS) && ok;
    }

    const bool ascii = MPM_WRITE_FORMAT == IOstream::ASCII;
    const unsigned digits = IOstream::defaultPrecision();
    cloud.visitFields
    (
        [&](const word& field, const auto& values)
        {
            if (!part.wanted(field)) return;

            typedef typename std::decay<decltype(values()())>::type FieldType;
            tmp<FieldType> chosen(new FieldType(values()(), points));

            // Ids are counts, which no digit of may be lost
            const bool single = part.single && field != "id";
            if (single && !ascii)
            {
                ok = writeSingle(field, cloud, chosen()) && ok;
                return;
            }
            if (single) IOstream::defaultPrecision(7);
            ok = writeField(field, cloud, chosen, MPM_WRITE_ARGUMENTS) && ok;
            IOstream::defaultPrecision(digits);
        }
    );
    return ok;
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
        const bool here = header.typeHeaderOk<IOField<vector>>(true);
        n = IOField<vector>(header, here).size();
    }

    const int64_t total = returnReduce(int64_t(n), sumOp<int64_t>());
    if (!total && expectedPoints_ != 0)
    {
        FatalErrorInFunction
            << "cloud " << name() << " has no points in "
            << time().timePath()/cloud::prefix/name() << '.' << nl
            << "    Run setMaterialPoints first"
            << (Pstream::parRun()
               ? " (in parallel, or before decomposePar)." : ".")
            << nl << "    If redistributePar wrote this time: it does not carry"
            << " clouds; use decomposePar and" << nl << "    reconstructPar."
            << exit(FatalError);
    }

    // Beside the columns one field of the widest kind
    machineMemory::check
    (
        dict_, name(), total, points_.bytesPerPoint() + sizeof(tensor)
    );
    points_.resize(n);
    DynamicList<word> newFields;
    for (const pointStorage::field& f : points_.fields())
    {
        if (writtenFields_.size() && !writtenFields_.found(f.name))
        {
            newFields.append(f.name);
        }
        else if (!readField(f) && n)
        {
            FatalErrorInFunction
                << "file " << fileOf(f.name)
                << " is missing; a restart needs it." << nl
                << "    Run setMaterialPoints, or start from another time. If"
                << " redistributePar wrote this time:" << nl
                << "    it does not carry clouds; use decomposePar and"
                << " reconstructPar." << exit(FatalError);
        }
    }
    checkPoints();

    // Cells from the exact positions
    DynamicList<label> strays;
    for (label p = 0; p < n; ++p)
    {
        if (!findCell(p, binaryRounding)) strays.append(p);
    }
    gatherStrays(strays);
    n = size();
    if (open_.valid() && !open_->started())
    {
        scalar maxId = -1;
        for (label p = 0; p < n; ++p)
        {
            maxId = max(maxId, points_.column(id_)[p]);
        }
        open_->start(inside(), maxId);
    }
    if (newFields.size())
    {
        Info<< "Cloud " << name() << ": with the settings of before, points had"
            << " no " << flatOutput(newFields) << "; it begins here" << nl;
        beginFields(newFields);
    }
    findMaxSpeed();
    findViews();
    activate(false);
}


Foam::fileName Foam::mpm::materialPointCloud::fileOf(const word& field) const
{
    return time().timePath()/cloud::prefix/name()/field;
}


void Foam::mpm::materialPointCloud::gatherStrays(const labelUList& strays)
{
    labelList nStrays(Pstream::nProcs(), Zero);
    nStrays[Pstream::myProcNo()] = strays.size();
    Pstream::gatherList(nStrays);
    Pstream::scatterList(nStrays);
    if (!sum(nStrays)) return;

    const label nColumns = points_.nColumns();
    List<scalarList> all(Pstream::nProcs());
    scalarList& mine = all[Pstream::myProcNo()];
    mine.resize(strays.size()*nColumns);
    forAll(strays, i) points_.pack(strays[i], mine.data() + i*nColumns);
    for (label i = strays.size() - 1; i >= 0; --i) points_.remove(strays[i]);

    auto take = [&](const scalar* columns, const scalar tolerance)
    {
        points_.append(columns, 0);
        const bool found = findCell(points_.size() - 1, tolerance);
        if (!found) points_.remove(points_.size() - 1);
        return found;
    };

    // decomposePar goes by the cells in the file coordinates, which
    // renumberMesh does not renumber. Each rank takes what is its own.
    labelList found(sum(nStrays), Zero);
    if (Pstream::parRun())
    {
        Pstream::gatherList(all);
        Pstream::scatterList(all);
        label i = 0;
        for (const scalarList& columns : all)
        {
            for (label k = 0; k < columns.size(); k += nColumns)
            {
                found[i++] = take(columns.cdata() + k, 0);
            }
        }
        Pstream::listCombineGather(found, plusEqOp<label>());
        Pstream::listCombineScatter(found);
        if (sum(found))
        {
            Info<< "Cloud " << name() << ": " << sum(found) << " points went to"
                << " the rank that has their cell. Were the cells renumbered"
                << " after setMaterialPoints?" << endl;
        }
    }

    // What no rank has, ascii files may have brought behind a wall
    label first = 0;
    for (label rank = 0; rank < Pstream::myProcNo(); ++rank)
    {
        first += nStrays[rank];
    }
    string lost;
    label nLost = 0;
    forAll(strays, i)
    {
        const scalar* columns = mine.cdata() + i*nColumns;
        if (found[first + i] || take(columns, positionUnit)) continue;

        ++nLost;
        if (!lost.empty()) continue;
        points_.append(columns, 0);
        OStringStream os;
        os  << "point " << strays[i] << " at " << position(points_.size() - 1);
        lost = os.str();
        points_.remove(points_.size() - 1);
    }
    if (!returnReduce(nLost, sumOp<label>())) return;

    stringList texts(Pstream::nProcs());
    texts[Pstream::myProcNo()] = lost;
    Pstream::gatherList(texts);
    Pstream::scatterList(texts);
    label rank = 0;
    while (texts[rank].empty()) ++rank;
    FatalErrorInFunction
        << "cloud " << name() << ": " << returnReduce(nLost, sumOp<label>())
        << " points in " << time().timePath()/cloud::prefix/name()
        << " lie outside of the mesh, the first is " << texts[rank].c_str();
    if (Pstream::parRun()) FatalError<< " of rank " << rank;
    FatalError
        << '.' << nl
        << "    Were mesh or decomposition changed after setMaterialPoints?"
        << exit(FatalError);
}


void Foam::mpm::materialPointCloud::checkPoints() const
{
    const scalar* ids = points_.column(id_);

    for (label p = 0; p < size(); ++p)
    {
        if (!(mass()[p] > 0))
        {
            FatalErrorInFunction
                << "cloud " << name() << ", file " << fileOf("mass")
                << ": point " << p << " (id " << idText(ids[p]).c_str()
                << ") has the mass " << mass()[p] << " kg." << nl
                << "    Allowed: mass > 0" << exit(FatalError);
        }
        if (ids[p] < 0 || ids[p] != std::floor(ids[p]))
        {
            FatalErrorInFunction
                << "cloud " << name() << ", file " << fileOf("id")
                << ": point " << p << " has the id "
                << idText(ids[p]).c_str() << '.' << nl
                << "    Allowed: 0, 1, 2, ..., each once" << exit(FatalError);
        }
    }

    // Each id once, over all ranks: each rank gets all points of some ids. By
    // blocks of ids, as points of a rank have few of these blocks.
    struct place { scalar id; label rank; label point; };
    std::vector<place> places;
    places.reserve(size());
    if (Pstream::parRun())
    {
        const label nRanks = Pstream::nProcs();
        const scalar block = 4096;
        List<DynamicList<scalar>> outgoing(nRanks);
        List<DynamicList<label>> points(nRanks);
        for (label p = 0; p < size(); ++p)
        {
            const label rank = std::fmod(std::floor(ids[p]/block), nRanks);
            outgoing[rank].append(ids[p]);
            points[rank].append(p);
        }
        PstreamBuffers buffers(Pstream::commsTypes::nonBlocking);
        for (label rank = 0; rank < nRanks; ++rank)
        {
            if (outgoing[rank].empty()) continue;
            UOPstream to(rank, buffers);
            to << outgoing[rank] << points[rank];
        }
        labelList sizes;
        buffers.finishedSends(sizes);
        for (label rank = 0; rank < nRanks; ++rank)
        {
            if (!sizes[rank]) continue;
            UIPstream from(rank, buffers);
            const List<scalar> theirs(from);
            const labelList theirPoints(from);
            forAll(theirs, i)
            {
                places.push_back(place{theirs[i], rank, theirPoints[i]});
            }
        }
    }
    else
    {
        for (label p = 0; p < size(); ++p)
        {
            places.push_back(place{ids[p], 0, p});
        }
    }
    std::sort
    (
        places.begin(), places.end(),
        [](const place& a, const place& b)
        {
            return
                a.id != b.id ? a.id < b.id
              : a.rank != b.rank ? a.rank < b.rank
              : a.point < b.point;
        }
    );
    for (size_t i = 1; i < places.size(); ++i)
    {
        const place& a = places[i - 1];
        const place& b = places[i];
        if (a.id != b.id) continue;

        auto where = [](const place& x)
        {
            OStringStream os;
            os << "point " << x.point;
            if (Pstream::parRun()) os << " of rank " << x.rank;
            return os.str();
        };
        FatalErrorInFunction
            << "cloud " << name() << ", file " << fileOf("id") << ": "
            << where(a).c_str() << " and "
            << where(b).c_str() << " have the same id "
            << idText(a.id).c_str() << '.' << nl
            << "    Allowed: each id once. Ascii files hold ids up to"
            << " 10^writePrecision only; a file that was merged or edited may"
            << " have a point twice." << exit(FatalError);
    }
}


void Foam::mpm::materialPointCloud::describe
(
    dictionary& basis,
    dictionary& settings
) const
{
    basis.set("constitutiveModel", dict_.get<word>("constitutiveModel"));

    settings = dict_;
    settings.remove("constitutiveModel");

    // The default is a choice, too
    if (transfer_.valid()) settings.set("transfer", transfer_->type());
}


void Foam::mpm::materialPointCloud::readState(const dictionary& dict)
{
    stepCount_ = dict.lookupOrDefault<label>("stepCount", 0);
    expectedPoints_ = readCount(dict, "nPoints");
    writtenFields_ = dict.lookupOrDefault<wordList>("fields", wordList());
    counters_.left.read(dict, "left");

    // A global sum; one rank carries it on
    counters_.wallContacts =
        Pstream::master() ? readCountOrZero(dict, "wallContacts") : 0;

    if (Pstream::master())
    {
        forceWork_ = dict.lookupOrDefault<scalar>("forceWork", 0);
        relaxationWork_ = dict.lookupOrDefault<scalar>("relaxationWork", 0);
        relaxationImpulse_ =
            dict.lookupOrDefault<vector>("relaxationImpulse", Zero);
    }

    if (open_.valid()) open_->read(dict);
    if (transfer_.valid()) transfer_->read(dict);
}


void Foam::mpm::materialPointCloud::writeState(dictionary& dict) const
{
    dict.set("nPoints", globalSize());
    wordList names(points_.fields().size());
    forAll(names, i) names[i] = points_.fields()[i].name;
    dict.set("fields", names);
    dict.set("stepCount", stepCount_);
    if (transfer_.valid()) transfer_->write(dict);
    counters_.left.write(dict, "left");
    dict.set
    (
        "wallContacts",
        returnReduce(counters_.wallContacts, sumOp<int64_t>())
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


Foam::label Foam::mpm::materialPointCloud::neededDigits(string& why) const
{
    // Rounding of a mass by 5e-6 of it
    label digits = 6;
    why = "masses";

    // The digit of a number before its point, counted from one
    auto order = [](const scalar x)
    {
        return x > 0 ? label(std::floor(std::log10(x))) + 1 : label(1);
    };

    const boundBox domain(mesh_.points(), true);
    const scalar h = grid_.cells().minSpacing();
    scalar farthest = 0;
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        const label c = grid_.cells().axis(d);
        farthest = max
        (
            farthest, max(mag(domain.min()[c]), mag(domain.max()[c]))
        );
    }
    const label forPositions =
        order(farthest) + label(std::ceil(-std::log10(positionUnit*h)));
    if (forPositions > digits)
    {
        digits = forPositions;
        OStringStream os;
        os  << "positions at up to " << farthest << " m in cells of " << h
            << " m";
        why = os.str();
    }

    scalar maxId = 0;
    for (label p = 0; p < size(); ++p)
    {
        maxId = max(maxId, points_.column(id_)[p]);
    }
    reduce(maxId, maxOp<scalar>());
    if (order(maxId) > digits)
    {
        digits = order(maxId);
        why = "ids up to " + idText(maxId);
    }
    return digits;
}


void Foam::mpm::materialPointCloud::checkDigits() const
{
    if (time().writeFormat() != IOstream::ASCII) return;

    string why;
    const label needed = neededDigits(why);
    const label given = IOstream::defaultPrecision();
    if (given >= needed) return;

    FatalIOErrorInFunction(time().controlDict())
        << "keyword writePrecision is " << given << ", with writeFormat ascii:"
        << " the points of cloud " << name() << nl
        << "    are not held by so few digits, because of " << why.c_str()
        << '.' << nl << "    Allowed: writePrecision >= " << needed
        << ", or writeFormat binary" << exit(FatalIOError);
}


bool Foam::mpm::materialPointCloud::writeObject(MPM_WRITE_PARAMETERS) const
{
    // The start was checked; ids grow, and controlDict may change in a run
    const unsigned given = IOstream::defaultPrecision();
    if (MPM_WRITE_FORMAT == IOstream::ASCII)
    {
        string why;
        const unsigned needed = neededDigits(why);
        if (needed > given)
        {
            IOstream::defaultPrecision(needed);
            Info<< "Cloud " << name() << ": written with " << needed
                << " digits, not with writePrecision " << given
                << ", because of " << why.c_str() << nl << endl;
        }
    }

    pointField position;
    labelList cell;
    geometry(position, cell);

    const lagrangianOutput::part* part = lagrangianOutput::of(*this);
    if (part)
    {
        const bool ok = writePart
        (
            *this, mesh_, *part, position, cell, MPM_WRITE_ARGUMENTS
        );
        IOstream::defaultPrecision(given);
        return ok;
    }

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
    IOstream::defaultPrecision(given);
    return ok;
}


bool Foam::mpm::materialPointCloud::writeMeshFields() const
{
    const bool ok = alpha_.write();
    return U_.write() && ok;
}

// ************************************************************************* //
