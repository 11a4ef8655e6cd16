/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pointHistory.H"
#include "dictionary.H"
#include "OSspecific.H"
#include "Pstream.H"
#include <hdf5.h>
#include <hdf5_hl.h>
#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Of the layout of the files
const long format = 2;

//- Values of a chunk; each chunk is compressed on its own
const hsize_t chunkValues = 32768;

//- Digits of the name of a time, so that names sort like times
const size_t nDigits = 6;


//- Closes a handle of the library at the end of its scope
class handle
{
    hid_t id_;
    herr_t (*close_)(hid_t);

public:

    handle(const hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
    ~handle() { if (id_ >= 0) close_(id_); }

    handle(const handle&) = delete;
    void operator=(const handle&) = delete;

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


bool isTime(const std::string& name)
{
    return
        name.size() == nDigits
     && name.find_first_not_of("0123456789") == std::string::npos;
}


//- Bytes by which a file in memory grows
const size_t growth = 1 << 22;

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::fileName Foam::mpm::pointHistory::timePath(const word& group) const
{
    return path_.lessExt()/(group + ".h5");
}


std::vector<Foam::word> Foam::mpm::pointHistory::groups() const
{
    std::vector<word> found;
    for (const fileName& name : readDir(path_.lessExt()))
    {
        const word group(name.lessExt());
        if (isTime(group) && name.ext() == "h5") found.push_back(group);
    }
    std::sort(found.begin(), found.end());
    return found;
}


void Foam::mpm::pointHistory::open(const fileName& path)
{
    current_ = path;
    file_ = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    check(file_ >= 0, "open");
}


void Foam::mpm::pointHistory::create(const fileName& path)
{
    current_ = path;
    const handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
    file_ =
        H5Pset_fapl_core(access, growth, false) < 0 ? -1
      : H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
    check(file_ >= 0, "create");
}


void Foam::mpm::pointHistory::finish()
{
    // The memory is larger than the image of the file
    void* memory = nullptr;
    ssize_t size = -1;
    const bool ok =
        H5Fflush(file_, H5F_SCOPE_GLOBAL) >= 0
     && H5Fget_vfd_handle(file_, H5P_DEFAULT, &memory) >= 0
     && (size = H5Fget_file_image(file_, nullptr, 0)) > 0;
    check(ok, "write to");
    replace(current_, *static_cast<char**>(memory), size);
    close();
}


void Foam::mpm::pointHistory::replace
(
    const fileName& path,
    const char* content,
    const size_t size
)
{
    mkDir(path.path());
    const fileName partial(path + ".partial");

    errno = 0;
    std::ofstream os(partial, std::ios::binary);
    os.write(content, size);
    os.close();
    if (!os || std::rename(partial.c_str(), path.c_str()) != 0)
    {
        const std::string reason(std::strerror(errno));
        std::remove(partial.c_str());
        current_ = path;
        check(false, "write to", reason);
    }
}


void Foam::mpm::pointHistory::close()
{
    if (group_ >= 0) H5Gclose(group_);
    const herr_t error = file_ >= 0 ? H5Fclose(file_) : 0;
    file_ = group_ = -1;
    check(error >= 0, "close");
}


void Foam::mpm::pointHistory::fail(const std::string& message)
{
    // OpenFOAM makes a warning of most errors of a function object and goes on
    // without it; on ranks the others would wait for this one for ever
    if (Pstream::parRun()) FatalIOError.throwExceptions(false);

    FatalIOErrorInFunction(dictionary(current_))
        << message.c_str() << exit(FatalIOError);
}


void Foam::mpm::pointHistory::check
(
    const bool ok,
    const std::string& what,
    std::string reason
)
{
    if (ok) return;

    // What the library knows: the innermost reason
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
    if (group_ >= 0) H5Gclose(group_);
    if (file_ >= 0) H5Fclose(file_);
    file_ = group_ = -1;

    fail
    (
        "cannot " + what + ' ' + current_
      + (reason.empty() ? "" : " (" + reason + ')')
      + ".\n    Is it a file of materialPointHDF5? What was written before is as"
        " it was."
    );
}


void Foam::mpm::pointHistory::takeApart()
{
    current_ = path_ + ".journal";
    if (isFile(current_, false))
    {
        fail
        (
            "an earlier version of mpmFoam ended while it wrote to "
          + path_ + ", and left " + current_.name()
          + ".\n    Complete it with that version, or remove both"
        );
    }

    // The file is opened again for each, as create() has only one
    open(path_);
    std::vector<std::string> names;
    check(members(file_, names), "read");
    close();
    for (const std::string& name : names)
    {
        current_ = path_;
        const handle old
        (
            H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose
        );
        check
        (
            isTime(name),
            "read group " + name + " (allowed: six digits) of"
        );
        create(timePath(name));
        check
        (
            H5Ocopy
            (
                old, name.c_str(), file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT
            ) >= 0,
            "copy group " + name + " of " + path_ + " to"
        );
        finish();
    }
}


Foam::mpm::pointHistory::timeInfo
Foam::mpm::pointHistory::readTime(const word& name)
{
    open(timePath(name));
    group_ = H5Gopen2(file_, name.c_str(), H5P_DEFAULT);

    long step = 0, nPoints = 0;
    timeInfo t;
    t.group = name;
    std::vector<std::string> fields;
    check
    (
        group_ >= 0
     && H5LTget_attribute_double(group_, ".", "time", &t.time) >= 0
     && H5LTget_attribute_long(group_, ".", "step", &step) >= 0
     && H5LTget_attribute_long(group_, ".", "nPoints", &nPoints) >= 0
     && members(group_, fields),
        "read group " + name + " of"
    );
    t.step = step;
    t.nPoints = nPoints;
    for (const std::string& field : fields)
    {
        int nDims = 0;
        hsize_t dims[2] = {0, 1};
        H5T_class_t kind = H5T_NO_CLASS;
        size_t bytes = 0;
        check
        (
            H5LTget_dataset_ndims(group_, field.c_str(), &nDims) >= 0
         && (nDims == 1 || nDims == 2)
         && H5LTget_dataset_info(group_, field.c_str(), dims, &kind, &bytes)
         >= 0,
            "read data set " + name + '/' + field + " of"
        );
        t.fields.push_back
        (
            fieldInfo{field, label(dims[1]), kind == H5T_INTEGER, label(bytes)}
        );
    }
    close();
    return t;
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
    const handle space(H5Screate_simple(nDims, dims, nullptr), H5Sclose);
    const handle creation(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);

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

    const handle set
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


bool Foam::mpm::pointHistory::forgetFrom(const label step, const scalar time)
{
    const auto kept = std::remove_if
    (
        times_.begin(), times_.end(),
        [&](const timeInfo& t) { return t.step >= step || t.time > time; }
    );
    const bool any = kept != times_.end();
    times_.erase(kept, times_.end());
    return any;
}


void Foam::mpm::pointHistory::writeIndices()
{
    writeLinks();
    writeXdmf();

    // Nothing shows them any more
    for (const word& group : groups())
    {
        if (times_.empty() || group > times_.back().group) rm(timePath(group));
    }
}


void Foam::mpm::pointHistory::writeLinks()
{
    create(path_);
    check
    (
        H5LTset_attribute_string(file_, ".", "cloud", cloud_.c_str()) >= 0
     && H5LTset_attribute_long(file_, ".", "format", &format, 1) >= 0,
        "write to"
    );
    for (const timeInfo& t : times_)
    {
        // From the directory of the file of links
        const std::string target(path_.lessExt().name()/(t.group + ".h5"));
        check
        (
            H5Lcreate_external
            (
                target.c_str(), t.group.c_str(), file_, t.group.c_str(),
                H5P_DEFAULT, H5P_DEFAULT
            ) >= 0,
            "write to"
        );
    }
    finish();
}


void Foam::mpm::pointHistory::writeXdmf()
{
    std::ostringstream os;
    os.precision(17);

    const string directory(path_.lessExt().name());
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
            os  << "\">" << directory << '/' << t.group << ".h5:/" << t.group
                << '/' << f.name << "</DataItem>";
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

    const std::string content(os.str());
    replace(indexPath(), content.data(), content.size());
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
    const quiet q;
    bool old = false;
    if (isFile(path_, false))
    {
        long found = 0;
        open(path_);
        check
        (
            H5LTget_attribute_long(file_, ".", "format", &found) >= 0
         && found >= 1 && found <= format,
            "read"
        );
        close();
        old = found == 1;
    }
    if (old) takeApart();
    for (const word& group : groups()) times_.push_back(readTime(group));
    if (old) writeIndices();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::pointHistory::removeFrom
(
    const label step,
    const scalar time
)
{
    const quiet q;
    if (forgetFrom(step, time)) writeIndices();
}


void Foam::mpm::pointHistory::begin
(
    const label step,
    const scalar time,
    const label nPoints
)
{
    const quiet q;
    forgetFrom(step, time);

    const label number = times_.empty() ? 0 : readLabel(times_.back().group) + 1;
    const std::string digits(std::to_string(number));
    check(digits.size() <= nDigits, "add time number " + digits + " to");
    const word group(std::string(nDigits - digits.size(), '0') + digits);

    create(timePath(group));
    group_ =
        H5Gcreate2(file_, group.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);

    const double timeInFile = time;
    const long stepInFile = step, nPointsInFile = nPoints;
    check
    (
        group_ >= 0
     && H5LTset_attribute_double(group_, ".", "time", &timeInFile, 1) >= 0
     && H5LTset_attribute_long(group_, ".", "step", &stepInFile, 1) >= 0
     && H5LTset_attribute_long(group_, ".", "nPoints", &nPointsInFile, 1) >= 0,
        "write to"
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
    finish();
    writeIndices();
}

// ************************************************************************* //
