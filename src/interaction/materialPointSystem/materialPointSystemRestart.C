/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointSystem.H"
#include "argList.H"
#include "IFstream.H"
#include "OSspecific.H"
#include "PstreamReduceOps.H"
#include "cloud.H"
#include "bodies.H"
#include "fileOperation.H"
#include "exactDigits.H"
#include "lagrangianOutput.H"
#include "waterCloud.H"
#include "soilCloud.H"
#include "phasePair.H"
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <sys/statvfs.h>

const Foam::word Foam::mpm::materialPointSystem::stateName("materialPoints");

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

//- Has a collated file its blocks of all ranks, "// Processor<i> n (bytes)"
bool allBlocks(std::istream& file, const Foam::label nRanks)
{
    std::string line;
    Foam::label n = 0;
    while (std::getline(file, line))
    {
        if (line.compare(0, 12, "// Processor")) continue;

        std::streamsize size = 0;
        file >> size;
        while (file.good() && file.get() != '(') {}
        file.ignore(size);
        if (file.get() != ')') return false;
        ++n;
    }
    return n == nRanks;
}


//- Does the last line of a file hold the comment that OpenFOAM ends with.
//  The file may be compressed (writeCompression), or hold a block of each of
//  nRanks ranks (collated).
bool ended(const Foam::fileName& path, const Foam::label nRanks)
{
    if (nRanks)
    {
        Foam::IFstream whole(path, Foam::IOstream::BINARY);
        std::string line;
        while (whole.good() && std::getline(whole.stdStream(), line))
        {
            if (line.find("decomposedBlockData") != std::string::npos)
            {
                return allBlocks(whole.stdStream(), nRanks);
            }
            if (line == "}") break;
        }
    }

    if (Foam::isFile(path + ".gz", false))
    {
        // A file that was cut off ends early
        Foam::IFstream compressed(path);
        std::string line;
        bool found = false;
        while (compressed.good() && std::getline(compressed.stdStream(), line))
        {
            found = line.find("// ***") != std::string::npos
                || (found && line.empty());
        }
        return found;
    }

    std::ifstream file(path, std::ios::binary | std::ios::ate);
    if (!file.good()) return false;

    const std::streamoff size = file.tellg();
    const std::streamoff tail = std::min(size, std::streamoff(100));
    std::string text(tail, ' ');
    file.seekg(size - tail);
    file.read(&text[0], tail);
    return text.find("// ***") != std::string::npos;
}


//- Is a time directory whole: its state file, which is written last, and all
//  files of its clouds. In processors<N>, or processors<N>_<first>-<last>, it is
//  that of several ranks.
bool complete(const Foam::fileName& timePath, const Foam::word& stateName)
{
    using namespace Foam;

    int n = 0, first = 0, last = 0;
    const int nFound = std::sscanf
    (
        timePath.path().name().c_str(), "processors%d_%d-%d", &n, &first, &last
    );
    const label nRanks = nFound == 3 ? last - first + 1 : n;
    if (!ended(timePath/"uniform"/stateName, nRanks)) return false;

    for (const fileName& name : readDir(timePath/cloud::prefix, fileName::DIRECTORY))
    {
        const fileName path(timePath/cloud::prefix/name);
        const fileNameList files(readDir(path, fileName::FILE));
        for (const fileName& file : files)
        {
            if (!ended(path/file, nRanks)) return false;
        }
        // What every cloud needs
        for (const char* needed : {"x", "U", "mass", "id"})
        {
            if (files.size() && !files.found(needed)) return false;
        }
    }
    return true;
}

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::materialPointSystem::describeCase() const
{
    const exactDigits exact;
    auto text = [](const bool on) { return word(on ? "yes" : "no"); };

    DynamicList<word> names;
    for (const materialPointCloud& cloud : clouds_)
    {
        dictionary basis, settings;
        cloud.describe(basis, settings);
        record_.basis().set(cloud.name(), basis);
        record_.settings().set(cloud.name(), settings);
        names.append(cloud.name());
    }
    record_.basis().set("clouds", wordList(names));

    // As they are in effect, given or not
    dictionary mpm(control_);
    mpm.set("shapeFunction", grid_.shapeFunction());
    mpm.set("maxCo", maxCo_);
    mpm.set("smoothing", text(settings_.smoothing));
    mpm.set("volumeCorrection", text(settings_.volumeCorrection));
    mpm.set("overlapCorrection", text(settings_.overlapCorrection));
    mpm.set("sortInterval", settings_.sortInterval);
    mpm.remove("logInterval");
    // Not known to states before December 2026
    if (!settings_.looseningCorrection) mpm.remove("looseningCorrection");
    mpm.remove("strictKeywords");
    record_.settings().set("MPM", mpm);

    if (settings_.coupled)
    {
        record_.settings().set
        (
            "interaction", properties_.subOrEmptyDict("interaction")
        );
    }
    if (bodies_.valid())
    {
        record_.settings().set("bodies", properties_.subDict("bodies"));
    }
    if (frame_.valid())
    {
        record_.settings().set("frame", properties_.subDict("frame"));
    }
    record_.settings().set("gravity", g_);
    record_.settings().set
    (
        "adjustTimeStep",
        text
        (
            time_.controlDict().lookupOrDefault<Switch>("adjustTimeStep", false)
        )
    );
}


