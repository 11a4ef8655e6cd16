"""A value that is not finite ends the run: cell, point and limiter named, and
nothing restarts from what was written then."""

import re
import struct

import numpy as np
import pytest

from mpmfoam import foamFile

from caseBuilder import damBreak

NAN = struct.pack("<d", float("nan"))


def poison(path, row, components, component, value=NAN):
    """One number of a binary field, overwritten"""
    data = bytearray(path.read_bytes())
    start = data.index(b"\n(", data.index(b"// * *")) + 2
    at = start + 8*(row*components + component)
    data[at:at + 8] = value
    path.write_bytes(data)


def poisoned(tmp_path, field="U", components=3, value=NAN, ranks=1):
    """A run to its second write time, where one value is then not finite.
    Returns the case, that time, the point's id and what the field was"""
    case = damBreak().endless(20).write(tmp_path/"case").prepare()
    case.change(control={"endTime": 0.03})
    if ranks > 1:
        case.decompose(ranks, cellRank=case.case.cellCentres("0")[:, 0] > 0.1)
    case.solve(ranks=ranks)
    case.change(control={"endTime": 0.06})
    time = case.times[-1]
    root = case.path if ranks == 1 else case.path/"processor1"
    folder = root/time/"lagrangian"/"water"
    original = (folder/field).read_bytes()
    row = 100
    ids = type(case)(root, case.setup)
    point = int(foamFile.readList(folder/"id")[row])
    poison(folder/field, row, components, 1 % components, value)
    return case, time, point, folder/field, original


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("field, components", [
    ("U", 3), ("velocityGradient", 9), ("J", 1), ("gradJ", 3)])
def testNan(tmp_path, figures, field, components, ranks):
    """nan in a field of one point of a restart"""
    case, time, point, path, original = poisoned(
        tmp_path, field, components, ranks=ranks)
    result = case.solve(ranks=ranks, check=False)
    text = result.text[max(result.text.find("FOAM FATAL"), 0):]
    figures.equal("exit status", result.status, 1)
    figures.holds("a FatalError", "FOAM FATAL" in result.text)
    expected = {"cloud": "cloud water", "point": r"point \d+"}
    if "at the start" in text or "must be positive" in text:
        # Refused before a step was taken: there is no limiter yet
        expected["file"] = rf"{time}/lagrangian/water"
        expected["value"] = r"\bnan\b"
    else:
        expected.update(
            cell=r"cell \d+", limiter=r"limiter: \w[\w ]*")
    for what, pattern in expected.items():
        found = re.search(pattern, text)
        figures.contains(f"message names the {what}", found and found[0],
                         pattern)

    found = re.search(r"cell (\d+)", text)
    if found and ranks == 1:
        # Within the step nan spreads to nodes, points, nodes and points: to
        # those nearest to the fourth node away, 5 cells from the point, and
        # half a cell to the centre of theirs
        place = case.case.cellCentres("0")[int(found[1])]
        there = case.points("0")
        before = there.x[there.id == point][0]
        figures.atMost("named cell: distance to the point in cells", float(
            np.abs((place - before)[:2]).max()/0.02), 5.5)

    # The value was wrong in `time`; with it right again, the run starts
    # there and not from what was written when it stopped
    path.write_bytes(original)
    case.solve(ranks=ranks)
    log = (case.path/"log.mpmFoam").read_text()
    figures.holds("the run starts again",
                  float(case.times[-1]) > float(time), case.times[-1])
    bad = [t for t in case.times if float(t) > float(time) and not all(
        np.all(np.isfinite(case.case.cloudField(t, "water", f)))
        for f in ["x", "U", "J"])]
    figures.equal("times with values that are not finite", bad, [])
    if "written" in text:
        figures.holds("what was written then is set aside",
                      "is incomplete" in log)


def testStateForInspection(tmp_path, figures):
    """What is written when it stops can be looked at, and says that it is no
    start"""
    case, time, point, _, _ = poisoned(tmp_path)
    before = set(case.times)
    case.solve(check=False)
    new = set(case.times) - before
    figures.equal("times written", len(new), 1)
    last = new.pop()
    U = case.case.cloudField(last, "water", "U")
    figures.atLeast("values of U that are not finite",
                    int(np.sum(~np.isfinite(U))), 1)
    figures.holds("without the state file", not (
        case.path/last/"uniform"/"materialPoints").exists())


def testNanInAscii(tmp_path, figures):
    """The word nan in an ascii file: refused, with the file named, or the run
    stops"""
    setup = damBreak(control={"writeFormat": "ascii"}).steps(10)
    case = setup.write(tmp_path/"case").prepare()
    path = case.path/"0"/"lagrangian"/"water"/"U"
    text = path.read_text()
    if "{" in text[text.index("// * *"):]:
        # A uniform list
        text = re.sub(r"(\d+)\{\(0 0 0\)\}",
                      lambda m: m[1] + "(" + "(0 0 0)"*int(m[1]) + ")", text)
    head, body = text[:text.index("// * *")], text[text.index("// * *"):]
    path.write_text(head + body.replace("(0 0 0)", "(0 nan 0)", 1))
    result = case.solve(check=False)
    figures.equal("exit status", result.status, 1)
    found = re.search(r"0/lagrangian/water(/U)?|point \d+", result.text)
    figures.contains("message names file or point", found and found[0],
                     "0/lagrangian/water or point")


@pytest.mark.parametrize("speed", [1e3, 1e8, 1e30, 1e200])
def testAbsurdSpeed(tmp_path, figures, speed):
    """One point that is far too fast: a message or a smaller time step, and
    never an endless run or nan"""
    case, time, point, _, _ = poisoned(
        tmp_path, value=struct.pack("<d", speed))
    case.change(control={"endTime": float(time) + 2e-5})
    process = case.start()
    status = case.waitForEnd(process, 20)
    text = (case.path/"log.mpmFoam").read_text()
    figures.holds("it ends by itself", status is not None, status)
    figures.equal("nan in the log", len(re.findall(r"\bnan\b", text)), 0)
    if status:
        figures.holds("a FatalError", "FOAM FATAL" in text)
    else:
        values = case.case.cloudField(case.times[-1], "water", "U")
        figures.equal("values that are not finite",
                      int(np.sum(~np.isfinite(values))), 0)
