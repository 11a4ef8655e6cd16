"""Ranks get the same work: decomposePar with weights of setMaterialPoints, and
the same part of each cloud, with its decomposition."""

import re

import numpy as np
import pytest

from mpmfoam.foamFile import readList

from caseBuilder import Setup, box, damBreak, foamText, header, hydrostatic
from test_wallJet import CloudPoints


def decompose(case, ranks, n, method, weights, times=None):
    entries = {"numberOfSubdomains": ranks, "method": method,
               f"{method}Coeffs": {"n": n, "delta": 0.001}}
    if method == "hierarchical":
        entries["hierarchicalCoeffs"]["order"] = "xyz"
    if weights:
        entries["weightField"] = "pointWeights"
    (case.path/"system"/"decomposeParDict").write_text(
        header("decomposeParDict") + foamText(entries))
    case.run("decomposePar", "-force", *(["-latestTime"] if times else []))


def imbalance(case, time, weight):
    """Largest work of a rank over the mean, of the clouds with a weight"""
    work = []
    for processor in case.case.processors:
        files = {cloud: processor/time/"lagrangian"/cloud/"id"
                 for cloud in weight}
        # Without points a rank has no file
        work.append(sum(weight[cloud]*len(readList(file))
                        for cloud, file in files.items() if file.is_file()))
    figure = max(work)*len(work)/sum(work)
    print("work of the ranks:", work)
    return figure


@pytest.mark.parametrize("ranks, n, method", [
    (2, (2, 1, 1), "simple"), (4, (4, 1, 1), "simple"),
    (4, (2, 2, 1), "hierarchical")])
def testDamBreak(tmp_path, figures, ranks, n, method):
    """A column in two fifths of the box"""
    case = damBreak(h=0.01).write(tmp_path/"case").prepare()
    case.run("setMaterialPoints", "-weights")
    weight = {"water": 1}
    found = {}
    for weights in [False, True]:
        decompose(case, ranks, n, method, weights)
        found[weights] = imbalance(case, "0", weight)
    figures.atLeast("without weights: largest work over the mean",
                    found[False], 1.5)
    # A column of cells is 5 % of the points
    figures.atMost("with weights", found[True], 1.2 if ranks > 2 else 1.05)


def testSoil(tmp_path, figures):
    """Soil costs more: its weight, and a later time of the run"""
    case = Setup(
        cells=(40, 10), h=0.01, points=2, energy=False,
        regions={"water": hydrostatic((0, 0), (0.2, 0.05))},
        soilRegions={"bed": box((0.2, 0), (0.3, 0.05), stress="geostatic")},
    ).until(0.01).write(tmp_path/"case").prepare()
    case.solve()
    time = case.times[-1]
    result = case.run("setMaterialPoints", "-weights", "-soilWeight", "4")
    figures.contains("log", re.search(
        "Cloud soil: .* of weight 4", result.text), "soil of weight 4")

    cells = case.case.field(time, "pointWeights")
    number = {c: len(CloudPoints(case, c, time).id) for c in case.setup.clouds}
    figures.equal("sum of the weights", float(np.sum(cells)),
                  float(number["water"] + 4*number["soil"]))
    weight = {"water": 1, "soil": 4}
    found = {}
    for weights in [False, True]:
        decompose(case, 2, (2, 1, 1), "simple", weights, times=time)
        found[weights] = imbalance(case, time, weight)
    figures.atLeast("without weights: largest work over the mean",
                    found[False], 1.1)
    figures.atMost("with weights", found[True], 1.05)
    case.change(control={"endTime": 0.02})
    case.solve(ranks=2)
    figures.holds("goes on with them", float(case.times[-1]) > float(time),
                  case.times[-1])


@pytest.mark.parametrize("ranks", [2, 3, 4])
def testEachCloud(tmp_path, figures, ranks):
    """Deep water at one end, a bed under shallow water over the rest: with equal
    sums alone one rank would have most of the water, another most of the soil"""
    case = Setup(
        cells=(120, 20), h=0.01, points=1, energy=False,
        regions={"deep": hydrostatic((0, 0), (0.4, 0.18)),
                 "shallow": hydrostatic((0.4, 0.1), (1.2, 0.12))},
        soilRegions={"bed": box((0.4, 0), (1.2, 0.1), stress="geostatic")},
    ).until(0.002).write(tmp_path/"case").prepare()
    case.run("setMaterialPoints", "-weights")
    decompose(case, ranks, (ranks, 1, 1), "simple", True)
    figures.atLeast("water by weights: most of a rank over the mean",
                    imbalance(case, "0", {"water": 1}), 1.25)

    (case.path/"system"/"decomposeParDict").write_text(
        header("decomposeParDict") + foamText({
            "numberOfSubdomains": ranks, "method": "manual",
            "manualCoeffs": {"dataFile": '"cellDecomposition"'}}))
    case.run("setMaterialPoints", "-decomposition")
    case.run("decomposePar", "-force")
    for cloud in ["water", "soil"]:
        # Three parts of two kinds of work need not exist, and a column is
        # 2.5 % of the deep water: more of a part of it
        figures.atMost(f"{cloud}: most of a rank over the mean",
                       imbalance(case, "0", {cloud: 1}),
                       1.05 if ranks == 2 else 1.15)
    case.solve(ranks=ranks)
    figures.holds("it runs", case.log.finished)


@pytest.mark.parametrize("ranks", [3, 26])
def testNothingThereYet(tmp_path, figures, ranks):
    """A domain that an inlet will fill: each rank gets cells, or it is said
    that there are too few"""
    setup = damBreak()
    setup.regions = {}
    setup.sides["xmin"] = ("patch", {
        "type": "fixedValue", "value": "uniform (1 0 0)"})
    setup.water["inflowOutflow"] = {"inlets": {"in": {
        "patch": "xmin", "velocity": (1, 0, 0)}}}
    case = setup.write(tmp_path/"case").prepare()
    (case.path/"system"/"decomposeParDict").write_text(
        header("decomposeParDict") + foamText({
            "numberOfSubdomains": ranks, "method": "manual",
            "manualCoeffs": {"dataFile": '"cellDecomposition"'}}))
    result = case.run("setMaterialPoints", "-decomposition", check=False)
    if ranks > 25:
        figures.equal("exit status", result.status, 1)
        for part in ["numberOfSubdomains is 26", "longest direction", "25"]:
            figures.holds(part, part in result.text)
        return
    case.run("decomposePar")
    cells = [len(readList(p/"constant/polyMesh/cellProcAddressing"))
             for p in case.case.processors]
    figures.atLeast("fewest cells of a rank over the mean",
                    min(cells)*ranks/sum(cells), 0.9)


def testDecompositionIsSerial(tmp_path, figures):
    """It comes before decomposePar, and needs its dictionary"""
    case = damBreak().write(tmp_path/"case").prepare()
    result = case.run("setMaterialPoints", "-decomposition", check=False)
    figures.equal("exit status", result.status, 1)
    figures.holds("named", "decomposeParDict" in result.text)


def testBadWeight(tmp_path, figures):
    case = damBreak().write(tmp_path/"case").prepare()
    result = case.run("setMaterialPoints", "-weights", "-soilWeight", "-1",
                      check=False)
    figures.equal("exit status", result.status, 1)
    figures.holds("named", "soilWeight" in result.text
                  and "> 0" in result.text)
