/*---------------------------------------------------------------------------*\
License
    This file is part of mpmFoam, distributed under GPL-3.0-or-later.

Application
    mpmBenchmark

Description
    Measures the time step of mpmFoam on a case whose points are set: CPU time
    of the process per point and step, in total and by part, and memory per
    point. With -plain the same points are also run through the plain
    reference kernel (plainKernel.H), in turns with the production kernels, so
    that both see the same machine.

    benchmark.py makes the cases; see there.

\*---------------------------------------------------------------------------*/

#include "argList.H"
#include "Time.H"
#include "fvMesh.H"
#include "sigFpe.H"
#include "PstreamReduceOps.H"
#include "materialPointSystem.H"
#include "waterCloud.H"
#include "plainKernel.H"
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <fstream>

using namespace Foam;

// * * * * * * * * * * * * * * * Local Functions * * * * * * * * * * * * * * //

namespace
{

double seconds(const clockid_t clock)
{
    timespec t;
    clock_gettime(clock, &t);
    return t.tv_sec + 1e-9*t.tv_nsec;
}

double cpu() { return seconds(CLOCK_PROCESS_CPUTIME_ID); }
double wall() { return seconds(CLOCK_MONOTONIC); }


//- CPU time of the calls that make a step
struct stepCost
{
    enum part { setDeltaT, p2g, nodes, g2p, relocate, nParts };

    static const char* name(const int part)
    {
        static const char* names[nParts] =
        {
            "setDeltaT", "particlesToGrid", "moveNodes", "gridToParticles",
            "relocate"
        };
        return names[part];
    }

    double total = 0;
    double parts[nParts] = {};
};


//- A step as in mpmFoam.C
void step(mpm::materialPointSystem& points, Time& runTime, stepCost& cost)
{
    const double begin = cpu();
    double last = begin;
    auto lap = [&](const int part)
    {
        const double now = cpu();
        cost.parts[part] += now - last;
        last = now;
    };

    points.particlesToGrid();
    lap(stepCost::p2g);
    points.setDeltaT(runTime);
    points.advance(runTime);
    lap(stepCost::setDeltaT);
    points.moveNodes();
    lap(stepCost::nodes);
    points.gridToParticles();
    lap(stepCost::g2p);
    points.relocate();
    points.endStep(runTime);
    lap(stepCost::relocate);

    cost.total += last - begin;
}


//- The points of a cloud, for the plain kernel
template<int dim>
mpm::plainKernel<dim> makePlain
(
    const mpm::waterCloud& water,
    const vector& g
)
{
    const mpm::lattice& cells = water.grid().cells();
    double gravity[dim], origin[dim], spacing[dim];
    int nCells[dim];
    for (int d = 0; d < dim; ++d)
    {
        gravity[d] = g[cells.axis(d)];
        origin[d] = cells.origin(d);
        spacing[d] = cells.spacing(d);
        nCells[d] = cells.nCells(d);
    }
    const auto& fluid = water.fluid();
    mpm::plainKernel<dim> plain
    (
        {fluid.rho0(), fluid.mu(), fluid.soundSpeed()},
        gravity, origin, spacing, nCells
    );

    label C = -1;
    for (const auto& field : water.points().fields())
    {
        if (field.name == "velocityGradient") C = field.first;
    }

    plain.points.resize(water.size());
    for (label p = 0; p < water.size(); ++p)
    {
        auto& record = plain.points[p];
        for (int c = 0; c < dim; ++c)
        {
            record.x[c] = water.x(c)[p];
            record.v[c] = water.v(c)[p];
            for (int d = 0; d < dim; ++d)
            {
                record.C[c][d] =
                    C < 0 ? 0 : water.points().column(C + c*dim + d)[p];
            }
        }
        record.mass = water.mass()[p];
        record.J = water.J()[p];
    }
    return plain;
}


//- Centre of mass of a cloud
void centre(const mpm::waterCloud& water, const int dim, double* x)
{
    double mass = 0;
    for (int c = 0; c < dim; ++c) x[c] = 0;
    for (label p = 0; p < water.size(); ++p)
    {
        mass += water.mass()[p];
        for (int c = 0; c < dim; ++c) x[c] += water.mass()[p]*water.x(c)[p];
    }
    for (int c = 0; c < dim; ++c) x[c] /= mass;
}


//- Flat list of names and numbers, printed and written as JSON
class results
{
    std::vector<std::pair<std::string, double>> values_;

public:

