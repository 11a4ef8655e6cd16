#!/usr/bin/env python3
"""Wall stress, turbulence and yield stress against closed forms and
measurements: open channels over rough and smooth beds after 5 H/u*, a dam
break over a rough bed, a backward-facing step, a wall jet, a Bingham liquid in
a gap, on a slope and as a column that slumps, a viscous liquid that spreads.

    ./liquids.py [--list] [name or pattern ...]

Writes results/liquids.csv, a row for each run and figure; a run whose rows are
there is not made again.
"""

import math
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
import eulerian  # noqa: E402
from caseBuilder import (  # noqa: E402
    G, RHO, Setup, box, foamText, hydrostatic)
from liquids import (  # noqa: E402
    ASCII, KAPPA, BedChannel, Channel, binghamGap, binghamSlope, setField)
from mpmfoam import figureTable  # noqa: E402

caseBuilder.TIMEOUT = 7200
TIMES = 5                       # H/u*
MODELS = ["kEpsilon", "realizableKE", "RNGkEpsilon"]      # simpleFoam: the last, too
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


def gap(path, transfer="APIC", viscousStep="explicit", **entries):
    setup, exact, T = binghamGap(
        water={"transfer": transfer, "viscousStep": viscousStep}, **entries)
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


def slope(path, transfer="XAPIC", viscousStep="explicit", **entries):
    """A layer that flows, and one that its yield stress holds"""
    setup, exact, T = binghamSlope(
        water={"transfer": transfer, "viscousStep": viscousStep}, **entries)
    case = setup.until(T).write(path).prepare()
    case.solve()
    p = case.points()
    theory = exact(p.x[:, 1])
    asked = "1 +- 2 %"
    if entries.get("yields", True):
        return [("flow over theory's", p.U[:, 0].mean()/theory.mean(), asked)]
    return [("largest speed over that without a yield stress",
             np.linalg.norm(p.U, axis=1).max()/exact.free, "<= 0.01")]


def spreading(path, h, viscousStep="explicit"):
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
        fluid={"mu": nu*RHO, "soundSpeed": 7},
        water={"transfer": "XAPIC", "viscousStep": viscousStep},
        regions={f"c{i}": hydrostatic((xi - h/2, 0), (xi + h/2, d))
                 for i, (xi, d) in enumerate(zip(x, profile(x, 1)))})
    case = setup.until(7, 3.5).write(path).prepare()
    case.solve()
    return [(f"front over Huppert's at {1 + t:g} s",
             case.points(case.times[k]).x[:, 0].max()/at(1 + t), "1 +- 4 %")
            for k, t in [(1, 3.5), (2, 7)]]


def nextOrder(A, length):
    """Front and height of a slump of area A, length tau_y/(rho g), where the
    liquid yields in extension as it comes to rest: that takes pi/2 tau_y h off
    the thrust rho g h^2/2, whose fall along x is tau_y (the balance of Nye 1951,
    Proc. R. Soc. A 207; an expansion to third order: Dubash et al. 2009, J.
    Non-Newton. Fluid Mech. 158, not compared term by term). x = x0
    - h^2/(2 length) + pi/2 h, up to the front, where dx/dh = 0"""
    c = math.pi/2

    def slumpOf(H):
        h = np.linspace(c*length, H, 2001)
        x0 = H**2/(2*length) - c*H
        x = x0 - h**2/(2*length) + c*h
        return x[0]*h[0] + np.sum((x[1:] + x[:-1])/2)*(h[1] - h[0]), x[0]
    low, high = c*length, 100*length
    for _ in range(60):
        H = (low + high)/2
        area, front = slumpOf(H)
        low, high = (H, high) if area < A else (low, H)
    return front, H


