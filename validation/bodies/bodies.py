#!/usr/bin/env python3
"""Solid bodies against closed forms: still water over inclined floors, buoyancy,
added mass, entry of wedges, floating boxes, columns of sand on planes.

    ./bodies.py [--list] [name or pattern ...]

Writes results/bodies.csv, a row for each run and figure; a run whose rows are
there is not made again."""

import shutil
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

import bodies as shapes  # noqa: E402
from caseBuilder import G, RHO, Setup, box, hydrostatic  # noqa: E402
import plateRuns  # noqa: E402
from heave import freeHeave  # noqa: E402
from mpmfoam import figureTable  # noqa: E402

RESULTS = HERE/"results"/"bodies.csv"


def rms(U):
    return np.sqrt((U**2).sum(axis=1).mean())


def solve(name, setup):
    path = HERE/"runs"/name
    shutil.rmtree(path, ignore_errors=True)
    setup.energy = False
    case = setup.write(path)
    case.prepare()
    case.solve()
    return case


def series(case):
    """forces.dat: time, force, moment, position, velocity"""
    return np.loadtxt(
        case.path/"postProcessing"/"forces"/"0"/"forces.dat", ndmin=2)


def withForces(setup, every=1):
    setup.functions["forces"] = {
        "type": "materialPointForces", "cloud": "water",
        "libs": '("libmpmFunctionObjects.so")',
        "writeControl": "timeStep", "writeInterval": every}
    return setup


# --- still water ----------------------------------------------------------

def floor(name, degrees, offset, h):
    level, through = 0.4, (0.5, 0.12 + offset*h)
    case = solve(name, Setup(
        cells=(round(1/h), round(0.6/h)), h=h,
        regions={"pool": hydrostatic((0, 0), (1, level))},
        bodies={"floor": {"type": "fixed",
                          "surface": shapes.surface("floor.obj")}},
        surfaces={"floor.obj": shapes.prism(shapes.slope(degrees, through))}
    ).until(2, 0.5))
    t = np.radians(degrees)
    normal = np.array([-np.sin(t), np.cos(t)])
    noise, speed, deepest, height = [], [], [], []
    for time in case.times:
        points = case.points(time)
        height.append(points.centre[1])
        if float(time) == 0:
            continue
        phi = (points.x[:, :2] - through) @ normal
        depth = level - points.x[:, 1]
        wall = (phi < 1.5*h) & (depth > 1.5*h)
        noise.append(np.sqrt(np.mean((points.p - RHO*G*depth)[wall]**2)))
        speed.append(rms(points.U))
        deepest.append(phi.min()/h)
    asked = 2.5 if offset else 1.5
    yield ("noise at the wall, 2 s, % of rho g H",
           100*noise[-1]/(RHO*G*level), f"<= {asked}")
    yield ("noise at the wall, most, % of rho g H",
           100*max(noise)/(RHO*G*level), f"<= {asked}")
    yield "rms speed, most, mm/s", 1e3*max(speed), "<= 10"
    yield "rms speed at 2 s, mm/s", 1e3*speed[-1], "<= 10"
    yield "deepest point over h", min(deepest), ">= 0"
    yield ("drift of the mean height of the water, % of the depth",
           100*abs(np.array(height) - height[0]).max()/level, "<= 0.1")


