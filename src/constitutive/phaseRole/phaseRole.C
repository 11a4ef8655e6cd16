/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "phaseRole.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "soilModel.H"
#include "weaklyCompressibleNewtonian.H"


Foam::mpm::phaseRole Foam::mpm::roleOf(const dictionary& cloudDict)
{
    if (!cloudDict.found("constitutiveModel"))
    {
        // The misspelt keyword is named, if there is one
        checkNearMisses(cloudDict, {"constitutiveModel"}, {}, true);
    }
    const word model(cloudDict.get<word>("constitutiveModel"));
    const wordList liquids({weaklyCompressibleNewtonian::typeName});
    const wordList solids
    (
        soilModel::dictionaryConstructorTablePtr_->sortedToc()
    );
    const bool liquid = liquids.found(model);
    if (!liquid && !solids.found(model))
    {
        FatalIOErrorInFunction(cloudDict)
            << "keyword constitutiveModel: unknown model " << model << nl
            << "    Valid names: " << listed(liquids) << " of liquids, "
            << listed(solids) << " of solids" << exit(FatalIOError);
    }

    const word ofModel(liquid ? "liquid" : "solid");
    const word role
    (
        readChoiceOrDefault(cloudDict, "role", ofModel, {"liquid", "solid"})
    );
    if (role != ofModel)
    {
        FatalIOErrorInFunction(cloudDict)
            << "keyword role is " << role << ", but the constitutiveModel "
            << model << " is of a " << ofModel << '.' << nl
            << "    Allowed: role " << ofModel << ", or one of "
            << listed(liquid ? solids : liquids) << exit(FatalIOError);
    }
    return liquid ? phaseRole::liquid : phaseRole::solid;
}

// ************************************************************************* //
