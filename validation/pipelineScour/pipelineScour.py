#!/usr/bin/env python3
"""Scour below a pipeline that lies on a bed of sand, in a current, against the
profiles that Mao (1986) measured after 11 and 18 s; and the current over the
same bed without the pipe, endless, against the logarithmic law.

    ./pipelineScour.py [--list] [name or pattern ...]

Writes results/pipelineScour.csv, a row for each run and figure, and
results/pipelineScour.png; a run whose rows are there is not made again."""

import re
import shutil
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

import bodies as shapes  # noqa: E402
import caseBuilder  # noqa: E402
from caseBuilder import G, RHO, RHO_S, Setup, box  # noqa: E402
from mpmfoam import figureTable, reference, style  # noqa: E402

caseBuilder.TIMEOUT = 4*3600

RESULTS = HERE/"results"/"pipelineScour.csv"
SERIES = HERE/"results"/"series"

# Mao's pipe, sand and current (Mathieu et al. 2019, Water 11, 1727; the depth
# is that of their domain)
D = 0.05
GRAIN = 0.36e-3
SHIELDS = 0.33
DEPTH = 0.23
U_STAR = np.sqrt(SHIELDS*(RHO_S/RHO - 1)*G*GRAIN)
KS = 2.5*GRAIN
KAPPA = 0.41

# Speed of sound of water and, at most, of the bed: 10 times the mean speed
C = 10

# The bed's surface is at 0, the pipe's axis above x = 0
BED = 1.5*D
# Its ends are joined: what leaves enters again. In a part of it the water, but
# not the sand, is brought to the current of the law
BEFORE, BEHIND = 4.5*D, 7.5*D
ZONE = (-4.25*D, -3*D)

# Hole that is there at the start, of the form of a cosine 3 D long: how the
# tunnel begins these grids do not resolve (README)
HOLE, HALF = 0.5*D, 1.5*D

# k and epsilon in the middle of the depth
K = 0.5*U_STAR**2/0.3
EPSILON = 2*U_STAR**3/(KAPPA*DEPTH)


def law(y):
    """Velocity over a rough bed [m/s]"""
    return U_STAR/KAPPA*np.log(np.maximum(30*y/KS, 1))


def meanOfLaw(lower, upper):
    """Of the law between two heights"""
    y = lower + (upper - lower)*(np.arange(200) + 0.5)/200
    return law(y).mean()


def bedLoad(stress):
    """Sand with MeyerPeterMueller by a stress, or None"""
    if not stress:
        return sand()
    return sand(bedLoad="MeyerPeterMueller", bedStress=stress)


def sand(**entries):
    return {"constitutiveModel": "DruckerPrager", "DruckerPragerCoeffs": {
        "rhoS": RHO_S, "d": GRAIN, "e0": 0.667, "E0": 216, "n": 0.5,
        "nu": 0.2, "phi": 32, "psi": 0}, **entries}


def liquid(turbulence):
    """Of a turbulence model, or of a transfer without one"""
    if turbulence in ["APIC", "XAPIC"]:
        return {"transfer": turbulence}
    return {"transfer": "XAPIC", "turbulence": turbulence,
            "kEpsilonCoeffs": {"k": K, "epsilon": EPSILON}}


def columns(x0, x1, h, hole):
    """Ends and top of the columns of the bed; one but for the hole"""
    if not hole:
        return [(x0, x1, 0)]
    n = round(2*HALF/h)
    edges = h/2*np.arange(-n, n + 1)
    x = 0.5*(edges[1:] + edges[:-1])
    tops = -hole/2*(1 + np.cos(np.pi/HALF*np.clip(x, -HALF, HALF)))
    tops[tops > -h/4] = 0                   # shallower than a point
    return [(x0, edges[0], 0), *zip(edges, edges[1:], tops),
            (edges[-1], x1, 0)]


def current(x0, x1, h, hole=0):
    """The water over the bed, in layers of a cell with the velocity of the law,
    and that in the pores"""
    rows = round(DEPTH/h)
    regions = {}
    for i, (a, b, top) in enumerate(columns(x0, x1, h, hole)):
        still = {"pressure": "hydrostatic", "level": DEPTH}
        regions[f"pores{i}"] = box((a, -BED), (b, top), **still)
        if top < 0:
            regions[f"hole{i}"] = box((a, top), (b, 0), **still)
    for j in range(rows):
        top = DEPTH if j == rows - 1 else (j + 1)*h
        regions[f"layer{j}"] = box(
            (x0, j*h), (x1, top), pressure="hydrostatic", level=DEPTH,
            velocity=(meanOfLaw(j*h, top), 0, 0))
    return regions


