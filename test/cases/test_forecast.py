"""The forecast of setMaterialPoints, and what remains in the log of mpmFoam."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from caseBuilder import Setup, damBreak, hydrostatic

ROOT = Path(__file__).resolve().parents[2]


def forecast(path):
    """The lines by their names"""
    text = (path/"log.setMaterialPoints").read_text()
    text = text[text.index("\nForecast of mpmFoam"):text.index("\nEnd\n")]
    return dict(re.findall(r"^    (\S[^:\n]*): +(\S.*)$", text,
                           re.MULTILINE)), text


def number(line, pattern):
    return float(re.search(pattern, line)[1])


def prepared(setup, path):
    """With its forecast, which prepare() does without"""
    case = setup.write(path)
    case.run("blockMesh")
    case.run("setMaterialPoints")
    return case


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    setup = damBreak(h=0.01, points=3, mpm={"logInterval": 5})
    setup.until(0.3, write=0.05)
    case = prepared(setup, tmp_path_factory.mktemp("forecast")/"case")
    case.solve()
    return case


def testForecast(run, figures):
    """Steps and output against what the run made; the time is of this
    machine"""
    found, text = forecast(run.path)
    steps = number(found["steps"], r"([\d.e+]+)")
    figures.atMost("steps: forecast over truth",
                   steps/run.log.stepCount, 1.5)
    figures.atLeast("steps: forecast over truth",
                    steps/run.log.stepCount, 1/1.5)
    figures.contains("time step: limiter", found["time step"], "water sound")
    times, each = re.search(r"(\d+) times of (\S+) MB",
                            found["output"]).groups()
    figures.equal("times that are written", int(times), 6)
    size = sum(p.stat().st_size for p in (run.path/"0.3").rglob("*")
               if p.is_file())
    figures.atMost("bytes of a time: forecast over truth, distance to 1",
                   abs(float(each)*1e6/size - 1), 0.1)
    figures.contains("points", found["points"],
                     f"water {len(run.points().x)}")
    figures.holds("memory", float(re.search(
        r"(\S+) MB", found["memory"])[1]) > 10, found["memory"])
    for what in ["maxCo 0.7", "water pointsPerDirection 2", "soundSpeed",
                 "cells twice as large"]:
        figures.holds(f"cheaper: {what}", re.search(
            rf"^ +{what}.*: 0\.\d+ of the time; \S", text, re.MULTILINE))


def testRemains(run, figures):
    """What remains falls to nothing, and with what is done makes the whole"""
    text = (run.path/"log.mpmFoam").read_text()
    entries = re.findall(
        r"^Time = (\S+)\n.*?^Remaining = (\S+) s  on the clock = (\S+) s.*?"
        r"^ExecutionTime = (\S+) s", text, re.MULTILINE | re.DOTALL)
    entries = np.array(entries, dtype=float)
    figures.equal("entries of the log, but for the first",
                  len(entries) >= len(re.findall("^Time = ", text,
                                                 re.MULTILINE)) - 1, True)
    figures.equal("remains at the end", entries[-1, 1], 0)
    half = entries[np.abs(entries[:, 0] - 0.15).argmin()]
    # Others work on this machine, too
    ratio = (half[1] + half[3])/entries[-1, 3]
    figures.atMost("half way: done and remaining over the whole, factor",
                   max(ratio, 1/ratio), 2)
    rate = np.diff(entries[:, 1] + entries[:, 3])
    figures.holds("it is followed", np.isfinite(rate).all())


def testFoamLog(run, figures):
    case = run.path
    shutil.copy(ROOT/"etc"/"foamLog.db", case)
    foamLog = Path(os.environ["WM_PROJECT_DIR"])/"bin"/"foamLog"
    done = subprocess.run([str(foamLog), "log.mpmFoam"], cwd=case,
                          capture_output=True, text=True, timeout=60)
    figures.equal("exit status", done.returncode, 0)
    for name, pattern in [("remaining_0", r"^Remaining = (\S+) s"),
                          ("remainingClock_0", r"on the clock = (\S+) s")]:
        values = [float(line.split()[1]) for line in
                  (case/"logs"/name).read_text().splitlines()]
        expected = [float(v) for v in re.findall(
            pattern, (case/"log.mpmFoam").read_text(), re.MULTILINE)]
        figures.equal(f"{name}: values", values, expected)


def testNothingChanges(tmp_path, figures):
    """The steps that are tried leave no trace: all files as without"""
    files = {}
    for name, options in [("with", []), ("without", ["-noForecast"])]:
        case = damBreak(h=0.02).until(0.1).write(tmp_path/name)
        case.run("blockMesh")
        case.run("setMaterialPoints", *options)
        start = case.path/"0"
        files[name] = {
            str(p.relative_to(case.path)): p.read_bytes()
            for p in sorted(case.path.rglob("*"))
            if p.is_file() and not p.name.startswith("log.")}
        figures.holds("a start", start.is_dir())
    figures.equal("same files", sorted(files["with"]),
                  sorted(files["without"]))
    figures.equal("files that differ", [
        name for name in files["with"]
        if files["with"][name] != files["without"][name]], [])
    figures.holds("-noForecast says so", "No forecast" in (
        tmp_path/"without"/"log.setMaterialPoints").read_text())


def testRefused(tmp_path, figures):
    """What the solver will refuse is said, with its reason; points are set"""
    setup = damBreak(control={"adjustTimeStep": False, "deltaT": 0.01})
    case = prepared(setup.until(0.1), tmp_path/"case")
    _, text = forecast(case.path)
    figures.contains("reason", text, "mpmFoam refuses this case")
    figures.contains("entry", text, "keyword deltaT is 0.01")
    figures.holds("points are there",
                  (case.path/"0"/"lagrangian"/"water"/"x").is_file())


def testInflow(tmp_path, figures):
    """A channel that fills: points in the mean of the run"""
    case = tmp_path/"case"
    shutil.copytree(ROOT/"tutorials"/"waterInjection", case)
    shutil.copytree(case/"0.orig", case/"0", dirs_exist_ok=True)
    for command in ["blockMesh", "setMaterialPoints"]:
        done = subprocess.run([command], cwd=case, capture_output=True,
                              text=True, env={**os.environ, "PWD": str(case)})
        assert done.returncode == 0, done.stdout
        (case/f"log.{command}").write_text(done.stdout)
    found, _ = forecast(case)
    mean = number(found["points"], r"about ([\d.e+]+)")
    # 868 in the run of 100 s
    figures.atMost("forecast over 868, factor", max(mean/868, 868/mean), 1.5)


def testPointsThatEnter(tmp_path, figures):
    """A basin that rain fills: seven times as many points at the end as at a
    tenth. At the rate so far alone half of the time would be forecast"""
    h, n, size, rain, end = 0.02, 3, 0.6, 0.12, 3
    setup = Setup(
        cells=(30, 30), h=h, points=n, energy=False, mpm={"logInterval": 20},
        sides={"ymax": ("patch", {"type": "fixedValue",
                                  "value": f"uniform (0 {-rain} 0)"})},
        regions={"puddle": hydrostatic((0, 0), (size, 2*h))})
    setup.water["inflowOutflow"] = {"inlets": {"rain": {
        "patch": "ymax", "velocity": (0, -rain, 0),
        "pointsPerDirection": n}}}
    case = setup.until(end).write(tmp_path/"case").prepare()
    case.solve()
    text = (case.path/"log.mpmFoam").read_text()
    rows = np.array(re.findall(
        r"^Time = (\S+)\n.*?^water: points (\d+).*?^Remaining = (\S+) s  on"
        r".*?^ExecutionTime = (\S+) s", text, re.MULTILINE | re.DOTALL),
        dtype=float)
    tenth = rows[np.searchsorted(rows[:, 0], 0.1*end)]
    figures.atLeast("points at the end over those at a tenth",
                    rows[-1, 1]/tenth[1], 4)
    ratio = (tenth[2] + tenth[3])/rows[-1, 3]
    # Others work on this machine, too
    figures.atMost("a tenth: done and remaining over the whole, factor",
                   max(ratio, 1/ratio), 1.6)


def testFarEnd(tmp_path, figures):
    """A run that is stopped by other means than an end in 1e18 s"""
    case = damBreak(control={
        "endTime": 1e18, "stopAt": "nextWrite", "writeControl": "timeStep",
        "writeInterval": 50}, mpm={"logInterval": 10}).write(
            tmp_path/"case").prepare()
    text = case.solve().text
    figures.contains("log", re.search(r"Remaining = \S+ s .*", text),
                     "Remaining = ")
    figures.holds("no date", "until" not in text)


def testFunctionObjects(tmp_path, figures):
    """They are tried, count, and leave nothing; steps end at their times"""
    interval = 7e-4
    each = {"libs": '("libmpmFunctionObjects.so")', "cloud": "water",
            "writeControl": "adjustableRunTime", "writeInterval": interval}
    functions = {
        "balance": {"type": "massBalance", **each},
        "front": {"type": "frontPosition", "direction": "(1 0 0)", **each}}
    steps, texts = {}, {}
    for name, more in [("without", {}), ("with", functions)]:
        setup = damBreak(h=0.01, points=3, mpm={"logInterval": 5},
                         functions=more, energy=False)
        case = prepared(setup.until(0.28, write=0.07), tmp_path/name)
        found, texts[name] = forecast(case.path)
        steps[name] = number(found["steps"], r"([\d.e+]+)")
        figures.holds(f"{name}: no postProcessing",
                      not (case.path/"postProcessing").exists())
    case.solve()
    figures.contains("with: counted", texts["with"], "; function objects ")
    figures.equal("without: none counted",
                  "; function objects " in texts["without"], False)
    figures.equal("with: whole steps from time to time",
                  round(steps["with"]) % round(0.28/interval), 0)
    figures.atMost("with: steps, forecast over truth, distance to 1",
                   abs(steps["with"]/case.log.stepCount - 1), 0.1)
    figures.atLeast("with: steps over those without",
                    steps["with"]/steps["without"], 1.1)
