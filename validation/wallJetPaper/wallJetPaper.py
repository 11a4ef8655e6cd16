#!/usr/bin/env python3
"""The wall jet at the paper's resolution (cells of 4 x 4.17 mm, 16 points in
each: 200 000 points) on two ranks, to 4 s, with the soil's own stiffness and
with the cap that the tutorial recommends: time, steps, what limited them, what
each part cost, and the hole. Two ranks against one over the first tenth of a
second, where both have the same to do."""

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))
sys.path.insert(0, str(HERE.parent/"wallJet"))

import wallJet  # noqa: E402
from mpmfoam import metrics, reference, runLog, study, style  # noqa: E402

# dx = 0.004, dy = 0.05/12
MESH = {"nx0": 175, "nx1": 10, "nx2": 245, "nx3": 125,
        "ny0": 12, "ny1": 12, "ny2": 36}
SHORT = 0.1                 # s
CAP = {"system/fvSolution": {"MPM/maxSoilSoundSpeed": 20}}


def paper(name, **keywords):
    return wallJet.jet(name, MESH, 0.004, points=4, **keywords)


def runs():
    return [paper("short_1rank", end=SHORT),
            paper("short_2ranks", end=SHORT, ranks=2),
            paper("cap", ranks=2, changes=CAP),
            paper("default", ranks=2)]


def costs(run):
    """Seconds of each part"""
    text = (run.path/"log.mpmFoam").read_text(errors="replace")
    return {name: row[0] for name, row in runLog.costs(text).items()}


def evaluate(done, results):
    out = {}
    whole = [n for n in ["default", "cap"] if n in done]
    parts = {n: costs(run) for n, run in done.items()}
    names = list(dict.fromkeys(k for p in parts.values() for k in p))
    reference.writeCsv(results/"costs.csv", {"part": names, **{
        n: [p.get(k, float("nan")) for k in names] for n, p in parts.items()}},
        "wall-clock seconds")

    fig, panels = style.plt.subplots(1, 2, figsize=(9.5, 3.4),
                                     layout="constrained")
    for name in whole:
        run = done[name]
        course, found = wallJet.measures(run)
        out.update({f"{k}_{name}": v for k, v in found.items()
                    if k not in ("h", "pointsPerCell")})
        out[f"dtLimiter_{name}"] = run.log.dtLimiter
        out[f"minutes_{name}"] = run.log.wallTime/60
        for panel, key, scale, unit in [
                (panels[0], "scourDepth", 1e3, "mm"),
                (panels[1], "erodedVolume", 1e3, "1e-3 m2")]:
            panel.plot(course["time"], scale*course[key], label=name)
            panel.set(xlabel="t [s]", ylabel=f"{key} [{unit}]")
            panel.legend()
    if whole:
        style.save(fig, results/"wallJetPaper.png")
    if {"short_1rank", "short_2ranks"} <= set(done):
        total = [parts[f"short_{r}"]["total"] for r in ("1rank", "2ranks")]
        out["twoRanksOverOne"] = total[0]/total[1]
        out["stepCount_short_1rank"], out["stepCount_short_2ranks"] = (
            done[f"short_{r}"].log.stepCount for r in ("1rank", "2ranks"))
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: minutes <= 60, twoRanksOverOne >= 1.6")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
