"""Tutorials with bodies: each places its points and runs, for a few steps."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

from mpmfoam.runLog import readLog

TUTORIALS = Path(__file__).resolve().parents[2]/"tutorials"
STEPS = 20


def withBodies():
    return sorted(
        path.parents[1].name
        for path in TUTORIALS.glob("*/constant/materialPointProperties")
        if re.search(r"^bodies\b", path.read_text(), re.M))


@pytest.mark.parametrize("name", withBodies())
def testRuns(name, tmp_path):
    case = tmp_path/name
    shutil.copytree(TUTORIALS/name, case, ignore=shutil.ignore_patterns(
        "[1-9]*", "0", "0.[0-9]*", "log.*", "postProcessing", "polyMesh"))
    shutil.copytree(case/"0.orig", case/"0")

    control = case/"system"/"controlDict"
    text = re.sub(r"^writeControl .*", "writeControl timeStep;",
                  control.read_text(), flags=re.M)
    text = re.sub(r"^writeInterval .*", f"writeInterval {STEPS};", text,
                  flags=re.M)
    control.write_text(re.sub(r"^stopAt .*", "stopAt nextWrite;", text,
                              flags=re.M))
    for command in [["blockMesh"], ["setMaterialPoints", "-noForecast"],
                    ["mpmFoam"]]:
        with open(case/f"log.{command[0]}", "w") as out:
            status = subprocess.run(
                command, cwd=case, stdout=out, stderr=subprocess.STDOUT,
                env={**os.environ, "PWD": str(case)}).returncode
        assert status == 0, (case/f"log.{command[0]}").read_text()[-2000:]
    assert readLog(case/"log.mpmFoam").finished
