#!/usr/bin/env python3
"""Open boundaries at length: the water injection of the paper over 100 s, with
and without recycling, on a floor that slips and one that does not; flux and
pressure at inlets; the level before a sill in a channel."""

import re
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402
from mpmfoam.postProcessing import readColumns, readDat  # noqa: E402

G, RHO = 9.81, 1000
INJECTION = REPOSITORY/"tutorials"/"waterInjection"
CHANNEL = REPOSITORY/"tutorials"/"openChannel"
PICTURES = ["1", "4", "20", "100"]
PROPERTIES = "constant/materialPointProperties"
INLET = "water/inflowOutflow/inlets/left"

# openChannel: discharge per width [m2/s], height of the sill [m]
Q, SILL = 0.04, 0.10
COUNTS = {"nx0": 150, "nx1": 5, "nx2": 45, "ny0": 5, "ny1": 4, "ny2": 11}

# Held channel: depth and speed at both ends
DEPTH, SPEED = 0.24, 0.2
TABLE_TIMES, TABLE = [0, 1, 2, 3, 4, 5], [0, 1, 1, 0.4, 0.4, 1]
HELD_END = 5


def injection(name, recycle="yes", floor="slip"):
    return study.Run(
        f"injection_{name}", [INJECTION], study.MPMFOAM,
        {"system/controlDict": {"endTime": 100},
         "0.orig/U.water": {"boundaryField/floor/type": floor},
         "system/fvSolution": {"MPM/logInterval": 1000},
         PROPERTIES: {"water/inflowOutflow/recycle": recycle}},
        about={"floor": floor, "recycle": recycle})


def channel(h, endTime=25, optional=False):
    finer = round(0.02/h)
    return study.Run(
        f"channel_h{h:.3g}", [CHANNEL], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, **{key: finer*n for key, n in COUNTS.items()}},
         "system/controlDict": {"endTime": endTime},
         "system/fvSolution": {"MPM/logInterval": 1000}},
        about={"h": h}, optional=optional)


HELD_POINTS = """FoamFile
{
    version     2.0;
    format      ascii;
    class       dictionary;
    object      setMaterialPointsDict;
}

water
{
    pointsPerDirection  2;
    regions
    {
        flow
        {
            type        box;
            min         (0 0 -1);
            max         (1 0.24 1);
            velocity    (%g 0 0);
            pressure    hydrostatic;
            level       0.24;
        }
    }
}
"""


def held(kind):
    """A channel that is as deep at its end, by the water behind it, as at its
    inlet"""
    def values(scale, form):
        return "table (" + " ".join(
            f"({t} {form.format(scale*v)})"
            for t, v in zip(TABLE_TIMES, TABLE)) + ")"

    flow = {"constant": ("velocity", f"({SPEED} 0 0)"),
            "table": ("velocity", values(SPEED, "({:g} 0 0)")),
            "discharge": ("discharge", f"{SPEED*DEPTH:g}"),
            "dischargeTable": ("discharge", values(SPEED*DEPTH, "{:g}")),
            }[kind]
    properties = (INJECTION/PROPERTIES).read_text().replace(
        "velocity            (0.01 0 0);", f"{flow[0]} {flow[1]};").replace(
        "patch               outlet;",
        f"patch               outlet; waterLevel {DEPTH};")
    control = (INJECTION/"system"/"controlDict").read_text()
    control = control[:control.index("functions")] + """functions
{
    balance
    {
        type            massBalance;
        libs            ("libmpmFunctionObjects.so");
        cloud           water;
        writeControl    timeStep;
        writeInterval   1;
    }
    probes
    {
        type            probes;
        libs            ("libsampling.so");
        fields          (p);
        probeLocations  (%s);
        writeControl    timeStep;
        writeInterval   1;
    }
}
""" % " ".join(f"({x:g} 0.005 0.005)" for x in PROBES)
    start = SPEED*(TABLE[0] if "able" in kind else 1)
    return study.Run(
        f"held_{kind}", [INJECTION], study.MPMFOAM,
        {"system/blockMeshDict": {"nx": 100},
         "system/controlDict": {"endTime": HELD_END, "writeInterval": 0.25},
         "system/fvSolution": {"MPM/logInterval": 1000}},
        files={PROPERTIES: properties, "system/controlDict": control,
               "system/blockMeshDict": re.sub(
                   r"\(3 (\S+ +(0|\$h)\))", r"(1 \1",
                   (INJECTION/"system"/"blockMeshDict").read_text()),
               "system/setMaterialPointsDict": HELD_POINTS % start},
        about={"kind": kind})


