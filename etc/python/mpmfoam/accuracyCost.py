"""What accuracy costs, for any case: see docs/howto/accuracyCost.md."""

import argparse
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from pathlib import Path

import numpy as np

from . import costStudy, foamDict, foamFile, metrics, reference, runLog
from . import study
from .costStudy import MPM, POINTS, PROPERTIES, merged
from .foamFile import FoamFileError
from .mesh import Lattice, Mesh
from .postProcessing import readColumns

FACTORS = ["grid", "points", "soundSpeed", "stiffness", "transfer", "maxCo",
           "shape", "output", "scatter"]

# Metrics that are taken where none is asked for, if the case has them
USUAL = ["scourDepthMax", "erodedVolume", "duneHeight", "reservoirLevelEnd",
         "frontPosition", "energyRatio", "mass"]

# Displacement of regular points for the scatter, in distances of points
JITTER = 0.05

# Parts of the budget: of the finest run, and of all before combinations of
# settings and their repetition with other placements
FINEST, FIRST = 0.45, 0.85


class AccuracyCostError(Exception):
    pass


# --- metrics ----------------------------------------------------------------

REDUCTIONS = {"max": np.max, "min": np.min, "mean": np.mean,
              "end": lambda v: v[-1]}


class Metric:
    """A number of metrics.json, or object/file.dat:column of postProcessing:
    all of it in time, or :max, :min, :mean, :end of it, or :<time in s>"""

    def __init__(self, text):
        self.name = text
        self.object, self.file, self.column, self.part = [None]*4
        if ":" not in text:
            return
        words = text.split(":")
        where = words[0].split("/")
        if len(where) != 2 or len(words) not in (2, 3):
            raise AccuracyCostError(
                f"--metrics {text} is no metric.\n    Allowed: a name in "
                "metrics.json, or object/file:column, or object/file:column:"
                "part with a part of max, min, mean, end or a time in s")
        self.object, self.file = where
        self.column = words[1]
        if len(words) == 3:
            self.part = words[2]
            if self.part not in REDUCTIONS and \
                    foamDict.number(self.part) is None:
                raise AccuracyCostError(
                    f"--metrics {text}: part {self.part} is not known.\n"
                    f"    Allowed: {', '.join(REDUCTIONS)}, or a time in s")

    @property
    def isSeries(self):
        return self.object is not None and self.part is None

    def options(self):
        """Of caseMetrics: times that are in the metric's name"""
        found = re.fullmatch(r"(frontPosition|energyRatio)_t([\d.e+-]+)",
                             self.name)
        if not found:
            return {}
        option = {"frontPosition": "--front", "energyRatio": "--energy"}
        return {option[found[1]]: found[2]}

    def read(self, path):
        """The number, or (times, values)"""
        if self.object is None:
            known = metrics.readMetrics(path/"metrics.json")
            if not isinstance(known.get(self.name), (int, float)):
                raise AccuracyCostError(
                    f"{path/'metrics.json'}: there is no number "
                    f"{self.name}.\n    Allowed: " + ", ".join(
                        k for k, v in known.items()
                        if not isinstance(v, str)))
            return float(known[self.name])
        try:
            columns = readColumns(path, self.object, self.file)
        except FileNotFoundError:
            there = sorted({f"{p.parent.parent.name}/{p.name}" for p in
                            (path/"postProcessing").glob("*/*/*.dat")})
            raise AccuracyCostError(
                f"{path}/postProcessing: --metrics {self.name}: no "
                f"{self.object}/{self.file}.\n    Allowed: "
                f"{', '.join(there) or 'none: the case writes no .dat'}")
        time = next(iter(columns.values()))
        if self.column not in columns:
            raise AccuracyCostError(
                f"{path}/postProcessing/{self.object}/*/{self.file}: "
                f"--metrics {self.name}: no column {self.column}.\n"
                f"    Allowed: {', '.join(list(columns)[1:])}")
        values = columns[self.column]
        if self.part is None:
            return time, values
        if self.part in REDUCTIONS:
            return float(REDUCTIONS[self.part](values))
        return float(np.interp(float(self.part), time, values))

    def distance(self, a, b):
        """Of two values; of series the mean over time"""
        if not self.isSeries:
            return abs(a - b)
        return float(np.nanmean(np.abs(np.interp(b[0], *a) - b[1])))

    def size(self, a):
        return abs(a) if not self.isSeries else float(
            np.nanmean(np.abs(a[1])))


# Part of its way, over three grids, that a course in time must come forward: a
# number that goes one way comes forward by all of it. Less is a course that goes
# to and fro, whose steps say nothing of what is left.
FORWARD = 0.9


def monotone(metric, a, b, c):
    """Do values of three grids go one way, by smaller steps"""
    if metric.isSeries:
        first, last = metric.distance(a, b), metric.distance(b, c)
        return last < first and \
            metric.distance(a, c) >= FORWARD*(first + last)
    return (a - b)*(b - c) > 0 and abs(b - c) < abs(a - b)


