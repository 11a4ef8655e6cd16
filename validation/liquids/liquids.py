#!/usr/bin/env python3
"""Wall stress, turbulence and yield stress against closed forms: open channels
over rough and smooth beds after 5 H/u*, a dam break over a rough bed, a
Bingham liquid in a gap, on a slope and as a column that slumps, a viscous
liquid that spreads.

    ./liquids.py [--list] [name or pattern ...]

Writes results/liquids.csv, a row for each run and figure; a run whose rows are
there is not made again.
"""

import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

import caseBuilder  # noqa: E402
from caseBuilder import G, RHO, Setup, hydrostatic  # noqa: E402
from liquids import (  # noqa: E402
    KAPPA, BedChannel, Channel, binghamGap, binghamSlope, setField)
from mpmfoam import figureTable  # noqa: E402

caseBuilder.TIMEOUT = 7200
TIMES = 5                       # H/u*
START = {"k": 8e-3, "epsilon": 3e-3}


def channel(path, turbulence, transfer="XAPIC", **entries):
    flow = Channel(
        turbulence, water={"transfer": transfer},
        coeffs=START if turbulence == "kEpsilon" else None, **entries)
    case = flow.start(path, TIMES*flow.depth/flow.uStar)
    case.solve()
    p = case.points()
    y = p.x[:, 1]
    rows = [(y >= j*flow.h) & (y < (j + 1)*flow.h)
            for j in range(1, flow.cells)]
    profile = [p.U[r, 0].mean()/flow.profile(y[r].mean())
               for r in rows if r.any()]
    return [("mean velocity over the law's", flow.meanOf(case), "1 +- 5 %"),
            ("largest error of the profile over the first row",
             np.abs(np.array(profile) - 1).max(), "")]


def bed(path, **entries):
    """Over grains, half as long"""
    flow = BedChannel(coeffs=START, **entries)
    case = flow.start(path, 2.5*flow.depth/flow.uStar, writes=5)
    case.solve()
    return [("mean velocity over the law's", flow.meanOf(case), "1 +- 5 %"),
            ("stress on the bed over the law's",
             flow.stressOf(case, *case.times[-2:]), "1 +- 5 %")]


def gap(path, transfer="APIC", **entries):
    setup, exact, T = binghamGap(water={"transfer": transfer}, **entries)
    case = setup.until(T/2).write(path).prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = exact(x[:, 1])
    setField(case, "U", U)
    case.solve()
    p = case.points()
    u, theory = p.U[:, 0], exact(p.x[:, 1])
    return [("flow over theory's", u.mean()/theory.mean(), "1 +- 2 %"),
            ("speed of the plug over theory's", u.max()/theory.max(), ""),
            ("width of the plug over theory's",
             plugWidth(p.x[:, 1], u, 0.05, 0.02)/0.02, "1 +- 5 %"),
            ("rms error over the plug's speed",
             np.sqrt(np.mean((u - theory)**2))/theory.max(), "")]


def plugWidth(y, u, half, plug):
    """Of a profile U - a (d - plug)^2, d the distance from the middle: a
    straight line through sqrt(U - u), away from plug and wall"""
    d = np.abs(y - half)
    part = (d > plug + 0.25*(half - plug)) & (d < plug + 0.85*(half - plug))
    slope, at0 = np.polyfit(d[part], np.sqrt(u.max() - u[part]), 1)
    return -at0/slope


def slope(path, transfer="XAPIC", **entries):
    """A layer that flows, and one that its yield stress holds"""
    setup, exact, T = binghamSlope(water={"transfer": transfer}, **entries)
    case = setup.until(T).write(path).prepare()
    case.solve()
    p = case.points()
    theory = exact(p.x[:, 1])
    asked = "1 +- 2 %"
    if entries.get("yields", True):
        return [("flow over theory's", p.U[:, 0].mean()/theory.mean(), asked)]
    return [("largest speed over that without a yield stress",
             np.linalg.norm(p.U, axis=1).max()/exact.free, "<= 0.01")]