PROBES = [0.005, 0.015, 0.025, 0.035, 0.055]


def runs():
    return [injection("slip"), injection("noSlip", floor="noSlip"),
            injection("noRecycling", recycle="no"),
            *[held(k) for k in ["constant", "table", "discharge",
                                "dischargeTable"]],
            channel(0.02), channel(0.01), channel(0.02/3),
            channel(0.005, optional=True)]


def balance(run):
    return readColumns(run.path, "balance", "massBalance.dat")


def evaluateInjection(done, results, out):
    mine = {n.split("_")[1]: r for n, r in done.items()
            if n.startswith("injection")}
    if not mine:
        return
    fig, panels = style.plt.subplots(
        1, 2, figsize=(8, 3.2), layout="constrained")
    series = {}
    for name, run in mine.items():
        b = balance(run)
        series[name] = b
        out[f"imbalance_{name}"] = np.abs(b["imbalance"]).max()
        out[f"imbalanceMass_{name}"] = np.abs(b["imbalanceMass"]).max()
        t, end = b["Time"], b["Time"][-1]
        half = np.searchsorted(t, end/2)
        out[f"allocatedGrowthLastHalf_{name}"] = (
            b["allocated"][-1]/b["allocated"][half] - 1)
        late = np.searchsorted(t, end - 20)
        out[f"outflowOverInflow_{name}"] = (
            (b["leftMass"][-1] - b["leftMass"][late])
            /(b["enteredMass"][-1] - b["enteredMass"][late]))
        out[f"arrival_{name}"] = t[np.flatnonzero(b["left"] > 0)[0]]
        out[f"allocatedEnd_{name}"] = b["allocated"][-1]
        out[f"insideEnd_{name}"] = b["inside"][-1]
        out[f"wallTime_{name}"] = run.log.wallTime
        out[f"cpuTime_{name}"] = run.log.cpuTime
        for panel, key in zip(panels, ["allocated", "waiting"]):
            panel.plot(t, b[key], label=name)
    panels[0].set(xlabel="t [s]", ylabel="allocated points")
    panels[1].set(xlabel="t [s]", ylabel="points waiting",
                  ylim=(0, 3*max(1, max(series[n]["waiting"].max()
                                        for n in series
                                        if n != "noRecycling"))))
    panels[0].legend()
    style.save(fig, results/"injectionCurves.png")

    pairs = [mine.get(n) for n in ["slip", "noRecycling"]]
    if all(pairs):
        end = pairs[0].case.times()[-1]
        x, y = (r.case.cloudField(end, "water", "x") for r in pairs)
        out["recyclingDifference"] = (
            np.abs(x - y).max() if x.shape == y.shape else np.nan)

    if "slip" in mine:
        case = mine["slip"].case
        fig, panels = style.plt.subplots(
            4, 1, figsize=(8, 6), layout="constrained", sharex=True)
        for panel, time in zip(panels, PICTURES):
            x = case.cloudField(time, "water", "x")
            speed = np.linalg.norm(
                case.cloudField(time, "water", "U"), axis=1)
            image = panel.scatter(x[:, 0], x[:, 1], s=1.5, c=speed, vmin=0,
                                  vmax=0.8, cmap="viridis")
            panel.set(xlim=(0, 3), ylim=(0, 0.31), ylabel=f"{time} s")
        panels[-1].set_xlabel("x [m]")
        fig.colorbar(image, ax=panels, label="speed [m/s]")
        style.save(fig, results/"injection.png")
    pick = slice(0, None, 20)
    first = series[min(series)]
    reference.writeCsv(
        results/"injection.csv",
        {"Time": first["Time"][pick],
         **{f"{key}_{n}": b[key][pick] for n, b in series.items()
            for key in ["inside", "waiting", "allocated", "enteredMass",
                        "leftMass"]}}, "SI units")


