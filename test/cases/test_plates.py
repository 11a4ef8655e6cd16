"""Thin plates: each side stands by itself. Water on one side, sand, the edge,
ranks and restarts, bad input. Bounds are those of issue 21, acceptance 7, where
nothing else is said."""

import re

import numpy as np
import pytest

from bodies import sameAfterRestart, sameOnTwoRanks, solved
from caseBuilder import G, RHO, CaseError, Setup, box, hydrostatic
from plates import (blobs, discharge, forces, gate, height, inclined, motions,
                    moving, oneSided, oneSidedFigures, placed, plate, polygon,
                    released, sluice)


@pytest.mark.parametrize("degrees", [90, 60, 120])
@pytest.mark.parametrize("thickness", [0.1, 0.5, 1, 2, 8])
def testWaterOnOneSide(tmp_path, figures, thickness, degrees):
    """Still water to the left of a plate, nothing to the right of it"""
    setup, start, end, volume = oneSided(thickness, degrees)
    case = solved(setup, tmp_path/"case")
    points = case.points("0")
    figures.atMost(
        "error of the volume at the start, %",
        100*abs((points.mass*points.J).sum()/RHO/volume - 1), 0.2)
    nearest, speed, noise, F = oneSidedFigures(case, thickness, start, end)
    figures.atLeast("nearest point to the face over h", nearest, 0)
    figures.atMost("rms speed, most, mm/s", 1e3*speed, 10)
    figures.atMost("noise of the pressure at the plate, % of rho g H",
                   100*noise, 2.5)
    figures.atMost("error of the force across, %", 100*abs(F[0] - 1), 1)
    figures.atMost("error of the force upwards, % of that across",
                   100*abs(F[1] + 1/np.tan(np.radians(degrees))), 2)


@pytest.mark.parametrize("soil", [False, True])
@pytest.mark.parametrize("degrees", [90, 60])
@pytest.mark.parametrize("thickness", [0.1, 0.5, 1, 2])
def testNothingPassesThrough(tmp_path, figures, thickness, degrees, soil):
    """The asked share of the momentum is 0.1 %; what is on the right may not
    even know to rounding whether there is something on the left"""
    first, last = nothingPasses(tmp_path, figures, thickness, degrees, soil)
    given = (first["mass"][:, None]*first["U"]).sum(axis=0)
    passed = (last["mass"][:, None]*last["U"])[first["right"]].sum(axis=0)
    figures.atMost("momentum that passed, %", 100*np.linalg.norm(
        passed)/np.linalg.norm(given), 0.1)


@pytest.mark.parametrize("soil", [False, True])
@pytest.mark.parametrize("degrees", [90, 60])
@pytest.mark.parametrize("thickness", [0.1, 2])
@pytest.mark.parametrize("way", ["along", "across", "turning"])
def testNothingPassesThroughAPlateThatMoves(
        tmp_path, figures, way, thickness, degrees, soil):
    """The same; the plate gives momentum, too: what clouds lose is its force"""
    motion = motions(degrees)[way]
    first, last = nothingPasses(
        tmp_path, figures, thickness, degrees, soil, motion)
    lost = ((first["mass"][:, None]*(first["U"] - last["U"])).sum(axis=0))
    F = forces(last["case"], "soil" if soil else "water")
    figures.equal("steps in the log", len(F), 100)
    figures.atMost("force in time less the momentum that was lost, %",
                   100*np.linalg.norm(4e-4*F.sum(axis=0) - lost)
                   / np.linalg.norm(lost), 1e-6)


