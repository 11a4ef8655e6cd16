"""Shear stress on a bed from known profiles of velocity, against the criteria
for erosion, and beside soil that moves."""

import re

import numpy as np
import pytest

from mpmfoam.postProcessing import readDat

from caseBuilder import RHO, Setup, box, damBreak
from test_badInput import CONTROL, refused, words

LIBS = '("libmpmFunctionObjects.so")'
H = 0.01
BED = 0.04
LEVEL = 0.16
D = 0.85e-3
Z0 = 2.5*D/30

# Critical shear stress [Pa], in the order of the columns
CRITICAL = {"Shields": 0.63*0.85,
            "vanRijn": RHO*0.0208673**2,
            "Annandale": 2/3*9810*1.65*D*np.tan(np.radians(35))}

RIGID = {"constitutiveModel": "rigidSkeleton",
         "rigidSkeletonCoeffs": {"rhoS": 2650, "d": D, "e0": 0.695}}


def criteria(**entries):
    return {"type": "erosionCriteria", "libs": LIBS, "cloud": "soil",
            "frictionAngle": 35, "writeControl": "timeStep",
            "writeInterval": 1, **entries}


def logProfile(z, shearVelocity):
    return shearVelocity/0.41*np.log(z/Z0)


def flow(velocity, zones, across=None, **entries):
    """Water over a bed, with velocity(z, zone) at the height z over it; a
    zone of 10 cells along x for each value. Straight lines in each row of
    cells. Three dimensions if there are zones across, too"""
    dim = 3 if across else 2
    up = dim - 1
    width = 10*H*len(zones)
    rows = round((LEVEL - BED)/H)

    def place(x, y, z):
        """Corners of a box in the zones"""
        return tuple((a[0], a[1]) if dim == 2 else (a[0], a[2], a[1])
                     for a in zip(x, z, y))

    regions = {}
    for i, zone in enumerate(zones):
        for j in range(len(across or [0])):
            value = zone*(across[j] if across else 1)
            x, y = (10*H*i, 10*H*(i + 1)), (4*H*j, 4*H*(j + 1))
            lower, upper = place(x, y, (0, BED))
            regions[f"pores{i}_{j}"] = box(lower, upper)
            for k in range(rows):
                z = (k + 0.5)*H
                slope = (velocity(z + 1e-6, value)
                         - velocity(z - 1e-6, value))/2e-6
                gradient = np.zeros((3, 3))
                gradient[0, up] = slope
                centre = np.zeros(3)
                centre[up] = BED + z
                lower, upper = place(x, y, (BED + k*H, BED + (k + 1)*H))
                regions[f"row{i}_{j}_{k}"] = box(
                    lower, upper, velocity=(velocity(z, value), 0, 0),
                    velocityGradient=gradient.ravel(), centre=centre)

    cells = (10*len(zones), 20) if dim == 2 else (
        10*len(zones), 4*len(across), 20)
    end = (width, BED) if dim == 2 else (width, 4*H*len(across), BED)
    return Setup(
        cells=cells, h=H, energy=False, regions=regions,
        points=3 if dim == 2 else 2,
        soilRegions={"bed": box((0,)*dim, end)}, soil=RIGID,
        functions={"erosion": criteria(**entries)})


def rows(case):
    """By column of the file"""
    path = next((case.path/"postProcessing"/"erosion").rglob(
        "erosionCriteria.dat"))
    names = [line for line in path.read_text().splitlines()
             if line.startswith("#")][-1].strip("# ").split()
    return dict(zip(names, readDat(
        case.path, "erosion", "erosionCriteria.dat").T))


SPEEDS = [0.01, 0.022, -0.05, 0.1]


@pytest.fixture(scope="module")
def turbulent(tmp_path_factory):
    setup = flow(logProfile, SPEEDS, profiles="(0.055 0.256)").steps(3)
    case = setup.write(tmp_path_factory.mktemp("log")/"case").prepare()
    case.solve()
    return case


def atStart(case):
    found = rows(case)
    start = found["Time"] == 0
    return {name: values[start] for name, values in found.items()}


