"""Points that no longer belong to their case: what would falsify a run is
refused, with the old and the new value and what to do; what is harmless is
said; and files that cannot hold the points are not written."""

import os
import re
import subprocess
import time

import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak, foamText, hydrostatic
from test_restart import limitFileSize


def withSoil(h=0.02):
    """Water over a bed of soil, small"""
    return Setup(
        cells=(10, 10), h=h, points=2, energy=False,
        regions={"column": hydrostatic((0, 0), (5*h, 7*h))},
        soilRegions={"bed": box((0, 0), (10*h, 3*h), stress="geostatic")})


def refused(figures, result, *patterns):
    at = result.text.find("--> FOAM FATAL")
    flat = re.sub(r"\s+", " ", result.text[max(at, 0):])
    print(result.text[max(at, 0):][:3000])
    figures.equal("exit status", result.status, 1)
    figures.holds("a FatalError", at >= 0)
    for pattern in patterns:
        found = re.search(pattern, flat)
        figures.contains("message", found and found[0], pattern)


def scale(factor):
    def change(case):
        case.run("transformPoints", "-scale", f"({factor} {factor} {factor})")
    return change


def translate(*by):
    def change(case):
        case.run("transformPoints", "-translate", foamText(by))
    return change


def otherBlocks(case):
    """A hole where there is no water"""
    case.setup.solid = [((12, 12), (15, 15))]
    case.rewrite()
    case.run("blockMesh")


def otherHole(case):
    case.setup.solid = [((14, 12), (17, 15))]
    case.rewrite()
    case.run("blockMesh")


def entry(section, **entries):
    return lambda case: case.change(**{section: entries})


def coefficient(keyword, value):
    def change(case):
        coeffs = case.setup.properties()["soil"]["DruckerPragerCoeffs"]
        case.change(soil={"DruckerPragerCoeffs": {**coeffs, keyword: value}})
    return change


def otherModel(case):
    coeffs = case.setup.properties()["soil"]["DruckerPragerCoeffs"]
    case.setup.soil = {
        "constitutiveModel": "linearElastic", "linearElasticCoeffs": {
            **{k: coeffs[k] for k in ["rhoS", "d", "e0", "nu"]}, "E": 1e6}}
    case.rewrite()


def onlyWater(case):
    case.setup.soilRegions = {}
    case.rewrite()


MESH = "constant/polyMesh"
PROPERTIES = "constant/materialPointProperties"

# change, whether the scene has soil, what the message says
BASIS = {
    "scaled": (scale(2), False, [
        MESH, r"mesh/spacing was \(0\.02 0\.02 0\.02\), "
        r"is \(0\.04 0\.04 0\.04\)"]),
    "translated": (translate(0.02, 0, 0), False, [
        MESH, r"mesh/origin was \(0 0 0\), is \(0\.02 0 0\)"]),
    "hole": (otherBlocks, False, [MESH, r"mesh/cells was 500, is 491"]),
    "density": (entry("fluid", rho0=1200), False, [
        PROPERTIES, r"water/rho0 was 1000, is 1200"]),
    "gamma": (entry("fluid", gamma=1.5), False, [
        PROPERTIES, r"water/gamma was 7, is 1\.5"]),
    "soundSpeed": (entry("fluid", soundSpeed=30), False, [
        PROPERTIES, r"water/soundSpeed was 14\.0\d+, is 30"]),
    "grains": (coefficient("rhoS", 2500), True, [
        PROPERTIES, r"soil/rhoS was 2650, is 2500"]),
    "diameter": (coefficient("d", 2e-3), True, [
        PROPERTIES, r"soil/d was 0\.00085, is 0\.002"]),
    "voidRatio": (coefficient("e0", 0.9), True, [
        PROPERTIES, r"soil/e0 was 0\.695, is 0\.9"]),
    "model": (otherModel, True, [
        PROPERTIES,
        r"soil/constitutiveModel was DruckerPrager, is linearElastic"]),
    "clouds": (onlyWater, True, [
        PROPERTIES, r"clouds was .*\(water soil\), is .*\(water\)"]),
}


