"""Water and soil exchange momentum and nothing else."""

import numpy as np
import pytest

from caseBuilder import Setup, box
from test_wallJet import CloudPoints

SOIL = {"constitutiveModel": "linearElastic", "linearElasticCoeffs": {
    "rhoS": 2650, "d": 1e-3, "e0": 0.7, "E": 1e5, "nu": 0.2}}


def momentum(case, time):
    """Of all clouds, and the sum of m |U|"""
    total, size = np.zeros(3), 0.0
    for cloud in case.setup.clouds:
        points = CloudPoints(case, cloud, time)
        p = points.mass[:, None]*points.U
        total += p.sum(axis=0)
        size += np.abs(p).sum()
    return total, size


@pytest.mark.parametrize("drag", [
    "none", "DarcyForchheimer", "DarcyForchheimerPaper", "Gidaspow"])
def testMomentumOfMixture(tmp_path, figures, drag):
    """A body of soil that moves and deforms in water at rest, in a box that is
    cyclic on all sides"""
    case = Setup(
        cells=(20, 20), h=0.01, g=(0, 0, 0), energy=False,
        regions={"all": box((0, 0), (0.2, 0.2))},
        soilRegions={"body": box((0.05, 0.05), (0.12, 0.11),
                                 velocity=(0.3, -0.2, 0))},
        soil=SOIL, fluid={"soundSpeed": 5}, interaction={"drag": drag},
    ).cyclic("x", "y").steps(200).write(tmp_path/"case").prepare()
    before, _ = momentum(case, "0")
    soil = CloudPoints(case, "soil", "0")
    case.solve()
    after, size = momentum(case, case.times[-1])
    # Something was exchanged
    slowed = CloudPoints(case, "soil", case.times[-1])
    figures.atLeast("change of the soil's velocity, m/s", np.abs(
        slowed.U.mean(axis=0) - soil.U.mean(axis=0)).max(), 1e-2)
    figures.atMost("momentum: change over sum of m |U|",
                   np.abs(after - before).max()/size, 1e-12)


@pytest.mark.parametrize("d", [0.05e-3, 1e-3, 50e-3])
def testStepDoesNotDependOnDrag(tmp_path, figures, d):
    """From silt to cobbles: a saturated bed takes the same steps"""
    coeffs = {**SOIL["linearElasticCoeffs"], "d": d}
    case = Setup(
        cells=(10, 20), h=0.01, energy=False,
        regions={"all": box((0, 0), (0.1, 0.15), pressure="hydrostatic")},
        soilRegions={"bed": box((0, 0), (0.1, 0.08), stress="geostatic")},
        soil={**SOIL, "linearElasticCoeffs": coeffs},
    ).until(0.05).write(tmp_path/"case").prepare()
    case.solve()
    step = 0.05/case.log.stepCount
    # h/(2 (c + v)) of soil and pore water; viscosity and drag leave it alone
    c = np.sqrt(1e5/0.9*1.7/2650 + (10*np.sqrt(9.81*0.15))**2/(0.7/1.7))
    figures.atLeast("mean time step over h/(2 c)", step/(0.005/c), 0.9)
    for cloud in ["water", "soil"]:
        points = CloudPoints(case, cloud, case.times[-1])
        figures.atMost(f"{cloud}: largest speed, m/s",
                       np.abs(points.U).max(), 0.05)
