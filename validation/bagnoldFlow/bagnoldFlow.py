#!/usr/bin/env python3
"""Dry mu(I) flow down inclines of 24, 26 and 28 degrees, from a linear profile
to steady flow: velocity profile against Bagnold's."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import bagnold, metrics, reference, study, style  # noqa: E402

ANGLES = [24, 26, 28]
GRIDS = [20, 30]            # cells per height; the finer one if named
HEIGHT = 0.02
END = 6
MEAN_FROM = 4               # s; errors are means over the times after it


def incline(angle, n):
    h, nx, ny = HEIGHT/n, 6, round(1.3*n)
    flow = bagnold.row(angle)
    tilt = np.radians(angle)
    vertices = [(x, y, z) for z in (0, h)
                for x, y in [(0, 0), (nx*h, 0), (nx*h, ny*h), (0, ny*h)]]
    shear = 2*flow["u_mean"]/HEIGHT
    return study.Run(
        f"deg{angle}_n{n}", [REPOSITORY/"tutorials"/"bagnoldFlow"],
        study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": nx, "ny": ny, "vertices": [
                "({:.10g} {:.10g} {:.10g})".format(*v) for v in vertices]},
         "constant/g": {"value": "({:.8g} {:.8g} 0)".format(
             bagnold.G*np.sin(tilt), -bagnold.G*np.cos(tilt))},
         "system/setMaterialPointsDict": {
             "soil/regions/layer/velocityGradient":
                 f"(0 {shear:.6g} 0  0 0 0  0 0 0)"},
         "system/controlDict": {"endTime": END, "writeInterval": 0.25}},
        about={"angle": angle, "n": n, "h": h}, optional=n != GRIDS[0])


def evaluate(done, results):
    out = {}
    fig, panels = style.figure(1, len(ANGLES), width=9, sharey=True)
    table = {k: [] for k in ["angle", "cells", "profileError", "surfaceError",
                             "meanError", "swelling", "separated", "wallTime"]}
    for name, run in done.items():
        angle, n, h = (run.about[k] for k in ["angle", "n", "h"])
        flow, case = bagnold.row(angle), run.case
        profiles, errors = [], []
        for time in [t for t in case.times() if float(t) > MEAN_FROM]:
            y, u, exact, error = bagnold.compare(case, time, flow, h)
            profiles.append((y, u, exact))
            x, regime = (case.cloudField(time, "soil", f)
                         for f in ["x", "regime"])
            errors.append({**error, "swelling": 2*x[:, 1].mean()/HEIGHT - 1,
                           "separated": (regime == 3).mean()})
        mean = {key: np.mean([e[key] for e in errors]) for key in errors[0]}
        y, u, exact = np.mean(profiles, axis=0)
        mean["profileError"] = np.abs(u - exact).max()/flow["u_surface"]
        for key in table:
            value = {"angle": angle, "cells": n,
                     "wallTime": run.log.wallTime, **mean}[key]
            table[key].append(value)
            if key not in ("angle", "cells"):
                out[f"{key}_{name}"] = value
        axis = panels[ANGLES.index(angle)]
        axis.plot(u, 1e3*y, "os"[GRIDS.index(n)], label=f"H/{n}")
        axis.set_title(f"{angle} degrees")
    for angle, axis in zip(ANGLES, panels):
        y = np.linspace(0, HEIGHT)
        axis.plot(bagnold.velocity(y, bagnold.row(angle)), 1e3*y,
                  color=style.REFERENCE, label="closed form")
        axis.set(xlabel="velocity [m/s]")
        axis.legend()
    panels[0].set(ylabel="height [mm]")
    style.save(fig, results/"bagnoldFlow.png")
    out.update(study.provenance(done))
    reference.writeCsv(
        results/"bagnoldFlow.csv", table,
        f"means of {MEAN_FROM} to {END} s; profileError: of the mean "
        "profile, the largest, over the surface velocity")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: profileError <= 0.05")


if __name__ == "__main__":
    study.main(HERE, [incline(angle, n) for n in GRIDS for angle in ANGLES],
               evaluate, __doc__)
