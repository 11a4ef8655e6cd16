"""An interFoam case becomes one of mpmFoam: see docs/howto/fromInterFoam.md."""

import os
import re
import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np

from . import foamDict, foamFile
from .foamFile import FoamFileError
from .mesh import Lattice, Mesh

AXES = "xyz"

WALLS = ("noSlip", "slip", "fixedValue", "uniformFixedValue",
         "movingWallVelocity", "partialSlip", "rotatingWallVelocity")
OPENINGS = ("zeroGradient", "inletOutlet", "pressureInletOutletVelocity",
            "outletInlet", "pressureInletOutletParSlipVelocity",
            "freestreamVelocity")
INLETS = ("fixedValue", "uniformFixedValue", "flowRateInletVelocity",
          "variableHeightFlowRateInletVelocity", "surfaceNormalFixedValue")
BY_TYPE = ("empty", "symmetry", "symmetryPlane", "cyclic")


class Notes:
    """What was changed, moved, left behind; printed as it is found"""

    def __init__(self, quiet=False):
        self.lines, self.quiet = [], quiet

    def __call__(self, kind, text):
        line = f"{kind}: {text}"
        if line not in self.lines:
            self.lines.append(line)
            if not self.quiet:
                print("    " + line)


def run(case, *command):
    """An OpenFOAM application, silent unless it fails"""
    done = subprocess.run(command, cwd=case, capture_output=True, text=True,
                          env={**os.environ, "PWD": str(case)})
    if done.returncode:
        output = (done.stdout + done.stderr).strip()
        start = output.find("--> FOAM FATAL")
        raise FoamFileError(f"{command[0]} failed in {case}:\n"
                            + (output[start:] if start >= 0
                               else output[-2000:]))
    return done.stdout


def workingCopy(case, target):
    """0 (from 0.orig), constant, system in a directory to work in"""
    for part in ["constant", "system"]:
        if not (case/part).is_dir():
            raise FoamFileError(f"{case}: no directory {part}")
        shutil.copytree(case/part, target/part)
    start = case/"0.orig" if (case/"0.orig").is_dir() else case/"0"
    if not start.is_dir():
        raise FoamFileError(f"{case}: no directory 0 or 0.orig")
    shutil.copytree(start, target/"0")
    uncompress(target)
    for path in (target/"0").glob("*.orig"):
        if not path.with_suffix("").exists() or start.name == "0.orig":
            shutil.copyfile(path, path.with_suffix(""))


def uncompress(work):
    """Files of a working copy, and those that applications write into it, by
    the names that they have without writeCompression"""
    for path in work.rglob("*.gz"):
        path.with_suffix("").write_bytes(foamFile.read(path))
        path.unlink()
    control = work/"system"/"controlDict"
    if control.is_file() and "writeCompression" in control.read_text():
        run(work, "foamDictionary", "system/controlDict",
            "-disableFunctionEntries", "-entry", "writeCompression", "-set",
            "off")


def patchEntry(boundary, patch, path):
    """The entry of a patch in boundaryField: its name, a group, a pattern"""
    if patch.name in boundary:
        return boundary[patch.name]
    for group in patch.groups:
        if group in boundary:
            return boundary[group]
    found = None
    for key, value in boundary.items():
        try:
            if re.fullmatch(key, patch.name):
                found = value
        except re.error:
            pass
    if found is None and patch.type in BY_TYPE:
        return {"type": patch.type}
    if found is None:
        raise FoamFileError(
            f"{path}: entry boundaryField/{patch.name} is missing.\n"
            f"    Allowed: an entry for each patch; found "
            f"{', '.join(boundary)}")
    return found


def uniform(value):
    """The number or vector of 'uniform ...', or None"""
    if isinstance(value, list) and len(value) == 2 and value[0] == "uniform":
        value = value[1]
    elif isinstance(value, list) and len(value) == 2 and (
            value[0] == "constant"):
        value = value[1]
    if isinstance(value, list):
        numbers = [foamDict.number(v) for v in value]
        return None if None in numbers else np.array(numbers)
    return foamDict.number(value)


