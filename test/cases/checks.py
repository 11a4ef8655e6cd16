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


def meanLevel(case, time, clouds=("water",)):
    """Mean height over the floor of the water, or of all clouds named, that a
    mesh without solids holds: the length of each column in which their part
    of the volume is above 1/2"""
    x, y, _ = case.case.lattice(time, f"alpha.{clouds[0]}")
    alpha = sum(case.case.lattice(time, f"alpha.{c}")[2] for c in clouds)
    # Half a cell to the floor, where it is as in the lowest cell
    wet = alpha > 0.5
    length = 0.5*(y[1] - y[0])*wet[0].astype(float)
    for j in range(len(y) - 1):
        lower, upper = alpha[j], alpha[j + 1]
        change = np.where(upper == lower, 1, upper - lower)
        crossing = np.where(wet[j] == wet[j + 1], 0, (0.5 - lower)/change)
        part = np.where(wet[j] & wet[j + 1], 1.0, np.where(
            wet[j], crossing, np.where(wet[j + 1], 1 - crossing, 0.0)))
        length += part*(y[j + 1] - y[j])
    return float(np.mean(length))
