"""Wall stress, turbulence, liquids with a yield stress. Bounds are those of
issue 22 where nothing else is said."""

import re

import numpy as np
import pytest

from caseBuilder import RHO, CaseError, Setup, box, damBreak, hydrostatic
from liquids import (
    ASCII, COEFFICIENTS, KAPPA, BedChannel, Channel, MixingLayer, binghamGap,
    setField)
from test_erosionCriteria import criteria, rows
from test_parallel import agree
from test_restart import differing

START = {"k": 1e-2, "epsilon": 2e-3}
KEPSILON = {"turbulence": "kEpsilon", "transfer": "XAPIC",
            "kEpsilonCoeffs": START}


@pytest.mark.parametrize("turbulence, ks", [
    ("mixingLength", 4e-3), ("mixingLength", 0), ("kEpsilon", 4e-3)])
def testOpenChannel(tmp_path, figures, turbulence, ks):
    """Mean velocity of the logarithmic law, 20 cells, after 2.5 H/u*"""
    coeffs = {"k": 8e-3, "epsilon": 3e-3} if turbulence == "kEpsilon" else {}
    channel = Channel(turbulence, ks=ks, coeffs=coeffs)
    case = channel.start(tmp_path/"case", 10)
    case.solve()
    figures.atMost("mean velocity over that of the law, less one",
                   abs(channel.meanOf(case) - 1), 0.05)


@pytest.mark.parametrize("cells, entries", [
    (20, {}), (40, {}), (20, {"rise": 0.5}), (20, {"placement": "jittered"}),
    (20, {"d": 4e-3})],
    ids=["20", "40", "betweenNodes", "jittered", "coarse"])
def testOpenChannelOverBed(tmp_path, figures, cells, entries):
    """Over grains, after H/u*: without the bed as a wall the mean velocity was
    at 0.13 of the law's, the stress at 20 times. The stress is the noisier the
    less regular the points are; its bounds tell it from that, not from the law:
    after 2.5 H/u* it is 0.98 to 1.46 times the law's (validation/liquids)"""
    channel = BedChannel(cells, coeffs={"k": 8e-3, "epsilon": 3e-3}, **entries)
    channel.setup.functions = {"erosion": criteria(
        shearStress="wallLaw", criteria="(Shields)",
        writeControl="adjustableRunTime", writeInterval=0.1)}
    case = channel.start(tmp_path/"case", 4)
    case.solve()

    # It goes with the square of the velocity beside the bed, which is within
    # 10 %, while the mean is within 5
    found = rows(case)
    late = found["Time"] > 2
    law = RHO*channel.uStar**2*found["shearStress"][late].size
    figures.atMost("stress of the law over rho u*^2, less one",
                   abs(found["shearStress"][late].sum()/law - 1), 0.2)
    figures.holds("no stress before the first step", np.isnan(
        found["shearStress"][found["Time"] == 0]).all())
    figures.atMost("mean velocity over that of the law, less one",
                   abs(channel.meanOf(case) - 1), 0.05)
    stress = channel.stressOf(case, *case.times[-2:])
    figures.atLeast("stress on the bed over that of the law", stress, 0.6)
    figures.atMost("stress on the bed over that of the law", stress, 1.6)
    for name in ["k", "epsilon"]:
        figures.atLeast(f"smallest {name}", float(case.case.cloudField(
            case.times[-1], "water", name).min()), 0)
    # The pore water below what slides along is at rest
    p = case.points()
    deep = p.x[:, 1] < channel.bed - 3*channel.h
    figures.atMost("speed deep in the bed over that of the flow",
                   np.abs(p.U[deep, 0]).max()/channel.mean(), 0.03)


@pytest.mark.parametrize("turbulence", COEFFICIENTS)
def testMixingLayer(tmp_path, figures, turbulence):
    """Thickness and k of the layer between two streams, and its momentum
    thickness, against the model's own equations in one dimension: with sources,
    diffusion or viscosity 10 % off it is another layer"""
    flow, end = MixingLayer(turbulence), 1.2
    case = flow.run(tmp_path/"case", end)
    y, u, k = flow.theory(end)
    p = case.points()
    thick = flow.thickness(y, u, np.ones_like(y))
    figures.atMost("thickness over theory's, less one", float(abs(
        flow.thickness(p.x[:, 1], p.U[:, 0], p.mass)/thick - 1)), 0.05)
    figures.atMost("largest k over theory's, less one", float(abs(
        case.case.field(case.times[-1], "k").max()/k.max() - 1)), 0.05)


