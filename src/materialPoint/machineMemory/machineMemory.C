/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "machineMemory.H"
#include "OSspecific.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"
#include "stringList.H"
#include <fstream>
#include <string>
#include <sys/resource.h>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Of this share of the available memory is said how much is needed
const Foam::scalar muchMemory = 0.1;


//- A number in bytes at the head of a file; GREAT if there is none ("max")
Foam::scalar numberIn(const std::string& file)
{
    std::ifstream is(file);
    double value;
    return is >> value ? value : Foam::GREAT;
}


//- Value of a line "key: number kB" of a file of /proc [bytes]; GREAT if none
Foam::scalar kilobytes(const std::string& file, const std::string& key)
{
    std::ifstream is(file);
    std::string line;
    while (std::getline(is, line))
    {
        if (line.compare(0, key.size(), key) == 0)
        {
            return 1024*std::stod(line.substr(key.size()));
        }
    }
    return Foam::GREAT;
}


std::string gigabytes(const Foam::scalar bytes)
{
    Foam::OStringStream os;
    os.precision(3);
    os << bytes/1e9 << " GB";
    return os.str();
}

} // End anonymous namespace


// * * * * * * * * * * * * * Static Member Functions * * * * * * * * * * * * //

Foam::scalar Foam::mpm::machineMemory::available()
{
    scalar bytes = kilobytes("/proc/meminfo", "MemAvailable:");

    // Control groups, version 2 and 1
    for
    (
        const auto& group :
        {
            std::pair<std::string, std::string>
            (
                "/sys/fs/cgroup/memory.max", "/sys/fs/cgroup/memory.current"
            ),
            std::pair<std::string, std::string>
            (
                "/sys/fs/cgroup/memory/memory.limit_in_bytes",
                "/sys/fs/cgroup/memory/memory.usage_in_bytes"
            )
        }
    )
    {
        const scalar limit = numberIn(group.first);
        const scalar used = numberIn(group.second);
        if (limit < GREAT && used < GREAT)
        {
            bytes = min(bytes, max(scalar(0), limit - used));
        }
    }

    rlimit limit;
    if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY)
    {
        const scalar used = kilobytes("/proc/self/status", "VmSize:");
        bytes = min(bytes, max(scalar(0), scalar(limit.rlim_cur) - used));
    }
    return bytes;
}


Foam::scalar Foam::mpm::machineMemory::availableToAll()
{
    // One rank of each machine counts for it
    stringList host(Pstream::nProcs());
    host[Pstream::myProcNo()] = hostName();
    Pstream::gatherList(host);
    Pstream::scatterList(host);

    const bool first = host.find(host[Pstream::myProcNo()])
     == Pstream::myProcNo();

    return returnReduce(first ? available() : 0, sumOp<scalar>());
}


void Foam::mpm::machineMemory::check
(
    const dictionary& dict,
    const word& cloud,
    const scalar nPoints,
    const scalar bytesPerPoint
)
{
    const scalar needed = nPoints*bytesPerPoint;
    const scalar there = availableToAll();

    if (needed > muchMemory*there)
    {
        Info<< "Cloud " << cloud << ": about " << nPoints << " points need "
            << gigabytes(needed).c_str() << " of the " << gigabytes(there).c_str()
            << " that are free" << endl;
    }
    if (needed > there || nPoints > labelMax)
    {
        FatalIOErrorInFunction(dict)
            << "cloud " << cloud << ": about " << nPoints << " points need "
            << gigabytes(needed).c_str() << " of memory; free on "
            << (Pstream::parRun() ? "the machines of all ranks" : "this machine")
            << " are " << gigabytes(there).c_str() << '.' << nl
            << "    Allowed: as many points as there is memory for (and up to "
            << labelMax << "):" << nl
            << "    a smaller pointsPerDirection, smaller regions, a coarser"
            << " mesh, or ranks on other machines" << exit(FatalIOError);
    }
}

// ************************************************************************* //
