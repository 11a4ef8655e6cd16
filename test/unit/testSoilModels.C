/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Description
    The plain models: linearElastic, rigidSkeleton, DruckerPrager.

\*---------------------------------------------------------------------------*/

#include "figures.H"
#include "soilElement.H"
#include "rigidSkeleton.H"
#include "unitConversion.H"
#include "vector.H"
#include <random>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

const std::string grains("rhoS 2650; d 0.85e-3; e0 0.7;");

//- A user's model, with more fields than points have places for
class manyFields
:
    public rigidSkeleton
{
public:

    TypeName("manyFields");

    manyFields(const dictionary& coeffs, const bool strict)
    :
        rigidSkeleton(coeffs, strict)
    {}

    wordList stateFields() const override
    {
        wordList names(9);
        forAll(names, i) names[i] = "field" + Foam::name(i);
        return names;
    }
};

defineTypeName(manyFields);
soilModel::adddictionaryConstructorToTable<manyFields> addManyFields;

} // End anonymous namespace


TEST_CASE("soilModel: more fields than there is room for")
{
    contains
    (
        errorOf([]() { soilModelOf("manyFields", grains); }),
        {"manyFields", "9 fields", "field8", "Allowed: up to 8"}
    );
}


TEST_CASE("soilModel: unknown models and values are refused")
{
    contains
    (
        errorOf([]() { soilModelOf("CamClay", grains); }),
        {"constitutiveModel", "CamClay", "DruckerPrager", "linearElastic"}
    );
    contains
    (
        errorOf([]() { soilModelOf("rigidSkeleton", "rhoS 2650; d 0; e0 1;"); }),
        {"keyword d", "0 < d"}
    );
    contains
    (
        errorOf([]() { soilModelOf("rigidSkeleton", "rhoS 2650; d 1; e0 3;"); }),
        {"keyword e0", "3", "e0 < 2.97"}
    );
    contains
    (
        errorOf
        (
            []() { soilModelOf("linearElastic", grains + "E 1e6; nu 0.5;"); }
        ),
        {"keyword nu", "0.5", "0 <= nu < 0.5"}
    );
    contains
    (
        errorOf
        (
            []()
            {
                soilModelOf
                (
                    "DruckerPrager", grains + "E 1e6; nu 0.2; phi 30; psi 31;"
                );
            }
        ),
        {"keyword psi", "31", "0 <= psi <= 30"}
    );
    contains
    (
        errorOf
        (
            []()
            {
                soilModelOf
                (
                    "DruckerPrager", grains + "E 1e6; nu 0.2; phi 30; pRes 1;"
                );
            }
        ),
        {"keyword pRes", "1", "pRes <= 0.00267"}
    );
    contains
    (
        errorOf
        (
            []()
            {
                autoPtr<soilModel> m
                (
                    soilModelOf("DruckerPrager", grains + "E 1e6; nu 0.2; phi 30;")
                );
                soilElement(*m, 2, 0.7, {-100, -1000, -100, 0, 0, 0});
            }
        ),
        {"start stress", "q/p", "2.25", "q/p <= 1.2"}
    );
}


