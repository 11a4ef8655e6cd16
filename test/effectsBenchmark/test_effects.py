"""What a scene does not use costs nothing: bytes, and instructions of the
programs as they are, which are the same on each run. Times are in effects.py.

Instructions are counted by the trap flag of the processor
(test/instructionCounter): exact, but some microseconds each, so that the cases
are small and a few steps must do. effects.py has the same and more with
callgrind."""

import copy
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent/"cases")]

import effects  # noqa: E402
from caseBuilder import hydrostatic  # noqa: E402

COUNTER = "libmpmInstructionCounter.so"

# A whole interval of sorting, for each cloud
INTERVAL = (4, 6)


def count(case, steps, *command):
    """Instructions per step, by a program from the start of a case"""
    first, last = steps
    result = subprocess.run(
        command or ["mpmFoam"], cwd=case.path, capture_output=True, text=True,
        timeout=300,
        env={**os.environ, "PWD": str(case.path), "LD_PRELOAD": COUNTER,
             "MPM_COUNT_FROM": str(first), "MPM_COUNT_TO": str(last)})
    found = re.search(r"^instructions (\d+)$", result.stderr, re.MULTILINE)
    assert found, result.stdout[-1000:] + result.stderr
    return int(found[1])/(last - first)


def prepare(path, setup, coarser):
    """A case with larger cells, and fewer"""
    setup = copy.deepcopy(setup)
    setup.h *= coarser
    setup.cells = tuple(round(n/coarser) for n in setup.cells)
    setup.mpm["sortInterval"] = 2
    return setup.write(path).prepare()


@pytest.fixture(scope="module")
def water(tmp_path_factory):
    """A column of water, 576 points, in a tank"""
    return prepare(tmp_path_factory.mktemp("water")/"case", effects.tank(), 5)


def testWaterAloneHasNoSoil(water, figures):
    """The same bytes as a program that does not know soil"""
    case = water.clone(water.path.parent/"log")
    case.setup.steps(1)
    case.rewrite()
    case.solve()
    text = (case.path/"log.mpmFoam").read_text()
    memory = re.findall(r"^    (\w+): (?:(\S+) bytes per point, )?(\S+) MB",
                        text[text.index("\nMemory\n"):], re.MULTILINE)
    figures.equal("clouds with memory", [m[0] for m in memory], ["water"])

    alone = water.run("mpmWaterOnly", "-steps", "0").text
    points, of, nodes = (int(n) for n in re.search(
        r"points (\d+) .*\nbytes of points (\d+) of nodes (\d+)",
        alone).groups())
    figures.equal("bytes per point", float(memory[0][1]), of/points)
    figures.atMost("bytes on nodes over those of water alone, distance to 1",
                   abs(1e6*float(memory[0][2])/nodes - 1), 1e-4)


def testWaterAlone(water, figures):
    """mpmFoam against a program that does not know soil. What it executes
    beyond that does not depend on the number of points: at most 0.5 % of a
    step of 10 000 points, 300 instructions each"""
    own, again = (count(water, INTERVAL) for _ in range(2))
    alone = count(water, INTERVAL, "mpmWaterOnly", "-steps", "9")
    figures.show("instructions per step of 576 points, water alone", alone)
    # The clocks of the cost meter may take a second look
    figures.atMost("difference of two counts, %", 100*abs(own/again - 1),
                   0.05)
    figures.atMost("more of mpmFoam, instructions per step", own - alone,
                   0.005*10000*300)


def testEmptyCells(tmp_path, figures):
    """With a hundred times as many of them, and the balance of energy"""
    counts = [count(prepare(tmp_path/str(f), effects.emptyTank(f, True), 5),
                    INTERVAL) for f in (1, 100)]
    figures.show("instructions per step", counts[0])
    figures.atMost("more with 100 times as many empty cells, %",
                   100*(counts[1]/counts[0] - 1), 5)


@pytest.mark.parametrize("name, coarser, bound", [
    ("coupling: soil far from the water", 3, 5),
    ("open boundaries: no flow", 3, 5),
    ("soil: energy, not due", 3, 5),
    ("cap of the stiffness: not reached", 3, 5),
    ("Smagorinsky: water at rest", 3, 8)])
def testIdle(tmp_path, figures, name, coarser, bound):
    """An effect that is on but has nothing to do"""
    on, off = next(row[1:] for row in effects.idleRows() if row[0] == name)
    without = [off] if off else [effects.apart(soil=False),
                                 effects.apart(water=False)]
    with_, *alone = (
        count(prepare(tmp_path/str(i), setup, coarser), INTERVAL)
        for i, setup in enumerate([on, *without]))
    figures.show("instructions per step without it", sum(alone))
    figures.atMost("more with it, %", 100*(with_/sum(alone) - 1), bound)
