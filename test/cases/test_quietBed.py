"""Beds of sand at rest whose points are not quite regular: nothing in the bed
may push points about where no grain would move, dry or under a current that is
too weak."""

import numpy as np
import pytest

from caseBuilder import G, RHO, RHO_S, Setup, box, hydrostatic
from test_wallJet import CloudPoints

H, N, BED, DEPTH = 0.005, 12, 0.025, 0.03
D = 0.85e-3
SCALE = np.sqrt((RHO_S/RHO - 1)*G*D**3)
SAND = {  # soil A of the paper's Table 2
    "rhoS": 2650, "d": D, "e0": 0.695, "E0": 216, "nu": 0.2, "n": 0.5,
    "phiC": 35, "eRef": 0.807, "lambda": 0.0596, "xi": 0.365, "Ad": 0.7,
    "kp": 0.0044, "np": 2.4, "nd": 2.9, "I0": 0.28, "muS": 0.7,
    "muD": 0.77, "PhiC": 0.70, "dPhi": 0.29}


def bed(stress=None, rhoS=SAND["rhoS"]):
    """An endless bed, dry or under a current that brings a stress to it"""
    end, level = N*H, BED + DEPTH
    regions, g = {}, (0, -G, 0)
    if stress is not None:
        g = (stress/(RHO*DEPTH), -G, 0)
        regions = {
            "current": hydrostatic(
                (0, BED), (end, level), velocity=(0, 0, 0),
                velocityGradient=[0, stress/RHO/1.3e-4, 0, 0, 0, 0, 0, 0, 0],
                centre=(0, BED, 0)),
            "pores": box((0, 0), (end, BED), pressure="hydrostatic",
                         level=level)}
    saturated = {"saturated": True} if regions else {}
    return Setup(
        cells=(N, round(level/H) + 2), h=H, g=g, points=2, energy=False,
        regions=regions,
        soilRegions={"bed": box((0, 0), (end, BED), stress="geostatic",
                                **saturated)},
        soil={"constitutiveModel": "elastoplasticMuI",
              "elastoplasticMuICoeffs": {**SAND, "rhoS": rhoS}},
        fluid={"soundSpeed": 20}, mpm={"maxSoilSoundSpeed": 20},
        placement={"placement": "jittered"}).cyclic("x")


def history(setup, path, end, write):
    """Times, and the points of the soil at each"""
    case = setup.until(end, write).write(path).prepare()
    case.solve()
    return (np.array([float(t) for t in case.times]),
            [CloudPoints(case, "soil", t) for t in case.times])


def way(first, last):
    """Of all points along x"""
    step = last.x[:, 0] - first.x[:, 0]
    return (step + 0.5*N*H) % (N*H) - 0.5*N*H


def testDryBedKeepsItsStress(tmp_path, figures):
    """The ratio of horizontal to vertical stress is that of a bed at rest,
    about 1 - sin(phi) = 0.43. A bed that is pushed from inside goes to its
    passive limit, 3.7"""
    _, points = history(bed(), tmp_path/"case", 0.2, 0.2)
    first, last = points[0], points[-1]
    depth = BED - last.x[:, 1]
    deep = (depth > 0.5*H) & (depth < BED - H)
    sigma = last["sigma"][deep]
    figures.atMost("horizontal over vertical stress",
                   sigma[:, 0].sum()/sigma[:, 3].sum(), 0.8)
    figures.atMost("longest path over d",
                   np.abs(way(first, last)).max()/D, 0.02)
    figures.atMost("largest change of void ratio", np.abs(
        last["voidRatio"] - SAND["e0"]).max(), 0.005)


def testRestsUnderAWeakCurrent(tmp_path, figures):
    """Half the stress that moves such grains: none does. The swing is that of
    a point about its own mean: points at other depths have another p"""
    times, points = history(bed(0.5), tmp_path/"case", 0.6, 0.01)
    top = points[0].x[:, 1] > BED - H/2
    half = len(points)//2
    late = points[half:]
    figures.atMost(
        "swing of the top row's pressure, Pa",
        np.sqrt(np.var([p["p"][top] for p in late], axis=0).mean()), 1)
    figures.equal("grains of it without contact", int(sum(
        (p["regime"][top] == 3).sum() for p in late)), 0)
    volume = (points[0].mass/RHO_S*way(late[0], late[-1])).sum()
    figures.atMost("transport", abs(volume)/(N*H*H)/(
        times[-1] - times[half])/SCALE, 1e-5)
    figures.atMost("longest path over d",
                   np.abs(way(points[0], points[-1])).max()/D, 0.02)


@pytest.mark.parametrize("stress", [0, 0.5])
def testWaterBearsNoMoreThanBuoyancy(tmp_path, figures, stress):
    """Grains that are hardly heavier than water: contact bears what buoyancy
    does not, sum of V sigma_yy = sum of m (1 - rho/rhoS) g y over all points,
    also where points of both crowd at some nodes and are few at others"""
    rhoS = 1190
    _, points = history(bed(stress, rhoS), tmp_path/"case", 0.6, 0.1)
    found = [-(p.mass/rhoS*(1 + p["voidRatio"])*p["sigma"][:, 3]).sum()
             / ((1 - RHO/rhoS)*G*(p.mass*p.x[:, 1]).sum())
             for p in points[-3:]]
    # 0.92 where over-full nodes lifted their grains; times differ by 0.01
    figures.atMost("contact over weight in water, less 1",
                   abs(np.mean(found) - 1), 0.03)
