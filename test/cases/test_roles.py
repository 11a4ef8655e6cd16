"""Clouds by name with a role: one liquid, any number of solids that share one
skeleton."""

import copy
from dataclasses import dataclass, field

import numpy as np
import pytest

from caseBuilder import RHO_S, Setup, box, hydrostatic, merge
from test_restart import body
from test_wallJet import CloudPoints

BOUND = 1e-10
FRICTIONAL = {"type": "frictional", "frictionCoefficient": 0.5}


@dataclass
class Several(Setup):
    """The soil of the setup by other names: name -> regions, and name ->
    entries that differ"""
    solids: dict = field(default_factory=dict)
    entries: dict = field(default_factory=dict)
    liquid: str = "water"

    @property
    def clouds(self):
        return [self.liquid]*bool(self.regions) + list(self.solids)

    def properties(self):
        one = Setup(self.cells, self.h, self.regions, soil=self.soil,
                    soilRegions={"any": {}}, water=self.water,
                    fluid=self.fluid, interaction=self.interaction)
        all = one.properties()
        result = {"clouds": self.clouds}
        if self.regions:
            result.update({self.liquid: all["water"],
                           "interaction": all["interaction"]})
        for name in self.solids:
            result[name] = copy.deepcopy(all["soil"])
            merge(result[name], self.entries.get(name, {}))
        return result

    def setMaterialPointsDict(self):
        common = {"pointsPerDirection": self.points, "placement": "regular"}
        merge(common, self.placement)
        regions = {self.liquid: self.regions, **self.solids}
        return {c: {**common, "regions": regions[c]} for c in self.clouds}


GRAINS = {"rhoS": RHO_S, "d": 0.85e-3, "e0": 0.695, "E0": 216, "n": 0.5,
          "nu": 0.2, "phi": 35, "psi": 0}


def split(setup, solids, **entries):
    """The same scene with other clouds of solids"""
    values = {k: copy.deepcopy(v) for k, v in vars(setup).items()}
    values.update(soilRegions={}, solids=solids, entries=entries)
    return Several(**values)


def column(**entries):
    """A block of soil that collapses on a wall with friction"""
    return Setup(
        cells=(16, 10), h=0.02, points=2, energy=False, regions={},
        soilRegions={"block": box((0, 0), (0.16, 0.12), stress="geostatic")},
        soilWall=FRICTIONAL,
        control={"libs": '("libmpmBackgroundGrid.so")'}, **entries).steps(100)


def bank(**entries):
    """A block of soil in water that falls over it"""
    return Setup(
        cells=(16, 10), h=0.02, points=2, energy=False,
        regions={"wave": hydrostatic((0, 0), (0.16, 0.16)),
                 "rest": hydrostatic((0.16, 0), (0.32, 0.1))},
        soilRegions={"block": box((0.08, 0), (0.24, 0.08),
                                  stress="geostatic")},
        soilWall=FRICTIONAL,
        control={"libs": '("libmpmBackgroundGrid.so")'}, **entries).steps(100)


def beside(lower, middle, upper):
    """A block as two, side by side"""
    return {"left": {"block": box(lower, (middle, upper[1]),
                                  stress="geostatic")},
            "right": {"block": box((middle, lower[1]), upper,
                                   stress="geostatic")}}


def above(lower, middle, upper):
    """A block as two, one above the other"""
    return {"lower": {"block": box(lower, (upper[0], middle),
                                   stress="geostatic")},
            "upper": {"block": box((lower[0], middle), upper,
                                   stress="geostatic")}}


DRY, WET = ((0, 0), (0.16, 0.12)), ((0.08, 0), (0.24, 0.08))
SCENES = {
    "dry, side by side": (column, beside(DRY[0], 0.08, DRY[1])),
    "dry, one above the other": (column, above(DRY[0], 0.06, DRY[1])),
    "wet, side by side": (bank, beside(WET[0], 0.16, WET[1])),
    "wet, one above the other": (bank, above(WET[0], 0.04, WET[1])),
}


def joined(case, solids, name, time):
    """A field of several clouds, in the order of the ids"""
    clouds = [CloudPoints(case, c, time) for c in solids]
    ids = np.concatenate([c.id for c in clouds])
    values = np.concatenate([c[name] for c in clouds])
    return values[np.argsort(ids, kind="stable")]


