#!/usr/bin/env python3
"""Where mpmFoam and interFoam differ by more than 3 %: which of them moves as the
mesh gets finer? Each case by compareInterFoam on its own mesh and on finer ones."""

import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study  # noqa: E402

EXAMPLES = Path("/usr/share/doc/openfoam-examples/examples/multiphase/"
                "interFoam")
RUNS = HERE/"runs"
RESULTS = HERE/"results"


def copied(source, path):
    shutil.rmtree(path, ignore_errors=True)
    shutil.copytree(source, path)


def damBreak(path, finer):
    """OpenFOAM's own, with so many cells per cell"""
    if not EXAMPLES.is_dir():
        sys.exit(f"compare.py: no {EXAMPLES}: Debian's package "
                 "openfoam-examples has it")
    copied(EXAMPLES/"laminar"/"damBreak"/"damBreak", path)
    file = path/"system"/"blockMeshDict"
    file.write_text(re.sub(
        r"(hex \([\d ]+\) )\((\d+) (\d+) 1\)",
        lambda m: f"{m[1]}({int(m[2])*finer} {int(m[3])*finer} 1)",
        file.read_text()))
    # Not more than its Courant number asks for
    study.setEntry(path/"system"/"controlDict", "deltaT", f"{1e-3/finer:g}")


def openChannel(path, finer):
    source = REPOSITORY/"tutorials"/"openChannel"
    shutil.rmtree(path, ignore_errors=True)
    for part in ["0.orig", "constant", "system"]:
        shutil.copytree(source/part, path/part,
                        ignore=shutil.ignore_patterns("polyMesh"))
    mesh = path/"system"/"blockMeshDict"
    study.setEntry(mesh, "h", f"{0.02/finer:g}")
    counts = {"nx0": 150, "nx1": 5, "nx2": 45, "ny0": 5, "ny1": 4, "ny2": 11}
    for name, n in counts.items():
        study.setEntry(mesh, name, n*finer)


def gateSlot(path, finer):
    """That of validation/gateSlot, which lies over tutorials/damBreak"""
    shutil.rmtree(path, ignore_errors=True)
    for source in [REPOSITORY/"tutorials"/"damBreak",
                   REPOSITORY/"validation"/"gateSlot"/"case"]:
        for part in ["0.orig", "constant", "system"]:
            if (source/part).is_dir():
                shutil.copytree(
                    source/part, path/part, dirs_exist_ok=True,
                    ignore=shutil.ignore_patterns("polyMesh"))
    mesh = path/"system"/"blockMeshDict"
    study.setEntry(mesh, "h", f"{0.01/finer:g}")
    counts = {"nx0": 70, "nx1": 4, "nx2": 98, "nx3": 50,
              "ny0": 5, "ny1": 5, "ny2": 15}
    for name, n in counts.items():
        study.setEntry(mesh, name, n*finer)


def obstacle(path, finer):
    source = REPOSITORY/"tutorials"/"damBreakObstacle3D"
    shutil.rmtree(path, ignore_errors=True)
    for part in ["0.orig", "constant", "system"]:
        shutil.copytree(source/part, path/part,
                        ignore=shutil.ignore_patterns("polyMesh"))


def withObstacle(path, finer):
    """OpenFOAM's own, on a mesh that stays; 32 cells in 1 m, times finer"""
    copied(EXAMPLES/"laminar"/"damBreakWithObstacle", path)
    file = path/"system"/"blockMeshDict"
    n = round(32*finer)
    file.write_text(file.read_text().replace("(32 32 32)", f"({n} {n} {n})"))
    study.setEntry(path/"system"/"controlDict", "deltaT", f"{1e-3/finer:g}")
    for command in ["blockMesh", "topoSet",
                    "subsetMesh -overwrite c0 -patch walls"]:
        subprocess.run(command.split(), cwd=path, check=True,
                       stdout=subprocess.DEVNULL)


