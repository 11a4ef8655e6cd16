#!/usr/bin/env python3
"""What each effect of the table at the log's start costs, and that what a scene
does not use costs nothing.

    test/effectsBenchmark/run                 all tables
    test/effectsBenchmark/run water idle      some of: water effects idle
                                              empty table
    test/effectsBenchmark/run --no-times      only what load does not disturb
    test/effectsBenchmark/run --quick         the same with fewer steps

water    mpmFoam on water alone against a program that knows nothing but the
         kernels of water (waterOnly.C): instructions per step, bytes
effects  each effect on and off, where it has something to do
idle     each effect on and off, where it has nothing to do
empty    water in a tank with 1, 10 and 100 times as many empty cells as full
         ones
table    what the parts of the closing table of costs add up to

Instructions are those between two step numbers of two runs from the same
state, by callgrind; start-up and writing drop out. valgrind does not know
AVX-512: where the processor has it, a copy of the repository is built for
x86-64-v3 first (--build DIR, some minutes; kept). The CPU times are of the
build as it is, the shortest of some runs that take turns.

Prints tables and writes effects.json (--json). Judges nothing but what is the
same on each run: instructions are marked where they miss the bound.
"""

import argparse
import copy
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parents[1]
sys.path[:0] = [str(ROOT/"etc"/"python"), str(HERE.parent/"cases")]

from caseBuilder import RHO_S, Setup, box, hydrostatic  # noqa: E402
from mpmfoam.runLog import costs  # noqa: E402

LIBS = '("libmpmFunctionObjects.so")'
WATER_BOUND = 0.5           # % of instructions
IDLE_BOUND = 5              # %
TABLE_BOUND = 3             # % of run
NEVER = 1000000             # steps
TURNS = 5                   # of timed runs

# Steps: (to the first count, to the second), of instructions and of CPU time.
# Both are whole sorting intervals
STEPS, TIMED = (10, 30), (20, 620)
QUICK = (10, 20)


# --- scenes ---------------------------------------------------------------

def numerics(**entries):
    return {"logInterval": NEVER, **entries}


def tank(h=0.005, **entries):
    """A column of water, 14 400 points, that collapses in a tank"""
    return Setup(
        cells=(100, 80), h=h, energy=False, mpm=numerics(), **entries,
        regions={"column": hydrostatic((0, 0), (0.2, 0.2))})


def still(**entries):
    """Water at rest, 9000 points"""
    return Setup(
        cells=(50, 25), h=0.01, energy=False, mpm=numerics(), **entries,
        regions={"pond": hydrostatic((0, 0), (0.5, 0.2))})


FULL = {"rhoS": RHO_S, "d": 2e-3, "e0": 0.818, "E0": 216, "nu": 0.2,
        "n": 0.5, "phiC": 30, "eRef": 0.827, "lambda": 0.0596, "xi": 0.365,
        "Ad": 0.7, "kp": 0.0044, "np": 2.4, "nd": 2.9, "I0": 0.28,
        "muS": 0.577, "muD": 0.660, "PhiC": 0.70, "dPhi": 0.29}
SAND = {"rhoS": RHO_S, "d": 2e-3, "e0": 0.818}
MODELS = {
    "elastoplasticMuI": FULL,
    "DruckerPrager": {**SAND, "E0": 216, "n": 0.5, "nu": 0.2, "phi": 30,
                      "psi": 0},
    "linearElastic": {**SAND, "E": 1e6, "nu": 0.2},
    "rigidSkeleton": SAND}


def sand(model="elastoplasticMuI", **coefficients):
    return {"constitutiveModel": model,
            f"{model}Coeffs": {**MODELS[model], **coefficients}}


FRICTIONAL = {"type": "frictional", "frictionCoefficient": 0.577}