def same(figures, case, one, solids, fields, bound=BOUND):
    """Do the clouds of a case have what the cloud soil of another one has"""
    names = [c.timesByStep() for c in (case, one)]
    last = max(names[1])
    figures.equal("last step", max(names[0]), last)
    for name in ["id", *fields]:
        a = joined(case, solids, name, names[0][last])
        b = joined(one, ["soil"], name, names[1][last])
        figures.atMost(f"{name}: relative difference", float(
            np.abs(a - b).max()/np.abs(b).max()), bound)


def waterToo(figures, case, one, bound=BOUND):
    names = [c.timesByStep() for c in (case, one)]
    last = max(names[1])
    for name in ["id", "x", "U", "J"]:
        a, b = (CloudPoints(c, "water", n[last])[name]
                for c, n in zip((case, one), names))
        figures.atMost(f"water {name}: relative difference", float(
            np.abs(a - b).max()/np.abs(b).max()), bound)


SOIL_FIELDS = ["x", "U", "mass", "sigma", "voidRatio"]


@pytest.mark.parametrize("transfer", ["APIC", "XPIC"])
@pytest.mark.parametrize("name", SCENES)
def testTwoCloudsAreOne(tmp_path, figures, name, transfer):
    setup, solids = SCENES[name]
    soil = {"transfer": transfer}
    one = setup(soil=soil).write(tmp_path/"one").prepare()
    two = split(setup(soil=soil), solids).write(tmp_path/"two").prepare()
    for case in one, two:
        case.solve()
    same(figures, two, one, solids, SOIL_FIELDS)
    if one.setup.regions:
        waterToo(figures, two, one)


def testTwoCloudsAreOne3D(tmp_path, figures):
    """With cubic shape functions, water that runs in, and walls with
    friction"""
    lower, upper = (0.06, 0, 0), (0.18, 0.12, 0.06)
    one = Setup(
        cells=(12, 6, 6), h=0.02, points=2, energy=False,
        mpm={"shapeFunction": "cubicBSpline"},
        regions={"wave": hydrostatic((0, 0, 0), (0.1, 0.12, 0.1))},
        soilRegions={"block": box(lower, upper, stress="geostatic")},
        soilWall=FRICTIONAL,
        control={"libs": '("libmpmBackgroundGrid.so")'}).steps(30)
    solids = {"left": {"block": box(lower, (0.12, 0.12, 0.06),
                                    stress="geostatic")},
              "right": {"block": box((0.12, 0, 0), upper,
                                     stress="geostatic")}}
    two = split(one, solids).write(tmp_path/"two").prepare()
    one = one.write(tmp_path/"one").prepare()
    for case in one, two:
        case.solve()
    same(figures, two, one, solids, SOIL_FIELDS)
    waterToo(figures, two, one)


@pytest.mark.parametrize("scene", [column, bank])
def testGrainsThatDiffer(tmp_path, figures, scene):
    """By so little that it is as if they did not: solid volume, diameter and
    the mean compression of each soil are then found another way. The blocks
    lie apart, as each kind is smoothed by itself."""
    lower, upper = DRY if scene is column else WET
    blocks = {
        "left": box(lower, (lower[0] + 0.04, upper[1]), stress="geostatic"),
        "right": box((upper[0] - 0.04, 0), upper, stress="geostatic")}
    setup = scene()
    setup.soilRegions = blocks
    setup.steps(20)
    one = setup.write(tmp_path/"one").prepare()
    two = split(setup, {k: {"block": v} for k, v in blocks.items()}, right={
        "DruckerPragerCoeffs": {"rhoS": RHO_S*(1 + 1e-14),
                                "d": 0.85e-3*(1 + 1e-14)}})
    two = two.write(tmp_path/"two").prepare()
    for case in one, two:
        case.solve()
    same(figures, two, one, ["left", "right"], SOIL_FIELDS)
    if scene is bank:
        waterToo(figures, two, one)


def testLayersCarryEachOther(tmp_path, figures):
    """Light soil over heavy soil at rest: it stays so, and the stress in each
    is the weight of both above it"""
    light = {**GRAINS, "rhoS": 1800, "e0": 1.0}
    setup = Setup(
        cells=(4, 12), h=0.02, points=2, energy=False, regions={},
        soilRegions={"any": {}}, soilWall="slip").until(0.05)
    setup = split(
        setup, above((0, 0), 0.1, (0.08, 0.2)),
        upper={"DruckerPragerCoeffs": light})
    case = setup.write(tmp_path/"case").prepare()
    case.solve()
    for time in ["0", case.times[-1]]:
        for cloud in ["lower", "upper"]:
            p = CloudPoints(case, cloud, time)
            y = p.x[:, 1]
            weight = 1800/2.0*9.81*(0.2 - np.maximum(y, 0.1)) \
                + RHO_S/1.695*9.81*np.maximum(0.1 - y, 0)
            vertical = -p["sigma"][:, 3]
            figures.atMost(
                f"{cloud} at {time}: stress - weight, over the largest",
                np.abs(vertical - weight).max()/(1800/2.0*9.81*0.2),
                1e-2 if time == "0" else 0.1)
            figures.atMost(f"{cloud} at {time}: largest speed, m/s",
                           np.abs(p.U).max(), 5e-3)


