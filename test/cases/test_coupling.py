"""Water and soil exchange momentum and nothing else."""

import numpy as np
import pytest

from caseBuilder import G, RHO, Setup, box
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


def carried(tmp_path, voidRatio, coefficient, end=0.05, ranks=1):
    """Water and grains that move along an endless wall with friction, 20
    cells deep. Momenta of grains and water at the start and at the end, and
    the speed at the start"""
    speed, depth = 0.2, 0.1
    case = Setup(
        cells=(4, 24), h=depth/20, points=2, energy=False,
        regions={"all": box((0, 0), (0.02, depth), velocity=(speed, 0, 0),
                            pressure="hydrostatic", level=depth)},
        soilWall={"type": "frictional", "frictionCoefficient": coefficient},
        soil={"DruckerPragerCoeffs": {
            "rhoS": 2650, "d": 0.1e-3, "e0": 0.7, "nu": 0.2, "phi": 35,
            "psi": 0, "E": 1e6}},
        soilRegions={"grains": box(
            (0, 0), (0.02, depth), velocity=(speed, 0, 0),
            voidRatio=voidRatio, stress="geostatic")},
        # For decomposePar, which knows no patch type frictional
        control={"libs": '("libmpmBackgroundGrid.so")'},
    ).cyclic("x").until(end, end).write(tmp_path/"case").prepare()
    if ranks > 1:
        case.decompose(ranks)
    case.solve(ranks=ranks)
    found = []
    for time in ("0", case.times[-1]):
        soil, water = (CloudPoints(case, c, time) for c in ("soil", "water"))
        found.append([(c.mass*c.U[:, 0]).sum() for c in (soil, water)])
    return case, np.array(found), speed


@pytest.mark.parametrize("ns, ranks", [(0.05, 1), (0.2, 1), (0.2, 2)])
def testSuspensionRubsNoWall(tmp_path, figures, ns, ranks):
    """What carries suspended grains is the water: a wall with friction, on
    which they do not lie, takes no momentum of them"""
    case, p, _ = carried(tmp_path, 1/ns - 1, 0.6, ranks=ranks)
    regime = CloudPoints(case, "soil", case.times[-1])["regime"]
    figures.equal("points that are not suspended", int((regime != 2).sum()), 0)
    # 0.54 h of them are at the nodes of the wall
    held = 0.6*ns*2650*G*0.54*0.005*(0.02*case.setup.spacing[2])*0.05
    figures.atMost("momentum lost over mu times the weight at the wall",
                   abs(p[1].sum() - p[0].sum())/held, 0.01)


@pytest.mark.parametrize("mu", [0.1, 0.3])
def testBedRubsTheWall(tmp_path, figures, mu):
    """Grains that lie on it press with their weight under water"""
    end, e = 0.05, 0.7
    case, p, speed = carried(tmp_path, e, mu, end)
    pressed = (2650 - RHO)/(1 + e)*G
    moving = (2650 + RHO*e)/(1 + e)
    figures.atMost(
        "momentum lost over mu times the weight under water: error",
        abs((1 - p[1].sum()/p[0].sum())*speed*moving/(mu*pressed*end) - 1),
        0.1)
