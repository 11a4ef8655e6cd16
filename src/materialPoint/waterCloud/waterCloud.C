/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "waterCloud.H"
#include "dictionaryEntries.H"
#include "PstreamReduceOps.H"
#include "zeroGradientFvPatchFields.H"
#include <algorithm>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(waterCloud, 0);
}
}

// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

void Foam::mpm::waterCloud::select()
{
    // Plain APIC at its own time-step limit, and no more dissipative when the
    // time step is cut
    const scalar apicRate =
        2*fluid_.soundSpeed()/grid_.cells().minSpacing();

    selectTransfer("APIC", settings_.coupled ? coupledApicRate : apicRate);

    kernels_ = newWaterKernels
    (
        *this,
        waterVariant
        {
            grid_.nDim(),
            transfer_->affine(),
            fluid_.viscous(),
            settings_.smoothing
        }
    );
}


void Foam::mpm::waterCloud::findMinVolumeRatio()
{
    minJ_ = 1;
    for (label p = 0; p < size(); ++p)
    {
        if (!(J()[p] > 0))
        {
            FatalErrorInFunction
                << "cloud " << name() << ": point " << p << " in "
                << time().timePath()/cloud::prefix/name()
                << " has the volume ratio J = " << J()[p]
                << "; it must be positive." << exit(FatalError);
        }
        minJ_ = min(minJ_, J()[p]);
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

void Foam::mpm::waterCloud::derivedFields
(
    HashTable<tmp<scalarField>>& fields
) const
{
    tmp<scalarField> p(new scalarField(size()));
    tmp<scalarField> rho(new scalarField(size()));
    for (label i = 0; i < size(); ++i)
    {
        p.ref()[i] = max(fluid_.pressure(J()[i]), minPressure_);
        rho.ref()[i] = fluid_.rho0()/J()[i];
    }
    fields.set("p", p);
    fields.set("rho", rho);
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::waterCloud::waterCloud
(
    const word& name,
    const fvMesh& mesh,
    const backgroundGrid& grid,
    const dictionary& dict,
    const settings& control,
    costMeter& cost,
    const vector& g
)
:
    materialPointCloud
    (
        name, mesh, grid, dict, control, cost, g, nodeBoundary::slipCorners
    ),
    fluid_(dict, control.strictKeywords),
    J_(points_.add("J", pointStorage::scalarValue)),
    gradJ_
    (
        control.smoothing ? points_.add("gradJ", pointStorage::vectorValue) : -1
    ),
    minPressure_
    (
        readSwitchOrDefault(dict, "tensionCutOff", false) ? 0 : -VGREAT
    ),
    p_
    (
        IOobject
        (
            "p",
            mesh.time().timeName(),
            mesh,
            IOobject::NO_READ,
            IOobject::AUTO_WRITE
        ),
        mesh,
        dimensionedScalar(dimPressure, Zero),
        zeroGradientFvPatchScalarField::typeName
    ),
    stressWork_(0),
    correctionWork_(0),
    minJ_(1)
{
    if (!fluid_.autoSoundSpeed()) select();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

void Foam::mpm::waterCloud::checkDictionary
(
    const dictionary& dict,
    const bool strictKeywords
)
{
    checkKeywords
    (
        dict,
        {
            "constitutiveModel",
            word(weaklyCompressibleNewtonian::typeName) + "Coeffs",
            "transfer",
            "apicRate",
            "flipDampingRate",
            "tensionCutOff"
        },
        strictKeywords
    );
}


void Foam::mpm::waterCloud::findSoundSpeed
(
    const scalar surface,
    const scalar speed
)
{
    if (!fluid_.autoSoundSpeed()) return;

    // Heights are measured against gravity, from the lowest floor
    const scalar g = mag(g_);
    const vector up = (g > 0 ? -g_/g : vector(Zero));

    scalar floor = GREAT;
    for (const point& x : mesh_.points()) floor = min(floor, up & x);
    reduce(floor, minOp<scalar>());

    scalar lowest = GREAT;
    findMaxSpeed();
    scalar fastest = maxSpeed();
    for (label p = 0; p < size(); ++p)
    {
        scalar height = 0;
        for (label d = 0; d < grid_.nDim(); ++d)
        {
            height += up[grid_.cells().axis(d)]*x(d)[p];
        }
        lowest = min(lowest, height);
    }
    reduce(lowest, minOp<scalar>());
    reduce(fastest, maxOp<scalar>());

    // Half a cell: points stand off the floor
    const scalar drop =
        max(scalar(0), lowest - floor - grid_.cells().minSpacing());
    const scalar depth = max(scalar(0), surface - floor);
    const scalar reference = max
    (
        max(speed, fastest),
        max(std::sqrt(2*g*drop), std::sqrt(g*depth))
    );

    if (reference <= SMALL)
    {
        FatalIOErrorInFunction
        (
            dict_.subDict(word(weaklyCompressibleNewtonian::typeName) + "Coeffs")
        )   << "keyword soundSpeed is auto, but the scene has neither gravity"
            << " nor speed to find it from (c = 0)." << nl
            << "    Allowed: soundSpeed > 0 m/s, about 10 times the fastest"
            << " flow expected" << exit(FatalIOError);
    }
    fluid_.setSoundSpeed(10*reference);
    select();

    Info<< "Speed of sound of " << name() << ": " << fluid_.soundSpeed()
        << " m/s = 10 max(inlet " << speed << ", initial " << fastest
        << ", sqrt(2 g drop) " << std::sqrt(2*g*drop)
        << ", sqrt(g H) " << std::sqrt(g*depth) << ')' << endl;
}


void Foam::mpm::waterCloud::setState
(
    const label first,
    const UList<scalar>& volume,
    const UList<scalar>& pressure
)
{
    forAll(volume, i)
    {
        const scalar J = fluid_.volumeRatio(pressure[i]);
        points_.column(J_)[first + i] = J;
        points_.column(mass_)[first + i] = fluid_.rho0()*volume[i]/J;
    }
}


void Foam::mpm::waterCloud::finishPoints()
{
    materialPointCloud::finishPoints();
    findMinVolumeRatio();
}


Foam::scalar Foam::mpm::waterCloud::maxWaveSpeed() const
{
    return fluid_.soundSpeed(minJ_);
}


Foam::scalar Foam::mpm::waterCloud::viscosity() const
{
    return fluid_.mu()/fluid_.rho0();
}


void Foam::mpm::waterCloud::energy
(
    const vector& g,
    scalar& kinetic,
    scalar& potential,
    scalar& elastic
) const
{
    materialPointCloud::energy(g, kinetic, potential, elastic);
    for (label p = 0; p < size(); ++p)
    {
        elastic += mass()[p]/fluid_.rho0()*fluid_.elasticEnergy(J()[p]);
    }
}


bool Foam::mpm::waterCloud::writeMeshFields() const
{
    const bool ok = p_.write();
    return materialPointCloud::writeMeshFields() && ok;
}


void Foam::mpm::waterCloud::readPoints()
{
    materialPointCloud::readPoints();
    findMinVolumeRatio();
}


void Foam::mpm::waterCloud::readState(const dictionary& dict)
{
    materialPointCloud::readState(dict);

    if (fluid_.autoSoundSpeed())
    {
        fluid_.setSoundSpeed(readPositive(dict, "soundSpeed", dimVelocity));
        select();
    }
    if (Pstream::master())
    {
        stressWork_ = dict.lookupOrDefault<scalar>("stressWork", 0);
        correctionWork_ = dict.lookupOrDefault<scalar>("correctionWork", 0);
    }
}


void Foam::mpm::waterCloud::writeState(dictionary& dict) const
{
    materialPointCloud::writeState(dict);

    dict.set("soundSpeed", fluid_.soundSpeed());
    dict.set("stressWork", returnReduce(stressWork_, sumOp<scalar>()));
    dict.set("correctionWork", returnReduce(correctionWork_, sumOp<scalar>()));
}


void Foam::mpm::waterCloud::effects(List<FixedList<string, 3>>& table) const
{
    auto add = [&](const string& effect, const bool on, const string& why)
    {
        table.append
        (
            FixedList<string, 3>({effect, on ? "on" : "off", why})
        );
    };
    add("cloud " + name(), true, Foam::name(globalSize()) + " points");
    add("  transfer", true, transfer_->description());
    add
    (
        "  viscous stress", fluid_.viscous(),
        "mu = " + Foam::name(fluid_.mu()) + " Pa s"
    );
    add
    (
        "  pressure smoothing", settings_.smoothing,
        "fvSolution/MPM/smoothing"
    );
    add
    (
        "  volume correction", settings_.volumeCorrection,
        "fvSolution/MPM/volumeCorrection"
    );
    add("  tension cut-off", minPressure_ == 0, "tensionCutOff");
}


Foam::scalar Foam::mpm::waterCloud::densityVariation() const
{
    if (!size()) return 0;

    std::vector<scalar> variation(size());
    for (label p = 0; p < size(); ++p) variation[p] = mag(1/J()[p] - 1);
    const auto percentile = variation.begin() + label(0.99*(size() - 1));
    std::nth_element(variation.begin(), percentile, variation.end());
    return *percentile;
}

// ************************************************************************* //
