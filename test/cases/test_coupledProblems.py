"""Water with soil on problems with known answers: the tutorials of these names,
short. The longer matrices are validation/coupling and validation/
immersedCollapse, whose runs these are."""

import shutil
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(ROOT/"validation"/name)
                for name in ("coupling", "immersedCollapse")]
sys.path.insert(0, str(ROOT/"etc"/"python"))

import coupling  # noqa: E402
import immersedCollapse  # noqa: E402
from coupledProblem import PROBLEMS  # noqa: E402
from mpmfoam import coupled, reference  # noqa: E402

from caseBuilder import RunningCase, Setup, box, hydrostatic  # noqa: E402
from test_badInput import refused, words  # noqa: E402
from test_wallJet import CLOUDS, CloudPoints, body  # noqa: E402
from test_wallJet import bed as restingBed  # noqa: E402


def solved(tmp_path, run):
    run.path = tmp_path/run.name
    run.make()
    run.run()
    return run.case


def figuresOf(case, problem):
    return PROBLEMS[problem][0](case)


# --- the closed forms against the reference data --------------------------

class Sand:
    """What coupled.Medium reads of a case"""
    ergun, discharge = coupled.Medium.ergun, coupled.Medium.discharge
    rho, mu, rhoS, n = 1000, 1e-3, 2650, 0.4100295

    def __init__(self, d):
        self.d = d


def testClosedForms(figures):
    data = reference.data("ana_ergun_column.csv")
    here = np.array(data["case"]) == "Ex3"
    sand = Sand(data["d"][here][0])
    figures.atMost("Ergun: relative difference", np.abs(
        sand.ergun(data["q"][here])/data["dpdz_ergun"][here] - 1).max(), 1e-5)
    figures.atMost("its inverse: relative difference", np.abs(
        sand.discharge(data["dpdz_ergun"][here])/data["q"][here] - 1).max(),
        1e-5)
    data = reference.data("ana_settling_closed_vessel.csv")
    figures.atMost("settling: relative difference", max(
        abs(coupled.settlingSpeed(Sand(d), ns)/v - 1) for d, ns, v in zip(
            data["d"], data["ns"], data["vs_cons"])), 1e-6)
    data = reference.data("ana_terzaghi_isochrones.csv")
    figures.atMost("Terzaghi, isochrones: difference", max(
        abs(coupled.terzaghi(Z, T)[0][0] - p) for T, Z, p in zip(
            data["Tv"], data["Z"], data["p_over_p0"])), 1e-6)
    data = reference.data("ana_terzaghi_U.csv")
    figures.atMost("Terzaghi, degree: difference", max(
        abs(coupled.terzaghi(0, T)[1] - U) for T, U in zip(
            data["Tv"], data["U"])), 1e-6)


# --- seepage --------------------------------------------------------------

@pytest.mark.parametrize("q", coupling.DISCHARGES)
def testSeepage(tmp_path, figures, q):
    """The gradient in the bed is Ergun's at the discharge there; with ends
    smeared over a cell more flows than through a bed with sharp ones"""
    case = solved(tmp_path, coupling.seepage(f"q{q}", q))
    found = figuresOf(case, "seepageColumn")
    first, last = (CloudPoints(RunningCase(case.path, None), "soil", t)
                   for t in (case.times()[0], case.times()[-1]))
    figures.equal("way of the skeleton that is held, m", float(
        np.abs(last.x - first.x).max()), 0.0)
    figures.atMost("gradient: error against Ergun", abs(
        found["gradientError"]), 0.02)
    figures.atMost("discharge: excess over that of sharp ends",
                   abs(found["dischargeExcess"]), 0.08)


