#!/usr/bin/env python3
"""What accuracy costs in time: for each scene one factor at a time around the
default (grid, points per cell, shape function, transfer, smoothing, time step,
stiffness of soil or water), the error of each run against analysis or against
the finest run, and what it cost."""

import re
import sys
import textwrap
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

from scenes import SCENES  # noqa: E402

MARKERS = {"default": "*", "grid": "o", "points": "s", "shape": "^",
           "transfer": "D", "smoothing": "v", "maxCo": "P", "stiffness": "X",
           "soundSpeed": "h", "interFoam": "o"}


def memory(run):
    """Of points and nodal fields [MB], from the table at the log's start"""
    text = (run.path/"log.mpmFoam").read_text(errors="replace")
    counts = dict(re.findall(r"Cloud (\w+): (\d+) points", (
        run.path/"log.setMaterialPoints").read_text(errors="replace")))
    total = sum(float(nodes) for nodes in re.findall(
        r"^    coupling: (\S+) MB on nodes", text, re.MULTILINE))
    for cloud, perPoint, nodes in re.findall(
            r"^    (\w+): (\S+) bytes per point, (\S+) MB on nodes", text,
            re.MULTILINE):
        total += float(nodes) + 1e-6*float(perPoint)*int(counts[cloud])
    return total


def row(run, error):
    about, log = run.about, run.log
    own = run.commands[-1] == "mpmFoam"
    return {"run": run.name.split("/")[1], "factor": about["factor"],
            "value": about["value"], "h": about["h"], "error": error,
            "cpuTime": log.cpuTime, "wallTime": log.wallTime,
            "stepCount": log.stepCount,
            "memoryMB": memory(run) if own else float("nan")}


def front(rows):
    """Those that no other run beats in both error and time"""
    return [r for r in rows if not any(
        o["error"] <= r["error"] and o["cpuTime"] <= r["cpuTime"]
        and o is not r for o in rows)]


def draw(scene, rows, best, path):
    fig, panel = style.plt.subplots(figsize=(6.3, 4.2),
                                    layout="constrained")
    for factor, marker in MARKERS.items():
        here = [r for r in rows if r["factor"] == factor]
        if not here:
            continue
        if factor in ("grid", "interFoam"):
            here = sorted(here + [r for r in rows if r["factor"] == "default"
                                  and factor == "grid"],
                          key=lambda r: r["cpuTime"])
        panel.loglog([r["cpuTime"] for r in here], [r["error"] for r in here],
                     marker + ("-" if factor in ("grid", "interFoam") else ""),
                     ms=11 if factor == "default" else 5,
                     color={"default": "black", "grid": style.MPM,
                            "interFoam": style.INTERFOAM}.get(factor),
                     mfc=None if factor != "grid" else "white",
                     label=factor, zorder=3 if factor == "default" else 2)
    default = [r for r in rows if r["factor"] == "default"]
    for r in rows:
        # Those that cannot be told from the default would hide each other
        if not any(abs(r["error"]/d["error"] - 1) < 0.05
                   and abs(r["cpuTime"]/d["cpuTime"] - 1) < 0.2
                   for d in default):
            panel.annotate(" " + r["value"], (r["cpuTime"], r["error"]),
                           fontsize=6, color="0.3")
    best = sorted(best, key=lambda r: r["cpuTime"])
    panel.step([r["cpuTime"] for r in best], [r["error"] for r in best],
               where="post", color="0.6", lw=0.8, ls="--",
               label="nothing is better and cheaper", zorder=1)
    panel.set(xlabel="CPU time [s]", title=scene.title,
              ylabel=textwrap.fill(scene.errorName, 44))
    panel.legend(fontsize=7)
    style.save(fig, path)


def evaluate(done, results):
    out = {}
    for name, scene in SCENES.items():
        here = {run.name: run for run in done.values()
                if run.about["scene"] == name}
        if not here or not scene.ready(here):
            continue
        rows = [row(run, scene.error(run, here)) for run in here.values()
                if not scene.isReference(run)]
        own = [r for r in rows if r["factor"] != "interFoam"]
        best = front(own)
        for r in rows:
            r["onFront"] = int(r in best)
        reference.writeCsv(
            results/f"{name}.csv", {k: [r[k] for r in rows] for k in rows[0]},
            f"error: {scene.errorName}; s, m, MB; {study.commit()}")
        draw(scene, rows, best, results/f"{name}.png")
        print(f"\n{name}: {scene.errorName}")
        print(f"{'run':<24}{'error':>10}{'CPU s':>9}{'steps':>9}{'MB':>7}")
        for r in sorted(rows, key=lambda r: r["error"]):
            print(f"{r['run']:<24}{r['error']:10.4g}{r['cpuTime']:9.1f}"
                  f"{r['stepCount']:9d}{r['memoryMB']:7.1f}"
                  + ("  *" if r["onFront"] else ""))
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
