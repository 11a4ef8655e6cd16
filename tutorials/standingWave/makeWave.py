#!/usr/bin/env python3
"""Writes system/waveSurface, the outline of the water at rest on the crest of
a standing wave, y = depth + amplitude cos(mode pi x/L), as a polygon, and
system/gaugePoints, the locations of the wave gauges: the middle of each cell
along the tank."""

import argparse

import numpy as np


def points(rows):
    return "(\n" + "".join(
        f"    ({' '.join(f'{v:.8g}' for v in row)})\n" for row in rows) + ")\n"


parser = argparse.ArgumentParser(description=__doc__)
parser.add_argument("--length", type=float, default=1)
parser.add_argument("--depth", type=float, default=0.5)
parser.add_argument("--amplitude", type=float, default=0.01)
parser.add_argument("--mode", type=int, default=1)
parser.add_argument("--cells", type=int, default=40,
                    help="cells along the tank")
arguments = parser.parse_args()

L = arguments.length
x = np.linspace(L, 0, 1001)
y = arguments.depth + arguments.amplitude*np.cos(arguments.mode*np.pi*x/L)
with open("system/waveSurface", "w") as file:
    file.write(points([(0, 0), (L, 0), *zip(x, y)]))

h = L/arguments.cells
with open("system/gaugePoints", "w") as file:
    file.write(points([((i + 0.5)*h, 0, 0.5*h)
                       for i in range(arguments.cells)]))
