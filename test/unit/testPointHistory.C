/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "pointHistory.H"
#include "OSspecific.H"
#include <hdf5.h>
#include <hdf5_hl.h>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <sys/uio.h>
#include <sys/wait.h>
#include <unistd.h>

using namespace Foam;
using namespace Foam::mpm;

// All that changes a file goes through here, from the libraries, too: the call
// number \c at ends the process half-way, or finds the disk full
namespace
{

enum class trouble { none, kill, diskFull };

trouble kind = trouble::none;
long calls = 0;
long at = -1;

//- Does this call find trouble
bool troubled() { return kind != trouble::none && calls++ == at; }

void die() { ::raise(SIGKILL); }


template<class Call, class Half>
ssize_t troubledWrite(const Call& whole, const Half& half)
{
    if (!troubled()) return whole();
    if (kind == trouble::kill && half() >= 0) die();
    errno = ENOSPC;
    return -1;
}


template<class Function>
Function real(const char* name)
{
    return reinterpret_cast<Function>(::dlsym(RTLD_NEXT, name));
}

} // End anonymous namespace


extern "C"
{

ssize_t write(int fd, const void* data, size_t size)
{
    static const auto f = real<ssize_t (*)(int, const void*, size_t)>("write");
    return troubledWrite
    (
        [&] { return f(fd, data, size); },
        [&] { return f(fd, data, size/2); }
    );
}

ssize_t writev(int fd, const iovec* parts, int n)
{
    static const auto f = real<ssize_t (*)(int, const iovec*, int)>("writev");
    return troubledWrite
    (
        [&] { return f(fd, parts, n); },
        [&] { return f(fd, parts, n/2); }
    );
}

int remove(const char* path) noexcept
{
    static const auto f = real<int (*)(const char*)>("remove");
    if (kind == trouble::kill && troubled()) die();
    return f(path);
}

int rename(const char* from, const char* to) noexcept
{
    static const auto f = real<int (*)(const char*, const char*)>("rename");
    if (kind == trouble::kill && troubled()) die();
    return f(from, to);
}

}


namespace
{

//- A directory of its own
class place
{
    char path_[32] = "/tmp/mpmHistory.XXXXXX";

public:

    place() { REQUIRE(::mkdtemp(path_)); }
    ~place() { rmDir(path_); }

    fileName file() const { return fileName(path_)/"water.h5"; }

    label nFiles() const { return readDir(fileName(path_)/"water").size(); }

