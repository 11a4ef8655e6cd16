/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "scourProfile.H"
#include "OSspecific.H"
#include "PstreamReduceOps.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"
#include <limits>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(scourProfile, 0);
    addToRunTimeSelectionTable(functionObject, scourProfile, dictionary);

    static const functionNeeds::add needsOfScourProfile
    (
        "scourProfile", functionNeeds::WRITE_TIMES
    );
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::scourProfile::readReservoir(const dictionary& dict)
{
    reservoir_ = Tuple2<scalar, scalar>(GREAT, -GREAT);
    if (!dict.found("reservoir")) return;

    reservoir_ = dict.get<Tuple2<scalar, scalar>>("reservoir");
    for (label s = 0; s < surfaces().nStations(); ++s)
    {
        const scalar x = surfaces().coordinate(s);
        if (x >= reservoir_.first() && x <= reservoir_.second()) return;
    }
    FatalIOErrorInFunction(dict)
        << "keyword reservoir is " << reservoir_
        << ": no column of cells lies between." << nl
        << "    Allowed: two coordinates, first < last, between "
        << surfaces().coordinate(0) << " and "
        << surfaces().coordinate(surfaces().nStations() - 1)
        << exit(FatalIOError);
}


void Foam::mpm::scourProfile::findInitial()
{
    const word property("initialBed");

    if (foundProperty(property))
    {
        getProperty(property, initial_);
    }
    if (initial_.size() != surfaces().nColumns())
    {
        if (cloud().stepCount())
        {
            WarningInFunction
                << "function object " << name() << ": the bed of an earlier"
                << " start is not in " << mesh_.time().timePath()
                << "/uniform/functionObjects. Scour counts from time "
                << mesh_.time().timeName() << '.' << endl;
        }
        initial_ = find().bed;

        // An entry of a dictionary has no words for not a number
        for (scalar& z : initial_)
        {
            if (std::isnan(z)) z = -GREAT;
        }
    }
    setProperty(property, initial_);
}


Foam::scalar Foam::mpm::scourProfile::suspendedFraction
(
    const scalarField& bed
) const
{
    const materialPointCloud& soil = cloud();
    const scalar h = soil.grid().cells().spacing(vertical());

    scalar above = 0, all = 0;
    for (label p = 0; p < soil.size(); ++p)
    {
        const scalar z = surfaces().heightOf(soil.x(vertical())[p]);
        const scalar m = soil.mass()[p];
        all += m;
        if (z > bed[surfaces().column(soil.points().cell()[p])] + h) above += m;
    }
    reduce(above, sumOp<scalar>());
    reduce(all, sumOp<scalar>());
    return all > 0 ? above/all : 0;
}


Foam::scalar Foam::mpm::scourProfile::reservoirLevel
(
    const scalarField& water
) const
{
    scalar sum = 0;
    label n = 0;
    forAll(water, c)
    {
        const scalar x = surfaces().coordinate(surfaces().station(c));
        if
        (
            x >= reservoir_.first() && x <= reservoir_.second()
         && !std::isnan(water[c])
        )
        {
            sum += water[c];
            ++n;
        }
    }
    return n ? sum/n : std::numeric_limits<scalar>::quiet_NaN();
}


void Foam::mpm::scourProfile::writeProfile() const
{
    const columnSurfaces::heights h(find());
    if (!writeToFile() || !Pstream::master()) return;

    const label n = surfaces().nStations();
    auto mean = [&](const scalarField& z, const label station)
    {
        scalar sum = 0;
        label number = 0;
        for (label c = station; c < z.size(); c += n)
        {
            if (std::isnan(z[c])) continue;
            sum += z[c];
            ++number;
        }
        return number ? sum/number : std::numeric_limits<scalar>::quiet_NaN();
    };

    const fileName directory(baseFileDir()/prefix_/mesh_.time().timeName());
    mkDir(directory);
    OFstream os(directory/"profile.csv");
    initStream(os);
    os  << "x,bed,water" << nl;
    for (label s = 0; s < n; ++s)
    {
        os  << surfaces().coordinate(s) << ',' << mean(h.bed, s) << ','
            << mean(h.water, s) << nl;
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::scourProfile::keywords() const
{
    wordList names(bedTimeSeries::keywords());
    names.append("reservoir");
    return names;
}


void Foam::mpm::scourProfile::readEntries(const dictionary& dict)
{
    bedTimeSeries::readEntries(dict);
    readReservoir(dict);

    // Not again when controlDict is read again
    if (initial_.empty()) findInitial();
}


Foam::stringList Foam::mpm::scourProfile::description() const
{
    return stringList
    ({
        "Change of the bed since the first start: lengths [m], volumes "
      + string(cloud().grid().nDim() == 2 ? "per width [m2]" : "[m3]"),
        "Part of the grains more than a cell above the bed [-]; level of the"
        " reservoir [m]; mean stress on the bed [Pa], the layer that it can"
        " move [m], the same in cells [-]"
    });
}


Foam::wordList Foam::mpm::scourProfile::columns() const
{
    wordList names
    ({
        "scourDepth", "scourPosition", "duneHeight", "dunePosition",
        "erodedVolume", "depositedVolume", "suspendedFraction"
    });
    if (reservoir_.first() <= reservoir_.second())
    {
        names.append("reservoirLevel");
    }
    soilCloud::bedState bed;
    if (soil().bed(bed))
    {
        names.append
        (
            wordList({"bedStress", "movableLayer", "movableCells"})
        );
    }
    return names;
}


Foam::scalarList Foam::mpm::scourProfile::values() const
{
    const columnSurfaces::heights h(find());
    const scalar nan = std::numeric_limits<scalar>::quiet_NaN();

    scalarList v({0, nan, 0, nan, 0, 0, 0});
    forAll(h.bed, c)
    {
        if (std::isnan(h.bed[c])) continue;

        const scalar rise = h.bed[c] - initial_[c];
        const scalar x = surfaces().coordinate(surfaces().station(c));
        if (-rise > v[0])
        {
            v[0] = -rise;
            v[1] = x;
        }
        if (rise > v[2])
        {
            v[2] = rise;
            v[3] = x;
        }
        v[4] += max(scalar(0), -rise)*surfaces().area();
        v[5] += max(scalar(0), rise)*surfaces().area();
    }
    v[6] = suspendedFraction(h.bed);

    if (reservoir_.first() <= reservoir_.second())
    {
        v.append(reservoirLevel(h.water));
    }
    soilCloud::bedState bed;
    if (soil().bed(bed))
    {
        const scalar spacing = cloud().grid().cells().spacing(vertical());
        v.append
        (
            scalarList({bed.stress, bed.movable, bed.movable/spacing})
        );
    }
    return v;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::scourProfile::scourProfile
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    bedTimeSeries(name, runTime, dict, "scourProfile"),
    reservoir_(GREAT, -GREAT)
{
    start(dict);
    writeProfile();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::scourProfile::execute()
{
    if (mesh_.time().writeTime()) writeProfile();
    return true;
}

// ************************************************************************* //
