#!/usr/bin/env python3
"""A dam of sand is overtopped and eroded (tutorials/overtopping at h = 0.01, to
30 s after the water has reached the crest): profiles of the dam, its height,
what is left of it, and where the sand moves fastest. The dam is saturated
below the line from the reservoir to the downstream toe; another run has it
saturated all through."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

TOE, CREST, HEEL = 1.0, (1.4, 1.5), 1.9
HEIGHT = 0.20
PICTURES = [2, 4, 8, 20, 30]        # after the water reached the crest [s]
SATURATED = {
    "water/regions/pores/points": "((1.0 0) (1.9 0) (1.5 0.20) (1.4 0.20))",
    "soil/regions/dry/saturated": "yes"}


def dam(name, finer, end, points=None, **keywords):
    h = 0.02/finer
    return study.Run(
        name, [REPOSITORY/"tutorials"/"overtopping"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": 400*finer, "ny0": 10*finer, "ny1": 10*finer},
         "system/controlDict": {"endTime": end, "writeInterval": 0.25},
         "system/setMaterialPointsDict": points or {},
         "system/fvSolution": {"MPM/logInterval": 1000}},
        about={"h": h}, **keywords)


def runs():
    return [dam("h0.02", 1, 31), dam("h0.01", 2, 31),
            dam("h0.02_saturated", 1, 31, SATURATED),
            dam("h0.01_saturated", 2, 31, SATURATED, optional=True)]


def profile(run, time):
    rows = np.genfromtxt(
        run.path/"postProcessing"/"scour"/time/"profile.csv", delimiter=",",
        skip_header=1)
    return rows.T


def overtopped(run, times):
    """First written time at which water stands over the whole crest"""
    for time in times:
        x, bed, water = profile(run, time)
        crest = (x > CREST[0]) & (x < CREST[1])
        if (water[crest] > bed[crest] + 0.25*run.about["h"]).all():
            return float(time)
    return np.nan


def fastestDepth(run, time):
    """Depth below the bed's surface of the fastest percent of the grains,
    and their mean speed"""
    case = run.case
    x, v = (case.cloudField(time, "soil", f) for f in ["x", "U"])
    speed = np.sqrt((v**2).sum(axis=1))
    fast = speed >= np.quantile(speed, 0.99)
    at, bed, _ = profile(run, time)
    surface = np.interp(x[:, 0], at, bed)
    return np.median((surface - x[:, 1])[fast]), speed[fast].mean()


def evaluate(done, results):
    out = {}
    columns = {k: [] for k in ["run", "t", "x", "bed", "water"]}
    shown = [n for n in ["h0.01", "h0.02"] if n in done][:1]
    fig, panels = style.plt.subplots(2, 1, figsize=(8, 6),
                                     layout="constrained")
    for name, run in done.items():
        times = [t for t in run.case.times()
                 if (run.path/"postProcessing"/"scour"/t).is_dir()]
        start = overtopped(run, times)
        out[f"timeOfOvertopping_{name}"] = start
        x, first, _ = profile(run, times[0])
        inDam = (x > TOE) & (x < HEEL)
        course = []
        for t in times:
            bed = profile(run, t)[1]
            course.append((float(t) - start, bed[inDam].max(),
                           bed[inDam].sum()/first[inDam].sum()))
        course = np.array(course)
        panels[1].plot(course[:, 0], course[:, 1]/HEIGHT,
                       label=f"height, {name}")
        panels[1].plot(course[:, 0], course[:, 2], "--",
                       label=f"area left, {name}")
        for after in PICTURES:
            t = run.case.nearestTime(start + after)
            if t not in times:
                continue
            x, bed, water = profile(run, t)
            depth, speed = fastestDepth(run, t)
            label = f"t{after}_{name}"
            out[f"damHeight_{label}"] = bed[inDam].max()
            out[f"damLeft_{label}"] = bed[inDam].sum()/first[inDam].sum()
            slope = (x > CREST[1]) & (x < HEEL)
            out[f"slopeEroded_{label}"] = (
                np.maximum(first - bed, 0)[slope].sum()*run.about["h"])
            out[f"depthOfFastestOverH_{label}"] = depth/run.about["h"]
            out[f"speedOfFastest_{label}"] = speed
            columns["run"] += [name]*len(x)
            columns["t"] += [after]*len(x)
            columns["x"] += list(x)
            columns["bed"] += list(bed)
            columns["water"] += list(water)
            if name in shown:
                keep = (x > 0.8) & (x < 3)
                line, = panels[0].plot(x[keep], bed[keep], label=f"{after} s")
                panels[0].plot(x[keep], water[keep], ":", lw=0.8,
                               color=line.get_color())
        for cloud in ["water", "soil"]:
            state = [run.case.cloudState(t, cloud) for t in
                     (times[0], times[-1])]
            out[f"pointsLeft_{cloud}_{name}"] = state[1].get("left", 0)
        out[f"wallTime_{name}"] = run.log.wallTime
        out[f"stepCount_{name}"] = run.log.stepCount
        out[f"nsPerPointStep_{name}"] = run.log.nsPerPointStep
        if name in shown:
            panels[0].fill_between(x, first, color="0.9",
                                   label="dam at the start")
            panels[0].set_xlim(0.8, 3)
    panels[0].set(xlabel="x [m]", ylabel="bed (dots: water) [m]",
                  title=f"{', '.join(shown)} (paper: Fig. 17)")
    panels[1].set(xlabel="time after the water reached the crest [s]",
                  ylabel="over that at the start", ylim=(0, 1.1))
    for panel in panels:
        panel.legend(fontsize="small")
    style.save(fig, results/"overtopping.png")
    reference.writeCsv(results/"profiles.csv", columns, "s and m; t after the "
                       "water reached the crest")
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out)


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
