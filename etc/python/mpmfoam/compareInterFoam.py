"""Runs a case with mpmFoam and with interFoam and lays the results over each
other: see docs/howto/fromInterFoam.md."""

import os
import shutil
import subprocess
import sys
import time as clock
from pathlib import Path

import numpy as np

from . import foamDict, foamFile, fromInterFoam, metrics, reference, runLog
from . import toInterFoam
from .case import Case
from .foamFile import FoamFileError
from .mesh import Mesh


class Run:
    """One of the two, by its fields on the mesh; both by the same formulas"""

    def __init__(self, path, solver):
        self.path, self.solver = Path(path), solver
        self.case = Case(self.path)
        self.mesh = Mesh(self.path)
        self.log = runLog.readLog(self.path/f"log.{solver}")
        if solver == "mpmFoam":
            self.alphaName, self.velocityName = "alpha.water", "U.water"
            self.rho = foamDict.number(foamDict.read(
                self.path/"constant"/"materialPointProperties",
                "water/weaklyCompressibleNewtonianCoeffs")["rho0"])
        else:
            d = foamDict.read(self.path/"constant"/"transportProperties")
            phase = d["phases"][0]
            self.alphaName, self.velocityName = f"alpha.{phase}", "U"
            rho = d[phase]["rho"]
            self.rho = foamDict.number(rho[-1] if isinstance(rho, list)
                                       else rho)
        self.g = np.array([foamDict.number(v) for v in foamDict.read(
            self.path/"constant"/"g")["value"]])
        self.empty = self.mesh.emptyDirection
        # Those with fields; mpmFoam's start has none
        self.times = [t for t in self.case.times()
                      if foamFile.stored(self.path/t/self.alphaName)]
        self._cache = {}

    @property
    def cpuPerSecond(self):
        """One of the two may have been ended earlier"""
        return self.log.cpuTime/self.log.time

    def alpha(self, time):
        if time not in self._cache:
            self._cache[time] = np.clip(foamFile.readInternalField(
                self.path/time/self.alphaName, self.mesh.nCells), 0, 1)
        return self._cache[time]

    def velocity(self, time):
        return foamFile.readInternalField(
            self.path/time/self.velocityName, self.mesh.nCells)

    def volume(self, time):
        return float((self.alpha(time)*self.mesh.volumes).sum())

    def energy(self, time):
        """Kinetic, and potential above that of the same volume at rest in the
        lowest cells [J]"""
        mesh = self.mesh
        height = -(mesh.centres @ self.g)
        v = self.alpha(time)*mesh.volumes
        order = np.argsort(height)
        room = mesh.volumes[order]
        rest = np.clip(v.sum() - np.cumsum(room) + room, 0, room)
        return (self.rho*float((0.5*v*(self.velocity(time)**2).sum(
                    axis=1)).sum()),
                self.rho*float((v*height).sum()
                               - (rest*height[order]).sum()))


class Sampler:
    """Fields of cells on a lattice for both codes: the cell of each place"""

    def __init__(self, run, axes):
        self.cells = run.mesh.cellsAt(axes)

    def __call__(self, values):
        """nan outside of the mesh: array [z, y, x]"""
        return np.where(self.cells >= 0,
                        np.take(values, np.maximum(self.cells, 0)), np.nan)


