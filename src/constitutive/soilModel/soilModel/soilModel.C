/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "listed.H"
#include "soilModel.H"
#include "dictionaryEntries.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(soilModel, 0);
    defineRunTimeSelectionTable(soilModel, dictionary);
}
}

// Above this void ratio the stiffness (2.97 - e)^2 grows again
static const Foam::scalar maxVoidRatio = 2.97;

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::soilModel::soilModel(const dictionary& coeffs)
:
    coeffs_(coeffs),
    rhoS_(readPositive(coeffs, "rhoS", dimDensity)),
    d_(readPositive(coeffs, "d", dimLength)),
    e0_(readBounded(coeffs, "e0", dimless, 0, maxVoidRatio))
{
    warnUnusual
    (
        coeffs,
        {
            {"rhoS", 2000, 5300, "minerals, in kg/m3 of solid"},
            {"d", 2e-6, 0.063, "silt to gravel, in m"},
            {"e0", 0.2, 1.5, "packings of grains"}
        }
    );
}


Foam::autoPtr<Foam::mpm::soilModel> Foam::mpm::soilModel::New
(
    const dictionary& cloudDict,
    const bool strictKeywords
)
{
    const word name(cloudDict.get<word>("constitutiveModel"));
    auto found = dictionaryConstructorTablePtr_->cfind(name);

    if (!found.found())
    {
        FatalIOErrorInFunction(cloudDict)
            << "keyword constitutiveModel: unknown soil model " << name << nl
            << "    Valid names: "
            << listed(dictionaryConstructorTablePtr_->sortedToc())
            << exit(FatalIOError);
    }
    autoPtr<soilModel> model
    (
        found()(subDictOf(cloudDict, name + "Coeffs"), strictKeywords)
    );
    const wordList fields(model->stateFields());
    if (fields.size() > soilPoints::maxStateFields)
    {
        FatalIOErrorInFunction(cloudDict)
            << "keyword constitutiveModel: the soil model " << name << " has "
            << fields.size() << " fields, " << listed(fields) << '.' << nl
            << "    Allowed: up to " << soilPoints::maxStateFields
            << exit(FatalIOError);
    }
    return model;
}

// ************************************************************************* //
