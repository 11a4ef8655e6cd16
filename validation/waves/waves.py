#!/usr/bin/env python3
"""Waves made by a piston and absorbed by a sponge: height over stroke of regular
waves, what the sponge reflects, how a solitary wave keeps its height, and its
run-up on a beach of 1:19.85 (Synolakis 1987).

    ./waves.py [--list] [name or pattern ...]

Writes results/waves.csv, a row for each run and figure, and results/waves.png; a
run whose rows are there is not made again."""

import shutil
import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

import bodies as shapes  # noqa: E402
import caseBuilder  # noqa: E402
from caseBuilder import G, RHO, Setup, box, hydrostatic  # noqa: E402
from mpmfoam import figureTable, reference, style  # noqa: E402
from mpmfoam.postProcessing import readDat  # noqa: E402

caseBuilder.TIMEOUT = 7200

RESULTS = HERE/"results"/"waves.csv"
SERIES = HERE/"results"/"series"

# Where the piston's face is at rest
FACE = 0.2


def paddle(h, top, **motion):
    return {"type": "prescribed",
            "surface": box((-2, -3*h), (FACE, top + 3*h)),
            "motion": {"type": "pistonWave", **motion}}


def gauges(x, interval):
    return {"gauges": {
        "type": "waveGauge", "cloud": "water",
        "libs": '("libmpmFunctionObjects.so")',
        "points": [(float(v), 0.0, 0.0) for v in x],
        "writeControl": "adjustableRunTime", "writeInterval": interval}}


def solve(name, setup):
    path = HERE/"runs"/name
    shutil.rmtree(path, ignore_errors=True)
    setup.energy = False
    case = setup.write(path)
    case.prepare()
    case.solve()
    return case


def heights(case, n):
    """Time, and columns of the gauges"""
    data = readDat(case.path, "gauges", "waveGauge.dat")
    return data[:, 0], data[:, 1:1 + n]


def keep(name, **columns):
    SERIES.mkdir(parents=True, exist_ok=True)
    reference.writeCsv(SERIES/f"{name}.csv", columns)


# --- regular waves --------------------------------------------------------

def waveNumber(omega, depth):
    k = omega/np.sqrt(G*depth)
    for _ in range(100):
        k = omega**2/(G*np.tanh(k*depth))*0.5 + 0.5*k
    return k


def incidentAndReflected(a, x, k):
    """Least squares of complex amplitudes at x (Mansard and Funke 1980, of one
    frequency)"""
    basis = np.stack([np.exp(-1j*k*x), np.exp(1j*k*x)], axis=1)
    return np.linalg.lstsq(basis, a, rcond=None)[0]


def regular(name, h, sponge, points=2):
    depth, height, period = 0.3, 0.06, 1.4
    omega = 2*np.pi/period
    k = waveNumber(omega, depth)
    kd = k*depth
    wave = 2*np.pi/k
    group = 0.5*omega/k*(1 + 2*kd/np.sinh(2*kd))
    ratio = 2*(np.cosh(2*kd) - 1)/(np.sinh(2*kd) + 2*kd)

    # Three gauges a wave length from the piston, then the sponge
    x = FACE + wave*np.array([1.0, 1.22, 1.5])
    begin, length = FACE + 2*wave, 1.5*wave
    end = h*round((begin + length)/h)
    water = {}
    if sponge:
        water["relaxationZones"] = {"beach": {
            "min": (begin, -1, -1), "max": (end, 2, 1),
            "direction": (1, 0, 0), "rate": 12*group/length}}

    # Where the gauges have the wave, and what comes back from the end
    periods = 3
    last = period*np.ceil((2*end - x[0])/group/period + 2)
    case = solve(name, Setup(
        cells=(round(end/h), round(0.45/h)), h=h, points=points, water=water,
        regions={"pool": hydrostatic((FACE, 0), (end, depth))},
        bodies={"piston": paddle(
            h, 0.45, wave="regular", height=height, depth=depth,
            period=period, rampTime=2*period)},
        functions=gauges(x, period/40)).until(last, last))
    t, eta = heights(case, 3)
    late = t > last - periods*period + 1e-9
    basis = np.exp(-1j*omega*t[late])
    a = 2*(eta[late]*basis[:, None]).mean(axis=0)
    incident, reflected = incidentAndReflected(a, x, k)
    keep(name, t=t, **{f"gauge{i + 1}": eta[:, i] for i in range(3)})

    stroke = height/ratio
    yield "reflected over incident height, %", \
        100*abs(reflected/incident), "<= 10" if sponge else "stated"
    if not sponge:
        return
    for i in range(3):
        yield f"H/S at gauge {i + 1} over theory", \
            2*abs(a[i])/stroke/ratio, "1 +- 5 %"
    yield "incident H/S over theory", 2*abs(incident)/stroke/ratio, "1 +- 5 %"
    yield "mean level at the gauges, % of H", \
        100*abs((eta[late] - depth).mean(axis=0)).max()/height, "stated"