    void clear() const
    {
        rm(file());
        rmDir(fileName(path_)/"water", true);
    }
};


scalar valueOf(const label time, const label point, const label component)
{
    return std::sin(1 + 3*time + 0.1*point + component);
}


//- More than a chunk, so that the index of chunks grows, too
const label nPoints = 20000;


void append(pointHistory& history, const label time)
{
    std::vector<int64_t> ids(nPoints);
    std::vector<scalar> x(3*nPoints);
    for (label i = 0; i < nPoints; ++i)
    {
        ids[i] = i;
        for (label c = 0; c < 3; ++c) x[3*i + c] = valueOf(time, i, c);
    }
    history.setCompression(1);
    history.begin(10*time, 0.1*time, nPoints);
    history.add("id", ids);
    history.add("x", 3, x);
    history.end();
}


//- Number of times in the file, with nothing of ours; -1 if it cannot be opened
//  or a value is wrong
label wholeTimes(const fileName& path)
{
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
    if (file < 0) return -1;

    label n = 0;
    for (;; ++n)
    {
        const std::string name("00000" + std::to_string(n) + "/x");
        if (H5Lexists(file, name.substr(0, 6).c_str(), H5P_DEFAULT) <= 0) break;

        std::vector<scalar> x(3*nPoints);
        const hid_t set = H5Dopen2(file, name.c_str(), H5P_DEFAULT);
        bool right =
            set >= 0
         && H5Dread
            (
                set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, x.data()
            ) >= 0;
        if (set >= 0) H5Dclose(set);
        for (label i = 0; right && i < nPoints; ++i)
        {
            for (label c = 0; c < 3; ++c)
            {
                right = right && x[3*i + c] == valueOf(n, i, c);
            }
        }
        if (!right)
        {
            n = -1;
            break;
        }
    }
    H5Fclose(file);
    return n;
}


//- A file of format 1: the groups of the times in it
void writeOld(const fileName& path, const label nTimes)
{
    const hid_t file =
        H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const long format = 1, n = nPoints;
    H5LTset_attribute_long(file, ".", "format", &format, 1);
    for (label t = 0; t < nTimes; ++t)
    {
        const std::string name("00000" + std::to_string(t));
        const hid_t group =
            H5Gcreate2
            (
                file, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT
            );
        const double time = 0.1*t;
        const long step = 10*t;
        H5LTset_attribute_double(group, ".", "time", &time, 1);
        H5LTset_attribute_long(group, ".", "step", &step, 1);
        H5LTset_attribute_long(group, ".", "nPoints", &n, 1);

        std::vector<long> ids(nPoints);
        std::vector<scalar> x(3*nPoints);
        for (label i = 0; i < nPoints; ++i)
        {
            ids[i] = i;
            for (label c = 0; c < 3; ++c) x[3*i + c] = valueOf(t, i, c);
        }
        const hsize_t dims[2] = {hsize_t(nPoints), 3};
        H5LTmake_dataset_long(group, "id", 1, dims, ids.data());
        H5LTmake_dataset_double(group, "x", 2, dims, x.data());
        H5Gclose(group);
    }
    H5Fclose(file);
}


//- Call op in a process that ends at the call number \c call; false if it came
//  to the end without
template<class Op>
bool killedAt(const long call, const Op& op)
{
    const pid_t child = ::fork();
    if (child == 0)
    {
        kind = trouble::kill;
        calls = 0;
        at = call;
        op();
        ::_exit(0);
    }
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    return !WIFEXITED(status);
}

} // End anonymous namespace


TEST_CASE("pointHistory: writes, removes, appends")
{
    const place dir;
    {
        pointHistory history(dir.file(), "water");
        for (label t = 0; t < 4; ++t) append(history, t);
        equal("times", wholeTimes(dir.file()), 4);

        history.removeFrom(30, GREAT);
        equal("after one was removed by its step", wholeTimes(dir.file()), 3);
        history.removeFrom(1000, 0.15);
        equal("after one was removed by its time", wholeTimes(dir.file()), 2);
    }
    pointHistory history(dir.file(), "water");
    equal("times found again", label(history.times().size()), 2);
    equal("step of the last", history.times()[1].step, 10);
    equal("components of x", history.times()[1].fields[1].nComponents, 3);

    append(history, 2);
    append(history, 2);
    equal("times", wholeTimes(dir.file()), 3);
    equal("files of times", dir.nFiles(), 3);

    history.removeFrom(0, 0);
    equal("times after all were removed", wholeTimes(dir.file()), 0);
    equal("files after all times were removed", dir.nFiles(), 0);
}


TEST_CASE("pointHistory: continues a file of format 1")
{
    const place dir;
    writeOld(dir.file(), 3);
    {
        pointHistory history(dir.file(), "water");
        equal("times found", label(history.times().size()), 3);
        equal("step of the last", history.times()[2].step, 20);
        equal("components of x", history.times()[1].fields[1].nComponents, 3);
        append(history, 3);
    }
    equal("times", wholeTimes(dir.file()), 4);
    equal("files of times", dir.nFiles(), 4);

    label kills = 0, lost = 0;
    for (long call = 0; ; ++call, ++kills)
    {
        dir.clear();
        writeOld(dir.file(), 3);
        if
        (
           !killedAt(call, [&] { pointHistory history(dir.file(), "water"); })
        )
        {
            break;
        }
        if (wholeTimes(dir.file()) != 3) ++lost;
        pointHistory history(dir.file(), "water");
        if (wholeTimes(dir.file()) != 3 || history.times().size() != 3) ++lost;
    }
    atLeast("calls at which it was killed", kills, 10);
    equal("files that lost a time", lost, 0);

    // One that an earlier version left half written
    dir.clear();
    writeOld(dir.file(), 3);
    std::fclose(std::fopen((dir.file() + ".journal").c_str(), "w"));
    contains
    (
        errorOf([&] { pointHistory history(dir.file(), "water"); }),
        {"earlier version", "water.h5.journal"}
    );
}


