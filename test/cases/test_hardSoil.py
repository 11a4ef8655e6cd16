"""Hard cases with soil (spec 11): finite values, exact masses, no point in a
wall, energy that does not grow."""

import numpy as np
import pytest

from caseBuilder import Setup, box, hydrostatic
from mpmfoam.postProcessing import readDat
from test_wallJet import clouds, sound

SAND = {  # soil A of the paper's Table 2
    "rhoS": 2650, "d": 0.85e-3, "e0": 0.695, "E0": 216, "nu": 0.2, "n": 0.5,
    "phiC": 35, "eRef": 0.807, "lambda": 0.0596, "xi": 0.365, "Ad": 0.7,
    "kp": 0.0044, "np": 2.4, "nd": 2.9, "I0": 0.28, "muS": 0.700,
    "muD": 0.770, "PhiC": 0.70, "dPhi": 0.29}
KINETIC, POTENTIAL, ELASTIC, WORK, CORRECTION, TOTAL = range(1, 7)


def sand(**entries):
    return {"constitutiveModel": "elastoplasticMuI",
            "elastoplasticMuICoeffs": {**SAND, **entries}}


def energyOf(*names):
    return {f"energy_{cloud}": {
        "type": "materialPointEnergy", "cloud": cloud,
        "libs": '("libmpmFunctionObjects.so")',
        "writeControl": "timeStep", "writeInterval": 20} for cloud in names}


def scene(tmp_path, **entries):
    setup = {"h": 0.01, "points": 2, "energy": False, "soil": sand(),
             "functions": energyOf("water", "soil"), **entries}
    return Setup(**setup)


def course(case, cloud):
    return readDat(case.path, f"energy_{cloud}", "energy.dat")


def hard(figures, case, bound=1e-3):
    """All that any scene must hold to. Kinetic + potential energy of both
    clouds: what one loses the other may win, no more. The water's elastic
    energy and what its volume correction did come on top; soil stores almost
    none."""
    sound(figures, case)
    water, soil = (course(case, c) for c in ["water", "soil"])
    n = min(len(water), len(soil))
    total = (water[:n, KINETIC] + water[:n, POTENTIAL] + water[:n, ELASTIC]
             - water[:n, CORRECTION]
             + soil[:n, KINETIC] + soil[:n, POTENTIAL])
    initial = sum(abs(e[0, KINETIC]) + abs(e[0, POTENTIAL])
                  for e in (water, soil))
    climb = (total - np.minimum.accumulate(total)).max()
    figures.atMost("largest growth of the energy over its initial value",
                   climb/initial, bound)


def testJetOntoDrySand(tmp_path, figures):
    """Water at 2 m/s from above onto dry sand: a crater, sand in the air"""
    case = scene(
        tmp_path, cells=(30, 25),
        regions={"jet": box((0.13, 0.12), (0.17, 0.22), velocity=(0, -2, 0))},
        soilRegions={"bed": box((0, 0), (0.3, 0.1), stress="geostatic",
                                saturated=False)},
    ).until(0.4, 0.1).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    bed = clouds(case, "0.4")["soil"]
    below = bed.x[np.abs(bed.x[:, 0] - 0.15) < 0.02, 1]
    figures.atMost("bed under the jet over its depth at the start",
                   below.max()/0.1, 0.97)


def testSandFallsIntoWater(tmp_path, figures):
    """A block of sand falls 0.1 m into water that is 0.1 m deep, sinks, and
    lies on the floor"""
    case = scene(
        tmp_path, cells=(30, 30),
        regions={"pool": hydrostatic((0, 0), (0.3, 0.1))},
        soilRegions={"block": box((0.1, 0.2), (0.2, 0.25))},
    ).until(1, 0.25).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    soil = clouds(case, "1")["soil"]
    figures.atMost("mean height of the sand, m", soil.x[:, 1].mean(), 0.05)


@pytest.mark.parametrize("d", [0.05e-3, 50e-3])
def testDamOfSiltOrCobbles(tmp_path, figures, d):
    """Water breaks against a heap of grains far smaller, and larger, than a
    cell"""
    case = scene(
        tmp_path, cells=(40, 20), soil=sand(d=d),
        regions={"reservoir": hydrostatic((0, 0), (0.15, 0.15))},
        soilRegions={"heap": {
            "type": "polygon", "plane": "xy", "saturated": False,
            "points": [(0.2, 0), (0.34, 0), (0.28, 0.06), (0.26, 0.06)],
            "stress": "geostatic"}},
    ).until(0.5, 0.25).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    start, end = (clouds(case, t)["soil"].x[:, 0].mean() for t in ["0", "0.5"])
    # Silt goes with the water, cobbles let it through
    if d < 1e-3:
        figures.atLeast("shift of the heap, m", end - start, 0.02)
    else:
        water = clouds(case, "0.5")["water"].x[:, 0]
        figures.atLeast("water behind the heap, share",
                        (water > 0.34).mean(), 0.05)


