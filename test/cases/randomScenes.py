"""Scenes of valid entries of all kinds together, each from a seed, and what
must be true of any: it runs, keeps its mass and stays finite, a restart half
way changes no bit, two ranks change rounding only, and water among walls and
bodies at rest wins no energy."""

import copy
import random
import shutil

import numpy as np

from bodies import cylinder
from caseBuilder import G, RHO_S, Setup, box, hydrostatic
from plates import moving, plate

STEPS = 120

# Of the run on two ranks, and how much rounding may grow in them, over the
# largest value; what is at rest moves by rounding alone, less than REST [m, m/s, ...]
STEPS_OF_RANKS = 40
ROUNDING = 1e-8
REST = 1e-9

# Largest growth of the energy over its value at the start: as of the hard cases
GROWTH = 1e-3

SOILS = {
    "DruckerPrager": {
        "rhoS": RHO_S, "d": 0.85e-3, "e0": 0.695, "E0": 216, "n": 0.5,
        "nu": 0.2, "phi": 30, "psi": 0},
    "muI": {
        "rhoS": RHO_S, "d": 1e-3, "e0": 0.66, "E": 1e6, "nu": 0.2,
        "muS": 0.38, "muD": 0.64, "I0": 0.3},
    "elastoplasticMuI": {
        "rhoS": RHO_S, "d": 0.85e-3, "e0": 0.7, "E0": 216, "nu": 0.2, "n": 0.5,
        "phiC": 33, "eRef": 0.807, "lambda": 0.0596, "xi": 0.365, "Ad": 0.7,
        "kp": 0.0044, "np": 2.4, "nd": 2.9, "I0": 0.28, "muS": 0.65,
        "muD": 0.77, "PhiC": 0.7, "dPhi": 0.29}}

TURBULENT = {"k": 1e-3, "epsilon": 1e-2}

# Models of the liquid, and how often each is taken
LIQUIDS = [
    (7, {}),
    (2, {"turbulence": "kEpsilon", "kEpsilonCoeffs": TURBULENT}),
    (2, {"turbulence": "realizableKE", "realizableKECoeffs": TURBULENT}),
    (1, {"turbulence": "Smagorinsky"}),
    (2, {"viscosityModel": "BinghamPapanastasiou",
         "BinghamPapanastasiouCoeffs": {"tau0": 0.02, "m": 50}}),
    (1, {"viscosityModel": "BinghamPapanastasiou", "viscousStep": "stages",
         "BinghamPapanastasiouCoeffs": {"tau0": 0.2, "m": 50}}),
    (2, {"viscosityModel": "HerschelBulkley", "HerschelBulkleyCoeffs": {
        "tau0": 0.02, "k": 2e-3, "n": 0.6, "nu0": 0.5}})]


