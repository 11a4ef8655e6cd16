"""The .dat files of function objects."""

from pathlib import Path

import numpy as np


def readDat(casePath, functionObject, fileName):
    """All rows of postProcessing/<functionObject>/<startTime>/<fileName>.

    A run that was restarted has one directory per start: a later start
    replaces what an earlier one wrote from its start time on. Brackets of
    vectors are ignored. Returns a 2D array, the time in column 0."""
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
            new = np.concatenate([rows[rows[:, 0] < new[0, 0]], new])
        rows = new
    return rows


def readColumns(casePath, functionObject, fileName):
    """The same as columns by the names in the head of the last file"""
    root = Path(casePath)/"postProcessing"/functionObject
    rows = readDat(casePath, functionObject, fileName)
    last = max((p for p in root.glob("*") if (p/fileName).is_file()),
               key=lambda p: float(p.name))
    with open(last/fileName) as file:
        head = [line for line in file if line.startswith("#")][-1]
    return dict(zip(head.strip("# \n").split(), rows.T))


def _table(path):
    with open(path) as file:
        lines = [line.replace("(", " ").replace(")", " ").split()
                 for line in file if not line.startswith("#")]
    lines = [line for line in lines if line]
    # A run that was killed may leave its last line cut short
    if len(lines) > 1 and len(lines[-1]) != len(lines[0]):
        lines.pop()
    return np.array(lines, dtype=float)
