/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cloudTimeSeries.H"
#include "dictionaryEntries.H"
#include "FlatOutput.H"
#include "OSspecific.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::cloudTimeSeries::checkEntries(const dictionary& dict) const
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

    const dictionary control(mesh_.solutionDict().subOrEmptyDict("MPM"));
    checkKeywords
    (
        dict,
        known,
        control.lookupOrDefault<Switch>("strictKeywords", true)
    );
}


void Foam::mpm::cloudTimeSeries::checkCloud(const dictionary& dict) const
{
    if (!mesh_.foundObject<materialPointCloud>(cloudName_))
    {
        FatalIOErrorInFunction(dict)
            << "function object " << name() << ", keyword cloud: there is no"
            << " material point cloud " << cloudName_ << '.' << nl
            << "    Clouds of this case: "
            << flatOutput(mesh_.sortedNames<materialPointCloud>())
            << exit(FatalIOError);
    }
}


void Foam::mpm::cloudTimeSeries::openFile()
{
    const wordList names(columns());
    if (names == columns_) return;

    // Other columns after a change of controlDict go into another file
    const bool first = columns_.empty();
    columns_ = names;
    if (!writeToFile()) return;

    // A run that begins again at the same time begins the file again. (OpenFOAM
    // would write another one beside it, and readers find the old one.)
    const scalar start = first ? startTime_ : mesh_.time().value();
    const fileName directory
    (
        baseFileDir()/prefix_/
        Time::timeName
        (
            useUserTime_ ? mesh_.time().timeToUserTime(start) : start
        )
    );
    mvBak(directory/(fileName_ + ".dat"));
    filePtr_ = createFile(fileName_, start);

    OFstream& os = file();
    writeHeader(os, type() + " of the cloud " + cloudName_);
    for (const string& line : description()) writeHeader(os, line);
    writeCommented(os, "Time");
    for (const word& column : columns_) writeTabbed(os, column);
    os  << endl;
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

const Foam::mpm::materialPointCloud& Foam::mpm::cloudTimeSeries::cloud() const
{
    return mesh_.lookupObject<materialPointCloud>(cloudName_);
}


void Foam::mpm::cloudTimeSeries::sumToMaster(scalarList& values)
{
    Pstream::listCombineGather(values, plusEqOp<scalar>());
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::cloudTimeSeries::cloudTimeSeries
(
    const word& name,
    const Time& runTime,
    const dictionary& dict,
    const word& file
)
:
    fvMeshFunctionObject(name, runTime, dict),
    writeFile(mesh_, name, file)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::cloudTimeSeries::start(const dictionary& dict)
{
    read(dict);

    const scalar now = mesh_.time().timeOutputValue();
    if (dict.lookupOrDefault<scalar>("timeStart", now) <= now) write();
}


bool Foam::mpm::cloudTimeSeries::read(const dictionary& dict)
{
    fvMeshFunctionObject::read(dict);
    writeFile::read(dict);

    checkEntries(dict);
    cloudName_ = dict.get<word>("cloud");
    checkCloud(dict);
    log = dict.lookupOrDefault<Switch>("log", false);

    readEntries(dict);
    openFile();

    return true;
}


bool Foam::mpm::cloudTimeSeries::write()
{
    const scalarList numbers(values());

    if (writeToFile())
    {
        OFstream& os = file();
        writeCurrentTime(os);
        for (const scalar number : numbers)
        {
            os  << tab << valueWidth() << number;
        }
        os  << endl;
    }

    if (log)
    {
        Info<< type() << ' ' << name() << ':';
        forAll(columns_, i) Info<< ' ' << columns_[i] << ' ' << numbers[i];
        Info<< endl;
    }
    return true;
}

// ************************************************************************* //
