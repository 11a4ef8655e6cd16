/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "bodyWall.H"
#include "nodeBoundary.H"
#include "PstreamReduceOps.H"
#include "dictionaryEntries.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(bodyWall, 0);
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    using namespace Foam;

    //- Part of its own velocity along a smooth surface that a slave keeps, how
    //  deep in the body it may be for that [cells], and how full the node
    constexpr scalar ownPart = 0.7;
    constexpr scalar ownDepth = 0.5;
    constexpr scalar ownFilling = 0.9;

    //- Mass of a master over that of a full cell below which r^2 is raised
    constexpr scalar thin = 0.6;

    //- How full of water and body a node is from which on the wall presses,
    //  and presses in full; and the same of the water in what the body leaves
    constexpr scalar pressed = 0.7;
    constexpr scalar fullyPressed = 0.9;
    constexpr scalar pressedBeside = 0.3;
    constexpr scalar fullyPressedBeside = 0.7;

    //- From 0 to 1 between two values
    scalar ramp(const scalar x, const scalar none, const scalar all)
    {
        return min(scalar(1), max(scalar(0), (x - none)/(all - none)));
    }

    vector product(const vector& a, const vector& b)
    {
        return cmptMultiply(a, b);
    }

    //- A tensor between components with signs
    tensor withSigns(const tensor& t, const vector& sign)
    {
        tensor s(t);
        for (direction i = 0; i < 3; ++i)
        for (direction j = 0; j < 3; ++j)
        {
            s[3*i + j] *= sign[i]*sign[j];
        }
        return s;
    }
}


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::bodyWall::findFree()
{
    // Walls alone
    std::vector<slave> kept;
    slaves_.swap(kept);

    // What walls make of a velocity of one, and of none
    nodeField<nodeVector> one(grid_.nNodes(), nodeVector{1, 1, 1, 1});
    nodeField<nodeVector> none(grid_.nNodes(), nodeVector{});
    boundary_.constrain(one, true);
    boundary_.constrain(none, false);
    slaves_.swap(kept);
    takeFree(one, none);

    // Walls know them of all nodes now, later of active ones
    if (bodies_.anyMoves())
    {
        freeOfWalls_.swap(one);
        givenByWalls_.swap(none);
    }
}


void Foam::mpm::bodyWall::takeFree
(
    const nodeField<nodeVector>& ofGrid,
    const nodeField<nodeVector>& givenOfGrid
)
{
    std::vector<vector> free, given;
    std::vector<scalar> unused;
    nodes_.gather(ofGrid, 0, free, unused);
    nodes_.gather(givenOfGrid, 0, given, unused);
    for (label k = 0; k < nodes_.size(); ++k)
    {
        nodes_[k].free = free[k];
        nodes_[k].given = given[k];
    }
}