TEST_CASE("linearElastic: moduli, energy, wave speed")
{
    autoPtr<soilModel> m
    (
        soilModelOf("linearElastic", grains + "E 2e6; nu 0.25;")
    );
    const scalar K = 2e6/1.5, G = 2e6/2.5;

    for (const label dim : {2, 3})
    {
        const std::string name = dim == 2 ? "2D: " : "3D: ";
        soilElement s(*m, dim, 0.7, 0);
        s.L(0, 0) = -1;
        s.step(1e-4);
        atMost
        (
            name + "uniaxial modulus K + 4G/3, relative",
            mag(s.stress[0]/(-1e-4*(K + 4*G/3)) - 1), 1e-12
        );
        atMost
        (
            name + "side stress, relative",
            mag(s.stress[1]/s.stress[0]/m->K0() - 1), 1e-12
        );
        atMost
        (
            name + "void ratio", mag(s.voidRatio - (1.7*std::exp(-1e-4) - 1)),
            1e-14
        );
        scalar energy = 0;
        m->elasticEnergy(dim, s.points, &energy);
        atMost
        (
            name + "elastic energy, relative",
            mag(energy/(0.5*1e-8*(K + 4*G/3)) - 1), 1e-12
        );
        atMost
        (
            name + "wave speed, relative",
            mag
            (
                s.points.maxWaveSpeedSqr
               /((K + 4*G/3)*(1 + s.voidRatio)/2650) - 1
            ),
            1e-12
        );
        atMost
        (
            name + "power, relative",
            mag(s.power/(1e-4*(K + 4*G/3)) - 1), 1e-12
        );

        // All shear components
        soilElement t(*m, dim, 0.7, 0);
        t.L(0, 1) = t.L(1, 0) = 0.5;
        if (dim == 3)
        {
            t.L(1, 2) = t.L(2, 1) = 1;
            t.L(2, 0) = t.L(0, 2) = 1.5;
        }
        t.step(1e-4);
        for (int c = 3; c < (dim == 2 ? 4 : 6); ++c)
        {
            atMost
            (
                name + "shear stress, relative",
                mag(t.stress[c]/(2*G*1e-4*0.5*(c - 2)) - 1), 1e-12
            );
        }
    }

    m->limitWaveSpeed(10);
    atMost
    (
        "capped wave speed, relative",
        mag(std::sqrt(m->waveSpeedSqr(1e5, 0.7))/10 - 1), 1e-12
    );
}


TEST_CASE("soil models: wave speed after a compression from no stress")
{
    for
    (
        const std::string stiffness :
        {
            "E0 216; n 0.5;", "E0 216; n 0.7;", "E0 216; n 0;",
            "E0 216; n 1e-5;"
        }
    )
    for (const bool capped : {false, true})
    {
        autoPtr<soilModel> m
        (
            soilModelOf("DruckerPrager", grains + stiffness + "nu 0.2; phi 35;")
        );
        if (capped) m->limitWaveSpeed(30);
        const std::string name = stiffness + (capped ? " capped" : "") + ": ";

        // What a very slow isotropic compression comes to
        soilElement s(*m, 3, 0.7, {-1e-3, -1e-3, -1e-3, 0, 0, 0});
        for (int d = 0; d < 3; ++d) s.L(d, d) = -1.0/3;
        const scalar e = s.voidRatio, strain = 1e-3;
        for (int i = 0; i < 10000; ++i)
        {
            // Of the same void ratio, as a single step has it
            s.voidRatio = e;
            s.step(strain/10000);
        }
        atMost
        (
            name + "wave speed squared, relative",
            mag
            (
                m->waveSpeedSqrGrowth(strain, e)
               /m->waveSpeedSqr(s.p(), e)
              - 1
            ),
            2e-3
        );
    }
}


TEST_CASE("soil models: the cap where stiffness hardly depends on pressure")
{
    const scalar e = 0.7;
    for (const std::string n : {"0", "1e-300", "1e-5", "0.004", "0.0056", "0.02"})
    {
        auto model = [&](const std::string& E0)
        {
            return soilModelOf
            (
                "DruckerPrager",
                grains + "E0 " + E0 + "; n " + n + "; nu 0.2; phi 35;"
            );
        };
        autoPtr<soilModel> stiff(model("216")), soft(model("0.02"));
        const scalar cs = std::sqrt(soft->waveSpeedSqr(100, e));
        atMost("n " + n + ", soft: wave speed without the cap", cs, 20);
        stiff->limitWaveSpeed(30);
        soft->limitWaveSpeed(30);
        for (const scalar p : {0.0, 1.0, 100.0, 1e6})
        {
            atMost
            (
                "n " + n + ", stiff: wave speed over the cap, distance to 1",
                mag(std::sqrt(stiff->waveSpeedSqr(p, e))/30 - 1), 1e-12
            );
        }
        atMost
        (
            "n " + n + ", soft: wave speed over that without the cap,"
            " distance to 1",
            mag(std::sqrt(soft->waveSpeedSqr(100, e))/cs - 1), 1e-12
        );

        // K of the cap, by a step of strain
        soilElement s(*stiff, 3, e, {-100, -100, -100, 0, 0, 0});
        for (int d = 0; d < 3; ++d) s.L(d, d) = -1.0/3;
        s.step(1e-6);
        const scalar K = 900.0*2650/(1 + e)/(1 + 4*0.75/3);
        atMost
        (
            "n " + n + ": pressure after a compression, relative to K",
            mag((s.p() - 100)/(1e-6*K) - 1), 1e-4
        );
    }
}


