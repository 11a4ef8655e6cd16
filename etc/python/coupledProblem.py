#!/usr/bin/env python3
"""Measures a case of water and soil against the answer that is known: adds its
figures to metrics.json, prints them, and draws a picture.

    $MPMFOAM_PYTHON $MPMFOAM_DIR/etc/python/coupledProblem.py <problem> \\
        [--case <dir>]

Problems: seepageColumn, settling, consolidation, bedUnderStillWater,
wettingFront, immersedCollapse, as the tutorials of these names."""

import argparse
from pathlib import Path

import numpy as np

from mpmfoam import coupled, metrics, reference, style
from mpmfoam.case import Case
from mpmfoam.postProcessing import readDat


# --- figures of each, by name ---------------------------------------------

def seepageColumn(case):
    return coupled.seepage(case, 0.5*float(case.times()[-1]))


def settling(case):
    found = coupled.settling(case)
    return {"settlingSpeed": found["speed"], "settlingSpeedExact":
            found["exact"], "settlingError": found["error"]}


def consolidation(case):
    """The largest error is of the sound of the start, which fades until a
    time factor of about 0.2; the mean is of the times behind it"""
    layer = coupled.Consolidation(case)
    rows = [layer.at(t) for t in case.times() if float(t) > 0]
    rows = [r for r in rows if r["T"] >= 0.05]
    late = [r for r in rows if r["T"] >= 0.5]
    return {"stiffnessRatio": layer.stiffnessRatio,
            "timeFactorEnd": rows[-1]["T"],
            "poreRmsMax": max(r["rms"] for r in rows),
            "poreRmsMean": np.mean([r["rms"] for r in rows if r["T"] >= 0.2]),
            "baseOscillationMax": max(r["oscillation"] for r in rows),
            "settlementErrorMax": max((r["settlement"]/r["degree"] - 1
                                       for r in late), key=abs)}


