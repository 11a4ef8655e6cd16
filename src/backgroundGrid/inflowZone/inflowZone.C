/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "inflowZone.H"
#include "PstreamReduceOps.H"
#include "SubField.H"
#include <algorithm>

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    //- Part of a cell below which a face does not count
    const Foam::scalar sliver = 1e-6;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::inflowZone::inflowZone
(
    const backgroundGrid& grid,
    const label patchi,
    const label vertical,
    const scalar lower,
    const scalar upper,
    const label nCells
)
:
    direction_(-1),
    side_(0),
    bent_(false)
{
    const lattice& cells = grid.cells();
    const label nDim = grid.nDim();
    const polyPatch& patch = grid.mesh().boundaryMesh()[patchi];

    // Direction and side as one number, so that ranks without faces agree
    label normal = -1;
    List<List<index3>> all(Pstream::nProcs());
    DynamicList<index3> own;
    forAll(patch, i)
    {
        label d, s;
        cells.faceDirection(patch.faceAreas()[i], d, s);
        bent_ = bent_ || d < 0 || (normal >= 0 && normal != 2*d + s);
        normal = 2*d + s;
        own.append(cells.cellIndex(patch.faceCells()[i]));
    }
    const label largest = returnReduce(normal, maxOp<label>());
    bent_ = returnReduce
    (
        bent_ || (normal >= 0 && normal != largest), orOp<bool>()
    );
    if (bent_ || largest < 0) return;
    direction_ = largest/2;
    side_ = largest % 2;

    all[Pstream::myProcNo()] = own;
    Pstream::gatherList(all);
    Pstream::scatterList(all);

    for (const List<index3>& list : all)
    {
        for (const index3& i : list)
        {
            face f{i, 0, 1};
            if (vertical >= 0)
            {
                const scalar h = cells.spacing(vertical);
                const scalar z = cells.origin(vertical) + i[vertical]*h;
                f.lower = min(scalar(1), max(scalar(0), (lower - z)/h));
                f.upper = min(scalar(1), max(scalar(0), (upper - z)/h));
            }
            if (f.upper - f.lower > sliver) faces_.push_back(f);
        }
    }
    std::sort
    (
        faces_.begin(),
        faces_.end(),
        [](const face& a, const face& b)
        {
            for (label d = 2; d > 0; --d)
            {
                if (a.cell[d] != b.cell[d]) return a.cell[d] < b.cell[d];
            }
            return a.cell[0] < b.cell[0];
        }
    );

    // What lies in the box of this rank; cyclic directions have images
    std::vector<char> inZone(grid.nNodes(), 0), given(grid.nNodes(), 0);
    const label inward = side_ ? -1 : 1;

    auto forImages = [&](const index3& at, const auto& op)
    {
        for (label image = 0; image < 27; ++image)
        {
            index3 i;
            i = 0;
            bool inside = true;
            label rest = image;
            for (label d = 0; d < 3; ++d)
            {
                const label shift = rest % 3 - 1;
                rest /= 3;
                if (d >= nDim)
                {
                    inside = inside && shift == 0;
                    continue;
                }
                inside = inside && (shift == 0 || cells.periodic(d));
                i[d] = at[d] + shift*cells.nCells(d) - grid.lower(d);
                inside = inside && i[d] >= 0 && i[d] < grid.nNodes(d);
            }
            if (inside) op(grid.index(i));
        }
    };

    for (size_t k = 0; k < faces_.size(); ++k)
    {
        const index3& first = faces_[k].cell;

        for (label n = 0; n < nCells; ++n)
        {
            index3 at = first;
            at[direction_] += n*inward;
            forImages
            (
                at,
                [&](const label cell)
                {
                    if (!grid.ownCell(cell)) return;
                    inZone[cell] = 1;
                    if (n == 0) ownFaces_.push_back(label(k));
                }
            );
        }

        // Corners of the face, on the patch and on the lines behind it
        for (label corner = 0; corner < (1 << nDim); ++corner)
        {
            if ((corner >> direction_) & 1) continue;
            index3 at = first;
            for (label d = 0; d < nDim; ++d) at[d] += (corner >> d) & 1;
            at[direction_] += side_;
            for (label n = 0; n <= nCells + 1; ++n)
            {
                forImages(at, [&](const label node) { given[node] = 1; });
                at[direction_] += inward;
            }
        }
    }
    for (label i = 0; i < grid.nNodes(); ++i)
    {
        if (inZone[i]) meshCells_.push_back(grid.meshCell(i));
        if (given[i]) nodes_.push_back(i);
    }
}

// ************************************************************************* //
