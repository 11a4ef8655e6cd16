"""The log: what foamLog, and a user, reads in it."""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest

from caseBuilder import damBreak
from mpmfoam.runLog import costs


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    """A run that takes some seconds, each step in the log"""
    setup = damBreak(h=0.005, points=4, mpm={"logInterval": 1})
    setup.until(0.2, write=0.05)
    case = setup.write(tmp_path_factory.mktemp("log")/"case").prepare()
    case.solve()
    return case


def extracted(case, name):
    """Second column of what foamLog wrote"""
    rows = [line.split() for line in
            (case.path/"logs"/name).read_text().splitlines()]
    return np.array([row[1] for row in rows], dtype=float), \
        np.array([row[0] for row in rows], dtype=float)


def testFoamLog(run, figures):
    foamLog = Path(os.environ["WM_PROJECT_DIR"])/"bin"/"foamLog"
    result = subprocess.run(
        [str(foamLog), "log.mpmFoam"], cwd=run.path, capture_output=True,
        text=True, timeout=60)
    figures.equal("exit status", result.returncode, 0)
    text = (run.path/"log.mpmFoam").read_text()
    steps = run.log.stepCount
    for name, pattern in [
            ("Time_0", r"^Time = (\S+)"),
            ("CourantMax_0", r"^Courant Number.*max: (\S+)"),
            ("CourantMean_0", r"^Courant Number mean: (\S+)"),
            ("deltaT_0", r"^deltaT = (\S+)"),
            ("executionTime_0", r"^ExecutionTime = (\S+)")]:
        if not (run.path/"logs"/name).is_file():
            # foamLog itself knows no deltaT; ours is told by foamLog.db
            figures.holds(f"{name} is extracted", False)
            continue
        values, times = extracted(run, name)
        expected = [float(v) for v in re.findall(pattern, text, re.MULTILINE)]
        figures.equal(f"{name}: values, one per step", len(values), steps)
        figures.atMost(f"{name}: difference to the log", float(np.abs(
            values - expected[:len(values)]).max()), 0)
    times = extracted(run, "Time_0")[0]
    figures.equal("times rise", bool(np.all(np.diff(times) > 0)), True)
    figures.atMost("largest Courant number", extracted(
        run, "CourantMax_0")[0].max(), 0.6)


@pytest.mark.parametrize("ranks", [1, 2])
def testCostTable(run, tmp_path, figures, ranks):
    case = run
    if ranks == 2:
        setup = damBreak(h=0.005, points=4).until(0.1)
        case = setup.write(tmp_path/"case").prepare()
        case.decompose(2)
        case.solve(ranks=2)
    text = (case.path/"log.mpmFoam").read_text()
    rows = costs(text)
    total = rows.pop("total")
    figures.show("parts", len(rows))
    for part in ["particle-to-grid", "grid-to-particle", "stress and forces"]:
        figures.holds(f"part water: {part}", f"water: {part}" in rows)
    share = sum(row[1] for row in rows.values())
    figures.atMost("parts: sum of % of run, distance to 100",
                   abs(share - 100), 3)
    # Seconds are given in hundredths
    figures.atMost("parts: sum of seconds over total, distance to 1",
                   abs(sum(row[0] for row in rows.values())/total[0] - 1),
                   0.03 + 0.005*len(rows)/total[0])
    figures.equal("total %", total[1], 100)
    steps, points, ns = (float(v) for v in re.search(
        r"Steps: (\d+)  points: (\d+)  ns per point and step: (\S+)",
        text).groups())
    figures.atMost("ns x points x steps over CPU time of all ranks, distance "
                   "to 1", abs(ns*1e-9*points*steps/(ranks*total[0]) - 1),
                   0.03)
    if ranks == 1:
        figures.atMost("share of what has no name, %", rows["other"][1], 10)
    else:
        # Ranks wait for each other there
        figures.show("share of what has no name, %", rows["other"][1])


def testEffects(run, figures):
    """The opening table has on or off, and why, for each effect"""
    text = (run.path/"log.mpmFoam").read_text()
    table = text[text.index("\nEffects\n"):text.index("\nMemory\n")]
    for effect in ["transfer", "viscous stress", "pressure smoothing",
                   "volume correction", "tension cut-off", "coupling",
                   "time step"]:
        row = re.search(rf"^ +{effect} +(\S+) +(\S.*)$", table, re.MULTILINE)
        figures.holds(f"row {effect}", row, row and row[0].strip())
    figures.holds("number of points in the table", "25600 points" in table)
    memory = float(re.search(r"(\S+) bytes per point", text)[1])
    figures.atMost("bytes per point (spec 12)", memory, 200)


@pytest.mark.parametrize("interval", [1, 7, 100])
def testLogInterval(tmp_path, figures, interval):
    """One entry each so many steps, and at write times; the same result"""
    setup = damBreak(mpm={"logInterval": interval}).steps(50)
    case = setup.write(tmp_path/"case").prepare()
    case.solve()
    text = (case.path/"log.mpmFoam").read_text()
    entries = len(re.findall(r"^Time = ", text, re.MULTILINE))
    expected = len({k for k in range(interval, 51, interval)} | {50})
    figures.equal("entries of the log for 50 steps", entries, expected)
    figures.equal("steps in the closing line", case.log.stepCount, 50)


def testLimiterIsNamed(tmp_path, figures):
    """The log says what limits the time step"""
    for name, setup in [
            ("water sound", damBreak()),
            ("viscosity", damBreak(fluid={"mu": 1000})),
            ("maxDeltaT", damBreak(control={"maxDeltaT": 1e-5})),
            ("deltaT", damBreak(control={"adjustTimeStep": False,
                                         "deltaT": 1e-4}))]:
        case = setup.steps(10).write(tmp_path/name.replace(" ", "")).prepare()
        case.solve()
        figures.equal("limiter", case.log.dtLimiter, name)
        if name == "maxDeltaT":
            figures.atMost("time step over maxDeltaT",
                           case.log.deltaTMax/1e-5, 1 + 1e-6)
