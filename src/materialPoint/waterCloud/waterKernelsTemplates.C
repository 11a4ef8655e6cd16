/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterKernels.H"
#include "waterMaterial.H"
#include "waterCloud.H"

namespace Foam
{
namespace mpm
{

template<class Shape, int dim, bool affine, bool viscous, bool smoothing>
class waterKernelsFor
:
    public waterKernels
{
    typedef waterMaterial<dim, viscous, smoothing> material;

    waterCloud& cloud_;
    const transferKernels<Shape, dim, affine> kernels_;

    //- Offsets to the neighbours of a node
    std::vector<label> neighbours_;


    material makeMaterial(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        const scalar courant = c.fluid_.soundSpeed()*deltaT
           /c.grid_.cells().minSpacing();

        material m
        {
            c.fluid_,
            c.points_.column(c.mass_),
            c.points_.column(c.J_),
            {},
            deltaT,
            {},
            c.settings_.volumeCorrection
              ? waterCloud::correctionRate*courant : 0,
            1 - std::exp(-waterCloud::smoothingRate*courant),
            c.minPressure_
        };
        for (int d = 0; d < dim; ++d)
        {
            m.gradJ[d] = smoothing ? c.points_.column(c.gradJ_ + d) : nullptr;
            m.gravity[d] = c.g_[c.grid_.cells().axis(d)];
        }
        return m;
    }

    template<class Op>
    void forActiveNodes(const Op& op)
    {
        for (const auto& range : cloud_.order_.nodeRanges())
        {
            for (label i = range.first; i < range.second; ++i) op(i);
        }
    }

    void sumToNodes()
    {
        waterCloud& c = cloud_;
        const material m(makeMaterial(0));

        c.zeroNodes();
        kernels_.particleToGrid(c.view<dim>(), m, c.nodes_);

        if (!c.grid_.exchange().idle())
        {
            c.cost_.start("halo exchange");
            c.grid_.exchange().sum(c.nodes_.momentum);
            c.grid_.exchange().sum(c.nodes_.ghostMass);
            if (dim == 3) c.grid_.exchange().sum(c.nodes_.volume);
        }
    }

    scalar volume(const label i) const
    {
        const nodalFields& n = cloud_.nodes_;
        if constexpr (dim == 2) return n.momentum[i][dim + 1];
        else return n.volume[i];
    }

    //- How much the volume at each node is off, into the scalar slot of the
    //  velocity: inside the water any error, elsewhere only an excess
    void volumeErrors()
    {
        const std::vector<scalar>& inverseVolume =
            cloud_.boundary_.inverseVolume();
        std::vector<scalar>& S = cloud_.nodes_.saturation;
        nodeField<nodeVector>& velocity = cloud_.nodes_.velocity;

        forActiveNodes
        (
            [&](const label i) { S[i] = volume(i)*inverseVolume[i]; }
        );
        forActiveNodes
        (
            [&](const label i)
            {
                bool inside = S[i] > waterCloud::insideSaturation;
                if (inside)
                {
                    for (const label n : neighbours_)
                    {
                        // Nodes behind walls have no control volume
                        inside = inside
                         &&
                            (
                                S[i + n] > waterCloud::insideSaturation
                             || inverseVolume[i + n] == 0
                            );
                    }
                }
                velocity[i][dim] = inside ? S[i] - 1 : max(0.0, S[i] - 1.1);
            }
        );
    }

public:

    explicit waterKernelsFor(waterCloud& cloud)
    :
        cloud_(cloud),
        kernels_(cloud.boundary())
    {
        const label ny = cloud.grid().stride(1);
        const label nz = cloud.grid().stride(2);
        for (label k = (dim == 3 ? -1 : 0); k <= (dim == 3 ? 1 : 0); ++k)
        for (label j = -1; j <= 1; ++j)
        for (label i = -1; i <= 1; ++i)
        {
            if (i || j || k) neighbours_.push_back(i + j*ny + k*nz);
        }
    }


    virtual void particlesToGrid()
    {
        waterCloud& c = cloud_;
        nodalFields& nodes = c.nodes_;

        c.cost_.start("particle-to-grid");
        sumToNodes();

        c.cost_.start("nodes");
        forActiveNodes
        (
            [&](const label i)
            {
                const scalar m = nodes.momentum[i][dim];
                nodeVector v = nodes.momentum[i]*(m > 0 ? 1/m : 0);
                for (int k = dim; k < 4; ++k) v[k] = 0;
                nodes.velocity[i] = v;
            }
        );
        c.boundary_.constrain(nodes.velocity);

        if (c.settings_.volumeCorrection)
        {
            c.cost_.start("volume correction (nodes)");
            volumeErrors();
        }
        c.cost_.stop();
    }


    virtual void updateStress(const scalar deltaT)
    {
        waterCloud& c = cloud_;

        c.cost_.start("stress and forces");
        const scalar keep = 1 - c.transfer_->picFraction(deltaT);
        material m(makeMaterial(deltaT));
        kernels_.updateStress(c.view<dim>(), m, keep, c.nodes_);
        c.stressWork_ += deltaT*sumLanes(m.stressWork);
        c.correctionWork_ += sumLanes(m.correctionWork);

        if (!c.grid_.exchange().idle())
        {
            c.cost_.start("halo exchange");
            c.grid_.exchange().sum(c.nodes_.force);
        }

        if (c.transfer_->filtered())
        {
            c.cost_.start("XPIC filter");
            nodeField<nodeVector>& filter = c.filter_;
            forActiveNodes([&](const label i) { filter[i] = nodeVector{}; });
            kernels_.velocityToGrid(c.view<dim>(), filter);
            c.grid_.exchange().sum(filter);
            forActiveNodes
            (
                [&](const label i)
                {
                    const scalar m = c.nodes_.momentum[i][dim];
                    filter[i] *= (m > 0 ? 1/m : 0);
                }
            );
            c.boundary_.constrain(filter, true);
            kernels_.gridToVelocity(c.view<dim>(), filter);
        }
        c.cost_.stop();
    }


    virtual void updateNodes(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        nodalFields& nodes = c.nodes_;
        const scalar rho0 = c.fluid_.rho0();

        c.cost_.start("nodes");
        if (c.settings_.energyBalance) nodes.oldVelocity = nodes.velocity;

        forActiveNodes
        (
            [&](const label i)
            {
                const scalar m = nodes.momentum[i][dim];
                nodeVector v = nodes.velocity[i]
                  + (m > 0 ? deltaT/m : 0)*nodes.force[i];

                if constexpr (smoothing)
                {
                    // The smoothed volume ratio; ghost nodes have their own
                    const scalar unfolded = m + nodes.ghostMass[i];
                    v[dim] =
                        unfolded > 0 ? rho0*nodes.force[i][dim]/unfolded : 0;
                }
                nodes.velocity[i] = v;
            }
        );
        c.boundary_.constrain(nodes.velocity);

        if (c.settings_.energyBalance)
        {
            // The work of the stresses was summed with the old velocity; the
            // kinetic energy changes with the mean of old and new
            scalar work = 0;
            forActiveNodes
            (
                [&](const label i)
                {
                    scalar power = 0;
                    for (int d = 0; d < dim; ++d)
                    {
                        const scalar weight = nodes.momentum[i][dim]
                           *c.g_[c.grid_.cells().axis(d)];
                        power += (nodes.force[i][d] - weight)
                           *(nodes.velocity[i][d] - nodes.oldVelocity[i][d]);
                    }
                    work += c.grid_.share(i)*power;
                }
            );
            c.stressWork_ -= 0.5*deltaT*work;
        }
        c.cost_.stop();
    }


    virtual void gridToParticles(const scalar deltaT)
    {
        waterCloud& c = cloud_;

        c.cost_.start("grid-to-particle");
        material m(makeMaterial(deltaT));
        kernels_.gridToParticle
        (
            c.view<dim>(), m, deltaT, c.nodes_, c.movers_, c.sums_
        );
        c.minJ_ = GREAT;
        for (int l = 0; l < nLanes; ++l) c.minJ_ = min(c.minJ_, m.minJ[l]);
        c.cost_.stop();
    }


    virtual void updateMeshFields()
    {
        waterCloud& c = cloud_;
        const backgroundGrid& grid = c.grid_;
        nodeField<nodeVector>& pressure = c.nodes_.force;

        sumToNodes();

        // Mean pressure by volume, in the slots 0 (sum) and 1 (weight)
        const material m(makeMaterial(0));
        kernels_.scalarsToGrid
        (
            c.view<dim>(),
            [&](const label p, lanes& pV, lanes& V)
            {
                V = m.volume(p);
                pV = V*maxLanes
                (
                    c.fluid_.pressure(loadLanes(m.J + p)),
                    allLanes(c.minPressure_)
                );
            },
            pressure
        );
        grid.exchange().sum(pressure);

        const std::vector<scalar>& inverseVolume = c.boundary_.inverseVolume();
        const label T = Shape::tileWidth;

        c.alpha_ = dimensionedScalar(dimless, Zero);
        c.p_ = dimensionedScalar(dimPressure, Zero);
        c.U_.primitiveFieldRef() = Zero;

        for (label celli = 0; celli < c.mesh_.nCells(); ++celli)
        {
            const label cell = grid.boxCell(celli);
            if (!c.order_.active(cell)) continue;

            const label s = c.boundary_.stencil(cell);
            scalar alpha = 0, mass = 0, pV = 0, V = 0;
            vector momentum(Zero);

            for (label t = 0; t < tile<Shape, dim>::size; ++t)
            {
                scalar w = Shape::cellIntegral[t % T]
                   *Shape::cellIntegral[(t/T) % T];
                if (dim == 3) w *= Shape::cellIntegral[t/(T*T)];

                label i = cell + grid.tileOffset() + grid.tileNode(t);
                nodeVector sign{1, 1, 1, 1};
                if (s >= 0)
                {
                    i = c.boundary_.targets(s)[t];
                    sign = c.boundary_.signs(s)[t];
                }
                alpha += w*volume(i)*inverseVolume[i];
                mass += w*c.nodes_.momentum[i][dim];
                for (int d = 0; d < dim; ++d)
                {
                    momentum[grid.cells().axis(d)] +=
                        w*sign[d]*c.nodes_.momentum[i][d];
                }
                pV += w*pressure[i][0];
                V += w*pressure[i][1];
            }
            c.alpha_[celli] = alpha;
            if (mass > 0) c.U_[celli] = momentum/mass;
            if (V > 0) c.p_[celli] = pV/V;
        }
        c.alpha_.correctBoundaryConditions();
        c.U_.correctBoundaryConditions();
        c.p_.correctBoundaryConditions();
    }
};


template<class Shape>
autoPtr<waterKernels> newWaterKernels
(
    waterCloud& cloud,
    const waterKernels::variant& v
)
{
    // Run-time flags to template arguments, one at a time
    auto choose = [&](const auto dim, const auto affine, const auto viscous)
    {
        constexpr int nDim = decltype(dim)::value;
        constexpr bool a = decltype(affine)::value;
        constexpr bool mu = decltype(viscous)::value;

        waterKernels* kernels;
        if (v.smoothing)
        {
            kernels = new waterKernelsFor<Shape, nDim, a, mu, true>(cloud);
        }
        else
        {
            kernels = new waterKernelsFor<Shape, nDim, a, mu, false>(cloud);
        }
        return autoPtr<waterKernels>(kernels);
    };
    auto chooseViscous = [&](const auto dim, const auto affine)
    {
        return v.viscous
          ? choose(dim, affine, std::true_type())
          : choose(dim, affine, std::false_type());
    };
    auto chooseAffine = [&](const auto dim)
    {
        return v.affine
          ? chooseViscous(dim, std::true_type())
          : chooseViscous(dim, std::false_type());
    };
    return v.nDim == 2
      ? chooseAffine(std::integral_constant<int, 2>())
      : chooseAffine(std::integral_constant<int, 3>());
}

} // End namespace mpm
} // End namespace Foam

// ************************************************************************* //
