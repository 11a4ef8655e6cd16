/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    mpmUnitTests

Description
    Unit tests of the libraries (Catch2). With a name as argument, only that
    test case:

    \verbatim
        mpmUnitTests --list-test-names-only
        mpmUnitTests "stencil: scatter conserves"
    \endverbatim

    Those of several ranks, which a run without name leaves out:

    \verbatim
        mpirun -np 4 mpmUnitTests -parallel "[ranks]"
    \endverbatim

\*---------------------------------------------------------------------------*/

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include "error.H"
#include "UPstream.H"
#include <cstring>

int main(int argc, char* argv[])
{
    Foam::FatalError.throwExceptions();
    Foam::FatalIOError.throwExceptions();

    const bool parallel = argc > 1 && !std::strcmp(argv[1], "-parallel");
    if (parallel)
    {
        Foam::UPstream::init(argc, argv, false);
        --argc;
        for (int i = 1; i < argc; ++i) argv[i] = argv[i + 1];
    }
    const int failed = Catch::Session().run(argc, argv);
    if (parallel) Foam::UPstream::exit(failed);
    return failed;
}

// ************************************************************************* //
