"""Hard cases with soil beside those of hardCases (spec 11)."""

import re

import numpy as np
import pytest

import hardCases
from caseBuilder import G, box, hydrostatic
from hardCases import energyOf, hard, sand, scene
from test_wallJet import CloudPoints, clouds


def says(figures, text, pattern):
    found = re.search(pattern, text)
    figures.contains("message", found and found[0][-200:], pattern)


def testSoilFarFromWater(tmp_path, figures):
    """A wall between them: neither knows of the other"""
    case = scene(
        cells=(60, 12), solid=[((22, 0), (25, 12))],
        regions={"pool": hydrostatic((0, 0), (0.22, 0.06))},
        soilRegions={"heap": box((0.45, 0), (0.55, 0.03),
                                 stress="geostatic", saturated=False)},
    ).until(0.2, 0.2).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    water = clouds(case, "0.2")["water"]
    figures.atMost("water: rms speed, m/s", float(np.sqrt(
        (water.U**2).sum(axis=1).mean())), 5e-3)


@pytest.mark.parametrize("angle", [25, 35])
def testDenseSlopeStands(tmp_path, figures, angle):
    """Loose sand fails at 35 degrees"""
    case = hardCases.slope(angle, soil=hardCases.SAND_B).write(
        tmp_path/"case").prepare()
    case.solve()
    hardCases.slopeStands(figures, case)


@pytest.mark.parametrize("speed", [5, 10, 20, 50])
@pytest.mark.parametrize("points", [2, 3, 4])
def testSandEntersWaterFast(tmp_path, figures, speed, points):
    """The speed of sound that is auto knows of the sand"""
    case = hardCases.sandEntersFast(speed, points, end=0.25/speed).write(
        tmp_path/"case").prepare()
    case.solve()
    hardCases.sandEntered(figures, case)


GRAINS = {"rhoS": 2650, "d": 0.85e-3, "e0": 0.695, "nu": 0.2}
CAP = {"mpm": {"maxSoilSoundSpeed": 20}}
CUT = {"water": {"tensionCutOff": True}}
KINDS = {
    "DruckerPrager": {"soil": {"constitutiveModel": "DruckerPrager"}},
    "linearElastic": {"soil": {
        "constitutiveModel": "linearElastic",
        "linearElasticCoeffs": {**GRAINS, "E": 1e6}}},
    "muI": {"soil": {"constitutiveModel": "muI", "muICoeffs": {
        **GRAINS, "E0": 216, "n": 0.5, "muS": 0.7, "muD": 0.77, "I0": 0.28}}},
    "capped": CAP, "tensionCutOff": CUT, "cappedAndCut": {**CAP, **CUT}}


@pytest.mark.parametrize("kind", KINDS)
def testFastSandOfAllKinds(tmp_path, figures, kind):
    case = hardCases.sandEntersFast(10, end=0.025, **KINDS[kind]).write(
        tmp_path/"case").prepare()
    case.solve()
    hardCases.sandEntered(figures, case)


@pytest.mark.parametrize("points, kind", [
    (2, None), (3, None), (4, None), *((3, kind) for kind in KINDS)])
def testFastSandAndSlowSound(tmp_path, figures, points, kind):
    """Sand at 10 m/s, sound at 7: the water is compressed by tenths, and the
    log says so. The nodes above its surface must not have the pressure that
    Tait's law finds far beyond the points"""
    setup = hardCases.sandEntersFast(
        10, points, end=0.05, fluid={"soundSpeed": 7}, **KINDS.get(kind, {}))
    case = setup.write(tmp_path/"case").prepare()
    result = case.solve()
    # So compressed, water is a spring
    hard(figures, case, 0.02, stored=kind == "linearElastic")
    fastest = max(np.linalg.norm(CloudPoints(
        case, cloud, time)["U"], axis=1).max()
        for cloud in ["water", "soil"] for time in case.times)
    figures.atMost("largest speed over the first", float(fastest/10), 1.5)
    says(figures, result.text, r"-->.*raise soundSpeed above 7\b")


def testSoundSpeedKnowsOfFallingSoil(tmp_path, figures):
    """Of its fall to the lowest water, of its speed, and of an inlet of it
    with a table in time; not of soil that lies"""
    fall = hardCases.sandIntoWater().write(tmp_path/"fall").prepare()
    figures.atMost("falls 0.1 m, but a cell: c over 10 sqrt(2 g drop), "
                   "distance to 1", abs(fall.state("0")["soundSpeed"]/(
                       10*np.sqrt(2*G*(0.2 + 0.0025 - 0.1 - 0.01))) - 1), 1e-6)
    feed = hardCases.sandIntoWater()
    feed.soilRegions["block"] = box((0.1, 0), (0.2, 0.05))
    feed.sides["ymax"] = ("patch", {"type": "fixedValue",
                                    "value": "uniform (0 0 0)"})
    feed.soil["inflowOutflow"] = {"inlets": {"hopper": {
        "patch": "ymax", "pointsPerDirection": 2,
        "velocity": "table ((0 (0 0 0)) (5 (0 -4 0)))"}}}
    fed = feed.write(tmp_path/"fed").prepare()
    figures.atMost("enters at up to 4 m/s: c over 40 m/s, distance to 1",
                   abs(fed.state("0")["soundSpeed"]/40 - 1), 1e-6)
    still = hardCases.stillBed().write(tmp_path/"still").prepare()
    figures.atMost("lies: c over 10 sqrt(g H), distance to 1", abs(
        still.state("0")["soundSpeed"]/(10*np.sqrt(G*0.2)) - 1), 1e-6)


