/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "frontPosition.H"
#include "dictionaryEntries.H"
#include "PstreamReduceOps.H"
#include "syncTools.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"
#include <limits>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(frontPosition, 0);
    addToRunTimeSelectionTable(functionObject, frontPosition, dictionary);

    static const functionNeeds::add needsOfFrontPosition
    (
        "frontPosition", functionNeeds::NO_FIELDS
    );
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::boolList Foam::mpm::frontPosition::filledCells() const
{
    const materialPointCloud& points = cloud();
    const backgroundGrid& grid = points.grid();

    scalarField volume(mesh_.nCells(), Zero);
    for (label p = 0; p < points.size(); ++p)
    {
        volume[grid.meshCell(points.points().cell()[p])] += points.volume(p);
    }

    // Each cell and its face neighbours, all of one size
    scalarField sum(volume);
    labelList number(mesh_.nCells(), label(1));
    auto add = [&](const label celli, const scalar neighbour)
    {
        sum[celli] += neighbour;
        ++number[celli];
    };

    const labelUList& owner = mesh_.faceOwner();
    const labelUList& neighbour = mesh_.faceNeighbour();
    forAll(neighbour, facei)
    {
        add(owner[facei], volume[neighbour[facei]]);
        add(neighbour[facei], volume[owner[facei]]);
    }

    // Across ranks and cyclic patches
    scalarList beyond;
    syncTools::swapBoundaryCellList(mesh_, volume, beyond);
    for (const polyPatch& pp : mesh_.boundaryMesh())
    {
        if (!pp.coupled()) continue;
        forAll(pp, i)
        {
            const label facei = pp.start() - mesh_.nInternalFaces() + i;
            add(pp.faceCells()[i], beyond[facei]);
        }
    }

    boolList filled(mesh_.nCells());
    forAll(filled, celli)
    {
        filled[celli] =
            sum[celli]
         >= minFraction_*number[celli]*grid.cells().cellVolume();
    }
    return filled;
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::frontPosition::keywords() const
{
    return wordList({"direction", "minFraction"});
}


void Foam::mpm::frontPosition::readEntries(const dictionary& dict)
{
    direction_ = dict.get<vector>("direction");

    const lattice& cells = cloud().grid().cells();
    vector solved(direction_);
    if (cells.nDim() == 2) solved[cells.axis(2)] = 0;

    if (mag(direction_) < VSMALL || mag(solved) < (1 - 1e-6)*mag(direction_))
    {
        FatalIOErrorInFunction(dict)
            << "keyword direction is " << direction_ << '.' << nl
            << "    Allowed: a vector that is not zero";
        if (cells.nDim() == 2)
        {
            FatalIOError
                << " and has no component in the empty direction "
                << vector::componentNames[cells.axis(2)];
        }
        FatalIOError<< exit(FatalIOError);
    }
    direction_ = solved/mag(solved);

    minFraction_ =
        readBoundedOrDefault(dict, "minFraction", dimless, 0.1, 0, 1);
}


Foam::stringList Foam::mpm::frontPosition::description() const
{
    OStringStream line;
    line<< "Coordinate along " << direction_ << " [m] of the farthest point,"
        << " and of the farthest in cells filled to " << minFraction_;
    return stringList({line.str()});
}


Foam::wordList Foam::mpm::frontPosition::columns() const
{
    return wordList({"max", "front"});
}


Foam::scalarList Foam::mpm::frontPosition::values() const
{
    const materialPointCloud& points = cloud();
    const backgroundGrid& grid = points.grid();
    const boolList filled(filledCells());

    scalarList reach(2, -GREAT);
    for (label p = 0; p < points.size(); ++p)
    {
        scalar s = 0;
        for (label d = 0; d < grid.nDim(); ++d)
        {
            s += direction_[grid.cells().axis(d)]*points.x(d)[p];
        }
        reach[0] = max(reach[0], s);
        if (filled[grid.meshCell(points.points().cell()[p])])
        {
            reach[1] = max(reach[1], s);
        }
    }
    Pstream::listCombineGather(reach, maxEqOp<scalar>());

    for (scalar& s : reach)
    {
        if (s <= -GREAT) s = std::numeric_limits<scalar>::quiet_NaN();
    }
    return reach;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::frontPosition::frontPosition
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    cloudTimeSeries(name, runTime, dict, "front"),
    direction_(Zero),
    minFraction_(0)
{
    start(dict);
}

// ************************************************************************* //
