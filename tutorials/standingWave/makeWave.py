#!/usr/bin/env python3
"""Writes system/waveSurface, the outline of the water at rest on the crest of
a standing wave, y = depth + amplitude cos(mode pi x/length), as a polygon,
and system/gaugePoints, the locations of the wave gauges: the middle of each
cell along the tank."""

import argparse

import numpy as np


def pointList(rows):
    return "(\n" + "".join(
        f"    ({' '.join(f'{v:.8g}' for v in row)})\n" for row in rows) + ")\n"


def waveSurface(length, depth, amplitude, mode):
    x = np.linspace(length, 0, 1001)
    y = depth + amplitude*np.cos(mode*np.pi*x/length)
    return pointList([(0, 0), (length, 0), *zip(x, y)])


def gaugePoints(length, cells):
    h = length/cells
    return pointList([((i + 0.5)*h, 0, 0.5*h) for i in range(cells)])


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--length", type=float, default=1)
    parser.add_argument("--depth", type=float, default=0.5)
    parser.add_argument("--amplitude", type=float, default=0.01)
    parser.add_argument("--mode", type=int, default=1)
    parser.add_argument("--cells", type=int, default=40,
                        help="cells along the tank")
    a = parser.parse_args()
    with open("system/waveSurface", "w") as file:
        file.write(waveSurface(a.length, a.depth, a.amplitude, a.mode))
    with open("system/gaugePoints", "w") as file:
        file.write(gaugePoints(a.length, a.cells))


if __name__ == "__main__":
    main()
