#!/usr/bin/env python3
"""A wave flows over a dike and digs into the bed behind it
(tutorials/tsunamiOverflow at h = 0.02, to 120 s): depth of the scour over time,
shape of the holes, suspended grains. And the first 5 s at h = 0.01 beside those at
h = 0.02: what the grid changes, and the time that 120 s would take."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402
from mpmfoam.postProcessing import readDat  # noqa: E402

COUNTS = {"nx0": 0.30, "nx1": 3.90, "nx2": 0.40,
          "ny0": 0.60, "ny1": 0.20, "ny2": 0.10, "ny3": 0.30}
BED = 0.50
PICTURES = [1, 2, 3, 5, 10, 20, 40, 60, 80, 120]
PAPER_HOURS = 30


def overflow(name, h, end, **keywords):
    return study.Run(
        name, [REPOSITORY/"tutorials"/"tsunamiOverflow"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, **{k: round(v/h) for k, v in COUNTS.items()}},
         "system/controlDict": {"endTime": end},
         "system/fvSolution": {"MPM/logInterval": 1000}},
        about={"h": h}, **keywords)


def runs():
    return [overflow("h0.05", 0.05, 120), overflow("h0.02", 0.02, 120),
            overflow("h0.02_5s", 0.02, 5), overflow("h0.01_5s", 0.01, 5)]


def profile(run, time):
    return np.genfromtxt(
        run.path/"postProcessing"/"scour"/time/"profile.csv", delimiter=",",
        skip_header=1).T


def holes(depth, least):
    """Stretches of the bed that are deeper than `least`, of three cells or
    more"""
    deep = np.concatenate([[0], (depth > least).astype(int), [0]])
    first, last = (np.flatnonzero(np.diff(deep) == s) for s in (1, -1))
    return int((last - first >= 3).sum())


def evaluate(done, results):
    """The long runs and the short ones each have their results"""
    for directory, here in [
            (results, {n: r for n, r in done.items() if "_5s" not in n}),
            (results/"first5s", {n: r for n, r in done.items() if "_5s" in n})]:
        if here:
            directory.mkdir(exist_ok=True)
            evaluateRuns(here, directory)


def evaluateRuns(done, results):
    out = {}
    fig, panels = style.plt.subplots(2, 1, figsize=(8, 6),
                                     layout="constrained")
    shown = [n for n in ["h0.02", "h0.05", "h0.01_5s"] if n in done][:1]
    columns = {k: [] for k in ["run", "t", "x", "bed", "water"]}
    for name, run in done.items():
        rows = readDat(run.path, "scour", "scourProfile.dat")
        panels[0].plot(rows[:, 0], rows[:, 1], label=f"depth, {name}")
        panels[0].plot(rows[:, 0], rows[:, 7], ":",
                       label=f"suspended part, {name}")
        for t in PICTURES:
            if rows[-1, 0] < t - 0.5 or (t < 10) != ("_5s" in name):
                continue
            out[f"scourDepth_t{t}_{name}"] = np.interp(t, rows[:, 0],
                                                       rows[:, 1])
            out[f"suspendedFraction_t{t}_{name}"] = np.interp(
                t, rows[:, 0], rows[:, 7])
            written = run.case.nearestTime(t)
            x, bed, water = profile(run, written)
            inBed = (x > 0.3) & (x < 4.2)
            out[f"holes_t{t}_{name}"] = holes(BED - bed[inBed],
                                              run.about["h"])
            columns["run"] += [name]*len(x)
            columns["t"] += [t]*len(x)
            columns["x"] += list(x)
            columns["bed"] += list(bed)
            columns["water"] += list(water)
            if name in shown:
                panels[1].plot(x[inBed], bed[inBed], label=f"{t} s")
        log = run.log
        out[f"wallTime_{name}"] = log.wallTime
        out[f"stepCount_{name}"] = log.stepCount
        out[f"nsPerPointStep_{name}"] = log.nsPerPointStep
        out[f"cpuTime_{name}"] = log.cpuTime
        out[f"hoursFor120s_{name}"] = log.cpuTime*120/log.time/3600
    out["hoursOfThePaper"] = PAPER_HOURS
    panels[0].set(xlabel="t [s]", ylabel="scour depth [m], part [-]")
    panels[1].set(xlabel="x [m]", ylabel="bed [m]",
                  title=f"{', '.join(shown)} (paper: Figs 19, 20)")
    for panel in panels:
        panel.legend(fontsize="small")
    style.save(fig, results/"tsunamiOverflow.png")
    reference.writeCsv(results/"profiles.csv", columns, "s and m")
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out)


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
