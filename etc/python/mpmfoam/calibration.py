"""Fits parameters of a soil model to measured element tests, by least squares
through soilElementTest: see docs/howto/ownSand.md."""

import math
import os
import tempfile
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from . import foamDict, reference, soilElement
from .foamFile import FoamFileError

P_AT = 101.3e3

#: What can be compared, from the columns of soilElementTest
QUANTITIES = {
    "q": lambda t: t["q"],
    "p": lambda t: t["p"],
    "volumetricStrain": lambda t: t["volumetricStrain"],
    "voidRatio": lambda t: t["voidRatio"],
    "axialStress": lambda t: t["sigma_yy"],
    "lateralStress": lambda t: t["sigma_xx"],
    "shearStress": lambda t: -t["sigma_xy"],
}

TESTS = ["drainedTriaxial", "undrainedTriaxial", "oedometer", "isotropic",
         "simpleShear"]

#: Bounds of parameters, if the dictionary has none: allowed by the model and
#: usual (etc/caseDicts/annotated/soilModels)
BOUNDS = {
    "E0": (20, 2000), "nu": (0.05, 0.45), "n": (0.2, 0.9), "E": (1e4, 1e9),
    "phiC": (20, 45), "eRef": (0.4, 1.5), "lambda": (1e-3, 0.3),
    "xi": (0.2, 1), "Ad": (0.3, 1.5), "kp": (1e-4, 1e-2), "np": (0.1, 10),
    "nd": (0.1, 10), "phi": (20, 50), "kpPressureExponent": (0.01, 1),
}


# --- starting values ------------------------------------------------------

BOLTON = ("Bolton 1986, Geotechnique 36, 65-78, "
          "doi 10.1680/geot.1986.36.1.65")
HARDIN = ("Hardin and Black 1966, J. Soil Mech. Found. Div. 92(2), 27-42, "
          "doi 10.1061/JSFEAQ.0000865")
HERLE = ("Herle and Gudehus 1999, Mech. Cohes.-Frict. Mater. 4, 461-486, "
         "doi 10.1002/(SICI)1099-1484(199909)4:5<461::AID-CFM71>3.0.CO;2-P")
LI = ("Li and Wang 1998, J. Geotech. Geoenviron. Eng. 124, 1215-1217, "
      "doi 10.1061/(ASCE)1090-0241(1998)124:12(1215)")


def startingValues(index, coefficients):
    """Parameters of elastoplasticMuI from index properties (d50, eMin, eMax,
    phiC): name -> (value, source). What has no correlation is left out."""
    out = {}
    value = lambda k, default: foamDict.number(
        out[k][0] if k in out else coefficients.get(k, default))
    if "d50" in index:
        out["d"] = index["d50"], "d50"
    if "phiC" in index:
        out["phiC"] = index["phiC"], "measured"
    elif "eMin" in index or "eMax" in index:
        out["phiC"] = 33.0, f"quartz sand, {BOLTON}"
    if "phiC" in out:
        out["muS"] = (_tan(out["phiC"][0]), "tan(phiC), the friction of slow flow")

    # Small strains, angular grains: G = 3230 (2.97 - e)^2/(1 + e) sqrt(p),
    # in kPa
    nu = value("nu", 0.2)
    out["E0"] = (2*(1 + nu)*3230/math.sqrt(P_AT/1e3),
                 f"G of angular grains at small strain, {HARDIN}")

    # Critical state line in e over (p/p_at)^0.7; its slope is that of Toyoura
    # sand. Here e_c = eRef exp(-lambda (p/p_at)^xi)
    if "eMax" in index:
        out["eRef"] = index["eMax"], f"eMax, {HERLE}"
        out["xi"] = 0.7, LI
        out["lambda"] = 0.019/index["eMax"], f"Toyoura sand, {LI}"
    if "eMax" in index and "eMin" in index and "phiC" in out:
        # The densest sand at p_at: relative dilatancy I_R = 10 - ln p - 1, at
        # most 4; phi_p = phi_c + 3 I_R, -d eps_v/d eps_1 = 0.3 I_R
        relative = min(4.0, 9 - math.log(P_AT/1e3))
        tanC = _tan(out["phiC"][0])
        tanP = _tan(out["phiC"][0] + 3*relative)
        critical = out["eRef"][0]*math.exp(-out["lambda"][0])
        ratio = critical/index["eMin"]
        if ratio > 1:
            out["np"] = (math.log(tanP/tanC)/math.log(ratio),
                         f"peak friction of the densest sand, {BOLTON}")
            nd = value("nd", out["np"][0])
            dilation = 0.3*relative
            strength = _slope(tanP) - _slope(tanC*ratio**-nd)
            out["Ad"] = (dilation/(1 + dilation/3)/strength,
                         f"dilation of the densest sand, {BOLTON}")
    return out


