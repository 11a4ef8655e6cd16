"""Time series of mpmFoam's own function objects against the points that were
written, over a restart, and on two ranks."""

import numpy as np
import pytest

from mpmfoam.postProcessing import readDat

from caseBuilder import RHO, damBreak

LIBS = '("libmpmFunctionObjects.so")'
SERIES = [("energy", "energy.dat"), ("front", "front.dat"),
          ("gauge", "waveGauge.dat")]


def withSeries(dim=2):
    s = damBreak(dim, h=0.02 if dim == 2 else 0.04,
                 points=4 if dim == 2 else 2)
    when = {"libs": LIBS, "cloud": "water", "writeControl": "timeStep",
            "writeInterval": 5}
    s.functions = {
        "front": {"type": "frontPosition", "direction": (1, 0, 0), **when},
        "gauge": {"type": "waveGauge", "points": [
            (0.1, 0.1, 0.01), (0.45, 0.1, 0.01)], **when}}
    s.endless(20)
    s.control["endTime"] = 0.05
    return s


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    case = withSeries().write(tmp_path_factory.mktemp("series")/"case").prepare()
    case.solve()
    return case


def row(case, name, file, time):
    rows = readDat(case.path, name, file)
    k = int(np.argmin(np.abs(rows[:, 0] - case.timeValue(time))))
    assert abs(rows[k, 0] - case.timeValue(time)) < 1e-6
    return rows[k]


def testEnergy(run, figures):
    """Columns of energy.dat against the points of a written time"""
    time = run.timesByStep()[40]
    at = {name: values[np.argmin(np.abs(
        run.energies()["time"] - run.timeValue(time)))]
        for name, values in run.energies().items()}
    points, c = run.points(time), run.state(time)["soundSpeed"]
    bulk = c**2*RHO/7
    J = points.J
    expected = {
        "kinetic": points.kinetic,
        "potential": points.potential(run.setup.g),
        "elastic": (points.mass/RHO*bulk*((J**-6 - 1)/6 + J - 1)).sum(),
        "stresswork": run.state(time)["stressWork"],
        "correctionwork": run.state(time)["correctionWork"]}
    scale = expected["potential"]
    for name, value in expected.items():
        figures.atMost(f"{name}: difference over potential energy",
                       abs(at[name] - value)/scale, 1e-10)
    figures.atMost(
        "total - kinetic - potential - stressWork - affine, over total",
        abs(at["total"] - at["kinetic"] - at["potential"]
            - at["stresswork"] - at["affine"])/at["total"], 1e-10)
    C = run.case.cloudField(time, "water", "velocityGradient")
    mass = run.case.cloudField(time, "water", "mass")
    affine = 0.5*(mass*(C**2).reshape(len(C), -1).sum(axis=1)).sum()
    figures.atMost("affine: difference to m C:C h2/8, over it", abs(
        at["affine"]/(affine*run.setup.h**2/4) - 1), 1e-10)
    start = run.energies()
    figures.equal("time of the first row", start["time"][0], 0)
    figures.equal("kinetic energy of the first row", start["kinetic"][0], 0)


def testFront(run, figures):
    for step in [20, 40, 60]:
        time = run.timesByStep()[step]
        values = row(run, "front", "front.dat", time)
        x = run.points(time).x[:, 0]
        figures.atMost(f"step {step}: max, difference to the points",
                       abs(values[1] - x.max()), 1e-10)
        figures.holds(f"step {step}: front",
                      x.max() - 2*0.02 <= values[2] <= x.max() + 1e-9,
                      f"{values[2]:.6g} of {x.max():.6g} m")


def testGauge(run, figures):
    """A column of 0.2 m in 0.2 of 0.5 m"""
    rows = readDat(run.path, "gauge", "waveGauge.dat")
    figures.atMost("height in the column at the start: error over it",
                   abs(rows[0, 1]/0.2 - 1), 0.01)
    figures.equal("height where there is no water", rows[0, 2], 0)
    figures.atMost("mean level at the start: error over it",
                   abs(rows[0, -1]/0.08 - 1), 0.01)
    figures.atMost("mean level: largest change", float(np.abs(
        rows[:, -1]/rows[0, -1] - 1).max()), 0.05)


@pytest.mark.parametrize("dim", [2, 3])
def testTwoRanks(tmp_path, figures, run, dim):
    serial = run
    if dim == 3:
        serial = withSeries(3).write(tmp_path/"serial").prepare()
        serial.solve()
    case = withSeries(dim).write(tmp_path/"parallel").prepare()
    case.decompose(2, cellRank=case.case.cellCentres("0")[:, 0] > 0.1)
    case.solve(ranks=2)
    for name, file in SERIES:
        a, b = (readDat(c.path, name, file) for c in (case, serial))
        figures.equal(f"{file}: rows", a.shape, b.shape)
        scale = np.nanmax(np.abs(b), axis=0)
        scale[scale == 0] = 1
        if name == "energy":
            scale[1:] = scale[6]
        figures.atMost(f"{file}: largest difference, relative", float(
            np.nanmax(np.abs(a - b)/scale)), 1e-10)


def testOverRestart(tmp_path, figures, run):
    """Two runs make the series of one"""
    case = withSeries().write(tmp_path/"case").prepare()
    case.change(control={"endTime": 0.03})
    case.solve()
    case.change(control={"endTime": 0.05})
    case.solve()
    for name, file in SERIES:
        a, b = (readDat(c.path, name, file) for c in (case, run))
        starts = len(list((case.path/"postProcessing"/name).iterdir()))
        figures.equal(f"{file}: start times", starts, 2)
        figures.equal(f"{file}: rows", a.shape, b.shape)
        if a.shape == b.shape:
            scale = np.nanmax(np.abs(b), axis=0)
            scale[scale == 0] = 1
            figures.atMost(f"{file}: largest difference, relative", float(
                np.nanmax(np.abs(a - b)/scale)), 1e-10)