def nothingPasses(tmp_path, figures, thickness, degrees, soil, motion=None):
    """Points at the start and the end"""
    setup, start, end = blobs(
        thickness, degrees, ["left", "right"], soil, motion=motion)
    both = solved(setup, tmp_path/"both")
    alone = solved(blobs(thickness, degrees, ["right"], soil, motion=motion)[0],
                   tmp_path/"alone")
    cloud = "soil" if soil else "water"

    def read(case, time):
        data = {name: case.case.cloudField(time, cloud, name)
                for name in ["x", "U", "mass", "id"]}
        order = np.argsort(data["id"])
        return {name: values[order] for name, values in data.items()}
    first, last, only = (
        read(both, "0"), read(both, both.times[-1]),
        read(alone, alone.times[-1]))
    right = height(first["x"], start, end) < 0
    there = placed(start, end, 0.04, **(motion or {}))
    figures.holds("each point stays on its side", (
        right == (height(last["x"], *there) < 0)).all())
    given = (first["mass"][:, None]*first["U"]).sum(axis=0)
    left = (last["mass"][:, None]*last["U"])[~right].sum(axis=0)
    # One that gives way takes less (1.5 % at the least)
    figures.atLeast(
        "momentum that the plate took from the left, %", 100*np.linalg.norm(
            given - left)/np.linalg.norm(given), 1 if motion else 5)
    change = last["U"][right] - only["U"]
    figures.atMost("other positions than alone, m",
                   abs(last["x"][right] - only["x"]).max(), 1e-12)
    figures.atMost("other velocities than alone, m/s", abs(change).max(), 1e-10)
    return {**first, "right": right}, {**last, "case": both}


@pytest.mark.parametrize("thickness", [0.1, 1])
def testAPlateParts(tmp_path, figures, thickness):
    """A pool in two; it goes there and back, and turns"""
    h = 0.02
    start, end = inclined((0.5, 0), 80, 0.45)
    case = solved(Setup(
        cells=(50, 25), h=h, points=2,
        regions={"left": polygon((0, 0), (0.5, 0), (0.535, 0.2), (0, 0.2),
                                 pressure="hydrostatic", level=0.2),
                 "right": polygon((0.5, 0), (1, 0), (1, 0.2), (0.535, 0.2),
                                  pressure="hydrostatic", level=0.2)},
        bodies={"plate": {
            **moving(plate(start, end, thickness*h)), "motion": {
                "centre": (0.5, 0, 0),
                "displacement":
                    "table ((0 (0 0 0)) (0.2 (0.1 0 0)) (0.5 (-0.1 0 0)))",
                "rotation":
                    "table ((0 (0 0 0)) (0.2 (0 0 20)) (0.5 (0 0 -10)))"}}},
        energy=False).until(0.5, 0.1), tmp_path/"case")
    first, last = case.points("0"), case.points()
    there = placed(start, end, 1, (-0.1, 0), -10, (0.5, 0))
    figures.equal("points on another side than before", int((
        (height(first.x, start, end) > 0)
        != (height(last.x, *there) > 0)).sum()), 0)
    figures.atLeast("nearest point to the face over h", (
        abs(height(last.x, *there)) - 0.5*thickness*h).min()/h, -1e-9)


def testAGateThinAndThick(tmp_path, figures):
    """A thin gate that is lifted holds the water less long than a thick one,
    which it has to pass first, but longer than none"""
    found = {}
    for kind in ["box", "plate", "none"]:
        setup, face = gate(kind)
        found[kind] = released(solved(setup, tmp_path/kind), face)
    for i, name in enumerate(["way of the front", "volume"]):
        box, thin, none = (found[k][i] for k in ["box", "plate", "none"])
        figures.atLeast(f"{name} over that of the thick gate", thin/box, 1.05)
        figures.atMost(f"{name} over that without a gate", thin/none, 0.95)


@pytest.mark.parametrize("thickness", [0.1, 1, 2])
def testFlowUnderAnEdge(tmp_path, figures, thickness):
    """The discharge of a sluice gate by Torricelli's law, with a contraction
    of 0.61"""
    setup, level, opening = sluice(thickness, 0.5)
    case = solved(setup, tmp_path/"case")
    figures.atMost("error of the discharge, %", 100*abs(
        discharge(case, level, opening) - 1), 10)


