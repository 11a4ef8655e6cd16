#!/usr/bin/env python3
"""Speed and memory of mpmFoam's time step.

    test/benchmark/run                  all configurations, one table
    test/benchmark/run 2D9 2D16         some of them
    test/benchmark/run --quick          one small one, to see that it works
    test/benchmark/run --prepare DIR    only make the cases, in DIR; then
        mpmBenchmark -case DIR/2D9      as often as you like

A column of water collapses in a tank twice as long as the water is wide. From
0.05 s on mpmBenchmark measures the time step: CPU time of the process, beside
a plain reference kernel (plainKernel.H) that takes turns on the same points.
Other machines, other figures; the ratios travel. soilRest is a bed of dry sand
with the stress of its own weight, soilFlow a column of it that collapses on a
rough floor, from 0.15 s on and with a quarter of the points; both with the full
model. mixture is such a column with water in all pores, as many points of both,
from 0.1 s on.

Prints tables and writes benchmark.json (--json). Judges nothing: the gates of
the project stand beside the figures. Measure on an idle machine.
"""

import argparse
import datetime
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

G = 9.81
WIDTH = 0.1          # of the water [m]
START = 0.05         # of the measurement [s]
SOIL_START = {"soilRest": 1e-3, "soilFlow": 0.15, "mixture": 0.1}

HEADER = """FoamFile
{{
    version     2.0;
    format      ascii;
    class       {cls};
    object      {name};
}}

"""

# name: dimensions, points per direction and cell
CONFIGURATIONS = {
    "2D9": (2, 3),
    "2D16": (2, 4),
    "3D8": (3, 2),
    "3D27": (3, 3),
    "soilRest": (2, 3),
    "soilFlow": (2, 3),
    "mixture": (2, 3),
}

# What else runs on the points of 2D9 and 3D8: fvSolution/MPM, water cloud
OPTIONS = {
    "no smoothing": ({"smoothing": "no"}, {}),
    "no volume correction": ({"volumeCorrection": "no"}, {}),
    "neither": ({"smoothing": "no", "volumeCorrection": "no"}, {}),
    "no viscosity": ({}, {"mu": "0"}),
    "FLIP": ({}, {"transfer": "FLIP"}),
    # APIC on linear functions is unstable at a free surface
    "FLIP, linear": ({"shapeFunction": "linear"}, {"transfer": "FLIP"}),
    "cubicBSpline": ({"shapeFunction": "cubicBSpline"}, {}),
}

# Gates of the issue
GATE_NS = {"2D9": 45, "2D16": 45, "3D8": 140, "soilRest": 150, "soilFlow": 350,
           "mixture": 180}
GATE_SPEED_UP = 1.7


def write(path, text, cls="dictionary"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(cls=cls, name=path.name) + text)


def environment(case):
    """OpenFOAM wants PWD to be the working directory."""
    return {**os.environ, "PWD": str(case.resolve())}


def run(command, case, log):
    """Run an application; its output goes to a log in the case."""
    with open(case / f"log.{log}", "w") as out:
        code = subprocess.call(
            command, cwd=case, env=environment(case), stdout=out, stderr=subprocess.STDOUT
        )
    if code:
        text = (case / f"log.{log}").read_text()
        sys.exit(f"{' '.join(command)} failed in {case}:\n{text[-2000:]}")
    return (case / f"log.{log}").read_text()


def writeNumerics(case, numerics=None, cloud=None):
    """fvSolution and materialPointProperties with these entries changed."""
    settings = {"shapeFunction": "quadraticBSpline", "maxCo": "0.5"}
    settings.update(numerics or {})
    water = {"transfer": "APIC", "mu": "1e-3"}
    water.update(cloud or {})
    entries = "".join(f"    {k} {v};\n" for k, v in settings.items())
    write(case / "system/fvSolution", f"MPM\n{{\n{entries}}}\n")
    write(
        case / "constant/materialPointProperties",
        f"""clouds (water);

water
{{
    constitutiveModel weaklyCompressibleNewtonian;
    weaklyCompressibleNewtonianCoeffs
    {{
        rho0        1000;
        mu          {water['mu']};
        soundSpeed  auto;
    }}
    transfer {water['transfer']};
}}
""",
    )