def gridError(metric, values):
    """What the finest of some grids still has as error, values as (h, value)
    from coarse to fine, and the order of convergence: Richardson's where three
    grids go one way, else the last change"""
    if len(values) < 2:
        return None, None
    (h2, b), (h3, c) = values[-2:]
    last = metric.distance(b, c)
    if len(values) > 2:
        h1, a = values[-3]
        first = metric.distance(a, b)
        if last > 0 and monotone(metric, a, b, c):
            # Order p of first/last = (h1^p - h2^p)/(h2^p - h3^p)
            order = np.linspace(0.5, 3, 251)
            ratio = (h1**order - h2**order)/(h2**order - h3**order)
            p = order[np.abs(ratio - first/last).argmin()]
            return last*h3**p/(h2**p - h3**p), float(p)
    return last, None


# --- a case and its grids ---------------------------------------------------

class Grid:
    """The case's mesh as a lattice, and finer and coarser ones with the same
    walls"""

    def __init__(self, path):
        mesh = Mesh(path)
        self.path = path
        lower, upper = mesh.bounds
        size = (mesh.upper - mesh.lower).min(axis=0)
        n = np.round((upper - lower)/size).astype(int)
        self.empty = mesh.emptyDirection
        self.lattice = Lattice(lower, upper, n)
        place = np.floor((mesh.centres - lower)/self.lattice.h).astype(int)
        self.lattice.active[:] = False
        self.lattice.active[place[:, 2], place[:, 1], place[:, 0]] = True
        self.patches = mesh.patches
        # The patch of a face, by its direction, its side and the cell before it
        self.faces = np.full((3, 2, *self.lattice.active.shape), -1)
        for number, patch in enumerate(self.patches):
            areas = mesh.areas[patch.faces]
            d = np.abs(areas).argmax(axis=1)
            side = np.sign(areas[np.arange(len(d)), d])
            self.faces[self.key(mesh.faceCentres[patch.faces], d, side)] = \
                number
        self.h = float(np.delete(self.lattice.h, self.empty).min()
                       if self.empty is not None else self.lattice.h.min())
        self.nDim = 3 if self.empty is None else 2

    def key(self, centres, d, side):
        """Indices of faces in self.faces"""
        place = (centres - self.lattice.lower)/self.lattice.h
        place[np.arange(len(d)), d] -= 0.5*side
        i, j, k = np.floor(place).astype(int).T
        return d, (side > 0).astype(int), k, j, i

    def scaled(self, factor):
        """The lattice with so many cells per cell, None if walls would have
        to move"""
        n = [int(self.lattice.n[d])*(1 if d == self.empty else Fraction(factor))
             for d in range(3)]
        if any(Fraction(c).denominator != 1 for c in n):
            return None
        new = Lattice(self.lattice.lower, self.lattice.upper,
                      [int(c) for c in n])
        # Parts of cells that lie in one old cell each
        parts = factor.denominator
        axes = [np.floor((new.lower[d] + (np.arange(
            new.n[d]*(1 if d == self.empty else parts)) + 0.5)
            * new.h[d]/(1 if d == self.empty else parts)
            - self.lattice.lower[d])/self.lattice.h[d]).astype(int)
            for d in range(3)]
        fine = self.lattice.active[np.ix_(axes[2], axes[1], axes[0])]
        shape = []
        for d in (2, 1, 0):
            shape += [new.n[d], 1 if d == self.empty else parts]
        fine = fine.reshape(shape)
        new.active = fine.any(axis=(1, 3, 5))
        if (new.active != fine.all(axis=(1, 3, 5))).any():
            return None
        return new if self.patchOf(new, parts) is not None else None

    def patchOf(self, lattice, parts=1):
        """Patch of each boundary face of a scaled lattice, None where one
        would lie on two"""
        (_, _, _), (nodes, _, d, side) = lattice.faces()
        centres = lattice.nodes()[nodes].mean(axis=1)
        rows = np.arange(len(d))
        shifts = (np.arange(parts) + 0.5)/parts - 0.5
        out = None
        for s in shifts:
            for t in shifts:
                place = centres.copy()
                for shift, e in [(s, (d + 1) % 3), (t, (d + 2) % 3)]:
                    across = e != (-1 if self.empty is None else self.empty)
                    place[rows, e] += shift*lattice.h[e]*across
                patch = self.faces[self.key(place, d, side)]
                if (patch < 0).any() or (
                        out is not None and (patch != out).any()):
                    return None
                out = patch
        return out

    def write(self, factor, path):
        """constant/polyMesh"""
        lattice = self.scaled(factor)
        patch = self.patchOf(lattice, factor.denominator)
        types = {}
        for p in self.patches:
            types[p.name] = {k: v for k, v in p.entries.items()
                             if k not in ("nFaces", "startFace", "inGroups")}
        lattice.write(path, [p.name for p in self.patches], types,
                      lambda centres, normals: patch)

    @cached_property
    def factors(self):
        """Those that keep all walls, from coarse to fine: near 1/2 and 3/4,
        and 3/2, 2, 3, 4"""
        def possible(low, high, wanted):
            all_ = sorted({Fraction(p, q) for q in range(1, 11)
                           for p in range(1, 4*q + 1)
                           if low <= Fraction(p, q) <= high},
                          key=lambda f: abs(f - wanted))
            return next((f for f in all_ if self.scaled(f)), None)
        out = [possible(0.35, 0.62, 0.5), possible(0.65, 0.85, 0.75),
               possible(1.3, 1.7, 1.5)]
        # Whole multiples always keep them
        return [f for f in out if f] + [Fraction(f) for f in (2, 3, 4)]


