"""Mistakes that a run used to pass over in silence: each ends with an error, a
warning or a line in the log that names it. docs/mistakes.md is the table of
them, with the messages as printed (docs/mistakes.py makes it)."""

import re
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak, foamText, header, hydrostatic

ROOT = Path(__file__).resolve().parents[2]
DOCUMENT = ROOT/"docs"/"mistakes.md"


# --- scenes, small --------------------------------------------------------

def water():
    return damBreak(h=0.04, points=2, energy=False).steps(2)


def soil(model="DruckerPrager", **coeffs):
    """A layer of dry soil from wall to wall; coefficients of the model"""
    base = {"DruckerPrager": {"phi": 35},
            "elastoplasticMuI": {
                "phiC": 35, "eRef": 0.807, "lambda": 0.0596, "xi": 0.365,
                "Ad": 0.7, "kp": 0.0044, "np": 2.4, "nd": 2.9, "muS": 0.7,
                "muD": 0.77, "PhiC": 0.7, "dPhi": 0.29},
            "muI": {"muS": 0.38, "muD": 0.64},
            "linearElastic": {}}[model]
    stiffness = {"E": 1e6} if model == "linearElastic" else {"E0": 216}
    return Setup(
        cells=(8, 6), h=0.02, regions={}, energy=False, points=2,
        soilRegions={"bed": box((0, 0), (0.16, 0.06), stress="geostatic")},
        soil={"constitutiveModel": model, model + "Coeffs": {
            "rhoS": 2650, "d": 0.85e-3, "e0": 0.695, "nu": 0.2, **stiffness,
            **base, **coeffs}}).steps(2)


def bed(**coeffs):
    """A wet bed under still water"""
    setup = soil(**coeffs)
    setup.regions = {"all": hydrostatic((0, 0), (0.16, 0.1))}
    return setup


def inflow(**inlet):
    setup = water()
    setup.sides["xmin"] = ("patch", {
        "type": "fixedValue", "value": "uniform (0 0 0)"})
    setup.water["inflowOutflow"] = {"inlets": {
        "left": {"patch": "xmin", "base": 0, "depth": 0.2, **inlet}}}
    return setup


# --- changes --------------------------------------------------------------

def changed(setup, **sections):
    """A setup with entries of its sections changed"""
    for name, entries in sections.items():
        target = getattr(setup, name)
        if isinstance(target, dict) and isinstance(entries, dict):
            target.update(entries)
        else:
            setattr(setup, name, entries)
    return setup


def inRegion(setup, name, **entries):
    regions = {**setup.regions, **setup.soilRegions}
    regions[name].update(entries)
    return setup


def renamed(setup, section, old, new, value=None):
    entries = getattr(setup, section)
    entries[old] = None
    entries[new] = value
    return setup


def replaced(file, old, new):
    def edit(case):
        path = case.path/file
        text = path.read_text()
        assert re.search(old, text, re.S), f"{file} has no {old}"
        path.write_text(re.sub(old, new, text, count=1, flags=re.S))
    return edit


def toOrig(case):
    """As a user who forgot to copy it"""
    (case.path/"0").rename(case.path/"0.orig")
    (case.path/"0").mkdir()


def tilted(degrees):
    a = np.radians(degrees)
    return (9.81*np.sin(a), -9.81*np.cos(a), 0)


class ElementTest(Setup):
    """soilElementTest instead of points on the grid"""
    test = {}

    def files(self):
        files = super().files()
        files["system/soilElementTestDict"] = header(
            "soilElementTestDict") + foamText({"tests": {"shear": self.test}})
        return files


def element(**entries):
    base = soil("elastoplasticMuI")
    setup = ElementTest(
        cells=base.cells, h=base.h, regions={}, soilRegions=base.soilRegions,
        soil=base.soil, energy=False)
    setup.test = {"test": "simpleShear", "p0": 1e3, "e0": 0.65, "strain": 0.1,
                  **entries}
    return setup


# --- the mistakes ---------------------------------------------------------

@dataclass
class Mistake:
    """name     of the test
    what     the user did
    where    file: entry
    kind     error, warning or said (in the log)
    expect   what the message must hold, regular expressions
    setup    the case with the mistake, to be called
    edit     change of the case on disk
    at       application that must tell"""
    name: str
    what: str
    where: str
    kind: str
    expect: list
    setup: object
    edit: object = None
    at: str = "setMaterialPoints"