WATER = """water
{
    constitutiveModel weaklyCompressibleNewtonian;
    weaklyCompressibleNewtonianCoeffs { rho0 1000; mu 1e-3; }
}

interaction { drag DarcyForchheimer; }
"""


def writeSoil(case, wet):
    """materialPointProperties of sand, soil C of the paper's Table 2; wet: with
    water."""
    write(
        case / "constant/materialPointProperties",
        ("clouds (water soil);\n\n" + WATER if wet else "clouds (soil);\n")
        + """
soil
{
    constitutiveModel elastoplasticMuI;
    elastoplasticMuICoeffs
    {
        rhoS    2650;   d       2e-3;   e0      0.818;
        E0      216;    nu      0.2;    n       0.5;
        phiC    30;     eRef    0.827;  lambda  0.0596; xi      0.365;
        Ad      0.7;    kp      0.0044; np      2.4;    nd      2.9;
        I0      0.28;   muS     0.577;  muD     0.660;
        PhiC    0.70;   dPhi    0.29;
    }
}
""",
    )


def writeControl(case, end, interval):
    write(
        case / "system/controlDict",
        f"""application mpmFoam;
startFrom latestTime;
stopAt endTime;
endTime {end};
deltaT 1e-5;
adjustTimeStep yes;
writeControl adjustableRunTime;
writeInterval {interval};
writeFormat binary;
writePrecision 12;
timePrecision 8;
""",
    )


def makeCase(case, dim, perDirection, points):
    """A dam break at START; water of width L and height 2 L (2D) or L (3D). Or
    soil: such a column, or a bed that fills the tank to the height L."""
    if case.exists():
        shutil.rmtree(case)
    soil = case.name in SOIL_START
    wet = case.name == "mixture"
    clouds = ["water", "soil"] if wet else ["soil" if soil else "water"]
    bed = case.name == "soilRest"
    rise = 2 if dim == 2 else 1
    if soil and not bed:
        points /= 4
    n = (points / perDirection**dim / rise) ** (1 / dim)
    n = max(4, 2 * round(n / 2))
    h = WIDTH / n

    cells = ((2 if bed or not soil else 4) * n, (rise + 1) * n, 1 if dim == 2 else n)
    x, y, z = (c * h for c in cells)
    side = "empty" if dim == 2 else "wall"
    write(
        case / "system/blockMeshDict",
        f"""scale 1;
vertices
(
    (0 0 0) ({x} 0 0) ({x} {y} 0) (0 {y} 0)
    (0 0 {z}) ({x} 0 {z}) ({x} {y} {z}) (0 {y} {z})
);
blocks (hex (0 1 2 3 4 5 6 7) ({cells[0]} {cells[1]} {cells[2]}) simpleGrading (1 1 1));
boundary
(
    walls
    {{
        type wall;
        faces ((0 4 7 3) (1 2 6 5) (0 1 5 4) (3 7 6 2));
    }}
    sides
    {{
        type {side};
        faces ((0 3 2 1) (4 5 6 7));
    }}
);
""",
    )
    for cloud in clouds:
        wall = "slip"
        if cloud == "soil" and not bed:
            wall = "frictional; frictionCoefficient 0.577"
        write(
            case / f"0/U.{cloud}",
            f"""dimensions [0 1 -1 0 0 0 0];
internalField uniform (0 0 0);
boundaryField
{{
    walls {{ type {wall}; }}
    sides {{ type {'empty' if dim == 2 else 'slip'}; }}
}}
""",
            "volVectorField",
        )
    write(
        case / "constant/g",
        f"dimensions [0 1 -2 0 0 0 0];\nvalue (0 -{G} 0);\n",
        "uniformDimensionedVectorField",
    )
    write(
        case / "system/fvSchemes",
        "ddtSchemes {}\ngradSchemes {}\ndivSchemes {}\nlaplacianSchemes {}\n"
        "interpolationSchemes {}\nsnGradSchemes {}\n",
    )
    width, height = (2 * WIDTH, WIDTH) if bed else (WIDTH, rise * WIDTH)
    state = {"soil": "stress geostatic;",
             "water": f"pressure hydrostatic; level {height};"}
    write(
        case / "system/setMaterialPointsDict",
        "\n".join(f"""{cloud}
{{
    pointsPerDirection {perDirection};
    regions
    {{
        column
        {{
            type box;
            min (0 0 -1);
            max ({width} {height} 1);
            {state[cloud]}
        }}
    }}
}}
""" for cloud in clouds),
    )
    # Ranks get equal numbers of points, not of cells
    write(
        case / "system/decomposeParDict",
        """numberOfSubdomains 2;
method simple;
simpleCoeffs { n (2 1 1); delta 0.001; }
weightField alpha.water;
""",
    )
    writeNumerics(case)
    if soil:
        writeSoil(case, wet)
    start = SOIL_START.get(case.name, START)
    writeControl(case, start, start)
    run(["blockMesh"], case, "blockMesh")
    run(["setMaterialPoints"], case, "setMaterialPoints")
    run(["mpmFoam"], case, "mpmFoam")


