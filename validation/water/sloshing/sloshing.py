#!/usr/bin/env python3
"""Sloshing over 1e5 steps: does the mean level stay?

A tank 1 m long, 0.5 m of water, started on the crest of its first mode with an
amplitude of 0.05 m; h = depth/16, 9 and 16 points per cell."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from common import TUTORIALS, study  # noqa: E402
from mpmfoam import metrics, reference, style  # noqa: E402
from mpmfoam.postProcessing import readDat  # noqa: E402

TUTORIAL = TUTORIALS/"standingWave"
sys.path.insert(0, str(TUTORIAL))

from makeWave import gaugePoints, waveSurface  # noqa: E402

LENGTH, HEIGHT, DEPTH, AMPLITUDE = 1, 0.625, 0.5, 0.05
SPACING = DEPTH/16
STEPS = 1e5
END = 71            # s, a little more than 1e5 steps
# The level swings with the wave, twice per period: the lasting change is that
# of the mean over several periods
WINDOW = 6          # s, five periods


def runs():
    return [study.Run(
        f"p{points}", [TUTORIAL], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": SPACING, "nx": round(LENGTH/SPACING),
            "ny": round(HEIGHT/SPACING)},
         "system/setMaterialPointsDict": {"water/pointsPerDirection": points},
         "constant/materialPointProperties": {
             "water/weaklyCompressibleNewtonianCoeffs/soundSpeed": "auto"},
         "system/controlDict": {
             "endTime": END, "writeInterval": END/2,
             "functions/gauge/writeInterval": 0.02,
             "functions/energy/writeInterval": 0.02}},
        {"system/waveSurface": waveSurface(LENGTH, DEPTH, AMPLITUDE, 1),
         "system/gaugePoints": gaugePoints(LENGTH, round(LENGTH/SPACING))},
        about={"points": points}) for points in [3, 4]]


def evaluate(done, results):
    out, columns = {}, {"run": [], "t": [], "level": [], "kineticPotential": []}
    fig, axes = style.figure(1, 2, width=9, height=2.8)
    for name, run in done.items():
        gauge = readDat(run.path, "gauge", "waveGauge.dat")
        energy = readDat(run.path, "energy", "energy.dat")
        t, level = gauge[:, 0], gauge[:, -1]/gauge[0, -1] - 1
        mechanical = energy[:, 1] + energy[:, 2]
        mechanical = np.interp(t, energy[:, 0], mechanical/mechanical[0])
        m = [run.case.cloudField(time, "water", "mass").sum()
             for time in (run.case.times()[0], run.case.times()[-1])]
        windows = [level[(t >= a) & (t < a + WINDOW)].mean()
                   for a in np.arange(0, t[-1] - WINDOW, WINDOW/2)]
        out[f"stepCount_{name}"] = run.log.stepCount
        out[f"meanLevelChangeMax_{name}"] = np.abs(level).max()
        out[f"meanLevelChangeMeanMax_{name}"] = np.abs(windows).max()
        out[f"meanLevelChangeEnd_{name}"] = level[t > t[-1] - WINDOW].mean()
        out[f"massError_{name}"] = m[1]/m[0] - 1
        out[f"kineticPotentialEnd_{name}"] = mechanical[-1]
        for key, values in zip(columns, [[name]*len(t), t, level, mechanical]):
            columns[key] += list(values[::5])
        axes[0].plot(t, 100*level, lw=0.5, label=name)
        axes[1].plot(t, gauge[:, 1] - DEPTH, lw=0.5, label=name)
        if run.log.stepCount < STEPS:
            print(f"    CAUTION: {name} made {run.log.stepCount} steps only")
    provenance = study.provenance(done)
    out.update(provenance)
    for bound in [-0.3, 0.3]:
        axes[0].axhline(bound, color=style.REFERENCE, lw=0.6)
    axes[0].set(xlabel="time [s]", ylabel="change of the mean level [%]")
    axes[0].set_title(f"commit {provenance.get('commit')}, "
                      f"{provenance.get('date')}; lines: bound")
    axes[1].set(xlabel="time [s]", ylabel="surface at the left wall [m]")
    axes[0].legend()
    style.save(fig, results/"sloshing.png")
    reference.writeCsv(results/"sloshing.csv", columns,
                       "level: change of the mean level; kinetic + potential "
                       "energy over the initial")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: |meanLevelChange| <= 0.003 over 1e5 steps")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