def _slope(tanPhi):
    """M in triaxial compression"""
    sine = tanPhi/math.sqrt(1 + tanPhi**2)
    return 6*sine/(3 - sine)


def _tan(degrees):
    return math.tan(math.radians(degrees))


# --- what was measured ----------------------------------------------------

@dataclass
class Curve:
    """One measured quantity of a test over its strain (logarithmic)"""
    quantity: str
    strain: np.ndarray
    values: np.ndarray
    weight: float

    @property
    def scale(self):
        return float(np.abs(self.values).max())


@dataclass
class Test:
    name: str
    kind: str
    entries: str            # of soilElementTestDict
    fitted: bool
    curves: list = field(default_factory=list)

    @property
    def strainEnd(self):
        return max(c.strain.max() for c in self.curves)


def logarithmic(strain, extension=False):
    """Engineering strain of a length or volume, positive in compression"""
    return np.log1p(strain) if extension else -np.log1p(-strain)


def readTest(d, case):
    """A test of calibrateSoilDict"""
    own = ["file", "rows", "columns", "strainMeasure", "fit", "strainRange",
           "weight"]
    lab = ["test", "p0", "e0", "K0", "direction", "volume", "strainRate",
           "strainIncrement", "integrator"]
    d.checkKeywords(own + lab)
    kind = d.word("test", choices=TESTS)
    d.number("p0", allowed="pressure at the start [Pa], >= 0",
             within=lambda v: v >= 0)
    e0 = d.number("e0", allowed="void ratio at the start, > 0",
                  within=lambda v: v > 0)
    measure = d.word("strainMeasure", "engineering",
                     ["engineering", "logarithmic"])
    extension = d.word("direction", "compression",
                       ["compression", "extension"]) == "extension"

    name = d.word("file", allowed="name of a CSV file, in quotes")
    path = Path(os.path.expandvars(name))
    path = path if path.is_absolute() else case/path
    if not path.is_file():
        d.fail("file", f"a CSV file; there is no {path}")
    table = reference.readCsv(path)
    size = len(next(iter(table.values())))
    rows = np.ones(size, dtype=bool)
    chosen = d.entries.get("rows", [])
    if chosen:
        if not isinstance(chosen, list) or len(chosen) != 2 or (
                chosen[0] not in table):
            d.fail("rows", "(column value); columns of the file: "
                   + ", ".join(table))
        rows = np.array([str(v) == chosen[1] or
                         foamDict.number(chosen[1]) == v
                         for v in table[chosen[0]]])
        if not rows.any():
            d.fail("rows", "a value of the column: " + ", ".join(
                sorted(set(map(str, table[chosen[0]])))))

    def column(entry, key):
        """A column, times scale, less another one"""
        if isinstance(entry.entries.get(key), dict):
            sub = entry.sub(key)
            sub.checkKeywords(["column", "minus", "scale", "weight"])
            names = [k for k in ["column", "minus"] if k in sub]
            if "column" not in sub:
                sub.fail("column", "a column of the file: "
                         + ", ".join(table))
        else:
            sub, names = entry, [key]
        parts = []
        for k in names:
            if sub.entries[k] not in table or isinstance(
                    table[sub.entries[k]], list):
                sub.fail(k, "a column of numbers of the file: " + ", ".join(
                    c for c in table if not isinstance(table[c], list)))
            parts.append(table[sub.entries[k]][rows])
        nested = sub is not entry
        scale = sub.number("scale", 1.0) if nested else 1.0
        weight = sub.number("weight", 1.0, "a number >= 0",
                            lambda v: v >= 0) if nested else 1.0
        return scale*(parts[0] - sum(parts[1:])), weight

    columns = d.sub("columns")
    columns.checkKeywords(["strain", *QUANTITIES])
    axialOnly = kind in ("oedometer", "isotropic")
    if "strain" in columns:
        strain, _ = column(columns, "strain")
        if measure == "engineering" and kind != "simpleShear":
            strain = logarithmic(strain, extension)
    elif axialOnly and "voidRatio" in columns:
        strain = np.log((1 + e0)/(1 + column(columns, "voidRatio")[0]))
    else:
        columns.fail("strain", "a column of the file" + (
            ", or none where voidRatio is given" if axialOnly else ""))
    if (strain < -1e-9).any():
        columns.fail("strain", "strains >= 0 in the direction of the test; "
                     f"the smallest found is {strain.min():.4g}")
    if (np.diff(strain) < -1e-9).any():
        columns.fail("strain", "strains that grow: a branch of unloading "
                     "cannot be fitted; leave it out")

    lower, upper = 0.0, np.inf
    if "strainRange" in d:
        limits = [foamDict.number(v) for v in d.entries["strainRange"]]
        if len(limits) != 2 or None in limits or limits[0] >= limits[1]:
            d.fail("strainRange", "(from to), logarithmic strains to fit")
        lower, upper = limits

    entries = "".join(f"{k} {foamDict.text(d.entries[k])}; " for k in lab
                      if k in d)
    test = Test(d.scope.split("/")[-1], kind, entries, d.flag("fit", True))
    weight = d.number("weight", 1.0, "a number >= 0", lambda v: v >= 0)
    for quantity in columns:
        if quantity == "strain" or (quantity == "voidRatio" and axialOnly
                                    and "strain" not in columns):
            continue
        values, own = column(columns, quantity)
        if quantity == "volumetricStrain" and measure == "engineering":
            values = logarithmic(values)
        if not np.isfinite(values).all() or not np.isfinite(strain).all():
            columns.fail(quantity, "numbers in every row")
        keep = (strain >= lower) & (strain <= upper)
        if keep.sum() < 3:
            d.fail("strainRange" if "strainRange" in d else "file",
                   f"at least 3 rows; {keep.sum()} found")
        test.curves.append(Curve(quantity, strain[keep], values[keep],
                                 own*weight))
    if not test.curves:
        columns.fail("", "strain and at least one of "
                     + ", ".join(QUANTITIES))
    return test


