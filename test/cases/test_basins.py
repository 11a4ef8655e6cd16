"""Bodies of water that walls part from all others: full vessels, and both
sides of a thin wall."""

import shutil

import numpy as np
import pytest

from caseBuilder import G, Setup, box, hydrostatic


# --- vessels without a free surface ---------------------------------------

def suspension(**entries):
    """Grains that settle in a narrow vessel full of liquid"""
    return Setup(
        cells=(2, 10), h=0.002, points=3, energy=False,
        regions={"all": hydrostatic((0, 0), (0.004, 0.02))},
        soilRegions={"grains": box((0, 0), (0.004, 0.0175), voidRatio=1)},
        fluid={"rho0": 950, "mu": 0.4e-3}, soilWall="slip",
        soil={"DruckerPragerCoeffs": {
            "rhoS": 1050, "d": 290e-6, "e0": 0.695, "nsC": 0.592, "E0": 216,
            "n": 0.5, "nu": 0.2, "phi": 30}},
        mpm={"maxSoilSoundSpeed": 5, "logInterval": 1000},
        control={"deltaT": 1e-5}, **entries).cyclic("x")


def meanPressure(case, time):
    points = case.points(time)
    return float(np.average(points.p, weights=points.mass))


def speed(case, time, cloud):
    U = case.case.cloudField(time, cloud, "U")
    return float(np.sqrt((U**2).sum(axis=1).mean()))


def testFullVessel(tmp_path, figures):
    """Nothing but its volume ties the pressure of a full vessel: it may not
    drift, and nothing may grow (grains settle with 0.5 mm/s)"""
    case = suspension().until(20, 2.5).write(tmp_path/"case").prepare()
    case.solve()
    rhoGH = 950*G*0.02
    mean = [meanPressure(case, t) for t in case.times]
    figures.show("mean pressure, Pa", [round(p, 1) for p in mean])
    figures.atMost("mean pressure: largest change over rho g H",
                   np.abs(np.array(mean) - mean[0]).max()/rhoGH, 0.001)
    for cloud in ["water", "soil"]:
        rms = [speed(case, t, cloud) for t in case.times[1:]]
        figures.show(f"rms speed of {cloud}, mm/s",
                     [round(1e3*v, 3) for v in rms])
        figures.atMost(f"rms speed of {cloud} at the end, m/s",
                       max(rms[-4:]), 2e-3)
    alpha = sum(case.case.field(case.times[-1], f"alpha.{c}")
                for c in ["water", "soil"])
    figures.atMost("volume that the grid sees at the end: error",
                   abs(alpha.mean() - 1), 5e-4)


def stillWater():
    return Setup(
        cells=(4, 12), h=0.01, points=3, energy=False,
        regions={"all": hydrostatic((0, 0), (0.04, 0.12))},
        placement={"placement": "jittered", "jitter": 0.5}).until(2, 0.5)


@pytest.mark.parametrize("ranks", [1, 2])
def testFullOfWater(tmp_path, figures, ranks):
    """The correction that follows the noise of the points adds up to nothing"""
    case = stillWater().write(tmp_path/"case").prepare()
    if ranks > 1:
        case.decompose(ranks, (1, 2, 1))
    case.solve(ranks=ranks)
    mean = [meanPressure(case, t) for t in case.times]
    figures.show("mean pressure, Pa", [round(p, 2) for p in mean])
    figures.atMost("mean pressure: largest change over rho g H",
                   np.abs(np.array(mean) - mean[0]).max()/(1000*G*0.12),
                   0.001)


# --- walls of two cells ---------------------------------------------------

# The length of the steps is of all water
FIXED = {"adjustTimeStep": False, "deltaT": 2e-4}


def twoBasins(right, shape="quadraticBSpline", wall=2, **entries):
    """Water on one side of a wall, or on both"""
    n = 12
    regions = {"left": hydrostatic((0, 0), (0.12, 0.12))}
    if right:
        x = 0.01*(n + wall)
        regions["right"] = hydrostatic((x, 0), (x + 0.12, 0.05))
    return Setup(
        cells=(2*n + wall, 16), h=0.01, points=3, energy=False,
        solid=[((n, 0), (n + wall, 16))], regions=regions,
        placement={"placement": "jittered"}, fluid={"soundSpeed": 12},
        mpm={"shapeFunction": shape}, control=FIXED, **entries).steps(100)


