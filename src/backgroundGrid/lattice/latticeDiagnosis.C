/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "latticeDiagnosis.H"
#include "IOdictionary.H"
#include "ITstream.H"
#include "Time.H"
#include <algorithm>
#include <cmath>
#include <sstream>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    //- Lengths that a spacing fits: within 1 %
    const Foam::scalar fitTolerance = 0.01;

    //- Sizes that count as the same, and distances of one and the same plane
    //  in cells
    const Foam::scalar sameSize = 1e-4;
    const Foam::scalar samePlane = 1e-3;

    //- Runs of cells that are listed per direction
    const size_t maxRuns = 12;

    const char axisName[] = {'x', 'y', 'z'};
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::latticeDiagnosis::findPlanes()
{
    std::vector<scalar> all[3];
    vector smallest(vector::uniform(GREAT));

    for (label celli = 0; celli < mesh_.nCells(); ++celli)
    {
        const boundBox bb(mesh_.points(), mesh_.cellPoints()[celli], false);
        const vector span(bb.span());
        const scalar volume = span.x()*span.y()*span.z();
        if
        (
            mesh_.cells()[celli].size() != 6
         || mesh_.cellPoints()[celli].size() != 8
         || mag(mesh_.cellVolumes()[celli] - volume) > 1e-3*volume
        )
        {
            return;
        }
        for (direction c = 0; c < 3; ++c)
        {
            all[c].push_back(bb.min()[c]);
            all[c].push_back(bb.max()[c]);
            smallest[c] = min(smallest[c], span[c]);
        }
    }
    for (direction c = 0; c < 3; ++c)
    {
        std::sort(all[c].begin(), all[c].end());
        DynamicList<scalar> planes;
        for (const scalar x : all[c])
        {
            if (planes.empty() || x > planes.last() + samePlane*smallest[c]) planes.append(x);
        }
        planes_[c] = planes;
    }
}


void Foam::mpm::latticeDiagnosis::findRuns()
{
    for (direction c = 0; c < 3; ++c)
    {
        for (label i = 1; i < planes_[c].size(); ++i)
        {
            const scalar h = planes_[c][i] - planes_[c][i - 1];
            std::vector<run>& runs = runs_[c];
            if (runs.size() && mag(h - runs.back().size()) < sameSize*h)
            {
                runs.back().to = planes_[c][i];
                ++runs.back().n;
            }
            else
            {
                runs.push_back(run{planes_[c][i - 1], planes_[c][i], 1, false});
            }
        }

        // Cells of which none is as its neighbour
        std::vector<run> joined;
        for (const run& r : runs_[c])
        {
            if (joined.size() && r.n == 1)
            {
                run& before = joined.back();
                if (before.n == 1 || before.graded)
                {
                    before.to = r.to;
                    before.graded = true;
                    ++before.n;
                    continue;
                }
            }
            joined.push_back(r);
        }
        runs_[c] = joined;
    }
}


void Foam::mpm::latticeDiagnosis::readBlocks()
{
    const IOobject header
    (
        "blockMeshDict",
        mesh_.time().system(),
        mesh_.time(),
        IOobject::MUST_READ,
        IOobject::NO_WRITE,
        false
    );
    if (!IOobject(header).typeHeaderOk<IOdictionary>(true)) return;

    // It may hold what is not understood here, as named or projected vertices:
    // then the blocks have no names
    const bool throwing = FatalIOError.throwExceptions();
    try
    {
        const IOdictionary dict(header);
        const scalar scale = dict.lookupOrDefault<scalar>
        (
            "scale", dict.lookupOrDefault<scalar>("convertToMeters", 1)
        );
        const pointField vertices(scale*pointField(dict.lookup("vertices")));

        // hex (8 vertices) [zone] (3 numbers) grading ...
        const ITstream& is = dict.lookup("blocks");
        label index = -1;
        for (label i = 0; i + 9 < is.size(); ++i)
        {
            if (!is[i].isWord() || is[i].wordToken() != "hex") continue;
            ++index;
            boundBox bounds;
            for (label k = 0; k < 8; ++k)
            {
                bounds.add(vertices[is[i + 2 + k].labelToken()]);
            }
            blocks_.push_back(block{index, bounds});
        }
    }
    catch (const Foam::error&)
    {
        blocks_.clear();
    }
    FatalIOError.throwExceptions(throwing);
}


Foam::labelList Foam::mpm::latticeDiagnosis::cellsFor
(
    const std::vector<scalar>& lengths,
    const scalar h
) const
{
    labelList n(lengths.size());
    forAll(n, i)
    {
        n[i] = std::lround(lengths[i]/h);
        if (n[i] < 1 || mag(lengths[i] - n[i]*h) > fitTolerance*lengths[i])
        {
            return labelList();
        }
    }
    return n;
}


std::string Foam::mpm::latticeDiagnosis::fewDigits() const
{
    if (!mesh_.nCells()) return std::string();

    vector least(vector::uniform(GREAT)), most(Zero), mean(Zero);
    for (label celli = 0; celli < mesh_.nCells(); ++celli)
    {
        const vector span
        (
            boundBox(mesh_.points(), mesh_.cellPoints()[celli], false).span()
        );
        least = min(least, span);
        most = max(most, span);
        mean += span/mesh_.nCells();
    }
    const boundBox bb(mesh_.points(), false);

    for (direction c = 0; c < 3; ++c)
    {
        const scalar extent = bb.span()[c];
        const scalar size = extent/max(1, std::lround(extent/mean[c]));
        const scalar deviation = max(most[c] - size, size - least[c]);
        if (deviation < 1e-6*size) continue;

        // Utilities write 6 digits by default, blockMesh 10. Planes may be
        // rounded apart, and the ends of the mesh a little.
        const scalar largest = max(mag(bb.min()[c]), mag(bb.max()[c]));
        const label k = digits(mesh_.points().component(c)());
        const scalar last = unit(largest, k);
        if (k < 6 || k > 12 || deviation > 1.5*last) continue;

        std::ostringstream os;
        os  << "\n    Only digits keep it from being uniform: along "
            << axisName[c] << ", at " << largest << " m, the " << k
            << " digits of the file are\n    steps of " << last
            << " m, " << 100*last/size << " % of a cell."
            << "\n    Set writeFormat binary in system/controlDict and make the"
            << " mesh again, or move the\n    origin of the coordinates near to"
            << " the mesh.";
        return os.str();
    }
    return std::string();
}