def slump(path, h, mu=2.0, times=(4, 6), m=5, viscousStep="explicit",
          points=3):
    """A column of a Bingham liquid, 0.1 m x 0.1 m, that slumps to
    z^2 = 2 tau_y (L - x)/(rho g) [Liu and Mei 1989, J. Fluid Mech. 207], a
    balance without inertia"""
    A, stress = 0.01, 17.0
    L = (9*A**2*RHO*G/(8*stress))**(1/3)
    setup = Setup(
        cells=(round(0.6/h), round(0.12/h)), h=h, points=points,
        sides={"ymin": ("wall", "noSlip")}, wall="slip", energy=False,
        fluid={"mu": mu, "soundSpeed": 10}, water={
            "transfer": "XAPIC", "viscosityModel": "BinghamPapanastasiou",
            "BinghamPapanastasiouCoeffs": {"tau0": stress/RHO, "m": m},
            "viscousStep": viscousStep},
        regions={"column": hydrostatic((0, 0), (0.1, 0.1))})
    case = setup.until(times[-1], times[-1] - times[-2]).write(path).prepare()
    case.solve()
    z = np.sqrt(2*stress*L/(RHO*G))
    further = nextOrder(A, stress/(RHO*G))
    rows = []
    for t in times:
        p = case.points(f"{t:g}")
        x, y, V = p.x[:, 0], p.x[:, 1], p.mass*p.J/RHO/h
        columns = np.bincount((x/h).astype(int), V)/h
        centres = (np.arange(len(columns)) + 0.5)*h
        theory = np.sqrt(2*stress*np.maximum(0, L - centres)/(RHO*G))
        rows += [(f"front over theory's at {t:g} s", x.max()/L, "1 +- 5 %"),
                 (f"height over theory's at {t:g} s", y.max()/z, "1 +- 5 %"),
                 (f"front over that of the next order at {t:g} s",
                  x.max()/further[0], "1 +- 5 %"),
                 (f"height over that of the next order at {t:g} s",
                  y.max()/further[1], "1 +- 5 %"),
                 (f"rms error of the depth over theory's height at {t:g} s",
                  np.sqrt(np.mean((columns - theory)[centres < L]**2))/z,
                  "<= 0.05")]
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


def damBreak(path, ks, h=0.01, turbulence="kEpsilon", end=1.0):
    """A dam break, 0.4 m deep, over a rough bed that is dry"""
    h0, dam = 0.4, 2.0
    water = {"transfer": "XAPIC", "turbulence": turbulence}
    if turbulence == "kEpsilon":
        water["kEpsilonCoeffs"] = START
    bed = {"type": "roughWall", "ks": ks} if ks else "slip"
    setup = Setup(
        cells=(round((dam + (4.2*end if ks else 4))/h), round(0.45/h)), h=h,
        points=2, sides={"ymin": ("wall", bed)}, energy=False, water=water,
        regions={"reservoir": hydrostatic((0, 0), (dam, h0))})
    case = setup.until(end, 0.25).write(path).prepare()
    case.solve()

    def theory(t):
        return tip(t, h0, ks) if ks else 2*np.sqrt(G*h0)*t

    def front(t):
        """The first point, but for spray; where half a cell is full"""
        p = case.points(t)
        x = p.x[:, 0]
        columns = np.bincount((x/h).astype(int), p.mass*p.J/RHO/h)/h
        return (np.quantile(x, 0.9995) - dam,
                (np.flatnonzero(columns > h/2).max() + 1)*h - dam)

    # The speed: how long the front takes to form is not in the theory
    rows = []
    times = [float(t) for t in case.times]
    fronts = [front(t) for t in case.times]
    for i in range(2, len(times) - 1):
        there = [theory(t) for t in times[i:i + 2]]
        for k, name in enumerate(["front", "front that fills half a cell"]):
            rows.append((
                f"speed of the {name} over theory's, {times[i]:g} to "
                f"{times[i + 1]:g} s", (fronts[i + 1][k] - fronts[i][k])/(
                    there[1] - there[0]), "1 +- 5 %"))
    rows.append((f"front that fills half a cell over theory's at {end:g} s",
                 fronts[-1][1]/theory(end), "1 +- 5 %"))
    return rows


def meanFlow(case, times, x, dx, h, rows):
    """Mean velocity along x by height, in columns of width dx at x: an array
    of (position, row of cells)"""
    sums = np.zeros((2, len(x), rows))
    for t in times:
        p = case.points(t)
        j = (p.x[:, 1]/h).astype(int)
        for i, xi in enumerate(x):
            near = (np.abs(p.x[:, 0] - xi) < dx/2) & (j < rows)
            sums[0, i] += np.bincount(
                j[near], p.mass[near]*p.U[near, 0], minlength=rows)
            sums[1, i] += np.bincount(
                j[near], p.mass[near], minlength=rows)
    return sums[0]/np.maximum(sums[1], 1e-30)


