/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "weaklyCompressibleNewtonian.H"
#include "dictionaryEntries.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::weaklyCompressibleNewtonian::weaklyCompressibleNewtonian
(
    const dictionary& cloudDict,
    const bool strictKeywords
)
:
    autoSoundSpeed_(true),
    soundSpeed_(0),
    bulk_(0)
{
    readChoice(cloudDict, "constitutiveModel", {typeName});

    const dictionary& dict = 
        subDictOf(cloudDict, word(typeName) + "Coeffs");
    checkKeywords(dict, {"rho0", "mu", "soundSpeed", "gamma"}, strictKeywords);

    rho0_ = readPositive(dict, "rho0", dimDensity);
    mu_ = readBounded(dict, "mu", dimDynamicViscosity, 0, GREAT, true);
    gamma_ = readBoundedOrDefault(dict, "gamma", dimless, 7, 1, 100);

    warnUnusual
    (
        dict,
        {
            {"rho0", 600, 3200, "liquids, in kg/m3"},
            {"gamma", 1, 10, "liquids (water: 7)"}
        }
    );
    if (mu_ > 0)
    {
        warnUnusual(dict, {{"mu", 1e-4, 100, "liquids, in Pa s"}});
    }

    if (dict.found("soundSpeed"))
    {
        ITstream& is = dict.lookup("soundSpeed");
        if (is.size() == 1 && is[0].isWord())
        {
            readChoice(dict, "soundSpeed", {"auto"});
        }
        else
        {
            autoSoundSpeed_ = false;
            setSoundSpeed(readPositive(dict, "soundSpeed", dimVelocity));
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::weaklyCompressibleNewtonian::setSoundSpeed(const scalar cs)
{
    soundSpeed_ = cs;
    bulk_ = cs*cs*rho0_/gamma_;
}

// ************************************************************************* //
