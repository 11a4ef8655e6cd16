#!/usr/bin/env python3
"""Water that is thrown about, many times over: small dam breaks with obstacle,
gate, step, lid and films, in 2D and 3D, from many placements and seeds. Each
must run to its end, keep its mass and its level, and never win energy.

    ./sweep.py [--seeds N] [--maxCo 0.5 0.7] [--only WORD] [--jobs N]
    ./sweep.py --only obstacle3D_16 --points 3 4

Writes results/sweep.csv, a row each run; resumable: rows that are there are
not run again.
"""

import argparse
import csv
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

from scatteredWater import FINER, JITTERS, SCENES, judge, made  # noqa: E402

FIELDS = ["scene", "points", "jitter", "seed", "maxCo", "held", "reason",
          "growth", "level", "commit"]
RESULTS = HERE/"results"/"sweep.csv"


def key(row):
    return tuple(str(row[f]) for f in FIELDS[:5])


def commit():
    return subprocess.run(
        ["git", "-C", str(REPOSITORY), "describe", "--always", "--dirty"],
        capture_output=True, text=True, check=True).stdout.strip()


def run(scene, points, jitter, seed, maxCo):
    """One row"""
    path = Path(tempfile.mkdtemp(prefix="sweep."))
    try:
        row = judge(made(scene, points, jitter, seed, maxCo).write(
            path/"case"))
    finally:
        shutil.rmtree(path, ignore_errors=True)
    return {"scene": scene, "points": points, "jitter": jitter, "seed": seed,
            "maxCo": maxCo, **row, "commit": commit()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=20)
    parser.add_argument("--points", type=int, nargs="+", default=[2])
    parser.add_argument("--maxCo", type=float, nargs="+", default=[0.5])
    parser.add_argument("--jitter", type=float, nargs="+", default=JITTERS)
    parser.add_argument("--only", default="")
    parser.add_argument("--jobs", type=int, default=1)
    parser.add_argument("--results", type=Path, default=RESULTS)
    args = parser.parse_args()

    done = []
    if args.results.exists():
        with open(args.results) as file:
            done = list(csv.DictReader(file))
    known = {key(row) for row in done}
    scenes = [s for s in SCENES if args.only in s] or [
        s for s in FINER if args.only in s]
    todo = [(scene, points, jitter, seed, maxCo)
            for maxCo in args.maxCo for points in args.points
            for seed in range(1, args.seeds + 1) for jitter in args.jitter
            for scene in scenes]
    todo = [t for t in todo if tuple(str(x) for x in t) not in known]
    print(f"{len(known)} rows are there, {len(todo)} runs to do", flush=True)

    new = not args.results.exists()
    args.results.parent.mkdir(exist_ok=True)
    with open(args.results, "a", newline="") as file:
        table = csv.DictWriter(file, FIELDS)
        if new:
            table.writeheader()
        with ThreadPoolExecutor(args.jobs) as pool:
            for row in pool.map(lambda t: run(*t), todo):
                table.writerow(row)
                file.flush()
                done.append(row)
                if not int(row["held"]):
                    print("FAILED", row, flush=True)

    held = [row for row in done if int(row["held"])]
    print(f"{len(held)} of {len(done)} hold; largest growth of the energy "
          f"{max(float(r['growth']) for r in held):.2e}, error of the level "
          f"{max(abs(float(r['level'] or 0)) for r in held):.2%}")
    return len(held) < len(done)


if __name__ == "__main__":
    sys.exit(main())
