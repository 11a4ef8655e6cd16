"""Small scenes of water alone, each with the one figure in which the
dissipation, or the noise, of a transfer shows."""

import sys
from pathlib import Path

import numpy as np

REPOSITORY = Path(__file__).resolve().parents[2]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

from caseBuilder import G, RHO, Setup, box, hydrostatic  # noqa: E402
from liquids import ASCII, setField  # noqa: E402


def cellsPerWave(n, flow, transfer, mach=0.1, points=3, end=1, **entries):
    """A box of one wave length, cyclic all round, 1 m/s"""
    setup = Setup(
        cells=(n, n), h=1/n, points=points, g=(0, 0, 0), energy=False,
        regions={"all": box((0, 0), (1, 1))},
        fluid={"soundSpeed": 1/mach, "mu": 0}, water=transfer,
        control={**ASCII, "deltaT": 1e-5}, **entries)
    return setup.cyclic("x", "y").until(end, end/20), flow


def shearWave(x):
    k = 2*np.pi
    return np.stack([np.sin(k*x[:, 1]), 0*x[:, 1], 0*x[:, 1]], axis=1)


def taylorGreen(x):
    k = 2*np.pi
    a, b = k*x[:, 0], k*x[:, 1]
    return np.stack(
        [np.sin(a)*np.cos(b), -np.cos(a)*np.sin(b), 0*a], axis=1)


def decay(path, setup, flow, waves):
    """Viscosity, from the amplitude of the mode"""
    case = setup.write(path)
    case.prepare()
    U = flow(case.case.cloudField("0", "water", "x"))
    setField(case, "U", U)
    case.solve()
    t, a = [], []
    for name in case.times:
        p = case.points(name)
        mode = flow(p.x)
        t.append(float(name))
        a.append((p.mass*(p.U*mode).sum(axis=1)).sum()
                 / (p.mass*(mode**2).sum(axis=1)).sum())
    t, a = np.array(t), np.array(a)
    late = t > 0.1*t[-1]
    slope = np.polyfit(t[late], np.log(np.abs(a[late])), 1)[0]
    return {"nu": -slope/(waves*(2*np.pi)**2), "left": a[-1]/a[0],
            "t": list(t), "a": list(a)}


def sloshing(path, transfer, n=40, points=3, periods=4, **entries):
    """First mode of a tank, half as deep as long: loss per period"""
    length, depth = 1.0, 0.5
    h = length/n
    k = np.pi/length
    omega = np.sqrt(G*k*np.tanh(k*depth))
    T = 2*np.pi/omega
    setup = Setup(
        cells=(n, round(0.75*n)), h=h, points=points,
        regions={"pool": hydrostatic((0, 0), (length, depth))},
        water=transfer, energy=False, **entries,
        control=ASCII)
    case = setup.until((periods + 0.25)*T, T/40).write(path)
    case.prepare()
    # Through the rest position, as fast as linear theory has it
    x = case.case.cloudField("0", "water", "x")
    speed = omega*0.02
    U = np.stack([
        -speed*np.sin(k*x[:, 0])*np.cosh(k*x[:, 1])/np.sinh(k*depth),
        speed*np.cos(k*x[:, 0])*np.sinh(k*x[:, 1])/np.sinh(k*depth),
        0*x[:, 0]], axis=1)
    setField(case, "U", U)
    case.solve()
    t, c = [], []
    for name in case.times:
        p = case.points(name)
        t.append(float(name))
        c.append((p.mass*p.x[:, 0]).sum()/p.totalMass - length/2)
    t, c = np.array(t), np.array(c)
    c -= c[-160:].mean()
    # Peaks by parabola
    peaks = []
    for i in range(1, len(c) - 1):
        if abs(c[i]) >= abs(c[i - 1]) and abs(c[i]) > abs(c[i + 1]):
            a, b, d = c[i - 1], c[i], c[i + 1]
            s = 0.5*(a - d)/(a - 2*b + d)
            peaks.append((t[i] + s*(t[1] - t[0]), abs(b - 0.25*(a - d)*s)))
    tp, ap = np.array(peaks).T
    # Extremes are half a period apart
    return {"kept": float(np.exp(2*np.polyfit(
                np.arange(len(ap)), np.log(ap), 1)[0])),
            "period": float(2*np.polyfit(np.arange(len(tp)), tp, 1)[0]/T),
            "peaks": list(ap/ap[0])}


