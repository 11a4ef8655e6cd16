"""A case of mpmFoam, of water alone, becomes one of interFoam: see
docs/howto/fromInterFoam.md."""

import shutil
import tempfile
from pathlib import Path

import numpy as np

from . import foamDict, foamFile, study
from .foamFile import FoamFileError
from .fromInterFoam import (
    Notes, _plain, patchEntry, run, uncompress, uniform)
from .mesh import Mesh

AIR = {"rho": 1.0, "nu": 1.48e-5}
SUB = {2: 12, 3: 6}         # parts of a cell per direction, for alpha


class MpmCase:
    """What a case of mpmFoam says, in a working copy with its mesh"""

    def __init__(self, case, work, notes):
        self.case, self.work, self.note = Path(case), Path(work), notes
        properties = self.case/"constant"/"materialPointProperties"
        if not properties.is_file():
            raise FoamFileError(f"{properties}: no such file: not a case of "
                                "mpmFoam")
        for part in ["constant", "system"]:
            shutil.copytree(self.case/part, self.work/part)
        start = self.case/"0.orig" if (self.case/"0.orig").is_dir() \
            else self.case/"0"
        if not foamFile.stored(start/"U.water"):
            raise FoamFileError(f"{start}/U.water: no such file")
        shutil.copytree(start, self.work/"0", ignore=shutil.ignore_patterns(
            "lagrangian", "uniform"))
        uncompress(self.work)
        if not (self.work/"constant"/"polyMesh"/"points").is_file():
            run(self.work, "blockMesh")
        self.mesh = Mesh(self.work)
        self.empty = self.mesh.emptyDirection
        self._properties(properties)
        self.g = np.array([foamDict.number(v) for v in foamDict.read(
            self.work/"constant"/"g")["value"]])
        self._water()

    def _read(self, place):
        d = foamDict.Dictionary.read(self.work/place)
        d.path = self.case/place
        return d

    def _properties(self, shown):
        d = self._read("constant/materialPointProperties")
        clouds = d.entries.get("clouds")
        if clouds != ["water"]:
            d.fail("clouds", "(water): interFoam knows no soil")
        water = d.sub("water")
        coeffs = water.sub("weaklyCompressibleNewtonianCoeffs")
        self.rho = coeffs.number("rho0")
        self.nu = coeffs.number("mu")/self.rho
        for key in ["bodyForce", "pressureGradient"]:
            value = water.entries.get(key)
            if value is not None and not (isinstance(value, list) and all(
                    foamDict.number(v) == 0 for v in value)):
                water.fail(key, "none, or (0 0 0): it cannot be carried over")
        if self.nu == 0:
            self.note("changed", "viscosity 0 is carried over as 0")
        flow = water.sub("inflowOutflow", required=False)
        self.inlets = {}
        inlets = flow.sub("inlets", required=False)
        for name in inlets:
            inlet = inlets.sub(name)
            self.inlets[inlet.word("patch")] = inlet
        outlets = flow.sub("outlets", required=False)
        for name in outlets:
            outlet = outlets.sub(name)
            if outlet.word("type") != "patch":
                outlet.fail("type", "patch: interFoam cannot remove water "
                            "elsewhere")
            if "waterLevel" in outlet:
                outlet.fail("waterLevel", "none: a level behind an opening "
                            "cannot be carried over")
        solution = self._read("system/fvSolution").sub("MPM", required=False)
        if "gravity" in solution:
            solution.fail("gravity", "none: gravity over time cannot be "
                          "carried over")
        if "tensionCutOff" in water and water.flag("tensionCutOff"):
            self.note("left behind", "tensionCutOff")

    # --- water at the start -----------------------------------------------

    def _water(self):
        d = self._read("system/setMaterialPointsDict").sub("water")
        regions = d.sub("regions", required=False)
        mesh = self.mesh
        self.alpha = np.zeros(mesh.nCells)
        self.U = np.zeros((mesh.nCells, 3))
        n = SUB[2 if self.empty is not None else 3]
        share = (np.arange(n) + 0.5)/n
        one = np.array([0.5])
        parts = [one if c == self.empty else share for c in range(3)]
        weight = 1/np.prod([len(p) for p in parts])
        for name in regions:
            region = regions.sub(name)
            inside = insideOf(region)
            velocity = uniform(["uniform", region.entries.get(
                "velocity", ["0", "0", "0"])])
            filled = np.zeros(mesh.nCells)
            if region.entries["type"] == "box":
                # Exactly
                lower, upper = (_vector(region, k) for k in ["min", "max"])
                overlap = np.minimum(mesh.upper, upper) \
                    - np.maximum(mesh.lower, lower)
                filled = np.prod(np.clip(
                    overlap/(mesh.upper - mesh.lower), 0, 1), axis=1)
            else:
                for a in parts[0]:
                    for b in parts[1]:
                        for c in parts[2]:
                            at = mesh.lower + (mesh.upper - mesh.lower) \
                                * np.array([a, b, c])
                            filled += weight*inside(at)
            self.alpha += filled
            if velocity is not None and np.any(velocity):
                self.U[filled > 0] = velocity
            pressure = region.entries.get("pressure", "none")
            if pressure not in ("hydrostatic", "none"):
                self.note("left behind", f"pressure {pressure} of region "
                          f"{name}: interFoam finds its own at once")
        self.alpha = np.clip(self.alpha, 0, 1)
        self.alpha[self.alpha > 1 - 1e-9] = 1
        self.alpha[self.alpha < 1e-9] = 0
        self.volume = float((self.alpha*mesh.volumes).sum())