class Step:
    """A step H in a duct of 5 H that becomes one of 6 H, with a lid that has no
    stress, Re = U H/nu = 5100; n cells per H. Reattachment at 6.28 H by direct
    simulation [Le, Moin and Kim 1997, J. Fluid Mech. 330], 6.0 measured [Jovic
    and Driver 1994, NASA TM 108807]. The boundary layer is thinner here. A
    level far above the outlet, under next to no gravity, keeps the pressure
    at rho U^2: below zero the water would part behind the step"""
    H, U, before, behind = 0.1, 1.0, 5, 16
    k, epsilon = 1e-3*U**2, 5e-4*U**3/H/10
    nu = U*H/5100

    def __init__(self, n, turbulence, bed="smoothWall", water=None):
        H, U = self.H, self.U
        level, g = 20.0, U**2/20
        self.n, self.h = n, H/n
        self.setup = Setup(
            cells=((self.before + self.behind)*n, 6*n), h=self.h, points=2,
            g=(0, -g, 0), solid=[((0, 0), (self.before*n, n))],
            sides={"xmin": ("patch", {"type": "fixedValue",
                                      "value": f"uniform ({U} 0 0)"}),
                   "xmax": ("patch", "zeroGradient"),
                   "ymax": ("wall", "slip")},
            wall={"type": bed}, energy=False,
            fluid={"mu": RHO*self.nu, "soundSpeed": 10*U},
            water={"turbulence": turbulence, "transfer": "XAPIC",
                   turbulence + "Coeffs": {
                       "k": self.k, "epsilon": self.epsilon},
                   "inflowOutflow": {
                       "inlets": {"left": {
                           "patch": "xmin", "velocity": (U, 0, 0),
                           "pointsPerDirection": 2}},
                       "outlets": {"right": {
                           "type": "patch", "patch": "xmax",
                           "waterLevel": level}}}, **(water or {})},
            regions={"low": box((self.before*H, 0), (10, H),
                                velocity=(0, 0, 0), pressure="hydrostatic",
                                level=level),
                     "duct": box((0, H), (10, 6*H), velocity=(U, 0, 0),
                                 pressure="hydrostatic", level=level)})

    def figures(self, x, floor, ahead, inner, k):
        """From positions behind the step and the velocity along the floor,
        the profile ahead (over the step) and behind, H and 3 H, and k"""
        back = np.flatnonzero((floor[:-1] < 0) & (floor[1:] >= 0))[-1]
        reached = x[back] + (x[back + 1] - x[back])*floor[back]/(
            floor[back] - floor[back + 1])
        thick = (np.flatnonzero(
            ahead > 0.95*ahead[2*self.n])[0] + 0.5)*self.h
        layer = [(u.max() - u.min())/np.diff(u[:2*self.n]).max()*self.h
                 for u in inner]
        return [("reattachment over H", reached/self.H, "6.28 +- 15 %"),
                ("height ahead of the step with 0.95 U over H",
                 thick/self.H, ""),
                ("largest speed back along the floor over U",
                 -floor.min()/self.U, ""),
                ("vorticity thickness at H over H", layer[0]/self.H, ""),
                ("vorticity thickness at 3 H over H", layer[1]/self.H, ""),
                ("largest k over U^2", k/self.U**2, "")]


def backwardStep(path, n, turbulence="kEpsilon", **entries):
    step = Step(n, turbulence, **entries)
    H, h, end = step.H, step.h, 70*step.H/step.U
    case = step.setup.until(end, end/60).write(path).prepare()
    case.solve()
    late = case.times[-21:]
    edge = step.before*H
    x = np.arange(0.25, step.behind - 2, 0.25)*H
    u = meanFlow(case, late, edge + x, 0.25*H, h, 6*n)
    ahead = meanFlow(case, late, [edge - H], 0.5*H, h, 6*n)[0][n:]
    inner = meanFlow(case, late, [edge + H, edge + 3*H], 0.25*H, h, 6*n)
    k = max(case.case.field(t, "k").max() for t in late)
    return step.figures(x, u[:, 0], ahead, inner, k)


def simpleFoamStep(path, n, turbulence):
    """What the model gives by itself: OpenFOAM's on the same mesh"""
    step = Step(n, turbulence)
    U, k, before = eulerian.solve(
        path, step.setup, turbulence, {"xmin": (step.U, 0, 0)},
        (step.U, 0, 0), step.k, step.epsilon, step.nu)
    if before is not None:
        raise AssertionError(f"{path}: simpleFoam did not converge")
    u, edge = U[..., 0], step.before*n
    x = (np.arange(step.behind*n) + 0.5)*step.h
    return step.figures(
        x, u[0, edge:], u[n:, edge - n], [u[:, edge + i*n] for i in (1, 3)],
        np.nanmax(k))


