"""calibrateSoil: parameters of a made-up soil found again from noisy tests, the
tutorial (Karlsruhe sand), starting values, bad input."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mpmfoam import calibration, foamDict, reference, soilElement

ROOT = Path(__file__).resolve().parents[2]
TUTORIAL = ROOT/"tutorials"/"calibrateSoil"


def run(case, *arguments):
    return subprocess.run(
        [str(ROOT/"bin"/"calibrateSoil"), str(case), *arguments],
        capture_output=True, text=True, timeout=300,
        env={**os.environ, "MPMFOAM_DIR": str(ROOT),
             "PYTHONPATH": str(ROOT/"etc"/"python")})


def parameters(case):
    rows = reference.readCsv(
        case/"postProcessing"/"calibrateSoil"/"parameters.csv")
    return {name: {k: rows[k][i] for k in rows}
            for i, name in enumerate(rows["parameter"])}


# --- a made-up soil -------------------------------------------------------

TRUE = {"E0": 300.0, "phiC": 34.0, "eRef": 0.9, "Ad": 0.9, "kp": 0.003,
        "np": 2.0, "nd": 3.5}
REST = {"rhoS": 2650.0, "d": 1e-3, "e0": 0.7, "nu": 0.2, "n": 0.5,
        "lambda": 0.03, "xi": 0.5, "I0": 0.28, "muS": 0.67, "muD": 0.77,
        "PhiC": 0.7, "dPhi": 0.29}
START = {"E0": 150.0, "phiC": 31.0, "eRef": 0.85, "Ad": 0.7, "kp": 0.006,
         "np": 3.0, "nd": 2.0}

# Entries, end of strain, columns that are compared
TESTS = {
    "loose": ("test drainedTriaxial; p0 1e5; e0 0.85;", 0.2,
              ["q", "volumetricStrain"]),
    "dense": ("test drainedTriaxial; p0 1e5; e0 0.65;", 0.2,
              ["q", "volumetricStrain"]),
    "undrained": ("test undrainedTriaxial; p0 2e5; e0 0.75;", 0.1,
                  ["q", "p"]),
    "oedometer": ("test oedometer; p0 2e4; e0 0.7;", 0.015, ["axialStress"]),
    "shear": ("test simpleShear; p0 5e4; e0 0.7;", 0.2,
              ["shearStress", "volumetricStrain"]),
}


def madeUp(path, noise=0.02):
    """The case: measured curves of the true soil with noise of a share of the
    largest value, the soil that the fit starts from"""
    random = np.random.default_rng(1)
    found = soilElement.run(
        path/"truth", {**REST, **TRUE},
        {k: f"{e} strain {end}; writeInterval 1;"
         for k, (e, end, _) in TESTS.items()})
    shutil.copytree(TUTORIAL/"system", path/"system")
    (path/"constant").mkdir()
    (path/"constant"/"materialPointProperties").write_text(
        foamDict.header("materialPointProperties") + "clouds (soil);\n"
        + "soil " + foamDict.text({
            "constitutiveModel": "elastoplasticMuI",
            "elastoplasticMuICoeffs": {**REST, **START}}))
    text = ""
    for name, (entries, end, quantities) in TESTS.items():
        t = found[name]
        strain = np.linspace(0.01, 1, 50)*end
        columns = {"strain": strain}
        for q in quantities:
            values = np.interp(strain, t["strain"],
                               calibration.QUANTITIES[q](t))
            columns[q] = values + noise*abs(values).max()*random.normal(
                size=len(strain))
        reference.writeCsv(path/"constant"/f"{name}.csv", columns)
        text += (f"{name} {{ {entries} file \"constant/{name}.csv\"; "
                 "strainMeasure logarithmic; columns { strain strain; "
                 + " ".join(f"{q} {q};" for q in quantities) + " } }\n")
    (path/"system"/"calibrateSoilDict").write_text(
        foamDict.header("calibrateSoilDict") + "parameters { "
        + " ".join(f"{k} {{}}" for k in TRUE) + f" }}\ntests {{ {text} }}\n")
    return path


def testSyntheticSoil(tmp_path, figures):
    """2 % noise on each curve"""
    case = madeUp(tmp_path/"case")
    done = run(case)
    figures.equal("exit status", done.returncode, 0)
    found = parameters(case)
    inside = 0
    for name, true in TRUE.items():
        value = found[name]
        figures.atMost(f"{name}: error",
                       abs(value["value"]/true - 1), 0.05)
        inside += value["lower"] <= true <= value["upper"]
    # 95 % each: of seven, all or all but one
    figures.atLeast("true values within their confidence", inside, 6)
    # What is written is a soil: it gives the same curves
    fitted = foamDict.read(case/"postProcessing"/"calibrateSoil"/"soilCoeffs")
    figures.atMost("written eRef, relative error", abs(
        float(fitted["elastoplasticMuICoeffs"]["eRef"])
        / found["eRef"]["value"] - 1), 1e-4)


# --- Karlsruhe ------------------------------------------------------------

def testKarlsruhe(tmp_path, figures):
    case = tmp_path/"case"
    shutil.copytree(TUTORIAL, case,
                    ignore=shutil.ignore_patterns("postProcessing", "log.*"))
    done = run(case, "--write")
    figures.equal("exit status", done.returncode, 0)
    t = reference.readCsv(case/"postProcessing"/"calibrateSoil"/"tests.csv")
    rows = {(t["test"][i], t["quantity"][i]): i
            for i in range(len(t["test"]))}
    # By hand: 6.0 and 7.9 %
    for name in ["TMD2", "TMD22"]:
        figures.atMost(f"{name}: misfit of q", t["misfit"][rows[name, "q"]],
                       0.04)
    for name in ["TMD1", "TMD8", "TMD23"]:
        i = rows[name, "q"]
        figures.equal(f"{name}: fitted", t["fitted"][i], "no")
        figures.show(f"{name}: misfit of q, not fitted", t["misfit"][i])
    soil = foamDict.read(case/"constant"/"materialPointProperties")["soil"]
    figures.atMost("eRef set in the case", abs(
        float(soil["elastoplasticMuICoeffs"]["eRef"])
        / parameters(case)["eRef"]["value"] - 1), 1e-4)
    figures.holds("figure", (case/"postProcessing"/"calibrateSoil"
                             /"calibration.png").stat().st_size > 20000)


def testStartingValues(figures):
    """By hand from the published correlations"""
    found = calibration.startingValues(
        {"d50": 0.14e-3, "eMin": 0.677, "eMax": 1.054, "phiC": 33.1},
        {"nu": 0.2, "nd": 2.9})
    # 2 (1 + 0.2) 3230/sqrt(101.3); ln(tan 45.1/tan 33.1)/ln(1.035/0.677)
    for name, value in [("E0", 770.2), ("eRef", 1.054), ("muS", 0.6519),
                        ("np", 1.016)]:
        figures.atMost(f"{name}, relative error",
                       abs(found[name][0]/value - 1), 1e-3)
    figures.holds("each names its source", all(
        "doi" in source for name, (_, source) in found.items()
        if name not in ("d", "phiC", "muS")))


@pytest.mark.parametrize("pattern, replacement, expected", [
    (r"phiC +\{ min 30; max 36; \}", "phiC { min 36; max 30; }",
     ["entry parameters/phiC/max", "value 30", "> min, 36"]),
    (r"nd +\{ max 8; \}", "nonsense {}",
     ["entry parameters/nonsense", "no number", "Allowed:.*eRef"]),
    (r"eMin +0\.677", "eMin 1.2",
     ["entry indexProperties/eMin", r"value 1\.2", r"less than eMax, 1\.054"]),
    (r"file +\"[^\"]*p100\.csv\"", "file nowhere.csv",
     ["entry tests/TMD2/file", "nowhere.csv", "a CSV file"]),
    (r"column sigma_v;", "column sigma_1;",
     ["columns/q/column", "sigma_1", "sigma_v"]),
    (r"\(test_id TMD22\)", "(test_id TMD99)",
     ["entry tests/TMD22/rows", "TMD99", "TMD2, TMD22"]),
    (r"e0 +0\.9753", "e0 -1", ["entry tests/TMD2/e0", "value -1", "> 0"]),
    (r"scale 1e3;", "scale 1e3; unit kPa;",
     ["unknown entry tests/TMD2/columns/q/unit", "column, minus"]),
    # What soilElementTest itself refuses is passed on
    (r"p0 +100e3", "p0 100e3; K0 9", ["soilElementTest failed", "keyword K0"]),
])
def testBadInput(tmp_path, figures, pattern, replacement, expected):
    case = tmp_path/"case"
    shutil.copytree(TUTORIAL, case,
                    ignore=shutil.ignore_patterns("postProcessing", "log.*"))
    path = case/"system"/"calibrateSoilDict"
    text, n = re.subn(pattern, replacement, path.read_text(), count=1)
    assert n, f"no {pattern} in the tutorial"
    path.write_text(text)
    done = run(case)
    figures.equal("exit status", done.returncode, 1)
    if "soilElementTest" not in expected[0]:
        expected = ["calibrateSoilDict", *expected]
    for e in expected:
        figures.contains("message", re.search(e, done.stderr, re.DOTALL), e)
