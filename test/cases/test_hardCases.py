"""Small versions of the hard cases of the specification, water alone: finite
values, exact mass, no point outside, energy that does not grow."""

import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak, header, hydrostatic
from checks import healthy


def ran(setup, path, figures, **kwargs):
    case = setup.write(path/"case").prepare()
    case.solve()
    healthy(figures, case, **kwargs)
    return case


def testThinFilm(tmp_path, figures):
    """One cell deep, sliding along a floor and up a wall"""
    setup = Setup(cells=(30, 12), h=0.02, regions={"film": hydrostatic(
        (0, 0), (0.4, 0.02), velocity=(0.5, 0, 0))})
    case = ran(setup.until(1, write=0.05), tmp_path, figures)
    figures.atMost("highest point over u^2/2g + depth", case.points().x[
        :, 1].max()/(0.5**2/(2*9.81) + 0.02), 2)


def testThinFilmOfHalfACell(tmp_path, figures):
    setup = Setup(cells=(30, 12), h=0.02, points=4, regions={
        "film": hydrostatic((0, 0), (0.4, 0.01), velocity=(0.5, 0, 0))})
    ran(setup.until(1, write=0.05), tmp_path, figures)


def testFreePoints(tmp_path, figures):
    """Single points, several cells apart, fall on a floor"""
    regions = {}
    for k, (x, y) in enumerate([(0.05, 0.31), (0.15, 0.23), (0.27, 0.37),
                                (0.35, 0.11)]):
        # With two points per direction they sit at 0.25 and 0.75 of a cell
        i, j = int(x/0.02), int(y/0.02)
        centre = np.array([(i + 0.25)*0.02, (j + 0.25)*0.02])
        regions[f"p{k}"] = box(centre - 1e-3, centre + 1e-3)
    setup = Setup(cells=(20, 20), h=0.02, points=2, regions=regions,
                  fluid={"soundSpeed": 25})
    # Not longer: a single point that rests on a floor keeps an oscillation of
    # its volume that grows from about 0.7 s on (README, known limits)
    case = ran(setup.until(0.5, write=0.02), tmp_path, figures)
    figures.equal("points", len(case.points().id), 4)
    # They fall freely before the first one lands
    start, later = case.points("0"), case.points("0.1")
    fall = start.x[:, 1] - later.x[:, 1]
    figures.atMost("path of the highest: error over g t^2/2", float(np.abs(
        fall[start.x[:, 1] > 0.2]/(0.5*9.81*0.1**2) - 1).max()), 0.02)
    end = case.points()
    figures.atMost("highest point at the end", end.x[:, 1].max(), 0.02)


@pytest.mark.parametrize("dim, points", [(2, 1), (2, 4), (3, 1), (3, 3)])
def testPointsPerCell(tmp_path, figures, dim, points):
    """One point per cell, and 16 (27)"""
    setup = damBreak(dim, h=0.02 if dim == 2 else 0.05, points=points)
    ran(setup.until(0.8, write=0.05), tmp_path, figures)


def testManyPointsPerCell(tmp_path, figures):
    setup = damBreak(h=0.05, points=10)
    ran(setup.until(0.4, write=0.05), tmp_path, figures)


@pytest.mark.parametrize("dim", [2, 3])
def testImpactOnStep(tmp_path, figures, dim):
    """Against the face of a step, over its edge and against the wall"""
    setup = damBreak(dim, h=0.02 if dim == 2 else 0.025, height=0.3,
                     points=3 if dim == 2 else 2)
    step = (12, 3) if dim == 2 else (10, 3)
    lower = (step[0], 0) if dim == 2 else (step[0], 0, 0)
    upper = (step[0] + 5, step[1]) if dim == 2 else (
        step[0] + 4, setup.cells[1], step[1])
    setup.solid = [(lower, upper)]
    case = ran(setup.until(0.8 if dim == 2 else 0.5, write=0.04),
               tmp_path, figures)
    h = setup.spacing[0]
    end = case.points()
    figures.atLeast("points behind the step",
                    int(np.sum(end.x[:, 0] > upper[0]*h)), 1)