# --- solitary wave --------------------------------------------------------

def crest(t, eta):
    """Time and height of the largest value, by a parabola through it"""
    i = int(np.argmax(eta))
    i = min(max(i, 1), len(eta) - 2)
    a, b, c = np.polyfit(t[i - 1:i + 2] - t[i], eta[i - 1:i + 2], 2)
    return t[i] - b/(2*a), c - b*b/(4*a)


def solitary(name, h, points=2, **water):
    depth, height = 0.3, 0.09
    speed = np.sqrt(G*(depth + height))
    first = 7*depth
    x = FACE + first + depth*np.array([0, 5, 10, 15, 20])
    end = h*round((x[-1] + 8*depth)/h)
    arrival = 1.4 + (x[-1] - FACE)/speed
    case = solve(name, Setup(
        cells=(round(end/h), round(0.48/h)), h=h, points=points, water=water,
        regions={"pool": hydrostatic((FACE, 0), (end, depth))},
        bodies={"piston": paddle(
            h, 0.48, wave="solitary", height=height, depth=depth)},
        functions=gauges(x, 0.01)).until(arrival + 0.5, arrival + 0.5))
    t, eta = heights(case, 5)
    eta -= depth
    keep(name, t=t, **{f"gauge{i + 1}": eta[:, i] for i in range(5)})
    crests = [crest(t, eta[:, i]) for i in range(5)]
    yield "height at 7 depths over that of the piston", \
        crests[0][1]/height, "stated"
    yield "height after 20 depths over that before, %", \
        100*crests[-1][1]/crests[0][1], ">= 97"
    celerity = 20*depth/(crests[-1][0] - crests[0][0])
    yield "celerity over sqrt(g (d + H))", \
        celerity/np.sqrt(G*(depth + crests[2][1])), "1 +- 2 %"


def column(points, x, h):
    """Height of the water above x [m], by hats of the width of two cells"""
    volume = points.mass*points.J/RHO
    near = np.maximum(0, 1 - abs(points.x[None, :, 0] - x[:, None])/h)
    return (near*volume).sum(axis=1)/h**2


def runUp(name, cellsOfDepth, points=2, **water):
    """H/d = 0.3. The time counts from when the crest is half a wave length
    before the toe of the beach."""
    depth, part, slope = 0.3, 0.3, 19.85
    h = depth/cellsOfDepth
    height = part*depth
    half = np.arccosh(np.sqrt(20))/np.sqrt(0.75*part)*depth
    beyond = 7*depth
    toe = h*round((FACE + 7*depth + half)/h)
    shore = toe + slope*depth
    cells = (round((shore + beyond)/h), round(1.8*cellsOfDepth))
    degrees = np.degrees(np.arctan(1/slope))
    unit = np.sqrt(depth/G)
    start = 1.55 + (toe - half - FACE - 4*depth)/np.sqrt(G*(depth + height))
    case = solve(name, Setup(
        cells=cells, h=h, points=points, water=water,
        regions={"pool": hydrostatic((FACE, 0), (shore, depth))},
        bodies={
            "piston": paddle(h, 1.8*depth, wave="solitary", height=height,
                             depth=depth),
            "beach": {"type": "fixed",
                      "surface": shapes.surface("beach.obj")}},
        surfaces={"beach.obj": shapes.prism(
            shapes.slope(degrees, (toe, 0), length=15))},
        functions=gauges([toe - half], 0.01)
    ).until(start + 27*unit, 0.25*unit))
    t, eta = heights(case, 1)
    eta = eta[:, 0] - depth
    t0, found = crest(t, eta)
    yield "height before the toe over that of the piston", \
        found/height, "stated"

    times = np.array([float(v) for v in case.times])
    for of in [15, 25]:
        measured = reference.data(f"exp_solitaryRunUp_H0.30_t{of}.csv")
        x, exact = measured["x_over_d"], measured["eta_over_d"]
        i = int(np.argmin(abs(times - (t0 + of*unit))))
        cloud = case.points(case.times[i])
        at = shore - x*depth
        bed = np.maximum(0, (at - toe)/slope)
        level = (bed + column(cloud, at, h) - depth)/depth
        keep(f"{name}_t{of}", x=x, eta=level, measured=exact)
        yield f"t = {of}: rms of the profile over the height, %", \
            100*np.sqrt(np.mean((level - exact)**2))/part, "<= 8"
    front = cloud.x[:, 0].max()
    yield "t = 25: front of the water over the depth, from the shore", \
        (front - shore)/depth, "stated"


