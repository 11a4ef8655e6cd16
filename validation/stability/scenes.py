#!/usr/bin/env python3
"""Valid entries of all kinds together, at random: clouds, models, transfers,
walls, bodies, placements in 2D and 3D. Each scene must run, keep its mass and
stay finite; a restart half way must change no bit, two ranks rounding only; water
that nothing works on may win no energy.

    ./scenes.py 1 200 [--results FILE]

Writes results/scenes.csv, a row each seed; rows that are there are not run
again. test/cases/test_randomScenes.py runs some of them.
"""

import argparse
import csv
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

from randomScenes import judge, made  # noqa: E402
from sweep import commit  # noqa: E402

FIELDS = ["seed", "scene", "wrong", "commit"]


def row(seed):
    path = Path(tempfile.mkdtemp(prefix=f"scene{seed}."))
    try:
        wrong = judge(seed, path)
    except AssertionError as error:
        text = str(error)
        wrong = [" ".join(text[max(text.find("FOAM FATAL"), 0):].split())[:300]]
    return {"seed": seed, "scene": made(seed)[1], "wrong": "; ".join(wrong),
            "commit": commit()}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("first", type=int)
    parser.add_argument("last", type=int)
    parser.add_argument("--results", type=Path,
                        default=HERE/"results"/"scenes.csv")
    args = parser.parse_args()

    done = []
    if args.results.exists():
        with open(args.results) as file:
            done = list(csv.DictReader(file))
    known = {int(r["seed"]) for r in done}
    with open(args.results, "a", newline="") as file:
        table = csv.DictWriter(file, FIELDS)
        if not done:
            table.writeheader()
        for seed in range(args.first, args.last + 1):
            if seed in known:
                continue
            done.append(row(seed))
            table.writerow(done[-1])
            file.flush()
            if done[-1]["wrong"]:
                print(seed, done[-1]["scene"], done[-1]["wrong"], flush=True)
    wrong = [r for r in done if r["wrong"]]
    print(f"{len(done) - len(wrong)} of {len(done)} hold")
    return bool(wrong)


if __name__ == "__main__":
    sys.exit(main())
