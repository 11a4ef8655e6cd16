"""ParaView without a screen reads what the solver wrote; function objects and
utilities of OpenFOAM work on the cloud and on the fields."""

import json
import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mpmfoam.postProcessing import readDat

from caseBuilder import damBreak

HERE = Path(__file__).resolve().parent

needsParaView = pytest.mark.skipif(
    not (shutil.which("pvpython") and shutil.which("xvfb-run")),
    reason="no pvpython or no xvfb-run")


@pytest.fixture(scope="module")
def seen(tmp_path_factory):
    """Cases by name, and what one session of ParaView sees of them: time ->
    points, values, means"""
    cases = {}
    for name, dim, format in [("2D binary", 2, "binary"),
                              ("2D ascii", 2, "ascii"),
                              ("3D binary", 3, "binary")]:
        setup = damBreak(dim, h=0.02 if dim == 2 else 0.04,
                         points=3 if dim == 2 else 2,
                         control={"writeFormat": format})
        path = tmp_path_factory.mktemp("serial")/"case"
        cases[name] = setup.until(0.1, write=0.05).write(path).prepare()
        cases[name].solve()

    # One of the ranks has no water at first
    path = tmp_path_factory.mktemp("parallel")/"case"
    case = damBreak().until(0.2, write=0.1).write(path).prepare()
    case.decompose(2)
    case.solve(ranks=2)
    cases["decomposed"] = case
    path = tmp_path_factory.mktemp("reconstructed")/"case"
    shutil.copytree(case.path, path)
    cases["reconstructed"] = type(case)(path, case.setup)
    cases["reconstructed"].run("reconstructPar")
    for i in range(2):
        shutil.rmtree(path/f"processor{i}")

    names = {name: f"{c.path}:decomposed" if name == "decomposed"
             else str(c.path) for name, c in cases.items()}
    result = subprocess.run(
        [os.environ["MPMFOAM_DIR"] + "/etc/pvpythonOffscreen",
         str(HERE/"countPoints.py"),
         *names.values()], capture_output=True, text=True, timeout=180)
    assert result.returncode == 0, result.stdout + result.stderr
    found = json.loads(result.stdout.splitlines()[-1])
    return {name: (cases[name], found[key]) for name, key in names.items()}


@needsParaView
@pytest.mark.parametrize("name", ["2D binary", "2D ascii", "3D binary",
                                  "decomposed", "reconstructed"])
def testParaView(seen, figures, name):
    """The number of points, their positions and velocities at each time"""
    case, found = seen[name]
    # The start lies in the case directory, which ParaView passes over
    times = [t for t in case.times if t != "0" or name != "decomposed"]
    figures.atLeast("times", len(times), 2)
    for time in times:
        key = f"{float(time):.6g}"
        points, at = case.points(time), found.get(key)
        if not at:
            figures.holds(f"{time} s is there", False)
            continue
        figures.equal(f"{time} s: points", at["points"], len(points.id))
        figures.equal(f"{time} s: values of U", at["values"],
                      len(points.id))
        if at["points"] and at["values"]:
            # ParaView holds them in single precision
            figures.atMost(f"{time} s: mean position, difference", np.abs(
                np.array(at["x"]) - points.x.mean(axis=0)).max(), 1e-6)
            figures.atMost(f"{time} s: mean U, difference", np.abs(
                np.array(at["U"]) - points.U.mean(axis=0)).max(), 1e-6)


def testVtkCloud(tmp_path, figures):
    """Function object vtkCloud, and what it wrote read again"""
    setup = damBreak(functions={"cloud": {
        "type": "vtkCloud", "libs": '("liblagrangianFunctionObjects.so")',
        "cloud": "water", "format": "ascii", "writeControl": "writeTime",
        "fields": "(U p rho J mass)"}})
    case = setup.until(0.1, write=0.05).write(tmp_path/"case").prepare()
    case.solve()
    files = sorted((case.path/"postProcessing"/"cloud").rglob("*.vt[kp]"))
    figures.equal("files", len(files), len(case.times) - 1)
    text = files[-1].read_text(errors="replace")
    points = case.points()
    n = re.search(r'NumberOfPoints=.(\d+)', text)
    figures.equal("points in the last file", int(n[1]) if n else None,
                  len(points.id))
    for name in ["U", "p", "rho", "J", "mass"]:
        figures.holds(f"field {name}", f"Name='{name}'" in text
                      or f'Name="{name}"' in text)
    found = re.search(
        r"<DataArray[^>]*Name=.U.[^>]*>(.*?)</DataArray>", text, re.DOTALL)
    U = np.array(found[1].split(), dtype=float).reshape(-1, 3)
    figures.atMost("sum of U: relative difference", np.abs(
        U.sum(axis=0) - points.U.sum(axis=0)).max()
        / np.abs(points.U).sum(), 1e-5)