def _vector(d, key):
    value = d.entries.get(key)
    numbers = [foamDict.number(v) for v in value] if isinstance(value, list) \
        else []
    if len(numbers) != 3 or None in numbers:
        d.fail(key, "(x y z)")
    return np.array(numbers)


def insideOf(region):
    """Points -> inside, for a region of setMaterialPointsDict"""
    kind = region.word("type")
    if kind == "box":
        lower, upper = _vector(region, "min"), _vector(region, "max")
        return lambda x: ((x >= lower) & (x <= upper)).all(axis=1)
    if kind == "sphere":
        origin, radius = _vector(region, "origin"), region.number("radius")
        return lambda x: ((x - origin)**2).sum(axis=1) <= radius**2
    if kind == "cylinder":
        a, b = _vector(region, "point1"), _vector(region, "point2")
        radius = region.number("radius")
        axis = (b - a)/np.linalg.norm(b - a)

        def cylinder(x):
            along = (x - a) @ axis
            across = ((x - a)**2).sum(axis=1) - along**2
            return (along >= 0) & (along <= np.linalg.norm(b - a)) & (
                across <= radius**2)
        return cylinder
    if kind == "polygon":
        from matplotlib.path import Path as Outline
        plane = region.word("plane", "xy", ["xy", "xz", "yz"])
        c = ["xyz".index(p) for p in plane]
        corners = region.entries.get("points")
        outline = Outline(np.array([[foamDict.number(v) for v in p]
                                    for p in corners]))
        return lambda x: outline.contains_points(x[:, c])
    region.fail("type", "box, polygon, cylinder, sphere; others cannot be "
                "carried over")


