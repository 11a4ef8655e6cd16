"""Small versions of the hard cases of the specification, the guards that keep
them stable, and variants in water: finite values, exact mass, no point
outside, energy that does not grow, level. hardCases has what they are;
validation/stability runs the large ones."""

import numpy as np
import pytest

import hardCases
from caseBuilder import Setup, box, damBreak, header, hydrostatic
from checks import healthy
from hardCases import GUARDS, HARD


def ran(setup, path, figures, **kwargs):
    case = setup.write(path/"case").prepare()
    case.solve()
    healthy(figures, case, **kwargs)
    return case


@pytest.mark.parametrize("name", HARD)
def testHardCase(tmp_path, figures, name):
    hard = HARD[name]
    hard.bounds(figures, hard.solve(tmp_path/"case", hard.quick))


@pytest.mark.parametrize("name", GUARDS)
def testGuard(tmp_path, figures, name):
    """The bound holds with the guard, and not without it"""
    guard = GUARDS[name]
    for on in [True, False]:
        case = guard.made(on, guard.quick).write(tmp_path/str(on))
        figure = guard.figure(case)
        if on:
            figures.atMost(f"with it: {guard.about}", figure, guard.bound)
        else:
            # Clearly, not by a hair
            figures.atLeast(f"without it: {guard.about}", figure,
                            1.5*guard.bound)
        if guard.debugSwitch:
            figures.equal("warning in the log", guard.warned(case), not on)


# --- variants -------------------------------------------------------------

def testThinFilmOfHalfACell(tmp_path, figures):
    ran(hardCases.film(depth=0.5, points=4), tmp_path, figures)


@pytest.mark.parametrize("points", [1, 3])
def testPointsPerCell3D(tmp_path, figures, points):
    ran(damBreak(3, h=0.05, points=points).until(0.8, write=0.05),
        tmp_path, figures)


def testImpactOnStep3D(tmp_path, figures):
    setup = hardCases.step(1, dim=3, end=0.5)
    hardCases.behindStep(figures, ran(setup, tmp_path, figures))


def testImpactOnWallNoSlip(tmp_path, figures):
    ran(hardCases.wall(1, wall="noSlip"), tmp_path, figures)


@pytest.mark.parametrize("transfer", ["APIC", "FLIP"])
def testLargeCourantNumber3D(tmp_path, figures, transfer):
    setup = hardCases.fast(dim=3, transfer=transfer)
    hardCases.fastHolds(figures, ran(setup, tmp_path, figures))


def testManyPointsPerCell(tmp_path, figures):
    setup = damBreak(h=0.05, points=10)
    ran(setup.until(0.4, write=0.05), tmp_path, figures)


def testPointOnLastFace(tmp_path, figures):
    """A wall's own plane belongs to the mesh: points exactly on the upper
    walls are taken in, not refused"""
    setup = Setup(cells=(10, 10), h=0.1, points=2, g=(0, 0, 0),
                  control={"writeFormat": "ascii", "writePrecision": 17},
                  fluid={"soundSpeed": 10},
                  regions={"pool": box((0.5, 0.5), (1, 1))})
    case = setup.steps(20).write(tmp_path/"case").prepare()
    x = case.case.cloudField("0", "water", "x")
    x[np.isclose(x[:, 0], 0.975), 0] = 1.0
    x[np.isclose(x[:, 1], 0.975), 1] = 1.0
    figures.atLeast("points on the upper walls",
                    int(np.any(x[:, :2] == 1, axis=1).sum()), 10)
    path = case.path/"0"/"lagrangian"/"water"/"x"
    path.write_text(header("x", "vectorField") + f"{len(x)}\n(\n" + "\n".join(
        "({:.17g} {:.17g} {:.17g})".format(*row) for row in x) + "\n)\n")
    case.solve()
    healthy(figures, case, energy=False)


@pytest.mark.parametrize("precision", [6, 12])
def testRestartFromAscii(tmp_path, figures, precision):
    """Fewer digits than a number has: close, not exact, and never refused;
    with water pressed into a corner of upper walls"""
    setup = Setup(cells=(10, 10), h=0.02, g=(20, 10, 0), points=3,
                  control={"writeFormat": "ascii",
                           "writePrecision": precision},
                  regions={"block": box((0.08, 0.08), (0.2, 0.2))})
    case = setup.until(0.2, write=0.02).write(tmp_path/"case").prepare()
    case.solve()
    near = case.points().x[:, :2].max()
    figures.atLeast("nearest point to a wall at 0.2 m", near, 0.19)
    case.change(control={"endTime": 0.4})
    result = case.solve(check=False)
    figures.equal("exit status of the restart", result.status, 0)
    if result.status == 0:
        healthy(figures, case, energy=False)