def spreading(path, h):
    """A viscous liquid on a plate [Huppert 1982, J. Fluid Mech. 121]: 0.01 m2,
    nu 0.01 m2/s, from his profile at 1 s to 8 s"""
    A, nu = 0.01, 0.01

    def at(t):
        return 1.411*(G*A**3*t/(3*nu))**0.2

    def profile(x, t):
        depth = A/(0.84135*at(t))       # mean of (1 - s^2)^(1/3)
        return depth*np.cbrt(np.maximum(0, 1 - (x/at(t))**2))
    x = (np.arange(round(at(1)/h)) + 0.5)*h
    setup = Setup(
        cells=(round(0.55/h), round(0.06/h)), h=h, points=3,
        sides={"ymin": ("wall", "noSlip")}, wall="slip", energy=False,
        fluid={"mu": nu*RHO, "soundSpeed": 7}, water={"transfer": "XAPIC"},
        regions={f"c{i}": hydrostatic((xi - h/2, 0), (xi + h/2, d))
                 for i, (xi, d) in enumerate(zip(x, profile(x, 1)))})
    case = setup.until(7, 3.5).write(path).prepare()
    case.solve()
    return [(f"front over Huppert's at {1 + t:g} s",
             case.points(case.times[k]).x[:, 0].max()/at(1 + t), "1 +- 4 %")
            for k, t in [(1, 3.5), (2, 7)]]


def slump(path, h):
    """A column of a Bingham liquid, 0.1 m x 0.1 m, that slumps to
    z^2 = 2 tau_y (L - x)/(rho g) [Liu and Mei 1989, J. Fluid Mech. 207]"""
    A, stress, mu = 0.01, 17.0, 2.0
    L = (9*A**2*RHO*G/(8*stress))**(1/3)
    setup = Setup(
        cells=(round(0.6/h), round(0.12/h)), h=h, points=3,
        sides={"ymin": ("wall", "noSlip")}, wall="slip", energy=False,
        fluid={"mu": mu, "soundSpeed": 10}, water={
            "transfer": "XAPIC", "viscosityModel": "BinghamPapanastasiou",
            "BinghamPapanastasiouCoeffs": {"tau0": stress/RHO, "m": 5}},
        regions={"column": hydrostatic((0, 0), (0.1, 0.1))})
    case = setup.until(6, 2).write(path).prepare()
    case.solve()
    z = np.sqrt(2*stress*L/(RHO*G))
    rows = []
    for t in case.times[-2:]:
        p = case.points(t)
        rows += [(f"front over theory's at {float(t):g} s",
                  p.x[:, 0].max()/L, "1 +- 5 %"),
                 (f"height over theory's at {float(t):g} s",
                  p.x[:, 1].max()/z, "1 +- 5 %")]
    return rows


def tip(t, h0, ks, nu=1e-6):
    """Front of a dam-break wave over a rough bed [Whitham 1955, Proc. R. Soc.
    A 227; closed as Chanson 2009, Eur. J. Mech. B 28]: behind it a tip of one
    velocity U, dh/dx = -u*^2/(g h), that holds what the wave without friction
    would have ahead of where it has U. Here with the u* of the law of the
    wall for the depth instead of a constant coefficient"""
    c0 = np.sqrt(G*h0)

    def tipOf(U):
        h1 = (c0 - U/2)**2/G
        h = np.linspace(0, h1, 2001)[1:]
        y0 = ks/30
        # Mean of ln(1 + y/y0) over the depth
        mean = ((h + y0)*np.log1p(h/y0) - h)/h
        uStar = KAPPA*U/mean
        length = np.cumsum(G*h/uStar**2)*(h[1] - h[0])
        volume = length[-1]*h1 - np.sum(length)*(h[1] - h[0])
        return length[-1], volume

    low, high = 0.5*c0, 2*c0
    for _ in range(60):
        U = (low + high)/2
        length, volume = tipOf(U)
        # More friction, a larger tip than there is water for: slower
        if volume > t*(c0 - U/2)**3/G:
            low = U
        else:
            high = U
    return (1.5*U - c0)*t + tipOf(U)[0]


