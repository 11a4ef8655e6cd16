/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "bedLoadModel.H"
#include "bedWall.H"
#include <cmath>
#include <vector>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

const scalar pi = 3.14159265358979;
const scalar angle = 35*pi/180;
const scalar d = 1e-3;


//- Quartz in water, on cells so large that they resolve nothing; gravity
//  points along -down
bedLoadModel::bed quartz(const nodeVector& down)
{
    return bedLoadModel::bed
    {
        3, d, 2650, std::tan(angle), 0.6, 1000, 9.81, down, 1
    };
}


autoPtr<bedLoadModel> make
(
    const word& name,
    const nodeVector& down = nodeVector{0, 0, -1, 0},
    const dictionary& coeffs = dictionary()
)
{
    dictionary dict;
    dict.name() = "materialPointProperties.soil";
    dict.set("bedLoad", name);
    if (!coeffs.empty()) dict.set(word(name + "Coeffs"), coeffs);
    return bedLoadModel::New(dict, quartz(down), true);
}


scalar transport(const bedLoadModel& m, const scalar theta, const scalar cr)
{
    scalar q = -1;
    m.transport(1, &theta, &cr, &q);
    return q;
}


//- Velocity for a Shields parameter, towards t, on a bed with a normal [m/s];
//  all grains in a layer of 10 d
nodeVector velocity
(
    const bedLoadModel& m,
    const scalar theta,
    const nodeVector& t,
    const nodeVector& normal
)
{
    scalar tau[3], n[3], v[3], perThickness = 1/(10*d);
    const scalar *tauOf[3], *nOf[3];
    scalar* vOf[3];
    for (int i = 0; i < 3; ++i)
    {
        tau[i] = theta*1650*9.81*d*t[i];
        n[i] = normal[i];
        tauOf[i] = tau + i;
        nOf[i] = n + i;
        vOf[i] = v + i;
    }
    m.velocity(1, tauOf, nOf, &perThickness, vOf);
    return nodeVector{v[0], v[1], v[2], 0};
}

} // End anonymous namespace


TEST_CASE("bedLoadModel: the formulas")
{
    // By hand
    const auto mpm = make("MeyerPeterMueller");
    atMost
    (
        "Meyer-Peter and Mueller at 0.147: error",
        mag(transport(*mpm, 0.147, 0.047) - 0.2529822128), 1e-9
    );
    const auto wp = make("WongParker");
    atMost
    (
        "Wong and Parker at 0.1495: error",
        mag(transport(*wp, 0.1495, 0.0495) - 0.1255424231), 1e-9
    );
    atMost("at the critical one", transport(*mpm, 0.047, 0.047), 0);
    atMost("below it", transport(*mpm, 0.03, 0.047), 0);
    atMost
    (
        "critical ones: error",
        mag(mpm->criticalShields() - 0.047)
      + mag(wp->criticalShields() - 0.0495), 1e-15
    );
    // sqrt(1.65*9.81*1e-9)
    atMost
    (
        "scale of the transport: error",
        mag(mpm->transportScale()/1.27226e-4 - 1), 1e-5
    );
}


TEST_CASE("bedLoadModel: critical stress on slopes")
{
    const scalar mu = std::tan(angle);
    for (const scalar degrees : {0.0, 10.0, 25.0, 34.0})
    {
        const scalar b = degrees*pi/180, s = std::sin(b), c = std::cos(b);
        atMost
        (
            "down " + std::to_string(int(degrees)) + " degrees: error",
            mag
            (
                bedLoadModel::slopeFactor(s, s*s, c, mu)
              - std::sin(angle - b)/std::sin(angle)
            ), 1e-12
        );
        atMost
        (
            "up: error",
            mag
            (
                bedLoadModel::slopeFactor(-s, s*s, c, mu)
              - std::sin(angle + b)/std::sin(angle)
            ), 1e-12
        );
        atMost
        (
            "across: error",
            mag
            (
                bedLoadModel::slopeFactor(0, s*s, c, mu)
              - c*std::sqrt(1 - sqr(std::tan(b)/mu))
            ), 1e-12
        );
    }
    const scalar s = std::sin(40*pi/180), c = std::cos(40*pi/180);
    atMost
        ("steeper than friction", bedLoadModel::slopeFactor(s, s*s, c, mu), 0);
}


