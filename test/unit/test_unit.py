"""Runs the unit tests (Catch2) one test case at a time, and passes on the
figures that they compare."""

import os
import subprocess

import pytest

EXECUTABLE = "mpmUnitTests"

# Bounds that mean: equal but for rounding
ROUNDING = 1e-11


def run(*arguments):
    return subprocess.run([EXECUTABLE, *arguments], capture_output=True,
                          text=True, timeout=300)


def cases():
    """Names of the test cases; none where the executable does not start"""
    bin = os.environ.get("FOAM_USER_APPBIN", "")
    if not os.access(os.path.join(bin, EXECUTABLE), os.X_OK):
        return []
    # Catch2 returns the number of names
    return [name for name in run("--list-test-names-only").stdout.splitlines()
            if name and not name.startswith("I/O")]


def testThereAreCases(figures):
    figures.atLeast("test cases", len(cases()), 50)


@pytest.mark.parametrize("name", cases())
def testUnit(name, figures):
    # Catch2 takes a name as a pattern: commas separate, brackets are tags
    pattern = name.replace("\\", "\\\\").replace(",", "\\,").replace("[", "\\[")
    judge(run(pattern), figures)


def testOnFourRanks(figures):
    """The cases of several ranks"""
    judge(subprocess.run(
        ["mpirun", "-np", "4", EXECUTABLE, "-parallel", "[ranks]"],
        capture_output=True, text=True, timeout=300), figures)


def judge(result, figures):
    log = [line for line in result.stdout.splitlines()
           if not line.startswith("figure\t")]

    for line in result.stdout.splitlines():
        if line.startswith("figure\t"):
            _, what, value, relation, bound = line.split("\t")
            compare(figures, what, value, relation, bound)

    if result.returncode:
        pytest.fail("\n".join(log) + result.stderr, pytrace=False)


def compare(figures, what, value, relation, bound):
    if relation == "<=" and float(bound) <= ROUNDING:
        # Not worth a line at the end of all tests, unless it fails
        figures.holds(f"{what} <= {bound}", float(value) <= float(bound), value)
    elif relation == "<=":
        figures.atMost(what, float(value), float(bound))
    elif relation == ">=":
        figures.atLeast(what, float(value), float(bound))
    else:
        figures.equal(what, value, bound)
