"""Function object materialPointForces on patches: all that walls and bodies take
is what the points lose; pressure and friction apart; pressure along lines and
surfaces. Forces on bodies alone are in test_bodies."""

import numpy as np
import pytest

from mpmfoam.postProcessing import readColumns, readDat

from bodies import cylinder
from caseBuilder import G, RHO, CaseError, Setup, box, hydrostatic
from test_wallJet import CloudPoints

STEPS = 40


def forcesOf(cloud, **entries):
    return {"type": "materialPointForces", "cloud": cloud,
            "libs": '("libmpmFunctionObjects.so")', "writePrecision": 17,
            "writeControl": "timeStep", "writeInterval": 1, **entries}


def fixedStep(setup, deltaT, steps=STEPS):
    setup.control.update(adjustTimeStep=False, deltaT=deltaT)
    return setup.steps(steps)


def tank(transfer="APIC", soil=None, mu=1e-3):
    """Water that sloshes, over sand if its walls are given: past a step with a convex corner
    and a pipe, at walls of all kinds, one of which is two patches. The viscous
    stress may act in stages, and does if mu is large"""
    setup = Setup(
        cells=(24, 16), h=0.02, points=2, solid=[((16, 0), (24, 4))],
        sides={"xmin": ("wall", "noSlip"), "xmax": ("wall", "slip"),
               "ymin": ("wall", {"type": "roughWall", "ks": 5e-3})},
        water={"transfer": transfer, "viscousStep": "stages"},
        fluid={"mu": mu},
        regions={"water": {**hydrostatic((0, 0), (0.28, 0.24)),
                           "velocity": (0.6, -0.2, 0)}},
        bodies={"pipe": {"type": "fixed", "water": {"type": "noSlip"},
                         "surface": cylinder((0.153, 0.151), 0.04)}},
        # For decomposePar, which knows no patch type frictional
        control={"libs": '("libmpmBackgroundGrid.so")'}, energy=False)
    patches = {"patches": '(".*")', "bodies": "(pipe)", "CofR": (0.1, 0.05, 0)}
    setup.functions["water"] = forcesOf("water", **patches)
    if soil:
        setup.soilRegions = {"bed": box((0, 0), (0.28, 0.08),
                                        stress="geostatic",
                                        velocity=(0.2, 0, 0))}
        del setup.sides["ymin"]
        setup.sides["xmin"] = ("wall", "slip")
        setup.soilWall = soil
        setup.bodies["pipe"]["soil"] = {"frictionCoefficient": 0.3}
        setup.functions["soil"] = forcesOf("soil", **patches)
    return setup


def lost(figures, case, deltaT, bound=1e-10):
    """Change of the momentum of all points against forces and weight"""
    impulse, before, after, weight = np.zeros((4, 3))
    for cloud in case.setup.clouds:
        force = readDat(case.path, cloud, "force.dat")
        figures.equal(f"{cloud}: steps", len(force) - 1, STEPS)
        impulse -= deltaT*force[1:, 1:4].sum(axis=0)
        for time, sum_ in [("0", before), (case.times[-1], after)]:
            p = CloudPoints(case, cloud, time)
            sum_ += (p["mass"][:, None]*p["U"]).sum(axis=0)
        weight[1] -= p["mass"].sum()*G*STEPS*deltaT
    change = after - before
    figures.atLeast("momentum that changed over the weight",
                    float(np.abs(impulse).max()/np.abs(weight).max()), 0.3)
    figures.atMost(
        "change of momentum less impulse of all walls and weight, over both",
        float(np.abs(change - impulse - weight).max()
              / np.abs(impulse).max()), bound)


# With 1e4 Pa s explicit steps would have to be ten times shorter
@pytest.mark.parametrize("transfer, mu", [
    ("APIC", 1e-3), ("FLIP", 1e-3), ("APIC", 1e4)])
