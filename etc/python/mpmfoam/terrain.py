"""terrainToSurface: a terrain as a closed surface, for a body or a region of points.

    terrainToSurface dem.asc terrain.obj --shift -512000 -5403000 -310
    terrainToSurface profile.csv terrain.obj

Input: an ESRI ASCII grid (.asc, heights at the centres of its cells; up is z), or a
CSV of two columns, coordinate and height, for a 2D case in the plane of x and y (up
is y). Output: a Wavefront file (.obj) for constant/triSurface. The ground goes on
level beyond its ends, and down below its lowest place, so that the surface closes
outside the mesh.
"""

import argparse
import sys
from pathlib import Path

import numpy as np


def readGrid(path):
    """x, y, height[iy, ix] of an ESRI ASCII grid"""
    lines = Path(path).read_text().split("\n")
    head, n = {}, 0
    while n < len(lines) and lines[n].split() \
            and lines[n].split()[0][0].isalpha():
        words = lines[n].split()
        try:
            head[words[0].lower()] = float(words[1])
        except (IndexError, ValueError):
            sys.exit(f"{path}, line {n + 1}: {lines[n]}. Allowed: a name and"
                     " a number")
        n += 1
    for name in ("ncols", "nrows", "cellsize"):
        if name not in head:
            sys.exit(f"{path}: no {name}. Allowed: an ESRI ASCII grid")
    nx, ny, d = int(head["ncols"]), int(head["nrows"]), head["cellsize"]
    try:
        height = np.array(" ".join(lines[n:]).split(), float)
    except ValueError as error:
        sys.exit(f"{path}: {error}. Allowed: numbers")
    if height.size != nx*ny:
        sys.exit(f"{path}: {height.size} heights. Allowed: ncols nrows ="
                 f" {nx*ny}")
    missing = np.count_nonzero(height == head.get("nodata_value", np.nan))
    if missing:
        sys.exit(f"{path}: {missing} heights are NODATA. Allowed: none; fill"
                 " them first")
    # Rows come from the north
    height = height.reshape(ny, nx)[::-1]
    low = [head.get(f"{a}llcenter", head.get(f"{a}llcorner", 0)
                    + (0 if f"{a}llcenter" in head else 0.5*d))
           for a in "xy"]
    return low[0] + d*np.arange(nx), low[1] + d*np.arange(ny), height


def readProfile(path):
    """x, height of a CSV; lines that are no numbers are titles"""
    rows = []
    for line in Path(path).read_text().splitlines():
        try:
            rows.append([float(v) for v in line.split(",")[:2]])
        except ValueError:
            continue
    rows = np.array([r for r in rows if len(r) == 2])
    if len(rows) < 2 or np.any(np.diff(rows[:, 0]) <= 0):
        sys.exit(f"{path}: Allowed: two rows or more of coordinate and height,"
                 " coordinates rising")
    return rows[:, 0], rows[:, 1]


def surface(x, y, height, depth, margin):
    """Vertices and triangles (outwards) of the ground over a level bottom"""
    x = np.concatenate(([x[0] - margin], x, [x[-1] + margin]))
    y = np.concatenate(([y[0] - margin], y, [y[-1] + margin]))
    height = np.pad(height, 1, mode="edge")
    nx, ny = len(x), len(y)
    X, Y = np.meshgrid(x, y)
    bottom = height.min() - depth
    points = np.concatenate([
        np.stack([X, Y, height], -1).reshape(-1, 3),
        np.stack([X, Y, np.full_like(X, bottom)], -1).reshape(-1, 3)])

    number = np.arange(nx*ny).reshape(ny, nx)
    a, b = number[:-1, :-1].ravel(), number[:-1, 1:].ravel()
    c, d = number[1:, 1:].ravel(), number[1:, :-1].ravel()
    top = np.concatenate([np.stack(t, 1) for t in [(a, b, c), (a, c, d)]])
    under = top[:, ::-1] + nx*ny
    # Around, anticlockwise as seen from above
    rim = np.concatenate([number[0, :], number[1:, -1], number[-1, -2::-1],
                          number[-2:0:-1, 0]])
    p, q = rim, np.roll(rim, -1)
    sides = np.concatenate([
        np.stack([p, p + nx*ny, q], 1), np.stack([q, p + nx*ny, q + nx*ny], 1)])
    return points, np.concatenate([top, under, sides])


def volume(points, triangles):
    """Of a closed surface"""
    a, b, c = (points[triangles[:, k]] - points.mean(0) for k in range(3))
    return float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum()/6)


def main(arguments=None):
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter,
        prog="terrainToSurface")
    parser.add_argument("input", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--depth", type=float,
                        help="of the bottom below the lowest place [m]"
                             " (default: the length of the terrain)")
    parser.add_argument("--margin", type=float,
                        help="how far the ground goes on beyond its ends [m]"
                             " (default: the length of the terrain)")
    parser.add_argument("--shift", type=float, nargs=3, default=(0, 0, 0),
                        metavar=("X", "Y", "Z"),
                        help="added to all coordinates [m]: files in ascii need"
                             " more digits far from the origin")
    options = parser.parse_args(arguments)
    if options.output.suffix != ".obj":
        parser.error(f"{options.output}: Allowed: a name that ends in .obj")

    flat = options.input.suffix == ".csv"
    if flat:
        x, z = readProfile(options.input)
        y, height = np.array([-0.5, 0.5])*(x[-1] - x[0]), np.stack([z, z])
    else:
        x, y, height = readGrid(options.input)
    length = max(np.ptp(x), np.ptp(y))
    for name in ("depth", "margin"):
        if getattr(options, name) is None:
            setattr(options, name, length)
        if not getattr(options, name) > 0:
            parser.error(f"--{name}: Allowed: > 0 m")
    points, triangles = surface(x, y, height, options.depth, options.margin)
    if flat:
        # Up is y
        points = np.stack([points[:, 0], points[:, 2], -points[:, 1]], 1)
    points = points + options.shift

    options.output.parent.mkdir(parents=True, exist_ok=True)
    with options.output.open("w") as file:
        file.write(f"# {options.input} by terrainToSurface\n")
        np.savetxt(file, points, fmt="v %.9g %.9g %.9g")
        np.savetxt(file, triangles + 1, fmt="f %d %d %d")
    low, high = points.min(0), points.max(0)
    print(f"{options.output}: {len(triangles)} triangles, from"
          f" ({' '.join(f'{v:.6g}' for v in low)}) to"
          f" ({' '.join(f'{v:.6g}' for v in high)}) m")


if __name__ == "__main__":
    main()