def evaluateHeld(done, results, out):
    mine = {n.split("_")[1]: r for n, r in done.items()
            if n.startswith("held")}
    if not mine:
        return
    fine = np.linspace(0, HELD_END, 100001)
    fig, panels = style.plt.subplots(
        1, 2, figsize=(9, 3.4), layout="constrained")
    for name, run in mine.items():
        b = balance(run)
        rate = (np.interp(fine, TABLE_TIMES, TABLE) if "able" in name
                else np.ones_like(fine))
        total = np.concatenate([[0], np.cumsum(
            (rate[1:] + rate[:-1])/2*(fine[1] - fine[0]))])
        asked = RHO*SPEED*DEPTH*0.01*np.interp(b["Time"], fine, total)
        steps = np.diff(b["enteredMass"])
        layer = steps[steps > 0].min()
        late = (asked - b["enteredMass"])/layer
        out[f"fluxLateMax_{name}"] = late.max()
        out[f"fluxLateMin_{name}"] = late.min()
        out[f"imbalance_{name}"] = np.abs(b["imbalanceMass"]).max()
        panels[0].plot(b["Time"], late, label=name, lw=0.7)

        worst, means = 0, 0
        for time in run.case.times()[1:]:
            x, v = (run.case.cloudField(time, "water", f) for f in ["x", "U"])
            asked = SPEED*np.interp(float(time), fine, rate)
            near = x[:, 0] < 0.01
            worst = max(worst, np.abs(v[near, 0] - asked).max()/SPEED)
            means = max(means, abs(v[near, 0].mean() - asked)/SPEED)
        out[f"speedErrorMean_{name}"] = means
        out[f"speedErrorMax_{name}"] = worst

        rows = readDat(run.path, "probes", "p")
        t = rows[:, 0]
        # Mean over the time of one layer: 5 mm at 0.2 m/s
        width = np.searchsorted(t, t[0] + 0.025)
        mean = np.array([np.convolve(c, np.ones(width)/width, "same")
                         for c in rows[:, 1:].T]).T
        inner = slice(max(width, np.searchsorted(t, 0.5)), -width)
        spikes = np.abs(rows[:, 1:] - mean)[inner].max(axis=0)/(RHO*G*DEPTH)
        for x, s in zip(PROBES, spikes):
            out[f"spike_{name}_x{x:g}"] = s
        if name == "constant":
            cut = (t > 3) & (t < 3.2)
            for k, x in enumerate(PROBES):
                panels[1].plot(t[cut], rows[cut, 1 + k]/(RHO*G*DEPTH),
                               label=f"x = {1000*x:g} mm")
            entered = b["Time"][1:][np.diff(b["entered"]) > 0]
            for e in entered[(entered > 3) & (entered < 3.2)]:
                panels[1].axvline(e, color=style.REFERENCE, lw=0.5)
    panels[0].set(xlabel="t [s]", ylabel="rho0 q t - entered [layers]",
                  xlim=(0, 0.6), ylim=(-0.1, 1.6))
    panels[0].legend()
    panels[1].set(xlabel="t [s]", ylabel="p/(rho g H) at the floor")
    panels[1].legend()
    style.save(fig, results/"inlets.png")


def evaluateChannel(done, results, out):
    mine = {r.about["h"]: r for n, r in done.items()
            if n.startswith("channel")}
    if not mine:
        return
    critical = (Q*Q/G)**(1/3)
    level = SILL + 1.5*critical
    out["channelLevelAnalytical"] = level
    fig, panel = style.plt.subplots(figsize=(5, 3.4), layout="constrained")
    for h, run in sorted(mine.items()):
        rows = readDat(run.path, "gauge", "waveGauge.dat")
        t, upstream = rows[:, 0], rows[:, 1:3].mean(axis=1)
        late = t > 0.6*t[-1]
        out[f"channelLevel_h{h:.3g}"] = upstream[late].mean()
        out[f"channelLevelError_h{h:.3g}"] = upstream[late].mean()/level - 1
        out[f"channelImbalance_h{h:.3g}"] = np.abs(
            balance(run)["imbalanceMass"]).max()
        out[f"channelWallTime_h{h:.3g}"] = run.log.wallTime
        panel.plot(t, upstream, label=f"h = {1000*h:g} mm")
    panel.axhline(level, color=style.REFERENCE, label="sill + 1.5 h_c")
    panel.set(xlabel="t [s]", ylabel="level upstream [m]")
    panel.legend()
    style.save(fig, results/"channel.png")


def evaluate(done, results):
    out = {}
    evaluateInjection(done, results, out)
    evaluateHeld(done, results, out)
    evaluateChannel(done, results, out)
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(
        out, "asked: imbalance 0; allocatedGrowth <= 0.02; outflowOverInflow "
        "0.98 to 1.02; fluxLate 0 to 1; speedErrorMean <= 0.01; spike <= 0.05; "
        "channelLevelError <= 0.03")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
