"""Water problems with known answers, short; validation/water has the long
ones."""

import numpy as np
import pytest

from mpmfoam import reference, wave
from mpmfoam.postProcessing import readDat

from caseBuilder import G, RHO, Setup, box, hydrostatic
from checks import healthy


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


# --- water at rest --------------------------------------------------------

@pytest.mark.parametrize("dim, width, points", [
    (2, 0.5, 3), (2, 0.5, 4), (3, 0.125, 3),
    pytest.param(2, 1, 3, marks=pytest.mark.slow),
    pytest.param(2, 1, 4, marks=pytest.mark.slow)])
def testHydrostatic(tmp_path, figures, dim, width, points):
    """Column 0.5 m deep, h = depth/16, jittered points. The noise of the
    jitter is the largest at first; it settles within about 2 s."""
    depth, h, end = 0.5, 0.5/16, 5
    n = round(width/h)
    if dim == 2:
        cells, low, top = (n, 20), (0, 0), (width, depth)
    else:
        cells, low, top = (n, n, 20), (0, 0, 0), (width, width, depth)
        end = 0.5
    setup = Setup(cells=cells, h=h, points=points,
                  placement={"placement": "jittered"},
                  regions={"column": hydrostatic(low, top)})
    case = setup.until(end, write=0.05).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)

    up = dim - 1
    start = case.points("0")
    c = case.state("0")["soundSpeed"]
    noise, wall, against, shift = [], [], [], []
    for time in case.times:
        p = case.points(time)
        below = depth - p.x[:, up]
        # Tait's law at rest, and incompressible
        k, bulk = 6/7, c**2*RHO/7
        exact = bulk*((1 + k*RHO*G*np.maximum(below, 0)/bulk)**(1/k) - 1)
        exact = np.where(below > 0, exact, RHO*G*below)
        error = (p.p - exact)/(RHO*G*depth)
        side = np.any([(p.x[:, d] < h) | (p.x[:, d] > width - h)
                       for d in range(dim - 1)], axis=0)
        noise.append(rms(error))
        wall.append(rms(error[side | (p.x[:, up] < h)]))
        against.append(rms((p.p - RHO*G*below)/(RHO*G*depth)))
        shift.append(np.abs(p.centre - start.centre)[:dim].max()/depth)
    late = slice(len(noise)//2, None)
    figures.show("largest pressure noise over rho g H", max(noise))
    figures.atMost("mean noise of 0.25 to 0.5 s", np.mean(noise[5:11]), 0.01)
    figures.atMost(f"mean noise of {end/2} to {end} s", np.mean(noise[late]),
                   0.01)
    figures.atMost("the same in the cells next to walls",
                   np.mean(wall[late]), 0.01)
    figures.atMost("the same against rho g z", np.mean(against[late]), 0.01)
    figures.atMost("centre of mass: largest shift over depth", max(shift),
                   1e-3)


def testSmoothingIsNeeded(tmp_path, figures):
    """The noise that the bound above keeps out is there without smoothing"""
    depth, h = 0.5, 0.5/16
    noise = {}
    for smoothing in [True, False]:
        setup = Setup(cells=(16, 20), h=h, points=3,
                      placement={"placement": "jittered"},
                      mpm={"smoothing": smoothing},
                      regions={"column": hydrostatic((0, 0), (0.5, depth))})
        case = setup.until(0.5).write(tmp_path/str(smoothing)).prepare()
        case.solve()
        p = case.points()
        noise[smoothing] = rms((p.p - RHO*G*(depth - p.x[:, 1]))/(
            RHO*G*depth))
    figures.atLeast("noise without smoothing over noise with it",
                    noise[False]/noise[True], 2)


def testSloshingKeepsItsLevel(tmp_path, figures):
    """The first mode of a tank at a tenth of the depth for 1e4 steps;
    validation/water/sloshing makes 1e5. Mean level: the volume that the grid
    sees, as mean over periods."""
    length, depth, h, end = 0.5, 0.25, 0.25/8, 10
    x = np.linspace(length, 0, 201)
    outline = [(0, 0), (length, 0)] + [
        (float(v), float(depth*(1 + 0.1*np.cos(np.pi*v/length)))) for v in x]
    setup = Setup(cells=(16, 12), h=h, points=3, regions={"wave": {
        "type": "polygon", "points": outline, "pressure": "hydrostatic",
        "level": depth}})
    setup.functions["gauge"] = {
        "type": "waveGauge", "points": [(0.5*h, 0, 0.5*h)],
        "libs": '("libmpmFunctionObjects.so")', "cloud": "water",
        "writeControl": "adjustableRunTime", "writeInterval": 0.02}
    case = setup.until(end, write=end/4).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)
    rows = readDat(case.path, "gauge", "waveGauge.dat")
    t, level = rows[:, 0], rows[:, -1]/rows[0, -1] - 1
    window = 1.7        # s, two periods
    means = [level[(t >= a) & (t < a + window)].mean()
             for a in np.arange(0, end - window, window)]
    swing = np.ptp(rows[t > end - window, 1])
    figures.show("swing at the wall in the end over depth", swing/depth)
    figures.atMost("mean level: largest change", np.abs(means).max(), 3e-3)


# --- standing wave --------------------------------------------------------

