/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "momentumStep.H"
#include "listed.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(momentumStep, 0);
    defineRunTimeSelectionTable(momentumStep, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::momentumStep::momentumStep(const scene& s)
:
    scene_(s)
{}


// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::momentumStep> Foam::mpm::momentumStep::New
(
    const dictionary& control,
    const scene& s
)
{
    const word name(control.lookupOrDefault<word>("momentum", "explicit"));

    auto found = dictionaryConstructorTablePtr_->cfind(name);
    if (!found.found())
    {
        FatalIOErrorInFunction(control)
            << "keyword momentum: unknown momentum step " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    return found()(control, s);
}

// ************************************************************************* //
