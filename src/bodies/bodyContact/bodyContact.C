/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodyContact.H"
#include "nodeBoundary.H"
#include "dictionaryEntries.H"
#include <string>
#include <unordered_map>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(bodyContact, 0);
}
}

// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bodyContact::bodyContact
(
    const backgroundGrid& grid,
    const nodeBoundary& boundary,
    const bodies& all,
    const word& cloud,
    const bool strict
)
:
    nodeConstraint(grid),
    boundary_(boundary),
    bodies_(all),
    nodes_(grid, all),
    noSlip_(all.size(), false),
    friction_(all.size(), 0),
    plateOf_(all.size(), -1),
    impulse_(all.size()),
    loads_(all.size())
{
    label nPlates = 0;
    for (label b = 0; b < all.size(); ++b)
    {
        if (all[b].thinPlate()) plateOf_[b] = nPlates++;
        const dictionary dict(all[b].wallOf(cloud));
        checkKeywords(dict, {"type", "frictionCoefficient"}, strict);
        noSlip_[b] =
            dict.found("type")
         && readChoice(dict, "type", {"friction", "noSlip"}) == "noSlip";
        if (dict.found("frictionCoefficient"))
        {
            if (noSlip_[b])
            {
                reportEntry
                (
                    dict,
                    "keyword frictionCoefficient is given, but type is noSlip",
                    strict
                );
            }
            friction_[b] = readBounded
            (
                dict, "frictionCoefficient", dimless, 0, 10, true, true
            );
        }
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::bodyContact::put(const bool renewed)
{
    // Nodes keep what they know, by what they are
    std::unordered_map<int64_t, scalar> kept(read_);
    for (size_t k = 0; k < next_.size(); ++k)
    {
        if (next_[k] > 0) kept[nodes_.id(label(k))] = next_[k];
    }
    const bool others = nodes_.build
    (
        boundary_.folding(), boundary_.inverseVolume(), renewed
    );
    if (others) next_.assign(nodes_.size(), 0);
    for (label k = 0; others && k < nodes_.size(); ++k)
    {
        const auto found = kept.find(nodes_.id(k));
        if (found != kept.end()) next_[k] = found->second;
    }

    const scalar most = contactDistance*grid_.cells().minSpacing();
    DynamicList<label> near;
    for (label k = 0; k < nodes_.size(); ++k)
    {
        if (nodes_[k].phi < most && nodes_[k].faced && magSqr(nodes_[k].n) > 0)
        {
            near.append(k);
        }
    }
    near_ = near;
    inRange_.reset();
    inRange_.resize(nodes_.size());
    inRange_.set(near_);
}


void Foam::mpm::bodyContact::finish(const scalar deltaT, nodeMotion& nodes)
{
    std::vector<vector> momentum;
    std::vector<scalar> unused;
    nodes_.gather(nodes.momentum, 1, momentum, mass_);
    nodes_.gather(nodes.velocity, 0, before_, unused);
    mean_ = next_;
    read_.clear();
    follow(deltaT, nodes);
}


void Foam::mpm::bodyContact::follow(const scalar deltaT, nodeMotion& nodes)
{
    std::vector<vector> v(before_);
    held_.reset();
    held_.resize(nodes_.size());

    // What each node is pressed by and what holding it asks for, per contact
    std::vector<scalar> pressed(nodes_.size(), 0);
    std::vector<vector> along(nodes_.size(), Zero);
    for (const label k : near_)
    {
        const bodyNodes::node& node = nodes_[k];
        if (!(mass_[k] > 0)) continue;
        const vector relative
        (
            v[k] - bodies_[node.body].motion().velocity(node.x)
        );
        const scalar normal = relative & node.n;
        pressed[k] = mass_[k]*max(scalar(0), -normal);
        along[k] = mass_[k]*(relative - normal*node.n);
    }

    // Mean normal force of the contact over the time of its vibration
    std::vector<scalar> steady(nodes_.size(), 0);
    for (const label k : near_)
    {
        const scalar fresh = 1 - std::exp(-deltaT/memory(nodes_[k]));
        const scalar now = pressed[k]/deltaT;
        next_[k] = mean_[k] > 0 ? mean_[k] + fresh*(now - mean_[k]) : now;
        steady[k] = deltaT*next_[k];
    }

    // What friction can bear: the normal impulse, shared among the nodes of the
    // contact around, as single nodes lose contact now and then, by what they ask
    // for. By their mass those in the body, which have next to none, would slip
    std::vector<scalar> bears(nodes_.size(), 0);
    DynamicList<label> around;
    for (const label k : near_)
    {
        if (!(steady[k] > 0)) continue;
        around.clear();
        around.append(k);
        scalar asked = mag(along[k]);
        for (label j = 0; j < nodes_.nNeighbours(); ++j)
        {
            const label neighbour = nodes_.neighbours(k)[j];
            if (neighbour < 0 || !inRange_.test(neighbour)) continue;
            if (!(mass_[neighbour] > 0)) continue;
            around.append(neighbour);
            asked += mag(along[neighbour]);
        }
        if (!(asked > 0)) continue;
        for (const label j : around)
        {
            bears[j] +=
                friction_[nodes_[k].body]*steady[k]*mag(along[j])/asked;
        }
    }

    for (load& l : impulse_) l = load();
    for (const label k : near_)
    {
        const bodyNodes::node& node = nodes_[k];
        if (!(mass_[k] > 0)) continue;

        vector lost(Zero);
        if (noSlip_[node.body])
        {
            lost = along[k]
              + mass_[k]*(
                    (v[k] - bodies_[node.body].motion().velocity(node.x))
                  & node.n
                )*node.n;
        }
        else
        {
            const scalar asked = mag(along[k]);
            lost = -pressed[k]*node.n
              + (asked > bears[k] ? bears[k]/max(asked, VSMALL) : 1)
               *along[k];
        }
        v[k] -= lost/mass_[k];
        if (magSqr(lost) > 0) held_.set(k);
        const vector arm(node.x - bodies_[node.body].motion().centre());
        const vector tangential(lost - (node.n & lost)*node.n);
        impulse_[node.body].force += lost;
        impulse_[node.body].moment += arm ^ lost;
        impulse_[node.body].friction += tangential;
        impulse_[node.body].frictionMoment += arm ^ tangential;
    }
    nodes_.scatter(v, nodes.velocity);
    forAll(loads_, b)
    {
        loads_[b] = impulse_[b].times(1/deltaT);
    }
}


void Foam::mpm::bodyContact::writeState(dictionary& dict) const
{
    // By name: a list would be read as binary where the state file is
    dictionary forces;
    for (size_t k = 0; k < next_.size(); ++k)
    {
        if (!(next_[k] > 0)) continue;
        const word name("node" + std::to_string(nodes_.id(label(k))));
        forces.set(name, next_[k]);
    }
    dict.set("contactForces", forces);
}


void Foam::mpm::bodyContact::readState(const dictionary& dict)
{
    // None before the first step
    const dictionary forces(subDictOrEmpty(dict, "contactForces"));

    // Nodes take them when they are placed where the bodies are
    for (const entry& e : forces)
    {
        const word name(e.keyword());
        int64_t id;
        if (!name.startsWith("node") || !Foam::read(name.substr(4), id))
        {
            FatalIOErrorInFunction(forces)
                << "keyword " << name << " names no node." << nl
                << "    Allowed: node followed by its number"
                << exit(FatalIOError);
        }
        read_[id] = forces.get<scalar>(name);
    }
    next_.clear();
    place();
}


void Foam::mpm::bodyContact::push
(
    const label i,
    const scalar,
    scalar (&impulse)[6],
    scalar (&resistance)[36]
) const
{
    const point& centre = bodies_[i].motion().centre();
    for (direction d = 0; d < 3; ++d)
    {
        impulse[d] += impulse_[i].force[d];
        impulse[3 + d] += impulse_[i].moment[d];
    }
    for (label motion = 0; motion < 6; ++motion)
    {
        vector V(Zero), Omega(Zero);
        (motion < 3 ? V : Omega)[motion % 3] = 1;
        for (const label k : held_)
        {
            const bodyNodes::node& node = nodes_[k];
            if (node.body != i) continue;
            const vector v(V + (Omega ^ (node.x - centre)));
            const vector J
            (
                mass_[k]*(noSlip_[i] ? v : (v & node.n)*node.n)
            );
            const vector M((node.x - centre) ^ J);
            for (direction d = 0; d < 3; ++d)
            {
                resistance[6*d + motion] += J[d];
                resistance[6*(3 + d) + motion] += M[d];
            }
        }
    }
}

// ************************************************************************* //
