/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "atomicHDF5Driver.H"
#if H5_VERSION_GE(1, 13, 2)
    #include <H5FDdevelop.h>
#endif
#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <map>
#include <vector>
#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

const haddr_t pageSize = 4096;

const char journalMark[8] = {'m', 'p', 'm', 'J', 'r', 'n', 'l', '1'};


//- An open file; the library sees its first part
struct openFile
{
    H5FD_t base{};

    std::string path;
    int fd = -1;
    bool writable = false;

    //- Ends of the space in use and of the file, as the library sees them
    haddr_t eoa = 0;
    haddr_t eof = 0;

    //- What lies before it must stay as it is
    haddr_t kept = 0;

    //- New content of the kept part, by its first byte
    std::map<haddr_t, std::vector<char>> pages;

    bool changed = false;

    //- Why it cannot be written; empty if it can
    std::string failure;
};

//- Of the file that was closed last
std::string lastFailure;

openFile& of(H5FD_t* file) { return *reinterpret_cast<openFile*>(file); }

const openFile& of(const H5FD_t* file)
{
    return *reinterpret_cast<const openFile*>(file);
}


bool writeAll(const int fd, const char* data, size_t size, haddr_t at)
{
    while (size)
    {
        const ssize_t n = ::pwrite(fd, data, size, at);
        if (n <= 0) return false;
        data += n;
        size -= n;
        at += n;
    }
    return true;
}


//- Behind the end of the file there are zeros
bool readAll(const int fd, char* data, size_t size, haddr_t at)
{
    while (size)
    {
        const ssize_t n = ::pread(fd, data, size, at);
        if (n < 0) return false;
        if (n == 0)
        {
            std::memset(data, 0, size);
            return true;
        }
        data += n;
        size -= n;
        at += n;
    }
    return true;
}


std::string journalOf(const std::string& path) { return path + ".journal"; }


void append(std::vector<char>& bytes, const void* data, const size_t size)
{
    const char* c = static_cast<const char*>(data);
    bytes.insert(bytes.end(), c, c + size);
}


void append(std::vector<char>& bytes, const uint64_t number)
{
    append(bytes, &number, sizeof number);
}


