/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cloudFunctionObject.H"
#include "dictionaryEntries.H"
#include "listed.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::cloudFunctionObject::checkEntries(const dictionary& dict) const
{
    // Of Foam::functionObject and its time control, v1912 to v2506
    wordList known
    ({
        "type", "libs", "functionObjectLibs", "region", "enabled", "errors",
        "log", "timeStart", "timeEnd", "triggerStart", "triggerEnd",
        "controlMode", "deltaTCoeff", "nStepsToStartTimeChange",
        "executeControl", "executeInterval", "writeControl", "writeInterval",
        "outputControl", "outputInterval", "writePrecision", "writeToFile",
        "useUserTime", "useNamePrefix", "updateHeader",
        "cloud"
    });
    known.append(keywords());

    checkKeywords(dict, known, strictKeywords());
}


void Foam::mpm::cloudFunctionObject::checkCloud(const dictionary& dict) const
{
    if (!mesh_.foundObject<materialPointCloud>(cloudName_))
    {
        FatalIOErrorInFunction(dict)
            << "function object " << name() << ", keyword cloud: there is no"
            << " material point cloud " << cloudName_ << '.' << nl
            << "    Clouds of this case: "
            << listed(mesh_.sortedNames<materialPointCloud>())
            << exit(FatalIOError);
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

bool Foam::mpm::cloudFunctionObject::strictKeywords() const
{
    const dictionary control(subDictOrEmpty(mesh_.solutionDict(), "MPM"));
    return control.lookupOrDefault<Switch>("strictKeywords", true);
}


const Foam::mpm::materialPointCloud&
Foam::mpm::cloudFunctionObject::cloud() const
{
    return mesh_.lookupObject<materialPointCloud>(cloudName_);
}


bool Foam::mpm::cloudFunctionObject::started(const dictionary& dict) const
{
    const scalar now = mesh_.time().timeOutputValue();
    return dict.lookupOrDefault<scalar>("timeStart", now) <= now;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::cloudFunctionObject::read(const dictionary& dict)
{
    fvMeshFunctionObject::read(dict);

    checkEntries(dict);
    cloudName_ = dict.get<word>("cloud");
    checkCloud(dict);
    log = dict.lookupOrDefault<Switch>("log", false);
    readEntries(dict);

    return true;
}

// ************************************************************************* //
