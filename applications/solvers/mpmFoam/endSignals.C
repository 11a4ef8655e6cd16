/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "endSignals.H"
#include "Pstream.H"
#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <iostream>
#include <poll.h>
#include <streambuf>
#include <unistd.h>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

volatile std::sig_atomic_t caught = 0;

//- Is this process a rank that mpirun (OpenMPI) has started
bool rankOfMpirun = false;


//- A message that waits for a reader goes to nobody if none comes: mpirun does
//  not read any more when it is about to kill its ranks, and one that is asleep
//  in its message would never see the signal. The system repeats the write, to
//  what the file is then. (All calls may be made in a handler.)
void abandonUnread(const int file)
{
    pollfd state = {file, POLLOUT, 0};
    if (::poll(&state, 1, 200) == 0)
    {
        const int nobody = ::open("/dev/null", O_WRONLY);
        if (nobody >= 0) ::dup2(nobody, file);
    }
}


void note(int signal)
{
    const int before = errno;
    caught = signal;

    if (rankOfMpirun && signal == SIGTERM)
    {
        abandonUnread(STDOUT_FILENO);
        abandonUnread(STDERR_FILENO);
    }

    // Who reads the log through a pipe gets Ctrl-C, too
    std::signal(SIGPIPE, SIG_IGN);
    errno = before;
}


//- A log that nobody may read any more: OpenFOAM takes a failed message for an
//  error, and fails again with the message of that
class forgivingBuffer
:
    public std::streambuf
{
    const int file_;

    virtual std::streamsize xsputn(const char* text, std::streamsize n)
    {
        for (std::streamsize done = 0; done < n;)
        {
            const ssize_t part = ::write(file_, text + done, n - done);
            if (part <= 0 && errno != EINTR) break;
            done += std::max(part, ssize_t(0));
        }
        return n;
    }

    virtual int_type overflow(int_type c)
    {
        const char text = traits_type::to_char_type(c);
        xsputn(&text, 1);
        return traits_type::not_eof(c);
    }

public:

    explicit forgivingBuffer(const int file)
    :
        file_(file)
    {}
};


//- Messages from now on may get lost
void forgive()
{
    static bool done = false;
    if (done) return;
    done = true;

    // Never deleted: the streams use them until the very end
    std::cout.flush();
    std::cout.rdbuf(new forgivingBuffer(STDOUT_FILENO));
    std::cerr.rdbuf(new forgivingBuffer(STDERR_FILENO));
    std::cout.clear();
    std::cerr.clear();
}

//- Larger than any signal
const Foam::label launcherGone = 1000;

} // End anonymous namespace


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::endSignals::endSignals()
:
    launcher_(getppid())
{
    rankOfMpirun = std::getenv("OMPI_COMM_WORLD_RANK");
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGUSR1})
    {
        const auto before = std::signal(signal, note);
        if
        (
            before == SIG_IGN
         || (signal == SIGUSR1 && before != SIG_DFL)
        )
        {
            std::signal(signal, before);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::label Foam::mpm::endSignals::own() const
{
    if (Pstream::parRun() && getppid() != launcher_)
    {
        note(caught);
        return launcherGone;
    }
    return caught;
}


Foam::string Foam::mpm::endSignals::reason(const label largest) const
{
    if (largest) forgive();

    switch (largest)
    {
        case 0:
        {
            return string();
        }
        case SIGINT:
        {
            return "SIGINT";
        }
        case SIGTERM:
        {
            return "SIGTERM";
        }
        case SIGHUP:
        {
            return "SIGHUP";
        }
        case SIGUSR1:
        {
            return "SIGUSR1";
        }
        default:
        {
            return "mpirun has ended";
        }
    }
}

// ************************************************************************* //