def standingWave(path, h):
    """L 1, depth 0.5, mode 1, amplitude 0.01, c = 30 sqrt(g depth); two
    periods. Amplitude over time from the centre of mass: a surface
    a cos(pi x/L) shifts it by -2 a L/(pi^2 depth)."""
    length, depth, amplitude = 1, 0.5, 0.01
    x = np.linspace(length, 0, 401)
    outline = [(0, 0), (length, 0)] + [
        (float(v), float(depth + amplitude*np.cos(np.pi*v)))
        for v in x]
    setup = Setup(
        cells=(round(1/h), round(0.6/h)), h=h, points=3,
        fluid={"soundSpeed": 30*np.sqrt(G*depth), "mu": 0},
        regions={"wave": {
            "type": "polygon", "points": outline, "pressure": "hydrostatic",
            "level": depth}})
    case = setup.until(2.36, write=0.04).write(path).prepare()
    case.solve()
    times = case.times
    centre = np.array([case.points(t).centre[0] for t in times])
    return np.array(times, dtype=float), \
        (length/2 - centre)*np.pi**2*depth/(2*length**2), case


def testStandingWave(tmp_path, figures):
    table = reference.data("ana_standing_wave_periods.csv")
    row = (table["L"] == 1) & (table["h"] == 0.5) & (table["m"] == 1)
    omega = table["omega"][row][0]
    rates = {}
    for h, bound in [(0.05, 0.02), (0.025, 0.01)]:
        t, a, case = standingWave(tmp_path/f"h{h}", h)
        w, rate, start, rest = wave.fit(t, a, omega)
        rates[h] = rate
        figures.show(f"h {h}: amplitude of the fit, residual over it",
                     f"{start:.4g} m, {rest:.2g}")
        figures.atMost(f"h {h}: error of the period", abs(omega/w - 1),
                       bound)
        # The fit follows what it is fitted to
        figures.atMost(f"h {h}: residual", rest, 0.1)
        healthy(figures, case)
    figures.show("damping rates", ", ".join(
        f"{r:.3g} 1/s at h {h}" for h, r in rates.items()))
    figures.atMost("damping rate at h 0.025 over that at h 0.05",
                   rates[0.025]/rates[0.05], 0.5)


# --- channel flow ---------------------------------------------------------

HEIGHT, NU, SPEED = 1e-3, 1e-6, 1e-3


@pytest.mark.parametrize("transfer", ["APIC", "XPIC"])
@pytest.mark.parametrize("flow", ["couette", "poiseuille"])
def testChannel(tmp_path, figures, flow, transfer):
    """Start-up at nu t/H^2 = 0.1 and 0.5, 16 cells; Re = 1"""
    force = 8*NU*SPEED/HEIGHT**2 if flow == "poiseuille" else 0
    sides = {"ymin": ("wall", "noSlip"), "ymax": ("wall", "noSlip")}
    if flow == "couette":
        sides["ymax"] = ("wall", {
            "type": "fixedValue", "value": f"uniform ({SPEED} 0 0)"})
    setup = Setup(
        cells=(8, 16), h=HEIGHT/16, points=4, g=(force, 0, 0), sides=sides,
        fluid={"soundSpeed": 0.02}, water={"transfer": transfer},
        regions={"channel": box((0, 0), (1, 1))}).cyclic("x")
    case = setup.until(0.5, write=0.1).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case, energy=False)

    exact = reference.data("ana_couette_poiseuille_startup.csv")
    column = {"couette": "u_couette_over_U",
              "poiseuille": "u_poiseuille_over_umax"}[flow]
    for number in [0.1, 0.5]:
        row = exact["T"] == number
        assert row.sum() == 11
        p = case.points(f"{number*HEIGHT**2/NU:g}")
        y = p.x[:, 1]/HEIGHT
        u = p.U[:, 0]/SPEED
        # Points stay in their rows, four to a cell
        rows = np.array_split(np.argsort(y, kind="stable"), 64)
        mean = np.interp(exact["y_over_H"][row][1:-1],
                         [y[r].mean() for r in rows],
                         [u[r].mean() for r in rows])
        error = np.abs(mean - exact[column][row][1:-1]).max()
        figures.atMost(f"nu t/H^2 = {number}: largest error of u over U",
                       error, 0.01)
        figures.atMost("speed across the channel over U",
                       np.abs(p.U[:, 1]).max()/SPEED, 0.01)


# --- elliptical drop ------------------------------------------------------

@pytest.mark.parametrize("h", [0.1, 0.05])
def testEllipticalDrop(tmp_path, figures, h):
    """Round drop, v = A0 (-x, y), no gravity: axes to A0 t = 0.5"""
    nx, ny = round(2.6/h), round(3.6/h)
    setup = Setup(
        cells=(nx, ny), h=h, origin=(-nx*h/2, -ny*h/2, 0), points=4,
        g=(0, 0, 0), fluid={"soundSpeed": 30, "mu": 0},
        regions={"drop": {
            "type": "cylinder", "point1": (0, 0, -1), "point2": (0, 0, 1),
            "radius": 1, "centre": (0, 0, 0),
            "velocityGradient": (-1, 0, 0, 0, 1, 0, 0, 0, 0)}})
    case = setup.until(0.5, write=0.1).write(tmp_path/"case").prepare()
    case.solve()
    healthy(figures, case)
    exact = reference.data("ana_elliptical_drop.csv")
    errors = []
    for time in case.times:
        p = case.points(time)
        # An ellipse with the second moments of the points
        axes = 2*np.sqrt((p.mass[:, None]*(p.x - p.centre)**2).sum(axis=0)
                         / p.totalMass)[:2]
        row = np.isclose(exact["A0t"], float(time))
        assert row.sum() == 1
        errors.append(np.abs(axes/[exact["a"][row][0],
                                   exact["b"][row][0]] - 1).max())
    figures.show("error at the start", errors[0])
    figures.atMost("largest error of an axis", max(errors), 0.02)
    end, start = case.points(), case.points("0")
    scale = (start.mass[:, None]*np.abs(start.U)).sum()
    figures.atMost("momentum over sum of m |U|",
                   np.abs(end.momentum - start.momentum).max()/scale, 1e-12)