def column(model="elastoplasticMuI", wall=FRICTIONAL, **coefficients):
    """Sand that collapses, 3600 points"""
    return Setup(
        cells=(80, 45), h=0.005, regions={}, energy=False, mpm=numerics(),
        soil=sand(model, **coefficients), soilWall=wall,
        soilRegions={"column": box((0, 0), (0.1, 0.1),
                                   stress="geostatic")})


def bed(model="elastoplasticMuI", wet=False, level=0.2, **coefficients):
    """A bed at rest, 4500 points; wet: under water"""
    setup = Setup(
        cells=(50, 25), h=0.01, energy=False, mpm=numerics(),
        soil=sand(model, **coefficients), soilWall="slip",
        regions={"all": hydrostatic((0, 0), (0.5, level))} if wet else {},
        soilRegions={"bed": box((0, 0), (0.5, 0.1), stress="geostatic",
                                **({"saturated": True} if wet else {}))})
    return setup


def current(**water):
    """Water that flows over a bed, without end, 9000 points"""
    setup = bed("rigidSkeleton", wet=True).cyclic("x")
    setup.regions["all"]["velocity"] = (0.3, 0, 0)
    setup.water = {"transfer": "XAPIC", "pressureQuadrature": "points",
                   **water}
    return setup


def apart(water=True, soil=True):
    """Water and sand at the two ends of a tank, before they meet; together or
    alone they take the same steps, and do the same"""
    return Setup(
        cells=(100, 25), h=0.01, energy=False, mpm=numerics(), soil=sand(),
        control={"adjustTimeStep": False, "deltaT": 2e-5},
        water={"apicRate": 500},
        regions={"pond": hydrostatic((0, 0), (0.3, 0.2))} if water else {},
        soilRegions={"bed": box((0.7, 0), (1, 0.2), stress="geostatic")}
        if soil else {})


def mixture(ns=0.55, drag="DarcyForchheimer", **entries):
    """A saturated column that collapses in water; ns 0.3: suspended"""
    return Setup(
        cells=(50, 30), h=0.01, energy=False, mpm=numerics(), **entries,
        regions={"all": hydrostatic((0, 0), (0.5, 0.2))},
        soil=sand(), interaction={"drag": drag},
        soilRegions={"column": box((0, 0), (0.2, 0.15),
                                   voidRatio=(1 - ns)/ns)})


def channel(open_=True, speed=0.5):
    """Water that runs through; not open: the same between walls"""
    setup = Setup(
        cells=(120, 30), h=0.01, energy=False, mpm=numerics(),
        regions={"water": hydrostatic((0, 0), (1.2, 0.2),
                                      velocity=(speed, 0, 0))})
    if open_:
        setup.sides = {
            "xmin": ("patch", {"type": "fixedValue",
                               "value": f"uniform ({speed} 0 0)"}),
            "xmax": ("patch", "zeroGradient")}
        setup.water["inflowOutflow"] = {
            "inlets": {"left": {"patch": "xmin", "depth": 0.2,
                                "velocity": (speed, 0, 0),
                                "pointsPerDirection": 3}},
            "outlets": {"right": {"type": "patch", "patch": "xmax"}}}
    return setup


def closed():
    """A still pond in a tank with an outlet and an inlet out of its reach"""
    setup = still(sides={
        "ymax": ("patch", {"type": "fixedValue",
                           "value": "uniform (0 0 0)"})})
    setup.water["inflowOutflow"] = {
        "inlets": {"rain": {"patch": "ymax", "velocity": (0, 0, 0),
                            "pointsPerDirection": 3}},
        "outlets": {"above": {"type": "limit", "point": (0, 0.23, 0),
                              "normal": (0, 1, 0)}}}
    return setup


def function(kind, interval=10, cloud="water", **entries):
    return {kind: {"type": kind, "cloud": cloud, "libs": LIBS,
                   "writeControl": "timeStep", "writeInterval": interval,
                   **entries}}