class InterFoamCase:
    """What an interFoam case says, read in a working copy"""

    def __init__(self, case, work, notes, time=None):
        self.case, self.work, self.note = Path(case), Path(work), notes
        workingCopy(self.case, self.work)
        self._mesh()
        self._properties()
        self._start(time)
        self._leftBehind()

    # --- mesh -------------------------------------------------------------

    def _mesh(self):
        if not (self.work/"constant"/"polyMesh"/"points").is_file():
            dicts = [p for p in [self.work/"system"/"blockMeshDict",
                                 self.work/"constant"/"polyMesh"
                                 /"blockMeshDict"] if p.is_file()]
            if not dicts:
                raise FoamFileError(
                    f"{self.case}: neither constant/polyMesh/points nor "
                    "system/blockMeshDict: make the mesh first")
            later = [n for n in ["snappyHexMeshDict", "topoSetDict",
                                 "extrudeMeshDict", "refineMeshDict",
                                 "mirrorMeshDict", "createBafflesDict"]
                     if (self.work/"system"/n).is_file()]
            if later:
                raise FoamFileError(
                    f"{self.case}: no constant/polyMesh, and system/"
                    f"{later[0]} changes what blockMesh makes: make the mesh "
                    "as the case's Allrun does, then convert")
            run(self.work, "blockMesh")
        self.mesh = Mesh(self.work)
        for patch in self.mesh.patches:
            if patch.type in ("wedge", "cyclicAMI", "cyclicACMI", "cyclicSlip",
                              "processor"):
                raise FoamFileError(
                    f"{self.case}/constant/polyMesh/boundary: entry "
                    f"{patch.name}/type has the value {patch.type}.\n"
                    "    Allowed: patch, wall, empty, symmetry, "
                    "symmetryPlane, cyclic; nothing else can be carried over")
        self.empty = self.mesh.emptyDirection

    # --- properties -------------------------------------------------------

    def _properties(self):
        path = self.work/"constant"/"transportProperties"
        shown = self.case/"constant"/"transportProperties"
        if not path.is_file():
            raise FoamFileError(f"{shown}: no such file: not a case of "
                                "interFoam")
        d = foamDict.Dictionary.read(path)
        d.path = shown
        phases = d.entries.get("phases")
        if not isinstance(phases, list) or len(phases) != 2:
            d.fail("phases", "two phases, water first: (water air)")
        self.phase = phases[0]
        water, air = (d.sub(p) for p in phases)
        model = water.word("transportModel", "Newtonian",
                           ["Newtonian", "HerschelBulkley"])
        self.rho = _quantity(water, "rho")
        # Kinematic, as mpmFoam's model of that name has them
        self.yieldStress = {}
        if model == "HerschelBulkley":
            coeffs = water.sub("HerschelBulkleyCoeffs")
            self.yieldStress = {k: _quantity(coeffs, k)
                                for k in ["tau0", "k", "n", "nu0"]}
            self.mu = 0.0
            self.nuMax = self.yieldStress["nu0"]
        else:
            self.nuMax = _quantity(water, "nu")
            self.mu = self.rho*self.nuMax
        rhoAir = _quantity(air, "rho")
        self.air = {"rho": rhoAir, "nu": _quantity(air, "nu")}
        if rhoAir > 0.1*self.rho:
            d.fail(f"{phases[1]}", "a light second phase (density below a "
                   f"tenth of {phases[0]}'s): mpmFoam has no second fluid")
        self.note("left behind", f"{phases[1]} ({rhoAir:g} kg/m3): mpmFoam "
                  "computes the water only; air that is shut in does not "
                  "hold")
        sigma = _quantity(d, "sigma") if "sigma" in d else 0.0

        g = self.work/"constant"/"g"
        if not g.is_file():
            raise FoamFileError(f"{self.case}/constant/g: no such file")
        self.g = np.array([foamDict.number(v) for v in
                           foamDict.read(g)["value"]])
        self.sigma = sigma
        if sigma > 0 and np.linalg.norm(self.g) > 0:
            length = np.sqrt(sigma/(self.rho*np.linalg.norm(self.g)))
            self.note("left behind", f"surface tension {sigma:g} N/m (matters "
                      f"below some {1e3*length:.2g} mm)")

        self.control = foamDict.Dictionary.read(
            self.work/"system"/"controlDict")
        self.control.path = self.case/"system"/"controlDict"
        application = self.control.word("application", "interFoam")
        if application not in ("interFoam", "interIsoFoam"):
            self.control.fail("application", "interFoam, interIsoFoam")

    def _leftBehind(self):
        constant, system = self.work/"constant", self.work/"system"
        for name in ["turbulenceProperties", "momentumTransport"]:
            if (constant/name).is_file():
                d = foamDict.read(constant/name)
                kind = d.get("simulationType", "laminar")
                if kind != "laminar":
                    inner = d.get(kind, {})
                    model = inner.get(f"{kind}Model", "")
                    self.note("left behind", f"turbulence model {kind} "
                              f"{model}: the new case is laminar (mpmFoam has "
                              "mixingLength, Smagorinsky and kEpsilon: "
                              "docs/theory.md)")
        path = constant/"dynamicMeshDict"
        if path.is_file():
            kind = foamDict.read(path).get("dynamicFvMesh", "staticFvMesh")
            if kind == "dynamicRefineFvMesh":
                self.note("left behind", "refinement during the run "
                          "(dynamicMeshDict): cells stay as they are")
            elif kind != "staticFvMesh":
                raise FoamFileError(
                    f"{self.case}/constant/dynamicMeshDict: entry "
                    f"dynamicFvMesh has the value {kind}.\n    Allowed: "
                    "staticFvMesh, dynamicRefineFvMesh: a mesh that moves "
                    "cannot be carried over; a tank that moves as a whole: "
                    "convert it at rest, then docs/howto/movingFrame.md")
        for path in [constant/"fvOptions", system/"fvOptions",
                     constant/"MRFProperties", constant/"porosityProperties"]:
            if path.is_file():
                active = [k for k, v in foamDict.read(path).items()
                          if k != "FoamFile" and isinstance(v, dict)
                          and v.get("active", "yes") not in ("no", "false",
                                                             "off")]
                if active:
                    raise FoamFileError(
                        f"{self.case}/{path.relative_to(self.work)}: entry "
                        f"{active[0]} cannot be carried over.\n    Allowed: "
                        "none that is active")
        for name in self.control.sub("functions", required=False):
            self.note("left behind", f"function object {name} of "
                      "controlDict: put it in by hand where it makes sense")

    # --- start ------------------------------------------------------------

    def _field(self, name):
        path = self.work/self.time/name
        if not path.is_file():
            raise FoamFileError(f"{self.case}/{self.time}/{name}: no such "
                                "file")
        return path

    def boundary(self, name):
        """boundaryField of a field at the start"""
        if foamFile.isBinary(self._field(name)):
            # foamDictionary cannot read such lists
            for key, value in [("writeFormat", "ascii"),
                               ("writePrecision", "16")]:
                run(self.work, "foamDictionary", "system/controlDict",
                    "-disableFunctionEntries", "-entry", key, "-set", value)
            run(self.work, "foamFormatConvert", "-time", self.time)
        return foamDict.read(self._field(name), "boundaryField")

    def _otherPatches(self, name):
        """Say which patches of a field the mesh does not have, as those of
        baffles that are not made yet"""
        names = {p.name for p in self.mesh.patches}
        names.update(g for p in self.mesh.patches for g in p.groups)
        for key in self.boundary(name):
            if re.fullmatch(r"\w+", key) and key not in names:
                self.note("left behind", f"patch {key} of {self.time}/{name}: "
                          "the mesh has none of that name (if a utility of "
                          "the case's Allrun makes it, run that first)")

    def _start(self, time):
        self.time = "0"
        if time is not None:
            source = next((p for p in self.case.iterdir() if p.is_dir() and
                           _isNumber(p.name) and float(p.name) == float(time)),
                          None)
            if source is None:
                raise FoamFileError(
                    f"{self.case}: no time {time}.\n    Allowed: " + ", ".join(
                        sorted((p.name for p in self.case.iterdir()
                                if p.is_dir() and _isNumber(p.name)),
                               key=float)))
            self.time = source.name
            if self.time != "0" or source.name == "0":
                shutil.rmtree(self.work/self.time, ignore_errors=True)
                shutil.copytree(source, self.work/self.time)
                uncompress(self.work)
        name = f"alpha.{self.phase}"
        n = self.mesh.nCells
        alpha = foamFile.readInternalField(self._field(name), n)
        if time is None and np.ptp(alpha) == 0:
            if (self.work/"system"/"setFieldsDict").is_file():
                run(self.work, "setFields")
                alpha = foamFile.readInternalField(self._field(name), n)
        self.alpha = np.clip(alpha, 0, 1)
        self.U = foamFile.readInternalField(self._field("U"), n)
        self._otherPatches("U")
        self.volume = float((self.alpha*self.mesh.volumes).sum())


