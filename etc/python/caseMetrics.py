#!/usr/bin/env python3
"""Writes metrics.json of a finished case and prints it as a short table.

    $MPMFOAM_PYTHON $MPMFOAM_DIR/etc/python/caseMetrics.py \\
        [--case <dir>] [--front 0.05 0.10] [--energy 0.3]

What there is decides what comes out: the log, the points of each cloud, and
the function objects materialPointEnergy, frontPosition, waveGauge,
scourProfile and massBalance under the names energy, front, gauge, scour and
balance.
"""

import argparse
from pathlib import Path

import numpy as np

from mpmfoam import metrics
from mpmfoam.case import Case
from mpmfoam.runLog import readLog
from mpmfoam.postProcessing import readColumns, readDat

# Columns of energy.dat behind the time
KINETIC, POTENTIAL, ELASTIC, STRESS_WORK, CORRECTION_WORK, TOTAL = range(1, 7)


def fromLog(path):
    log = readLog(path)
    return {
        "endTime": log.time,
        "stepCount": log.stepCount,
        "wallTime": log.wallTime,
        "cpuTime": log.cpuTime,
        "nsPerPointStep": log.nsPerPointStep,
        "dtLimiter": log.dtLimiter,
        "wallContacts": log.wallContacts,
    }


def fromPoints(case):
    """Points and mass of each cloud at the end. massError: inside + left
    over what was there at the start and has entered, the worst of the
    clouds."""
    times = case.times()
    out = {}
    clouds = [c for c in ["water", "soil"] if case.hasCloud(times[-1], c)]
    if not clouds:
        raise FileNotFoundError("no points")
    for cloud in clouds:
        with_ = [t for t in times if case.hasCloud(t, cloud)]
        inside, left = [], []
        for time in (with_[0], with_[-1]):
            inside.append(case.cloudField(time, cloud, "mass"))
            left.append(case.cloudState(time, cloud)["leftMass"]
                        - case.enteredMass(time, cloud))
        # A cloud that is empty at first has files at later times only: of
        # what came in by inlets massBalance knows
        start = inside[0].sum() + left[0]
        figures = {"pointCount": len(inside[1]),
                   "pointsLeft": int(case.cloudState(with_[-1], cloud)["left"]),
                   "mass": inside[1].sum(),
                   "massError": (inside[1].sum() + left[1])/start - 1,
                   "speedRms": np.sqrt((case.cloudField(
                       with_[-1], cloud, "U")**2).sum(axis=1).mean())}
        out.update({name + (f"_{cloud}" if len(clouds) > 1 else ""): value
                    for name, value in figures.items()})
    if len(clouds) > 1:
        out["massError"] = max((out[f"massError_{c}"] for c in clouds), key=abs)
    return out


def fromEnergy(case, times):
    """Energies as shares of the initial kinetic + potential one"""
    energy = readDat(case.path, "energy", "energy.dat")
    mechanical = energy[:, KINETIC] + energy[:, POTENTIAL]
    initial = mechanical[0]
    out = {"energyInitial": initial}
    for time in times or [energy[-1, 0]]:
        out[f"energyRatio_t{time:g}"] = np.interp(
            time, energy[:, 0], mechanical)/initial
    # What is in the points and what the stresses took from them falls, by
    # what the transfer dissipates; only an instability lets it climb. Also
    # without the work that the volume correction put in.
    total = energy[:, TOTAL]
    for name, course in [("", total),
                         ("LessCorrection", total - energy[:, CORRECTION_WORK])]:
        climb = (course - np.minimum.accumulate(course)).max()
        out[f"energyGrowthMax{name}"] = climb/abs(initial)
    out["energyTotalEnd"] = total[-1]/initial
    return out


def fromFront(case, times):
    front = readDat(case.path, "front", "front.dat")
    return {f"frontPosition_t{time:.2f}":
            np.interp(time, front[:, 0], front[:, 2]) for time in times}


def fromGauge(case):
    level = readDat(case.path, "gauge", "waveGauge.dat")[:, -1]
    return {"meanLevelChange": level[-1]/level[0] - 1}


def fromBalance(case):
    """What came in and went out. massError: imbalance over what there was at
    the start and came in; zero, not small"""
    b = readColumns(case.path, "balance", "massBalance.dat")
    if "entered" not in b:
        return {}
    out = {key: b[key][-1] for key in [
        "entered", "left", "elsewhere", "waiting", "allocated"]}
    out["enteredMass"] = b["enteredMass"][-1]
    out["leftMass"] = b["leftMass"][-1]
    out["massError"] = np.abs(b["imbalanceMass"]).max()/(
        b["insideMass"][0] + b["enteredMass"][-1])
    # Over the last fifth
    k = np.searchsorted(b["Time"], 0.8*b["Time"][-1])
    came = b["enteredMass"][-1] - b["enteredMass"][k]
    if came > 0:
        out["outflowOverInflow"] = (
            b["leftMass"][-1] - b["leftMass"][k])/came
    if b["left"][-1]:
        out["timeOfFirstOutflow"] = b["Time"][np.flatnonzero(b["left"])[0]]
    return out


def fromScour(case):
    """The deepest hole and when it was, shape at the end; the largest part of
    the grains that was ever in suspension"""
    rows = readDat(case.path, "scour", "scourProfile.dat")
    time, depth, position, dune, dunePosition, eroded, deposited, suspended = \
        rows.T[:8]
    deepest = depth.argmax()
    out = {"scourDepthMax": depth[deepest], "timeOfScourMax": time[deepest],
           "scourDepthEnd": depth[-1], "scourPosition": position[-1],
           "duneHeight": dune[-1], "dunePosition": dunePosition[-1],
           "erodedVolume": eroded[-1], "depositedVolume": deposited[-1],
           "suspendedFraction": suspended.max()}
    if rows.shape[1] > 8:
        out["reservoirLevelEnd"] = rows[-1, 8]
    # Positions of what is not there
    return {name: value for name, value in out.items() if np.isfinite(value)}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--case", default=".", type=Path)
    parser.add_argument("--front", nargs="*", type=float, default=[])
    parser.add_argument("--energy", nargs="*", type=float, default=[])
    arguments = parser.parse_args()

    case = Case(arguments.case)
    out = fromLog(case.path/"log.mpmFoam")
    for part in (lambda: fromPoints(case),
                 lambda: fromEnergy(case, arguments.energy),
                 lambda: fromFront(case, arguments.front),
                 lambda: fromGauge(case),
                 lambda: fromBalance(case),
                 lambda: fromScour(case)):
        try:
            out.update(part())
        except FileNotFoundError:
            pass    # this case has no such function object
    metrics.writeMetrics(case.path/"metrics.json", out)
    metrics.printTable(out, f"{case.path.resolve().name}: metrics.json")


main()
