/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "soilPlacement.H"
#include "initialStress.H"
#include "dictionaryEntries.H"
#include "PstreamReduceOps.H"

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

Foam::scalar Foam::mpm::soilPlacement::effectiveWeight
(
    const dictionary& dict
) const
{
    const bool saturated =
        readSwitchOrDefault(dict, "saturated", water_ != nullptr);
    if (saturated && !water_)
    {
        FatalIOErrorInFunction(dict)
            << "keyword saturated is yes, but the scene has no liquid." << nl
            << "    Allowed: no, or a liquid in clouds of"
            << " constant/materialPointProperties" << exit(FatalIOError);
    }
    const scalar buoyancy = saturated ? water_->fluid().rho0() : 0;

    return (soil_.model().rhoS() - buoyancy)/(1 + voidRatio(dict))*g_;
}


void Foam::mpm::soilPlacement::checkStiffness
(
    const placedRegions::placed& region,
    const scalar weight
) const
{
    const soilModel& model = soil_.model();
    if (model.held()) return;

    scalar lowest = GREAT;
    for (label p = region.first; p < region.last; ++p)
    {
        lowest = min(lowest, regions_.up() & soil_.position(p));
    }
    reduce(lowest, minOp<scalar>());

    const scalar pressure = weight*(region.level - lowest);
    const scalar e = voidRatio(region.dict);
    if (!(pressure > 0)) return;

    // By the stiffness that it has under this weight; of a suspension, that
    // of its deposit
    const scalar dense = min(e, model.e0());
    const scalar waveSpeedSqr = model.waveSpeedSqr(pressure, dense);
    const scalar strain = pressure*(1 + dense)/(model.rhoS()*waveSpeedSqr);
    const scalar most = std::log(1 + dense);
    if (strain <= most) return;

    const dictionary control
    (
        refCast<const fvMesh>(soil_.grid().mesh()).solutionDict()
       .subOrEmptyDict("MPM")
    );
    const word cap("maxSoilSoundSpeed");
    const bool capped =
        control.found(cap)
     && waveSpeedSqr > 0.999*sqr(readPositive(control, cap, dimVelocity));
    const dictionary& dict = capped ? control : model.coeffs();
    const bool constant = dict.found("E");
    const word keyword(capped ? cap : constant ? word("E") : word("E0"));
    const scalar value = readPositive
    (
        dict, keyword, capped ? dimVelocity : constant ? dimPressure : dimless
    );

    FatalIOErrorInFunction(dict)
        << "keyword " << keyword << " has the value " << value
        << ": soil so soft is compressed beyond its void ratio, " << dense
        << ", by its own weight (" << pressure << " Pa in the region "
        << region.dict.dictName() << ")." << nl
        << "    Allowed: " << keyword << " > "
        << value*(capped ? std::sqrt(strain/most) : strain/most)
        << exit(FatalIOError);
}


Foam::scalarField Foam::mpm::soilPlacement::startState
(
    scalar voidRatio,
    const symmTensor& stress
) const
{
    const lattice& cells = regions_.cells();
    const label nDim = cells.nDim();
    const label nStress = (nDim == 2 ? 4 : 6);

    scalarField state(soil_.model().stateFields().size(), Zero);
    scalarField values(nStress), whole(nStress);
    soilPoints point;
    point.n = 1;
    point.voidRatio = &voidRatio;
    for (label k = 0; k < nStress; ++k)
    {
        // xx yy zz xy yz zx of the mesh's directions
        values[k] = tensor(stress)
        (
            cells.axis(k < 3 ? k : k - 3), cells.axis(k < 3 ? k : (k - 2) % 3)
        );
        point.stress[k] = &values[k];
        point.wholeStress[k] = &whole[k];
    }
    forAll(state, i) point.state[i] = &state[i];
    soil_.model().initialise(nDim, point);
    return state;
}


void Foam::mpm::soilPlacement::checkRegion
(
    const placedRegions::placed& r
) const
{
    warnUnusual
    (
        r.dict,
        {
            {"voidRatio", 0.2, GREAT, "packings of grains"},
            {"K0", 0.2, 3, "soils"}
        }
    );

    // Nothing but honeycombs of fine or flat grains stands so loose
    const scalar loosest = 0.5;
    const scalar e = voidRatio(r.dict);
    const wordList fields(soil_.model().stateFields());
    const label regime = fields.find("regime");
    if (regime < 0 || 1/(1 + e) >= loosest) return;

    if (label(startState(e, Zero)[regime]) != soilModel::suspended)
    {
        IOWarningInFunction(r.dict)
            << "region " << r.dict.dictName() << " has the solid fraction "
            << 1/(1 + e) << " (void ratio " << e
            << "): its grains touch and carry, and do not settle." << nl
            << "    Usual: for a suspension, less than nsC of the model; for a"
            << " packing, more than " << loosest << " (void ratio < "
            << 1/loosest - 1 << ')' << nl << endl;
    }
}


