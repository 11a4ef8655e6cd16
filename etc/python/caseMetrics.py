#!/usr/bin/env python3
"""Writes metrics.json of a finished case and prints it as a short table.

    $MPMFOAM_PYTHON $MPMFOAM_DIR/etc/python/caseMetrics.py \\
        [--case <dir>] [--cloud water] [--front 0.05 0.10] [--energy 0.3]

What there is decides what comes out: the log, the points, and the function
objects materialPointEnergy, frontPosition and waveGauge under the names
energy, front and gauge.
"""

import argparse
from pathlib import Path

import numpy as np

from mpmfoam import metrics
from mpmfoam.case import Case
from mpmfoam.runLog import readLog
from mpmfoam.postProcessing import readDat

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
        "pointsLeft": log.left,
        "wallContacts": log.wallContacts,
    }


def fromPoints(case, cloud):
    times = [t for t in case.times() if case.hasCloud(t, cloud)]
    first, last = (case.cloudField(t, cloud, "mass")
                   for t in (times[0], times[-1]))
    return {
        "pointCount": len(last),
        "mass": last.sum(),
        "massError": last.sum()/first.sum() - 1,
    }


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


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("--case", default=".", type=Path)
    parser.add_argument("--cloud", default="water")
    parser.add_argument("--front", nargs="*", type=float, default=[])
    parser.add_argument("--energy", nargs="*", type=float, default=[])
    arguments = parser.parse_args()

    case = Case(arguments.case)
    out = fromLog(case.path/"log.mpmFoam")
    for part in (lambda: fromPoints(case, arguments.cloud),
                 lambda: fromEnergy(case, arguments.energy),
                 lambda: fromFront(case, arguments.front),
                 lambda: fromGauge(case)):
        try:
            out.update(part())
        except FileNotFoundError:
            pass    # this case has no such function object
    metrics.writeMetrics(case.path/"metrics.json", out)
    metrics.printTable(out, f"{case.path.resolve().name}: metrics.json")


main()
