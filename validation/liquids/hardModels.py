#!/usr/bin/env python3
"""The hard cases of the specification, at the sizes of the tests, with each
model of turbulence and of viscosity: do they hold to the same bounds?

    ./hardModels.py [--list] [name or pattern ...]     # 'kEpsilon *'

Writes results/hardModels.csv, a row for each figure that a bound is on; a run
whose rows are there is not made again.
"""

import shutil
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases", "validation/stability"]:
    sys.path.insert(0, str(REPOSITORY/place))

from hardCases import HARD, ElementTest  # noqa: E402
from mpmfoam import figureTable  # noqa: E402
from stability import Bounds  # noqa: E402

# Name -> entries of the cloud water, and what slip walls become
MODELS = {
    "XAPIC": ({"transfer": "XAPIC"}, None),
    "kEpsilon": ({"turbulence": "kEpsilon", "kEpsilonCoeffs": {
        "k": 1e-3, "epsilon": 1e-3}}, {"type": "roughWall", "ks": 1e-3}),
    "Smagorinsky": ({"turbulence": "Smagorinsky"}, {"type": "smoothWall"}),
    "BinghamPapanastasiou": ({
        "viscosityModel": "BinghamPapanastasiou",
        "BinghamPapanastasiouCoeffs": {"tau0": 1e-3, "m": 1}}, None),
    "HerschelBulkley": ({
        "viscosityModel": "HerschelBulkley", "HerschelBulkleyCoeffs": {
            "tau0": 1e-3, "k": 1e-3, "n": 0.5, "nu0": 1e-2}}, None),
    # Without stages a cell of 1 cm would take steps of 25 us
    "stages": ({
        "viscousStep": "stages", "viscosityModel": "BinghamPapanastasiou",
        "BinghamPapanastasiouCoeffs": {"tau0": 1e-3, "m": 1000}}, None)}


def number(value, good):
    """Of a figure that is a text, whether it is right"""
    return value if isinstance(value, float) else float(good)


def applies(name):
    """Is it a run of mpmFoam with water?"""
    setup = HARD[name].setup(**HARD[name].quick)
    return not isinstance(setup, ElementTest) and "water" in setup.clouds


def leastOf(case, fields):
    """The smallest value of fields of the water at all times written; points of
    the start do not know k and epsilon"""
    values = [case.case.cloudField(t, "water", field)
              for t in case.times[1:] for field in fields
              if (case.path/t/"lagrangian"/"water"/field).is_file()]
    return float(min(v.min() for v in values if v.size))


def run(model, name):
    hard = HARD[name]
    water, wall = MODELS[model]
    setup = hard.setup(**hard.quick)
    setup.water = {**setup.water, **water}
    if wall and setup.wall == "slip":
        setup.wall = wall
    bounds = Bounds(name)
    path = Path(tempfile.mkdtemp(prefix="hardModels."))
    try:
        case = setup.write(path/"case")
        hard.start(case)
        hard.bounds(bounds, case)
        if water.get("turbulence") == "kEpsilon":
            least = leastOf(case, ["k", "epsilon"])
            bounds.rows.append(("smallest k and epsilon", least, ">", "0",
                                least > 0))
    except AssertionError as error:
        reason = " ".join(str(error).split())
        bounds.rows.append(("runs to its end", 0.0, "", reason[-300:], False))
    finally:
        shutil.rmtree(path, ignore_errors=True)
    return [(figure, number(value, good), f"{relation} {bound}".strip(), good)
            for figure, value, relation, bound, good in bounds.rows]


RUNS = {f"{model} {name}": (lambda _, model=model, name=name: run(model, name))
        for model in MODELS for name in HARD if applies(name)}


if __name__ == "__main__":
    figureTable.main(
        __doc__, HERE, HERE/"results"/"hardModels.csv", RUNS)
