"""What holds for every run, whatever it computes."""

import numpy as np


def healthy(figures, case, energy=True, start="0", bound=1e-3):
    """Finite values, exact mass of each point, no point outside of the mesh,
    at every time that was written; energy that does not grow, at each step
    that the function object materialPointEnergy wrote."""
    first = case.points(start)
    masses = dict(zip(first.id, first.mass))
    finite, outside, wrongMass, lost = 0, 0, 0, 0
    for time in case.times:
        points = case.points(time)
        values = [points.x, points.U, points.J, points.p]
        finite += sum(int(np.sum(~np.isfinite(v))) for v in values)
        finite += int(np.sum(points.J <= 0))
        outside += case.outside(points)
        lost += len(first.id) - len(points.id) - int(
            case.state(time)["left"])
        wrongMass += sum(masses[i] != m
                         for i, m in zip(points.id, points.mass))
    figures.show("times looked at", len(case.times))
    figures.equal("values that are not finite", finite, 0)
    figures.equal("points outside of the mesh", outside, 0)
    figures.equal("points lost", lost, 0)
    figures.equal("points with another mass", wrongMass, 0)
    if energy:
        # Kinetic + potential (from the lower corner of the mesh) + work of
        # the stresses
        total = case.energies()["total"] - case.floor
        figures.atMost("largest growth of the energy over its initial value",
                       total.max()/total[0] - 1, bound)


def meanLevel(case, time):
    """Mean height of the surface, alpha.water = 0.5, above the floor; seen
    from above"""
    x, y, alpha = case.case.lattice(time, "alpha.water")
    levels = []
    for column in alpha.T:
        wet = np.flatnonzero(column > 0.5)
        if not len(wet):
            levels.append(0.0)
            continue
        j = wet[-1]
        if j + 1 == len(y):
            levels.append(y[j])
            continue
        part = (column[j] - 0.5)/(column[j] - column[j + 1])
        levels.append(y[j] + part*(y[j + 1] - y[j]))
    return float(np.mean(levels)) - case.setup.bounds[0][1]