def testMostlyEmpty(tmp_path, figures):
    """Two small bodies far apart in a large mesh; one rests"""
    setup = Setup(cells=(120, 60), h=0.02, regions={
        "falls": box((0.2, 0.8), (0.26, 0.86)),
        "rests": hydrostatic((2.2, 0), (2.4, 0.04))})
    case = ran(setup.until(0.8, write=0.05), tmp_path, figures)
    # Cells without points cost nothing: compare with the tank alone
    figures.show("ns per point and step", case.log.nsPerPointStep)


def testFlowThroughGap(tmp_path, figures):
    """Through an opening of two cells under a wall of two cells"""
    setup = damBreak(height=0.3)
    setup.solid = [((10, 2), (12, 20))]
    case = ran(setup.until(0.6, write=0.05), tmp_path, figures)
    end = case.points()
    figures.atLeast("points behind the gate",
                    int(np.sum(end.x[:, 0] > 0.24)), 50)
    figures.atMost("points inside or above the gate", int(np.sum(
        (end.x[:, 0] > 0.2) & (end.x[:, 0] < 0.24) & (end.x[:, 1] > 0.04))),
        0)


@pytest.mark.parametrize("cells, origin", [
    ((20, 12), (-0.3, 5, 0)), ((20, 12), (1e3, -1e3, 7))])
def testOrigin(tmp_path, figures, cells, origin):
    """The mesh lies anywhere"""
    low = np.array(origin[:2])
    setup = Setup(cells=cells, h=0.02, origin=origin, regions={
        "column": hydrostatic(low, low + 0.2)})
    case = ran(setup.until(0.3, write=0.05), tmp_path, figures)
    start, end = case.points("0"), case.points()
    figures.atLeast("front's way", float(
        end.x[:, 0].max() - start.x[:, 0].max()), 0.15)


def testUnequalSpacing(tmp_path, figures):
    """Cells twice as wide as high"""
    setup = Setup(cells=(15, 20), h=(0.04, 0.02, 0.02), regions={
        "column": hydrostatic((0, 0), (0.2, 0.2))})
    ran(setup.until(0.6, write=0.05), tmp_path, figures)


@pytest.mark.parametrize("empty", ["x", "y"])
def testOtherPlanes(tmp_path, figures, empty):
    """2D in the planes y-z and x-z gives what x-y gives"""
    # Axes of the plane in the order in which mpmFoam has them
    axes = [a for a in "xyz" if a != empty]
    up = "z"
    results = {}
    for plane in ["xy", "".join(axes)]:
        setup = PlaneSetup(plane, up if plane != "xy" else "y")
        case = setup.write(tmp_path/plane).prepare()
        case.solve()
        points = case.points()
        ids = ["xyz".index(a) for a in plane]
        results[plane] = points.x[:, ids], points.U[:, ids], points.J
    a, b = results["xy"], results["".join(axes)]
    for name, u, v in zip(["x", "U", "J"], a, b):
        figures.atMost(f"{name}: difference to x-y, relative", float(
            np.abs(u - v).max()/np.abs(u).max()), 1e-10)


class PlaneSetup(Setup):
    """A dam break in a plane of two of the axes; the mesh has one layer of
    cells along the third"""

    def __init__(self, plane, up):
        first, second = ("xyz".index(a) for a in plane)
        third = 3 - first - second
        cells, top = [1, 1, 1], [10, 10, 10]
        cells[first], cells[second] = 20, 15
        top[first], top[second] = 0.2, 0.2
        low = [-10, -10, -10]
        low[first] = low[second] = 0
        g = [0, 0, 0]
        g["xyz".index(up)] = -9.81
        super().__init__(
            cells=tuple(cells), h=0.02, g=tuple(g), regions={
                "column": box(low, top, pressure="hydrostatic", level=0.2)})
        axis = "xyz"[third]
        self.sides = {axis + "min": ("empty", "empty"),
                      axis + "max": ("empty", "empty")}
        self.steps(100)
