"""Mass, momentum, energy, volume."""

import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak, hydrostatic
from checks import healthy, meanLevel


@pytest.mark.parametrize("dim", [2, 3])
def testDamBreak(tmp_path, figures, dim):
    """To the impact on the far wall and beyond"""
    setup = damBreak(dim, h=0.02 if dim == 2 else 0.025,
                     points=4 if dim == 2 else 2)
    setup.until(1 if dim == 2 else 0.6, write=0.02)
    case = setup.write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)
    figures.equal("mass: change", case.points().totalMass
                  - case.points("0").totalMass, 0)


def testEnergyOfTheTutorial(tmp_path, figures):
    """Issue 2, 4: kinetic + potential at 0.3 s; at h 0.005"""
    setup = Setup(cells=(80, 60), h=0.005, points=4, regions={
        "column": hydrostatic((0, 0), (0.1, 0.2))})
    case = setup.until(0.3, write=0.05).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)
    figures.atLeast("kinetic + potential at 0.3 s over initial", sum(
        case.mechanicalEnergy())/sum(case.mechanicalEnergy("0")), 0.97)


def cyclicBox(dim, transfer, full, **entries):
    """Streams of different velocity in a box that is cyclic all round"""
    cells = (16, 12) if dim == 2 else (10, 8, 8)
    low, mid, top = (0,)*dim, cells[0]*0.01, np.array(cells)*0.02
    regions = {
        "slow": box(low, (mid, *top[1:]), velocity=(0.3, 0.1, 0)),
        "fast": box((mid, *low[1:]), tuple(top), velocity=(-0.2, 0.4, 0))}
    if not full:
        regions["fast"] = box(
            (mid + 0.04, *low[1:]), (top[0] - 0.04, *(top[1:] - 0.04)),
            velocity=(-1, 0.7, 0))
    if dim == 3:
        regions["fast"]["velocity"] = (-0.4, 0.5, 0.6)
    setup = Setup(cells=cells, h=0.02, g=(0, 0, 0), regions=regions,
                  points=3 if dim == 2 else 2,
                  placement={"placement": "jittered"},
                  fluid={"soundSpeed": 15}, water={"transfer": transfer},
                  **entries)
    return setup.cyclic(*"xyz"[:dim])


@pytest.mark.parametrize("full", [True, False], ids=["full", "surface"])
@pytest.mark.parametrize("transfer", ["APIC", "FLIP", "PIC", "XPIC"])
@pytest.mark.parametrize("dim", [2, 3])
def testMomentum(tmp_path, figures, dim, transfer, full):
    """No wall and no gravity: nothing changes the momentum"""
    setup = cyclicBox(dim, transfer, full)
    case = setup.steps(300 if dim == 2 else 100).write(tmp_path/"case")
    case.prepare().solve()
    healthy(figures, case)
    start, end = case.points("0"), case.points()
    moved = np.abs(end.U - start.U).max()/np.abs(start.U).max()
    figures.atLeast("largest change of a point's velocity, relative",
                    moved, 0.05)
    scale = (start.mass*np.linalg.norm(start.U, axis=1)).sum()
    figures.atMost("momentum: change over sum of m |U|",
                   np.abs(end.momentum - start.momentum).max()/scale, 1e-12)


@pytest.mark.parametrize("shape, transfer", [
    ("linear", "FLIP"), ("cubicBSpline", "APIC")])
def testMomentumOfOtherShapes(tmp_path, figures, shape, transfer):
    """A block that passes another and crosses the cyclic ends"""
    setup = cyclicBox(2, transfer, False, mpm={"shapeFunction": shape})
    case = setup.steps(300).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)
    start, end = case.points("0"), case.points()
    scale = (start.mass*np.linalg.norm(start.U, axis=1)).sum()
    figures.atMost("momentum: change over sum of m |U|",
                   np.abs(end.momentum - start.momentum).max()/scale, 1e-12)


def testFreeFall(tmp_path, figures):
    """Before it touches anything, a body falls as a body does"""
    setup = Setup(cells=(20, 20), h=0.02, fluid={"soundSpeed": 20},
                  regions={"body": box((0.1, 0.26), (0.2, 0.36))})
    case = setup.until(0.1).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)
    start, end = case.points("0"), case.points()
    fall = start.centre[1] - end.centre[1]
    time = case.timeValue(case.times[-1])
    figures.atMost("speed: error over g t", abs(
        end.momentum[1]/end.totalMass/(-9.81*time) - 1), 1e-10)
    # First order in time: half a step of the speed at the end
    figures.atMost("path: error over g t^2/2",
                   abs(fall/(0.5*9.81*time**2) - 1),
                   1.1*case.log.deltaTMax/time)
    figures.atMost("sideways over fall",
                   abs(end.centre[0] - start.centre[0])/fall, 1e-10)


def sloshing(tmp_path, steps, writes):
    """A tank of 0.5 x 0.25 m with a surface that starts as a step"""
    setup = Setup(cells=(20, 16), h=0.025, points=3, regions={
        "left": hydrostatic((0, 0), (0.25, 0.275)),
        "right": hydrostatic((0.25, 0), (0.5, 0.225))})
    setup.endless(steps//writes)
    setup.control.update(stopAt="endTime")
    case = setup.write(tmp_path/"case").prepare()
    # Long enough for so many steps: c = 10 sqrt(g H)
    dt = 0.5*0.025/(10*np.sqrt(9.81*0.275))
    case.change(control={"endTime": float(f"{steps*dt:.6g}")})
    case.solve()
    return case


def levelKept(figures, case):
    times = case.times
    # The mean of some times: sound moves the level, too
    late = np.mean([meanLevel(case, t) for t in times[-5:]])
    figures.show("steps", case.log.stepCount)
    figures.show("mean level at the start", 0.25)
    figures.atMost("mean level: change over depth", abs(late/0.25 - 1), 3e-3)


def testSloshing(tmp_path, figures):
    case = sloshing(tmp_path, 2000, 40)
    healthy(figures, case)
    levelKept(figures, case)


@pytest.mark.slow
def testSloshingLong(tmp_path, figures):
    case = sloshing(tmp_path, 100000, 50)
    healthy(figures, case)
    levelKept(figures, case)


def testLevelNeedsTheCorrection(tmp_path, figures):
    """The volume correction is what keeps the level: a dam break with FLIP,
    mean of 4 to 6 s"""
    loss = {}
    for correction in [True, False]:
        setup = damBreak(water={"transfer": "FLIP"},
                         mpm={"volumeCorrection": correction})
        case = setup.until(6, write=0.5).write(tmp_path/str(correction))
        case.prepare().solve()
        level = np.mean([meanLevel(case, t) for t in case.times[-5:]])
        loss[correction] = 1 - level/0.08
    figures.atLeast("loss of level without it", loss[False], 0.01)
    figures.atMost("loss of level with it", abs(loss[True]),
                   loss[False]/3)