PROPERTIES = "constant/materialPointProperties"
REGIONS = "system/setMaterialPointsDict"
CONTROL = "system/controlDict"


def unusual(name, what, keyword, value, usual, setup, where=PROPERTIES):
    return Mistake(
        name, what, f"`{where}`: `{keyword}`", "warning",
        [where, rf"keyword {keyword} has the value {re.escape(value)}\.",
         re.escape(usual)], setup)


MISTAKES = [
    # Values that no such material has
    unusual("densityOfWater", "`rho0 1` (g/cm3)", "rho0", "1",
            "600 <= rho0 <= 3200", lambda: changed(water(), fluid={"rho0": 1})),
    unusual("kinematicViscosity", "`mu 1e-6` (the kinematic one)", "mu",
            "1e-06", "0.0001 <= mu <= 100",
            lambda: changed(water(), fluid={"mu": 1e-6})),
    unusual("exponent", "`gamma 70`", "gamma", "70", "1 <= gamma <= 10",
            lambda: changed(water(), fluid={"gamma": 70})),
    unusual("grainsInMillimetres", "`d 0.85` (mm)", "d", "0.85",
            "2e-06 <= d <= 0.063", lambda: soil(d=0.85)),
    unusual("bulkDensity", "`rhoS 1600` (with the pores)", "rhoS", "1600",
            "2000 <= rhoS <= 5300", lambda: soil(rhoS=1600)),
    unusual("porosity", "`e0 0.05`", "e0", "0.05", "0.2 <= e0 <= 1.5",
            lambda: soil(e0=0.05)),
    unusual("radians", "`phiC 0.6` (radians)", "phiC", "0.6",
            "20 <= phiC <= 45", lambda: soil("elastoplasticMuI", phiC=0.6,
                                              muS=0.3)),
    unusual("radiansDruckerPrager", "`phi 0.6` (radians)", "phi", "0.6",
            "15 <= phi <= 50", lambda: inRegion(soil(phi=0.6), "bed",
                                                K0=1)),
    unusual("frictionInDegrees", "`muS 21` (degrees)", "muS", "21",
            "0.2 <= muS <= 1.2", lambda: soil("muI", muS=21, muD=30)),
    Mistake("modulusInMegapascal", "`E 20` (MPa)", f"`{PROPERTIES}`: `E`",
            "error", [PROPERTIES, "keyword E has the value 20: soil so soft",
                      "Allowed: E > "],
            lambda: soil("linearElastic", E=20)),
    unusual("modulusInPascal", "`E0 1e6` (Pa)", "E0", "1000000",
            "20 <= E0 <= 2000", lambda: soil(E0=1e6)),
    unusual("solidFraction", "`voidRatio 0.05` of a region", "voidRatio",
            "0.05", "0.2 <= voidRatio",
            lambda: inRegion(soil(), "bed", voidRatio=0.05), where=REGIONS),
    unusual("wallInDegrees", "`frictionCoefficient 30` (degrees)",
            "frictionCoefficient", "30", "0 <= frictionCoefficient <= 1.2",
            lambda: changed(soil(), soilWall={
                "type": "frictional", "frictionCoefficient": 30}),
            where="0/U.soil"),
    Mistake("farAboveBounds", "`rho0 1e20`", f"`{PROPERTIES}`: `rho0`",
            "error", [PROPERTIES, r"rho0 has the value 1e\+20",
                      r"0 < rho0 < 1e\+15"],
            lambda: changed(water(), fluid={"rho0": 1e20})),

    Mistake("onePointPerCell", "`pointsPerDirection 1` for water",
            f"`{REGIONS}`: `pointsPerDirection`", "warning",
            [REGIONS, "keyword pointsPerDirection is 1", "Usual: 2 to 4"],
            lambda: changed(water(), placement={"pointsPerDirection": 1})),

    # controlDict
    Mistake("adjustTimestep", "`adjustTimestep yes`",
            f"`{CONTROL}`: `adjustTimeStep`", "error",
            [CONTROL, "keyword adjustTimestep", r"mean adjustTimeStep\?"],
            lambda: renamed(water(), "control", "adjustTimeStep",
                            "adjustTimestep", True)),
    Mistake("maxDeltat", "`maxDeltat 0.001`", f"`{CONTROL}`: `maxDeltaT`",
            "error", [CONTROL, "keyword maxDeltat", r"mean maxDeltaT\?"],
            lambda: renamed(water(), "control", "maxDeltaT", "maxDeltat",
                            0.001)),
    Mistake("nearBesideTheRightOne", "`endtime 5` beside `endTime`",
            f"`{CONTROL}`: `endTime`", "warning",
            [CONTROL, "keyword endtime", r"mean endTime\?"],
            lambda: changed(water(), control={"endtime": 5})),
    Mistake("function", "`function { ... }`", f"`{CONTROL}`: `functions`",
            "error", [CONTROL, "keyword function ", r"mean functions\?"],
            lambda: changed(water(), control={"function": {}})),
    Mistake("deltaTLongerThanRun", "`deltaT 1` for a run of 0.1 s",
            f"`{CONTROL}`: `deltaT`", "error",
            [CONTROL, "keyword deltaT is 1 s", "longer than the run",
             "deltaT <= 0.1 s"],
            lambda: changed(water().until(0.1), control={
                "stopAt": "endTime", "writeControl": "runTime",
                "deltaT": 1, "adjustTimeStep": False}), at="mpmFoam"),

    # Soil and water
    Mistake("noPoreWater", "A bed under water, water only above it",
            f"`{REGIONS}`: `regions`", "warning",
            [REGIONS, "region bed", "96 of 96 points of soil hold no water",
             "as light as under water", "96 of them lie under water",
             "a region of the cloud water"],
            lambda: changed(bed(), regions={
                "all": hydrostatic((0, 0.06), (0.16, 0.1))})),
    Mistake("suspensionThatStands", "A suspension with `voidRatio 1.2`",
            f"`{REGIONS}`: `voidRatio`", "warning",
            [REGIONS, "region bed", "solid fraction 0.4545", "do not settle",
             "less than nsC"],
            lambda: inRegion(bed(), "bed", stress="none", voidRatio=1.2)),
    Mistake("geostaticUnderSlope", "`stress geostatic` of a bank",
            f"`{REGIONS}`: `stress`", "said",
            ["geostatic", r"surface of the soil above is between 0\.0",
             "as below level ground", "no shear stress"],
            lambda: changed(soil(), soilRegions={"bed": {
                "type": "polygon", "stress": "geostatic",
                "points": "((0 0) (0.16 0) (0 0.08))"}})),
    Mistake("geostaticTooSteep", "`stress geostatic`, gravity tilted by 40"
            " degrees", f"`{REGIONS}`: `stress`", "said",
            ["geostatic", "slope of 40 degrees", "steeper than the soil stands",
             "as below level ground"],
            lambda: changed(soil(phi=20), g=tilted(40))),
    Mistake("geostaticBlockOnSlope", "`stress geostatic` of a block, gravity"
            " tilted by 10 degrees", f"`{REGIONS}`: `stress`", "said",
            ["geostatic", "inclined by 10 degrees", "ends within the mesh",
             "as below level ground"],
            lambda: changed(soil(), g=tilted(10), soilRegions={
                "bed": box((0.04, 0), (0.1, 0.06), stress="geostatic")})),
    Mistake("buoyantGrains", "`rhoS 900` in water", f"`{PROPERTIES}`: `rhoS`",
            "warning", [PROPERTIES, "rhoS of the soil is 900", "grains float",
                        "rhoS > rho0"],
            lambda: inRegion(bed(rhoS=900), "bed", stress="none")),
    Mistake("buoyantGeostatic", "`stress geostatic` of grains that float",
            f"`{REGIONS}`: `stress`", "error",
            [REGIONS, "region bed", "lighter than the water",
             "rhoS 900, rho0 1000"], lambda: bed(rhoS=900)),
    Mistake("tension", "`sigma` with the sign of compression positive",
            f"`{REGIONS}`: `sigma`", "error",
            [REGIONS, "keyword sigma of region bed", "mean pressure p",
             "value -1000 Pa", "Allowed: p > 0"],
            lambda: inRegion(soil(), "bed", stress="uniform",
                             sigma="(1000 0 0 1000 0 1000)")),
    Mistake("gravityUpwards", "`value (0 9.81 0)`", "`constant/g`: `value`",
            "warning", ["constant/g", r"\(0 9\.81 0\)", r"fall towards \+y",
                        r"\(0 -9\.81 0\)"],
            lambda: changed(water(), g=(0, 9.81, 0))),

    # Clouds and patches
    Mistake("frictionalWater", "`type frictional` for water", "`0/U.water`",
            "error", [r"0/U\.water", "patch walls", "frictional",
                      "not water", r"Allowed: \(slip symmetryPlane"],
            lambda: changed(water(), wall={
                "type": "frictional", "frictionCoefficient": 0.5})),
    Mistake("missingVelocity", "0.orig not copied to 0", "`0/U.soil`", "error",
            [r"0/U\.soil\W+is missing", r"cp -r 0\.orig 0"], soil, edit=toOrig),
    Mistake("leftOverCloud", "`clouds (water)`, with a dictionary of soil",
            f"`{PROPERTIES}`: `clouds`", "error",
            [PROPERTIES, "dictionary soil is not used", r"clouds is \(water\)",
             r"clouds \(water soil\)"], water,
            edit=replaced(PROPERTIES, "clouds", "soil { d 1e-3; }\nclouds")),
    Mistake("leftOverInteraction", "`clouds (soil)`, with an interaction",
            f"`{PROPERTIES}`: `interaction`", "error",
            [PROPERTIES, "dictionary interaction is not used"], soil,
            edit=replaced(PROPERTIES, "clouds", "interaction { }\nclouds")),

    # What must be a dictionary
    Mistake("inletsNotADictionary", "`inlets 1`",
            f"`{PROPERTIES}`: `inlets`", "error",
            [PROPERTIES, "keyword inlets has the value 1", "a dictionary"],
            lambda: changed(water(), water={"inflowOutflow": {"inlets": 1}})),
    Mistake("outletsNotADictionary", "`outlets 1`",
            f"`{PROPERTIES}`: `outlets`", "error",
            [PROPERTIES, "keyword outlets has the value 1", "a dictionary"],
            lambda: changed(water(), water={"inflowOutflow": {"outlets": 1}})),
    Mistake("numericsNotADictionary", "`MPM ();`", "`system/fvSolution`: `MPM`",
            "error", ["system/fvSolution", "keyword MPM", "a dictionary"],
            water, edit=replaced("system/fvSolution", r"MPM.*", "MPM ();\n")),
    Mistake("regionNotADictionary", "`column 1` among the regions",
            f"`{REGIONS}`: `regions`", "error",
            [REGIONS, "keyword column has the value 1", "a dictionary"],
            lambda: changed(water(), regions={"column": 1})),
    Mistake("functionsNotADictionary", "`functions 1`",
            f"`{CONTROL}`: `functions`", "error",
            [CONTROL, "functions", "dictionary"],
            lambda: changed(water(), control={"functions": 1})),

    # States that no water has
    Mistake("pressureBelowStateLimit", "`p -1e6`", f"`{REGIONS}`: `p`",
            "error", [REGIONS, "keyword p of region column is -1000000 Pa",
                      r"Allowed: -\d[\d.e+]* < p < "],
            lambda: inRegion(water(), "column", pressure="uniform", p=-1e6)),
    Mistake("velocity", "`velocity (1e30 0 0)`", f"`{REGIONS}`: `velocity`",
            "error", [REGIONS, "keyword velocity of region column",
                      r"\(1e\+30 0 0\)", "up to 1500 m/s"],
            lambda: inRegion(water(), "column", velocity="(1e30 0 0)")),
    Mistake("inletVelocity", "`velocity (1e30 0 0)` of an inlet",
            f"`{PROPERTIES}`: `velocity`", "error",
            [PROPERTIES, "keyword velocity of inlet left", r"1e\+30 m/s",
             "up to 1500 m/s"], lambda: inflow(velocity="(1e30 0 0)")),
    Mistake("negativeInTable", "A negative discharge within a table",
            f"`{PROPERTIES}`: `discharge`", "error",
            [PROPERTIES, "keyword discharge of inlet left is -0.02",
             "at time 3", "discharge >= 0"],
            lambda: inflow(
                discharge="table ((0 0.01) (3 -0.02) (5 0.01))")),
    Mistake("levelFarAbove", "`level 1000` over a mesh of 0.4 m",
            f"`{REGIONS}`: `level`", "error",
            [REGIONS, "keyword level of region column is 1000",
             r"Allowed: level <= 40\.4"],
            lambda: inRegion(water(), "column", level=1000)),
    Mistake("levelAbove", "`level 2` over a mesh of 0.4 m",
            f"`{REGIONS}`: `level`", "warning",
            [REGIONS, "keyword level of region column is 2",
             r"ends at 0\.4", r"1\.6 m of water"],
            lambda: inRegion(water(), "column", level=2)),

    # Element tests
    Mistake("hugeStrain", "`strain 1e12; strainIncrement 1e-4`",
            "`system/soilElementTestDict`: `strain`", "error",
            ["soilElementTestDict", r"strain has the value 1e\+12",
             r"1e\+16 steps", "2147483647"],
            lambda: element(strain=1e12, strainIncrement=1e-4),
            at="soilElementTest"),
    Mistake("notFinite", "`strain 1e12` in one step",
            "`system/soilElementTestDict`: `strainIncrement`", "error",
            ["soilElementTestDict", "test shear", "not finite at strain",
             "strainIncrement"],
            lambda: element(
                strain=1e12, strainIncrement=1e12, strainRate=1,
                volume="constant", integrator="adaptiveSubstepping"),
            at="soilElementTest"),
    Mistake("directionOfBed", "`direction (0 1 0)` of a profile",
            f"`{CONTROL}`: `direction`", "error",
            [CONTROL, "keyword direction", r"one of \(\(1 0 0\)\)"],
            lambda: changed(bed(), functions={"scour": {
                "type": "scourProfile", "cloud": "soil",
                "libs": '("libmpmFunctionObjects.so")',
                "direction": "(0 1 0)"}}), at="mpmFoam"),
    Mistake("noSuchZone", "A region of a cellZone that is not there",
            f"`{REGIONS}`: `zone`", "error",
            [REGIONS, "no cellZone pool", r"zones of the mesh: \(\)"],
            lambda: changed(water(), regions={
                "column": {"type": "cellZone", "zone": "pool"}})),
]


