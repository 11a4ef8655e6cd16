/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "erosionCriteria.H"
#include "listed.H"
#include "waterCloud.H"
#include "dictionaryEntries.H"
#include "gravityMeshObject.H"
#include "volFields.H"
#include "soilCloud.H"
#include "OSspecific.H"
#include "PstreamReduceOps.H"
#include "functionNeeds.H"
#include "addToRunTimeSelectionTable.H"
#include <limits>

namespace Foam
{
namespace mpm
{
    defineTypeNameAndDebug(erosionCriteria, 0);
    addToRunTimeSelectionTable(functionObject, erosionCriteria, dictionary);

    static const functionNeeds::add needsOfErosionCriteria
    (
        "erosionCriteria", functionNeeds::WRITE_TIMES
    );
}
}

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

using namespace Foam;

const scalar noNumber = std::numeric_limits<scalar>::quiet_NaN();


//- Mean of what is a number; none if nothing is
class meanOfNumbers
{
    scalar sum_ = 0;
    label n_ = 0;

public:

    void add(const scalar s)
    {
        if (std::isnan(s)) return;
        sum_ += s;
        ++n_;
    }

    scalar value() const { return n_ ? sum_/n_ : noNumber; }
};

} // End anonymous namespace


// * * * * * * * * * * * * * Private Member Functions  * * * * * * * * * * * //

const Foam::mpm::waterCloud& Foam::mpm::erosionCriteria::water
(
    const dictionary& dict
) const
{
    const waterCloud* water = dynamic_cast<const waterCloud*>
    (
        mesh_.findObject<materialPointCloud>(waterName())
    );
    if (!water)
    {
        FatalIOErrorInFunction(dict)
            << "keyword water is " << waterName() << '.' << nl
            << "    Allowed for " << type() << ": a liquid, one of "
            << listed(mesh_.sortedNames<waterCloud>())
            << exit(FatalIOError);
    }
    return *water;
}


void Foam::mpm::erosionCriteria::readCriteria(const dictionary& dict)
{
    const weaklyCompressibleNewtonian& fluid = water(dict).fluid();

    erosionCriterion::bed bed;
    bed.d = soil().model().d();
    bed.rhoS = soil().model().rhoS();
    bed.frictionAngle =
        dict.found("frictionAngle")
      ? readBounded(dict, "frictionAngle", dimless, 0, 90, true)
      : -1;
    bed.rho = fluid.rho0();
    bed.mu = fluid.mu();
    bed.g = mag(meshObjects::gravity::New(mesh_.time()).value());

    names_ = dict.lookupOrDefault<wordList>
    (
        "criteria", wordList({"Shields", "vanRijn", "Annandale"})
    );
    criteria_.clear();
    criteria_.setSize(names_.size());
    forAll(names_, i)
    {
        criteria_.set(i, erosionCriterion::New(names_[i], dict, bed).ptr());
    }
}


void Foam::mpm::erosionCriteria::readHeights(const dictionary& dict)
{
    shearStress_ = readChoiceOrDefault
    (
        dict, "shearStress", "logLaw", {"logLaw", "viscous", "wallLaw"}
    );
    logLaw_ = shearStress_ == "logLaw";
    wallLaw_ = shearStress_ == "wallLaw";
    if (wallLaw_ && !soil().hasBedForce())
    {
        FatalIOErrorInFunction(dict)
            << "keyword shearStress is wallLaw, which needs turbulence kEpsilon"
            << " or realizableKE of the " << waterName() << ", and drag between it and the "
            << soil().name() << '.' << nl
            << "    Allowed here: logLaw, viscous" << exit(FatalIOError);
    }
    roughness_ = readBoundedOrDefault
    (
        dict, "roughness", dimLength,
        roughnessPerDiameter*soil().model().d(), 0, GREAT
    );

    const scalar h = cloud().grid().cells().spacing(vertical());
    heights_ = dict.lookupOrDefault<Tuple2<scalar, scalar>>
    (
        "heights", Tuple2<scalar, scalar>(2*h, 4*h)
    );

    // A line needs two cells, the law of the wall one above z0
    const scalar lowest = lowestHeight();
    const scalar least = (logLaw_ ? 1 : 2)*h;
    if
    (
        !(heights_.first() >= lowest)
     || !(heights_.second() - heights_.first() >= least*(1 - SMALL))
    )
    {
        FatalIOErrorInFunction(dict)
            << "keyword heights is " << heights_ << '.' << nl
            << "    Allowed for shearStress " << shearStress_
            << ": two heights [m], the first >= " << lowest
            << ", the second at least " << least << " higher"
            << exit(FatalIOError);
    }
}


