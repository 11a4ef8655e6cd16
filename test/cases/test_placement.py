"""Where setMaterialPoints puts points: on the faces of regions, and outside of
the mesh."""

import re

import numpy as np
import pytest

from caseBuilder import Setup, box, hydrostatic
from test_badInput import refused, words


def placed(case):
    """The log of setMaterialPoints, and the points of each region"""
    case.run("blockMesh")
    text = case.run("setMaterialPoints").text
    return text, {name: int(n) for name, n in re.findall(
        r"region (\w+): (\d+) points", text)}


def testTouchingBoxes(tmp_path, figures):
    """Layers of soil whose common faces have a row of points on them: each
    point belongs to one of them, and the water has the pores of that one"""
    voidRatio = {"low": 0.8, "middle": 1.0, "high": 1.25}
    edges = [0, 0.025, 0.031, 0.053]
    case = Setup(
        cells=(3, 30), h=0.002, points=3, energy=False,
        regions={"all": hydrostatic((0, 0), (0.006, 0.06))},
        soilRegions={
            name: box((0, edges[i]), (0.006, edges[i + 1]), voidRatio=e)
            for i, (name, e) in enumerate(voidRatio.items())}).write(
        tmp_path/"case")
    _, n = placed(case)
    # Rows of points at (i + 1/2) h/3
    y = (np.arange(90) + 0.5)*0.002/3
    row = {name: 9*int(np.sum((y >= edges[i] - 1e-9) & (y < edges[i + 1] - 1e-9)))
           for i, name in enumerate(voidRatio)}
    figures.equal("points of the layers", {k: n[k] for k in row}, row)
    figures.equal("points on the faces 0.025 and 0.031", int(np.sum(
        np.abs(y[:, None] - edges[1:3]).min(axis=1) < 1e-9)), 2)

    e = case.case.cloudField("0", "soil", "voidRatio")
    ys = case.case.cloudField("0", "soil", "x")[:, 1]
    above = ys[np.isclose(e, voidRatio["middle"])]
    figures.equal("the face belongs to the layer above", (
        bool(abs(above.min() - 0.025) < 1e-9),
        bool(above.max() < 0.031 - 1e-4)), (True, True))

    # Grains and pores fill each place once
    points = case.points("0")
    V = points.mass*points.J/1000
    share = V/(0.002**3/9)
    expected = np.ones(len(V))
    for i, name in enumerate(voidRatio):
        inside = ((points.x[:, 1] >= edges[i] - 1e-9)
                  & (points.x[:, 1] < edges[i + 1] - 1e-9))
        expected[inside] = voidRatio[name]/(1 + voidRatio[name])
    figures.atMost("pores of the water points: error",
                   np.abs(share - expected).max(), 1e-9)


def testOverlapWithoutSoil(tmp_path, figures):
    """Two regions of soil may overlap where no point of theirs is; water there
    has the pores of one of them"""
    e, h = 0.8, 0.01
    setup = Setup(
        cells=(4, 4), h=h, points=4, energy=False,
        regions={"all": hydrostatic((0, 0), (4*h, 4*h))},
        soilRegions={"low": box((0, 0), (4*h, 2*h), voidRatio=e),
                     "high": box((0, 1.8*h), (4*h, 4*h), voidRatio=e)})
    case = setup.write(tmp_path/"case")
    # Two rows of soil, four of water
    path = case.path/"system"/"setMaterialPointsDict"
    head, tail = path.read_text().rsplit("pointsPerDirection 4", 1)
    path.write_text(head + "pointsPerDirection 2" + tail)
    _, n = placed(case)
    figures.equal("points of soil", (n["low"], n["high"]), (32, 32))
    points = case.points("0")
    share = points.mass*points.J/1000/(h*case.setup.spacing[2]*h/16)
    figures.atMost("pores of the water points: error",
                   np.abs(share - e/(1 + e)).max(), 1e-9)


@pytest.mark.parametrize("shape", ["box", "polygon", "cylinder"])
def testSameForEachFormat(tmp_path, figures, shape):
    """A region that ends on a column of points: the last bit of the mesh may
    not decide"""
    region = {
        "box": hydrostatic((0, 0), (0.1, 0.2)),
        "polygon": {"type": "polygon",
                    "points": "((0 0) (0.1 0) (0.1 0.2) (0 0.2))"},
        "cylinder": {"type": "cylinder", "point1": (0, 0.1, -1),
                     "point2": (0, 0.1, 1), "radius": 0.1}}[shape]
    found = {}
    for style in ["ascii", "binary"]:
        case = Setup(
            cells=(30, 30), h=0.008, points=3, energy=False,
            regions={"column": region},
            control={"writeFormat": style, "writePrecision": 6}).write(
                tmp_path/style)
        found[style] = placed(case)[1]["column"]
    figures.show("points", found)
    figures.equal("points, ascii and binary", found["ascii"], found["binary"])
    if shape != "cylinder":
        # The column at 0.1 is the first one that is outside
        figures.equal("points", found["binary"], 37*75)


