/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "cellZoneRegion.H"
#include "dictionaryEntries.H"
#include "listed.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(cellZoneRegion, 0);
    addToRunTimeSelectionTable(pointRegion, cellZoneRegion, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::cellZoneRegion::cellZoneRegion
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    pointRegion(mesh, dict),
    inZone_(mesh.nCells()),
    bounds_(boundBox::invertedBox)
{
    checkKeywords(dict, keywords({"zone"}), strictKeywords);

    const word zone(dict.get<word>("zone"));
    const label zonei = mesh.cellZones().findZoneID(zone);
    if (zonei < 0)
    {
        FatalIOErrorInFunction(dict)
            << "keyword zone: there is no cellZone " << zone << nl
            << "    Allowed, zones of the mesh: "
            << listed(mesh.cellZones().names())
            << exit(FatalIOError);
    }
    inZone_.set(mesh.cellZones()[zonei]);
    for (const label celli : inZone_)
    {
        bounds_.add(mesh.points(), mesh.cellPoints()[celli]);
    }
    bounds_.reduce();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::cellZoneRegion::contains
(
    const point& x,
    const label celli
) const
{
    return celli >= 0 && inZone_.test(celli);
}


Foam::boundBox Foam::mpm::cellZoneRegion::bounds() const
{
    return bounds_;
}

// ************************************************************************* //