@pytest.mark.parametrize("when", ["start", "restart"])
@pytest.mark.parametrize("what", BASIS)
def testRefused(tmp_path, figures, what, when):
    """The basis of the points: before the first step and later"""
    change, soil, patterns = BASIS[what]
    setup = withSoil() if soil else damBreak()
    case = setup.steps(3).write(tmp_path/"case").prepare()
    if when == "restart":
        case.solve()
    change(case)
    result = case.solve(check=False)
    if (what, when) == ("hole", "restart"):
        # OpenFOAM comes first, to a field on the cells
        refused(figures, result, "U.water",
                "size 500 is not equal to the given value of 491")
        return
    refused(figures, result, "uniform/materialPoints",
            *patterns, "run setMaterialPoints again", "restore")


def testOtherHole(tmp_path, figures):
    """As many cells, in another place"""
    setup = damBreak()
    setup.solid = [((12, 12), (15, 15))]
    case = setup.steps(3).write(tmp_path/"case").prepare()
    otherHole(case)
    refused(figures, case.solve(check=False), MESH,
            "other blocks of the mesh are left out")


PLACEMENT = {
    "pointsPerDirection": (
        lambda s: setattr(s, "points", 4),
        r"setMaterialPointsDict: water/pointsPerDirection was 3, is 4"),
    "region": (
        lambda s: s.regions["column"].update(max=(0.3, 0.2, 10)),
        r"setMaterialPointsDict: water/regions/column/max was "
        r"\(0\.2 0\.2 10\), is \(0\.3 0\.2 10\)"),
    "gravity": (
        lambda s: setattr(s, "g", (0, -5, 0)),
        r"constant/g: gravity was \(0 -9\.81 0\), is \(0 -5 0\)"),
}


@pytest.mark.parametrize("what", PLACEMENT)
def testPlacedOtherwise(tmp_path, figures, what):
    """What setMaterialPoints had read: an error before the first step; after
    it only gravity still means something, and is said"""
    change, pattern = PLACEMENT[what]
    case = damBreak().steps(3).write(tmp_path/"case").prepare()
    later = case.clone(tmp_path/"later")
    later.solve()
    for c in [case, later]:
        change(c.setup)
        c.rewrite()
    refused(figures, case.solve(check=False), "0/uniform/materialPoints",
            pattern, "run setMaterialPoints again")
    text = later.solve().text
    figures.equal("said at a restart", "Restart with another" in text,
                  what == "gravity")


SETTINGS = {
    "transfer": ({"water": {"transfer": "FLIP"}}, [
        r"transfer \(water\): was APIC, is FLIP"]),
    "viscosity": ({"fluid": {"mu": 0.1}}, [
        r"mu \(water/weaklyCompressibleNewtonianCoeffs\): was 0\.001, "
        r"is 0\.1"]),
    "smoothing": ({"mpm": {"smoothing": False}}, [
        r"smoothing \(MPM\): was yes, is no"]),
    "maxCo": ({"mpm": {"maxCo": 0.3}}, [r"maxCo \(MPM\): was 0\.5, is 0\.3"]),
    "shapeFunction": ({"mpm": {"shapeFunction": "cubicBSpline"}}, [
        r"shapeFunction \(MPM\): was quadraticBSpline, is cubicBSpline"]),
}


@pytest.mark.parametrize("what", SETTINGS)
def testSaid(tmp_path, figures, what):
    """Another setting is said, there and back, and the run goes on"""
    entries, patterns = SETTINGS[what]
    case = damBreak().steps(3).write(tmp_path/"case").prepare()
    figures.equal("said where nothing changed",
                  "with another" in case.solve().text, False)
    case.change(**entries)
    text = case.solve().text
    for pattern in patterns:
        found = re.search("Restart with another " + pattern, text)
        figures.contains("log", found and found[0], pattern)
    figures.equal("lines", len(re.findall("with another", text)),
                  len(patterns))
    case.change(water={"transfer": "APIC"}, fluid={"mu": 1e-3}, mpm={
        "smoothing": True, "maxCo": 0.5,
        "shapeFunction": "quadraticBSpline"})
    text = case.solve().text
    figures.equal("lines on the way back",
                  len(re.findall("Restart with another", text)),
                  len(patterns))
    figures.equal("steps", max(case.timesByStep()), 9)
    points = case.points()
    figures.holds("finite", np.all(np.isfinite(points.U)))


