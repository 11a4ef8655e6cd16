/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pointHistory.H"
#include "atomicHDF5Driver.H"
#include "dictionary.H"
#include "OSspecific.H"
#include "Pstream.H"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Of the layout of the file
const int64_t format = 1;

//- Values of a chunk; each chunk is compressed on its own
const hsize_t chunkValues = 32768;


//- Closes an identity of the library at the end of its scope
class held
{
    hid_t id_;
    herr_t (*close_)(hid_t);

public:

    held(const hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~held() { if (id_ >= 0) close_(id_); }

    held(const held&) = delete;
    void operator=(const held&) = delete;

    operator hid_t() const { return id_; }
    bool ok() const { return id_ >= 0; }
};


//- The library says nothing by itself while this lives
class quiet
{
    H5E_auto2_t function_ = nullptr;
    void* data_ = nullptr;

public:

    quiet()
    {
        H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
        H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    }
    ~quiet() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }
};


hid_t accessProperties()
{
    const hid_t id = H5Pcreate(H5P_FILE_ACCESS);
    if (id >= 0) Foam::mpm::atomicHDF5Driver::set(id);
    return id;
}


template<class Type> hid_t memoryType();
template<> hid_t memoryType<double>() { return H5T_NATIVE_DOUBLE; }
template<> hid_t memoryType<int64_t>() { return H5T_NATIVE_INT64; }


template<class Type>
bool writeAttribute(const hid_t object, const char* name, const Type value)
{
    const held space(H5Screate(H5S_SCALAR), H5Sclose);
    const held attribute
    (
        H5Acreate2
        (
            object, name, memoryType<Type>(), space, H5P_DEFAULT, H5P_DEFAULT
        ),
        H5Aclose
    );
    return attribute.ok()
        && H5Awrite(attribute, memoryType<Type>(), &value) >= 0;
}


