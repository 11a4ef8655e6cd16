/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "erosionCriterion.H"
#include "OSspecific.H"
#include <cmath>
#include <fstream>
#include <sstream>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- Quartz in water
erosionCriterion::bed quartz(const scalar d, const scalar angle = -1)
{
    return erosionCriterion::bed{d, 2650, angle, 1000, 1e-3, 9.81};
}


autoPtr<erosionCriterion> make
(
    const word& name,
    const erosionCriterion::bed& b
)
{
    dictionary dict;
    dict.name() = "controlDict.functions.erosion";
    return erosionCriterion::New(name, dict, b);
}


//- Critical Shields number of van Rijn at a dimensionless diameter
scalar theta(const scalar dStar)
{
    return make
    (
        "vanRijn", quartz(dStar/std::cbrt(1.65*9.81*1e12))
    )->shieldsNumber();
}

} // End anonymous namespace


TEST_CASE("erosionCriterion: the beds of Table 4")
{
    std::ifstream file
    (
        getEnv("MPMFOAM_DIR")/"validation/reference/table4_check.csv"
    );
    REQUIRE(file.good());

    label rows = 0;
    std::string line;
    while (std::getline(file, line))
    {
        if (line.compare(0, 2, "Ex") != 0) continue;
        std::istringstream fields(line);
        std::string bed;
        std::getline(fields, bed, ',');

        scalar d, angle, dStar, Shields, printed, vanRijn, Annandale;
        char comma;
        fields >> d >> comma >> angle >> comma >> dStar >> comma >> Shields
            >> comma >> printed >> comma >> vanRijn >> comma >> Annandale;
        REQUIRE(fields.good());

        const std::pair<word, scalar> expected[] =
        {
            {"Shields", Shields}, {"vanRijn", vanRijn}, {"Annandale", Annandale}
        };
        for (const auto& e : expected)
        {
            const auto c = make(e.first, quartz(d, angle));

            // The file has six digits
            atMost
            (
                bed + ", " + e.first + ": relative error of the shear velocity",
                mag(c->shearVelocity()/e.second - 1),
                5e-6
            );
            atMost
            (
                bed + ", " + e.first + ": shear stress and its velocity",
                mag(c->shearStress()/(1000*sqr(c->shearVelocity())) - 1),
                1e-12
            );
        }
        ++rows;
    }
    equal("beds", rows, 3);
}


TEST_CASE("erosionCriterion: all branches of van Rijn")
{
    atMost("at 2: error of the Shields number", mag(theta(2) - 0.12), 1e-12);
    atMost
    (
        "at 6: error", mag(theta(6) - 0.14*std::exp(-0.64*std::log(6))), 1e-12
    );
    atMost
    (
        "at 15: error", mag(theta(15) - 0.04*std::exp(-0.1*std::log(15))), 1e-12
    );
    atMost("at 200: error", mag(theta(200) - 0.055), 1e-12);

    // With the exponent -0.29 it is 82 % from 20 on
    for (const scalar d : {4, 10, 20, 150})
    {
        atMost
        (
            "jump at " + std::to_string(int(d)) + ", relative",
            mag(theta(d*(1 + 1e-9))/theta(d*(1 - 1e-9)) - 1),
            0.05
        );
    }
}


TEST_CASE("erosionCriterion: errors")
{
    contains
    (
        errorOf([] { make("shields", quartz(1e-3)); }),
        {"criteria", "shields", "Shields", "vanRijn", "Annandale"}
    );
    contains
    (
        errorOf([] { make("Annandale", quartz(1e-3)); }),
        {"Annandale", "frictionAngle", "0 to 90"}
    );
    contains
    (
        errorOf([] { make("vanRijn", quartz(2e-5)); }),
        {"vanRijn", "dimensionless diameter", "> 1"}
    );
}
