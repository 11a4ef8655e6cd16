#!/usr/bin/env python3
"""Draws the velocity profile of the last time beside Bagnold's, profile.png,
and adds the errors to metrics.json. Takes the slope in degrees."""

import sys

from mpmfoam import bagnold, metrics, style
from mpmfoam.case import Case


def main():
    flow = bagnold.row(float(sys.argv[1]))
    case = Case(".")
    fig, axis = style.figure(width=4.5, height=3.6)
    for time in [t for t in case.times() if float(t) > 0]:
        y, u, exact, errors = bagnold.compare(case, time, flow, h=1e-3)
        axis.plot(u, 1e3*y, "o", label=f"{time} s")
    axis.plot(exact, 1e3*y, color=style.REFERENCE, label="closed form")
    axis.set(xlabel="velocity [m/s]", ylabel="height [mm]")
    axis.legend()
    style.save(fig, "profile.png")
    metrics.writeMetrics(
        "metrics.json", {**metrics.readMetrics("metrics.json"), **errors})
    metrics.printTable(errors)


if __name__ == "__main__":
    main()
