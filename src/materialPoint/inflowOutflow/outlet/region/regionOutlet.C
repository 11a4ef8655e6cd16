/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "regionOutlet.H"
#include "dictionaryEntries.H"
#include "volFields.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(regionOutlet, 0);
    addToRunTimeSelectionTable(outlet, regionOutlet, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::regionOutlet::regionOutlet
(
    const word& name,
    const dictionary& dict,
    const volVectorField& U,
    const bool strictKeywords
)
:
    outlet(name, dict),
    region_
    (
        pointRegion::New(U.mesh(), subDictOf(dict, "region"), strictKeywords)
    )
{
    checkKeywords(dict, {"type", "region"}, strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::string Foam::mpm::regionOutlet::description() const
{
    return "region of type " + region_->type();
}


bool Foam::mpm::regionOutlet::overlaps(const boundBox& box) const
{
    return region_->bounds().overlaps(box);
}


bool Foam::mpm::regionOutlet::contains(const point& x, const label celli) const
{
    return region_->contains(x, celli);
}

// ************************************************************************* //
