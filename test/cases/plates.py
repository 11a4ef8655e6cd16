"""Thin plates: bodies for caseBuilder, and on which side of them points are."""

import re

import numpy as np

from caseBuilder import G, RHO, Setup, hydrostatic

LEVEL = 0.2


def plate(start, end, thickness, **entries):
    """A fixed plate"""
    def point(x):
        return tuple(float(c) for c in x) + (0.0,)*(3 - len(x))
    across = {"across": entries.pop("across")} if "across" in entries else {}
    return {"type": "fixed", "surface": {
        "type": "plate", "start": point(start), "end": point(end),
        "thickness": thickness, **across}, **entries}


def moving(body, displacement=(0, 0), degrees=0, centre=(0, 0), time=1.0):
    """A plate that goes that far, and turns by so much, in a time, evenly"""
    def table(x):
        values = " ".join(f"{v:.15g}" for v in x)
        return f"table ((0 (0 0 0)) ({time} ({values})))"
    return {**body, "type": "prescribed", "motion": {
        "displacement": table((*displacement, *(0,)*(3 - len(displacement)))),
        "rotation": table((0, 0, degrees)),
        "centre": (*centre, *(0,)*(3 - len(centre)))}}


def placed(start, end, time, displacement=(0, 0), degrees=0, centre=(0, 0)):
    """Start and end of its middle line then, of one that goes a second"""
    t = np.radians(degrees*time)
    turn = np.array([[np.cos(t), -np.sin(t)], [np.sin(t), np.cos(t)]])
    return [np.array(centre) + np.array(displacement)*time
            + turn @ (x - np.array(centre)) for x in [start, end]]


def inclined(foot, degrees, length):
    """Start and end of a plate that rises from its foot"""
    t = np.radians(degrees)
    foot = np.array(foot, dtype=float)
    return foot, foot + length*np.array([np.cos(t), np.sin(t)])


def height(x, start, end):
    """Distance from the middle plane, positive to the left of the way from
    start to end"""
    along = (end - start)/np.linalg.norm(end - start)
    return (x[:, :2] - start) @ np.array([-along[1], along[0]])


def polygon(*corners, **entries):
    """A region"""
    return {"type": "polygon", "points": [tuple(float(v) for v in c) for c in corners],
            **entries}


def oneSided(thickness, degrees, h=0.02, end=0.5):
    """Still water of 0.2 m to the left of a plate, nothing to the right of it;
    the setup, and the plate"""
    level, foot = LEVEL, 0.4
    t = np.radians(degrees)
    start, end_ = inclined((foot, 0), degrees, 0.3/np.sin(t))
    top = foot + level/np.tan(t)
    volume = 0.5*level*(foot + top) - 0.5*thickness*h*level/np.sin(t)
    return Setup(
        cells=(round(0.8/h), round(0.3/h)), h=h, regions={"pool": polygon(
            (0, 0), (foot, 0), (top, level), (0, level),
            pressure="hydrostatic", level=level)},
        bodies={"plate": plate(start, end_, thickness*h)},
        energy=False).until(end, end/5), start, end_, volume*h


def forces(case, cloud="water"):
    """Force on the plate at the entries of the log [N]"""
    text = (case.path/"log.mpmFoam").read_text()
    found = re.findall(
        rf"body plate:.*?force of {cloud} \(([^)]*)\)", text)
    return np.array([[float(v) for v in f.split()] for f in found])


