/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "closedBasins.H"
#include "regionSplit.H"
#include "volFields.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::closedBasins::keep(const boolList& kept)
{
    labelList number(kept.size(), -1);
    label n = 0;
    forAll(kept, basin)
    {
        if (!kept[basin]) continue;
        nNodes_[n] = nNodes_[basin];
        number[basin] = n++;
    }
    nNodes_.setSize(n);
    for (labelList* list : {&ofCell_, &ofNode_})
    {
        for (label& basin : *list) basin = basin < 0 ? -1 : number[basin];
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::closedBasins::closedBasins
(
    const nodeBoundary& boundary,
    const volVectorField& U
)
:
    grid_(boundary.grid()),
    boundary_(boundary),
    chosen_(false)
{
    const regionSplit regions(U.mesh());
    ofCell_ = regions;

    boolList closed(regions.nRegions(), true);
    for (const fvPatchVectorField& Up : U.boundaryField())
    {
        if (!nodeBoundary::isOpening(Up.type())) continue;
        for (const label celli : Up.patch().faceCells())
        {
            closed[ofCell_[celli]] = false;
        }
    }
    Pstream::listCombineGather(closed, andEqOp<bool>());
    Pstream::listCombineScatter(closed);

    // Nodes of the cells, on all ranks. Where two parts meet at an edge, a
    // node that both have belongs to none.
    const label nDim = grid_.nDim();
    nodeField<packed<4>> cells(grid_.nNodes(), packed<4>{});
    forAll(ofCell_, celli)
    {
        for (label corner = 0; corner < (1 << nDim); ++corner)
        {
            label node = grid_.boxCell(celli);
            for (label d = 0; d < nDim; ++d)
            {
                node += ((corner >> d) & 1)*grid_.stride(d);
            }
            const scalar region = ofCell_[celli];
            cells[node] += packed<4>{1, region, region*region, 0};
        }
    }
    grid_.exchange().sum(cells);

    ofNode_.setSize(grid_.nNodes(), -1);
    forAll(ofNode_, i)
    {
        const packed<4>& sum = cells[i];
        if (sum[0] > 0 && sum[0]*sum[2] == sum[1]*sum[1])
        {
            ofNode_[i] = label(sum[1]/sum[0]);
        }
    }

    scalarField nNodes(regions.nRegions(), Zero);
    forAll(ofNode_, i)
    {
        if (ofNode_[i] >= 0) nNodes[ofNode_[i]] += grid_.share(i);
    }
    reduce(nNodes, sumOp<scalarField>());
    nNodes_ = nNodes;
    keep(closed);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalarList Foam::mpm::closedBasins::excess(const scalarList& sums)
{
    const label n = nNodes_.size();
    scalarList result(n, Zero);
    boolList kept(n);
    for (label basin = 0; basin < n; ++basin)
    {
        const scalar* sum = sums.cdata() + 3*basin;
        if (mag(sum[2] - nNodes_[basin]) < 0.5)
        {
            result[basin] = (sum[0] - sum[1])/sum[0];
        }
        kept[basin] = sum[0] > nearlyFull*sum[1];
    }

    // Nothing enters or leaves: what is half full stays so
    if (!chosen_)
    {
        chosen_ = true;
        keep(kept);
        label next = 0;
        for (label basin = 0; basin < n; ++basin)
        {
            if (kept[basin]) result[next++] = result[basin];
        }
        result.setSize(next);
    }
    return result;
}

// ************************************************************************* //