class _Maker:
    """Chooses step by step; parts names what is there"""

    def __init__(self, seed):
        self.random = random.Random(seed)
        self.dim = 3 if self.maybe(0.2) else 2
        self.h = self.choice([0.01, 0.02, 0.025])
        self.cells = (
            (self.number(12, 28), self.number(10, 20)) if self.dim == 2 else
            (self.number(10, 14), self.number(6, 8), self.number(10, 12)))
        self.origin = tuple(self.choice([0, 0, -0.3, 1.7])
                            for _ in range(self.dim)) + (0,)*(3 - self.dim)
        self.clouds = self.choice(
            ["water", "water", "water soil", "water soil", "soil"])
        self.parts = [f"{self.dim}D", self.clouds]

    def choice(self, values):
        return copy.deepcopy(self.random.choice(values))

    def maybe(self, part):
        return self.random.random() < part

    def number(self, lower, upper):
        return self.random.randint(lower, upper)

    def between(self, lower, upper):
        return self.random.uniform(lower, upper)

    def place(self, *parts):
        """By the parts of the mesh along its directions"""
        return tuple(self.origin[d] + part*self.cells[d]*self.h
                     for d, part in enumerate(parts))

    def region(self, x0, x1, y0, y1, wide=True, make=box, **entries):
        """Between parts of the length and height, on faces of cells"""
        up = self.dim - 1
        corners = []
        for x, y in [(x0, y0), (x1, y1)]:
            x = round(x*self.cells[0])/self.cells[0]
            y = round(y*self.cells[up])/self.cells[up]
            z = () if self.dim == 2 else (float(len(corners)),) if wide else (
                0.25 + 0.5*len(corners),)
            corners.append(self.place(x, *z, y))
        return make(*corners, **entries)

    def wall(self):
        return self.choice(["slip", "slip", "noSlip", "smoothWall",
                            {"type": "roughWall", "ks": 0.1*self.h}])

    def numerics(self):
        mpm = {"shapeFunction": self.choice(
                   ["quadraticBSpline"]*4 + ["cubicBSpline"]),
               "maxCo": self.choice([0.3, 0.5, 0.7])}
        if self.maybe(0.15):
            mpm["volumeCorrection"] = False
        elif self.clouds == "water soil" and self.maybe(0.2):
            mpm["overlapCorrection"] = True
        if self.maybe(0.2):
            mpm["sortInterval"] = self.choice([1, 37])
        if "soil" in self.clouds:
            mpm["maxSoilSoundSpeed"] = self.choice([15, 30])
            if self.maybe(0.2):
                mpm["looseningCorrection"] = True
        return mpm

    def liquid(self):
        weights, models = zip(*LIQUIDS)
        water = copy.deepcopy(self.random.choices(models, weights)[0])
        water["transfer"] = self.choice(["APIC", "APIC", "XAPIC", "FLIP"])
        if self.maybe(0.2):
            water["tensionCutOff"] = True
        if self.maybe(0.2):
            water["pressureQuadrature"] = "cells"
        self.parts += [water[k] for k in ("turbulence", "viscosityModel")
                       if k in water] + [water["transfer"]]
        return water

    def soil(self):
        model = self.choice(list(SOILS))
        self.parts.append(model)
        return {"constitutiveModel": model, f"{model}Coeffs": dict(SOILS[model]),
                "transfer": self.choice(["FLIP", "APIC"])}

    def bed(self):
        """Its region, and the part of the height that it takes"""
        top = self.between(0.15, 0.4)
        if self.maybe(0.4):
            self.parts.append("heap")
            return self.region(0, self.between(0.4, 0.7), 0, top), top
        return self.region(0, 1, 0, top, stress="geostatic"), top

    def waterOver(self, bed):
        kind = self.choice(["column", "pool", "drop"])
        self.parts.append(kind)
        if kind == "column":
            return self.region(0, self.between(0.25, 0.5), 0,
                               self.between(bed + 0.2, 0.8), wide=False,
                               make=hydrostatic)
        if kind == "pool":
            return self.region(0, 1, 0, self.between(bed + 0.2, 0.8),
                               make=hydrostatic)
        velocity = [self.between(-2, 2), 0, 0]
        velocity[self.dim - 1] = self.between(-2, 1)
        return self.region(0.3, 0.6, bed + 0.15, bed + 0.5, wide=False,
                           velocity=tuple(velocity))

    def body(self):
        h = self.h
        if self.dim == 3:
            self.parts.append("sphere")
            return {"type": "fixed", "surface": {
                "type": "sphere", "origin": self.place(0.5, 0.5, 0.5),
                "radius": 2.2*h}}
        centre = self.place(self.between(0.4, 0.7), self.between(0.35, 0.6))
        displacement = (self.between(-0.1, 0.1), self.between(-0.05, 0.05))
        kind = self.choice(["pipe", "moving pipe", "rigid pipe", "plate",
                            "moving plate"])
        self.parts.append(kind)
        radius = self.between(2, 3)*h
        if kind == "rigid pipe":
            mass = self.choice([100, 600, 1500])*np.pi*radius**2
            return {"type": "rigid", "surface": cylinder(centre, radius),
                    "motion": {
                        "mass": float(mass), "centreOfMass": (*centre, 0),
                        "momentOfInertia": (
                            1e-2, 1e-2, float(0.5*mass*radius**2))}}
        if "pipe" in kind:
            body = {"type": "fixed", "surface": cylinder(centre, radius)}
        else:
            angle, length = self.between(0, np.pi), self.between(4, 8)*h
            half = 0.5*length*np.array([np.cos(angle), np.sin(angle)])
            body = plate(np.array(centre) - half, np.array(centre) + half,
                         self.choice([0.1, 0.5, 1, 2])*h)
        if "moving" in kind:
            body = moving(body, displacement, self.choice([0, 60]), centre)
        if "water" in self.clouds and self.maybe(0.3):
            body["water"] = {"type": "noSlip"}
        return body

    def setup(self):
        entries = {
            "points": self.choice([2, 3, 4]) if self.dim == 2 else 2,
            "origin": self.origin, "wall": self.wall(), "mpm": self.numerics(),
            "soilWall": self.choice(["noSlip", "slip", {
                "type": "frictional", "frictionCoefficient": 0.4}]),
            "placement": self.choice([
                {}, {"placement": "jittered", "jitter": 0.2,
                     "seed": self.number(1, 99)}]),
            "energy": self.clouds == "water"}
        if self.maybe(0.25):
            entries["sides"] = {
                "ymax" if self.dim == 2 else "zmax": ("patch", "zeroGradient")}
            self.parts.append("open top")
        top = 0
        if "soil" in self.clouds:
            entries["soil"] = self.soil()
            bed, top = self.bed()
            entries["soilRegions"] = {"bed": bed}
            entries["interaction"] = {
                "drag": self.choice(["DarcyForchheimer", "Gidaspow"])}
        regions = {}
        if "water" in self.clouds:
            entries["water"] = self.liquid()
            entries["fluid"] = {"mu": self.choice([0, 1e-3, 0.05]),
                                "gamma": self.choice([2, 5, 7, 7, 7])}
            regions["water"] = self.waterOver(top)
        if self.maybe(0.5):
            entries["bodies"] = {"body": self.body()}
        return Setup(cells=self.cells, h=self.h, regions=regions, **entries)


