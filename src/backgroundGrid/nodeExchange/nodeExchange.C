/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeExchange.H"
#include "Pstream.H"
#include "PstreamBuffers.H"
#include "ListOps.H"
#include <algorithm>
#include <map>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::nodeExchange::nodeExchange
(
    const labelUList& localNodes,
    const List<int64_t>& globalIds
)
{
    // Copies on this rank, and one primary node per global id
    std::map<int64_t, DynamicList<label>> byId;
    forAll(localNodes, i)
    {
        byId[globalIds[i]].append(localNodes[i]);
    }

    DynamicList<labelList> images;
    for (const auto& entry : byId)
    {
        if (entry.second.size() > 1) images.append(entry.second);
    }
    images_.transfer(images);

    if (!Pstream::parRun()) return;

    // Everyone sends the ids in use; std::map keeps them in ascending order,
    // so that the intersection has the same order on both sides
    List<int64_t> mine(byId.size());
    label n = 0;
    for (const auto& entry : byId) mine[n++] = entry.first;

    PstreamBuffers buffers(Pstream::commsTypes::nonBlocking);
    for (label rank = 0; rank < Pstream::nProcs(); ++rank)
    {
        if (rank == Pstream::myProcNo()) continue;
        UOPstream to(rank, buffers);
        to.write
        (
            reinterpret_cast<const char*>(mine.cdata()),
            std::streamsize(mine.size()*sizeof(int64_t))
        );
    }
    labelList sizes;
    buffers.finishedSends(sizes);

    DynamicList<label> ranks;
    DynamicList<labelList> nodes;
    for (label rank = 0; rank < Pstream::nProcs(); ++rank)
    {
        if (rank == Pstream::myProcNo()) continue;

        List<int64_t> theirs(sizes[rank]/label(sizeof(int64_t)));
        UIPstream from(rank, buffers);
        from.read
        (
            reinterpret_cast<char*>(theirs.data()),
            std::streamsize(theirs.size()*sizeof(int64_t))
        );

        DynamicList<label> common;
        for (const int64_t id : theirs)
        {
            const auto found = byId.find(id);
            if (found != byId.end()) common.append(found->second[0]);
        }
        if (common.size())
        {
            ranks.append(rank);
            nodes.append(labelList(common));
        }
    }
    ranks_.transfer(ranks);
    nodes_.transfer(nodes);
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::labelList Foam::mpm::nodeExchange::sharedNodes() const
{
    labelHashSet shared;
    for (const labelList& list : nodes_) shared.insert(list);
    for (const labelList& list : images_) shared.insert(list);
    return shared.sortedToc();
}

// ************************************************************************* //
