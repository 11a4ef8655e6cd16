#!/usr/bin/env python3
"""What accuracy costs in time: for each scene one factor at a time around the
default (grid, points per cell, shape function, transfer, smoothing, time step,
stiffness of soil or water), the error of each run against analysis or against
the finest run, and what it cost."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import costStudy, metrics, study  # noqa: E402

from scenes import SCENES  # noqa: E402


def evaluate(done, results):
    out = {}
    for name, scene in SCENES.items():
        here = {run.name: run for run in done.values()
                if run.about["scene"] == name}
        if not here or not scene.ready(here):
            continue
        rows = [costStudy.row(run, scene.error(run, here))
                for run in here.values() if not scene.isReference(run)]
        own = [r for r in rows if r["factor"] != "interFoam"]
        best = costStudy.front(own)
        for r in rows:
            r["onFront"] = int(r in best)
        costStudy.writeTable(rows, results/f"{name}.csv", scene.errorName)
        costStudy.draw(scene.title, scene.errorName, rows, best,
                       results/f"{name}.png")
        costStudy.printTable(rows, f"{name}: {scene.errorName}")
        for r in rows:
            out[f"error_{name}_{r['run']}"] = r["error"]
            out[f"cpuTime_{name}_{r['run']}"] = r["cpuTime"]
        out[f"front_{name}"] = " ".join(
            r["run"] for r in sorted(best, key=lambda r: r["cpuTime"]))
        out.update(scene.more(rows, here))
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)


if __name__ == "__main__":
    study.main(HERE, [run for scene in SCENES.values()
                      for run in scene.runs()], evaluate, __doc__)
