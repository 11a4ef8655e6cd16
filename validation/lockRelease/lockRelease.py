#!/usr/bin/env python3
"""Suspensions of sand released from a lock into still water, against the
fronts that Gadal et al. measured (J. Fluid Mech. 974, A4, 2023).

No number here is tuned. The water has no turbulence model."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

LENGTH, HEIGHT, DEPTH, LOCK = 1.5, 0.21, 0.2, 0.1
# Solid fraction in the lock, and end [s]
MEASURED = {"run146": (0.09732, 7.5), "run138": (0.02919, 10),
            "run141": (0.00978, 12)}


POINTS = "system/setMaterialPointsDict"


def release(name, h, variant="", settings=None, points=4):
    phi, end = MEASURED[name]
    return study.Run(
        f"{name}_h{h:g}{variant}", [HERE/"case"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(LENGTH/h), "ny": round(HEIGHT/h)},
         POINTS: {
             "soil/regions/lock/voidRatio": round((1 - phi)/phi, 3),
             "water/pointsPerDirection": points},
         "system/controlDict": {"endTime": end},
         **(settings or {})},
        about={"measured": name, "h": h, "phi": phi,
               "variant": variant.strip("_")})


def vortex(points):
    """What goes wrong with few points: a box of water without soil that turns
    at 2/s at first"""
    return study.Run(
        f"vortex_points{points}", [HERE/"case"], study.MPMFOAM,
        {"system/blockMeshDict": {"nx": 30, "length": 0.3},
         POINTS: {
             "water/pointsPerDirection": points,
             "water/regions/all/max": [0.3, 0.2, 1],
             "water/regions/all/velocityGradient":
                 [0, -2, 0, 2, 0, 0, 0, 0, 0],
             "water/regions/all/centre": [0.15, 0.1, 0]},
         "constant/materialPointProperties": {"clouds": "(water)"},
         "system/fvSolution": {"MPM/strictKeywords": "no"},
         "system/controlDict": {"endTime": 2}},
        about={"points": points})


RUNS = [*(release(name, 0.01) for name in MEASURED),
        *(release(name, 0.02) for name in MEASURED),
        release("run146", 0.02, "_noSlip", {
            "0.orig/U.water": {"boundaryField/floor/type": "noSlip"}}),
        release("run141", 0.01, "_points2", points=2),
        # Does friction of the floor stop it?
        *(release(name, h, "_soilSlips", {
            "0.orig/U.soil": {"boundaryField/floor": "{ type slip; }"}})
          for name, h in [("run146", 0.02), ("run146", 0.01),
                          ("run138", 0.02), ("run141", 0.02)]),
        *(vortex(points) for points in (2, 3, 4))]


START = 0.2                     # the clocks are set by the passage here, m
# The front is where a column holds more than this part of the grains that a
# column of the lock held; a single point is 0.006 of it
FRONT = 0.02


def front(case, phi, part=FRONT):
    """Times and farthest columns with grains, linear between columns"""
    out = []
    for time in case.times():
        x, y, alpha = case.lattice(time, "alpha.soil")
        held = alpha.sum(axis=0)*(y[1] - y[0])/(phi*DEPTH)
        i = np.nonzero(held >= part)[0][-1]
        after = held[i + 1] if i + 1 < len(x) else 0.0
        out.append((float(time), x[i] + (x[1] - x[0])*(held[i] - part)
                    /(held[i] - after)))
    return np.array(out).T


def passage(t, x, place):
    """First time at a place, nan if it is not reached"""
    beyond = np.nonzero(x >= place)[0]
    if not len(beyond) or beyond[0] == 0:
        return np.nan
    i = beyond[0]
    return t[i - 1] + (t[i] - t[i - 1])*(place - x[i - 1])/(x[i] - x[i - 1])


def measures(run):
    data = reference.data(f"exp_lockRelease_{run.about['measured']}.csv")
    tm, xm = data["t_s"], data["x_front_m"]
    tm = tm - passage(tm, xm, START)
    t, x = front(run.case, run.about["phi"])
    t = t - passage(t, x, START)
    out = {}
    # Mean speed between two places against the measured one
    for a, b in [(0.2, 0.4), (0.4, 0.8), (0.8, 1.2)]:
        span, spanMeasured = (passage(tt, xx, b) - passage(tt, xx, a)
                              for tt, xx in ((t, x), (tm, xm)))
        if np.isfinite(span) and np.isfinite(spanMeasured):
            out[f"speedRatio_{a:g}_{b:g}"] = spanMeasured/span
    here = (tm >= 0) & (tm <= t[-1])
    error = np.interp(tm[here], t, x) - xm[here]
    out["frontRms"] = float(np.sqrt(np.mean(error**2)))
    out["frontErrorEnd"] = error[-1]
    out["timeCompared"] = tm[here][-1]
    out["frontEnd"], out["frontEndMeasured"] = x[-1], np.interp(t[-1], tm, xm)
    # Does the mark that makes a front matter?
    other = front(run.case, run.about["phi"], FRONT/4)
    out["frontRmsMark"] = float(np.sqrt(np.mean((other[1] - x)**2)))
    # Grains behind: height of their centre over that at the start
    y = [run.case.cloudField(i, "soil", "x")[:, 1].mean()
         for i in (run.case.times()[0], run.case.times()[-1])]
    out["meanHeightRatioEnd"] = y[1]/y[0]
    out["massErrorSoil"] = (
        run.case.cloudField(run.case.times()[-1], "soil", "mass").sum()
        /run.case.cloudField(run.case.times()[0], "soil", "mass").sum() - 1)
    out.update(excess(run.case))
    out["cpuTime"] = run.log.cpuTime
    return (tm, xm), (t, x), out


def excess(case, depth=0.17):
    """By how much water and grains fill more than there is, below a depth:
    mean and largest of the cells, the worst of the times"""
    worst = np.zeros(2)
    for time in case.times():
        _, y, total = case.lattice(time, "alpha.water")
        if case.hasCloud(time, "soil"):
            total = total + case.lattice(time, "alpha.soil")[2]
        total = total[y < depth] - 1
        worst = np.maximum(worst, [total.mean(), total.max()])
    return {"excessMean": worst[0], "excessMax": worst[1]}


def evaluate(done, results):
    out, rows = {}, {"run": [], "t": [], "front": []}
    fig, panels = style.figure(1, len(MEASURED), width=9, height=2.6,
                               sharey=True)
    for run in done.values():
        if "points" in run.about:
            out.update({f"{run.name}_{k}": v
                        for k, v in excess(run.case).items()})
    for panel, (name, (phi, _)) in zip(panels, MEASURED.items()):
        shown = False
        for run in done.values():
            if run.about.get("measured") != name:
                continue
            experiment, (t, x), found = measures(run)
            out.update({f"{run.name}_{k}": v for k, v in found.items()})
            if not shown:
                panel.plot(*experiment, "o", color=style.REFERENCE,
                           markersize=2, label="Gadal et al. (2023)")
                shown = True
            label = ", ".join(filter(None, [
                f"h = {run.about['h']:g}", run.about["variant"]]))
            panel.plot(t, x, label=label)
            for row in zip([run.name]*len(t), t, x):
                for column, value in zip(rows.values(), row):
                    column.append(value)
        last = max([0] + [float(t) for n, t in zip(rows["run"], rows["t"])
                          if n.startswith(name)])
        panel.set(title=f"solid fraction {phi:g}", xlim=(-1, last + 0.5),
                  xlabel="t since the front passed 0.2 m [s]")
        if shown:
            panel.legend(fontsize="x-small")
    panels[0].set_ylabel("front [m]")
    style.save(fig, results/"lockRelease.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"lockRelease.csv", rows,
                       "Front of the grains, s since it passed 0.2 m, and m")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "fronts in m")


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