def _isNumber(name):
    return re.fullmatch(r"[0-9.]+(e[-+]?[0-9]+)?", name) is not None


def _quantity(d, key):
    """A number that may have a name and dimensions before it"""
    value = d.entries.get(key)
    if isinstance(value, list):
        value = value[-1]
    found = foamDict.number(value)
    if found is None or found < 0:
        d.fail(key, "a number >= 0")
    return found


# --- the lattice ----------------------------------------------------------

def keyPlanes(mesh, d, alpha=None):
    """Coordinates of boundary faces across a direction, and of faces between
    water and air at the start"""
    inner = len(mesh.neighbour)
    size = np.linalg.norm(mesh.areas, axis=1)
    across = np.abs(mesh.areas[:, d]) > 0.999*size
    use = across & (np.arange(len(size)) >= inner)
    planes = _merged(mesh.faceCentres[use, d])
    water = []
    if alpha is not None:
        edge = np.abs(alpha[mesh.owner[:inner]]
                      - alpha[mesh.neighbour]) > 0.99
        water = _merged(mesh.faceCentres[:inner][edge & across[:inner], d])
    return planes, water


def _merged(values):
    values = np.sort(values)
    if not len(values):
        return []
    span = (np.ptp(values) or 1)*1e-6
    keep = np.concatenate([[True], np.diff(values) > span])
    return list(values[keep])


def cellSize(mesh):
    """The size of cells that most of the volume has"""
    size = (mesh.upper - mesh.lower)
    d = [c for c in range(3) if c != mesh.emptyDirection]
    h = np.prod(size[:, d], axis=1)**(1/len(d))
    order = np.argsort(h)
    share = np.cumsum(mesh.volumes[order])
    return float(h[order][np.searchsorted(share, 0.5*share[-1])])


def counts(bounds, h, empty):
    length = bounds[1] - bounds[0]
    n = np.maximum(np.round(length/h), 1).astype(int)
    if empty is not None:
        n[empty] = 1
    return n


def propose(inter, parts):
    """A spacing near that of the mesh at which solids, and water within parts
    of a cell, move least: of all from half to 1.1 of it, one that parts solids
    by two cells"""
    mesh, bounds = inter.mesh, inter.mesh.bounds
    size = cellSize(mesh)
    solids = [[] if d == inter.empty else keyPlanes(mesh, d)[0]
              for d in range(3)]
    water = [[] if d == inter.empty else keyPlanes(mesh, d, inter.alpha)[1]
             for d in range(3)]
    span = max(bounds[1][d] - bounds[0][d] for d in range(3)
               if d != inter.empty)
    best = None
    for n in range(int(np.ceil(span/(1.1*size))), int(span/(0.5*size)) + 1):
        h = span/n
        lattice = Lattice(*bounds, counts(bounds, h, inter.empty))
        moved, merged = 0.0, False
        for d in range(3):
            snapped = [lattice.snap(v, d) for v in solids[d]]
            moved = max([moved, *(abs(a - b) for a, b in
                                  zip(snapped, solids[d]))])
            moved = max([moved, *(0.3*abs(lattice.snap(v, d, parts) - v)
                                  for v in water[d])])
            steps = np.diff(sorted(snapped))
            merged |= bool((steps < 1.5*lattice.h[d]).any())
        # The mesh's own size if nothing moves for it
        cost = moved/size + 0.05*abs(size/h - 1) + (10 if merged else 0)
        if best is None or cost < best[0] - 1e-9:
            best = cost, h
    return best[1]


# --- the conversion -------------------------------------------------------

