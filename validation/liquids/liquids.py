#!/usr/bin/env python3
"""Wall stress, turbulence and yield stress against closed forms: open channels
over rough and smooth beds after 5 H/u*, a Bingham liquid in a gap.

    ./liquids.py [--list] [name or pattern ...]

Writes results/liquids.csv, a row for each run and figure; a run whose rows are
there is not made again.
"""

import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

from liquids import Channel, binghamGap, setField  # noqa: E402
from mpmfoam import figureTable  # noqa: E402

TIMES = 5                       # H/u*
START = {"k": 8e-3, "epsilon": 3e-3}


def channel(path, turbulence, transfer="XAPIC", **entries):
    flow = Channel(
        turbulence, water={"transfer": transfer},
        coeffs=START if turbulence == "kEpsilon" else None, **entries)
    case = flow.start(path, TIMES*flow.depth/flow.uStar)
    case.solve()
    p = case.points()
    y = p.x[:, 1]
    rows = [(y >= j*flow.h) & (y < (j + 1)*flow.h)
            for j in range(1, flow.cells)]
    profile = [p.U[r, 0].mean()/flow.profile(y[r].mean())
               for r in rows if r.any()]
    return [("mean velocity over the law's", flow.meanOf(case), "1 +- 5 %"),
            ("largest error of the profile over the first row",
             np.abs(np.array(profile) - 1).max(), "")]


def gap(path, transfer="APIC", **entries):
    setup, exact, T = binghamGap(water={"transfer": transfer}, **entries)
    case = setup.until(T/2).write(path).prepare()
    x = case.case.cloudField("0", "water", "x")
    U = np.zeros_like(x)
    U[:, 0] = exact(x[:, 1])
    setField(case, "U", U)
    case.solve()
    p = case.points()
    u, theory = p.U[:, 0], exact(p.x[:, 1])
    return [("flow over theory's", u.mean()/theory.mean(), "1 +- 2 %"),
            ("speed of the plug over theory's", u.max()/theory.max(), ""),
            ("rms error over the plug's speed",
             np.sqrt(np.mean((u - theory)**2))/theory.max(), "")]


def within(make, *arguments, **entries):
    """A run in a directory of its own, of which the figures stay"""
    def run(name):
        path = Path(tempfile.mkdtemp(prefix="liquids."))
        try:
            return make(path/"case", *arguments, **entries)
        finally:
            shutil.rmtree(path, ignore_errors=True)
    return run


RUNS = {
    **{f"channel {model} ks={ks:g} cells={n}":
       within(channel, model, ks=ks, cells=n)
       for model in ["mixingLength", "kEpsilon"] for ks in [1e-3, 1e-2]
       for n in [20, 40]},
    "channel mixingLength smooth cells=20":
        within(channel, "mixingLength", ks=0),
    **{f"channel {model} ks=0.001 cells=20 APIC":
       within(channel, model, "APIC", ks=1e-3)
       for model in ["mixingLength", "kEpsilon"]},
    **{f"gap {model} m={m:g} cells={n} {transfer}":
       within(gap, transfer, model=model, m=m, cells=n)
       for model, m, n, transfer in [
           ("BinghamPapanastasiou", 10, 16, "APIC"),
           ("BinghamPapanastasiou", 10, 16, "XAPIC"),
           ("BinghamPapanastasiou", 10, 32, "XAPIC"),
           ("BinghamPapanastasiou", 40, 32, "APIC"),
           ("HerschelBulkley", 10, 16, "XAPIC")]}}


if __name__ == "__main__":
    figureTable.main(__doc__, HERE, HERE/"results"/"liquids.csv", RUNS)
