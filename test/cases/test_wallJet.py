"""Water and soil in one scene: the wall jet of tutorials/wallJet, short; beds
at rest; what a user gets wrong about soil."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mpmfoam.metrics import readMetrics
from mpmfoam.postProcessing import readDat

from caseBuilder import RunningCase, Setup, box, foamText, hydrostatic
from test_badInput import PROPERTIES, REGIONS, CONTROL, refused, words
from test_paraview import needsParaView

TUTORIAL = Path(__file__).resolve().parents[2]/"tutorials"/"wallJet"
H = 0.01
CLOUDS = ["water", "soil"]


class WallJet(RunningCase):
    """The tutorial, with other entries of controlDict"""

    def __init__(self, path, write=True, **control):
        # The tutorial's mesh, to know what lies outside
        super().__init__(path, Setup(
            cells=(222, 25), h=H, regions={}, solid=[
                ((0, 0), (70, 5)), ((70, 10), (74, 25)),
                ((172, 0), (222, 5))]))
        if not write:
            return
        shutil.copytree(TUTORIAL/"0.orig", self.path/"0")
        for part in ["constant", "system"]:
            shutil.copytree(TUTORIAL/part, self.path/part,
                            ignore=shutil.ignore_patterns("polyMesh"))
        self.control(**control)

    def control(self, **entries):
        path = self.path/"system"/"controlDict"
        text = path.read_text()
        for name, value in entries.items():
            # The entries at the top; those of functions are indented
            text, n = re.subn(rf"^{name}\s.*;$", f"{name} {foamText(value)};",
                              text, flags=re.MULTILINE)
            assert n == 1, name
        path.write_text(text)

    def functionInterval(self, seconds):
        path = self.path/"system"/"controlDict"
        path.write_text(re.sub(r"^(    +writeInterval\s+)\S+;",
                               rf"\g<1>{seconds};", path.read_text(),
                               flags=re.MULTILINE))

    def clone(self, path):
        shutil.copytree(self.path, path)
        return WallJet(path, write=False)

    def profile(self, time):
        path = self.path/"postProcessing"/"scour"/time/"profile.csv"
        return np.genfromtxt(path, delimiter=",", names=True)


class CloudPoints:
    """All that is asked of a cloud, in the order of its id"""

    def __init__(self, case, cloud, time):
        order = np.argsort(case.case.cloudField(time, cloud, "id"),
                           kind="stable")
        self._get = lambda name: case.case.cloudField(time, cloud, name)[order]
        for name in ["id", "x", "U", "mass"]:
            setattr(self, name, self._get(name))

    def __getitem__(self, name):
        return self._get(name)


def clouds(case, time):
    return {cloud: CloudPoints(case, cloud, time) for cloud in CLOUDS}


def sound(figures, case, names=CLOUDS):
    """Finite, inside of the mesh and outside of its walls, and masses exact,
    at all times"""
    first = {cloud: CloudPoints(case, cloud, "0") for cloud in names}
    for cloud in names:
        finite = outside = wrongMass = 0
        balance = 0.0
        masses = dict(zip(first[cloud].id, first[cloud].mass))
        total = first[cloud].mass.sum()
        for time in case.times:
            points = CloudPoints(case, cloud, time)
            state = case.case.cloudState(time, cloud)
            for values in [points.x, points.U]:
                finite += int(np.sum(~np.isfinite(values)))
            outside += case.outside(points)
            wrongMass += sum(masses[i] != m
                             for i, m in zip(points.id, points.mass))
            balance = max(balance, abs(
                points.mass.sum() + state["leftMass"] - total)/total)
            assert len(points.id) + state["left"] == len(masses)
        figures.equal(f"{cloud}: values that are not finite", finite, 0)
        figures.equal(f"{cloud}: points outside of the mesh or in walls",
                      outside, 0)
        figures.equal(f"{cloud}: points with another mass", wrongMass, 0)
        figures.atMost(f"{cloud}: inside + left - start, over start", balance,
                       1e-13)


# --- the wall jet ---------------------------------------------------------

@pytest.fixture(scope="module")
def start(tmp_path_factory):
    """The case before its first step"""
    return WallJet(tmp_path_factory.mktemp("wallJet")/"case").prepare()


@pytest.fixture(scope="module")
def serial(start, tmp_path_factory):
    case = start.clone(tmp_path_factory.mktemp("serial")/"case")
    case.control(endTime=0.3)
    case.solve()
    return case


@pytest.fixture(scope="module")
def parallel(start, tmp_path_factory):
    """Two ranks; the plane between them cuts hole and dune"""
    case = start.clone(tmp_path_factory.mktemp("parallel")/"case")
    case.control(endTime=0.3)
    case.decompose(2, cellRank=case.case.cellCentres("0")[:, 0] > 0.76)
    case.solve(ranks=2)
    return case


@pytest.mark.parametrize("ranks", [1, 2])
def testSound(request, figures, ranks):
    case = request.getfixturevalue("serial" if ranks == 1 else "parallel")
    sound(figures, case)
    figures.equal("end", case.log.time, 0.3)
    speed = np.abs(clouds(case, case.times[-1])["water"].U).max()
    figures.atMost("largest velocity of water over Torricelli's",
                   float(speed/np.sqrt(2*9.81*0.15)), 1.5)


def testItDigs(serial, figures):
    """A hole behind the apron, a dune behind it, and the bed far from the jet
    where it was; volumes, profile and points agree"""
    rows = readDat(serial.path, "scour", "scourProfile.dat")
    time, depth, place, dune, dunePlace, eroded, deposited, _, level = (
        rows.T[:9])
    stress, layer, cells = rows.T[9:]
    figures.equal("rows", len(rows), 16)
    figures.equal("scour at the start", depth[0], 0)
    figures.holds("no stress before the first step", np.isnan(stress[0]))
    figures.atLeast("mean stress on the bed at 0.3 s, Pa", stress[-1], 0.1)
    figures.atMost("movable layer over its cells: error",
                   abs(layer[-1]/(cells[-1]*H) - 1), 1e-9)
    figures.atLeast("depth of the hole at 0.3 s, m", depth[-1], 0.5*H)
    figures.holds("it is at the apron", 0.70 < place[-1] < 0.78, place[-1])
    figures.atLeast("height of the dune at 0.3 s, m", dune[-1], 0.5*H)
    figures.holds("it is downstream", place[-1] < dunePlace[-1] < 1.0,
                  dunePlace[-1])
    figures.atMost("eroded over deposited volume, distance to 1",
                   abs(eroded[-1]/deposited[-1] - 1), 0.15)
    figures.atLeast("fall of the reservoir, m", level[0] - level[-1], 0.002)
    figures.atMost("level of the reservoir at the start, error in m",
                   abs(level[0] - 0.2), 1e-3)

    profile = serial.profile("0.3")
    bed, first = profile["bed"], serial.profile("0")["bed"]
    figures.equal("columns of the profile", len(profile), 222)
    figures.atMost("depth in the profile, difference in m", abs(
        np.nanmax(first - bed) - depth[-1]), 1e-9)
    far = (profile["x"] > 1.3) & (profile["x"] < 1.7)
    figures.atMost("bed far from the jet: largest change, m", float(
        np.abs(bed[far] - 0.05).max()), 1e-3)
    on = profile["x"] < 0.69
    figures.atMost("bed on the rigid base: difference to it, m", float(
        np.abs(bed[on] - 0.05).max()), 1e-12)
    figures.holds("water is nowhere below the bed", bool(np.all(
        ~(profile["water"] < bed - 1e-3))))

    soil = clouds(serial, "0.3")["soil"]
    mass = 2650*0.05*1.02*H/1.695
    figures.atMost("mass of the soil, relative error", abs(
        soil.mass.sum()/mass - 1), 1e-9)
    far = (soil.x[:, 0] > 1.3) & (soil.x[:, 0] < 1.7)
    figures.atMost("rms speed of the bed far from the jet, m/s", float(
        np.sqrt((soil.U[far]**2).sum(axis=1).mean())), 1e-2)


def testTwoRanksLater(serial, parallel, figures):
    """At 0.3 s chaos has had 5000 steps"""
    a, b = (c.profile("0.3") for c in (serial, parallel))
    figures.atMost("bed: rms difference over h", float(np.sqrt(
        np.mean((a["bed"] - b["bed"])**2))/H), 0.1)
    scour = [readDat(c.path, "scour", "scourProfile.dat")
             for c in (serial, parallel)]
    figures.equal("rows", scour[0].shape, scour[1].shape)
    figures.atMost("depth of the hole: difference over h", abs(
        scour[0][-1, 1] - scour[1][-1, 1])/H, 0.1)
    front = [readDat(c.path, "front", "front.dat")[-1, 2]
             for c in (serial, parallel)]
    figures.atMost("front: difference over h", abs(front[0] - front[1])/H, 0.5)


def testTwoRanksEarly(start, tmp_path, figures):
    """After 100 steps: to rounding"""
    cases = [start.clone(tmp_path/name) for name in ("serial", "parallel")]
    for case in cases:
        case.control(stopAt="nextWrite", writeControl="timeStep",
                     writeInterval=100)
    cases[1].decompose(2)
    for case, ranks in zip(cases, (1, 2)):
        case.solve(ranks=ranks)
    figures.equal("steps", cases[0].log.stepCount, 100)
    points = [clouds(c, c.times[-1]) for c in cases]
    for cloud, names in [("water", ["x", "U", "J", "p", "mass"]),
                         ("soil", ["x", "U", "sigma", "voidRatio", "mass"])]:
        a, b = (p[cloud] for p in points)
        assert np.array_equal(a.id, b.id)
        for name in names:
            u, v = a[name], b[name]
            figures.atMost(f"{cloud} {name}: relative difference", float(
                np.abs(u - v).max()/np.abs(u).max()), 1e-10)
    series = [readDat(c.path, "scour", "scourProfile.dat") for c in cases]
    figures.atMost("scourProfile.dat: largest difference", float(np.nanmax(
        np.abs(series[0] - series[1]))), 1e-10)


def body(path):
    """What follows the header, which names the time directory"""
    data = path.read_bytes()
    return data[data.index(b"}", data.index(b"FoamFile")):]


def testTwoRunsAreOne(start, tmp_path, figures):
    split = start.clone(tmp_path/"split")
    split.control(endTime=0.02, writeInterval=0.02)
    split.functionInterval(0.005)
    whole = split.clone(tmp_path/"whole")
    whole.control(endTime=0.04)
    split.solve()
    split.control(endTime=0.04)
    split.solve()
    whole.solve()
    figures.show("steps", whole.log.stepCount)
    for time in ["0.02", "0.04"]:
        for cloud in CLOUDS:
            place = Path(time)/"lagrangian"/cloud
            names = sorted(p.name for p in (whole.path/place).iterdir())
            assert "voidRatio" in names or "J" in names
            figures.equal(f"{time} s, {cloud}: files that differ", [
                n for n in names if body(split.path/place/n)
                != body(whole.path/place/n)], [])
    # The bed that scour counts from is that of the first start
    series = [readDat(c.path, "scour", "scourProfile.dat")
              for c in (split, whole)]
    figures.equal("scourProfile.dat: shape", series[0].shape, series[1].shape)
    figures.atMost("scourProfile.dat: largest difference", float(np.nanmax(
        np.abs(series[0] - series[1]))), 1e-10)


def testGoesOnExactly(serial, tmp_path, figures):
    """The same while the hole grows: once more from 0.2 s"""
    case = serial.clone(tmp_path/"case")
    shutil.rmtree(case.path/"0.3")
    case.solve()
    for cloud in CLOUDS:
        place = Path("0.3")/"lagrangian"/cloud
        names = sorted(p.name for p in (serial.path/place).iterdir())
        figures.equal(f"{cloud}: files that differ", [
            n for n in names if body(case.path/place/n)
            != body(serial.path/place/n)], [])
    last = [readDat(c.path, "scour", "scourProfile.dat")[-1]
            for c in (case, serial)]
    figures.atMost("scour at 0.3 s: largest difference", float(
        np.abs(last[0] - last[1]).max()), 1e-10)


def render(case, output, *arguments):
    """What renderPoints prints"""
    root = Path(os.environ["MPMFOAM_DIR"])
    result = subprocess.run(
        [root/"etc"/"pvpythonOffscreen", root/"etc"/"python"/"renderPoints.py",
         "--case", case.path, "--output", output, *arguments],
        capture_output=True, text=True, timeout=120)
    assert result.returncode == 0, result.stdout + result.stderr
    return result.stdout


def testMonitor(serial, figures):
    """foamMonitor names the curves by the last line of comment"""
    paths = sorted((serial.path/"postProcessing").glob("*/*/*.dat"))
    figures.atLeast("time series", len(paths), 4)
    for path in paths:
        lines = path.read_text().splitlines()
        names = [line for line in lines if line.startswith("#")][-1].split()
        figures.equal(f"{path.name}: first words", names[:2], ["#", "Time"])
        figures.equal(f"{path.name}: columns without a name",
                      len(lines[-1].split()) - (len(names) - 1), 0)


@needsParaView
def testSurfaces(serial, tmp_path, figures):
    """What the contours enclose: the bed is there, and all that is filled"""
    text = render(serial, tmp_path, "--show", "surface", "--show", "both",
                  "0.3")
    enclosed = {n: float(v) for n, v in re.findall(
        r"surface of (\w+) (\S+) m3", text)}
    found = clouds(serial, "0.3")
    volumes = {
        "soil": found["soil"].mass.sum()/2650*1.695,
        "water": found["water"].mass.sum()/1000
        + found["soil"].mass.sum()/2650}
    for name, volume in volumes.items():
        figures.atMost(f"{name}: volume off, part of it",
                       abs(enclosed[name]/volume - 1), 0.05)
    for mode in ("surface", "both"):
        figures.holds(f"picture of {mode}",
                      (tmp_path/f"water_soil_{mode}_t0.3.png").exists())

    import matplotlib.image
    image = matplotlib.image.imread(
        tmp_path/"water_soil_surface_t0.3.png")[..., :3]
    sand = np.abs(image - [0.62, 0.45, 0.24]).max(axis=-1) < 0.03
    figures.atLeast("pixels of wet sand", int(sand.sum()), 500)


@needsParaView
def testPicture(serial, tmp_path, figures):
    """Both clouds in one picture: sand where there is sand, solids in grey"""
    text = render(serial, tmp_path, "--window", "0.5", "1.3", "0", "0.25",
                  "0.3")
    for cloud in CLOUDS:
        n = len(clouds(serial, "0.3")[cloud].id)
        figures.holds(f"{n} points of {cloud}",
                      f"{n} points of {cloud}" in text)

    import matplotlib.image
    image = matplotlib.image.imread(tmp_path/"water_soil_t0.3.png")[..., :3]
    pixels = image.shape[1]*0.94/0.8
    middle = image.shape[0]/2

    def at(x, y):
        return image[int(middle - (y - 0.125)*pixels),
                     int(image.shape[1]/2 + (x - 0.9)*pixels)]

    for what, x, y, colour in [
            ("bed", 1.0, 0.0125, [0.80, 0.62, 0.36]),
            ("gate", 0.72, 0.18, [0.62, 0.62, 0.64]),
            ("base", 0.60, 0.02, [0.62, 0.62, 0.64]),
            ("air", 1.1, 0.20, [1, 1, 1])]:
        figures.atMost(f"colour of the {what}: difference", float(
            np.abs(at(x, y) - colour).max()), 0.03)


@needsParaView
def testAnimation(serial, tmp_path, figures):
    from PIL import Image
    still = tmp_path/"water_soil_t0.1.png"
    still.write_text("made before")
    render(serial, tmp_path, "--animation", "0.2", "0.1", "0.3")
    with Image.open(tmp_path/"water_soil.gif") as film:
        figures.equal("pictures in the film", film.n_frames, 2)
        frames = []
        for i in range(film.n_frames):
            film.seek(i)
            frames.append(np.asarray(film.convert("RGB"), dtype=float))
        figures.equal("ms for each", film.info["duration"], 200)
    figures.atLeast("share of pixels that change", float(
        (np.abs(frames[1] - frames[0]).max(axis=-1) > 40).mean()), 0.01)
    figures.equal("files", sorted(p.name for p in tmp_path.iterdir()),
                  ["water_soil.gif", still.name])
    figures.equal("a picture made before", still.read_text(), "made before")


def testErosionFigure(serial, figures):
    """Profiles and map are drawn, and the shares of agreement add up"""
    scripts = Path(os.environ["MPMFOAM_DIR"])/"etc"/"python"
    result = subprocess.run(
        [os.environ["MPMFOAM_PYTHON"], str(scripts/"plotErosion.py"),
         "--case", str(serial.path), "--time", "0.3"],
        capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stdout + result.stderr
    figures.atLeast("bytes of erosion.png",
                    (serial.path/"erosion.png").stat().st_size, 1e4)
    found = dict(line.split() for line in result.stdout.splitlines()
                 if re.match(r" +Shields\w+ ", line))
    shares = [float(v) for k, v in found.items() if "Correlation" not in k]
    figures.equal("shares", len(shares), 4)
    figures.atMost("their sum less 1", abs(sum(shares) - 1), 1e-4)
    figures.atLeast("exceeded where grains move",
                    float(found["ShieldsExceededMoves"]), 0.1)


def testMetrics(serial, figures):
    scripts = Path(os.environ["MPMFOAM_DIR"])/"etc"/"python"
    result = subprocess.run(
        [os.environ["MPMFOAM_PYTHON"], str(scripts/"caseMetrics.py"),
         "--case", str(serial.path), "--front", "0.2"],
        capture_output=True, text=True, timeout=60)
    assert result.returncode == 0, result.stdout + result.stderr
    found = readMetrics(serial.path/"metrics.json")
    rows = readDat(serial.path, "scour", "scourProfile.dat")
    for name, value in [("scourDepthMax", rows[:, 1].max()),
                        ("timeOfScourMax", rows[rows[:, 1].argmax(), 0]),
                        ("duneHeight", rows[-1, 3]),
                        ("suspendedFraction", rows[:, 7].max()),
                        ("reservoirLevelEnd", rows[-1, 8])]:
        figures.atMost(f"{name}: difference", abs(found[name] - value), 1e-8)
    figures.atMost("massError", abs(found["massError"]), 1e-13)
    for cloud in CLOUDS:
        figures.equal(f"pointCount_{cloud}", found[f"pointCount_{cloud}"],
                      len(clouds(serial, "0.3")[cloud].id))
    figures.holds("front between gate and end",
                  0.74 < found["frontPosition_t0.20"] < 1.72,
                  found["frontPosition_t0.20"])


# --- beds at rest ---------------------------------------------------------

SCOUR = {"type": "scourProfile", "libs": '("libmpmFunctionObjects.so")',
         "cloud": "soil", "writeControl": "adjustableRunTime",
         "writeInterval": 0.1}


def bed(level, **entries):
    """A bed of 0.1 m, saturated, under water up to a level"""
    regions = {"pores": hydrostatic((0, 0), (0.2, 0.1))}
    regions["pores"]["level"] = level
    if level > 0.1:
        regions["above"] = hydrostatic((0, 0.1), (0.2, level))
    setup = Setup(
        cells=(20, round(level/H) + 5), h=H, points=2, energy=False,
        regions=regions, functions={"scour": SCOUR},
        soilRegions={"bed": box((0, 0), (0.2, 0.1), stress="geostatic",
                                saturated=True)}, **entries)
    return setup.until(0.5, write=0.5)


@pytest.mark.parametrize("name, level", [("underWater", 0.3),
                                         ("surfaceInAir", 0.1)])
def testRests(tmp_path, figures, name, level):
    case = bed(level).write(tmp_path/"case").prepare()
    case.solve()
    sound(figures, case)
    points = clouds(case, "0.5")
    for cloud in CLOUDS:
        figures.atMost(f"{cloud}: rms speed after 0.5 s, m/s", float(np.sqrt(
            (points[cloud].U**2).sum(axis=1).mean())), 1e-2)
    rows = readDat(case.path, "scour", "scourProfile.dat")
    figures.atMost("surface of the bed: largest fall, m", rows[:, 1].max(),
                   0.02*H)
    figures.atMost("surface of the bed: largest rise, m", rows[:, 3].max(),
                   0.02*H)
    profile = np.genfromtxt(
        case.path/"postProcessing"/"scour"/"0.5"/"profile.csv",
        delimiter=",", names=True)
    figures.atMost("level of the water: largest change, m", float(
        np.abs(profile["water"] - level).max()), 0.05*H)


# --- what a user gets wrong -----------------------------------------------

def changed(**sections):
    def change(setup):
        for name, entries in sections.items():
            getattr(setup, name).update(entries)
    return change


def inRegion(name, **entries):
    return lambda s: s.regions[name].update(entries)


def withoutSoil(case):
    path = case.path/"constant"/"materialPointProperties"
    path.write_text(path.read_text().replace("(water soil)", "(water)"))


BAD = {
    "unknownModel": (
        changed(soil={"constitutiveModel": "clay"}), None, {
            "file": PROPERTIES, "keyword": r"\bconstitutiveModel\b",
            "value": r"\bclay\b",
            "allowed": words("DruckerPrager", "linearElastic")}),
    "misspeltCoefficient": (
        changed(soil={"DruckerPragerCoeffs": {
            "rhoS": 2650, "d": 1e-3, "e0": 0.7, "E0": 216, "n": 0.5,
            "nu": 0.2, "phi": 35, "psy": 0}}), None, {
                "file": PROPERTIES, "keyword": r"\bpsy\b",
                "allowed": r"\bpsi\b"}),
    "noFileOfVelocity": (
        None, lambda case: (case.path/"0"/"U.soil").unlink(), {
            "file": r"0/U\.soil"}),
    "soilKeywordInWater": (
        inRegion("pores", voidRatio=0.7), None, {
            "file": REGIONS, "keyword": r"\bvoidRatio\b",
            "cloud": r"\bwater\b"}),
    "waterKeywordInSoil": (
        lambda s: s.soilRegions["bed"].update(pressure="hydrostatic"), None, {
            "file": REGIONS, "keyword": r"\bpressure\b",
            "cloud": r"\bsoil\b"}),
    "interactionWithoutSoil": (
        None, withoutSoil, {
            "file": PROPERTIES, "keyword": r"\b(interaction|soil)\b",
            "allowed": r"\bwater\b"}),
    "unknownDrag": (
        changed(interaction={"drag": "Stokes"}), None, {
            "file": PROPERTIES, "keyword": r"\bdrag\b",
            "value": r"\bStokes\b",
            "allowed": words("DarcyForchheimer", "Gidaspow")}),
    "stressUnknown": (
        lambda s: s.soilRegions["bed"].update(stress="lithostatic"), None, {
            "file": REGIONS, "keyword": r"\bstress\b",
            "value": r"\blithostatic\b", "allowed": r"\bgeostatic\b"}),
}


@pytest.mark.parametrize("name", BAD)
def testRefused(tmp_path, figures, name):
    setup, edit, expect = BAD[name]
    s = bed(0.1)
    if setup:
        setup(s)
    case = s.write(tmp_path/"case")
    if edit:
        edit(case)
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False), expect)


@pytest.mark.parametrize("entries, expect", [
    ({"cloud": "water"}, {"keyword": r"\bcloud\b", "value": r"\bwater\b",
                          "allowed": "a solid"}),
    ({"direction": (0, 1, 0)}, {"keyword": r"\bdirection\b",
                                "value": r"\(0 1 0\)",
                                "allowed": r"\(1 0 0\)"}),
    ({"reservoir": (3, 4)}, {"keyword": r"\breservoir\b",
                             "value": r"\(3 4\)", "allowed": "between"}),
    ({"water": "watr"}, {"keyword": r"\bwater\b", "value": r"\bwatr\b",
                         "allowed": "a liquid.*water"}),
    ({"bedFraction": 1.5}, {"keyword": r"\bbedFraction\b",
                            "value": r"\b1\.5\b", "allowed": "< 1"}),
    ({"resrvoir": (0, 1)}, {"keyword": r"\bresrvoir\b",
                            "allowed": r"\breservoir\b"}),
], ids=["cloud", "direction", "reservoir", "water", "bedFraction", "misspelt"])
def testScourProfileRefused(tmp_path, figures, entries, expect):
    s = bed(0.1)
    s.functions["scour"] = {**SCOUR, **entries}
    case = s.write(tmp_path/"case").prepare()
    refused(figures, case.solve(check=False), {"file": CONTROL, **expect})
