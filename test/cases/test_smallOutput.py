"""Output that stays small: lagrangianOutput of controlDict, and the points that
materialPointHDF5 writes. What is left out is left out, what is there is right, and
a restart needs all and says so."""

import json
import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from caseBuilder import Setup, box, hydrostatic
from test_badInput import CONTROL, refused, words
from test_materialPointHDF5 import history, read
from test_paraview import needsParaView

HERE = Path(__file__).resolve().parent
WITHIN = {"type": "box", "min": (0, 0, -1), "max": (0.1, 0.1, 1)}
PART = {"fields": "(U p)", "every": 3, "within": WITHIN}


def scene(**output):
    """Water that runs against a saturated bed"""
    setup = Setup(
        cells=(20, 10), h=0.02, points=2, energy=False,
        regions={"column": hydrostatic((0, 0), (0.12, 0.14)),
                 "pores": hydrostatic((0.2, 0), (0.4, 0.06))},
        soilRegions={"bed": box((0.2, 0), (0.4, 0.06), stress="geostatic")})
    if output:
        setup.control["lagrangianOutput"] = output
    return setup.until(0.05, write=0.01)


@pytest.fixture(scope="module")
def runs(tmp_path_factory):
    """With all, and with a part of the water but each 0.02 s"""
    cases = {}
    for name, output in [
            ("all", {}),
            ("part", {"restartInterval": 0.02,
                      "water": {**PART, "precision": "single"}})]:
        cases[name] = scene(**output).write(
            tmp_path_factory.mktemp("small")/name).prepare()
        cases[name].solve()
    return cases


def fields(case, time, cloud="water"):
    return {p.name for p in
            (case.path/time/"lagrangian"/cloud).iterdir()}


def testPart(runs, figures):
    """Which times hold what, and the same values as a run that writes all"""
    whole, part = runs["all"], runs["part"]
    everything = fields(whole, "0.01")
    for time in ["0.02", "0.04", "0.05"]:
        figures.equal(f"{time} s: all fields", fields(part, time), everything)
    for time in ["0.01", "0.03"]:
        figures.equal(f"{time} s: fields", fields(part, time),
                      {"positions", "id", "U", "p"})
        figures.equal(f"{time} s: of soil all", fields(part, time, "soil"),
                      fields(whole, time, "soil"))
        of = {f: whole.case.cloudField(time, "water", f)
              for f in ("id", "x", "U", "p")}
        chosen = (of["id"] % 3 == 0) & (of["x"][:, 0] < 0.1) \
            & (of["x"][:, 1] < 0.1)
        found = {f: part.case.cloudField(time, "water", f)
                 for f in ("id", "U", "p")}
        figures.equal(f"{time} s: ids", found["id"].tolist(),
                      of["id"][chosen].tolist())
        for f in ("U", "p"):
            figures.equal(f"{time} s: bytes of a number in {f}",
                          found[f].dtype.itemsize, 4)
            figures.equal(f"{time} s: {f}", np.array_equal(
                found[f], of[f][chosen].astype("f4")), True)


def testRestart(runs, tmp_path, figures):
    """Not from a part, by name; from all as if nothing had been left out"""
    case = runs["part"].clone(tmp_path/"case")
    case.change(control={"startFrom": "startTime", "startTime": 0.03})
    refused(figures, case.solve(check=False), {
        "file": r"uniform/materialPoints",
        "entries": r"lagrangianOutput in controlDict: .*fields",
        "time that has all": r"startTime 0\.02"})

    case.change(control={"startTime": 0.02})
    case.solve()
    for cloud in ["water", "soil"]:
        for f in sorted(fields(runs["all"], "0.05", cloud)
                        - {"positions", "coordinates"}):
            figures.equal(f"{cloud}: {f}", np.array_equal(
                case.case.cloudField("0.05", cloud, f),
                runs["all"].case.cloudField("0.05", cloud, f)), True)


def testStopped(tmp_path, figures):
    """A run that is told to stop writes all"""
    setup = scene(water=PART)
    setup.control.update(stopAt="writeNow")
    case = setup.write(tmp_path/"case").prepare()
    case.solve()
    last = case.times[-1]
    figures.holds("all fields", "velocityGradient" in fields(case, last))