class WallJet:
    """A jet of height b from a slot along the floor, U b/nu = 5e4, n cells per
    b, into water that is still but for what feeds its entrainment: that comes
    down through the top at V, a little more than the jet takes up to the
    outlet, which is as high as the jet is there, so that nothing flows back. In
    a closed basin the return flow makes another jet of it. U_max = 3.5 U sqrt(b/x) [Rajaratnam 1976, Turbulent
    Jets]; its half width grows by 0.073 [Launder and Rodi 1983, Annu. Rev.
    Fluid Mech. 15], 0.068 [Rajaratnam], 0.076 [Ead and Rajaratnam 2004, J.
    Eng. Mech. 130]. Level and gravity as of Step"""
    b, U, slot, length, depth, opening = 0.05, 1.0, 2, 44, 15, 8
    nu, k, epsilon = 1e-6, 1e-4, 1e-4
    V = 1.2*U/length
    inlets = {"xmin": (U, 0, 0), "ymax": (0, -V, 0)}

    # Where the law holds, over b
    far = np.arange(15, 36)

    def __init__(self, n, turbulence, bed="smoothWall", water=None):
        b, U, slot = self.b, self.U, self.slot
        level, g = 20.0, U**2/20
        self.n, self.h = n, b/n
        self.setup = Setup(
            cells=((slot + self.length)*n, self.depth*n), h=self.h, points=2,
            g=(0, -g, 0), solid=[
                ((0, n), (slot*n, self.depth*n)),
                ((self.length*n, self.opening*n),
                 ((slot + self.length)*n, self.depth*n))],
            sides={"xmax": ("patch", "zeroGradient"), **{
                side: ("patch", {"type": "fixedValue",
                                 "value": f"uniform {foamText(velocity)}"})
                for side, velocity in self.inlets.items()}},
            wall={"type": bed}, energy=False, control=ASCII,
            fluid={"mu": RHO*self.nu, "soundSpeed": 10*U},
            water={"turbulence": turbulence, "transfer": "XAPIC",
                   turbulence + "Coeffs": {
                       "k": self.k, "epsilon": self.epsilon},
                   "inflowOutflow": {
                       "inlets": {side: {
                           "patch": side, "velocity": velocity,
                           "pointsPerDirection": 2}
                           for side, velocity in self.inlets.items()},
                       "outlets": {"right": {
                           "type": "patch", "patch": "xmax",
                           "waterLevel": level}}}, **(water or {})},
            regions={"all": box((0, 0), (10, 10), pressure="hydrostatic",
                                level=level)})

    def law(self, x, y):
        """Velocity, with the profile of Verhoff [Rajaratnam]"""
        x = np.maximum(x - self.slot*self.b, 0)/self.b
        eta = y/self.b/(0.068*(x + 10))
        jet = 1.48*eta**(1/7)*(1 - np.vectorize(math.erf)(0.68*eta))
        most = 3.5/np.sqrt(np.maximum(x, 12.25))
        core = (x < 12.25) & (y < self.b)
        return self.U*np.where(core, 1, most*jet)

    def figures(self, u):
        """From the velocity by distance (far) and row"""
        b, far, h = self.b, self.far, self.h
        top, most = u.argmax(axis=1), u.max(axis=1)
        half = np.empty(len(far))
        for i, row in enumerate(u):
            j = top[i] + np.flatnonzero(row[top[i]:] < most[i]/2)[0]
            half[i] = (j - 0.5 + (row[j - 1] - most[i]/2)/(
                row[j - 1] - row[j]))*h
        decay = most/self.U*np.sqrt(far)
        flux = [(row*h).sum()/(b*self.U) for row in u[[0, -1]]]
        return [("U_max sqrt(x/b)/U over 3.5, mean", decay.mean()/3.5,
                 "1 +- 10 %"),
                ("U_max sqrt(x/b)/U at 15 b", decay[0], "3.5 +- 10 %"),
                ("U_max sqrt(x/b)/U at 35 b", decay[-1], "3.5 +- 10 %"),
                ("growth of the half width", np.polyfit(far*b, half, 1)[0],
                 "0.073 +- 10 %"),
                ("half width at 15 b over b", half[0]/b, ""),
                ("half width at 35 b over b", half[-1]/b, ""),
                ("flow over that of the slot at 35 b", flux[1], "")]

    def steadiness(self, u, before):
        return [("U_max over that of before, mean",
                 (u.max(axis=1)/before.max(axis=1)).mean(), "1 +- 1 %")]


