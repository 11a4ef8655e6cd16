#!/usr/bin/env python3
"""accuracyCost on three cases, one of them OpenFOAM's own, with half an hour of
CPU time each, and whether what it recommends keeps its promise: settings that it
recommends for 10, 5 and 2 % run again, each with three placements of the points
that the study has not seen."""

import json
import shutil
import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import accuracyCost, study  # noqa: E402

EXAMPLES = Path("/usr/share/doc/openfoam-examples/examples/multiphase/"
                "interFoam")
RUNS = HERE/"runs"/"cases"
RESULTS = HERE/"results"/"cases"
BUDGET = "30min"

# Placements that no study has seen
SEEDS = [201, 202, 203]


def tutorial(name):
    def prepare(path):
        for part in ["0.orig", "constant", "system"]:
            shutil.copytree(REPOSITORY/"tutorials"/name/part, path/part,
                            ignore=shutil.ignore_patterns("polyMesh"))
    return prepare


def weirOverflow(path):
    """OpenFOAM's own, with a gauge in the reservoir and what leaves"""
    if not EXAMPLES.is_dir():
        sys.exit(f"cases.py: no {EXAMPLES}: Debian's package "
                 "openfoam-examples has it")
    source = path.with_name(path.name + "_interFoam")
    shutil.rmtree(source, ignore_errors=True)
    shutil.copytree(EXAMPLES/"RAS"/"weirOverflow", source)
    shutil.rmtree(path)
    subprocess.run(["interFoamToMpmFoam", str(source), str(path)], check=True)
    control = path/"system"/"controlDict"
    study.setEntry(control, "functions/gauge/points",
                   "((-9.5 60 0) (9.5 60 0) (36.5 60 0) (63.5 60 0))")
    study.setEntry(control, "functions/mass", "{ type massBalance; libs "
                   "(\"libmpmFunctionObjects.so\"); cloud water; writeControl "
                   "adjustableRunTime; writeInterval 0.4; }")


# name: how it is made, end [s], metrics, and others that the same runs are judged
# by: depth of the hole, and its area; level in the reservoir, and what has run
# off; front, and the level at the wall behind it
SCOUR = "scour/scourProfile.dat"
CASES = {
    "wallJet": (tutorial("wallJet"), 1, [f"{SCOUR}:scourDepth:end"],
                {"Area": [f"{SCOUR}:erodedVolume:end"]}),
    "weirOverflow": (weirOverflow, 24, [
        "gauge/waveGauge.dat:height0:end",
        "mass/massBalance.dat:elsewhereMass:end"], {}),
    "damBreak": (tutorial("damBreak"), 0.3, [
        "frontPosition_t0.15", "gauge/waveGauge.dat:height0"], {})}


def arguments(name, more=None):
    _, end, wanted, others = CASES[name]
    return [str(RUNS/name), "--endTime", f"{end:g}", "--budget", BUDGET,
            "--metrics", ",".join(others[more] if more else wanted)]


def prepare(name):
    path = RUNS/name
    if not (path/"system"/"controlDict").is_file():
        path.mkdir(parents=True, exist_ok=True)
        CASES[name][0](path)


def promise(name, more=None):
    """Rows of recommended settings with other placements"""
    owner = accuracyCost.Study(RUNS/name, accuracyCost.parsed(
        arguments(name, more) + ["--evaluate"]))
    verdict, checks = accuracyCost.judged(owner)
    rows = []
    for target in owner.targets:
        run = verdict.chosen(target/100)
        if run is None:
            rows.append({"target": target, "run": None})
            continue
        errors, times = [], []
        for seed in SEEDS:
            again = owner.run(
                "check", f"own {seed}", run.settings, grid=run.factor,
                seed=seed, name=f"own{seed}_{run.name}", of=run.name)
            again.path = RUNS/f"{name}_own"/again.name
            if not again.finished():
                again.make()
                again.run()
            errors.append(100*verdict.errorOf(again))
            times.append(again.log.cpuTime)
        rows.append({
            "target": target, "run": run.name,
            "error": 100*verdict.error(run),
            "bound": 100*verdict.bound(run), "own": errors,
            "cpuTime": run.log.cpuTime, "ownTimes": times,
            "finest": verdict.finest.name,
            "finestTime": verdict.finest.log.cpuTime,
            "kept": all(e <= target for e in errors)})
    return rows


def keep(name, more=""):
    source = RUNS/name/"accuracyCost"/"results"
    RESULTS.mkdir(parents=True, exist_ok=True)
    for file, suffix in [("accuracyCost.csv", "csv"),
                         ("accuracyCost.png", "png"),
                         ("recommendation.txt", "txt")]:
        shutil.copy(source/file, RESULTS/f"{name}{more}.{suffix}")


def main():
    names = sys.argv[1:] or list(CASES)
    for name in names:
        if name not in CASES:
            sys.exit(f"cases.py: no case {name}. Allowed: {', '.join(CASES)}")
        prepare(name)
        for more in ["", *CASES[name][3]]:
            subprocess.run(["accuracyCost", *arguments(name, more), *(
                ["--evaluate"] if more else [])], check=True)
            keep(name, more)
            rows = promise(name, more)
            (RESULTS/f"{name}{more}.json").write_text(
                json.dumps(rows, indent=1) + "\n")
            for row in rows:
                print(f"{name}{more}: {row}")


if __name__ == "__main__":
    main()
