/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Library
    libmpmInstructionCounter

Description
    Counts the instructions that a program executes from one time step to
    another, exactly, and ends it:

    \verbatim
        LD_PRELOAD=libmpmInstructionCounter.so \
        MPM_COUNT_FROM=5 MPM_COUNT_TO=7 mpmFoam
    \endverbatim

    prints, to the error stream, the instructions of the steps 6 and 7 of this
    run. It stands before materialPointCloud::relocate, which each cloud calls
    once a step; steps are those of the cloud that calls first.

    The processor's trap flag stops the program after each instruction, a
    signal handler counts: some microseconds each, and any instruction set.
    valgrind, 50 times faster, does not know AVX-512. Instructions of the
    kernel (of the operating system) do not count.

\*---------------------------------------------------------------------------*/

#include "materialPointCloud.H"
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <dlfcn.h>

namespace
{

// Counted by a handler, read when it is off
volatile long nInstructions = 0;

void trap(int)
{
    nInstructions = nInstructions + 1;
}


//- Set or clear the trap flag; 128 bytes below the stack pointer may be in use
#if defined(__x86_64__)
inline void setTrapFlag(const bool on)
{
    if (on)
    {
        asm volatile
        (
            "lea -128(%%rsp), %%rsp\n\t pushfq\n\t orq $0x100, (%%rsp)\n\t"
            "popfq\n\t lea 128(%%rsp), %%rsp" : : : "memory", "cc"
        );
    }
    else
    {
        asm volatile
        (
            "lea -128(%%rsp), %%rsp\n\t pushfq\n\t andq $~0x100, (%%rsp)\n\t"
            "popfq\n\t lea 128(%%rsp), %%rsp" : : : "memory", "cc"
        );
    }
}
#else
    #error "The trap flag is that of x86-64"
#endif


int fromEnvironment(const char* name)
{
    const char* text = std::getenv(name);
    if (!text)
    {
        std::fprintf(stderr, "libmpmInstructionCounter: %s is not set\n", name);
        std::_Exit(2);
    }
    return std::atoi(text);
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

void Foam::mpm::materialPointCloud::relocate(const scalar deltaT)
{
    typedef void (*function)(materialPointCloud*, scalar);
    static const function original = reinterpret_cast<function>
    (
        dlsym(RTLD_NEXT, "_ZN4Foam3mpm18materialPointCloud8relocateEd")
    );
    static const int first = fromEnvironment("MPM_COUNT_FROM");
    static const int last = fromEnvironment("MPM_COUNT_TO");
    static const materialPointCloud* const counted = this;
    static int step = 0;

    if (this != counted)
    {
        original(this, deltaT);
        return;
    }

    original(this, deltaT);
    ++step;
    if (step == first)
    {
        std::signal(SIGTRAP, trap);
        setTrapFlag(true);
    }
    if (step == last)
    {
        setTrapFlag(false);
        std::fprintf(stderr, "instructions %ld\n", nInstructions);
        std::_Exit(0);
    }
}

// ************************************************************************* //
