#!/usr/bin/env python3
"""Wall stress, turbulence and yield stress against closed forms: open channels
over rough and smooth beds after 5 H/u*, a Bingham liquid in a gap.

    ./liquids.py [--only NAME ...]

Writes results/liquids.csv, a row each run; resumable: rows that are there are
not run again.
"""

import argparse
import csv
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

from liquids import Channel, binghamGap, setField  # noqa: E402

RESULTS = HERE/"results"/"liquids.csv"
FIELDS = ["run", "figure", "value", "CPU", "commit"]
TIMES = 5                       # H/u*
START = {"k": 8e-3, "epsilon": 3e-3}


def channel(path, turbulence, transfer="XAPIC", **entries):
    flow = Channel(
        turbulence, water={"transfer": transfer},
        coeffs=START if turbulence == "kEpsilon" else None, **entries)
    case = flow.start(path, TIMES*flow.depth/flow.uStar)
    case.solve()
    p = case.points()
    y = p.x[:, 1]
    rows = [(y >= j*flow.h) & (y < (j + 1)*flow.h)
            for j in range(1, flow.cells)]
    profile = [p.U[r, 0].mean()/flow.profile(y[r].mean())
               for r in rows if r.any()]
    return case, {"mean velocity over the law's": flow.meanOf(case),
                  "largest error of the profile over the first row":
                      np.abs(np.array(profile) - 1).max()}


def gap(path, transfer="APIC", **entries):
    setup, exact, T = binghamGap(water={"transfer": transfer}, **entries)
    case = setup.until(T/2).write(path).prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = exact(x[:, 1])
    setField(case, "U", U)
    case.solve()
    p = case.points()
    u, theory = p.U[:, 0], exact(p.x[:, 1])
    return case, {"flow over theory's": u.mean()/theory.mean(),
                  "speed of the plug over theory's": u.max()/theory.max(),
                  "rms error over the plug's speed":
                      np.sqrt(np.mean((u - theory)**2))/theory.max()}


RUNS = {
    **{f"channel {model} ks={ks:g} cells={n}":
       (lambda path, model=model, ks=ks, n=n: channel(
           path, model, ks=ks, cells=n))
       for model in ["mixingLength", "kEpsilon"] for ks in [1e-3, 1e-2]
       for n in [20, 40]},
    "channel mixingLength smooth cells=20":
        lambda path: channel(path, "mixingLength", ks=0),
    "channel mixingLength ks=0.001 cells=20 APIC":
        lambda path: channel(path, "mixingLength", "APIC", ks=1e-3),
    "channel kEpsilon ks=0.001 cells=20 APIC":
        lambda path: channel(path, "kEpsilon", "APIC", ks=1e-3),
    **{f"gap {model} m={m:g} cells={n} {transfer}":
       (lambda path, model=model, m=m, n=n, transfer=transfer: gap(
           path, transfer, model=model, m=m, cells=n))
       for model, m, n, transfer in [
           ("BinghamPapanastasiou", 10, 16, "APIC"),
           ("BinghamPapanastasiou", 10, 16, "XAPIC"),
           ("BinghamPapanastasiou", 10, 32, "XAPIC"),
           ("BinghamPapanastasiou", 40, 32, "APIC"),
           ("HerschelBulkley", 10, 16, "XAPIC")]}}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", default=[""],
                        help="words in the names of runs")
    options = parser.parse_args()
    commit = subprocess.run(
        ["git", "-C", str(REPOSITORY), "describe", "--always", "--dirty"],
        capture_output=True, text=True, check=True).stdout.strip()
    RESULTS.parent.mkdir(exist_ok=True)
    rows = []
    if RESULTS.is_file():
        with open(RESULTS, newline="") as file:
            rows = list(csv.DictReader(file))
    have = {r["run"] for r in rows}
    for name, run in RUNS.items():
        if name in have or not any(word in name for word in options.only):
            continue
        path = Path(tempfile.mkdtemp(prefix="liquids."))
        try:
            start = time.monotonic()
            case, found = run(path/"case")
            cpu = getattr(case.log, "executionTime", None) \
                or time.monotonic() - start
        finally:
            shutil.rmtree(path, ignore_errors=True)
        for figure, value in found.items():
            rows.append(dict(zip(FIELDS, [
                name, figure, f"{value:.4f}", f"{cpu:.0f}", commit])))
            print(*rows[-1].values(), flush=True)
        with open(RESULTS, "w", newline="") as file:
            writer = csv.DictWriter(file, FIELDS)
            writer.writeheader()
            writer.writerows(rows)


if __name__ == "__main__":
    main()
