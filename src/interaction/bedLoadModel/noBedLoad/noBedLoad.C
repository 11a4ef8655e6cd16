/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "noBedLoad.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(noBedLoad, 0);
    addToRunTimeSelectionTable(bedLoadModel, noBedLoad, dictionary);
}
}

// ************************************************************************* //
