#!/usr/bin/env python3
"""The flow of the wall jet without soil: water from a reservoir under a gate
onto a rigid floor. Speed of the jet and front against Torricelli on three
grids, and how they change when the time step is cut to a quarter: with
apicRate they must not, with plain APIC (a rate beyond 1/dt) they do."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

G = 9.81
HEAD = 0.15                 # water over the floor at the start [m]
GATE = 0.70                 # its upstream face [m]
TIMES = ["0.2", "0.25", "0.3"]
COUNTS = {"nx0": 70, "nx1": 4, "nx2": 98, "nx3": 50,
          "ny0": 5, "ny1": 5, "ny2": 15}
PLAIN = 1e9                 # [1/s]


def slot(name, finer, maxCo=0.5, rate=500):
    mesh = {key: finer*n for key, n in COUNTS.items()}
    return study.Run(
        name, [REPOSITORY/"tutorials"/"damBreak", HERE/"case"], study.MPMFOAM,
        {"system/blockMeshDict": {"h": 0.01/finer, **mesh},
         "system/fvSolution": {"MPM/maxCo": maxCo},
         "constant/materialPointProperties": {"water/apicRate": rate}},
        about={"h": 0.01/finer, "maxCo": maxCo, "rate": rate})


def runs():
    return [slot("h0.01", 1), slot("h0.005", 2), slot("h0.0025", 4),
            slot("h0.01_quarter", 1, maxCo=0.125),
            slot("h0.005_quarter", 2, maxCo=0.125),
            slot("h0.01_plain", 1, rate=PLAIN),
            slot("h0.01_plain_quarter", 1, maxCo=0.125, rate=PLAIN)]


def evaluate(done, results):
    torricelli = np.sqrt(2*G*HEAD)
    out = {"torricelli": torricelli}
    table = {k: [] for k in ["run", "h", "t", "jetSpeed", "jetSpeedMax",
                             "front", "massError"]}
    jet, front = {}, {}
    for name, run in done.items():
        case = run.case
        m0 = case.cloudField(case.times()[0], "water", "mass").sum()
        for t in TIMES:
            x, v, m = (case.cloudField(t, "water", f)
                       for f in ["x", "U", "mass"])
            # One to two openings behind the gate
            behind = (x[:, 0] > GATE + 0.05) & (x[:, 0] < GATE + 0.10)
            row = [name, run.about["h"], float(t), v[behind, 0].mean(),
                   v[behind, 0].max(), np.sort(x[:, 0])[-5],
                   m.sum()/m0 - 1]
            for key, value in zip(table, row):
                table[key].append(value)
        mine = [i for i, r in enumerate(table["run"]) if r == name]
        jet[name] = np.mean([table["jetSpeed"][i] for i in mine])
        front[name] = table["front"][mine[-1]]
        out[f"jetSpeed_{name}"] = jet[name]
        out[f"jetSpeedMax_{name}"] = np.mean(
            [table["jetSpeedMax"][i] for i in mine])
        out[f"front_t0.3_{name}"] = front[name]
        out[f"wallTime_{name}"] = run.log.wallTime
    for name in done:
        if f"{name}_quarter" in done:
            out[f"changeOfJet_{name}"] = jet[f"{name}_quarter"]/jet[name] - 1
            out[f"changeOfFront_{name}"] = (
                (front[f"{name}_quarter"] - GATE)/(front[name] - GATE) - 1)

    fig, panel = style.plt.subplots(figsize=(5, 3.4), layout="constrained")
    for label, suffix, marker in [("maxCo 0.5", "", "o-"),
                                  ("maxCo 0.125", "_quarter", "x"),
                                  ("plain APIC, 0.5", "_plain", "s"),
                                  ("plain APIC, 0.125", "_plain_quarter", "D")]:
        names = [n for n in done if n == f"h{done[n].about['h']:g}{suffix}"]
        panel.plot([done[n].about["h"] for n in names],
                   [jet[n] for n in names], marker, label=label)
    panel.axhline(torricelli, color=style.REFERENCE,
                  label="Torricelli, full head")
    panel.set(xlabel="h [m]", ylabel="mean speed of the jet, 0.2-0.3 s [m/s]",
              ylim=(0, None))
    panel.legend()
    style.save(fig, results/"gateSlot.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"gateSlot.csv", table, "SI units")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(
        out, "asked: rising with finer h; |change...| <= 0.05")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
