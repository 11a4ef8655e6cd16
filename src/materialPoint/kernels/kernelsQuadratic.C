/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    Kernels of all clouds with the shape function quadraticBSpline; a file of
    its own so that the shape functions compile side by side.
\*---------------------------------------------------------------------------*/

#include "waterKernelsTemplates.C"
#include "soilKernelsTemplates.C"

namespace Foam
{
namespace mpm
{
    template autoPtr<cloudKernels>
    newWaterKernels<quadraticBSpline>(waterCloud&);

    template autoPtr<cloudKernels>
    newSoilKernels<quadraticBSpline>(soilCloud&);
}
}

// ************************************************************************* //
