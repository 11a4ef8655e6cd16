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
# The jittered points settle first: means are taken from here on, and the peak
# over all of the run is given beside them
SETTLED = 1.0       # s
SEEDS = [1, 2, 3, 4, 5]
# 5 s are too short to see sound that grows slowly: two runs of 20 s, judged by
# the mean pressure of the lowest layer of cells, written out of step with
# that sound (11 Hz)
LONG = dict(endTime=20, writeInterval=0.13)
WINDOW = 4          # s, at the start and at the end of the long runs


def runs():
    return [waterRun(
        f"width{length:g}_p{points}_seed{seed}", HERE/"case",
        {"system/blockMeshDict": {"length": length,
                                  "nx": round(length/SPACING)},
         "system/setMaterialPointsDict": {
             "water/seed": seed,
             "water/regions/column/max": (length, DEPTH, 1),
             "water/pointsPerDirection": points}},
        length=length, points=points, seed=seed)
        for length in [0.5, 1] for points in [3, 4] for seed in SEEDS] + [
        waterRun(
            f"long_{placement}", HERE/"case",
            {"system/controlDict": LONG,
             "system/setMaterialPointsDict": {
                 "water/placement": placement,
                 "water/regions/column/max": (0.5, DEPTH, 1)}},
            length=0.5, points=4, long=True)
        for placement in ["jittered", "regular"]]


def floorPressure(run):
    """Time and mean pressure error of the lowest layer over rho g H"""
    t, error = [], []
    for time in run.case.times()[1:]:
        x, p = (run.case.cloudField(time, "water", f) for f in ["x", "p"])
        low = x[:, 1] < SPACING
        t.append(float(time))
        error.append((p - RHO*G*(DEPTH - x[:, 1]))[low].mean()/(RHO*G*DEPTH))
    return np.array(t), np.array(error)


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
    out, columns, groups = {}, {}, {}
    fig, axes = style.figure(1, 3, width=9, height=2.8)
    for name, run in done.items():
        if run.about.get("long"):
            t, error = floorPressure(run)
            out[f"floorPressureStdStart_{name}"] = error[t <= WINDOW].std()
            out[f"floorPressureStdEnd_{name}"] = \
                error[t > t[-1] - WINDOW].std()
            axes[2].plot(t, 100*error, lw=0.6, label=name[5:])
            continue
        s = series(run)
        columns.setdefault("run", []).extend([name]*len(s["t"]))
        for key, values in s.items():
            columns.setdefault(key, []).extend(values)
        groups.setdefault(
            (run.about["length"], run.about["points"]), []).append(s)

    # For each set-up the mean over the seeds and the worst of them
    for (length, points), group in groups.items():
        name = f"width{length:g}_p{points}"
        late = group[0]["t"] >= SETTLED
        found = {}
        for place in ["noise", "noiseWall"]:
            key = place.replace("noise", "pressureNoise")
            found[f"{key}Settled"] = [s[place][late].mean() for s in group]
            found[f"{key}End"] = [s[place][-1] for s in group]
            found[f"{key}Peak"] = [s[place].max() for s in group]
        found["centreOfMassDriftPeak"] = [s["shift"].max() for s in group]
        found["speedRmsSettled"] = [s["speed"][late].mean() for s in group]
        for key, values in found.items():
            out[f"{key}_{name}"] = np.mean(values)
            out[f"{key}Worst_{name}"] = np.max(values)
        out[f"seeds_{name}"] = len(group)

        t = group[0]["t"]
        label = f"{length:g} m, {points}$^2$ points"
        for ax, key in [(axes[0], "noise"), (axes[1], "shift")]:
            values = 100*np.array([s[key] for s in group])
            line, = ax.plot(t, values.mean(axis=0), label=label)
            ax.fill_between(t, values.min(axis=0), values.max(axis=0),
                            color=line.get_color(), alpha=0.2, lw=0)
            if key == "noise":
                wall = 100*np.array([s["noiseWall"] for s in group])
                ax.plot(t, wall.mean(axis=0), ":", color=line.get_color())

    axes[0].set(xlabel="time [s]", ylim=(0, None),
                ylabel="rms(p - rho g z) / rho g H [%]")
    axes[0].axhline(1, color=style.REFERENCE, lw=0.6)
    axes[0].set_title("bands: seeds; dotted: at the walls")
    axes[1].set(xlabel="time [s]", ylabel="centre of mass shift / H [%]")
    axes[1].legend()
    axes[2].set(xlabel="time [s]", ylabel="floor: p error / rho g H [%]")
    axes[2].set_title("long runs, 0.5 m, 4$^2$ points")
    axes[2].legend()
    style.save(fig, results/"hydrostatic.png")

    out.update(study.provenance(done))
    reference.writeCsv(results/"hydrostatic.csv", columns,
                       "noise and shift over rho g H and H; speed in m/s")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: noise <= 0.01, also at the wall; "
                            "drift <= 0.001; floorPressureStd "
                            "should not grow")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
