/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "pointSelection.H"
#include "dictionaryEntries.H"
#include "materialPointCloud.H"
#include <cmath>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::pointSelection::pointSelection
(
    const polyMesh& mesh,
    const dictionary& dict,
    const bool strictKeywords
)
:
    every_(readIntegerOrDefault(dict, "every", 1, 1, labelMax))
{
    if (dict.found("within"))
    {
        region_ = pointRegion::New
        (
            mesh, dict.subDict("within"), strictKeywords
        );
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::wordList Foam::mpm::pointSelection::keywords()
{
    return wordList({"every", "within"});
}


Foam::labelList Foam::mpm::pointSelection::points
(
    const materialPointCloud& cloud
) const
{
    const scalar* id = nullptr;
    for (const pointStorage::field& f : cloud.points().fields())
    {
        if (f.name == "id") id = cloud.points().column(f.first);
    }

    DynamicList<label> chosen(cloud.size()/every_ + 1);
    for (label p = 0; p < cloud.size(); ++p)
    {
        if (every_ > 1 && std::fmod(id[p], scalar(every_)) != 0) continue;
        if
        (
            region_.valid()
         && !region_->contains
            (
                cloud.position(p),
                cloud.grid().meshCell(cloud.points().cell()[p])
            )
        )
        {
            continue;
        }
        chosen.append(p);
    }
    return labelList(std::move(chosen));
}

// ************************************************************************* //
