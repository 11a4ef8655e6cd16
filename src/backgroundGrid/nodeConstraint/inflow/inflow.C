/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "inflow.H"

// * * * * * * * * * * * * * * Static Data Members * * * * * * * * * * * * * //

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(inflow, 0);
}
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::inflow::inflow
(
    const backgroundGrid& grid,
    const inflowZone& zone,
    nodeFolding& folding
)
:
    nodeConstraint(grid),
    zone_(zone),
    folding_(folding),
    open_(false),
    velocity_{}
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::inflow::build(const wallNodes&)
{
    closed_ = folding_.mirrored(zone_.meshCells());
}


void Foam::mpm::inflow::activate(const bitSet& active)
{
    active_.clear();
    for (const label node : zone_.nodes())
    {
        if (active.test(node)) active_.push_back(node);
    }
}


void Foam::mpm::inflow::set(const bool open, const nodeVector& velocity)
{
    velocity_ = velocity;
    if (open_ == open) return;

    open_ = open;
    folding_.setEven(closed_, open);
}


void Foam::mpm::inflow::constrain
(
    nodeField<nodeVector>& velocity,
    const bool homogeneous
) const
{
    if (!open_) return;
    for (const label node : active_)
    {
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            velocity[node][d] = homogeneous ? 0 : velocity_[d];
        }
    }
}

// ************************************************************************* //
