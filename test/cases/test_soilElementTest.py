"""soilElementTest: the tutorial, the reference integrator, bad input."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mpmfoam import reference

ROOT = Path(__file__).resolve().parents[2]
TUTORIAL = ROOT/"tutorials"/"soilElementTest"
ANNOTATED = ROOT/"etc"/"caseDicts"/"annotated"

HEADER = """FoamFile
{
    version 2.0;
    format ascii;
    class dictionary;
    object soilElementTestDict;
}
"""


def caseOf(path, tests=None, soil=None):
    """The tutorial with other tests, and with entries of the soil changed"""
    shutil.copytree(TUTORIAL, path, ignore=shutil.ignore_patterns(
        "postProcessing", "log.*", "*.png", "metrics.json"))
    if tests is not None:
        (path/"system"/"soilElementTestDict").write_text(HEADER + tests)
    properties = path/"constant"/"materialPointProperties"
    text = properties.read_text()
    for keyword, value in (soil or {}).items():
        text, n = re.subn(rf"(\b{keyword}\s+)\S+;", rf"\g<1>{value};", text)
        if not n:
            # One that the tutorial leaves at its default
            text, n = re.subn(r"(elastoplasticMuICoeffs\s*\{)",
                              rf"\g<1> {keyword} {value};", text)
        assert n, f"no {keyword} in the tutorial's soil"
    properties.write_text(text)
    return path


def run(path):
    return subprocess.run(
        ["soilElementTest"], cwd=path, capture_output=True, text=True,
        timeout=120, env={**os.environ, "PWD": str(path)})


def result(path, name):
    return reference.readCsv(path/"postProcessing"/"soilElementTest"/f"{name}.csv")


def testTutorial(tmp_path, figures):
    path = caseOf(tmp_path/"case")
    done = run(path)
    figures.equal("exit status", done.returncode, 0)
    loose = result(path, "drained_100kPa_loose")
    dense = result(path, "drained_100kPa_dense")
    figures.atMost("lateral stress held, relative error",
                   abs(loose["sigma_xx"]/1e5 - 1).max(), 1e-6)
    figures.atLeast("dense: peak over end of q",
                    dense["q"].max()/dense["q"][-1], 1.2)
    figures.atMost("loose: peak over end of q",
                   loose["q"].max()/loose["q"][-1], 1.001)
    figures.atMost("volume of undrained tests",
                   abs(result(path, "undrained_100kPa_loose")
                       ["volumetricStrain"]).max(), 1e-12)
    shear = result(path, "simpleShear_1kPa")
    figures.atMost("normal stress held, relative error",
                   abs(shear["sigma_yy"]/1e3 - 1).max(), 1e-6)
    figures.equal("regime of slow shear", set(shear["regime"]), {0.0})

    # The viscous part alone, from the file
    fast = result(path, "simpleShear_fast")
    pressure = 2650*(0.85e-3*0.29*100/(0.7 - 1/1.9))**2
    figures.atMost("viscous pressure, relative error",
                   abs(fast["p"][-1]/pressure - 1), 1e-6)
    inertial = 0.85e-3*100/np.sqrt(pressure/2650)
    mu = 0.7 + 0.07*inertial/(0.28 + inertial)
    figures.atMost("mu(I), relative error",
                   abs(-fast["sigma_xy"][-1]/pressure/mu - 1), 1e-6)

    # There and back: what was compressed has a higher density
    isotropic = result(path, "isotropic")
    figures.atMost("isotropic there and back: p over p0, less 1",
                   abs(isotropic["p"][-1]/1e3 - 1), 1e-6)


def testReferenceIntegrator(tmp_path, figures):
    """Through files, as a user would compare; testElastoplasticMuI.C measures
    all tests, densities and pressures"""
    text = "tests\n{\n"
    for name, entries in [
            ("drained", "test drainedTriaxial; p0 500; strain 0.1;"),
            ("undrained", "test undrainedTriaxial; p0 50; strain 0.1;"),
            ("oedometer", "test oedometer; p0 5e3; strain 0.02;"),
            ("shear", "test simpleShear; p0 1e5; strain 0.1;")]:
        text += f"{name} {{ {entries} }}\n"
        text += (f"{name}_reference {{ {entries} strainIncrement 1e-5; "
                 "writeInterval 100; integrator adaptiveSubstepping; }\n")
    path = caseOf(tmp_path/"case", text + "}\n")
    figures.equal("exit status", run(path).returncode, 0)
    for name in ["drained", "undrained", "oedometer", "shear"]:
        found = result(path, name)
        exact = result(path, f"{name}_reference")
        q = np.interp(found["strain"], exact["strain"], exact["q"])
        figures.atMost(f"{name}: error of q over its maximum at 1e-4",
                       abs(found["q"] - q).max()/q.max(), 0.01)


def testEachModel(tmp_path, figures):
    """The annotated entries of each model are accepted"""
    path = caseOf(tmp_path/"case",
                  "test oedometer; p0 1e3; strain 1e-3; strainIncrement 1e-5;")
    text = (ANNOTATED/"soilModels").read_text()
    properties = path/"constant"/"materialPointProperties"
    for model in ["elastoplasticMuI", "muI", "DruckerPrager", "linearElastic",
                  "rigidSkeleton"]:
        properties.write_text(text.replace(
            "constitutiveModel   elastoplasticMuI;",
            f"constitutiveModel   {model};") + "clouds (soil);\n")
        done = run(path)
        figures.equal(f"{model}: exit status", done.returncode, 0)
        figures.holds(f"{model}: no complaint",
                      "unknown keyword" not in done.stdout + done.stderr)


ONE = "test drainedTriaxial; p0 1e4; strain 0.1;"

PROPERTIES = "constant/materialPointProperties"
DICT = "system/soilElementTestDict"


@pytest.mark.parametrize("soil, tests, patterns", [
    ({"e0": 3}, ONE, [PROPERTIES, "keyword e0", "value 3", r"e0 < 2\.97"]),
    ({"nu": 0.5}, ONE, [PROPERTIES, "keyword nu", r"0\.5", r"0 <= nu < 0\.5"]),
    ({"nu": -0.1}, ONE, [PROPERTIES, "keyword nu", r"-0\.1", "0 <= nu"]),
    ({"PhiC": 0.55}, ONE, [PROPERTIES, "keyword PhiC", r"0\.55",
                           r"0\.65 < PhiC"]),
    ({"e0": 0.4}, ONE, [PROPERTIES, "keyword PhiC", r"0\.7\b",
                        r"0\.714286 < PhiC"]),
    ({"d": 0}, ONE, [PROPERTIES, r"keyword d\b", "value 0", "0 < d"]),
    ({"kp": 0}, ONE, [PROPERTIES, "keyword kp", "value 0", "0 < kp"]),
    ({"dPhi": "0.29; nsC 1"}, ONE, [PROPERTIES, "keyword nsC", "value 1",
                                    "0 < nsC < 1"]),
    ({"constitutiveModel": "CamClay"}, ONE,
     [PROPERTIES, "constitutiveModel", "CamClay", "elastoplasticMuI"]),
    ({}, ONE + "K0 0.1;", [DICT, "keyword K0", r"0\.1", r"q/p", "Allowed"]),
    ({}, "test triaxial; p0 1; strain 1;",
     [DICT, "keyword test", "triaxial", "drainedTriaxial"]),
    ({}, ONE + "strainIncrement 1;",
     [DICT, "strainIncrement", "value 1", r"strainIncrement <= 0\.1"]),
    ({}, ONE + "integrator Euler;",
     [DICT, "integrator", "Euler", "adaptiveSubstepping"]),
    ({}, ONE + "stain 1;", [DICT, "unknown keyword stain", "strain"]),
    ({}, "test oedometer; p0 -1; strain 0.1;",
     [DICT, "keyword p0", "value -1", "0 <= p0"]),
], ids=lambda v: None if not isinstance(v, str) else v[:30].strip(";"))
def testRefused(tmp_path, figures, soil, tests, patterns):
    done = run(caseOf(tmp_path/"case", tests, soil))
    message = re.sub(r"\s+", " ", done.stderr + done.stdout)
    message = message[max(message.find("--> FOAM FATAL"), 0):]
    figures.equal("exit status", done.returncode, 1)
    for pattern in patterns:
        found = re.search(pattern, message)
        figures.contains("message", found and found[0], pattern)


def testUnusualValuesWarn(tmp_path, figures):
    """Outside the ranges of the paper's Table A1"""
    done = run(caseOf(tmp_path/"case", ONE, {
        "kp": 0.044, "Ad": 2, "nu": 0.3, "n": 0.8}))
    text = re.sub(r"\s+", " ", done.stderr + done.stdout)
    figures.equal("exit status", done.returncode, 0)
    for keyword, value, usual in [
            ("kp", "0.044", "0.0001 <= kp <= 0.01"), ("Ad", "2", "0.5 <= Ad"),
            ("nu", "0.3", "0.2 <= nu"), ("n", "0.8", "0.5 <= n")]:
        figures.holds(f"a warning about {keyword}", re.search(
            rf"Warning.*keyword {keyword} has the value {value}\..*{usual}",
            text) is not None)