@pytest.mark.parametrize("turbulence", COEFFICIENTS)
def testTurbulenceDecays(tmp_path, figures, turbulence):
    """In water that moves as one, k = k0 (1 + (C2 - 1) t e0/k0)^(-1/(C2 - 1)),
    of which the viscous part of realizableKE is 1 % here"""
    k, epsilon, end = 1e-2, 0.1, 0.5
    case = Setup(
        cells=(8, 8), h=0.01, points=2, g=(0, 0, 0), energy=False,
        fluid={"soundSpeed": 10, "mu": 1e-6}, water={
            "turbulence": turbulence,
            turbulence + "Coeffs": {"k": k, "epsilon": epsilon}},
        regions={"all": box((0, 0), (1, 1), velocity=(0.3, 0, 0))}).cyclic(
            "x", "y").until(end).write(tmp_path/"case").prepare()
    case.solve()
    C2 = COEFFICIENTS[turbulence][2]
    decayed = k*(1 + (C2 - 1)*end*epsilon/k)**(-1/(C2 - 1))
    for edge in ["min", "max"]:
        found = getattr(case.case.cloudField(
            case.times[-1], "water", "k"), edge)()
        figures.atMost(f"{edge}imum of k over theory's, less one",
                       float(abs(found/decayed - 1)), 0.01)


@pytest.mark.parametrize("turbulence", COEFFICIENTS)
def testEddiesAtAWall(tmp_path, figures, turbulence):
    """Eddies in water that does not flow, half a cell from walls: of u_k =
    C_mu^(1/4) sqrt(k) only dissipation u_k^3/(kappa y) is left, so that
    k^-1/2 grows by C_mu^(3/4) t/(2 kappa y). With the k of u* of a flow that is
    not there they were gone after a step, and a wall jet grew by a fifth too
    fast"""
    k, end, h = 1e-2, 0.5, 0.01
    case = Setup(
        cells=(8, 2), h=h, points=1, g=(0, 0, 0), energy=False,
        sides={y: ("wall", {"type": "smoothWall"}) for y in ["ymin", "ymax"]},
        fluid={"soundSpeed": 10, "mu": 1e-6}, water={
            "turbulence": turbulence,
            turbulence + "Coeffs": {"k": k, "epsilon": 0.1}},
        regions={"all": box((0, 0), (1, 1))}).cyclic("x").until(end).write(
            tmp_path/"case").prepare()
    case.solve()
    left = (k**-0.5 + 0.09**0.75*end/(2*KAPPA*h/2))**-2
    found = case.case.cloudField(case.times[-1], "water", "k")
    figures.atMost("k over theory's, less one",
                   float(abs(found/left - 1).max()), 0.01)


def overSand(dim, **entries):
    """A dam break on a bed of sand, which moves by the stress of the law"""
    upper = (0.5, 0.06) if dim == 2 else (0.5, 0.2, 0.06)
    return damBreak(dim, points=2, water=KEPSILON, energy=False,
                    functions={"erosion": criteria(shearStress="wallLaw")},
                    soilRegions={"bed": box((0,)*dim, upper)},
                    soil={"bedLoad": "MeyerPeterMueller",
                          "bedStress": "wallLaw"}, **entries)