def functions(interval, cloud="water", energy=False):
    out = {**function("frontPosition", interval, cloud,
                      direction=(1, 0, 0)),
           **function("massBalance", interval, cloud)}
    if cloud == "water":
        out.update(function("waveGauge", interval, points=[(0.1, 0, 0.01)]))
    else:
        out.update(function("scourProfile", interval, cloud,
                            direction=(1, 0, 0)))
    if energy:
        out = function("materialPointEnergy", interval, cloud)
    return out


def probes(interval):
    return {"probes": {"type": "probes", "libs": '("libsampling.so")',
                       "fields": ["p"], "probeLocations": [(0.1, 0.1, 0.002)],
                       "writeControl": "timeStep", "writeInterval": interval}}


def changed(setup, **sections):
    """A copy with other entries; functions are replaced"""
    other = copy.deepcopy(setup)
    for name, entries in sections.items():
        if name == "functions":
            other.functions = entries
        else:
            getattr(other, name).update(entries)
    return other


def pairs(setup, rows):
    """With and without, for changes of one setup"""
    return [(name, changed(setup, **on), changed(setup, **off))
            for name, on, off in rows]


def effectRows():
    """Name, with the effect, without it"""
    points = {"transfer": "XAPIC", "pressureQuadrature": "points"}
    rows = pairs(tank(), [
        ("viscous stress", {}, {"fluid": {"mu": 0}}),
        ("pressure smoothing", {}, {"mpm": {"smoothing": False}}),
        ("volume correction", {}, {"mpm": {"volumeCorrection": False}}),
        ("tension cut-off", {"water": {"tensionCutOff": True}}, {}),
        ("APIC for FLIP", {}, {"water": {"transfer": "FLIP"}}),
        ("XPIC for FLIP", {"water": {"transfer": "XPIC"}},
         {"water": {"transfer": "FLIP"}}),
        ("XAPIC for APIC", {"water": points}, {}),
        ("pressure by cells for points", {"water": {"transfer": "XAPIC"}},
         {"water": points}),
        ("BinghamPapanastasiou", {"water": {
            "viscosityModel": "BinghamPapanastasiou",
            "BinghamPapanastasiouCoeffs": {"tau0": 1e-4, "m": 1}}}, {}),
        ("Smagorinsky", {"water": {**points, "turbulence": "Smagorinsky"}},
         {"water": points}),
        ("kEpsilon", {"water": {
            **points, "turbulence": "kEpsilon",
            "kEpsilonCoeffs": {"k": 1e-3, "epsilon": 1e-3}}},
         {"water": points}),
        ("realizableKE", {"water": {
            **points, "turbulence": "realizableKE",
            "realizableKECoeffs": {"k": 1e-3, "epsilon": 1e-3}}},
         {"water": points}),
        ("energy, each 10 steps", {"functions": functions(10, energy=True)},
         {}),
        ("front, gauge, balance, each 10", {"functions": functions(10)}, {}),
        ("probes of p, each 10", {"functions": probes(10)}, {}),
        ("log, each 10", {"mpm": {"logInterval": 10}}, {})])
    rows.append(("kEpsilon over a bed", current(
        turbulence="kEpsilon", kEpsilonCoeffs={"k": 1e-3, "epsilon": 1e-3}),
        current()))
    mud = {"viscosityModel": "BinghamPapanastasiou",
           "BinghamPapanastasiouCoeffs": {"tau0": 0.02, "m": 50}}
    rows.append(("viscous stages (10) for explicit", tank(water={
        **mud, "viscousStep": "stages"}), tank(water=mud)))
    rows.append(("inlet and outlet", channel(), channel(open_=False)))
    rows.append(("roughWall for slip",
                 tank(wall={"type": "roughWall", "ks": 1e-3}), tank()))
    rows += [
        ("linearElastic for rigidSkeleton", column("linearElastic"),
         column("rigidSkeleton")),
        ("DruckerPrager for linearElastic", column("DruckerPrager"),
         column("linearElastic")),
        ("elastoplasticMuI for DruckerPrager", column(),
         column("DruckerPrager")),
        ("soil: smoothing", column(),
         changed(column(), mpm={"smoothing": False})),
        ("soil: frictional walls", column(), column(wall="noSlip")),
        ("soil: front, balance, scour, each 10", changed(
            column(), functions=functions(10, "soil")), column()),
        ("drag", mixture(), mixture(drag="none")),
        ("Gidaspow for DarcyForchheimer", mixture(drag="Gidaspow"),
         mixture()),
        ("suspended for in contact", mixture(ns=0.3), mixture())]
    return rows


