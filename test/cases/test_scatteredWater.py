"""Water that is thrown about: lone drops and films at walls, lids and
obstacles. Three of the many scenes of validation/stability/sweep.py, and the
smallest of them: one point at a wall."""

import numpy as np
import pytest

import scatteredWater
from caseBuilder import RHO, Setup, box
from scatteredWater import GROWTH, LEVEL, judge


@pytest.mark.parametrize("scene, points, seed, maxCo", [
    ("lid2D", 2, 4, 0.5), ("lid2D", 3, 1, 0.7), ("obstacle3D", 2, 1, 0.7),
    # Ran away at the edge of a film that hangs over a convex edge
    ("obstacle3D_16", 2, 9, 0.7), ("obstacle3D_16", 2, 24, 0.7)])
def testScene(tmp_path, figures, scene, points, seed, maxCo):
    setup = scatteredWater.made(scene, points, 0.5, seed, maxCo)
    row = judge(setup.write(tmp_path/"case"))
    figures.equal("why it does not hold", row["reason"], "")
    if row["growth"]:
        figures.atMost("growth of the energy over its initial value",
                       float(row["growth"]), GROWTH)
    if row["level"]:
        figures.atMost("error of the mean level",
                       abs(float(row["level"])), LEVEL)


def lonePoint(dim, y, maxCo, J=1.0, v=1.0, g=0.0):
    """One point that moves along a slip wall, y cells above it, periodic in
    x; of a box of half a cell"""
    h = 0.0144
    lower = [2*h] + [0.0]*(dim - 1)
    upper = [2.5*h] + [0.5*h]*(dim - 1)
    gravity = [0.0, 0.0, 0.0]
    gravity[dim - 1] = -g
    setup = Setup(
        cells=(6,)*dim, h=h, points=2, g=tuple(gravity),
        regions={"drop": box(lower, upper, velocity=(v, 0, 0))},
        fluid={"soundSpeed": 16.8}, mpm={"maxCo": maxCo},
        control={"writeFormat": "ascii", "writePrecision": 17})
    setup.cyclic("x")
    return setup.until(1.0, 0.25), (y*h, J)


def place(case, y, J):
    """The point moved, and compressed"""
    up = case.setup.dim - 1
    folder = case.path/"0"/"lagrangian"/"water"
    x = case.case.cloudField("0", "water", "x")
    assert len(x) == 1
    x[0, up] = y
    text = (folder/"x").read_text()
    body = "1\n(\n({:.17g} {:.17g} {:.17g})\n)\n".format(*x[0])
    (folder/"x").write_text(text[:text.index("}") + 2] + "\n" + body)
    text = (folder/"J").read_text()
    (folder/"J").write_text(
        text[:text.index("}") + 2] + f"\n1\n(\n{J:.17g}\n)\n")


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("y", [0.001, 0.25, 0.49])
@pytest.mark.parametrize("maxCo", [0.5, 0.7])
def testLonePointAtWall(tmp_path, figures, dim, y, maxCo):
    """It keeps its momentum along a slip wall, its volume returns to that of
    water at rest, and its energy never grows"""
    setup, (height, J) = lonePoint(dim, y, maxCo, J=1.01)
    case = setup.write(tmp_path/"case").prepare()
    place(case, height, J)
    case.solve()
    energies = case.energies()
    stored = energies["elastic"][0]
    total = energies["kinetic"] + energies["potential"] \
        + energies["stresswork"]
    # What its volume stores is not in it, and comes back
    figures.atMost("largest growth of the energy over its initial value",
                   float((total.max() - total[0])/(total[0] + stored)), GROWTH)
    end = case.points()
    figures.atMost("velocity along the wall: change",
                   abs(float(end.U[0, 0]) - 1), 1e-12)
    figures.atMost("volume ratio less one", abs(float(end.J[0]) - 1), 1e-3)
    figures.atMost("mass over density times volume, less one", abs(
        float(end.mass[0])/RHO/(0.5*0.0144)**case.setup.dim
        * (1 if case.setup.dim == 3 else 1/0.0144) - 1), 1e-9)
