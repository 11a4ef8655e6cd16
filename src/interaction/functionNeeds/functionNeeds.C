/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "functionNeeds.H"
#include "dictionaryEntries.H"
#include "functionObject.H"

namespace Foam
{
namespace mpm
{
    // Of OpenFOAM: those that work on points or files, and those that look at
    // fields only when they write
    static const functionNeeds::add ofOpenFOAM[] =
    {
        {"vtkCloud", functionNeeds::NO_FIELDS},
        {"dataCloud", functionNeeds::NO_FIELDS},
        {"cloudInfo", functionNeeds::NO_FIELDS},
        {"timeActivatedFileUpdate", functionNeeds::NO_FIELDS},
        {"runTimeControl", functionNeeds::NO_FIELDS},
        {"abort", functionNeeds::NO_FIELDS},
        {"probes", functionNeeds::WRITE_TIMES},
        {"patchProbes", functionNeeds::WRITE_TIMES},
        {"sets", functionNeeds::WRITE_TIMES},
        {"surfaces", functionNeeds::WRITE_TIMES}
    };
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::HashTable<Foam::mpm::functionNeeds>& Foam::mpm::functionNeeds::table()
{
    // Made when the first one is added, before all static objects are
    static HashTable<functionNeeds> types;
    return types;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::functionNeeds::add::add
(
    const word& type,
    const fieldTimes fields,
    const bool energyBalance
)
{
    table().set(type, functionNeeds{fields, energyBalance});
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::functionNeeds::forAllFunctions
(
    const Time& time,
    const std::function<void(const dictionary&, const functionNeeds&)>& op
)
{
    const functionNeeds ofUnknown{ANY_TIME, false};

    for (const entry& e : subDictOrEmpty(time.controlDict(), "functions"))
    {
        if (!e.isDict()) continue;

        // As the function object itself will
        const_cast<Time&>(time).libs().open
        (
            e.dict(), "libs", functionObject::dictionaryConstructorTablePtr_
        );
        const word type(e.dict().lookupOrDefault<word>("type", word::null));
        op(e.dict(), table().lookup(type, ofUnknown));
    }
}

// ************************************************************************* //