def damBreak(path, ks, h=0.01, turbulence="kEpsilon"):
    """A dam break, 0.4 m deep, over a rough bed that is dry"""
    h0, dam, end = 0.4, 2.0, 1.0
    water = {"transfer": "XAPIC", "turbulence": turbulence}
    if turbulence == "kEpsilon":
        water["kEpsilonCoeffs"] = START
    bed = {"type": "roughWall", "ks": ks} if ks else "slip"
    setup = Setup(
        cells=(round((dam + 4)/h), round(0.45/h)), h=h, points=2,
        sides={"ymin": ("wall", bed)}, energy=False, water=water,
        regions={"reservoir": hydrostatic((0, 0), (dam, h0))})
    case = setup.until(end, end/4).write(path).prepare()
    case.solve()
    # The speed: how long the front takes to form is not in the theory
    rows = []
    times = [float(t) for t in case.times]
    fronts = [np.quantile(case.points(t).x[:, 0], 0.9995) for t in case.times]
    for i in range(2, len(times) - 1):
        there = [tip(t, h0, ks) if ks else 2*np.sqrt(G*h0)*t
                 for t in times[i:i + 2]]
        rows.append((
            f"speed of the front over theory's, {times[i]:g} to "
            f"{times[i + 1]:g} s", (fronts[i + 1] - fronts[i])/(
                there[1] - there[0]), "1 +- 5 %"))
    return rows


def within(make, *arguments, **entries):
    """A run in a directory of its own, of which the figures stay"""
    def run(name):
        path = Path(tempfile.mkdtemp(prefix="liquids."))
        try:
            return make(path/"case", *arguments, **entries)
        finally:
            shutil.rmtree(path, ignore_errors=True)
    return run


RUNS = {
    **{f"channel {model} ks={ks:g} cells={n}":
       within(channel, model, ks=ks, cells=n)
       for model in ["mixingLength", "kEpsilon"] for ks in [1e-3, 1e-2]
       for n in [20, 40]},
    "channel mixingLength smooth cells=20":
        within(channel, "mixingLength", ks=0),
    **{f"channel {model} ks=0.001 cells=20 APIC":
       within(channel, model, "APIC", ks=1e-3)
       for model in ["mixingLength", "kEpsilon"]},
    **{f"gap {model} m={m:g} cells={n} {transfer}":
       within(gap, transfer, model=model, m=m, cells=n)
       for model, m, n, transfer in [
           ("BinghamPapanastasiou", 10, 16, "APIC"),
           ("BinghamPapanastasiou", 10, 16, "XAPIC"),
           ("BinghamPapanastasiou", 10, 32, "XAPIC"),
           ("BinghamPapanastasiou", 40, 32, "APIC"),
           ("HerschelBulkley", 10, 16, "XAPIC")]},
    **{f"bed {name}": within(bed, **entries) for name, entries in [
        ("cells=20", {}), ("cells=40", {"cells": 40}),
        ("cells=20 between nodes", {"rise": 0.5}),
        ("cells=20 jittered", {"placement": "jittered"}),
        ("cells=20 d=4 mm", {"d": 4e-3}),
        ("cells=40 jittered", {"cells": 40, "placement": "jittered"})]},
    **{f"slope cells={n}": within(slope, cells=n) for n in [8, 16]},
    "slope holds cells=8": within(slope, cells=8, yields=False),
    **{f"spreading h={h*1e3:g} mm": within(spreading, h)
       for h in [0.005, 0.0025]},
    **{f"slump h={h*1e3:g} mm": within(slump, h) for h in [0.005, 0.0025]},
    **{f"dam break ks={ks*1e3:g} mm h={h*1e3:g} mm{and_}":
       within(damBreak, ks, h, turbulence)
       for ks, h, turbulence, and_ in [
           (0, 0.01, "none", ""), (0.01, 0.01, "kEpsilon", ""),
           (0.01, 0.005, "kEpsilon", ""), (0.03, 0.01, "kEpsilon", ""),
           (0.01, 0.01, "none", " no turbulence")]}}


if __name__ == "__main__":
    figureTable.main(__doc__, HERE, HERE/"results"/"liquids.csv", RUNS)