@pytest.mark.parametrize("thickness, degrees", [(0.1, 90), (1, 60)])
def testADamBreaksOnAPlate(tmp_path, figures, thickness, degrees):
    """Water hits a plate, and goes over its edge"""
    h = 0.02
    start, end = inclined((0.6, 0), degrees, 0.2)
    case = solved(Setup(
        cells=(50, 35), h=h, points=2,
        regions={"pool": hydrostatic((0, 0), (0.3, 0.5))},
        bodies={"plate": plate(start, end, thickness*h)},
        energy=False).until(0.5, 0.02), tmp_path/"case")
    along = (end - start)/0.2
    crossed, over, before = 0, 0, None
    for time in case.times:
        x = case.points(time).x
        eta = height(x, start, end)
        beside = (x[:, :2] - start) @ along < 0.2 - 1.5*h
        if before is not None:
            crossed += ((eta > 0) != (before[0] > 0))[beside & before[1]].sum()
        before = eta, beside
        over = max(over, (eta < 0).sum())
    figures.equal("points that went through it", crossed, 0)
    figures.atLeast("points that went over it", over, 10)


def mixed(end=0.04):
    """Water and sand, also below the edge of an inclined plate"""
    return Setup(
        cells=(50, 25), h=0.02, points=2,
        regions={"pool": hydrostatic((0, 0), (0.5, 0.36)),
                 "tail": hydrostatic((0.5, 0), (1, 0.2))},
        soilRegions={"bed": box((0, 0), (1, 0.14), stress="geostatic",
                                saturated=True)},
        mpm={"maxSoilSoundSpeed": 10},
        bodies={"plate": plate((0.46, 0.06), (0.55, 0.6), 0.01,
                               soil={"frictionCoefficient": 0.4})},
        energy=False).until(end, 0.02)


def solid3D(end=0.04):
    """A plate across a corner, its lower and one side edge free"""
    h = 0.05
    return Setup(
        cells=(16, 12, 12), h=h, points=2,
        regions={"pool": hydrostatic((0, 0, 0), (0.4, 0.6, 0.4))},
        bodies={"plate": plate((0.41, 0.17, 0.12), (0.41, 0.17, 0.8), 0.01,
                               across=(0.1, 0.4, 0))},
        energy=False).until(end, 0.02)


def driven(end=0.04):
    """The same; the plate goes down into the bed, and turns"""
    setup = mixed(end)
    setup.bodies["plate"] = moving(
        setup.bodies["plate"], (0.5, -1), 60, (0.46, 0.06))
    return setup


def swung3D(end=0.04):
    """The plate across a corner is lifted, and turns about z"""
    setup = solid3D(end)
    setup.bodies["plate"] = moving(
        setup.bodies["plate"], (-1, 0.5, 3), 90, (0.41, 0.17, 0))
    return setup


@pytest.mark.parametrize("scene", [mixed, solid3D, driven, swung3D])
def testTwoRanks(tmp_path, figures, scene):
    sameOnTwoRanks(figures, scene, tmp_path, [(2, 1, 1), (1, 2, 1)])


@pytest.mark.parametrize("scene", [mixed, solid3D, driven, swung3D])
def testRestart(tmp_path, figures, scene):
    sameAfterRestart(figures, scene, tmp_path)