def embankment(points=2):
    """A core of clay-like soil in a shell of sand that water overtops"""
    core = {"type": "polygon", "stress": "geostatic",
            "points": "((0.28 0) (0.36 0) (0.34 0.1) (0.3 0.1))"}
    left = {"type": "polygon", "stress": "geostatic",
            "points": "((0.12 0) (0.28 0) (0.3 0.1) (0.28 0.1))"}
    right = {"type": "polygon", "stress": "geostatic",
             "points": "((0.36 0) (0.52 0) (0.36 0.1) (0.34 0.1))"}
    fine = {**GRAINS, "d": 0.1e-3, "rhoS": 2700, "phi": 28, "E0": 150}
    setup = Setup(
        cells=(32, 9), h=0.02, points=points, energy=False,
        regions={"lake": hydrostatic((0, 0), (0.28, 0.14)),
                 "pores": box((0.28, 0), (0.5, 0.02))},
        soilRegions={"any": {}}, soilWall=FRICTIONAL,
        control={"libs": '("libmpmBackgroundGrid.so")'},
        functions={
            "profile": {"type": "scourProfile", "cloud": "shell",
                        "libs": '("libmpmFunctionObjects.so")'},
            "front": {"type": "frontPosition", "cloud": "core",
                      "direction": "(1 0 0)",
                      "libs": '("libmpmFunctionObjects.so")'}})
    return split(
        setup, {"core": {"core": core},
                "shell": {"upstream": left, "downstream": right}},
        core={"role": "solid", "DruckerPragerCoeffs": fine},
        shell={"velocityField": "core"}).steps(60)


@pytest.fixture(scope="module")
def embankmentCase(tmp_path_factory):
    case = embankment().write(
        tmp_path_factory.mktemp("embankment")/"case").prepare()
    start = case.clone(case.path.parent/"start")
    case.solve()
    return start, case


def testEmbankment(embankmentCase, figures):
    """A core and a shell of different soils: each has its output, no mass is
    lost, nothing is out of bounds"""
    _, case = embankmentCase
    time = case.times[-1]
    for cloud in ["water", "core", "shell"]:
        first, last = (CloudPoints(case, cloud, t) for t in ("0", time))
        figures.equal(f"{cloud}: ids", np.array_equal(first.id, last.id), True)
        figures.equal(f"{cloud}: masses",
                      np.array_equal(first.mass, last.mass), True)
        figures.equal(f"{cloud}: finite values", bool(
            np.isfinite(last.x).all() and np.isfinite(last.U).all()), True)
        figures.atMost(f"{cloud}: largest speed, m/s",
                       np.abs(last.U).max(), 2)
        for name in [f"alpha.{cloud}", f"U.{cloud}"]:
            figures.equal(name, (case.path/time/name).exists(), True)
    solid = sum(case.case.lattice(time, f"alpha.{c}")[2]
                for c in ["core", "shell"])
    figures.atMost("largest solid fraction", float(solid.max()), 0.75)
    log = (case.path/"log.mpmFoam").read_text()
    for part in ["cloud core", "cloud shell", "core: points", "shell: points",
                 "of the mass-weighted diameter"]:
        figures.holds(f"log: {part}", part in log)


def differing(a, b, step):
    """Files of all clouds that are not the same bytes in two cases"""
    first, second = (c.path/c.timesByStep()[step]/"lagrangian" for c in (a, b))
    return [str(f.relative_to(first)) for f in sorted(first.glob("*/*"))
            if body(f) != body(second/f.relative_to(first))]


def testRestart(embankmentCase, figures):
    start, whole = embankmentCase
    two = start.clone(start.path.parent/"two")
    two.setup.steps(30)
    two.rewrite()
    two.solve()
    two.solve()
    figures.equal("files that differ", differing(two, whole, 60), [])


def testRebuilt(embankmentCase, figures):
    start, whole = embankmentCase
    again = start.clone(start.path.parent/"again")
    again.change(control={"DebugSwitches": {"mpmRebuildInterval": 7}})
    again.solve()
    figures.equal("files that differ", differing(again, whole, 60), [])


