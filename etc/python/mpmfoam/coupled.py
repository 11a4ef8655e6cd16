"""Problems of water with soil that have known answers: the answers, and how a
case is measured against them. A case is read as its dictionaries have it, so
that a tutorial can be changed. Lengths in m, times in s, pressures in Pa; all
in x and y, gravity along -y."""

import re
from pathlib import Path

import numpy as np

from . import foamFile, reference
from .postProcessing import readDat

G = 9.81


# --- a case as numbers ----------------------------------------------------

def _text(case, path):
    """A dictionary without comments"""
    return re.sub(r"//.*", "", (Path(case.path)/path).read_text())


def entry(case, path, keyword):
    """The first number behind a keyword of a dictionary, by its text"""
    found = re.search(rf"\b{keyword}\s+([-+0-9.e]+)", _text(case, path))
    if not found:
        raise foamFile.FoamFileError(f"{case.path}/{path}: no {keyword}")
    return float(found[1])


def spacing(case):
    return entry(case, "system/blockMeshDict", "h")


def box(case, region):
    """Lower and upper corner of a region of setMaterialPointsDict"""
    path = "system/setMaterialPointsDict"
    number = r"\s*([-+0-9.e]+)"
    found = re.search(
        rf"\b{region}\s*{{[^}}]*?\bmin\s+\({number}{number}"
        rf"[^}}]*?\bmax\s+\({number}{number}", _text(case, path))
    if not found:
        raise foamFile.FoamFileError(f"{case.path}/{path}: no {region}")
    values = np.array(found.groups(), dtype=float)
    return values[:2], values[2:]


def gravity(case):
    """Along -y"""
    return -float(re.search(r"value\s+\(\s*\S+\s+(\S+)",
                            _text(case, "constant/g"))[1])


def drag(case):
    return re.search(r"\bdrag\s+(\w+)", _text(
        case, "constant/materialPointProperties"))[1]


class Medium:
    """Water and grains of a case"""

    def __init__(self, case):
        get = lambda k: entry(case, "constant/materialPointProperties", k)
        self.rho, self.mu = get("rho0"), get("mu")
        self.rhoS, self.d, self.e = get("rhoS"), get("d"), get("e0")

    @property
    def n(self):
        """Porosity"""
        return self.e/(1 + self.e)

    def ergun(self, q, n=None):
        """Pressure gradient that a discharge q per area needs"""
        n = self.n if n is None else n
        return (150*self.mu*(1 - n)**2/(n**3*self.d**2)*q
                + 1.75*self.rho*(1 - n)/(n**3*self.d)*q*np.abs(q))

    def discharge(self, gradient, n=None):
        """The inverse of ergun"""
        n = self.n if n is None else n
        a = 150*self.mu*(1 - n)**2/(n**3*self.d**2)
        b = 1.75*self.rho*(1 - n)/(n**3*self.d)
        return 2*gradient/(a + np.sqrt(a**2 + 4*b*gradient))


def points(case, time, cloud):
    """Positions and velocities"""
    return (case.cloudField(time, cloud, "x"),
            case.cloudField(time, cloud, "U"))


def rms(values):
    return float(np.sqrt(np.mean(np.square(values))))


def rmsSpeed(case, time, cloud):
    return float(np.sqrt((points(case, time, cloud)[1]**2)
                         .sum(axis=1).mean()))


def massError(case):
    """Largest change of mass of a cloud, over its mass at the start, with
    what left through openings counted in"""
    times = case.times()
    worst = 0.0
    for cloud in ["water", "soil"]:
        total = [case.cloudField(t, cloud, "mass").sum()
                 + case.cloudState(t, cloud)["leftMass"]
                 for t in (times[0], times[-1])]
        worst = max(worst, abs(total[1]/total[0] - 1))
    return worst