def testWallsTakeWhatWaterLoses(tmp_path, figures, transfer, mu):
    deltaT = 1e-4
    case = fixedStep(tank(transfer, mu=mu), deltaT).write(
        tmp_path/"case").prepare()
    serial = case.clone(tmp_path/"serial")
    serial.solve()
    lost(figures, serial, deltaT)

    # All patches and the pipe, one by one and together
    columns = readColumns(serial.path, "water", "forces.dat")
    force = readDat(serial.path, "water", "force.dat")
    for d, axis in enumerate("xyz"):
        each = sum(v for k, v in columns.items() if k.endswith("_F" + axis))
        figures.atMost(f"sum of F{axis} of each",
                       float(np.abs(each - force[:, 1 + d]).max()), 1e-9)
    figures.atMost("total less pressure and viscous", float(np.abs(
        force[:, 1:4] - force[:, 4:7] - force[:, 7:10]).max()), 1e-12)
    figures.atLeast("viscous", float(np.abs(force[:, 7:9]).max()), 1e-4)
    head = next((serial.path/"postProcessing"/"water").glob(
        "*/moment.dat")).read_text().splitlines()
    figures.equal("head", head[0].strip(), "# Moment")
    figures.contains("centre", head[1] if "CofR" in head[1] else None, "CofR")
    figures.contains(
        "columns", "yes" if "(pressure_x pressure_y pressure_z)"
        in head[3] else None, "yes")

    # The step and the two patches at the pipe lie on both ranks
    case.decompose(2, (2, 1, 1)).solve(ranks=2)
    for name in ["force.dat", "moment.dat", "forces.dat"]:
        a, b = (readDat(c.path, "water", name) for c in (serial, case))
        figures.atMost(f"two ranks, {name}", float(
            np.abs(a - b).max()/np.abs(a).max()), 1e-10)


@pytest.mark.parametrize("wall, bound", [
    ("slip", 1e-10),
    # Not exact in the corner that a frictional wall makes with another one
    ({"type": "frictional", "frictionCoefficient": 0.3}, 1e-6)],
    ids=["slip", "frictional"])
def testWallsTakeWhatWaterAndSoilLose(tmp_path, figures, wall, bound):
    deltaT = 5e-5
    case = fixedStep(tank(soil=wall), deltaT).write(tmp_path/"case").prepare()
    serial = case.clone(tmp_path/"serial")
    serial.solve()
    lost(figures, serial, deltaT, bound)
    case.decompose(2, (2, 1, 1)).solve(ranks=2)
    for cloud in ["water", "soil"]:
        a, b = (readDat(c.path, cloud, "force.dat") for c in (serial, case))
        figures.atMost(f"two ranks, {cloud}", float(
            np.abs(a - b).max()/np.abs(a).max()), 1e-10)


def testStillWater(tmp_path, figures):
    """Force on each wall, and the pressure along walls"""
    h, level, width = 0.02, 0.3, 0.4
    line = {"type": "line", "start": (0, 0.03, 0), "end": (0, 0.27, 0),
            "nPoints": 9}
    case = Setup(
        cells=(20, 18), h=h, sides={
            s: ("wall", "slip") for s in ("xmin", "xmax", "ymin")},
        regions={"pool": hydrostatic((0, 0), (width, level))},
        functions={"forces": forcesOf(
            "water", patches="(xmin ymin)", pressure={
                "side": line, "floor": {"type": "patch", "patch": "ymin"},
                "dry": {"type": "points", "points": "((0.2 0.34 0))"}})},
        energy=False).until(0.2).write(tmp_path/"case").prepare()
    case.solve()
    rows = readColumns(case.path, "forces", "forces.dat")
    half = len(rows["Time"])//2
    mean = {k: v[half:].mean() for k, v in rows.items()}
    side, floor = RHO*G*level**2/2*h, RHO*G*level*width*h
    figures.atMost("side: error of the force, %",
                   100*abs(mean["xmin_Fx"]/-side - 1), 1)
    figures.atMost("floor: error of the force, %",
                   100*abs(mean["ymin_Fy"]/-floor - 1), 0.5)
    # About the origin: the side at a third of the depth, the floor in its middle
    figures.atMost("side: error of its moment, %", 100*abs(
        mean["xmin_Mz"]/(side*level/3) - 1), 1.5)
    figures.atMost("floor: error of its moment, %", 100*abs(
        mean["ymin_Mz"]/(-floor*width/2) - 1), 0.5)
    figures.atMost("slip: viscous", float(np.abs(
        readDat(case.path, "forces", "force.dat")[:, 7:]).max()), 0)

    p = readDat(case.path, "forces", "pressure_side.dat")[half:, 1:].mean(axis=0)
    y = np.linspace(0.03, 0.27, 9)
    figures.atMost("pressure along the side: error over that of the floor, %",
                   float(100*np.abs(p/(RHO*G) - (level - y)).max()/level), 1.5)
    p = readDat(case.path, "forces", "pressure_floor.dat")[half:, 1:]
    figures.equal("faces of the floor", p.shape[1], 20)
    figures.atMost("pressure on the floor, error, %", float(
        100*np.abs(p.mean(axis=0)/(RHO*G*level) - 1).max()), 1.5)
    figures.equal("pressure where it is dry", float(np.abs(readDat(
        case.path, "forces", "pressure_dry.dat")[:, 1:]).max()), 0.0)