@pytest.mark.parametrize("drag", ["DarcyForchheimer", "DarcyForchheimerPaper"])
def testSeepageWithoutEnds(tmp_path, figures, drag):
    """The form of the paper needs 1/n_w times the gradient"""
    case = solved(tmp_path, coupling.seepage(drag, 0.005, drag, whole=True))
    found = figuresOf(case, "seepageColumn")
    factor = 1/coupled.Medium(case).n if drag.endswith("Paper") else 1
    figures.atMost("gradient over Ergun's, error", abs(
        (1 + found["gradientError"])/factor - 1), 1e-6)


# --- settling, consolidation, wetting -------------------------------------

@pytest.mark.parametrize("ns, d, bound", [(0.05, 0.85e-3, 0.05),
                                          (0.3, 1e-3, 0.08)])
def testSettling(tmp_path, figures, ns, d, bound):
    found = figuresOf(solved(tmp_path, coupling.settling(ns, d)), "settling")
    figures.atMost("speed: error against the equilibrium",
                   abs(found["settlingError"]), bound)


def testDepositIsStable(tmp_path, figures):
    """Fast grains that come to rest on the floor: points that had left the
    skeleton once kept the pressure of their impact, and the deposit blew up"""
    case = solved(tmp_path, coupling.settling(0.05, 2e-3, end=1.2))
    speed = max(np.abs(case.cloudField(t, "soil", "U")).max()
                for t in case.times())
    exact = coupled.settlingSpeed(coupled.Medium(case), 0.05)
    figures.atMost("largest speed of a grain over that of settling",
                   float(speed/exact), 1.5)
    figures.atMost("mass: error", coupled.massError(case), 1e-13)


def testConsolidation(tmp_path, figures):
    run = coupling.consolidation(20)
    run.settings["system/controlDict"] = {"endTime": 10}
    found = figuresOf(solved(tmp_path, run), "consolidation")
    figures.atLeast("stiffness of the pore water over the skeleton's",
                    found["stiffnessRatio"], 20)
    figures.atMost("pore pressure: rms error over u0", found["poreRmsMax"],
                   0.03)
    figures.atMost("its mean without the sound of the start",
                   found["poreRmsMean"], 1e-3)
    figures.atMost("oscillation at the base over u0",
                   found["baseOscillationMax"], 0.02)
    figures.atMost("settlement: error", abs(found["settlementErrorMax"]), 0.03)


def testWettingFront(tmp_path, figures):
    case = solved(tmp_path, coupling.run("wettingFront", "short", {}))
    found = figuresOf(case, "wettingFront")
    figures.atMost("mean depth of the front: error over h",
                   found["frontErrorMaxOverH"], 1)
    figures.atMost("water ahead of the front over h",
                   found["frontAheadMaxOverH"], 1)
    figures.atMost("lowest water, from column to column, over h",
                   found["frontSpreadMaxOverH"], 0.5)
    # Speed in the pores at the front, at the first time looked at
    t, z = coupled.wettingCourse(case)
    figures.atMost("largest speed in the sand over that of the front",
                   found["speedInSandMax"]/np.interp(
                       0.1*t[-1], t[1:], np.diff(z)/np.diff(t)), 2)
    figures.atMost("mass: error", coupled.massError(case), 1e-13)


# --- beds at rest ---------------------------------------------------------

@pytest.mark.parametrize("name, level", [("underWater", 0.3), ("inAir", 0.1)])
def testBedAtRest(tmp_path, figures, name, level):
    case = solved(tmp_path, coupling.bed(name, level=level, end=1))
    found = figuresOf(case, "bedUnderStillWater")
    for key, bound in [("vRmsSoil", 1e-4), ("vRmsWater", 1e-3),
                       ("poreNoiseMax", 0.02), ("bedChange", 0.2)]:
        figures.atMost(key, found[key], bound)
    figures.equal("suspended points", found["suspended"], 0)