void Foam::mpm::bodyWall::findSlaves()
{
    const scalar h = grid_.cells().minSpacing();
    const scalar near = slaveDistance*h;

    // Plates lie along the grid more often than not: at half a cell exactly all
    // are slaves, whatever the rounding. At the corners of an end that is wider
    // than a cell they are, too, as at those of any body; a narrower one is no
    // surface to the grid, and the flow around it is that of free nodes.
    auto slaved = [&](const bodyNodes::node& node)
    {
        const plate* thin = bodies_[node.body].thinPlate();
        if (!thin) return node.phi < near;
        const bool blunt = thin->thickness() > (1 + 1e-6)*h;
        return node.phi < near + 1e-6*h && (node.faced || blunt);
    };
    std::vector<bool> isSlave(nodes_.size());
    for (label k = 0; k < nodes_.size(); ++k) isSlave[k] = slaved(nodes_[k]);

    // By the ranks that have the cells of the image points
    struct found
    {
        label number, first, last;
    };
    List<DynamicList<scalar>> numbers(Pstream::nProcs());
    DynamicList<scalar>& mine = numbers[Pstream::myProcNo()];
    std::vector<bodyNodes::source> sources;
    sources_.clear();
    std::vector<found> places(nodes_.size(), found{-1, 0, 0});
    for (label k = 0; k < nodes_.size(); ++k)
    {
        const bodyNodes::node& node = nodes_[k];
        if (!isSlave[k] || node.buried) continue;

        const point image(node.x + (imageDistance*h - node.phi)*node.n);
        nodes_.sourcesOf
        (
            image,
            boundary_.folding(),
            [&](const label j) { return !isSlave[j]; },
            sources
        );
        if (sources.empty()) continue;
        if (!Pstream::parRun())
        {
            const label first = label(sources_.size());
            places[k] = {k, first, first + label(sources.size())};
            sources_.insert(sources_.end(), sources.begin(), sources.end());
            continue;
        }
        mine.append(k);
        mine.append(scalar(sources.size()));
        for (const bodyNodes::source& from : sources)
        {
            mine.append(from.node);
            mine.append(from.weight);
            for (direction d = 0; d < 3; ++d) mine.append(from.sign[d]);
        }
    }
    if (Pstream::parRun())
    {
        Pstream::gatherList(numbers);
        Pstream::scatterList(numbers);
    }

    for (const DynamicList<scalar>& list : numbers)
    {
        for (label i = 0; i < list.size();)
        {
            const label k = label(list[i++]);
            const label n = label(list[i++]);
            const bool known = places[k].number >= 0;
            if (!known)
            {
                places[k] =
                {
                    k, label(sources_.size()), label(sources_.size()) + n
                };
            }
            for (label j = 0; j < n; ++j, i += 5)
            {
                if (known) continue;
                sources_.push_back
                (
                    bodyNodes::source
                    {
                        label(list[i]),
                        list[i + 1],
                        vector(list[i + 2], list[i + 3], list[i + 4])
                    }
                );
            }
        }
    }

    slaves_.clear();
    bitSet isMaster(nodes_.size());
    for (label k = 0; k < nodes_.size(); ++k)
    {
        const bodyNodes::node& node = nodes_[k];
        if (!isSlave[k]) continue;

        // Without masters a node moves with the body
        slave s{k, 0, noSlip_[node.body], 0, 0, 0, Zero};
        if (places[k].number >= 0)
        {
            s.first = places[k].first;
            s.last = places[k].last;
            scalar distance = 0;
            for (label j = s.first; j < s.last; ++j)
            {
                distance += sources_[j].weight*nodes_[sources_[j].node].phi;
                isMaster.set(sources_[j].node);
            }
            s.r = max(scalar(-2), min(scalar(1), node.phi/distance));
        }
        s.factor = factor(s, s.r);
        slaves_.push_back(s);
    }
    masters_ = isMaster.toc();
    follows_ = isMaster;
    for (const slave& s : slaves_) follows_.set(s.number);
}


Foam::tensor Foam::mpm::bodyWall::factor
(
    const slave& s,
    const scalar normal
) const
{
    if (s.noSlip) return normal*tensor(I);
    const vector& n = nodes_[s.number].n;
    return normal*(n*n) + (1 - s.own)*(tensor(I) - n*n);
}


Foam::vector Foam::mpm::bodyWall::partOfBody
(
    const slave& s,
    const vector& velocity,
    const vector& angularVelocity
) const
{
    if (velocity == vector::zero && angularVelocity == vector::zero)
    {
        return Zero;
    }
    const bodyNodes::node& node = nodes_[s.number];
    const point& centre = bodies_[node.body].motion().centre();
    auto at = [&](const point& x)
    {
        return velocity + (angularVelocity ^ (x - centre));
    };
    vector part(at(node.x));
    for (label j = s.first; j < s.last; ++j)
    {
        const bodyNodes::source& from = sources_[j];
        part -= s.r*from.weight*at(nodes_[from.node].x);
    }
    return s.noSlip ? part : (node.n & part)*node.n;
}


Foam::vector Foam::mpm::bodyWall::fromMasters
(
    const slave& s,
    const std::vector<vector>& v
) const
{
    vector sum(Zero);
    for (label j = s.first; j < s.last; ++j)
    {
        const bodyNodes::source& from = sources_[j];
        sum += from.weight*product(from.sign, v[from.node]);
    }
    return s.factor & sum;
}


std::vector<Foam::vector> Foam::mpm::bodyWall::bodyParts() const
{
    std::vector<vector> parts(slaves_.size(), Zero);
    for (size_t i = 0; bodies_.anyMoves() && i < slaves_.size(); ++i)
    {
        const bodyMotion& motion =
            bodies_[nodes_[slaves_[i].number].body].motion();
        parts[i] = partOfBody
            (slaves_[i], motion.velocity(), motion.angularVelocity());
    }
    return parts;
}


