#!/usr/bin/env python3
"""The hard cases of the specification and the guards that keep them stable, at
the large sizes of test/cases/hardCases.py."""

import contextlib
import copy
import io
import json
import shutil
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
for place in ["etc/python", "test", "test/cases"]:
    sys.path.insert(0, str(REPOSITORY/place))

import caseBuilder  # noqa: E402
from conftest import Figures  # noqa: E402
from hardCases import GUARDS, HARD, ElementTest  # noqa: E402
from mpmfoam import metrics, reference, study, style  # noqa: E402

caseBuilder.TIMEOUT = 7200
FIGURES = "figures.json"


class Bounds(Figures):
    """What a test compares, kept"""

    def __init__(self, name):
        super().__init__(name)
        self.rows = []

    def _add(self, name, value, relation, bound, good, listed=False):
        super()._add(name, value, relation, bound, good, listed)
        self.rows.append([name, _plain(value), relation, _plain(bound),
                          bool(good)])


def _plain(value):
    """A number, or a text"""
    try:
        return float(value)
    except (TypeError, ValueError):
        return str(value)


@dataclass
class HardRun(study.Run):
    """setup   what writes the case
    solve   runs it
    judge   adds its figures to Bounds"""
    setup: object = None
    solve: object = None
    judge: object = None

    def digest(self):
        self.files = self.setup.files()
        return super().digest()

    def make(self):
        shutil.rmtree(self.path, ignore_errors=True)
        self.path.parent.mkdir(parents=True, exist_ok=True)

    def run(self):
        madeBy = study.build(self.commands[-1])
        bounds = Bounds(self.name)
        print(f"--- {self.name}", flush=True)
        try:
            # Some are changed for a restart
            case = copy.deepcopy(self.setup).write(self.path)
            self.solve(case)
            self.judge(bounds, case)
        except AssertionError as error:
            # A run that ends with an error does not hold
            reason = [line for line in str(error).splitlines()
                      if line.startswith(("cloud", "non-finite"))]
            bounds.holds("it runs to its end", False,
                         reason[0] if reason else str(error)[:200])
        (self.path/FIGURES).write_text(json.dumps(bounds.rows) + "\n")
        self.sign(madeBy)

    @property
    def figures(self):
        return json.loads((self.path/FIGURES).read_text())

    def judgeAgain(self):
        """By the bounds of today; a guard's figure stays, and so does a run
        that stopped"""
        rows = self.figures
        if self.name.startswith("guard") or len(rows) == 1:
            return
        bounds = Bounds(self.name)
        with contextlib.redirect_stdout(io.StringIO()):
            self.judge(bounds, self.setup.caseAt(self.path))
        (self.path/FIGURES).write_text(json.dumps(bounds.rows) + "\n")

    @property
    def cost(self):
        """CPU time of the last part [s] and steps; none of a run that
        stopped"""
        if self.commands[-1] != "mpmFoam":
            return 0, 0
        return self.log.cpuTime or 0, self.log.stepCount


def commandsOf(setup):
    return ["soilElementTest"] if isinstance(setup, ElementTest) \
        else study.MPMFOAM


def hardRun(name):
    hard = HARD[name]
    setup = hard.setup(**hard.large)
    return HardRun(name, [], commandsOf(setup), about={"text": hard.about},
                   setup=setup, solve=hard.start, judge=hard.bounds)


def guardRun(name, on):
    """A run without its guard must fail: what is judged is the same"""
    guard = GUARDS[name]
    setup = guard.made(on, guard.large)
    figure = {}

    def solve(case):
        figure["value"] = guard.figure(case)

    def judge(bounds, case):
        compare = bounds.atMost if on else bounds.atLeast
        compare(guard.about, figure["value"], guard.bound)

    return HardRun(f"guard_{name}_{'on' if on else 'off'}", [],
                   commandsOf(setup), about={"text": guard.about},
                   setup=setup, solve=solve, judge=judge)


# --- what came out --------------------------------------------------------

def limits(rows):
    """Figures over their upper limits"""
    return [(value/limit, name) for name, value, relation, limit, _ in rows
            if relation == "<=" and isinstance(value, float)
            and isinstance(limit, float) and limit > 0]


