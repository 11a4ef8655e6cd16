#!/usr/bin/env python3
"""Speed and memory of mpmFoam's time step.

    test/benchmark/run                  all configurations, one table
    test/benchmark/run 2D9 2D16         some of them
    test/benchmark/run --quick          one small one, to see that it works
    test/benchmark/run --prepare DIR    only make the cases, in DIR; then
        mpmBenchmark -case DIR/2D9      as often as you like

A column of water collapses in a tank twice as long as the water is wide; from
0.05 s on the time step is measured by mpmBenchmark (CPU time of the process),
beside a plain reference kernel on the same points. Other machines, other
figures: what travels is the ratio.
"""

import argparse
import datetime
import json
import math
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
}

# What else runs on the points of 2D9 and 3D8: fvSolution/MPM, water cloud
OPTIONS = {
    "no smoothing": ({"smoothing": "no"}, {}),
    "no volume correction": ({"volumeCorrection": "no"}, {}),
    "neither": ({"smoothing": "no", "volumeCorrection": "no"}, {}),
    "no viscosity": ({}, {"mu": "0"}),
    "FLIP": ({}, {"transfer": "FLIP"}),
    "linear": ({"shapeFunction": "linear"}, {}),
    "cubicBSpline": ({"shapeFunction": "cubicBSpline"}, {}),
}

# Gates of the issue
GATE_NS = {"2D9": 45, "2D16": 45, "3D8": 140}
GATE_SPEED_UP = 1.7


def write(path, text, cls="dictionary"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(cls=cls, name=path.name) + text)


def run(command, case, log):
    """Run an application; its output goes to a log in the case."""
    with open(case / f"log.{log}", "w") as out:
        code = subprocess.call(command, cwd=case, stdout=out, stderr=subprocess.STDOUT)
    if code:
        text = (case / f"log.{log}").read_text()
        sys.exit(f"{' '.join(command)} failed in {case}:\n{text[-2000:]}")
    return (case / f"log.{log}").read_text()


def write_numerics(case, numerics=None, cloud=None):
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


def write_control(case, end, interval):
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


def make_case(case, dim, per_direction, points):
    """A dam break at START; water of width L and height 2 L (2D) or L (3D)."""
    if case.exists():
        shutil.rmtree(case)
    rise = 2 if dim == 2 else 1
    n = (points / per_direction**dim / rise) ** (1 / dim)
    n = max(4, 2 * round(n / 2))
    h = WIDTH / n

    cells = (2 * n, (rise + 1) * n, 1 if dim == 2 else n)
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
    write(
        case / "0/U.water",
        f"""dimensions [0 1 -1 0 0 0 0];
internalField uniform (0 0 0);
boundaryField
{{
    walls {{ type slip; }}
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
    write(
        case / "system/setMaterialPointsDict",
        f"""water
{{
    pointsPerDirection {per_direction};
    regions
    {{
        column
        {{
            type box;
            min (0 0 -1);
            max ({WIDTH} {rise * WIDTH} 1);
            pressure hydrostatic;
            level {rise * WIDTH};
        }}
    }}
}}
""",
    )
    # Ranks get equal numbers of points, not of cells
    write(
        case / "system/decomposeParDict",
        """numberOfSubdomains 2;
method simple;
simpleCoeffs { n (2 1 1); delta 0.001; }
weightField pointWeight;
""",
    )
    write_numerics(case)
    write_control(case, START, START)
    run(["blockMesh"], case, "blockMesh")
    run(["setMaterialPoints"], case, "setMaterialPoints")
    run(["mpmFoam"], case, "mpmFoam")


def measure(case, steps, warm_up, plain=False, ranks=1):
    command = ["mpmBenchmark", "-steps", str(steps), "-warmUp", str(warm_up)]
    command += ["-json", str(case.resolve() / "result.json")]
    if plain:
        command += ["-plain"]
    if ranks > 1:
        command = ["mpirun", "-np", str(ranks)] + command + ["-parallel"]
    run(command, case, "mpmBenchmark")
    return json.loads((case / "result.json").read_text())


def machine():
    name = platform.machine()
    try:
        name = re.search(r"model name\s*: (.*)", Path("/proc/cpuinfo").read_text())[1]
    except (OSError, TypeError):
        pass
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"],
        cwd=Path(__file__).parent, capture_output=True, text=True,
    ).stdout.strip()
    return {
        "processor": name,
        "cores": os.cpu_count(),
        "load": os.getloadavg()[0],
        "date": datetime.datetime.now().isoformat(timespec="minutes"),
        "commit": commit,
    }


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("configurations", nargs="*", help=" ".join(CONFIGURATIONS))
    parser.add_argument("--prepare", metavar="DIR", type=Path)
    parser.add_argument("--points", type=int, default=200000)
    args = parser.parse_args()
    names = args.configurations or list(CONFIGURATIONS)
    if args.prepare:
        for name in names:
            make_case(args.prepare / name, *CONFIGURATIONS[name], args.points)
            print(args.prepare / name)


if __name__ == "__main__":
    main()