CONTENTS = {
    **{f"regular_h{h:g}": (lambda n, h=h: regular(n, h, True))
       for h in [0.03, 0.02]},
    "regular_h0.03_wall": lambda n: regular(n, 0.03, False),
    **{f"solitary_h{h:g}": (lambda n, h=h: solitary(n, h))
       for h in [0.03, 0.02]},
    **{f"solitary_h{h:g}_XAPIC":
       (lambda n, h=h: solitary(n, h, transfer="XAPIC"))
       for h in [0.03, 0.02]},
    **{f"runUp_d{c}h": (lambda n, c=c: runUp(n, c)) for c in [10, 15]},
    "runUp_d10h_XAPIC": lambda n: runUp(n, 10, transfer="XAPIC"),
}


def series(pattern, values):
    """(value, columns, colour) of the files that are there"""
    found = []
    for value, colour in zip(values, style.COLOURS):
        path = SERIES/(pattern.format(value) + ".csv")
        if path.is_file():
            found.append((value, reference.readCsv(path), colour))
    return found


def drawRegular(ax):
    for h, s, colour in series("regular_h{:g}", [0.03, 0.02]):
        late = s["t"] > s["t"].max() - 3*1.4
        for i, line in enumerate(["-", "--", ":"]):
            ax.plot(s["t"][late], (s[f"gauge{i + 1}"][late] - 0.3)/0.06, line,
                    color=colour, label=f"h = {h:g} m, gauge {i + 1}")
    for y in [-0.5, 0.5]:
        ax.axhline(y, color="black", lw=0.6)
    ax.set(xlabel="t [s]", ylabel=r"$\eta/H$",
           title="regular waves before a sponge; linear theory: +- 0.5")
    ax.set_ylim(-0.7, 1)
    ax.legend(ncols=3, loc="upper center")


def drawSolitary(ax):
    for h, s, colour in series("solitary_h{:g}", [0.03, 0.02]):
        for i in range(1, 6):
            ax.plot(s["t"], s[f"gauge{i}"]/0.09, color=colour,
                    label=f"h = {h:g} m" if i == 1 else None)
    ax.axhline(1, color="black", lw=0.6)
    ax.set(xlabel="t [s]", ylabel=r"$\eta/H$", title=(
        "solitary wave at 7, 12, 17, 22 and 27 depths from the piston"))
    ax.legend()


def drawRunUp(ax):
    for of, lift in [(15, 0), (25, 0.3)]:
        runs = series("runUp_d{}h_t%d" % of, [10, 15])
        for c, s, colour in runs:
            order = np.argsort(s["x"])
            ax.plot(s["x"][order], s["eta"][order] + lift, color=colour,
                    label=f"d = {c} h" if of == 15 else None)
        if runs:
            s = runs[0][1]
            ax.plot(s["x"], s["measured"] + lift, "k.",
                    label="Synolakis 1987" if of == 15 else None)
    ax.invert_xaxis()
    ax.set(xlabel="x/d, from the shore", ylabel=r"$\eta/d$",
           title="run-up at t* = 15 and, 0.3 higher, 25")
    ax.legend()


def draw():
    """What there is of the series"""
    panels = [panel for name, panel in [
        ("regular", drawRegular), ("solitary", drawSolitary),
        ("runUp", drawRunUp)] if any(SERIES.glob(f"{name}*.csv"))]
    fig, axes = style.figure(len(panels), 1, height=2.3, squeeze=False)
    for panel, ax in zip(panels, axes[:, 0]):
        panel(ax)
    style.save(fig, HERE/"results"/"waves.png")


if __name__ == "__main__":
    figureTable.main(__doc__, HERE, RESULTS, CONTENTS)
    if SERIES.is_dir():
        draw()