class Comparison:
    def __init__(self, mpm, inter, gauges=None):
        self.mpm, self.inter = mpm, inter
        common = [(t, min(inter.times, key=lambda u: abs(float(u) - float(t))))
                  for t in mpm.times]
        self.times = [(a, b) for a, b in common
                      if abs(float(a) - float(b)) < 1e-6*max(float(a), 1e-6)
                      + 1e-9 and float(a) > 0]
        if not self.times:
            raise FoamFileError(
                f"{mpm.path}, {inter.path}: no write times in common")
        self.t = np.array([float(a) for a, _ in self.times])
        low = np.maximum(mpm.mesh.bounds[0], inter.mesh.bounds[0])
        high = np.minimum(mpm.mesh.bounds[1], inter.mesh.bounds[1])
        self.low, self.high, self.empty = low, high, mpm.empty
        h = fromInterFoam.cellSize(mpm.mesh)
        self.h = h
        # Half a cell of mpmFoam: finer than what either resolves
        self.axes = []
        for d in range(3):
            n = 1 if d == self.empty else max(
                1, int(round(2*(high[d] - low[d])/h)))
            self.axes.append(low[d] + (np.arange(n) + 0.5)
                             * (high[d] - low[d])/n)
        self.up = int(np.argmax(np.abs(mpm.g)))
        self.along = next(d for d in range(3)
                          if d != self.up and d != self.empty)
        self.across = next(d for d in range(3)
                           if d not in (self.up, self.along))
        self.samplers = {r: Sampler(r, self.axes) for r in (mpm, inter)}
        if gauges is None:
            gauges = [low[self.along] + s*(high - low)[self.along]
                      for s in (0.25, 0.5, 0.75)]
        self.gauges = gauges
        self._series()

    def sampled(self, run, time):
        return self.samplers[run](run.alpha(time))

    def slice(self, run, time):
        """alpha in the middle of the domain: coordinates along and up,
        values [up, along]"""
        values = self.sampled(run, time)
        axis = 2 - self.across
        values = np.take(values, values.shape[axis]//2, axis=axis)
        # Remaining order of axes: of z, y, x without across
        if self.up < self.along:
            values = values.T
        # Two places are a cell of mpmFoam: the mean of those in the mesh
        x, y = self.axes[self.along], self.axes[self.up]
        ny, nx = len(y)//2, len(x)//2
        four = values[:2*ny, :2*nx].reshape(ny, 2, nx, 2)
        inside = np.isfinite(four)
        count = inside.sum(axis=(1, 3))
        mean = np.where(inside, four, 0).sum(axis=(1, 3)) \
            / np.maximum(count, 1)
        return (x[:2*nx].reshape(nx, 2).mean(axis=1),
                y[:2*ny].reshape(ny, 2).mean(axis=1),
                np.where(count >= 2, mean, np.nan))

    def depths(self, run, time):
        """Depth over the coordinate along, mean across"""
        values = np.nan_to_num(self.sampled(run, time))
        step = np.diff(self.axes[self.up])[0]
        depth = values.sum(axis=2 - self.up)*step
        # What is left: two of z, y, x; mean over the one across
        left = [d for d in (2, 1, 0) if d != self.up]
        return depth.mean(axis=left.index(self.across))

    def front(self, run, time):
        """Farthest place along of the contour alpha = 0.5, in all of the
        tank"""
        x = self.axes[self.along]
        values = np.nan_to_num(self.sampled(run, time))
        rows = np.moveaxis(values, 2 - self.along, -1).reshape(-1, len(x))
        wet = rows >= 0.5
        places = np.nonzero(wet.any(axis=0))[0]
        if not len(places):
            return self.low[self.along]
        i = places[-1]
        if i + 1 == len(x):
            return self.high[self.along]
        p, q = rows[wet[:, i], i], rows[wet[:, i], i + 1]
        return x[i] + (x[i + 1] - x[i])*float(((p - 0.5)/(p - q)).max())

    def _series(self):
        x = self.axes[self.along]
        self.series = {}
        for run, k in [(self.mpm, 0), (self.inter, 1)]:
            s = {"front": [], "volume": [], "kinetic": [], "potential": [],
                 "gauges": [], "profile": []}
            for pair in self.times:
                time = pair[k]
                depth = self.depths(run, time)
                s["front"].append(self.front(run, time))
                s["volume"].append(run.volume(time))
                kinetic, potential = run.energy(time)
                s["kinetic"].append(kinetic)
                s["potential"].append(potential)
                s["profile"].append(depth)
                s["gauges"].append([float(np.interp(g, x, depth))
                                    for g in self.gauges])
            self.series[run] = {k: np.array(v) for k, v in s.items()}

    # --- figures in numbers -----------------------------------------------

    def metrics(self):
        a, b = self.series[self.mpm], self.series[self.inter]
        length = self.high[self.along] - self.low[self.along]
        # Until either front is a cell before the end of the domain
        free = (a["front"] < self.high[self.along] - self.h) & (
            b["front"] < self.high[self.along] - self.h) & (
            np.maximum(a["front"], b["front"]) > self.low[self.along])
        out = {}
        reach = b["front"] - self.low[self.along]
        if free.any():
            difference = (a["front"] - b["front"])[free]/reach[free]
            out["frontDifferenceMax"] = float(np.abs(difference).max())
            out["frontDifferenceMean"] = float(difference.mean())
            out["frontDifferenceMaxLength"] = float(np.abs(
                (a["front"] - b["front"])[free]).max())
        deepest = max(b["profile"].max(), 1e-300)
        out["profileDifferenceRms"] = float(np.sqrt(np.mean(
            (a["profile"] - b["profile"])**2))/deepest)
        for i, g in enumerate(self.gauges):
            difference = a["gauges"][:, i] - b["gauges"][:, i]
            out[f"gauge{i}DifferenceRms"] = float(
                np.sqrt(np.mean(difference**2))/deepest)
            out[f"gauge{i}DifferenceMean"] = float(difference.mean()/deepest)
            last = slice(2*len(difference)//3, None)
            out[f"gauge{i}LastThirdMean_mpmFoam"] = float(
                a["gauges"][last, i].mean())
            out[f"gauge{i}LastThirdMean_interFoam"] = float(
                b["gauges"][last, i].mean())
        for name, s in [("mpmFoam", a), ("interFoam", b)]:
            total = s["kinetic"] + s["potential"]
            out[f"energyStart_{name}"] = float(total[0])
            out[f"energyEnd_{name}"] = float(total[-1])
            out[f"volumeEnd_{name}"] = float(s["volume"][-1])
        out["volumeDifferenceMax"] = float(np.abs(
            a["volume"]/np.maximum(b["volume"], 1e-300) - 1).max())
        out["length"] = float(length)
        for run, name in [(self.mpm, "mpmFoam"), (self.inter, "interFoam")]:
            out[f"cpuTime_{name}"] = run.log.cpuTime
            out[f"cpuPerSimulatedSecond_{name}"] = run.cpuPerSecond
            out[f"cells_{name}"] = run.mesh.nCells
            out[f"steps_{name}"] = run.log.stepCount
        out["timeOverInterFoam"] = \
            self.mpm.cpuPerSecond/self.inter.cpuPerSecond
        return out

    def table(self):
        columns = {"time": self.t}
        for run, name in [(self.mpm, "mpmFoam"), (self.inter, "interFoam")]:
            s = self.series[run]
            columns[f"front_{name}"] = s["front"]
            for i in range(len(self.gauges)):
                columns[f"gauge{i}_{name}"] = s["gauges"][:, i]
            for key in ["kinetic", "potential", "volume"]:
                columns[f"{key}_{name}"] = s[key]
        return columns

    # --- figure -----------------------------------------------------------

    def draw(self, path, pictures):
        from . import style

        shown = sorted({min(range(len(self.t)),
                            key=lambda i: abs(self.t[i] - p))
                        for p in pictures})
        aspect = (self.high - self.low)[self.up] \
            / (self.high - self.low)[self.along]
        fig = style.plt.figure(
            figsize=(9, 5.6 + 8.4*np.clip(aspect, 0.15, 1)/2*(
                (len(shown) + 1)//2)*0.62), layout="constrained")
        upper, lower = fig.subfigures(2, 1, height_ratios=[
            max(2.2, 8.4*np.clip(aspect, 0.15, 1)/2*0.62
                * ((len(shown) + 1)//2) + 0.5), 5.0])
        axes = upper.subplots((len(shown) + 1)//2, 2, squeeze=False)
        for ax in axes.flat[len(shown):]:
            ax.axis("off")
        runs = [(self.mpm, 0, style.MPM, "mpmFoam"),
                (self.inter, 1, style.INTERFOAM, "interFoam")]
        for ax, i in zip(axes.flat, shown):
            for run, k, colour, name in runs:
                x, y, values = self.slice(run, self.times[i][k])
                if run is self.mpm:
                    ax.contourf(x, y, np.isnan(values), [0.5, 1.5],
                                colors=["0.75"])
                filled = _outwards(values)
                if np.nanmax(filled) > 0.5 > np.nanmin(filled):
                    ax.contour(x, y, filled, [0.5], colors=[colour],
                               linewidths=1.2)
            ax.set_title(f"t = {self.t[i]:.4g} s")
            ax.set(xlim=(self.low[self.along], self.high[self.along]),
                   ylim=(self.low[self.up], self.high[self.up]))
            if 0.15 < aspect:
                ax.set_aspect("equal")
            ax.grid(False)
        axes[0, 0].legend(handles=[
            style.plt.Line2D([], [], color=c, label=f"{n}, alpha = 0.5")
            for _, _, c, n in runs], loc="upper right")
        a = lower.subplots(2, 2)
        for run, k, colour, name in runs:
            s = self.series[run]
            a[0, 0].plot(self.t, s["front"], color=colour, label=name)
            for i, g in enumerate(self.gauges):
                a[0, 1].plot(self.t, s["gauges"][:, i], color=colour,
                             ls=["-", "--", ":", "-."][i % 4],
                             label=f"{g:.3g} m" if k == 0 else None)
            a[1, 0].plot(self.t, s["kinetic"] + s["potential"], color=colour,
                         label=f"{name}: kinetic + potential")
            a[1, 0].plot(self.t, s["kinetic"], "--", color=colour,
                         label="kinetic")
        names = "xyz"
        a[0, 0].set(xlabel="time [s]",
                    ylabel=f"front along {names[self.along]} [m]")
        a[0, 1].set(xlabel="time [s]", ylabel="depth at gauges [m]")
        a[1, 0].set(xlabel="time [s]", ylabel="energy above rest [J]")
        for ax in (a[0, 0], a[0, 1], a[1, 0]):
            ax.legend(fontsize=7)
        times = [r.cpuPerSecond for r, *_ in runs]
        a[1, 1].barh([n for *_, n in runs], times,
                     color=[c for _, _, c, _ in runs])
        for i, (run, *_) in enumerate(runs):
            a[1, 1].text(0.02*max(times), i, f"{times[i]:.3g}, "
                         f"{run.mesh.nCells} cells", va="center", fontsize=8,
                         bbox=dict(fc="white", ec="none", alpha=0.7, pad=1))
        a[1, 1].set(xlabel="CPU time per simulated time")
        style.save(fig, path)


def _outwards(values):
    """Values continued by a cell into solids, so that contours reach walls"""
    out = values.copy()
    for axis in (0, 1):
        for shift in (1, -1):
            moved = np.roll(values, shift, axis=axis)
            out = np.where(np.isnan(out), moved, out)
    return out


# --- running --------------------------------------------------------------

def isMpmFoam(case):
    return (Path(case)/"constant"/"materialPointProperties").is_file()


def prepare(case, work, spacing=None, points=None, time=None, rest=False):
    """Both cases below work, made where they are not there"""
    case, work = Path(case).resolve(), Path(work)
    work.mkdir(parents=True, exist_ok=True)
    paths = {"mpmFoam": work/"mpmFoam", "interFoam": work/"interFoam"}
    own = "mpmFoam" if isMpmFoam(case) else "interFoam"
    if not paths[own].is_dir():
        _copy(case, paths[own])
    dynamic = paths["interFoam"]/"constant"/"dynamicMeshDict"
    if own == "interFoam" and dynamic.is_file() and foamDict.read(
            dynamic).get("dynamicFvMesh") == "dynamicRefineFvMesh":
        # Both on a mesh that stays
        dynamic.write_text(foamDict.header("dynamicMeshDict")
                           + "\ndynamicFvMesh   staticFvMesh;\n")
        print("    changed: interFoam runs without refinement "
              "(dynamicMeshDict)")
    other = "interFoam" if own == "mpmFoam" else "mpmFoam"
    if not paths[other].is_dir():
        print(f"{own} case {case}: conversion", flush=True)
        if own == "mpmFoam":
            toInterFoam.convert(case, paths[other])
        else:
            fromInterFoam.convert(case, paths[other], spacing, points, time,
                                  rest)
    return paths


def _copy(case, target):
    """Without times other than the start, logs and results"""
    target.mkdir(parents=True)
    for part in ["constant", "system"]:
        shutil.copytree(case/part, target/part)
    start = "0.orig" if (case/"0.orig").is_dir() else "0"
    shutil.copytree(case/start, target/"0", ignore=shutil.ignore_patterns(
        "lagrangian", "uniform"))
    for path in (target/"0").glob("*.orig"):
        if not path.with_suffix("").exists() or start == "0.orig":
            shutil.copyfile(path, path.with_suffix(""))


def solve(path, solver):
    """Mesh and start where they are missing, and the run"""
    path = Path(path)
    log = path/f"log.{solver}"
    if log.is_file() and runLog.readLog(log).finished:
        print(f"{solver}: finished before")
        return
    if not (path/"0").is_dir():
        shutil.copytree(path/"0.orig", path/"0")
    if not foamFile.stored(path/"constant"/"polyMesh"/"points"):
        fromInterFoam.run(path, "blockMesh")
    if solver == "mpmFoam":
        fromInterFoam.run(path, "setMaterialPoints")
    elif (path/"system"/"setFieldsDict").is_file():
        fromInterFoam.run(path, "setFields")
    print(f"{solver}: running in {path}", flush=True)
    start = clock.time()
    with open(log, "w") as out:
        status = subprocess.run(
            [solver], cwd=path, stdout=out, stderr=subprocess.STDOUT,
            env={**os.environ, "PWD": str(path)}).returncode
    if status:
        tail = log.read_text(errors="replace").splitlines()[-15:]
        raise FoamFileError(f"{solver} failed; end of {log}:\n    "
                            + "\n    ".join(tail))
    print(f"{solver}: {clock.time() - start:.0f} s", flush=True)


def endAt(path, endTime, interval):
    """Other times for both"""
    from .study import setEntry

    control = Path(path)/"system"/"controlDict"
    if endTime:
        setEntry(control, "endTime", f"{endTime:g}")
    if interval:
        setEntry(control, "writeControl", "adjustableRunTime")
        setEntry(control, "writeInterval", f"{interval:g}")


def main():
    import argparse

    parser = argparse.ArgumentParser(
        prog="compareInterFoam",
        description="Converts a case of interFoam or of mpmFoam to the other, "
        "runs both, and compares surfaces, front, gauges, energy and time: "
        "<case>/compareInterFoam has both cases, comparison.png, "
        "comparison.csv and metrics.json (docs/howto/fromInterFoam.md). A "
        "second call goes on where the first was stopped.")
    parser.add_argument("case")
    parser.add_argument("--output", help="directory (default: "
                        "<case>/compareInterFoam)")
    parser.add_argument("--spacing", type=float, metavar="h")
    parser.add_argument("--points", type=int)
    parser.add_argument("--endTime", type=float, help="of both runs [s]")
    parser.add_argument("--writeInterval", type=float,
                        help="of both runs [s]")
    parser.add_argument("--times", type=float, nargs="+",
                        help="of the surfaces [s] (default: four)")
    parser.add_argument("--gauges", type=float, nargs="+",
                        help="places along the tank [m] (default: quarters)")
    parser.add_argument("--evaluate", action="store_true",
                        help="run nothing")
    a = parser.parse_args()
    work = Path(a.output or Path(a.case)/"compareInterFoam").resolve()
    try:
        if not (Path(a.case)/"system"/"controlDict").is_file():
            raise FoamFileError(f"{a.case}: no system/controlDict")
        fresh = not work.is_dir()
        paths = prepare(a.case, work, a.spacing, a.points)
        if fresh:
            for path in paths.values():
                endAt(path, a.endTime, a.writeInterval)
        if not a.evaluate:
            for solver, path in paths.items():
                solve(path, solver)
        evaluate(paths, work, a.times, a.gauges)
    except FoamFileError as error:
        sys.exit(f"compareInterFoam: {error}")


def evaluate(paths, work, times=None, gauges=None):
    comparison = Comparison(Run(paths["mpmFoam"], "mpmFoam"),
                            Run(paths["interFoam"], "interFoam"), gauges)
    t = comparison.t
    pictures = times or [t[i] for i in np.unique(np.round(
        np.array([0.1, 0.25, 0.5, 1])*(len(t) - 1)).astype(int))]
    out = comparison.metrics()
    reference.writeCsv(
        work/"comparison.csv", comparison.table(),
        "compareInterFoam: from the fields of both on their meshes; gauges at "
        + " ".join(f"{g:.6g}" for g in comparison.gauges)
        + " m, depth mean across; SI units (2D: of the mesh's thickness)")
    metrics.writeMetrics(work/"metrics.json", out)
    comparison.draw(work/"comparison.png", pictures)
    metrics.printTable(out, "mpmFoam against interFoam; differences over the "
                       "reach of the front, and the largest depth:")
    return comparison


if __name__ == "__main__":
    main()
