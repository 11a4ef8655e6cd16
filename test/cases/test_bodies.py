"""Solid bodies of any shape: still water and buoyancy, motion that is told and
motion by forces, contact of soil, ranks and restarts, bad input. Bounds are
those of issue 21 where nothing else is said."""

import re

import numpy as np
import pytest

from bodies import (cylinder, prism, sameAfterRestart, sameOnTwoRanks, slope,
                    solved, surface)
from caseBuilder import G, RHO, CaseError, Setup, box, hydrostatic


def rms(U):
    return np.sqrt((U**2).sum(axis=1).mean())


def forces(case, body="pipe", cloud="water"):
    """Force on a body at the entries of the log [N]"""
    text = (case.path/"log.mpmFoam").read_text()
    found = re.findall(
        rf"body {body}:.*?force of {cloud} \(([^)]*)\)", text)
    return np.array([[float(v) for v in f.split()] for f in found])


@pytest.mark.parametrize("degrees", [26.6, 45])
def testStillWaterOverAnInclinedFloor(tmp_path, figures, degrees):
    h, level, through = 0.02, 0.4, (0.5, 0.128)
    case = solved(Setup(
        cells=(50, 30), h=h, regions={"pool": hydrostatic((0, 0), (1, level))},
        bodies={"floor": {"type": "fixed", "surface": surface("floor.obj")}},
        surfaces={"floor.obj": prism(slope(degrees, through))},
        energy=False).until(0.5), tmp_path)
    points = case.points()
    t = np.radians(degrees)
    phi = (points.x[:, :2] - through) @ [-np.sin(t), np.cos(t)]
    depth = level - points.x[:, 1]
    wall = (phi < 1.5*h) & (depth > 1.5*h)
    noise = np.sqrt(np.mean((points.p - RHO*G*depth)[wall]**2))
    figures.atMost("rms of the pressure at the wall over rho g H, %",
                   100*noise/(RHO*G*level), 2.5)
    figures.atMost("rms speed, mm/s", 1e3*rms(points.U), 10)
    figures.atLeast("deepest point over h", phi.min()/h, 0)


def testVolumeBesideABody(tmp_path, figures):
    """Points that the surface cuts carry the part of them that is outside"""
    h, radius = 0.02, 0.1
    case = Setup(
        cells=(50, 30), h=h, regions={"pool": hydrostatic((0, 0), (1, 0.5))},
        bodies={"pipe": {"type": "fixed",
                         "surface": cylinder((0.503, 0.257), radius)}},
        energy=False).write(tmp_path/"case")
    case.prepare()
    points = case.points("0")
    volume = (points.mass*points.J).sum()/RHO
    exact = (0.5 - np.pi*radius**2)*h
    figures.atMost("error of the volume, %", 100*abs(volume/exact - 1), 0.02)


