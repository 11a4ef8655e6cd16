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


def counted(setup, steps, path, counter, ranks):
    """What the counter says of a run"""
    setup.control["runTimeModifiable"] = False
    setup.mpm["logInterval"] = 1000
    case = setup.steps(steps).write(path).prepare().decompose(ranks)
    return case.run("env", f"LD_PRELOAD={counter}", "mpmFoam",
                    ranks=ranks).text


def waited(setup, steps, path, counter):
    """Reductions and exchanges of a run; the most of any rank"""
    text = counted(setup, steps, path, counter, 2)
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
    figures.equal(f"{name}: all-to-all exchanges per step", perStep[1], 0)


def testMessagesOfManyRanks(tmp_path, figures, counter):
    """A channel that grows with the ranks, each with ten columns of cells:
    start and steps send from rank to rank what they send on fewer ranks, and
    to neighbours alone. docs/parallel.md has the formulas."""
    most = {}
    for ranks in (4, 8):
        setup = Setup(
            cells=(10*ranks, 12), h=0.01, energy=False,
            regions={"all": hydrostatic((0, 0), (0.1*ranks, 0.1))})
        text = counted(setup, FEW, tmp_path/str(ranks), counter, ranks)
        rows = [tuple(map(int, row)) for row in re.findall(
            r"(\d+) messages of (\d+) bytes to (\d+) ranks", text)]
        assert len(rows) == ranks
        # The master sends to all what it has read from files
        most[ranks] = [sorted(row[k] for row in rows)[-2 if k == 2 else -1]
                       for k in range(3)]
    # One on each side, as the margin of three cells is less than ten; the
    # master; and the rank that compares the ids of its points
    figures.atMost("ranks that a rank sends to, of 8", most[8][2], 4)
    for k, what in enumerate(["messages", "bytes"]):
        figures.atMost(f"{what} of a rank, of 8 over of 4",
                       most[8][k]/most[4][k], 1.1)
