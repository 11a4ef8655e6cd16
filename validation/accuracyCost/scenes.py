"""The scenes of the study: runs, and the error of each."""

import sys

import numpy as np

from mpmfoam import costStudy, reference, study, wave
from mpmfoam.costStudy import MPM, POINTS, PROPERTIES, Scene, merged
from mpmfoam.postProcessing import readDat

REPOSITORY = reference.repository()
TUTORIALS = REPOSITORY/"tutorials"
for other in ["validation/damBreak", "validation/columnCollapse",
              "validation/coupling", "tutorials/standingWave"]:
    sys.path.insert(0, str(REPOSITORY/other))

import columnCollapse as column  # noqa: E402
import coupling  # noqa: E402
import damBreak as dam  # noqa: E402
from coupledProblem import PROBLEMS  # noqa: E402
from makeWave import gaugePoints, waveSurface  # noqa: E402


class DamBreak(Scene):
    title = "dam break to 0.18 s"
    errorName = "water misplaced, mean of four times, against the finest run"
    h, points = 0.005, 4
    grids = [0.25, 0.5, 2]
    pointCounts = [1, 2, 3]
    END = 0.18

    def reference(self):
        return 4, 4

    def mesh(self, finer):
        h = self.h/finer
        return {"system/blockMeshDict": {
            "h": h, "nx": round(dam.WIDTH/h), "ny": round(dam.HEIGHT/h)},
            "system/controlDict": {"endTime": self.END}}

    def settings(self, finer, points):
        return merged(self.mesh(finer), {
            POINTS: {"water/pointsPerDirection": points}})

    def variants(self):
        yield from super().variants()
        yield from self.waterTransfers()
        yield ("smoothing", "no correction", 1, self.points,
               {MPM: {"MPM/volumeCorrection": "no"}})

    def runs(self):
        yield from super().runs()
        for finer in self.grids + [1, self.reference()[0]]:
            h = self.h/finer
            yield study.Run(
                self.label("interFoam", f"h{h:.3g}"),
                [study.INTERFOAM_CASE,
                 REPOSITORY/"validation"/"damBreak"/"interFoam",
                 (dam.TUTORIAL/"system"/"blockMeshDict",
                  "system/blockMeshDict"),
                 (dam.TUTORIAL/"constant"/"g", "constant/g")],
                study.INTERFOAM, self.mesh(finer),
                about={"scene": self.name, "factor": "interFoam",
                       "value": f"h {h:.3g}", "h": h})

    def ready(self, done):
        return super().ready(done) and self.finestInterFoam() in done

    def isReference(self, run):
        return super().isReference(run) or run.name == self.finestInterFoam()

    def finestInterFoam(self):
        return self.label("interFoam", f"h{self.h/self.reference()[0]:.3g}")

    @staticmethod
    def depth(run, time):
        x, _, alpha = run.case.lattice(run.case.nearestTime(time),
                                       "alpha.water")
        return x, alpha.sum(axis=0)*run.about["h"]

    def distance(self, run, exact):
        """Volume that lies elsewhere, over that of the water"""
        out = []
        for time in dam.PICTURES:
            x, fine = self.depth(exact, time)
            coarse = np.interp(x, *self.depth(run, time))
            out.append(0.5*np.abs(coarse - fine).sum()/fine.sum())
        return float(np.mean(out))

    def error(self, run, done):
        """Against the finest run of the same code"""
        own = self.finestInterFoam() if run.about["factor"] == "interFoam" \
            else self.label("reference")
        return self.distance(run, done[own])

    def more(self, rows, done):
        """Time of both codes at the errors that both reach, by interpolation
        along their grids"""
        exact, other = done[self.label("reference")], \
            done[self.finestInterFoam()]
        out = {"damBreak_finestRunsApart": self.distance(other, exact)}
        curves = {}
        for code, factors in [("mpmFoam", ("grid", "default")),
                              ("interFoam", ("interFoam",))]:
            curve = sorted((r["error"], r["cpuTime"]) for r in rows
                           if r["factor"] in factors)
            curves[code] = np.log(np.array(curve).T)
        low = max(c[0].min() for c in curves.values())
        high = min(c[0].max() for c in curves.values())
        for level in np.linspace(low, high, 3):
            times = {code: np.exp(np.interp(level, *curve))
                     for code, curve in curves.items()}
            out[f"damBreak_timeOverInterFoam_error{np.exp(level):.2g}"] = \
                times["mpmFoam"]/times["interFoam"]
        return out


class StandingWave(Scene):
    title = "standing wave, five periods"
    errorName = "rms difference from linear theory over the start"
    h, points = 0.025, 4
    grids = [0.5, 2]
    pointCounts = [2, 3]

    def settings(self, finer, points):
        h = self.h/finer
        return {"system/blockMeshDict": {
            "h": h, "nx": round(1/h), "ny": round(0.6/h)},
            POINTS: {"water/pointsPerDirection": points}}

    def files(self, finer):
        return {"system/waveSurface": waveSurface(1, 0.5, 0.01, 1),
                "system/gaugePoints": gaugePoints(1, round(finer/self.h))}

    def variants(self):
        yield from super().variants()
        yield from self.waterTransfers()
        yield ("smoothing", "no correction", 1, self.points,
               {MPM: {"MPM/volumeCorrection": "no"}})

    def error(self, run, done):
        gauge = readDat(run.path, "gauge", "waveGauge.dat")
        t, heights = gauge[:, 0], gauge[:, 1:-1]
        x = (np.arange(heights.shape[1]) + 0.5)/heights.shape[1]
        a = wave.modeAmplitude(heights, x, 1)
        theory = np.exp(-2e-6*np.pi**2*t)*np.cos(wave.omegaLinear(1, 0.5)*t)
        # Over its own start: on coarse grids whole points are cut
        return float(np.sqrt(np.mean((a/a[0] - theory)**2)))