def plane(name, h, n=16):
    """Still water over a plane inclined about two axes"""
    level, through = 0.8*n*h, np.array([0.5*n*h, 0.5*n*h, 0.31*n*h])
    normal = np.array([-0.4, -0.25, 1.0])
    normal /= np.linalg.norm(normal)
    u = np.cross(normal, [0, 1.0, 0])
    u /= np.linalg.norm(u)
    v = np.cross(normal, u)
    far = 6*n*h
    corners = [through + far*(a*u + b*v) - c*far*normal
               for c in (1, 0) for a, b in [(-1, -1), (1, -1), (1, 1), (-1, 1)]]
    faces = [(1, 4, 3), (1, 3, 2), (5, 6, 7), (5, 7, 8)]
    for i in range(1, 5):
        j = i % 4 + 1
        faces += [(i, j, j + 4), (i, j + 4, i + 4)]
    # Outward, whichever way u and v turn
    if np.dot(np.cross(u, v), normal) < 0:
        faces = [f[::-1] for f in faces]
    text = "".join("v {:.12g} {:.12g} {:.12g}\n".format(*c) for c in corners)
    text += "".join("f %d %d %d\n" % f for f in faces)
    case = solve(name, Setup(
        cells=(n, n, n), h=h, points=2,
        regions={"pool": hydrostatic((0, 0, 0), (n*h, n*h, level))},
        bodies={"floor": {"type": "fixed",
                          "surface": shapes.surface("floor.obj")}},
        surfaces={"floor.obj": text}).until(0.5, 0.1))
    noise, speed, deepest, height = [], [], [], []
    for time in case.times:
        points = case.points(time)
        height.append(points.centre[2])
        if float(time) == 0:
            continue
        phi = (points.x - through) @ normal
        depth = level - points.x[:, 2]
        wall = (phi < 1.5*h) & (depth > 1.5*h)
        noise.append(np.sqrt(np.mean((points.p - RHO*G*depth)[wall]**2)))
        speed.append(rms(points.U))
        deepest.append(phi.min()/h)
    yield ("noise at the wall, most, % of rho g H",
           100*max(noise)/(RHO*G*level), "<= 2.5")
    yield "rms speed, most, mm/s", 1e3*max(speed), "<= 10"
    yield "deepest point over h", min(deepest), ">= 0"
    yield ("drift of the mean height of the water, % of the depth",
           100*abs(np.array(height) - height[0]).max()/level, "<= 0.1")


