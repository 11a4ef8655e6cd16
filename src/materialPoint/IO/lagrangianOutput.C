/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "lagrangianOutput.H"
#include "dictionaryEntries.H"
#include "fileOperation.H"
#include "listed.H"
#include "materialPointCloud.H"
#include "stringListOps.H"

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::lagrangianOutput::lagrangianOutput
(
    const fvMesh& mesh,
    const bool strictKeywords
)
:
    regIOobject
    (
        IOobject
        (
            keyword, mesh.time().constant(), mesh, IOobject::NO_READ,
            IOobject::NO_WRITE
        )
    ),
    mesh_(mesh),
    restartInterval_(GREAT),
    lastWhole_(mesh.time().value()),
    decidedStep_(-1),
    whole_(true)
{
    const Time& time = mesh.time();
    const dictionary& dict = time.controlDict().subDict(keyword);

    // It would remove the times that hold all
    if (time.controlDict().lookupOrDefault<label>("purgeWrite", 0) > 0)
    {
        FatalIOErrorInFunction(time.controlDict())
            << "keyword purgeWrite is "
            << time.controlDict().get<label>("purgeWrite") << " beside "
            << keyword << ": it would remove the times that hold all." << nl
            << "    Allowed: purgeWrite 0" << exit(FatalIOError);
    }

    if (dict.found("restartInterval"))
    {
        restartInterval_ = readPositive(dict, "restartInterval", dimTime);
    }
    wordList known({"fields", "precision"});
    known.append(pointSelection::keywords());
    for (const entry& e : dict)
    {
        if (!e.isDict()) continue;

        checkKeywords(e.dict(), known, strictKeywords);
        const word handler(fileHandler().type());
        if
        (
            (handler == "collated" || handler == "hostCollated")
         && e.dict().lookupOrDefault<word>("precision", "double") == "single"
        )
        {
            FatalIOErrorInFunction(e.dict())
                << "keyword precision is single, but files of the fileHandler "
                << handler << " hold all digits." << nl
                << "    Allowed: double; or another fileHandler"
                << exit(FatalIOError);
        }
        auto* p = new part
        {
            e.dict().lookupOrDefault<wordRes>("fields", wordRes()),
            readChoiceOrDefault
                (e.dict(), "precision", "double", {"double", "single"})
         == "single",
            pointSelection(mesh, e.dict(), strictKeywords),
            string()
        };
        OStringStream os;
        for (const entry& ofPart : e.dict())
        {
            os  << (os.str().empty() ? "" : ", ") << ofPart.keyword();
        }
        p->text = os.str();
        parts_.set(e.keyword(), p);
    }
}


void Foam::mpm::lagrangianOutput::New
(
    const fvMesh& mesh,
    const PtrList<materialPointCloud>& clouds,
    const bool strictKeywords
)
{
    if (!mesh.time().controlDict().found(keyword)) return;

    auto* output = new lagrangianOutput(mesh, strictKeywords);
    output->store();

    const dictionary& dict = mesh.time().controlDict().subDict(keyword);
    wordList names({"restartInterval"});
    for (const materialPointCloud& cloud : clouds) names.append(cloud.name());
    checkKeywords(dict, names, strictKeywords);

    for (const materialPointCloud& cloud : clouds)
    {
        const part* p = output->parts_.lookup(cloud.name(), nullptr);
        if (!p) continue;

        wordList known;
        cloud.visitFields
        (
            [&](const word& field, const auto&) { known.append(field); }
        );
        for (const wordRe& pattern : p->fields)
        {
            if (!findStrings(pattern, known).empty()) continue;

            sort(known);
            FatalIOErrorInFunction(dict.subDict(cloud.name()))
                << "keyword fields: " << pattern << " is no field of the cloud "
                << cloud.name() << '.' << nl
                << "    Allowed: " << listed<wordList>(known)
                << exit(FatalIOError);
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

const Foam::mpm::lagrangianOutput::part* Foam::mpm::lagrangianOutput::of
(
    const materialPointCloud& cloud
)
{
    const auto* found =
        cloud.grid().mesh().findObject<lagrangianOutput>(keyword);
    if (!found) return nullptr;

    auto& output = const_cast<lagrangianOutput&>(*found);
    return
        output.whole()
      ? nullptr : output.parts_.lookup(cloud.name(), nullptr);
}


void Foam::mpm::lagrangianOutput::record
(
    const materialPointCloud& cloud,
    dictionary& state
)
{
    const part* p = of(cloud);
    if (p) state.set(keyword, p->text);
}


void Foam::mpm::lagrangianOutput::checkWhole
(
    const materialPointCloud& cloud,
    const dictionary& state,
    const word& stateName
)
{
    if (!state.found(keyword)) return;

    // The last time before that holds all
    const Time& time = cloud.time();
    word last;
    for (const instant& t : time.times())
    {
        if (t.value() >= time.value()) break;

        IOobject header
        (
            stateName, t.name(), "uniform", time, IOobject::MUST_READ,
            IOobject::NO_WRITE, false
        );
        if (!header.typeHeaderOk<IOdictionary>(false)) continue;
        if
        (
            !IOdictionary(header).subOrEmptyDict(cloud.name()).found(keyword)
        )
        {
            last = t.name();
        }
    }
    FatalIOErrorInFunction(state)
        << "time " << time.timeName() << " holds only a part of the points of"
        << " cloud " << cloud.name() << ", or of their fields ("
        << keyword << " in controlDict: "
        << state.get<string>(keyword).c_str() << ");" << nl
        << "    a restart needs all of them." << nl
        << "    Allowed: a time that holds all";
    if (last.size())
    {
        FatalIOError
            << ", the last before is startTime " << last
            << " (with startFrom startTime)";
    }
    FatalIOError<< exit(FatalIOError);
}


bool Foam::mpm::lagrangianOutput::whole()
{
    const Time& time = mesh_.time();
    if (time.timeIndex() == decidedStep_) return whole_;
    decidedStep_ = time.timeIndex();

    // A whole interval, but for the rounding of times
    const scalar past = time.value() - lastWhole_;
    whole_ =
        parts_.empty()
     || time.timeIndex() == time.startTimeIndex()
     || !time.writeTime()
     || time.value() > time.endTime().value() - 0.5*time.deltaTValue()
     || past >= restartInterval_ - 0.5*time.deltaTValue();
    if (whole_) lastWhole_ = time.value();
    return whole_;
}

// ************************************************************************* //
