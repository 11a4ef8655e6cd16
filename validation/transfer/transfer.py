#!/usr/bin/env python3
"""What the transfers of water alone cost in accuracy: the viscosity that each
has by itself, the jet through an opening, a sloshing mode, the flow through a
gap, and the noise of still water.

    ./transfer.py [--only SCENE ...]

Writes results/transfer.csv, a row each run; resumable: rows that are there are
not run again.
"""

import argparse
import csv
import shutil
import subprocess
import tempfile
from pathlib import Path

import scenes
from scenes import REPOSITORY

HERE = Path(__file__).resolve().parent
RESULTS = HERE/"results"/"transfer.csv"
FIELDS = ["scene", "transfer", "variant", "figure", "value", "commit"]

# Speed of sound over spacing of each scene [1/s]: rates of APIC are told in it
SOUND = {"shear": lambda n: 10*n, "vortex": lambda n: 10*n,
         "jet": lambda n: 14*n/0.05, "poiseuille": lambda n: 10*n,
         "still": lambda n: 22.15*32, "sloshing": lambda n: 22.15*n}

TRANSFERS = ["APIC 2c/h", "APIC c/h", "APIC 0.5c/h", "APIC 0.25c/h", "XAPIC",
             "XPIC", "FLIP", "PIC"]


def water(transfer, sound):
    name, *rate = transfer.split()
    entries = {"transfer": name}
    if rate:
        entries["apicRate"] = float(rate[0][:-3] or 1)*sound
    return entries


def waves(flow, number):
    def run(path, w, n=16, **entries):
        return scenes.decay(path, *scenes.cellsPerWave(
            n, flow, w, **entries), number)
    return run


RUN = {"shear": (waves(scenes.shearWave, 1), 16),
       "vortex": (waves(scenes.taylorGreen, 2), 16),
       "jet": (scenes.opening, 4), "poiseuille": (scenes.poiseuille, 16),
       "sloshing": (scenes.sloshing, 40), "still": (scenes.still, None)}

VARIANTS = {
    "shear": [{}, {"n": 8}],
    "vortex": [{}, {"n": 8}, {"n": 32}, {"points": 2},
               {"mpm": {"maxCo": 0.25}}, {"mach": 0.05},
               {"mpm": {"shapeFunction": "cubicBSpline"}}],
    "jet": [{}, {"n": 8}], "poiseuille": [{}],
    "sloshing": [{"n": 20}, {}],
    "still": [{"end": 10}, {"end": 10, "points": 2}]}

FIGURES = {"shear": ["nu"], "vortex": ["nu"], "jet": ["jet"],
           "poiseuille": ["flow"], "sloshing": ["kept", "period"],
           "still": ["noise", "speed"]}


def text(variant):
    flat = {}
    for k, v in variant.items():
        flat.update(v if isinstance(v, dict) else {k: v})
    return " ".join(f"{k}={v}" for k, v in flat.items()) or "-"


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--only", nargs="+", choices=list(RUN), default=None)
    options = parser.parse_args()
    commit = subprocess.run(
        ["git", "-C", str(REPOSITORY), "describe", "--always", "--dirty"],
        capture_output=True, text=True, check=True).stdout.strip()
    RESULTS.parent.mkdir(exist_ok=True)
    rows = []
    if RESULTS.is_file():
        with open(RESULTS, newline="") as file:
            rows = list(csv.DictReader(file))
    have = {(r["scene"], r["transfer"], r["variant"]) for r in rows}
    for scene, (run, cells) in RUN.items():
        if options.only and scene not in options.only:
            continue
        for variant in VARIANTS[scene]:
            few = variant and scene == "vortex"
            for transfer in TRANSFERS:
                if few and transfer not in ("APIC 2c/h", "XAPIC"):
                    continue
                if (scene, transfer, text(variant)) in have:
                    continue
                n = variant.get("n", cells)
                sound = SOUND[scene](n)*0.1/variant.get("mach", 0.1)
                given = dict(variant, **({"n": n} if cells else {}))
                path = Path(tempfile.mkdtemp(prefix="transfer."))
                try:
                    found = run(path/"case", water(transfer, sound), **given)
                finally:
                    shutil.rmtree(path, ignore_errors=True)
                # c h, the scale of the scheme's viscosity
                unit = 1/variant.get("mach", 0.1)/n if "nu" in found else 1
                for figure in FIGURES[scene]:
                    value = found[figure]/unit
                    rows.append(dict(zip(FIELDS, [
                        scene, transfer, text(variant), figure,
                        f"{value:.5g}", commit])))
                    print(*rows[-1].values(), flush=True)
                with open(RESULTS, "w", newline="") as file:
                    writer = csv.DictWriter(file, FIELDS)
                    writer.writeheader()
                    writer.writerows(rows)


if __name__ == "__main__":
    main()