void Foam::mpm::erosionCriteria::readProfiles(const dictionary& dict)
{
    profiles_ = dict.lookupOrDefault<scalarList>("profiles", scalarList());

    const scalar half = 0.5*cloud().grid().cells().spacing(along());
    const scalar first = surfaces().coordinate(0) - half;
    const scalar last =
        surfaces().coordinate(surfaces().nStations() - 1) + half;
    for (const scalar x : profiles_)
    {
        if (x >= first && x <= last) continue;

        FatalIOErrorInFunction(dict)
            << "keyword profiles: " << x << " is outside of the mesh." << nl
            << "    Allowed: coordinates between " << first << " and " << last
            << exit(FatalIOError);
    }
}


Foam::label Foam::mpm::erosionCriteria::nearestStation(const scalar x) const
{
    const scalar h = cloud().grid().cells().spacing(along());
    const label s = std::floor((x - surfaces().coordinate(0))/h + 0.5);
    return max(label(0), min(surfaces().nStations() - 1, s));
}


Foam::mpm::erosionCriteria::profile
Foam::mpm::erosionCriteria::findProfile() const
{
    auto alpha = [&](const word& name)
    {
        return surfaces().gather
        (
            mesh_.lookupObject<volScalarField>
            (
                IOobject::groupName("alpha", name)
            )
        );
    };
    auto velocity = [&](const word& name)
    {
        const volVectorField& U = mesh_.lookupObject<volVectorField>
        (
            IOobject::groupName("U", name)
        );
        List<scalarField> u(1, surfaces().gather(U, along()));
        for (label d = 0; d < cloud().grid().nDim(); ++d)
        {
            if (d != along() && d != vertical())
            {
                u.append(surfaces().gather(U, d));
            }
        }
        return u;
    };
    return profile
    {
        alpha(waterName()),
        alpha(cloud().name()),
        velocity(waterName()),
        velocity(cloud().name())
    };
}


Foam::tmp<Foam::vectorField> Foam::mpm::erosionCriteria::findWallLaw() const
{
    const lattice& cells = cloud().grid().cells();
    List<nodeVector> found;
    soil().bedForce(found);

    volVectorField force
    (
        IOobject("bedForce", mesh_.time().timeName(), mesh_),
        mesh_,
        dimensionedVector(dimless, Zero)
    );
    volScalarField area
    (
        IOobject("bedArea", mesh_.time().timeName(), mesh_),
        mesh_,
        dimensionedScalar(dimless, Zero)
    );
    forAll(found, celli)
    {
        for (label d = 0; d < cells.nDim(); ++d)
        {
            force[celli][cells.axis(d)] = found[celli][d];
        }
        area[celli] = found[celli][3];
    }

    // Of columns, over the area of their bed; the first component is along
    // the profile
    const scalarField areas(surfaces().gather(area));
    tmp<vectorField> stress(new vectorField(surfaces().nColumns(), Zero));
    scalarField sums(stress().size(), Zero);
    direction component = 0;
    for (label d : {along(), 3 - along() - vertical()})
    {
        if (d >= cells.nDim() || d == vertical()) continue;
        const scalarField forces(surfaces().gather(force, d));
        forAll(forces, k)
        {
            stress.ref()[k/surfaces().nRows()][component] += forces[k];
        }
        ++component;
    }
    forAll(areas, k) sums[k/surfaces().nRows()] += max(areas[k], scalar(0));
    forAll(sums, c)
    {
        if (sums[c] > 0) stress.ref()[c] /= sums[c];
        else stress.ref()[c] = vector::uniform(noNumber);
    }
    return stress;
}


