"""Transfers of water alone: the viscosity that they have by themselves,
ranks, energy. Scenes of validation/transfer."""

import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(
    Path(__file__).resolve().parents[2]/"validation"/"transfer"))

import scenes  # noqa: E402
from caseBuilder import CaseError, Setup, box, damBreak  # noqa: E402
from test_parallel import agree  # noqa: E402
from test_restart import differing  # noqa: E402

CELLS = {"transfer": "XAPIC"}
XAPIC = {**CELLS, "pressureQuadrature": "points"}


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


@pytest.mark.parametrize("water", [XAPIC, CELLS], ids=["points", "cells"])
@pytest.mark.parametrize("dim", [2, 3])
def testRanksAgree(tmp_path, figures, dim, water):
    serial = damBreak(dim, points=2, water=water).steps(60).write(
        tmp_path/"serial").prepare()
    parallel = serial.clone(tmp_path/"parallel").decompose(2)
    serial.solve()
    parallel.solve(ranks=2)
    agree(figures, parallel, serial)


@pytest.mark.parametrize("water", [XAPIC, CELLS], ids=["points", "cells"])
def testEnergy(tmp_path, figures, water):
    case = damBreak(points=3, water=water).until(1).write(
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


@pytest.mark.parametrize("dim", [2, 3])
def testUniformPressurePushesNothing(tmp_path, figures, dim):
    """A box full of jittered points under 1 kPa, cyclic all round: integrated
    by the points it moves them, by cells not at all"""
    def speed(quadrature):
        n = 8 if dim == 2 else 4
        setup = Setup(
            cells=(n,)*dim, h=1/n, g=(0, 0, 0), energy=False,
            points=3 if dim == 2 else 2,
            regions={"all": box((0,)*dim, (1,)*dim, pressure="uniform",
                                p=1000)},
            placement={"placement": "jittered", "jitter": 0.25, "seed": 1},
            fluid={"soundSpeed": 10}, mpm={"volumeCorrection": False},
            water={**XAPIC, "pressureQuadrature": quadrature})
        case = setup.cyclic(*"xyz"[:dim]).steps(50).write(
            tmp_path/quadrature).prepare()
        case.solve()
        return float(abs(case.points().U).max())
    figures.atLeast("largest speed, points [m/s]", speed("points"), 1e-3)
    figures.atMost("largest speed, cells [m/s]", speed("cells"), 1e-9)


def testBlocksThatCollide(tmp_path, figures):
    """Two blocks in free flight: momentum is exact, and cells were full"""
    case = Setup(
        cells=(30, 20), h=0.02, g=(0, 0, 0), points=3, water=CELLS,
        placement={"placement": "jittered", "jitter": 0.25, "seed": 1},
        fluid={"soundSpeed": 20}, regions={
            "left": box((0.1, 0.1), (0.28, 0.3), velocity=(1, 0, 0)),
            "right": box((0.3, 0.1), (0.48, 0.3), velocity=(-1, 0.2, 0))},
        ).until(0.03).write(tmp_path/"case").prepare()
    case.solve()
    first, last = case.points("0"), case.points()
    scale = (first.mass[:, None]*abs(first.U)).sum()
    figures.atMost("change of momentum over sum m |U|", float(abs(
        (last.mass[:, None]*last.U).sum(axis=0)
        - (first.mass[:, None]*first.U).sum(axis=0)).max()/scale), 1e-13)
    figures.atLeast("largest pressure over rho c 1 m/s",
                    float(last.p.max()/2e4), 0.05)


def testQuieterStillWater(tmp_path, figures):
    """After 10 s; 0.49 and 0.36 in validation/transfer"""
    points = scenes.still(tmp_path/"points", XAPIC, end=10)
    cells = scenes.still(tmp_path/"cells", CELLS, end=10)
    for name in ["noise", "speed"]:
        figures.atMost(f"{name}: cells over points",
                       cells[name]/points[name], 0.75)


def testRestartWithCells(tmp_path, figures):
    split = damBreak(points=2, water=CELLS).steps(20).write(
        tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")
    split.solve()
    whole.change(control={"stopAt": "endTime", "endTime": 0.06})
    split.solve()
    whole.solve()
    end = max(split.timesByStep())
    figures.equal("files that differ", differing(split, whole, end), [])


def testUnknownQuadrature(tmp_path):
    case = damBreak(water={"pressureQuadrature": "gauss"}).write(
        tmp_path/"case")
    case.run("blockMesh")
    with pytest.raises(CaseError, match="(?s)pressureQuadrature.*points cells"):
        case.run("setMaterialPoints")
        case.solve()
