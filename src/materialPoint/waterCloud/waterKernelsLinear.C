/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    Water kernels with the shape function linear; a file of its own so that
    the variants compile side by side.
\*---------------------------------------------------------------------------*/

#include "waterKernelsTemplates.C"

template Foam::autoPtr<Foam::mpm::cloudKernels>
Foam::mpm::newWaterKernels<Foam::mpm::linear>
(
    waterCloud&,
    const waterVariant&
);

// ************************************************************************* //
