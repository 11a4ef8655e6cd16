/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointForces.H"
#include "bodies.H"
#include "listed.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(materialPointForces, 0);
    addToRunTimeSelectionTable(functionObject, materialPointForces, dictionary);

    static const functionNeeds::add needs
    (
        "materialPointForces", functionNeeds::NO_FIELDS
    );
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

const Foam::mpm::bodies& Foam::mpm::materialPointForces::all() const
{
    return *cloud().bodiesPtr();
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::materialPointForces::keywords() const
{
    return wordList({"bodies"});
}


void Foam::mpm::materialPointForces::readEntries(const dictionary& dict)
{
    if (!cloud().bodiesPtr())
    {
        FatalIOErrorInFunction(dict)
            << "function object " << name() << " asks for forces on bodies, but"
            << " the scene has none." << nl
            << "    Allowed: with bodies { ... } in"
            << " constant/materialPointProperties" << exit(FatalIOError);
    }
    wordList names(all().size());
    forAll(names, b) names[b] = all()[b].name();

    const wordList asked(dict.lookupOrDefault<wordList>("bodies", names));
    DynamicList<label> numbers;
    for (const word& body : asked)
    {
        const label b = names.find(body);
        if (b < 0)
        {
            FatalIOErrorInFunction(dict)
                << "keyword bodies: there is no body " << body << '.' << nl
                << "    Allowed: " << listed(names) << exit(FatalIOError);
        }
        numbers.append(b);
    }
    bodies_ = numbers;
}


Foam::stringList Foam::mpm::materialPointForces::description() const
{
    return stringList
    ({
        "Force [N] of " + cloud().name() + " on bodies in the last step, and"
        " moment [N m] about the centre of each; where it is [m] and its"
        " velocity [m/s] if it moves"
    });
}


Foam::wordList Foam::mpm::materialPointForces::columns() const
{
    DynamicList<word> names;
    for (const label b : bodies_)
    {
        const word& body = all()[b].name();
        for (const char* of : {"Fx", "Fy", "Fz", "Mx", "My", "Mz"})
        {
            names.append(body + '_' + of);
        }
        if (!all()[b].motion().moves()) continue;
        for (const char* of : {"x", "y", "z", "Ux", "Uy", "Uz"})
        {
            names.append(body + '_' + of);
        }
    }
    return wordList(names);
}


Foam::scalarList Foam::mpm::materialPointForces::values() const
{
    DynamicList<scalar> values;
    auto add = [&](const vector& v)
    {
        for (direction d = 0; d < 3; ++d) values.append(v[d]);
    };
    for (const label b : bodies_)
    {
        const nodeConstraint::load load(cloud().loadOn(b));
        add(load.force);
        add(load.moment);
        const bodyMotion& motion = all()[b].motion();
        if (!motion.moves()) continue;
        add(motion.centre());
        add(motion.velocity());
    }
    return scalarList(values);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::materialPointForces::materialPointForces
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudTimeSeries(name, runTime, dict, "forces")
{
    start(dict);
}

// ************************************************************************* //
