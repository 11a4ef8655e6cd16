"""Grid, exchange, constraints, tiles and kernels made again while a run goes
on, from the points in memory: no number changes."""

import pytest

from caseBuilder import Setup, box, damBreak, hydrostatic
from test_openBoundaries import channel
from test_restart import differing


def bed():
    """Water that falls on soil beside a step, on walls with friction"""
    return Setup(
        cells=(16, 14), h=0.02, points=2, energy=False,
        solid=[((11, 0), (16, 4))],
        regions={"fall": box((0.04, 0.14), (0.14, 0.24))},
        soilRegions={"bed": box((0, 0), (0.22, 0.1))},
        soilWall={"type": "frictional", "frictionCoefficient": 0.5},
        control={"libs": '("libmpmBackgroundGrid.so")'})


CASES = {
    "frictional bed under water": bed,
    "bed load": lambda: Setup(
        cells=(16, 10), h=0.02, points=2, energy=False,
        sides={"xmin": ("cyclic", "cyclic"), "xmax": ("cyclic", "cyclic")},
        regions={"flow": hydrostatic(
            (0, 0), (0.32, 0.16), velocity=(0.5, 0, 0))},
        soilRegions={"bed": box((0, 0), (0.32, 0.08))},
        soil={"bedLoad": "MeyerPeterMueller"}),
    "inlet and outlet": lambda: channel(length=0.3),
    "3D": lambda: damBreak(3, points=2),
    "XPIC": lambda: damBreak(water={"transfer": "XPIC"}),
}


@pytest.mark.parametrize("ranks", [1, 2])
@pytest.mark.parametrize("name", CASES)
def testRebuilt(tmp_path, figures, name, ranks):
    setup = CASES[name]().steps(40)
    whole = setup.write(tmp_path/"whole").prepare()
    rebuilt = whole.clone(tmp_path/"rebuilt")
    rebuilt.change(control={"DebugSwitches": {"mpmRebuildInterval": 7}})
    for case in whole, rebuilt:
        if ranks > 1:
            case.decompose(ranks)
        case.solve(ranks)
        if ranks > 1:
            case.run("reconstructPar")
    figures.equal("files that differ", differing(whole, rebuilt, 40), [])
