/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cloudTimeSeries.H"
#include "gravityMeshObject.H"
#include "OSspecific.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::cloudTimeSeries::openFile()
{
    const wordList names(columns());
    if (opened_ && names == columns_) return;

    // Other columns after a change of controlDict go into another file
    const bool first = !opened_;
    opened_ = true;
    columns_ = names;
    if (!writeToFile()) return;

    filePtr_ = beginFile(fileName_, first);

    OFstream& os = file();
    writeHeader(os, type() + " of the cloud " + cloud().name());
    for (const string& line : description()) writeHeader(os, line);
    writeCommented(os, "Time");
    for (const word& column : columns_) writeTabbed(os, column);
    os  << endl;
}


Foam::autoPtr<Foam::OFstream> Foam::mpm::cloudTimeSeries::beginFile
(
    const word& file,
    const bool first
) const
{
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
    if (Pstream::master())
    {
        mvBak(directory/(file + ".dat"));
        if (first) setLaterAside(file, start);
    }
    return createFile(file, start);
}


void Foam::mpm::cloudTimeSeries::setLaterAside
(
    const word& file,
    const scalar start
) const
{
    const fileName root(baseFileDir()/prefix_);
    for (const fileName& name : readDir(root, fileName::DIRECTORY))
    {
        scalar other = 0;
        const fileName path(root/name/(file + ".dat"));
        if (readScalar(name, other) && other > start && isFile(path, false))
        {
            mvBak(path);
            Info<< type() << ' ' << this->name() << ": this run starts before "
                << path << " does; it was renamed to .bak" << nl << endl;
        }
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::cloudTimeSeries::sumToMaster(scalarList& values)
{
    Pstream::listCombineGather(values, plusEqOp<scalar>());
}


Foam::word Foam::mpm::cloudTimeSeries::timeNow() const
{
    // Names of times may be shared by several steps
    return Time::timeName
    (
        useUserTime_ ? mesh_.time().timeOutputValue() : mesh_.time().value(),
        timeDigits
    );
}


Foam::label Foam::mpm::cloudTimeSeries::findVertical
(
    const dictionary& dict,
    bool& upward
) const
{
    const vector g = meshObjects::gravity::New(mesh_.time()).value();
    const lattice& cells = cloud().grid().cells();
    const label vertical = cells.along(g);
    if (mag(g[cells.axis(vertical)]) < VSMALL)
    {
        FatalIOErrorInFunction(dict)
            << "function object " << name() << ": a " << type()
            << " needs gravity to know what is up, but the value in constant/g"
            << " is " << g << exit(FatalIOError);
    }
    upward = g[cells.axis(vertical)] < 0;
    return vertical;
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
    cloudFunctionObject(name, runTime, dict),
    writeFile(mesh_, name, file)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::cloudTimeSeries::start(const dictionary& dict)
{
    read(dict);
    if (started(dict)) write();
}


bool Foam::mpm::cloudTimeSeries::read(const dictionary& dict)
{
    writeFile::read(dict);
    cloudFunctionObject::read(dict);
    openFile();

    return true;
}


bool Foam::mpm::cloudTimeSeries::write()
{
    for (const scalarList& numbers : rows())
    {
        if (writeToFile())
        {
            OFstream& os = file();

            os  << setw(charWidth()) << timeNow();
            for (const scalar number : numbers)
            {
                os  << tab << valueWidth() << number;
            }
            os  << nl;
        }
        if (log)
        {
            Info<< type() << ' ' << name() << ':';
            forAll(columns_, i) Info<< ' ' << columns_[i] << ' ' << numbers[i];
            Info<< nl;
        }
    }
    if (writeToFile()) file().flush();
    if (log) Info<< flush;
    return true;
}

// ************************************************************************* //