SHAPES = {
    "sphere": ({"origin": (0.2, 0.21, 0.19), "radius": 0.15},
               4/3*np.pi*0.15**3),
    "cone": ({"point1": (0.2, 0.2, 0.05), "radius1": 0.15,
              "innerRadius1": 0, "point2": (0.2, 0.2, 0.35), "radius2": 0.05,
              "innerRadius2": 0},
             np.pi*0.3*(0.15**2 + 0.15*0.05 + 0.05**2)/3),
    "rotatedBox": ({"span": (0.2, 0.1, 0.1), "origin": (0.15, 0.1, 0.1),
                    "e1": (1, 1, 0), "e3": (0, 0, 1)}, 0.2*0.1*0.1)}


@pytest.mark.parametrize("shape", SHAPES)
def testShapesOfOpenFOAM(tmp_path, figures, shape):
    """Any closed surface of OpenFOAM is a region: its volume"""
    entries, volume = SHAPES[shape]
    case = Setup(
        cells=(20, 20, 20), h=0.02, points=3, energy=False,
        fluid={"soundSpeed": 10},
        regions={"drop": {"type": shape, **entries}}).write(tmp_path/"case")
    _, n = placed(case)
    figures.atMost("volume of the points over that of the shape: error",
                   abs(n["drop"]*(0.02/3)**3/volume - 1), 0.03)


@pytest.mark.parametrize("entries, expect", [
    ({"type": "plate", "origin": (0, 0, 0), "span": (0.1, 0.1, 0)},
     {"keyword": "type", "value": "plate", "allowed": "closed surface"}),
    ({"type": "ball"}, {"keyword": "type", "value": "ball",
                        "allowed": words("box", "cylinder", "polygon",
                                         "sphere")}),
    ({"type": "sphere", "origin": (0, 0, 0), "radius": -1},
     {"keyword": "radius", "value": "-1", "allowed": "0 < radius"}),
    ({"type": "sphere", "origin": (0, 0, 0), "radus": 1},
     {"keyword": "radus", "allowed": "radius"}),
    ({"type": "cone", "velocty": (0, 0, 0)},
     {"keyword": "velocty", "allowed": "velocity"}),
], ids=["plate", "unknown", "negative", "misspelt", "nearMiss"])
def testBadShapes(tmp_path, figures, entries, expect):
    case = Setup(cells=(4, 4, 4), h=0.02, points=2, energy=False,
                 regions={"drop": entries}).write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False),
            {"file": "setMaterialPointsDict", "region": "drop", **expect})


@pytest.mark.parametrize("lower, upper, says", [
    ((0, 0), (0.1, 0.1), None),
    ((0, 0, -1e3), (0.1, 0.1, 1e3), None),
    ((-0.1, 0), (0.1, 0.1), "about 50 %"),
    ((0.1, 0.1), (0.3, 0.3), "about 75 %"),
    ((0, 0), (0.1, 0.2001), "less than 1 %"),
    ((0.05, 0.05), (0.15, 0.15), "about 25 %")])
def testPartlyOutside(tmp_path, figures, lower, upper, says):
    """The log says how much of a region is where no cell is: outside of the
    mesh, or in a solid of it (from (0.1 0.1) to the upper corner)"""
    case = Setup(
        cells=(20, 20), h=0.01, points=2, energy=False,
        solid=[] if lower == (0.1, 0.1) else [((10, 10), (20, 20))],
        regions={"column": box(lower, upper)}, fluid={"soundSpeed": 10}).write(
            tmp_path/"case")
    text, _ = placed(case)
    line = next(x for x in text.splitlines() if "region column" in x)
    figures.show("log", line)
    if says:
        figures.holds("says how much", says in line
                      and "of its volume lies outside of the mesh" in line)
    else:
        figures.holds("says nothing", "outside" not in line)


def testPartlyOutsideParallel(tmp_path, figures):
    case = Setup(
        cells=(20, 20), h=0.01, points=2, energy=False,
        regions={"column": box((-0.1, 0), (0.1, 0.1))},
        fluid={"soundSpeed": 10}).write(tmp_path/"case")
    case.run("blockMesh")
    case.decompose(2)
    text = case.run("setMaterialPoints", ranks=2).text
    figures.holds("says how much", "about 50 % of its volume" in text)