Foam::mpm::erosionCriteria::flow Foam::mpm::erosionCriteria::findFlow
(
    const profile& u,
    const columnSurfaces::heights& h,
    const label column
) const
{
    const scalar bed = h.bed[column], surface = h.water[column];
    flow result{noNumber, noNumber, noNumber, noNumber};
    if (std::isnan(bed)) return result;

    result.depth = surface > bed ? surface - bed : 0;
    const scalar half = 0.5*cloud().grid().cells().spacing(vertical());

    // The band, lowered to the highest cells that are full of water where it
    // holds too few of them
    const label needed = logLaw_ ? 1 : 2;
    scalar lower = heights_.first(), upper = heights_.second();
    scalar highest = -GREAT;
    label inBand = 0;
    for (label row = 0; row < surfaces().nRows(); ++row)
    {
        const label k = column*surfaces().nRows() + row;
        const scalar z = surfaces().height(row) + half - bed;
        if (z < 0 || z > result.depth || u.alphaWater[k] < 0.5) continue;

        highest = max(highest, z);
        inBand += z >= lower && z <= upper;
    }
    if (inBand < needed)
    {
        // Above what the grid mixes with the bed, if there is enough
        const scalar clear =
            min(3*half, highest - (needed - 1)*2*half*(1 + 1e-6));
        lower = max(highest - (upper - lower), clear);
        lower = max(lower, max(lowestHeight(), 0.5*half));
        upper = highest;
    }

    // Sums over the cells of the band; of the velocities by direction
    label n = 0;
    scalar sumZ = 0, sumL = 0, sumLL = 0;
    scalarList sumU(u.water.size(), Zero), sumUL(u.water.size(), Zero);
    scalar volume = 0, flux = 0;

    for (label row = 0; row < surfaces().nRows(); ++row)
    {
        const label k = column*surfaces().nRows() + row;
        const scalar z = surfaces().height(row) + half - bed;
        if (z < 0 || z > result.depth || u.alphaWater[k] < 0) continue;

        volume += u.alphaWater[k];
        flux += u.alphaWater[k]*u.water[0][k];

        if
        (
            z < lower || z > upper
         || u.alphaWater[k] < 0.5
        )
        {
            continue;
        }
        const scalar L = logLaw_ ? std::log(30*z/roughness_) : z;
        ++n;
        sumZ += z;
        sumL += L;
        sumLL += L*L;
        forAll(sumU, d)
        {
            sumU[d] += u.water[d][k];
            sumUL[d] += u.water[d][k]*L;
        }
    }
    if (volume > 0) result.meanVelocity = flux/volume;
    if (wallLaw_ || n < needed) return result;
    result.height = sumZ/n;

    // u = slope L, or with an intercept for the straight line
    scalarList slope(sumU.size());
    forAll(slope, d)
    {
        slope[d] =
            logLaw_
          ? sumUL[d]/sumLL
          : (n*sumUL[d] - sumL*sumU[d])/(n*sumLL - sqr(sumL));
    }
    scalar size = 0;
    for (const scalar s : slope) size += sqr(s);
    size = std::sqrt(size);

    const weaklyCompressibleNewtonian& fluid = water(dictionary::null).fluid();
    result.shearVelocity =
        sign(slope[0])
       *(logLaw_ ? kappa*size : std::sqrt(fluid.mu()/fluid.rho0()*size));
    return result;
}