def wallJet(path, n, turbulence="kEpsilon", **entries):
    """From the law"""
    jet = WallJet(n, turbulence, **entries)
    b, h, end = jet.b, jet.h, 160*jet.b/jet.U
    case = jet.setup.until(end, end/60).write(path).prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = jet.law(x[:, 0], x[:, 1])
    setField(case, "U", U)
    case.solve()

    def at(times):
        return meanFlow(case, times, (jet.slot + jet.far)*b, b, h,
                        jet.depth*n)
    u, before = at(case.times[-21:]), at(case.times[-31:-21])
    return jet.figures(u) + jet.steadiness(u, before) + [
        ("largest k over U^2", max(case.case.field(t, "k").max()
                                   for t in case.times[-21:])/jet.U**2, "")]


def simpleFoamJet(path, n, turbulence):
    """As simpleFoamStep, but that the slow flow over the jet never rests"""
    jet = WallJet(n, turbulence)
    U, k, before = eulerian.solve(
        path, jet.setup, turbulence, jet.inlets, (0, 0, 0), jet.k, jet.epsilon,
        jet.nu)
    first = (jet.slot + jet.far)*n - n//2
    u, before = (np.array([U[:, i:i + n, 0].mean(axis=1) for i in first])
                 for U in (U, U if before is None else before))
    return jet.figures(u) + jet.steadiness(u, before) + [
        ("largest k over U^2", np.nanmax(k)/jet.U**2, "")]


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
    **{f"slump h={h*1e3:g} mm mu={mu:g} m={m:g}": within(
        slump, h, mu, times, m, "stages")
       for h, mu, m, times in [
           (0.005, 2, 100, (4, 6)), (0.005, 10, 100, (10, 20)),
           (0.0025, 2, 100, (4, 6)), (0.0025, 10, 100, (10, 20))]},
    **{f"slump h={h*1e3:g} mm mu=2 m=100 2 x 2 points": within(
        slump, h, 2, (2, 4), 100, "stages", points=2)
       for h in [0.005, 0.0025]},
    "gap BinghamPapanastasiou m=10 cells=32 XAPIC stages": within(
        gap, "XAPIC", "stages", m=10, cells=32),
    "gap BinghamPapanastasiou m=100 cells=32 XAPIC stages": within(
        gap, "XAPIC", "stages", m=100, cells=32),
    "slope cells=16 stages": within(slope, cells=16, viscousStep="stages"),
    "slope holds cells=16": within(slope, cells=16, yields=False),
    "spreading h=2.5 mm stages": within(spreading, 0.0025, "stages"),
    **{f"backward step n={n} {model}": within(backwardStep, n, model)
       for model in MODELS[:2] for n in [4, 8, 12]},
    **{f"backward step n={n} {model} simpleFoam": within(
        simpleFoamStep, n, model)
       for model in MODELS for n in [4, 8, 16, 32]},
    **{f"wall jet n={n} {model}": within(wallJet, n, model)
       for model in MODELS[:2] for n in [3, 4, 6]},
    **{f"wall jet n={n} {model} simpleFoam": within(simpleFoamJet, n, model)
       for model in MODELS for n in [3, 4, 6, 8, 12]},
    **{f"dam break ks=10 mm h={h*1e3:g} mm to {end:g} s": within(
        damBreak, 0.01, h, end=end) for h, end in [(0.01, 2), (0.005, 1.5)]},
    **{f"dam break ks={ks*1e3:g} mm h={h*1e3:g} mm{and_}":
       within(damBreak, ks, h, turbulence)
       for ks, h, turbulence, and_ in [
           (0, 0.01, "none", ""), (0.01, 0.01, "kEpsilon", ""),
           (0.01, 0.005, "kEpsilon", ""), (0.03, 0.01, "kEpsilon", ""),
           (0.01, 0.01, "none", " no turbulence")]}}


if __name__ == "__main__":
    figureTable.main(__doc__, HERE, HERE/"results"/"liquids.csv", RUNS)
