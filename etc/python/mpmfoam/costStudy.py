"""What accuracy costs in time, for scenes and for any case: factors that are
varied one at a time, what a run cost, table, figure, and the runs that nothing
beats. Users: validation/accuracyCost (scenes), accuracyCost (a user's case)."""

import re
import textwrap

from . import reference, study

MPM = "system/fvSolution"
PROPERTIES = "constant/materialPointProperties"
POINTS = "system/setMaterialPointsDict"

MARKERS = {"default": "*", "grid": "o", "points": "s", "shape": "^",
           "transfer": "D", "smoothing": "v", "maxCo": "P", "stiffness": "X",
           "soundSpeed": "h", "output": "d", "scatter": ".", "combined": "p",
           "check": "1", "interFoam": "o"}


def merged(*parts):
    """Settings (file -> entry -> value) laid over each other"""
    out = {}
    for part in parts:
        for file, entries in part.items():
            out.setdefault(file, {}).update(entries)
    return out


# --- factors: (factor, value as text, settings) ---------------------------

def shapes(clouds, values=("linear", "cubicBSpline")):
    """APIC with linear functions is refused: FLIP there"""
    for shape in values:
        change = {MPM: {"MPM/shapeFunction": shape}}
        if shape == "linear":
            change[PROPERTIES] = {f"{c}/transfer": "FLIP" for c in clouds}
        yield "shape", shape, change


def courantNumbers(values):
    for maxCo in values:
        yield "maxCo", f"Co {maxCo:g}", {MPM: {"MPM/maxCo": maxCo}}


def waterTransfers(cloud="water"):
    for name, entries in [
            ("PIC", {"transfer": "PIC"}),
            ("XPIC", {"transfer": "XPIC"}),
            ("FLIP", {"transfer": "FLIP", "flipDampingRate": 20}),
            ("APIC 1e9/s", {"apicRate": 1e9})]:
        yield "transfer", name, {PROPERTIES: {
            f"{cloud}/{k}": v for k, v in entries.items()}}


def soilStiffness(caps):
    """Caps of the wave speed of solids [m/s]"""
    for cap in caps:
        yield ("stiffness", f"{cap:.3g} m/s",
               {MPM: {"MPM/maxSoilSoundSpeed": f"{cap:.6g}"}})


def soundSpeeds(cloud, speeds):
    """Of the liquid [m/s]"""
    for c in speeds:
        yield "soundSpeed", f"{c:.3g} m/s", {PROPERTIES: {
            f"{cloud}/weaklyCompressibleNewtonianCoeffs/soundSpeed":
            f"{c:.6g}" if isinstance(c, float) else c}}


def label(*words):
    """Part of the name of a run"""
    return "_".join(filter(None, words)).replace(" ", "").replace("/", "per")


class Scene:
    """A default and, one at a time, what is changed of it. A variant is
    (factor, value as text, cells per default cell, points per direction,
    settings)."""

    title = errorName = None
    clouds = ["water"]
    h = points = None           # default
    grids = []                  # cells per default cell
    pointCounts = []

    def template(self):
        return reference.repository()/"tutorials"/self.name

    @property
    def name(self):
        return type(self).__name__[0].lower() + type(self).__name__[1:]

    def settings(self, finer, points):
        """What a grid and a number of points ask for"""
        raise NotImplementedError

    def files(self, finer):
        return {}

    def reference(self):
        """Grid and points of the run that counts as exact; none if there is
        analysis"""
        return None

    def atDefault(self, factors):
        """Variants on the default's grid and points"""
        for factor, value, change in factors:
            yield factor, value, 1, self.points, change

    def common(self):
        """Numerics that all scenes try"""
        yield from self.atDefault(shapes(self.clouds))
        yield from self.atDefault(courantNumbers([0.1, 0.25, 0.7]))
        yield ("smoothing", "none", 1, self.points,
               {MPM: {"MPM/smoothing": "no"}})

    def waterTransfers(self):
        yield from self.atDefault(waterTransfers())

    def variants(self):
        yield "default", "", 1, self.points, {}
        for finer in self.grids:
            yield "grid", f"h {self.h/finer:.3g}", finer, self.points, {}
        for n in self.pointCounts:
            yield "points", f"{n*n}/cell", 1, n, {}
        yield from self.common()

    def runs(self):
        variants = list(self.variants())
        if self.reference():
            finer, points = self.reference()
            variants.append(("reference", "", finer, points, {}))
        for factor, value, finer, points, change in variants:
            yield study.Run(
                self.label(factor, value), [self.template()], study.MPMFOAM,
                merged(self.settings(finer, points),
                       {MPM: {"MPM/logInterval": 100}}, change),
                self.files(finer),
                about={"scene": self.name, "factor": factor, "value": value,
                       "h": self.h/finer})

    def label(self, *words):
        return f"{self.name}/" + label(*words)

    def ready(self, done):
        return not self.reference() or self.label("reference") in done

    def isReference(self, run):
        return run.about["factor"] == "reference"

    def error(self, run, done):
        raise NotImplementedError

    def more(self, rows, done):
        return {}