@pytest.mark.parametrize("n", [0, 1e-5])
def testConstantModulusWithCap(tmp_path, figures, n):
    """The cap holds where stiffness does not depend on pressure, and limits
    the time step: h/(2 c)"""
    case = scene(
        cells=(12, 8), regions={}, functions=energyOf("soil"),
        soil=sand(n=n), mpm={"maxSoilSoundSpeed": 30},
        soilRegions={"column": box((0, 0), (0.05, 0.06), stress="geostatic")},
    ).until(0.05, 0.025).write(tmp_path/"case").prepare()
    case.solve()
    hard(figures, case)
    figures.atMost("time step over h/(2 c)",
                   case.log.deltaTMax/(0.5*0.01/30), 1)
    figures.equal("limiter", case.log.dtLimiter, "soil stiffness")


@pytest.mark.parametrize("speed, cap", [(50, 20), (2, 20), (50, None)])
def testSoilFasterThanCap(tmp_path, figures, speed, cap):
    """Softened soil bounces where it meets faster than its sound: the log
    names the cap and the speed, and is silent otherwise"""
    setup = scene(
        cells=(20, 20), points=2, regions={}, functions={},
        mpm={"maxSoilSoundSpeed": cap, "logInterval": 1},
        soilRegions={"block": box((0.05, 0.02), (0.15, 0.1),
                                  velocity=(0, -speed, 0))}).steps(20)
    text = setup.write(tmp_path/"case").prepare().solve().text
    if speed == 50 and cap:
        says(figures, text, r"-->.* a third of maxSoilSoundSpeed 20 m/s \(the "
             r"fastest: 50.*Raise maxSoilSoundSpeed above 15\d")
    else:
        figures.equal("warnings", text.count("third of maxSoilSoundSpeed"), 0)


SOFT = {"cap": ({"maxSoilSoundSpeed": 0.1}, {}, "fvSolution",
                "maxSoilSoundSpeed", "0.1"),
        "modulus": ({}, {"constitutiveModel": "DruckerPrager",
                         "DruckerPragerCoeffs": {
                             **GRAINS, "E": 10, "phi": 35}},
                    "DruckerPragerCoeffs", "E", "10"),
        "dense": ({}, {"constitutiveModel": "DruckerPrager",
                       "DruckerPragerCoeffs": {
                           **GRAINS, "E": 1e6, "phi": 35, "e0": 1e-5}},
                  "DruckerPragerCoeffs", "e0", "1e-05"),
        "denseRegion": ({}, {}, "bed", "voidRatio", "1e-05")}


@pytest.mark.parametrize("what", SOFT)
def testSoftSoilIsNamed(tmp_path, figures, what):
    """Soil that its own weight would compress beyond its voids, or whose
    pores hold no water"""
    mpm, soil, dictionary, keyword, value = SOFT[what]
    setup = hardCases.stillBed()
    setup.mpm = mpm
    setup.soil = soil or setup.soil
    if what == "denseRegion":
        setup.soilRegions["bed"]["voidRatio"] = 1e-5
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    result = case.run("setMaterialPoints", check=False)
    figures.equal("exit status", result.status, 1)
    says(figures, result.text, rf"FATAL IO ERROR[\s\S]*keyword {keyword} has "
         rf"the value {value}\b[\s\S]*Allowed: [\s\S]*{dictionary}")


def testSoftSoilHolds(tmp_path, figures):
    """The softest bed that is admitted runs; it is stiff enough where the
    message says so"""
    setup = hardCases.stillBed(end=0.2)
    setup.mpm["maxSoilSoundSpeed"] = 0.1
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    text = case.run("setMaterialPoints", check=False).text
    least = float(re.search(r"Allowed: maxSoilSoundSpeed > (\S+)", text)[1])
    case.change(mpm={"maxSoilSoundSpeed": 1.01*least})
    case.run("setMaterialPoints")
    case.solve()
    figures.equal("values that are not finite", sum(
        int(np.sum(~np.isfinite(CloudPoints(case, cloud, case.times[-1])["U"])))
        for cloud in ["water", "soil"]), 0)


def testImpactOnTwoRanks(tmp_path, figures):
    """A column that hits a floor, one half denser and on another rank: both
    ranks take one and the same step, that of a serial run. (It starts on the
    floor: in free fall rounding errors decide which grains touch.)"""
    setup = scene(
        cells=(16, 30), regions={}, functions={},
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