def testLogLaw(turbulent, figures):
    found = atStart(turbulent)
    figures.equal("lines per time", len(found["x"]), 40)
    figures.equal("times", len(np.unique(rows(turbulent)["Time"])), 4)
    figures.atMost("x: error", np.abs(
        found["x"] - H*(np.arange(40) + 0.5)).max(), 1e-12)
    figures.atMost("bed: error over h",
                   np.abs(found["bed"] - BED).max()/H, 1e-2)
    figures.atMost("depth: error over h", np.abs(
        found["depth"] - (LEVEL - BED)).max()/H, 1e-1)

    exceeded = {name: [] for name in CRITICAL}
    for zone, speed in enumerate(SPEEDS):
        middle = slice(10*zone + 4, 10*zone + 6)
        u, tau, mean = (found[name][middle] for name in [
            "shearVelocity", "shearStress", "meanVelocity"])
        figures.atMost(f"u* = {speed} m/s: error of it, relative",
                       np.abs(u/speed - 1).max(), 0.02)
        figures.atMost(f"u* = {speed} m/s: shear stress, relative to it",
                       np.abs(tau/(RHO*u*np.abs(u)) - 1).max(), 1e-10)
        figures.atMost(f"u* = {speed} m/s: stream power, relative to it",
                       np.abs(found["streamPower"][middle]
                              / (tau*mean) - 1).max(), 1e-10)
        z = (np.arange(12) + 0.5)*H
        figures.atMost(f"u* = {speed} m/s: error of the mean velocity",
                       np.abs(mean/logProfile(z, speed).mean() - 1).max(),
                       0.02)
        for name, critical in CRITICAL.items():
            values = found[f"{name}Exceeded"][middle]
            exceeded[name].append(values.tolist())
            figures.atMost(f"{name}: relative error of the critical stress",
                           np.abs(found[f"{name}Stress"][middle]/critical
                                  - 1).max(), 1e-5)
    for name, critical in CRITICAL.items():
        figures.equal(f"{name}: exceeded", exceeded[name], [
            [float(RHO*u*u > critical)]*2 for u in SPEEDS])
    figures.equal("numbers exceeded", [
        sum(exceeded[name][zone][0] for name in CRITICAL)
        for zone in range(4)], [0, 1, 2, 3])
    figures.equal("speed of a bed that is held", found["soilSpeed"].max(), 0)
    figures.equal("moving layer", found["movingLayer"].max(), 0)


def testVelocityProfiles(turbulent, figures):
    for time in ["0", turbulent.times[-1]]:
        path = (turbulent.path/"postProcessing"/"erosion"/time
                / "velocityProfiles.csv")
        table = np.genfromtxt(path, delimiter=",", names=True)
        figures.equal(f"{time} s: coordinates", sorted(set(
            np.round(table["x"], 6))), [0.055, 0.255])
    table = np.genfromtxt(turbulent.path/"postProcessing"/"erosion"/"0"
                          / "velocityProfiles.csv", delimiter=",", names=True)
    for x, speed in [(0.055, SPEEDS[0]), (0.255, SPEEDS[2])]:
        part = table[np.abs(table["x"] - x) < 1e-6]
        figures.atMost("height: error over h", np.abs(
            part["height"] - (part["z"] - BED)).max()/H, 1e-2)
        over = (part["height"] > 2*H) & (part["height"] < 10*H)
        figures.atMost(
            f"u* = {speed} m/s: water's velocity, largest relative error",
            np.abs(part["water"][over]/logProfile(
                part["height"][over], speed) - 1).max(), 0.02)
        # The grid reaches three cells
        below = part["height"] < -3*H
        figures.atMost("in the bed: speed of water and soil, m/s", max(
            np.abs(part[c][below]).max() for c in ["water", "soil"]), 1e-12)
        figures.atMost("in the bed: error of the solid fraction", np.abs(
            part["alphaSoil"][below] - 1/1.695).max(), 1e-2)


