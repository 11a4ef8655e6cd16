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
    extern template autoPtr<waterKernels> newWaterKernels<linear>
        (waterCloud&, const waterKernels::variant&);
    extern template autoPtr<waterKernels> newWaterKernels<quadraticBSpline>
        (waterCloud&, const waterKernels::variant&);
    extern template autoPtr<waterKernels> newWaterKernels<cubicBSpline>
        (waterCloud&, const waterKernels::variant&);
}
}

// * * * * * * * * * * * * * * * * Selector  * * * * * * * * * * * * * * * * //

Foam::autoPtr<Foam::mpm::waterKernels> Foam::mpm::waterKernels::New
(
    waterCloud& cloud,
    const variant& v
)
{
    const word& shape = cloud.grid().shapeFunction();

    if (shape == linear::name) return newWaterKernels<linear>(cloud, v);
    if (shape == cubicBSpline::name) return newWaterKernels<cubicBSpline>(cloud, v);
    return newWaterKernels<quadraticBSpline>(cloud, v);
}

// ************************************************************************* //
