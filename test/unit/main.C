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

\*---------------------------------------------------------------------------*/

#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>
#include "error.H"

int main(int argc, char* argv[])
{
    Foam::FatalError.throwExceptions();
    Foam::FatalIOError.throwExceptions();

    return Catch::Session().run(argc, argv);
}

// ************************************************************************* //
