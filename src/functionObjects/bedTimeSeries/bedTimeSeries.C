/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bedTimeSeries.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "waterCloud.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::label Foam::mpm::bedTimeSeries::findDirection
(
    const dictionary& dict,
    const label vertical
) const
{
    const vector direction
    (
        dict.lookupOrDefault<vector>("direction", vector(1, 0, 0))
    );
    const lattice& cells = cloud().grid().cells();

    DynamicList<vector> allowed;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        if (d == vertical) continue;

        vector axis(Zero);
        axis[cells.axis(d)] = 1;
        if (mag(direction & axis) > (1 - 1e-6)*mag(direction) + VSMALL)
        {
            return d;
        }
        allowed.append(axis);
    }
    FatalIOErrorInFunction(dict)
        << "keyword direction is " << direction << '.' << nl
        << "    Allowed: a horizontal direction of the mesh, one of "
        << listed(allowed) << exit(FatalIOError);
    return -1;
}


void Foam::mpm::bedTimeSeries::readBedFraction(const dictionary& dict)
{
    const soilCloud* soil = dynamic_cast<const soilCloud*>(&cloud());
    if (!soil)
    {
        FatalIOErrorInFunction(dict)
            << "keyword cloud is " << cloud().name() << '.' << nl
            << "    Allowed for " << type() << ": a solid, one of "
            << listed(mesh_.sortedNames<soilCloud>())
            << exit(FatalIOError);
    }
    bedFraction_ = readBoundedOrDefault
    (
        dict, "bedFraction", dimless, 1/(1 + soil->model().e0()), 0, 1
    );
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::bedTimeSeries::keywords() const
{
    return wordList({"water", "direction", "bedFraction"});
}


void Foam::mpm::bedTimeSeries::readEntries(const dictionary& dict)
{
    readBedFraction(dict);
    const wordList liquids(mesh_.sortedNames<waterCloud>());
    waterName_ = dict.lookupOrDefault<word>
    (
        "water", liquids.empty() ? word::null : liquids[0]
    );
    if (dict.found("water") && !mesh_.foundObject<waterCloud>(waterName_))
    {
        FatalIOErrorInFunction(dict)
            << "keyword water is " << waterName_ << '.' << nl
            << "    Allowed for " << type() << ": a liquid, one of "
            << listed(liquids) << exit(FatalIOError);
    }

    bool upward = true;
    vertical_ = findVertical(dict, upward);
    along_ = findDirection(dict, vertical_);
    surfaces_.reset
    (
        new columnSurfaces(cloud().grid(), along_, vertical_, upward)
    );
}


const Foam::mpm::soilCloud& Foam::mpm::bedTimeSeries::soil() const
{
    // Checked when the entries were read
    return static_cast<const soilCloud&>(cloud());
}


Foam::mpm::columnSurfaces::heights Foam::mpm::bedTimeSeries::find() const
{
    auto alpha = [&](const word& cloudName)
    {
        return mesh_.findObject<volScalarField>
        (
            IOobject::groupName("alpha", cloudName)
        );
    };
    // The bed is of all solids
    tmp<volScalarField> bed(*alpha(cloud().name()));
    for (const word& solid : mesh_.sortedNames<soilCloud>())
    {
        if (solid != cloud().name()) bed = bed + *alpha(solid);
    }
    return surfaces_->find(bed(), alpha(waterName_), bedFraction_);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bedTimeSeries::bedTimeSeries
(
    const word& name,
    const Time& runTime,
    const dictionary& dict,
    const word& file
)
:
    cloudTimeSeries(name, runTime, dict, file),
    vertical_(-1),
    along_(-1),
    bedFraction_(0)
{}

// ************************************************************************* //