@dataclass
class CaseRun(study.Run):
    """A run on a scaled grid; metrics.json and what it put on the disk"""
    grid: Grid = None
    factor: Fraction = Fraction(1)
    evaluation: list = field(default_factory=list)      # commands

    def digest(self):
        if getattr(self, "_digest", None) is None:
            mesh = self.grid.path/"constant"/"polyMesh"
            more = [str(self.factor).encode()] + [
                (mesh/name).read_bytes() for name in ["boundary", "owner"]]
            self._digest = super().digest() + hashlib.sha256(
                b"\0".join(more)).hexdigest()[:8]
        return self._digest

    def make(self):
        super().make()
        self.grid.write(self.factor, self.path)

    def sign(self, madeBy):
        """Only the last time is kept: the metrics have been taken"""
        size = sum(p.stat().st_size for p in self.path.rglob("*")
                   if p.is_file() and "polyMesh" not in p.parts)
        self.evaluate()
        for time in self.case.times()[1:-1]:
            shutil.rmtree(self.path/time)
        (self.path/"disk.json").write_text(json.dumps({"bytes": size}))
        super().sign(madeBy)

    def evaluate(self):
        """metrics.json; what it had stays"""
        file = self.path/"metrics.json"
        before = metrics.readMetrics(file) if file.is_file() else {}
        for command in self.evaluation:
            done = subprocess.run(
                command, cwd=self.path, capture_output=True, text=True,
                shell=isinstance(command, str),
                env={**os.environ, "PWD": str(self.path)})
            if done.returncode:
                raise study.RunError(
                    f"{self.name}: {command} failed:\n" + (
                        done.stdout + done.stderr)[-2000:])
        if before:
            metrics.writeMetrics(file, {**metrics.readMetrics(file),
                                        **before})

    def complete(self, wanted):
        """Evaluate again if a metric is asked for that was not before"""
        known = metrics.readMetrics(self.path/"metrics.json")
        if any(m.options() and m.name not in known for m in wanted):
            self.evaluate()

    @property
    def diskMB(self):
        return json.loads((self.path/"disk.json").read_text())["bytes"]/1e6


