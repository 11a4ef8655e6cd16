/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "nodeExchange.H"
#include "Pstream.H"
#include <algorithm>
#include <map>

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::nodeExchange::nodeExchange
(
    const neighbourRanks& neighbours,
    std::vector<std::vector<candidate>>& candidates
)
{
    // In the order of the ids, which is the same on all ranks
    for (std::vector<candidate>& list : candidates)
    {
        std::sort
        (
            list.begin(), list.end(),
            [](const candidate& a, const candidate& b)
            {
                return a.id != b.id ? a.id < b.id : a.node < b.node;
            }
        );
    }

    // Copies on this rank
    const label own = neighbours.place(Pstream::myProcNo());
    DynamicList<labelList> images;
    DynamicList<label> group;
    const std::vector<candidate>& here = candidates[own];
    for (size_t i = 0; i < here.size(); ++i)
    {
        if (group.empty() || group.last() != here[i].node)
        {
            group.append(here[i].node);
        }
        if (i + 1 < here.size() && here[i + 1].id == here[i].id) continue;
        if (group.size() > 1) images.append(group);
        group.clear();
    }
    images_.transfer(images);

    // The first copy of each is sent
    List<DynamicList<int64_t>> ids(neighbours.size());
    forAll(ids, r)
    {
        if (r == own) continue;
        std::vector<candidate>& list = candidates[r];
        list.erase
        (
            std::unique
            (
                list.begin(), list.end(),
                [](const candidate& a, const candidate& b)
                {
                    return a.id == b.id;
                }
            ),
            list.end()
        );
        ids[r].reserve(label(list.size()));
        for (const candidate& c : list) ids[r].append(c.id);
    }
    const List<List<int64_t>> theirs(neighbours.exchange(ids));

    DynamicList<label> ranks;
    DynamicList<labelList> nodes;
    DynamicList<label> common;
    forAll(theirs, r)
    {
        if (r == own) continue;
        common.clear();
        auto c = candidates[r].cbegin();
        for (const int64_t id : theirs[r])
        {
            while (c != candidates[r].cend() && c->id < id) ++c;
            if (c == candidates[r].cend()) break;
            if (c->id == id) common.append(c->node);
        }
        if (common.size())
        {
            ranks.append(neighbours.ranks()[r]);
            nodes.append(common);
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