void Foam::mpm::soilPlacement::checkPoreWater
(
    const placedRegions::placed& r,
    const placedRegions& inWater
) const
{
    // By default what is in a case with water is wet
    if (!readSwitchOrDefault(r.dict, "saturated", true)) return;

    const backgroundGrid& grid = soil_.grid();
    const vector step(regions_.cells().minSpacing()*regions_.up());
    int64_t nDry = 0, nUnder = 0;
    for (label p = r.first; p < r.last; ++p)
    {
        const point x(soil_.position(p));
        const label celli = grid.meshCell(soil_.points().cell()[p]);
        if (inWater.find(x, celli) >= 0) continue;

        ++nDry;
        bool under = false;
        for (point y = x + step; !under && domain_.contains(y); y += step)
        {
            under = inWater.find(y, regions_.cellAt(y)) >= 0;
        }
        nUnder += under;
    }
    reduce(nDry, sumOp<int64_t>());
    reduce(nUnder, sumOp<int64_t>());
    const int64_t n = returnReduce(int64_t(r.size()), sumOp<int64_t>());

    const bool buoyant =
        r.dict.lookupOrDefault<word>("stress", "none") == "geostatic";
    if (nUnder || (nDry && buoyant))
    {
        OSstream& os = IOWarningInFunction(r.dict);
        os  << "region " << r.dict.dictName() << ": " << nDry << " of " << n
            << " points of " << soil_.name()
            << " hold no water in their pores"
            << (buoyant ? ", but are as light as under water" : "");
        if (nUnder) os << ", and " << nUnder << " of them lie under water";
        os  << '.' << nl << "    Allowed: a region of the cloud "
            << water_->name() << " over the"
            << " soil as well, or saturated no; for soil that starts dry"
            << nl << endl;
    }
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::soilPlacement::soilPlacement
(
    soilCloud& soil,
    const dictionary& dict,
    const vector& gravity,
    const waterCloud* water,
    const bool strictKeywords
)
:
    soil_(soil),
    regions_
    (
        soil,
        dict,
        mag(gravity) > 0 ? -gravity/mag(gravity) : vector(Zero),
        {"pressure", "p"},
        strictKeywords
    ),
    g_(mag(gravity)),
    water_(water),
    domain_(soil.grid().mesh().points(), true),
    solids_(nullptr)
{}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

Foam::scalar Foam::mpm::soilPlacement::voidRatio(const dictionary& dict) const
{
    return readBoundedOrDefault
    (
        dict, "voidRatio", dimless, soil_.model().e0(),
        soil_.leastVoidRatio(), GREAT
    );
}


Foam::scalar Foam::mpm::soilPlacement::porosity
(
    const point& x,
    const label celli
) const
{
    const label i = regions_.find(x, celli);
    if (i < 0) return 1;

    const scalar e = voidRatio(regions_.begin()[i].dict);
    return e/(1 + e);
}


Foam::string Foam::mpm::soilPlacement::refusal
(
    const scalar voidRatio,
    const symmTensor& stress
) const
{
    const bool throwing = FatalIOError.throwExceptions(true);
    string reason;
    try
    {
        startState(voidRatio, stress);
    }
    catch (const IOerror& e)
    {
        reason = e.message();
    }
    FatalIOError.throwExceptions(throwing);
    return reason;
}


bool Foam::mpm::soilPlacement::weightAt(const point& x, scalar& weight) const
{
    for (const soilPlacement& s : *solids_)
    {
        const label region = s.regions_.find(x, s.regions_.cellAt(x));
        if (region < 0) continue;

        weight = s.weights_[region];
        return true;
    }
    return false;
}


void Foam::mpm::soilPlacement::checkOverlap(const soilPlacement& other) const
{
    for (const placedRegions::placed& r : other.regions_)
    {
        for (label p = r.first; p < r.last; ++p)
        {
            const point x(other.soil_.position(p));
            const label cell = other.soil_.points().cell()[p];
            const label own = regions_.find(x, soil_.grid().meshCell(cell));
            if (own < 0) continue;

            FatalIOErrorInFunction(r.dict)
                << "region " << r.dict.dictName() << " of the cloud "
                << other.soil_.name() << " overlaps the region "
                << regions_.begin()[own].dict.dictName() << " of the cloud "
                << soil_.name() << " at " << x << '.' << nl
                << "    Allowed: regions of solids that do not overlap"
                << exit(FatalIOError);
        }
    }
}


void Foam::mpm::soilPlacement::findWeights
(
    const UPtrList<soilPlacement>& solids
)
{
    solids_ = &solids;
    weights_.clear();
    for (const placedRegions::placed& r : regions_)
    {
        weights_.append(effectiveWeight(r.dict));
        checkStiffness(r, weights_.last());
    }
}


void Foam::mpm::soilPlacement::setState(const placedRegions* inWater)
{
    for (const placedRegions::placed& r : regions_)
    {
        const autoPtr<initialStress> stress(initialStress::New(r.dict, *this));
        checkRegion(r);
        if (inWater && g_ > 0) checkPoreWater(r, *inWater);

        soil_.setState
        (
            r.first,
            regions_.pointVolumes(r),
            scalarField(r.size(), voidRatio(r.dict)),
            stress->stress(r)
        );
    }
}

// ************************************************************************* //