class Conversion:
    def __init__(self, mpm, target, notes):
        self.mpm, self.target, self.note = mpm, Path(target), notes

    def write(self):
        mpm, target = self.mpm, self.target
        target.mkdir(parents=True)
        for part in ["constant", "system"]:
            shutil.copytree(study.INTERFOAM_CASE/part, target/part)
        shutil.copytree(mpm.work/"constant"/"polyMesh",
                        target/"constant"/"polyMesh")
        blockMeshDict = mpm.work/"system"/"blockMeshDict"
        if blockMeshDict.is_file():
            shutil.copyfile(blockMeshDict, target/"system"/"blockMeshDict")
        shutil.copyfile(mpm.work/"constant"/"g", target/"constant"/"g")
        for name, value in [("water/rho", mpm.rho), ("water/nu", mpm.nu),
                            ("air/rho", AIR["rho"]), ("air/nu", AIR["nu"])]:
            study.setEntry(target/"constant"/"transportProperties", name,
                           f"{value:.10g}")
        self.note("changed", "air comes in: 1 kg/m3, 1.48e-5 m2/s, no surface "
                  "tension")
        self._control()
        self._fields()
        (target/"Allrun").write_text(ALLRUN)
        (target/"Allrun").chmod(0o755)
        (target/"conversion.log").write_text(
            f"mpmFoamToInterFoam {mpm.case}\n"
            + "".join(f"    {line}\n" for line in self.note.lines))

    def _control(self):
        c = self.mpm._read("system/controlDict")
        end = c.number("endTime")
        interval = c.number("writeInterval")
        for name in c.sub("functions", required=False):
            self.note("left behind", f"function object {name}")
        (self.target/"system"/"controlDict").write_text(
            foamDict.header("controlDict") + f"""
application     interFoam;

startFrom       startTime;
startTime       0;
stopAt          endTime;
endTime         {end:.10g};

deltaT          1e-4;
adjustTimeStep  yes;
maxCo           0.5;
maxAlphaCo      0.5;
maxDeltaT       1e-2;

writeControl    adjustableRunTime;
writeInterval   {interval:.10g};
purgeWrite      0;
writeFormat     binary;
writePrecision  12;
writeCompression off;
timeFormat      general;
timePrecision   8;
runTimeModifiable no;
""")

    def _fields(self):
        mpm = self.mpm
        boundary = foamDict.read(mpm.work/"0"/"U.water", "boundaryField")
        path = mpm.case/"0.orig"/"U.water"
        out = {"U": {}, "p_rgh": {}, "alpha.water": {}}
        openings = False
        for patch in mpm.mesh.patches:
            entry = patchEntry(boundary, patch, path)
            kind = entry.get("type")
            d = foamDict.Dictionary(entry, path,
                                    f"boundaryField/{patch.name}")
            if patch.type in ("empty", "cyclic", "symmetry",
                              "symmetryPlane"):
                three = [{"type": patch.type}]*3
            elif patch.name in mpm.inlets:
                three = self._inlet(patch, mpm.inlets[patch.name])
            elif kind in ("zeroGradient", "inletOutlet") or (
                    self._dryLid(patch) and kind in ("slip", "noSlip")):
                if kind in ("slip", "noSlip"):
                    self.note("changed", f"{patch.name}: the lid becomes an "
                              "opening, for the air of interFoam; in mpmFoam "
                              "the space above the water has pressure 0 in "
                              "any case")
                openings = True
                three = [{"type": "pressureInletOutletVelocity",
                          "value": ["uniform", [0, 0, 0]]},
                         # Air of pressure 0 at each height
                         {"type": "prghTotalPressure",
                          "p0": ["uniform", "0"],
                          "value": ["uniform", "0"]},
                         {"type": "inletOutlet",
                          "inletValue": ["uniform", "0"],
                          "value": ["uniform", "0"]}]
            elif kind in ("slip", "noSlip", "fixedValue"):
                u = {"type": kind}
                if kind == "fixedValue":
                    u["value"] = entry.get("value")
                three = [u, {"type": "fixedFluxPressure",
                             "value": ["uniform", "0"]},
                         {"type": "zeroGradient"}]
            else:
                d.fail("type", "slip, noSlip, fixedValue, zeroGradient, "
                       "inletOutlet and those of the mesh")
            for name, condition in zip(out, three):
                out[name][patch.name] = condition
        if not openings:
            # Only differences of pressure count then
            self._addReference()
        dims = {"U": "[0 1 -1 0 0 0 0]", "p_rgh": "[1 -1 -2 0 0 0 0]",
                "alpha.water": "[0 0 0 0 0 0 0]"}
        inner = {"U": _values(mpm.U), "p_rgh": "uniform 0",
                 "alpha.water": _values(mpm.alpha)}
        (self.target/"0.orig").mkdir()
        for name, conditions in out.items():
            kind = "volVectorField" if name == "U" else "volScalarField"
            text = foamDict.header(name, kind) + (
                f"\ndimensions      {dims[name]};\n\n"
                f"internalField   {inner[name]};\n\nboundaryField\n{{\n")
            for patch, condition in conditions.items():
                text += f"    {patch}\n    {{\n" + "".join(
                    "        {:<15} {};\n".format(
                        k, v if isinstance(v, str) else _plain(v))
                    for k, v in condition.items()) + "    }\n"
            (self.target/"0.orig"/name).write_text(text + "}\n")

    def _dryLid(self, patch):
        """All of it above, and without water at the start"""
        mpm = self.mpm
        if not patch.size or not np.any(mpm.g):
            return False
        areas = mpm.mesh.areas[patch.faces]
        up = -(areas @ mpm.g)/np.linalg.norm(areas, axis=1) \
            / np.linalg.norm(mpm.g)
        return (up > 0.9).all() and not mpm.alpha[
            mpm.mesh.owner[patch.faces]].any()

    def _addReference(self):
        """A vessel without openings: the level of p is free. In the air"""
        mpm = self.mpm
        dry = np.nonzero(mpm.alpha == 0)[0]
        up = -mpm.g/np.linalg.norm(mpm.g) if np.any(mpm.g) else \
            np.array([0, 1, 0])
        where = dry if len(dry) else np.arange(mpm.mesh.nCells)
        cell = int(where[np.argmax(mpm.mesh.centres[where] @ up)])
        path = self.target/"system"/"fvSolution"
        study.setEntry(path, "PIMPLE/pRefCell", cell)
        study.setEntry(path, "PIMPLE/pRefValue", 0)

    def _inlet(self, patch, inlet):
        mpm, mesh = self.mpm, self.mpm.mesh
        faces = patch.faces
        normal = mesh.areas[faces].sum(axis=0)
        unit = normal/np.linalg.norm(normal)
        g = int(np.argmax(np.abs(mpm.g)))
        low, high = mesh.faceLower[faces, g], mesh.faceUpper[faces, g]
        base = inlet.number("base", float(low.min()))
        depth = inlet.number("depth", float(high.max() - base))
        wet = np.clip((np.minimum(high, base + depth)
                       - np.maximum(low, base))/(high - low), 0, 1) \
            if abs(unit[g]) < 0.5 else np.ones(len(low))
        if "discharge" in inlet:
            velocity = -unit*inlet.number("discharge", allowed="a number; a "
                                          "function of time cannot be "
                                          "carried over")/depth
        else:
            velocity = _vector(inlet, "velocity")
        self.note("changed", f"{patch.name}: interFoam gets the velocity "
                  f"{_plain(velocity)} below the level {base + depth:.4g} m "
                  "and still air above")
        speed = np.where(wet[:, None] > 0, velocity*np.minimum(
            1, wet)[:, None], 0)
        return [{"type": "fixedValue", "value": _values(speed)},
                {"type": "fixedFluxPressure", "value": ["uniform", "0"]},
                {"type": "fixedValue", "value": _values(wet)}]