def testBuoyancyOfACylinder(tmp_path, figures):
    h, radius = 0.02, 0.1
    case = solved(Setup(
        cells=(50, 35), h=h, regions={"pool": hydrostatic((0, 0), (1, 0.6))},
        bodies={"pipe": {"type": "fixed",
                         "surface": cylinder((0.507, 0.302), radius)}},
        energy=False).until(0.5), tmp_path)
    F = forces(case)
    exact = RHO*G*np.pi*radius**2*h
    F = F[len(F)//2:].mean(axis=0)
    figures.atMost("error of the buoyancy, %", 100*abs(F[1]/exact - 1), 1)
    figures.atMost("force across, %", 100*abs(F[0]/exact), 1)


def testABodyOnTheFloorIsNotLifted(tmp_path, figures):
    """What lies below its foot belongs to the floor"""
    h, level = 0.02, 0.2
    case = solved(Setup(
        cells=(40, 15), h=h,
        regions={"pool": hydrostatic((0, 0), (0.4, level))},
        bodies={"pipe": {"type": "fixed",
                         "surface": box((0.4, -1), (0.5, 1))}},
        energy=False).until(0.2), tmp_path)
    F = forces(case)
    F = F[len(F)//2:].mean(axis=0)/(0.5*RHO*G*level**2*h)
    figures.atMost("error of the force across, %", 100*abs(F[0] - 1), 1)
    figures.atMost("force upwards, % of that across", 100*abs(F[1]), 1)


def testBuoyancyOfASphere(tmp_path, figures):
    h, radius = 0.025, 0.1
    case = solved(Setup(
        cells=(16, 16, 18), h=h,
        regions={"pool": hydrostatic((0, 0, 0), (0.4, 0.4, 0.4))}, points=2,
        bodies={"ball": {"type": "fixed", "surface": {
            "type": "sphere", "origin": (0.207, 0.2, 0.205),
            "radius": radius}}}, energy=False).until(0.1), tmp_path)
    F = forces(case, "ball")
    exact = RHO*G*4/3*np.pi*radius**3
    F = F[len(F)//2:].mean(axis=0)
    figures.atMost("error of the buoyancy, %", 100*abs(F[2]/exact - 1), 2.5)


def floating(density, h=0.02, end=1.0):
    """A box at its draught, in a tank at rest; it may heave only"""
    size, level = np.array([0.2, 0.1]), 0.3
    lower = np.array([0.4, level - density*size[1]])
    centre = (*(lower + size/2), 0.0)
    mass = density*RHO*size.prod()*h
    inertia = mass*(size**2).sum()/12
    return Setup(
        cells=(50, 25), h=h, regions={"pool": hydrostatic((0, 0), (1, level))},
        bodies={"box": {"type": "rigid", "surface": box(lower, lower + size),
                        "motion": {
            "mass": mass, "centreOfMass": centre,
            "momentOfInertia": (inertia,)*3, "constraints": {"heave": {
                "sixDoFRigidBodyMotionConstraint": "line",
                "direction": (0, 1, 0)}}}}},
        functions={"forces": {
            "type": "materialPointForces", "cloud": "water",
            "libs": '("libmpmFunctionObjects.so")',
            "writeControl": "timeStep", "writeInterval": 10}},
        energy=False).until(end), size


@pytest.mark.parametrize("density", [0.5, 0.05])
def testABoxFloatsAtItsDraught(tmp_path, figures, density):
    setup, size = floating(density)
    case = solved(setup, tmp_path)
    data = np.loadtxt(
        case.path/"postProcessing"/"forces"/"0"/"forces.dat")
    y = data[:, 8]

    # Of a draught of a quarter of a cell the grid knows no more than that
    bound = max(0.02*density*size[1], 0.02*setup.h)
    figures.atMost("way from its draught, mm", 1e3*abs(y - y[0]).max(),
                   1e3*bound)


@pytest.mark.parametrize("transfer, density", [
    ("APIC", 0.05), ("APIC", 1.5), ("FLIP", 0.5)])
def testMomentumOfWaterAndBody(tmp_path, figures, transfer, density):
    h, radius = 0.02, 0.1
    mass = density*RHO*np.pi*radius**2*h
    inertia = 0.5*mass*radius**2
    case = solved(Setup(
        cells=(50, 50), h=h, g=(0, 0, 0), points=2,
        regions={"blob": box((0.1, 0.35), (0.3, 0.6), velocity=(2, 0, 0))},
        fluid={"soundSpeed": 30}, water={"transfer": transfer},
        bodies={"ball": {"type": "rigid",
                         "surface": cylinder((0.45, 0.45), radius),
                         "motion": {"mass": mass,
                                    "centreOfMass": (0.45, 0.45, 0.0),
                                    "momentOfInertia": (inertia,)*3}}},
        energy=False).until(0.1), tmp_path)
    start, end = case.points("0"), case.points()
    state = (case.path/case.times[-1]/"uniform"/"materialPoints").read_text()
    velocity = np.array([float(v) for v in re.search(
        r"\n\s+velocity\s+\(([^)]*)\)", state)[1].split()])
    total = end.momentum + mass*velocity
    figures.atMost("change of momentum, relative", np.linalg.norm(
        total - start.momentum)/np.linalg.norm(start.momentum), 1e-12)
    figures.atLeast("part that the body has",
                    mass*velocity[0]/start.momentum[0], 0.01)
    figures.atMost(
        "kinetic energy over that of the start",
        (end.kinetic + 0.5*mass*velocity @ velocity)/start.kinetic, 1)


def onASpring(half, mass, stiffness, amplitude, **control):
    """A mass on a spring, away from the water"""
    setup = Setup(
        cells=(40, 40), h=0.02, g=(0, 0, 0), points=2,
        regions={"puddle": box((0, 0), (0.1, 0.04))},
        fluid={"soundSpeed": 20},
        bodies={"ball": {
            "type": "rigid", "surface": cylinder((0.5, 0.5), 0.06),
            "motion": {
                "mass": mass, "centreOfMass": (0.5, 0.5, 0.0),
                "momentOfInertia": (1, 1, 1),
                "restraints": {"spring": {
                    "sixDoFRigidBodyMotionRestraint": "linearSpring",
                    "anchor": (0.1, 0.5, 0.0),
                    "refAttachmentPt": (0.5, 0.5, 0.0),
                    "stiffness": stiffness, "damping": 0,
                    "restLength": 0.4 - amplitude}}}}},
        functions={"forces": {
            "type": "materialPointForces", "cloud": "water",
            "libs": '("libmpmFunctionObjects.so")',
            "writeControl": "timeStep", "writeInterval": 1}},
        energy=False)
    setup.control.update(control)
    return setup.until(half)


def testABodyOnASpring(tmp_path, figures):
    """OpenFOAM's restraints act on it: half a period"""
    mass, stiffness, amplitude = 2.0, 2000.0, 0.05
    half = np.pi*np.sqrt(mass/stiffness)
    case = solved(onASpring(half, mass, stiffness, amplitude), tmp_path)
    x, speed = np.loadtxt(case.path/"postProcessing"/"forces"/"0"/"forces.dat")[
        -1, [7, 10]]
    figures.atMost("error of its way over the amplitude, %",
                   100*abs((0.5 - x)/(2*amplitude) - 1), 0.1)
    figures.atMost("speed at the turn over the largest, %", 100*abs(
        speed)/(amplitude*np.sqrt(stiffness/mass)), 1)


def testDigitsOfASpring(tmp_path, figures):
    """What the restraints see of a body has nothing to do with the digits
    that are written"""
    place = []
    for digits in [3, 12]:
        case = solved(onASpring(0.02, 2.0, 2000.0, 0.05, writePrecision=digits),
                      tmp_path/str(digits))
        state = (case.path/case.times[-1]/"uniform"/"materialPoints").read_text()
        place.append(re.search(r"centre\s+\((.*?)\)", state)[1])
    figures.equal("centre of the body", place[0], place[1])


def turning(end=0.04):
    """A cylinder that goes through water, and turns"""
    return Setup(
        cells=(50, 35), h=0.02,
        regions={"pool": hydrostatic((0, 0), (1, 0.5))}, points=2,
        bodies={"pipe": {
            "type": "prescribed", "surface": cylinder((0.46, 0.3), 0.1),
            "water": {"type": "noSlip"}, "motion": {
                "displacement": "table ((0 (0 0 0)) (1 (0.5 0 0)))",
                "rotation": "table ((0 (0 0 0)) (1 (0 0 90)))",
                "centre": (0.46, 0.3, 0.0)}}},
        energy=False).until(end, 0.02)


def drifting(end=0.04):
    """A box that falls into water as it turns, on a bed of sand"""
    lower, size = np.array([0.44, 0.28]), np.array([0.2, 0.12])
    return Setup(
        cells=(50, 30), h=0.02, points=2,
        regions={"pool": hydrostatic((0, 0), (1, 0.3))},
        soilRegions={"bed": box((0, 0), (1, 0.1), stress="geostatic",
                                saturated=True)},
        mpm={"maxSoilSoundSpeed": 10},
        bodies={
            "box": {"type": "rigid", "surface": box(lower, lower + size),
                    "motion": {"mass": 0.3,
                               "centreOfMass": (*(lower + size/2), 0.0),
                               "momentOfInertia": (1e-3, 1e-3, 1e-3),
                               "velocity": (0.5, -1, 0),
                               "angularVelocity": (0, 0, 2)}},
            "stone": {"type": "fixed", "surface": cylinder((0.3, 0.1), 0.07),
                      "soil": {"frictionCoefficient": 0.4}}},
        energy=False).until(end, 0.02)


def standing(end=0.02):
    """A box in wet sand, where two ranks meet"""
    return Setup(
        cells=(50, 25), h=0.02, points=2,
        regions={"pool": hydrostatic((0, 0), (0.46, 0.36)),
                 "tail": hydrostatic((0.54, 0), (1, 0.2))},
        soilRegions={"bed": box((0, 0), (1, 0.14), stress="geostatic",
                                saturated=True)},
        mpm={"maxSoilSoundSpeed": 10},
        bodies={"wall": {"type": "fixed",
                         "surface": box((0.46, 0.06), (0.54, 0.6)),
                         "soil": {"frictionCoefficient": 0.4}}},
        energy=False).until(end, 0.02)


def overDryFloor(end=0.04):
    """A jet runs along the floor below a pipe, where no water was at the start"""
    return Setup(
        cells=(40, 20), h=0.02, points=2, wall={"type": "smoothWall"},
        regions={"jet": box((0, 0), (0.32, 0.06), velocity=(3, 0, 0))},
        bodies={"pipe": {"type": "fixed",
                         "surface": cylinder((0.403, 0.117), 0.06)}},
        energy=False).until(end, 0.02)


@pytest.mark.parametrize("scene", [turning, drifting, standing, overDryFloor])
def testTwoRanks(tmp_path, figures, scene):
    sameOnTwoRanks(figures, scene, tmp_path)


@pytest.mark.parametrize("scene", [turning, drifting, overDryFloor])
def testRestart(tmp_path, figures, scene):
    sameAfterRestart(figures, scene, tmp_path)


def block(degrees, friction, end):
    """An elastic block on an inclined body"""
    h = 0.02
    t = np.radians(degrees)
    along = np.array([np.cos(t), np.sin(t)])
    normal = np.array([-np.sin(t), np.cos(t)])
    through = np.array([0.6, 0.3])
    corners = [through - 6*h*along, through + 6*h*along,
               through + 6*h*along + 6*h*normal,
               through - 6*h*along + 6*h*normal]
    return Setup(
        cells=(60, 40), h=h, regions={}, points=2, soilRegions={
            "block": {"type": "surface", "file": '"block.obj"'}},
        soil={"constitutiveModel": "linearElastic", "linearElasticCoeffs": {
            "rhoS": 2650, "e0": 0.6, "d": 1e-3, "E": 2e6, "nu": 0.2}},
        bodies={"floor": {"type": "fixed", "surface": surface("floor.obj"),
                          "soil": {"frictionCoefficient": friction}}},
        surfaces={"floor.obj": prism(slope(degrees, through)),
                  "block.obj": prism([tuple(c) for c in corners])},
        energy=False).until(end, end/8), along, h


def way(case, along):
    """Times, and the way down the slope at each"""
    cloud = case.case
    times = cloud.times()
    x = []
    for time in times:
        order = np.argsort(cloud.cloudField(time, "soil", "id"))
        x.append(cloud.cloudField(
            time, "soil", "x")[order][:, :2].mean(axis=0))
    return np.array([float(t) for t in times]), -(np.array(x) - x[0]) @ along


def testABlockSlides(tmp_path, figures):
    setup, along, _ = block(30, 0.3, 0.4)
    t, s = way(solved(setup, tmp_path), along)
    exact = G*(np.sin(np.radians(30)) - 0.3*np.cos(np.radians(30)))
    figures.atMost("error of the acceleration, %",
                   100*abs(2*np.polyfit(t, s, 2)[0]/exact - 1), 1)


def testABlockStandsBelowItsAngleOfFriction(tmp_path, figures):
    setup, along, h = block(30, 0.7, 0.8)
    t, s = way(solved(setup, tmp_path), along)
    figures.atMost("way from 0.1 s on over h", (s[-1] - s[1])/h, 0.02)


def testStressOfSandAtABody(tmp_path, figures):
    """An endless layer at rest on a slope below the angle of friction: the first
    rows above the body bear what is above them"""
    h, rows, degrees = 0.01, 6, 20
    t, base, rho = np.radians(degrees), 6*h, 2650/1.7
    case = solved(Setup(
        cells=(4, 6 + rows + 4), h=h, points=2, regions={},
        g=(G*np.sin(t), -G*np.cos(t), 0), mpm={"maxSoilSoundSpeed": 25},
        soil={"DruckerPragerCoeffs": {
            "rhoS": 2650, "d": 1e-3, "e0": 0.7, "E0": 216, "n": 0.5, "nu": 0.2,
            "phi": 31, "psi": 0}},
        soilRegions={"sand": box((0, base), (4*h, base + rows*h),
                                 stress="geostatic", saturated=False)},
        bodies={"floor": {"type": "fixed",
                          "surface": box((-1, -1), (1, base)),
                          "soil": {"frictionCoefficient": 0.5}}},
        energy=False).cyclic("x").until(0.15), tmp_path)
    x, sigma = (case.case.cloudField(case.times[-1], "soil", name)
                for name in ["x", "sigma"])
    above = base + rows*h - x[:, 1]
    for low, high in [(0, 0.5), (0.5, 1), (1, 1.5)]:
        row = abs(x[:, 1] - base - 0.5*(low + high)*h) < 0.25*h
        weight = rho*G*above[row].mean()
        for name, stress, part in [("normal", -sigma[row, 3], np.cos(t)),
                                   ("shear", sigma[row, 1], np.sin(t))]:
            figures.atMost(f"error of the {name} stress, {low} to {high} h, %",
                           100*abs(stress.mean()/(weight*part) - 1), 12)


def testBedAroundAPipe(tmp_path, figures):
    """Sand and water at rest around a pipe that is half in the bed"""
    h = 0.01
    case = solved(Setup(
        cells=(40, 25), h=h, points=2,
        regions={"water": hydrostatic((0, 0), (0.4, 0.2))},
        soilRegions={"bed": box((0, 0), (0.4, 0.08), stress="geostatic",
                                saturated=True)},
        mpm={"maxSoilSoundSpeed": 10},
        bodies={"pipe": {"type": "fixed",
                         "surface": cylinder((0.2, 0.1), 0.035),
                         "soil": {"frictionCoefficient": 0.4}}},
        energy=False).until(0.2), tmp_path)
    F = forces(case)
    exact = RHO*G*np.pi*0.035**2*h
    figures.atMost("error of the buoyancy, %",
                   100*abs(F[-1][1]/exact - 1), 2)
    cloud = case.case
    for name, bound in [("water", 1), ("soil", 0.1)]:
        figures.atMost(f"rms speed of the {name}, mm/s", 1e3*rms(
            cloud.cloudField(case.times[-1], name, "U")), bound)


BALL = {"type": "fixed", "surface": cylinder((0.5, 0.3), 0.1)}
MOTION = {"mass": 1, "centreOfMass": (0.5, 0.3, 0),
          "momentOfInertia": (1, 1, 1)}


@pytest.mark.parametrize("body, changes, message", [
    ({"type": "floating", **{"surface": BALL["surface"]}}, {},
     "keyword type.*floating.*fixed.*prescribed.*rigid"),
    ({**BALL, "colour": "red"}, {}, "colour"),
    ({"type": "fixed", "surface": {**BALL["surface"], "radios": 1}}, {},
     "radios.*radius"),
    ({"type": "fixed", "surface": cylinder((0.5, 0.3), -0.1)}, {},
     "value -0.1.*Allowed: 0 < radius"),
    ({**BALL, "motion": {}}, {}, "keyword motion is given, but type is fixed"),
    ({"type": "fixed"}, {}, "surface"),
    ({"type": "fixed", "surface": cylinder((0.5, 0.3), 0.015)}, {},
     "thinner than.*Allowed: 0.05 m or thicker"),
    ({"type": "fixed", "surface": cylinder((5, 0.3), 0.1)}, {},
     "outside of the mesh"),
    ({"type": "fixed", "surface": {
        "type": "sphere", "origin": (0.5, 0.3, 0), "radius": 0.05}}, {},
     "across the plane of the case"),
    ({"type": "fixed", "surface": {"type": "disk", "origin": (0.5, 0.3, 0),
                                   "normal": (0, 1, 0), "radius": 0.1}}, {},
     "no inside"),
    ({**BALL, "type": "prescribed", "motion": {}}, {},
     "neither displacement nor rotation"),
    ({**BALL, "type": "prescribed", "motion": {
        "rotation": "constant (10 0 0)"}}, {}, "not about the normal"),
    ({**BALL, "type": "rigid", "motion": {**MOTION, "mass": -1}}, {},
     "value -1.*Allowed: 0 < mass"),
    ({**BALL, "type": "rigid", "motion": {
        **MOTION, "momentOfInertia": (1, 0, 1)}}, {}, "momentOfInertia"),
    ({**BALL, "water": {"type": "wet"}}, {}, "wet.*slip.*noSlip"),
    (BALL, {"mpm": {"shapeFunction": "linear"}}, "shape function.*linear"),
    (BALL, {"mpm": {"smoothing": False}}, "smoothing"),
])
def testBadInput(tmp_path, figures, body, changes, message):
    setup = Setup(
        cells=(50, 30), h=0.02, regions={"pool": hydrostatic((0, 0), (1, 0.4))},
        bodies={"ball": body}, energy=False, **changes)
    case = setup.write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
    text = " ".join(str(error.value).split())
    figures.holds("the message says " + message, re.search(message, text),
                  text[-400:])


@pytest.mark.parametrize("turned", [False, True])
@pytest.mark.parametrize("thickness", [0.1, 0.3, 0.49, 0.7, 1.5])
@pytest.mark.parametrize("offset", [0, 0.13, 0.25, 0.5])
def testPlatesAreRefused(tmp_path, figures, thickness, offset, turned):
    """Also those that lie between the samples of the distance, which are half
    a cell apart; thickness and offset in cells"""
    h = 0.02
    x = 0.5 + offset*h
    box = {"type": "box", "min": (x, 0.1, -1),
           "max": (x + thickness*h, 0.3, 1)}
    if turned:
        e = (np.cos(0.4), np.sin(0.4), 0)
        box = {"type": "rotatedBox", "origin": (x, 0.1, -1),
               "span": (thickness*h, 0.2, 2), "e1": e, "e3": (0, 0, 1)}
    case = Setup(
        cells=(50, 30), h=h, regions={"pool": hydrostatic((0, 0), (1, 0.4))},
        bodies={"wall": {"type": "fixed", "surface": box}},
        energy=False).write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
    figures.contains("message", " ".join(str(error.value).split()),
                     "body wall is thinner than.*Allowed: 0.05 m or thicker")


def testBodiesThatOverlap(tmp_path, figures):
    case = Setup(
        cells=(50, 30), h=0.02, regions={"pool": hydrostatic((0, 0), (1, 0.4))},
        bodies={"a": BALL, "b": {"type": "fixed",
                                 "surface": cylinder((0.6, 0.3), 0.1)}},
        energy=False).write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
    figures.contains("message", " ".join(str(error.value).split()),
                     "bodies a and b overlap.*Allowed: bodies that are apart")