void Foam::mpm::erosionCriteria::findMotion
(
    const scalarField& bed,
    scalarField& speed,
    scalarField& layer
) const
{
    const lattice& cells = soil().grid().cells();
    const scalar h = cells.spacing(vertical());
    const scalar area = surfaces().area()*cells.thickness();

    scalarField mass(bed.size(), Zero);
    speed = scalarField(bed.size(), Zero);
    layer = scalarField(bed.size(), Zero);
    for (label p = 0; p < soil().size(); ++p)
    {
        scalar v = 0;
        for (label d = 0; d < cells.nDim(); ++d) v += sqr(soil().v(d)[p]);
        v = std::sqrt(v);

        const label c = surfaces().column(soil().points().cell()[p]);
        const scalar depth =
            bed[c] - surfaces().heightOf(soil().x(vertical())[p]);
        if (depth >= 0 && depth <= h)
        {
            mass[c] += soil().mass()[p];
            speed[c] += soil().mass()[p]*v;
        }
        if (v > movingSpeed_) layer[c] += soil().volume(p)/area;
    }
    sumToMaster(mass);
    sumToMaster(speed);
    sumToMaster(layer);
    forAll(mass, c) speed[c] = mass[c] > 0 ? speed[c]/mass[c] : noNumber;
}


void Foam::mpm::erosionCriteria::writeProfiles() const
{
    if (profiles_.empty()) return;

    const columnSurfaces::heights h(find());
    const profile u(findProfile());
    if (!writeToFile() || !Pstream::master()) return;

    const label nRows = surfaces().nRows(), n = surfaces().nStations();
    const scalar half = 0.5*cloud().grid().cells().spacing(vertical());

    const fileName directory(baseFileDir()/prefix_/mesh_.time().timeName());
    mkDir(directory);
    OFstream os(directory/"velocityProfiles.csv");
    initStream(os);
    os  << "x,z,height,water,soil,alphaWater,alphaSoil" << nl;
    for (const scalar x : profiles_)
    {
        const label station = nearestStation(x);
        meanOfNumbers bed;
        for (label c = station; c < h.bed.size(); c += n) bed.add(h.bed[c]);

        for (label row = 0; row < nRows; ++row)
        {
            // Of all columns across: volumes, and velocities weighted by them
            scalar water = 0, soil = 0, waterFlux = 0, soilFlux = 0;
            label columns = 0;
            for (label c = station; c < h.bed.size(); c += n)
            {
                const label k = c*nRows + row;
                if (u.alphaSoil[k] < 0) continue;
                ++columns;
                water += u.alphaWater[k];
                soil += u.alphaSoil[k];
                waterFlux += u.alphaWater[k]*u.water[0][k];
                soilFlux += u.alphaSoil[k]*u.soil[0][k];
            }
            if (!columns) continue;

            const scalar z = surfaces().height(row) + half;
            os  << surfaces().coordinate(station) << ',' << z << ','
                << z - bed.value() << ','
                << (water > 0 ? waterFlux/water : noNumber) << ','
                << (soil > 0 ? soilFlux/soil : noNumber) << ','
                << water/columns << ',' << soil/columns << nl;
        }
    }
}


// * * * * * * * * * * * * Protected Member Functions  * * * * * * * * * * * //

Foam::wordList Foam::mpm::erosionCriteria::keywords() const
{
    wordList names(bedTimeSeries::keywords());
    names.append
    (
        wordList
        ({
            "criteria", "frictionAngle", "shearStress", "roughness", "heights",
            "movingSpeed", "profiles"
        })
    );
    return names;
}


void Foam::mpm::erosionCriteria::readEntries(const dictionary& dict)
{
    bedTimeSeries::readEntries(dict);
    readCriteria(dict);
    readHeights(dict);
    readProfiles(dict);
    movingSpeed_ = readBoundedOrDefault
    (
        dict, "movingSpeed", dimVelocity, 0.01, 0, GREAT, true
    );
}