def opening(path, transfer, n=4, points=3, end=0.3, **entries):
    """Jet under a gate, n cells high: speed over Torricelli's, with the head
    over a contracted jet (tutorials/wallJet without soil)"""
    a, head = 0.05, 0.15
    h = a/n
    gate, thick = round(0.7/h), max(3, round(0.04/h))
    nx, ny = gate + thick + round(0.6/h), round(0.2/h)
    setup = Setup(
        cells=(nx, ny), h=h, points=points,
        solid=[((gate, n), (gate + thick, ny))],
        sides={"xmax": ("patch", "zeroGradient")},
        regions={"reservoir": hydrostatic((0, 0), (gate*h, head))},
        **{"fluid": {"soundSpeed": 14}, **entries}, water=transfer, energy=False)
    case = setup.until(end, end/6).write(path)
    case.prepare()
    case.solve()
    ratio = []
    for name in case.times[-3:]:
        p = case.points(name)
        x = p.x[:, 0] - (gate + thick)*h
        behind = (x > a) & (x < 2*a) & (p.x[:, 1] < a)
        back = (p.x[:, 0] < 0.5) & (p.x[:, 0] > 0.2)
        level = p.mass[back].sum()/(RHO*0.3*h)
        ratio.append(p.U[behind, 0].mean()
                     / np.sqrt(2*G*(level - 0.61*a)))
    return {"jet": float(np.mean(ratio))}


def poiseuille(path, transfer, n=16, Re=100, mach=0.1, points=3, **entries):
    """Flow through a gap of n cells over that of theory"""
    H, U = 1.0, 1.0
    nu = U*H/Re
    setup = Setup(
        cells=(8, n), h=H/n, points=points, g=(0, 0, 0),
        sides={side: ("wall", "noSlip") for side in ("ymin", "ymax")},
        fluid={"soundSpeed": U/mach, "mu": RHO*nu},
        water={"pressureGradient": (-RHO*8*nu*U/H**2, 0, 0), **transfer},
        regions={"channel": box((0, 0), (10, 1))}, energy=False,
        control=ASCII, **entries)
    case = setup.cyclic("x").until(5, 2.5).write(path)
    case.prepare()
    x = case.case.cloudField("0", "water", "x")
    U0 = np.zeros_like(x)
    U0[:, 0] = 4*U*x[:, 1]*(1 - x[:, 1])
    setField(case, "U", U0)
    case.solve()
    p = case.points()
    return {"flow": float((p.mass*p.U[:, 0]).sum()/p.totalMass/(2*U/3))}


def still(path, transfer, points=3, jitter=0.25, end=3, **entries):
    """Noise of the pressure over rho g H, rms speed over sqrt(g H)"""
    H, n = 0.5, 16
    setup = Setup(
        cells=(n, n + 4), h=H/n, points=points,
        placement={"placement": "jittered", "jitter": jitter, "seed": 1},
        regions={"pool": hydrostatic((0, 0), (H, H))}, water=transfer,
        energy=False, **entries)
    case = setup.until(end, end/15).write(path)
    case.prepare()
    case.solve()
    noise, speed = [], []
    for name in case.times[-7:]:
        p = case.points(name)
        noise.append(np.sqrt(np.mean(
            (p.p - RHO*G*(H - p.x[:, 1]))**2))/(RHO*G*H))
        speed.append(np.sqrt((p.U**2).sum(axis=1).mean()/(G*H)))
    return {"noise": float(np.mean(noise)), "speed": float(np.mean(speed)),
            "speedEnd": float(speed[-1])}


def dam(path, transfer, points=3, **entries):
    """Kinetic and potential energy at 1 s over the initial"""
    h = 0.01
    setup = Setup(
        cells=(50, 40), h=h, points=points,
        regions={"column": hydrostatic((0, 0), (0.2, 0.2))}, water=transfer,
        **entries)
    case = setup.until(1.0, 0.05).write(path)
    case.prepare()
    case.solve()
    e = case.energies()
    total = e["kinetic"] + e["potential"]
    t = e["time"]
    total = np.interp(1.0, t, total)/total[0]
    return {"energy": float(total)}
