"""Forces on a cloud beside gravity, gravity in time, and relaxation."""

import re

import numpy as np
import pytest

from mpmfoam import reference
from mpmfoam.postProcessing import readColumns

from caseBuilder import G, RHO, RHO_S, Setup, box, damBreak, hydrostatic
from test_parallel import agree
from test_restart import differing
from test_wallJet import CloudPoints
from test_waterProblems import HEIGHT, NU, SPEED


def energyOf(cloud):
    return {"type": "materialPointEnergy", "cloud": cloud,
            "libs": '("libmpmFunctionObjects.so")',
            "writeControl": "timeStep", "writeInterval": 10}


# Of the flow at the end: 8 nu U/H^2 along x
FORCE = 8*NU*SPEED/HEIGHT**2


@pytest.mark.parametrize("water", [
    {"pressureGradient": (-RHO*FORCE, 0, 0)}, {"bodyForce": (FORCE, 0, 0)}],
    ids=lambda w: next(iter(w)))
def testPoiseuille(tmp_path, figures, water):
    """Endless channel: the parabola at its start, and the energy"""
    setup = Setup(
        cells=(8, 16), h=HEIGHT/16, points=3, g=(0, 0, 0),
        sides={side: ("wall", "noSlip") for side in ("ymin", "ymax")},
        fluid={"soundSpeed": 0.02}, water=water,
        regions={"channel": box((0, 0), (1, 1))}).cyclic("x")
    case = setup.until(0.5, write=0.1).write(tmp_path/"case").prepare()
    case.solve()

    exact = reference.data("ana_couette_poiseuille_startup.csv")
    for number in [0.1, 0.5]:
        row = exact["T"] == number
        p = case.points(f"{number*HEIGHT**2/NU:g}")
        y = p.x[:, 1]/HEIGHT
        rows = np.array_split(np.argsort(y, kind="stable"), 48)
        mean = np.interp(exact["y_over_H"][row][1:-1],
                         [y[r].mean() for r in rows],
                         [p.U[r, 0].mean()/SPEED for r in rows])
        error = np.abs(
            mean - exact["u_poiseuille_over_umax"][row][1:-1]).max()
        figures.atMost(f"nu t/H^2 = {number}: largest error of u over U",
                       error, 0.01)
    e = case.energies()
    # Two thirds of U t, but for the time that the flow takes to start
    done = np.trapz(
        [(case.points(t).mass*case.points(t).U[:, 0]).sum()*FORCE
         for t in case.times], [float(t) for t in case.times])
    figures.atMost("work of the force: relative difference to the points'",
                   abs(e["forcework"][-1]/done - 1), 0.02)
    figures.atMost("growth of the total over the work", float(
        (e["total"] - np.minimum.accumulate(e["total"])).max()
        / e["forcework"][-1]), 1e-3)


def slope(**entries):
    """Endless slope of 15 degrees under water, in its own axes: the pressure
    of the water that rests over it has a gradient along the slope"""
    along, down = G*np.sin(np.radians(15)), G*np.cos(np.radians(15))
    setup = Setup(
        cells=(4, 20), h=0.01, points=2, g=(0, -down, 0),
        sides={"ymin": ("wall", "noSlip")},
        mpm={"gravity": (along, -down, 0),
             "relaxation": {"until": 0.1}, "maxSoilSoundSpeed": 30},
        water={"pressureGradient": (RHO*along, 0, 0)},
        regions={"water": hydrostatic((0, 0), (0.04, 0.15))},
        soilRegions={"bed": box((0, 0), (0.04, 0.1), stress="geostatic")},
        soil={"constitutiveModel": "linearElastic", "linearElasticCoeffs": {
            "rhoS": RHO_S, "d": 1e-3, "e0": 0.7, "E": 1e6, "nu": 0.3}},
        energy=False, **entries).cyclic("x")
    return setup, along


def testSubmergedSlope(tmp_path, figures):
    setup, along = slope()
    case = setup.until(0.2, write=0.1).write(tmp_path/"case").prepare()
    text = case.solve().text
    figures.contains("log", re.search(
        r"soil: relaxation ended, it gave \S+ J and \(.*\) kg m/s", text),
        "relaxation ended")
    soil = CloudPoints(case, "soil", case.times[-1])
    x, shear = soil.x, soil["sigma"][:, 1]
    # Submerged weight of what lies above
    exact = (RHO_S - RHO)/1.7*along*(0.1 - x[:, 1])
    inside = (x[:, 1] < 0.08) & (x[:, 1] > 0.02)
    scale = exact.max()
    figures.atMost("shear stress in the bed: largest error over that of its"
                   " base", float(np.abs(shear - exact)[inside].max()/scale),
                   0.03)
    p = case.points()
    figures.atMost("rms speed of the water [m/s]",
                   float(np.sqrt((p.U**2).sum(axis=1).mean())), 2e-3)