def idleRows():
    """The same; None: without is what the two clouds cost alone"""
    dry = apart()
    # Nothing moves, not even by what smoothing rounds off: all rates of strain
    # are zero
    rest = changed(still(g=(0, 0, 0), fluid={"soundSpeed": 10}),
                   mpm={"smoothing": False, "volumeCorrection": False})
    rest.regions = {"pond": box((0, 0), (0.5, 0.2))}
    return [
        ("Smagorinsky: water at rest",
         changed(rest, water={"turbulence": "Smagorinsky", "transfer": "APIC"}),
         rest),
        ("coupling: soil far from the water", dry, None),
        ("drag: soil far from the water", dry,
         changed(dry, interaction={"drag": "none"})),
        ("viscous stress: still water", still(),
         changed(still(), fluid={"mu": 0})),
        ("tension cut-off: no tension",
         changed(still(), water={"tensionCutOff": True}), still()),
        ("open boundaries: no flow", closed(), still()),
        ("function objects: not due",
         changed(tank(), functions=functions(NEVER)), tank()),
        ("energy: not due",
         changed(tank(), functions=functions(NEVER, energy=True)), tank()),
        ("probes: not due", changed(tank(), functions=probes(NEVER)),
         tank()),
        ("soil: energy, not due", changed(
            column(), functions=functions(NEVER, "soil", energy=True)),
         column()),
        ("suspended regime: bed at rest", bed(wet=True),
         bed(wet=True, nsC=1e-3)),
        ("bed load: bed at rest", bed(),
         bed(bedLoadI=1e9, bedLoadSpeed=1e9)),
        ("cap of the stiffness: not reached",
         changed(column(), mpm={"maxSoilSoundSpeed": 1e4}), column())]


def emptyTank(factor, energy=False):
    """A column of 40 x 40 cells in a tank with that many times more empty
    cells"""
    extra = {1: (80, 40), 10: (220, 80), 100: (1010, 160)}[factor]
    return Setup(
        cells=extra, h=0.005, energy=False, mpm=numerics(),
        functions=functions(NEVER, energy=True) if energy else {},
        regions={"column": hydrostatic((0, 0), (0.2, 0.2))})


# --- measuring ------------------------------------------------------------

class Build:
    """Programs that valgrind can run"""

    def __init__(self, directory):
        self.environment = dict(os.environ)
        if "avx512" not in Path("/proc/cpuinfo").read_text():
            return
        directory = Path(directory).resolve()
        source = directory/"source"
        source.mkdir(parents=True, exist_ok=True)
        print(f"x86-64-v3 for valgrind in {directory} "
              "(minutes at the first time)", flush=True)
        files = subprocess.run(
            ["git", "ls-files", "-z", "-co", "--exclude-standard", "Allwmake",
             "src", "etc", "applications/solvers", "test/effectsBenchmark"],
            cwd=ROOT, capture_output=True, check=True).stdout
        for name in files.decode().split("\0"):
            own, other = ROOT/name, source/name
            if not own.is_file() or (
                    other.is_file()
                    and other.read_bytes() == own.read_bytes()):
                continue
            other.parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(own, other)
        self.environment.update(
            MPMFOAM_ARCH="x86-64-v3",
            FOAM_USER_LIBBIN=str(directory/"lib"),
            FOAM_USER_APPBIN=str(directory/"bin"),
            PATH=f"{directory/'bin'}:{os.environ['PATH']}",
            LD_LIBRARY_PATH=f"{directory/'lib'}:"
                            f"{os.environ.get('LD_LIBRARY_PATH', '')}")
        for part in ["lib", "bin"]:
            (directory/part).mkdir(exist_ok=True)
        result = subprocess.run(
            ["./Allwmake", "-tests", "-j"], cwd=source, text=True,
            capture_output=True, env=self.environment)
        if result.returncode:
            sys.exit(result.stdout[-1000:] + result.stderr)