# name: how it is made, cells per cell, arguments of compareInterFoam
CASES = {
    **{f"damBreak_{n}": (damBreak, n, [
        "--endTime", "0.3", "--writeInterval", "0.02"]) for n in (1, 2, 4)},
    **{f"openChannel_{n}": (openChannel, n, [
        "--endTime", "12", "--writeInterval", "0.25",
        "--gauges", "1", "2", "3.05"]) for n in (1, 2)},
    **{f"gateSlot_{n}": (gateSlot, n, [
        "--endTime", "0.4", "--writeInterval", "0.05"]) for n in (1, 2, 4)},
    "damBreakObstacle3D": (obstacle, 1, [
        "--endTime", "1", "--writeInterval", "0.05"]),
    **{f"damBreakWithObstacle_{n:g}": (withObstacle, n, [
        "--endTime", end, "--writeInterval", "0.05"])
       for n, end in ((1, "1"), (1.5, "0.5"))}}


def run(name):
    make, finer, arguments = CASES[name]
    path = RUNS/name
    if not (path/"system"/"controlDict").is_file():
        path.parent.mkdir(exist_ok=True)
        make(path, finer)
    subprocess.run(["compareInterFoam", str(path), *arguments], check=True)


def results(name):
    path = RUNS/name/"compareInterFoam"
    if not (path/"metrics.json").is_file():
        return None
    return (reference.readCsv(path/"comparison.csv"),
            metrics.readMetrics(path/"metrics.json"))


def fronts(out):
    """Each code's distance to its own finest mesh, and to the other"""
    found = {n: results(f"damBreak_{n}") for n in (1, 2, 4)}
    if not all(found.values()):
        return
    table = {n: found[n][0] for n in found}
    t = table[1]["time"]
    # From a front that has gone some cells to one that is before the end
    fine = [table[4][f"front_{c}"] for c in ("mpmFoam", "interFoam")]
    free = (t > 0.07) & (np.maximum(*fine) < 0.584 - 2*0.0126)
    rows = []
    for n in (1, 2, 4):
        front = {c: table[n][f"front_{c}"][free]
                 for c in ("mpmFoam", "interFoam")}
        last = {c: table[4][f"front_{c}"][free] for c in front}
        rows.append({
            "cellsPerCell": n,
            "apart": np.abs(front["mpmFoam"]/front["interFoam"] - 1).max(),
            "apartMean": (front["mpmFoam"]/front["interFoam"] - 1).mean(),
            "mpmFoamToFinest": np.abs(
                front["mpmFoam"]/last["mpmFoam"] - 1).max(),
            "interFoamToFinest": np.abs(
                front["interFoam"]/last["interFoam"] - 1).max(),
            "mpmFoamToFinestInterFoam": np.abs(
                front["mpmFoam"]/last["interFoam"] - 1).max(),
            "interFoamToFinestMpmFoam": np.abs(
                front["interFoam"]/last["mpmFoam"] - 1).max(),
            "cpuTime_mpmFoam": found[n][1]["cpuTime_mpmFoam"],
            "cpuTime_interFoam": found[n][1]["cpuTime_interFoam"]})
    put("damBreak", rows, "differences of the front over its distance from the "
        "left wall, largest of all times before the right one; s", out)


def levels(out):
    rows = []
    for n in (1, 2):
        found = results(f"openChannel_{n}")
        if not found:
            continue
        table, known = found
        late = table["time"] > 9
        rows.append({
            "cellsPerCell": n,
            **{f"level_{c}": table[f"gauge1_{c}"][late].mean()
               for c in ("mpmFoam", "interFoam")},
            **{f"sill_{c}": table[f"gauge2_{c}"][late].mean()
               for c in ("mpmFoam", "interFoam")},
            "apart": (table["gauge1_mpmFoam"][late].mean()
                      / table["gauge1_interFoam"][late].mean() - 1),
            "rms": known["profileDifferenceRms"],
            "cpuTime_mpmFoam": known["cpuTime_mpmFoam"],
            "cpuTime_interFoam": known["cpuTime_interFoam"]})
    if rows:
        put("openChannel", rows, "level 1 m before the sill and depth on it, "
            "mean of 9 to 12 s [m]; rms of depths over the largest; s", out)


