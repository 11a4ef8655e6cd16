"""Thin plates: runs of bodies.py. The scenes are those of test/cases/plates.py."""

import numpy as np

import plates
from caseBuilder import G, RHO, Setup, box, hydrostatic


def oneSided(solve, name, thickness, degrees, h):
    setup, start, end, volume = plates.oneSided(thickness, degrees, h)
    case = solve(name, setup)
    points = case.points("0")
    yield ("error of the volume at the start, %",
           100*((points.mass*points.J).sum()/RHO/volume - 1), "<= 0.1")
    nearest, speed, noise, F = plates.oneSidedFigures(
        case, thickness, start, end)
    yield "deepest point over h", nearest, ">= 0"
    yield "rms speed, most, mm/s", 1e3*speed, "<= 10"
    yield "noise at the plate, most, % of rho g H", 100*noise, "<= 1.5"
    yield "force across over rho g H^2/2", F[0], "1 +- 1 %"
    yield ("force upwards over rho g H^2/2, less the exact one",
           F[1] + 1/np.tan(np.radians(degrees)), "<= 0.02")


def passing(solve, name, thickness, degrees, soil, way=None):
    """What is on the right with something on the left, and without"""
    motion = plates.motions(degrees)[way] if way else None
    runs = [solve(f"{name}_{len(sides)}", plates.blobs(
        thickness, degrees, sides, soil, motion=motion)[0])
        for sides in [["left", "right"], ["right"]]]
    _, start, end = plates.blobs(thickness, degrees, ["right"], soil)
    there = plates.placed(start, end, 0.04, **(motion or {}))
    cloud = "soil" if soil else "water"

    def read(case, time):
        field = {n: case.case.cloudField(time, cloud, n)
                 for n in ["id", "x", "U", "mass"]}
        order = np.argsort(field["id"])
        return {n: values[order] for n, values in field.items()}
    first, last, alone = (read(runs[0], "0"), read(runs[0], runs[0].times[-1]),
                          read(runs[1], runs[1].times[-1]))
    right = plates.height(first["x"], start, end) < 0
    momentum = (last["mass"][:, None]*last["U"])[right].sum(axis=0)
    given = (first["mass"][:, None]*first["U"]).sum(axis=0)
    yield ("points on another side than before", float((right != (
        plates.height(last["x"], *there) < 0)).sum()), "<= 0")
    if way:
        lost = given - (last["mass"][:, None]*last["U"]).sum(axis=0)
        force = 4e-4*plates.forces(runs[0], cloud).sum(axis=0)
        yield ("force in time less the momentum that was lost, %",
               100*np.linalg.norm(force - lost)/np.linalg.norm(lost), "<= 1e-6")
    else:
        yield ("momentum that passed in 100 steps, %",
               100*np.linalg.norm(momentum)/np.linalg.norm(given), "<= 0.1")
    yield ("velocities other than with nothing on the left, m/s",
           abs(last["U"][right] - alone["U"]).max(), "<= 1e-10")


def sluice(solve, name, thickness):
    setup, level, opening = plates.sluice(thickness, 0.8)
    yield ("discharge over Torricelli's, contraction 0.61",
           plates.discharge(solve(name, setup), level, opening), "1 +- 10 %")


def sluiceOffset(solve, name, thickness):
    """The same where plate and edge are elsewhere between the nodes"""
    found = []
    for x in [0.6, 0.603, 0.605]:
        for opening in [0.06, 0.063, 0.065]:
            setup, level, _ = plates.sluice(thickness, 0.8, x, opening)
            case = solve(f"{name}_{x:g}_{opening:g}", setup)
            found.append(plates.discharge(case, level, opening, x))
    what = "discharge over Torricelli's, contraction 0.61"
    yield f"{what}: least of nine places", min(found), "stated"
    yield f"{what}: mean", np.mean(found), "1 +- 10 %"
    yield f"{what}: most", max(found), "stated"


def gate(solve, name, h):
    """One that is lifted off the floor, as a plate and as a box, and none"""
    found = {}
    for kind in ["box", "plate", "none"]:
        setup, face = plates.gate(kind, 0.3, h)
        found[kind] = plates.released(solve(f"{name}_{kind}", setup), face)
    for i, what in enumerate(["way of the front", "volume"]):
        for kind in ["box", "none"]:
            yield (f"{what} over that with {kind}",
                   found["plate"][i]/found[kind][i], "stated")