def solve(name, setup):
    path = HERE/"runs"/name
    shutil.rmtree(path, ignore_errors=True)
    setup.energy = False
    case = setup.write(path)
    case.prepare()
    case.solve()
    return case


def keep(name, **columns):
    SERIES.mkdir(parents=True, exist_ok=True)
    reference.writeCsv(SERIES/f"{name}.csv", columns)


# --- the current alone ----------------------------------------------------

def flat(name, cells, turbulence, stress=None, columns=8, end=5):
    """An endless bed; a force drives the water with the stress of the law's
    u*. With a stress for bedLoad, also what sand moves, after the formula"""
    h = D/cells
    length = columns*h
    case = solve(name, Setup(
        cells=(columns, round((BED + DEPTH)/h) + 4), h=h, origin=(0, -BED, 0),
        points=2, regions=current(0, length, h),
        water={**liquid(turbulence), "bodyForce": (U_STAR**2/DEPTH, 0, 0)},
        soil=bedLoad(stress),
        soilRegions={"bed": box((0, -BED), (length, 0), stress="geostatic",
                                saturated=True)},
        interaction={"drag": "Gidaspow"},
        fluid={"soundSpeed": C}, mpm={"maxSoilSoundSpeed": C}
    ).cyclic("x").until(end, end/5))
    p = case.points()
    over = p.x[:, 1] > 0
    u = (p.mass*p.U[:, 0])[over].sum()/p.mass[over].sum()
    y = (np.arange(round(DEPTH/h)) + 0.5)*h
    profile = [p.U[abs(p.x[:, 1] - v) < h/2, 0].mean() for v in y]
    keep(name, y=y, u=profile, law=law(y))
    yield ("mean velocity over the law's", u/meanOfLaw(0, DEPTH), "1 +- 10 %")
    x = [case.case.cloudField(t, "soil", "x") for t in case.times[-3:]]
    yield "uppermost point of the soil, mm", 1e3*x[-1][:, 1].max(), "stated"
    if stress:
        mass = case.case.cloudField(case.times[-1], "soil", "mass")
        way = np.zeros(len(mass))
        for first, last in zip(x, x[1:]):
            step = last[:, 0] - first[:, 0]
            way += (step + length/2) % length - length/2
        moved = (mass*way).sum()/RHO_S/(length*h)/(2*end/5)
        scale = np.sqrt((RHO_S/RHO - 1)*G*GRAIN**3)
        yield ("transport over the formula's at the law's stress",
               moved/scale/(8*(SHIELDS - 0.047)**1.5), "0.5 to 2")


# --- the pipe -------------------------------------------------------------

def pipe(name, cells, turbulence, stress=None, end=18):
    h = D/cells
    x0, x1 = -BEFORE, BEHIND
    bed = round(BED/h)
    nx, ny = round((x1 - x0)/h), bed + round(1.4*DEPTH/h)

    edges = h*np.unique(np.round(np.geomspace(1, DEPTH/h, 7)))
    edges[-1] = DEPTH + 2*h
    zones = {
        f"current{i}": {
            "min": (ZONE[0], a, -1), "max": (ZONE[1], b, 1), "rate": 30,
            "velocity": (meanOfLaw(a, min(b, DEPTH)), 0, 0)}
        for i, (a, b) in enumerate(zip([0, *edges[:-1]], edges))}
    setup = Setup(
        cells=(nx, ny), h=h, origin=(x0, -BED, 0), points=2,
        regions=current(x0, x1, h, HOLE),
        water={**liquid(turbulence), "relaxationZones": zones},
        soil=bedLoad(stress),
        soilRegions={
            f"bed{i}": box((a, -BED), (b, top), stress="geostatic",
                           saturated=True)
            for i, (a, b, top) in enumerate(columns(x0, x1, h, HOLE))},
        interaction={"drag": "Gidaspow"},
        fluid={"soundSpeed": C}, mpm={"maxSoilSoundSpeed": C},
        bodies={"pipe": {"type": "fixed",
                         "surface": shapes.cylinder((0, D/2), D/2),
                         "soil": {"frictionCoefficient": 0.4}}},
        functions={
            "scour": {"type": "scourProfile", "cloud": "soil",
                      "libs": '("libmpmFunctionObjects.so")',
                      "direction": (1, 0, 0),
                      "writeControl": "adjustableRunTime",
                      "writeInterval": 0.1},
            "forces": {"type": "materialPointForces", "cloud": "water",
                       "libs": '("libmpmFunctionObjects.so")',
                       "bodies": "(pipe)",
                       "writeControl": "adjustableRunTime",
                       "writeInterval": 0.05}}).cyclic("x")
    case = solve(name, setup.until(end, 1))
    yield from compare(case, name, end)
    log = (case.path/"log.mpmFoam").read_text()
    yield ("CPU time, min", float(re.findall(
        r"ExecutionTime = (\S+) s", log)[-1])/60, "stated")