def jets(out):
    rows = []
    finest = None
    for n in (4, 2, 1):
        found = results(f"gateSlot_{n}")
        if not found:
            continue
        table, known = found
        # From the gate on, and before the end of the domain
        gate, end = 0.74, 2.2
        front = {c: table[f"front_{c}"] - gate
                 for c in ("mpmFoam", "interFoam")}
        free = (np.minimum(*front.values()) > 0.1) & (
            np.maximum(*front.values()) < end - gate)
        finest = finest or front
        late = table["time"] > 0.19
        speed = {c: np.polyfit(table["time"][late],
                               table[f"front_{c}"][late], 1)[0]
                 for c in front}
        rows.append({
            "cellsPerCell": n,
            "apart": np.abs(front["mpmFoam"]/front["interFoam"] - 1)[
                free].max(),
            **{f"speed_{c}": s for c, s in speed.items()},
            "mpmFoamToFinest": np.abs(
                front["mpmFoam"]/finest["mpmFoam"] - 1)[free].max(),
            "interFoamToFinest": np.abs(
                front["interFoam"]/finest["interFoam"] - 1)[free].max(),
            "rms": known["profileDifferenceRms"],
            "cpuTime_mpmFoam": known["cpuTime_mpmFoam"],
            "cpuTime_interFoam": known["cpuTime_interFoam"]})
    if rows:
        put("gateSlot", rows[::-1], "differences of the front over its "
            "distance from the gate, largest of all times; rms of depths over "
            "the largest; s", out)


def three(out):
    found = results("damBreakObstacle3D")
    if found:
        put("damBreakObstacle3D", [{k: v for k, v in found[1].items() if
                                    isinstance(v, (int, float))}],
            "as metrics.json of compareInterFoam", out)


def tanks(out):
    """OpenFOAM's dam break with an obstacle: front, depth, energy lost"""
    rows = []
    for n in (1, 1.5):
        found = results(f"damBreakWithObstacle_{n:g}")
        if not found:
            continue
        table, known = found
        early = table["time"] < 0.55
        rows.append({
            "cellsPerCell": n,
            "apart": known["frontDifferenceMax"],
            "apartMean": known["frontDifferenceMean"],
            "apartLength": known["frontDifferenceMaxLength"],
            "rms": known["profileDifferenceRms"],
            **{f"front_{c}_{t:g}": float(np.interp(
                t, table["time"], table[f"front_{c}"]))
               for t in (0.2, 0.3, 0.4) for c in ("mpmFoam", "interFoam")},
            **{f"energy_{c}": ((table[f"kinetic_{c}"]
                                + table[f"potential_{c}"])[early][-1]
                               / (table[f"kinetic_{c}"]
                                  + table[f"potential_{c}"])[0])
               for c in ("mpmFoam", "interFoam")},
            "cpuTime_mpmFoam": known["cpuTime_mpmFoam"],
            "cpuTime_interFoam": known["cpuTime_interFoam"]})
    if rows:
        put("damBreakWithObstacle", rows, "front: differences over its reach, "
            "places of both [m]; rms of depths over the largest; energy at "
            "0.5 s over that of 0.05 s; s", out)


def put(name, rows, text, out):
    RESULTS.mkdir(exist_ok=True)
    reference.writeCsv(RESULTS/f"{name}.csv",
                       {k: [r[k] for r in rows] for k in rows[0]},
                       f"{text}; {study.commit()}")
    print(f"\n{name}: {text}")
    for row in rows:
        print("    " + "  ".join(f"{k} {v:.4g}" for k, v in row.items()))
        for key, value in row.items():
            if key != "cellsPerCell":
                out[f"{name}_{row.get('cellsPerCell', 1):g}_{key}"] = \
                    float(value)


def main():
    words = sys.argv[1:]
    names = [w for w in words if not w.startswith("-")] or list(CASES)
    for name in names:
        if name not in CASES:
            sys.exit(f"compare.py: no case {name}. Allowed: "
                     f"{', '.join(CASES)}")
    if "--evaluate" not in words:
        for name in names:
            run(name)
    out = {}
    fronts(out)
    levels(out)
    jets(out)
    three(out)
    tanks(out)
    if out:
        file = RESULTS/"metrics.json"
        before = metrics.readMetrics(file) if file.is_file() else {}
        metrics.writeMetrics(file, {**before, **out})


if __name__ == "__main__":
    main()
