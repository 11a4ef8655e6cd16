/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "endSignals.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"
#include <csignal>
#include <unistd.h>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

volatile std::sig_atomic_t caught = 0;

//- Nobody may read the log any more, and that must not end the run: who reads
//  it through a pipe gets Ctrl-C, too
void ignorePipe()
{
    std::signal(SIGPIPE, SIG_IGN);
}

void note(int signal)
{
    caught = signal;
    ignorePipe();
}

//- Larger than any signal
const Foam::label launcherGone = 1000;

} // End anonymous namespace


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::endSignals::endSignals()
:
    launcher_(getppid())
{
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

Foam::string Foam::mpm::endSignals::received() const
{
    label what = caught;
    if (Pstream::parRun() && getppid() != launcher_)
    {
        ignorePipe();
        what = launcherGone;
    }

    switch (returnReduce(what, maxOp<label>()))
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