def testRanks(runs, tmp_path, figures):
    """The same points on two ranks, and taken together"""
    case = scene(water=PART).write(tmp_path/"case").prepare()
    case.decompose(2)
    case.solve(ranks=2)
    case.run("reconstructPar")
    whole = runs["all"].case
    for time in ["0.01", "0.04"]:
        ids = whole.cloudField(time, "water", "id")
        x = whole.cloudField(time, "water", "x")
        chosen = ids[(ids % 3 == 0) & (x[:, 0] < 0.1) & (x[:, 1] < 0.1)]
        found = case.case.cloudField(time, "water", "id")
        figures.equal(f"{time} s: ids", sorted(found.tolist()),
                      sorted(chosen.tolist()))
        figures.equal(f"{time} s: fields", fields(case, time)
                      - {"coordinates"}, {"positions", "id", "U", "p"})


@needsParaView
def testParaView(runs, figures):
    """It reads numbers of 4 bytes beside positions of 8"""
    case = runs["part"]
    result = subprocess.run(
        [os.environ["MPMFOAM_DIR"] + "/etc/pvpythonOffscreen",
         str(HERE/"countPoints.py"), str(case.path)],
        capture_output=True, text=True, timeout=300)
    assert result.returncode == 0, result.stdout + result.stderr
    found = json.loads(result.stdout.splitlines()[-1])
    for time in ["0.01", "0.03"]:
        U = case.case.cloudField(time, "water", "U")
        at = found[str(case.path)][time]
        figures.equal(f"{time} s: points", at["points"], len(U))
        figures.equal(f"{time} s: values", at["values"], len(U))
        figures.atMost(f"{time} s: mean of U, difference", float(np.abs(
            np.array(at["U"]) - U.astype(float).mean(axis=0)).max()), 1e-6)


def testHDF5(tmp_path, figures):
    """every and within; as many as there are at each time"""
    setup = scene()
    setup.functions = {"water": history(every=2, within=WITHIN,
                                        fields="(U)")}
    case = setup.write(tmp_path/"case").prepare()
    case.solve()
    for (_, _, found), time in zip(read(case), case.times):
        ids = case.case.cloudField(time, "water", "id")
        x = case.case.cloudField(time, "water", "x")
        U = case.case.cloudField(time, "water", "U")
        order = np.argsort(ids)
        ids, x, U = ids[order], x[order], U[order]
        chosen = (ids % 2 == 0) & (x[:, 0] < 0.1) & (x[:, 1] < 0.1)
        figures.equal(f"{time} s: ids", found["id"].tolist(),
                      ids[chosen].astype(int).tolist())
        figures.equal(f"{time} s: U", np.array_equal(
            found["U"], U[chosen]), True)


@pytest.mark.parametrize("output, control, expect", [
    ({"water": {"fields": "(U q)"}}, {},
     {"field": r"fields: q is no field", "allowed": words("U", "p", "mass")}),
    ({"wine": {"fields": "(U)"}}, {}, {"keyword": "wine"}),
    ({"water": {"every": 0}}, {}, {"keyword": "every", "allowed": "1"}),
    ({"water": {"precision": "half"}}, {},
     {"value": "half", "allowed": words("double", "single")}),
    ({"restartInterval": 0, "water": {"every": 2}}, {},
     {"keyword": "restartInterval"}),
    ({"water": {"every": 2}}, {"purgeWrite": 2},
     {"keyword": "purgeWrite is 2", "allowed": "purgeWrite 0"}),
    ({"water": {"evry": 2}}, {}, {"keyword": "evry"})],
    ids=["field", "cloud", "every", "precision", "interval", "purge", "typo"])
def testRefused(tmp_path, figures, output, control, expect):
    setup = scene(**output)
    setup.control.update(control)
    case = setup.write(tmp_path/"case").prepare()
    refused(figures, case.solve(check=False), {"file": CONTROL, **expect})


def testSingleIsNotCollated(tmp_path, figures, monkeypatch):
    """Files of all ranks in one have all digits"""
    case = scene(water={"precision": "single"}).write(tmp_path/"case")
    case.prepare()
    monkeypatch.setenv("FOAM_FILEHANDLER", "collated")
    text = case.solve(check=False).text
    figures.contains("refused", re.search(
        r"precision is single.*collated.*\n\s*Allowed: double", text),
        "precision, collated, double")