std::string Foam::mpm::latticeDiagnosis::sizes() const
{
    std::ostringstream os;
    for (direction c = 0; c < 3; ++c)
    {
        const std::vector<run>& runs = runs_[c];
        if (runs.size() < 2 && !runs[0].graded) continue;

        os << "\n    Along " << axisName[c] << ':';
        size_t listed = 0;
        for (const run& r : runs)
        {
            if (++listed > maxRuns)
            {
                os  << "\n        ... " << runs.size() - maxRuns
                    << " more, to " << runs.back().to;
                break;
            }
            os  << "\n        " << r.n << (r.n > 1 ? " cells" : " cell");
            if (r.graded) os << " of a size that grows or shrinks";
            else os << " of " << r.size();
            os  << " from " << r.from << " to " << r.to;

            // Half of the run or more lies in them
            std::ostringstream names;
            label n = 0;
            for (const block& b : blocks_)
            {
                const scalar in =
                    min(b.bounds.max()[c], r.to)
                  - max(b.bounds.min()[c], r.from);
                if (in < 0.5*r.length()) continue;
                names << ' ' << b.index;
                ++n;
            }
            if (n)
            {
                os  << " (edge " << axisName[c]
                    << (n > 1 ? " of blocks" : " of block") << names.str()
                    << " in blockMeshDict)";
            }
        }
    }
    return os.str();
}


std::string Foam::mpm::latticeDiagnosis::fit() const
{
    // All directions with one spacing, else each with its own. One cell alone
    // is an empty direction.
    std::vector<scalar> all, one[3];
    std::vector<scalar> used;
    for (direction c = 0; c < 3; ++c)
    {
        if (runs_[c].size() > maxRuns) return std::string();
        if (runs_[c].size() == 1 && runs_[c][0].n == 1) continue;
        for (const run& r : runs_[c])
        {
            all.push_back(r.length());
            one[c].push_back(r.length());
            used.insert(used.end(), r.n, r.size());
        }
    }
    if (all.empty()) return std::string();

    auto median = [](std::vector<scalar> v)
    {
        std::nth_element(v.begin(), v.begin() + v.size()/2, v.end());
        return v[v.size()/2];
    };

    // The nearest to a size, up to four times as fine or as coarse
    auto nearest = [&](const std::vector<scalar>& lengths, const scalar size)
    {
        for (scalar f = 1; f < 4; f *= 1.0005)
        {
            for (const scalar h : {size/f, size*f})
            {
                const labelList n(cellsFor(lengths, h));
                if (n.empty()) continue;

                // The mean of all, if it fits them as well
                scalar length = 0;
                for (const scalar l : lengths) length += l;
                const scalar mean = length/sum(n);
                return cellsFor(lengths, mean) == n ? mean : h;
            }
        }
        return scalar(0);
    };

    std::ostringstream os;
    auto describe = [&](const direction c, const scalar h)
    {
        os << ' ' << axisName[c] << " (";
        const labelList n(cellsFor(one[c], h));
        forAll(n, i) os << (i ? " " : "") << n[i];
        os << ')';
    };

    os.precision(4);
    const scalar h = nearest(all, median(used));
    if (h > 0)
    {
        os  << "\n    A spacing that fits all these lengths within 1 %: " << h
            << ", with the numbers of cells";
        for (direction c = 0; c < 3; ++c) if (one[c].size()) describe(c, h);
        os  << ".\n    Make the lengths whole multiples of it.";
        return os.str();
    }
    for (direction c = 0; c < 3; ++c)
    {
        // One run is uniform already
        if (one[c].size() < 2 && !runs_[c][0].graded) continue;
        std::vector<scalar> own;
        for (const run& r : runs_[c]) own.insert(own.end(), r.n, r.size());
        const scalar hc = nearest(one[c], median(own));
        if (!(hc > 0)) continue;
        os  << "\n    A spacing that fits all these lengths within 1 % along "
            << axisName[c] << ": " << hc << ", with the numbers of cells";
        describe(c, hc);
    }
    return os.str();
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::latticeDiagnosis::latticeDiagnosis(const polyMesh& mesh)
:
    mesh_(mesh)
{
    findPlanes();
    findRuns();
    readBlocks();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

std::string Foam::mpm::latticeDiagnosis::text() const
{
    const std::string digits(fewDigits());
    if (!digits.empty()) return digits;
    return planes_[0].empty() ? std::string() : sizes() + fit();
}


Foam::label Foam::mpm::latticeDiagnosis::digits(const UList<scalar>& values)
{
    label most = 1;
    for (const scalar x : values)
    {
        while (most < 16)
        {
            std::ostringstream os;
            os.precision(most);
            os << x;
            if (mag(std::stod(os.str()) - x) <= 4*SMALL*mag(x)) break;
            ++most;
        }
    }
    return most;
}


Foam::scalar Foam::mpm::latticeDiagnosis::unit
(
    const scalar largest,
    const label digits
)
{
    if (!(largest > 0)) return 0;
    return std::pow(10.0, std::floor(std::log10(largest)) + 1 - digits);
}

// ************************************************************************* //
