/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "wallStress.H"
#include "constrainedWallFvPatchVectorField.H"
#include "patchValues.H"
#include "wallLaw.H"
#include "addToRunTimeSelectionTable.H"

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(wallStress, 0);
    addToRunTimeSelectionTable(nodeConstraint, wallStress, wall);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::wallStress::wallStress
(
    const backgroundGrid& grid,
    const wallPatches& patches
)
:
    nodeConstraint(grid),
    rho_(0),
    nu_(0)
{
    for (const constrainedWallFvPatchVectorField* Up : patches)
    {
        const dictionary& dict = Up->coeffs();
        patch_ = Up->patch().name();
        coeffs_ = dict;

        // A smooth wall is one without roughness
        scalar ks = 0;
        if (Up->type() != "smoothWall")
        {
            ks = dict.get<scalar>("ks");
            if (!(ks >= 0))
            {
                FatalIOErrorInFunction(dict)
                    << "patch " << patch_ << ", keyword ks is " << ks << '.'
                    << nl << "    Allowed: >= 0 m" << exit(FatalIOError);
            }
            const scalar h = grid.cells().minSpacing();
            if (ks > h)
            {
                IOWarningInFunction(dict)
                    << "patch " << patch_ << ", keyword ks is " << ks
                    << " m, larger than the spacing h = " << h << " m: the"
                    << " law of the wall is taken among the grains of the"
                    << " roughness." << nl << "    Usual: ks <= h" << nl
                    << endl;
            }
        }
        else if (dict.found("ks"))
        {
            FatalIOErrorInFunction(dict)
                << "patch " << patch_ << ", keyword ks belongs to type"
                << " roughWall, the type is smoothWall" << exit(FatalIOError);
        }
        roughness_.set(Up->patch().index(), ks);
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::wallStress::build(const wallNodes& walls)
{
    const label nDim = grid_.nDim();
    const lattice& cells = grid_.cells();

    const patchValues values(walls, roughness_);

    walls.forFreeNodes
    (
        [&](const label node)
        {
            for (label side = 0; side < 2*nDim; ++side)
            {
                const scalar n = values.number(node, side);
                if (!(n > 0)) continue;

                // Each side of a cell shares its area among its corners
                scalar area = n;
                for (label d = 0; d < 3; ++d)
                {
                    if (d == side/2) continue;
                    area *= d < nDim
                      ? 0.5*cells.spacing(d)
                      : cells.spacing(d);
                }
                const label next = walls.next(node, side);
                nodes_.push_back
                (
                    wallNode
                    {
                        node,
                        side/2,
                        values.sum(node, side)/n,
                        area,
                        next < 0 ? node : next,
                        side
                    }
                );
            }
        }
    );
    lost_.assign(nodes_.size(), nodeVector{});
}


void Foam::mpm::wallStress::activate(const bitSet& active)
{
    active_ = chosen
    (
        active,
        nodes_.size(),
        [&](const label i) { return nodes_[i].node; }
    );
}


void Foam::mpm::wallStress::finish(const scalar deltaT, nodeMotion& nodes)
{
    if (!(rho_ > 0))
    {
        FatalIOErrorInFunction(coeffs_)
            << "patch " << patch_ << " is a smoothWall or roughWall of a cloud"
            << " that is no liquid." << nl
            << "    Allowed for solids: slip, noSlip, frictional"
            << exit(FatalIOError);
    }

    const label nDim = grid_.nDim();
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        lost_[i] = nodeVector{};
        const scalar m = nodes.mass(w.node);
        if (!(m > 0)) continue;

        nodeVector& v = nodes.velocity[w.node];
        const nodeVector& u = nodes.velocity[w.next];
        scalar speedSqr = 0, flowSqr = 0;
        for (label d = 0; d < nDim; ++d)
        {
            if (d == w.direction) continue;
            speedSqr += sqr(v[d]);
            flowSqr += sqr(u[d]);
        }
        if (!(speedSqr > 0)) continue;

        const scalar h = grid_.cells().spacing(w.direction);
        const scalar uStar = wallLaw::frictionVelocity
        (
            std::sqrt(flowSqr), h, w.roughness, nu_
        );
        const scalar decay =
            deltaT*rho_*sqr(uStar)*w.area/(m*std::sqrt(speedSqr));
        const scalar lostPart = decay/(1 + decay);
        for (label d = 0; d < nDim; ++d)
        {
            if (d == w.direction) continue;
            lost_[i][d] = m*lostPart*v[d];
            v[d] *= 1 - lostPart;
        }
    }
}


void Foam::mpm::wallStress::take
(
    const nodeMotion& nodes,
    const scalar deltaT,
    const scalar projected,
    const wallShares& shares,
    List<load>& loads
) const
{
    // What is normal to it the mirror takes
    for (const label i : active_)
    {
        const wallNode& w = nodes_[i];
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            if (d == w.direction) continue;
            give
            (
                grid_, w.node, w.side, d,
                grid_.share(w.node)*lost_[i][d]/deltaT,
                [&](const label patch) { return roughness_.found(patch); },
                shares, loads
            );
        }
    }
}

// ************************************************************************* //
