"""Every combination of transfer scheme, shape function and dimension runs."""

import re

import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak
from checks import healthy

TRANSFERS = ["APIC", "FLIP", "PIC", "XPIC"]
SHAPES = ["linear", "quadraticBSpline", "cubicBSpline"]


def fallen(figures, case, least):
    """The water has begun to move as water does"""
    start, end = case.points("0"), case.points()
    dim = case.setup.dim
    up = dim - 1
    time = case.timeValue(case.times[-1])
    drop = start.centre[up] - end.centre[up]
    figures.atLeast("centre of mass: drop over g t^2/2",
                    drop/(0.5*9.81*time**2), least)
    figures.atMost("centre of mass: drop over g t^2/2",
                   drop/(0.5*9.81*time**2), 1)
    # Nothing in a dam break is faster than 2 sqrt(g H), sound apart
    fastest = np.linalg.norm(end.U, axis=1).max()
    figures.atMost("largest speed over 2 sqrt(g H)",
                   fastest/(2*np.sqrt(9.81*0.2)), 1)


# APIC with linear is refused (test_badInput): it blows up at free surfaces
@pytest.mark.parametrize("transfer, shape", [
    (transfer, shape) for transfer in TRANSFERS for shape in SHAPES
    if (transfer, shape) != ("APIC", "linear")])
@pytest.mark.parametrize("dim", [2, 3])
def testSchemes(tmp_path, figures, dim, transfer, shape):
    setup = damBreak(dim, h=0.02 if dim == 2 else 0.025,
                     points=3 if dim == 2 else 2,
                     water={"transfer": transfer},
                     mpm={"shapeFunction": shape})
    if dim == 3:
        setup.cells = (20, 8, 16)
    case = setup.steps(50 if dim == 3 else 200).write(tmp_path/"case")
    case.prepare().solve()
    text = (case.path/"log.mpmFoam").read_text()
    figures.holds("log names the scheme", f"on   {transfer}" in text)
    figures.holds("log names the shape function", shape in text)
    healthy(figures, case)
    fallen(figures, case, 0.1)


@pytest.mark.parametrize("transfer", TRANSFERS)
@pytest.mark.parametrize("off", [
    ["smoothing"], ["volumeCorrection"], ["smoothing", "volumeCorrection"]],
    ids="+".join)
def testEffectsOff(tmp_path, figures, transfer, off):
    setup = damBreak(water={"transfer": transfer},
                     mpm={key: False for key in off})
    case = setup.steps(200).write(tmp_path/"case").prepare()
    case.solve()
    text = (case.path/"log.mpmFoam").read_text()
    for key in off:
        effect = {"smoothing": "pressure smoothing",
                  "volumeCorrection": "volume correction"}[key]
        line = next(x for x in text.splitlines()
                    if x.strip().startswith(effect))
        figures.holds("table of effects", line.split()[2] == "off",
                      " ".join(line.split()))
    if "smoothing" in off:
        # An effect that is off has no arrays
        figures.equal("field gradJ is written", (
            case.path/case.times[-1]/"lagrangian"/"water"/"gradJ").exists(),
            False)
    healthy(figures, case)
    fallen(figures, case, 0.1)


@pytest.mark.parametrize("viscosity", [0, 1e-3, 1000])
def testViscosity(tmp_path, figures, viscosity):
    """No viscous effect at mu = 0, and a time step that a viscous liquid
    allows"""
    setup = damBreak(fluid={"mu": viscosity}, wall="noSlip")
    case = setup.steps(100).write(tmp_path/"case").prepare()
    case.solve()
    text = (case.path/"log.mpmFoam").read_text()
    line = next(x for x in text.splitlines() if "viscous stress" in x)
    figures.equal("viscous stress in the table of effects",
                  line.split()[2], "on" if viscosity else "off")
    if viscosity == 1000:
        figures.equal("limiter", case.log.dtLimiter, "viscosity")
        limit = 0.02**2/(2*2*viscosity/1000)
        figures.atMost("time step over h^2/(2 dim nu)",
                       case.log.deltaTMax/limit, 1 + 1e-6)
    healthy(figures, case)


def movePoints(case, shift):
    """All points by a vector, in the binary file of their positions"""
    path = case.path/"0"/"lagrangian"/"water"/"x"
    data = path.read_bytes()
    found = re.compile(rb"\n(\d+)\s*\n?\(").search(
        data, data.index(b"// * *"))
    n, first = int(found[1]), found.end()
    x = np.frombuffer(data, "<f8", 3*n, first).reshape(n, 3) + shift
    path.write_bytes(data[:first] + x.tobytes() + data[first + 24*n:])


@pytest.mark.parametrize("transfer, shape", [
    (transfer, shape) for transfer in TRANSFERS for shape in SHAPES[:2]
    if (transfer, shape) != ("APIC", "linear")])
@pytest.mark.parametrize("shift", [(0.25, 0.25), (0.25, 0), (0.25 + 1e-9, 0)],
                         ids=["corners", "faces", "near faces"])
def testUniformMotion(tmp_path, figures, shift, transfer, shape):
    """A block that moves as one, with points exactly on faces and corners of
    cells: a node that no point gives mass has a velocity all the same"""
    velocity = (0.7, 0.3, 0)
    case = Setup(
        cells=(12, 10), h=1, points=2, g=(0, 0, 0), energy=False,
        regions={"block": box((2, 2), (6, 6), velocity=velocity)},
        fluid={"soundSpeed": 4}, water={"transfer": transfer},
        mpm={"shapeFunction": shape},
        control={"adjustTimeStep": False, "deltaT": 0.1}).cyclic(
            "x", "y").steps(60).write(tmp_path/"case").prepare()
    movePoints(case, np.array([*shift, 0]))
    start = case.points("0")
    figures.equal("points on faces", int(np.sum(
        np.abs(start.x[:, 0] - np.round(start.x[:, 0])) < 1e-8)), 32)
    case.solve()
    end = case.points()
    way = (end.x - start.x)[:, :2] - 6*np.array(velocity[:2])
    way -= np.round(way/[12, 10])*[12, 10]
    figures.atMost("place: largest error", np.abs(way).max(), 1e-12)
    figures.atMost("velocity: largest error",
                   np.abs(end.U - velocity).max(), 1e-12)