def testTwoRanks(embankmentCase, figures):
    start, whole = embankmentCase
    cut = start.clone(start.path.parent/"cut")
    cut.decompose(2)
    cut.solve(ranks=2)
    cut.run("reconstructPar")
    time, serial = (c.timesByStep()[60] for c in (cut, whole))
    for cloud in ["water", "core", "shell"]:
        a, b = CloudPoints(cut, cloud, time), CloudPoints(whole, cloud, serial)
        figures.equal(f"{cloud}: ids", np.array_equal(a.id, b.id), True)
        for name in ["x", "U"]:
            figures.atMost(f"{cloud} {name}: relative difference", float(
                np.abs(a[name] - b[name]).max()/np.abs(b[name]).max()), BOUND)


def testNamesAreFree(tmp_path, figures):
    """Water and soil by other names are the same bytes"""
    usual = bank().write(tmp_path/"usual").prepare()
    setup = split(bank(), {"sand": bank().soilRegions})
    setup.liquid = "sea"
    other = setup.write(tmp_path/"other").prepare()
    for case in usual, other:
        case.solve()
    for name, cloud in [("water", "sea"), ("soil", "sand")]:
        a = usual.path/usual.timesByStep()[100]/"lagrangian"/name
        b = other.path/other.timesByStep()[100]/"lagrangian"/cloud
        files = sorted(f.name for f in a.iterdir())
        figures.equal(f"{cloud}: files", sorted(f.name for f in b.iterdir()),
                      files)
        figures.equal(f"{cloud}: files that differ",
                      [f for f in files if body(a/f) != body(b/f)], [])


LIQUID = {"constitutiveModel": "weaklyCompressibleNewtonian",
          "weaklyCompressibleNewtonianCoeffs": {"rho0": 800, "mu": 1e-3}}
RIGID = {"constitutiveModel": "rigidSkeleton",
         "rigidSkeletonCoeffs": {"rhoS": 2650, "d": 1e-3, "e0": 0.7}}
BAD = {
    "two liquids": (
        {"right": {**LIQUID, "DruckerPragerCoeffs": None}},
        ["keyword clouds", "role liquid", "water", "right", "one liquid"]),
    "role of another model": (
        {"right": {"role": "liquid"}},
        ["keyword role is liquid", "DruckerPrager", "solid"]),
    "unknown role": (
        {"right": {"role": "gas"}}, ["role", "gas", "liquid", "solid"]),
    "unknown velocity field": (
        {"right": {"velocityField": "middle"}},
        ["keyword velocityField is middle", "left", "right"]),
    "velocity field of a liquid": (
        {"right": {"velocityField": "water"}},
        ["keyword velocityField is water", "no solid", "left"]),
    "two velocity fields": (
        {"right": {"velocityField": "right"}},
        ["keyword velocityField is right", "left", "through each other"]),
    "held and not": (
        {"right": {**RIGID, "DruckerPragerCoeffs": None}},
        ["keyword constitutiveModel is rigidSkeleton", "held", "left"]),
    "filtered and not": (
        {"right": {"transfer": "XPIC"}},
        ["keyword transfer is XPIC", "left", "Allowed"]),
    "other corners": (
        {"right": {"corners": "slip"}},
        ["keyword corners is slip", "left", "corners stick"]),
    "bed load": (
        {"right": {"bedLoad": "MeyerPeterMueller"}},
        ["keyword bedLoad", "more than one solid"]),
}


@pytest.mark.parametrize("name", BAD)
def testBadInput(tmp_path, figures, name):
    entries, parts = BAD[name]
    case = split(bank(), beside(WET[0], 0.16, WET[1]), **entries).write(
        tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case, ["materialPointProperties", *parts])


def refused(figures, case, parts):
    result = case.run("setMaterialPoints", check=False)
    figures.holds("refused", result.status != 0
                  and "FOAM FATAL IO ERROR" in result.text)
    for part in parts:
        figures.holds(f"message: {part}", part in result.text,
                      result.text[-800:] if part not in result.text else part)


def testNameTwice(tmp_path, figures):
    case = split(bank(), beside(WET[0], 0.16, WET[1])).write(tmp_path/"case")
    path = case.path/"constant"/"materialPointProperties"
    path.write_text(path.read_text().replace(
        "(water left right)", "(water left left right)"))
    case.run("blockMesh")
    refused(figures, case, ["keyword clouds", "left", "twice"])


def testReservedName(tmp_path, figures):
    case = split(bank(), {"p": bank().soilRegions}).write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case, ["keyword clouds", "names p", "Allowed"])


