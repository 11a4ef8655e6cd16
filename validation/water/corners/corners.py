#!/usr/bin/env python3
"""A jet under a gate's lip and over the edge of a step: are velocities near the corners smooth?"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from common import G, study, waterRun  # noqa: E402
from mpmfoam import metrics, style  # noqa: E402

# Convex corners of the solid that water touches, the level that drives the
# flow, and the solid itself as boxes (x0, x1, y0, y1). The jet leaves the gate
# at its upstream edge and does not touch the downstream one.
SCENES = {
    "gate": dict(
        h=0.005, level=0.20,
        corners={"lip": (0.20, 0.10), "edge of the step": (0.40, 0.05)},
        solids=[(0, 0.40, 0, 0.05), (0.20, 0.24, 0.10, 0.25)]),
    "step": dict(
        h=0.004, level=0.20,
        corners={"front edge": (0.20, 0.048), "rear edge": (0.224, 0.048)},
        solids=[(0.20, 0.224, 0, 0.048)]),
}
NEAR = 2.0          # cells from the corner
TOLERANCE = 1e-9    # m; a point on a wall is not inside it


def runs():
    return [waterRun(name, HERE/name, **scene)
            for name, scene in SCENES.items()]


def evaluate(done, results):
    out, touched = {}, {}
    for name, run in done.items():
        scene, case = run.about, run.case
        h, level = scene["h"], scene["level"]
        inside, fastest, roughest = 0, 0, 0
        for time in case.times()[1:]:
            x, u = (case.cloudField(time, "water", f)[:, :2]
                    for f in ["x", "U"])
            speed = np.linalg.norm(u, axis=1)
            # Steady flow is no faster than a fall from the first level; an
            # impact may be
            limit = np.sqrt(2*G*np.maximum(level - x[:, 1], h))
            for x0, x1, y0, y1 in scene["solids"]:
                inside += np.sum(
                    (x[:, 0] > x0 + TOLERANCE) & (x[:, 0] < x1 - TOLERANCE)
                    & (x[:, 1] > y0 + TOLERANCE) & (x[:, 1] < y1 - TOLERANCE))
            for label, corner in scene["corners"].items():
                near = np.linalg.norm(x - corner, axis=1) < NEAR*h
                if near.sum() < 10:
                    continue
                touched[name, label] = max(
                    touched.get((name, label), (0, None)),
                    (speed[near].sum(), time))
                fastest = max(fastest, (speed/limit)[near].max())
                roughest = max(roughest, roughness(x[near], u[near]))
        out[f"pointsInSolid_{name}"] = int(inside)
        out[f"speedOverFallMaxAtCorners_{name}"] = fastest
        out[f"roughnessMaxAtCorners_{name}"] = roughest
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: no spurious velocities at corners "
                            "(figure); no point in a solid")
    for name, run in done.items():
        for label in run.about["corners"]:
            if (name, label) not in touched:
                print(f"    CAUTION: no water at {name}, {label}: not tested")
    draw(done, touched, results)


def roughness(x, u):
    """rms of what a quadratic in x and y leaves of the velocity, over the rms
    speed: 0 for a smooth field"""
    d = (x - x.mean(axis=0))/np.ptp(x, axis=0).max()
    basis = np.stack([np.ones(len(d)), d[:, 0], d[:, 1], d[:, 0]**2,
                      d[:, 0]*d[:, 1], d[:, 1]**2], axis=1)
    rest = u - basis @ np.linalg.lstsq(basis, u, rcond=None)[0]
    return np.sqrt((rest**2).sum()/(u**2).sum())


def draw(done, touched, results):
    """Each corner at the write time when the flow past it is strongest"""
    fig, axes = style.plt.subplots(
        2, 2, figsize=(8, 7.2), layout="constrained")
    for ax in axes.flat[len(touched):]:
        ax.axis("off")
    for ax, ((name, label), (_, time)) in zip(axes.flat, touched.items()):
        run = done[name]
        case, h = run.case, run.about["h"]
        corner = run.about["corners"][label]
        x, u = (case.cloudField(time, "water", f)[:, :2] for f in ["x", "U"])
        near = np.abs(x - corner).max(axis=1) < 5*h
        x, u = x[near], u[near]
        speed = np.linalg.norm(u, axis=1)
        for x0, x1, y0, y1 in run.about["solids"]:
            ax.add_patch(style.plt.Rectangle(
                (x0, y0), x1 - x0, y1 - y0, color="0.85", zorder=0))
        arrows = ax.quiver(x[:, 0], x[:, 1], u[:, 0], u[:, 1], speed,
                           angles="xy", scale_units="xy",
                           scale=(speed.max() or 1)/(1.2*h), width=0.003)
        fig.colorbar(arrows, label="speed [m/s]", shrink=0.8)
        ax.set(aspect="equal", xlim=(corner[0] - 5*h, corner[0] + 5*h),
               ylim=(corner[1] - 5*h, corner[1] + 5*h))
        ax.set_xticks(corner[0] + h*np.arange(-4, 5, 2))
        ax.set_yticks(corner[1] + h*np.arange(-4, 5, 2))
        ax.set_title(f"{run.name}: {label}, {time} s")
    style.save(fig, results/"corners.png")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