class Study:
    """A case, what is varied of it, and what has been run"""

    def __init__(self, case, arguments):
        self.case = Path(case).resolve()
        self.metrics = [Metric(m) for m in arguments.metrics]
        self.factors = arguments.factors
        self.seeds = arguments.seeds
        self.budget = arguments.budget
        self.targets = sorted(arguments.targets, reverse=True)
        self.output = Path(arguments.output or self.case/"accuracyCost") \
            .resolve()
        self.endTime = arguments.endTime
        self.evaluation = [self._caseMetrics()] + arguments.after
        self.template = self.output/"template"
        self._prepare()
        self.grid = Grid(self.template)
        self._read()
        self.skipped = []

    # --- the case -----------------------------------------------------------

    def _prepare(self):
        """A copy without results, with its mesh"""
        start = next((d for d in ["0.orig", "0"]
                      if (self.case/d).is_dir()), None)
        for part, found in [("constant", "constant"), ("system", "system"),
                            ("0.orig or 0", start)]:
            if found is None or not (self.case/found).is_dir():
                raise AccuracyCostError(f"{self.case}: no directory {part}")
        if not (self.case/PROPERTIES).is_file():
            raise AccuracyCostError(
                f"{self.case}: no {PROPERTIES}: no case of mpmFoam.\n"
                "    Allowed: a case of mpmFoam; interFoamToMpmFoam makes one "
                "of a case of interFoam")
        new = self.output/"template.new"
        shutil.rmtree(new, ignore_errors=True)
        for part in ["constant", "system"]:
            shutil.copytree(self.case/part, new/part)
        shutil.copytree(self.case/start, new/"0.orig",
                        ignore=shutil.ignore_patterns("lagrangian", "uniform"))
        for file in self.case.iterdir():
            if file.suffix in (".py", ".sh") and file.is_file():
                shutil.copy(file, new/file.name)
        control = foamDict.read(new/"system"/"controlDict")
        if self.endTime:
            study.setEntry(new/"system"/"controlDict", "endTime",
                           f"{self.endTime:g}")
            interval = foamDict.number(control.get("writeInterval"))
            if interval and control.get("writeControl") in (
                    "adjustableRunTime", "runTime") and \
                    interval > self.endTime:
                study.setEntry(new/"system"/"controlDict", "writeInterval",
                               f"{self.endTime:g}")
        if (new/"system"/"blockMeshDict").is_file():
            done = subprocess.run(
                ["blockMesh"], cwd=new, capture_output=True, text=True,
                env={**os.environ, "PWD": str(new)})
            if done.returncode:
                raise AccuracyCostError(f"{self.case}: blockMesh failed:\n"
                                        + (done.stdout + done.stderr)[-1500:])
        elif not foamFile.stored(new/"constant"/"polyMesh"/"points"):
            raise AccuracyCostError(
                f"{self.case}: neither system/blockMeshDict nor "
                "constant/polyMesh")
        shutil.rmtree(self.template, ignore_errors=True)
        new.rename(self.template)

    def _read(self):
        properties = foamDict.Dictionary.read(self.template/PROPERTIES)
        names = properties.entries.get("clouds", [])
        self.clouds = [names] if isinstance(names, str) else list(names)
        points = foamDict.Dictionary.read(self.template/POINTS)
        self.points, self.placement = {}, {}
        self.inlets, self.transfer = {}, {}
        self.liquid, self.solids = None, []
        for cloud in self.clouds:
            d = properties.sub(cloud)
            isLiquid = d.entries.get("constitutiveModel") == \
                "weaklyCompressibleNewtonian"
            if isLiquid:
                self.liquid = cloud
            else:
                self.solids.append(cloud)
            placed = points.sub(cloud)
            self.points[cloud] = int(placed.number("pointsPerDirection"))
            self.placement[cloud] = placed.word("placement", "regular")
            self.transfer[cloud] = d.entries.get("transfer")
            opens = d.entries.get("inflowOutflow", {}).get("inlets", {})
            self.inlets[cloud] = {
                f"{cloud}/inflowOutflow/inlets/{name}/pointsPerDirection":
                int(foamDict.number(inlet["pointsPerDirection"]))
                for name, inlet in opens.items()
                if "pointsPerDirection" in inlet}
        numerics = foamDict.read(self.template/MPM).get("MPM", {})
        control = foamDict.read(self.template/"system"/"controlDict")
        self.shape = numerics.get("shapeFunction", "quadraticBSpline")
        self.maxCo = foamDict.number(numerics.get(
            "maxCo", control.get("maxCo", 0.5)))
        self.adjusts = control.get("adjustTimeStep") in ("yes", "on", "true")
        self.cap = foamDict.number(numerics.get("maxSoilSoundSpeed"))
        self.histories = [name for name, f in control.get(
            "functions", {}).items()
            if isinstance(f, dict) and f.get("type") == "materialPointHDF5"]

    def _caseMetrics(self):
        options = {}
        for metric in self.metrics:
            for option, time in metric.options().items():
                options.setdefault(option, []).append(time)
        return [os.environ.get("MPMFOAM_PYTHON", sys.executable), str(
            reference.repository()/"etc"/"python"/"caseMetrics.py"),
            *[w for option, times in options.items()
              for w in (option, *times)]]

    # --- runs ---------------------------------------------------------------

    def run(self, factor, value, settings=None, grid=Fraction(1), seed=None,
            name=None, **about):
        settings = merged({MPM: {"MPM/logInterval": 100}}, settings or {})
        if seed is not None:
            settings = merged(settings, self.placed(seed))
        new = CaseRun(
            name or costStudy.label(factor, value) or factor,
            [self.template], ["setMaterialPoints", "mpmFoam"], settings,
            about={"factor": factor, "value": value,
                   "h": self.grid.h/float(grid), **about},
            grid=self.grid, factor=grid, evaluation=self.evaluation)
        new.path = self.output/"runs"/new.name
        return new

    def placed(self, seed):
        entries = {}
        for cloud in self.clouds:
            entries[f"{cloud}/seed"] = seed
            if self.placement[cloud] == "regular":
                entries[f"{cloud}/placement"] = "jittered"
                entries[f"{cloud}/jitter"] = JITTER
        return {POINTS: entries}

    def base(self):
        return self.run("default", "")

    def gridRun(self, f):
        return self.run("grid", f"h {self.grid.h/float(f):.3g}", grid=f)

    def candidates(self, base):
        """(run, its cost over that of the base)"""
        dim = self.grid.nDim
        wanted = self.factors
        if "scatter" in wanted:
            for seed in range(1, self.seeds + 1):
                yield self.run("scatter", f"seed {seed}", seed=seed), 1
        if "grid" in wanted:
            for f in self.grid.factors:
                if f < 1:
                    yield self.gridRun(f), float(f)**(dim + 1)
        if "points" in wanted:
            n = max(self.points.values())
            for more in (-2, -1, 1, 2):
                counts = {c: v + more for c, v in self.points.items()}
                if min(counts.values()) < 1 or max(counts.values()) > 6:
                    continue
                inlets = {k: max(1, v + more) for c in self.clouds
                          for k, v in self.inlets[c].items()}
                value = " ".join(f"{v**dim}" for v in dict.fromkeys(
                    counts.values())) + "/cell"
                yield self.run("points", value, merged(
                    {POINTS: {f"{c}/pointsPerDirection": v
                              for c, v in counts.items()}},
                    {PROPERTIES: inlets})), ((n + more)/n)**dim
        if "soundSpeed" in wanted and self.liquid:
            c = soundSpeed(base.path, self.liquid)
            for part in (0.5, 0.7, 2) if c else ():
                factor, value, change = next(iter(costStudy.soundSpeeds(
                    self.liquid, [float(f"{part*c:.4g}")])))
                yield self.run(factor, value, change), max(1, part)
        if "stiffness" in wanted and self.solids:
            own = soilSpeed(base, self.grid.h, self.maxCo)
            speeds = [own/2, own/4, own/8] if own else []
            for cap in speeds:
                if self.cap and cap >= self.cap:
                    continue
                factor, value, change = next(iter(costStudy.soilStiffness(
                    [float(f"{cap:.2g}")])))
                yield self.run(factor, value, change), 1
        if "transfer" in wanted:
            if self.liquid:
                for factor, value, change in costStudy.waterTransfers(
                        self.liquid):
                    yield self.run(factor, value, change), 1.2
            for cloud in self.solids:
                other = "FLIP" if self.transfer[cloud] == "APIC" else "APIC"
                yield self.run("transfer", f"{cloud} {other}", {PROPERTIES: {
                    f"{cloud}/transfer": other}}), 1.1
        if "maxCo" in wanted and self.adjusts:
            for Co in (0.25, 0.7):
                if abs(Co - self.maxCo) > 0.01:
                    factor, value, change = next(iter(
                        costStudy.courantNumbers([Co])))
                    yield self.run(factor, value, change), self.maxCo/Co
        if "shape" in wanted:
            for shape in ("linear", "quadraticBSpline", "cubicBSpline"):
                if shape != self.shape:
                    factor, value, change = next(iter(costStudy.shapes(
                        self.clouds, [shape])))
                    yield self.run(factor, value, change), 1.3
        if "output" in wanted:
            yield self.run("output", "7 digits", {"system/controlDict": {
                "writeFormat": "ascii", "writePrecision": 7}}), 1.1
            if self.histories:
                yield self.run("output", "HDF5 single", {
                    "system/controlDict": {
                        f"functions/{name}/precision": "single"
                        for name in self.histories}}), 1

    # --- the budget ---------------------------------------------------------

    def spent(self):
        """CPU time of all runs that are there [s]"""
        total = 0
        for log in (self.output/"runs").glob("*/log.mpmFoam"):
            total += runLog.readLog(log).cpuTime or 0
        return total

    def do(self, run, predicted=None):
        """Run it if there is time for it; True if it is finished"""
        if run.finished():
            run.complete(self.metrics)
            return True
        left = self.budget - self.spent()
        if left <= 0 or (predicted and predicted > left):
            self.skipped.append((run.name, predicted))
            return False
        note = run.path/"overBudget.json"
        if note.is_file() and json.loads(note.read_text())["left"] >= left:
            self.skipped.append((run.name, predicted))
            return False
        try:
            run.make()
            run.cpuLimit = left
            run.run()
        except study.OverLimit:
            run.path.mkdir(exist_ok=True)
            note.write_text(json.dumps({"left": left}))
            self.skipped.append((run.name, predicted))
            print(f"{run.name}: stopped, the budget is used up")
            return False
        except study.RunError as error:
            # Another setting may be one that the case does not bear
            (run.path/"failed.txt").write_text(str(error))
            print(f"{run.name}: {error}", file=sys.stderr)
            return False
        return True

    def cost(self, run):
        return run.log.cpuTime

    def predictGrid(self, f, done):
        """From the nearest grid that was run; its exponent from two of them"""
        known = sorted((float(r.factor), self.cost(r)) for r in done
                       if r.about["factor"] in ("grid", "default"))
        exponent = self.grid.nDim + 1
        if len(known) > 1 and known[-2][1] > 1:
            exponent = np.clip(np.log(known[-1][1]/known[-2][1])
                               / np.log(known[-1][0]/known[-2][0]),
                               self.grid.nDim, self.grid.nDim + 1.5)
        near, cost = min(known, key=lambda k: abs(np.log(k[0]/float(f))))
        return cost*(float(f)/near)**exponent

    def explore(self):
        base = self.base()
        if not self.do(base):
            failed = base.path/"failed.txt"
            if failed.is_file() and not base.finished():
                raise AccuracyCostError(
                    f"{self.case}: the case itself does not run:\n"
                    + failed.read_text())
            # The budget may end before the solver begins
            log = base.path/"log.mpmFoam"
            came = (runLog.readLog(log).time or 0) if log.is_file() else 0
            raise AccuracyCostError(
                f"{self.case}: the case itself takes more than the budget: it "
                f"came to {came:g} s.\n    Allowed: a larger "
                "--budget, or an earlier --endTime")
        for metric in self.metrics:
            metric.read(base.path)
        one = self.cost(base)
        print(f"default: {one:.1f} s of CPU time; budget {self.budget:g} s, "
              f"{self.spent():.0f} s spent", flush=True)

        finer = [f for f in self.grid.factors if f > 1] \
            if "grid" in self.factors else []
        done = [base]

        def reserve():
            """What the finest grid will cost that there is time for"""
            costs = [self.predictGrid(f, done) for f in finer]
            fits = [c for c in costs if c <= FINEST*self.budget]
            return max(fits, default=0)

        todo = [(run, weight*one) for run, weight in self.candidates(base)]
        for run, predicted in sorted(todo, key=lambda t: t[1]):
            if not run.finished() and self.spent() + predicted + reserve() \
                    > FIRST*self.budget:
                self.skipped.append((run.name, predicted))
                continue
            if self.do(run):
                done.append(run)
        # Finer grids, cheap ones first
        for f in finer:
            run = self.gridRun(f)
            predicted = self.predictGrid(f, done)
            if not run.finished() and predicted > max(
                    FINEST*self.budget, 0) :
                self.skipped.append((run.name, predicted))
                continue
            if self.do(run, predicted):
                done.append(run)
        return base, done

    def combinations(self, done, verdict):
        """All bargains together, on the case's grid and on finer ones"""
        base = verdict.base
        if verdict.finest is base:
            return []
        settings, names = {}, []
        for factor in ["points", "soundSpeed", "stiffness", "maxCo"]:
            # Steps tell more surely than times, on the same points
            price = self.cost if factor == "points" else steps
            here = [r for r in done if r.about["factor"] == factor
                    and price(r) < 0.93*price(base)
                    and verdict.shift(r) <= verdict.bargain]
            if here:
                best = min(here, key=price)
                settings = merged(settings, best.settings)
                names.append(best.about["value"])
        if not names:
            return []
        print("together: " + ", ".join(names))
        out = []
        for f in [f for f in self.grid.factors if f < 1] + [Fraction(1)] + [
                f for f in self.grid.factors if 1 < f]:
            if f >= verdict.finest.factor:
                continue
            run = self.run("combined", f"h {self.grid.h/float(f):.3g} "
                           "combined", settings, grid=f,
                           name=costStudy.label(
                               "combined", f"h {self.grid.h/float(f):.3g}"),
                           together=names)
            same = out[-1] if out else None
            predicted = self.predictGrid(f, done) if not same else \
                self.cost(same)*float(f/same.factor)**(self.grid.nDim + 1)
            if self.do(run, predicted):
                out.append(run)
        return out

    def check(self, run):
        """The same with another placement of the points"""
        again = self.run(
            "check", "again: " + (run.about["value"] or "default"),
            run.settings, grid=run.factor, seed=101,
            name=f"check_{run.name}", of=run.name)
        return again if self.do(again, self.cost(run)) else None