class Conversion:
    def __init__(self, inter, target, spacing, points, rest, notes):
        self.inter, self.target, self.note = inter, Path(target), notes
        mesh = inter.mesh
        self.twoD = inter.empty is not None
        self.parts = points or (4 if self.twoD else 2)
        self.h = spacing or propose(inter, self.parts)
        notes("spacing", f"{self.h:.6g} m "
              + ("as asked" if spacing else "proposed")
              + f" (the mesh has {cellSize(mesh):.4g} m in most of its "
              "volume)")
        self._lattice()
        self._boundaries()
        self._water(rest)

    def _lattice(self):
        inter, note = self.inter, self.note
        mesh = inter.mesh
        self.lattice = lattice = Lattice(
            *mesh.bounds, counts(mesh.bounds, self.h, inter.empty))
        used = [d for d in range(3) if d != inter.empty]
        worst = max(abs(lattice.h[d]/self.h - 1) for d in used)
        if worst > 1e-6:
            note("changed", "cells are " + " x ".join(
                f"{lattice.h[d]:.6g}" for d in used) + " m, so that their "
                "number fits the outer sides")
        self.fine = mesh.cellsAt(lattice.axes(self.parts))
        n, p = lattice.n[::-1], self.parts
        inside = (self.fine >= 0).reshape(
            n[0], p, n[1], p, n[2], p).mean(axis=(1, 3, 5))
        # By the middle of the cell: as planes are rounded
        lattice.active = mesh.cellsAt(lattice.axes()) >= 0
        partly = (inside > 0) & (inside < 1)

        for d in used:
            for value in keyPlanes(mesh, d)[0]:
                moved = lattice.snap(value, d) - value
                if abs(moved) > 1e-6*self.h:
                    note("moved", f"wall at {AXES[d]} = {value:.6g} to "
                         f"{value + moved:.6g} m ({1e3*moved:+.3g} mm)")
        size = np.linalg.norm(mesh.areas, axis=1)
        for patch in mesh.patches:
            if patch.type == "empty" or not patch.size:
                continue
            share = np.abs(mesh.areas[patch.faces]).max(axis=1) \
                / size[patch.faces]
            if (share < 0.999).any():
                note("changed", f"{patch.name}: faces that are not along the "
                     f"axes become steps of {self.h:.4g} m")
        total = lattice.active.sum()*np.prod(lattice.h)
        change = total/mesh.volumes.sum() - 1
        if partly.any():
            note("changed", f"volume of the domain {100*change:+.3g} %")
        thin = lattice.thinSolids()
        if thin:
            d, cell = thin[0]
            at = lattice.lower + (cell + 0.5)*lattice.h
            raise FoamFileError(
                f"{inter.case}: a solid at ({' '.join(f'{v:.4g}' for v in at)}"
                f") is one cell thick along {AXES[d]} with cells of "
                f"{lattice.h[d]:.4g} m; the flow on both sides would feel each "
                f"other.\n    Allowed: two cells and more: --spacing "
                f"{lattice.h[d]/2:.4g} or less")

    def _patchOf(self, centres, normals):
        """Nearest face of the mesh that looks the same way, or else any"""
        from scipy.spatial import cKDTree

        mesh = self.inter.mesh
        inner = len(mesh.neighbour)
        number = np.full(len(mesh.areas), -1)
        for k, patch in enumerate(mesh.patches):
            number[patch.faces] = k
        faces = np.arange(inner, len(mesh.areas))
        unit = mesh.areas[faces] / np.linalg.norm(
            mesh.areas[faces], axis=1)[:, None]
        out = np.full(len(centres), -1)
        for d in range(3):
            for side in (1, -1):
                mine = normals[:, d] == side
                if not mine.any():
                    continue
                like = unit[:, d]*side > 0.3
                if d != self.inter.empty and self.inter.empty is not None:
                    like &= np.abs(unit[:, self.inter.empty]) < 0.5
                if not like.any():
                    like = np.ones(len(faces), dtype=bool)
                # Faces larger than a cell: distance to the box, by candidates
                tree = cKDTree(mesh.faceCentres[faces[like]])
                k = min(12, like.sum())
                _, near = tree.query(centres[mine], k=k)
                near = near.reshape(mine.sum(), -1)
                candidates = faces[like][near]
                gap = np.maximum(
                    mesh.faceLower[candidates] - centres[mine][:, None],
                    centres[mine][:, None] - mesh.faceUpper[candidates])
                distance = (np.maximum(gap, 0)**2).sum(axis=2)
                best = np.argmin(distance, axis=1)
                out[mine] = number[candidates[np.arange(len(best)), best]]
        names = [p.name for p in mesh.patches]
        for k, (name, (g, base, top)) in enumerate(self.rest.items()):
            half = 0.5*self.lattice.h[g]
            beyond = (centres[:, g] - half > top - 1e-6*half) | (
                centres[:, g] + half < base + 1e-6*half)
            out[(out == names.index(name)) & beyond] = len(names) + k
        return out

    # --- boundary conditions ----------------------------------------------

    def _boundaries(self):
        inter, note = self.inter, self.note
        name = f"alpha.{inter.phase}"
        U, alpha = inter.boundary("U"), inter.boundary(name)
        pName = next((n for n in ["p_rgh", "pd", "p"]
                      if (inter.work/inter.time/n).is_file()), None)
        p = inter.boundary(pName) if pName else {}
        self.types, self.conditions, self.inlets = {}, {}, {}
        # Inlets that are lower than their patch: the rest is a wall
        self.rest = {}
        path = inter.case/inter.time/"U"
        end = inter.control.number("endTime")
        layer = np.sqrt(inter.nuMax*end)
        for patch in inter.mesh.patches:
            entry = {"type": patch.type}
            if patch.type == "cyclic":
                entry["neighbourPatch"] = patch.entries["neighbourPatch"]
            if patch.type not in ("empty", "symmetry", "symmetryPlane",
                                  "cyclic", "wall", "patch"):
                entry["type"] = "patch"
                note("changed", f"{patch.name}: type {patch.type} becomes "
                     "patch")
            self.types[patch.name] = entry
            if patch.type in BY_TYPE:
                self.conditions[patch.name] = {"type": patch.type}
                continue
            u = patchEntry(U, patch, path)
            kind = u.get("type")
            value = uniform(u.get("value", u.get("uniformValue")))
            zero = value is not None and not np.any(value)
            d = foamDict.Dictionary(u, path, f"boundaryField/{patch.name}")
            if kind == "slip" or kind in ("symmetry", "symmetryPlane"):
                condition = {"type": "slip"}
            elif kind in ("noSlip", "movingWallVelocity") or (
                    kind in ("fixedValue", "uniformFixedValue") and zero):
                condition = self._wall(patch, kind, layer)
            elif kind in ("fixedValue", "uniformFixedValue") and (
                    value is not None and self._tangential(patch, value)):
                condition = {"type": "fixedValue",
                             "value": ["uniform", list(value)]}
            elif kind in OPENINGS:
                condition = {"type": "zeroGradient"}
                self._opening(patch, p, pName, alpha, name)
            elif kind in INLETS:
                condition = self._inlet(patch, u, d, kind, value,
                                        patchEntry(alpha, patch,
                                                   inter.case/inter.time/name))
            else:
                d.fail("type", ", ".join(sorted(set(
                    ("noSlip", "slip") + OPENINGS + INLETS)))
                    + "; others cannot be carried over")
            self.conditions[patch.name] = condition
        for name in self.rest:
            self.types[f"{name}Wall"] = {"type": "wall"}
            self.conditions[f"{name}Wall"] = {"type": "slip"}

    def _wall(self, patch, kind, layer):
        if layer > 2*self.h:
            self.note("kept", f"{patch.name}: {kind}; the boundary layer is "
                      f"resolved (sqrt(nu t) = {layer:.3g} m)")
            return {"type": "noSlip"}
        self.note("changed", f"{patch.name}: {kind} becomes slip; the "
                  f"boundary layer (sqrt(nu t) = {layer:.2g} m at the end) is "
                  "thinner than two cells, and noSlip would hold a whole row "
                  "of cells back")
        return {"type": "slip"}

    def _tangential(self, patch, value):
        normal = self.inter.mesh.areas[patch.faces].sum(axis=0)
        return abs(normal @ value) < 1e-6*np.linalg.norm(normal) \
            * np.linalg.norm(value)

    def _opening(self, patch, p, pName, alpha, name):
        inter = self.inter
        a = patchEntry(alpha, patch, inter.case/inter.time/name)
        inflow = uniform(a.get("inletValue"))
        if inflow is not None and np.any(inflow):
            raise FoamFileError(
                f"{inter.case}/{inter.time}/{name}: entry boundaryField/"
                f"{patch.name}/inletValue has the value {inflow:g}.\n"
                "    Allowed: 0; water that flows in through an opening "
                "cannot be carried over: make it an inlet of given velocity")
        if p:
            entry = patchEntry(p, patch, inter.case/inter.time/pName)
            for key in ["p0", "value", "p", "gradient"]:
                value = uniform(entry.get(key))
                if entry.get("type") in ("zeroGradient",
                                         "fixedFluxPressure"):
                    break
                if value is not None and np.any(value):
                    raise FoamFileError(
                        f"{inter.case}/{inter.time}/{pName}: entry "
                        f"boundaryField/{patch.name}/{key} has the value "
                        f"{value:g}.\n    Allowed: 0; an opening has the "
                        "pressure of the air (a level behind it: waterLevel "
                        "of an outlet, by hand)")

    def _inlet(self, patch, u, d, kind, value, a):
        inter = self.inter
        mesh = inter.mesh
        alpha = uniform(a.get("value")) if a.get("type") in (
            "fixedValue", "uniformFixedValue") else None
        if alpha is None:
            alpha = uniform(a.get("uniformValue"))
        if alpha is not None and not np.any(alpha):
            self.note("changed", f"{patch.name}: air blows in; becomes slip")
            return {"type": "slip"}
        normal = mesh.areas[patch.faces]
        area = np.linalg.norm(normal.sum(axis=0))
        unit = normal.sum(axis=0)/area
        axis = int(np.argmax(np.abs(unit)))
        if abs(unit[axis]) < 0.999:
            d.fail("type", "an inlet along an axis; this patch is oblique")
        out = {"patch": patch.name,
               "pointsPerDirection": self.parts}
        g = int(np.argmax(np.abs(inter.g)))
        width = None
        across = [c for c in range(3) if c not in (axis, g)]
        lower = mesh.faceLower[patch.faces].min(axis=0)
        upper = mesh.faceUpper[patch.faces].max(axis=0)
        if across:
            width = upper[across[0]] - lower[across[0]]

        # Water at the patch at the start; all of it if alpha is 1 there
        full = alpha is not None and np.all(alpha == 1)
        if not full and axis != g:
            at = mesh.owner[patch.faces]
            wet = inter.alpha[at] > 0.5
            up = -np.sign(inter.g[g])
            heights = [mesh.faceLower[patch.faces][wet, g],
                       mesh.faceUpper[patch.faces][wet, g]]
            if not wet.any():
                raise FoamFileError(
                    f"{inter.case}/{inter.time}: entry boundaryField/"
                    f"{patch.name} has the type {kind}, but there is no water "
                    "at the patch at the start, which says how deep it "
                    "enters.\n    Allowed: water at the inlet, or alpha "
                    "fixedValue 1")
            if up < 0:
                d.fail("type", "an inlet with gravity along a negative axis")
            base = min(heights[0])
            top = self.lattice.snap(max(heights[1]), g, self.parts)
            depth = top - base
            out["base"], out["depth"] = float(base), float(depth)
            if lower[g] < base - 0.5*self.h or upper[g] > top + 0.5*self.h:
                self.rest[patch.name] = (g, base, top)
                self.note("changed", f"{patch.name}: above and below the "
                          f"inlet it becomes a wall, {patch.name}Wall")
            self.note("changed", f"{patch.name}: the water enters between "
                      f"{base:.4g} and {top:.4g} m, its level at the start; "
                      "in interFoam the level at the inlet may change")
        else:
            depth = upper[g] - lower[g]
            if axis == g:
                depth = None

        if kind in ("flowRateInletVelocity",
                    "variableHeightFlowRateInletVelocity"):
            key = "flowRate" if "flowRate" in u else "volumetricFlowRate"
            rate = uniform(u.get(key))
            if rate is None or np.ndim(rate) or rate < 0:
                d.fail(key, "a constant volume per time [m3/s], >= 0")
            if depth is None:
                out["velocity"] = list(-unit*rate/area)
            else:
                out["discharge"] = float(rate/width)
                self.note("kept", f"{patch.name}: {rate:g} m3/s are "
                          f"{rate/width:.4g} m2/s per metre of width, "
                          f"{rate/width/depth:.4g} m/s over {depth:.4g} m")
        elif kind == "surfaceNormalFixedValue":
            speed = uniform(u.get("refValue"))
            if speed is None:
                d.fail("refValue", "uniform <number>")
            out["velocity"] = list(unit*speed)
        else:
            if value is None:
                d.fail("value", "uniform (x y z); nonuniform values cannot be "
                       "carried over")
            if value @ unit >= 0:
                d.fail("value", "a velocity into the domain; a fixed outflow "
                       "cannot be carried over")
            out["velocity"] = list((value @ unit)*unit)
            side = value - (value @ unit)*unit
            if np.linalg.norm(side) > 1e-6*np.linalg.norm(value):
                self.note("left behind", f"{patch.name}: the part of the "
                          "velocity along the patch")
        speed = out.get("velocity") or list(
            -unit*out["discharge"]/depth)
        self.inlets[patch.name] = out
        return {"type": "fixedValue", "value": ["uniform", speed]}

    # --- water ------------------------------------------------------------

    def _water(self, rest):
        inter, lattice, p = self.inter, self.lattice, self.parts
        mesh = inter.mesh
        # Partly filled cells: alpha between the centres of the cells
        if ((inter.alpha > 0.01) & (inter.alpha < 0.99)).any():
            from scipy.interpolate import LinearNDInterpolator
            axes = lattice.axes(p)
            d = [c for c in range(3) if c != inter.empty]
            z, y, x = np.meshgrid(axes[2], axes[1], axes[0], indexing="ij")
            at = np.stack([x, y, z], axis=-1)
            wet = np.take(inter.alpha, np.maximum(self.fine, 0)) > 0.5
            mixed = LinearNDInterpolator(
                mesh.centres[:, d], inter.alpha)(at[..., d])
            wet = np.where(np.isnan(mixed), wet, mixed > 0.5)
        else:
            wet = np.take(inter.alpha, np.maximum(self.fine, 0)) > 0.5
        solid = ~np.repeat(np.repeat(np.repeat(
            lattice.active, p, 0), p, 1), p, 2)
        wet &= (self.fine >= 0) & ~solid
        # Steps that reach into what was solid: as the cell's other points
        stepped = (self.fine < 0) & ~solid
        if stepped.any():
            n = lattice.n[::-1]
            shape = (n[0], p, n[1], p, n[2], p)
            known = ((self.fine >= 0) & ~solid).reshape(shape)
            share = (wet.reshape(shape).sum(axis=(1, 3, 5))
                     / np.maximum(known.sum(axis=(1, 3, 5)), 1)) > 0.5
            wet |= stepped & np.repeat(np.repeat(np.repeat(
                share, p, 0), p, 1), p, 2)
        self.wet = wet
        volume = wet.sum()*np.prod(lattice.h/p)
        self.volume = float(volume)
        if inter.volume > 0:
            change = self.volume/inter.volume - 1
            self.note("water", f"{self.volume:.6g} m3, interFoam starts with "
                      f"{inter.volume:.6g} ({100*change:+.3g} %)")
            if abs(change) > 0.1:
                raise FoamFileError(
                    f"{inter.case}: the water at the start would change by "
                    f"{100*change:.1f} %: bodies thinner than a cell.\n"
                    "    Allowed: a smaller --spacing")
        for d in range(3):
            if d == inter.empty:
                continue
            for value in keyPlanes(mesh, d, inter.alpha)[1]:
                moved = lattice.snap(value, d, p) - value
                if abs(moved) > 1e-6*self.h:
                    self.note("moved", f"edge of the water at {AXES[d]} = "
                              f"{value:.6g} to {value + moved:.6g} m "
                              f"({1e3*moved:+.3g} mm)")
        # Velocity
        speed = np.linalg.norm(inter.U, axis=1)
        cells = np.unique(self.fine[wet & (self.fine >= 0)])
        moving = speed[cells] if len(cells) else np.zeros(1)
        self.velocity = np.zeros(3)
        if moving.max() > 0:
            mean = inter.U[cells].mean(axis=0)
            spread = np.linalg.norm(inter.U[cells] - mean, axis=1).max()
            if spread <= 1e-6*moving.max():
                self.velocity = mean
            elif rest:
                self.note("left behind", "velocity at the start (up to "
                          f"{moving.max():.3g} m/s): from rest, as asked")
            else:
                raise FoamFileError(
                    f"{inter.case}/{inter.time}/U: the velocity of the water "
                    f"is not uniform (0 to {moving.max():.3g} m/s); regions "
                    "of points have one each.\n    Allowed: a uniform "
                    "velocity; or --rest, to start from rest")
        self.boxes = boxes(wet)

    def regions(self):
        """Boxes of points: lower and upper corner, level of the surface"""
        lattice, step = self.lattice, self.lattice.h/self.parts
        g = int(np.argmax(np.abs(self.inter.g)))
        out = []
        for low, high in self.boxes:
            lower = lattice.lower + low*step
            upper = lattice.lower + high*step
            if self.inter.empty is not None:
                d = self.inter.empty
                thick = lattice.upper[d] - lattice.lower[d]
                lower[d], upper[d] = lattice.lower[d] - thick, \
                    lattice.upper[d] + thick
            # Top of the water that stands on the middle of the box
            column = [(low[c] + high[c])//2 for c in range(3)]
            index = [column[2], column[1], column[0]]
            index[2 - g] = slice(None)
            line = self.wet[tuple(index)]
            up = self.inter.g[g] <= 0
            k = column[g]
            while 0 <= k + (1 if up else -1) < len(line) and (
                    line[k + (1 if up else -1)]):
                k += 1 if up else -1
            level = lattice.lower[g] + (k + (1 if up else 0))*step[g]
            out.append((lower, upper, level if up else -level))
        return out

    # --- files ------------------------------------------------------------

    def write(self):
        inter, target = self.inter, self.target
        (target/"system").mkdir(parents=True, exist_ok=True)
        (target/"0.orig").mkdir(exist_ok=True)
        (target/"constant").mkdir(exist_ok=True)
        names = [p.name for p in inter.mesh.patches]
        names += [f"{name}Wall" for name in self.rest]
        faces = self.lattice.write(target, names, self.types, self._patchOf)
        for name, count in faces.items():
            before = next((p.size for p in inter.mesh.patches
                           if p.name == name), 0)
            if before and not count:
                self.note("left behind", f"patch {name}: no face is left of "
                          "it on this lattice")
        shutil.copyfile(inter.work/"constant"/"g", target/"constant"/"g")
        self._fields()
        self._materials()
        self._placement()
        self._control()
        (target/"conversion.log").write_text(
            f"interFoamToMpmFoam {inter.case}, time {inter.time}\n"
            + "".join(f"    {line}\n" for line in self.note.lines))
        (target/"Allrun").write_text(ALLRUN)
        (target/"Allrun").chmod(0o755)

    def _fields(self):
        text = foamDict.header("U.water", "volVectorField") + (
            "\ndimensions      [0 1 -1 0 0 0 0];\n\n"
            "internalField   uniform (0 0 0);\n\nboundaryField\n{\n")
        for name, condition in self.conditions.items():
            text += f"    {name}\n    {{\n" + "".join(
                "        {:<15} {};\n".format(k, _plain(v))
                for k, v in condition.items()) + "    }\n"
        (self.target/"0.orig"/"U.water").write_text(text + "}\n")

    def _materials(self):
        inlets = "".join(
            f"            {name}\n            {{\n" + "".join(
                f"                {k:<19} {_plain(v)};\n"
                for k, v in inlet.items()) + "            }\n"
            for name, inlet in self.inlets.items())
        flow = f"""
    inflowOutflow
    {{
        inlets
        {{
{inlets}        }}
    }}
""" if inlets else ""
        liquid = ""
        if self.inter.yieldStress:
            coeffs = "".join(f"        {k:12s}{v:.10g};\n"
                             for k, v in self.inter.yieldStress.items())
            liquid = f"""
    viscosityModel      HerschelBulkley;

    HerschelBulkleyCoeffs
    {{
{coeffs}    }}
"""
        (self.target/"constant"/"materialPointProperties").write_text(
            foamDict.header("materialPointProperties") + f"""
clouds      (water);

water
{{
    constitutiveModel   weaklyCompressibleNewtonian;

    weaklyCompressibleNewtonianCoeffs
    {{
        rho0        {self.inter.rho:.10g};
        mu          {self.inter.mu:.10g};
        soundSpeed  auto;   // 10 times the largest speed to expect
        gamma       7;
    }}

    transfer            APIC;
{liquid}{flow}}}
""")

    def _placement(self):
        still = self.inter.time == "0" or not np.any(self.inter.U)
        text = ""
        for k, (lower, upper, level) in enumerate(self.regions()):
            name = "water" if len(self.boxes) == 1 else f"water{k}"
            text += f"""        {name}
        {{
            type        box;
            min         {_plain(lower)};
            max         {_plain(upper)};
            velocity    {_plain(self.velocity)};
            pressure    hydrostatic;
            level       {level:.10g};
        }}
"""
        # Columns of points part where the flow stretches them far
        jitter = "" if self.twoD else \
            "    placement           jittered;\n    jitter              0.5;\n"
        (self.target/"system"/"setMaterialPointsDict").write_text(
            foamDict.header("setMaterialPointsDict") + f"""
water
{{
    pointsPerDirection  {self.parts};
{jitter}
    regions
    {{
{text}    }}
}}
""")
        if not still:
            self.note("changed", "the pressure at the start is hydrostatic")

    def _control(self):
        inter, c = self.inter, self.inter.control
        start = float(inter.time)
        end = c.number("endTime") - start
        interval = c.number("writeInterval", allowed="a time [s], > 0",
                            within=lambda v: v > 0)
        kind = c.word("writeControl", "timeStep")
        if kind in ("timeStep",):
            interval *= c.number("deltaT")
        elif kind not in ("adjustable", "adjustableRunTime", "runTime"):
            interval = end/20
            self.note("changed", f"writeControl {kind} becomes 20 times over "
                      "the run")
        if start:
            self.note("changed", f"time {inter.time} becomes 0")
        depth = np.ptp(self.lattice.axes()[int(np.argmax(np.abs(inter.g)))])
        speed = np.sqrt(2*np.linalg.norm(inter.g)*max(depth, self.h)) or 1.0
        deltaT = min(1e-4, 0.05*self.h/(10*speed))
        horizontal = next(d for d in range(3) if d != inter.empty
                          and abs(inter.g[d]) < 1e-9) if (
            np.count_nonzero(np.abs(inter.g) < 1e-9) > (
                inter.empty is not None)) else 0
        direction = [0, 0, 0]
        direction[horizontal] = 1
        low, high = self.lattice.lower, self.lattice.upper
        places = []
        for share in (0.25, 0.5, 0.75):
            at = 0.5*(low + high)
            at[horizontal] = low[horizontal] + share*(
                high[horizontal] - low[horizontal])
            # In the middle of a cell
            at[horizontal] = low[horizontal] + (np.floor(
                (at[horizontal] - low[horizontal])
                / self.lattice.h[horizontal]) + 0.5) \
                * self.lattice.h[horizontal]
            places.append(at)
        every = interval/5
        functions = ""
        for name, kind, extra in [
                ("energy", "materialPointEnergy", ""),
                ("front", "frontPosition",
                 f"        direction       {_plain(direction)};\n"),
                ("gauge", "waveGauge",
                 f"        points          ({' '.join(map(_plain, places))});"
                 "\n")]:
            functions += f"""    {name}
    {{
        type            {kind};
        libs            ("libmpmFunctionObjects.so");
        cloud           water;
{extra}        writeControl    adjustableRunTime;
        writeInterval   {every:.10g};
    }}
"""
        (self.target/"system"/"controlDict").write_text(
            foamDict.header("controlDict") + f"""
application     mpmFoam;

startFrom       latestTime;
startTime       0;
stopAt          endTime;
endTime         {end:.10g};

deltaT          {deltaT:.3g};
adjustTimeStep  yes;

writeControl    adjustableRunTime;
writeInterval   {interval:.10g};
purgeWrite      0;
writeFormat     binary;
writePrecision  12;
writeCompression off;
timeFormat      general;
timePrecision   8;
runTimeModifiable yes;

functions
{{
{functions}}}
""")
        (self.target/"system"/"fvSolution").write_text(
            foamDict.header("fvSolution")
            + "\nMPM\n{\n    maxCo           0.5;\n}\n")
        (self.target/"system"/"fvSchemes").write_text(
            foamDict.header("fvSchemes") + "\n" + "".join(
                f"{k}Schemes {{ default {v}; }}\n" for k, v in [
                    ("ddt", "none"), ("grad", "none"), ("div", "none"),
                    ("laplacian", "none"), ("interpolation", "linear"),
                    ("snGrad", "none")]))


ALLRUN = """#!/bin/sh
cd "${0%/*}" || exit                                # Run from this directory
: "${MPMFOAM_DIR:?source etc/bashrc of mpmFoam first}"
. "$WM_PROJECT_DIR/bin/tools/RunFunctions"          # Tutorial run functions
set -e

# The mesh is that of interFoamToMpmFoam; conversion.log says what was changed
[ -f log.setMaterialPoints ] || restore0Dir         # Keep the points of a first run
runApplication setMaterialPoints
runApplication mpmFoam

#------------------------------------------------------------------------------
"""


def _plain(value):
    """As OpenFOAM writes it, without noise in the last digits"""
    if isinstance(value, (list, tuple, np.ndarray)) and len(value) == 2 and (
            isinstance(value[0], str)):
        return f"{value[0]} {_plain(value[1])}"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "(" + " ".join(_plain(v) for v in value) + ")"
    if isinstance(value, (float, np.floating)):
        return f"{0.0 if abs(value) < 1e-14 else value:.10g}"
    return str(value)


def boxes(mask):
    """Boxes that fill a mask [z, y, x]: (lower, upper) as indices (x, y, z).
    Runs along x, then equal runs along y, then equal rectangles along z"""
    done = []
    open3 = {}
    for k in range(mask.shape[0]):
        rectangles = []
        open2 = {}
        for j in range(mask.shape[1]):
            row = np.diff(np.concatenate([[0], mask[k, j].astype(int), [0]]))
            runs = list(zip(np.nonzero(row == 1)[0], np.nonzero(row == -1)[0]))
            for run in list(open2):
                if run not in runs:
                    rectangles.append((run, open2.pop(run), j))
            for run in runs:
                open2.setdefault(run, j)
        rectangles += [(run, j0, mask.shape[1]) for run, j0 in open2.items()]
        for r in list(open3):
            if r not in rectangles:
                done.append((r, open3.pop(r), k))
        for r in rectangles:
            open3.setdefault(r, k)
    done += [(r, k0, mask.shape[0]) for r, k0 in open3.items()]
    return [(np.array([i0, j0, k0]), np.array([i1, j1, k1]))
            for ((i0, i1), j0, j1), k0, k1 in done]


def convert(case, target=None, spacing=None, points=None, time=None,
            rest=False, quiet=False):
    """Writes the case target; returns the Conversion"""
    case = Path(case).resolve()
    target = Path(target).resolve() if target else \
        case.with_name(case.name + "_mpmFoam")
    if target.exists():
        raise FoamFileError(f"{target} exists: name another one, or remove it")
    notes = Notes(quiet)
    with tempfile.TemporaryDirectory(prefix="interFoamToMpmFoam.") as work:
        inter = InterFoamCase(case, Path(work)/"case", notes, time)
        conversion = Conversion(inter, target, spacing, points, rest, notes)
        if not conversion.wet.any() and not conversion.inlets:
            raise FoamFileError(
                f"{case}/{inter.time}/alpha.{inter.phase}: no water, and no "
                "inlet.\n    Allowed: setFieldsDict, a time with water "
                "(--time), or an inlet")
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
        prog="interFoamToMpmFoam",
        description="Makes a case of mpmFoam of one of interFoam, and says "
        "what moved, changed, or was left behind (docs/howto/"
        "fromInterFoam.md).")
    parser.add_argument("case")
    parser.add_argument("newCase", nargs="?",
                        help="default: <case>_mpmFoam beside it")
    parser.add_argument("--spacing", type=float, metavar="h",
                        help="size of the cells [m] (default: proposed)")
    parser.add_argument("--points", type=int,
                        help="points per cell and direction (default: 4 in "
                        "2D, 2 in 3D)")
    parser.add_argument("--time", help="start from alpha of this time "
                        "(default: 0, with setFieldsDict)")
    parser.add_argument("--rest", action="store_true",
                        help="drop a velocity at the start that is not "
                        "uniform")
    a = parser.parse_args()
    print(f"interFoamToMpmFoam {a.case}")
    try:
        c = convert(a.case, a.newCase, a.spacing, a.points, a.time, a.rest)
    except FoamFileError as error:
        sys.exit(f"interFoamToMpmFoam: {error}")
    cells = int(c.lattice.active.sum())
    print(f"Wrote {c.target}: {cells} cells, {len(c.boxes)} regions of water. "
          "Next: its ./Allrun")


if __name__ == "__main__":
    main()