def _values(values):
    """uniform, or nonuniform List<...>"""
    if len(values) and np.ptp(values, axis=0).max() == 0:
        return "uniform " + _plain(values[0] if values.ndim == 1
                                   else list(values[0]))
    kind = "scalar" if values.ndim == 1 else "vector"
    rows = "\n".join(_plain(v if values.ndim == 1 else list(v))
                     for v in values)
    return f"nonuniform List<{kind}>\n{len(values)}\n(\n{rows}\n)\n"


ALLRUN = """#!/bin/sh
cd "${0%/*}" || exit                                # Run from this directory
. "${WM_PROJECT_DIR:?}/bin/tools/RunFunctions"      # Tutorial run functions
set -e

# Mesh and alpha.water at the start are those of mpmFoamToInterFoam
restore0Dir
runApplication interFoam

#------------------------------------------------------------------------------
"""


def convert(case, target=None, quiet=False):
    case = Path(case).resolve()
    target = Path(target).resolve() if target else \
        case.with_name(case.name + "_interFoam")
    if target.exists():
        raise FoamFileError(f"{target} exists: name another one, or remove it")
    notes = Notes(quiet)
    with tempfile.TemporaryDirectory(prefix="mpmFoamToInterFoam.") as work:
        mpm = MpmCase(case, Path(work), notes)
        conversion = Conversion(mpm, target, notes)
        try:
            conversion.write()
        except BaseException:
            shutil.rmtree(target, ignore_errors=True)
            raise
    return conversion


def main():
    import argparse
    import sys

    parser = argparse.ArgumentParser(
        prog="mpmFoamToInterFoam",
        description="Makes a case of interFoam of one of mpmFoam, of water "
        "alone, on the same mesh, and says what changed or was left behind "
        "(docs/howto/fromInterFoam.md).")
    parser.add_argument("case")
    parser.add_argument("newCase", nargs="?",
                        help="default: <case>_interFoam beside it")
    a = parser.parse_args()
    print(f"mpmFoamToInterFoam {a.case}")
    try:
        c = convert(a.case, a.newCase)
    except FoamFileError as error:
        sys.exit(f"mpmFoamToInterFoam: {error}")
    print(f"Wrote {c.target}: {c.mpm.mesh.nCells} cells, {c.mpm.volume:.6g} m3 "
          "of water. Next: its ./Allrun")


if __name__ == "__main__":
    main()
