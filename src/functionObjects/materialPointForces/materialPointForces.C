/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "materialPointForces.H"
#include "bodies.H"
#include "nodeBoundary.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "functionNeeds.H"
#include "wordRes.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(materialPointForces, 0);
    addToRunTimeSelectionTable(functionObject, materialPointForces, dictionary);

    static const functionNeeds::add needsOfMaterialPointForces
    (
        "materialPointForces", functionNeeds::NO_FIELDS
    );
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

const Foam::mpm::bodies& Foam::mpm::materialPointForces::all() const
{
    return *cloud().bodiesPtr();
}


void Foam::mpm::materialPointForces::readBodies(const dictionary& dict)
{
    bodies_.clear();
    if (!cloud().bodiesPtr())
    {
        if (dict.found("patches") && !dict.found("bodies")) return;
        FatalIOErrorInFunction(dict)
            << "function object " << name() << " asks for forces on bodies, but"
            << " the scene has none." << nl
            << "    Allowed: with bodies { ... } in"
            << " constant/materialPointProperties, or patches"
            << exit(FatalIOError);
    }
    wordList names(all().size());
    forAll(names, b) names[b] = all()[b].name();

    const wordList asked
    (
        dict.lookupOrDefault<wordList>
            ("bodies", dict.found("patches") ? wordList() : names)
    );
    for (const word& body : asked)
    {
        const label b = names.find(body);
        if (b < 0)
        {
            FatalIOErrorInFunction(dict)
                << "keyword bodies: there is no body " << body << '.' << nl
                << "    Allowed: " << listed(names) << exit(FatalIOError);
        }
        bodies_.append(b);
    }
}


void Foam::mpm::materialPointForces::readPatches(const dictionary& dict)
{
    patches_.clear();
    if (!dict.found("patches")) return;

    const polyBoundaryMesh& patches = mesh_.boundaryMesh();
    wordList walls;
    labelList ofWall;
    forAll(patches, patchi)
    {
        if (!cloud().boundary().isWall(patchi)) continue;
        walls.append(patches[patchi].name());
        ofWall.append(patchi);
    }
    const wordRes asked(dict.get<wordRes>("patches"));
    bitSet chosen(patches.size());
    for (const wordRe& pattern : asked)
    {
        bool any = false;
        forAll(walls, i)
        {
            if (!pattern.match(walls[i])) continue;
            chosen.set(ofWall[i]);
            any = true;
        }
        if (!any)
        {
            FatalIOErrorInFunction(dict)
                << "keyword patches: " << pattern << " is no wall of the cloud "
                << cloud().name() << '.' << nl << "    Allowed: "
                << listed(walls) << exit(FatalIOError);
        }
    }
    patches_ = chosen.toc();

    // What the pressure of a liquid does to walls, points of solids record, too
    for (const word& name : mesh_.sortedNames<materialPointCloud>())
    {
        mesh_.lookupObjectRef<materialPointCloud>(name).recordWallLoads();
    }
}


Foam::mpm::nodeConstraint::load Foam::mpm::materialPointForces::onPatch
(
    const label patchi
) const
{
    nodeConstraint::load load;
    if (patchi < cloud().wallLoads().size()) load = cloud().wallLoads()[patchi];
    load.moment -= CofR_ ^ load.force;
    load.frictionMoment -= CofR_ ^ load.friction;
    return load;
}


Foam::mpm::nodeConstraint::load Foam::mpm::materialPointForces::sum() const
{
    nodeConstraint::load sum;
    for (const label b : bodies_)
    {
        nodeConstraint::load load(cloud().loadOn(b));
        const vector arm(all()[b].motion().centre() - CofR_);
        load.moment += arm ^ load.force;
        load.frictionMoment += arm ^ load.friction;
        sum += load;
    }
    for (const label patchi : patches_) sum += onPatch(patchi);
    return sum;
}


