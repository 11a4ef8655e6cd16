#!/usr/bin/env python3
"""Columns of beads that collapse in a viscous liquid, dense and loose, against
Rondon, Pouliquen and Aussillous (2011): front, profiles and pore pressure on
two grids.

No number here is tuned to these measurements. The beads' critical state was
not measured; it is the tutorial's guess."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from coupledProblem import PROBLEMS  # noqa: E402
from mpmfoam import coupled, metrics, reference, study, style  # noqa: E402


def collapse(name, h, end, loose=False, changes={}):
    """Dense: 0.042 m at a solid fraction of 0.60; loose: 0.048 m at 0.55"""
    run = study.Run(
        name, [REPOSITORY/"tutorials"/"immersedCollapse"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(0.3/h), "ny": round(0.084/h)},
         "system/setMaterialPointsDict": {
             "soil/regions/column/max": [0.06, 0.048 if loose else 0.042, 1]},
         "constant/materialPointProperties": {
             "soil/elastoplasticMuICoeffs/e0": 0.818 if loose else 0.6667},
         # Meets the times of the measured profiles
         "system/controlDict": {
             "endTime": end, "writeInterval": 0.22 if loose else 0.25}},
        about={"h": h, "density": "loose" if loose else "dense"},
        optional=bool(changes))
    for file, entries in changes.items():
        run.settings.setdefault(file, {}).update(entries)
    return run


def soil(**entries):
    return {"constant/materialPointProperties": {
        f"soil/elastoplasticMuICoeffs/{key}": value
        for key, value in entries.items()}}


# What was guessed or chosen, one at a time; they run when they are named
VARIATIONS = {
    "eRef0.754": soil(eRef=0.754), "eRef0.70": soil(eRef=0.70),
    "Ad1.4": soil(Ad=1.4), "np6nd6": soil(np=6, nd=6), "kp0.0011": soil(kp=0.0011),
    "phiC25": soil(phiC=25),
    "c30": {"system/fvSolution": {"MPM/maxSoilSoundSpeed": 30}},
    "points4": {"system/setMaterialPointsDict": {
        f"{cloud}/pointsPerDirection": 4 for cloud in ("soil", "water")}},
    "APIC": {"constant/materialPointProperties": {"soil/transfer": "APIC"}}}

RUNS = [collapse("loose_h0.006", 0.006, 6.6, loose=True),
        collapse("dense_h0.006", 0.006, 18),
        collapse("loose_h0.004", 0.004, 6.6, loose=True),
        collapse("dense_h0.004", 0.004, 12)] + [
            collapse(f"{density}_{name}", 0.006, end, density == "loose", changes)
            for density, end in (("dense", 6), ("loose", 4.4))
            for name, changes in VARIATIONS.items()]


def evaluate(done, results):
    out, rows = {}, {"run": [], "t": [], "front": [], "porePressure": []}
    for name, run in done.items():
        found = PROBLEMS["immersedCollapse"][0](run.case)
        found["massError"] = coupled.massError(run.case)
        found["energyGrowthMax"] = coupled.energyGrowth(run.case)
        found["cpuTime"] = run.log.cpuTime
        out.update({f"{name}_{key}": value for key, value in found.items()})
        for t, front, _, pressure in coupled.collapseCourse(run.case):
            for column, value in zip(rows.values(),
                                     (name, t, front, pressure)):
                column.append(value)
    shown = {name: run for name, run in done.items() if not run.optional}
    finest = [min((r for r in shown.values() if r.about["density"] == density),
                  key=lambda r: r.about["h"], default=None)
              for density in coupled.RONDON]
    finest = [run for run in finest if run]
    fig, panels = style.figure(len(finest), 3, width=10.5, height=3,
                               squeeze=False)
    for run, row in zip(finest, panels):
        PROBLEMS["immersedCollapse"][1](row, run.case)
        row[0].set_title(f"{run.about['density']}, h = {run.about['h']:g}")
    # The other grids, dashed
    for run in shown.values():
        for other, row in zip(finest, panels):
            if run.name != other.name and (
                    run.about["density"] == other.about["density"]):
                course = coupled.collapseCourse(run.case)
                label = f"h = {run.about['h']:g}"
                row[1].plot(course[:, 0], 100*course[:, 1], "--",
                            color=style.MPM, label=label)
                row[2].plot(course[:, 0], course[:, 3], "--", color=style.MPM)
                row[1].legend()
    style.save(fig, results/"immersedCollapse.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"immersedCollapse.csv", rows,
                       "s, m, Pa (excess over the liquid at rest)")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: front 15 % from 1 s on, profiles 12 %, "
                       "pore pressure 25 %")


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
