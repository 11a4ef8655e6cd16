"""Flows of liquids that are more than laminar: an endless open channel, a gap
with a yield stress. test_liquids runs them small, validation/liquids large."""

import numpy as np

from caseBuilder import G, RHO, Setup, box, hydrostatic

KAPPA, E = 0.41, 9.8


def setField(case, name, values):
    """The values of a vector of the points of water at the start, in ascii"""
    path = case.path/"0"/"lagrangian"/"water"/name
    text = path.read_text()
    head = text[:text.index("}", text.index("FoamFile")) + 1]
    rows = "\n".join("(" + " ".join(f"{c:.17g}" for c in v) + ")"
                     for v in values)
    path.write_text(f"{head}\n{len(values)}\n(\n{rows}\n)\n")


ASCII = {"writeFormat": "ascii", "writePrecision": 17}


def logarithmic(y, uStar, ks, nu):
    """Velocity over a wall, rough or smooth"""
    return uStar/KAPPA*np.log1p(y/(ks/30 + nu/(E*uStar)))


class Channel:
    """Endless open channel, driven along its bed by a force: depth H, friction
    velocity uStar, roughness ks (0: smoothWall)"""

    def __init__(self, turbulence, cells=20, ks=4e-3, uStar=0.05, depth=0.2,
                 points=2, water=None, coeffs=None, fluid=None):
        self.depth, self.uStar, self.ks = depth, uStar, ks
        self.h, self.cells, self.nu = depth/cells, cells, 1e-6
        entries = {"turbulence": turbulence, "transfer": "XAPIC",
                   "bodyForce": (uStar**2/depth, 0, 0), **(water or {})}
        if coeffs:
            entries[turbulence + "Coeffs"] = coeffs
        bed = {"type": "roughWall", "ks": ks} if ks else {"type": "smoothWall"}
        self.setup = Setup(
            cells=(4, cells + 3), h=self.h, points=points, g=(0, -G, 0),
            sides={"ymin": ("wall", bed)}, energy=False,
            fluid={"soundSpeed": 14, **(fluid or {})}, water=entries,
            regions={"channel": hydrostatic((0, 0), (10, depth))},
            control=ASCII).cyclic("x")

    def profile(self, y):
        return logarithmic(y, self.uStar, self.ks, self.nu)

    def mean(self):
        """Mean velocity of the logarithmic law"""
        y = (np.arange(1000) + 0.5)/1000*self.depth
        return self.profile(y).mean()

    def start(self, path, end, writes=5):
        """The case, from the logarithmic law"""
        case = self.setup.until(end, end/writes).write(path).prepare()
        x = case.case.cloudField("0", "water", "x")
        U = np.zeros_like(x)
        U[:, 0] = self.profile(x[:, 1])
        setField(case, "U", U)
        return case

    def meanOf(self, case, time=None):
        p = case.points(time)
        return (p.mass*p.U[:, 0]).sum()/p.totalMass/self.mean()