Foam::stringList Foam::mpm::erosionCriteria::description() const
{
    DynamicList<string> lines;
    if (wallLaw_)
    {
        lines.append
        (
            "Shear stress by the law of the wall that turbulence takes (nan:"
            " none, or before the first step)"
        );
    }
    else
    {
        lines.append
        (
            string("Shear stress by ")
          + (logLaw_ ? "the law of the rough wall, roughness "
               + Foam::name(roughness_) + " m" : string("viscosity"))
          + ", from water " + Foam::name(heights_.first()) + " to "
          + Foam::name(heights_.second()) + " m above the bed"
        );
        lines.append
        (
            "Water too thin for these heights: from the highest cells that are"
            " full of it (column velocityHeight: their mean height)"
        );
        lines.append
        (
            string("nan: no water, or none left: fewer than ")
          + (logLaw_ ? "one full cell" : "two full cells") + " over the bed"
        );
    }
    forAll(criteria_, i)
    {
        const erosionCriterion& c = criteria_[i];
        lines.append
        (
            names_[i] + ": critical shear stress "
          + Foam::name(c.shearStress()) + " Pa, shear velocity "
          + Foam::name(c.shearVelocity()) + " m/s, Shields number "
          + Foam::name(c.shieldsNumber()) + ", stream power "
          + Foam::name(c.streamPower()) + " W/m2"
        );
    }
    lines.append("Units: m, m/s, Pa, W/m2; soil moves above "
      + Foam::name(movingSpeed_) + " m/s");
    return stringList(lines);
}


Foam::wordList Foam::mpm::erosionCriteria::columns() const
{
    wordList names
    ({
        "x", "bed", "depth", "meanVelocity", "shearVelocity", "shearStress",
        "streamPower", "soilSpeed", "movingLayer"
    });
    for (const word& criterion : names_)
    {
        names.append(word(criterion + "Stress"));
        names.append(word(criterion + "Exceeded"));
    }
    names.append("velocityHeight");
    return names;
}


Foam::List<Foam::scalarList> Foam::mpm::erosionCriteria::rows() const
{
    const columnSurfaces::heights h(find());
    const profile u(findProfile());
    const scalar rho = water(dictionary::null).fluid().rho0();

    scalarField speed, layer;
    findMotion(h.bed, speed, layer);
    const tmp<vectorField> stresses
    (
        wallLaw_ ? findWallLaw() : tmp<vectorField>()
    );

    const label n = surfaces().nStations();
    List<scalarList> lines(n);
    forAll(lines, station)
    {
        // Numbers of the columns across; the first is the coordinate
        List<meanOfNumbers> means(columns().size());
        for (label c = station; c < h.bed.size(); c += n)
        {
            flow f(findFlow(u, h, c));
            if (wallLaw_ && !std::isnan(f.depth + stresses()[c].x()))
            {
                const vector& tau = stresses()[c];
                f.shearVelocity = sign(tau.x())*std::sqrt(mag(tau)/rho);
            }
            const scalar stress = rho*f.shearVelocity*mag(f.shearVelocity);

            label i = 1;
            for
            (
                const scalar s :
                {
                    h.bed[c], f.depth, f.meanVelocity, f.shearVelocity, stress,
                    mag(stress*f.meanVelocity), speed[c],
                    std::isnan(h.bed[c]) ? noNumber : layer[c]
                }
            )
            {
                means[i++].add(s);
            }
            for (const erosionCriterion& criterion : criteria_)
            {
                const scalar critical = criterion.shearStress();
                means[i++].add(critical);
                means[i++].add
                (
                    std::isnan(stress) ? noNumber
                  : mag(stress) > critical ? 1 : 0
                );
            }
            means[i].add(f.height);
        }
        lines[station].setSize(means.size());
        forAll(means, i) lines[station][i] = means[i].value();
        lines[station][0] = surfaces().coordinate(station);
    }
    return lines;
}


// * * * * * * * * * * * * * * * * Constructors  * * * * * * * * * * * * * * //

Foam::mpm::erosionCriteria::erosionCriteria
(
    const word& name,
    const Time& runTime,
    const dictionary& dict
)
:
    bedTimeSeries(name, runTime, dict, "erosionCriteria"),
    logLaw_(true),
    wallLaw_(false),
    roughness_(0),
    heights_(0, 0),
    movingSpeed_(0)
{
    start(dict);
    writeProfiles();
}


// * * * * * * * * * * * * * * * Member Functions  * * * * * * * * * * * * * //

bool Foam::mpm::erosionCriteria::execute()
{
    if (mesh_.time().writeTime()) writeProfiles();
    return true;
}

// ************************************************************************* //
