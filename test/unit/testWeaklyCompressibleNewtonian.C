/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.
\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "weaklyCompressibleNewtonian.H"
#include "OSspecific.H"
#include "StringStream.H"
#include <cmath>
#include <fstream>
#include <sstream>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

weaklyCompressibleNewtonian fluidOf(const std::string& coeffs)
{
    IStringStream is
    (
        "constitutiveModel weaklyCompressibleNewtonian;"
        "weaklyCompressibleNewtonianCoeffs {" + coeffs + "}"
    );
    return weaklyCompressibleNewtonian(dictionary(is), true);
}

} // End anonymous namespace


TEST_CASE("weaklyCompressibleNewtonian: hydrostatic column of the reference")
{
    std::ifstream file
    (
        getEnv("MPMFOAM_DIR")/"test/unit/reference/ana_hydrostatic_tait.csv"
    );
    REQUIRE(file.good());

    scalar pressureError = 0, densityError = 0;
    label rows = 0;
    std::string line;
    while (std::getline(file, line))
    {
        if (line.empty() || !std::isdigit(line[0])) continue;
        std::istringstream fields(line);
        scalar cs, depth, p, rho;
        char comma;
        fields >> cs >> comma >> depth >> comma >> p >> comma >> rho;

        const weaklyCompressibleNewtonian water
        (
            fluidOf("rho0 1000; mu 0; soundSpeed " + std::to_string(cs) + ";")
        );
        const scalar found = water.hydrostaticPressure(9.81*depth);

        // The file has eight digits
        pressureError = max(pressureError, mag(found - p)/max(p, scalar(1)));
        densityError = max
        (
            densityError, mag(water.rho0()/water.volumeRatio(found) - rho)/rho
        );
        ++rows;
    }
    atLeast("rows of the reference", rows, 10);
    atMost("relative error of pressure", pressureError, 1e-7);
    atMost("relative error of density", densityError, 1e-7);
}


TEST_CASE("weaklyCompressibleNewtonian: pressure and its inverse")
{
    // The shortcut for 7, and the general power
    for (const char* gamma : {"7", "7.000001", "3.5", "1.01"})
    {
        const weaklyCompressibleNewtonian water
        (
            fluidOf
            (
                "rho0 998; mu 1e-3; soundSpeed 35; gamma "
              + std::string(gamma) + ";"
            )
        );
        const scalar g = std::stod(gamma);
        const scalar B = 35*35*998/g;

        scalar inverse = 0, formula = 0, sound = 0, elastic = 0;
        for (scalar J = 0.9; J < 1.1; J += 0.005)
        {
            const scalar p = water.pressure(J);
            inverse = max(inverse, mag(water.volumeRatio(p) - J));
            formula = max(formula, mag(p - B*(std::pow(J, -g) - 1))/B);

            // c^2 = dp/drho, and dW/dJ = -p, by central differences
            const scalar e = 1e-5;
            const scalar dp = water.pressure(J - e) - water.pressure(J + e);
            const scalar drho = 998/(J - e) - 998/(J + e);
            sound = max(sound, mag(std::sqrt(dp/drho)/water.soundSpeed(J) - 1));

            const scalar dW =
                (water.elasticEnergy(J + e) - water.elasticEnergy(J - e))/(2*e);
            elastic = max(elastic, mag(dW + p)/B);
        }
        const std::string name = "gamma " + std::string(gamma) + ": ";
        atMost(name + "J(p(J)) - J", inverse, 1e-14);
        atMost(name + "p against B(J^-gamma - 1), over B", formula, 1e-14);
        atMost(name + "speed of sound against dp/drho, relative", sound, 1e-7);
        atMost(name + "dW/dJ + p, over B", elastic, 1e-7);
        atMost(name + "W(1)/B", mag(water.elasticEnergy(1))/B, 1e-15);
        atMost(name + "p(1)", mag(water.pressure(scalar(1))), 0);
        atMost
        (
            name + "speed of sound at J = 1", mag(water.soundSpeed(1) - 35),
            1e-13
        );
    }
}


TEST_CASE("weaklyCompressibleNewtonian: hydrostatic pressure balances weight")
{
    const weaklyCompressibleNewtonian water
    (
        fluidOf("rho0 1000; mu 0; soundSpeed 14;")
    );
    // dp/d(gz) = rho
    scalar error = 0;
    for (scalar gz = 0.1; gz < 10; gz += 0.1)
    {
        const scalar e = 1e-4;
        const scalar slope =
            (
                water.hydrostaticPressure(gz + e)
              - water.hydrostaticPressure(gz - e)
            )/(2*e);
        const scalar rho =
            1000/water.volumeRatio(water.hydrostaticPressure(gz));
        error = max(error, mag(slope/rho - 1));
    }
    atMost("dp/d(gz) against the density, relative", error, 1e-8);
}


TEST_CASE("weaklyCompressibleNewtonian: the sound speed set later")
{
    weaklyCompressibleNewtonian water
    (
        fluidOf("rho0 1000; mu 1e-3; soundSpeed auto;")
    );
    equal("auto", label(water.autoSoundSpeed()), 1);
    equal("viscous", label(water.viscous()), 1);
    water.setSoundSpeed(20);
    atMost
    (
        "B", mag(water.pressure(scalar(0.5)) - 1000*400/7.0*127)/1e7, 1e-15
    );

    equal
    (
        "auto by default", label(fluidOf("rho0 1; mu 0;").autoSoundSpeed()), 1
    );
    equal
    (
        "viscous without viscosity",
        label(fluidOf("rho0 1; mu 0;").viscous()), 0
    );
}


TEST_CASE("weaklyCompressibleNewtonian: refused values")
{
    contains
    (
        errorOf([]() { fluidOf("rho0 -1000; mu 0;"); }),
        {"rho0", "-1000", "0 < rho0"}
    );
    contains
    (
        errorOf([]() { fluidOf("rho0 1000; mu -1;"); }),
        {"mu", "-1", "0 <= mu"}
    );
    contains
    (
        errorOf([]() { fluidOf("rho0 1000; mu 0; soundSpeed 0;"); }),
        {"soundSpeed", "0 < soundSpeed"}
    );
    contains
    (
        errorOf([]() { fluidOf("rho0 1000; mu 0; gamma 1;"); }),
        {"gamma", "1 < gamma"}
    );
    contains
    (
        errorOf([]() { fluidOf("rho0 1000; mu 0; soundSpeed automatic;"); }),
        {"soundSpeed", "automatic", "auto"}
    );
    contains
    (
        errorOf([]() { fluidOf("rho0 1000; mu 0; gama 7;"); }),
        {"gama", "Did you mean gamma?"}
    );
    contains(errorOf([]() { fluidOf("mu 0;"); }), {"rho0"});

    IStringStream is("constitutiveModel Newtonian;");
    const dictionary dict(is);
    contains
    (
        errorOf([&]() { weaklyCompressibleNewtonian(dict, true); }),
        {"constitutiveModel", "Newtonian", "weaklyCompressibleNewtonian"}
    );
}

// ************************************************************************* //
