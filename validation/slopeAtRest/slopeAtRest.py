#!/usr/bin/env python3
"""Banks of dry sand 8 cm high: at 25 degrees soils B and C should be still for
5 s, at 35 degrees soil C should fail and soil B stand."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

HEIGHT, CREST, H = 0.08, 0.05, 0.005
END, SETTLED = 5, 0.5       # s
# What differs from soil C, which the tutorial has
SOILS = {"C": {}, "B": {"d": 1e-3, "e0": 0.695, "eRef": 0.977}}


def bank(angle, soil):
    toe = CREST + HEIGHT/np.tan(np.radians(angle))
    return study.Run(
        f"{soil}{angle}", [REPOSITORY/"tutorials"/"slopeAtRest"],
        study.MPMFOAM,
        {"system/setMaterialPointsDict": {"soil/regions/bank/points":
            f"((0 0) ({toe:.6f} 0) ({CREST} {HEIGHT}) (0 {HEIGHT}))"},
         "constant/materialPointProperties": {
             f"soil/elastoplasticMuICoeffs/{key}": value
             for key, value in SOILS[soil].items()},
         "system/controlDict": {"endTime": END, "writeInterval": 0.25}},
        about={"angle": angle, "soil": soil})


def front(x):
    """As in columnCollapse: 99.5 % of the grains lie behind"""
    return np.sort(x[:, 0])[int(0.995*len(x))]


def evaluate(done, results):
    out = {}
    table = {k: [] for k in ["run", "frontMoved", "pointMovedMax", "vRmsMax",
                             "vRmsEnd", "separatedMax", "massError",
                             "wallTime"]}
    fig, panels = style.figure(1, 2, width=9)
    for name, run in done.items():
        case = run.case
        times = [t for t in case.times() if case.hasCloud(t, "soil")]
        course = []
        for time in times:
            x, U, regime, ids, mass = (
                case.cloudField(time, "soil", f)
                for f in ["x", "U", "regime", "id", "mass"])
            order = np.argsort(ids)
            course.append((float(time), x[order],
                           np.sqrt((U**2).sum(axis=1).mean()),
                           (regime == 3).mean(), mass.sum()))
        start, end = course[0], course[-1]
        settled = [c for c in course if c[0] >= SETTLED]
        row = [name,
               max(front(c[1]) - front(start[1]) for c in course)/H,
               np.sqrt(((end[1] - start[1])**2).sum(axis=1)).max()/H,
               max(c[2] for c in settled), end[2],
               max(c[3] for c in settled), end[4]/start[4] - 1,
               run.log.wallTime]
        for key, value in zip(table, row):
            table[key].append(value)
            if key != "run":
                out[f"{key}_{name}"] = value
        panels[0].semilogy([c[0] for c in course[1:]],
                           [c[2] for c in course[1:]], label=name)
        if run.about["angle"] == 35:
            panels[1].plot(1e3*end[1][:, 0], 1e3*end[1][:, 1], ".", ms=1,
                           label=f"{name}, {END} s")
    panels[0].axhline(1e-4, color=style.REFERENCE, ls="--", lw=0.8)
    panels[0].set(xlabel="time [s]", ylabel="rms velocity [m/s]")
    panels[0].legend()
    panels[1].set(xlabel="x [mm]", ylabel="y [mm]", aspect="equal")
    panels[1].legend(markerscale=8)
    style.save(fig, results/"slopeAtRest.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"slopeAtRest.csv", table,
                       f"lengths over h; maxima from {SETTLED} s on but for "
                       "frontMoved")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(
        out, "asked: B25, C25, B35 frontMoved < 0.5, vRmsMax < 1e-4; C35 fails")


if __name__ == "__main__":
    study.main(HERE, [bank(angle, soil) for angle in (25, 35)
                      for soil in SOILS], evaluate, __doc__)
