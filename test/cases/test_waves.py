"""Waves made by a piston, and zones that absorb them: the path of the piston and
the height of the wave by theory, decay and target of a zone's velocity, ranks,
bad input."""

import re

import numpy as np
import pytest

from caseBuilder import G, CaseError, Setup, box, hydrostatic

FORCES = {"forces": {
    "type": "materialPointForces", "cloud": "water",
    "libs": '("libmpmFunctionObjects.so")',
    "writeControl": "timeStep", "writeInterval": 1}}


def piston(face, top, **motion):
    return {"type": "prescribed", "surface": box((-2, -0.1), (face, top + 0.1)),
            "motion": {"type": "pistonWave", **motion}}


def solved(setup, path):
    case = setup.write(path/"case")
    case.prepare()
    case.solve()
    return case


def waveNumber(omega, depth):
    k = omega**2/G
    for _ in range(200):
        k = 0.5*k + 0.5*omega**2/(G*np.tanh(k*depth))
    return k


def tank(depth=0.2, h=0.04, **motion):
    return Setup(
        cells=(25, round(0.32/h)), h=h, points=2,
        regions={"pool": hydrostatic((0.3, 0), (1, depth))},
        bodies={"piston": piston(0.3, 0.32, depth=depth, **motion)},
        functions=FORCES, energy=False)


def way(case):
    data = np.loadtxt(case.path/"postProcessing"/"forces"/"0"/"forces.dat")
    return data[:, 0], data[:, 7]


@pytest.mark.parametrize("secondOrder", [False, True])
def testPathOfARegularWave(tmp_path, figures, secondOrder):
    height, depth, period, ramp, start = 0.02, 0.2, 0.9, 0.6, 0.1
    t, x = way(solved(tank(
        wave="regular", height=height, period=period, rampTime=ramp,
        start=start, secondOrder=secondOrder).until(1.2), tmp_path))
    omega = 2*np.pi/period
    kd = waveNumber(omega, depth)*depth
    ratio = 2*(np.cosh(2*kd) - 1)/(np.sinh(2*kd) + 2*kd)
    s = t - start
    exact = height/ratio/2*np.sin(omega*s)
    if secondOrder:
        exact += height**2/(32*depth)*(
            3*np.cosh(kd)/np.sinh(kd)**3 - 2/ratio)*np.sin(2*omega*s)
    exact *= np.where(s < ramp, 0.5*(1 - np.cos(np.pi*s/ramp)), 1)*(s > 0)
    figures.atMost("way of the piston over the stroke, %",
                   100*abs(x - exact).max()/(height/ratio), 1e-4)


def testPathOfASolitaryWave(tmp_path, figures):
    """The piston moves with the water: dx/dt = c eta/(d + eta) at its place"""
    height, depth = 0.06, 0.2
    t, x = way(solved(
        tank(wave="solitary", height=height).until(2.2), tmp_path))
    kappa = np.sqrt(0.75*height/depth**3)
    speed = np.sqrt(G*(depth + height))
    stroke = 2*height/(kappa*depth)
    figures.atMost("way in all over the stroke, % off 99.9",
                   100*abs(x[-1]/stroke - np.tanh(3.8)), 0.01)
    middle = (3.8 + height/depth)/(kappa*speed)
    eta = height/np.cosh(kappa*(speed*(t - middle) - (x - x[-1]/2)))**2
    v = np.gradient(x, t)
    within = (t > 0.05) & (t < 2*middle - 0.05)
    figures.atMost("speed of the piston, % of c H/(d + H)", 100*abs(
        v - speed*eta/(depth + eta))[within].max()/(
            speed*height/(depth + height)), 1)


def testHeightOfARegularWave(tmp_path, figures):
    """Coarse: three cells high. Behind the gauges a sponge."""
    h, depth, height, period = 0.02, 0.2, 0.03, 0.9
    omega = 2*np.pi/period
    k = waveNumber(omega, depth)
    kd = k*depth
    ratio = 2*(np.cosh(2*kd) - 1)/(np.sinh(2*kd) + 2*kd)
    group = 0.5*omega/k*(1 + 2*kd/np.sinh(2*kd))
    x = [1.0, 1.2, 1.45]
    setup = Setup(
        cells=(170, 15), h=h, points=2,
        regions={"pool": hydrostatic((0.2, 0), (3.4, depth))},
        water={"relaxationZones": {"beach": {
            "min": (2, -1, -1), "max": (3.4, 1, 1), "direction": (1, 0, 0),
            "rate": 12*group/1.4}}},
        bodies={"piston": piston(
            0.2, 0.3, wave="regular", height=height, depth=depth,
            period=period)},
        functions={"gauges": {
            "type": "waveGauge", "cloud": "water",
            "libs": '("libmpmFunctionObjects.so")',
            "points": [(v, 0.0, 0.0) for v in x],
            "writeControl": "adjustableRunTime",
            "writeInterval": period/40}}, energy=False)
    case = solved(setup.until(8*period), tmp_path)
    data = np.loadtxt(
        case.path/"postProcessing"/"gauges"/"0"/"waveGauge.dat")
    t, eta = data[:, 0], data[:, 1:4]
    late = t > 5*period + 1e-9
    a = 2*(eta[late]*np.exp(-1j*omega*t[late])[:, None]).mean(axis=0)
    basis = np.stack([np.exp(-1j*k*np.array(x)), np.exp(1j*k*np.array(x))],
                     axis=1)
    incident, reflected = abs(np.linalg.lstsq(basis, a, rcond=None)[0])
    figures.atMost("error of H/S, %", 100*abs(2*incident/height - 1), 8)
    figures.atMost("reflected part, %", 100*reflected/incident, 10)


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("rate", [5.0, 1e6])
def testAZoneTakesTheVelocity(tmp_path, figures, rate, ranks):
    """Water that moves as a whole, without gravity, in a zone that is
    everywhere: exact by step"""
    dt, n, v0, target = 1e-3, 40, 2.0, 0.5
    setup = Setup(
        cells=(10, 8), h=0.1, g=(0, 0, 0), points=2, fluid={"soundSpeed": 20},
        regions={"water": box((0, 0), (1, 0.8), velocity=(v0, 0, 0))},
        water={"relaxationZones": {"all": {
            "min": (-1, -1, -1), "max": (2, 2, 2), "rate": rate,
            "velocity": (target, 0, 0)}}},
        control={"adjustTimeStep": False, "deltaT": dt}, energy=False)
    setup.cyclic("x")
    case = setup.steps(n).write(tmp_path/"case")
    case.prepare()
    if ranks > 1:
        case.decompose(ranks)
    case.solve(ranks)
    points = case.points()
    exact = target + (v0 - target)/(1 + rate*dt)**n
    figures.atMost("velocity, relative error",
                   abs(points.U[:, 0]/exact - 1).max(), 1e-10)