# --- the fit --------------------------------------------------------------

@dataclass
class Parameter:
    name: str
    start: float
    lower: float
    upper: float
    source: str
    logarithmic: bool = True
    value: float = None
    interval: tuple = (None, None)

    def inner(self, value):
        return math.log(value) if self.logarithmic else value

    def outer(self, value):
        return math.exp(value) if self.logarithmic else float(value)

    @property
    def atBound(self):
        span = self.inner(self.upper) - self.inner(self.lower)
        at = self.inner(self.value)
        return min(at - self.inner(self.lower),
                   self.inner(self.upper) - at) < 1e-3*span


class Calibration:
    """A case with system/calibrateSoilDict"""

    def __init__(self, case):
        self.case = Path(case)
        path = self.case/"system"/"calibrateSoilDict"
        properties = self.case/"constant"/"materialPointProperties"
        for needed in [path, properties]:
            if not needed.is_file():
                raise FoamFileError(f"{needed}: no such file")
        d = foamDict.Dictionary.read(path)
        d.checkKeywords(["indexProperties", "parameters", "tests", "measured",
                         "confidence", "maxEvaluations"])
        soil = foamDict.Dictionary.read(properties).sub("soil")
        self.model = soil.word("constitutiveModel")
        self.coefficients = dict(soil.sub(f"{self.model}Coeffs").entries)
        self.propertiesPath = properties

        self.confidence = d.number("confidence", 0.95, "between 0 and 1",
                                   lambda v: 0 < v < 1)
        self.maxEvaluations = int(d.number(
            "maxEvaluations", 100, "a number > 0", lambda v: v > 0))

        index = d.sub("indexProperties", required=False)
        index.checkKeywords(["d50", "eMin", "eMax", "phiC"])
        values = {k: index.number(k, allowed="a number > 0",
                                  within=lambda v: v > 0) for k in index}
        if "eMin" in values and "eMax" in values and (
                values["eMin"] >= values["eMax"]):
            index.fail("eMin", f"less than eMax, {values['eMax']:g}")
        self.estimates = {}
        if values and self.model == "elastoplasticMuI":
            self.estimates = startingValues(values, self.coefficients)
        elif values:
            index.fail("", "index properties give starting values of "
                       "elastoplasticMuI only; the case has " + self.model)

        self.parameters = self._parameters(d.sub("parameters"))
        tests = d.sub("tests")
        self.tests = [readTest(tests.sub(name), self.case) for name in tests]
        self.fitted = [t for t in self.tests if t.fitted]
        count = sum(len(c.values) for t in self.fitted for c in t.curves
                    if c.weight)
        if count <= len(self.parameters):
            tests.fail("", f"fitted curves with more than "
                       f"{len(self.parameters)} values (the number of "
                       f"parameters); {count} found")
        # What is not fitted, but known from index properties
        for name, (value, _) in self.estimates.items():
            if name in ("d", "muS") and name not in self._names:
                self.coefficients[name] = value

    @property
    def _names(self):
        return [p.name for p in self.parameters]

    def _parameters(self, d):
        out = []
        for name in d:
            sub = d.sub(name)
            sub.checkKeywords(["start", "min", "max", "scale"])
            given = foamDict.number(self.coefficients.get(name))
            if given is None and name not in self.estimates and (
                    "start" not in sub):
                raise FoamFileError(
                    f"{d.path}: entry {sub.name()} is no number in "
                    f"{self.propertiesPath}, soil/{self.model}Coeffs.\n"
                    "    Allowed: " + ", ".join(
                        k for k, v in self.coefficients.items()
                        if foamDict.number(v) is not None)
                    + "; or others with an entry start")
            lower, upper = BOUNDS.get(name, (None, None))
            lower = sub.number("min", *([] if lower is None else [lower]))
            upper = sub.number("max", *([] if upper is None else [upper]),
                               allowed=f"a number > min, {lower:g}",
                               within=lambda v: v > lower)
            start, source = self.estimates.get(name, (given, "the case"))
            if "start" in sub:
                start, source = sub.number("start"), "calibrateSoilDict"
            if not lower <= start <= upper:
                if source in ("the case", "calibrateSoilDict"):
                    raise FoamFileError(
                        f"{d.path}: entry {sub.name()}: starts at {start:g} "
                        f"({source}).\n    Allowed: {lower:g} to {upper:g} "
                        "(min, max)")
                start = min(max(start, lower), upper)
                source += "; moved to its bound"
            scale = sub.word("scale", "logarithmic" if lower > 0 else
                             "linear", ["logarithmic", "linear"])
            if scale == "logarithmic" and lower <= 0:
                sub.fail("scale", f"linear, for min is {lower:g}")
            out.append(Parameter(name, start, lower, upper, source,
                                 scale == "logarithmic"))
        if not out:
            raise FoamFileError(f"{d.path}: entry {d.name()} is empty.\n"
                                "    Allowed: at least one parameter")
        return out

    def simulate(self, values, tests, path):
        """Tests on the soil with values (name -> number)"""
        texts = {t.name: t.entries + f"strain {1.001*t.strainEnd:.10g}; "
                 "writeInterval 5;" for t in tests}
        return soilElement.run(
            path, {**self.coefficients, **values}, texts, self.model,
            self.case/"system"/"controlDict")

    def misfits(self, found, test):
        """Residuals over the largest measured value, one array a curve"""
        columns = found[test.name]
        return [(np.interp(c.strain, columns["strain"],
                           QUANTITIES[c.quantity](columns))
                 - c.values)/c.scale for c in test.curves]

    def fit(self, report=print):
        from scipy import optimize, stats

        ps = self.parameters
        with tempfile.TemporaryDirectory(prefix="calibrateSoil.") as scratch:
            def residuals(x):
                values = {p.name: p.outer(v) for p, v in zip(ps, x)}
                found = self.simulate(values, self.fitted, scratch)
                # Each curve counts alike, however many rows it has
                return np.concatenate([
                    c.weight/math.sqrt(len(r))*r for t in self.fitted
                    for c, r in zip(t.curves, self.misfits(found, t))])

            x0 = np.array([p.inner(p.start) for p in ps])
            lower = np.array([p.inner(p.lower) for p in ps])
            upper = np.array([p.inner(p.upper) for p in ps])
            margin = 1e-6*(upper - lower)
            x0 = np.clip(x0, lower + margin, upper - margin)
            # Differences well above the error of the steps in strain
            solution = optimize.least_squares(
                residuals, x0, bounds=(lower, upper), x_scale=upper - lower,
                diff_step=1e-3, max_nfev=self.maxEvaluations)
            for p, x in zip(ps, solution.x):
                p.value = p.outer(x)
            self.evaluations = solution.nfev
            self.converged = solution.status > 0
            report(f"    {solution.nfev} steps, {solution.message}")
            self._confidence(solution, stats)
            start = {p.name: p.start for p in ps}
            end = {p.name: p.value for p in ps}
            self.before = self.simulate(start, self.tests, scratch)
            self.after = self.simulate(end, self.tests, scratch)

    def _confidence(self, solution, stats):
        """Intervals from the Jacobian. The variance is that of each curve,
        more where its residuals follow one another: then it has fewer
        independent values than rows."""
        J, r = solution.jac, solution.fun
        pos, variance = 0, np.zeros(len(r))
        for t in self.fitted:
            for c in t.curves:
                n = len(c.values)
                part = r[pos:pos + n]
                square = np.sum(part**2)
                if square > 0:
                    follow = np.clip(
                        np.sum(part[1:]*part[:-1])/square, 0, 0.9)
                    variance[pos:pos + n] = \
                        square/n*(1 + follow)/(1 - follow)
                pos += n
        free = np.array([not p.atBound for p in self.parameters])
        self.correlations = {}
        if not free.any():
            return
        Jf = J[:, free]
        inverse = np.linalg.pinv(Jf.T @ Jf)
        A = inverse @ Jf.T
        degrees = len(r) - len(self.parameters)
        covariance = (A*variance) @ A.T*len(r)/degrees
        error = np.sqrt(np.diag(covariance))
        t = stats.t.ppf(0.5 + self.confidence/2, degrees)
        names = [p for p, f in zip(self.parameters, free) if f]
        for p, e in zip(names, error):
            x = p.inner(p.value)
            with np.errstate(over="ignore"):
                p.interval = tuple(
                    float(np.exp(v)) if p.logarithmic else float(v)
                    for v in (x - t*e, x + t*e))
        for i in range(len(names)):
            for j in range(i):
                if error[i]*error[j] > 0:
                    self.correlations[names[j].name, names[i].name] = \
                        covariance[i, j]/(error[i]*error[j])

    # --- results ----------------------------------------------------------

    def table(self):
        """Rows of tests.csv: rms misfit of each curve over its largest
        measured value, before and after; and without the scale"""
        out = {k: [] for k in ["test", "fitted", "quantity", "rows", "largest",
                               "misfitStart", "misfit", "rmsStart", "rms"]}
        for t in self.tests:
            rows = zip(t.curves, self.misfits(self.before, t),
                       self.misfits(self.after, t))
            for c, before, after in rows:
                rms = [float(np.sqrt(np.mean(r**2))) for r in (before, after)]
                for key, value in zip(out, [
                        t.name, "yes" if t.fitted and c.weight else "no",
                        c.quantity, len(c.values), c.scale, *rms,
                        rms[0]*c.scale, rms[1]*c.scale]):
                    out[key].append(value)
        return out

    def warnings(self):
        out = []
        if not self.converged:
            out.append(f"not converged in {self.evaluations} steps: raise "
                       "maxEvaluations, or start elsewhere")
        for p in self.parameters:
            if p.atBound:
                out.append(f"{p.name} is at its bound {p.value:.4g}: the "
                           "tests would take it further, or do not tell it")
            elif p.interval[0] is not None and (
                    p.logarithmic and p.interval[1] > 2*p.value):
                out.append(f"{p.name} is hardly told by these tests: "
                           f"{p.interval[0]:.3g} to {p.interval[1]:.3g}")
        for (a, b), c in self.correlations.items():
            if abs(c) > 0.95:
                out.append(f"{a} and {b} are told together only "
                           f"(correlation {c:.2f}): another kind of test, or "
                           "another density, would part them")
        fitted = self.coefficientsFitted()
        phiC, muS, muD = (foamDict.number(fitted.get(k))
                          for k in ["phiC", "muS", "muD"])
        if phiC and muS and abs(muS/_tan(phiC) - 1) > 0.03:
            out.append(f"muS {muS:.4g} is not tan(phiC) {_tan(phiC):.4g}: "
                       "friction of slow flow and of the critical state "
                       "differ")
        if muS and muD and muS > muD:
            out.append(f"muS {muS:.4g} is above muD {muD:.4g}: the model "
                       "refuses that; raise muD, which no slow test tells")
        return out

    def coefficientsFitted(self):
        out = {**self.coefficients,
               **{p.name: float(f"{p.value:.5g}") for p in self.parameters}}
        if self._slowFrictionFollows:
            out["muS"] = float(f"{_tan(out['phiC']):.5g}")
        return out

    @property
    def _slowFrictionFollows(self):
        """muS is that of the index properties: it goes with phiC"""
        return "muS" in self.estimates and "muS" not in self._names

    def fittedDictionary(self):
        """The coefficients as a dictionary to include"""
        notes = {}
        for p in self.parameters:
            note = "at its bound" if p.atBound else (
                f"{100*self.confidence:g} %: {p.interval[0]:.4g} to "
                f"{p.interval[1]:.4g}")
            notes[p.name] = f"    // fitted, {note}"
        lines = "".join(
            f"    {k:<19} {foamDict.text(v)};{notes.get(k, '')}\n"
            for k, v in self.coefficientsFitted().items())
        return (foamDict.header("soilCoeffs")
                + "\n// By calibrateSoil: take these into the soil of\n"
                "// constant/materialPointProperties\n"
                f"constitutiveModel   {self.model};\n{self.model}Coeffs\n"
                f"{{\n{lines}}}\n")

    def write(self, directory):
        directory = Path(directory)
        directory.mkdir(parents=True, exist_ok=True)
        nan = float("nan")
        reference.writeCsv(directory/"parameters.csv", {
            "parameter": self._names,
            "value": [p.value for p in self.parameters],
            "lower": [nan if p.interval[0] is None else p.interval[0]
                      for p in self.parameters],
            "upper": [nan if p.interval[1] is None else p.interval[1]
                      for p in self.parameters],
            "min": [float(p.lower) for p in self.parameters],
            "max": [float(p.upper) for p in self.parameters],
            "atBound": ["yes" if p.atBound else "no"
                        for p in self.parameters],
            "start": [float(p.start) for p in self.parameters],
            "startFrom": [p.source for p in self.parameters]},
            f"calibrateSoil: lower, upper: {100*self.confidence:g} % "
            "confidence, nan at a bound; min, max: bounds of the fit")
        reference.writeCsv(directory/"tests.csv", self.table(),
                           "calibrateSoil: misfit: rms over the largest "
                           "measured value; SI units, strain logarithmic")
        (directory/"soilCoeffs").write_text(self.fittedDictionary())
        self.draw(directory/"calibration.png")

    def draw(self, path):
        from . import style

        quantities = []
        for t in self.tests:
            for c in t.curves:
                if c.quantity not in quantities:
                    quantities.append(c.quantity)
        groups = [[t for t in self.tests if t.fitted],
                  [t for t in self.tests if not t.fitted]]
        groups = [g for g in groups if g]
        fig, axes = style.figure(len(quantities), len(groups),
                                 width=4.2*len(groups), height=2.9,
                                 squeeze=False)
        for column, group in enumerate(groups):
            for row, quantity in enumerate(quantities):
                axis = axes[row, column]
                k = 0
                for t in group:
                    colour = style.COLOURS[group.index(t)
                                           % len(style.COLOURS)]
                    for c, r in zip(t.curves, self.misfits(self.after, t)):
                        if c.quantity != quantity:
                            continue
                        k += 1
                        f = 1e-3 if quantity in _STRESSES else 100 \
                            if quantity == "volumetricStrain" else 1
                        rms = np.sqrt(np.mean(r**2))
                        axis.plot(100*c.strain, f*c.values, "o", ms=2.5,
                                  color=colour)
                        for found, ls in [(self.before, ":"),
                                          (self.after, "-")]:
                            columns = found[t.name]
                            axis.plot(
                                100*columns["strain"],
                                f*QUANTITIES[quantity](columns), ls,
                                color=colour, lw=0.8 if ls == ":" else 1.4,
                                label=f"{t.name}, {100*rms:.1f} %"
                                if ls == "-" else None)
                if not k:
                    axis.axis("off")
                    continue
                axis.set(xlabel="strain [%]", ylabel=_LABELS[quantity])
                # The starting values may lie far off
                top = [f*c.values for t in group for c in t.curves
                       if c.quantity == quantity]
                low, high = min(map(np.min, top)), max(map(np.max, top))
                span = high - low
                axis.set_ylim(low - 0.15*span, high + 0.3*span)
                axis.legend()
                if row == 0:
                    axis.set_title("fitted" if group[0].fitted
                                   else "not fitted")
        fig.suptitle("measured (points), fitted (lines), before the fit "
                     "(dotted); rms misfit over the largest value",
                     fontsize=8)
        style.save(fig, path)