class BedChannel(Channel):
    """The same over grains of diameter d that stay where they are, ks = 2.5 d.
    The surface lies rise of a cell above a row of nodes"""

    def __init__(self, cells=20, d=1e-3, rise=0, placement="regular",
                 rows=5, **entries):
        super().__init__("kEpsilon", cells=cells, ks=2.5*d, **entries)
        h, setup = self.h, self.setup
        self.bed = (rows + rise)*h
        level = self.bed + self.depth
        setup.cells = (4, rows + cells + 4)
        setup.sides.pop("ymin")
        setup.regions = {
            "pores": box((0, 0), (10, self.bed), pressure="hydrostatic",
                         level=level),
            "channel": hydrostatic((0, self.bed), (10, level))}
        setup.soil = {"constitutiveModel": "rigidSkeleton",
                      "rigidSkeletonCoeffs": {
                          "rhoS": 2650, "d": d, "e0": 0.7}}
        setup.soilRegions = {"bed": box((0, 0), (10, self.bed))}
        setup.soilWall = "slip"
        setup.placement = {"placement": placement}

    def profile(self, y):
        """By height over the floor, or with depths alone over the bed"""
        return super().profile(np.maximum(y, 0))

    def start(self, path, end, writes=2):
        case = self.setup.until(end, end/writes).write(path).prepare()
        x = case.case.cloudField("0", "water", "x")
        U = np.zeros_like(x)
        U[:, 0] = self.profile(x[:, 1] - self.bed)
        setField(case, "U", U)
        return case

    def meanOf(self, case, time=None):
        p = case.points(time)
        over = p.x[:, 1] > self.bed
        return ((p.mass*p.U[:, 0])[over].sum()/p.mass[over].sum()
                / self.mean())

    def stressOf(self, case, first, last):
        """Mean stress on the bed between two times over rho u*^2, from the
        momentum of the water; what drives that in the pores stays there"""
        points = [case.points(t) for t in (first, last)]
        momentum = [(p.mass*p.U[:, 0]).sum() for p in points]
        mass = points[1].mass[points[1].x[:, 1] > self.bed].sum()
        area = 4*self.h*self.h
        lost = (mass*self.uStar**2/self.depth
                - (momentum[1] - momentum[0])/(float(last) - float(first)))
        return lost/area/(RHO*self.uStar**2)


def binghamGap(cells=16, model="BinghamPapanastasiou", m=10, water=None):
    """A Bingham liquid between plates 0.1 m apart, mu 1 Pa s, a gradient of
    400 Pa/m: the stress at the plates is 20 Pa, the liquid yields at 8 Pa.
    The setup, and the velocity by height"""
    H, mu, gradient, yieldStress = 0.1, 1.0, 400.0, 8.0
    half, plug = H/2, yieldStress/gradient
    U = gradient/(2*mu)*(half - plug)**2

    def exact(y):
        d = np.maximum(np.abs(y - half) - plug, 0)
        return U - gradient/(2*mu)*d**2

    coeffs = {"tau0": yieldStress/RHO, "m": m}
    if model == "HerschelBulkley":
        coeffs = {"tau0": yieldStress/RHO, "k": mu/RHO, "n": 1,
                  "nu0": yieldStress/RHO*m}
    setup = Setup(
        cells=(4, cells), h=H/cells, points=3, g=(0, 0, 0),
        sides={s: ("wall", "noSlip") for s in ("ymin", "ymax")},
        fluid={"soundSpeed": 10*U,
               "mu": mu if model == "BinghamPapanastasiou" else 0},
        water={"viscosityModel": model, model + "Coeffs": coeffs,
               "pressureGradient": (-gradient, 0, 0), **(water or {})},
        regions={"gap": box((0, 0), (10, H))}, energy=False,
        control=ASCII).cyclic("x")
    return setup, exact, half**2/(mu/RHO)


def binghamSlope(cells=8, yields=True, water=None):
    """An endless layer of a Bingham liquid, 0.05 m deep, on a slope of 1:5,
    mu 2 Pa s; the stress on its bed is 96 Pa, the yield stress half of that or
    (yields no) 1.25 times as much. The setup, the velocity by height (free:
    the largest without a yield stress) and the time to run"""
    H, mu = 0.05, 2.0
    g = np.array([G*0.2, -G, 0])/np.sqrt(1.04)
    bed = RHO*g[0]*H
    stress = bed/2 if yields else 1.25*bed

    def exact(y):
        shear = max(0, H - stress/(RHO*g[0]))
        return RHO*g[0]/(2*mu)*(shear**2 - np.maximum(0, shear - y)**2)
    exact.free = RHO*g[0]*H**2/(2*mu)

    m = 10 if yields else 20
    setup = Setup(
        cells=(4, cells + 2), h=H/cells, points=3, g=tuple(g),
        sides={"ymin": ("wall", "noSlip")}, energy=False,
        fluid={"mu": mu, "soundSpeed": 7},
        water={"viscosityModel": "BinghamPapanastasiou",
               "BinghamPapanastasiouCoeffs": {"tau0": stress/RHO, "m": m},
               **(water or {})},
        regions={"layer": hydrostatic((0, 0), (10, H))},
        control=ASCII).cyclic("x")
    return setup, exact, 4*H**2/(mu/RHO) if yields else 0.3


