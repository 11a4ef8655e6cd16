/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waveGauge.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(waveGauge, 0);
    addToRunTimeSelectionTable(functionObject, waveGauge, dictionary);

    static const functionNeeds::add needsOfWaveGauge
    (
        "waveGauge", functionNeeds::NO_FIELDS
    );
}
}

// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::waveGauge::keywords() const
{
    return wordList({"points"});
}


void Foam::mpm::waveGauge::readEntries(const dictionary& dict)
{
    locations_ = dict.get<pointField>("points");

    const backgroundGrid& grid = cloud().grid();
    bool upward = true;
    weights_.reset
    (
        new gaugeWeights(grid, findVertical(dict, upward), locations_)
    );
    volume_.reset(new gridVolume(cloud()));
    area_ = weights_->nColumns()*weights_->columnArea();

    const boolList inside(weights_->inDomain());
    forAll(inside, i)
    {
        if (!inside[i])
        {
            FatalIOErrorInFunction(dict)
                << "keyword points: no cell lies above or below location "
                << i << ", " << locations_[i] << '.' << nl
                << "    The mesh extends over " << mesh_.bounds()
                << exit(FatalIOError);
        }
    }
}


Foam::stringList Foam::mpm::waveGauge::description() const
{
    stringList lines(locations_.size() + 1);
    lines[0] = "Heights of the column at the locations, and mean level [m]";
    forAll(locations_, i)
    {
        OStringStream line;
        line<< "  height" << i << " at " << locations_[i];
        lines[i + 1] = line.str();
    }
    return lines;
}


Foam::wordList Foam::mpm::waveGauge::columns() const
{
    wordList names(locations_.size() + 1);
    forAll(locations_, i) names[i] = "height" + Foam::name(i);
    names.last() = "meanLevel";
    return names;
}


Foam::scalarList Foam::mpm::waveGauge::values() const
{
    const materialPointCloud& points = cloud();
    scalarList levels(locations_.size() + 1, Zero);

    FixedList<scalar, 3> x(Zero);
    for (label p = 0; p < points.size(); ++p)
    {
        for (label d = 0; d < points.grid().nDim(); ++d) x[d] = points.x(d)[p];
        weights_->add(x, points.points().cell()[p], points.volume(p), levels);
    }
    levels.last() = volume_->sum()/area_;

    sumToMaster(levels);
    return levels;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::waveGauge::waveGauge
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudTimeSeries(name, runTime, dict, "waveGauge"),
    area_(0)
{
    start(dict);
}

// ************************************************************************* //