def made(seed):
    """The setup of a seed, and what it has"""
    maker = _Maker(seed)
    setup = maker.setup()
    return setup, " ".join(maker.parts)


def _state(case, cloud):
    """What its points are and carry at the last time, by id"""
    time = case.times[-1]
    folder = case.path/time/"lagrangian"/cloud
    values = {}
    for name in ["id", "mass", "x", "U", "J", "p", "voidRatio", "stress"]:
        if (folder/name).exists():
            values[name] = np.asarray(case.case.cloudField(time, cloud, name))
    order = np.argsort(values["id"], kind="stable")
    return {name: value[order] for name, value in values.items()}


def _ran(setup, path):
    case = setup.write(path)
    case.prepare()
    case.solve()
    return case


def _isolated(setup):
    """Water alone, and nothing that does work on it"""
    return setup.energy and not setup.sides and all(
        body["type"] == "fixed" for body in setup.bodies.values())


def judge(seed, path):
    """What is wrong with the scene of a seed, an empty list if nothing is"""
    def setup(steps):
        return made(seed)[0].steps(steps)

    wrong = []
    whole = _ran(setup(STEPS), path/"whole")
    parts = _ran(setup(STEPS//2), path/"parts")
    parts.change(control={"writeInterval": STEPS})
    parts.solve()
    one = _ran(setup(STEPS_OF_RANKS), path/"one")
    two = setup(STEPS_OF_RANKS).write(path/"two")
    two.prepare()
    two.decompose(2)
    two.solve(ranks=2)
    two.run("reconstructPar")

    if _isolated(whole.setup):
        energy = whole.energies()["total"]
        growth = (energy - np.minimum.accumulate(energy)).max()
        if growth > GROWTH*abs(energy[0]):
            wrong.append(f"wins {growth:.3g} J of {energy[0]:.3g}")
    if parts.times[-1] != whole.times[-1]:
        wrong.append(f"ends at {parts.times[-1]} after a restart, at"
                     f" {whole.times[-1]} without")
    for cloud in whole.setup.clouds:
        a, b = _state(whole, cloud), _state(parts, cloud)
        start = whole.case.cloudField("0", cloud, "mass")
        if not whole.setup.sides and a["mass"].sum() != start[
                np.argsort(whole.case.cloudField("0", cloud, "id"))].sum():
            wrong.append(f"mass of {cloud}")
        for name in a:
            if not np.all(np.isfinite(a[name])):
                wrong.append(f"{name} of {cloud} not finite")
            if not np.array_equal(a[name], b[name]):
                wrong.append(f"{name} of {cloud} other after a restart")
        a, b = _state(one, cloud), _state(two, cloud)
        for name in a:
            scale = np.abs(a[name]).max(initial=0) + np.finfo(float).tiny
            if a[name].shape != b[name].shape or np.abs(
                    a[name] - b[name]).max(initial=0) > max(
                        ROUNDING*scale, REST):
                wrong.append(f"{name} of {cloud} other on two ranks")
    if not wrong:
        shutil.rmtree(path, ignore_errors=True)
    return wrong
