#!/usr/bin/env python3
"""A heap of beads that a current in a closed channel erodes and moves, against
the profiles that Sandoungout measured (thesis, Rennes, 2019).

No number here is tuned. The water has no turbulence model, and the plane case
no side walls."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402

LENGTH, HEIGHT = 0.38, 0.09
SHIFT = 0.08                    # of x of the case against the measured one, m
TIMES = [0, 2, 6, 10]
PACKING = 0.6                   # solid fraction
RHO, RHO_S, G, FRICTION = 1000, 2500, 9.81, 0.532


def heap(name, h, end, templates=(), settings=None, **about):
    return study.Run(
        name, [HERE/"case", *templates], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(LENGTH/h), "ny": round(HEIGHT/h)},
         "system/controlDict": {"endTime": end},
         **(settings or {})},
        about={"h": h, **about})


PROPERTIES = "constant/materialPointProperties"
INFLOW = "water/inflowOutflow/inlets/current/velocity"


def speed(u):
    """From rest in 0.3 s"""
    return {PROPERTIES: {INFLOW: f"table ((0 (0 0 0)) (0.3 ({u:g} 0 0)))"}}


# It has left the channel after 5 s
RUNS = [heap("h0.005", 0.005, 4),
        # With the friction of the beads on the side walls
        heap("sideWalls_h0.005", 0.005, 2.5, [HERE/"sideWalls"]),
        # What carries it off? Still water, half the speed, and a heap that is
        # held: the force on it
        heap("still_h0.005", 0.005, 2, settings=speed(0)),
        heap("slow_h0.005", 0.005, 4, settings=speed(0.215)),
        heap("held_h0.005", 0.005, 2, settings={
            "system/fvSolution": {"MPM/strictKeywords": "no"},
            PROPERTIES: {
                "soil/constitutiveModel": "rigidSkeleton",
                "soil/rigidSkeletonCoeffs":
                    "{ rhoS 2500; d 0.4e-3; e0 0.6667; }"},
            "system/setMaterialPointsDict":
                {"soil/regions/heap/stress": "none"}}, held=True),
        heap("h0.0025", 0.0025, 2.5)]


def measured(time):
    data = reference.data(f"exp_duneErosion_t{time:g}.csv")
    return data["x_m"] + SHIFT, data["bed_m"]


def found(case, time):
    """Height of the heap, as the volume of the grains in each column of cells
    over that of the packing: without a threshold"""
    time = case.nearestTime(time)
    x, y, alpha = case.lattice(time, "alpha.soil")
    return x, alpha.sum(axis=0)*(y[1] - y[0])/PACKING


def normalised(x, y, grid):
    """On one grid, with the unit area"""
    bed = np.interp(grid, x, y, left=0, right=0)
    return bed/np.trapz(bed, grid)


GRID = np.linspace(0, LENGTH, 1521)


def shape(x, y):
    """Area, centre, apex, and the span that holds 98 % of it"""
    bed = np.interp(GRID, x, y, left=0, right=0)
    area = np.trapz(bed, GRID)
    sums = np.cumsum(bed)/bed.sum()
    return {"area": area, "centre": (bed*GRID).sum()/bed.sum(),
            "apex": bed.max(), "apexPosition": GRID[bed.argmax()],
            "span": GRID[np.searchsorted(sums, 0.99)]
            - GRID[np.searchsorted(sums, 0.01)]}


def force(case):
    """Of the water on the heap, per width: what its pressure and momentum lose
    from x = 0.06 to 0.34, over the second half of the run; and the friction of
    the heap's weight in water on its base"""
    total = []
    for time in case.times():
        if float(time) < 0.5*float(case.times()[-1]):
            continue
        x = case.cloudField(time, "water", "x")[:, 0]
        u = case.cloudField(time, "water", "U")[:, 0]
        p = case.cloudField(time, "water", "p")
        total.append([HEIGHT*(p + RHO*u**2)[np.abs(x - at) < 0.02].mean()
                      for at in (0.06, 0.34)])
    mean = np.mean(total, axis=0)
    x, y = found(case, 0)
    weight = y.sum()*(x[1] - x[0])*PACKING*(RHO_S - RHO)*G
    return {"forceOfWater": mean[0] - mean[1],
            "frictionOfBase": FRICTION*weight}


def measures(run):
    out = {}
    case = run.case
    end = float(case.times()[-1])
    first = shape(*found(case, 0)), shape(*measured(0))
    for time in TIMES:
        if time > end + 0.1:
            continue
        a, b = found(case, time), measured(time)
        here, there = shape(*a), shape(*b)
        # Of the shapes of unit area: what lies apart, 0 to 1
        out[f"apart_t{time:g}"] = 0.5*np.trapz(
            np.abs(normalised(*a, GRID) - normalised(*b, GRID)), GRID)
        if time > 0:
            out[f"wayOfCentre_t{time:g}"] = (
                here["centre"] - first[0]["centre"])
            out[f"wayOfCentreRatio_t{time:g}"] = (
                here["centre"] - first[0]["centre"])/(
                there["centre"] - first[1]["centre"])
            out[f"apexRatio_t{time:g}"] = here["apex"]/there["apex"]
            out[f"areaKept_t{time:g}"] = here["area"]/first[0]["area"]
            out[f"areaKeptMeasured_t{time:g}"] = (
                there["area"]/first[1]["area"])
    late = case.nearestTime(2)
    if run.about.get("held"):
        out = force(case)
    else:
        regime = case.cloudField(late, "soil", "regime")
        out["separated_t2"] = (regime == 3).mean()
        out["suspended_t2"] = (regime == 2).mean()
    u = case.cloudField(late, "water", "U")
    x = case.cloudField(late, "water", "x")
    out["inflow_t2"] = u[(x[:, 0] > 0.02) & (x[:, 0] < 0.06), 0].mean()
    out["cpuTime"] = run.log.cpuTime
    return out


def evaluate(done, results):
    out, rows = {}, {"run": [], "t": [], "x": [], "bed": []}
    fig, panels = style.figure(1, 4, width=11, height=2.4, sharey=True)
    for name, run in done.items():
        out.update({f"{name}_{k}": v for k, v in measures(run).items()})
        for time, panel in zip(TIMES, panels.ravel()):
            if run.about.get("held") or (
                    time > float(run.case.times()[-1]) + 0.1):
                continue
            x, y = found(run.case, time)
            panel.plot(100*x, 100*y, label=name)
            for row in zip([name]*len(x), [time]*len(x), x, y):
                for column, value in zip(rows.values(), row):
                    column.append(value)
    for time, panel in zip(TIMES, panels.ravel()):
        x, y = measured(time)
        panel.plot(100*x, 100*y, "o", color=style.REFERENCE, markersize=2,
                   label="Sandoungout (2019)")
        panel.set(title=f"{time:g} s", xlim=(8, 100*LENGTH), ylim=(0, 3))
        panel.set_xlabel("x [cm]")
    panels[0].set_ylabel("bed [cm]")
    panels[1].legend(fontsize="x-small")
    style.save(fig, results/"dune.png")
    out.update(study.provenance(done))
    reference.writeCsv(results/"dune.csv", rows,
                       "Volume of grains over that of the packing, s and m")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "apart: part of the unit area that lies elsewhere")


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
