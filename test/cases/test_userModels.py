"""The worked example of docs/addingAModel.md: a library of the user's own adds
a drag law and a soil model."""

import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from caseBuilder import Setup, box
from test_badInput import PROPERTIES, refused
from test_soilElementTest import caseOf, result, run
from test_wallJet import CloudPoints

EXAMPLE = Path(__file__).resolve().parents[2]/"docs"/"examples"/"userModels"


@pytest.fixture(scope="module")
def libs(tmp_path_factory):
    """The library, built as the page says but to a place of its own"""
    path = tmp_path_factory.mktemp("user")/"userModels"
    shutil.copytree(EXAMPLE, path, ignore=shutil.ignore_patterns(
        "lnInclude", "linux*"))
    files = path/"Make"/"files"
    files.write_text(files.read_text().replace(
        "$(FOAM_USER_LIBBIN)", str(path)))
    done = subprocess.run(["wmake", str(path)], capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "warning" not in done.stderr, done.stderr
    return f'("{path}/libuserModels.so")'


KAPPA, G, MU = 2e-10, 4.0, 1e-3


def seepage(libs, **coeffs):
    """A periodic bed all along, whose water a body force drives"""
    return Setup(
        cells=(4, 8), h=0.01, points=2, energy=False, g=(0, -G, 0),
        fluid={"soundSpeed": 2, "mu": MU},
        regions={"all": box((0, 0), (0.04, 0.08))},
        soilRegions={"bed": box((0, 0), (0.04, 0.08), saturated=False)},
        soil={"constitutiveModel": "rigidSkeleton", "rigidSkeletonCoeffs": {
            "rhoS": 2650, "d": 1e-3, "e0": 0.7}},
        interaction={"drag": "constantPermeability",
                     "constantPermeabilityCoeffs": coeffs},
        control={"libs": libs}).cyclic("x", "y").until(0.02)


def testDrag(libs, tmp_path, figures):
    """Discharge of Darcy's law, kappa rho g/mu"""
    case = seepage(libs, kappa=KAPPA).write(tmp_path/"case").prepare()
    case.solve()
    U = CloudPoints(case, "water", case.times[-1]).U
    n = 0.7/1.7
    figures.atMost("discharge over kappa rho g/mu: error", np.abs(
        -n*U[:, 1]*MU/(KAPPA*1000*G) - 1).max(), 1e-6)
    figures.holds("the table of effects names it", "constantPermeability" in
                  (case.path/"log.mpmFoam").read_text())


@pytest.mark.parametrize("coeffs, expect", [
    ({"kapa": KAPPA}, {"keyword": "kapa", "allowed": "kappa"}),
    ({"kappa": -1}, {"keyword": "kappa", "value": "-1", "allowed": "0 < kappa"}),
], ids=["misspelt", "negative"])
def testBadCoefficient(libs, tmp_path, figures, coeffs, expect):
    case = seepage(libs, **coeffs).write(tmp_path/"case")
    case.run("blockMesh")
    refused(figures, case.run("setMaterialPoints", check=False),
            {"file": PROPERTIES, "dictionary": "constantPermeabilityCoeffs",
             **expect})


COEFFS = {"rhoS": 2650, "d": 1e-5, "e0": 1, "E": 1e6, "nu": 0.3,
          "qYield": 2e4}


def testSoilElement(libs, tmp_path, figures):
    """q = 3 G strain, then qYield"""
    path = caseOf(tmp_path/"case", """
        tests { triaxial { test undrainedTriaxial; p0 1e5; strain 0.05;
                           strainIncrement 1e-4; } }""")
    (path/"constant"/"materialPointProperties").write_text(
        "FoamFile { version 2.0; format ascii; class dictionary;"
        " object materialPointProperties; }\nclouds (soil);\n"
        "soil { constitutiveModel vonMises; vonMisesCoeffs {"
        + " ".join(f"{k} {v};" for k, v in COEFFS.items()) + " } }\n")
    control = path/"system"/"controlDict"
    control.write_text(control.read_text() + f"\nlibs {libs};\n")
    done = run(path)
    assert done.returncode == 0, done.stdout + done.stderr
    found = result(path, "triaxial")
    # The first column
    strain, q = list(found.values())[0], found["q"]
    G = COEFFS["E"]/2/(1 + COEFFS["nu"])
    elastic = np.minimum(3*G*strain, COEFFS["qYield"])
    figures.atMost("q: error over qYield",
                   np.abs(q - elastic).max()/COEFFS["qYield"], 1e-3)
    figures.atMost("pressure: change over p0",
                   np.abs(found["p"]/1e5 - 1).max(), 1e-6)


def testSoilInTheSolver(libs, tmp_path, figures):
    """A steep bank that is too high yields, and nowhere beyond qYield"""
    yielded = {**COEFFS, "qYield": 500}
    case = Setup(
        cells=(16, 10), h=0.05, points=2, energy=False, regions={},
        soilRegions={"bank": box((0, 0), (0.4, 0.4))},
        soil={"constitutiveModel": "vonMises", "vonMisesCoeffs": yielded},
        control={"libs": libs}).until(0.1).write(tmp_path/"case").prepare()
    case.solve()
    s = case.case.cloudField(case.times[-1], "soil", "sigma")
    xx, xy, xz, yy, yz, zz = s.T
    q = np.sqrt(0.5*((xx - yy)**2 + (yy - zz)**2 + (zz - xx)**2)
                + 3*(xy**2 + xz**2 + yz**2))
    figures.atMost("largest q over qYield", q.max()/500, 1 + 1e-9)
    figures.atLeast("points that yield", np.sum(q > 499.9)/len(q), 0.2)


def testPair(libs, tmp_path, figures):
    """Grains and water of one speed each, without drag: their difference
    decays with k (1/rho_w n + 1/rho_s n_s), their momentum stays"""
    k, n, v, end = 1e4, 0.7/1.7, 0.1, 0.02
    case = seepage(libs)
    case.g = (0, 0, 0)
    case.fluid["soundSpeed"] = 5
    case.soil = {"constitutiveModel": "linearElastic", "linearElasticCoeffs": {
        "rhoS": 2650, "d": 1e-3, "e0": 0.7, "E": 1e4, "nu": 0.2}}
    case.soilRegions["bed"]["velocity"] = (v, 0, 0)
    case.interaction = {"pairs": {
        "bed": {"type": "liquidSkeleton", "drag": "none"},
        "more": {"type": "linearExchange", "coefficient": k}}}
    case.control.update(adjustTimeStep=False, deltaT=1e-4,
                        writeControl="runTime")
    case = case.until(end).write(tmp_path/"case").prepare()
    case.solve()
    points = {c: CloudPoints(case, c, case.times[-1])
              for c in ["water", "soil"]}
    grains = CloudPoints(case, "soil", "0")
    momentum = sum((p.mass*p.U[:, 0]).sum() for p in points.values())
    figures.atMost("momentum: relative change", abs(
        momentum/(grains.mass.sum()*v) - 1), 1e-12)
    rate = k*(1/(1000*n) + 1/(2650*(1 - n)))
    difference = points["soil"].U[:, 0].mean() - points["water"].U[:, 0].mean()
    figures.atMost("difference over that of exp(-rate t): error", abs(
        difference/(v*np.exp(-rate*end)) - 1), rate*1e-4*rate*end)
    figures.holds("the table of effects names it", "linearExchange" in
                  (case.path/"log.mpmFoam").read_text())