def testOtherWalls(tmp_path, figures):
    """Clouds of one velocity field have the same walls"""
    case = split(bank(), beside(WET[0], 0.16, WET[1])).write(tmp_path/"case")
    path = case.path/"0"/"U.right"
    path.write_text(path.read_text().replace("0.5", "0.4"))
    case.run("blockMesh")
    refused(figures, case, ["U.right", "patch walls", "differs", "U.left"])


def testOverlap(tmp_path, figures):
    solids = beside(WET[0], 0.16, WET[1])
    solids["right"]["block"]["min"] = (0.14, 0, -10)
    case = split(bank(), solids).write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case, ["region block of the cloud right overlaps",
                            "cloud left"])


# --- pairs of phases ------------------------------------------------------

def testPairs(tmp_path, figures):
    """A pair by name is what the dictionary interaction alone is"""
    usual = bank(interaction={"drag": "Gidaspow"}).steps(20).write(
        tmp_path/"usual").prepare()
    other = bank(interaction={"pairs": {"bed": {
        "type": "liquidSkeleton", "clouds": ["soil", "water"],
        "drag": "Gidaspow"}}}).steps(20).write(tmp_path/"other").prepare()
    for case in usual, other:
        case.solve()
    figures.equal("files that differ", differing(usual, other, 20), [])
    figures.holds("drag", "Gidaspow" in (
        other.path/"log.mpmFoam").read_text())


PAIR = {"type": "liquidSkeleton"}
BAD_PAIRS = {
    "unknown": ({"bed": {"type": "liquidGas"}},
                ["pairs.bed", "keyword type", "liquidGas", "liquidSkeleton"]),
    "no type": ({"bed": {}}, ["pairs.bed", "type"]),
    "clouds": ({"bed": {**PAIR, "clouds": ["water", "sand"]}},
               ["pairs.bed", "keyword clouds", "sand", "soil"]),
    "one cloud": ({"bed": {**PAIR, "clouds": ["water"]}},
                  ["pairs.bed", "keyword clouds", "soil"]),
    "twice": ({"bed": PAIR, "again": PAIR},
              ["keyword pairs has 2 pairs", "liquidSkeleton", "one"]),
    "none": ({}, ["keyword pairs has 0 pairs", "liquidSkeleton", "one"]),
    "misspelt": ({"bed": {**PAIR, "darg": "none"}},
                 ["pairs.bed", "keyword darg", "Did you mean drag"]),
}


@pytest.mark.parametrize("name", BAD_PAIRS)
def testBadPairs(tmp_path, figures, name):
    pairs, parts = BAD_PAIRS[name]
    case = bank(interaction={"pairs": pairs}).write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case, ["materialPointProperties", *parts])


def testSeepageThroughLayers(tmp_path, figures):
    """Two layers of grains of another size, one behind the other: all water
    flows through both, driven by rho g n in each volume, and loses a = A mu
    ns^2/(nw d^2) times its speed in each. Where they meet, over a cell or
    two, the mean diameter is not that of either: of first order in h."""
    A, mu, g, n = 150, 1e-3, 1.0, 0.7/1.7
    d = {"left": 0.4e-3, "right": 0.8e-3}
    rigid = {"constitutiveModel": "rigidSkeleton", "rigidSkeletonCoeffs": {
        "rhoS": 2650, "d": 1e-3, "e0": 0.7}}
    setup = Setup(
        cells=(64, 4), h=0.005, points=2, energy=False, g=(g, 0, 0),
        fluid={"soundSpeed": 5, "mu": mu},
        regions={"all": box((0, 0), (0.32, 0.02))}, soilRegions={"any": {}},
        soil={**rigid, "DruckerPragerCoeffs": None},
        interaction={"drag": "DarcyForchheimer", "DarcyForchheimerCoeffs": {
            "viscous": A, "inertial": 0}}).cyclic("x", "y").until(1)
    solids = beside((0, 0), 0.16, (0.32, 0.02))
    for regions in solids.values():
        regions["block"].update(stress="none", saturated=False)
    case = split(setup, solids, **{
        k: {"rigidSkeletonCoeffs": {"d": v}} for k, v in d.items()})
    case = case.write(tmp_path/"case").prepare()
    case.solve()
    a = [A*mu*(1 - n)**2/(n*v**2) for v in d.values()]
    speed = 1000*g*n/np.mean(a)
    water = CloudPoints(case, "water", case.times[-1])
    figures.atMost("mean speed over that of Darcy: error",
                   abs(np.average(water.U[:, 0], weights=water.mass)/speed
                       - 1), 0.02)
