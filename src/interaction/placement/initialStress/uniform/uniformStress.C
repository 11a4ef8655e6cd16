/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "uniformStress.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(uniformStress, 0);
    addToRunTimeSelectionTable(initialStress, uniformStress, dictionary);
}
}

// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::symmTensorField Foam::mpm::uniformStress::stress
(
    const placedRegions::placed& region
) const
{
    const symmTensor given(dict_.get<symmTensor>("sigma"));
    const string reason
    (
        placement_.refusal(placement_.voidRatio(dict_), given)
    );
    if (!reason.empty())
    {
        FatalIOErrorInFunction(dict_)
            << "keyword sigma of region " << dict_.dictName() << " is "
            << given << '.' << nl << "    " << reason.c_str()
            << exit(FatalIOError);
    }
    return symmTensorField(region.size(), given);
}

// ************************************************************************* //