@pytest.mark.parametrize("floor", ["noSlip", "slip"])
def testBankAtRest(tmp_path, figures, floor):
    """Water over an oblique bed, held so that nothing but its own forces can
    move it: whatever is not balanced drives a current along the slope"""
    case = Setup(
        cells=(30, 13), h=0.01, points=2, energy=False, soilWall=floor,
        regions={"all": hydrostatic((0, 0), (0.3, 0.1))},
        soil={"constitutiveModel": "rigidSkeleton",
              "rigidSkeletonCoeffs": {"rhoS": 2650, "d": 2e-3, "e0": 0.818}},
        soilRegions={"bank": {
            "type": "polygon",
            "points": [(0, 0), (0.17, 0), (0.06, 0.04), (0, 0.04)]}},
    ).until(1, 0.25).write(tmp_path/"case").prepare()
    case.solve()
    # 1e-3 of what water as deep as a cell runs with
    for time in case.times[1:]:
        speed = np.linalg.norm(case.points(time).U, axis=1)
        figures.atMost(f"rms speed of the water at {time} s, m/s",
                       np.sqrt(np.mean(speed**2)), 1e-4)


def testDivergenceForm(tmp_path, figures):
    """The form of the paper does not keep it at rest"""
    run = coupling.bed("divergence", end=0.25, form="divergence")
    case = solved(tmp_path, run)
    log = (run.path/"log.mpmFoam").read_text()
    figures.holds("the log says so", "divergence form" in log)
    found = coupled.bedAtRest(case, "0.25")
    figures.atLeast("rms speed of the soil, m/s", found["vRmsSoil"], 1e-2)
    figures.atLeast("suspended points", found["suspended"], 1)


def testUnknownPressureForm(tmp_path, figures):
    case = restingBed(0.1, mpm={"pressureForm": "divergent"}).write(
        tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False), {
        "file": r"system/fvSolution", "keyword": r"\bpressureForm\b",
        "value": r"\bdivergent\b",
        "allowed": words("gradient", "divergence")})


# --- a collapse in water --------------------------------------------------

@pytest.fixture(scope="module")
def collapse(tmp_path_factory):
    """0.3 s of the collapse of a dense column, coarse"""
    run = immersedCollapse.collapse("coarse", h=0.006, end=0.3)
    run.settings["system/controlDict"]["writeInterval"] = 0.1
    case = solved(tmp_path_factory.mktemp("collapse"), run)
    return RunningCase(case.path, Setup(cells=(50, 14), h=0.006, regions={}))


def testCollapse(collapse, figures):
    case = collapse.case
    rows = coupled.collapseCourse(case)
    figures.atLeast("way of the front, m", rows[-1, 1] - rows[0, 1], 1e-3)
    figures.atMost("early pore pressure of a dense column, Pa",
                   rows[1:, 3].max(), -5)
    figures.atMost("energy: largest climb over the initial",
                   coupled.energyGrowth(case), 1e-3)
    figures.atMost("overlap of water and grains, mean", max(
        coupled.overlap(case, t)[0] for t in case.times()), 2e-3)
    figures.atMost("mass: error", coupled.massError(case), 1e-13)


def goOn(collapse, path, **control):
    """From 0.2 s, with soil flowing"""
    case = collapse.clone(path)
    for time in case.times:
        if float(time) > 0.2:
            shutil.rmtree(case.path/time)
    for key, value in control.items():
        coupling.study.setEntry(case.path/"system"/"controlDict", key, value)
    return case


def testCollapseGoesOnExactly(collapse, tmp_path, figures):
    case = goOn(collapse, tmp_path/"case")
    case.solve()
    for cloud in CLOUDS:
        place = Path("0.3")/"lagrangian"/cloud
        names = sorted(p.name for p in (collapse.path/place).iterdir())
        figures.equal(f"{cloud}: files that differ", [
            n for n in names if body(case.path/place/n)
            != body(collapse.path/place/n)], [])


