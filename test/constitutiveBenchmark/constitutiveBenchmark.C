/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    mpmConstitutiveBenchmark

Description
    Cost of one call of the soil model elastoplasticMuI per point, in 2D and
    3D, on arrays of points as the solver calls it. Judges nothing; the gates
    of the project stand beside the figures. Measure on an idle machine.

    \verbatim
        mpmConstitutiveBenchmark [points [calls [case]]]
    \endverbatim

    Each case prints the CPU time of the fastest and of the mean round: the
    states are put back before each round and the time of that is not counted.
    The points differ in pressure (50 Pa to 5 kPa), stress ratio, void ratio
    and directions of stress and strain. The last column is the share of points
    that were of the kind (gained plastic strain; did not; suspended;
    separated).

\*---------------------------------------------------------------------------*/

#include "elastoplasticMuI.H"
#include "StringStream.H"
#include "IOstreams.H"
#include <ctime>
#include <iomanip>
#include <iostream>
#include <random>
#include <vector>

using namespace Foam;
using namespace Foam::mpm;

namespace
{

//- Arrays of points and their start
struct pointArrays
{
    label n;
    std::vector<std::vector<scalar>> stress, whole, gradient, state;
    std::vector<scalar> voidRatio, solidFraction, speed, power;
    std::vector<std::vector<scalar>> stressStart, stateStart;
    std::vector<scalar> voidRatioStart;
    soilPoints points;

    explicit pointArrays(const label size)
    :
        n(size),
        stress(6, std::vector<scalar>(n)),
        whole(stress),
        gradient(9, std::vector<scalar>(n)),
        state(8, std::vector<scalar>(n)),
        voidRatio(n),
        solidFraction(n, 0.5),
        speed(n),
        power(n)
    {
        points.n = n;
        for (label c = 0; c < 6; ++c)
        {
            points.stress[c] = stress[c].data();
            points.wholeStress[c] = whole[c].data();
        }
        for (label c = 0; c < 9; ++c)
        {
            points.velocityGradient[c] = gradient[c].data();
        }
        for (label c = 0; c < 8; ++c) points.state[c] = state[c].data();
        points.voidRatio = voidRatio.data();
        points.solidFraction = solidFraction.data();
        points.speed = speed.data();
        points.power = power.data();
    }

    void keep()
    {
        stressStart = stress;
        stateStart = state;
        voidRatioStart = voidRatio;
    }