def testAZoneActsWhereItIs(tmp_path, figures):
    """Two boxes of water far apart, one in the zone"""
    dt, n, rate = 1e-3, 20, 20.0
    setup = Setup(
        cells=(24, 8), h=0.1, g=(0, 0, 0), points=2, fluid={"soundSpeed": 20},
        regions={"a": box((0.4, 0), (0.8, 0.8), velocity=(1, 0, 0)),
                 "b": box((1.4, 0), (1.8, 0.8), velocity=(1, 0, 0))},
        water={"relaxationZones": {"right": {
            "min": (1.2, -1, -1), "max": (2.4, 2, 2), "rate": rate}}},
        control={"adjustTimeStep": False, "deltaT": dt}, energy=False)
    case = solved(setup.steps(n), tmp_path)
    points = case.points()
    at0 = case.points("0")
    inside = at0.x[:, 0] > 1.3
    exact = 1/(1 + rate*dt)**n
    figures.atMost("velocity in the zone, relative error",
                   abs(points.U[inside, 0]/exact - 1).max(), 1e-10)
    figures.atMost("velocity of the other, relative error",
                   abs(points.U[~inside, 0] - 1).max(), 1e-10)


GOOD = {"wave": "regular", "height": 0.02, "depth": 0.2, "period": 0.9}
ZONE = {"min": (0.5, -1, -1), "max": (1, 1, 1), "rate": 5}


@pytest.mark.parametrize("motion, message", [
    ({"type": "pistonWve"}, "unknown type pistonWve.*functions pistonWave"),
    ({"wave": "cnoidal"}, "unknown wave cnoidal.*regular solitary"),
    ({"height": -0.1}, "height.*value -0.1.*Allowed: 0 < height"),
    ({"height": 0.15}, "keyword height is 0.15 m: waves of the length .* break"),
    ({"depth": None}, "depth"),
    ({"period": None}, "period"),
    ({"wave": "solitary"}, "keyword period is given, but wave is solitary"),
    ({"wave": "solitary", "period": None, "height": 0.18},
     "keyword height is 0.18 m: the wave breaks.*Allowed: < 0.156 m"),
    ({"period": 2.5, "secondOrder": True}, "secondOrder is yes, but height"),
    ({"direction": (0, 0, 0)}, "keyword direction"),
    ({"direction": (0, 0, 1)}, "out of the plane of the case"),
    ({"heigth": 0.02}, "heigth"),
])
def testBadPiston(tmp_path, figures, motion, message):
    case = tank(**{k: v for k, v in {**GOOD, **motion}.items()
                   if v is not None and k != "depth"})
    entries = case.bodies["piston"]["motion"]
    entries.pop("depth")
    if motion.get("depth", 0.2) is not None:
        entries["depth"] = 0.2
    case = case.until(0.5).write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
        case.solve()
    figures.holds("the message says " + message, re.search(
        message, " ".join(str(error.value).split())), str(error.value)[-400:])


@pytest.mark.parametrize("zone, message", [
    ({"rate": 0}, "value 0.*Allowed: 0 < rate"),
    ({"rate": None}, "rate"),
    ({"max": (0.4, 1, 1)}, "Allowed: min < max"),
    ({"min": (5, -1, -1), "max": (6, 1, 1)}, "has no node of the grid"),
    ({"direction": (1, 1, 0)}, "keyword direction is .*along an axis"),
    ({"direction": (0, 0, 1)}, "keyword direction is .*along an axis"),
    ({"velocity": (0, 0, 1)}, "keyword velocity"),
    ({"rte": 1}, "rte"),
])
def testBadZone(tmp_path, figures, zone, message):
    entries = {k: v for k, v in {**ZONE, **zone}.items() if v is not None}
    case = Setup(
        cells=(25, 10), h=0.04, points=2,
        regions={"pool": hydrostatic((0, 0), (1, 0.2))},
        water={"relaxationZones": {"beach": entries}},
        energy=False).write(tmp_path/"case")
    with pytest.raises(CaseError) as error:
        case.prepare()
    figures.holds("the message says " + message, re.search(
        message, " ".join(str(error.value).split())), str(error.value)[-400:])