void Foam::mpm::bodyWall::solve
(
    const std::vector<vector>& change,
    const std::vector<vector>& fromBody,
    nodeMotion& nodes,
    List<load>& sum
)
{
    // Momentum of the masters
    std::vector<vector> momentum(nodes_.size());
    for (const label k : heavyMasters_) momentum[k] = change[k];
    for (const label i : heavySlaves_)
    {
        const slave& s = slaves_[i];
        const vector given
        (
            s.factor
          & (
                change[s.number]
              - mass_[s.number]*(fromBody[i] - fromBody_[i])
            )
        );
        for (label j = s.first; j < s.last; ++j)
        {
            const bodyNodes::source& from = sources_[j];
            momentum[from.node] += from.weight*product(from.sign, given);
        }
    }

    const std::vector<vector> before(velocity_);
    for (const label k : heavyMasters_)
    {
        velocity_[k] += inverseMass_[k] & momentum[k];
        velocity_[k] =
            product(nodes_[k].free, velocity_[k]) + nodes_[k].given;
    }
    for (const label i : heavySlaves_)
    {
        // No point reads what has no mass
        const slave& s = slaves_[i];
        const bodyNodes::node& node = nodes_[s.number];
        vector v(fromBody[i] + fromMasters(s, velocity_));
        if (s.own > 0)
        {
            ownVelocity_[s.number] += change[s.number]/mass_[s.number];
            const vector& own = ownVelocity_[s.number];
            v += s.own*(own - (node.n & own)*node.n);
        }
        velocity_[s.number] = product(node.free, v) + node.given;
    }
    fromBody_ = fromBody;
    nodes_.scatter(velocity_, nodes.velocity);

    // What the nodes did not get, their body did
    auto add = [&](const label k)
    {
        const bodyNodes::node& node = nodes_[k];
        const vector lost
        (
            change[k] - mass_[k]*(velocity_[k] - before[k])
        );
        const vector arm(node.x - bodies_[node.body].motion().centre());
        load& l = sum[node.body];
        l.force += lost;
        l.moment += arm ^ lost;

        // Along surfaces that slip masters and slaves keep all they have
        if (!noSlip_[node.body]) return;
        const vector along(lost - (node.n & lost)*node.n);
        l.friction += along;
        l.frictionMoment += arm ^ along;
    };
    for (const label k : heavyMasters_) add(k);
    for (const label i : heavySlaves_) add(slaves_[i].number);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::bodyWall::bodyWall
(
    const backgroundGrid& grid,
    const nodeBoundary& boundary,
    const bodies& all,
    const word& cloud,
    const scalar rho0,
    const bool strict
)
:
    nodeConstraint(grid),
    boundary_(boundary),
    bodies_(all),
    nodes_(grid, all),
    noSlip_(all.size(), false),
    rho0_(rho0),
    projected_(all.size()),
    impulse_(all.size()),
    loads_(all.size())
{
    for (label b = 0; b < all.size(); ++b)
    {
        const dictionary dict(all[b].wallOf(cloud));
        checkKeywords(dict, {"type"}, strict);
        noSlip_[b] =
            dict.found("type")
         && readChoice(dict, "type", {"slip", "noSlip"}) == "noSlip";
    }
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::bodyWall::place()
{
    put(true);
}


void Foam::mpm::bodyWall::put(const bool renewed)
{
    const bool others = nodes_.build
    (
        boundary_.folding(), boundary_.inverseVolume(), renewed
    );
    if (renewed) findFree();
    else if (others) takeFree(freeOfWalls_, givenByWalls_);
    findSlaves();
}


void Foam::mpm::bodyWall::addSaturation
(
    std::vector<scalar>& saturation,
    const std::vector<scalar>& inverse,
    const bitSet& active
)
{
    // Active nodes are found anew in each step
    for (const label i : filled_)
    {
        // Second records may have become fewer; they are always active
        if (i < label(saturation.size()) && !active.test(i)) saturation[i] = 0;
    }
    filled_.clear();
    for (const bodyNodes::local& l : nodes_.locals())
    {
        const scalar V = nodes_[l.number].V;
        if (!(V > 0)) continue;
        saturation[l.grid] += V*inverse[l.grid];
        filled_.push_back(l.grid);
    }
}


void Foam::mpm::bodyWall::press
(
    const std::vector<scalar>& pressure,
    const std::vector<scalar>& volume,
    const std::vector<scalar>& space,
    const nodeMotion& nodes
)
{
    std::vector<scalar> values(size_t(4)*nodes_.size(), 0);
    for (size_t i = 0; i < nodes_.locals().size(); ++i)
    {
        const bodyNodes::local& l = nodes_.locals()[i];
        if (!l.gives) continue;
        values[4*size_t(l.number)] = pressure[i];
        values[4*size_t(l.number) + 1] = volume[i];
        values[4*size_t(l.number) + 2] = nodes.mass(l.grid);
        values[4*size_t(l.number) + 3] = space[i];
    }
    bodyNodes::sum(values);
    auto p = [&](const label k) { return values[4*size_t(k)]; };
    auto m = [&](const label k) { return values[4*size_t(k) + 2]; };

    // From a node to those around, in the order of its neighbours
    const lattice& cells = grid_.cells();
    const bool is3D = cells.nDim() == 3;
    FixedList<vector, 26> way;
    label nWays = 0;
    for (label c = (is3D ? -1 : 0); c <= (is3D ? 1 : 0); ++c)
    for (label b = -1; b <= 1; ++b)
    for (label a = -1; a <= 1; ++a)
    {
        if (!a && !b && !c) continue;
        const index3 step{a, b, c};
        vector& dx = way[nWays++];
        dx = Zero;
        for (label d = 0; d < cells.nDim(); ++d)
        {
            dx[cells.axis(d)] = step[d]*cells.spacing(d);
        }
    }
    wallForce_.assign(nodes_.size(), Zero);
    for (label k = 0; k < nodes_.size(); ++k)
    {
        const bodyNodes::node& node = nodes_[k];
        if (!(m(k) > 0) || !(node.V > 0) || !(p(k) > 0)) continue;
        const scalar water = values[4*size_t(k) + 1];
        const scalar room = values[4*size_t(k) + 3];
        const scalar beside = room - node.V;
        const scalar part = min
        (
            ramp((water + node.V)/room, pressed, fullyPressed),
            ramp
            (
                beside > 0 ? water/beside : 1, pressedBeside, fullyPressedBeside
            )
        );
        if (part <= 0) continue;

        // Gradient by least squares, weighted by mass; of the solved directions
        vector gradient(Zero);
        if (is3D)
        {
            symmTensor A(Zero);
            vector b(Zero);
            for (label j = 0; j < nWays; ++j)
            {
                const label neighbour = nodes_.neighbours(k)[j];
                if (neighbour < 0 || !(m(neighbour) > 0)) continue;
                A += m(neighbour)*sqr(way[j]);
                b += m(neighbour)*(p(neighbour) - p(k))*way[j];
            }
            if (!(det(A) > 1e-6*pow3(tr(A)))) continue;
            gradient = inv(A) & b;
        }
        else
        {
            const label x = cells.axis(0), y = cells.axis(1);
            scalar Axx = 0, Axy = 0, Ayy = 0, bx = 0, by = 0;
            for (label j = 0; j < nWays; ++j)
            {
                const label neighbour = nodes_.neighbours(k)[j];
                if (neighbour < 0 || !(m(neighbour) > 0)) continue;
                const scalar mx = m(neighbour)*way[j][x];
                const scalar my = m(neighbour)*way[j][y];
                const scalar dp = p(neighbour) - p(k);
                Axx += mx*way[j][x];
                Axy += mx*way[j][y];
                Ayy += my*way[j][y];
                bx += mx*dp;
                by += my*dp;
            }
            const scalar det = Axx*Ayy - Axy*Axy;
            if (!(det > 1e-6*sqr(Axx + Ayy))) continue;
            gradient[x] = (Ayy*bx - Axy*by)/det;
            gradient[y] = (Axx*by - Axy*bx)/det;
        }

        vector R
        (
            p(k)*node.A - (node.T & gradient)
          + cmptMultiply(node.W, gradient)
        );
        if (cells.nDim() == 2) R[cells.axis(2)] = 0;

        // A wall of the mesh that holds the node bears what presses on it behind
        // the body's surface. The body's own part is along its normal.
        const vector n(product(node.free, node.n));
        const vector held(node.n - n);
        R = product(node.free, R);
        if (magSqr(held) > 0 && magSqr(n) > 0.01)
        {
            R += (R & n)/magSqr(n)*held;
        }
        wallForce_[k] = part*R;
    }
}


Foam::mpm::nodeVector Foam::mpm::bodyWall::wallForce
(
    const bodyNodes::local& l
) const
{
    nodeVector force{};
    for (label d = 0; d < grid_.nDim(); ++d)
    {
        force[d] = wallForce_[l.number][grid_.cells().axis(d)];
    }
    return force;
}


void Foam::mpm::bodyWall::start(nodeMotion& nodes)
{
    // Inlets open and close, and have a velocity that may change
    if (returnReduce(!boundary_.inflowNodes().empty(), orOp<bool>())) findFree();

    const label n = nodes_.size();
    const scalar h = grid_.cells().minSpacing();
    std::vector<vector> momentum;
    nodes_.gather(nodes.momentum, 1, momentum, mass_);

    velocity_.assign(n, Zero);
    ownVelocity_.resize(n);
    inverseMass_.resize(n);
    for (label k = 0; k < n; ++k)
    {
        // What walls hold does not move its mass
        const bodyNodes::node& node = nodes_[k];
        if (mass_[k] > 0)
        {
            momentum[k] =
                product(node.free, momentum[k]) + mass_[k]*node.given;
        }
    }

    heavySlaves_.clear();
    for (size_t i = 0; i < slaves_.size(); ++i)
    {
        slave& s = slaves_[i];
        const bodyNodes::node& node = nodes_[s.number];
        if (mass_[s.number] > 0) heavySlaves_.push_back(label(i));
        ownVelocity_[s.number] = Zero;
        const scalar own =
            s.first == s.last ? (s.noSlip ? 0 : 1)
          : !s.noSlip && node.smooth && node.phi > -ownDepth*h
         && (mass_[s.number]/rho0_ + node.V)*node.inverseVolume > ownFilling
          ? ownPart : 0;
        if (own == s.own) continue;
        s.own = own;
        s.factor = factor(s, s.r);
    }

    // Masses of the masters, with those of their slaves
    std::vector<tensor>& mass = inverseMass_;
    for (const label k : masters_) mass[k] = mass_[k]*tensor(I);
    for (const label i : heavySlaves_)
    {
        const slave& s = slaves_[i];
        const scalar m = mass_[s.number];
        const scalar square = sqr(s.r);
        const vector& n = nodes_[s.number].n;
        const tensor normal(s.noSlip ? tensor(I) : n*n);
        const tensor across(factor(s, 0));
        const tensor full(square*normal + across);
        for (label j = s.first; j < s.last; ++j)
        {
            const bodyNodes::source& from = sources_[j];
            const scalar cell = rho0_/nodes_[from.node].inverseVolume;
            const scalar missing = max
            (
                scalar(0), 1 - mass_[from.node]/(thin*cell)
            );
            if (from.sign == vector::one && (missing == 0 || square >= 1))
            {
                mass[from.node] += from.weight*m*full;
                continue;
            }
            const scalar rr =
                square < 1 ? square + (1 - square)*missing : square;
            mass[from.node] +=
                from.weight*m*withSigns(rr*normal + across, from.sign);
        }
    }
    heavyMasters_.clear();
    for (const label k : masters_)
    {
        const scalar scale = tr(mass[k]);
        if (!(scale > 0))
        {
            inverseMass_[k] = Zero;
            continue;
        }
        heavyMasters_.push_back(k);
        if (grid_.nDim() == 2)
        {
            const label empty = grid_.cells().axis(2);
            mass[k][4*empty] = scale;
        }
        inverseMass_[k] = inv(mass[k]);
    }

    for (load& l : projected_) l = load();
    for (load& l : impulse_) l = load();

    // From zero velocity: the body's part counts from the beginning
    std::fill(fromBody_.begin(), fromBody_.end(), Zero);
    fromBody_.resize(slaves_.size(), Zero);

    // Nodes that are neither keep theirs
    for (label k = 0; k < n; ++k)
    {
        if (mass_[k] > 0) velocity_[k] = momentum[k]/mass_[k];
    }
    for (const label k : masters_) velocity_[k] = Zero;
    for (const slave& s : slaves_) velocity_[s.number] = Zero;
    solve(momentum, bodyParts(), nodes, projected_);
}


void Foam::mpm::bodyWall::constrain
(
    nodeField<nodeVector>& velocity,
    const bool homogeneous
) const
{
    // Only differences of velocities, which have no momentum to share
    if (!homogeneous || slaves_.empty()) return;

    std::vector<vector> v;
    std::vector<scalar> unused;
    nodes_.gather(velocity, 0, v, unused);
    for (const slave& s : slaves_)
    {
        v[s.number] = product
        (
            nodes_[s.number].free, fromMasters(s, v)
        );
    }
    nodes_.scatter(v, velocity);
}


void Foam::mpm::bodyWall::react(nodeMotion& nodes)
{
    std::vector<vector> v;
    std::vector<scalar> unused;
    nodes_.gather(nodes.velocity, 0, v, unused);

    std::vector<vector> change(nodes_.size(), Zero);
    const std::vector<vector> fromBody(bodyParts());
    bool changed = fromBody != fromBody_;
    for (label k = 0; k < nodes_.size(); ++k)
    {
        if (!(mass_[k] > 0)) continue;
        if (!follows_.test(k)) velocity_[k] = v[k];
        else if (v[k] != velocity_[k])
        {
            change[k] = mass_[k]*(v[k] - velocity_[k]);
            changed = true;
        }
    }

    // As after the drag in a scene without soil
    if (changed) solve(change, fromBody, nodes, impulse_);
}


void Foam::mpm::bodyWall::finish(const scalar, nodeMotion& nodes)
{
    react(nodes);
}


void Foam::mpm::bodyWall::push
(
    const label i,
    const scalar deltaT,
    const scalar projected,
    scalar (&impulse)[6],
    scalar (&resistance)[36]
) const
{
    load J(impulse_[i]);
    J.force += projected*projected_[i].force;
    J.moment += projected*projected_[i].moment;
    const point& centre = bodies_[i].motion().centre();
    for (label k = 0; k < nodes_.size(); ++k)
    {
        if (nodes_[k].body != i) continue;
        J.force -= deltaT*wallForce_[k];
        J.moment -= deltaT*((nodes_[k].x - centre) ^ wallForce_[k]);
    }
    for (direction d = 0; d < 3; ++d)
    {
        impulse[d] += J.force[d];
        impulse[3 + d] += J.moment[d];
    }

    for (label motion = 0; motion < 6; ++motion)
    {
        vector V(Zero), Omega(Zero);
        (motion < 3 ? V : Omega)[motion % 3] = 1;

        // As solve() would, from rest
        std::vector<vector> momentum(nodes_.size(), Zero);
        std::vector<vector> v(nodes_.size(), Zero);
        for (const slave& s : slaves_)
        {
            if (nodes_[s.number].body != i || !(mass_[s.number] > 0)) continue;
            v[s.number] = partOfBody(s, V, Omega);
            const vector given
            (
                -mass_[s.number]*(s.factor & v[s.number])
            );
            for (label j = s.first; j < s.last; ++j)
            {
                const bodyNodes::source& from = sources_[j];
                momentum[from.node] += from.weight*product(from.sign, given);
            }
        }
        for (const label k : masters_)
        {
            v[k] = product
                (nodes_[k].free, inverseMass_[k] & momentum[k]);
        }
        load sum;
        auto add = [&](const label k)
        {
            sum.force += mass_[k]*v[k];
            sum.moment += mass_[k]*((nodes_[k].x - centre) ^ v[k]);
        };
        for (const slave& s : slaves_)
        {
            if (!(mass_[s.number] > 0)) continue;
            v[s.number] = product
                (nodes_[s.number].free, v[s.number] + fromMasters(s, v));
            add(s.number);
        }
        for (const label k : masters_) add(k);
        for (direction d = 0; d < 3; ++d)
        {
            resistance[6*d + motion] += sum.force[d];
            resistance[6*(3 + d) + motion] += sum.moment[d];
        }
    }
}


void Foam::mpm::bodyWall::findLoads
(
    const scalar deltaT,
    const scalar projected
)
{
    forAll(loads_, b)
    {
        loads_[b] = impulse_[b].times(1/deltaT);
        loads_[b] += projected_[b].times(projected/deltaT);
    }

    // The wall gave its force to the nodes
    for (label k = 0; k < nodes_.size(); ++k)
    {
        const bodyNodes::node& node = nodes_[k];
        if (wallForce_[k] == vector::zero) continue;
        loads_[node.body].force -= wallForce_[k];
        loads_[node.body].moment -=
            (node.x - bodies_[node.body].motion().centre()) ^ wallForce_[k];
    }
}


size_t Foam::mpm::bodyWall::memory() const
{
    return
        nodes_.memory() + sizeof(slave)*slaves_.capacity()
      + sizeof(bodyNodes::source)*sources_.capacity()
      + size_t(nodes_.size())
       *(sizeof(scalar) + 4*sizeof(vector) + sizeof(tensor))
      + sizeof(nodeVector)*(freeOfWalls_.size() + givenByWalls_.size());
}

// ************************************************************************* //
