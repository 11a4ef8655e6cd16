"""accuracyCost: grids with the same walls, Richardson, budget, going on after an
interruption, the promise kept, bad input."""

import json
import os
import shutil
import signal
import subprocess
import time
from fractions import Fraction
from pathlib import Path

import numpy as np
import pytest

from mpmfoam import accuracyCost, reference, study
from mpmfoam.mesh import Mesh

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = ROOT/"tutorials"
ENVIRONMENT = {**os.environ, "MPMFOAM_DIR": str(ROOT),
               "PYTHONPATH": str(ROOT/"etc"/"python"),
               "PATH": f"{ROOT/'bin'}:{os.environ['PATH']}"}


def call(*arguments, **kwargs):
    return subprocess.run(
        [str(ROOT/"bin"/"accuracyCost"), *map(str, arguments)],
        capture_output=True, text=True, timeout=300, env=ENVIRONMENT, **kwargs)


def copied(name, path, **cells):
    """A tutorial on another grid"""
    shutil.copytree(TUTORIALS/name, path, ignore=shutil.ignore_patterns(
        "[1-9]*", "0", "0.[0-9]*", "log.*", "postProcessing", "polyMesh",
        "accuracyCost"))
    for key, value in cells.items():
        study.setEntry(path/"system"/"blockMeshDict", key, value)
    return path


def dam(path):
    """Cells of 20 mm, 300 of them: runs of a tenth of a second"""
    case = copied("damBreak", path, h=0.02, nx=20, ny=15)
    study.setEntry(case/"system"/"controlDict", "writeInterval", 0.05)
    return case


def areas(mesh):
    return {p.name: np.linalg.norm(mesh.areas[p.faces], axis=1).sum()
            for p in mesh.patches}


@pytest.mark.parametrize("name", ["damBreak", "wallJet", "waterInjection"])
def testGrids(name, tmp_path, figures):
    """Finer and coarser: the same walls, patches and volume"""
    case = copied(name, tmp_path/name)
    assert subprocess.run(["blockMesh"], cwd=case, capture_output=True,
                          env={**ENVIRONMENT, "PWD": str(case)}
                          ).returncode == 0
    grid = accuracyCost.Grid(case)
    mesh = Mesh(case)
    figures.equal("cells", int(grid.lattice.active.sum()), mesh.nCells)
    factors = [f for f in grid.factors if f <= 2]
    figures.holds("twice as fine is possible", Fraction(2) in factors)
    for f in factors:
        new = tmp_path/f"{name}{float(f):.3g}"
        shutil.copytree(case, new)
        shutil.rmtree(new/"constant"/"polyMesh")
        grid.write(f, new)
        scaled = Mesh(new)
        figures.equal(f"{f}: cells", scaled.nCells,
                      int(mesh.nCells*f**grid.nDim))
        figures.atMost(f"{f}: volume, relative difference", abs(
            scaled.volumes.sum()/mesh.volumes.sum() - 1), 1e-10)
        before, after = areas(mesh), areas(scaled)
        figures.equal(f"{f}: patches", list(before), list(after))
        figures.atMost(f"{f}: areas, relative difference", max(
            abs(after[k]/before[k] - 1) for k in before), 1e-10)


def testRichardson(figures):
    """Exact where the error is a power of h; else the last change"""
    metric = accuracyCost.Metric("depth")
    for p in (1, 2):
        left, order = accuracyCost.gridError(
            metric, [(h, 3 + 0.5*h**p) for h in (0.4, 0.2, 0.1333)])
        figures.atMost(f"order {p}: found, distance", abs(order - p), 0.02)
        figures.atMost(f"order {p}: error left over the true one, distance "
                       "to 1", abs(left/(0.5*0.1333**p) - 1), 0.02)
    left, order = accuracyCost.gridError(
        metric, [(0.4, 1.0), (0.2, 1.2), (0.1, 1.1)])
    figures.equal("not one way: order", order, None)
    figures.atMost("not one way: distance to the last change",
                   abs(left - 0.1), 1e-12)
    figures.equal("one grid says nothing", accuracyCost.gridError(
        metric, [(0.1, 1.0)]), (None, None))


def testRichardsonOfCourses(figures):
    """Of a course in time only where it goes one way; one that goes to and fro
    by smaller steps says nothing of what is left"""
    metric = accuracyCost.Metric("gauge/waveGauge.dat:height0")
    time = np.linspace(0, 1, 101)
    exact = 1 + time

    def left(shapes):
        return accuracyCost.gridError(metric, [
            (h, (time, exact + shape)) for h, shape in shapes])

    found, order = left([(h, 0.5*h*time) for h in (0.4, 0.2, 0.1)])
    figures.atMost("one way: order, distance to 1", abs(order - 1), 0.02)
    figures.atMost("one way: error left, relative distance to the true one",
                   abs(found/(0.5*0.1*0.5) - 1), 0.02)
    wave = 0.01*np.sin(20*time)
    found, order = left([(0.4, 4*wave), (0.2, -wave), (0.1, 0.5*wave)])
    figures.equal("to and fro: order", order, None)
    figures.atMost("to and fro: over the last change, distance to 1", abs(
        found/np.mean(np.abs(1.5*wave)) - 1), 1e-9)


