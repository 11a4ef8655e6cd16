/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "linearExchange.H"
#include "addToRunTimeSelectionTable.H"
#include "dictionaryEntries.H"
#include "effectsTable.H"
#include "soilCloud.H"
#include "waterCloud.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(linearExchange, 0);
    addToRunTimeSelectionTable(phasePair, linearExchange, dictionary);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::linearExchange::linearExchange
(
    const dictionary& dict,
    const phases& all
)
:
    liquid_(all.liquid),
    skeleton_(*all.solids[0]),
    coefficient_
    (
        readPositive(dict, "coefficient", dimDensity/dimTime)
    )
{
    checkKeywords(dict, {"coefficient"}, all.strictKeywords);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::linearExchange::exchangeMomentum(const scalar deltaT)
{
    nodalFields& liquid = liquid_.nodes();
    nodalFields& solids = skeleton_.nodes();
    const std::vector<scalar>& perVolume = liquid_.boundary().inverseVolume();

    for (const auto& range : skeleton_.nodeRanges())
    {
        for (label i = range.first; i < range.second; ++i)
        {
            const scalar mLiquid = liquid.mass(i), mSolids = solids.mass(i);
            if (!(mLiquid > 0 && mSolids > 0)) continue;

            const scalar rate =
                deltaT*coefficient_/perVolume[i]*(1/mLiquid + 1/mSolids);
            const scalar reduced =
                rate/(1 + rate)*mLiquid*mSolids/(mLiquid + mSolids);
            for (label d = 0; d < liquid.nDim; ++d)
            {
                const scalar impulse = reduced
                   *(liquid.velocity[i][d] - solids.velocity[i][d]);
                liquid.velocity[i][d] -= impulse/mLiquid;
                solids.velocity[i][d] += impulse/mSolids;
            }
        }
    }

    // Walls take what it brings to them
    liquid_.boundary().constrain(liquid.velocity);
    skeleton_.boundary().constrain(solids.velocity);
}


void Foam::mpm::linearExchange::effects(effectsTable& table) const
{
    table.add("  " + type(), true, "k " + Foam::name(coefficient_));
}

// ************************************************************************* //