_STRESSES = ("q", "p", "axialStress", "lateralStress", "shearStress")
_LABELS = {"q": "q [kPa]", "p": "p [kPa]", "axialStress": "axial stress [kPa]",
           "lateralStress": "lateral stress [kPa]",
           "shearStress": "shear stress [kPa]", "voidRatio": "void ratio",
           "volumetricStrain": "contraction [%]"}


def main():
    import argparse
    import sys

    parser = argparse.ArgumentParser(
        prog="calibrateSoil",
        description="Fits parameters of the soil of a case to measured "
        "triaxial, oedometer and shear tests: reads system/calibrateSoilDict "
        "and constant/materialPointProperties, writes "
        "postProcessing/calibrateSoil (docs/howto/ownSand.md).")
    parser.add_argument("case", nargs="?", default=".",
                        help="case directory (default: this one)")
    parser.add_argument("--start", action="store_true",
                        help="show the starting values, fit nothing")
    parser.add_argument("--write", action="store_true",
                        help="set the fitted values in "
                        "constant/materialPointProperties, too")
    arguments = parser.parse_args()
    try:
        _run(arguments)
    except FoamFileError as error:
        sys.exit(f"calibrateSoil: {error}")


def _run(arguments):
    calibration = Calibration(arguments.case)
    print("Starting values")
    for p in calibration.parameters:
        print(f"    {p.name:<8} {p.start:<9.4g} {p.source}")
    for name, (value, source) in calibration.estimates.items():
        if name not in calibration._names:
            print(f"    {name:<8} {value:<9.4g} {source}; "
                  + ("taken, not fitted" if name in ("d", "muS") else
                     "not fitted: the case has "
                     f"{calibration.coefficients.get(name)}"))
    if arguments.start:
        return
    print("Fit to " + ", ".join(t.name for t in calibration.fitted))
    calibration.fit()
    print(f"    {'':<8} {'value':<10} {100*calibration.confidence:g} % "
          "confidence")
    for p in calibration.parameters:
        print(f"    {p.name:<8} {p.value:<10.4g} "
              + ("at its bound" if p.atBound or p.interval[0] is None else
                 f"{p.interval[0]:.4g} to {p.interval[1]:.4g}"))
    print("Misfit (rms over the largest measured value)")
    table = calibration.table()
    for row in zip(*table.values()):
        row = dict(zip(table, row))
        print(f"    {row['test']:<14} {row['quantity']:<17} "
              f"{100*row['misfitStart']:6.2f} -> {100*row['misfit']:5.2f} %"
              + ("" if row["fitted"] == "yes" else "   not fitted"))
    for warning in calibration.warnings():
        print(f"Note: {warning}")
    out = calibration.case/"postProcessing"/"calibrateSoil"
    calibration.write(out)
    print(f"    wrote {out}/soilCoeffs, parameters.csv, tests.csv")
    if arguments.write:
        from .study import setEntry
        values = calibration.coefficientsFitted()
        names = calibration._names + [n for n in ("d", "muS")
                                      if n in calibration.estimates and
                                      n not in calibration._names]
        for name in names:
            setEntry(calibration.propertiesPath,
                     f"soil/{calibration.model}Coeffs/{name}",
                     f"{foamDict.number(values[name]):.5g}")
        print(f"    set in {calibration.propertiesPath}: "
              + " ".join(names))


if __name__ == "__main__":
    main()