def bedUnderStillWater(case):
    """The worst of the times after the first tenth"""
    times = [t for t in case.times() if float(t) > 0]
    times = times[len(times)//10:]
    rows = [coupled.bedAtRest(case, t) for t in times]
    return {key: max((r[key] for r in rows), key=abs) for key in rows[0]}


def wettingFront(case):
    t, z = coupled.wettingCourse(case)
    h = coupled.spacing(case)
    rows = []
    for time in case.times():
        # Not yet in the sand, or already at the floor
        if not 0.1*t[-1] < float(time) < 0.95*t[-1]:
            continue
        row = coupled.wettingFront(case, time)
        row["error"] = row["depth"] - np.interp(float(time), t, z)
        rows.append(row)
    return {"frontErrorMaxOverH": max(abs(r["error"]) for r in rows)/h,
            "frontAheadMaxOverH": max(r["ahead"].max() for r in rows)/h,
            "frontSpreadMaxOverH": max(r["spread"] for r in rows)/h,
            "speedInSandMax": max(r["speedMax"] for r in rows)}


def immersedCollapse(case):
    rows = coupled.collapseCourse(case)
    early = rows[(rows[:, 0] > 0) & (rows[:, 0] <= 1)]
    excess = [coupled.overlap(case, t) for t in case.times()]
    return {"frontEnd": rows[-1, 1], "heightEnd": rows[-1, 2],
            "overlapMeanMax": max(e[0] for e in excess),
            "overlapMax": max(e[1] for e in excess),
            "porePressureMin": rows[:, 3].min(),
            "porePressureEarlyMean": early[:, 3].mean(),
            **(coupled.collapseMisfit(case) if rows[-1, 0] > 1.5 else {})}


# --- pictures -------------------------------------------------------------

def drawSeepage(panel, case, **line):
    """Pore pressure along the column, the mean of the second half, and Ergun
    at the discharge that was measured"""
    m, found = coupled.Medium(case), seepageColumn(case)
    (_, low), (_, high) = coupled.box(case, "bed")
    (_, bottom), (_, top) = coupled.box(case, "all")
    h = coupled.spacing(case)
    n = round((top - bottom)/h)
    sums, counts = np.zeros(n), np.zeros(n)
    for t in case.times():
        if float(t) < 0.5*float(case.times()[-1]):
            continue
        y = coupled.points(case, t, "water")[0][:, 1]
        cell = np.clip(((y - bottom)/h).astype(int), 0, n - 1)
        sums += np.bincount(cell, case.cloudField(t, "water", "p"), n)
        counts += np.bincount(cell, minlength=n)
    p, y = sums/counts, bottom + (np.arange(n) + 0.5)*h
    panel.plot(y, p, "o", color=style.MPM, **line)
    inside = np.array([low, high])
    slope = m.ergun(found["discharge"]) - m.rho*coupled.gravity(case)
    middle = np.abs(y - inside.mean()) < 0.25*(high - low)
    panel.plot(inside, p[middle].mean() + slope*(inside - inside.mean()),
               color=style.REFERENCE, label="Ergun, slope")
    panel.axvspan(low, high, color="0.92")
    panel.set(xlabel="height [m]", ylabel="pressure [Pa]")


def drawSettling(panel, case, **line):
    """Fall of the grains in the middle"""
    found = coupled.settling(case)
    course = found["course"]
    panel.plot(course[:, 0], course[0, 1] - course[:, 1], color=style.MPM,
               **line)
    panel.plot(course[:, 0], found["exact"]*course[:, 0], "--",
               color=style.REFERENCE, label="Ergun, equilibrium")
    panel.set(xlabel="t [s]", ylabel="fall of the grains [m]")


def drawConsolidation(panel, case, **line):
    """Isochrones"""
    layer = coupled.Consolidation(case)
    wanted = [0.05, 0.1, 0.2, 0.4, 0.8]
    rows = [layer.at(t) for t in case.times() if float(t) > 0]
    z = np.linspace(0, 1, 100)
    for T in wanted:
        row = min(rows, key=lambda r: abs(r["T"] - T))
        panel.plot(row["p"], row["y"]/layer.H, "o", color=style.MPM, **line)
        line.pop("label", None)
        panel.plot(coupled.terzaghi(1 - z, row["T"])[0], z,
                   color=style.REFERENCE,
                   label="Terzaghi" if T == wanted[0] else None)
    panel.set(xlabel="p / u0", ylabel="y / H", title="T = "
              + ", ".join(f"{T:g}" for T in reversed(wanted)))


def drawWetting(panel, case, **line):
    """Depth of the front in time"""
    t, z = coupled.wettingCourse(case)
    times = [time for time in case.times() if float(time) <= 1.1*t[-1]]
    panel.plot([float(time) for time in times],
               [coupled.wettingFront(case, time)["depth"] for time in times],
               "o", color=style.MPM, **line)
    panel.plot(t, z, color=style.REFERENCE, label="Ergun, sharp front")
    panel.set(xlabel="t [s]", ylabel="depth of the front [m]")


def drawBed(panel, case, time=None, **line):
    """Pressure of the water over height"""
    time = time or case.times()[-1]
    m = coupled.Medium(case)
    x, _ = coupled.points(case, time, "water")
    level, bed = (coupled.box(case, n)[1][1] for n in ("all", "bed"))
    panel.plot(case.cloudField(time, "water", "p"), x[:, 1], ".",
               markersize=2, color=style.MPM, **line)
    panel.plot([m.rho*coupled.G*level, 0], [0, level],
               color=style.REFERENCE, label="hydrostatic")
    panel.axhspan(0, bed, color="0.92")
    panel.set(xlabel="pressure [Pa]", ylabel="y [m]")


def drawCollapse(panels, case):
    """Profiles, front, and pore pressure, beside the experiment"""
    profile, front, pressure = panels
    rows, measured = coupled.collapseCourse(case), coupled.rondon(case)
    end = rows[-1, 0]
    times = [t for t in measured["profiles"] if t <= end + 0.5]
    for t, colour in zip(times or [end], style.COLOURS):
        table = np.genfromtxt(coupled.profileTime(case, t), delimiter=",",
                              names=True)
        profile.plot(100*table["x"], 100*table["bed"], color=colour,
                     label=f"{t:g} s")
        if times:
            x, y = measured["profiles"][t]
            profile.plot(100*x, 100*y, "o", color=colour, markersize=2.5)
    profile.set(xlabel="x [cm]", ylabel="y [cm]", ylim=(0, 5),
                xlim=(0, 100*rows[-1, 1] + 3))
    profile.legend(title="points: Rondon et al. 2011", ncols=2)
    front.plot(rows[:, 0], 100*rows[:, 1], color=style.MPM, label="mpmFoam")
    t, x = measured["front"]
    front.plot(t, 100*x, "o", color=style.REFERENCE,
               label="Rondon et al. 2011")
    front.set(xlabel="t [s]", ylabel="front [cm]", xlim=(0, max(end, 3)))
    front.legend()
    pressure.plot(rows[:, 0], rows[:, 3], color=style.MPM)
    pressure.plot(*measured["pressure"], "o", color=style.REFERENCE)
    pressure.axhline(0, color="0.6", linewidth=0.6)
    pressure.set(xlabel="t [s]", ylabel="excess pore pressure\n"
                 "at the floor, x = 2 cm [Pa]", xlim=(0, max(end, 3)))


PROBLEMS = {"seepageColumn": (seepageColumn, drawSeepage),
            "settling": (settling, drawSettling),
            "consolidation": (consolidation, drawConsolidation),
            "bedUnderStillWater": (bedUnderStillWater, drawBed),
            "wettingFront": (wettingFront, drawWetting),
            "immersedCollapse": (immersedCollapse, drawCollapse)}


def main():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("problem", choices=PROBLEMS)
    parser.add_argument("--case", default=".", type=Path)
    arguments = parser.parse_args()

    case = Case(arguments.case)
    measure, draw = PROBLEMS[arguments.problem]
    found = {key: float(value) for key, value in measure(case).items()}
    path = case.path/"metrics.json"
    known = metrics.readMetrics(path) if path.is_file() else {}
    metrics.writeMetrics(path, {**known, **found})
    metrics.printTable(found, f"{arguments.problem}: against what is known")

    if draw is drawCollapse:
        fig, panels = style.plt.subplots(1, 3, figsize=(11, 3.2),
                                         layout="constrained")
        draw(panels, case)
    else:
        fig, panel = style.figure(width=4.6, height=3.4)
        draw(panel, case, label="mpmFoam")
        panel.legend()
    style.save(fig, case.path/f"{arguments.problem}.png")


if __name__ == "__main__":
    main()