def make(mistake, path):
    """Result of the application that must tell"""
    case = mistake.setup().write(path)
    if mistake.edit:
        mistake.edit(case)
    if mistake.at != "soilElementTest":
        case.run("blockMesh")
    if mistake.at == "mpmFoam":
        case.run("setMaterialPoints")
    return case.run(mistake.at, check=False)


def messages(mistake, result):
    """Of the kind of a mistake, without OpenFOAM's frame"""
    text = result.text
    if mistake.kind == "error":
        at = text.find("--> FOAM FATAL")
        blocks = [text[at:]] if at >= 0 else []
    elif mistake.kind == "warning":
        blocks = [block.split("\n\n")[0] for block in re.split(
            r"(?=--> FOAM Warning)", text)[1:]]
    else:
        blocks = [m[0] for m in re.finditer(
            r"^.*-->(?! FOAM).*\n(?:  +.*\n)*", text, re.M)]
    return [block.split("\n\nEnd")[0] for block in blocks]


def refused(figures, mistake, result):
    figures.equal("exit status", result.status,
                  1 if mistake.kind == "error" else 0)
    found = messages(mistake, result)
    flat = [re.sub(r"\s+", " ", m) for m in found]
    best = max(flat, default="", key=lambda m: sum(
        bool(re.search(p, m)) for p in mistake.expect))
    print(best[:1500])
    for pattern in mistake.expect:
        hit = re.search(pattern, best)
        figures.contains("message", hit and hit[0][:60], pattern)


