#!/usr/bin/env python3
"""At which stress does a bed start to move? A current over an endless bed of
sand (soil A of the paper), driven by a small slope of gravity, on two grids;
the stress is what the water loses to the bed, the motion the transport of
grains.

No number here is tuned. Water has no turbulence model: its shear layer over the
bed is as thick as the scheme makes it, a few cells."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import coupled, metrics, reference, study, style  # noqa: E402

G, RHO, RHO_S, D = 9.81, 1000, 2650, 0.85e-3
BED, DEPTH, HEIGHT = 0.05, 0.05, 0.11
LENGTH = {0.005: 0.1, 0.0025: 0.05, 0.00125: 0.025}
END = {0.005: 10, 0.0025: 5}

# Momentum diffusivity of the scheme, for a start near the steady profile; the
# measured stress does not rest on it [m2/s]
NU_SCHEME = {0.005: 1.3e-4, 0.0025: 8e-5, 0.00125: 5e-5}

# Stresses aimed at [Pa]; a half of the Shields stress first
SHIELDS_HALF = 0.267
AIMS = {0.005: [SHIELDS_HALF, 0.5, 1, 1.4, 2, 2.8, 4, 5.6],
        0.0025: [SHIELDS_HALF, 1, 1.4, 2, 2.8, 4]}

# Beds at rest under at most 0.3 Pa: a thinner bed and less water, so that the
# finest grid can be afforded; stiffness of the soil uncapped and capped [m/s];
# (h, cap): end [s]
QUIET_BED, QUIET_DEPTH = 0.025, 0.03
QUIET_AIM = {0.005: 0.5, 0.0025: 0.9, 0.00125: 1.2}
QUIET = {(0.005, 20): 5, (0.005, None): 5, (0.0025, 20): 3,
         (0.0025, None): 1, (0.00125, 20): 1}

# Transport that counts as motion, over sqrt((s - 1) g d^3): a thousandth, where
# the formula of Meyer-Peter and Mueller gives 0.0001 to 0.01 near its threshold
MOTION = 1e-3
SCALE = np.sqrt((RHO_S/RHO - 1)*G*D**3)


def weightStress():
    """Of the Shields parameter 1 [Pa]"""
    return (RHO_S - RHO)*G*D


def criteria():
    """Critical stress of the paper's criteria [Pa]: rho u*^2 of Example 3's
    sand, van Rijn with his published exponent"""
    table = reference.data("table4_check.csv")
    row = list(table["example"]).index("Ex3")
    return {name: RHO*table[column][row]**2 for name, column in [
        ("Shields", "u_Shields_eq59"), ("vanRijn", "u_vR_orig"),
        ("Annandale", "u_Annandale_eq64")]}


def current(h, aim):
    length = LENGTH[h]
    slope = aim/(RHO*DEPTH*G)
    return study.Run(
        f"h{h:g}_tau{aim:g}", [HERE/"case"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(length/h), "ny": round(HEIGHT/h),
            "length": length},
         "system/setMaterialPointsDict": {
             "water/regions/current/velocity": [0, 0, 0],
             "water/regions/current/velocityGradient":
                 [0, aim/RHO/NU_SCHEME[h], 0, 0, 0, 0, 0, 0, 0],
             "water/regions/current/centre": [0, BED, 0]},
         "constant/g": {"value": [G*slope, -G, 0]},
         # The same for all, and beyond ten times the fastest
         "constant/materialPointProperties": {
             "water/weaklyCompressibleNewtonianCoeffs/soundSpeed": 20},
         "system/controlDict": {"endTime": END[h]},
         "system/fvSolution": {"MPM/logInterval": 1000}},
        about={"h": h, "aim": aim, "slope": slope})


def quiet(h, cap):
    """A bed that should rest, watched closely"""
    length, aim, end = LENGTH[h], QUIET_AIM[h], QUIET[h, cap]
    top = QUIET_BED + QUIET_DEPTH
    up = round(top/h) + 2
    slope = aim/(RHO*QUIET_DEPTH*G)
    mpm = {"MPM/logInterval": 1000}
    if cap:
        mpm["MPM/maxSoilSoundSpeed"] = cap
    return study.Run(
        f"quiet_h{h:g}_{f'cap{cap:g}' if cap else 'uncapped'}",
        [HERE/"case"], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(length/h), "ny": up, "length": length,
            "height": up*h},
         "system/setMaterialPointsDict": {
             "water/regions/current/min": [0, QUIET_BED, -1],
             "water/regions/current/max": [length, top, 1],
             "water/regions/current/level": top,
             "water/regions/current/velocity": [0, 0, 0],
             "water/regions/current/velocityGradient":
                 [0, aim/RHO/NU_SCHEME[h], 0, 0, 0, 0, 0, 0, 0],
             "water/regions/current/centre": [0, QUIET_BED, 0],
             "water/regions/pores/max": [length, QUIET_BED, 1],
             "water/regions/pores/level": top,
             "soil/regions/bed/max": [length, QUIET_BED, 1]},
         "constant/g": {"value": [G*slope, -G, 0]},
         "constant/materialPointProperties": {
             "water/weaklyCompressibleNewtonianCoeffs/soundSpeed": 20},
         "system/controlDict": {"endTime": end, "writeInterval": 0.02},
         "system/fvSolution": mpm},
        about={"h": h, "cap": cap or 0, "aim": aim, "slope": slope,
               "quiet": True})


def quietness(run):
    """How quiet the bed is, over the second half of the run. The top row of
    points is that of the start. Its effective pressure differs with the depth
    of its points, by a straight line; what is left in space is the swing of the
    means of the points about that line, in time that of each about its mean"""
    h, case = run.about["h"], run.case
    stress, transport, way, _ = coupled.currentOverBed(
        case, LENGTH[h], QUIET_BED, G*run.about["slope"], RHO_S)
    times = case.times()
    ids = case.cloudField(times[0], "soil", "id")
    y = case.cloudField(times[0], "soil", "x")[np.argsort(ids), 1]
    top = y > QUIET_BED - h/2
    p, depth, separated = [], [], []
    for t in times[len(times)//2:]:
        order = np.argsort(case.cloudField(t, "soil", "id"))[top]
        p.append(case.cloudField(t, "soil", "p")[order])
        depth.append(QUIET_BED - case.cloudField(t, "soil", "x")[order, 1])
        separated.append(case.cloudField(t, "soil", "regime")[order] == 3)
    p = np.array(p)
    mean, where = p.mean(axis=0), np.mean(depth, axis=0)
    line = np.polyval(np.polyfit(where, mean, 1), where)
    return {"h": h, "cap": run.about["cap"], "seconds": float(times[-1]),
            "stress": stress, "transport": transport/SCALE,
            "longestPathOverD": np.abs(way).max()/D,
            "separatedTopRow": np.mean(separated),
            "pTopRow": mean.mean(), "swingInTime": (p - mean).std(),
            "swingInSpace": (mean - line).std(),
            "spreadByDepth": line.std(), "wallTime": run.log.wallTime}


def measures(run):
    h = run.about["h"]
    stress, transport, way, suspended = coupled.currentOverBed(
        run.case, LENGTH[h], BED, G*run.about["slope"], RHO_S)
    return {"h": h, "aim": run.about["aim"], "stress": stress,
            "shieldsParameter": stress/weightStress(),
            "transport": transport/SCALE,
            "movedFurtherThanD": (np.abs(way) > D).mean(),
            "longestPathOverD": np.abs(way).max()/D,
            "suspended": suspended,
            "wallTime": run.log.wallTime}


def threshold(rows):
    """Stress between the last bed at rest and the first in motion, by
    interpolation in logarithms; nan if there is no such pair"""
    rows = sorted(rows, key=lambda r: r["stress"])
    for a, b in zip(rows, rows[1:]):
        if a["transport"] < MOTION <= b["transport"]:
            low = max(a["transport"], 1e-6)
            f = np.log(MOTION/low)/np.log(b["transport"]/low)
            return a["stress"], b["stress"], float(np.exp(
                (1 - f)*np.log(a["stress"]) + f*np.log(b["stress"])))
    return np.nan, np.nan, np.nan


def evaluate(done, results):
    beds = [quietness(run) for run in done.values() if "quiet" in run.about]
    if beds:
        reference.writeCsv(
            results/"quiet.csv", {k: [r[k] for r in beds] for k in beds[0]},
            "stress and p in Pa; cap 0: none")
        found = {}
        for row in beds:
            name = f"h{row['h']:g}_" + (
                f"cap{row['cap']:g}" if row["cap"] else "uncapped")
            found.update({f"{k}_{name}": v for k, v in row.items()
                          if k not in ["h", "cap"]})
        metrics.printTable(found, "asked: transport < 1e-4, path < 1 d, "
                           "separated < 1 %, swing < 1 Pa")
        found.update(study.provenance(
            {n: run for n, run in done.items() if "quiet" in run.about}))
        metrics.writeMetrics(results/"quiet.json", found)
    done = {name: run for name, run in done.items()
            if "quiet" not in run.about}
    if not done:
        return
    rows = [measures(run) for run in done.values()]
    critical = criteria()
    out = {f"criticalStress{name}": tau for name, tau in critical.items()}
    fig, panel = style.plt.subplots(figsize=(5.5, 3.8), layout="constrained")
    for h, marker in [(0.005, "s-"), (0.0025, "D-")]:
        here = sorted((r for r in rows if r["h"] == h),
                      key=lambda r: r["stress"])
        if not here:
            continue
        low, high, middle = threshold(here)
        if np.isfinite(middle):
            out[f"stressAtRest_h{h:g}"] = low
            out[f"stressInMotion_h{h:g}"] = high
            out[f"thresholdStress_h{h:g}"] = middle
            for name, tau in critical.items():
                out[f"thresholdOver{name}_h{h:g}"] = middle/tau
        else:
            print(f"h = {h:g}: no threshold between these stresses")
        half = min(here, key=lambda r: abs(r["stress"] - SHIELDS_HALF))
        for key in ["stress", "transport", "longestPathOverD",
                    "movedFurtherThanD"]:
            out[f"{key}NearHalfShields_h{h:g}"] = half[key]
        panel.loglog([r["shieldsParameter"] for r in here],
                     [max(r["transport"], 1e-6) for r in here], marker,
                     label=f"mpmFoam, h {h:g}")
    theta = np.geomspace(0.0475, 0.5, 60)
    panel.loglog(theta, 8*(theta - 0.047)**1.5, "k-",
                 label="Meyer-Peter and Mueller (1948)")
    for (name, tau), line in zip(critical.items(), ["--", "-.", ":"]):
        panel.axvline(tau/weightStress(), color=style.REFERENCE, ls=line,
                      label=name)
    panel.axhline(MOTION, color=style.REFERENCE, ls=":",
                  label="counts as motion")
    panel.set(xlabel="Shields parameter, from the water's momentum loss",
              ylabel="transport / sqrt((s-1) g d3)", ylim=(5e-7, None))
    panel.legend(fontsize="small")
    style.save(fig, results/"incipientMotion.png")
    out.update(study.provenance(done))
    reference.writeCsv(
        results/"incipientMotion.csv",
        {k: [r[k] for r in rows] for k in rows[0]}, "stress in Pa")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: at half the Shields stress the bed rests")


if __name__ == "__main__":
    study.main(HERE, [current(h, aim) for h in AIMS for aim in AIMS[h]]
               + [quiet(h, cap) for h, cap in QUIET],
               evaluate, __doc__)
