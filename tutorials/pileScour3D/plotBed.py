#!/usr/bin/env python3
"""Change of the level of the bed around the pile, from the mass of the grains over
each column of cells, and the stress on it: bed.png"""

import os
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(os.environ["MPMFOAM_DIR"])/"etc"/"python"))

from mpmfoam import style  # noqa: E402
from mpmfoam.case import Case  # noqa: E402

H, D = 0.025, 0.125
X, Y = np.arange(-0.2, 0.3 + H/2, H), np.arange(0, 0.2 + H/2, H)
BULK = 2650/1.667


def level(case, time):
    """Mean height of the grains of each column [m]"""
    x = case.cloudField(time, "soil", "x")
    mass = case.cloudField(time, "soil", "mass")
    volume = np.histogram2d(x[:, 0], x[:, 1], (X, Y), weights=mass/BULK)[0]
    return volume/H**2


def stress(case, time):
    """Of the grains in the uppermost cell [Pa]"""
    x = case.cloudField(time, "soil", "x")
    tau = np.linalg.norm(case.cloudField(time, "soil", "bedStress"), axis=1)
    top = x[:, 2] > -H
    n, total = (np.histogram2d(x[top, 0], x[top, 1], (X, Y), weights=w)[0]
                for w in [None, tau[top]])
    return np.where(n > 0, total/np.maximum(n, 1), np.nan)


def main():
    case = Case(Path("."))
    end = case.times()[-1]
    change = 1e3*(level(case, end) - level(case, "0"))
    tau = stress(case, end)
    fig, axes = style.plt.subplots(1, 2, figsize=(8, 3), layout="constrained")
    panels = [
        (change, "change of the bed, mm", "RdBu_r", np.abs(change).max()),
        (tau, "stress on the bed, Pa", "viridis", None)]
    for ax, (values, title, colours, limit) in zip(axes, panels):
        # Both halves
        both = np.concatenate([values[:, ::-1], values], axis=1)
        ax.grid(False)
        image = ax.pcolormesh(
            X/D, np.concatenate([-Y[:0:-1], Y])/D, both.T, cmap=colours,
            vmin=-limit if limit else None, vmax=limit)
        t = np.linspace(0, 2*np.pi, 60)
        ax.fill(0.5*np.cos(t), 0.5*np.sin(t), color="0.6")
        ax.set(xlabel="x/D", ylabel="y/D", aspect="equal",
               title=f"{title}, {end} s")
        fig.colorbar(image, ax=ax, shrink=0.7)
    style.save(fig, "bed.png")
    near = np.hypot(*np.meshgrid(X[:-1] + H/2, Y[:-1] + H/2,
                                 indexing="ij")) < D
    print(f"deepest within D of the axis: {-change[near].min():.1f} mm,"
          f" largest stress there {np.nanmax(tau[near]):.2f} Pa,"
          f" mean {np.nanmean(tau):.2f} Pa")


main()
