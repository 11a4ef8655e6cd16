#!/usr/bin/env python3
"""What the function object erosionCriteria (under the name erosion) found:
velocity profiles over the bed beside the critical shear velocities, and a map
over place and time of where a criterion is exceeded and where grains move.

    $MPMFOAM_PYTHON $MPMFOAM_DIR/etc/python/plotErosion.py \\
        [--case <dir>] [--time 0.5] [--criterion Shields]

Writes erosion.png into the case (paper: Fig. 24), and to standard output how
often the criterion and the grains agree. Their agreement is no proof of either:
the shear velocity is that of a law fitted to a few cells.
"""

import argparse
from pathlib import Path

import numpy as np

from mpmfoam import metrics, style
from mpmfoam.case import Case
from mpmfoam.postProcessing import agreement, erosionMaps


def profiles(case, time):
    """Name of the written time nearest to it, and the table"""
    found = {p.parent.name: p for p in (
        case.path/"postProcessing"/"erosion").rglob("velocityProfiles.csv")}
    if not found:
        raise FileNotFoundError(f"{case.path}: no velocityProfiles.csv")
    name = min(found, key=lambda t: abs(float(t) - time))
    return name, np.genfromtxt(found[name], delimiter=",", names=True,
                               comments="#")


def drawProfiles(panel, case, time, critical):
    name, table = profiles(case, time)
    for x in np.unique(table["x"]):
        here = table[table["x"] == x]
        panel.plot(here["water"], here["height"], "o-", ms=2,
                   label=f"x = {x:.3g} m")
    for (criterion, speed), line in zip(critical.items(), ["--", "-.", ":"]):
        panel.axvline(speed, color=style.REFERENCE, ls=line, lw=0.9,
                      label=f"{criterion}, {speed:.3g} m/s")
    panel.axhline(0, color="0.6", lw=0.6)
    panel.set(xlabel="velocity of the water [m/s]",
              ylabel="height over the bed [m]", title=f"{name} s")
    panel.legend(fontsize="x-small")


def drawMap(panel, fig, found, criterion):
    x, t = found["x"], found["time"]
    # 0 neither, 1 exceeded only, 2 moves only, 3 both
    state = (found["exceeded"][criterion] > 0) + 2*found["moves"]
    state = np.where(found["hasBed"], state, np.nan)
    panel.grid(False)
    colours = style.plt.matplotlib.colors.ListedColormap(
        ["0.9", style.COLOURS[4], style.COLOURS[5], style.COLOURS[2]])
    image = panel.pcolormesh(x, t, state, cmap=colours, vmin=-0.5, vmax=3.5,
                             shading="nearest", rasterized=True)
    bar = fig.colorbar(image, ax=panel, ticks=range(4))
    bar.ax.set_yticklabels(
        ["neither", "exceeded", "grains move", "both"], fontsize="small")
    bed = x[found["hasBed"].any(axis=0)]
    panel.set(xlabel="x [m]", ylabel="t [s]", xlim=(bed[0], bed[-1]),
              title=f"{criterion} exceeded, grains faster than "
              f"{found['movingSpeed']:g} m/s")


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--case", default=".", type=Path)
    parser.add_argument("--time", type=float, default=0,
                        help="of the velocity profiles [s] (default: first)")
    parser.add_argument("--criterion", default="Shields")
    arguments = parser.parse_args()

    case = Case(arguments.case)
    found = erosionMaps(case.path)
    if arguments.criterion not in found["exceeded"]:
        parser.error(f"no criterion {arguments.criterion}; there is "
                     + " ".join(found["exceeded"]))

    fig, panels = style.plt.subplots(
        1, 2, figsize=(9.5, 3.8), layout="constrained",
        gridspec_kw={"width_ratios": [1, 1.5]})
    drawProfiles(panels[0], case, arguments.time, found["criticalSpeed"])
    drawMap(panels[1], fig, found, arguments.criterion)
    style.save(fig, case.path/"erosion.png")
    metrics.printTable(agreement(found, arguments.criterion),
                       f"{arguments.criterion} beside grains that move")


if __name__ == "__main__":
    main()