def oneSidedFigures(case, thickness, start, end):
    """Nearest point to the face over h, rms speed [m/s], noise of the pressure
    at the plate over rho g H, the largest in time; force on the plate over
    rho g H^2/2"""
    h, speeds, nearest, noise = case.setup.h, [], [], []
    for time in case.times[1:]:
        points = case.points(time)
        eta = height(points.x, start, end) - 0.5*thickness*h
        depth = LEVEL - points.x[:, 1]
        wall = (eta < 1.5*h) & (depth > 1.5*h)
        noise.append(np.sqrt(np.mean((points.p - RHO*G*depth)[wall]**2)))
        speeds.append(np.sqrt((points.U**2).sum(axis=1).mean()))
        nearest.append(eta.min()/h)
    F = forces(case)
    return (min(nearest), max(speeds), max(noise)/(RHO*G*LEVEL),
            F[len(F)//2:].mean(axis=0)/(0.5*RHO*G*LEVEL**2*h))


def motions(degrees):
    """Ways of a plate of blobs() in a second"""
    t = np.radians(degrees)
    along = np.array([np.cos(t), np.sin(t)])
    return {"along": {"displacement": 2*along},
            "across": {"displacement": 0.5*np.array([along[1], -along[0]])},
            "turning": {"degrees": -120, "centre": (0.4, 0)}}


def blobs(thickness, degrees, sides, soil=False, steps=100, motion=None):
    """Without gravity: what is on the left hits the plate, what is on the right
    touches it"""
    h = 0.02
    t = np.radians(degrees)
    start, end = inclined((0.4, 0), degrees, 0.4/np.sin(t))
    at = [start[0] + y/np.tan(t) for y in (0.12, 0.28)]
    regions = {
        "left": polygon((0.15, 0.12), (at[0], 0.12), (at[1], 0.28),
                        (0.15, 0.28), velocity=(1, 0.5, 0)),
        "right": polygon((at[0], 0.12), (0.7, 0.12), (0.7, 0.28),
                         (at[1], 0.28))}
    kind = "soilRegions" if soil else "regions"
    fluid = {} if soil else {"fluid": {"soundSpeed": 20}}
    return Setup(
        cells=(45, 20), h=h, g=(0, 0, 0), points=2,
        **{"regions": {}, **fluid,
           kind: {side: regions[side] for side in sides}},
        soil={} if not soil else {
            "constitutiveModel": "linearElastic", "linearElasticCoeffs": {
                "rhoS": 2650, "e0": 0.6, "d": 1e-3, "E": 2e5, "nu": 0.2}},
        bodies={"plate": (moving if motion else dict)(
            plate(start, end, thickness*h, **(
                {"soil": {"frictionCoefficient": 0.5}} if soil else {})),
            **(motion or {}))},
        mpm={"logInterval": 1} if motion else {},
        control={"adjustTimeStep": False, "deltaT": 4e-4},
        energy=False).steps(steps), start, end


def gate(kind, end=0.3, h=0.02):
    """A dam breaks as a gate is lifted, a box of 0.05 m or a plate of 2 mm, or
    without one"""
    face = {"box": 0.275, "plate": 0.3, "none": 0.3}[kind]
    body = {
        "box": {"surface": {"type": "box", "min": (face, -0.1, -1),
                            "max": (face + 0.05, 0.36, 1)}},
        "plate": plate((0.3, 0), (0.3, 0.36), 0.002), "none": {}}[kind]
    return Setup(
        cells=(round(1.2/h), round(0.6/h)), h=h, points=2,
        origin=(face - 0.26, 0, 0),
        regions={"reservoir": hydrostatic((0, 0), (face, 0.26))},
        bodies={"gate": moving(body, (0, 0.6), time=0.4)} if body else {},
        energy=False).until(end, 0.05), face


def released(case, face):
    """How far the front is from where the water stood [m], and what is beyond
    0.05 m from there [m2]"""
    p = case.points()
    return p.x[:, 0].max() - face, (
        (p.mass*p.J)[p.x[:, 0] > face + 0.05].sum()/RHO/case.setup.h)


def sluice(thickness, end, x=0.6, opening=0.06):
    """Water leaves below a plate"""
    h, level = 0.01, 0.3
    return Setup(
        cells=(100, 34), h=h, points=2,
        regions={"pool": hydrostatic((0, 0), (x, level))},
        bodies={"plate": plate((x, opening), (x, 0.4), thickness*h)},
        sides={"xmax": ("patch", "zeroGradient")},
        energy=False).until(end, 0.05), level, opening


def discharge(case, level, opening, x=0.6):
    """Over that of Torricelli's law with a contraction of 0.61, of the second
    half of the time"""
    volumes = []
    for time in case.times:
        p = case.points(time)
        behind = p.x[:, 0] < x
        volumes.append((p.mass*p.J)[behind].sum()/RHO/case.setup.h)
    q = -np.diff(volumes)/np.diff([float(t) for t in case.times])
    H = np.array(volumes)[1:]/x
    exact = 0.61*opening*np.sqrt(2*G*H/(1 + 0.61*opening/H))
    return (q/exact)[len(q)//2:].mean()