    void putBack()
    {
        // Values only: the model holds pointers
        for (label c = 0; c < 6; ++c)
        {
            std::copy_n(stressStart[c].data(), n, stress[c].data());
        }
        for (label c = 0; c < 8; ++c)
        {
            std::copy_n(stateStart[c].data(), n, state[c].data());
        }
        std::copy_n(voidRatioStart.data(), n, voidRatio.data());
    }
};


scalar cpuTime()
{
    timespec t;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return t.tv_sec + 1e-9*t.tv_nsec;
}


enum kind { plastic, elastic, isSuspended, isSeparated };


//- Fill the points with states of a kind and strain increments of a size
void fill
(
    const soilModel& model,
    const label dim,
    const kind what,
    const scalar size,
    pointArrays& a
)
{
    std::mt19937 random(1);
    std::uniform_real_distribution<scalar> uniform(0, 1);

    for (label i = 0; i < a.n; ++i)
    {
        // A deviator in any direction, q/p = 0.2 to 0.8
        scalar s[6] = {};
        for (label c = 0; c < (dim == 2 ? 4 : 6); ++c)
        {
            s[c] = 2*uniform(random) - 1;
        }
        const scalar mean = (s[0] + s[1] + s[2])/3;
        for (label c = 0; c < 3; ++c) s[c] -= mean;
        const scalar q = std::sqrt(1.5*doubleDot<3>(s, s));

        const bool loaded = what == plastic || what == elastic;
        const scalar p = loaded ? 50*std::pow(100, uniform(random)) : 0;
        const scalar ratio = 0.2 + 0.6*uniform(random);
        for (label c = 0; c < 6; ++c)
        {
            s[c] /= q;
            a.stress[c][i] = p*(ratio*s[c] - (c < 3 ? 1 : 0));
        }
        a.voidRatio[i] =
            what == isSuspended ? 2 + uniform(random)
          : 0.6 + 0.2*uniform(random);
        a.solidFraction[i] = 1/(1 + a.voidRatio[i]);

        // Strain along it and a third in any other direction; back if elastic.
        // Up to a twentieth of it as volume; expansion if separated
        const scalar D[6] =
        {
            s[0] + 0.3*(2*uniform(random) - 1),
            s[1] + 0.3*(2*uniform(random) - 1),
            s[2] + 0.3*(2*uniform(random) - 1),
            s[3] + 0.3*(2*uniform(random) - 1),
            s[4] + 0.3*(2*uniform(random) - 1),
            s[5] + 0.3*(2*uniform(random) - 1)
        };
        const scalar factor = (what == elastic ? -1 : 1)*size;
        const scalar trace = D[0] + D[1] + (dim == 3 ? D[2] : 0);
        const scalar volume =
            what == isSeparated ? 0.1 : 0.05*(2*uniform(random) - 1);
        auto set = [&](const label c, const label d, const label k)
        {
            a.gradient[c*dim + d][i] = factor
               *(D[k] + (c == d ? (volume - trace)/dim : 0));
        };
        set(0, 0, 0);
        set(1, 1, 1);
        set(0, 1, 3);
        set(1, 0, 3);
        if (dim == 3)
        {
            set(2, 2, 2);
            set(1, 2, 4);
            set(2, 1, 4);
            set(2, 0, 5);
            set(0, 2, 5);
        }
    }
    model.initialise(dim, a.points);
    a.keep();
}


void measure
(
    const soilModel& model,
    const label dim,
    const kind what,
    const scalar size,
    const label nPoints,
    const label nCalls,
    const char* gate
)
{
    pointArrays a(nPoints);
    fill(model, dim, what, size, a);

    scalar fastest = VGREAT, sum = 0;
    for (label k = 0; k < nCalls; ++k)
    {
        a.putBack();
        const scalar start = cpuTime();
        model.update(dim, a.points, 1);
        const scalar time = cpuTime() - start;
        fastest = min(fastest, time);
        sum += time;
    }

    label share = 0;
    for (label i = 0; i < nPoints; ++i)
    {
        const bool grew = a.state[0][i] > a.stateStart[0][i];
        const label regime = label(a.state[2][i]);
        share +=
            what == plastic ? grew
          : what == elastic ? !grew && regime < 2
          : regime == (what == isSuspended ? 2 : 3);
    }
    const char* names[] = {"plastic", "elastic", "suspended", "separated"};
    std::cout
        << std::fixed << std::setw(11) << names[what] << std::setw(4) << dim
        << "D   " << std::scientific << std::setprecision(0) << size
        << std::fixed << std::setprecision(1)
        << std::setw(11) << 1e9*fastest/nPoints
        << std::setw(9) << 1e9*sum/nCalls/nPoints
        << std::setw(9) << gate << std::setw(9) << 100.0*share/nPoints
        << " %" << std::endl;
}

} // End anonymous namespace


int main(int argc, char* argv[])
{
    const label nPoints = argc > 1 ? std::atoi(argv[1]) : 4096;
    const label nCalls = argc > 2 ? std::atoi(argv[2]) : 200;
    const std::string only = argc > 3 ? argv[3] : "";

    IStringStream is
    (
        "rhoS 2650; d 0.85e-3; e0 0.695; E0 216; nu 0.2; n 0.5; phiC 35;"
        "eRef 0.807; lambda 0.0596; xi 0.365; Ad 0.7; kp 0.0044; np 2.4;"
        "nd 2.9; muS 0.7; muD 0.77; PhiC 0.7; dPhi 0.29;"
    );
    const elastoplasticMuI model(dictionary(is), true);

    std::cout
        << "elastoplasticMuI, " << nPoints << " points, " << nCalls
        << " calls: ns CPU per point\n"
        << "       case dim increment  fastest     mean     gate   of that kind"
        << std::endl;

    for (const label dim : {2, 3})
    {
        auto run = [&](const kind k, const scalar size, const char* gate)
        {
            const std::string name =
                std::string(k == plastic ? "plastic" : k == elastic ? "elastic"
              : k == isSuspended ? "suspended" : "separated")
              + std::to_string(dim);
            if (only.empty() || only == name)
            {
                measure(model, dim, k, size, nPoints, nCalls, gate);
            }
        };
        for (const scalar size : {1e-6, 1e-5, 1e-4, 1e-3})
        {
            run(plastic, size, "<= 300");
        }
        run(elastic, 1e-7, "<= 60");
        run(isSuspended, 1e-4, "<= 30");
        run(isSeparated, 1e-4, "<= 30");
    }
    return 0;
}

// ************************************************************************* //