def testCollapseOnTwoRanks(collapse, tmp_path, figures):
    """After 100 steps, to rounding; both ranks have part of the column"""
    # Times are written at multiples of the interval
    index = int(collapse.state("0.2", "soil")["stepCount"])
    cases = [goOn(collapse, tmp_path/name, endTime=1, stopAt="nextWrite",
                  writeControl="timeStep", writeInterval=index + 100)
             for name in ("serial", "parallel")]
    x = cases[1].case.cellCentres("0.2")[:, 0]
    cases[1].decompose(2, cellRank=x > 0.05, times="0.2")
    for case, ranks in zip(cases, (1, 2)):
        case.solve(ranks=ranks)
    figures.equal("steps", [c.log.stepCount for c in cases], [100, 100])
    a, b = ([CloudPoints(c, cloud, c.times[-1]) for cloud in CLOUDS]
            for c in cases)
    figures.atLeast("speed of the fastest grain, m/s",
                    float(np.abs(a[1].U).max()), 1e-3)
    for cloud, s, p, names in zip(CLOUDS, a, b, [
            ["x", "U", "J", "p"], ["x", "U", "sigma", "voidRatio"]]):
        assert np.array_equal(s.id, p.id)
        for name in names:
            u, v = s[name], p[name]
            figures.atMost(f"{cloud} {name}: relative difference", float(
                np.abs(u - v).max()/np.abs(u).max()), 1e-10)


def testLooseGrainsFlowAsASuspension(tmp_path, figures):
    """A loose column liquefies. What its grains rub on the liquid between them
    carries them for seconds; without it they flow like water"""
    course = {}
    for flow in ("BoyerGuazzelliPouliquen", "none"):
        run = immersedCollapse.collapse(flow, h=0.006, end=1.4, loose=True)
        run.settings[coupling.PROPERTIES][
            "soil/elastoplasticMuICoeffs/viscousFlow"] = flow
        run.settings["system/controlDict"]["writeInterval"] = 0.2
        case = solved(tmp_path, run)
        course[flow] = coupled.collapseCourse(case)
        figures.atMost(f"{flow}, energy: largest climb over the initial",
                       coupled.energyGrowth(case), 1e-3)
        figures.atMost(f"{flow}, mass: error", coupled.massError(case), 1e-13)
    suspension, water = course.values()
    figures.atMost("way of the front over that without", float(
        (suspension[-1, 1] - suspension[0, 1])
        /(water[-1, 1] - water[0, 1])), 0.85)
    figures.atLeast("pore pressure at 1.4 s, Pa", float(suspension[-1, 3]), 100)
    figures.atLeast("and over that without, Pa", float(
        suspension[-1, 3] - water[-1, 3]), 25)


# --- time -----------------------------------------------------------------

def testViscousStep(tmp_path, figures):
    """A suspension in a liquid so viscous that diffusion limits the step:
    it falls as it should, and nothing grows"""
    run = coupling.settling(0.3, 0.2, end=0.6)
    run.settings[coupling.PROPERTIES][f"{coupling.FLUID}/mu"] = 100
    case = solved(tmp_path, run)
    figures.equal("limiter", run.log.dtLimiter, "viscosity")
    figures.atMost("speed: error against the equilibrium",
                   abs(figuresOf(case, "settling")["settlingError"]), 0.05)
    exact = coupled.settlingSpeed(coupled.Medium(case), 0.3)
    figures.atMost("largest speed over that of settling", float(max(
        np.abs(case.cloudField(t, cloud, "U")).max()
        for cloud in CLOUDS for t in case.times()))/exact, 3)


def testThirdOfASecond(tmp_path, figures):
    """Write times whose names are rounded down do not stop the clock"""
    case = Setup(cells=(5, 5), h=0.1, energy=False,
                 regions={"all": box((0, 0), (0.5, 0.3),
                                     pressure="hydrostatic")},
                 ).until(0.2, write=0.2/3).write(tmp_path/"case").prepare()
    case.solve()
    figures.equal("times", case.times, ["0", "0.0666667", "0.133333", "0.2"])