class ColumnCollapse(Scene):
    title = "collapse of a column of soil C, a = 2"
    errorName = "soil misplaced at rest, against the finest run"
    clouds = ["soil"]
    h, points = 0.005, 2
    grids = [0.5, 2]
    pointCounts = [1, 3]

    def reference(self):
        return 3, 2

    def settings(self, finer, points):
        run = column.collapse(2, round(20*finer))
        return merged(run.settings, {POINTS: {
            "soil/pointsPerDirection": points}})

    def variants(self):
        yield from super().variants()
        # The tutorial takes APIC at 20/s
        for name, entries in [("FLIP 20/s", {"transfer": "FLIP",
                                             "flipDampingRate": 20}),
                              ("APIC 5/s", {"apicRate": 5}),
                              ("APIC 80/s", {"apicRate": 80})]:
            yield ("transfer", name, 1, self.points, {PROPERTIES: {
                f"soil/{k}": v for k, v in entries.items()}})
        yield from self.atDefault(costStudy.soilStiffness([5, 10, 20]))

    @staticmethod
    def deposit(run, edges):
        case = run.case
        last = case.times()[-1]
        x, m = (case.cloudField(last, "soil", f) for f in ["x", "mass"])
        return np.histogram(x[:, 0], edges, weights=m)[0]/m.sum()

    def error(self, run, done):
        # In columns that are wider than the cells of all
        edges = np.arange(0, 1, 0.02)
        return float(0.5*np.abs(
            self.deposit(run, edges)
            - self.deposit(done[self.label("reference")], edges)).sum())


class Consolidation(Scene):
    title = "consolidation of an elastic layer of 1 m"
    errorName = ("rms error of the pore pressure over its start, mean from "
                 "T = 0.2 on")
    clouds = ["water", "soil"]
    h, points = 0.05, 3
    grids = [0.5, 2, 4]
    pointCounts = [1, 2, 4]
    SOUND = [25, 100]           # beside the tutorial's 50 m/s

    def settings(self, finer, points):
        run = coupling.consolidation(round(finer/self.h))
        return merged(run.settings, {POINTS: {
            f"{c}/pointsPerDirection": points for c in self.clouds}})

    def variants(self):
        yield from super().variants()
        yield from self.waterTransfers()
        yield ("transfer", "soil APIC", 1, self.points,
               {PROPERTIES: {"soil/transfer": "APIC"}})
        yield ("smoothing", "no correction", 1, self.points,
               {MPM: {"MPM/volumeCorrection": "no"}})
        # No cap of the stiffness: it would change what Terzaghi's layer is.
        # The water's stiffness limits the time step
        yield from self.atDefault(costStudy.soundSpeeds("water", self.SOUND))

    def figures(self, run):
        return PROBLEMS[self.name][0](run.case)

    def error(self, run, done):
        return self.figures(run)["poreRmsMean"]

    def more(self, rows, done):
        """What the error leaves out: the sound of the start, which fades, and
        the settlement"""
        out = {}
        for r in rows:
            found = self.figures(done[f"{self.name}/{r['run']}"])
            for key in ["poreRmsMax", "settlementErrorMax"]:
                out[f"{self.name}_{key}_{r['run']}"] = found[key]
        return out


class WallJet(Scene):
    title = "wall jet to 1 s"
    errorName = "error of the eroded area, mean 0.2-1 s, against the finest run"
    clouds = ["water", "soil"]
    h, points = 0.01, 2
    grids = [2]
    pointCounts = [1, 3, 4]
    END = 1
    COUNTS = {"nx0": 70, "nx1": 4, "nx2": 98, "nx3": 50,
              "ny0": 5, "ny1": 5, "ny2": 15}

    def reference(self):
        return 3, 2

    def settings(self, finer, points):
        return {"system/blockMeshDict": {
            "h": self.h/finer,
            **{k: finer*n for k, n in self.COUNTS.items()}},
            "system/controlDict": {"endTime": self.END},
            POINTS: {f"{c}/pointsPerDirection": points for c in self.clouds}}

    def variants(self):
        yield from super().variants()
        yield from self.waterTransfers()
        yield ("transfer", "soil APIC", 1, self.points,
               {PROPERTIES: {"soil/transfer": "APIC"}})
        yield from self.atDefault(costStudy.soilStiffness([5, 10, 20]))

    @staticmethod
    def area(run):
        rows = readDat(run.path, "scour", "scourProfile.dat")
        return np.interp(np.arange(0.2, 1.01, 0.05), rows[:, 0], rows[:, 5])

    def error(self, run, done):
        exact = self.area(done[self.label("reference")])
        return float(np.abs(self.area(run) - exact).mean()/exact.mean())


SCENES = {scene.name: scene for scene in [
    DamBreak(), StandingWave(), ColumnCollapse(), Consolidation(),
    WallJet()]}
