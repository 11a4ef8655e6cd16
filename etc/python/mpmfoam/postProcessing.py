"""The .dat files of function objects."""

import re
from pathlib import Path

import numpy as np


def readDat(casePath, functionObject, fileName):
    """All rows of postProcessing/<functionObject>/<startTime>/<fileName>.

    A run that was restarted has one directory per start: a later start
    replaces what an earlier one wrote from its start time on, but for
    rounding, so that each time is there once. Brackets of vectors are ignored.
    Returns a 2D array, the time in column 0."""
    root = Path(casePath)/"postProcessing"/functionObject
    starts = sorted((p for p in root.glob("*") if (p/fileName).is_file()),
                    key=lambda p: float(p.name))
    if not starts:
        raise FileNotFoundError(f"no {root}/*/{fileName}")

    rows = np.empty((0, 0))
    for start in starts:
        new = _table(start/fileName)
        if not len(new):
            continue
        if len(rows):
            first = new[0, 0] - 1e-12*abs(new[0, 0])
            new = np.concatenate([rows[rows[:, 0] < first], new])
        rows = new
    return rows


def readColumns(casePath, functionObject, fileName):
    """The same as columns by the names in the head of the last file"""
    rows = readDat(casePath, functionObject, fileName)
    head = _head(casePath, functionObject, fileName)[-1]
    return dict(zip(head.strip("# \n").split(), rows.T))


def erosionMaps(casePath, functionObject="erosion"):
    """The columns of erosionCriteria.dat over time and place: time, x, and
    arrays (times, places): known, where there is a bed and a shear stress on
    it; moves, grains at the surface faster than movingSpeed [m/s]; exceeded, by
    criterion. criticalSpeed: sqrt(tau/rho) of each, the mean over the bed"""
    b = readColumns(casePath, functionObject, "erosionCriteria.dat")
    movingSpeed = float(re.search(
        r"soil moves above (\S+) m/s",
        "".join(_head(casePath, functionObject, "erosionCriteria.dat")))[1])
    # tau = rho |u*| u*, where there is a flow
    flows = np.abs(b["shearVelocity"]) > 0
    rho = np.median(b["shearStress"][flows]/(
        b["shearVelocity"]*np.abs(b["shearVelocity"]))[flows])
    time, x = np.unique(b["Time"]), np.unique(b["x"])
    shape = (len(time), len(x))
    names = [n.removesuffix("Exceeded") for n in b if n.endswith("Exceeded")]
    return {
        "time": time, "x": x, "movingSpeed": movingSpeed,
        "hasBed": np.isfinite(b["soilSpeed"]).reshape(shape),
        "known": np.isfinite(b["shearStress"] + b["soilSpeed"]).reshape(
            shape),
        "moves": b["soilSpeed"].reshape(shape) > movingSpeed,
        "exceeded": {n: b[f"{n}Exceeded"].reshape(shape) for n in names},
        "criticalSpeed": {
            n: float(np.sqrt(np.nanmean(b[f"{n}Stress"])/rho))
            for n in names}}


def agreement(found, criterion):
    """Shares of the places and times at which the shear stress on the bed is
    known, and the correlation of both (phi coefficient; nan if one never
    changes)"""
    known = found["known"]
    above = (found["exceeded"][criterion] > 0)[known]
    moves = found["moves"][known]
    phi = np.nan
    if 0 < above.mean() < 1 and 0 < moves.mean() < 1:
        phi = np.corrcoef(above, moves)[0, 1]
    return {
        f"{criterion}ExceededMoves": (above & moves).mean(),
        f"{criterion}ExceededRests": (above & ~moves).mean(),
        f"{criterion}BelowMoves": (~above & moves).mean(),
        f"{criterion}BelowRests": (~above & ~moves).mean(),
        f"{criterion}Correlation": phi,
        "shearStressKnown": known.sum()/found["hasBed"].sum()}


def _head(casePath, functionObject, fileName):
    """The lines of comment of the last file"""
    root = Path(casePath)/"postProcessing"/functionObject
    last = max((p for p in root.glob("*") if (p/fileName).is_file()),
               key=lambda p: float(p.name))
    with open(last/fileName) as file:
        return [line for line in file if line.startswith("#")]


def _table(path):
    with open(path) as file:
        lines = [line.replace("(", " ").replace(")", " ").split()
                 for line in file if not line.startswith("#")]
    lines = [line for line in lines if line]
    # A run that was killed may leave its last line cut short
    if len(lines) > 1 and len(lines[-1]) != len(lines[0]):
        lines.pop()
    return np.array(lines, dtype=float)