def steps(run):
    return run.log.stepCount


def soundSpeed(path, cloud):
    found = re.search(rf"^Speed of sound of {cloud}: (\S+) m/s", (
        path/"log.setMaterialPoints").read_text(errors="replace"),
        re.MULTILINE)
    return float(found[1]) if found else None


def soilSpeed(base, h, maxCo):
    """Wave speed of solids [m/s] where they limit the time step, None else"""
    log = base.log
    soil = sum(n for name, n in log.limiters.items() if "stiffness" in name)
    if 2*soil < sum(log.limiters.values()) or not log.deltaTMean:
        return None
    return maxCo*h/log.deltaTMean


# --- the verdict ------------------------------------------------------------

class Verdict:
    """Errors against the finest run, their uncertainty, and what to take"""

    def __init__(self, owner, done):
        self.owner, self.done = owner, done
        self.base = next(r for r in done if r.about["factor"] == "default")
        grids = sorted((r for r in done
                        if r.about["factor"] in ("grid", "default")),
                       key=lambda r: r.factor)
        self.finest = grids[-1]
        self.parts = {}
        self.metrics = []
        for metric in owner.metrics:
            value = {r.name: metric.read(r.path) for r in done}
            exact = value[self.finest.name]
            size = metric.size(exact)
            if size == 0:
                print(f"{metric.name} is 0 in the finest run: relative "
                      "errors have no meaning, it is left out")
                continue
            self.metrics.append(metric)
            last, order = gridError(metric, [
                (r.about["h"], value[r.name]) for r in grids])
            around = [value[r.name] for r in done
                      if r.about["factor"] in ("scatter", "default")]
            scatter = None
            if len(around) > 1:
                # Standard deviation, from the distances of all pairs
                pairs = [metric.distance(a, b)**2 for i, a in
                         enumerate(around) for b in around[:i]]
                scatter = float(np.sqrt(np.mean(pairs)/2))/size
            self.parts[metric.name] = {
                "exact": exact, "value": value, "size": size, "order": order,
                "finest": last/size if last is not None else None,
                "scatter": scatter,
                "shift": {n: metric.distance(v, value[self.base.name])/size
                          for n, v in value.items()},
                "error": {n: metric.distance(v, exact)/size
                          for n, v in value.items()}}
        if not self.metrics:
            raise AccuracyCostError("no metric is left to judge by")

    def error(self, run):
        """The worst of the metrics"""
        return max(p["error"][run.name] for p in self.parts.values())

    def errorOf(self, run):
        """The same of a run that is not one of those that were judged"""
        return max(m.distance(m.read(run.path), self.parts[m.name]["exact"])
                   / self.parts[m.name]["size"] for m in self.metrics)

    def bound(self, run):
        """Error and its uncertainty, the worst of the metrics; the scatter
        of this run and of the finest, and the error of the finest's grid"""
        return max(p["error"][run.name] + np.sqrt(
            2*(p["scatter"] or 0)**2 + (p["finest"] or 0)**2)
            for p in self.parts.values())

    @property
    def uncertainty(self):
        return max(np.sqrt(2*(p["scatter"] or 0)**2 + (p["finest"] or 0)**2)
                   for p in self.parts.values())

    def shift(self, run):
        """Change from the case as it is, the worst of the metrics"""
        return max(p["shift"][run.name] for p in self.parts.values())

    @property
    def bargain(self):
        """A change that is not one: within the scatter, or 1 %"""
        return max(0.01, 2*max(p["scatter"] or 0
                               for p in self.parts.values()))

    def chosen(self, target):
        """The cheapest run whose error with its uncertainty is within the
        target; None if there is none"""
        if self.finest is self.base:
            return None
        fit = [r for r in self.done
               if r.about["factor"] not in ("scatter", "check")
               and r is not self.finest and self.bound(r) <= target]
        return min(fit, key=lambda r: r.log.cpuTime, default=None)

    def rows(self):
        out = []
        for r in self.done:
            row = costStudy.row(r, self.error(r))
            row["bound"] = self.bound(r)
            row["diskMB"] = r.diskMB
            for name, part in self.parts.items():
                row[f"error:{name}"] = part["error"][r.name]
            out.append(row)
        judged = [r for r in out if r["run"] != self.finest.name
                  and r["factor"] not in ("scatter", "check")]
        best = costStudy.front(judged)
        for r in out:
            r["onFront"] = int(r in best)
        return out, best