def testPorosityJump(tmp_path, figures):
    """Loose over dense sand under still water: the pressure does not know of
    it, and nothing moves"""
    case = scene(
        tmp_path, cells=(20, 25), soil=sand(),
        regions={"all": hydrostatic((0, 0), (0.2, 0.2))},
        soilRegions={
            "dense": box((0, 0), (0.2, 0.05), voidRatio=0.6,
                         stress="geostatic"),
            "loose": box((0, 0.05), (0.2, 0.1), voidRatio=0.8,
                         stress="geostatic")},
    ).until(1, 0.5).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    end = clouds(case, "1")
    for cloud, bound in [("soil", 1e-3), ("water", 2e-3)]:
        figures.atMost(f"{cloud}: rms speed, m/s", float(np.sqrt(
            (end[cloud].U**2).sum(axis=1).mean())), bound)
    water = end["water"]
    exact = 1000*9.81*(0.2 - water.x[:, 1])
    figures.atMost("rms error of the pore pressure over its maximum",
                   np.sqrt(np.mean((water["p"] - exact)**2))/exact.max(),
                   0.02)


def testDroppedSand(tmp_path, figures):
    """A column of dry sand dropped from 1 m, soil alone"""
    case = scene(
        tmp_path, cells=(40, 120), regions={},
        functions=energyOf("soil"),
        soilRegions={"column": box((0.15, 1), (0.25, 1.15))},
    ).until(0.8, 0.4).write(tmp_path/"case").prepare()
    case.solve()
    energy = course(case, "soil")
    total = energy[:, TOTAL]
    figures.atMost("largest growth of the energy over its initial value",
                   (total - np.minimum.accumulate(total)).max()/total[0],
                   1e-3)
    soil = case.case.cloudField("0.8", "soil", "x")
    figures.equal("values that are not finite",
                  int((~np.isfinite(soil)).sum()), 0)
    figures.equal("points in walls", int(
        ((soil[:, :2] < 0) | (soil[:, :2] > (0.4, 1.2))).sum()), 0)
    # A heap: it came down and did not bounce
    figures.atMost("height that 99 % lie below, m",
                   np.quantile(soil[:, 1], 0.99), 0.15)


def testSoilFarFromWater(tmp_path, figures):
    """A wall between them: neither knows of the other"""
    case = scene(
        tmp_path, cells=(60, 12), solid=[((22, 0), (25, 12))],
        regions={"pool": hydrostatic((0, 0), (0.22, 0.06))},
        soilRegions={"heap": box((0.45, 0), (0.55, 0.03),
                                 stress="geostatic", saturated=False)},
    ).until(0.2, 0.2).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    water = clouds(case, "0.2")["water"]
    figures.atMost("water: rms speed, m/s", float(np.sqrt(
        (water.U**2).sum(axis=1).mean())), 5e-3)


def testImpactOnTwoRanks(tmp_path, figures):
    """A column that hits a floor, one half denser and on another rank: both
    ranks take one and the same step, that of a serial run. (It starts on the
    floor: in free fall rounding errors decide which grains touch.)"""
    setup = scene(
        tmp_path, cells=(16, 30), regions={}, functions={},
        soilRegions={
            "dense": box((0.03, 0), (0.08, 0.1), voidRatio=0.6,
                         velocity=(0, -2, 0)),
            "loose": box((0.08, 0), (0.13, 0.1), voidRatio=0.8,
                         velocity=(0, -2, 0))}).until(0.06, 0.06)
    serial = setup.write(tmp_path/"serial").prepare()
    parallel = serial.clone(tmp_path/"parallel")
    parallel.decompose(
        2, cellRank=parallel.case.cellCentres("0")[:, 0] > 0.08)
    serial.solve()
    parallel.solve(ranks=2)
    figures.atLeast("steps that the impact limits, logged",
                    serial.log.limiters["impact"], 1)
    figures.equal("steps, serial and two ranks",
                  parallel.log.stepCount, serial.log.stepCount)
    heights = [c.case.cloudField("0.06", "soil", "x")[:, 1].mean()
               for c in (serial, parallel)]
    figures.atMost("difference of the mean height over h",
                   abs(heights[1] - heights[0])/0.01, 1e-6)
