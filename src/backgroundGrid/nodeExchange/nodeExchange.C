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
    orderParts();
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::nodeExchange::orderParts()
{
    // Ranks ascend, this one is among them
    std::map<label, std::vector<part>> partsOf;
    bool ownPassed = false;
    auto addOwn = [&]()
    {
        if (ownPassed) return;
        ownPassed = true;
        for (const labelList& nodes : nodes_)
        {
            for (const label node : nodes)
            {
                std::vector<part>& parts = partsOf[node];
                if (parts.empty() || parts.back().rank >= 0)
                {
                    parts.push_back(part{-1, -1});
                }
            }
        }
    };
    forAll(ranks_, r)
    {
        if (ranks_[r] > Pstream::myProcNo()) addOwn();
        forAll(nodes_[r], i) partsOf[nodes_[r][i]].push_back(part{r, i});
    }
    addOwn();

    List<DynamicList<label>> pairs(ranks_.size());
    DynamicList<label> several, first;
    for (const auto& entry : partsOf)
    {
        const std::vector<part>& parts = entry.second;
        if (parts.size() == 2)
        {
            const part& other = parts[parts[0].rank < 0];
            pairs[other.rank].append(other.place);
            continue;
        }
        several.append(entry.first);
        first.append(label(parts_.size()));
        parts_.insert(parts_.end(), parts.begin(), parts.end());
    }
    first.append(label(parts_.size()));

    pairs_.setSize(pairs.size());
    forAll(pairs, r) pairs_[r].transfer(pairs[r]);
    several_.transfer(several);
    firstPart_.transfer(first);
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
