"""Reference data: .csv files with a header of '#' lines on their source."""

import csv
import os
from pathlib import Path

import numpy as np


def repository():
    """The root of the repository"""
    return Path(os.environ.get("MPMFOAM_DIR")
                or Path(__file__).resolve().parents[3])


def readCsv(path):
    """Columns by name; numbers as float arrays, all else as lists of str"""
    with open(path, newline="") as file:
        rows = list(csv.DictReader(
            line for line in file if not line.startswith("#")))
    columns = {}
    for name in rows[0]:
        column = [row[name] for row in rows]
        try:
            columns[name] = np.array(column, dtype=float)
        except ValueError:
            columns[name] = column
    return columns


def writeCsv(path, columns, comment=None):
    """The inverse of readCsv; comment lines go before the names"""
    with open(path, "w", newline="") as file:
        for line in (comment or "").splitlines():
            file.write(f"# {line}\n")
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(columns)
        for row in zip(*columns.values()):
            writer.writerow(
                [f"{v:.8g}" if isinstance(v, (float, np.floating)) else v
                 for v in row])


def data(name):
    """validation/reference/<name>"""
    return readCsv(repository()/"validation"/"reference"/name)