TEST_CASE("pointHistory: a group that is no time of ours")
{
    const place dir;
    writeOld(dir.file(), 1);
    const hid_t file = H5Fopen(dir.file().c_str(), H5F_ACC_RDWR, H5P_DEFAULT);
    REQUIRE
    (
        H5Lcopy
        (
            file, "000000", H5L_SAME_LOC, "copy", H5P_DEFAULT, H5P_DEFAULT
        ) >= 0
    );
    H5Fclose(file);
    contains
    (
        errorOf([&] { pointHistory history(dir.file(), "water"); }),
        {"copy", "six digits", dir.file()}
    );
}


TEST_CASE("pointHistory: killed at any call that changes a file")
{
    const place dir;
    const label kept = 3;

    // A new time behind the others; the last one again; a restart before it
    for (const label next : {kept, kept - 1, kept - 2})
    {
        label kills = 0, lost = 0, wrong = 0;
        for (long call = 0; ; ++call, ++kills)
        {
            dir.clear();
            {
                pointHistory history(dir.file(), "water");
                for (label t = 0; t < kept; ++t) append(history, t);
            }
            const bool killed = killedAt
            (
                call,
                [&]
                {
                    pointHistory history(dir.file(), "water");
                    append(history, next);
                }
            );
            if (!killed) break;

            // As it lies there, with the library alone; then opened again, and
            // the time that may be there written again
            if (wholeTimes(dir.file()) < next) ++lost;
            pointHistory history(dir.file(), "water");
            if (label(history.times().size()) < next) ++lost;
            append(history, next);
            if
            (
                wholeTimes(dir.file()) != next + 1 || dir.nFiles() != next + 1
            )
            {
                ++wrong;
            }
        }
        const string what("time " + std::to_string(next) + " after 3: ");
        // Three files are written and renamed
        atLeast(what + "calls at which it was killed", kills, 6);
        equal(what + "files that lost a time", lost, 0);
        equal(what + "series that were not whole after it", wrong, 0);
    }
}


TEST_CASE("pointHistory: the disk is full at any write")
{
    const place dir;
    label failures = 0, lost = 0, silent = 0;
    std::string message;
    for (long call = 0; ; ++call)
    {
        pointHistory history(dir.file(), "water");
        history.removeFrom(20, GREAT);
        for (label t = history.times().size(); t < 2; ++t) append(history, t);

        kind = trouble::diskFull;
        calls = 0;
        at = call;
        bool failed = false;
        try
        {
            append(history, 2);
        }
        catch (const Foam::error& e)
        {
            failed = true;
            message = e.message();
        }
        kind = trouble::none;
        const bool reached = calls > call;
        if (!reached) break;
        ++failures;
        if (!failed) ++silent;

        pointHistory again(dir.file(), "water");
        if (wholeTimes(dir.file()) < 2) ++lost;
    }
    atLeast("writes that failed", failures, 3);
    equal("failures without an error", silent, 0);
    equal("files that lost a time", lost, 0);
    contains(message, {"water.xdmf", "No space left on device"});
}


TEST_CASE("pointHistory: not a file of its kind")
{
    const place dir;
    {
        std::FILE* file = std::fopen(dir.file().c_str(), "w");
        std::fputs("nothing", file);
        std::fclose(file);
    }
    contains
    (
        errorOf([&] { pointHistory history(dir.file(), "water"); }),
        {"cannot open", "water.h5", "signature"}
    );
}