def column(**entries):
    """Water in a box on which gravity grows, started without pressure"""
    return Setup(
        cells=(8, 20), h=0.01, points=3, g=(0, -G, 0),
        regions={"column": box((0, 0), (0.08, 0.16))},
        mpm={"gravity": "table ((0 (0 0 0)) (0.3 (0 -9.81 0)))",
             "relaxation": {"until": 0.5}},
        fluid={"soundSpeed": 12.5}, **entries)


def testRampIsHydrostatic(tmp_path, figures):
    case = column().until(0.7, write=0.1).write(tmp_path/"case").prepare()
    case.solve()
    p = case.points()
    exact = RHO*G*(p.x[:, 1].max() + 0.01/6 - p.x[:, 1])
    figures.atMost("rms error of the pressure over rho g H", float(
        np.sqrt(((p.p - exact)**2).mean())/(RHO*G*0.16)), 0.01)
    figures.atMost("rms speed [m/s]", float(
        np.sqrt((p.U**2).sum(axis=1).mean())), 2e-3)
    e = case.energies()
    scale = RHO*G*0.16*0.08*0.16*0.01
    figures.atMost("growth of the total over m g H", float(
        (e["total"] - np.minimum.accumulate(e["total"])).max()/scale), 1e-3)
    figures.atMost("relaxation gives energy", float(
        np.diff(e["relaxationwork"]).max()), 0.0)


def testTwoRunsAreOne(tmp_path, figures):
    """In gravity and relaxation that end between"""
    setup = column()
    setup.mpm.update(gravity="table ((0 (0 0 0)) (0.03 (1 -9.81 0)))",
                     relaxation={"until": 0.025})
    setup.water["bodyForce"] = "table ((0 (0 0 0)) (0.04 (1 2 0)))"
    split = setup.until(0.02).write(tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")
    split.solve()
    for case in [split, whole]:
        case.change(control={"endTime": 0.04})
        case.solve()
    end = max(split.timesByStep())
    figures.equal("files that differ", differing(split, whole, end), [])
    a, b = (readColumns(c.path, "energy", "energy.dat")
            for c in (split, whole))
    for key in ["forceWork", "relaxationWork"]:
        figures.atLeast(f"{key} [J]", abs(b[key][-1]), 1e-6)
        figures.atMost(f"{key}: relative difference",
                       abs(a[key][-1]/b[key][-1] - 1), 1e-9)


def testRanksAgree(tmp_path, figures):
    setup = column()
    setup.mpm.update(gravity="table ((0 (0 0 0)) (0.03 (1 -9.81 0)))",
                     relaxation={"until": 0.02})
    setup.water["bodyForce"] = (0.5, 0, 0)
    serial = setup.steps(100).write(tmp_path/"serial").prepare()
    parallel = serial.clone(tmp_path/"parallel").decompose(2)
    serial.solve()
    parallel.solve(ranks=2)
    agree(figures, parallel, serial)
    a, b = (c.state(c.times[-1]) for c in (serial, parallel))
    for key in ["forceWork", "relaxationWork"]:
        figures.atMost(f"{key}: relative difference",
                       abs(a[key]/b[key] - 1), 1e-9)


@pytest.mark.parametrize("where, entries, message", [
    ("water", {"bodyForce": (0, 0, 1)},
     r"bodyForce is \(0 0 1\) at 0 s\.\s+Allowed: .*0 in direction z"),
    ("water", {"pressureGradient": "[0 1 -2 0 0 0 0] (1 0 0)"},
     r"pressureGradient has the dimensions .*Allowed: \[1 -2 -2"),
    ("mpm", {"gravity": "table ((0 (0 0 0)) (1 (0 -9 1)))"},
     r"gravity is \(.*Allowed: .*0 in direction z"),
    ("mpm", {"relaxation": {"until": 1, "damping": 1}},
     r"damping has the value 1\. Allowed: 0 < damping < 1"),
    ("mpm", {"relaxation": {"until": 0}}, r"until has the value 0\. Allowed: 0 < until"),
    ("mpm", {"relaxation": {"untill": 1}}, r"untill"),
], ids=["empty", "dimensions", "later", "damping", "until", "misspelt"])
def testRefused(tmp_path, figures, where, entries, message):
    setup = damBreak().until(0.05)
    getattr(setup, where).update(entries)
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    result = case.run("setMaterialPoints", check=False)
    if result.status == 0:
        result = case.solve(check=False)
    figures.holds("ends with an error", result.status != 0)
    flat = re.sub(r"\s+", " ", result.text)
    figures.contains("message", (re.search(message, flat) or [None])[0],
                     message)