class Measurement:
    """A case at a state from which runs of some steps start"""

    def __init__(self, case, steps):
        self.case = case
        self.index = 0
        case.setup.control.update(timePrecision=10)
        if steps:
            case.setup.steps(steps)
            case.rewrite()
            case.solve()
            self.index = steps
        self.start = case.timesByStep()[self.index]

    def run(self, command, n, environment=None):
        """Output and CPU time of a program that takes n steps from the start
        state"""
        case = self.case
        case.setup.steps(self.index + n)
        case.setup.control.update(startFrom="startTime",
                                  startTime=self.start)
        case.rewrite()
        with open(case.path/"log.run", "w") as out:
            process = subprocess.Popen(
                command, cwd=case.path, stdout=out, stderr=subprocess.STDOUT,
                env={**(environment or os.environ), "PWD": str(case.path)})
            _, status, usage = os.wait4(process.pid, 0)
        text = (case.path/"log.run").read_text(errors="replace")
        if status:
            sys.exit(f"{command} in {case.path} failed:\n{text[-2000:]}")
        for time in case.times:
            if time not in ("0", self.start):
                shutil.rmtree(case.path/time)
        return text, usage.ru_utime + usage.ru_stime

    def instructions(self, build, steps, command=("mpmFoam",)):
        """Per step"""
        counts = []
        for n in steps:
            line = list(command)
            if command[0] == "mpmWaterOnly":
                line += ["-steps", str(n)]
            text, _ = self.run(
                ["valgrind", "--tool=callgrind",
                 f"--callgrind-out-file={self.case.path}/callgrind.{n}",
                 *line], n, build.environment)
            self.text = text
            counts.append(int(re.search(r"Collected : (\d+)", text)[1]))
        return (counts[1] - counts[0])/(steps[1] - steps[0])

    @property
    def points(self):
        return sum(int(self.case.state(self.start, cloud)["nPoints"])
                   for cloud in self.case.setup.clouds)


def times(measurements, steps=TIMED, turns=TURNS):
    """CPU seconds per step of cases, in turns"""
    best = [[1e9, 1e9] for _ in measurements]
    for _ in range(turns):
        for m, shortest in zip(measurements, best):
            for i, n in enumerate(steps):
                shortest[i] = min(shortest[i], m.run(["mpmFoam"], n)[1])
    return [(b[1] - b[0])/(steps[1] - steps[0]) for b in best]