@pytest.fixture(scope="module")
def finished(tmp_path_factory):
    case = dam(tmp_path_factory.mktemp("accuracyCost")/"dam")
    done = call(case, "--metrics", "frontPosition_t0.15,"
                "energy/energy.dat:kinetic:max", "--endTime", "0.15",
                "--budget", "25s")
    return case, done


def testCase(finished, figures):
    case, done = finished
    print(done.stdout[-4000:] + done.stderr[-2000:])
    figures.equal("exit status", done.returncode, 0)
    results = case/"accuracyCost"/"results"
    rows = reference.readCsv(results/"accuracyCost.csv")
    factors = set(rows["factor"])
    figures.holds("all factors that the case has", {
        "default", "grid", "points", "soundSpeed", "transfer", "maxCo",
        "shape", "scatter", "output"} <= factors, sorted(factors))
    figures.holds("figure", (results/"accuracyCost.png").is_file())
    error = dict(zip(rows["run"], rows["error"]))
    time = dict(zip(rows["run"], rows["cpuTime"]))
    figures.atMost("CPU time of all runs [s]", sum(time.values()), 27)
    figures.equal("runs whose error is 0: the finest",
                  sum(1 for e in error.values() if e == 0), 1)
    text = (results/"recommendation.txt").read_text()
    figures.holds("a sentence", "Accuracy: for 10" in text)
    # Digits of the output change no result
    figures.atMost("change by digits of the output", abs(
        error["output_7digits"] - error["default"]), 1e-6)
    figures.holds("worse: PIC", error["transfer_PIC"] > error["default"])


def testGoesOn(finished, figures):
    """A second call runs nothing"""
    case, first = finished
    runs = case/"accuracyCost"/"runs"
    before = {p: p.stat().st_mtime_ns for p in runs.glob("*/log.mpmFoam")}
    done = call(case, "--metrics", "frontPosition_t0.15,"
                "energy/energy.dat:kinetic:max", "--endTime", "0.15",
                "--budget", "25s")
    figures.equal("exit status", done.returncode, 0)
    again = [p.parent.name for p in before
             if p.stat().st_mtime_ns != before[p]]
    figures.equal("runs made again", again, [])


def testInterrupted(tmp_path, figures):
    """Ctrl-C in a run, then to the end"""
    case = dam(tmp_path/"dam")
    arguments = [case, "--metrics", "mass", "--endTime", "0.1", "--factors",
                 "scatter,maxCo", "--budget", "10s"]
    process = subprocess.Popen(
        [str(ROOT/"bin"/"accuracyCost"), *map(str, arguments)],
        stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env=ENVIRONMENT, start_new_session=True)
    log = case/"accuracyCost"/"runs"/"default"/"log.mpmFoam"
    while not log.is_file() and process.poll() is None:
        time.sleep(0.01)
    os.killpg(process.pid, signal.SIGINT)
    text = process.communicate(timeout=60)[0]
    figures.holds("says that it can go on", "goes on from there" in text,
                  text[-300:])
    done = call(*arguments)
    figures.equal("then: exit status", done.returncode, 0)
    stamps = list((case/"accuracyCost"/"runs").glob("*/study.json"))
    figures.equal("finished runs", len(stamps), 5)
    for stamp in stamps:
        figures.holds(f"{stamp.parent.name} has its digest",
                      json.loads(stamp.read_text())["digest"])


@pytest.mark.parametrize("arguments, texts", [
    (["--metrics", "frontPostion_t0.1"],
     ["metrics.json", "frontPostion_t0.1", "Allowed", "speedRms"]),
    (["--metrics", "front/front.dat:fornt:max"],
     ["postProcessing/front", "fornt", "Allowed", "front"]),
    (["--metrics", "frnt/front.dat:front:max"],
     ["no frnt/front.dat", "Allowed", "front/front.dat"]),
    (["--metrics", "front/front.dat:front:most"],
     ["most", "Allowed", "max, min, mean, end"]),
    (["--factors", "gird"], ["gird", "Allowed", "grid"]),
    (["--budget", "1 fortnight"], ["fortnight", "Allowed"]),
    (["--metrics", "mass", "--budget", "0.01s"],
     ["takes more than the budget", "Allowed", "--budget"]),
])
def testBadInput(tmp_path, figures, arguments, texts):
    case = dam(tmp_path/"dam")
    done = call(case, "--endTime", "0.02", *arguments)
    figures.holds("exit status", done.returncode != 0)
    for text in texts:
        figures.holds(f"says {text}", text in done.stderr, done.stderr[-400:])


def testNoCase(tmp_path, figures):
    (tmp_path/"system").mkdir()
    (tmp_path/"system"/"controlDict").write_text("")
    done = call(tmp_path)
    figures.holds("exit status", done.returncode != 0)
    figures.holds("says what is missing", "no directory" in done.stderr,
                  done.stderr)