def energyGrowth(case):
    """Largest climb of the energy in water and soil together (kinetic,
    potential from the lowest that it was, elastic), over its initial value"""
    rows = [readDat(case.path, f"energy{c}", "energy.dat")
            for c in ("Water", "Soil")]
    n = min(map(len, rows))
    potential = sum(r[:n, 2] for r in rows)
    total = sum(r[:n, 1] + r[:n, 3] for r in rows) + potential
    scale = total[0] - potential.min()
    return float((total - np.minimum.accumulate(total)).max()
                 /max(scale, np.abs(total[0])*1e-3))


# --- seepage --------------------------------------------------------------

def seepage(case, after):
    """Flow around a column that is joined at its ends, with a bed in it. Mean
    over the times from `after` on of the discharge, and of the pressure
    gradient three cells and more inside of the bed."""
    m, h = Medium(case), spacing(case)
    lower, upper = box(case, "bed")
    whole = np.allclose([lower, upper], box(case, "all"))
    skin = -h if whole else 3*h
    q, gradient = [], []
    for time in case.times():
        if float(time) < after:
            continue
        x, v = points(case, time, "water")
        p = case.cloudField(time, "water", "p")
        here = (x[:, 1] > lower[1] + skin) & (x[:, 1] < upper[1] - skin)
        q.append(-m.n*v[here, 1].mean())
        gradient.append(np.polyfit(x[here, 1], p[here], 1)[0]
                        + m.rho*gravity(case))
    discharge, slope = np.mean(q), np.mean(gradient)
    # What the body force would drive through a bed with sharp ends
    share = (upper[1] - lower[1])/(box(case, "all")[1][1]
                                   - box(case, "all")[0][1])
    sharp = m.discharge(m.rho*gravity(case)/share)
    return {"discharge": discharge, "gradient": slope,
            "gradientError": slope/m.ergun(discharge) - 1,
            "dischargeExcess": discharge/sharp - 1, "times": len(q)}


# --- settling -------------------------------------------------------------

def settlingSpeed(medium, ns, law="DarcyForchheimer", g=G):
    """Speed of grains in a closed vessel, where the discharges of grains and
    water cancel: f = n_s n_w (rho_s - rho) g"""
    nw = 1 - ns
    load = ns*nw*(medium.rhoS - medium.rho)*g

    def drag(w):
        rho, mu, d = medium.rho, medium.mu, medium.d
        if law == "Gidaspow" and ns <= 0.2:
            Re = nw*rho*d*w/mu
            if Re < 1000:
                return (18*mu*ns/d**2*(1 + 0.15*Re**0.687)*nw**-2.65)*w
            return 0.75*0.44*rho*ns*nw/d*nw**-2.65*w*w
        return (150*mu*ns**2/(nw*d**2)*w + 1.75*rho*ns/d*w*w)

    low, high = 0.0, 10.0
    for _ in range(200):
        w = 0.5*(low + high)
        low, high = (w, high) if drag(w) < load else (low, w)
    return nw*w


def settling(case, part=(0.4, 0.75)):
    """Mean speed of fall of the grains that began in a part of the height,
    over the second and third quarter of the times: after the sound of the
    start, before the deposit has grown to them"""
    (_, bottom), (_, top) = box(case, "suspension")
    part = [bottom + s*(top - bottom) for s in part]
    ids = case.cloudField("0", "soil", "id")
    y0 = dict(zip(ids, case.cloudField("0", "soil", "x")[:, 1]))
    heights = []
    for time in case.times():
        y = case.cloudField(time, "soil", "x")[:, 1]
        start = np.array([y0[i] for i in
                          case.cloudField(time, "soil", "id")])
        here = (start > part[0]) & (start < part[1])
        heights.append((float(time), y[here].mean()))
    end = heights[-1][0]
    t, y = np.array([r for r in heights
                     if 0.25*end <= r[0] <= 0.75*end]).T
    m = Medium(case)
    # Solid fraction: the void ratio of the region stands for it
    ns = 1/(1 + entry(case, "system/setMaterialPointsDict", "voidRatio"))
    speed = float(-np.polyfit(t, y, 1)[0])
    exact = settlingSpeed(m, ns, drag(case), gravity(case))
    return {"speed": speed, "exact": exact, "error": speed/exact - 1,
            "course": np.array(heights)}


