"""Hard cases with soil beside those of hardCases (spec 11)."""

import re

import numpy as np
import pytest

import hardCases
from caseBuilder import box, hydrostatic
from hardCases import hard, scene
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
