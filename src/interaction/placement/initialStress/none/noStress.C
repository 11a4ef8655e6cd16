/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "noStress.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(noStress, 0);
    addToRunTimeSelectionTable(initialStress, noStress, dictionary);
}
}


// ************************************************************************* //
