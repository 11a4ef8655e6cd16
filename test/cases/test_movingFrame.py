"""A mesh that moves (dictionary frame): surfaces at rest in it, a free point,
work, ranks, bad input."""

import numpy as np
import pytest

from mpmfoam.postProcessing import readColumns

from caseBuilder import G, CaseError, Setup, box, hydrostatic
from test_parallel import agree


def gauge(*places):
    return {"type": "waveGauge", "cloud": "water", "points": places,
            "libs": '("libmpmFunctionObjects.so")',
            "writeControl": "timeStep", "writeInterval": 20}


def levels(case, n):
    rows = readColumns(case.path, "gauge", "waveGauge.dat")
    names = [k for k in rows if k != "Time"][:n]
    late = rows["Time"] > 0.8*rows["Time"][-1]
    return np.array([rows[k][late].mean() for k in names])


@pytest.mark.parametrize("frame, slope", [
    ({"acceleration": (0.15*G, 0, 0)}, -0.15),
    # The mesh turned counter-clockwise: its right side is up
    ({"axis": (0, 0, 1), "angle": 8}, -np.tan(np.radians(8)))],
    ids=["accelerated", "tilted"])
def testSurfaceInAFrame(tmp_path, figures, frame, slope):
    setup = Setup(
        cells=(30, 16), h=0.02, points=2,
        regions={"pool": hydrostatic((0, 0), (0.6, 0.16))},
        mpm={"relaxation": {"until": 10, "damping": 0.7}},
        functions={"gauge": gauge((0.15, 0, 0), (0.45, 0, 0))}, energy=False)
    setup.properties = lambda: {**setup.cloudProperties(), "frame": frame}
    case = setup.until(1.5).write(tmp_path/"case").prepare()
    case.solve()
    low, high = levels(case, 2)
    figures.atMost("error of the rise between two gauges over h",
                   abs(high - low - 0.3*slope)/0.02, 0.1)
    p = case.points()
    figures.atMost("rms speed [m/s]",
                   float(np.sqrt((p.U**2).sum(axis=1).mean())), 1e-2)


def turning(**entries):
    """A narrow tank that turns about a vertical axis at its left end"""
    setup = Setup(
        cells=(16, 2, 14), h=0.025, points=2, origin=(0, -0.025, 0),
        regions={"pool": hydrostatic((0, -1, 0), (0.4, 1, 0.15))},
        mpm={"relaxation": {"until": 10, "damping": 0.7}},
        functions={"gauge": gauge((0.0625, 0, 0), (0.3375, 0, 0))},
        energy=False, **entries)
    setup.properties = lambda: {**setup.cloudProperties(), "frame": {
        "axis": (0, 0, 1), "angularVelocity": 4}}
    return setup


def testParabola(tmp_path, figures):
    case = turning().until(1.5).write(tmp_path/"case").prepare()
    case.solve()
    near, far = levels(case, 2)
    exact = 4**2*(0.3375**2 - 0.0625**2)/(2*G)
    figures.atMost("error of the rise, %", 100*abs((far - near)/exact - 1), 3)


def testRanks(tmp_path, figures):
    setup = turning().steps(50)
    setup.mpm.clear()
    setup.regions["pool"]["velocity"] = (0, 0.3, 0.2)
    serial = setup.write(tmp_path/"serial").prepare()
    case = serial.clone(tmp_path/"case").decompose(2)
    serial.solve()
    case.solve(ranks=2)
    agree(figures, case, serial)


@pytest.mark.parametrize("rate", ["constant", "growing"])
def testAFreePointGoesStraight(tmp_path, figures, rate):
    """In space, about an origin that is not that of the mesh; and the work"""
    origin, end = np.array([0.2, -0.1]), 0.8
    if rate == "constant":
        omega, angle, omega0 = 2, 2*end, 2
    else:
        omega, angle, omega0 = "table ((0 0) (1 4))", 2*end**2, 0
    setup = Setup(
        cells=(40, 40), h=0.05, points=1, origin=(-1, -1, 0), g=(0, 0, 0),
        fluid={"soundSpeed": 10}, regions={"drop": box(
            (0.5, 0.1), (0.55, 0.15), velocity=(0.3, -0.2, 0))},
        control={"adjustTimeStep": False, "deltaT": 5e-4})
    setup.properties = lambda: {**setup.cloudProperties(), "frame": {
        "axis": (0, 0, 2), "angularVelocity": omega,
        "origin": (*origin, 0)}}
    case = setup.until(end).write(tmp_path/"case").prepare()
    case.solve()
    start, p = case.points("0"), case.points()
    figures.equal("points", len(start.id), 1)
    r = start.x[0, :2] - origin
    V = start.U[0, :2] + omega0*np.array([-r[1], r[0]])
    c, s = np.cos(angle), np.sin(angle)
    exact = origin + np.array([[c, s], [-s, c]]) @ (r + V*end)
    figures.atLeast("way over the error of the place", float(
        np.linalg.norm(V)*end/np.linalg.norm(p.x[0, :2] - exact)), 500)

    e = case.energies()
    gained = e["kinetic"][-1] - e["kinetic"][0]
    figures.atMost("work of the frame over the kinetic energy gained, error, %",
                   100*abs(e["forcework"][-1]/gained - 1), 0.5)


def testBadFrames(tmp_path, figures):
    case = Setup(cells=(6, 6), h=0.02, energy=False, regions={
        "pool": hydrostatic((0, 0), (1, 0.06))}).steps(1).write(
            tmp_path/"case").prepare()
    for frame, words in [
            ({}, ["frame", "acceleration, angle or angularVelocity"]),
            ({"angle": 3, "axis": (1, 0, 0)}, ["axis", "along z"]),
            ({"angle": 3, "angularVelocity": 1, "axis": (0, 0, 1)},
             ["angle and angularVelocity"]),
            ({"acceleration": (0, 0, 1)}, ["acceleration", "direction z"]),
            ({"accelaration": (1, 0, 0)}, ["accelaration"])]:
        case.setup.properties = lambda: {
            **case.setup.cloudProperties(), "frame": frame}
        case.rewrite()
        with pytest.raises(CaseError) as error:
            case.solve()
        for word in words:
            figures.contains(f"{frame}", word if word in str(error.value)
                             else None, word)