void Foam::mpm::materialPointForces::openOthers()
{
    // Others after a change of controlDict
    OStringStream heads;
    heads << bodies_ << patches_ << CofR_;
    for (const pressureSet& set : sets_) heads << set.name() << set.positions();
    const bool first = heads_.empty();
    if (heads.str() == heads_) return;
    heads_ = heads.str();

    auto integrated = [&](const word& file, const word& title)
    {
        autoPtr<OFstream> osPtr(beginFile(file, first));
        OFstream& os = osPtr();
        writeHeader(os, title);
        writeHeaderValue(os, "CofR", CofR_);
        writeHeader(os, "");
        writeCommented(os, "Time");
        for (const char* part : {"total", "pressure", "viscous"})
        {
            const word p(part);
            writeTabbed(os, "(" + p + "_x " + p + "_y " + p + "_z)");
        }
        os  << endl;
        return osPtr;
    };
    force_ = integrated("force", "Force");
    moment_ = integrated("moment", "Moment");

    pressure_.clear();
    pressure_.setSize(sets_.size());
    forAll(sets_, i)
    {
        autoPtr<OFstream> osPtr
            (beginFile("pressure_" + sets_[i].name(), first));
        OFstream& os = osPtr();
        const pointField x(sets_[i].positions());
        os  << setw(0);
        forAll(x, k) os << "# Probe " << k << ' ' << x[k] << nl;
        os  << "# Time";
        forAll(x, k) os << tab << k;
        os  << endl;
        pressure_.set(i, osPtr.release());
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::materialPointForces::keywords() const
{
    return wordList({"bodies", "patches", "CofR", "pressure"});
}


void Foam::mpm::materialPointForces::readEntries(const dictionary& dict)
{
    CofR_ = dict.lookupOrDefault<point>("CofR", Zero);
    const dictionary sets(subDictOrEmpty(dict, "pressure"));
    sets_.clear();
    for (const entry& e : sets)
    {
        sets_.append
        (
            new pressureSet
            (
                e.keyword(), subDictOf(sets, e.keyword()), cloud(), mesh_,
                strictKeywords()
            )
        );
    }

    // Pressures may be all that is asked for
    if
    (
        sets_.size() && !cloud().bodiesPtr()
     && !dict.found("patches") && !dict.found("bodies")
    )
    {
        bodies_.clear();
        patches_.clear();
        return;
    }
    readBodies(dict);
    readPatches(dict);
}


Foam::stringList Foam::mpm::materialPointForces::description() const
{
    return stringList
    ({
        "Force [N] of " + cloud().name() + " on bodies in the last step, and"
        " moment [N m] about the centre of each; where it is [m] and its"
        " velocity [m/s] if it moves"
      + string(patches_.empty() ? "" : "; on patches, about CofR")
    });
}


Foam::wordList Foam::mpm::materialPointForces::columns() const
{
    DynamicList<word> names;
    auto add = [&](const word& of, const std::initializer_list<const char*>& what)
    {
        for (const char* w : what) names.append(of + '_' + w);
    };
    for (const label b : bodies_)
    {
        const word& body = all()[b].name();
        add(body, {"Fx", "Fy", "Fz", "Mx", "My", "Mz"});
        if (!all()[b].motion().moves()) continue;
        add(body, {"x", "y", "z", "Ux", "Uy", "Uz"});
    }
    for (const label patchi : patches_)
    {
        add
        (
            mesh_.boundaryMesh()[patchi].name(),
            {"Fx", "Fy", "Fz", "Mx", "My", "Mz"}
        );
    }
    return wordList(names);
}


Foam::scalarList Foam::mpm::materialPointForces::values() const
{
    DynamicList<scalar> values;
    auto add = [&](const vector& v)
    {
        for (direction d = 0; d < 3; ++d) values.append(v[d]);
    };
    for (const label b : bodies_)
    {
        const nodeConstraint::load load(cloud().loadOn(b));
        add(load.force);
        add(load.moment);
        const bodyMotion& motion = all()[b].motion();
        if (!motion.moves()) continue;
        add(motion.centre());
        add(motion.velocity());
    }
    for (const label patchi : patches_)
    {
        const nodeConstraint::load load(onPatch(patchi));
        add(load.force);
        add(load.moment);
    }
    return scalarList(values);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::materialPointForces::materialPointForces
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudTimeSeries(name, runTime, dict, "forces"),
    CofR_(Zero)
{
    start(dict);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::materialPointForces::read(const dictionary& dict)
{
    cloudTimeSeries::read(dict);
    if (writeToFile()) openOthers();
    return true;
}


bool Foam::mpm::materialPointForces::write()
{
    cloudTimeSeries::write();

    List<scalarList> pressures(sets_.size());
    forAll(sets_, i) pressures[i] = sets_[i].pressures(cloud());
    if (!writeToFile() || !Pstream::master()) return true;

    const nodeConstraint::load load(sum());
    auto integrated = [&]
    (
        OFstream& os,
        const vector& total,
        const vector& viscous
    )
    {
        os  << timeNow() << tab << total << tab << total - viscous << tab
            << viscous << endl;
    };
    integrated(force_(), load.force, load.friction);
    integrated(moment_(), load.moment, load.frictionMoment);
    forAll(sets_, i)
    {
        OFstream& os = pressure_[i];
        os  << timeNow();
        for (const scalar p : pressures[i]) os << tab << p;
        os  << endl;
    }
    return true;
}

// ************************************************************************* //