def draw(done, results):
    cases = [name for name in HARD if name in done]
    guards = [name for name in GUARDS
              if all(f"guard_{name}_{s}" in done for s in ("on", "off"))]
    fig, (left, right) = style.figure(1, 2, width=10, height=5.2)
    for k, name in enumerate(reversed(cases)):
        run = done[name]
        worst = max(limits(run.figures), default=(np.nan, ""))
        holds = all(row[-1] for row in run.figures)
        # A run that stopped has no figure
        left.plot(max(np.nan_to_num(worst[0], nan=10), 1e-3), k, "o",
                  color=style.MPM if holds else style.INTERFOAM)
    left.axvline(1, color=style.REFERENCE, ls="--", lw=0.8)
    left.set(xscale="log", yticks=range(len(cases)),
             yticklabels=cases[::-1],
             xlabel="the figure nearest to its limit, over the limit",
             title="hard cases (orange: a bound does not hold)")
    for k, name in enumerate(reversed(guards)):
        bound = GUARDS[name].bound
        on, off = (done[f"guard_{name}_{s}"].figures[0][1]
                   for s in ("on", "off"))
        right.plot(max(on/bound, 1e-3), k, "o", color=style.MPM,
                   label="with it" if not k else None)
        stopped = not np.isfinite(off)
        right.plot(100 if stopped else off/bound, k,
                   ">" if stopped else "s", color=style.INTERFOAM,
                   label="without it" if not k else None)
        if stopped:
            right.annotate("the run stops", (100, k), (-4, 6), ha="right",
                           textcoords="offset points", fontsize=8)
    right.axvline(1, color=style.REFERENCE, ls="--", lw=0.8)
    right.set(xscale="log", yticks=range(len(guards)),
              yticklabels=guards[::-1], title="guards",
              xlabel="figure over its bound")
    right.legend(loc="upper left", bbox_to_anchor=(0, -0.1), ncols=2)
    style.save(fig, results/"stability.png")


def evaluate(done, results):
    table = {k: [] for k in ["run", "case", "bound", "value", "relation",
                             "limit", "holds"]}
    failed = []
    for name, run in done.items():
        run.judgeAgain()
        for bound, value, relation, limit, holds in run.figures:
            for key, entry in zip(table, [
                    name, run.about["text"], bound, value, relation, limit,
                    "yes" if holds else "no"]):
                table[key].append(entry)
            if not holds:
                failed.append(f"{name}: {bound} {value:.4g}, limit "
                              f"{limit:.4g}" if isinstance(value, float)
                              else f"{name}: {bound} {value}")
    growth = [value for name, value in zip(table["bound"], table["value"])
              if name.startswith("largest growth of the energy")]
    out = {"runs": len(done), "runsAsked": len(RUNS),
           "boundsCompared": len(table["run"]), "boundsFailed": len(failed),
           "energyGrowthMax": max(growth, default=None)}
    for name, guard in GUARDS.items():
        for state in ("on", "off"):
            run = done.get(f"guard_{name}_{state}")
            if run is None:
                continue
            value = run.figures[0][1]
            out[f"{name}_{state}"] = (
                value if np.isfinite(value) else "the run stops")
    costs = [run.cost for run in done.values()]
    out["cpuTime"] = float(sum(c[0] for c in costs))
    out["stepCount"] = sum(c[1] for c in costs)
    out.update(study.provenance(done))
    reference.writeCsv(results/"stability.csv", table,
                       "each bound of each run; sizes: large, in "
                       "test/cases/hardCases.py")
    metrics.writeMetrics(results/"metrics.json", out)
    draw(done, results)
    metrics.printTable(out, "asked: boundsFailed 0")
    if failed:
        print("bounds that do not hold:\n    " + "\n    ".join(failed))
    missing = [run.name for run in RUNS if run.name not in done]
    if missing:
        print("not run: " + " ".join(missing))


RUNS = ([guardRun(name, on) for name in GUARDS for on in (True, False)]
        + [hardRun(name) for name in HARD])


if __name__ == "__main__":
    study.main(HERE, RUNS, evaluate, __doc__)