def describe(run):
    words = run.about["value"] or "the case as it is"
    if "together" in run.about:
        words = f"h {run.about['h']:.3g}, " + ", ".join(run.about["together"])
    return words


def report(owner, verdict, checks):
    """Table, CSV, figure, and the sentence"""
    results = owner.output/"results"
    results.mkdir(exist_ok=True)
    names = ", ".join(m.name for m in verdict.metrics)
    errorName = f"error of {names}" + (
        " (the worst)" if len(verdict.metrics) > 1 else "") \
        + f", against {verdict.finest.name}"
    rows, best = verdict.rows()
    costStudy.writeTable(rows, results/"accuracyCost.csv", errorName + (
        "; bound: with uncertainty"))
    shown = [r for r in rows if r["run"] != verdict.finest.name]
    if shown:
        costStudy.draw(owner.case.name, errorName,
                       [r for r in shown if r["error"] > 0], best,
                       results/"accuracyCost.png", verdict.uncertainty)
        costStudy.printTable(shown, f"{owner.case.name}: {errorName}")
    text = []
    for name, part in verdict.parts.items():
        percent = lambda v: "unknown" if v is None else f"{100*v:.2g} %"
        order = f" (Richardson, order {part['order']:.2g})" \
            if part["order"] else " (last change of the grid)"
        text.append(
            f"{name}: scatter of placements {percent(part['scatter'])}, error "
            f"left on the finest grid {percent(part['finest'])}"
            + (order if part["finest"] is not None else ""))
    text.append(f"Finest run: {verdict.finest.name}, "
                f"{verdict.finest.log.cpuTime:.0f} s of CPU time")
    groups = {}
    for target in owner.targets:
        run = verdict.chosen(target/100)
        groups.setdefault(run and run.name, (run, []))[1].append(target)
    clauses = []
    for run, targets in groups.values():
        aim = ", ".join(f"{t:g}" for t in targets) + " %"
        if run is None:
            reason = "no finer grid was within the budget" \
                if verdict.finest is verdict.base else \
                "the finest run is itself uncertain by " \
                f"{100*verdict.uncertainty:.2g} %" \
                if verdict.uncertainty > targets[0]/100 else \
                "no cheaper run is as near to the finest"
            clauses.append(f"for {aim} nothing can be promised ({reason})")
            continue
        clause = (f"for {aim} take {describe(run)} "
                  f"(error {100*verdict.error(run):.2g} %, at most "
                  f"{100*verdict.bound(run):.2g} %, "
                  f"{run.log.cpuTime:.3g} s")
        again = checks.get(run.name)
        if again:
            clause += f"; another placement {100*verdict.error(again):.2g} %"
        clauses.append(clause + ")")
    text.append("Accuracy: " + "; ".join(clauses) + ".")
    skipped = dict(owner.skipped)
    for r in rows:
        skipped.pop(r["run"], None)
    if skipped:
        text.append("Not run within the budget: " + ", ".join(
            f"{n} (about {c:.0f} s)" if c else n
            for n, c in skipped.items()))
    print("\n" + "\n".join(text))
    (results/"recommendation.txt").write_text("\n".join(text) + "\n")
    return text


