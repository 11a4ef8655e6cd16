"""One point of soil in the laboratory: runs soilElementTest on a soil given as
a dictionary."""

import os
import shutil
import subprocess
from pathlib import Path

from . import foamDict, reference
from .foamFile import FoamFileError


def run(path, coefficients, tests, model="elastoplasticMuI", controlDict=None):
    """Run tests (name -> entries, as text) on a soil (keyword -> value) in the
    directory path; name -> columns of its CSV.
    controlDict: that of a case, whose libs may have the model"""
    path = Path(path)
    for part in ["constant", "system"]:
        (path/part).mkdir(parents=True, exist_ok=True)
    entries = "".join(f"    {k} {foamDict.text(v)};\n"
                      for k, v in coefficients.items())
    (path/"constant"/"materialPointProperties").write_text(
        foamDict.header("materialPointProperties")
        + f"clouds (soil);\nsoil\n{{\nconstitutiveModel {model};\n"
        + f"{model}Coeffs\n{{\n{entries}}}\n}}\n")
    if controlDict:
        shutil.copyfile(controlDict, path/"system"/"controlDict")
    else:
        (path/"system"/"controlDict").write_text(
            foamDict.header("controlDict") + "startFrom startTime; "
            "startTime 0; stopAt endTime; endTime 1; deltaT 1; "
            "writeInterval 1;\n")
    text = "".join(f"{k} {{ {v} }}\n" for k, v in tests.items())
    (path/"system"/"soilElementTestDict").write_text(
        foamDict.header("soilElementTestDict") + f"tests\n{{\n{text}}}\n")
    done = subprocess.run(["soilElementTest"], cwd=path, capture_output=True,
                          text=True, env={**os.environ, "PWD": str(path)})
    if done.returncode:
        output = (done.stdout + done.stderr).strip()
        start = output.find("--> FOAM FATAL")
        raise FoamFileError("soilElementTest failed:\n"
                            + (output[start:] if start >= 0
                               else output[-2000:]))
    return {k: reference.readCsv(
        path/"postProcessing"/"soilElementTest"/f"{k}.csv") for k in tests}