def testViscous(tmp_path, figures):
    """A linear profile: tau = mu du/dz"""
    setup = flow(lambda z, slope: slope*z, [5, -20], shearStress="viscous",
                 heights="(0.03 0.08)", criteria="(Shields)")
    setup.fluid["mu"] = 0.1
    case = setup.steps(1).write(tmp_path/"case").prepare()
    case.solve()
    found = atStart(case)
    for zone, slope in enumerate([5, -20]):
        tau = found["shearStress"][10*zone + 4:10*zone + 6]
        figures.atMost(f"du/dz = {slope} 1/s: relative error of the stress",
                       np.abs(tau/(0.1*slope) - 1).max(), 1e-8)
    figures.equal("exceeded", [found["ShieldsExceeded"][k] for k in (4, 15)],
                  [0, 1])


@pytest.mark.parametrize("law, needed", [("logLaw", 1), ("viscous", 2)])
def testThinWater(tmp_path, figures, law, needed):
    """Thinner than the heights: from the highest cells that there are"""
    if law == "logLaw":
        setup = flow(logProfile, [0.05], heights="(0.2 0.4)")
        exact = RHO*0.05**2
    else:
        setup = flow(lambda z, slope: slope*z, [5], shearStress="viscous",
                     criteria="(Shields)", heights="(0.2 0.4)")
        setup.fluid["mu"] = 0.1
        exact = 0.5
    case = setup.steps(1).write(tmp_path/"case").prepare()
    case.solve()
    found = atStart(case)
    middle = slice(4, 6)
    figures.atMost("shear stress: relative error", np.abs(
        found["shearStress"][middle]/exact - 1).max(), 0.03)
    # Cells above 1.5 cells, up to the surface
    z = (np.arange(1, 12) + 0.5)*H
    figures.atMost("height of the velocities, error over h", np.abs(
        found["velocityHeight"][middle] - z.mean()).max()/H, 0.6)
    head = next((case.path/"postProcessing"/"erosion").rglob(
        "erosionCriteria.dat")).read_text()
    figures.holds("the header says what is done",
                  "from the highest cells that are full" in head)
    figures.holds("the header says when none is left", re.search(
        rf"none left: fewer than {['', 'one', 'two'][needed]} full cell",
        head))


def testWaterThinnerThanCells(tmp_path, figures):
    """Half a cell of water over the bed: no number"""
    setup = flow(logProfile, [0.05], heights="(0.2 0.4)")
    setup.regions = {"pores": box((0, 0), (0.1, BED)),
                     "film": box((0, BED), (0.1, BED + 0.34*H))}
    case = setup.steps(1).write(tmp_path/"case").prepare()
    case.solve()
    found = atStart(case)
    figures.holds("no stress", np.isnan(found["shearStress"]).all())
    figures.holds("no height", np.isnan(found["velocityHeight"]).all())


def testTwoRanks(tmp_path, figures, turbulent):
    case = flow(logProfile, SPEEDS, profiles="(0.055 0.256)").steps(3).write(
        tmp_path/"case").prepare().decompose(2)
    case.solve(ranks=2)
    a, b = rows(case), rows(turbulent)
    figures.equal("columns", list(a), list(b))
    for name in a:
        # Rounding must not decide what is a number
        assert np.array_equal(np.isnan(a[name]), np.isnan(b[name]))
        scale = np.nanmax(np.abs(b[name])) or 1
        figures.atMost(f"{name}: largest relative difference",
                       np.nanmax(np.abs(a[name] - b[name]))/scale, 1e-10)
    tables = [np.genfromtxt(c.path/"postProcessing"/"erosion"/"0"
                            / "velocityProfiles.csv", delimiter=",",
                            skip_header=1) for c in (case, turbulent)]
    figures.atMost("velocity profiles: largest difference", np.nanmax(
        np.abs(tables[0] - tables[1])), 1e-10)


