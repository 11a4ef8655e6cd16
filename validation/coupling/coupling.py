#!/usr/bin/env python3
"""Water and soil together, each part on a problem with a known answer."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from coupledProblem import PROBLEMS  # noqa: E402
from mpmfoam import coupled, metrics, reference, study, style  # noqa: E402

TUTORIALS = REPOSITORY/"tutorials"
PROPERTIES = "constant/materialPointProperties"
POINTS = "system/setMaterialPointsDict"
FLUID = "water/weaklyCompressibleNewtonianCoeffs"


def run(tutorial, name, settings, files=None, **about):
    return study.Run(f"{tutorial}_{name}", [TUTORIALS/tutorial],
                     study.MPMFOAM, settings, files or {}, about)


# --- the runs -------------------------------------------------------------

MEDIUM = {"d": 0.85e-3, "n": 0.6949/1.6949, "mu": 1e-3, "rho": 1000}
DISCHARGES = [0.001, 0.005, 0.02]
BED = (0.025, 0.125)
COLUMN = 0.15


def ergun(q, d, n, mu, rho):
    return (150*mu*(1 - n)**2/(n**3*d**2)*q
            + 1.75*rho*(1 - n)/(n**3*d)*q*q)


def seepage(name, q, drag="DarcyForchheimer", whole=False):
    """A bed of 20 cells, or a column that is bed all along"""
    gradient = ergun(q, **MEDIUM)
    share = 1 if whole else (BED[1] - BED[0])/COLUMN
    # Compression by 0.2 %
    drop = (1 - share)*gradient*COLUMN*share
    c = max(20*q, np.sqrt(drop/(0.002*MEDIUM["rho"])))
    bed = (0, COLUMN) if whole else BED
    return run(
        "seepageColumn", name,
        {"constant/g": {"value": [0, f"{-gradient*share/MEDIUM['rho']:.8g}",
                                  0]},
         PROPERTIES: {f"{FLUID}/soundSpeed": f"{c:.6g}",
                      "interaction/drag": drag},
         POINTS: {"soil/regions/bed/min": [0, bed[0], -1],
                  "soil/regions/bed/max": [0.02, bed[1], 1]}},
        bed=bed, q=q, whole=whole, h=0.005)


def settling(ns, d, drag="DarcyForchheimer", end=1.2):
    return run(
        "settling", f"ns{ns}_d{1e3*d:g}" + (
            "" if drag == "DarcyForchheimer" else f"_{drag}"),
        {PROPERTIES: {"soil/DruckerPragerCoeffs/d": d,
                      "interaction/drag": drag},
         POINTS: {"soil/regions/suspension/voidRatio": (1 - ns)/ns},
         "system/controlDict": {"endTime": end, "writeInterval": end/60}},
        ns=ns, d=d, drag=drag, end=end)


def consolidation(cells):
    h = 1/cells
    return run(
        "consolidation", f"n{cells}",
        {"system/blockMeshDict": {"h": h, "nx": 4,
                                  "ny": cells + 2, "vertices": [
            f"({x} {y} {z})" for z in (0, h) for x, y in [
                (0, 0), (4*h, 0), (4*h, 1 + 2*h), (0, 1 + 2*h)]]},
         POINTS: {f"{cloud}/regions/{name}/max": [4*h, 1, 1]
                  for cloud, name in [("water", "pores"), ("soil", "layer")]}},
        cells=cells)


def bed(name, h=0.01, level=0.3, end=10, form="gradient", **about):
    n = round(0.01/h)
    return run(
        "bedUnderStillWater", name,
        {"system/blockMeshDict": {"h": h, "nx": 20*n, "ny": 33*n},
         POINTS: {"water/regions/all/max": [0.2, level, 1]},
         "system/controlDict": {"endTime": end, "writeInterval": end/20},
         "system/fvSolution": {"MPM/pressureForm": form}},
        h=h, level=level, **about)


RUNS = (
    [seepage(f"q{q}", q) for q in DISCHARGES]
    + [seepage(f"whole_q{q}", q, whole=True) for q in DISCHARGES]
    + [seepage("whole_q0.005_paper", 0.005, "DarcyForchheimerPaper", True)]
    + [settling(ns, d) for ns in (0.05, 0.3) for d in (0.85e-3, 1e-3, 2e-3)]
    + [settling(0.05, 1e-4, drag, end=4)
       for drag in ("DarcyForchheimer", "Gidaspow")]
    + [consolidation(20), consolidation(40)]
    + [bed("h0.01"), bed("h0.005", h=0.005),
       bed("inAir", level=0.1, end=5),
       bed("divergence", end=1, form="divergence")]
    + [run("wettingFront", "h0.01", {})]
)


# --- what came out --------------------------------------------------------

def drawDestroyed(panels, done):
    """A bed under still water, with the pressure in gradient form and in the
    divergence form of the paper"""
    for panel, (name, time) in zip(panels, [
            ("bedUnderStillWater_h0.01", 10),
            ("bedUnderStillWater_divergence", 0.1),
            ("bedUnderStillWater_divergence", 1)]):
        case = done[name].case
        time = case.nearestTime(time)
        for cloud, colour in [("water", "#9ec9e8"), ("soil", "#8a5a1f")]:
            x, _ = coupled.points(case, time, cloud)
            panel.plot(100*x[:, 0], 100*x[:, 1], ".", color=colour,
                       markersize=2)
        form = "divergence" if "divergence" in name else "gradient"
        panel.set(title=f"{form} form, {float(time):g} s", aspect="equal",
                  xlim=(0, 20), ylim=(0, 33), xlabel="x [cm]")
        panel.grid(False)
    panels[0].set_ylabel("y [cm]")


def overview(done, results):
    fig, panels = style.figure(2, 3, width=10.5, height=3.1)
    panels = panels.ravel()

    # All seepage in one: gradient over discharge
    data = reference.data("ana_ergun_column.csv")
    here = np.array(data["case"]) == "Ex3"
    panels[0].loglog(data["q"][here], data["dpdz_ergun"][here],
                     color=style.REFERENCE, label="Ergun")
    panels[0].loglog(data["q"][here], data["dpdz_paper5"][here], "--",
                     color="0.5", label="form of the paper")
    for pattern, marker, label in [("seepageColumn_q", "o", "bed of 20 cells"),
                                   ("seepageColumn_whole_q0.005_paper", "x",
                                    "DarcyForchheimerPaper")]:
        for name, run in done.items():
            if name.startswith(pattern):
                found = coupled.seepage(run.case, 1)
                panels[0].loglog(found["discharge"], found["gradient"], marker,
                                 color=style.MPM, label=label)
                label = None
    panels[0].set(xlabel="discharge [m/s]", ylabel="gradient [Pa/m]")

    for panel, draw, name in [
            (panels[1], "seepageColumn", "seepageColumn_q0.005"),
            (panels[2], "consolidation", "consolidation_n20"),
            (panels[4], "wettingFront", "wettingFront_h0.01"),
            (panels[5], "bedUnderStillWater", "bedUnderStillWater_h0.01")]:
        if name in done:
            PROBLEMS[draw][1](panel, done[name].case, label="mpmFoam")

    data = reference.data("ana_settling_closed_vessel.csv")
    for d in sorted(set(data["d"])):
        here = data["d"] == d
        panels[3].plot(data["ns"][here], data["vs_cons"][here],
                       color=style.REFERENCE)
    for name, run in done.items():
        if name.startswith("settling") and run.about["d"] > 5e-4:
            panels[3].plot(run.about["ns"],
                           coupled.settling(run.case)["speed"], "o",
                           color=style.MPM)
    panels[3].set(xlabel="solid fraction", ylabel="settling speed [m/s]",
                  title="d = 0.85, 1, 2 mm")
    for panel in panels:
        if panel.get_legend_handles_labels()[0]:
            panel.legend()
    style.save(fig, results/"coupling.png")


def evaluate(done, results):
    out, rows = {}, {"run": [], "figure": [], "value": []}
    for name, run in done.items():
        problem = name.split("_")[0]
        found = PROBLEMS[problem][0](run.case)
        found["massError"] = coupled.massError(run.case)
        if (run.path/"postProcessing"/"energySoil").is_dir():
            found["energyGrowthMax"] = coupled.energyGrowth(run.case)
        found["stepCount"] = run.log.stepCount
        found["nsPerPointStep"] = run.log.nsPerPointStep
        for key, value in found.items():
            out[f"{name}_{key}"] = value
            for column, entry in zip(rows, (name, key, float(value))):
                rows[column].append(entry)

    overview(done, results)
    if "bedUnderStillWater_divergence" in done:
        fig, panels = style.plt.subplots(1, 3, figsize=(7.5, 4.2),
                                         layout="constrained", sharey=True)
        drawDestroyed(panels, done)
        style.save(fig, results/"pressureForm.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"coupling.csv", rows, "SI units")
    metrics.writeMetrics(results/"metrics.json", {
        key: value for key, value in out.items()
        if isinstance(value, str) or np.isfinite(value)})
    metrics.printTable(out, "asked: see README.md")


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
