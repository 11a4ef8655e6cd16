/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointSystem.H"
#include "argList.H"
#include "IFstream.H"
#include "OSspecific.H"
#include "PstreamReduceOps.H"

const Foam::word Foam::mpm::materialPointSystem::stateName("materialPoints");

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Does the state file of a time directory end as it should
bool complete(const Foam::fileName& state)
{
    Foam::IFstream file(state);
    std::string line;
    while (file.good())
    {
        file.getLine(line);
        if (line.compare(0, 8, "complete") == 0) return true;
    }
    return false;
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::materialPointSystem::setIncompleteTimesAside
(
    const argList& args
)
{
    const fileName casePath(args.path());
    const instantList times(TimePaths::findTimes(casePath));

    // Whole on every rank, or not at all
    wordHashSet whole, found;
    for (const instant& t : times)
    {
        if (t.name() == "constant") continue;
        found.insert(t.name());
        if (complete(casePath/t.name()/"uniform"/stateName))
        {
            whole.insert(t.name());
        }
    }
    if (Pstream::parRun())
    {
        List<wordList> allWhole(Pstream::nProcs()), allFound(Pstream::nProcs());
        allWhole[Pstream::myProcNo()] = whole.sortedToc();
        allFound[Pstream::myProcNo()] = found.sortedToc();
        Pstream::gatherList(allWhole);
        Pstream::scatterList(allWhole);
        Pstream::gatherList(allFound);
        Pstream::scatterList(allFound);
        for (label rank = 0; rank < Pstream::nProcs(); ++rank)
        {
            whole &= wordHashSet(allWhole[rank]);
            found |= wordHashSet(allFound[rank]);
        }
    }

    // Only what is later than the last whole time can have been cut off
    scalar last = -GREAT;
    for (const word& name : whole)
    {
        last = max(last, readScalar(name));
    }
    if (whole.empty()) return;

    for (const word& name : found.sortedToc())
    {
        if (readScalar(name) <= last) continue;

        Info<< "--> Time directory " << name << " is incomplete (its file"
            << " uniform/" << stateName << " is missing or cut off): it is"
            << " skipped and renamed to " << name << ".incomplete." << nl
            << endl;
        const fileName from(casePath/name);
        const fileName to(from + ".incomplete");
        if (isDir(from))
        {
            if (isDir(to)) rmDir(to);
            mv(from, to);
        }
    }
}


void Foam::mpm::materialPointSystem::read()
{
    cost_.reset();
    const IOobject header
    (
        stateName,
        time_.timeName(),
        "uniform",
        time_,
        IOobject::MUST_READ,
        IOobject::NO_WRITE,
        false
    );
    if (!IOobject(header).typeHeaderOk<IOdictionary>(true))
    {
        FatalErrorInFunction
            << "file " << header.objectPath() << " is missing." << nl
            << "    Run setMaterialPoints first"
            << (Pstream::parRun()
               ? " (in parallel, or before decomposePar)." : ".")
            << exit(FatalError);
    }
    const IOdictionary state(header);

    for (materialPointCloud& cloud : clouds_)
    {
        const dictionary& dict = state.subDict(cloud.name());
        cloud.readState(dict);
        cloud.readPoints();

        const label n = cloud.globalSize();
        const label expected = dict.get<label>("nPoints");
        if (n != expected)
        {
            FatalIOErrorInFunction(dict)
                << "keyword nPoints is " << expected << ", but the files of"
                << " cloud " << cloud.name() << " at time " << time_.timeName()
                << " hold " << n << " points." << nl
                << "    Were processor directories of another run left over?"
                << exit(FatalIOError);
        }
    }
    firstStep_ = clouds_[0].stepCount();
}


void Foam::mpm::materialPointSystem::write()
{
    for (materialPointCloud& cloud : clouds_)
    {
        cloud.updateMeshFields();
        if (!cloud.regIOobject::write() || !cloud.writeMeshFields())
        {
            FatalErrorInFunction
                << "cannot write cloud " << cloud.name() << " to "
                << time_.timePath() << "; is the disk full?"
                << exit(FatalError);
        }
    }
    writeState();
}


void Foam::mpm::materialPointSystem::writeState() const
{
    IOdictionary state
    (
        IOobject
        (
            stateName,
            time_.timeName(),
            "uniform",
            time_,
            IOobject::NO_READ,
            IOobject::NO_WRITE,
            false
        )
    );
    // Enough digits to read the same number again
    const unsigned precision = IOstream::defaultPrecision(17);

    for (const materialPointCloud& cloud : clouds_)
    {
        dictionary dict;
        cloud.writeState(dict);
        state.set(cloud.name(), dict);
    }

    // Last of all: its presence says that the time directory is whole
    state.set("complete", true);

    const bool ok = state.regIOobject::write();
    IOstream::defaultPrecision(precision);

    if (!ok)
    {
        FatalErrorInFunction
            << "cannot write " << state.objectPath() << "; is the disk full?"
            << nl << "    The time directory before it is whole."
            << exit(FatalError);
    }
}

// ************************************************************************* //