def testSoilBeginsToBeSmoothed(tmp_path, figures):
    """A bed under its own weight stays at rest where smoothing begins"""
    setup = Setup(
        cells=(10, 10), h=0.02, points=2, energy=False, regions={},
        mpm={"smoothing": False},
        soilRegions={"bed": box((0, 0), (0.2, 0.06), stress="geostatic")})
    case = setup.steps(5).write(tmp_path/"case").prepare()
    case.solve()
    case.change(mpm={"smoothing": True})
    text = case.solve().text
    figures.contains("log", re.search(
        r"points had no \(?.*compressionMean.*it begins here", text),
        "compressionMean begins")
    U = case.case.cloudField(case.times[-1], "soil", "U")
    # 1.7e-4 where it was smooth from the start
    figures.atMost("largest speed in m/s", float(np.abs(U).max()), 2e-4)


def testTheSameNumbers(tmp_path, figures):
    """Written in another way they are no change"""
    case = damBreak(fluid={"soundSpeed": 20}).steps(3)
    case = case.write(tmp_path/"case").prepare()
    case.change(fluid={"rho0": "rho0 [1 -3 0 0 0 0 0] 1e3", "mu": "0.001",
                       "soundSpeed": "20.0"})
    text = case.solve().text
    figures.equal("said", re.findall("with another.*", text), [])


def testStateWithoutRecord(tmp_path, figures):
    """Files of an older mpmFoam: they run, and the log says that nothing was
    compared"""
    case = damBreak().steps(3).write(tmp_path/"case").prepare()
    path = case.path/"0"/"uniform"/"materialPoints"
    text = path.read_text()
    start = text.index("\ncase\n")
    end = re.search(r"^\}", text[start:], re.MULTILINE).end() + start
    text = text[:start] + text[end:]
    path.write_text(re.sub(r"\n    fields [^;]*;", "", text))
    case.change(fluid={"mu": 0.01})
    text = case.solve().text
    figures.holds("log", "has no record of the case" in text)
    figures.equal("said", re.findall("with another.*", text), [])


def asciiCase(path, **entries):
    setup = damBreak(**entries).steps(3)
    setup.control.update(writeFormat="ascii", writePrecision=12)
    return setup.write(path).prepare()


def edited(case, field, row, value):
    """One value of an ascii field of time 0"""
    path = case.path/"0"/"lagrangian"/"water"/field
    lines = path.read_text().splitlines()
    start = lines.index("(") + 1
    lines[start + row] = value(lines[start:]) if callable(value) else value
    path.write_text("\n".join(lines) + "\n")


@pytest.mark.parametrize("field, value, patterns", [
    ("mass", "0", [r"water/mass.*point 7 \(id \d+\) has the mass 0 kg",
                   "mass > 0"]),
    ("mass", "-0.4", [r"water/mass.*point 7 \(id \d+\) has the mass -0\.4"]),
    ("id", lambda rows: rows[3], [
        r"water/id.*point 3 and point 7 have the same id \d+",
        "each id once"]),
    ("id", "2.5", [r"water/id.*point 7 has the id 2\.5"]),
    ("id", "-3", [r"water/id.*point 7 has the id -3"])],
    ids=["zeroMass", "negativeMass", "doubleId", "brokenId", "negativeId"])
def testPoints(tmp_path, figures, field, value, patterns):
    case = asciiCase(tmp_path/"case")
    edited(case, field, 7, value)
    refused(figures, case.solve(check=False), *patterns)


@pytest.mark.parametrize("cells, ranks", [
    (-2.5e-4, 1), (25 + 2.5e-4, 1), (-0.01, 1), (-2.5e-4, 2), (-0.01, 2)])
def testBehindAWall(tmp_path, figures, cells, ranks):
    """By what digits of a file round off, a point may be behind a wall; not
    by more"""
    case = asciiCase(tmp_path/"case")
    edited(case, "x", 7, f"({0.02*cells:.12g} 0.05 0.01)")
    if ranks > 1:
        case.decompose(2)
    result = case.solve(ranks=ranks, check=False)
    if cells == -0.01:
        refused(figures, result, "1 points in .*lie outside of the mesh.*"
                r"point \d+ at \(-0\.0002 0\.05 0\.01\)",
                "changed after setMaterialPoints")
    else:
        figures.equal("exit status", result.status, 0)
        figures.equal("points", len(case.points().id), 900)


def testDoubleIdOnTwoRanks(tmp_path, figures):
    case = asciiCase(tmp_path/"case")
    case.decompose(2, cellRank=case.case.cellCentres("0")[:, 0] > 0.1)
    ids = []
    for rank in [0, 1]:
        path = case.path/f"processor{rank}"/"0"/"lagrangian"/"water"/"id"
        lines = path.read_text().splitlines()
        start = lines.index("(") + 1
        ids.append((path, lines, start))
    path, lines, start = ids[1]
    lines[start + 4] = ids[0][1][ids[0][2] + 2]
    path.write_text("\n".join(lines) + "\n")
    refused(figures, case.solve(ranks=2, check=False),
            "point 2 of rank 0 and point 4 of rank 1 have the same id")


