/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterKernels.H"
#include "waterMaterial.H"
#include "waterCloud.H"
#include "cloudKernelsFor.H"
#include "cellQuadrature.H"

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
        std::vector<scalar> slopes[2];
    }
    diffusion_;

    //- Offsets to the neighbours of a node
    std::vector<label> neighbours_;

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

    //- Call op(node, offsets to its neighbours) for the active nodes. Nodes on
    //  the rim of the box, which points of this rank do not reach, have none.
    template<class Op>
    void forNeighbourhoods(const Op& op) const
    {
        static const std::vector<label> none;
        const label rim = neighbours_.back();
        const label beyond = label(cloud_.nodes_.saturation.size()) - rim;
        this->forActiveNodes
        (
            [&](const label i)
            {
                op(i, i >= rim && i < beyond ? neighbours_ : none);
            }
        );
    }

    //- Volume of the water over that of the pores, and the share of the
    //  pressure that follows from the most of it nearby: see waterMaterial
    void saturations()
    {
        waterCloud& c = cloud_;
        const std::vector<scalar>& inversePoreVolume =
            c.coupling_
          ? c.coupling_->inversePoreVolume : c.boundary_.inverseVolume();
        std::vector<scalar>& S = c.nodes_.saturation;
        std::vector<scalar>& filling = c.nodes_.filling;

        this->forActiveNodes
        (
            [&](const label i) { S[i] = volume(i)*inversePoreVolume[i]; }
        );
        if (c.bodies_)
        {
            if (c.cellQuadrature_) waterSaturation_ = S;
            c.addBodySaturation(inversePoreVolume);
        }
        forNeighbourhoods
        (
            [&](const label i, const std::vector<label>& neighbours)
            {
                scalar most = S[i];
                for (const label n : neighbours)
                {
                    if (most >= waterCloud::fullSaturation) break;
                    most = max(most, S[i + n]);
                }
                filling[i] = waterCloud::filling(most);
            }
        );
    }

    //- How much the volume at each node is off: inside the water any error but
    //  what a plane surface nearby explains, elsewhere only an excess
    void volumeErrors()
    {
        waterCloud& c = cloud_;
        const std::vector<scalar>& inverseVolume = c.boundary_.inverseVolume();
        const std::vector<scalar>& S = c.nodes_.saturation;
        nodalFields& nodes = c.nodes_;

        forNeighbourhoods
        (
            [&](const label i, const std::vector<label>& neighbours)
            {
                // Nodes behind walls have no control volume
                scalar least = neighbours.size() ? S[i] : 0;
                if (least > waterCloud::insideSaturation)
                {
                    for (const label n : neighbours)
                    {
                        const scalar s = S[i + n];
                        if (s < least && inverseVolume[i + n] > 0) least = s;
                    }
                }
                nodes.volumeError(i) =
                    least <= waterCloud::insideSaturation
                  ? max(0.0, S[i] - waterCloud::outsideSaturation)
                  : S[i] >= 1
                  ? S[i] - 1
                  : min(0.0, S[i] - 1 + surfaceDefect<Shape>(least));
            }
        );

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

    //- Mean of a scalar of the points by mass, on the mesh
    void meanOnMesh(const scalar* values, volScalarField& mean)
    {
        waterCloud& c = cloud_;
        nodeField<nodeVector>& sum = c.nodes_.force;

        this->sumToNodes(makeMaterial(0));
        const pointView<dim> points(c.view<dim>());
        kernels_.scalarsToGrid
        (
            points,
            [&](const label p, lanes& weighted, lanes& weight)
            {
                weight = loadLanes(points.mass + p);
                weighted = weight*loadLanes(values + p);
            },
            sum
        );
        c.grid_.exchange().sum(sum);

        mean.primitiveFieldRef() = 0;
        this->cellMeans
        (
            [&](const label i) { return volume(i); },
            [&]
            (
                const label celli,
                const label n,
                const label* node,
                const scalar* weight
            )
            {
                scalar weighted = 0, mass = 0;
                for (label t = 0; t < n; ++t)
                {
                    weighted += weight[t]*sum[node[t]][0];
                    mass += weight[t]*sum[node[t]][1];
                }
                if (mass > 0) mean[celli] = weighted/mass;
            }
        );
        mean.correctBoundaryConditions();
    }

    //- Stress of the points, with or without a viscosity of their own
    template<bool eddy>
    void stressOfPoints(const scalar deltaT)
    {
        waterCloud& c = cloud_;
        waterMaterial<dim, eddy> m(makeMaterial<eddy>(deltaT));
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

        if (c.nut_ >= 0) c.correctViscosity(deltaT);

        c.startCost("volume (nodes)");
        saturations();
        if (c.settings_.volumeCorrection)
        {
            volumeErrors();
            c.correctBasins(deltaT);
        }

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
        this->filter(deltaT);

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
        this->accelerate
        (
            deltaT,
            [&](const label i)
            {
                if (smoothing) c.nodes_.smoothed(i) = c.meanVolumeRatio(i);
            }
        );
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

        for (int s = 0; s < 2; ++s)
        {
            this->forActiveNodes
            (
                [&](const label i)
                {
                    const scalar m = c.nodes_.mass(i);
                    field[i][dim] = m > 0 ? sum[i][s]/m : 0;
                }
            );
            slopes[s].resize(dim*stride);
            scalar* slope = slopes[s].data();
            kernels_.scalarToPoints
            (
                points,
                field,
                [&]
                (
                    const label p,
                    const laneMask& valid,
                    const lanes&,
                    const lanes (&gradient)[dim]
                )
                {
                    for (int d = 0; d < dim; ++d)
                    {
                        storeLanes(slope + d*stride + p, gradient[d], valid);
                    }
                }
            );
        }

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
                        flux[d][s] =
                            D*loadLanes(slopes[s].data() + d*stride + p);
                    }
                }
            },
            change
        );
        c.grid_.exchange().sum(change);

        // What falls does so as if implicit: positive whatever the step
        for (int s = 0; s < 2; ++s)
        {
            this->forActiveNodes
            (
                [&](const label i)
                {
                    const scalar had = sum[i][s];
                    const scalar gain =
                        had > 0 ? -deltaT*change[i][s]/had : 0;
                    field[i][dim] = gain > 0 ? 1 + gain : 1/(1 - gain);
                }
            );
            scalar* value = values[s];
            kernels_.scalarToPoints
            (
                points,
                field,
                [&]
                (
                    const label p,
                    const laneMask& valid,
                    const lanes& factor,
                    const lanes (&)[dim]
                )
                {
                    storeLanes
                        (value + p, loadLanes(value + p)*factor, valid);
                }
            );
        }
    }


    virtual void updateMeshFields()
    {
        waterCloud& c = cloud_;
        for (auto& [column, mean] : c.meshMeans_)
        {
            meanOnMesh(c.points_.column(column), *mean);
        }

        nodeField<nodeVector>& pressure = c.nodes_.force;
        const waterMaterial<dim> m(makeMaterial(0));

        // Mean pressure by volume, in the slots 0 (sum) and 1 (weight)
        this->sumToNodes(m);
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
        c.grid_.exchange().sum(pressure);

        c.p_ = dimensionedScalar(dimPressure, Zero);
        this->cellMeans
        (
            [&](const label i) { return volume(i); },
            [&]
            (
                const label celli,
                const label n,
                const label* node,
                const scalar* weight
            )
            {
                scalar pV = 0, V = 0;
                for (label t = 0; t < n; ++t)
                {
                    pV += weight[t]*pressure[node[t]][0];
                    V += weight[t]*pressure[node[t]][1];
                }
                if (V > 0) c.p_[celli] = pV/V;
            }
        );
        c.p_.correctBoundaryConditions();
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
