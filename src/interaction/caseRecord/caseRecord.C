/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "caseRecord.H"
#include "exactDigits.H"
#include "ITstream.H"
#include "PstreamReduceOps.H"
#include "StringStream.H"
#include <string>

const Foam::word Foam::mpm::caseRecord::recordName("case");
const Foam::word Foam::mpm::caseRecord::basisName("basis");
const Foam::word Foam::mpm::caseRecord::settingsName("settings");
const Foam::word Foam::mpm::caseRecord::placementName("placement");

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

//- The values of an entry, without name and dimensions of a quantity and
//  without the number in front of a list
tokenList values(const entry& e)
{
    const ITstream& all = e.stream();
    DynamicList<token> result;
    bool dimensions = false;
    for (const token& t : all)
    {
        if (t.isPunctuation() && t.pToken() == token::BEGIN_SQR)
        {
            dimensions = true;
            if (result.size() == 1 && result[0].isWord()) result.clear();
        }
        else if (t.isPunctuation() && t.pToken() == token::END_SQR)
        {
            dimensions = false;
        }
        else if (!dimensions)
        {
            if
            (
                t.isPunctuation() && t.pToken() == token::BEGIN_LIST
             && result.size() && result.last().isLabel()
            )
            {
                result.remove();
            }
            result.append(t);
        }
    }
    return result;
}


bool same(const tokenList& a, const tokenList& b)
{
    if (a.size() != b.size()) return false;

    forAll(a, i)
    {
        if (a[i].isNumber() && b[i].isNumber())
        {
            const scalar x = a[i].number(), y = b[i].number();
            if (mag(x - y) > 1e-12*max(mag(x), mag(y))) return false;
        }
        else if (a[i] != b[i])
        {
            // A word or a string, a list or a compound of it
            OStringStream x, y;
            x << a[i];
            y << b[i];
            if (x.str() != y.str()) return false;
        }
    }
    return true;
}


//- As it stands in a dictionary, cut where it is long
string text(const entry* e)
{
    if (!e) return "not given";
    if (e->isDict()) return "a dictionary";

    const size_t longest = 80;
    OStringStream os;
    const tokenList tokens(values(*e));
    forAll(tokens, i)
    {
        const bool open = i
         && tokens[i - 1].isPunctuation()
         && tokens[i - 1].pToken() == token::BEGIN_LIST;
        const bool close =
            tokens[i].isPunctuation()
         && tokens[i].pToken() == token::END_LIST;
        if (i && !open && !close) os << ' ';
        os << tokens[i];
        if (os.str().size() > longest) break;
    }
    std::string s(os.str());
    if (s.size() > longest) s = s.substr(0, longest) + " ...";
    return s;
}


