#!/usr/bin/env python3
"""The table of times in gallery.md, from the logs of tutorials that were run:

    $MPMFOAM_PYTHON docs/gallery.py [tutorials]
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


def row(case):
    log = case/"log.mpmFoam"
    if not log.exists():
        return None
    text = log.read_text(errors="replace")
    if not re.search(r"^End", text, re.M):
        return None
    seconds = float(re.findall(r"ExecutionTime = (\S+) s", text)[-1])
    steps, points = re.findall(r"^Steps: (\d+)  points: (\d+)", text, re.M)[-1]
    end = re.findall(r"^Time = (\S+)", text, re.M)[-1]
    return (f"| `{case.name}` | {int(points):,} | {float(end):g} |"
            f" {int(steps):,} | {seconds:.3g} |").replace(",", " ")


def main():
    where = Path(sys.argv[1]) if len(sys.argv) > 1 else ROOT/"tutorials"
    print("| tutorial | points, mean | time [s] | steps | CPU [s] |\n"
          "|---|---|---|---|---|")
    for case in sorted(where.iterdir()):
        line = row(case)
        if line:
            print(line)


main()