TEST_CASE("soil models: a rotating point keeps its stress")
{
    for (const std::string name : {"linearElastic", "DruckerPrager"})
    {
        autoPtr<soilModel> m
        (
            soilModelOf
            (
                name,
                grains + "E 2e6; nu 0.25;"
              + (name == "DruckerPrager" ? "phi 35;" : "")
            )
        );
        for (const label dim : {2, 3})
        {
            soilElement s
            (
                *m, dim, 0.7, {-1000, -1500, -1200, 200, dim == 3 ? 100. : 0, 0}
            );
            const auto start = s.stress;
            const scalar p = s.p(), q = s.q();

            // One turn; in 3D about an axis in general position
            const vector axis =
                dim == 2 ? vector(0, 0, 1) : vector(1, 2, 3)/std::sqrt(14.0);
            const label nSteps = 1000;
            const scalar angle = 2*constant::mathematical::pi/nSteps;
            // tan of the half angle, for an exact turn
            const scalar rate = 2*std::tan(angle/2);
            s.L(0, 1) = -rate*axis.z();
            s.L(1, 0) = rate*axis.z();
            if (dim == 3)
            {
                s.L(1, 2) = -rate*axis.x();
                s.L(2, 1) = rate*axis.x();
                s.L(2, 0) = -rate*axis.y();
                s.L(0, 2) = rate*axis.y();
            }
            scalar invariants = 0, quarter = 0;
            for (label i = 0; i < nSteps; ++i)
            {
                s.step(1);
                invariants = max
                (
                    invariants, max(mag(s.p()/p - 1), mag(s.q()/q - 1))
                );
                if (dim == 2 && i + 1 == nSteps/4)
                {
                    quarter = mag(s.stress[0] - start[1])
                      + mag(s.stress[3] + start[3]);
                }
            }
            scalar back = 0;
            for (int c = 0; c < 6; ++c)
            {
                back = max(back, mag(s.stress[c] - start[c])/p);
            }
            const std::string which
            (
                name + (dim == 2 ? ", 2D: " : ", 3D: ")
            );
            atMost(which + "change of p and q in one turn", invariants, 1e-10);
            atMost(which + "stress after one turn, over p", back, 1e-10);
            atMost
            (
                which + "a quarter turn exchanges x and y, over p",
                quarter/p, 1e-10
            );
        }
    }
}


TEST_CASE("DruckerPrager: strength, dilatancy, plastic work")
{
    for (const label dim : {2, 3})
    {
        autoPtr<soilModel> m
        (
            soilModelOf
            (
                "DruckerPrager",
                grains + "E0 216; n 0.5; nu 0.2; phi 30; psi 10;"
            )
        );
        soilElement s(*m, dim, 0.7, 1000);
        s.L(0, 0) = 1;
        s.L(1, 1) = -1;
        scalar outside = 0, last = s.p();
        for (label i = 0; i < 100; ++i)
        {
            last = s.p();
            s.step(1e-4);
            outside = max(outside, s.q()/(1.2*s.p()) - 1);
        }
        const std::string name = dim == 2 ? "2D: " : "3D: ";
        atMost(name + "q/(M p) - 1", outside, 1e-10);
        atMost(name + "1 - q/(M p) at the end", 1 - s.q()/(1.2*s.p()), 1e-10);

        // Undrained, all strain but that of the pressure change is plastic:
        // dp = K M(psi) dl, dl = deps - dq/3G
        const scalar mean = 0.5*(s.p() + last);
        const scalar E = 216*101300*sqr(2.27)/1.7*std::sqrt(mean/101300);
        const scalar K = E/1.8, G = E/2.4;
        const scalar sine = std::sin(degToRad(10));
        const scalar dl =
            2/std::sqrt(3.0)*1e-4 - 1.2*(s.p() - last)/(3*G);
        atMost
        (
            name + "dp against K M(psi) dl, relative",
            mag((s.p() - last)/(K*6*sine/(3 - sine)*dl) - 1), 1e-3
        );
    }
}