def command(case, steps, warmUp, ranks=1, plain=False, result="result.json"):
    line = ["mpmBenchmark", "-steps", str(steps), "-warmUp", str(warmUp)]
    line += ["-json", str(case.resolve() / result)]
    if plain:
        line += ["-plain"]
    if ranks > 1:
        line = ["mpirun", "-np", str(ranks)] + line + ["-parallel"]
    return line


def measure(case, steps, warmUp, **options):
    run(command(case, steps, warmUp, **options), case, "mpmBenchmark")
    return json.loads((case / "result.json").read_text())


def measureTwo(case, steps, warmUp):
    """Two runs side by side that know nothing of each other."""
    names = ["result1.json", "result2.json"]
    runs = [
        subprocess.Popen(
            command(case, steps, warmUp, result=name),
            cwd=case, env=environment(case), stdout=subprocess.DEVNULL,
        )
        for name in names
    ]
    if any([r.wait() for r in runs]):
        sys.exit(f"mpmBenchmark failed in {case}")
    return max(
        json.loads((case / name).read_text())["wallPerStep"] for name in names
    )


def machine():
    name = platform.machine()
    found = re.search(r"model name\s*: (.*)", readText("/proc/cpuinfo"))
    if found:
        name = found[1]
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"],
        cwd=Path(__file__).resolve().parent, capture_output=True, text=True,
    ).stdout.strip()
    return {
        "processor": name,
        "cores": os.cpu_count(),
        "loadAtStart": os.getloadavg()[0],
        "date": datetime.datetime.now().isoformat(timespec="minutes"),
        "commit": commit,
    }


def readText(path):
    try:
        return Path(path).read_text()
    except OSError:
        return ""


def number(value):
    if not isinstance(value, float):
        return str(value)
    return f"{value:.1f}" if value >= 10 else f"{value:.2f}"


def table(title, columns, rows):
    """Print rows (first column left, others right aligned)."""
    cells = [columns] + [
        [number(c) for c in row] for row in rows
    ]
    widths = [max(len(row[i]) for row in cells) for i in range(len(columns))]
    print(f"\n{title}")
    for row in cells:
        first = row[0].ljust(widths[0])
        rest = "  ".join(c.rjust(w) for c, w in zip(row[1:], widths[1:]))
        print(f"    {first}  {rest}", flush=True)


def stepsOf(dim, quick):
    """Timed steps, and steps before."""
    if quick:
        return 20, 5
    return (200, 50) if dim == 2 else (80, 20)


def benchmarkConfigurations(work, names, quick):
    results = {}
    rows = []
    for name in names:
        dim = CONFIGURATIONS[name][0]
        plain = name not in SOIL_START
        r = measure(work / name, *stepsOf(dim, quick), plain=plain)
        results[name] = r
        rows.append([
            name, int(r["points"]), r["ns"], r["nsFastest"],
            f"<= {GATE_NS[name]}" if name in GATE_NS else "-",
            r["nsPlain"] if plain else "-", r["ratioToPlain"] if plain else "-",
            int(r["bytesPerPoint"]), int(r["nodeBytesPerPoint"]),
        ])
    table(
        "Time step: ns CPU per point and step",
        ["configuration", "points", "mean", "fastest 10th", "gate", "plain",
         "to plain", "bytes/point", "of nodes"],
        rows,
    )
    parts = [k for k in results[names[0]] if k.startswith("ns_")]
    table(
        "Parts of the step: ns CPU per point and step",
        ["part"] + names,
        [[p[3:]] + [results[n][p] for n in names] for p in parts],
    )
    return results


