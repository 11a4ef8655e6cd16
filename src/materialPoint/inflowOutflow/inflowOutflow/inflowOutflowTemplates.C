/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "polyMesh.H"
#include "SubField.H"

template<class Pressure>
void Foam::mpm::inflowOutflow::setLoads
(
    const nodeFolding& folding,
    const label vertical,
    const Pressure& pressure
)
{
    const lattice& cells = grid_.cells();
    const label nDim = grid_.nDim();
    const label T = grid_.reachWidth();

    // Gauss points of half cells: splines have their knots in between
    const label nGauss = 6;
    const scalar offset = 0.25*std::sqrt(0.6);
    const scalar at[nGauss] =
    {
        0.25 - offset, 0.25, 0.25 + offset, 0.75 - offset, 0.75, 0.75 + offset
    };
    const scalar weight[nGauss] =
        {5.0/36, 8.0/36, 5.0/36, 5.0/36, 8.0/36, 5.0/36};

    nodeField<nodeVector> load(grid_.nNodes(), nodeVector{});

    for (const outlet& out : outlets_)
    {
        if (!(out.waterLevel() > -GREAT)) continue;

        const polyPatch& patch = grid_.mesh().boundaryMesh()[out.patch()];
        forAll(patch, i)
        {
            label d, s;
            cells.faceDirection(patch.faceAreas()[i], d, s);
            if (d < 0 || d == vertical) continue;

            const label celli = patch.faceCells()[i];
            const label cell = grid_.boxCell(celli);
            const label stencil = folding.stencil(cell);
            const scalar area = cells.cellVolume()/cells.spacing(d);

            label n[3] = {1, 1, 1};
            for (label k = 0; k < nDim; ++k) if (k != d) n[k] = nGauss;

            // The cell that begins where the zone does
            const label shift = (levelCells - 1)*grid_.stride(d)*(s ? -1 : 1);

            for (label k = 0; k < n[2]; ++k)
            for (label j = 0; j < n[1]; ++j)
            for (label l = 0; l < n[0]; ++l)
            {
                const label point[3] = {l, j, k};
                scalar w[3][4] = {}, g[4];
                scalar force = area;
                for (label c = 0; c < nDim; ++c)
                {
                    const scalar f = c == d ? scalar(1 - s) : at[point[c]];
                    if (c != d) force *= weight[point[c]];
                    reachWeights(grid_, f, w[c], g);
                }
                const scalar z = cells.origin(vertical)
                  + (cells.cellIndex(celli)[vertical] + at[point[vertical]])
                   *cells.spacing(vertical);
                force *= pressure(out.waterLevel(), z)*(s ? -1 : 1);

                for (label t = 0; t < grid_.reachSize(); ++t)
                {
                    scalar N = w[0][t % T]*w[1][(t/T) % T];
                    if (nDim == 3) N *= w[2][t/(T*T)];
                    nodeVector f{};
                    f[d] = N*force;
                    // Nodes fold as they do at the patch
                    if (stencil < 0)
                    {
                        load
                        [
                            cell + shift + grid_.reachOffset()
                          + grid_.reachNode(t)
                        ] += f;
                    }
                    else
                    {
                        load[folding.targets(stencil)[t] + shift] +=
                            folding.signs(stencil)[t]*f;
                    }
                }
            }
        }
    }
    loadsKnown_ = true;
    loads_.clear();
    for (label i = 0; i < grid_.nNodes(); ++i)
    {
        bool any = false;
        for (label d = 0; d < nDim; ++d) any = any || load[i][d] != 0;
        if (any) loads_.emplace_back(i, load[i]);
    }
}

// ************************************************************************* //