class Bench:
    def __init__(self, work, build, quick, timed):
        self.work, self.build, self.timed = work, build, timed
        self.steps = QUICK if quick else STEPS
        self.made = 0

    def prepare(self, setup, develop):
        self.made += 1
        path = self.work/f"case{self.made}"
        case = copy.deepcopy(setup).write(path).prepare()
        return Measurement(case, develop)

    def drop(self, *measurements):
        for m in measurements:
            shutil.rmtree(m.case.path)

    def water(self):
        """mpmFoam and the program that knows water only"""
        m = self.prepare(tank(), 300)
        own = m.instructions(self.build, self.steps)
        text = m.text
        log = changed(m.case.setup, mpm={"logInterval": 10})
        alone = m.instructions(self.build, self.steps, ("mpmWaterOnly",))
        other = m.text
        m.case.setup = log
        logged = m.instructions(self.build, self.steps)
        memory = re.search(r"^    water: (\S+) bytes per point, (\S+) MB",
                           text, re.MULTILINE)
        bytes_ = re.search(r"bytes of points (\d+) of nodes (\d+)", other)
        points, n = m.points, max(1, m.points)
        out = {
            "points": points,
            "instructions_mpmFoam": own, "instructions_waterOnly": alone,
            "extraPercent": 100*(own/alone - 1),
            "extraPercent_log10": 100*(logged/alone - 1),
            "bytesPerPoint_mpmFoam": float(memory[1]),
            "bytesPerPoint_waterOnly": int(bytes_[1])/n,
            "nodeMB_mpmFoam": float(memory[2]),
            "nodeMB_waterOnly": int(bytes_[2])/1e6,
            "soilArrays": len(re.findall(
                r"^    (?:soil|coupling): .*(?:bytes|MB)", text,
                re.MULTILINE))}
        table(f"Water alone, {points} points", ["", "mpmFoam", "water only"], [
            ["instructions per step", f"{own:.0f}", f"{alone:.0f}"],
            ["bytes per point", memory[1], f"{int(bytes_[1])/n:g}"],
            ["MB on nodes", memory[2], f"{int(bytes_[2])/1e6:g}"]])
        print(f"    more instructions: {out['extraPercent']:.3f} % "
              f"(<= {WATER_BOUND} %{mark(out['extraPercent'], WATER_BOUND)})"
              f"; with a log each 10 steps {out['extraPercent_log10']:.3f} %"
              f"\n    arrays of soil or coupling: {out['soilArrays']}")
        self.drop(m)
        return out

    def compare(self, name, on, off, develop):
        """Instructions and CPU time with and without an effect"""
        alone = off is None
        cases = [self.prepare(on, develop)] + (
            [self.prepare(apart(soil=False), develop),
             self.prepare(apart(water=False), develop)] if alone
            else [self.prepare(off, develop)])
        points = [m.points for m in cases]

        def perPoint(values):
            return values[0]/points[0], sum(values[1:])/sum(points[1:])

        with_, without = perPoint(
            [m.instructions(self.build, self.steps) for m in cases])
        row = {"points": points[0], "instructionsWith": with_,
               "instructionsWithout": without,
               "instructionsPercent": 100*(with_/without - 1)}
        if self.timed:
            with_, without = perPoint(times(cases))
            row.update(nsWith=1e9*with_, nsWithout=1e9*without,
                       cpuPercent=100*(with_/without - 1))
        self.drop(*cases)
        return row

    def rows(self, title, rows, develop, bound=None):
        out = {}
        print(f"\n{title}\n    {'':38}{'points':>7}{'instr':>9}{'without':>9}"
              f"{'cost %':>8}{'ns':>8}{'without':>9}{'cost %':>8}")
        for name, on, off in rows:
            r = out[name] = self.compare(name, on, off, develop)
            print(f"    {name:38}{r['points']:7d}{r['instructionsWith']:9.1f}"
                  f"{r['instructionsWithout']:9.1f}"
                  f"{r['instructionsPercent']:8.2f}" + (
                      f"{r['nsWith']:8.1f}{r['nsWithout']:9.1f}"
                      f"{r['cpuPercent']:8.1f}" if "nsWith" in r else "")
                  + (mark(r["instructionsPercent"], bound) if bound else ""),
                  flush=True)
        return out

    def effects(self):
        return self.rows("Effects at work: per point and step",
                         effectRows(), 300)

    def idle(self):
        return self.rows(f"Idle effects: per point and step, <= {IDLE_BOUND}"
                         " %", idleRows(), 20, IDLE_BOUND)

    def empty(self):
        """More empty cells, also with the energy balance"""
        out = {}
        for energy in [False, True]:
            cases = [self.prepare(emptyTank(f, energy), 20)
                     for f in (1, 10, 100)]
            n = cases[0].points
            counts = [m.instructions(self.build, self.steps) for m in cases]
            cpu = times(cases) if self.timed else [float("nan")]*3
            name = "emptyWithEnergy" if energy else "empty"
            table("More empty cells" + (", with energy" if energy else "")
                  + ": per point and step",
                  ["times", "instr", "more %", "ns", "more %"],
                  [[str(f), f"{c/n:.1f}", f"{100*(c/counts[0] - 1):.2f}"
                    + mark(100*(c/counts[0] - 1), IDLE_BOUND),
                    f"{1e9*t/n:.1f}", f"{100*(t/cpu[0] - 1):.1f}"]
                   for f, c, t in zip((1, 10, 100), counts, cpu)])
            for f, c, t in zip((1, 10, 100), counts, cpu):
                out[f"{name}{f}"] = {
                    "instructions": c/n, "ns": 1e9*t/n,
                    "instructionsPercent": 100*(c/counts[0] - 1),
                    "cpuPercent": 100*(t/cpu[0] - 1)}
            self.drop(*cases)
        return out

    def table(self):
        """Sum of the closing table of costs"""
        out, rows = {}, []
        for name, setup in [
                ("water", changed(tank(), functions=functions(10))),
                ("soil", column()), ("water and soil", mixture()),
                ("inlet and outlet", channel())]:
            m = self.prepare(setup, 600)
            parts = costs((m.case.path/"log.mpmFoam").read_text())
            total = parts.pop("total")
            share = sum(p[1] for p in parts.values())
            out[name] = {"sumPercent": share, "otherPercent":
                         parts["other"][1], "parts": len(parts)}
            rows.append([name, str(len(parts)), f"{share:.1f}"
                         + mark(abs(share - 100), TABLE_BOUND),
                         f"{parts['other'][1]:.1f}", f"{total[0]:.3f}"])
            self.drop(m)
        table("Closing table of costs",
              ["", "parts", "sum %", "without a name %", "total s"], rows)
        return out


