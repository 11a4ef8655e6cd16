/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "soilKernels.H"
#include "soilMaterial.H"
#include "soilCloud.H"
#include "waterCloud.H"
#include "cloudKernelsFor.H"
#include <algorithm>
#include <cmath>

namespace Foam
{
namespace mpm
{

template<class Shape, int dim>
class soilKernelsFor
:
    public cloudKernelsFor<Shape, dim>
{
    typedef cloudKernelsFor<Shape, dim> base;
    typedef soilMaterial<dim> material;

    using base::kernels_;

    //- Points that the constitutive model takes at once, about; their work
    //  space stays in the first-level cache
    static constexpr label chunk = 128;

    soilCloud& cloud_;
    soilWorkSpace<dim> work_;

    //- Weight of suspended grains near walls that they press, and the tiles
    //  that are; empty without such walls or without water
    nodalFields suspended_;
    std::vector<char> pressedTiles_;


    material makeMaterial()
    {
        soilCloud& c = cloud_;
        const bool smooth = c.compression_ >= 0;

        material m
        {
            c.points_.column(c.mass_),
            c.points_.column(c.voidRatio_),
            1/c.model_->rhoS(),
            {},
            soilCloud::compactionRate*c.fallRate(),
            smooth ? c.points_.column(c.compression_) : nullptr,
            smooth ? c.points_.column(c.compressionMean_) : nullptr,
            {},
            soilCloud::smoothingFraction*c.waveSpeed()
           /c.grid_.cells().minSpacing(),
            0,
            &work_
        };
        for (int d = 0; d < dim; ++d)
        {
            m.compressionGradient[d] =
                smooth ? c.points_.column(c.compressionGradient_ + d) : nullptr;
            m.gravity[d] = c.acceleration_[c.grid_.cells().axis(d)];
        }
        return m;
    }

    //- Saturation around the points begin .. end - 1: that of their tiles
    void findSaturation(const label begin, const label end)
    {
        const soilCloud& c = cloud_;
        const label* tile = c.points_.tile();
        for (label i = begin; i < end; ++i)
        {
            work_.saturation[i - begin] =
                i > begin && tile[i] == tile[i - 1]
              ? work_.saturation[i - begin - 1]
              : kernels_.saturation
                (
                    c.coupling_->saturation,
                    c.liquid_->nodes().momentum,
                    tile[i]
                );
        }
    }

    //- Solid fraction that the grid shows inside, at points begin .. end - 1
    void findInside(const label begin, const label end)
    {
        const soilCloud& c = cloud_;
        const label* tile = c.points_.tile();
        work_.inside.resize(work_.speed.size());
        for (label p = begin; p < end; ++p)
        {
            work_.inside[p - begin] =
                p > begin && tile[p] == tile[p - 1]
              ? work_.inside[p - begin - 1]
              : kernels_.inside(c.nodes_.velocity, tile[p]);
        }
    }

    //- |D|^2 of the shear in velocity gradient i of the chunk
    scalar shearRateSqr(const label i) const
    {
        scalar trace = 0, sum = 0;
        for (int c = 0; c < dim; ++c)
        {
            trace += work_.gradient[c*dim + c][i];
            for (int d = 0; d < dim; ++d)
            {
                sum += sqr
                (
                    work_.gradient[c*dim + d][i] + work_.gradient[d*dim + c][i]
                )/8;
            }
        }
        return max(sum - trace*trace/(2*dim), scalar(0));
    }

    //- Volumetric strain of the points begin .. end - 1 that their velocity
    //  gradients do not see, see soilMaterial
    void loosen(const material& m, const label begin, const label end)
    {
        for (label p = begin; p < end; ++p)
        {
            const label i = p - begin;
            const scalar ratio =
                material::overLoosening*work_.inside[i]*(1 + m.voidRatio[p]);
            if (ratio >= 1) continue;

            const scalar excess = -std::log(max(ratio, SMALL));
            const scalar slow =
                min(m.compactionRate, std::sqrt(shearRateSqr(i)));
            const scalar rate =
                slow*min(material::maxExcess, excess)
              + m.compactionRate
               *min
                (
                    material::maxExcess,
                    max(scalar(0), excess - material::maxExcess)
                );
            for (int d = 0; d < dim; ++d)
            {
                work_.gradient[d*dim + d][i] += rate/dim;
            }
        }
    }

    //- What the constitutive model sees of the points begin .. end - 1
    soilPoints modelPoints
    (
        const label begin,
        const label end,
        const bool wet
    )
    {
        soilCloud& c = cloud_;
        soilPoints s(c.modelPoints(begin, end));
        if (wet)
        {
            findSaturation(begin, end);
            s.saturation = work_.saturation.data();
        }
        else
        {
            s.liquidViscosity = 0;
        }
        for (int i = 0; i < dim*dim; ++i)
        {
            s.velocityGradient[i] = work_.gradient[i].data();
        }
        for (int i = 0; i < work_.nStress; ++i)
        {
            s.wholeStress[i] = work_.stress[i].data();
        }
        s.solidFraction = work_.solidFraction.data();
        s.speed = work_.speed.data();
        s.power = c.energyBalance_ ? work_.power.data() : nullptr;
        return s;
    }

    //- What presses walls, without the weight of suspended grains: the water
    //  carries it. Of grains that no water carries it is the force of the wall
    //  itself.
    void releaseSuspended()
    {
        soilCloud& c = cloud_;
        bool any = false;
        for (const soilCloud* s : c.skeleton_->clouds())
        {
            any = any || s->regime_ >= 0;
        }

        // The same on all ranks
        if (!any || !c.boundary_.nodeWalls() || !c.liquid_) return;

        if (pressedTiles_.empty())
        {
            pressedTiles_ =
                c.boundary_.tiles().with(c.boundary_.pressedNodes());
            suspended_.force.assign(c.grid_.nNodes(), nodeVector{});
            suspended_.saturation.assign(c.grid_.nNodes(), 0);
        }
        nodeField<nodeVector>& weight = suspended_.force;
        this->forActiveNodes([&](const label i) { weight[i] = nodeVector{}; });
        for (soilCloud* s : c.skeleton_->clouds())
        {
            s->kernels_->addSuspended(pressedTiles_, weight);
        }
        c.grid_.exchange().sum(weight);

        const nodeField<nodeVector>& water = c.liquid_->nodes().momentum;
        this->forActiveNodes
        (
            [&](const label i)
            {
                suspended_.saturation[i] =
                    water[i][dim] > 0 ? c.coupling_->saturation[i] : 0.0;
            }
        );
        c.boundary_.relieve(weight, suspended_.saturation);
    }

public:

    explicit soilKernelsFor(soilCloud& cloud)
    :
        base(cloud),
        cloud_(cloud)
    {}


    virtual void particlesToGrid()
    {
        soilCloud& c = cloud_;
        skeleton& grains = *c.skeleton_;

        c.startCost("particle-to-grid");
        c.zeroNodes();
        grains.addToNodes(c.nodes_, c.order_.nodeRanges());
        this->completeSums();
        grains.exchangeNodes(c.grid_.exchange());

        c.startCost("nodes");
        this->nodalVelocities();

        // The solid fraction that the grid shows
        const std::vector<scalar>& inverseVolume = c.boundary_.inverseVolume();
        if (grains.grainsDiffer())
        {
            this->forActiveNodes
            (
                [&](const label i)
                {
                    c.nodes_.solidFraction(i) =
                        grains.solidVolume(i)*inverseVolume[i];
                }
            );
        }
        else
        {
            const scalar inverseRhoS = 1/c.model_->rhoS();
            this->forActiveNodes
            (
                [&](const label i)
                {
                    c.nodes_.solidFraction(i) =
                        c.nodes_.mass(i)*inverseRhoS*inverseVolume[i];
                }
            );
        }
        c.cost_.stop();
    }


    virtual void addToNodes()
    {
        kernels_.particleToGrid
        (
            cloud_.template view<dim>(), makeMaterial(), cloud_.nodes_
        );
    }


    virtual void updateStress(const scalar deltaT)
    {
        soilCloud& c = cloud_;
        skeleton& grains = *c.skeleton_;

        c.startCost("stress and forces");
        grains.addForces(deltaT, c.nodes_, c.order_.nodeRanges());
        this->exchangeForces();
        grains.findMeans(c.grid_.exchange(), c.order_.nodeRanges());
        releaseSuspended();
        this->filter(deltaT);
        c.cost_.stop();
    }


    virtual void addForces(const scalar deltaT)
    {
        soilCloud& c = cloud_;
        const label n = c.size();
        const label* tile = c.points_.tile();
        const scalar keep = 1 - c.transfer_->picFraction(deltaT);
        const nodeField<nodeVector>* water =
            c.liquid_ ? &c.liquid_->nodes().momentum : nullptr;
        couplingFields* const coupling =
            c.coupling_ && c.coupling_->contact ? c.coupling_ : nullptr;

        material m(makeMaterial());
        pointView<dim> view(c.template view<dim>());

        c.waveSpeedSqr_ = 0;
        c.viscosity_ = 0;
        c.minVoidRatio_ = GREAT;

        for (label begin = 0; begin < n;)
        {
            label end = min(begin + chunk, n);
            while (end < n && tile[end] == tile[end - 1]) ++end;

            work_.resize(end - begin);
            m.begin = begin;
            view.n = end;
            if (c.settings_.looseningCorrection)
            {
                findInside(begin, end);
                loosenedSoilMaterial<dim> loosened(m);
                kernels_.gradientToParticle
                    (view, begin, loosened, keep, c.nodes_);
                loosen(m, begin, end);
            }
            else
            {
                kernels_.gradientToParticle(view, begin, m, keep, c.nodes_);
            }

            soilPoints s(modelPoints(begin, end, coupling));
            c.model_->update(dim, s, deltaT);
            c.waveSpeedSqr_ = max(c.waveSpeedSqr_, s.maxWaveSpeedSqr);
            c.viscosity_ = max(c.viscosity_, s.maxViscosity);
            if (m.compression)
            {
                c.model_->elasticCompression(s, m.compression + begin);
            }

            for (label i = begin; i < end; ++i)
            {
                c.minVoidRatio_ = min(c.minVoidRatio_, m.voidRatio[i]);
            }
            if (s.power)
            {
                for (label i = begin; i < end; ++i)
                {
                    c.stressWork_ += deltaT*s.power[i - begin]*c.volume(i);
                }
            }
            kernels_.forcesToGrid(view, begin, m, c.nodes_, coupling, water);
            begin = end;
        }
    }


    virtual void addSuspended
    (
        const std::vector<char>& tiles,
        nodeField<nodeVector>& weight
    )
    {
        soilCloud& c = cloud_;
        if (c.regime_ < 0) return;

        const scalar* mass = c.points_.column(c.mass_);
        const scalar* regime = c.points_.column(c.regime_);
        scalar gravity[dim];
        for (int d = 0; d < dim; ++d)
        {
            gravity[d] = c.acceleration_[c.grid_.cells().axis(d)];
        }
        auto ofSuspended = [&](const label p, lanes (&force)[dim])
        {
            const lanes zero{};
            const lanes m =
                loadLanes(regime + p) == allLanes(soilModel::suspended)
              ? loadLanes(mass + p)
              : zero;
            for (int d = 0; d < dim; ++d) force[d] = m*gravity[d];
        };

        const label n = c.size();
        const label* tile = c.points_.tile();
        pointView<dim> view(c.template view<dim>());
        for (label begin = 0; begin < n;)
        {
            bool any = false;
            label end = begin;
            for (; end < n && tile[end] == tile[begin]; ++end)
            {
                any = any || regime[end] == soilModel::suspended;
            }
            if (any && tiles[tile[begin]])
            {
                view.n = end;
                kernels_.vectorsToGrid(view, begin, ofSuspended, weight);
            }
            begin = end;
        }
    }


    virtual void updateNodes(const scalar deltaT)
    {
        soilCloud& c = cloud_;

        c.startCost("nodes");
        if (c.compression_ >= 0 && !c.skeleton_->severalKinds())
        {
            // The mean compression; ghost nodes have their own
            this->accelerate
            (
                deltaT,
                [&](const label i)
                {
                    nodalFields& nodes = c.nodes_;
                    const scalar unfolded =
                        nodes.mass(i) + nodes.ghostMass[i];
                    nodes.smoothed(i) =
                        unfolded > 0 ? nodes.smoothingSum(i)/unfolded : 0;
                }
            );
        }
        else
        {
            this->accelerate(deltaT, [](const label) {});
        }
        if (c.model_->held())
        {
            this->forActiveNodes
            (
                [&](const label i)
                {
                    for (int d = 0; d < dim; ++d) c.nodes_.velocity[i][d] = 0;
                }
            );
        }
        if (c.energyBalance_)
        {
            c.stressWork_ -= this->workOfAcceleration(deltaT);
        }
        this->relax(deltaT);
        c.cost_.stop();
    }


    virtual void gridToParticles(const scalar deltaT)
    {
        soilCloud& c = cloud_;

        c.startCost("grid-to-particle");
        if (c.compression_ >= 0 && c.skeleton_->severalKinds())
        {
            c.skeleton_->giveMean(c, c.nodes_, c.order_.nodeRanges());
        }
        material m(makeMaterial());
        kernels_.gridToParticle
        (
            c.template view<dim>(), m, deltaT, c.nodes_, c.movers_, c.sums_
        );
        c.cost_.stop();
    }


    virtual void slip
    (
        const scalar deltaT,
        const nodeField<nodeVector>& stress,
        const nodeField<nodeVector>& normal,
        const surfaceSlip& law
    )
    {
        soilCloud& c = cloud_;
        scalar* own[dim];
        for (int d = 0; d < dim; ++d)
        {
            own[d] = c.points_.column(c.bedStress_ + d);
        }
        const scalar part = 1 - std::exp(-deltaT/law.averagingTime());

        const size_t nMovers = c.movers_.size();
        kernels_.shiftPoints
        (
            c.template view<dim>(), stress, normal,
            [&]
            (
                const label begin,
                const label n,
                const auto& tau,
                const auto& up,
                auto& shift
            )
            {
                const scalar* ownStress[dim];
                const scalar* upward[dim];
                scalar* velocity[dim];
                for (int d = 0; d < dim; ++d)
                {
                    ownStress[d] = own[d] + begin;
                    upward[d] = up[d];
                    velocity[d] = shift[d];
                }
                for (label i = 0; i < n; ++i)
                {
                    // Normals of nodes far from the surface are zero
                    scalar near = 0;
                    for (int d = 0; d < dim; ++d) near += sqr(up[d][i]);
                    if (near < 0.25) continue;

                    for (int d = 0; d < dim; ++d)
                    {
                        scalar& mean = own[d][begin + i];
                        mean += part*(tau[d][i] - mean);
                    }
                }
                law.velocity(n, ownStress, upward, up[dim], velocity);
                for (int d = 0; d < dim; ++d)
                {
                    for (label i = 0; i < n; ++i) shift[d][i] *= deltaT;
                }
            },
            c.movers_
        );

        // Those that moved anyhow are there already
        if (c.movers_.size() > nMovers)
        {
            std::sort(c.movers_.begin(), c.movers_.end());
            c.movers_.erase
            (
                std::unique(c.movers_.begin(), c.movers_.end()),
                c.movers_.end()
            );
        }
    }


    virtual void updateMeshFields()
    {
        soilCloud& c = cloud_;
        const scalar inverseRhoS = 1/c.model_->rhoS();

        this->sumToNodes(makeMaterial());
        this->cellMeans
        (
            [&](const label i)
            {
                return c.nodes_.mass(i)*inverseRhoS;
            },
            [](const label, const label, const label*, const scalar*) {}
        );
    }
};


template<class Shape>
autoPtr<cloudKernels> newSoilKernels(soilCloud& cloud)
{
    cloudKernels* kernels;
    const bool plane = cloud.grid().nDim() == 2;
    if (plane) kernels = new soilKernelsFor<Shape, 2>(cloud);
    else kernels = new soilKernelsFor<Shape, 3>(cloud);

    return autoPtr<cloudKernels>(kernels);
}

} // End namespace mpm
} // End namespace Foam

// ************************************************************************* //