# Cmu, C1, C2, sigmak, sigmaEps
COEFFICIENTS = {"kEpsilon": (0.09, 1.44, 1.92, 1.0, 1.3),
                "realizableKE": (0.09, 0, 1.9, 1.0, 1.2)}


class MixingLayer:
    """Two streams of -U/2 and U/2 side by side, endless, the layer between
    them 4 cells thick at the start, and what the model of turbulence makes of
    it in one dimension, on a grid of twice as many cells"""
    h, rows, U, nu = 0.0125, 64, 1.0, 2e-5

    def __init__(self, turbulence, k=1e-3, epsilon=5e-4, columns=4, **entries):
        self.turbulence, self.k, self.epsilon = turbulence, k, epsilon
        self.height = self.rows*self.h
        self.setup = Setup(
            cells=(columns, self.rows), h=self.h, points=2, g=(0, 0, 0),
            energy=False, fluid={"soundSpeed": 10*self.U, "mu": self.nu*RHO},
            water={"turbulence": turbulence, "transfer": "XAPIC",
                   turbulence + "Coeffs": {"k": k, "epsilon": epsilon}},
            regions={"all": box((0, 0), (10, self.height))},
            control=ASCII, **entries).cyclic("x")

    def profile(self, y):
        return self.U/2*np.tanh((y - self.height/2)/(2*self.h))

    def run(self, path, end):
        case = self.setup.until(end).write(path).prepare()
        x = case.case.cloudField("0", "water", "x")
        U = np.zeros_like(x)
        U[:, 0] = self.profile(x[:, 1])
        setField(case, "U", U)
        case.solve()
        return case

    def thickness(self, y, u, weight):
        """U over the largest slope of the means of the rows"""
        row = (y/self.h).astype(int)
        mean = (np.bincount(row, weight*u, self.rows)
                / np.bincount(row, weight, self.rows))
        return self.U/np.gradient(mean, self.h).max()

    def theory(self, end):
        """Height, velocity, k at the end; explicit"""
        Cmu, C1, C2, sigmak, sigmaEps = COEFFICIENTS[self.turbulence]
        n = 2*self.rows
        dy = self.height/n
        y = (np.arange(n) + 0.5)*dy
        u, k, e = (self.profile(y), np.full(n, self.k),
                   np.full(n, self.epsilon))
        steps = round(end/5e-4)
        dt = end/steps

        def spread(f, D):
            flux = np.zeros(n + 1)
            flux[1:-1] = (D[1:] + D[:-1])/2*np.diff(f)/dy
            return np.diff(flux)/dy
        for _ in range(steps):
            S = np.abs(np.gradient(u, dy))
            eta = S*k/e
            C = Cmu
            if self.turbulence == "realizableKE":
                # U* = |S| in plane shear
                C = 1/(4 + np.sqrt(4.5)*eta)
            nut = C*k**2/e
            P = np.minimum(nut*S**2, 10*e)
            gain, decay = C1*P*e/k, C2*e**2/k
            if self.turbulence == "realizableKE":
                gain = np.maximum(0.43, eta/(eta + 5))*S*e
                decay = C2*e**2/(k + np.sqrt(self.nu*e))
            u, k, e = (u + dt*spread(u, self.nu + nut),
                       k + dt*(P - e + spread(k, self.nu + nut/sigmak)),
                       e + dt*(gain - decay
                               + spread(e, self.nu + nut/sigmaEps)))
        return y, u, k
