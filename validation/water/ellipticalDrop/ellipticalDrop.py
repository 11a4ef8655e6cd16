#!/usr/bin/env python3
"""A round drop without gravity that starts with v = A0 (-x, y): axes of the
ellipse against the exact solution.

Pressure is not judged: the points start at p = 0, the exact solution with
rho A0^2 R^2/2 = 500 Pa in the middle, and what is missing rings on as sound."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from common import study, waterRun  # noqa: E402
from mpmfoam import metrics, reference, style  # noqa: E402


def runs():
    return [waterRun("h0.05", HERE/"case", h=0.05),
            waterRun("h0.1", HERE/"case",
                     {"system/blockMeshDict": {"h": 0.1, "nx": 30, "ny": 52}},
                     h=0.1)]


def axes(case, time):
    """Semi-axes of the ellipse with the second moments of the points"""
    x, m = (case.cloudField(time, "water", f) for f in ["x", "mass"])
    centre = (m[:, None]*x).sum(axis=0)/m.sum()
    return 2*np.sqrt((m[:, None]*(x - centre)**2).sum(axis=0)/m.sum())[:2]


def evaluate(done, results):
    exact = reference.data("ana_elliptical_drop.csv")
    out = {}
    columns = {"run": [], "t": [], "a": [], "b": [], "aExact": [],
               "bExact": []}
    fig, panels = style.plt.subplots(
        1, 2, figsize=(7, 3.4), layout="constrained", width_ratios=[2, 1])
    for name, run in done.items():
        case = run.case
        t = np.array(case.times(), dtype=float)
        a, b = np.array([axes(case, time) for time in case.times()]).T
        aExact = np.interp(t, exact["A0t"], exact["a"])
        bExact = np.interp(t, exact["A0t"], exact["b"])
        out[f"axisErrorMax_{name}"] = max(np.abs(a/aExact - 1).max(),
                                          np.abs(b/bExact - 1).max())
        out[f"areaChange_{name}"] = a[-1]*b[-1]/(a[0]*b[0]) - 1
        for key, values in zip(columns, [[name]*len(t), t, a, b, aExact,
                                         bExact]):
            columns[key] += list(values)
        x, p = (case.cloudField(case.times()[-1], "water", f)
                for f in ["x", "p"])
        middle = np.hypot(x[:, 0], x[:, 1]) < 0.15
        out[f"pressureCentreEnd_{name}"] = p[middle].mean()
        out[f"pressureCentreEndExact_{name}"] = 1000*np.interp(
            t[-1], exact["A0t"], exact["p_c"])
        colour = style.COLOURS[list(done).index(name)]
        panels[0].plot(t, a, color=colour, label=f"{name}: a")
        panels[0].plot(t, b, "--", color=colour, label=f"{name}: b")
    panels[0].plot(t, aExact, "o", mfc="none", color=style.REFERENCE,
                   label="exact")
    panels[0].plot(t, bExact, "o", mfc="none", color=style.REFERENCE)
    panels[0].set(xlabel="A0 t", ylabel="semi-axes / R")
    panels[0].legend()

    run = list(done.values())[0]
    time = run.case.times()[-1]
    x, p = (run.case.cloudField(time, "water", f) for f in ["x", "p"])
    points = panels[1].scatter(x[:, 0], x[:, 1], c=p, s=1, lw=0,
                               rasterized=True)
    fig.colorbar(points, label="p [Pa]")
    angle = np.linspace(0, 2*np.pi, 200)
    panels[1].plot(aExact[-1]*np.cos(angle), bExact[-1]*np.sin(angle),
                   color=style.REFERENCE, lw=0.8)
    panels[1].set(xlabel="x [m]", ylabel="y [m]", aspect="equal",
                  xlim=(-1, 1))
    panels[1].set_title("points, line exact;\np rings (see script)")
    style.save(fig, results/"ellipticalDrop.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"ellipticalDrop.csv", columns, "m and s")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: axisErrorMax_h0.05 <= 0.02")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
