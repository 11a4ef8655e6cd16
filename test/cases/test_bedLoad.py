"""Bed load that is thinner than a cell: a current over an endless bed, against
the law that is asked for, beside what the grid moves without it."""

import re

import numpy as np
import pytest

from caseBuilder import G, RHO, RHO_S, Setup, box, hydrostatic
from test_badInput import refused, words
from test_wallJet import CloudPoints

H, BED, DEPTH, N = 0.005, 0.02, 0.03, 12
D = 0.85e-3
WEIGHT = (RHO_S - RHO)*G*D
SCALE = np.sqrt((RHO_S/RHO - 1)*G*D**3)

# Short, so that a short run has averaged; 0.6 s by default
AVERAGING = 0.1


def current(stress, bedLoad, cells=None, **soil):
    """A current that would bring a stress to the bed; driven by gravity"""
    cells = cells or (N, round(0.06/H))
    up = len(cells) - 1
    end = [n*H for n in cells]

    def over(lower, upper):
        a, b = [0]*len(cells), list(end)
        a[up], b[up] = lower, upper
        return tuple(a), tuple(b)

    g, gradient = [0, 0, 0], [0]*9
    g[0], g[up] = stress/(RHO*DEPTH), -G
    # As the scheme's diffusion of momentum has it, about
    gradient[3*0 + up] = stress/RHO/1.3e-4
    centre = [0, 0, 0]
    centre[up] = BED
    level = BED + DEPTH
    setup = Setup(
        cells=cells, h=H, g=tuple(g), points=2, energy=False,
        regions={
            "current": hydrostatic(*over(BED, level), velocityGradient=gradient,
                                   velocity=(0, 0, 0), centre=tuple(centre)),
            "pores": box(*over(0, BED), pressure="hydrostatic", level=level)},
        soilRegions={"bed": box(*over(0, BED), stress="geostatic",
                                saturated=True)},
        fluid={"soundSpeed": 20}, mpm={"maxSoilSoundSpeed": 20},
        placement={"placement": "jittered"},
        soil={"bedLoad": bedLoad, **soil})
    if bedLoad != "none":
        setup.soil.setdefault(
            f"{bedLoad}Coeffs", {"averagingTime": AVERAGING})
    return setup.cyclic(*"xyz"[:up])


def solved(setup, path, endTime, write):
    setup.until(endTime, write)
    case = setup.write(path)
    case.prepare()
    case.solve()
    return case


def transports(case, times, cells):
    """Dimensionless, along x"""
    x, mass = [], None
    for t in times:
        p = CloudPoints(case, "soil", t)
        x.append(p.x[:, 0])
        mass = p.mass
    length = cells[0]*H
    way = np.diff(np.array(x), axis=0)
    way = (way + 0.5*length) % length - 0.5*length
    area = length*(H if len(cells) == 2 else cells[1]*H)
    return (mass*way).sum(axis=1)/RHO_S/area/np.diff(
        [float(t) for t in times])/SCALE


def loggedStress(case):
    text = (case.path/"log.mpmFoam").read_text()
    return [float(s) for s in re.findall(r"stress on the bed (\S+) Pa", text)]


def testCarriesWhatTheLawSays(tmp_path, figures):
    """The law takes a stress that swings, so that it may carry up to twice
    what it does of the mean; without it the grid moves next to nothing"""
    found = {}
    for law in ["MeyerPeterMueller", "none"]:
        setup = current(3, law)
        case = solved(setup, tmp_path/law, 0.8, 0.1)
        times = [f"{t:g}" for t in np.arange(4, 9)/10]
        found[law] = transports(case, times, setup.cells).mean()
        logged = np.array(loggedStress(case))
        stress = logged[len(logged)//2:].mean()
        first, last = (CloudPoints(case, "soil", t).mass
                       for t in ["0", times[-1]])
        figures.equal(f"{law}: grains", len(last), len(first))
        figures.atMost(f"{law}: change of their masses, kg",
                       np.abs(last - first).max(), 0)
        theta = stress/WEIGHT
        if law != "none":
            expected = 8*max(theta - 0.047, 0)**1.5
            figures.atLeast("Shields parameter", theta, 0.1)
            figures.atMost("transport over the law's", found[law]/expected, 2)
            figures.atLeast("transport over the law's", found[law]/expected,
                            0.5)
    figures.atMost("without over with the law",
                   found["none"]/found["MeyerPeterMueller"], 0.1)


def testRestsBelowTheThreshold(tmp_path, figures):
    setup = current(0.35, "WongParker")
    case = solved(setup, tmp_path/"case", 0.4, 0.1)
    found = transports(case, ["0.2", "0.3", "0.4"], setup.cells)
    figures.atMost("transport", abs(found).max(), 1e-3)


def testThreeDimensionsAndRanks(tmp_path, figures):
    """Gravity along z, and the same in two parts"""
    setup = current(3, "MeyerPeterMueller", cells=(6, 4, 12))
    setup.until(0.02, 0.02)
    whole = setup.write(tmp_path/"serial").prepare()
    parts = whole.clone(tmp_path/"parallel")
    parts.decompose(2)
    whole.solve()
    parts.solve(ranks=2)
    x = [(p.x, p["bedStress"]) for p in
         (CloudPoints(case, "soil", "0.02") for case in [whole, parts])]
    scale = np.abs(x[0][1]).max()
    figures.atLeast("averaged stress, Pa", scale, 1e-3)
    figures.atMost("way of points, relative to a cell",
                   np.abs(x[0][0] - x[1][0]).max()/H, 1e-9)
    figures.atMost("stress, relative",
                   np.abs(x[0][1] - x[1][1]).max()/scale, 1e-6)


@pytest.mark.parametrize("law, coeffs, expect", [
    ("vanRijn", None, ["bedLoad", "vanRijn", "WongParker"]),
    ("MeyerPeterMueller", {"criticalShields": 2}, ["criticalShields", "2"]),
    ("MeyerPeterMueller", {"critical": 0.05}, ["critical", "criticalShields"])])
def testRefused(tmp_path, figures, law, coeffs, expect):
    setup = current(1, law)
    setup.soil.pop(f"{law}Coeffs")
    if coeffs:
        setup.soil[f"{law}Coeffs"] = coeffs
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False),
            {"entry": words(*expect)})