@pytest.mark.parametrize("dim", [2, 3])
def testTwoRunsOverABedAreOne(tmp_path, figures, dim):
    split = overSand(dim).steps(40).write(tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")
    split.solve()
    split.change(control={"writeInterval": 80})
    whole.change(control={"writeInterval": 80})
    split.solve()
    whole.solve()
    end = max(whole.timesByStep())
    figures.equal("last step", max(split.timesByStep()), end)
    figures.equal("files that differ", differing(split, whole, end), [])


@pytest.mark.parametrize("dim", [2, 3])
def testRanksAgreeOverABed(tmp_path, figures, dim):
    serial = overSand(dim).steps(60).write(tmp_path/"serial").prepare()
    parallel = serial.clone(tmp_path/"parallel").decompose(2)
    serial.solve()
    parallel.solve(ranks=2)
    agree(figures, parallel, serial)
    a, b = (rows(case)["shearStress"] for case in (parallel, serial))
    figures.equal("columns without a stress that differ",
                  int((np.isnan(a) != np.isnan(b)).sum()), 0)
    figures.atLeast("columns with a stress", int(np.isfinite(b).sum()), 1)
    figures.atMost("stress on the bed: largest relative difference",
                   np.nanmax(np.abs(a - b))/np.nanmax(np.abs(b)), 1e-10)


def testStressStopsButNeverTurns(tmp_path, figures):
    """A film thinner than its roughness, fast at the start"""
    channel = Channel("none", cells=2, ks=0.2, depth=0.02,
                      water={"bodyForce": (0, 0, 0)})
    case = channel.start(tmp_path/"case", 2, writes=2)
    case.solve()
    U = case.points().U[:, 0]
    first = case.points("0").U[:, 0].mean()
    figures.atLeast("lowest speed along the wall [m/s]", U.min(), -1e-3*first)
    figures.atMost("mean over the first", U.mean()/first, 0.5)


def testPositive(tmp_path, figures):
    """k and epsilon in a dam break: free surfaces, drops, an impact"""
    case = damBreak(points=2, water=KEPSILON).until(1, 0.1).write(
        tmp_path/"case").prepare()
    case.solve()
    for name in ["k", "epsilon", "nut"]:
        least = min(case.case.cloudField(t, "water", name).min()
                    for t in case.times[1:])
        figures.atLeast(f"smallest {name}", float(least), 0)
        # Means of the points by mass
        points = case.case.cloudField(case.times[-1], "water", name)
        mesh = case.case.field(case.times[-1], name)
        figures.atMost(f"{name} on the mesh, largest over the points'",
                       float(mesh.max()/points.max()), 1)
        figures.atLeast(f"{name} on the mesh, smallest where there is water",
                        float(mesh[mesh != 0].min()/points.min()), 1 - 1e-9)
    e = case.energies()["total"]
    figures.atMost("growth of the energy over its initial value", float(
        (e - np.minimum.accumulate(e)).max()/e[0]), 1e-3)


# At rest so stiff that its viscosity limits the time step
STIFF = {"viscosityModel": "HerschelBulkley", "HerschelBulkleyCoeffs": {
    "tau0": 0.02, "k": 2e-3, "n": 0.6, "nu0": 0.5}}


@pytest.mark.parametrize("water", [KEPSILON, STIFF], ids=["kEpsilon", "stiff"])
@pytest.mark.parametrize("dim", [2, 3])
def testTwoRunsAreOne(tmp_path, figures, dim, water):
    split = damBreak(dim, points=2, water=water, wall={
        "type": "roughWall", "ks": 1e-3}).steps(20).write(
            tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")
    split.solve()
    whole.change(control={"stopAt": "endTime", "endTime": 0.06})
    split.solve()
    whole.solve()
    end = max(split.timesByStep())
    figures.equal("files that differ", differing(split, whole, end), [])


@pytest.mark.parametrize("water", [KEPSILON, {
    "turbulence": "realizableKE", "realizableKECoeffs": START}, {
    "turbulence": "Smagorinsky"}, {
        "viscosityModel": "HerschelBulkley", "HerschelBulkleyCoeffs": {
            "tau0": 1e-3, "k": 1e-3, "n": 0.5, "nu0": 0.1}}, {
        "viscousStep": "stages", "viscosityModel": "BinghamPapanastasiou",
        "BinghamPapanastasiouCoeffs": {"tau0": 0.02, "m": 50}}],
    ids=["kEpsilon", "realizableKE", "Smagorinsky", "HerschelBulkley",
         "stages"])
@pytest.mark.parametrize("dim", [2, 3])
def testRanksAgree(tmp_path, figures, dim, water):
    setup = damBreak(dim, points=2, water=water, wall={"type": "smoothWall"})
    serial = setup.steps(60).write(tmp_path/"serial").prepare()
    parallel = serial.clone(tmp_path/"parallel").decompose(2)
    serial.solve()
    parallel.solve(ranks=2)
    agree(figures, parallel, serial)


def testFirstStep(tmp_path, figures):
    """Limited by the viscosity that the liquid has at rest"""
    h = 0.02
    case = damBreak(h=h, points=2, water=STIFF).steps(1).write(
        tmp_path/"case").prepare()
    case.solve()
    nu = 0.5 + 1e-3/RHO
    figures.atMost("first time step over that of explicit diffusion",
                   case.timeValue(case.times[-1])/(h**2/(4*nu)), 1 + 1e-9)


@pytest.mark.parametrize("model", ["BinghamPapanastasiou", "HerschelBulkley"])
def testBinghamGap(tmp_path, figures, model):
    """16 cells, XAPIC. With a first step that did not know the shear rate of
    the flow it starts with it was 3.5 %"""
    setup, exact, time = binghamGap(
        model=model, water={"transfer": "XAPIC"})
    case = setup.until(time/2).write(tmp_path/"case").prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = exact(x[:, 1])
    setField(case, "U", U)
    case.solve()
    p = case.points()
    figures.atMost("flow over that of theory, less one", float(abs(
        p.U[:, 0].mean()/exact(p.x[:, 1]).mean() - 1)), 0.02)


def testLiquidThatBeginsToYield(tmp_path, figures):
    """A run that goes on with a yield stress which it did not have before: its
    points know no shear rate of the step before, and as in the first step of a
    run they must not be taken for a plug, which would stop the flow"""
    setup, exact, _ = binghamGap(m=100, water={
        "transfer": "XAPIC", **STAGES})
    mud = {key: setup.water.pop(key) for key in [
        "viscosityModel", "BinghamPapanastasiouCoeffs"]}
    case = setup.steps(3).write(tmp_path/"case").prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = exact(x[:, 1])
    setField(case, "U", U)
    case.solve()
    case.change(water=mud, control={"writeInterval": 90})
    pattern = r"points had no \S*\(.*shearRate.*\); it begins here"
    found = re.search(pattern, case.solve().text)
    figures.contains("fields that begin", found and found[0], pattern)
    p = case.points()
    figures.atMost("flow over that of theory, less one", float(abs(
        p.U[:, 0].mean()/exact(p.x[:, 1]).mean() - 1)), 0.02)


def testYieldStressHoldsAColumn(tmp_path, figures):
    """rho g H/2 of 100 Pa, a yield stress of 400 Pa: what creeps is
    tau0 m, 100 times slower than what mu alone lets flow"""
    def run(name, **water):
        case = Setup(
            cells=(30, 12), h=0.002, points=2, fluid={"mu": 1},
            wall="noSlip", water=water, energy=False,
            regions={"column": hydrostatic((0, 0), (0.02, 0.02))}).until(
                0.1).write(tmp_path/name).prepare()
        case.solve()
        return case.points().x[:, 0].max() - 0.02
    free = run("free")
    held = run("held", viscosityModel="BinghamPapanastasiou",
               BinghamPapanastasiouCoeffs={"tau0": 0.4, "m": 0.5})
    figures.atLeast("front without a yield stress [m]", float(free), 2e-3)
    figures.atMost("front with it [m]", float(held), 5e-4)


# --- viscous stress in stages ---------------------------------------------

STAGES = {"viscousStep": "stages"}
MUD = {**STAGES, "viscosityModel": "BinghamPapanastasiou",
       "BinghamPapanastasiouCoeffs": {"tau0": 0.02, "m": 50}}


def testStagesAsExplicit(tmp_path, figures):
    """A Bingham liquid in a gap: the same flow, of steps that sound alone
    limits, a seventh in number"""
    flow, steps = {}, {}
    for step in ["explicit", "stages"]:
        setup, exact, time = binghamGap(
            m=40, water={"transfer": "XAPIC", "viscousStep": step})
        case = setup.until(time/4).write(tmp_path/step).prepare()
        x = case.case.cloudField("0", "water", "x")
        U = np.zeros_like(x)
        U[:, 0] = exact(x[:, 1])
        setField(case, "U", U)
        case.solve()
        flow[step] = case.points().U[:, 0].mean()/exact(x[:, 1]).mean()
        steps[step] = max(case.timesByStep())
        figures.equal(f"{step}: limiter", case.log.dtLimiter,
                      "viscosity" if step == "explicit" else "water sound")
    figures.atMost("flow in stages over explicit, less one", float(abs(
        flow["stages"]/flow["explicit"] - 1)), 0.005)
    figures.atMost("flow over that of theory, less one",
                   float(abs(flow["stages"] - 1)), 0.05)
    figures.atMost("steps over those of explicit stress",
                   steps["stages"]/steps["explicit"], 0.2)


@pytest.mark.parametrize("mu, soundSpeed, longer", [
    (1, 10, 0.02), (100, 10, 2), (100, 2.5, 8)])
def testStagesDecay(tmp_path, figures, mu, soundSpeed, longer):
    """A shear wave of 16 cells in a cyclic box, u = U exp(-nu k^2 t), to a
    tenth, in steps longer than explicit ones; the momentum stays. Stages of
    first order leave an error of nu k^2 dt/4 of the exponent, 0.01 longer"""
    n, h = 16, 0.01
    k = 2*np.pi/(n*h)
    nu = mu/RHO
    time = np.log(10)/(nu*k**2)
    setup = Setup(
        cells=(4, n), h=h, points=3, g=(0, 0, 0), energy=False,
        regions={"all": box((0, 0), (10, n*h), velocity=(0.3, 0, 0))},
        fluid={"mu": mu, "soundSpeed": soundSpeed},
        water={"transfer": "XAPIC", **STAGES},
        control=ASCII).cyclic("x", "y")
    case = setup.until(time).write(tmp_path/"case").prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = 0.3 + 0.1*np.sin(k*x[:, 1])
    setField(case, "U", U)
    before = case.points("0").momentum
    case.solve()
    p = case.points()
    left = 2*np.mean((p.U[:, 0] - 0.3)*np.sin(k*p.x[:, 1]))/0.1
    figures.atMost("decay of the wave over theory's, less one",
                   float(abs(np.log(left)/np.log(0.1) - 1)),
                   0.02 + 0.012*longer)
    figures.atMost("limiter viscosity", case.log.dtLimiter == "viscosity", 0)
    figures.atMost("change of the momentum over it", float(
        np.abs(p.momentum - before).max()/np.abs(before).max()), 1e-12)


def testStagesTakeEnergy(tmp_path, figures):
    """Mud that breaks from a dam, at rest and in motion"""
    case = damBreak(wall="noSlip", points=2, water=MUD).until(0.5).write(
        tmp_path/"case").prepare()
    text = case.solve().text
    figures.equal("limiter", case.log.dtLimiter, "water sound")
    figures.contains("cost of stages", "yes" if re.search(
        r"viscous stages", text) else None, "yes")
    e = case.energies()["total"]
    figures.atMost("growth of the energy over its initial value", float(
        (e - np.minimum.accumulate(e)).max()/e[0]), 1e-3)


def testStagesOverABed(tmp_path, figures):
    """Mud that flows over grains that are held, as with explicit stress"""
    front, steps = {}, {}
    for step in ["explicit", "stages"]:
        case = damBreak(
            points=2, energy=False, wall="slip", soilWall="slip",
            water={**MUD, "viscousStep": step, "transfer": "APIC",
                   "BinghamPapanastasiouCoeffs": {"tau0": 0.02, "m": 500}},
            soil={"constitutiveModel": "rigidSkeleton",
                  "rigidSkeletonCoeffs": {
                      "rhoS": 2650, "d": 5e-3, "e0": 0.7}},
            soilRegions={"bed": box((0, 0), (0.5, 0.06))}).until(0.2).write(
                tmp_path/step).prepare()
        case.solve()
        front[step] = case.points().x[:, 0].max() - 0.2
        steps[step] = max(case.timesByStep())
    figures.atMost("front in stages over explicit, less one", float(abs(
        front["stages"]/front["explicit"] - 1)), 0.05)
    figures.atMost("steps over those of explicit stress",
                   steps["stages"]/steps["explicit"], 0.35)


@pytest.mark.parametrize("dim", [2, 3])
def testTwoRunsOfStagesAreOne(tmp_path, figures, dim):
    split = damBreak(dim, points=2, water=MUD, wall="noSlip").steps(20).write(
        tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")
    split.solve()
    split.change(control={"writeInterval": 40})
    whole.change(control={"writeInterval": 40})
    split.solve()
    whole.solve()
    end = max(whole.timesByStep())
    figures.equal("last step", max(split.timesByStep()), end)
    figures.equal("files that differ", differing(split, whole, end), [])


@pytest.mark.parametrize("mu, wall, warned", [
    (1e-3, "noSlip", True), (1e-3, "slip", False), (100, "noSlip", False)])
def testNoSlipIsNamed(tmp_path, figures, mu, wall, warned):
    case = damBreak(wall=wall, fluid={"mu": mu}, energy=False).steps(1).write(
        tmp_path/"case").prepare()
    found = re.search(
        r"U.water is noSlip on the patches walls\.", case.solve().text)
    figures.equal("warning", found is not None, warned)


def testEddiesWeakerThanTheScheme(tmp_path, figures):
    """With APIC at 2 c/h"""
    water = {**KEPSILON, "transfer": "APIC",
             "kEpsilonCoeffs": {"k": 1e-6, "epsilon": 1e-3}}
    text = damBreak(points=2, water=water).until(0.02).write(
        tmp_path/"case").prepare().solve().text
    figures.equal("warnings", len(re.findall(
        r"the largest eddy viscosity, \S+ m2/s, is less than that of the "
        r"scheme", text)), 1)


def wallCase(wall, **entries):
    return damBreak(wall=wall, energy=False, **entries)


@pytest.mark.parametrize("setup, message", [
    (wallCase({"type": "roughWall"}), "ks"),
    (wallCase({"type": "roughWall", "ks": -1}), r"ks is -1.*Allowed: >= 0 m"),
    (wallCase({"type": "smoothWall", "ks": 1}), "ks belongs to type roughWall"),
    (wallCase("slip", water={"turbulence": "kOmega"}),
     "unknown model kOmega.*Smagorinsky"),
    (wallCase("slip", water={"turbulence": "mixingLength"}),
     "needs walls that have a stress"),
    (wallCase("slip", water={"turbulence": "kEpsilon"}), "k"),
    (wallCase("slip", water={"viscosityModel": "Casson"}),
     "unknown model Casson.*Newtonian"),
    (wallCase("slip", water={
        "viscosityModel": "HerschelBulkley", "HerschelBulkleyCoeffs": {
            "tau0": -1, "k": 1, "n": 1, "nu0": 1}}), "tau0"),
    (wallCase("slip", water={"viscousStep": "implicit"}),
     "viscousStep.*implicit.*stages"),
    (wallCase("slip", water={**STAGES, "transfer": "FLIP"},
              mpm={"shapeFunction": "linear"}),
     "viscousStep is stages.*explicit"),
    (wallCase({"type": "smoothWall"}, water={"turbulence": "mixingLength"},
              soilRegions={"bed": box((0, 0), (0.1, 0.04))}),
     "beside solids a bed would be one"),
    (wallCase("slip", soil={"bedStress": "wallLaw"},
              soilRegions={"bed": box((0, 0), (0.1, 0.04))}),
     "bedStress is wallLaw, which needs turbulence kEpsilon or realizableKE of "
     "the water.*"
     "Allowed here: bedStress drag"),
    (wallCase("slip", soil={"bedStress": "law"}, water=KEPSILON,
              soilRegions={"bed": box((0, 0), (0.1, 0.04))}),
     r"bedStress.*law.*\(drag wallLaw\)"),
    (wallCase("slip", soilWall={"type": "roughWall", "ks": 1e-3},
              soilRegions={"bed": box((0.3, 0), (0.4, 0.04))}),
     "a cloud that is no liquid")],
    ids=lambda v: v[:24] if isinstance(v, str) else "")
def testRefused(tmp_path, setup, message):
    case = setup.steps(2).write(tmp_path/"case")
    case.run("blockMesh")
    with pytest.raises(CaseError, match=f"(?s){message}"):
        case.run("setMaterialPoints")
        case.solve()