//- Where the entries of a cloud, or of all, are read
fileName fileOf(const word& part)
{
    return
        part == "mesh" ? "constant/polyMesh"
      : part == "gravity" ? "constant/g"
      : part == "MPM" ? "system/fvSolution"
      : part == "controlDict" ? "system/controlDict"
      : "constant/materialPointProperties";
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::caseRecord::addMesh(const lattice& cells)
{
    vector origin, spacing, number;
    for (label d = 0; d < 3; ++d)
    {
        origin[cells.axis(d)] = cells.origin(d);
        spacing[cells.axis(d)] = cells.spacing(d);
        number[cells.axis(d)] = cells.nCells(d);
    }

    // Which cells there are, whatever their order and rank; exact in a scalar
    const label n = cells.mesh().nCells();
    scalar places = 0;
    for (label celli = 0; celli < n; ++celli)
    {
        uint64_t z = 0;
        for (label d = 0; d < 3; ++d)
        {
            z = (z + uint64_t(cells.cellIndex(celli)[d]) + 1)
               *0x9E3779B97F4A7C15ULL;
            z ^= z >> 29;
        }
        places += scalar(z >> 40);
    }
    reduce(places, sumOp<scalar>());

    const exactDigits exact;
    dictionary mesh;
    mesh.set("dimensions", cells.nDim());
    mesh.set("origin", origin);
    mesh.set("spacing", spacing);
    mesh.set("latticeCells", number);
    mesh.set("cells", returnReduce(int64_t(n), sumOp<int64_t>()));
    // A word, which no precision of numbers rounds
    mesh.set("places", word("sum" + std::to_string(int64_t(places))));
    basis_.set("mesh", mesh);
}


bool Foam::mpm::caseRecord::in(const dictionary& state)
{
    return state.isDict(recordName);
}


void Foam::mpm::caseRecord::takePlacement(const dictionary& state)
{
    if (in(state))
    {
        placement_ = state.subDict(recordName).subOrEmptyDict(placementName);
    }
}


void Foam::mpm::caseRecord::checkBasis(const dictionary& state) const
{
    const dictionary& record = state.subDict(recordName).subDict(basisName);
    DynamicList<change> changes;

    // Coordinates differ by what a file in ascii holds of them
    dictionary was(record), is(basis_);
    const dictionary oldMesh(was.subOrEmptyDict("mesh"));
    const dictionary newMesh(is.subOrEmptyDict("mesh"));
    was.remove("mesh");
    is.remove("mesh");
    if (!oldMesh.empty())
    {
        const scalar tolerance = 1e-3;
        const vector h(oldMesh.get<vector>("spacing"));
        const vector h2(newMesh.get<vector>("spacing"));
        const vector n(oldMesh.get<vector>("latticeCells"));
        const vector from
        (
            newMesh.get<vector>("origin") - oldMesh.get<vector>("origin")
        );
        dictionary oldRest(oldMesh), newRest(newMesh);
        bool moved = false, scaled = false;
        for (direction c = 0; c < 3; ++c)
        {
            moved = moved || mag(from[c]) > tolerance*h[c];
            scaled = scaled || mag(h2[c] - h[c])*n[c] > tolerance*h[c];
        }
        auto takeNew = [&](const word& keyword)
        {
            oldRest.set(newMesh.findEntry(keyword)->clone(oldRest).ptr());
        };
        if (!moved) takeNew("origin");
        if (!scaled) takeNew("spacing");

        // Before December 2026 a number of as many digits as writePrecision
        const token places(oldMesh.lookup("places"));
        if (places.isNumber())
        {
            const scalar exact =
                std::stod(newMesh.get<word>("places").substr(3));
            if (mag(places.number() - exact) <= 1e-5*exact) takeNew("places");
        }
        compare(oldRest, newRest, "mesh", changes);

        // The number says more than which
        bool number = false;
        for (const change& c : changes) number = number || c.keyword == "cells";
        if (number)
        {
            DynamicList<change> rest;
            for (const change& c : changes)
            {
                if (c.keyword != "places") rest.append(c);
            }
            changes = rest;
        }
    }
    // Clouds that only one of them has are named by the entry clouds. What the
    // case leaves to the state file, as a speed of sound that is auto, is not
    // changed.
    for (const word& part : was.toc())
    {
        if (!was.isDict(part)) continue;
        if (!is.isDict(part))
        {
            was.remove(part);
            continue;
        }
        for (const word& keyword : was.subDict(part).toc())
        {
            if (!is.subDict(part).found(keyword))
            {
                was.subDict(part).remove(keyword);
            }
        }
    }
    for (const word& part : is.toc())
    {
        if (is.isDict(part) && !was.isDict(part)) is.remove(part);
    }
    compare(was, is, "", changes);
    if (changes.empty()) return;

    FatalIOErrorInFunction(state)
        << "the points in this time directory belong to another case than"
        << " that of now:" << nl;
    for (const change& c : changes)
    {
        const word part(c.dict.substr(0, c.dict.find('/')));
        FatalIOError<< "    " << fileOf(part).c_str() << ": ";
        if (c.keyword == "places")
        {
            FatalIOError<< "other blocks of the mesh are left out";
        }
        else
        {
            FatalIOError
                << c.dict.c_str() << (c.dict.empty() ? "" : "/")
                << c.keyword << " was " << c.was.c_str() << ", is "
                << c.is.c_str();
        }
        FatalIOError<< nl;
    }
    FatalIOError
        << "    Their masses and states would not mean what they meant." << nl
        << "    Allowed: run setMaterialPoints again"
        << " (and begin at its time), or restore what was changed"
        << exit(FatalIOError);
}


void Foam::mpm::caseRecord::checkPlacement
(
    const dictionary& state,
    const dictionary& placement
) const
{
    const dictionary was
    (
        state.subDict(recordName).subOrEmptyDict(placementName)
    );
    if (was.empty() || placement.empty()) return;

    DynamicList<change> changes;
    compare(was, placement, "", changes);
    if (changes.empty()) return;

    FatalIOErrorInFunction(state)
        << "the points in this time directory were placed before these entries"
        << " were changed:" << nl;
    for (const change& c : changes)
    {
        const bool gravity = c.dict.empty() && c.keyword == "gravity";
        FatalIOError
            << "    "
            << (gravity ? "constant/g" : "system/setMaterialPointsDict") << ": "
            << c.dict.c_str() << (c.dict.empty() ? "" : "/")
            << c.keyword << " was " << c.was.c_str() << ", is "
            << c.is.c_str() << nl;
    }
    FatalIOError
        << "    Allowed: run setMaterialPoints again, or restore what was"
        << " changed" << exit(FatalIOError);
}


void Foam::mpm::caseRecord::reportSettings
(
    const dictionary& state,
    const bool start
) const
{
    DynamicList<change> changes;
    compare
    (
        state.subDict(recordName).subOrEmptyDict(settingsName),
        settings_,
        "",
        changes
    );
    for (const change& c : changes)
    {
        Info<< (start ? "Start" : "Restart") << " with another " << c.keyword;
        if (!c.dict.empty()) Info<< " (" << c.dict.c_str() << ')';
        Info<< ": was " << c.was.c_str() << ", is " << c.is.c_str() << nl;
    }
    if (changes.size()) Info<< endl;
}


void Foam::mpm::caseRecord::write(dictionary& state) const
{
    dictionary record;
    record.set(basisName, basis_);
    record.set(settingsName, settings_);
    record.set(placementName, placement_);
    state.set(recordName, record);
}


void Foam::mpm::caseRecord::compare
(
    const dictionary& was,
    const dictionary& is,
    const string& path,
    DynamicList<change>& changes
)
{
    wordList keywords(is.toc());
    for (const word& keyword : was.toc())
    {
        if (!keywords.found(keyword)) keywords.append(keyword);
    }
    for (const word& keyword : keywords)
    {
        const entry* a = was.findEntry(keyword, keyType::LITERAL);
        const entry* b = is.findEntry(keyword, keyType::LITERAL);

        if (a && b && a->isDict() && b->isDict())
        {
            const string inner
            (
                path.empty() ? string(keyword) : path + '/' + keyword
            );
            compare(a->dict(), b->dict(), inner, changes);
            continue;
        }
        if
        (
            a && b && !a->isDict() && !b->isDict()
         && same(values(*a), values(*b))
        )
        {
            continue;
        }
        change found{path, keyword, text(a), text(b)};
        if (found.was == found.is)
        {
            // They part in digits that controlDict does not ask for
            const exactDigits exact;
            found.was = text(a);
            found.is = text(b);
        }
        changes.append(found);
    }
}

// ************************************************************************* //