def testThreeDimensions(tmp_path, figures):
    """Fast over one half of the width, slow over the other"""
    case = flow(logProfile, [0.12], across=[1, 0.05]).steps(1).write(
        tmp_path/"case").prepare()
    case.solve()
    found = atStart(case)
    figures.equal("lines per time", len(found["x"]), 10)
    figures.equal("Annandale: part of the width", [
        found["AnnandaleExceeded"][k] for k in (4, 5)], [0.5, 0.5])
    figures.atMost("mean u*: relative error", np.abs(
        found["shearVelocity"][4:6]/(0.12*0.525) - 1).max(), 0.03)


def testMotion(tmp_path, figures):
    """The upper two cells of a bed slide over one half of the length"""
    setup = flow(logProfile, [0.01, 0.01])
    setup.soil = {"constitutiveModel": "linearElastic",
                  "linearElasticCoeffs": {"rhoS": 2650, "d": D, "e0": 0.695,
                                          "E": 1e5, "nu": 0.2}}
    setup.soilRegions = {
        "below": box((0, 0), (0.2, BED - 2*H)),
        "rest": box((0, BED - 2*H), (0.1, BED)),
        "moves": box((0.1, BED - 2*H), (0.2, BED), velocity=(0.05, 0, 0))}
    case = setup.steps(1).write(tmp_path/"case").prepare()
    case.solve()
    found = atStart(case)
    left, right = slice(0, 10), slice(10, 20)
    figures.equal("at rest: layer that moves", found["movingLayer"][left].max(),
                  0)
    figures.atMost("sliding: layer that moves, error over h", np.abs(
        found["movingLayer"][right] - 2*H).max()/H, 1e-10)
    figures.equal("at rest: speed", found["soilSpeed"][left].max(), 0)
    figures.atMost("sliding: speed, error in m/s", np.abs(
        found["soilSpeed"][right] - 0.05).max(), 1e-12)


@pytest.mark.parametrize("entries, expect", [
    ({"criteria": "(Shields Hjulstrom)"},
     {"keyword": "criteria", "value": "Hjulstrom",
      "allowed": words("Annandale", "Shields", "vanRijn")}),
    ({"frictionAngle": None}, {"keyword": "frictionAngle",
                               "value": "Annandale", "allowed": "0 to 90"}),
    ({"frictionAngle": 90}, {"keyword": "frictionAngle", "value": "90"}),
    ({"shearStress": "linear"},
     {"keyword": "shearStress", "value": "linear",
      "allowed": words("logLaw", "viscous")}),
    ({"shearStress": "wallLaw"},
     {"keyword": "shearStress", "value": "wallLaw.*needs turbulence kEpsilon",
      "allowed": words("logLaw", "viscous")}),
    ({"heights": "(0.03 0.031)"}, {"keyword": "heights", "value": "0.031",
                                   "allowed": "at least 0.01 higher"}),
    ({"roughness": -1}, {"keyword": "roughness", "value": "-1"}),
    ({"profiles": "(0.05 3)"}, {"keyword": "profiles", "value": r"\b3\b",
                                "allowed": "between 0 and 0.1"}),
    ({"movingSpeed": -1}, {"keyword": "movingSpeed", "value": "-1"}),
    ({"water": "soil"}, {"keyword": "water", "value": "soil",
                         "allowed": "a liquid.*water"}),
    ({"criterion": "(Shields)"}, {"keyword": "criterion",
                                  "allowed": "criteria"}),
], ids=lambda e: "_".join(map(str, e))[:20])
def testBadEntries(tmp_path, figures, entries, expect):
    setup = flow(logProfile, [0.01])
    function = setup.functions["erosion"]
    function.update(entries)
    setup.functions["erosion"] = {
        k: v for k, v in function.items() if v is not None}
    case = setup.steps(1).write(tmp_path/"case").prepare()
    refused(figures, case.run("mpmFoam", check=False),
            {"file": CONTROL, "function object": "erosion", **expect})


def testCloudOfWater(tmp_path, figures):
    setup = damBreak(functions={"erosion": criteria(cloud="water")})
    case = setup.steps(1).write(tmp_path/"case").prepare()
    refused(figures, case.run("mpmFoam", check=False),
            {"file": CONTROL, "keyword": "cloud", "value": "water",
             "allowed": "a solid"})
