#!/usr/bin/env python3
"""The wall jet of tutorials/wallJet: scour, dune and sand balance over time on
three grids (and 16 points per cell on the second), and one-factor changes of model and numerics at h = 0.01.

Two runs that differ in the last digit dig holes that differ, too: seven more
placements of the points (jitter) show by how much. A change that is smaller
says nothing.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import metrics, reference, study, style  # noqa: E402
from mpmfoam.postProcessing import readDat  # noqa: E402

TUTORIAL = REPOSITORY/"tutorials"/"wallJet"
COUNTS = {"nx0": 70, "nx1": 4, "nx2": 98, "nx3": 50,
          "ny0": 5, "ny1": 5, "ny2": 15}
BED = 0.05                  # its surface at the start [m]
PORES = 0.695/1.695

PROPERTIES = "constant/materialPointProperties"
COLUMNS = ["time", "scourDepth", "scourPosition", "duneHeight",
           "dunePosition", "erodedVolume", "depositedVolume",
           "suspendedFraction", "reservoirLevel"]


def jet(name, mesh, h, points=2, end=4, changes=None, **keywords):
    settings = {
        "system/blockMeshDict": {"h": h, **mesh},
        "system/setMaterialPointsDict": {
            "water/pointsPerDirection": points,
            "soil/pointsPerDirection": points},
        "system/controlDict": {"endTime": end},
        "system/fvSolution": {"MPM/logInterval": 1000}}
    files = {}
    for file, entries in (changes or {}).items():
        if isinstance(entries, str):
            files[file] = entries
        else:
            settings.setdefault(file, {}).update(entries)
    return study.Run(name, [TUTORIAL], study.MPMFOAM, settings, files,
                     {"h": h, "points": points**2}, **keywords)


def refined(name, finer, **keywords):
    return jet(name, {k: finer*n for k, n in COUNTS.items()}, 0.01/finer,
               **keywords)


def model(**entries):
    return {PROPERTIES: {f"soil/elastoplasticMuICoeffs/{k}": v
                         for k, v in entries.items()}}


def jittered(seed):
    return {"system/setMaterialPointsDict": {
        f"{cloud}/{key}": value for cloud in ["water", "soil"]
        for key, value in [("placement", "jittered"), ("seed", seed)]}}


def walls(cloud, patches, condition):
    """The tutorial's file with entries that override its pattern.
    (foamDictionary would put them in the place of the pattern.)"""
    name = f"0.orig/U.{cloud}"
    head = "boundaryField\n{\n"
    return {name: (TUTORIAL/name).read_text().replace(head, head + "".join(
        f"    {patch} {{ type {condition}; }}\n" for patch in patches), 1)}


GRIDS = ["h0.01", "h0.01_p16", "h0.005", "h0.005_p16", "h0.003333"]

# One factor changed against h0.01, to 2 s
SENSITIVITY = {
    **{f"jitter{seed}": jittered(seed) for seed in range(1, 8)},
    "dragPaper": {PROPERTIES: {"interaction/drag": "DarcyForchheimerPaper"}},
    "dragGidaspow": {PROPERTIES: {"interaction/drag": "Gidaspow"}},
    "E0_72": model(E0=72), "E0_24": model(E0=24),
    "soundSpeed10": {"system/fvSolution": {"MPM/maxSoilSoundSpeed": 10}},
    "soundSpeed20": {"system/fvSolution": {"MPM/maxSoilSoundSpeed": 20}},
    "apicRate200": {PROPERTIES: {"water/apicRate": 200}},
    "waterFLIP20": {PROPERTIES: {"water/transfer": "FLIP",
                                 "water/flipDampingRate": 20}},
    "soilAPIC": {PROPERTIES: {"soil/transfer": "APIC"}},
    "floorFriction": walls("soil", ["floor"],
                           "frictional; frictionCoefficient 0.7"),
    "floorSlip": walls("soil", ["floor"], "slip"),
    "waterNoSlip": walls("water", ["base", "floor", "block"], "noSlip"),
    **{name: {PROPERTIES: {f"water/{key}": value for key, value in water},
              **walls("water", ["base", "floor", "block", "backWall"],
                      "roughWall; ks 0.85e-3")}
       for name, water in [
           ("waterRoughWall", []),
           ("waterRoughWallXAPIC", [("transfer", "XAPIC")]),
           ("waterkEpsilon", [
               ("turbulence", "kEpsilon"),
               ("kEpsilonCoeffs", "{k 1e-3; epsilon 1e-3;}")])]},
    "soilCornersSlip": {PROPERTIES: {"soil/corners": "slip"}},
    "waterCornersStick": {PROPERTIES: {"water/corners": "stick"}},
    "nsC0.3": model(nsC=0.3), "nsC0.5": model(nsC=0.5),
    # The default, 0.0027 Pa, is the largest that is admitted
    "pRes0.0005": model(pRes=0.0005),
    "noSmoothing": {"system/fvSolution": {"MPM/smoothing": "no"}},
    # The pores of the bed's water left out
    "dryBed": {"system/setMaterialPointsDict": {
        "soil/regions/bed/saturated": "no",
        "water/regions/pores/max": [0.71, 0.05, 1]}},
}


def runs():
    all = [refined("h0.01", 1), refined("h0.01_p16", 1, points=4),
           refined("h0.005", 2), refined("h0.005_p16", 2, points=4),
           refined("h0.003333", 3)]
    all += [refined(f"h0.01_{name}", 1, end=2, changes=changes)
            for name, changes in SENSITIVITY.items()]
    overlap = {"system/fvSolution": {"MPM/overlapCorrection": "yes"}}
    all += [refined("h0.01_overlapCorrection", 1, changes=overlap,
                    optional=True),
            refined("h0.005_overlapCorrection", 2, changes=overlap,
                    optional=True)]
    return all


def profile(run, time):
    rows = np.genfromtxt(
        run.path/"postProcessing"/"scour"/time/"profile.csv", delimiter=",",
        comments="#", skip_header=1)
    return rows[:, 0], rows[:, 1]


def order(h, f):
    """Of f = f0 + C h^p through three grids; nan where they do not converge"""
    (h0, h1, h2), (f0, f1, f2) = h, f
    ratio = (f0 - f1)/(f1 - f2) if f1 != f2 else np.nan
    p = np.linspace(0.05, 6, 2000)
    miss = (h0**p - h1**p)/(h1**p - h2**p) - ratio
    sign = np.flatnonzero(miss[1:]*miss[:-1] < 0)
    return p[sign[0]] if len(sign) else np.nan


def massError(run, cloud):
    case = run.case
    times = case.times()
    mass = [case.cloudField(t, cloud, "mass").sum()
            + case.cloudState(t, cloud)["leftMass"]
            for t in (times[0], times[-1])]
    return mass[1]/mass[0] - 1


def measures(run):
    """What is asked of the wall jet, from the course of scourProfile"""
    course = dict(zip(COLUMNS, readDat(
        run.path, "scour", "scourProfile.dat").T))
    time = course["time"]
    depth = course["scourDepth"]
    out = {"h": run.about["h"], "pointsPerCell": run.about["points"],
           "scourDepthMax": depth.max(),
           "timeOfScourMax": time[depth.argmax()],
           "scourDepth_t1": np.interp(1, time, depth),
           "scourDepth_t2": np.interp(2, time, depth),
           "erodedArea_t1": np.interp(1, time, course["erodedVolume"]),
           "erodedArea_t2": np.interp(2, time, course["erodedVolume"]),
           "duneHeight_t2": np.interp(2, time, course["duneHeight"]),
           "suspendedFraction": course["suspendedFraction"].max(),
           "reservoirLevelStart": course["reservoirLevel"][0],
           "reservoirLevelEnd": course["reservoirLevel"][-1],
           "massError_water": massError(run, "water"),
           "massError_soil": massError(run, "soil"),
           "stepCount": run.log.stepCount, "wallTime": run.log.wallTime,
           "nsPerPointStep": run.log.nsPerPointStep}
    if time[-1] > 3.9:
        late = (time > 2.45)
        out["scourDepth_t2.5"] = np.interp(2.5, time, depth)
        out["scourDepth_t4"] = depth[-1]
        out["scourDepthSpread_t2.5_4"] = np.ptp(depth[late])
        x, early = profile(run, "2.5")
        _, end = profile(run, "4")
        bed = (x > 0.70) & (x < 1.72)
        out["profileChangeRms_t2.5_4"] = np.sqrt(
            ((end - early)[bed]**2).mean())
    return course, out


def evaluate(done, results):
    table, courses = {}, {}
    for name, run in done.items():
        courses[name], table[name] = measures(run)
    out = {f"{key}_{name}": value for name, row in table.items()
           if name in GRIDS
           for key, value in row.items() if key not in ("h", "pointsPerCell")}

    grids = [n for n in ["h0.01", "h0.005", "h0.003333"] if n in done]
    if len(grids) == 3:
        for key in ["scourDepth_t1", "scourDepthMax", "erodedArea_t1",
                    "erodedArea_t2", "duneHeight_t2"]:
            f = [table[n][key] for n in grids]
            found = order([table[n]["h"] for n in grids], f)
            if np.isfinite(found):
                out[f"order_{key}"] = found
            else:
                print(f"{key}: no order, the grids do not converge monotonically")
            out[f"changeOnFinest_{key}"] = f[2]/f[1] - 1

    columns = list(dict.fromkeys(k for row in table.values() for k in row))
    reference.writeCsv(
        results/"runs.csv", {"run": list(table), **{
            k: [row.get(k, np.nan) for row in table.values()]
            for k in columns}}, "SI units; areas per width, pores included")

    changes = [n for n in done
               if n.startswith("h0.01_") and n not in GRIDS]
    if changes and "h0.01" in done:
        sensitivity(table, changes, results, out)

    draw(done, courses, table, results)
    out.update(study.provenance(done))
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out)


def sensitivity(table, names, results, out):
    """One row per factor: change against h0.01, in units of the scatter of
    the jittered placements"""
    keys = ["scourDepth_t2", "erodedArea_t1", "erodedArea_t2",
            "duneHeight_t2"]
    placements = ["h0.01"] + [n for n in names if "jitter" in n]
    mean = {k: np.mean([table[n][k] for n in placements]) for k in keys}
    scatter = {k: np.std([table[n][k] for n in placements], ddof=1)
               if len(placements) > 2 else np.nan for k in keys}
    rows = {"factor": ["placements: mean", "placements: scatter"]}
    for k in keys:
        rows[k] = [mean[k], scatter[k]]
        rows[f"{k}_change"] = [0, scatter[k]/mean[k]]
        out[f"scatter_{k}"] = scatter[k]/mean[k]
    others = [n for n in names if "jitter" not in n]
    grids = [n for n in ["h0.005", "h0.003333"] if n in table]
    for n in others + grids:
        rows["factor"].append(n.removeprefix("h0.01_"))
        for k in keys:
            rows[k].append(table[n][k])
            rows[f"{k}_change"].append(table[n][k]/mean[k] - 1)
            if n in others:
                out[f"change_{k}_{n.removeprefix('h0.01_')}"] = \
                    table[n][k]/mean[k] - 1
    reference.writeCsv(results/"sensitivity.csv", rows,
                       "at h = 0.01, 4 points per cell; _change: relative to "
                       "the mean of the placements")

    fig, panels = style.plt.subplots(1, 2, figsize=(9, 4.6), sharey=True,
                                     layout="constrained")
    labels = rows["factor"][2:]
    for panel, k in zip(panels, ["scourDepth_t2", "erodedArea_t2"]):
        values = 100*np.array(rows[f"{k}_change"][2:])
        panel.barh(labels, values)
        panel.axvspan(-200*scatter[k]/mean[k], 200*scatter[k]/mean[k],
                      alpha=0.2, color=style.REFERENCE,
                      label="twice the scatter of placements")
        panel.set(xlabel=f"change of {k.replace('_t2', ' at 2 s')} [%]")
        panel.legend(fontsize="small")
    panels[0].invert_yaxis()
    style.save(fig, results/"sensitivity.png")


def draw(done, courses, table, results):
    shown = [n for n in GRIDS if n in done]
    if not shown:
        return
    fig, panels = style.plt.subplots(3, 2, figsize=(9.5, 8.5),
                                     layout="constrained")
    for name in shown:
        course = courses[name]
        t = course["time"]
        for panel, key, scale, unit in [
                (panels[0, 0], "scourDepth", 1e3, "mm"),
                (panels[0, 1], "erodedVolume", 1e3, "1e-3 m2"),
                (panels[1, 0], "duneHeight", 1e3, "mm"),
                (panels[1, 1], "suspendedFraction", 100, "%")]:
            panel.plot(t, scale*course[key], label=name)
            panel.set(xlabel="t [s]", ylabel=f"{key} [{unit}]")
    finest = done[shown[-1]]
    for time in ["0.1", "0.5", "1", "2", "2.5", "4"]:
        x, bed = profile(finest, time)
        keep = (x > 0.65) & (x < 1.3)
        panels[2, 0].plot(x[keep], 1e3*(bed[keep] - BED), label=f"{time} s")
    panels[2, 0].set(xlabel="x [m]", ylabel="bed [mm]",
                     title=f"profiles, {shown[-1]} (paper: Fig. 13)")
    for name in shown:
        x, bed = profile(done[name], "2.5")
        keep = (x > 0.65) & (x < 1.3)
        panels[2, 1].plot(x[keep], 1e3*(bed[keep] - BED), label=name)
    panels[2, 1].set(xlabel="x [m]", ylabel="bed at 2.5 s [mm]")
    for panel in panels.flat:
        panel.legend(fontsize="small")
    style.save(fig, results/"wallJet.png")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
