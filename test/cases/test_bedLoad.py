"""Bed load that is thinner than a cell: a current over an endless bed, against
the law that is asked for, beside what the grid moves without it."""

import re

import numpy as np
import pytest

from caseBuilder import G, RHO, RHO_S, Setup, box, hydrostatic
from test_badInput import refused, words
from test_restart import body
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


@pytest.mark.parametrize("stress", [0.3, 3])
def testByTheLawOfTheWall(tmp_path, figures, stress):
    """A current in equilibrium, of the logarithmic law: the stress on the bed
    is what drives it, and what it carries is what Meyer-Peter and Mueller say of
    that; at half the critical stress nothing"""
    uStar, ks = np.sqrt(stress/RHO), 2.5*D
    setup = current(stress, "MeyerPeterMueller", bedStress="wallLaw")
    setup.water = {"turbulence": "kEpsilon", "transfer": "XAPIC",
                   "bodyForce": (stress/RHO/DEPTH, 0, 0),
                   "kEpsilonCoeffs": {
                       "k": uStar**2/0.3/2,
                       "epsilon": uStar**3/0.41/(DEPTH/2)}}
    setup.g = (0, -G, 0)
    setup.regions.pop("current")
    rowsOver = round(DEPTH/H)
    for j in range(rowsOver):
        z = (j + (np.arange(100) + 0.5)/100)*H
        setup.regions[f"row{j}"] = box(
            (0, BED + j*H), (N*H, BED + (j + 1)*H), pressure="hydrostatic",
            level=BED + DEPTH, velocity=((uStar/0.41*np.log1p(30*z/ks)).mean(), 0, 0))
    case = solved(setup, tmp_path/"case", 0.8, 0.1)
    times = [f"{t:g}" for t in np.arange(4, 9)/10]
    found = transports(case, times, setup.cells)
    logged = np.array(loggedStress(case))
    mean = logged[len(logged)//2:].mean()
    figures.atMost("stress over what drives the water, less one",
                   abs(mean/stress - 1), 0.2)
    if stress < 0.047*WEIGHT:
        figures.atMost("transport", abs(found).max(), 1e-3)
    else:
        expected = 8*(mean/WEIGHT - 0.047)**1.5
        figures.atMost("transport over the law's, less one",
                       abs(found.mean()/expected - 1), 0.3)


def testRestsBelowTheThreshold(tmp_path, figures):
    setup = current(0.35, "WongParker")
    case = solved(setup, tmp_path/"case", 0.4, 0.1)
    found = transports(case, ["0.2", "0.3", "0.4"], setup.cells)
    figures.atMost("transport", abs(found).max(), 1e-3)


# A dune and a hole as high as a cell: from, to, height in cells
UNEVEN = [(0, 4, 0), (4, 9, 1), (9, 12, 0), (12, 17, -1), (17, 20, 0)]


def uneven(stress, law="MeyerPeterMueller"):
    """A current over an uneven bed; stress is what it would bring to a flat
    one"""
    setup = current(stress, law, cells=(20, round(0.06/H)))
    over = setup.regions["current"]
    top = over["max"][1]
    setup.regions, setup.soilRegions = {}, {}
    for n, (first, last, rise) in enumerate(UNEVEN):
        at = BED + rise*H
        for name, low, high in [("pores", 0, at), ("hole", at, BED),
                                ("current", max(at, BED), top)]:
            if high <= low:
                continue
            region = box((first*H, low), (last*H, high),
                         pressure="hydrostatic", level=top)
            if name == "current":
                region.update({k: over[k] for k in [
                    "velocity", "velocityGradient", "centre"]})
            setup.regions[f"{name}{n}"] = region
        setup.soilRegions[f"bed{n}"] = box(
            (first*H, 0), (last*H, at), stress="geostatic", saturated=True)
    return setup


def surfaceStress(case, time):
    """That of the topmost grains of each column of cells, along x"""
    p = CloudPoints(case, "soil", time)
    column = np.floor(p.x[:, 0]/H)
    return np.array([
        p["bedStress"][here[np.argsort(p.x[here, 1])[-2:]], 0].mean()
        for here in (np.flatnonzero(column == i)
                     for i in np.unique(column))])


def testStillWaterHasNoStress(tmp_path, figures):
    """Over an uneven bed the drag on the grains at its surface is several
    times what the smoothed pressure explains: half the critical one. Water
    flows at some mm/s in the first tenths of a second"""
    case = solved(uneven(0), tmp_path/"case", 0.4, 0.1)
    worst = max(np.abs(surfaceStress(case, t)).max()
                for t in ["0.2", "0.3", "0.4"])
    figures.atMost("stress over the critical one", worst/WEIGHT/0.047, 0.2)


def testUnevenBedRestsBelowTheThreshold(tmp_path, figures):
    """The mean stress is half the critical one; dune and hole stay"""
    setup = uneven(0.45)
    case = solved(setup, tmp_path/"case", 0.8, 0.1)
    times = [f"{t:g}" for t in np.arange(4, 9)/10]
    stress = np.mean([surfaceStress(case, t).mean() for t in times])
    figures.atLeast("mean Shields parameter", stress/WEIGHT, 0.015)
    figures.atMost("mean Shields parameter", stress/WEIGHT, 0.03)
    found = transports(case, times, setup.cells)
    figures.atMost("transport", abs(found).max(), 1e-3)
    first, last = (CloudPoints(case, "soil", t).x for t in ["0", "0.8"])
    figures.atMost("farthest way of a grain over its diameter",
                   np.abs(last - first)[:, 0].max()/D, 1)


@pytest.mark.parametrize("bed", ["flat", "uneven"])
def testRestart(tmp_path, figures, bed):
    """What points have averaged is of the state: two runs are one"""
    setup = current(3, "MeyerPeterMueller") if bed == "flat" else uneven(3)
    setup.steps(60)
    split = setup.write(tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")
    split.solve()
    split.solve()
    whole.change(control={"writeInterval": 120})
    whole.solve()
    end = [c.path/c.timesByStep()[120]/"lagrangian"/"soil"
           for c in [split, whole]]
    names = {p.name for p in end[0].iterdir()}
    figures.holds("the averaged stress is written", "bedStress" in names)
    figures.equal("files", names, {p.name for p in end[1].iterdir()})
    figures.equal("files that differ", [
        n for n in sorted(names) if body(end[0]/n) != body(end[1]/n)], [])


@pytest.mark.parametrize("dim", [2, 3])
def testRanks(tmp_path, figures, dim):
    """The same in two parts; in three dimensions gravity is along z"""
    setup = uneven(3) if dim == 2 else current(
        3, "MeyerPeterMueller", cells=(6, 4, 12))
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
                   np.abs(x[0][0] - x[1][0]).max()/H, 1e-10)
    figures.atMost("stress, relative",
                   np.abs(x[0][1] - x[1][1]).max()/scale, 1e-10)


def testLogFindsTheBedRarely(tmp_path, figures):
    """Where nothing else needs the bed's surface, it costs half a step: only
    when a time is written"""
    for law, entries in [("none", 1), ("MeyerPeterMueller", 21)]:
        case = current(1, law).steps(210).write(tmp_path/law)
        case.prepare()
        case.solve()
        figures.equal(f"{law}: entries of the log", len(re.findall(
            "^Time = ", (case.path/"log.mpmFoam").read_text(), re.M)), 21)
        figures.equal(f"{law}: with the stress on the bed",
                      len(loggedStress(case)), entries)


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
