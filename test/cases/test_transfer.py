"""Transfers of water alone: the viscosity that they have by themselves,
ranks, energy. Scenes of validation/transfer."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(
    Path(__file__).resolve().parents[2]/"validation"/"transfer"))

import scenes  # noqa: E402
from caseBuilder import CaseError, damBreak  # noqa: E402
from test_parallel import agree  # noqa: E402

XAPIC = {"transfer": "XAPIC"}


def vortex(path, water):
    return scenes.decay(
        path, *scenes.cellsPerWave(16, scenes.taylorGreen, water), 2)


def testViscosityOfTheScheme(tmp_path, figures):
    """A vortex of 16 cells: the figure that the log tells for APIC, and less
    than a fifth of it with XAPIC"""
    plain = vortex(tmp_path/"APIC", {"transfer": "APIC"})["nu"]
    quiet = vortex(tmp_path/"XAPIC", XAPIC)["nu"]
    scale = 10/16
    figures.atMost("APIC: nu/(c h) over 0.0173 of the log, less one",
                   abs(plain/scale/0.0173 - 1), 0.15)
    figures.atMost("XAPIC: nu over that of APIC", quiet/plain, 0.2)
    figures.atLeast("XAPIC: nu", quiet, 0)


def testGap(tmp_path, figures):
    """Plane Poiseuille flow, 16 cells, a Reynolds number of 100"""
    flow = scenes.poiseuille(tmp_path/"case", XAPIC)["flow"]
    figures.atMost("flow over that of theory, less one", abs(flow - 1), 0.02)


def testJetThroughAnOpening(tmp_path, figures):
    """Four cells high: what no transfer takes is lost elsewhere"""
    figures.atLeast("speed of the jet over Torricelli's",
                    scenes.opening(tmp_path/"case", XAPIC)["jet"], 0.8)


@pytest.mark.parametrize("dim", [2, 3])
def testRanksAgree(tmp_path, figures, dim):
    serial = damBreak(dim, points=2, water=XAPIC).steps(60).write(
        tmp_path/"serial").prepare()
    parallel = serial.clone(tmp_path/"parallel").decompose(2)
    serial.solve()
    parallel.solve(ranks=2)
    agree(figures, parallel, serial)


def testEnergy(tmp_path, figures):
    case = damBreak(points=3, water=XAPIC).until(1).write(
        tmp_path/"case").prepare()
    case.solve()
    e = case.energies()["total"]
    figures.atMost("growth of the energy over its initial value", float(
        max(e[i] - min(e[:i + 1]) for i in range(len(e)))/e[0]), 1e-3)


def testRateOfAnotherTransfer(tmp_path, figures):
    case = damBreak(water={"transfer": "APIC", "filterRate": 100}).steps(2).write(
        tmp_path/"case").prepare()
    text = case.solve().text
    figures.contains("log", "keyword filterRate has no effect" in text,
                     "keyword filterRate has no effect")


def testNegativeRate(tmp_path):
    case = damBreak(water={**XAPIC, "filterRate": -1}).write(tmp_path/"case")
    case.run("blockMesh")
    with pytest.raises(CaseError, match="filterRate"):
        case.run("setMaterialPoints")
        case.solve()