def testStillWaterIn3D(tmp_path, figures):
    """Beside a plate that is inclined about two axes, from wall to wall"""
    h, level = 0.025, 0.25
    along = np.array([0.25, 0.1, 1.0])
    across = np.cross(along, [1.0, 0.3, -0.2])
    across *= 2/np.linalg.norm(across)
    normal = np.cross(along/np.linalg.norm(along),
                      across/np.linalg.norm(across))
    through = np.array([0.2, 0.2, 0.16])
    front = "front" if normal[0] < 0 else "back"
    case = solved(Setup(
        cells=(16, 16, 13), h=h, points=2,
        regions={"pool": {
            **hydrostatic((0, 0, 0), (0.4, 0.4, level))}},
        bodies={"plate": plate(through - along, through + along, 0.3*h,
                               across=across)},
        energy=False).until(0.1, 0.05), tmp_path/"case")
    first, last = case.points("0"), case.points()
    side = (first.x - through) @ normal > 0
    figures.holds(f"no point passes ({front} is where x is small)", (
        side == ((last.x - through) @ normal > 0)).all())
    figures.atMost("rms speed, mm/s",
                   1e3*np.sqrt((last.U**2).sum(axis=1).mean()), 10)
    eta = abs((last.x - through) @ normal) - 0.15*h
    depth = level - last.x[:, 2]
    wall = (eta < 1.5*h) & (depth > 1.5*h)
    figures.atMost("noise of the pressure at the plate, % of rho g H",
                   100*np.sqrt(np.mean((last.p - RHO*G*depth)[wall]**2))
                   / (RHO*G*level), 2.5)


PLATE = plate((0.5, 0), (0.5, 0.3), 0.004)


@pytest.mark.parametrize("body, others, message", [
    (plate((0.5, 0), (0.5, 0.3), -1), {}, "value -1.*Allowed: 0 < thickness"),
    (plate((0.5, 0.1), (0.5, 0.105), 0.01), {},
     "keywords start and end.*Allowed: more than 0.02 m"),
    (plate((0.5, 0), (0.5, 0.3), 0.004, across=(0, 0, 1)), {}, "across"),
    ({**PLATE, "surface": {"type": "plate", "origin": (0, 0, 0),
                           "span": (1, 0, 1)}}, {}, "origin.*start"),
    ({**PLATE, "type": "rigid", "motion": {
        "mass": 1, "centreOfMass": (0.5, 0.15, 0),
        "momentOfInertia": (1, 1, 1)}}, {},
     "keyword type is rigid.*is a plate.*Allowed: fixed, prescribed"),
    (PLATE, {"other": {
        "type": "prescribed", "surface": {
            "type": "box", "min": (0.1, 0.1, -1), "max": (0.2, 0.2, 1)},
        "motion": {"displacement": "constant (0 0.1 0)"}}},
     "body other, which moves and is no plate.*Allowed: plates that move"),
    (plate((5, 0), (5, 0.3), 0.004), {}, "outside of the mesh"),
    (PLATE, {"other": plate((0.58, 0), (0.58, 0.3), 0.004)},
     "plate.*Allowed: 0.12 m"),
])
def testBadInput(tmp_path, figures, body, others, message):
    case = Setup(
        cells=(50, 30), h=0.02, regions={"pool": hydrostatic((0, 0), (1, 0.4))},
        bodies={"plate": body, **others}, energy=False).write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
    text = " ".join(str(error.value).split())
    figures.holds("the message says " + message, re.search(message, text),
                  text[-400:])


def testAPlateComesNearToAnother(tmp_path, figures):
    case = Setup(
        cells=(50, 30), h=0.02, regions={"pool": hydrostatic((0, 0), (1, 0.4))},
        bodies={"plate": moving(PLATE, (1, 0)),
                "other": plate((0.64, 0), (0.64, 0.3), 0.004)},
        energy=False).until(0.05).write(tmp_path/"case")
    case.prepare()
    with pytest.raises(CaseError) as error:
        case.solve()
    pattern = "plate plate and body other.*at time 0.0.*Allowed: 0.12 m"
    figures.contains("message", re.search(
        pattern, " ".join(str(error.value).split())), pattern)


def testACyclicPatchNearby(tmp_path, figures):
    case = Setup(
        cells=(50, 30), h=0.02, regions={"pool": hydrostatic((0, 0), (1, 0.4))},
        bodies={"plate": plate((0.05, 0), (0.05, 0.6), 0.004)},
        energy=False).cyclic("x").write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
    pattern = "near to a cyclic patch.*Allowed"
    figures.contains("message", re.search(
        pattern, " ".join(str(error.value).split())), pattern)
