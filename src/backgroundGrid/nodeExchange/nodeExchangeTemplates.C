/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "UIPstream.H"
#include "UOPstream.H"

template<class Record>
void Foam::mpm::nodeExchange::sum(nodeField<Record>& field) const
{
    for (const labelList& group : images_)
    {
        for (label i = 1; i < group.size(); ++i)
        {
            field[group[0]] += field[group[i]];
        }
    }

    if (ranks_.size())
    {
        std::vector<nodeField<Record>> send(ranks_.size());
        std::vector<nodeField<Record>> receive(ranks_.size());
        const label firstRequest = UPstream::nRequests();

        forAll(ranks_, r)
        {
            const labelList& nodes = nodes_[r];
            const std::streamsize bytes = nodes.size()*sizeof(Record);

            receive[r].resize(nodes.size());
            UIPstream::read
            (
                UPstream::commsTypes::nonBlocking,
                ranks_[r],
                reinterpret_cast<char*>(receive[r].data()),
                bytes
            );

            send[r].resize(nodes.size());
            forAll(nodes, i)
            {
                send[r][i] = field[nodes[i]];
            }
            UOPstream::write
            (
                UPstream::commsTypes::nonBlocking,
                ranks_[r],
                reinterpret_cast<const char*>(send[r].data()),
                bytes
            );
        }
        UPstream::waitRequests(firstRequest);

        forAll(ranks_, r)
        {
            const labelList& nodes = nodes_[r];
            for (const label i : pairs_[r]) field[nodes[i]] += receive[r][i];
        }
        forAll(several_, k)
        {
            Record& value = field[several_[k]];
            auto valueOf = [&](const part& p) -> const Record&
            {
                return p.rank < 0 ? value : receive[p.rank][p.place];
            };
            label p = firstPart_[k];
            Record sum = valueOf(parts_[p]);
            while (++p < firstPart_[k + 1]) sum += valueOf(parts_[p]);
            value = sum;
        }
    }

    for (const labelList& group : images_)
    {
        for (label i = 1; i < group.size(); ++i)
        {
            field[group[i]] = field[group[0]];
        }
    }
}

// ************************************************************************* //