def mark(value, bound):
    return "" if value <= bound else "  MISSED"


def table(title, columns, rows):
    widths = [max(len(r[i]) for r in [columns] + rows)
              for i in range(len(columns))]
    print(f"\n{title}")
    for row in [columns] + rows:
        print("    " + row[0].ljust(widths[0]) + "".join(
            "  " + c.rjust(w) for c, w in zip(row[1:], widths[1:])),
            flush=True)


TABLES = ["water", "effects", "idle", "empty", "table"]


def main():
    parser = argparse.ArgumentParser(
        description=__doc__,
        formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tables", nargs="*", metavar="table",
                        help="of " + " ".join(TABLES) + " (default: all)")
    parser.add_argument("--quick", action="store_true",
                        help="few steps, no times")
    parser.add_argument("--no-times", action="store_true",
                        help="instructions only")
    parser.add_argument("--build", metavar="DIR", type=Path,
                        default=HERE/"valgrindBuild",
                        help="default: %(default)s")
    parser.add_argument("--json", metavar="FILE", type=Path,
                        default=Path("effects.json"))
    args = parser.parse_args()
    for name in args.tables:
        if name not in TABLES:
            parser.error(f"unknown table {name}; there are "
                         f"{' '.join(TABLES)}")
    if not shutil.which("valgrind"):
        sys.exit("no valgrind: run etc/provision")

    build = Build(args.build)
    results = {}
    with tempfile.TemporaryDirectory(prefix="mpmEffects.") as work:
        bench = Bench(Path(work), build, args.quick,
                      not (args.quick or args.no_times))
        for name in args.tables or TABLES:
            results[name] = getattr(bench, name)()
            args.json.write_text(json.dumps(results, indent=4) + "\n")
    print(f"\nWritten to {args.json}")


if __name__ == "__main__":
    main()