def sand(solve, name, thickness, h):
    top, foot = 0.12, 0.2
    case = solve(name, Setup(
        cells=(round(0.4/h), round(0.16/h)), h=h, points=2, regions={},
        soilRegions={"sand": box((0, 0), (foot, top), stress="geostatic",
                                 saturated=False)},
        mpm={"maxSoilSoundSpeed": 20},
        bodies={"plate": plates.plate(
            (foot, 0), (foot, 0.16), thickness*h,
            soil={"frictionCoefficient": 0.4})}, energy=False).until(0.5))
    U = case.case.cloudField(case.times[-1], "soil", "U")
    F = plates.forces(case, "soil")[-1]
    weight = 0.5*RHO*2.65/1.695*G*top**2*h
    yield ("rms speed, mm/s", 1e3*np.sqrt((U**2).sum(axis=1).mean()), "<= 1")
    yield ("force over rho g H^2/2 (active 0.25, at rest 0.43)",
           F[0]/weight, "stated")


def seepage(solve, name, h, d=1e-3, mu=5e-3):
    """Below a sheet pile in a layer of finite depth, of a viscous liquid, which
    follows Darcy's law: Pavlovsky's form factor of two fragments, q = k H K'/(2 K) with the modulus sin(pi s/(2 T))"""
    T, s, levels, end = 0.15, 0.07, (0.25, 0.17), 1.0
    case = solve(name, Setup(
        cells=(round(0.8/h), round(0.3/h)), h=h, points=2, regions={
            "left": hydrostatic((0, 0), (0.4, levels[0])),
            "right": hydrostatic((0.4, 0), (0.8, levels[1]))},
        soilRegions={"bed": box((0, 0), (0.8, T), stress="geostatic",
                                saturated=True)},
        fluid={"mu": mu}, soil={"DruckerPragerCoeffs": {
            "rhoS": 2650, "d": d, "e0": 0.695, "E0": 216, "n": 0.5, "nu": 0.2,
            "phi": 35, "psi": 0}},
        mpm={"maxSoilSoundSpeed": 15},
        bodies={"plate": plates.plate(
            (0.4, T - s), (0.4, 0.35), 0.2*h,
            soil={"frictionCoefficient": 0.4})},
        energy=False).until(end, end/10))
    q = []
    for time in case.times[3:]:
        # What the points below the toe carry
        p = case.points(time)
        below = (abs(p.x[:, 0] - 0.4) < 0.5*h) & (p.x[:, 1] < T - s)
        q.append((p.mass*p.U[:, 0])[below].sum()/(RHO*h*h))

    # Darcy's part of Ergun's law at the porosity of the bed
    n = 0.695/1.695
    k = RHO*G*n**3*d**2/(150*mu*(1 - n)**2)

    def K(m):
        # Complete elliptic integral by the arithmetic-geometric mean
        a, b = 1.0, np.sqrt(1 - m**2)
        for _ in range(20):
            a, b = 0.5*(a + b), np.sqrt(a*b)
        return np.pi/(2*a)
    m = np.sin(0.5*np.pi*s/T)
    exact = k*(levels[0] - levels[1])*K(np.sqrt(1 - m**2))/(2*K(m))
    yield "discharge over Pavlovsky's", np.mean(q)/exact, "1 +- 10 %"


def contents(solve):
    return {
        **{f"plate{t:g}h_{d}_h{h:g}":
           (lambda n, t=t, d=d, h=h: oneSided(solve, n, t, d, h))
           for t in [0.1, 0.5, 1, 2] for d in [90, 60, 120]
           for h in [0.02, 0.01] if h == 0.02 or t in (0.1, 1)},
        **{f"plate{t:g}h_{d}_passing_{'soil' if soil else 'water'}":
           (lambda n, t=t, d=d, soil=soil: passing(solve, n, t, d, soil))
           for t in [0.1, 0.5, 1, 2] for d in [90, 60]
           for soil in [False, True]},
        **{f"plate{t:g}h_{d}_{way}_{'soil' if soil else 'water'}":
           (lambda n, t=t, d=d, soil=soil, way=way:
            passing(solve, n, t, d, soil, way))
           for t in [0.1, 2] for d in [90, 60]
           for way in ["along", "across", "turning"] for soil in [False, True]},
        **{f"plate_gate_h{h:g}": (lambda n, h=h: gate(solve, n, h))
           for h in [0.02, 0.01]},
        **{f"plate{t:g}h_sluice": (lambda n, t=t: sluice(solve, n, t))
           for t in [0.1, 1, 2]},
        **{f"plate{t:g}h_sluice_offset":
           (lambda n, t=t: sluiceOffset(solve, n, t)) for t in [0.1, 1, 2]},
        **{f"plate{t:g}h_sand_h{h:g}":
           (lambda n, t=t, h=h: sand(solve, n, t, h))
           for t, h in [(0.1, 0.01), (1, 0.01), (0.1, 0.005)]},
        **{f"plate_seepage_h{h:g}": (lambda n, h=h: seepage(solve, n, h))
           for h in [0.0125, 0.01]},
    }
