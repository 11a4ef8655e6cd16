"""How often a step waits for all other ranks."""

import re
import subprocess
from pathlib import Path

import pytest

from caseBuilder import Setup, box, damBreak, hydrostatic
from test_basins import suspension

FEW, MANY = 10, 30


def dryColumn():
    return Setup(
        cells=(20, 15), h=0.01, regions={}, energy=False,
        soilRegions={"column": box((0, 0), (0.08, 0.1))})


def wetColumn():
    return Setup(
        cells=(20, 15), h=0.01, energy=False,
        regions={"all": hydrostatic((0, 0), (0.2, 0.1))},
        soilRegions={"column": box((0, 0), (0.08, 0.06))})


def fullTank():
    """Water to the lid: its volume is summed each step"""
    return Setup(cells=(10, 10), h=0.02, energy=False,
                 regions={"all": hydrostatic((0, 0), (0.2, 0.2))})


@pytest.fixture(scope="module")
def counter(tmp_path_factory):
    library = tmp_path_factory.mktemp("counter")/"countWaiting.so"
    subprocess.run(
        ["mpicc", "-shared", "-fPIC",
         str(Path(__file__).with_name("countWaiting.c")), "-o", str(library)],
        check=True)
    return library


def waited(setup, steps, path, counter):
    """Reductions and exchanges of a run; the most of any rank"""
    setup.control["runTimeModifiable"] = False
    setup.mpm["logInterval"] = 1000
    case = setup.steps(steps).write(path).prepare().decompose(2)
    text = case.run("env", f"LD_PRELOAD={counter}", "mpmFoam", ranks=2).text
    counts = re.findall(r"waited: (\d+) reductions, (\d+) exchanges", text)
    assert len(counts) == 2
    return [max(int(c[k]) for c in counts) for k in (0, 1)]


@pytest.mark.parametrize("name, make, bound", [
    ("water", lambda: damBreak(energy=False), 1),
    ("full tank", fullTank, 2),
    ("dry soil", dryColumn, 2),
    ("water and soil", wetColumn, 2),
    ("full vessel with grains", suspension, 2)])
def testReductions(tmp_path, figures, counter, name, make, bound):
    """Each step has one reduction at its end and, with soil or vessels that
    are full, one at its start. OpenFOAM has one of its own with
    runTimeModifiable, the log some when it writes."""
    few, many = [waited(make(), n, tmp_path/str(n), counter)
                 for n in (FEW, MANY)]
    perStep = [(b - a)/(MANY - FEW) for a, b in zip(few, many)]
    figures.atMost(f"{name}: reductions per step", perStep[0], bound)
    figures.show(f"{name}: exchanges of sizes per step", perStep[1])
