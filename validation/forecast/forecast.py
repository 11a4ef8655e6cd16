#!/usr/bin/env python3
"""The forecast of setMaterialPoints, and what mpmFoam says remains, against
the truth: all tutorials."""

import re
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
TUTORIALS = REPOSITORY/"tutorials"
sys.path[:0] = [str(REPOSITORY/"etc"/"python"),
                str(TUTORIALS/"standingWave")]

from mpmfoam import metrics, reference, study  # noqa: E402

from makeWave import gaugePoints, waveSurface  # noqa: E402

# What a tutorial's Allrun makes before
FILES = {"standingWave": {
    "system/waveSurface": waveSurface(1, 0.5, 0.01, 1),
    "system/gaugePoints": gaugePoints(1, 40)}}

UNITS = {"s": 1, "min": 60, "h": 3600}
NUMBER = r"([\d.e+-]+)"

# Cheap ones first
QUICK = ["seepageColumn", "settling", "wettingFront", "gate", "damBreak",
         "consolidation", "bagnoldFlow", "floatingBox", "overtopping",
         "slopeAtRest", "standingWave", "waveMaker", "slopingFlume"]
ORDER = QUICK + [
    "wallJet", "columnCollapse", "immersedCollapse", "bedUnderStillWater",
    "waterInjection", "openChannel", "tsunamiOverflow", "damBreakObstacle3D",
    "sheetPile", "pipelineScour", "pileScour3D"]

# Forecasts of each, and runs of quick ones: a machine that is shared is by a third
# slower or faster from one second to the next, which longer runs even out
REPEATS = 3


def runs():
    for name in ORDER:
        for i in range(REPEATS):
            runsOnce = i and name not in QUICK
            yield study.Run(
                name + (f"_{i + 1}" if i else ""), [TUTORIALS/name],
                study.MPMFOAM[:-1] if runsOnce else study.MPMFOAM,
                files=FILES.get(name, {}),
                about={"tutorial": name, "forecastOnly": bool(runsOnce)})


def forecast(run):
    """Steps and CPU time [s]"""
    text = (run.path/"log.setMaterialPoints").read_text(errors="replace")
    steps = re.search(rf"^    steps: +{NUMBER} to", text, re.MULTILINE)
    time = re.search(rf"^    time: +{NUMBER} (\w+) \(", text, re.MULTILINE)
    return float(steps[1]), float(time[1])*UNITS[time[2]]


def entries(run):
    """Time, CPU time done and remaining of each entry of the log"""
    text = (run.path/"log.mpmFoam").read_text(errors="replace")
    return np.array(re.findall(
        rf"^Time = {NUMBER}\n(?:.+\n|\n(?!Time))*?Remaining = {NUMBER} s.*\n"
        rf"ExecutionTime = {NUMBER} s", text, re.MULTILINE), dtype=float)


def atTenth(run, log):
    """Done and remaining after a tenth of the run, over the whole"""
    rows = entries(run)
    i = np.searchsorted(rows[:, 0], 0.1*log.time*(1 - 1e-9))
    return (rows[i, 1] + rows[i, 2])/log.cpuTime


def evaluate(done, results):
    rows, out = [], {}
    for name in ORDER:
        mine = [r for r in done.values() if r.about["tutorial"] == name]
        whole = [r for r in mine if not r.about["forecastOnly"]]
        if not whole:
            continue
        steps, cpuTime = (float(np.median(v)) for v in zip(
            *((r.log.stepCount, r.log.cpuTime) for r in whole)))
        forecasts = np.array([forecast(r) for r in mine])
        tenths = [atTenth(r, r.log) for r in whole]
        ratios = forecasts[:, 1]/cpuTime
        rows.append({
            "tutorial": name, "runs": len(whole), "forecasts": len(mine),
            "steps": int(steps), "stepsForecast": np.median(forecasts[:, 0]),
            "stepsRatio": np.median(forecasts[:, 0])/steps,
            "cpuTime": cpuTime, "cpuTimeForecast": np.median(forecasts[:, 1]),
            "cpuTimeRatio": np.median(ratios),
            "ratioAfterATenth": np.median(tenths)})
        for key, each in [("cpuTimeRatio", ratios),
                          ("ratioAfterATenth", tenths)]:
            rows[-1][f"{key}Least"] = min(each)
            rows[-1][f"{key}Most"] = max(each)
        for key in ["stepsRatio", "cpuTimeRatio", "ratioAfterATenth"]:
            out[f"{key}_{name}"] = float(rows[-1][key])
    for key, limit in [("cpuTimeRatio", 1.5), ("ratioAfterATenth", 1.2)]:
        out[f"{key}_within"] = int(sum(
            1/limit <= r[key] <= limit for r in rows))
    print(f"{'tutorial':<20}{'steps':>8}{'forecast':>10}{'ratio':>7}"
          f"{'CPU s':>9}{'forecast':>10}{'ratio':>7}{'at 10 %':>9}")
    for r in rows:
        print(f"{r['tutorial']:<20}{r['steps']:8d}{r['stepsForecast']:10.4g}"
              f"{r['stepsRatio']:7.2f}{r['cpuTime']:9.1f}"
              f"{r['cpuTimeForecast']:10.1f}{r['cpuTimeRatio']:7.2f}"
              f"{r['ratioAfterATenth']:9.2f}")
    reference.writeCsv(
        results/"forecast.csv", {k: [r[k] for r in rows] for k in rows[0]},
        "steps and CPU time [s] of setMaterialPoints' forecast and of the run; "
        "ratioAfterATenth: done and remaining after a tenth of the run, over "
        "the whole; medians of runs, with the least and the most; "
        f"{study.commit()}")
    metrics.writeMetrics(results/"metrics.json",
                         {**out, **study.provenance(done)})


if __name__ == "__main__":
    study.main(HERE, list(runs()), evaluate, __doc__)
