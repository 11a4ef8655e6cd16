#!/usr/bin/env python3
"""A dam break through a fixed block of crushed rock, against the free surfaces
that Liu, Lin, Chang and Sakakiyama (1999) measured.

No number here is tuned: the drag is Ergun's with the rock's diameter and
porosity. The gate is gone at once."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

LENGTH, HEIGHT = 0.89, 0.4
BLOCK = (0.3, 0.59)
DEPTH = 0.24                                    # of the water behind the gate
TIMES = [0, 0.2, 0.4, 0.6, 0.8, 1.0]
GATE = 0.1                                      # it takes that long to open, s


def dam(name, h, settings=None, **about):
    return study.Run(
        name, [HERE/"case"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(LENGTH/h), "ny": round(HEIGHT/h)},
         **(settings or {})},
        about={"h": h, **about})


DRAG = "constant/materialPointProperties"
RUNS = [dam("h0.01", 0.01), dam("h0.005", 0.005),
        # How much of it is drag
        dam("h0.01_noDrag", 0.01, {DRAG: {"interaction/drag": "none"}})]


def surface(case, time):
    """Height of the free surface by column: where water fills half of the
    room that the rock leaves, from above; linear between centres of cells,
    the depth where it is less than half a cell"""
    x, y, alpha = case.lattice(time, "alpha.water")
    h = y[1] - y[0]
    filled = alpha/(1 - case.lattice(time, "alpha.soil")[2])
    level = np.zeros(len(x))
    for i, column in enumerate(filled.T):
        full = np.nonzero(column >= 0.5)[0]
        if not len(full):
            level[i] = column.sum()*h
            continue
        j = full[-1]
        above = column[j + 1] if j + 1 < len(y) else 0
        level[i] = y[j] + h*(column[j] - 0.5)/(column[j] - above)
    return x, level


def measured(time):
    data = reference.data(f"exp_porousDamBreak_t{time:.1f}.csv")
    return data["x_m"], data["y_m"]


class Surfaces:
    """Of a run at any time, linear between the times written"""

    def __init__(self, case):
        self.t = np.array(case.times(), dtype=float)
        self.x, _ = surface(case, case.times()[0])
        self.levels = np.array([surface(case, t)[1] for t in case.times()])

    def __call__(self, time):
        time = np.clip(time, 0, self.t[-1])
        i = min(np.searchsorted(self.t, time, "right"), len(self.t) - 1)
        f = (time - self.t[i - 1])/(self.t[i] - self.t[i - 1])
        return (1 - f)*self.levels[i - 1] + f*self.levels[i]

    def error(self, time, lag=0.0):
        x, y = measured(time)
        return np.interp(x, self.x, self(time - lag)) - y


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def measures(run):
    levels = Surfaces(run.case)
    out = {}
    for time in TIMES[1:]:
        error = levels.error(time)
        x, y = measured(time)
        out[f"rms_t{time:g}"] = rms(error)/DEPTH
        out[f"levelBehindGateError_t{time:g}"] = error[x < 0.28].mean()/DEPTH
    every = lambda lag: rms(np.concatenate(
        [levels.error(t, lag) for t in TIMES[1:]]))/DEPTH
    out["rms"] = every(0)
    # As if the gate had opened at once, but later
    lags = np.arange(-0.1, 0.1501, 0.005)
    best = min(lags, key=every)
    out["bestLag"], out["rmsBestLag"] = best, every(best)
    mass = [run.case.cloudField(t, "water", "mass").sum()
            for t in (run.case.times()[0], run.case.times()[-1])]
    out["massError"] = mass[1]/mass[0] - 1
    out["cpuTime"] = run.log.cpuTime
    return levels, out


def evaluate(done, results):
    out, rows = {}, {"run": [], "t": [], "x": [], "measured": [], "found": []}
    fig, panels = style.figure(2, 3, width=9, height=1.7, sharex=True,
                               sharey=True)
    for name, run in done.items():
        levels, found = measures(run)
        out.update({f"{name}_{key}": value for key, value in found.items()})
        for time, panel in zip(TIMES, panels.ravel()):
            if not name.endswith("noDrag"):
                panel.plot(levels.x, levels(time),
                           label=f"h = {run.about['h']:g}")
            x, y = measured(time)
            for row in zip([name]*len(x), [time]*len(x), x, y,
                           y + levels.error(time)):
                for column, value in zip(rows.values(), row):
                    column.append(value)
    for time, panel in zip(TIMES, panels.ravel()):
        panel.axvspan(*BLOCK, color="0.92")
        panel.plot(*measured(time), "o", color=style.REFERENCE, markersize=2.5,
                   label="Liu et al. (1999)")
        panel.set(title=f"{time:g} s", xlim=(0, LENGTH), ylim=(0, 0.27))
    panels[0, 2].legend()
    for panel in panels[1]:
        panel.set_xlabel("x [m]")
    for panel in panels[:, 0]:
        panel.set_ylabel("y [m]")
    style.save(fig, results/"porousDamBreak.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"porousDamBreak.csv", rows,
                       "Free surface where it was measured, s and m")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, f"errors over the depth of {DEPTH} m")


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
