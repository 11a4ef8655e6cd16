/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "caseLock.H"
#include "argList.H"
#include "OSspecific.H"
#include <cerrno>
#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::caseLock::caseLock(const argList& args)
:
    directory_(-1)
{
    if (!Pstream::master()) return;

    const fileName path(args.rootPath()/args.globalCaseName());
    directory_ = ::open(path.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
    if (directory_ < 0) return;

    // One that was killed may take a moment to end
    for (int tenths = 0; ::flock(directory_, LOCK_EX | LOCK_NB); ++tenths)
    {
        if (errno != EWOULDBLOCK) return;
        if (tenths == 30)
        {
            FatalErrorInFunction
                << "mpmFoam or setMaterialPoints is already at work in the"
                << " case " << path << '.' << nl
                << "    Allowed: one at a time; wait, end the other, or copy"
                << " the case" << exit(FatalError);
        }
        ::usleep(100000);
    }
}


// * * * * * * * * * * * * * * * * Destructor  * * * * * * * * * * * * * * * //

Foam::mpm::caseLock::~caseLock()
{
    if (directory_ >= 0) ::close(directory_);
}

// ************************************************************************* //