@pytest.mark.parametrize("wall", ["slip", "noSlip"])
def testImpactOnWall(tmp_path, figures, wall):
    """A block of water at 3 m/s against a wall, in a corner"""
    setup = Setup(cells=(20, 20), h=0.02, wall=wall, g=(0, 0, 0),
                  fluid={"soundSpeed": 40}, regions={
                      "block": box((0.2, 0.04), (0.36, 0.2),
                                   velocity=(3, -0.5, 0))})
    ran(setup.until(0.3, write=0.01), tmp_path, figures)


def testPointsOnFacesAndCorners(tmp_path, figures):
    """Points exactly on cell faces, cell corners, walls and in the corners
    of the mesh: the positions of a case, edited in ascii"""
    setup = Setup(cells=(20, 10), h=0.02, points=2,
                  control={"writeFormat": "ascii", "writePrecision": 17},
                  regions={"pool": hydrostatic((0, 0), (0.4, 0.08))})
    setup.until(0.5, write=0.05)
    case = setup.write(tmp_path/"case").prepare()
    start = case.points("0")
    grid = start.x.copy()
    # 0.25 and 0.75 of a cell to 0 and 0.5: faces, corners and wall
    grid[:, :2] -= 0.005
    top = (grid[:, 1] > 0.0745) & (grid[:, 1] < 0.0755)
    right = np.isclose(grid[:, 0], 0.39)
    grid[right, 0] = 0.4 - 1e-12
    grid[top, 1] = 0.08
    order = np.argsort(case.case.cloudField("0", "water", "id"),
                       kind="stable")
    x = np.empty_like(grid)
    x[order] = grid
    path = case.path/"0"/"lagrangian"/"water"/"x"
    path.write_text(header("x", "vectorField") + f"{len(x)}\n(\n" + "\n".join(
        "({:.17g} {:.17g} {:.17g})".format(*row) for row in x) + "\n)\n")
    on = np.isclose(x[:, :2]/0.02, np.round(x[:, :2]/0.02), atol=1e-9)
    figures.atLeast("points on a face", int(np.any(on, axis=1).sum()), 100)
    figures.atLeast("points on a corner", int(np.all(on, axis=1).sum()), 40)
    case.solve()
    # Shifted points start out of balance
    healthy(figures, case)


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


def testDroppedColumn(tmp_path, figures):
    """0.2 x 0.2 m of water dropped from 1 m: 4.4 m/s at the floor"""
    setup = Setup(cells=(40, 56), h=0.025, points=3, regions={
        "column": box((0.4, 1), (0.6, 1.2))})
    case = ran(setup.until(1, write=0.05), tmp_path, figures)
    c = case.state("0")["soundSpeed"]
    figures.atLeast("sound speed over 10 sqrt(2 g drop)",
                    c/(10*np.sqrt(2*9.81)), 0.98)
    before = case.points("0.4")
    figures.atMost("momentum before the impact: error over m g t", abs(
        before.momentum[1]/(-9.81*0.4*before.totalMass) - 1), 1e-6)


def testMostlyEmpty(tmp_path, figures):
    """Two small bodies far apart in a large mesh; one rests"""
    setup = Setup(cells=(120, 60), h=0.02, regions={
        "falls": box((0.2, 0.8), (0.26, 0.86)),
        "rests": hydrostatic((2.2, 0), (2.4, 0.04))})
    case = ran(setup.until(0.8, write=0.05), tmp_path, figures)
    # Cells without points cost nothing: compare with the tank alone
    figures.show("ns per point and step", case.log.nsPerPointStep)


@pytest.mark.parametrize("transfer", ["APIC", "FLIP"])
@pytest.mark.parametrize("dim", [2, 3])
def testLargeCourantNumber(tmp_path, figures, dim, transfer):
    """maxCo at 0.9 of the limit 0.7"""
    setup = damBreak(dim, h=0.02 if dim == 2 else 0.04,
                     points=3 if dim == 2 else 2, mpm={"maxCo": 0.63},
                     water={"transfer": transfer})
    case = ran(setup.until(1, write=0.05), tmp_path, figures)
    figures.atLeast("largest Courant number", case.log.courantMax, 0.62)


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