# --- command line -----------------------------------------------------------

def duration(text):
    """1h, 30min, 10m, 90s or a number of seconds"""
    found = re.fullmatch(r"([\d.]+)\s*(h|min|m|s|)", text)
    unit = {"h": 3600, "min": 60, "m": 60, "s": 1, "": 1}
    try:
        seconds = float(found[1])*unit[found[2]]
    except (TypeError, ValueError):
        seconds = 0
    if not seconds > 0:
        raise argparse.ArgumentTypeError(
            f"{text} is no time. Allowed: as 1h, 30min, 90s, > 0")
    return seconds


def listOf(allowed):
    def words(text):
        out = [w for w in text.split(",") if w]
        for word in out:
            if allowed and word not in allowed:
                raise argparse.ArgumentTypeError(
                    f"{word} is not known. Allowed: {', '.join(allowed)}")
        return out
    return words


def parsed(words=None):
    """The arguments; those of the command where none are given"""
    parser = argparse.ArgumentParser(
        prog="accuracyCost",
        description="What accuracy costs for a case: varies one factor at a "
        "time around its settings, cheap runs first, within a budget of CPU "
        "time, and says what to take for 10, 5 and 2 % "
        "(docs/howto/accuracyCost.md). May be interrupted: the next call goes "
        "on, and with a larger budget farther.")
    parser.add_argument("case")
    parser.add_argument("--metrics", type=listOf(None), default=[],
                        metavar="a,b,...", help="names in metrics.json, or "
                        "object/file.dat:column[:max|min|mean|end|<time>]")
    parser.add_argument("--budget", type=duration, default=3600.,
                        help="CPU time of all runs (default: 1h)")
    parser.add_argument("--endTime", type=float, help="of all runs [s]")
    parser.add_argument("--factors", type=listOf(FACTORS), default=FACTORS,
                        metavar="a,b,...",
                        help=f"of {', '.join(FACTORS)} (default: all)")
    parser.add_argument("--seeds", type=int, default=2, help="placements of "
                        "the points beside the case's own (default: 2)")
    parser.add_argument("--targets", type=float, nargs="+",
                        default=[10, 5, 2], metavar="%")
    parser.add_argument("--after", action="append", default=[], metavar="cmd",
                        help="command that adds to metrics.json, in each run")
    parser.add_argument("--output", help="directory (default: "
                        "<case>/accuracyCost)")
    parser.add_argument("--evaluate", action="store_true",
                        help="run nothing")
    a = parser.parse_args(words)
    if a.evaluate:
        a.budget = 0
    return a


