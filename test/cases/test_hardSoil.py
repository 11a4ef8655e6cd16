"""Hard cases with soil beside those of hardCases (spec 11)."""

import numpy as np
import pytest

import hardCases
from caseBuilder import box, hydrostatic
from hardCases import hard, scene
from test_wallJet import clouds


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
