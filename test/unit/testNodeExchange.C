/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    Sums over the copies of a node that several ranks have. On four ranks:
    see main.C.

\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "nodeExchange.H"
#include "Pstream.H"
#include "PstreamReduceOps.H"
#include <cmath>
#include <cstring>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- Part of a rank in the sum of a node: of all sizes, so that another order
//  gives another sum
scalar partOf(const label rank, const label id)
{
    const scalar x = std::sin(1 + 12.9898*id + 78.233*rank);
    return x*std::pow(10.0, (7*id + 3*rank) % 11 - 5);
}

} // End anonymous namespace


TEST_CASE("nodeExchange: four ranks in one node", "[.][ranks]")
{
    const label nRanks = Pstream::nProcs();
    const label me = Pstream::myProcNo();
    if (Pstream::master()) equal("ranks", nRanks, 4);

    // Node id: the ranks that have it are the bits of 1 + id % 15. Each rank
    // numbers its nodes in its own way; every fifth one has an image
    const label nIds = 3000;
    auto has = [&](const label rank, const label id)
    {
        return ((1 + id % 15) >> rank) & 1;
    };
    DynamicList<label> nodes;
    DynamicList<int64_t> ids;
    nodeField<scalar> field(2*nIds, 0.0);
    label n = 0;
    for (label id = 0; id < nIds; ++id)
    {
        if (!has(me, id)) continue;
        for (label image = 0; image < 1 + (id % 5 == 0); ++image)
        {
            const label node = (7*n + me) % (2*nIds);
            nodes.append(node);
            field[node] = image ? 0 : partOf(me, id);
            ids.append(id);
            ++n;
        }
    }

    // Any rank may have any of them
    const neighbourRanks neighbours(identity(nRanks));
    std::vector<nodeExchange::candidate> candidates;
    forAll(nodes, i) candidates.push_back({ids[i], nodes[i]});
    std::vector<std::vector<nodeExchange::candidate>> all(nRanks, candidates);
    const nodeExchange exchange(neighbours, all);
    const auto start(field);
    exchange.sum(field);

    nodeField<nodeVector> records(2*nIds, nodeVector{});
    for (const label node : nodes)
    {
        records[node] = start[node] + nodeVector{};
    }
    exchange.sum(records);

    label different = 0, several = 0;
    forAll(nodes, i)
    {
        // In the order of the ranks
        bool first = true;
        scalar sum = 0;
        label copies = 0;
        for (label rank = 0; rank < nRanks; ++rank)
        {
            if (!has(rank, ids[i])) continue;
            const scalar part = partOf(rank, ids[i]);
            sum = first ? part : sum + part;
            first = false;
            ++copies;
        }
        several += copies > 2;
        different += std::memcmp(&sum, &field[nodes[i]], sizeof(scalar)) != 0;
        for (label c = 0; c < 4; ++c) different += records[nodes[i]][c] != sum;
    }
    reduce(different, sumOp<label>());
    label most = several;
    reduce(most, maxOp<label>());
    const label listed = returnReduce
    (
        exchange.nodesOfSeveral().size(), maxOp<label>()
    );
    if (Pstream::master())
    {
        atLeast("nodes of three and four ranks", most, 900);
        atLeast("of them summed in order", listed, 800);
        equal("sums that differ from the one in order", different, 0);
    }
}

// ************************************************************************* //
