/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterKernels.H"
#include "waterMaterial.H"
#include "strainRate.H"
#include "waterCloud.H"
#include "cloudKernelsFor.H"
#include "cellQuadrature.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{

template<class Shape, int dim>
class waterKernelsFor
:
    public cloudKernelsFor<Shape, dim>
{
    typedef cloudKernelsFor<Shape, dim> base;

    using base::kernels_;
    using base::volume;

    waterCloud& cloud_;

    //- Of diffuse(), kept from step to step; empty if nothing diffuses
    struct
    {
        nodeField<nodeVector> sum, change, field;
        std::vector<scalar> slopes;
    }
    diffusion_;

    //- Of filterBesideBed(): masses of some points, means over the bed, in it,
    //  and their masses; velocities of points in the bed
    struct
    {
        std::vector<scalar> mass;
        nodeField<nodeVector> means[3];
        std::vector<scalar> own;
    }
    parted_;

    //- Of accelerateInStages(): velocities before the first stage; forces of
    //  all else, and momentum given up to this stage and the one before it, at
    //  nodes and by mirrors. Empty without
    struct
    {
        nodeField<nodeVector> start;
        nodeField<nodeVector> others[2], now[2], before[2];
    }
    stages_;

    //- Offsets to the neighbours of a node
    std::vector<label> neighbours_;

    //- Nodes that a thin plate parts, and for each those around as it sees them;
    //  none without plates
    std::vector<label> plated_;
    std::vector<label> aroundPlated_;

    //- With pressureQuadrature cells; else empty
    cellQuadrature<Shape, dim> cells_;

    //- Saturation without bodies, if there are any, for that
    std::vector<scalar> waterSaturation_;


    template<bool eddy = false>
    waterMaterial<dim, eddy> makeMaterial(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        const scalar perSpeed = deltaT/c.grid_.cells().minSpacing();
        const scalar courant = c.fluid_.soundSpeed()*perSpeed;
        const bool correct = c.settings_.volumeCorrection;

        waterMaterial<dim, eddy> m
        {
            c.fluid_,
            c.points_.column(c.mass_),
            c.points_.column(c.J_),
            {},
            deltaT,
            {},
            c.bulkViscosity(courant)*c.grid_.cells().minSpacing(),
            1 - std::exp(-courant),
            correct ? waterCloud::correctionRate*courant : 0,
            correct ? waterCloud::bedCorrectionRate*perSpeed : 0,
            correct && c.settings_.overlapCorrection
          ? waterCloud::overlapCorrectionRate*courant : 0,
            1 - std::exp(-waterCloud::smoothingRate*courant),
            c.minPressure_
        };
        if constexpr (eddy)
        {
            m.nut = c.points_.column(c.nut_);
            m.shearRate = c.points_.column(c.nut_ + 1);
            if (c.rotation_ >= 0)
            {
                m.rotationRate = c.points_.column(c.rotation_);
                if (dim == 3) m.strainShape = c.points_.column(c.rotation_ + 1);
            }
        }
        for (int d = 0; d < dim; ++d)
        {
            m.gradJ[d] =
                c.settings_.smoothing
              ? c.points_.column(c.gradJ_ + d) : nullptr;
            m.gravity[d] = c.acceleration_[c.grid_.cells().axis(d)];
            m.reach[d] = 0.5*Shape::width*c.grid_.cells().spacing(d);
        }
        return m;
    }

    //- Call op(first node, number of nodes, offsets to the neighbours) for
    //  groups of up to nLanes active nodes in a row. Nodes on the rim of the
    //  box, which points of this rank do not reach, have no neighbours.
    template<class Op>
    void forNeighbourhoods(const Op& op) const
    {
        static const std::vector<label> none;
        const label rim = neighbours_.back();
        const label beyond = label(cloud_.nodes_.saturation.size()) - rim;
        for (const auto& range : cloud_.order_.nodeRanges())
        {
            for (label i = range.first; i < range.second;)
            {
                const label n = min(label(nLanes), range.second - i);
                if (i >= rim && i + n <= beyond)
                {
                    op(i, n, neighbours_);
                    i += n;
                }
                else
                {
                    op(i, 1, i >= rim && i < beyond ? neighbours_ : none);
                    ++i;
                }
            }
        }
    }

    void findPlated()
    {
        const backgroundGrid& grid = cloud_.grid();
        if (!grid.plated()) return;

        const std::vector<scalar>& inverse = cloud_.boundary_.inverseVolume();
        for (label node = 0; node < grid.nNodes(); ++node)
        {
            if (grid.viewOf(node) == plate::none || !(inverse[node] > 0))
            {
                continue;
            }
            plated_.push_back(node);
            for (const label offset : neighbours_)
            {
                aroundPlated_.push_back
                (
                    grid.seen
                    (
                        grid.boxNode(node) + offset, grid.viewOf(node)
                    )
                );
            }
        }
    }

    //- Volume of the water over that of the pores
    void saturations()
    {
        waterCloud& c = cloud_;
        const std::vector<scalar>& inversePoreVolume =
            c.coupling_
          ? c.coupling_->inversePoreVolume : c.boundary_.inverseVolume();
        std::vector<scalar>& S = c.nodes_.saturation;

        this->forActiveNodes
        (
            [&](const label i) { S[i] = volume(i)*inversePoreVolume[i]; }
        );
        if (c.bodies_)
        {
            if (c.cellQuadrature_) waterSaturation_ = S;
            c.addBodySaturation(inversePoreVolume);
        }
    }

    //- The share of the pressure that follows from the most of the saturation
    //  nearby; with correction how much the volume at each node is off: inside
    //  the water any error but what a plane surface nearby explains, elsewhere
    //  only an excess. See waterMaterial
    template<bool correction>
    void fillings()
    {
        waterCloud& c = cloud_;
        const std::vector<scalar>& inverseVolume = c.boundary_.inverseVolume();
        const std::vector<scalar>& S = c.nodes_.saturation;
        std::vector<scalar>& filling = c.nodes_.filling;
        nodalFields& nodes = c.nodes_;

        const auto load =
            [](const std::vector<scalar>& from, const label i, const label n)
            {
                if (n == nLanes) return loadLanes(from.data() + i);
                lanes v{};
                for (label l = 0; l < n; ++l) v[l] = from[i + l];
                return v;
            };

        const auto set =
            [&]
            (
                const label i,
                const scalar own,
                const scalar most,
                const scalar least
            )
            {
                filling[i] = waterCloud::filling(most);
                if constexpr (!correction) return;

                if (least <= waterCloud::insideSaturation)
                {
                    nodes.volumeError(i) =
                        max(0.0, own - waterCloud::outsideSaturation);
                    return;
                }
                const scalar error = own - 1;
                const scalar defect = surfaceDefect<Shape>(least);
                nodes.volumeError(i) =
                    defect > 0 && error < 0
                  ? min(0.0, error + defect) : error;
            };

        // Most and least without branches, which noise would decide
        forNeighbourhoods
        (
            [&]
            (
                const label first,
                const label n,
                const std::vector<label>& neighbours
            )
            {
                const lanes zero{};
                const lanes own = load(S, first, n);
                lanes most = own;
                lanes least = neighbours.size() ? own : zero;
                for (const label offset : neighbours)
                {
                    const lanes s = load(S, first + offset, n);
                    most = maxLanes(most, s);

                    // Nodes behind walls have no control volume
                    const lanes inverse = load(inverseVolume, first + offset, n);
                    least = minLanes
                        (least, inverse > zero ? s : allLanes(GREAT));
                }
                for (label l = 0; l < n; ++l)
                {
                    set(first + l, own[l], most[l], least[l]);
                }
            }
        );
        // No point reads what has no mass
        for (size_t k = 0; k < plated_.size(); ++k)
        {
            const label node = plated_[k];
            if (!(nodes.mass(node) > 0)) continue;
            const label* around = aroundPlated_.data() + k*neighbours_.size();
            scalar most = S[node], least = S[node];
            for (size_t j = 0; j < neighbours_.size(); ++j)
            {
                const label i = around[j];
                most = max(most, S[i]);
                if (inverseVolume[i] > 0) least = min(least, S[i]);
            }
            set(node, S[node], most, least);
        }
        if constexpr (!correction) return;

        // The gap behind the last layer of an inlet is no error
        for (const label i : c.boundary_.inflowNodes())
        {
            nodes.volumeError(i) = 0;
        }
    }

    //- Keep the volume ratio of points in zones of open inlets, and give it
    //  back
    void hold()
    {
        waterCloud& c = cloud_;
        c.held_.clear();
        if (!c.open_.valid() || !c.open_->anyOpen()) return;

        const std::vector<char>& marks = c.open_->marks();
        const label* cell = c.points_.cell();
        const scalar* J = c.J();
        for (label p = 0; p < c.size(); ++p)
        {
            if (marks[cell[p]] & inflowOutflow::openInlet)
            {
                c.held_.emplace_back(p, J[p]);
            }
        }
    }

    void release()
    {
        scalar* J = cloud_.points_.column(cloud_.J_);
        for (const auto& point : cloud_.held_) J[point.first] = point.second;
    }

    //- Full cells and their pressures
    void findCellPressures()
    {
        waterCloud& c = cloud_;
        const std::vector<scalar>& S = c.nodes_.saturation;
        auto find = [&](const auto& inside)
        {
            cells_.findFull
            (
                c.boundary_,
                c.mesh_.nCells(),
                S,
                waterCloud::insideSaturation,
                inside
            );
        };
        if (c.coupling_ || c.bodies_)
        {
            find
            (
                [&](const label i)
                {
                    return
                        !(c.coupling_ && c.coupling_->mixed[i])
                     && !(c.bodies_ && S[i] != waterSaturation_[i]);
                }
            );
        }
        else
        {
            find([](const label) { return true; });
        }
        cells_.findPressures
        (
            c.grid_.nBoxNodes(),
            c.size(),
            c.points_.cell(),
            c.points_.column(c.mass_),
            c.J(),
            [&](const scalar J)
            {
                return max(c.fluid_.pressure(J), c.minPressure_);
            }
        );
    }

    //- Mean of a scalar of the points on the mesh: op(p, weighted, weight)
    //  sets the scalar times the weight of points, and the weight
    template<class Op>
    void meanOnMesh(const Op& op, volScalarField& mean)
    {
        nodeField<nodeVector>& sum = cloud_.nodes_.force;

        this->sumToNodes(makeMaterial(0));
        kernels_.scalarsToGrid(cloud_.view<dim>(), op, sum);
        cloud_.grid_.exchange().sum(sum);

        mean = dimensionedScalar(mean.dimensions(), Zero);
        this->cellMeans
        (
            [&](const label i) { return volume(i); },
            [&]
            (
                const label celli,
                const label n,
                const label* node,
                const scalar* share
            )
            {
                scalar weighted = 0, weight = 0;
                for (label t = 0; t < n; ++t)
                {
                    weighted += share[t]*sum[node[t]][0];
                    weight += share[t]*sum[node[t]][1];
                }
                if (weight > 0) mean[celli] = weighted/weight;
            }
        );
        mean.correctBoundaryConditions();
    }

    //- As filter(), but the second projection of the points over a bed and
    //  of those in it is by their own nodal means: else each pulse would carry
    //  momentum into the bed, several times what friction does. The
    //  momentum of both stays; what both grid and own means resolve does.
    void filterBesideBed(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        if (!c.transfer_->advance(deltaT)) return;

        c.cost_.start("XPIC filter");
        const label n = c.size();
        const size_t nNodes = c.grid_.nNodes();
        pointView<dim> points(c.view<dim>());
        auto inBed = [&](const label p) { return c.bedDistance_[p] < 0; };

        auto& [mass, means, own] = parted_;
        for (int part = 0; part < 2; ++part)
        {
            mass.assign(n + nLanes, 0);
            for (label p = 0; p < n; ++p)
            {
                if (inBed(p) == (part == 1)) mass[p] = c.mass()[p];
            }
            pointView<dim> some(points);
            some.mass = mass.data();
            nodeField<nodeVector>& mean = means[part];
            nodeField<nodeVector>& sum = means[2];
            mean.assign(nNodes, nodeVector{});
            sum.assign(nNodes, nodeVector{});
            kernels_.scalarsToGrid
            (
                some,
                [&](const label p, lanes& m, lanes&)
                {
                    m = loadLanes(some.mass + p);
                },
                sum
            );
            kernels_.velocityToGrid(some, mean);
            c.grid_.exchange().sum(sum);
            c.grid_.exchange().sum(mean);
            this->forActiveNodes
            (
                [&](const label i)
                {
                    mean[i] *= (sum[i][0] > 0 ? 1/sum[i][0] : 0);
                }
            );
            c.boundary_.constrain(mean, true);
        }

        // To all points those of the bed, kept aside, then those over it
        const bool affine = c.transfer_->affine();
        kernels_.gridToVelocity(points, means[1]);
        own.clear();
        auto forComponents = [&](const auto& op)
        {
            for (label p = 0; p < n; ++p)
            {
                if (!inBed(p)) continue;
                for (int d = 0; d < dim; ++d) op(points.v[d][p]);
                for (int d = 0; affine && d < dim*dim; ++d) op(points.C[d][p]);
            }
        };
        forComponents([&](scalar& value) { own.push_back(value); });
        kernels_.gridToVelocity(points, means[0]);
        size_t next = 0;
        forComponents([&](scalar& value) { value = own[next++]; });
    }

    //- Stress of the points, with or without a viscosity of their own
    template<bool eddy>
    void stressOfPoints(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        waterMaterial<dim, eddy> m(makeMaterial<eddy>(deltaT));
        if (c.nStages_ > 0)
        {
            m.mu = 0;
            m.nut = nullptr;
        }
        if (c.cellQuadrature_)
        {
            m.cellPressure = cells_.pressures();
            m.cell = c.points_.cell();
        }
        kernels_.updateStress
        (
            c.view<dim>(), m, 1 - c.transfer_->picFraction(deltaT), c.nodes_,
            c.coupling_
        );
        c.stressWork_ += deltaT*sumLanes(m.stressWork);
        c.correctionWork_ += sumLanes(m.correctionWork);
    }

    //- The rates of points that start or entered, which have none of the step
    //  before: with none a liquid that yields would be stiff for a step. Zero
    //  is no rate, or that of rest: where no node moves nothing has another.
    void startShearRates()
    {
        waterCloud& c = cloud_;
        const scalar* rate = c.points_.column(c.nut_ + 1);
        const scalar* const end = rate + c.size();
        const scalar* first = std::find(rate, end, 0);
        if (first == end || !moves()) return;

        const waterMaterial<dim, true> m(makeMaterial<true>(0));
        pointView<dim> points(c.view<dim>());
        while (first != end)
        {
            const auto isRate = [](const scalar r) { return r != 0; };
            const scalar* const next = std::find_if(first, end, isRate);
            points.n = next - rate;
            kernels_.gradientsToPoints
            (
                points,
                first - rate,
                c.nodes_.velocity,
                [&]
                (
                    const label p,
                    const laneMask& valid,
                    const lanes (&)[dim + 1],
                    const lanes (&L)[dim + 1][dim]
                )
                {
                    lanes s[dim][dim];
                    twiceDeviator<dim>(L, s);
                    m.setRates(p, valid, L, s);
                }
            );
            first = std::find(next, end, 0);
        }
    }

    //- Has any node a velocity
    bool moves()
    {
        bool any = false;
        this->forActiveNodes
        (
            [&](const label i)
            {
                for (int d = 0; d < dim; ++d)
                {
                    any = any || cloud_.nodes_.velocity[i][d] != 0;
                }
            }
        );
        return any;
    }

    //- As accelerate(), with the viscous stress in stages: see waterCloud. With
    //  F the viscous forces of the velocities v of a stage, R all others, the
    //  momentum given is G_j = a (G_j-1 + w dt (F_j-1 + R)) + (1 - a) G_j-2,
    //  v = v_0 + G/m: where viscosity is strong, the v at which the two
    //  balance. The forces of the nodes are then what acts on the mean.
    void accelerateInStages(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        nodalFields& nodes = c.nodes_;
        const pointView<dim> points(c.view<dim>());
        const scalar nu = c.fluid_.mu()/c.fluid_.rho0();
        const scalar* nut = c.nut_ < 0 ? nullptr : c.points_.column(c.nut_);
        nodeField<nodeVector>* const forces[2] =
            {&nodes.force, &nodes.mirrored.force};
        auto& [start, others, now, before] = stages_;

        c.startCost("viscous stages");
        start = nodes.velocity;
        if (!nodes.oldVelocity.empty()) nodes.oldVelocity = nodes.velocity;
        for (int f = 0; f < 2; ++f)
        {
            others[f].swap(*forces[f]);
            for (auto* sum : {forces[f], &now[f], &before[f]})
            {
                sum->assign(others[f].size(), nodeVector{});
            }
        }

        const scalar s = c.nStages_;
        const scalar w = 2/(sqr(s) + s);
        for (label j = 1; j <= c.nStages_; ++j)
        {
            kernels_.stressToGrid
            (
                points,
                nodes.velocity,
                [&]
                (
                    const label p,
                    const laneMask&,
                    const lanes (&L)[dim + 1][dim],
                    lanes (&flux)[dim][dim]
                )
                {
                    lanes viscosity = allLanes(nu);
                    if (nut) viscosity += loadLanes(nut + p);
                    viscosity *= loadLanes(points.mass + p);
                    twiceDeviator<dim>(L, flux);
                    for (int d = 0; d < dim; ++d)
                    {
                        for (int e = 0; e < dim; ++e) flux[d][e] *= -viscosity;
                    }
                },
                nodes
            );
            c.grid_.exchange().sum(nodes.force);

            const scalar a = (2.0*j - 1)/j;
            const auto advance = [&](const int f, const size_t i)
            {
                const nodeVector last = now[f][i];
                now[f][i] =
                    a*(last + w*deltaT*((*forces[f])[i] + others[f][i]))
                  + (1 - a)*before[f][i];
                before[f][i] = last;
                (*forces[f])[i] = nodeVector{};
                return now[f][i] - last;
            };

            // Only the change since the stage before: nodes that depend on
            // each other share it
            this->forActiveNodes
            (
                [&](const label i)
                {
                    const scalar m = nodes.mass(i);
                    const nodeVector change = advance(0, i);
                    for (int d = 0; d < dim; ++d)
                    {
                        nodes.velocity[i][d] += m > 0 ? change[d]/m : 0;
                    }
                }
            );
            for (size_t i = 0; i < others[1].size(); ++i) advance(1, i);
            c.boundary_.constrain(nodes.velocity);
            c.boundary_.react(nodes);
        }

        // The power of others is known, with the velocity at the start
        scalar power = 0;
        this->forActiveNodes
        (
            [&](const label i)
            {
                scalar ofNode = 0;
                for (int d = 0; d < dim; ++d)
                {
                    const scalar mean = now[0][i][d]/deltaT;
                    ofNode += (mean - others[0][i][d])*start[i][d];
                    others[0][i][d] = mean;
                }
                power += c.grid_.share(i)*ofNode;
            }
        );
        c.stressWork_ -= deltaT*power;
        for (size_t i = 0; i < others[1].size(); ++i)
        {
            others[1][i] = now[1][i]/deltaT;
        }
        for (int f = 0; f < 2; ++f) others[f].swap(*forces[f]);
        c.startCost("nodes");
    }

public:

    explicit waterKernelsFor(waterCloud& cloud)
    :
        base(cloud),
        cloud_(cloud)
    {
        const label ny = cloud.grid().stride(1);
        const label nz = cloud.grid().stride(2);
        for (label k = (dim == 3 ? -1 : 0); k <= (dim == 3 ? 1 : 0); ++k)
        for (label j = -1; j <= 1; ++j)
        for (label i = -1; i <= 1; ++i)
        {
            if (i || j || k) neighbours_.push_back(i + j*ny + k*nz);
        }
        findPlated();
    }


    virtual void particlesToGrid()
    {
        cloud_.startCost("particle-to-grid");
        this->sumToNodes(makeMaterial(0));

        cloud_.startCost("nodes");
        this->nodalVelocities();
        cloud_.cost_.stop();
    }


    virtual void updateStress(const scalar deltaT)
    {
        waterCloud& c = cloud_;

        if (c.nut_ >= 0)
        {
            startShearRates();
            c.correctViscosity(deltaT);
        }
        c.findStages(deltaT);

        c.startCost("volume (nodes)");
        saturations();
        if (c.settings_.volumeCorrection)
        {
            fillings<true>();
            c.correctBasins(deltaT);
        }
        else fillings<false>();

        c.startCost("stress and forces");
        if (c.cellQuadrature_) findCellPressures();
        hold();
        if (c.nut_ >= 0) stressOfPoints<true>(deltaT);
        else stressOfPoints<false>(deltaT);
        release();
        if (c.cellQuadrature_)
        {
            c.stressWork_ -=
                deltaT*cells_.addForces(c.boundary_, c.nodes_);
        }
        c.addOutletLoads();

        this->exchangeForces();
        if (c.bodies_) c.pressAtBodies();
        if (c.bed_) filterBesideBed(deltaT);
        else this->filter(deltaT);

        if (c.coupling_ && c.coupling_->contact)
        {
            c.cost_.start("pore pressure");
            c.coupling_->forNodes
            (
                [&](const label i)
                {
                    const scalar J = c.meanVolumeRatio(i);
                    c.coupling_->pressure[i] =
                        J > 0
                      ? max(c.fluid_.pressure(J), c.minPressure_)
                      : 0;
                }
            );
        }
        c.cost_.stop();
    }


    virtual void updateNodes(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        const bool smoothing = c.settings_.smoothing;

        c.startCost("nodes");
        const auto setSmoothed = [&](const label i)
        {
            if (smoothing) c.nodes_.smoothed(i) = c.meanVolumeRatio(i);
        };
        if (c.nStages_ > 0)
        {
            accelerateInStages(deltaT);
            this->forActiveNodes(setSmoothed);
        }
        else this->accelerate(deltaT, setSmoothed);
        if (c.energyBalance_)
        {
            c.stressWork_ -= this->workOfAcceleration(deltaT);
        }
        this->relax(deltaT);
        c.cost_.stop();
    }


    virtual void gridToParticles(const scalar deltaT)
    {
        waterCloud& c = cloud_;

        c.startCost("grid-to-particle");
        waterMaterial<dim> m(makeMaterial(deltaT));
        kernels_.gridToParticle
        (
            c.view<dim>(), m, deltaT, c.nodes_, c.movers_, c.sums_
        );
        c.minJ_ = GREAT;
        for (int l = 0; l < nLanes; ++l) c.minJ_ = min(c.minJ_, m.minJ[l]);
        c.cost_.stop();
    }


    virtual void diffuse
    (
        const scalar deltaT,
        scalar* const (&values)[2],
        const scalar* const (&diffusivities)[2]
    )
    {
        waterCloud& c = cloud_;
        const pointView<dim> points(c.view<dim>());
        const size_t n = c.grid_.nNodes();
        auto& [sum, change, field, slopes] = diffusion_;
        for (nodeField<nodeVector>* f : {&sum, &change, &field})
        {
            f->assign(n, nodeVector{});
        }
        const label stride = c.size() + nLanes;

        kernels_.scalarsToGrid
        (
            points,
            [&](const label p, lanes& a, lanes& b)
            {
                const lanes m = loadLanes(points.mass + p);
                a = m*loadLanes(values[0] + p);
                b = m*loadLanes(values[1] + p);
            },
            sum
        );
        c.grid_.exchange().sum(sum);

        this->forActiveNodes
        (
            [&](const label i)
            {
                const scalar m = c.nodes_.mass(i);
                for (int s = 0; s < 2; ++s)
                {
                    field[i][s] = m > 0 ? sum[i][s]/m : 0;
                }
            }
        );
        const auto slope = [&, stride](const int s, const int d)
        {
            return slopes.data() + (dim*s + d)*stride;
        };
        slopes.resize(2*dim*stride);
        kernels_.scalarsToPoints
        (
            points,
            field,
            [&]
            (
                const label p,
                const laneMask& valid,
                const lanes (&)[dim + 1],
                const lanes (&gradient)[dim + 1][dim]
            )
            {
                for (int s = 0; s < 2; ++s)
                {
                    for (int d = 0; d < dim; ++d)
                    {
                        storeLanes(slope(s, d) + p, gradient[s][d], valid);
                    }
                }
            }
        );

        kernels_.fluxesToGrid
        (
            points,
            [&](const label p, lanes (&flux)[dim][dim])
            {
                const lanes m = loadLanes(points.mass + p);
                for (int s = 0; s < 2; ++s)
                {
                    const lanes D = m*loadLanes(diffusivities[s] + p);
                    for (int d = 0; d < dim; ++d)
                    {
                        flux[d][s] = D*loadLanes(slope(s, d) + p);
                    }
                }
            },
            change
        );
        c.grid_.exchange().sum(change);

        // What falls does so in parts, as if implicit: positive whatever the
        // step. What rises is added: in parts, a point with more than the nodes
        // around it would take the large gain of one that has next to nothing.
        this->forActiveNodes
        (
            [&](const label i)
            {
                const scalar m = c.nodes_.mass(i);
                for (int s = 0; s < 2; ++s)
                {
                    const scalar had = sum[i][s];
                    const scalar gain = -deltaT*change[i][s];
                    field[i][s] = gain < 0 && had > 0 ? had/(had - gain) : 1;
                    sum[i][s] = gain > 0 && m > 0 ? gain/m : 0;
                }
            }
        );
        kernels_.scalarsToPoints
        (
            points,
            field,
            [&]
            (
                const label p,
                const laneMask& valid,
                const lanes (&factor)[dim + 1],
                const lanes (&)[dim + 1][dim]
            )
            {
                for (int s = 0; s < 2; ++s)
                {
                    scalar* value = values[s] + p;
                    storeLanes(value, loadLanes(value)*factor[s], valid);
                }
            }
        );
        kernels_.scalarsToPoints
        (
            points,
            sum,
            [&]
            (
                const label p,
                const laneMask& valid,
                const lanes (&gain)[dim + 1],
                const lanes (&)[dim + 1][dim]
            )
            {
                for (int s = 0; s < 2; ++s)
                {
                    scalar* value = values[s] + p;
                    storeLanes(value, loadLanes(value) + gain[s], valid);
                }
            }
        );
    }


    virtual void updateMeshFields()
    {
        waterCloud& c = cloud_;
        for (auto& [column, mean] : c.meshMeans_)
        {
            const scalar* mass = c.points_.column(c.mass_);
            const scalar* values = c.points_.column(column);
            meanOnMesh
            (
                [=](const label p, lanes& weighted, lanes& weight)
                {
                    weight = loadLanes(mass + p);
                    weighted = weight*loadLanes(values + p);
                },
                *mean
            );
        }

        const waterMaterial<dim> m(makeMaterial(0));
        meanOnMesh
        (
            [&](const label p, lanes& pV, lanes& V)
            {
                V = m.volume(p);
                pV = V*maxLanes
                (
                    c.fluid_.pressure(loadLanes(m.J + p)),
                    allLanes(c.minPressure_)
                );
            },
            c.p_
        );
    }
};


template<class Shape>
autoPtr<cloudKernels> newWaterKernels(waterCloud& cloud)
{
    cloudKernels* kernels;
    const bool plane = cloud.grid().nDim() == 2;
    if (plane) kernels = new waterKernelsFor<Shape, 2>(cloud);
    else kernels = new waterKernelsFor<Shape, 3>(cloud);

    return autoPtr<cloudKernels>(kernels);
}

} // End namespace mpm
} // End namespace Foam

// ************************************************************************* //