bool writeAttribute
(
    const hid_t object,
    const char* name,
    const std::string& value
)
{
    const held type(H5Tcopy(H5T_C_S1), H5Tclose);
    H5Tset_size(type, std::max<size_t>(1, value.size()));
    const held space(H5Screate(H5S_SCALAR), H5Sclose);
    const held attribute
    (
        H5Acreate2(object, name, type, space, H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose
    );
    return attribute.ok() && H5Awrite(attribute, type, value.c_str()) >= 0;
}


template<class Type>
bool readAttribute(const hid_t object, const char* name, Type& value)
{
    const held attribute(H5Aopen(object, name, H5P_DEFAULT), H5Aclose);
    return attribute.ok()
        && H5Aread(attribute, memoryType<Type>(), &value) >= 0;
}


//- Names of the members of a group, in the order of the alphabet
bool members(const hid_t group, std::vector<std::string>& names)
{
    return H5Literate
    (
        group, H5_INDEX_NAME, H5_ITER_INC, nullptr,
        [](hid_t, const char* name, const H5L_info_t*, void* to) -> herr_t
        {
            static_cast<std::vector<std::string>*>(to)->push_back(name);
            return 0;
        },
        &names
    ) >= 0;
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::pointHistory::fail(const std::string& message) const
{
    // OpenFOAM makes a warning of most errors of a function object and goes on
    // without it; on ranks the others would wait for this one for ever
    if (Pstream::parRun()) FatalIOError.throwExceptions(false);

    FatalIOErrorInFunction(dictionary(path_))
        << message.c_str() << exit(FatalIOError);
}


void Foam::mpm::pointHistory::check(const bool ok, const string& what)
{
    if (ok) return;

    // What the library knows: the innermost reason
    std::string reason;
    H5Ewalk2
    (
        H5E_DEFAULT, H5E_WALK_UPWARD,
        [](unsigned n, const H5E_error2_t* e, void* to) -> herr_t
        {
            if (n == 0 && e->desc) *static_cast<std::string*>(to) = e->desc;
            return 0;
        },
        &reason
    );
    if (file_ >= 0)
    {
        atomicHDF5Driver::abandon(file_);
        if (group_ >= 0) H5Gclose(group_);
        H5Fclose(file_);
        file_ = group_ = -1;
    }
    fail
    (
        "cannot " + what + ' ' + path_
      + (reason.empty() ? "" : " (" + reason + ')')
      + ".\n    Is it a file of materialPointHDF5? What it held before is as it"
        " was."
    );
}


void Foam::mpm::pointHistory::open()
{
    const held access(accessProperties(), H5Pclose);
    file_ = H5Fopen(path_.c_str(), H5F_ACC_RDWR, access);
    check(file_ >= 0 && atomicHDF5Driver::protect(file_), "open");
}


void Foam::mpm::pointHistory::create()
{
    // In one go: a file without its first attributes is none
    const fileName partial(path_ + ".partial");
    {
        const held access(accessProperties(), H5Pclose);
        file_ = H5Fcreate(partial.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
        check
        (
            file_ >= 0
         && writeAttribute(file_, "cloud", std::string(cloud_))
         && writeAttribute(file_, "format", format),
            "create"
        );
        close();
    }
    check(std::rename(partial.c_str(), path_.c_str()) == 0, "create");
}


void Foam::mpm::pointHistory::close()
{
    const hid_t file = file_;
    file_ = -1;
    check(H5Fclose(file) >= 0, "write to");

    const std::string failure(atomicHDF5Driver::failure());
    if (!failure.empty())
    {
        fail
        (
            "cannot write to " + path_ + ": " + failure
          + ".\n    What it held before is as it was."
        );
    }
}


void Foam::mpm::pointHistory::readTimes()
{
    times_.clear();

    int64_t found = 0;
    std::vector<std::string> groups;
    check
    (
        readAttribute(file_, "format", found) && found == format
     && members(file_, groups),
        "read"
    );
    for (const std::string& name : groups)
    {
        const held group(H5Gopen2(file_, name.c_str(), H5P_DEFAULT), H5Gclose);
        int64_t step = 0, nPoints = 0;
        timeInfo t;
        t.group = name;

        // begin() counts on from it
        check
        (
            name.size() == 6
         && name.find_first_not_of("0123456789") == std::string::npos,
            "read group " + name + " (allowed: six digits) of"
        );
        std::vector<std::string> fields;
        check
        (
            group.ok()
         && readAttribute(group, "time", t.time)
         && readAttribute(group, "step", step)
         && readAttribute(group, "nPoints", nPoints)
         && members(group, fields),
            "read group " + name + " of"
        );
        t.step = step;
        t.nPoints = nPoints;
        for (const std::string& field : fields)
        {
            const held set
            (
                H5Dopen2(group, field.c_str(), H5P_DEFAULT), H5Dclose
            );
            const held space(H5Dget_space(set), H5Sclose);
            const held type(H5Dget_type(set), H5Tclose);
            hsize_t dims[2] = {0, 1};
            const int nDims = H5Sget_simple_extent_ndims(space);
            check
            (
                (nDims == 1 || nDims == 2)
             && H5Sget_simple_extent_dims(space, dims, nullptr) >= 0,
                "read data set " + name + '/' + field + " of"
            );
            t.fields.push_back
            (
                fieldInfo
                {
                    field,
                    label(nDims == 2 ? dims[1] : 1),
                    H5Tget_class(type) == H5T_INTEGER,
                    label(H5Tget_size(type))
                }
            );
        }
        times_.push_back(t);
    }
}


void Foam::mpm::pointHistory::addValues
(
    const fieldInfo& info,
    const void* values,
    const int64_t typeInMemory
)
{
    const quiet q;
    timeInfo& t = times_.back();

    const hsize_t dims[2] = {hsize_t(t.nPoints), hsize_t(info.nComponents)};
    const int nDims = info.nComponents > 1 ? 2 : 1;
    const held space(H5Screate_simple(nDims, dims, nullptr), H5Sclose);
    const held creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);

    bool ok = space.ok() && creation.ok();
    if (compressionLevel_ > 0 && t.nPoints > 0)
    {
        const hsize_t chunk[2] =
        {
            std::max<hsize_t>(1, std::min(dims[0], chunkValues/dims[1])),
            dims[1]
        };
        ok = ok
         && H5Pset_chunk(creation, nDims, chunk) >= 0
         && H5Pset_shuffle(creation) >= 0
         && H5Pset_deflate(creation, compressionLevel_) >= 0;
    }
    const hid_t typeInFile =
        info.integer ? H5T_STD_I64LE
      : info.bytes == 4 ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;

    const held set
    (
        ok
      ? H5Dcreate2
        (
            group_, info.name.c_str(), typeInFile, space, H5P_DEFAULT,
            creation, H5P_DEFAULT
        )
      : -1,
        H5Dclose
    );
    ok = set.ok()
     && H5Dwrite(set, typeInMemory, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;

    check(ok, "write field " + info.name + " to");
    t.fields.push_back(info);
}


void Foam::mpm::pointHistory::writeIndex() const
{
    const fileName partial(indexPath() + ".partial");
    std::ofstream os(partial);
    os.precision(17);

    const string file(path_.name());
    os  << "<?xml version=\"1.0\" ?>\n"
        << "<!DOCTYPE Xdmf SYSTEM \"Xdmf.dtd\" []>\n"
        << "<Xdmf Version=\"2.0\">\n<Domain>\n"
        << "<Grid Name=\"" << cloud_ << "\" GridType=\"Collection\""
        << " CollectionType=\"Temporal\">\n";

    for (const timeInfo& t : times_)
    {
        auto item = [&](const fieldInfo& f)
        {
            os  << "<DataItem Format=\"HDF\" NumberType=\""
                << (f.integer ? "Int" : "Float") << "\" Precision=\"" << f.bytes
                << "\" Dimensions=\"" << t.nPoints;
            if (f.nComponents > 1) os << ' ' << f.nComponents;
            os  << "\">" << file << ":/" << t.group << '/' << f.name
                << "</DataItem>";
        };

        os  << "<Grid Name=\"" << cloud_ << "\" GridType=\"Uniform\">\n"
            << "<Time Value=\"" << t.time << "\"/>\n";

        // Readers of XDMF know no grid without points
        if (t.nPoints == 0)
        {
            os  << "<Topology TopologyType=\"Polyvertex\""
                << " NumberOfElements=\"0\"/>\n"
                << "<Geometry GeometryType=\"XYZ\"><DataItem Format=\"XML\""
                << " Dimensions=\"0 3\"/></Geometry>\n</Grid>\n";
            continue;
        }

        os  << "<Topology TopologyType=\"Polyvertex\" NodesPerElement=\"1\""
            << " NumberOfElements=\"" << t.nPoints << "\"/>\n";
        for (const fieldInfo& f : t.fields)
        {
            if (f.name == "x")
            {
                os  << "<Geometry GeometryType=\"XYZ\">";
                item(f);
                os  << "</Geometry>\n";
                continue;
            }
            os  << "<Attribute Name=\"" << f.name << "\" AttributeType=\""
                << (
                       f.nComponents == 1 ? "Scalar"
                     : f.nComponents == 3 ? "Vector"
                     : f.nComponents == 6 ? "Tensor6" : "Tensor"
                   )
                << "\" Center=\"Node\">";
            item(f);
            os  << "</Attribute>\n";
        }
        os  << "</Grid>\n";
    }
    os  << "</Grid>\n</Domain>\n</Xdmf>\n";
    os.close();

    if (!os || std::rename(partial.c_str(), indexPath().c_str()) != 0)
    {
        fail("cannot write " + indexPath() + "; is the disk full?");
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::pointHistory::pointHistory
(
    const fileName& path,
    const word& cloud
)
:
    path_(path),
    cloud_(cloud),
    compressionLevel_(0),
    realBytes_(8),
    file_(-1),
    group_(-1)
{
    check(atomicHDF5Driver::recover(path_), "complete");
    if (!isFile(path_, false)) return;

    const quiet q;
    open();
    readTimes();
    close();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::pointHistory::removeFrom
(
    const label step,
    const scalar time
)
{
    auto late = [&](const timeInfo& t)
    {
        return t.step >= step || t.time > time;
    };
    if (std::none_of(times_.begin(), times_.end(), late)) return;

    if (std::all_of(times_.begin(), times_.end(), late))
    {
        // The library does not use the space of what was deleted again
        times_.clear();
        rm(indexPath());
        check(rm(path_), "remove");
        return;
    }

    const quiet q;
    open();
    std::vector<timeInfo> kept;
    for (const timeInfo& t : times_)
    {
        if (!late(t))
        {
            kept.push_back(t);
            continue;
        }
        check
        (
            H5Ldelete(file_, t.group.c_str(), H5P_DEFAULT) >= 0,
            "remove group " + t.group + " of"
        );
    }
    close();
    times_ = kept;
    writeIndex();
}


void Foam::mpm::pointHistory::begin
(
    const label step,
    const scalar time,
    const label nPoints
)
{
    const quiet q;
    if (!isFile(path_, false))
    {
        mkDir(path_.path());
        create();
    }
    open();

    // Behind the last one. Six digits, so that names sort like times
    const label last =
        times_.empty() ? -1 : label(std::stol(times_.back().group));
    check(last < 999999, "add time number 1000000 to");
    std::string group(std::to_string(1000000 + last + 1).substr(1));

    group_ =
        H5Gcreate2(file_, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    check
    (
        group_ >= 0
     && writeAttribute(group_, "time", double(time))
     && writeAttribute(group_, "step", int64_t(step))
     && writeAttribute(group_, "nPoints", int64_t(nPoints)),
        "add a time to"
    );
    times_.push_back(timeInfo{group, time, step, nPoints, {}});
}


void Foam::mpm::pointHistory::add
(
    const word& name,
    const label nComponents,
    const std::vector<scalar>& values
)
{
    addValues
    (
        fieldInfo{name, nComponents, false, realBytes_},
        values.data(),
        H5T_NATIVE_DOUBLE
    );
}


void Foam::mpm::pointHistory::add
(
    const word& name,
    const std::vector<int64_t>& values
)
{
    addValues(fieldInfo{name, 1, true, 8}, values.data(), H5T_NATIVE_INT64);
}


void Foam::mpm::pointHistory::end()
{
    const quiet q;
    H5Gclose(group_);
    group_ = -1;
    close();
    writeIndex();
}

// ************************************************************************* //
