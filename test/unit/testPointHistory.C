/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "pointHistory.H"
#include "OSspecific.H"
#include <hdf5.h>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
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


ssize_t troubledWrite(int fd, const void* data, size_t size, off_t place)
{
    static const auto real = reinterpret_cast<decltype(&::pwrite)>
    (
        ::dlsym(RTLD_NEXT, "pwrite")
    );
    if (troubled())
    {
        if (kind == trouble::kill)
        {
            if (real(fd, data, size/2, place) >= 0) die();
        }
        errno = ENOSPC;
        return -1;
    }
    return real(fd, data, size, place);
}

} // End anonymous namespace


extern "C"
{

ssize_t pwrite(int fd, const void* data, size_t size, off_t place)
{
    return troubledWrite(fd, data, size, place);
}

ssize_t pwrite64(int fd, const void* data, size_t size, off_t place)
{
    return troubledWrite(fd, data, size, place);
}

int ftruncate(int fd, off_t size) noexcept
{
    static const auto real = reinterpret_cast<int (*)(int, off_t)>
    (
        ::dlsym(RTLD_NEXT, "ftruncate")
    );
    if (kind == trouble::kill && troubled()) die();
    return real(fd, size);
}

int unlink(const char* path) noexcept
{
    static const auto real = reinterpret_cast<int (*)(const char*)>
    (
        ::dlsym(RTLD_NEXT, "unlink")
    );
    if (kind == trouble::kill && troubled()) die();
    return real(path);
}

int rename(const char* from, const char* to) noexcept
{
    static const auto real = reinterpret_cast<int (*)(const char*, const char*)>
    (
        ::dlsym(RTLD_NEXT, "rename")
    );
    if (kind == trouble::kill && troubled()) die();
    return real(from, to);
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
    fileName journal() const { return file() + ".journal"; }
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

    const off_t before = fileSize(dir.file());
    append(history, 2);
    const off_t written = fileSize(dir.file());
    history.removeFrom(20, GREAT);
    append(history, 2);
    equal("times", wholeTimes(dir.file()), 3);
    atMost
    (
        "growth of the file by writing the last time again, over one time",
        scalar(fileSize(dir.file()) - written)/(written - before),
        0.05
    );

    history.removeFrom(0, 0);
    equal("files after all times were removed", label(isFile(dir.file())), 0);
}


TEST_CASE("pointHistory: a group that is no time of ours")
{
    const place dir;
    {
        pointHistory history(dir.file(), "water");
        append(history, 0);
    }
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
        errorOf
        (
            [&]
            {
                pointHistory history(dir.file(), "water");
                append(history, 1);
            }
        ),
        {"copy", "six digits", dir.file()}
    );
}


TEST_CASE("pointHistory: killed at any call that changes a file")
{
    const place dir;
    const label kept = 3;

    label kills = 0, journals = 0, unreadable = 0, lost = 0, wrong = 0;
    for (long call = 0; ; ++call)
    {
        // Each time with a file that was made whole before
        rm(dir.file());
        rm(dir.journal());
        {
            pointHistory history(dir.file(), "water");
            for (label t = 0; t < kept; ++t) append(history, t);
        }
        const pid_t child = ::fork();
        if (child == 0)
        {
            kind = trouble::kill;
            calls = 0;
            at = call;
            pointHistory history(dir.file(), "water");
            append(history, kept);
            ::_exit(0);
        }
        int status = 0;
        REQUIRE(::waitpid(child, &status, 0) == child);
        if (WIFEXITED(status)) break;
        ++kills;

        // As it lies there, with the library alone
        if (isFile(dir.journal())) ++journals;
        else if (wholeTimes(dir.file()) < kept) ++unreadable;

        // Opened again, and the time that may be there written again
        pointHistory history(dir.file(), "water");
        const label found = wholeTimes(dir.file());
        if (found < kept || found != label(history.times().size())) ++lost;
        history.removeFrom(10*kept, GREAT);
        append(history, kept);
        if (wholeTimes(dir.file()) != kept + 1) ++wrong;
    }
    atLeast("calls at which it was killed", kills, 10);
    atLeast("kills that left a journal", journals, 2);
    equal("files without a journal that lost a time", unreadable, 0);
    equal("files that lost a time", lost, 0);
    equal("files that were not whole after the next write", wrong, 0);
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

        // At worst the pages of the journal are not in the file yet
        pointHistory again(dir.file(), "water");
        if (wholeTimes(dir.file()) < 2) ++lost;
    }
    atLeast("writes that failed", failures, 5);
    equal("failures without an error", silent, 0);
    equal("files that lost a time", lost, 0);
    contains(message, {"water.h5", "No space left on device"});
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
