/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterPlacement.H"
#include "initialPressure.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::waterPlacement::findSoundSpeed
(
    const UPtrList<soilPlacement>& solids
)
{
    scalar surface = -GREAT, landing = GREAT;
    for (const placedRegions::placed& r : regions_)
    {
        surface = max(surface, r.level);
        landing = min(landing, r.level);
    }
    DynamicList<materialPointCloud*> moving;
    for (const soilPlacement& s : solids)
    {
        if (!s.soil().model().held()) moving.append(&s.soil());
    }
    water_.findSoundSpeed(surface, landing, moving);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::waterPlacement::waterPlacement
(
    waterCloud& water,
    const dictionary& dict,
    const vector& gravity,
    const bool strictKeywords
)
:
    water_(water),
    regions_
    (
        water,
        dict,
        mag(gravity) > 0 ? -gravity/mag(gravity) : vector(Zero),
        {"voidRatio", "stress", "sigma", "K0", "saturated"},
        strictKeywords
    ),
    g_(mag(gravity))
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::waterPlacement::setState
(
    const UPtrList<soilPlacement>& solids
)
{
    findSoundSpeed(solids);

    const vector& up = regions_.up();
    scalar top = -GREAT, bottom = GREAT;
    for (const point& x : water_.grid().mesh().points())
    {
        top = max(top, up & x);
        bottom = min(bottom, up & x);
    }
    reduce(top, maxOp<scalar>());
    reduce(bottom, minOp<scalar>());

    for (const placedRegions::placed& r : regions_)
    {
        const autoPtr<initialPressure> start
        (
            initialPressure::New
            (
                r.dict,
                initialPressure::scene{water_, r.level, top, bottom, g_, up}
            )
        );
        scalarField p(r.size());
        scalarField V(regions_.pointVolumes(r));
        forAll(p, i)
        {
            const point x(water_.position(r.first + i));
            p[i] = start->pressure(x);
            // Regions may overlap where no point of soil is
            const label cell = water_.points().cell()[r.first + i];
            for (const soilPlacement& s : solids)
            {
                V[i] *= s.porosity(x, water_.grid().meshCell(cell));
            }
        }
        water_.setState(r.first, V, p);
        forAll(p, i)
        {
            if (start->carriesWeight() && p[i] > 0)
            {
                water_.setAtRest(r.first + i, -g_*up);
            }
        }
    }
}

// ************************************************************************* //