def testProbes(tmp_path, figures):
    """Function object probes on the fields of the mesh: the value of the
    cell, between write times, too"""
    locations = [(0.05, 0.05, 0.01), (0.05, 0.11, 0.01), (0.45, 0.35, 0.01)]
    setup = damBreak(functions={"probes": {
        "type": "probes", "libs": '("libsampling.so")',
        "fields": "(p alpha.water U.water)", "probeLocations": locations,
        "writeControl": "timeStep", "writeInterval": 1}})
    case = setup.until(0.05, write=0.025).write(tmp_path/"case").prepare()
    case.solve()
    time = case.times[-1]
    centres = case.case.cellCentres(time)
    cells = [int(np.argmin(np.linalg.norm(centres - x, axis=1)))
             for x in locations]
    for name in ["p", "alpha.water", "U.water"]:
        rows = readDat(case.path, "probes", name)
        figures.atLeast(f"{name}: rows", len(rows), case.log.stepCount)
        values = rows[-1, 1:].reshape(len(locations), -1)
        field = case.case.field(time, name)[cells].reshape(
            len(locations), -1)
        scale = np.abs(field).max()
        figures.atMost(f"{name} at {time} s: difference to the field", float(
            np.abs(values - field).max()/scale), 1e-5)
        # Fields follow the points between write times
        early = np.unique(rows[5:15, 1])
        figures.atLeast(f"{name}: different values in ten steps", len(early),
                        9 if name != "alpha.water" else 2)
    below = readDat(case.path, "probes", "p")[-1, 1]
    figures.holds("pressure near the floor over rho g H, of 0.2 m",
                  0.2 < below/(9810*0.2) < 1.2, f"{below/(9810*0.2):.3g}")
    air = readDat(case.path, "probes", "alpha.water")[-1, 3]
    figures.equal("alpha.water in the air", air, 0)


def testFieldMinMaxParallel(tmp_path, figures):
    """fieldMinMax on two ranks is that on one"""
    rows, columns = {}, {}
    for ranks in [1, 2]:
        setup = damBreak(functions={"extremes": {
            "type": "fieldMinMax",
            "libs": '("libfieldFunctionObjects.so")',
            "fields": "(p alpha.water)", "writeControl": "timeStep",
            "writeInterval": 10}})
        case = setup.steps(50).write(tmp_path/str(ranks)).prepare()
        if ranks > 1:
            case.decompose(2)
        case.solve(ranks=ranks)
        path = next((case.path/"postProcessing"/"extremes").rglob("*.dat"))
        lines = path.read_text().splitlines()
        columns[ranks] = [c.strip() for c in lines[1].split("\t")]
        rows[ranks] = [line.split("\t") for line in lines[2:]]
    figures.equal("rows", [len(r) for r in rows.values()], [10, 10])
    worst = 0.0
    for a, b in zip(rows[1], rows[2]):
        assert a[:2] == b[:2]       # time and field
        # In parallel a column with the rank follows each place
        for k in ["min", "max"]:
            u, v = (float(r[columns[ranks].index(k)])
                    for ranks, r in [(1, a), (2, b)])
            worst = max(worst, abs(u - v)/max(abs(u), 1e-30))
    figures.atMost("largest relative difference", worst, 1e-10)


@pytest.mark.skipif(not shutil.which("foamToVTK"), reason="no foamToVTK")
def testFoamToVTK(tmp_path, figures):
    case = damBreak().steps(20).write(tmp_path/"case").prepare()
    case.solve()
    result = case.run("foamToVTK", "-latestTime", "-ascii", check=False)
    figures.equal("exit status", result.status, 0)
    files = sorted((case.path/"VTK").rglob("*.vtp"))
    clouds = [f for f in files if "water" in str(f)]
    figures.atLeast("files of the cloud", len(clouds), 1)
    if clouds:
        n = re.search(r"NumberOfPoints=.(\d+)", clouds[-1].read_text())
        figures.equal("points", int(n[1]), len(case.points().id))