//- Journal: mark, size of the whole file, then place, length and content of
//  each page
bool writeJournal(const openFile& f)
{
    std::vector<char> bytes;
    append(bytes, journalMark, sizeof journalMark);
    append(bytes, uint64_t(f.eof));
    for (const auto& page : f.pages)
    {
        append(bytes, uint64_t(page.first));
        append(bytes, uint64_t(page.second.size()));
        append(bytes, page.second.data(), page.second.size());
    }

    const std::string partial = journalOf(f.path) + ".partial";
    const int fd =
        ::open(partial.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
    if (fd < 0) return false;

    const bool ok = writeAll(fd, bytes.data(), bytes.size(), 0);
    if (::close(fd) != 0 || !ok)
    {
        ::unlink(partial.c_str());
        return false;
    }
    return ::rename(partial.c_str(), journalOf(f.path).c_str()) == 0;
}


//- The new pages are in the journal: into the file with them
bool commit(const openFile& f)
{
    for (const auto& page : f.pages)
    {
        if (!writeAll(f.fd, page.second.data(), page.second.size(), page.first))
        {
            return false;
        }
    }
    return ::ftruncate(f.fd, f.eof) == 0
        && ::unlink(journalOf(f.path).c_str()) == 0;
}


// What the library calls

H5FD_t* openPath
(
    const char* path,
    const unsigned flags,
    const hid_t,
    const haddr_t
)
{
    openFile* f = new openFile;
    f->path = path;
    f->writable = flags & H5F_ACC_RDWR;

    int how = (f->writable ? O_RDWR : O_RDONLY) | O_CLOEXEC;
    if (flags & H5F_ACC_CREAT) how |= O_CREAT;
    if (flags & H5F_ACC_TRUNC) how |= O_TRUNC;
    if (flags & H5F_ACC_EXCL) how |= O_EXCL;

    struct stat status;
    f->fd = ::open(path, how, 0666);
    if (f->fd < 0 || ::fstat(f->fd, &status) != 0)
    {
        if (f->fd >= 0) ::close(f->fd);
        delete f;
        return nullptr;
    }
    f->kept = f->eof = status.st_size;
    return &f->base;
}


herr_t closeFile(H5FD_t* file)
{
    openFile& f = of(file);
    if (f.failure.empty() && f.changed && !(writeJournal(f) && commit(f)))
    {
        f.failure = std::strerror(errno);
    }
    if (::close(f.fd) != 0 && f.failure.empty())
    {
        f.failure = std::strerror(errno);
    }
    lastFailure = f.failure;
    delete &f;

    // The library cannot bear a file that does not close
    return 0;
}


int compare(const H5FD_t* a, const H5FD_t* b)
{
    return of(a).path.compare(of(b).path);
}


herr_t query(const H5FD_t*, unsigned long* flags)
{
    // As the library's own driver, whose files these are
    if (flags)
    {
        *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA
          | H5FD_FEAT_DATA_SIEVE | H5FD_FEAT_AGGREGATE_SMALLDATA
          | H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    }
    return 0;
}


haddr_t eoa(const H5FD_t* file, H5FD_mem_t) { return of(file).eoa; }


herr_t setEoa(H5FD_t* file, H5FD_mem_t, const haddr_t address)
{
    of(file).eoa = address;
    return 0;
}


haddr_t eof(const H5FD_t* file, H5FD_mem_t) { return of(file).eof; }


herr_t handle(H5FD_t* file, hid_t, void** result)
{
    *result = file;
    return 0;
}


herr_t read
(
    H5FD_t* file,
    H5FD_mem_t,
    hid_t,
    const haddr_t address,
    const size_t size,
    void* buffer
)
{
    const openFile& f = of(file);
    char* data = static_cast<char*>(buffer);
    if (!readAll(f.fd, data, size, address)) return -1;

    auto page = f.pages.lower_bound(address - address % pageSize);
    for (; page != f.pages.end() && page->first < address + size; ++page)
    {
        const haddr_t begin = std::max(address, page->first);
        const haddr_t end = std::min<haddr_t>
        (
            address + size, page->first + page->second.size()
        );
        if (begin < end)
        {
            std::memcpy
            (
                data + (begin - address),
                page->second.data() + (begin - page->first),
                end - begin
            );
        }
    }
    return 0;
}


herr_t write
(
    H5FD_t* file,
    const H5FD_mem_t type,
    const hid_t dxpl,
    haddr_t address,
    size_t size,
    const void* buffer
)
{
    openFile& f = of(file);
    const char* data = static_cast<const char*>(buffer);
    f.changed = true;

    while (size && address < f.kept)
    {
        const haddr_t first = address - address % pageSize;
        std::vector<char>& page = f.pages[first];
        const size_t whole = std::min(pageSize, f.kept - first);
        if (page.size() < whole)
        {
            // New, or cut off at the end of what was kept before a failure
            const std::vector<char> known(page);
            page.resize(whole);
            if (!readAll(f.fd, page.data(), whole, first))
            {
                f.failure = std::strerror(errno);
            }
            std::copy(known.begin(), known.end(), page.begin());
        }
        const size_t n = std::min<size_t>(size, first + page.size() - address);
        std::memcpy(page.data() + (address - first), data, n);
        data += n;
        size -= n;
        address += n;
        f.eof = std::max(f.eof, address);
    }
    if (size && !writeAll(f.fd, data, size, address))
    {
        // From here on all goes to memory, and is forgotten when the file is
        // closed: the library does not recover from a write that fails
        f.failure = std::strerror(errno);
        f.kept = HADDR_MAX;
        return write(file, type, dxpl, address, size, data);
    }
    f.eof = std::max(f.eof, address + size);
    return 0;
}


herr_t truncate(H5FD_t* file, hid_t, hbool_t)
{
    // The file itself gets its size when it is closed
    openFile& f = of(file);
    if (f.writable && f.eof != f.eoa)
    {
        f.eof = f.eoa;
        f.changed = true;
    }
    return 0;
}


//- The driver's identity in the library
hid_t driver()
{
    static H5FD_class_t c{};
    static hid_t id = -1;

    // The library forgets it when it is closed
    if (id >= 0 && H5Iis_valid(id) > 0) return id;

    #if H5_VERSION_GE(1, 13, 2)
    c.version = H5FD_CLASS_VERSION;
    // Of the range for drivers without a registered number
    c.value = static_cast<H5FD_class_value_t>(511);
    #endif
    c.name = "mpmAtomic";
    c.maxaddr = (haddr_t(1) << 62) - 1;
    c.fc_degree = H5F_CLOSE_STRONG;
    c.open = openPath;
    c.close = closeFile;
    c.cmp = compare;
    c.query = query;
    c.get_eoa = eoa;
    c.set_eoa = setEoa;
    c.get_eof = eof;
    c.get_handle = handle;
    c.read = read;
    c.write = write;
    c.truncate = truncate;
    const H5FD_mem_t map[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
    std::copy_n(map, int(H5FD_MEM_NTYPES), c.fl_map);

    id = H5FDregister(&c);
    return id;
}


openFile* fileOf(const hid_t file)
{
    void* result = nullptr;
    return
        H5Fget_vfd_handle(file, H5P_DEFAULT, &result) >= 0
      ? static_cast<openFile*>(result)
      : nullptr;
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::atomicHDF5Driver::set(const hid_t accessProperties)
{
    H5Pset_driver(accessProperties, driver(), nullptr);
}


bool Foam::mpm::atomicHDF5Driver::protect(const hid_t file)
{
    openFile* f = fileOf(file);
    if (!f) return false;

    // Behind it lies the tail of a write that never ended
    f->kept = std::min(f->kept, f->eoa);
    return true;
}


void Foam::mpm::atomicHDF5Driver::abandon(const hid_t file)
{
    if (openFile* f = fileOf(file)) f->failure = "abandoned";
}


std::string Foam::mpm::atomicHDF5Driver::failure() { return lastFailure; }


bool Foam::mpm::atomicHDF5Driver::recover(const std::string& path)
{
    const std::string journal = journalOf(path);
    ::unlink((journal + ".partial").c_str());

    openFile f;
    f.path = path;
    const int fd = ::open(journal.c_str(), O_RDONLY | O_CLOEXEC);
    if (fd < 0) return errno == ENOENT;

    struct stat status;
    bool ok = ::fstat(fd, &status) == 0;
    std::vector<char> bytes(ok ? status.st_size : 0);
    ok = ok && readAll(fd, bytes.data(), bytes.size(), 0);
    ::close(fd);

    size_t at = 0;
    auto take = [&](void* to, const size_t size)
    {
        ok = ok && size <= bytes.size() - at;
        if (!ok) return;
        std::memcpy(to, bytes.data() + at, size);
        at += size;
    };

    char mark[sizeof journalMark] = {};
    uint64_t end = 0;
    take(mark, sizeof mark);
    take(&end, sizeof end);
    ok = ok && std::equal(mark, mark + sizeof mark, journalMark);
    f.eof = end;
    while (ok && at < bytes.size())
    {
        uint64_t place = 0, length = 0;
        take(&place, sizeof place);
        take(&length, sizeof length);
        ok = ok && length <= pageSize;
        if (!ok) break;
        std::vector<char>& page = f.pages[place];
        page.resize(length);
        take(page.data(), length);
    }

    f.fd = ok ? ::open(path.c_str(), O_RDWR | O_CLOEXEC) : -1;
    if (f.fd < 0) return false;
    ok = commit(f);
    return ::close(f.fd) == 0 && ok;
}

// ************************************************************************* //
