"""Scenes that throw water about: drops and films at walls, lids and obstacles.
test_scatteredWater runs a few, validation/stability/sweep.py many."""

import numpy as np

from caseBuilder import RHO, CaseError, Setup, hydrostatic
from checks import meanLevel

JITTERS = [0.1, 0.25, 0.5]

# Growth of the energy over its initial value, error of the mean level
GROWTH = 1e-3
LEVEL = 5e-3


def tank(dim, n, end, solid=(), column=1/3, film=0, lid=True):
    """A closed tank of the width 0.432 m, n cells wide, with a column of water
    at its left and a film, in cells, on the rest of its floor. 3D: as deep as
    it is wide, the column a corner of it."""
    h = 0.432/n
    width = round(n*column)*h
    size = [width, width] if dim == 2 else [width, 0.432, width]
    up = dim - 1
    regions = {"column": hydrostatic((0,)*dim, size)}
    if film:
        lower, upper = [0]*dim, [0.432]*dim
        lower[0], upper[up] = width, film*h
        regions["film"] = hydrostatic(lower, upper)

    def corner(c):
        return c if dim == 2 else (c[0], 0, c[1])

    def far(c):
        return c if dim == 2 else (c[0], n, c[1])

    sides = {} if lid else {"xyz"[up] + "max": ("patch", "zeroGradient")}
    setup = Setup(cells=(n,)*dim, h=h, regions=regions, sides=sides,
                  solid=[(corner(a), far(b)) for a, b in solid])
    return setup.until(end, end/20)


SCENES = {
    f"{name}{dim}D": (lambda dim, name=name, **s: tank(
        dim, n=30 if dim == 2 else 14, end=5 if dim == 2 else 1.5, **s), dim,
        solid)
    for dim, k in [(2, 30), (3, 14)]
    for name, solid in {
        "lid": {},
        "obstacle": {"solid": [((k//2, 0), (k//2 + 2, k//6 + 1))]},
        "step": {"solid": [((2*k//3, 0), (k, k//5))]},
        "gate": {"solid": [((k//2, 3), (k//2 + 2, k))]},
        "film": {"film": 0.5}}.items()}

# On finer grids, for sweep.py where it is told so
FINER = {
    f"obstacle3D_{n}": (
        lambda dim, n=n, **s: tank(dim, n=n, end=2, **s), 3,
        {"solid": [((n//2, 0), (n//2 + max(2, n//8), n//6 + 1))]})
    for n in [16, 32]}


def made(scene, points=2, jitter=0.5, seed=1, maxCo=0.5):
    make, dim, entries = {**SCENES, **FINER}[scene]
    setup = make(dim, **entries)
    setup.points = points
    setup.mpm["maxCo"] = maxCo
    setup.placement = {"placement": "jittered", "jitter": jitter, "seed": seed}
    return setup


def levelError(case):
    """Mean level, mean of the last times, less that of the points' own volume,
    over the height of the first column; none where solids stand in the tank.
    Not over the depth at rest, of three cells: there jittered points alone,
    at rest, put the level off by 1.5 %"""
    if case.setup.solid or case.setup.dim == 3:
        return None
    width = case.setup.cells[0]*case.setup.spacing[0]
    late = [t for t in case.times if float(t) > 0.8*float(case.times[-1])]
    errors = []
    for time in late:
        points = case.points(time)
        volume = (points.mass*points.J).sum()/RHO
        errors.append(meanLevel(case, time)
                      - volume/width/case.setup.spacing[2])
    return float(np.mean(errors)/case.setup.regions["column"]["level"])


def judge(case):
    """held, and by how much: growth of the energy over its initial value,
    error of the level"""
    try:
        case.prepare().solve()
    except CaseError as error:
        lines = [line.strip() for line in str(error).splitlines() if line]
        reason = [line for line in lines if "volume ratio" in line
                  or "moved across" in line or "non-finite" in line]
        return {"held": 0, "reason": (reason or lines[-1:])[0][:120],
                "growth": "", "level": ""}
    total = case.energies()["total"] - case.floor
    growth = float((total - np.minimum.accumulate(total)).max()/total[0])
    level = levelError(case)
    held = growth <= GROWTH and abs(level or 0) <= LEVEL
    return {"held": int(held),
            "reason": "" if held else "growth or level",
            "growth": f"{growth:.3e}",
            "level": "" if level is None else f"{level:.5f}"}
