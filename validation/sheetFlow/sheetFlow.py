#!/usr/bin/env python3
"""Sheet flow of plastic grains in an open channel: how deep a strong current
shears its bed, against the profiles that Revil-Baudard et al. measured (J.
Fluid Mech. 767, 2015).

No number here is tuned. Without a turbulence model what diffuses the water's
momentum is the scheme, so that its speed is not to be compared: the bed feels
its stress only, that of the experiment, and less than half of the depth does
for it. With kEpsilon the depth is that of the experiment."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import coupled, metrics, reference, study, style  # noqa: E402

RHO, RHO_S, D, G = 1000, 1190, 3e-3, 9.81
SHEAR_SPEED, PACKING = 0.05, 0.55
BED, COLUMNS = 0.06, 8

# Depth of the water, without turbulence and with, and height of the mesh [m]
DEPTH = {False: 0.08, True: 0.17}
HEIGHT = {False: 0.18, True: 0.26}

# Momentum diffusivity of the scheme, for a start near the steady profile; the
# measured stress does not rest on it [m2/s]
NU_SCHEME = {0.01: 1.4e-4, 0.005: 7e-5}
# End of the run and begin of the mean [s]
END, FROM = {False: 40, True: 20}, {False: 20, True: 10}

# Near what is measured above the sheet: speed [m/s], k and epsilon
TURBULENT = {
    "water/transfer": "XAPIC", "water/turbulence": "kEpsilon",
    "water/kEpsilonCoeffs": "{ k 8e-3; epsilon 3e-3; }"}
SPEED = 0.65


def channel(h, turbulent=False, loosening=False):
    length, level = COLUMNS*h, BED + DEPTH[turbulent]
    drive = SHEAR_SPEED**2/DEPTH[turbulent]         # along the channel [m/s2]
    start = SHEAR_SPEED**2/NU_SCHEME[h]/2
    name = ["kEpsilon"]*turbulent + ["loosening"]*loosening + [f"h{h:g}"]
    return study.Run(
        "_".join(name), [HERE.parent/"incipientMotion"/"case"],
        study.MPMFOAM, {
            "system/blockMeshDict": {
                "h": h, "nx": COLUMNS, "ny": round(HEIGHT[turbulent]/h),
                "length": length, "height": HEIGHT[turbulent]},
            "system/setMaterialPointsDict": {
                "water/regions/current/min": [0, BED, -1],
                "water/regions/current/max": [length, level, 1],
                "water/regions/current/level": level,
                "water/regions/current/velocity":
                    [SPEED if turbulent else 0, 0, 0],
                "water/regions/current/velocityGradient":
                    [0, 0 if turbulent else start, *[0]*7],
                "water/regions/current/centre": [0, BED, 0],
                "water/regions/pores/max": [length, BED, 1],
                "water/regions/pores/level": level,
                "soil/regions/bed/max": [length, BED, 1]},
            "constant/g": {"value": [drive, -G, 0]},
            "constant/materialPointProperties": {
                "water/weaklyCompressibleNewtonianCoeffs/soundSpeed": 20,
                # Angle and friction as Chauchat et al. (2017) take them for
                # these grains in another solver; elasticity of the tutorials
                "soil/elastoplasticMuICoeffs/rhoS": RHO_S,
                "soil/elastoplasticMuICoeffs/d": D,
                "soil/elastoplasticMuICoeffs/e0": 1/PACKING - 1,
                "soil/elastoplasticMuICoeffs/eRef": 0.9,
                "soil/elastoplasticMuICoeffs/phiC": 27.5,
                "soil/elastoplasticMuICoeffs/muS": 0.52,
                "soil/elastoplasticMuICoeffs/muD": 0.96,
                "soil/elastoplasticMuICoeffs/I0": 0.6,
                "interaction/drag": "Gidaspow",
                **(TURBULENT if turbulent else {})},
            "system/controlDict": {"endTime": END[turbulent],
                                   "writeInterval": 0.5},
            "system/fvSolution": {"MPM/logInterval": 1000,
                                  "MPM/maxSoilSoundSpeed": 20,
                                  **({"MPM/looseningCorrection": "yes"}
                                     if loosening else {})}},
        about={"h": h, "length": length, "drive": drive,
               "turbulent": turbulent})


RUNS = [channel(0.01), channel(0.005),
        channel(0.01, turbulent=True),
        channel(0.01, turbulent=True, loosening=True),
        channel(0.005, turbulent=True, loosening=True)]


def profiles(run):
    """Heights over the bed's surface at the start, solid fraction, speed of
    the water and of the grains, mean over the times from FROM on"""
    case, sums = run.case, []
    for time in case.times():
        if float(time) < FROM[run.about["turbulent"]]:
            continue
        x, y, alpha = case.lattice(time, "alpha.soil")
        rows = [alpha.mean(axis=1)]
        for cloud in ("water", "soil"):
            at, u = coupled.points(case, time, cloud)
            row = np.minimum((at[:, 1]/run.about["h"]).astype(int), len(y) - 1)
            count = np.bincount(row, minlength=len(y))
            with np.errstate(invalid="ignore"):
                rows.append(np.bincount(row, u[:, 0], len(y))/count)
        sums.append(rows)
    with np.errstate(invalid="ignore"):
        phi, water, grains = np.nanmean(sums, axis=0)
    return y - BED, phi, water, grains


def height(z, phi, value):
    """Highest place where a profile falls through a value"""
    i = np.nonzero(phi >= value)[0][-1]
    return z[i] + (z[i + 1] - z[i])*(phi[i] - value)/(phi[i] - phi[i + 1])


def measures(run, measured, speeds):
    z, phi, water, grains = profiles(run)
    zm, phim = measured["z_m"], measured["solidFraction"]
    # One zero: where the grains reach up to if all lay packed at PACKING, so
    # that what the start assumed does not count. The measured bed ends at -9
    # mm, below which all is packed
    step = np.gradient(zm)
    whole = (phim*step).sum()/PACKING + zm[0]
    found = (phi*run.about["h"]).sum()/PACKING - BED
    z = z - found + whole
    cell = [phim[np.abs(zm - at) <= 0.5*run.about["h"]].mean()
            if (np.abs(zm - at) <= 0.5*run.about["h"]).any() else np.nan
            for at in z]
    here = np.isfinite(cell)
    error = (phi - cell)[here]
    stress, transport, _, suspended = coupled.currentOverBed(
        run.case, run.about["length"], BED, run.about["drive"], RHO_S)
    thickness = height(z, phi, 0.08) - height(z, phi, 0.5)
    thicknessMeasured = height(zm, phim, 0.08) - height(zm, phim, 0.5)
    # Speed of the water, of the experiment's largest
    there = (z >= speeds["z_m"].min()) & (z <= speeds["z_m"].max())
    miss = (water - np.interp(z, speeds["z_m"], speeds["u_m_s"]))[there]
    out = {"stress": stress,
           "speedRms": float(np.sqrt(np.nanmean(miss**2))
                             /speeds["u_m_s"].max()),
           "theta": stress/((RHO_S - RHO)*G*D),
           "solidFractionRms": float(np.sqrt(np.mean(error**2))),
           "solidFractionWorst": float(np.abs(error).max()),
           "thickness": thickness, "thicknessMeasured": thicknessMeasured,
           "transport": transport, "suspended": suspended,
           "cpuTime": run.log.cpuTime}
    return (z, phi, water, grains), out


def evaluate(done, results):
    measured = reference.data("exp_sheetFlow_phi.csv")
    speeds = reference.data("exp_sheetFlow_uRxz.csv")
    fig, (left, right) = style.figure(1, 2, width=7, height=3, sharey=True)
    left.plot(measured["solidFraction"], measured["z_m"], ".",
              color=style.REFERENCE, label="Revil-Baudard et al. (2015)")
    right.plot(speeds["u_m_s"], speeds["z_m"], ".", color=style.REFERENCE)
    out, rows = {}, {"run": [], "z": [], "solidFraction": [], "uWater": [],
                     "uSoil": []}
    for run in done.values():
        (z, phi, water, grains), found = measures(run, measured, speeds)
        out.update({f"{run.name}_{k}": v for k, v in found.items()})
        line, = left.plot(phi, z, "-o", markersize=2, label=run.name)
        right.plot(water, z, color=line.get_color())
        right.plot(np.where(phi > 0.01, grains, np.nan), z, "--",
                   color=line.get_color())
        for row in zip([run.name]*len(z), z, phi, water, grains):
            for column, value in zip(rows.values(), row):
                column.append(value)
    left.set(xlabel="solid fraction", ylabel="height [m]", ylim=(-0.03, 0.11))
    right.set(xlabel="speed of water, of grains (dashed) [m/s]")
    left.legend(fontsize="small")
    style.save(fig, results/"sheetFlow.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"sheetFlow.csv", rows,
                       "mean profiles; z in m, u in m/s")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked, with turbulence: rms <= 0.05")


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
