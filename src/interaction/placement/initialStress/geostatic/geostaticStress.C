/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "geostaticStress.H"
#include "cellZoneRegion.H"
#include "dictionaryEntries.H"
#include "unitConversion.H"
#include "PstreamReduceOps.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(geostaticStress, 0);
    addToRunTimeSelectionTable(initialStress, geostaticStress, dictionary);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::geostaticStress::check(const scalar weight) const
{
    if (weight <= 0)
    {
        FatalIOErrorInFunction(dict_)
            << "keyword stress of region " << dict_.dictName()
            << " is geostatic, but the grains are lighter than the"
            << " water: rhoS " << placement_.soil().model().rhoS() << ", rho0 "
            << placement_.water()->fluid().rho0() << " kg/m3." << nl
            << "    Allowed: none, uniform, or heavier grains"
            << exit(FatalIOError);
    }
    if (dict_.found("level") || !Pstream::parRun()) return;

    for (const soilPlacement& s : placement_.solids())
    {
        for (const placedRegions::placed& r : s.regions())
        {
            if (!isA<cellZoneRegion>(*r.region)) continue;

            FatalIOErrorInFunction(dict_)
                << "keyword stress is geostatic, and a region is a cellZone:"
                << " its cells that lie above may be on another rank." << nl
                << "    Allowed: give the level of the surface, or run"
                << " setMaterialPoints before decomposePar"
                << exit(FatalIOError);
        }
    }
}


Foam::vector Foam::mpm::geostaticStress::normal() const
{
    const lattice& cells = placement_.regions().cells();
    const vector& up = placement_.regions().up();

    vector normal(Zero);
    for (label d = 0; d < cells.nDim(); ++d)
    {
        vector axis(Zero);
        axis[cells.axis(d)] = sign(up[cells.axis(d)]);
        if ((axis & up) > (normal & up)) normal = axis;
    }
    return normal;
}


bool Foam::mpm::geostaticStress::endless
(
    const placedRegions::placed& r,
    const vector& normal
) const
{
    const lattice& cells = placement_.regions().cells();
    const vector& up = placement_.regions().up();
    const boundBox& domain = placement_.domain();

    bool endless = true;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const label a = cells.axis(d);
        if (normal[a] != 0 || mag(up[a]) <= 1e-3) continue;

        scalar first = GREAT, last = -GREAT;
        for (label p = r.first; p < r.last; ++p)
        {
            const scalar x = placement_.soil().position(p)[a];
            first = min(first, x);
            last = max(last, x);
        }
        reduce(first, minOp<scalar>());
        reduce(last, maxOp<scalar>());
        endless = endless
         && first < domain.min()[a] + cells.spacing(d)
         && last > domain.max()[a] - cells.spacing(d);
    }
    return endless;
}


Foam::scalar Foam::mpm::geostaticStress::step(const vector& direction) const
{
    const lattice& cells = placement_.regions().cells();
    scalar step = GREAT;
    for (label d = 0; d < cells.nDim(); ++d)
    {
        const scalar part = mag(direction[cells.axis(d)]);
        if (part > SMALL) step = min(step, cells.spacing(d)/part);
    }
    return step/(8*placement_.regions().nPerDirection());
}


Foam::mpm::geostaticStress::cover Foam::mpm::geostaticStress::findCover
(
    const placedRegions::placed& r,
    const vector& direction
) const
{
    const scalar length = step(direction);

    cover above{scalarField(r.size()), -GREAT, GREAT, false};
    forAll(above.weight, i)
    {
        const point x(placement_.soil().position(r.first + i));
        scalar weight = 0, top = direction & x;
        for
        (
            point y = x + 0.5*length*direction;
            placement_.domain().contains(y);
            y += length*direction
        )
        {
            scalar here;
            if (!placement_.weightAt(y, here)) continue;

            weight += here*length;
            top = (direction & y) + 0.5*length;
        }
        above.weight[i] = weight;
        above.highest = max(above.highest, top);
        above.lowest = min(above.lowest, top);
    }
    reduce(above.highest, maxOp<scalar>());
    reduce(above.lowest, minOp<scalar>());

    // To half of the distance of points
    above.plane = above.highest - above.lowest < 4.5*length;
    return above;
}


Foam::symmTensor Foam::mpm::geostaticStress::levelStress() const
{
    const vector& up = placement_.regions().up();
    return -(sqr(up) + K0_*(symmTensor::I - sqr(up)));
}