def leftPoints(case):
    points = case.points()
    left = points.x[:, 0] < 0.125
    return points.x[left], points.U[left], points.p[left]


@pytest.mark.parametrize("shape", ["linear", "quadraticBSpline",
                                   "cubicBSpline"])
def testWallOfTwoCells(tmp_path, figures, shape):
    """Two bodies of water know nothing of each other"""
    water = {"transfer": "FLIP"} if shape == "linear" else {}
    found = {}
    for right in [False, True]:
        case = twoBasins(right, shape, water=water).write(
            tmp_path/str(right)).prepare()
        case.solve()
        found[right] = leftPoints(case)
    figures.show("points on the left", len(found[True][0]))
    for name, a, b, scale in zip(
            ["place", "velocity", "pressure"], found[True], found[False],
            [0.01, 1, 1000*G*0.12]):
        figures.atMost(f"{name}: largest difference",
                       np.abs(a - b).max()/scale, 1e-12)


def testWallOfTwoCellsParallel(tmp_path, figures):
    """The same on two ranks that meet inside the wall's length"""
    serial = twoBasins(True).write(tmp_path/"serial").prepare()
    serial.solve()
    ranks = serial.clone(tmp_path/"ranks")
    for time in ranks.times[1:]:
        shutil.rmtree(ranks.path/time)
    ranks.decompose(4, (2, 2, 1))
    ranks.solve(ranks=4)
    a, b = serial.points(), ranks.points()
    figures.atMost("place: largest difference over h",
                   np.abs(a.x - b.x).max()/0.01, 1e-9)
    figures.atMost("pressure: largest difference over rho g H",
                   np.abs(a.p - b.p).max()/(1000*G*0.12), 1e-9)


@pytest.mark.parametrize("staircase", [False, True])
def testSoilBesideThinWall(tmp_path, figures, staircase):
    """The pore pressure of soil, too, knows nothing of water behind the wall;
    also where it is a staircase"""
    n, wall = 8, 2
    if staircase:
        # Steps of 3 cells, to the left as they rise
        solid = [((n - k, 3*k), (n - k + wall, 3*k + 3)) for k in range(4)]
        corners = [(0, 0)]
        for k in range(4):
            corners += [(0.01*(n - k), 0.03*k), (0.01*(n - k), 0.03*k + 0.03)]
        shape = {"type": "polygon", "points": corners + [(0, 0.12)]}
    else:
        solid = [((n, 0), (n + wall, 12))]
        shape = box((0, 0), (0.08, 0.1))
    found = {}
    for right in [False, True]:
        regions = {"left": {**shape, "pressure": "hydrostatic", "level": 0.1}}
        if right:
            regions["right"] = hydrostatic((0.105, 0), (0.18, 0.05))
        case = Setup(
            cells=(2*n + wall, 12), h=0.01, points=2, energy=False,
            solid=solid, regions=regions,
            soilRegions={"left": {**shape, "stress": "geostatic",
                                  "level": 0.12}},
            placement={"placement": "jittered"}, fluid={"soundSpeed": 12},
            mpm={"maxSoilSoundSpeed": 10}, soilWall="slip",
            control=FIXED).steps(60).write(tmp_path/str(right)).prepare()
        case.solve()
        last = case.times[-1]
        points = case.points()
        left = points.x[:, 0] < 0.0999
        ids = case.case.cloudField(last, "soil", "id")
        found[right] = (points.x[left], points.p[left], case.case.cloudField(
            last, "soil", "x")[np.argsort(ids)])
    for name, a, b, scale in zip(
            ["place of water", "pressure", "place of soil"],
            found[True], found[False], [0.01, 1000*G*0.12, 0.01]):
        figures.atMost(f"{name}: largest difference",
                       np.abs(a - b).max()/scale, 1e-11)