@pytest.mark.parametrize("on", ["patch", "body"])
def testCoulombFriction(tmp_path, figures, on):
    """A block that slides: friction over pressure is the coefficient"""
    mu, slope = 0.4, np.radians(35)
    body = on == "body"
    setup = Setup(
        cells=(30, 16), h=0.02, points=2, regions={}, soilWall="slip",
        g=(G*np.sin(slope), -G*np.cos(slope), 0),
        sides={"ymin": ("wall", "slip" if body else {
            "type": "frictional", "frictionCoefficient": mu})},
        soilRegions={"block": box((0.1, 0.1 if body else 0),
                                  (0.26, 0.2 if body else 0.1),
                                  stress="geostatic")},
        soil={"constitutiveModel": "linearElastic", "linearElasticCoeffs": {
            "rhoS": 2650, "d": 1e-3, "e0": 0.7, "E": 1e6, "nu": 0.3}},
        energy=False)
    if body:
        setup.bodies = {"plane": {
            "type": "fixed", "soil": {"frictionCoefficient": mu},
            "surface": box((-5, -5, -5), (5, 0.1, 5))}}
    setup.functions["forces"] = forcesOf(
        "soil", **({"bodies": "(plane)"} if body else {"patches": "(ymin)"}))
    case = setup.until(0.15 if body else 0.05).write(tmp_path/"case").prepare()
    case.solve()
    force = readDat(case.path, "forces", "force.dat")[1:]
    force = force[len(force)//3:] if body else force
    weight = 2650/1.7*0.16*0.1*0.02*G*np.cos(slope)
    figures.atMost("error of the mean normal force, %",
                   100*abs(force[:, 5].mean()/-weight - 1), 5)

    # On a body of the mean normal force; on a patch of that of each node, and
    # none where one pulls, as some do when the block vibrates later
    ratio = (force[:, 7].mean()/-force[:, 5].mean() if body
             else np.median(force[:, 7]/-force[:, 5]))
    figures.atMost("friction over pressure, error, %",
                   100*abs(ratio/mu - 1), 1)
    figures.atMost("pressure along the wall over that across", float(
        np.abs(force[:, 4]).max()/weight), 1e-12)


def testWhatIsNotThere(tmp_path, figures):
    setup = Setup(cells=(6, 6), h=0.02, energy=False,
                  regions={"pool": hydrostatic((0, 0), (1, 0.06))}).steps(1)
    case = setup.write(tmp_path/"case").prepare()
    for entries, words in [
            ({"patches": "(floor)"}, ["patches", "floor", "walls"]),
            ({"bodies": "(pipe)"}, ["bodies"]),
            ({"patches": "(walls)", "pressure": {"a": {"type": "lin"}}},
             ["type", "lin", "line"]),
            ({"patches": "(walls)", "pressure": {
                "a": {"type": "patch", "patch": "floor"}}}, ["floor"]),
            ({"patches": "(walls)", "pressure": {
                "a": {"type": "points", "points": "((0 0 0))",
                      "body": "pile"}}}, ["pile"])]:
        case.setup.functions = {"forces": forcesOf("water", **entries)}
        case.rewrite()
        with pytest.raises(CaseError) as error:
            case.solve()
        for word in words:
            figures.contains(f"{entries}", word if word in str(error.value)
                             else None, word)
