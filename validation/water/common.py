"""What the water problems share: the template and where things are."""

import sys
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import study  # noqa: E402

TUTORIALS = REPOSITORY/"tutorials"
G = 9.81
RHO = 1000


def waterRun(name, case, settings=None, **about):
    """A run of mpmFoam. What `case` does not have is that of the dam break
    tutorial: liquid, gravity, numerics."""
    return study.Run(name, [TUTORIALS/"damBreak", case], study.MPMFOAM,
                     settings or {}, about=about)