# --- digits ---------------------------------------------------------------

def farAway(at, format_="ascii", precision=6):
    """A small dam break whose mesh is far from the origin"""
    setup = damBreak(origin=(at, 0, 0))
    setup.regions = {"column": hydrostatic((at, 0), (at + 0.2, 0.2))}
    setup.control.update(writeFormat=format_, writePrecision=precision)
    return setup.steps(3)


def testFarFromOrigin(tmp_path, figures):
    """Six digits do not hold cells of 20 mm at 30 km; with those that the
    message asks for, the points are where they are in binary"""
    case = farAway(30000).write(tmp_path/"case")
    case.run("blockMesh")
    result = case.run("setMaterialPoints", check=False)
    refused(figures, result, "system/controlDict", "writePrecision is 6",
            "writeFormat ascii", r"positions at up to 30000\.5 m",
            r"writePrecision >= \d+", "or writeFormat binary")
    digits = int(re.search(r"writePrecision >= (\d+)", result.text)[1])
    case.change(control={"writePrecision": digits})
    case.run("setMaterialPoints")
    binary = farAway(30000, "binary").write(tmp_path/"binary").prepare()
    a, b = case.points("0"), binary.points("0")
    figures.equal("points", len(a.id), len(b.id))
    figures.atMost("difference of x in cells",
                   float(np.abs(a.x - b.x).max()/0.02), 1e-3)
    case.solve()


def testSolverSaysSo(tmp_path, figures):
    """The solver refuses it, too, where it begins"""
    case = farAway(30000, "binary").write(tmp_path/"case").prepare()
    case.change(control={"writeFormat": "ascii"})
    refused(figures, case.solve(check=False), "writePrecision is 6",
            r"Allowed: writePrecision >= 1\d")


def testLargeIds(tmp_path, figures):
    """Ids are numbers of places in the mesh: 16 per cell and direction"""
    setup = Setup(
        cells=(100, 100), h=0.02, points=16, energy=False,
        regions={"drop": box((1.9, 1.9), (1.94, 1.94))})
    setup.control.update(writeFormat="ascii", writePrecision=6)
    case = setup.steps(3).write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False),
            "writePrecision is 6", r"ids up to 2\d{6}",
            "Allowed: writePrecision >= 7")


def testDigitsAreRaised(tmp_path, figures):
    """A controlDict that asks for too few digits while the run goes on"""
    setup = damBreak()
    setup.control.update(writeFormat="ascii", writePrecision=12)
    case = setup.endless(25).write(tmp_path/"case").prepare()
    process = case.start()
    case.waitForTime(process, 0.02)
    case.change(control={"writePrecision": 3, "stopAt": "nextWrite"})
    late = time.time() + 60
    os.utime(case.path/"system"/"controlDict", (late, late))
    figures.equal("exit status", case.waitForEnd(process), 0)
    text = (case.path/"log.mpmFoam").read_text()
    figures.contains("log", re.search(
        r"Cloud water: written with 6 digits, not with writePrecision 3", text),
        "written with 6 digits")
    points = case.points()
    figures.equal("points with an id of their own",
                  len(np.unique(points.id)), 900)


def longNumbers():
    """A start with OpenFOAM's writePrecision and values of more digits: kg/m3
    of water at 20 degrees, thirds of millimetres and of metres"""
    setup = withSoil(h=0.1/3)
    setup.control.update(writePrecision=6)
    setup.fluid["rho0"] = 998.2071123
    coeffs = setup.properties()["soil"]["DruckerPragerCoeffs"]
    setup.soil = {"DruckerPragerCoeffs": {**coeffs, "d": 0.001/3}}
    return setup


def testLongNumbers(tmp_path, figures):
    """A case is its own, however few digits controlDict asks for: at the
    start and in a restart"""
    case = longNumbers().steps(3).write(tmp_path/"case").prepare()
    case.solve()
    case.change(control={"startFrom": "latestTime", "endTime": 1e-2})
    log = case.solve()
    figures.holds("goes on as the same case", "another" not in log.text)


