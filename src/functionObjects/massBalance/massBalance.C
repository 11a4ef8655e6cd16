/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "massBalance.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(massBalance, 0);
    addToRunTimeSelectionTable(functionObject, massBalance, dictionary);

    static const functionNeeds::add needsOfMassBalance
    (
        "massBalance", functionNeeds::NO_FIELDS
    );
}
}

// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::massBalance::readEntries(const dictionary& dict)
{
    // Counts of points would lose digits
    if (!dict.found("writePrecision")) writePrecision_ = 15;
}


Foam::stringList Foam::mpm::massBalance::description() const
{
    return stringList({"Numbers of points and masses [kg]"});
}


Foam::wordList Foam::mpm::massBalance::columns() const
{
    const inflowOutflow* boundaries = cloud().openBoundaries();
    if (!boundaries)
    {
        return wordList({"inside", "insideMass", "left", "leftMass"});
    }

    DynamicList<word> names;
    auto add = [&](const word& name)
    {
        names.append(name);
        names.append(name + "Mass");
    };
    add("inside");
    add("waiting");
    names.append("allocated");
    add("entered");
    add("left");
    add("elsewhere");
    add("imbalance");
    for (const inlet& in : boundaries->inlets()) add(in.name() + "Entered");
    for (const outlet& out : boundaries->outlets()) add(out.name() + "Left");
    return wordList(names);
}


Foam::scalarList Foam::mpm::massBalance::values() const
{
    DynamicList<scalar> numbers;
    auto add = [&](const massAccount& account)
    {
        numbers.append(scalar(account.n));
        numbers.append(account.mass.value());
    };

    const inflowOutflow* boundaries = cloud().openBoundaries();
    if (!boundaries)
    {
        add(cloud().inside().global());
        add(cloud().counts().left.global());
        return scalarList(numbers);
    }

    const inflowOutflow::balance b(cloud().accounts());
    add(b.inside);
    add(b.waiting);
    numbers.append(scalar(b.allocated));
    add(b.entered);
    add(b.left);
    add(b.elsewhere);
    numbers.append(scalar(b.imbalance()));
    numbers.append(b.massImbalance());
    for (const inlet& in : boundaries->inlets()) add(in.entered().global());
    for (const outlet& out : boundaries->outlets()) add(out.left().global());
    return scalarList(numbers);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::massBalance::massBalance
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudTimeSeries(name, runTime, dict, "massBalance")
{
    start(dict);
}

// ************************************************************************* //