# --- what a run cost ------------------------------------------------------

def memory(run):
    """Of points and nodal fields [MB], from the table at the log's start"""
    text = (run.path/"log.mpmFoam").read_text(errors="replace")
    counts = dict(re.findall(r"Cloud (\w+): (\d+) points", (
        run.path/"log.setMaterialPoints").read_text(errors="replace")))
    total = sum(float(nodes) for nodes in re.findall(
        r"^    coupling: (\S+) MB on nodes", text, re.MULTILINE))
    for cloud, perPoint, nodes in re.findall(
            r"^    (\w+): (\S+) bytes per point, (\S+) MB on nodes", text,
            re.MULTILINE):
        total += float(nodes) + 1e-6*float(perPoint)*int(counts[cloud])
    return total


def row(run, error):
    about, log = run.about, run.log
    own = run.commands[-1] == "mpmFoam"
    return {"run": run.name.split("/")[-1], "factor": about["factor"],
            "value": about["value"], "h": about["h"], "error": error,
            "cpuTime": log.cpuTime, "wallTime": log.wallTime,
            "stepCount": log.stepCount,
            "memoryMB": memory(run) if own else float("nan")}


def front(rows):
    """Those that no other run beats in both error and time"""
    return [r for r in rows if not any(
        o["error"] <= r["error"] and o["cpuTime"] <= r["cpuTime"]
        and o is not r for o in rows)]


# --- table and figure -----------------------------------------------------

def writeTable(rows, path, errorName):
    reference.writeCsv(
        path, {k: [r[k] for r in rows] for k in rows[0]},
        f"error: {errorName}; s, m, MB; {study.commit()}")


def printTable(rows, title):
    width = max(24, *(len(r["run"]) + 2 for r in rows))
    print(f"\n{title}")
    print(f"{'run':<{width}}{'error':>10}{'CPU s':>9}{'steps':>9}{'MB':>7}")
    for r in sorted(rows, key=lambda r: r["error"]):
        print(f"{r['run']:<{width}}{r['error']:10.4g}{r['cpuTime']:9.1f}"
              f"{r['stepCount']:9d}{r['memoryMB']:7.1f}"
              + ("  *" if r["onFront"] else ""))


def draw(title, errorName, rows, best, path, floor=None):
    """Error over CPU time, both logarithmic. floor: below it errors cannot be
    told apart"""
    from . import style

    fig, panel = style.plt.subplots(figsize=(6.3, 4.2),
                                    layout="constrained")
    for factor, marker in MARKERS.items():
        here = [r for r in rows if r["factor"] == factor]
        if not here:
            continue
        if factor in ("grid", "interFoam"):
            here = sorted(here + [r for r in rows if r["factor"] == "default"
                                  and factor == "grid"],
                          key=lambda r: r["cpuTime"])
        panel.loglog([r["cpuTime"] for r in here], [r["error"] for r in here],
                     marker + ("-" if factor in ("grid", "interFoam") else ""),
                     ms=11 if factor == "default" else 5,
                     color={"default": "black", "grid": style.MPM,
                            "interFoam": style.INTERFOAM}.get(factor),
                     mfc=None if factor != "grid" else "white",
                     label=factor, zorder=3 if factor == "default" else 2)
    default = [r for r in rows if r["factor"] == "default"]
    for r in rows:
        # Those that cannot be told from the default would hide each other
        if r["factor"] not in ("scatter", "check") and not any(
                abs(r["error"]/d["error"] - 1) < 0.05
                and abs(r["cpuTime"]/d["cpuTime"] - 1) < 0.2
                for d in default if d["error"] > 0):
            panel.annotate(" " + r["value"], (r["cpuTime"], r["error"]),
                           fontsize=6, color="0.3")
    best = sorted(best, key=lambda r: r["cpuTime"])
    panel.step([r["cpuTime"] for r in best], [r["error"] for r in best],
               where="post", color="0.6", lw=0.8, ls="--",
               label="nothing is better and cheaper", zorder=1)
    if floor:
        panel.axhline(floor, color="0.8", lw=1, zorder=0,
                      label="uncertainty of the errors")
    panel.set(xlabel="CPU time [s]", title=title,
              ylabel=textwrap.fill(errorName, 44))
    panel.legend(fontsize=7)
    style.save(fig, path)
