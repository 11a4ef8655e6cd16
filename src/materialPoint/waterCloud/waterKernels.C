/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterKernels.H"
#include "waterCloud.H"

namespace Foam
{
namespace mpm
{
    extern template autoPtr<cloudKernels> newWaterKernels<linear>
        (waterCloud&, const waterVariant&);
    extern template autoPtr<cloudKernels> newWaterKernels<quadraticBSpline>
        (waterCloud&, const waterVariant&);
    extern template autoPtr<cloudKernels> newWaterKernels<cubicBSpline>
        (waterCloud&, const waterVariant&);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::cloudKernels> Foam::mpm::newWaterKernels
(
    waterCloud& cloud,
    const waterVariant& v
)
{
    const word& shape = cloud.grid().shapeFunction();

    if (shape == linear::name) return newWaterKernels<linear>(cloud, v);
    if (shape == cubicBSpline::name) return newWaterKernels<cubicBSpline>(cloud, v);
    return newWaterKernels<quadraticBSpline>(cloud, v);
}

// ************************************************************************* //