TEST_CASE("bedLoadModel: slip of the surface")
{
    const nodeVector x{1, 0, 0, 0}, y{0, 1, 0, 0}, z{0, 0, 1, 0};
    const auto m = make("MeyerPeterMueller");

    // q_b/(10 d), along the stress; a part into the bed does nothing
    const scalar expected = 0.2529822128*m->transportScale()/(10*d);
    const nodeVector v = velocity(*m, 0.147, x - 0.3*z, z);
    atMost("level: error", mag(v[0]/expected - 1), 1e-9);
    atMost("level: across, up", mag(v[1]) + mag(v[2]), 1e-15);

    const nodeVector still = velocity(*m, 0.0235, x, z);
    atMost("half the critical stress", mag(still[0]), 0);

    // The same slope by gravity in another direction, and a bed that lies
    // as gravity does: down a side slope grains are deflected
    const scalar b = 15*pi/180;
    const nodeVector normal{0, -std::sin(b), std::cos(b), 0};
    const nodeVector side = velocity(*m, 0.1, x, normal);
    atLeast("side slope: deflected down", -side[1]/side[0], 0.05);
    atMost
    (
        "side slope: out of the bed",
        mag(side[1]*normal[1] + side[2]*normal[2]), 1e-15
    );
    // tan of the deflection = theta_c0 sin(b)/(mu theta)
    const scalar down = std::sqrt(sqr(side[1]) + sqr(side[2]));
    atMost
    (
        "side slope: error of the deflection",
        mag(down/side[0] - 0.047*std::sin(b)/(std::tan(angle)*0.1)), 1e-12
    );

    const auto turned = make("MeyerPeterMueller", nodeVector{0, -1, 0, 0});
    const nodeVector w = velocity(*turned, 0.147, x, y);
    atMost("gravity along y: error", mag(w[0]/expected - 1), 1e-9);

    // No flow, no transport, on any slope
    const nodeVector steep{std::sin(0.7), 0, std::cos(0.7), 0};
    const nodeVector none = velocity(*m, 0, x, steep);
    atMost("no flow", mag(none[0]) + mag(none[2]), 0);
}


TEST_CASE("bedLoadModel: fades out where the grid moves the row")
{
    bedLoadModel::bed b = quartz(nodeVector{0, 0, -1, 0});
    b.h = 2.5e-3;
    dictionary dict;
    dict.set("bedLoad", word("MeyerPeterMueller"));
    const auto m = bedLoadModel::New(dict, b, true);
    atMost
    (
        "stress that a row holds, relative error",
        mag(b.rowStress()/(0.25*std::tan(angle)*1650*9.81*0.6*2.5e-3) - 1),
        1e-12
    );
    atMost("below: error", mag(m->unresolved(0.9*b.rowStress()) - 1), 0);
    atMost
        ("half way: error", mag(m->unresolved(1.5*b.rowStress()) - 0.5), 1e-12);
    atMost("above", m->unresolved(2*b.rowStress()), 0);
}


TEST_CASE("bedLoadModel: selection")
{
    contains
    (
        errorOf([] { make("vanRijn"); }),
        {"bedLoad", "vanRijn", "MeyerPeterMueller", "WongParker", "none"}
    );
    dictionary coeffs;
    coeffs.set("criticalShields", -1.0);
    contains
    (
        errorOf
        (
            [&]
            {
                make("MeyerPeterMueller", nodeVector{0, 0, -1, 0}, coeffs);
            }
        ),
        {"criticalShields", "-1"}
    );
    equal("none is active", label(make("none")->active()), 0);

    coeffs.set("criticalShields", 0.03);
    coeffs.set("averagingTime", 2.0);
    const auto m = make("WongParker", nodeVector{0, 0, -1, 0}, coeffs);
    atMost
    (
        "coefficients as given: error",
        mag(m->criticalShields() - 0.03) + mag(m->averagingTime() - 2), 0
    );
}


// Nodes at the edge of a point's reach have next to no mass, and may have no
// velocity at all: a mass times VSMALL is zero then
TEST_CASE("bedWall: friction on nodes with next to no momentum")
{
    atMost("without friction", bedWall::partTaken(0, 0), 0);
    atMost
    (
        "of none: error", mag(bedWall::partTaken(1e-10, 0) - 1), 0
    );
    atMost
    (
        "of a mass of 1e-21 kg at no speed: error",
        mag(bedWall::partTaken(1e-10, 1e-21*VSMALL) - 1), 0
    );
    atMost("of three times it: error", mag(bedWall::partTaken(1, 3) - 0.25), 0);
}

// ************************************************************************* //