Foam::dictionary Foam::mpm::materialPointSystem::placement() const
{
    const IOobject header
    (
        "setMaterialPointsDict",
        time_.system(),
        mesh_,
        IOobject::MUST_READ,
        IOobject::NO_WRITE,
        false
    );
    if (!IOobject(header).typeHeaderOk<IOdictionary>(true)) return dictionary();

    const exactDigits exact;
    dictionary result(static_cast<const dictionary&>(IOdictionary(header)));
    result.set("gravity", g_);
    return result;
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::materialPointSystem::setIncompleteTimesAside
(
    const argList& args
)
{
    const fileName casePath(args.path());

    // A time directory that only some ranks have is incomplete, too
    wordHashSet found;
    for (const instant& t : TimePaths::findTimes(casePath))
    {
        if (t.name() != "constant") found.insert(t.name());
    }
    if (Pstream::parRun())
    {
        List<wordList> all(Pstream::nProcs());
        all[Pstream::myProcNo()] = found.sortedToc();
        Pstream::gatherList(all);
        Pstream::scatterList(all);
        for (const wordList& names : all) found.insert(names);
    }
    wordList names(found.toc());
    std::sort
    (
        names.begin(), names.end(),
        [](const word& a, const word& b)
        {
            return readScalar(a) > readScalar(b);
        }
    );

    // Only what is later than the last time that is whole on every rank can
    // have been cut off; what is earlier is not read
    label nIncomplete = 0;
    for (const word& name : names)
    {
        // On all ranks: file handlers may look for files by the master
        const fileName timePath(fileHandler().filePath(casePath/name));
        if (returnReduce(complete(timePath, stateName), andOp<bool>()))
        {
            break;
        }
        ++nIncomplete;
    }
    if (nIncomplete == names.size()) return;

    for (label i = nIncomplete - 1; i >= 0; --i)
    {
        const word& name = names[i];
        Info<< "--> Time directory " << name << " is incomplete (its file"
            << " uniform/" << stateName << " or one of its clouds is missing or"
            << " cut off): it is"
            << " skipped and renamed to " << name << ".incomplete." << nl
            << endl;
        // Of several ranks if files are collated: the first of them does it
        List<fileName> all(Pstream::nProcs());
        const fileName& from = all[Pstream::myProcNo()] =
            fileHandler().filePath(casePath/name);
        Pstream::gatherList(all);
        Pstream::scatterList(all);
        const fileName to(from + ".incomplete");
        if (all.find(from) == Pstream::myProcNo() && isDir(from))
        {
            if (isDir(to)) rmDir(to);
            mv(from, to);
        }
    }
    // Some file handlers keep the list of times
    fileHandler().flush();
}


void Foam::mpm::materialPointSystem::read(Time& runTime)
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

    const bool recorded = caseRecord::in(state);
    bool start = true;
    if (recorded)
    {
        describeCase();
        record_.checkBasis(state);

        for (const materialPointCloud& cloud : clouds_)
        {
            const dictionary& dict = state.subDict(cloud.name());
            start = start && !dict.lookupOrDefault<label>("stepCount", 0);
        }
        if (start) record_.checkPlacement(state, placement());
        record_.takePlacement(state);
    }
    else
    {
        Info<< "File " << state.objectPath() << " has no record of the case,"
            << " as older versions of mpmFoam wrote none:" << nl
            << "    not compared are mesh, materials and settings of then and"
            << " now" << nl << endl;
    }

    for (materialPointCloud& cloud : clouds_)
    {
        const dictionary& dict = state.subDict(cloud.name());
        lagrangianOutput::checkWhole(cloud, dict, stateName);
        cloud.readState(dict);
        cloud.readPoints();

        const int64_t n = cloud.globalSize();
        const int64_t expected = readCount(dict, "nPoints");
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
    lagrangianOutput::New(mesh_, clouds_, settings_.strictKeywords);
    firstStep_ = clouds_[0].stepCount();
    if (bodies_.valid() && firstStep_ > 0)
    {
        bodies_->readState(state.subDict("bodies"));
        if (bodies_->anyPlateMoves())
        {
            grid_.setPlates(bodies_->plates());
            rebuild();
        }
    }
    bodiesMoved_ = bodies_.valid() && bodies_->anyMoves();
    for (const materialPointCloud& cloud : clouds_) cloud.checkDigits();
    if (recorded)
    {
        // The speed of sound and what follows from it are known now
        describeCase();
        record_.reportSettings(state, start);
    }

    // The name of the directory is rounded
    const scalar value = state.lookupOrDefault<scalar>("time", time_.value());
    if (Time::timeName(value) == time_.timeName())
    {
        runTime.setTime(value, time_.timeIndex());
    }

    // Function objects look at them before the first step
    for (materialPointCloud& cloud : clouds_) cloud.updateMeshFields();
}


void Foam::mpm::materialPointSystem::writeOrStop
(
    const std::function<bool()>& op,
    const string& what
) const
{
    // A stream that fails ends the run with an error of its own, which does
    // not say why
    string failure;
    bool ok = false;
    const bool throwing = FatalIOError.throwExceptions();
    try
    {
        ok = op();
    }
    catch (const Foam::IOerror& e)
    {
        failure = e.message();
    }
    FatalIOError.throwExceptions(throwing);

    if (!returnReduce(!ok, orOp<bool>())) return;

    FatalErrorInFunction
        << "cannot write " << what.c_str() << (ok ? " on another rank" : "")
        << "; is the disk full, or the case read-only?";

    struct statvfs disk;
    if (statvfs(time_.path().c_str(), &disk) == 0)
    {
        FatalError
            << " (" << std::floor(1e-6*disk.f_bavail*disk.f_frsize)
            << " MB are free)";
    }
    if (!failure.empty()) FatalError<< nl << "    " << failure.c_str();
    FatalError
        << nl << "    What was written before is whole." << exit(FatalError);
}


void Foam::mpm::materialPointSystem::write()
{
    record_.setPlacement(placement());
    for (const materialPointCloud& cloud : clouds_) cloud.checkDigits();

    for (materialPointCloud& cloud : clouds_)
    {
        cloud.updateMeshFields();
        writeOrStop
        (
            [&]
            {
                return cloud.regIOobject::write() && cloud.writeMeshFields();
            },
            "cloud " + cloud.name() + " to " + time_.timePath()
        );
    }
    if (bodyDistance_.valid())
    {
        writeOrStop
        (
            [&] { return bodyDistance_->write(); }, bodyDistance_->objectPath()
        );
    }
    writeState();
}


void Foam::mpm::materialPointSystem::writeTime(Time& runTime)
{
    if (!runTime.writeTime()) return;

    writeOrStop([&] { return runTime.write(); }, "time " + runTime.timeName());
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
    const exactDigits exact;

    for (const materialPointCloud& cloud : clouds_)
    {
        dictionary dict;
        cloud.writeState(dict);
        lagrangianOutput::record(cloud, dict);
        state.set(cloud.name(), dict);
    }
    if (bodies_.valid())
    {
        dictionary dict;
        bodies_->writeState(dict);
        state.set("bodies", dict);
    }
    describeCase();
    record_.write(state);

    state.set("time", time_.value());

    // Last of all: its presence says that the time directory is whole
    state.set("complete", true);

    writeOrStop
    (
        [&] { return state.regIOobject::write(); }, state.objectPath()
    );
}

// ************************************************************************* //