// What is above a plane along the slope is carried by the normal and the shear
// stress on it. Along the slope the grains press as at rest, or as hard as a
// steep slope needs to stand: their mobilised friction is that of K0 or that of
// the slope (the circle of Mohr, with t the shear over the normal stress:
// (1 - K)^2 + 4 t^2 = m^2 (1 + K)^2).
Foam::symmTensor Foam::mpm::geostaticStress::slopeStress
(
    const vector& normal
) const
{
    const vector& up = placement_.regions().up();
    const scalar cosine = up & normal;
    const vector along(up - cosine*normal);
    const scalar t = mag(along)/cosine;
    const scalar m = max(mag(1 - K0_)/(1 + K0_), mag(along));
    const scalar root =
        2*std::sqrt(max(scalar(0), sqr(m) - sqr(t)*(1 - sqr(m))));
    const scalar K =
        K0_ > 1
      ? (1 + sqr(m) + root)/(1 - sqr(m))
      : (1 - sqr(m) + 4*sqr(t))/(1 + sqr(m) + root);

    return
       -cosine*(sqr(normal) + K*(symmTensor::I - sqr(normal)))
      - twoSymm(normal*along);
}


Foam::symmTensorField Foam::mpm::geostaticStress::ofLevel
(
    const placedRegions::placed& r
) const
{
    const placedRegions& regions = placement_.regions();
    const scalar weight = placement_.weights()[r.index];
    const symmTensor direction(levelStress());

    symmTensorField sigma(r.size());
    forAll(sigma, i)
    {
        const point x(placement_.soil().position(r.first + i));
        const scalar depth = max(scalar(0), r.level - (regions.up() & x));
        sigma[i] = weight*depth*direction;
    }
    return sigma;
}


Foam::symmTensorField Foam::mpm::geostaticStress::ofSurface
(
    const placedRegions::placed& r
) const
{
    const vector& up = placement_.regions().up();
    const vector across(normal());
    const scalar angle = std::acos(min(scalar(1), across & up));
    const bool inclined = angle > 1e-3;
    const bool wide = endless(r, across);

    const char* shear = "no shear stress, horizontal stress K0 times the weight"
        " of what is above";
    Info<< "    stress geostatic: ";
    if (inclined)
    {
        const cover above(findCover(r, across));
        if (above.plane && wide)
        {
            const symmTensor stress(slopeStress(across));
            const scalar most =
                returnReduce(max(above.weight), maxOp<scalar>());
            const scalar e = placement_.voidRatio(r.dict);
            if (placement_.refusal(e, most*stress).empty())
            {
                Info<< "equilibrium of an endless slope of " << radToDeg(angle)
                    << " degrees along the mesh" << endl;
                return above.weight*stress;
            }
            Info<< "--> a slope of " << radToDeg(angle)
                << " degrees along the mesh"
                << " is steeper than the soil stands;";
        }
        else
        {
            Info<< "--> gravity is inclined by " << radToDeg(angle)
                << " degrees, and the soil "
                << (
                       above.plane
                     ? "ends within the mesh;" : "has no surface along it;"
                   );
        }
    }

    const cover above(findCover(r, up));
    if (!inclined && above.plane)
    {
        Info<< "level ground" << endl;
        return above.weight*levelStress();
    }
    if (!inclined)
    {
        Info<< "--> the surface of the soil above is between " << above.lowest
            << " and " << above.highest << " m;";
    }
    Info<< nl << "        assumed as below level ground: " << shear << "." << nl
        << "        The soil moves until it has found its equilibrium" << endl;
    return above.weight*levelStress();
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::geostaticStress::geostaticStress
(
    const dictionary& dict,
    const soilPlacement& placement
)
:
    initialStress(dict, placement),
    K0_
    (
        readBoundedOrDefault
        (
            dict, "K0", dimless, placement.soil().model().K0(), 0, GREAT, true
        )
    )
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::symmTensorField Foam::mpm::geostaticStress::stress
(
    const placedRegions::placed& region
) const
{
    if (!(placement_.g() > 0)) return symmTensorField(region.size(), Zero);

    check(placement_.weights()[region.index]);
    return dict_.found("level") ? ofLevel(region) : ofSurface(region);
}

// ************************************************************************* //