def main():
    a = parsed()
    try:
        if not (Path(a.case)/"system"/"controlDict").is_file():
            raise AccuracyCostError(f"{a.case}: no system/controlDict")
        for command in ["setMaterialPoints", "mpmFoam"]:
            if not shutil.which(command):
                raise AccuracyCostError(f"no {command} in PATH")
        work(Study(a.case, a))
    except (AccuracyCostError, FoamFileError, study.RunError) as error:
        sys.exit(f"accuracyCost: {error}")
    except KeyboardInterrupt:
        sys.exit("\naccuracyCost: interrupted; the next call makes the run "
                 "that was under way again and goes on from there")


def usual(path):
    """Metrics where none was asked for"""
    known = metrics.readMetrics(path/"metrics.json")
    found = [k for name in USUAL for k, v in known.items()
             if (k == name or k.startswith(name + "_"))
             and isinstance(v, (int, float)) and v]
    if len(found) > 1:
        found = [k for k in found if not k.startswith("mass")]
    if not found:
        raise AccuracyCostError(
            f"{path/'metrics.json'}: none of the usual metrics is there, and "
            "--metrics is not given.\n    Allowed: " + ", ".join(
                k for k, v in known.items() if not isinstance(v, str)))
    return found


def work(owner):
    verdict, checks = judged(owner)
    report(owner, verdict, checks)


def judged(owner):
    """The verdict on all runs, made as far as the budget goes, and what was
    recommended with other placements, by name"""
    if not owner.metrics:
        if not owner.do(owner.base()):
            owner.explore()             # says why
        owner.metrics = [Metric(m) for m in usual(owner.base().path)]
        print("metrics: " + ", ".join(m.name for m in owner.metrics))
    base, done = owner.explore()
    verdict = Verdict(owner, done)
    combined = owner.combinations(done, verdict)
    verdict = Verdict(owner, done + combined)
    checks = {}
    for target in owner.targets:
        run = verdict.chosen(target/100)
        if run is not None and run.name not in checks:
            again = owner.check(run)
            if again:
                checks[run.name] = again
    return Verdict(owner, done + combined + list(checks.values())), checks


if __name__ == "__main__":
    main()