@pytest.mark.parametrize("mistake", MISTAKES, ids=lambda m: m.name)
def testTold(tmp_path, figures, mistake):
    refused(figures, mistake, make(mistake, tmp_path/"case"))


def testTwoSolvers(tmp_path, figures):
    """The second one ends, the first goes on; after it the case is free"""
    setup = water().endless(10)
    case = setup.write(tmp_path/"case").prepare()
    process = case.start()
    case.waitForTime(process, 1e-4)
    for application in ["mpmFoam", "setMaterialPoints"]:
        second = subprocess.run(
            [application], cwd=case.path, capture_output=True, text=True)
        text = re.sub(r"\s+", " ", second.stderr + second.stdout)
        figures.equal("exit status", second.returncode, 1)
        figures.contains("message", re.search(
            r"already at work in the case \S*case", text), "at work")
    figures.equal("the first one runs", process.poll(), None)
    process.kill()
    process.wait()
    case.change(control={"endTime": 1e-3})
    case.run("mpmFoam")


def testFirstStepIsCut(tmp_path, figures):
    """deltaT longer than twice the run, with adjustTimeStep"""
    setup = water().until(0.01)
    setup.control.update(deltaT=1, stopAt="endTime",
                         writeControl="adjustableRunTime")
    case = setup.write(tmp_path/"case").prepare()
    case.solve()
    figures.equal("times", case.times, ["0", "0.01"])
    before = len(re.findall("^Time = ", (case.path/"log.mpmFoam").read_text(),
                            re.M))
    figures.atLeast("lines of the log", before, 1)
    # A run that has ended takes no further step
    case.solve()
    figures.equal("steps after the end", len(re.findall(
        "^Time = ", (case.path/"log.mpmFoam").read_text(), re.M)), 0)


