#!/usr/bin/env python3
"""Start-up of Couette and Poiseuille flow in a cyclic channel of 16 cells."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from common import study, waterRun  # noqa: E402
from mpmfoam import metrics, reference, style  # noqa: E402

HEIGHT, NU, SPEED = 1e-3, 1e-6, 1e-3
FORCE = 8*NU*SPEED/HEIGHT**2
# Before, the layer at the wall is thinner than two cells
RESOLVED = 0.05


def runs():
    moving = "{ type fixedValue; value uniform " f"({SPEED} 0 0);" " }"
    return [
        waterRun("couette", HERE/"case",
                 {"0.orig/U.water": {"boundaryField/upper": moving}}),
        waterRun("poiseuille", HERE/"case",
                 {"constant/g": {"value": (FORCE, 0, 0)}})]


def profile(case, time):
    """Mean velocity of each row of points and its height; points stay in
    their rows as long as they move along the channel only"""
    x, u = (case.cloudField(time, "water", f) for f in ["x", "U"])
    order = np.argsort(x[:, 1])
    rows = np.array_split(order, 4*16)
    y = np.array([x[r, 1].mean() for r in rows])
    return y/HEIGHT, np.array([u[r, 0].mean() for r in rows])/SPEED, \
        np.abs(u[:, 1]).max()/SPEED


def evaluate(done, results):
    exact = reference.data("ana_couette_poiseuille_startup.csv")
    names = {"couette": "u_couette_over_U",
             "poiseuille": "u_poiseuille_over_umax"}
    walls = {"couette": (0, 1), "poiseuille": (0, 0)}
    out = {}
    columns = {"run": [], "T": [], "y_over_H": [], "u": [], "uExact": []}
    fig, axes = style.figure(1, 2, width=8, height=3.2)
    for ax, name in zip(axes, names):
        if name not in done:
            continue
        case, worst = done[name].case, 0
        for i, time in enumerate(np.unique(exact["T"])):
            at = exact["T"] == time
            yExact, uExact = exact["y_over_H"][at], exact[names[name]][at]
            y, u, across = profile(case, case.nearestTime(time))
            lower, upper = walls[name]
            found = np.interp(yExact, [0, *y, 1], [lower, *u, upper])
            error = np.abs(found - uExact).max()
            out[f"velocityErrorMax_{name}_T{time:g}"] = error
            if time >= RESOLVED:
                worst = max(worst, error)
            columns["run"] += [name]*len(yExact)
            columns["T"] += [time]*len(yExact)
            columns["y_over_H"] += list(yExact)
            columns["u"] += list(found)
            columns["uExact"] += list(uExact)
            ax.plot(u, y, color=style.COLOURS[i], label=f"T = {time:g}")
            ax.plot(uExact, yExact, "o", mfc="none",
                    color=style.COLOURS[i])
        out[f"velocityErrorMax_{name}"] = worst
        out[f"velocityAcross_{name}"] = across
        ax.set(xlabel="u / U", ylabel="y / H")
        ax.set_title(f"{name}: lines mpmFoam, circles exact")
        ax.legend()
    style.save(fig, results/"channel.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"channel.csv", columns,
                       "velocities over U; T = nu t/H^2")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: error <= 0.01 at 16 cells "
                            f"(T >= {RESOLVED:g})")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