def benchmarkOptions(work, name, quick):
    """Each option against the default measured just before it."""
    case = work / name
    dim = CONFIGURATIONS[name][0]
    results = {}
    rows = []
    for option, (numerics, cloud) in OPTIONS.items():
        base = measure(case, *stepsOf(dim, quick))
        writeNumerics(case, numerics, cloud)
        r = measure(case, *stepsOf(dim, quick))
        writeNumerics(case)
        ratio = r["ns"] / base["ns"]
        results[option] = {
            "ns": r["ns"], "nsDefault": base["ns"], "ratioToDefault": ratio
        }
        rows.append([option, r["ns"], base["ns"], ratio])
    table(
        f"Options, {name}: ns CPU per point and step",
        ["option", "mean", "default", "ratio"], rows,
    )
    return results


def benchmarkRanks(work, name, quick):
    """Wall time of one rank, of two, and of two runs side by side."""
    case = work / name
    dim = CONFIGURATIONS[name][0]
    steps, warmUp = stepsOf(dim, quick)
    run(["decomposePar", "-force", "-latestTime"], case, "decomposePar")

    one, two, independent = [], [], []
    for _ in range(1 if quick else 3):
        one.append(measure(case, steps, warmUp)["wallPerStep"])
        two.append(measure(case, steps, warmUp, ranks=2)["wallPerStep"])
        independent.append(measureTwo(case, steps, warmUp))
    result = {
        "wallPerStepOneRank": min(one),
        "wallPerStepTwoRanks": min(two),
        "speedUp": min(one) / min(two),
        "speedUpOfMachine": 2 * min(one) / min(independent),
    }
    table(
        f"Two ranks, {name} (shortest of {len(one)} runs)",
        ["ms per step: one rank", "two ranks", "speed-up", "gate", "of two separate runs"],
        [[number(1e3 * min(one)), 1e3 * min(two), result["speedUp"],
          f">= {GATE_SPEED_UP}", result["speedUpOfMachine"]]],
    )
    return result


def benchmark(work, names, points, quick, withRanks):
    out = {"machine": machine()}
    print(
        "{processor}, {cores} cores, load {loadAtStart:.2f}, commit {commit}".format(
            **out["machine"]
        ),
        flush=True,
    )
    for name in names:
        makeCase(work / name, *CONFIGURATIONS[name], points)
    out["configurations"] = benchmarkConfigurations(work, names, quick)

    # One of each dimension
    some = [
        n for n in names
        if n not in SOIL_START and CONFIGURATIONS[n][1] == 5 - CONFIGURATIONS[n][0]
    ]
    if not quick:
        out["options"] = {n: benchmarkOptions(work, n, quick) for n in some}
    if withRanks:
        out["twoRanks"] = {n: benchmarkRanks(work, n, quick) for n in some}
    return out


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument(
        "configurations", nargs="*", metavar="configuration",
        help="of " + " ".join(CONFIGURATIONS) + " (default: all)",
    )
    parser.add_argument("--quick", action="store_true", help="2D9, 5000 points, few steps")
    parser.add_argument("--points", type=int, default=200000, help="default: 200000")
    parser.add_argument("--no-ranks", action="store_true", help="no parallel runs")
    parser.add_argument("--prepare", metavar="DIR", type=Path, help="only make the cases")
    parser.add_argument(
        "--json", metavar="FILE", type=Path, default=Path("benchmark.json"),
        help="default: benchmark.json in this directory",
    )
    args = parser.parse_args()

    names = args.configurations or (["2D9"] if args.quick else list(CONFIGURATIONS))
    for name in names:
        if name not in CONFIGURATIONS:
            parser.error(f"unknown configuration {name}; there are {' '.join(CONFIGURATIONS)}")
    points = 5000 if args.quick else args.points

    if args.prepare:
        for name in names:
            makeCase(args.prepare / name, *CONFIGURATIONS[name], points)
            print(args.prepare / name)
        return

    with tempfile.TemporaryDirectory(prefix="mpmBenchmark.") as work:
        results = benchmark(Path(work), names, points, args.quick, not args.no_ranks)
    args.json.write_text(json.dumps(results, indent=4) + "\n")
    print(f"\nWritten to {args.json}")


if __name__ == "__main__":
    main()