def compare(case, name, end):
    """With the measured profiles up to a time"""
    for time in [11, 18]:
        if time > end:
            continue
        x, bedLevel = bedProfile(case, time)
        measured = reference.data(f"sedfoam_Mao_{time}s_expe.csv")
        z = np.interp(measured["x"], x, bedLevel)
        exact = measured["z"] + D/2
        keep(f"{name}_t{time}", x=x, bed=bedLevel)
        yield (f"{time} s: rms of the profile over D, %",
               100*np.sqrt(np.mean((z - exact)**2))/D, "stated")
        yield (f"{time} s: depth under the pipe over the measured one",
               np.interp(0, x, bedLevel)/np.interp(0, measured["x"], exact),
               "1 +- 25 %")
        yield (f"{time} s: greatest depth over the measured one",
               bedLevel[abs(x) < 2*D].min()/exact.min(), "stated")
        yield (f"{time} s: height behind the pipe over the measured one",
               bedLevel[(x > D) & (x < 6*D)].max()/exact.max(), "stated")


def bedProfile(case, time):
    """x and height of the bed, where there is one"""
    path = case.path/"postProcessing"/"scour"
    files = {float(f.parent.name): f for f in path.glob("*/profile.csv")}
    near = min(files, key=lambda t: abs(t - time))
    if abs(near - time) > 0.01:
        raise ValueError(f"{path} has no profile of {time} s")
    data = {k.strip("# "): v for k, v in reference.readCsv(files[near]).items()}
    good = np.isfinite(data["bed"])
    return data["x"][good], data["bed"][good]


# --- the picture ----------------------------------------------------------

def draw():
    """What there is of the profiles"""
    fig, axes = style.figure(2, 1, height=2.3)
    for time, ax in zip([11, 18], axes):
        measured = reference.data(f"sedfoam_Mao_{time}s_expe.csv")
        ax.plot(measured["x"]/D, measured["z"]/D + 0.5, "k.",
                label="Mao 1986")
        files = sorted(SERIES.glob(f"pipe_*_t{time}.csv"))
        for file, colour in zip(files, style.COLOURS):
            data = reference.readCsv(file)
            ax.plot(data["x"]/D, data["bed"]/D, color=colour,
                    label=file.stem[len("pipe_"):-len(f"_t{time}")])
        t = np.linspace(0, 2*np.pi, 100)
        ax.plot(0.5*np.cos(t), 0.5 + 0.5*np.sin(t), color="0.5")
        ax.set(xlabel="x/D", ylabel="z/D", title=f"{time} s",
               xlim=(-4, 7), ylim=(-1.2, 1.1))
        ax.legend()
    style.save(fig, HERE/"results"/"pipelineScour.png")


# Of bedLoad; none without it
STRESSES = {"": None, "_drag": "drag", "_wallLaw": "wallLaw"}
VARIANTS = [(t, s) for t in ["kEpsilon", "XAPIC", "APIC"] for s in STRESSES
            if s != "_wallLaw" or t == "kEpsilon"]

CONTENTS = {
    **{f"flat_D{c}h_{t}{s}":
       (lambda n, c=c, t=t, s=s: flat(n, c, t, STRESSES[s]))
       for c in [4, 6, 8] for t, s in VARIANTS},
    **{f"pipe_D{c}h_{t}{s}":
       (lambda n, c=c, t=t, s=s: pipe(n, c, t, STRESSES[s]))
       for c in [4, 6, 8] for t, s in VARIANTS},
}


if __name__ == "__main__":
    figureTable.main(__doc__, HERE, RESULTS, CONTENTS)
    if SERIES.is_dir():
        draw()