def testOtherInTheSeventhDigit(tmp_path, figures):
    """What is another is told apart, and with the digits that tell"""
    case = longNumbers().steps(3).write(tmp_path/"case").prepare()
    case.change(fluid={"rho0": 998.2071124})
    refused(figures, case.solve(check=False),
            r"water/rho0 was 998\.207112(29|3)\d*, is 998\.207112(39|4)")


# --- meshes ---------------------------------------------------------------

def testRenumbered(tmp_path, figures):
    """renumberMesh after setMaterialPoints changes nothing"""
    case = damBreak().steps(5).write(tmp_path/"case").prepare()
    other = case.clone(tmp_path/"other")
    case.solve()
    other.run("renumberMesh", "-overwrite")
    other.solve()
    a, b = case.points(), other.points()
    figures.equal("ids differ", int(np.sum(a.id != b.id)), 0)
    figures.atMost("difference of x", float(np.abs(a.x - b.x).max()), 1e-12)


def testOnTheWrongRank(tmp_path, figures):
    """Points in the files of another rank go to that of their cell"""
    case = damBreak().steps(5).write(tmp_path/"case").prepare()
    other = case.clone(tmp_path/"other")
    for c in [case, other]:
        c.decompose(2, cellRank=c.case.cellCentres("0")[:, 0] > 0.1)
    clouds = [other.path/f"processor{r}"/"0"/"lagrangian" for r in [0, 1]]
    clouds[0].rename(tmp_path/"first")
    clouds[1].rename(clouds[0])
    (tmp_path/"first").rename(clouds[1])
    case.solve(ranks=2)
    text = other.solve(ranks=2).text
    figures.contains("log", re.search(
        "900 points went to the rank that has their cell", text), "900 points")
    a, b = case.points(), other.points()
    figures.equal("ids differ", int(np.sum(a.id != b.id)), 0)
    figures.atMost("difference of x", float(np.abs(a.x - b.x).max()), 1e-12)


def testRedistributed(tmp_path, figures):
    """Whether redistributePar -reconstruct carries clouds changes from run to
    run (OpenFOAM v1912: ranks overwrite what others wrote). Either the points
    are those of reconstructPar, or the time is set aside, or refused by name;
    never is less than all of them used."""
    case = damBreak().steps(5).write(tmp_path/"case").prepare()
    case.decompose(2)
    case.solve(ranks=2)
    other = case.clone(tmp_path/"other")
    case.run("redistributePar", "-reconstruct", "-latestTime", ranks=2)
    other.run("reconstructPar", "-latestTime")
    result = case.solve(check=False)
    if result.status:
        figures.holds("refused: use reconstructPar", re.search(
            r"redistributePar.*reconstructPar", result.text, re.DOTALL))
        return
    figures.show("carried the clouds", "incomplete" not in result.text)
    last = other.times[-1]
    a, b = case.points(last), other.points(last)
    figures.equal("points", len(a.id), len(b.id))
    for name in ["id", "x", "U", "J", "mass"]:
        # To rounding, as it may have been run again on one rank
        figures.atMost(f"{name}: difference", float(np.abs(
            getattr(a, name)[np.argsort(a.id)]
            - getattr(b, name)[np.argsort(b.id)]).max()), 1e-12)


@pytest.mark.parametrize("where", ["setMaterialPoints", "mpmFoam"])
def testFullDisk(tmp_path, figures, where):
    """The error says so"""
    case = damBreak().steps(3).write(tmp_path/"case")
    case.run("blockMesh")
    if where == "mpmFoam":
        case.run("setMaterialPoints")
    process = subprocess.run(
        [where], cwd=case.path, capture_output=True, text=True,
        timeout=60, preexec_fn=limitFileSize(9000),
        env={**os.environ, "PWD": str(case.path)})
    text = re.sub(r"\s+", " ", process.stdout + process.stderr)
    figures.equal("exit status", process.returncode, 1)
    found = re.search(r"cannot write (cloud|time) .*is the disk full, or the "
                      r"case read-only\? \(\d+ MB are free\)", text)
    figures.contains("message", found and found[0], "cannot write ...")


def testTooManyPoints(tmp_path, figures):
    """A forecast, before the memory is taken"""
    setup = Setup(
        cells=(40, 40, 40), h=0.02, points=16, energy=False,
        regions={"all": box((0, 0, 0), (0.8, 0.8, 0.8))})
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False),
            "system/setMaterialPointsDict", r"about 262144000 points",
            r"need [\d.]+ GB of memory", r"free on this machine are [\d.]+ GB",
            "smaller pointsPerDirection")
