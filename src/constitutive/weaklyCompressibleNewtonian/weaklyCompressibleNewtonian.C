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

    const dictionary& dict = cloudDict.subDict(word(typeName) + "Coeffs");
    checkKeywords(dict, {"rho0", "mu", "soundSpeed", "gamma"}, strictKeywords);

    rho0_ = readPositive(dict, "rho0", dimDensity);
    mu_ = readBounded(dict, "mu", dimDynamicViscosity, 0, GREAT, true);
    gamma_ = readBoundedOrDefault(dict, "gamma", dimless, 7, 1, 100);

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
