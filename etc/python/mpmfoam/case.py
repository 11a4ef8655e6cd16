"""A case directory: times, clouds and mesh fields, serial or decomposed."""

import re
from functools import cached_property
from pathlib import Path

import numpy as np

from . import foamFile


class Case:
    """Reads a case as it lies on disk. Where a time exists in the case
    directory it is read there, else from all processor directories, one
    after the other; cell values and cellCentres(time) share that order."""

    def __init__(self, path="."):
        self.path = Path(path)
        if not (self.path/"system"/"controlDict").is_file():
            raise foamFile.FoamFileError(f"{path}: no system/controlDict")

    @cached_property
    def processors(self):
        return sorted(self.path.glob("processor[0-9]*"),
                      key=lambda p: int(p.name[len("processor"):]))

    def times(self):
        """Names of all time directories, by time; constant is none."""
        names = {p.name for root in [self.path, *self.processors]
                 for p in root.iterdir() if p.is_dir() and _isTime(p.name)}
        return sorted(names, key=float)

    def nearestTime(self, time):
        """The name of the time directory nearest to a time in s"""
        times = self.times()
        if not times:
            raise foamFile.FoamFileError(f"{self.path}: no time directories")
        return min(times, key=lambda name: abs(float(name) - float(time)))

    def hasCloud(self, time, cloud):
        return any((root/time/"lagrangian"/cloud).is_dir()
                   for root in self._cloudRoots(time, cloud))

    def cloudField(self, time, cloud, name):
        """A field of a cloud, e.g. cloudField("0.1", "water", "x")"""
        parts = []
        for root in self._cloudRoots(time, cloud):
            path = root/time/"lagrangian"/cloud/name
            # A rank without points may have no files
            if foamFile.stored(path):
                parts.append(foamFile.readList(path))
        if not parts:
            raise FileNotFoundError(
                f"{self.path}: no lagrangian/{cloud}/{name} at {time}")
        return np.concatenate(parts)

    def cloudState(self, time, cloud):
        """Numbers of a cloud in uniform/materialPoints, sums over all ranks:
        nPoints, left, leftMass, wallContacts, ..."""
        # Without the dictionaries in it
        text, nested = self._state(time, cloud), 1
        while nested:
            text, nested = re.subn(r"\w+\s*\{[^{}]*\}", "", text)
        return {key: float(value) for key, value in re.findall(
            r"(\w+)\s+([-+0-9.e]+);", text)}

    def enteredMass(self, time, cloud):
        """Mass that came in through the inlets of a cloud, from the state
        file (which has sums over all ranks)"""
        return sum(float(m) for m in re.findall(
            r"\benteredMass\s+([-+0-9.e]+);", self._state(time, cloud)))

    def _state(self, time, cloud):
        """What uniform/materialPoints says of a cloud"""
        paths = [root/time/"uniform"/"materialPoints"
                 for root in [self.path, *self.processors]]
        path = next(filter(foamFile.stored, paths), paths[-1])
        # The cloud's dictionary ends where a line is nothing but a brace
        return re.search(rf"^{cloud}\s*\n\{{(.*?)^\}}",
                         foamFile.read(path).decode(),
                         re.DOTALL | re.MULTILINE)[1]

    def field(self, time, name):
        """The internal field of a vol<Type>Field, e.g. alpha.water"""
        return np.concatenate(
            [foamFile.readInternalField(root/time/name, len(_centres(root)))
             for root in self._roots(time)])

    def cellCentres(self, time):
        """Cell centres in the order of field(time, ...)"""
        return np.concatenate([_centres(root) for root in self._roots(time)])

    def lattice(self, time, name):
        """A cell field of a 2D mesh in x and y as x, y, values[y, x], with
        nan where the mesh has no cell; values[y, x, component] for vectors"""
        centres = self.cellCentres(time)
        values = self.field(time, name)
        x, i = _levels(centres[:, 0])
        y, j = _levels(centres[:, 1])
        out = np.full((len(y), len(x)) + values.shape[1:], np.nan)
        out[j, i] = values
        return x, y, out

    def _cloudRoots(self, time, cloud):
        """setMaterialPoints in parallel leaves 0 of the case without points"""
        if (self.path/time/"lagrangian"/cloud).is_dir() or (
                not self.processors):
            return self._roots(time)
        return [p for p in self.processors if (p/time).is_dir()] \
            or self._roots(time)

    def _roots(self, time):
        if (self.path/time).is_dir() and (
                len(list((self.path/time).iterdir())) > 0):
            return [self.path]
        roots = [p for p in self.processors if (p/time).is_dir()]
        if not roots:
            raise FileNotFoundError(f"{self.path}: no time {time}")
        return roots


def _isTime(name):
    return re.fullmatch(r"[0-9.]+(e[-+]?[0-9]+)?", name) is not None


_centreCache = {}


def _centres(root):
    """Cell centres of a mesh of boxes: the mean of the centres of its faces"""
    mesh = root/"constant"/"polyMesh"
    key = (mesh.resolve(), foamFile.stored(mesh/"points").stat().st_mtime_ns)
    if key not in _centreCache:
        points = foamFile.readList(mesh/"points")
        faces = points[foamFile.readFaces(mesh/"faces")].mean(axis=1)
        owner = foamFile.readList(mesh/"owner")
        neighbour = foamFile.readList(mesh/"neighbour")
        cells = np.concatenate([owner, neighbour])
        n = owner.max() + 1
        centres = np.zeros((n, 3))
        np.add.at(centres, cells,
                  np.concatenate([faces, faces[:len(neighbour)]]))
        _centreCache[key] = centres/np.bincount(cells, minlength=n)[:, None]
    return _centreCache[key]


def _levels(values):
    """Distinct coordinates of a lattice, and the index of each value"""
    tolerance = 1e-6*(np.ptp(values) or 1)
    levels, index = np.unique(np.round(values/tolerance), return_inverse=True)
    # Neighbouring roundings of one and the same coordinate
    merged = np.concatenate([[0], np.cumsum(np.diff(levels) > 1.5)])
    index = merged[index]
    sums = np.bincount(index, weights=values)
    return sums/np.bincount(index), index
