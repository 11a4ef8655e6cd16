"""Openings: points leave through them and are counted, and the balance is
exact."""

import re

import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak, hydrostatic


def balance(figures, case, start="0"):
    """Inside and left make what there was, at each time"""
    first = case.points(start)
    total = first.totalMass
    wrongCount, worst = 0, 0.0
    for time in case.times:
        state = case.state(time)
        inside = case.points(time) if state["nPoints"] else None
        n = len(inside.id) if inside else 0
        m = inside.totalMass if inside else 0.0
        wrongCount += n + state["left"] != len(first.id)
        wrongCount += n != state["nPoints"]
        worst = max(worst, abs(m + state["leftMass"] - total)/total)
        if inside:
            assert set(inside.id) <= set(first.id)
            assert case.outside(inside) == 0
    figures.equal("times at which the count is wrong", wrongCount, 0)
    figures.atMost("mass inside + left: largest relative error", worst,
                   1e-13)
    return case.state()


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("kind", ["zeroGradient", "inletOutlet"])
@pytest.mark.parametrize("dim", [2, 3])
def testOutlet(tmp_path, figures, dim, kind, ranks):
    """A dam break that flows out at the end"""
    setup = damBreak(dim, h=0.02 if dim == 2 else 0.04,
                     points=3 if dim == 2 else 2)
    condition = {"type": kind}
    if kind == "inletOutlet":
        condition.update(inletValue="uniform (0 0 0)",
                         value="uniform (0 0 0)")
    setup.sides["xmax"] = ("patch", condition)
    setup.until(1, write=0.1)
    case = setup.write(tmp_path/"case").prepare()
    if ranks == 2:
        case.decompose(2)
    case.solve(ranks=ranks)
    state = balance(figures, case)
    figures.atLeast("points that left", state["left"], 100)
    logged = [int(n) for n in re.findall(
        r"left through openings (\d+)",
        (case.path/"log.mpmFoam").read_text())]
    figures.equal("last number in the log", logged[-1], int(state["left"]))
    figures.holds("numbers in the log never fall", logged == sorted(logged))
    # Slip floor, open end: most of it runs out
    figures.atMost("mass inside at 1 s over initial", 1 - state["leftMass"]
                   / case.points("0").totalMass, 0.5)


def flying(**entries):
    """A block that flies out of a box without walls"""
    setup = Setup(cells=(16, 12), h=0.02, g=(0, 0, 0), points=3,
                  fluid={"soundSpeed": 20}, wall="zeroGradient",
                  regions={"block": box((0.1, 0.1), (0.2, 0.18),
                                        velocity=(2, 1, 0))}, **entries)
    return setup


@pytest.mark.parametrize("ranks", [1, 2])
def testAllLeave(tmp_path, figures, ranks):
    """The run goes on without points, to its end, and from there"""
    setup = flying().until(0.4, write=0.05)
    case = setup.write(tmp_path/"case").prepare()
    if ranks == 2:
        case.decompose(2)
    case.solve(ranks=ranks)
    state = balance(figures, case)
    figures.equal("points left", int(state["left"]),
                  len(case.points("0").id))
    figures.equal("points inside", int(state["nPoints"]), 0)
    figures.equal("last time", float(case.times[-1]), 0.4)
    figures.holds("log has End", case.log.finished)

    case.change(control={"endTime": 0.5})
    result = case.solve(ranks=ranks, check=False)
    figures.equal("a restart without points: exit status", result.status, 0)
    if result.status == 0:
        figures.equal("last time", float(case.times[-1]), 0.5)
        figures.equal("points left, kept", int(case.state()["left"]),
                      int(state["left"]))


def testFreeFlight(tmp_path, figures):
    """An open side does nothing to what leaves through it: momentum inside
    and carried out by points of undisturbed speed"""
    setup = flying(mpm={"volumeCorrection": False})
    case = setup.until(0.08, write=0.01).write(tmp_path/"case").prepare()
    case.solve()
    balance(figures, case)
    end = case.points()
    figures.atLeast("points that left", case.state()["left"], 20)
    figures.atLeast("points inside", len(end.id), 20)
    speeds = np.abs(end.U[:, :2] - [2, 1]).max()
    figures.atMost("largest change of speed inside, m/s", speeds, 0.2)


def testCountersOverRestart(tmp_path, figures):
    """left and leftMass go on from where they were"""
    setup = damBreak()
    setup.sides["xmax"] = ("patch", "zeroGradient")
    case = setup.until(0.5, write=0.1).write(tmp_path/"case").prepare()
    case.solve()
    first = case.state()
    figures.atLeast("points that left in the first run", first["left"], 10)
    case.change(control={"endTime": 1})
    case.solve()
    second = balance(figures, case)
    figures.atLeast("points that left in both", second["left"],
                    first["left"] + 10)


def testBlockedAndOpened(tmp_path, figures):
    """A slip wall, and an opening after a restart"""
    setup = damBreak()
    setup.sides["xmax"] = ("wall", "slip")
    case = setup.until(0.5, write=0.1).write(tmp_path/"case").prepare()
    case.solve()
    figures.equal("points left while it is closed",
                  int(case.state()["left"]), 0)
    path = case.path/case.times[-1]/"U.water"
    data = path.read_bytes()
    at = data.index(b"xmax")
    path.write_bytes(data[:at] + data[at:].replace(b"slip", b"zeroGradient",
                                                   1))
    case.change(control={"endTime": 1})
    case.solve()
    state = balance(figures, case)
    figures.atLeast("points left once it is open", state["left"], 100)


def testOpenTop(tmp_path, figures):
    """A jet up a wall leaves through an open top, not through the walls"""
    setup = Setup(cells=(20, 10), h=0.02, points=3, regions={
        "column": hydrostatic((0, 0), (0.1, 0.18), velocity=(0, 0, 0)),
        "jet": box((0.3, 0.06), (0.4, 0.12), velocity=(0.5, 3, 0))})
    setup.sides["ymax"] = ("patch", "zeroGradient")
    case = setup.until(0.3, write=0.05).write(tmp_path/"case").prepare()
    case.solve()
    state = balance(figures, case)
    figures.atLeast("points that left through the top", state["left"], 20)


def testEmptyRestartIsNotNoPoints(tmp_path, figures):
    """Without a state that says that all have left, no points is an error"""
    case = damBreak().steps(5).write(tmp_path/"case").prepare()
    for path in (case.path/"0"/"lagrangian"/"water").iterdir():
        path.unlink()
    result = case.solve(check=False)
    figures.equal("exit status", result.status, 1)
    found = re.search(r"0/lagrangian/water.*", result.text)
    figures.contains("message names the directory", found and found[0],
                     "0/lagrangian/water")