# --- consolidation --------------------------------------------------------

def terzaghi(Z, T):
    """Pore pressure over u0 at depth Z below the drained top, and degree of
    consolidation, at the time factor T"""
    k = np.arange(400)[:, None]
    M = np.pi*(2*k + 1)/2
    decay = np.exp(-M**2*T)
    p = (2/M*np.sin(M*np.atleast_1d(Z)[None, :])*decay).sum(axis=0)
    return p, float(1 - (2/M**2*decay).sum())


class Consolidation:
    """A layer of height H on a smooth base, drained at its top; the start is
    p = u0 and a total stress of zero"""

    def __init__(self, case):
        self.case = case
        self.H = box(case, "layer")[1][1]
        self.u0 = entry(case, "system/setMaterialPointsDict", "p")
        self.cells = round(self.H/spacing(case))
        m = Medium(case)
        get = lambda k: entry(case, "constant/materialPointProperties", k)
        E, nu, c = get("E"), get("nu"), get("soundSpeed")
        self.modulus = E*(1 - nu)/((1 + nu)*(1 - 2*nu))
        # Darcy: Ergun's law at small discharges
        self.permeability = m.n**3*m.d**2/(150*m.mu*(1 - m.n)**2)
        self.stiffnessRatio = m.rho*c**2/m.n/self.modulus
        # Water that is not quite incompressible stores some as well
        self.cv = self.permeability*self.modulus/(1 + 1/self.stiffnessRatio)
        self.finalSettlement = self.u0*self.H/self.modulus

    def at(self, time):
        """Pore pressure by cell from the base up, mean of the points of each;
        its error; oscillation at the base; settlement"""
        x, _ = points(self.case, time, "water")
        p = self.case.cloudField(time, "water", "p")
        cells, h = self.cells, self.H/self.cells
        cell = (x[:, 1]/h).astype(int)
        mean = np.array([p[cell == i].mean() for i in range(cells)])
        y = np.array([x[cell == i, 1].mean() for i in range(cells)])
        T = self.cv*float(time)/self.H**2
        exact, degree = terzaghi(1 - y/self.H, T)
        error = mean/self.u0 - exact
        # From cell to cell: what a straight line through its neighbours
        # does not explain, in the lowest quarter
        bend = error[1:-1] - 0.5*(error[:-2] + error[2:])
        s = points(self.case, time, "soil")[0][:, 1]
        s0 = self.case.cloudField("0", "soil", "x")[:, 1]
        top = lambda y: np.sort(y)[-len(y)//(4*cells):].mean()
        return {"T": T, "y": y, "p": mean/self.u0, "exact": exact,
                "rms": rms(error), "error": error,
                "oscillation": float(np.abs(bend[:max(2, cells//4)]).max()),
                "settlement": (top(s0) - top(s))/self.finalSettlement,
                "degree": degree}


# --- beds at rest ---------------------------------------------------------

def bedAtRest(case, time):
    """Speeds, pore pressure against rho g z, and the bed's surface"""
    m, h = Medium(case), spacing(case)
    level, bed = (box(case, name)[1][1] for name in ("all", "bed"))
    x, v = points(case, time, "water")
    p = case.cloudField(time, "water", "p")
    exact = m.rho*G*(level - x[:, 1])
    pores = x[:, 1] < bed
    regime = case.cloudField(time, "soil", "regime")
    profile = np.genfromtxt(
        Path(case.path)/"postProcessing"/"scour"/time/"profile.csv",
        delimiter=",", names=True)
    noise = (p - exact)/exact.max()
    return {"vRmsSoil": rmsSpeed(case, time, "soil"),
            "vRmsWater": rmsSpeed(case, time, "water"),
            "poreNoise": rms(noise[pores] - noise[pores].mean()),
            "poreNoiseMax": float(np.abs(noise[pores]
                                         - noise[pores].mean()).max()),
            "poreOffset": float(noise[pores].mean()),
            "bedChange": float(np.abs(profile["bed"] - bed).max()/h),
            "suspended": int((regime == 2).sum()),
            "separated": int((regime == 3).sum())}


# --- wetting front --------------------------------------------------------

def wettingCourse(case, steps=4000):
    """Depth of the front below the surface of a dry column over time, under
    a pond: Ergun at the gradient rho g (pond left + wet depth)/wet depth"""
    medium = Medium(case)
    depth = box(case, "column")[1][1] - box(case, "column")[0][1]
    pond = box(case, "pond")[1][1] - box(case, "pond")[0][1]
    z = depth*np.linspace(0, 1, steps + 1)[1:]
    left = pond - medium.n*z
    # Ends where the pond is empty
    q = medium.discharge(medium.rho*G*(np.maximum(left, 0) + z)/z)
    t = np.concatenate([[0], np.cumsum(
        medium.n*np.diff(np.concatenate([[0], z]))/q)])
    return t, np.concatenate([[0], z])


def wettingFront(case, time):
    """Mean depth of the front, from the volume of the water below the surface;
    by column of cells how far the lowest water is ahead of the mean; and the
    largest speed in the sand"""
    m, h = Medium(case), spacing(case)
    lower, upper = box(case, "column")
    x, v = points(case, time, "water")
    mass = case.cloudField(time, "water", "mass")
    inside = x[:, 1] < upper[1]
    column = np.floor((x[:, 0] - lower[0])/h).astype(int)
    width = upper[0] - lower[0]
    mean = mass[inside].sum()/(m.rho*m.n*h*width)
    lowest = np.array([x[column == i, 1].min()
                       for i in range(round(width/h))])
    return {"depth": mean, "ahead": upper[1] - mean - lowest,
            "spread": float(np.ptp(lowest)),
            "speedMax": float(np.sqrt((v[inside]**2).sum(axis=1)).max())
            if inside.any() else 0.0}


# --- immersed collapse ----------------------------------------------------

def collapseCourse(case, probe=0.02):
    """Rows of time, front (where 99.5 % of the grains are behind), height of
    the bed at x = 0, and excess pore pressure in the cell at the floor at
    x = probe: over that of the liquid at rest, by the level far away"""
    m, h = Medium(case), spacing(case)
    rows = []
    for time in case.times():
        if not case.hasCloud(time, "soil"):
            continue
        x, _ = points(case, time, "water")
        p = case.cloudField(time, "water", "p")
        s = points(case, time, "soil")[0]
        far = x[:, 0] > x[:, 0].max() - 0.25*np.ptp(x[:, 0])
        # Liquid at rest there, from its pressure near the floor
        low = far & (x[:, 1] < 2*h)
        head = (p[low] + m.rho*G*x[low, 1]).mean()
        here = (np.abs(x[:, 0] - probe) < 1.5*h) & (x[:, 1] < 2*h)
        excess = (p[here] + m.rho*G*x[here, 1]).mean() - head
        rows.append((float(time), np.sort(s[:, 0])[int(0.995*len(s))],
                     s[s[:, 0] < 2*h, 1].max(), excess))
    return np.array(rows)


def currentOverBed(case, length, bed, drive, rhoS):
    """A current over an endless bed that ends at the height bed, a cell wide,
    driven by the acceleration drive, over the second half of the run: stress
    on the bed [Pa], what drives the water above it less what it gains;
    transport of all grains per width [m2/s]; way of each grain in the whole
    run [m]; and the part of the grains that is suspended at its end"""
    times = [t for t in case.times() if case.hasCloud(t, "soil")]
    momentum, free, x = [], [], []
    for t in times:
        m, v, y = (case.cloudField(t, "water", f) for f in ["mass", "U", "x"])
        momentum.append((m*v[:, 0]).sum())
        free.append(m[y[:, 1] > bed].sum())
        order = np.argsort(case.cloudField(t, "soil", "id"))
        x.append(case.cloudField(t, "soil", "x")[order][:, 0])
    mass = case.cloudField(times[-1], "soil", "mass")[order]
    t = np.array([float(i) for i in times])
    late = t >= 0.5*t[-1]
    area = length*spacing(case)

    gain = np.polyfit(t[late], np.array(momentum)[late], 1)[0]
    stress = (drive*np.mean(np.array(free)[late]) - gain)/area

    steps = np.diff(np.array(x), axis=0)
    steps = (steps + 0.5*length) % length - 0.5*length
    # Volume of grains times speed, per area
    volume = (mass/rhoS*steps[late[1:]].sum(axis=0)).sum()
    transport = volume/area/(t[-1] - t[late.argmax()])
    regime = case.cloudField(times[-1], "soil", "regime")
    return stress, transport, steps.sum(axis=0), (regime == 2).mean()


# What Rondon, Pouliquen and Aussillous (2011) measured: names of the files and
# times of the profiles
RONDON = {"dense": ("sedfoam_RondonDenseL6H4.2", (3, 6, 9, 12, 18, 60)),
          "loose": ("sedfoam_RondonLooseL6H4.8", (0.66, 1.32, 2, 4))}


def rondon(case):
    """Those of a case, by its column; front in m"""
    height = box(case, "column")[1][1]
    name, times = RONDON["loose" if height > 0.045 else "dense"]
    front, pressure = (reference.data(f"{name}_{what}.csv")
                       for what in ("FRONT", "Pressure"))
    return {"height": height, "front": (front["t"], 0.01*front["x"]),
            "pressure": (pressure["t"], pressure["p"]),
            "profiles": {t: tuple(reference.data(
                f"{name}_T{t:g}s.csv")[c] for c in "xy") for t in times}}


def collapseMisfit(case, early=6):
    """Against the measurements. Front from 1 s on: ratio less 1; profiles: rms
    over the height of the column, the mean of the measured times; pore
    pressure of the first seconds: rms over the largest measured one"""
    measured, rows = rondon(case), collapseCourse(case)
    end = rows[-1, 0]
    t, x = (np.array(c) for c in measured["front"])
    here = (t >= 1) & (t <= end)
    front = np.interp(t[here], rows[:, 0], rows[:, 1])/x[here] - 1
    profiles = {}
    for time, (x, y) in measured["profiles"].items():
        if time <= end + 0.1:
            table = np.genfromtxt(profileTime(case, time), delimiter=",",
                                  names=True)
            bed = np.nan_to_num(table["bed"])
            last = max(x.max(), table["x"][bed > 0].max())
            at = np.linspace(0, 1.1*last, 400)
            error = (np.interp(at, table["x"], bed)
                     - np.interp(at, x, y, right=0))
            profiles[time] = rms(error[at <= table["x"].max()]
                                 )/measured["height"]
    t, p = (np.array(c) for c in measured["pressure"])
    here = (t >= 1) & (t <= min(end, early))
    out = {"frontErrorMax": max(front, key=abs),
           "frontErrorMean": front.mean(),
           **{f"profileRms_t{t:g}": v for t, v in profiles.items()}}
    if profiles:
        out["profileRmsMean"] = np.mean(list(profiles.values()))
    if here.any():
        out["porePressureRms"] = rms(
            np.interp(t[here], rows[:, 0], rows[:, 3]) - p[here]
            )/np.abs(p).max()
    return out


def overlap(case, time):
    """By how much water and grains together fill more than there is, in cells
    that are full: mean and largest"""
    _, y, total = case.lattice(time, "alpha.water")
    total = total + case.lattice(time, "alpha.soil")[2]
    full = y < 0.9*box(case, "liquid")[1][1]
    return float(total[full].mean() - 1), float(total[full].max() - 1)


def profileTime(case, time):
    """The file of scourProfile nearest to a time"""
    root = Path(case.path)/"postProcessing"/"scour"
    return min((p for p in root.glob("*/profile.csv")),
               key=lambda p: abs(float(p.parent.name) - time))
