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
LENGTH = {0.005: 0.1, 0.0025: 0.05}
END = {0.005: 10, 0.0025: 5}

# Momentum diffusivity of the scheme, for a start near the steady profile; the
# measured stress does not rest on it [m2/s]
NU_SCHEME = {0.005: 1.3e-4, 0.0025: 8e-5}

# Stresses aimed at [Pa]; a half of the Shields stress first
SHIELDS_HALF = 0.267
AIMS = {0.005: [SHIELDS_HALF, 0.5, 1, 1.4, 2, 2.8, 4, 5.6],
        0.0025: [SHIELDS_HALF, 1, 1.4, 2, 2.8, 4]}

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
    study.main(HERE, [current(h, aim) for h in AIMS for aim in AIMS[h]],
               evaluate, __doc__)