    void add(const std::string& name, const double value)
    {
        values_.emplace_back(name, value);
    }

    void write(const fileName& file) const
    {
        std::ofstream os(file);
        const char* separator = "{\n";
        for (const auto& v : values_)
        {
            char number[40];
            std::snprintf(number, sizeof(number), "%.6g", v.second);
            os << separator << "    \"" << v.first << "\": " << number;
            separator = ",\n";
        }
        os << "\n}\n";
    }
};


template<int dim>
void measure
(
    mpm::materialPointSystem& points,
    Time& runTime,
    const label warmUp,
    const label nSteps,
    const bool withPlain,
    results& out
)
{
    scalar n = 0;
    for (const auto& cloud : points.clouds()) n += cloud.globalSize();
    const mpm::waterCloud* water =
        withPlain ? &points.liquid("mpmBenchmark -plain") : nullptr;

    stepCost none;
    for (label i = 0; i < warmUp; ++i) step(points, runTime, none);

    // In turns, so that production and plain kernel see the same machine
    const label nTurns = max(label(1), min(label(10), nSteps/20));
    const label perTurn = nSteps/nTurns;

    autoPtr<mpm::plainKernel<dim>> plain;
    if (withPlain)
    {
        plain.reset(new mpm::plainKernel<dim>(makePlain<dim>(*water, points.g())));
        plain->step(runTime.deltaTValue());
        *plain = makePlain<dim>(*water, points.g());
    }

    points.cost().reset();
    std::vector<double> turns, plainTurns;
    stepCost cost;
    double wallTime = 0;

    for (label turn = 0; turn < nTurns; ++turn)
    {
        returnReduce(label(0), sumOp<label>());
        const double before = cost.total;
        const double begin = wall();
        for (label i = 0; i < perTurn; ++i) step(points, runTime, cost);
        returnReduce(label(0), sumOp<label>());
        wallTime += wall() - begin;
        turns.push_back(cost.total - before);

        if (plain)
        {
            points.cost().stop();
            const double begin = cpu();
            for (label i = 0; i < perTurn; ++i)
            {
                plain->step(runTime.deltaTValue());
            }
            plainTurns.push_back(cpu() - begin);
        }
    }
    points.cost().stop();

    const scalar perPointStep = 1e9/(n*perTurn*nTurns);
    auto row = [&](const char* name, const double value)
    {
        std::printf("    %-28s %10.2f\n", name, value);
    };
    auto total = [](double value) { return returnReduce(value, sumOp<scalar>()); };

    const double ns = perPointStep*total(cost.total);
    const double best =
        perPointStep*nTurns*total(*std::min_element(turns.begin(), turns.end()));
    const double nsWall = perPointStep*returnReduce(wallTime, maxOp<scalar>());
    double pointMemory = 0, nodeMemory = 0;
    for (const auto& cloud : points.clouds())
    {
        pointMemory += cloud.pointMemory();
        nodeMemory += cloud.nodeMemory();
    }
    const double pointBytes = total(pointMemory)/n;
    const double nodeBytes = total(nodeMemory)/n;

    if (Pstream::master())
    {
        std::printf
        (
            "\n%d points, %d steps after %d, deltaT %.3g s, %d rank%s\n\n"
            "ns CPU per point and step\n",
            int(n), int(perTurn*nTurns), int(warmUp), runTime.deltaTValue(),
            int(Pstream::nProcs()), Pstream::nProcs() > 1 ? "s" : ""
        );
    }
    for (int part = 0; part < stepCost::nParts; ++part)
    {
        const double value = perPointStep*total(cost.parts[part]);
        if (Pstream::master()) row(stepCost::name(part), value);
        out.add(std::string("ns_") + stepCost::name(part), value);
    }
    if (Pstream::master())
    {
        row("total", ns);
        row("total, fastest turn", best);
        row("wall time", nsWall);
        std::printf("parts by the solver's cost meter (wall time)\n");
    }
    out.add("ns", ns);
    out.add("nsFastest", best);
    out.add("nsWall", nsWall);

    for (size_t i = 0; i < points.cost().size(); ++i)
    {
        const double value =
            perPointStep*total(points.cost().seconds(i));
        if (Pstream::master()) row(points.cost().name(i).c_str(), value);
        out.add(std::string("nsWall_") + points.cost().name(i), value);
    }
    if (Pstream::master())
    {
        std::printf("bytes per point\n");
        row("of points", pointBytes);
        row("of nodes", nodeBytes);
    }
    out.add("points", n);
    out.add("steps", perTurn*nTurns);
    out.add("ranks", Pstream::nProcs());
    out.add("wallPerStep", wallTime/(perTurn*nTurns));
    out.add("bytesPerPoint", pointBytes);
    out.add("nodeBytesPerPoint", nodeBytes);

    if (plain)
    {
        double sum = 0;
        for (const double t : plainTurns) sum += t;
        const double nsPlain = perPointStep*sum;
        const double bestPlain =
            perPointStep*nTurns
           *(*std::min_element(plainTurns.begin(), plainTurns.end()));

        // Both moved the same water: to the same place, nearly
        double a[dim], b[dim], distance = 0;
        centre(*water, dim, a);
        plain->centre(b);
        for (int c = 0; c < dim; ++c)
        {
            distance += sqr((a[c] - b[c])/points.grid().cells().spacing(c));
        }
        distance = std::sqrt(distance);

        std::printf("plain reference kernel, same points\n");
        row("total", nsPlain);
        row("total, fastest turn", bestPlain);
        row("mpmFoam / plain", ns/nsPlain);
        row("centres of mass apart [h]", distance);
        out.add("nsPlain", nsPlain);
        out.add("nsPlainFastest", bestPlain);
        out.add("ratioToPlain", ns/nsPlain);
        out.add("plainCentreDistance", distance);
    }
    if (Pstream::master()) std::printf("\n");
}

} // End anonymous namespace


// * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * * //

int main(int argc, char *argv[])
{
    argList::addNote
    (
        "Measure the time step of mpmFoam on a case whose points are set"
    );
    argList::addOption("steps", "N", "Timed steps (default: 200)");
    argList::addOption("warmUp", "N", "Steps before (default: 50)");
    argList::addBoolOption("plain", "Run the plain reference kernel as well");
    argList::addOption("json", "file", "Write the results to this file");

    #include "setRootCase.H"

    sigFpe::unset(false);

    #include "createTime.H"

    fvMesh mesh
    (
        IOobject
        (
            fvMesh::defaultRegion,
            runTime.timeName(),
            runTime,
            IOobject::MUST_READ
        )
    );
    mpm::materialPointSystem points(mesh);
    points.read(runTime);

    label nSteps = 200;
    label warmUp = 50;
    fileName json;
    args.readIfPresent("steps", nSteps);
    args.readIfPresent("warmUp", warmUp);
    args.readIfPresent("json", json);

    const bool plain = args.found("plain");
    if (plain && Pstream::parRun())
    {
        FatalErrorInFunction
            << "-plain runs on one rank only" << exit(FatalError);
    }

    // Nothing is written
    runTime.setEndTime(GREAT);

    results out;
    if (points.grid().nDim() == 2)
    {
        measure<2>(points, runTime, warmUp, nSteps, plain, out);
    }
    else
    {
        measure<3>(points, runTime, warmUp, nSteps, plain, out);
    }

    if (!json.empty() && Pstream::master()) out.write(json);

    return 0;
}

// ************************************************************************* //
