"""The commands in docs/howto run, in order, in an empty directory."""

import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
HOWTO = ROOT/"docs"/"howto"

# What a test has no time for
SHORTER = {"embankment.md": ("endTime -set 4 ", "endTime -set 0.02 ")}


@pytest.mark.parametrize("name", [
    "accuracyCost.md", "embankment.md", "fromInterFoam.md",
    "outputThatStaysSmall.md", "ownSand.md", "restart.md",
    "solidsInTheMesh.md", "terrain.md"])
def testCommands(name, tmp_path, figures):
    for path in re.findall(r"/usr/share/\S+", (HOWTO/name).read_text()):
        if not Path(path).exists():
            pytest.skip(f"no {path} here (openfoam-examples)")
    blocks = re.findall(r"^```\n(.*?)^```$", (HOWTO/name).read_text(),
                        re.MULTILINE | re.DOTALL)
    figures.atLeast("blocks of commands", len(blocks), 1)
    script = "\n".join(blocks)
    if name in SHORTER:
        long, short = SHORTER[name]
        figures.equal(f"places of {long}", script.count(long), 1)
        script = script.replace(long, short)
    done = subprocess.run(
        ["bash", "-e", "-c", script], cwd=tmp_path,
        capture_output=True, text=True, timeout=600,
        env={**os.environ, "MPMFOAM_DIR": str(ROOT), "PWD": str(tmp_path),
             "PYTHONPATH": str(ROOT/"etc"/"python"),
             "PATH": f"{ROOT/'bin'}:{os.environ['PATH']}"})
    print(done.stdout[-3000:] + done.stderr[-3000:])
    figures.equal("exit status", done.returncode, 0)