TEST_CASE("DruckerPrager: cones")
{
    const scalar sine = std::sin(degToRad(32));
    auto ratio = [&](const std::string& cone)
    {
        autoPtr<soilModel> m
        (
            soilModelOf
            (
                "DruckerPrager",
                grains + "E 1e6; nu 0.2; phi 32; cone " + cone + ";"
            )
        );
        soilElement s(*m, 2, 0.7, 1000);
        s.L(0, 1) = 1;
        for (label i = 0; i < 400; ++i) s.step(1e-4);
        return s.q()/s.p();
    };
    atMost("compression", mag(ratio("compression") - 6*sine/(3 - sine)), 1e-9);
    atMost("extension", mag(ratio("extension") - 6*sine/(3 + sine)), 1e-9);
    // tau = p sin(phi) is Mohr-Coulomb where the middle stress is the mean
    atMost
    (
        "planeStrain", mag(ratio("planeStrain") - std::sqrt(3.0)*sine), 1e-9
    );
}


TEST_CASE("DruckerPrager: opening and closing returns the stress")
{
    for (const std::string law : {"E 1e6;", "E0 216;", "E0 216; n 0.6;"})
    {
        autoPtr<soilModel> m
        (
            soilModelOf("DruckerPrager", grains + law + "nu 0.2; phi 30;")
        );
        scalar worst = 0, open = 0;
        for (const scalar amplitude : {2e-4, 1e-3, 1e-2, 5e-2})
        {
            for (const scalar p0 : {1.0, 50.0, 5000.0})
            {
                soilElement s(*m, 2, 0.7, p0);
                for (label cycle = 0; cycle < 50; ++cycle)
                {
                    // Steps that do not meet those of the way back
                    for (label i = 0; i < 7; ++i)
                    {
                        s.L(0, 0) = s.L(1, 1) = 0.5/7;
                        s.step(amplitude);
                    }
                    open += s.p() == 0;
                    for (label i = 0; i < 5; ++i)
                    {
                        s.L(0, 0) = s.L(1, 1) = -0.5/5;
                        s.step(amplitude);
                    }
                    worst = max(worst, mag(s.p()/p0 - 1));
                }
            }
        }
        atMost("p after 50 cycles, " + law + " relative", worst, 1e-2);
        atLeast("cycles that opened, " + law, open, 300);
    }
}


TEST_CASE("DruckerPrager: random paths stay finite and inside the cone")
{
    std::mt19937 random(1);
    std::uniform_real_distribution<scalar> uniform(-1, 1);

    scalar outside = 0;
    label bad = 0, open = 0;
    for (const std::string law : {"E 1e6;", "E0 216;", "E0 216; n 0.7;"})
    {
        for (const label dim : {2, 3})
        {
            autoPtr<soilModel> m
            (
                soilModelOf
                (
                    "DruckerPrager", grains + law + "nu 0.2; phi 35; psi 12;"
                )
            );
            const scalar sine = std::sin(degToRad(35));
            const scalar M = 6*sine/(3 - sine);
            for (label path = 0; path < 3000; ++path)
            {
                soilElement s
                (
                    *m, dim, 0.7, path % 5 ? std::pow(10, 2 + 2*uniform(random)) : 0
                );
                const scalar size = std::pow(10, -3 + 1.7*uniform(random));
                for (label i = 0; i < 12; ++i)
                {
                    for (auto& l : s.gradient) l = uniform(random)*size;
                    s.step(1);
                    outside = max(outside, s.q() - M*s.p()*(1 + 1e-9));
                    open += s.p() == 0;
                    bool finite = s.p() >= 0;
                    for (int c = 0; c < (dim == 2 ? 4 : 6); ++c)
                    {
                        finite = finite && std::isfinite(s.whole[c]);
                    }
                    bad += !finite;
                }
            }
        }
    }
    equal("steps with nan, inf or tension", bad, 0);
    atMost("q - M p [Pa]", outside, 1e-9);
    atLeast("steps that end open", open, 1000);
}


TEST_CASE("rigidSkeleton: holds")
{
    autoPtr<soilModel> m(soilModelOf("rigidSkeleton", grains));
    soilElement s(*m, 2, 0.7, 1000);
    for (auto& l : s.gradient) l = 3;
    s.step(0.1);
    atMost("change of void ratio", mag(s.voidRatio - 0.7), 0);
    atMost("change of stress", mag(s.whole[0] + 1000), 0);
    atMost("wave speed", s.points.maxWaveSpeedSqr, 0);
}

// ************************************************************************* //