def cylinder(name, h, offset):
    radius = 0.1
    case = solve(name, withForces(Setup(
        cells=(round(1/h), round(0.7/h)), h=h,
        regions={"pool": hydrostatic((0, 0), (1, 0.6))},
        bodies={"pipe": {"type": "fixed", "surface": shapes.cylinder(
            (0.5 + offset*h, 0.3 + 0.3*offset*h), radius)}}).until(1)))
    F = series(case)
    F = F[len(F)//2:, 1:3].mean(axis=0)/(RHO*G*np.pi*radius**2*h)
    yield "error of the buoyancy, %", 100*(F[1] - 1), "<= 1"
    yield "force across, % of the buoyancy", 100*F[0], "<= 1"


def turnedBox(name, h):
    t, size = np.radians(25), np.array([0.24, 0.16])
    along = np.array([np.cos(t), np.sin(t)])*size[0]/2
    up = np.array([-np.sin(t), np.cos(t)])*size[1]/2
    centre = np.array([0.507, 0.303])
    corners = [centre - along - up, centre + along - up, centre + along + up,
               centre - along + up]
    case = solve(name, withForces(Setup(
        cells=(round(1/h), round(0.7/h)), h=h,
        regions={"pool": hydrostatic((0, 0), (1, 0.6))},
        bodies={"box": {"type": "fixed",
                        "surface": shapes.surface("box.obj")}},
        surfaces={"box.obj": shapes.prism([tuple(c) for c in corners])}
    ).until(1)))
    F = series(case)
    F = F[len(F)//2:, 1:3].mean(axis=0)/(RHO*G*size.prod()*h)
    yield "error of the buoyancy, %", 100*(F[1] - 1), "<= 3"


def sphere(name, h):
    radius, n = 5*h, 24
    case = solve(name, withForces(Setup(
        cells=(n, n, n), h=h, points=2,
        regions={"pool": hydrostatic((0, 0, 0), (n*h, n*h, 20*h))},
        bodies={"ball": {"type": "fixed", "surface": {
            "type": "sphere", "origin": (12.3*h, 12*h, 10.2*h),
            "radius": radius}}}).until(0.3)))
    F = series(case)
    exact = RHO*G*4/3*np.pi*radius**3
    yield ("error of the buoyancy, %",
           100*(F[len(F)//2:, 3].mean()/exact - 1), "<= 3")
    yield "rms speed, mm/s", 1e3*rms(case.points().U), "<= 10"


# --- motion ---------------------------------------------------------------

def addedMass(name, cells, transfer="APIC"):
    h, amplitude, period, length = 0.0125, 0.004, 0.2, 2.0
    radius, omega = cells*h, 2*np.pi/period
    table = " ".join(
        f"({t:.8g} ({amplitude*np.sin(omega*t):.12g} 0 0))"
        for t in np.linspace(0, 3*period, 601))
    case = solve(name, withForces(Setup(
        cells=(round(length/h), round(length/2/h)), h=h, points=2,
        regions={"pool": hydrostatic((0, 0), (length, length/2 - 0.05))},
        fluid={"soundSpeed": 60}, water={"transfer": transfer},
        bodies={"ball": {
            "type": "prescribed",
            "surface": shapes.cylinder((length/2, length/4), radius),
            "motion": {"displacement": f"table ({table})"}}}
    ).until(3*period, period)))
    t, F = series(case)[:, :2].T
    late = t > period
    basis = np.c_[np.sin(omega*t), np.cos(omega*t), np.ones_like(t)]
    inPhase, out, _ = np.linalg.lstsq(basis[late], F[late], rcond=None)[0]
    unit = RHO*np.pi*radius**2*h*amplitude*omega**2
    yield "added mass over rho pi R^2", inPhase/unit, "1.027 +- 5 %"
    yield ("force against the velocity over rho pi R^2 omega U", -out/unit,
           "0; prototype 0.145")


def wedge(name, degrees, h, gravity):
    speed, depth, width = 2.0, 0.5, 30*h
    t = np.radians(degrees)
    apex = depth + h
    corner = apex + width*np.tan(t)
    corners = [(1, apex), (1 + width, corner), (1 + width, corner + 6*h),
               (1 - width, corner + 6*h), (1 - width, corner)]
    case = solve(name, withForces(Setup(
        cells=(round(2/h), int(np.ceil((corner + 8*h)/h))), h=h,
        g=(0, -G if gravity else 0, 0),
        regions={"pool": (hydrostatic if gravity else box)(
            (0, 0), (2, depth))},
        fluid={"soundSpeed": 80}, sides={"ymax": ("patch", "zeroGradient")},
        bodies={"wedge": {
            "type": "prescribed", "surface": shapes.surface("wedge.obj"),
            "motion": {"displacement":
                       f"table ((0 (0 0 0)) (10 (0 {-10*speed} 0)))"}}},
        surfaces={"wedge.obj": shapes.prism(corners)}
    ).until((13 if gravity else 8)*h/speed)))
    time, F = series(case)[:, [0, 2]].T
    s = speed*time - h
    buoyancy = RHO*G*s**2/np.tan(t)*h if gravity else 0
    k = (F - buoyancy)/h/(RHO*speed**2*np.maximum(s, 1e-9))
    chosen = (s > 4*h) & (s < 6*h)
    exact = {20: 42.5, 30: 14.1, 45: 3.9}[degrees]
    yield ("force over rho V^3 t, 4 to 6 h", k[chosen].mean(),
           f"{exact} +- 10 %")
    if gravity:
        yield "speed of the water at 12 h over V", \
            np.linalg.norm(case.points().U, axis=1).max()/speed, "finite"


def floatingBox(name, density, h, release, length, end, **entries):
    """A box that may heave, let go at rest; its height over rest [m] in time"""
    size, level = np.array([0.2, 0.1]), 0.4
    lower = np.array([length/2 - size[0]/2,
                      level - density*size[1] + release])
    centre = (*(lower + size/2), 0.0)
    mass = density*RHO*size.prod()*h
    inertia = mass*(size**2).sum()/12
    case = solve(name, withForces(Setup(
        cells=(round(length/h), round(0.6/h)), h=h,
        regions={"pool": hydrostatic((0, 0), (length, level))},
        bodies={"box": {"type": "rigid",
                        "surface": box(lower, lower + size), "motion": {
            "mass": mass, "centreOfMass": centre,
            "momentOfInertia": (inertia,)*3, "constraints": {"heave": {
                "sixDoFRigidBodyMotionConstraint": "line",
                "direction": (0, 1, 0)}}}}}, **entries).until(end, end)))
    data = series(case)
    y = data[:, 8] - size[1]/2 - (level - density*size[1])
    # It was placed above rest, and less of the water beside it
    return data[:, 0], y - size[0]*release/length, density*size[1]


def floating(name, density, h):
    t, y, draught = floatingBox(name, density, h, 0, 3.0, 3)
    yield "error of the draught, %", 100*abs(y).max()/draught, "<= 2"


def quiet(name, h, periods=20):
    """Released at rest, where it floats"""
    period = 0.74
    t, y, draught = floatingBox(name, 0.5, h, 0, 1.2, periods*period, points=2,
                                fluid={"soundSpeed": 20})
    for part, chosen in [("first", t < 0.5*t[-1]), ("second", t > 0.5*t[-1])]:
        yield (f"largest way from rest, {part} half of {periods} periods, "
               "% of the draught", 100*abs(y[chosen]).max()/draught, "<= 2")


def extremes(t, y):
    """Times and values of the first trough and of the crest behind it"""
    i = int(np.argmin(np.where(t < 0.65, y, np.inf)))
    j = i + int(np.argmax(y[i:]))
    return t[i], y[i], t[j], y[j]


def heave(name, h, transfer, release=0.015):
    """Against linear potential theory (heave.py)"""
    t, y, draught = floatingBox(
        name, 0.5, h, release, 2.4, 1.0, points=2, fluid={"soundSpeed": 20},
        water={"transfer": transfer})
    at = np.linspace(0, 1.2, 2401)
    z, _ = freeHeave(0.2, draught, 0.4, RHO*0.2*draught, at)
    exact, found = extremes(at, z), extremes(t, y/release)
    for i, what in [(0, "first trough"), (2, "first crest")]:
        yield (f"time to the {what} over the radiation solution's",
               found[i]/exact[i], "1 +- 10 %")
        yield (f"{what} over release, % (radiation solution "
               f"{100*exact[i + 1]:.1f})", 100*found[i + 1], "stated")


# --- soil -----------------------------------------------------------------

def column(name, degrees, h, friction, kind):
    """Dry column on a plane inclined downwards to the right: a wall of the mesh
    with tilted gravity, a body along the mesh with tilted gravity, an inclined
    body. Run-out along the plane."""
    size, end = np.array([0.12, 0.16]), 0.45
    t = np.radians(degrees)
    wall = {"frictionCoefficient": friction}
    along, normal, g = np.array([1, 0]), np.array([0, 1]), (
        G*np.sin(t), -G*np.cos(t), 0)
    heel = np.array([0.2, 0 if kind == "wall" else 6*h])
    length, height = 0.9, heel[1] + 0.24
    if kind == "inclined":
        along = np.array([np.cos(t), -np.sin(t)])
        normal = np.array([np.sin(t), np.cos(t)])
        g, heel, height = (0, -G, 0), np.array([0.2, 0.32]), 0.54
    corners = [heel, heel + size[0]*along,
               heel + size[0]*along + size[1]*normal, heel + size[1]*normal]
    setup = Setup(
        cells=(round(length/h), round(height/h)), h=h, points=2, g=g,
        regions={}, mpm={"maxSoilSoundSpeed": 25},
        soil={"DruckerPragerCoeffs": {
            "rhoS": 2650, "d": 1e-3, "e0": 0.7, "E0": 216, "n": 0.5, "nu": 0.2,
            "phi": 31, "psi": 0}},
        soilRegions={"sand": {"type": "surface", "file": '"sand.obj"'}},
        surfaces={"sand.obj": shapes.prism([tuple(c) for c in corners])},
        energy=False).until(end, end)
    if kind == "wall":
        setup.sides = {"ymin": ("wall", {"type": "frictional", **wall})}
        setup.soilWall = "slip"
    else:
        setup.bodies = {"plane": {
            "type": "fixed", "surface": shapes.surface("plane.obj"),
            "soil": wall}}
        setup.surfaces["plane.obj"] = shapes.prism(shapes.slope(
            -degrees if kind == "inclined" else 0, heel))
    case = solve(name, setup)
    x = case.case.cloudField(case.times[-1], "soil", "x")[:, :2]
    way = (x - heel) @ along
    return np.quantile(way, 0.995), way.mean() - 0.5*size[0]


def columns(name, degrees, h, friction=0.5):
    found = {kind: column(f"{name}_{kind}", degrees, h, friction, kind)
             for kind in ["wall", "aligned", "inclined"]}
    for of, against in [("inclined", "wall"), ("aligned", "wall"),
                        ("inclined", "aligned")]:
        asked = "1 +- 3 %" if of == "inclined" else "stated"
        other = "wall" if against == "wall" else "aligned body"
        for i, figure in enumerate(["front", "mean way"]):
            yield (f"{figure} on a body, {of}, over that on a {other}"
                   .replace("a aligned", "an aligned"),
                   found[of][i]/found[against][i], asked)


CONTENTS = {
    **{f"floor{d:g}_h{h:g}_off{o:g}":
       (lambda n, d=d, h=h, o=o: floor(n, d, o, h))
       for d in [10, 26.6, 45] for h in [0.02, 0.01] for o in [0, 0.4]
       if h == 0.02 or not o},
    **{f"cylinder_h{h:g}_off{o:g}": (lambda n, h=h, o=o: cylinder(n, h, o))
       for h in [0.02, 0.01] for o in [0, 0.37]},
    **{f"turnedBox_h{h:g}": (lambda n, h=h: turnedBox(n, h))
       for h in [0.02, 0.01]},
    "sphere": lambda n: sphere(n, 0.025),
    **{f"plane_h{h:g}": (lambda n, h=h: plane(n, h)) for h in [0.025]},
    **{f"columns{d}_h{h:g}": (lambda n, d=d, h=h: columns(n, d, h))
       for d, h in [(15, 0.01), (15, 0.005)]},
    **{f"addedMass_R{c}h": (lambda n, c=c: addedMass(n, c)) for c in [4, 8]},
    **{f"addedMass_R{c}h_XAPIC": (lambda n, c=c: addedMass(n, c, "XAPIC"))
       for c in [4, 8]},
    **{f"wedge{d}_h{h:g}{'_gravity' if g else ''}":
       (lambda n, d=d, h=h, g=g: wedge(n, d, h, g))
       for d in [20, 30, 45]
       for h, g in [(0.01, False), (0.01, True), (0.005, False)]},
    **{f"floating{r:g}_h{h:g}": (lambda n, r=r, h=h: floating(n, r, h))
       for r in [0.05, 0.5] for h in [0.02, 0.01]},
    "quiet_h0.02": lambda n: quiet(n, 0.02),
    **{f"heave_h{h:g}_{t}": (lambda n, h=h, t=t: heave(n, h, t))
       for h in [0.02, 0.01] for t in ["APIC", "XAPIC"]},
    **plateRuns.contents(solve),
}


if __name__ == "__main__":
    figureTable.main(__doc__, HERE, RESULTS, CONTENTS)