def testOthersEntries(tmp_path, figures):
    """What is no near miss is nobody's business"""
    setup = water()
    setup.control.update(
        maxAlphaCo=1, myInterval=0.1, dt=3, cloudFunctions={"a": 1},
        minDeltaT=1e-9, libz='("x")', h=0.1)
    setup.control.pop("libz")
    setup.functions["residuals"] = {
        "type": "runTimeControl", "libs": '("libutilityFunctionObjects.so")',
        "enabled": False, "adjustTimestep": 1}
    result = setup.write(tmp_path/"case").prepare().solve()
    figures.holds("no word about them", "Did you mean" not in result.text)


def testUsualValues(tmp_path, figures):
    """Ordinary scenes are passed without a warning"""
    for i, setup in enumerate([
            water(), bed(), soil("elastoplasticMuI"),
            soil("muI", muS=0.38, muD=0.64)]):
        case = setup.write(tmp_path/f"case{i}")
        case.run("blockMesh")
        text = case.run("setMaterialPoints").text
        figures.equal("warnings", text.count("FOAM Warning"), 0)
        figures.equal("lines of doubt", text.count("-->"), 0)


@pytest.mark.parametrize("degrees", [10, 20, 30])
def testSlopeInEquilibrium(tmp_path, figures, degrees):
    """geostatic on inclined gravity: the shear stress is rho g h sin, and the
    normal stress rho g h cos"""
    a = np.radians(degrees)
    setup = changed(soil("elastoplasticMuI"), g=tilted(degrees))
    setup.cyclic("x")
    setup.control.update(writeFormat="ascii")
    case = setup.write(tmp_path/"case").prepare()
    text = (case.path/"log.setMaterialPoints").read_text()
    figures.holds("said", f"endless slope of {degrees} degrees" in text)
    stress = case.case.cloudField("0", "soil", "sigma")
    depth = 0.06 - case.case.cloudField("0", "soil", "x")[:, 1]
    weight = 2650/1.695*9.81*depth
    figures.atMost("shear stress, relative error", np.abs(
        stress[:, 1]/(weight*np.sin(a)) - 1).max(), 1e-6)
    figures.atMost("normal stress, relative error", np.abs(
        stress[:, 3]/(weight*np.cos(a)) + 1).max(), 1e-6)
    # Mobilised friction in the plane: that of K0 or that of the slope
    K0 = 1 - np.sin(np.radians(35))
    radius = np.hypot((stress[:, 0] - stress[:, 3])/2, stress[:, 1])
    figures.atMost("mobilised friction, error", np.abs(
        radius/(-(stress[:, 0] + stress[:, 3])/2)
        - max((1 - K0)/(1 + K0), np.sin(a))).max(), 1e-6)


def testDocument(figures):
    """docs/mistakes.md has each of them (docs/mistakes.py makes it)"""
    rows = re.findall(r"^\| \d+ \| (.*?) \|", DOCUMENT.read_text(), re.M)
    figures.equal("mistakes in the document", rows, [m.what for m in MISTAKES])
    figures.atLeast("mistakes", len(MISTAKES), 30)
