/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "skeleton.H"
#include "soilCloud.H"
#include "nodeExchange.H"

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{
    template<class Op>
    void forNodes(const Foam::mpm::skeleton::ranges& active, const Op& op)
    {
        for (const auto& range : active)
        {
            for (Foam::label i = range.first; i < range.second; ++i) op(i);
        }
    }

    // Slots of the record of a kind
    enum slot { unfoldedMass, compressionSum, meanCompression };
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::skeleton::skeleton()
:
    nKinds_(0),
    grainsDiffer_(false)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::skeleton::add(soilCloud& cloud)
{
    const soilModel& model = cloud.model();
    label kind = nKinds_;
    forAll(kind_, i)
    {
        const soilModel& other = clouds_[i]->model();
        if (kind < nKinds_) break;
        if
        (
            other.type() == model.type()
         && other.coeffs().digest() == model.coeffs().digest()
        )
        {
            kind = kind_[i];
        }
    }
    kind_.append(kind);
    nKinds_ = max(nKinds_, kind + 1);
    clouds_.push_back(&cloud);
    if (clouds_.size() == 1) return;

    const soilCloud& first = *clouds_.front();
    const soilModel& ofFirst = first.model();
    if (model.held() != ofFirst.held())
    {
        const bool held = model.held();
        FatalIOErrorInFunction(cloud.dict_)
            << "keyword constitutiveModel is " << model.type() << ", which is "
            << (held ? "" : "not ") << "held in place, but the cloud "
            << first.name() << " of the same velocity field, "
            << ofFirst.type() << ", is" << (held ? " not" : "") << '.' << nl
            << "    Allowed: either all clouds of a velocity field, or none"
            << exit(FatalIOError);
    }
    if (cloud.transfer().filtered() != first.transfer().filtered())
    {
        FatalIOErrorInFunction(cloud.dict_)
            << "keyword transfer is " << cloud.transfer().type()
            << ", but that of the cloud " << first.name()
            << " of the same velocity field is " << first.transfer().type()
            << '.' << nl << "    Allowed: XPIC for all clouds of a velocity"
            << " field, or for none" << exit(FatalIOError);
    }
    grainsDiffer_ =
        grainsDiffer_
     || model.rhoS() != ofFirst.rhoS() || model.d() != ofFirst.d();
    makeNodes(cloud.grid_.nNodes());
}


void Foam::mpm::skeleton::addLimits(stepLimits& limits)
{
    auto largest = [this](scalar soilCloud::* value)
    {
        return [this, value]()
        {
            scalar result = clouds_.front()->*value;
            for (const soilCloud* c : clouds_) result = max(result, c->*value);
            return result;
        };
    };
    limits.addMaximum
    (
        stepLimits::end, largest(&soilCloud::waveSpeedSqr_),
        global_.waveSpeedSqr
    );
    limits.addMaximum
    (
        stepLimits::end, largest(&soilCloud::viscosity_), global_.viscosity
    );
    limits.addMinimum
    (
        stepLimits::end,
        [this]()
        {
            scalar least = GREAT;
            for (const soilCloud* c : clouds_)
            {
                least = min(least, c->minVoidRatio_);
            }
            return least;
        },
        global_.minVoidRatio
    );
    limits.addMaximum
    (
        stepLimits::start, largest(&soilCloud::compressionRate_),
        global_.compressionRate
    );
    limits.addMaximum
    (
        stepLimits::start, largest(&soilCloud::shearSqr_), global_.shearSqr
    );
}


void Foam::mpm::skeleton::makeNodes(const label nNodes)
{
    before_.clear();
    grains_.clear();
    compression_.clear();

    if (mixed()) before_.assign(2*nNodes, 0);
    if (grainsDiffer_) grains_.assign(nNodes, nodeVector{});
    if (nKinds_ > 1)
    {
        compression_.resize(nKinds_);
        for (auto& kind : compression_) kind.assign(nNodes, nodeVector{});
    }
}


void Foam::mpm::skeleton::addToNodes
(
    nodalFields& nodes,
    const ranges& active
)
{
    if (!mixed())
    {
        for (soilCloud* c : clouds_) c->kernels_->addToNodes();
        return;
    }

    if (grainsDiffer_)
    {
        forNodes(active, [&](const label i) { grains_[i] = nodeVector{}; });
    }
    for (auto& kind : compression_)
    {
        forNodes(active, [&](const label i) { kind[i] = nodeVector{}; });
    }

    // What a cloud gives is what a node has more after it
    for (size_t k = 0; k < clouds_.size(); ++k)
    {
        const soilModel& model = clouds_[k]->model();
        forNodes
        (
            active,
            [&](const label i)
            {
                before_[2*i] = nodes.mass(i);
                before_[2*i + 1] = nodes.ghostMass[i];
            }
        );
        clouds_[k]->kernels_->addToNodes();
        forNodes
        (
            active,
            [&](const label i)
            {
                const scalar mass = nodes.mass(i) - before_[2*i];
                const scalar ghosts = nodes.ghostMass[i] - before_[2*i + 1];
                if (grainsDiffer_)
                {
                    grains_[i][0] += mass/model.rhoS();
                    grains_[i][1] += mass*model.d();
                }
                if (nKinds_ > 1)
                {
                    compression_[kind_[k]][i][unfoldedMass] += mass + ghosts;
                }
            }
        );
    }
}


void Foam::mpm::skeleton::exchangeNodes(const nodeExchange& exchange)
{
    if (grainsDiffer_) exchange.sum(grains_);
}


void Foam::mpm::skeleton::addForces
(
    const scalar deltaT,
    nodalFields& nodes,
    const ranges& active
)
{
    for (size_t k = 0; k < clouds_.size(); ++k)
    {
        clouds_[k]->kernels_->addForces(deltaT);
        if (nKinds_ == 1) continue;

        // What is smoothed lies with the force
        nodeField<nodeVector>& own = compression_[kind_[k]];
        forNodes
        (
            active,
            [&](const label i)
            {
                own[i][compressionSum] += nodes.smoothingSum(i);
                nodes.force[i][nodes.nDim] = 0;
            }
        );
    }
}


void Foam::mpm::skeleton::findMeans
(
    const nodeExchange& exchange,
    const ranges& active
)
{
    for (auto& kind : compression_)
    {
        exchange.sum(kind);
        forNodes
        (
            active,
            [&](const label i)
            {
                const scalar mass = kind[i][unfoldedMass];
                kind[i][meanCompression] =
                    mass > 0 ? kind[i][compressionSum]/mass : 0;
            }
        );
    }
}


void Foam::mpm::skeleton::giveMean
(
    const soilCloud& cloud,
    nodalFields& nodes,
    const ranges& active
) const
{
    label k = 0;
    while (clouds_[k] != &cloud) ++k;

    const nodeField<nodeVector>& own = compression_[kind_[k]];
    forNodes
    (
        active,
        [&](const label i) { nodes.smoothed(i) = own[i][meanCompression]; }
    );
}


size_t Foam::mpm::skeleton::memory() const
{
    return
        sizeof(scalar)*before_.size()
      + sizeof(nodeVector)*(grains_.size() + nKinds_*(
            compression_.empty() ? 0 : compression_.front().size()
        ));
}

// ************************************************************************* //
