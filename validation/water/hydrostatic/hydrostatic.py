#!/usr/bin/env python3
"""A column of water at rest, jittered points, 5 s: noise of the pressure at
the points and drift of the centre of mass."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from common import G, RHO, study, waterRun  # noqa: E402
from mpmfoam import metrics, reference, style  # noqa: E402

DEPTH = 0.5
SPACING = DEPTH/16
SETTLED = 1.0       # s; the mean noise is taken from here on


def runs():
    return [waterRun(
        f"width{length:g}_p{points}", HERE/"case",
        {"system/blockMeshDict": {"length": length,
                                  "nx": round(length/SPACING)},
         "system/setMaterialPointsDict": {
             "water/regions/column/max": (length, DEPTH, 1),
             "water/pointsPerDirection": points}},
        length=length, points=points)
        for length in [0.5, 1] for points in [3, 4]]


def series(run):
    """Noise (rms of p - rho g depth over rho g H), also within one cell of
    the walls; shift of the centre of mass over H; rms speed"""
    case, length = run.case, run.about["length"]
    out = {name: [] for name in ["t", "noise", "noiseWall", "shift", "speed"]}
    start = None
    for time in case.times():
        x, p, u, m = (case.cloudField(time, "water", f)
                      for f in ["x", "p", "U", "mass"])
        error = (p - RHO*G*(DEPTH - x[:, 1]))/(RHO*G*DEPTH)
        wall = (x[:, 0] < SPACING) | (x[:, 0] > length - SPACING) \
            | (x[:, 1] < SPACING)
        centre = (m[:, None]*x).sum(axis=0)/m.sum()
        start = centre if start is None else start
        out["t"].append(float(time))
        out["noise"].append(rms(error))
        out["noiseWall"].append(rms(error[wall]))
        out["shift"].append(np.abs((centre - start)[:2]).max()/DEPTH)
        out["speed"].append(rms(np.linalg.norm(u, axis=1)))
    return {name: np.array(values) for name, values in out.items()}


def rms(values):
    return np.sqrt(np.mean(values**2))


def evaluate(done, results):
    out, columns = {}, {}
    fig, axes = style.figure(1, 3, width=9, height=2.8)
    for name, run in done.items():
        s = series(run)
        late = s["t"] >= SETTLED
        out[f"pressureNoise_{name}"] = s["noise"][late].mean()
        out[f"pressureNoiseMax_{name}"] = s["noise"][late].max()
        out[f"pressureNoiseWall_{name}"] = s["noiseWall"][late].mean()
        out[f"centreOfMassDriftMax_{name}"] = s["shift"].max()
        out[f"speedRms_{name}"] = s["speed"][late].mean()
        columns.setdefault("run", []).extend([name]*len(s["t"]))
        for key, values in s.items():
            columns.setdefault(key, []).extend(values)

        label = f"{run.about['length']:g} m, {run.about['points']}$^2$ points"
        line, = axes[0].plot(s["t"], 100*s["noise"], label=label)
        axes[0].plot(s["t"], 100*s["noiseWall"], ":", color=line.get_color())
        axes[1].plot(s["t"], 100*s["shift"], label=label)

    run = list(done.values())[-1]
    x, p = (run.case.cloudField(run.case.times()[-1], "water", f)
            for f in ["x", "p"])
    axes[2].plot(p/(RHO*G*DEPTH), x[:, 1]/DEPTH, ",", color=style.MPM)
    axes[2].plot([1, 0], [0, 1], color=style.REFERENCE, lw=0.8)
    axes[0].set(xlabel="time [s]", ylim=(0, None),
                ylabel="rms(p - rho g z) / rho g H [%]")
    axes[0].set_title("dotted: within a cell of the walls")
    axes[1].set(xlabel="time [s]", ylabel="centre of mass shift / H [%]")
    axes[1].legend()
    axes[2].set(xlabel="p / rho g H", ylabel="y / H")
    axes[2].set_title(f"points of {run.name} at 5 s")
    style.save(fig, results/"hydrostatic.png")

    out["commit"] = study.commit()
    reference.writeCsv(results/"hydrostatic.csv", columns,
                       "noise and shift over rho g H and H; speed in m/s")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: noise <= 0.01, also at the wall; "
                            "drift <= 0.001")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
