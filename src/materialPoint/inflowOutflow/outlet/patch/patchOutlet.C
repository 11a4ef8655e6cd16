/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "listed.H"
#include "patchOutlet.H"
#include "dictionaryEntries.H"
#include "volFields.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(patchOutlet, 0);
    addToRunTimeSelectionTable(outlet, patchOutlet, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::patchOutlet::patchOutlet
(
    const word& name,
    const dictionary& dict,
    const volVectorField& U,
    const bool strictKeywords
)
:
    outlet(name, dict),
    patchName_(dict.get<word>("patch")),
    patch_(-1),
    waterLevel_(-GREAT)
{
    checkKeywords(dict, {"type", "patch", "waterLevel"}, strictKeywords);

    DynamicList<word> openings;
    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        if (Up.type() == "zeroGradient" || Up.type() == "inletOutlet")
        {
            openings.append(Up.patch().name());
            if (Up.patch().name() == patchName_) patch_ = Up.patch().index();
        }
    }
    if (patch_ < 0)
    {
        FatalIOErrorInFunction(dict)
            << "keyword patch of outlet " << name << " is " << patchName_
            << ", which is no opening." << nl
            << "    Allowed: patches of type zeroGradient or inletOutlet in "
            << U.name() << ": " << listed(openings) << exit(FatalIOError);
    }
    if (dict.found("waterLevel"))
    {
        waterLevel_ =
            readBounded(dict, "waterLevel", dimLength, -GREAT, GREAT);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::string Foam::mpm::patchOutlet::description() const
{
    string s("patch " + patchName_);
    if (waterLevel_ > -GREAT)
    {
        s += ", water level " + Foam::name(waterLevel_) + " m";
    }
    return s;
}

// ************************************************************************* //
