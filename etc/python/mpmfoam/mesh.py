"""Meshes: any polyMesh as numbers (Mesh), and a lattice of equal cells, some
of them solid, that is written as one (Lattice)."""

import re
from pathlib import Path

import numpy as np

from . import foamDict, foamFile
from .foamFile import FoamFileError


class Patch:
    def __init__(self, name, entries):
        self.name, self.entries = name, entries
        self.type = entries["type"]
        self.start = int(entries.get("startFace", 0))
        self.size = int(entries.get("nFaces", 0))
        groups = entries.get("inGroups", [])
        if isinstance(groups, str):
            groups = [groups]
        # 1(wall), as a word
        self.groups = [g for group in groups if isinstance(group, str)
                       for g in re.sub(r"^\d+\(|\)$", "", group).split()]

    @property
    def faces(self):
        return slice(self.start, self.start + self.size)


class Mesh:
    """constant/polyMesh of a case, with centres and volumes as OpenFOAM has
    them"""

    def __init__(self, case):
        directory = Path(case)/"constant"/"polyMesh"
        if not foamFile.stored(directory/"points"):
            raise FoamFileError(f"{directory}: no mesh; run blockMesh")
        self.points = foamFile.readList(directory/"points")
        starts, labels = foamFile.readFaceLists(directory/"faces")
        self.owner = foamFile.readList(directory/"owner")
        self.neighbour = foamFile.readList(directory/"neighbour")
        self.nCells = int(self.owner.max()) + 1
        self.patches = readBoundary(directory/"boundary")
        self._geometry(starts, labels)

    def _geometry(self, starts, labels):
        n = len(starts) - 1
        sizes = np.diff(starts)
        corners = self.points[labels]
        face = np.repeat(np.arange(n), sizes)
        mean = np.stack([np.bincount(face, corners[:, c], n)
                         for c in range(3)], axis=1)/sizes[:, None]
        # Triangles of each edge with the mean of the corners
        following = np.arange(len(labels)) + 1
        following[starts[1:] - 1] = starts[:-1]
        a, b = corners, corners[following]
        m = mean[face]
        area = 0.5*np.cross(a - m, b - m)
        self.areas = np.stack([np.bincount(face, area[:, c], n)
                               for c in range(3)], axis=1)
        size = np.linalg.norm(area, axis=1)
        total = np.bincount(face, size, n)
        centre = (a + b + m)/3*size[:, None]
        self.faceCentres = np.stack([np.bincount(face, centre[:, c], n)
                                     for c in range(3)], axis=1) \
            / np.where(total > 0, total, 1)[:, None]

        # Cells: pyramids of the faces with the mean of the face centres
        inner = len(self.neighbour)
        self.cellFaces = np.concatenate([np.arange(n), np.arange(inner)])
        cells = np.concatenate([self.owner, self.neighbour])
        sign = np.concatenate([np.ones(n), -np.ones(inner)])
        order = np.argsort(cells, kind="stable")
        self.cellFaces, cells, sign = (
            self.cellFaces[order], cells[order], sign[order])
        self.cellSigns = sign
        count = np.bincount(cells, minlength=self.nCells)
        self.cellStarts = np.concatenate([[0], np.cumsum(count)])
        fc = self.faceCentres[self.cellFaces]
        estimate = np.stack([np.bincount(cells, fc[:, c], self.nCells)
                             for c in range(3)], axis=1)/count[:, None]
        out = self.areas[self.cellFaces]*sign[:, None]
        height = ((fc - estimate[cells])*out).sum(axis=1)
        self.volumes = np.bincount(cells, height, self.nCells)/3
        part = (0.75*fc + 0.25*estimate[cells])*height[:, None]/3
        self.centres = np.stack([np.bincount(cells, part[:, c], self.nCells)
                                 for c in range(3)], axis=1) \
            / self.volumes[:, None]

        # Boxes around the cells
        self.lower = np.full((self.nCells, 3), np.inf)
        self.upper = np.full((self.nCells, 3), -np.inf)
        first = np.full((n, 3), np.inf)
        last = np.full((n, 3), -np.inf)
        np.minimum.at(first, face, corners)
        np.maximum.at(last, face, corners)
        np.minimum.at(self.lower, cells, first[self.cellFaces])
        np.maximum.at(self.upper, cells, last[self.cellFaces])
        self.faceLower, self.faceUpper = first, last

    @property
    def bounds(self):
        return self.points.min(axis=0), self.points.max(axis=0)

    @property
    def emptyDirection(self):
        """The direction across a 2D mesh, or None"""
        for p in self.patches:
            if p.type == "empty" and p.size:
                normal = np.abs(self.areas[p.faces]).sum(axis=0)
                return int(np.argmax(normal))
        return None

    def cellsAt(self, axes):
        """The cell at each point of a lattice, axes (x, y, z) of coordinates;
        -1 outside: array [z, y, x]"""
        found = np.full([len(a) for a in axes[::-1]], -1)
        low = np.stack([np.searchsorted(axes[d], self.lower[:, d])
                        for d in range(3)], axis=1)
        high = np.stack([np.searchsorted(axes[d], self.upper[:, d])
                         for d in range(3)], axis=1)
        box = np.prod(self.upper - self.lower, axis=1)
        isBox = np.abs(self.volumes/box - 1) < 1e-6
        for c in range(self.nCells):
            (i0, j0, k0), (i1, j1, k1) = low[c], high[c]
            if i0 == i1 or j0 == j1 or k0 == k1:
                continue
            part = found[k0:k1, j0:j1, i0:i1]
            if isBox[c]:
                part[...] = c
                continue
            z, y, x = np.meshgrid(axes[2][k0:k1], axes[1][j0:j1],
                                  axes[0][i0:i1], indexing="ij")
            p = np.stack([x, y, z], axis=-1)
            inside = np.ones(x.shape, dtype=bool)
            rows = slice(self.cellStarts[c], self.cellStarts[c + 1])
            for f, s in zip(self.cellFaces[rows], self.cellSigns[rows]):
                inside &= ((p - self.faceCentres[f]) @ self.areas[f])*s <= 0
            part[inside] = c
        return found


def readBoundary(path):
    """Patches of constant/polyMesh/boundary"""
    data = foamFile.read(path).decode("ascii", errors="replace")
    entries = foamDict.parse(data, path)
    entries.pop("FoamFile", None)
    lists = [v for v in entries.values() if isinstance(v, list)]
    if not lists:
        raise FoamFileError(f"{path}: no list of patches")
    items = lists[0]
    return [Patch(items[i], items[i + 1]) for i in range(0, len(items), 2)]


class Lattice:
    """Cells of one size in a box, some of them solid. active[k, j, i]"""

    def __init__(self, lower, upper, counts):
        self.lower, self.upper = np.array(lower), np.array(upper)
        self.n = np.array(counts, dtype=int)
        self.h = (self.upper - self.lower)/self.n
        self.active = np.ones(self.n[::-1], dtype=bool)

    def axes(self, parts=1):
        """Coordinates of the middle of cells, or of parts of them"""
        return [self.lower[d] + (np.arange(self.n[d]*parts) + 0.5)
                * self.h[d]/parts for d in range(3)]

    def snap(self, value, d, parts=1):
        """The plane of cells, or of their parts, nearest to a coordinate"""
        step = self.h[d]/parts
        return self.lower[d] + round((value - self.lower[d])/step)*step

    def thinSolids(self):
        """(direction, cell) of solids one cell thick between the flow"""
        out = []
        for d in range(3):
            a = np.moveaxis(self.active, 2 - d, 0)
            if len(a) < 3:
                continue
            thin = a[:-2] & ~a[1:-1] & a[2:]
            if thin.any():
                layer, v, u = np.argwhere(thin)[0]
                cell = np.zeros(3, dtype=int)
                others = [e for e in range(3) if e != d]
                cell[d] = layer + 1
                cell[others[0]], cell[others[1]] = u, v
                out.append((d, cell))
        return out

    def faces(self):
        """Node labels, owner, neighbour of the inner faces; node labels,
        owner, direction and side of those at the boundary. In OpenFOAM's
        order"""
        nx, ny, nz = self.n
        number = np.full(self.active.shape, -1)
        number[self.active] = np.arange(self.active.sum())
        k, j, i = np.nonzero(self.active)
        node = lambda i, j, k: i + (nx + 1)*(j + (ny + 1)*k)
        corners = {
            0: lambda i, j, k: (node(i, j, k), node(i, j + 1, k),
                                node(i, j + 1, k + 1), node(i, j, k + 1)),
            1: lambda i, j, k: (node(i, j, k), node(i, j, k + 1),
                                node(i + 1, j, k + 1), node(i + 1, j, k)),
            2: lambda i, j, k: (node(i, j, k), node(i + 1, j, k),
                                node(i + 1, j + 1, k), node(i, j + 1, k))}
        inner, outer = [], []
        own = number[k, j, i]
        for d in range(3):
            step = np.zeros(3, dtype=int)
            step[d] = 1
            for side in (1, -1):
                other = np.stack([i, j, k]) + side*step[:, None]
                inside = ((other >= 0) & (other < self.n[:, None])).all(axis=0)
                next = np.full(len(i), -1)
                at = other[:, inside]
                next[inside] = number[at[2], at[1], at[0]]
                shift = step if side > 0 else 0*step
                f = np.stack(corners[d](i + shift[0], j + shift[1],
                                        k + shift[2]), axis=1)
                if side < 0:
                    f = f[:, ::-1]
                if side > 0:
                    joined = next >= 0
                    inner.append((f[joined], own[joined], next[joined]))
                free = next < 0
                outer.append((f[free], own[free],
                              np.full(free.sum(), d),
                              np.full(free.sum(), side)))
        inner = [np.concatenate(a) for a in zip(*inner)]
        outer = [np.concatenate(a) for a in zip(*outer)]
        order = np.lexsort((inner[2], inner[1]))
        return [a[order] for a in inner], outer

    def nodes(self):
        x, y, z = [self.lower[d] + np.arange(self.n[d] + 1)*self.h[d]
                   for d in range(3)]
        z, y, x = np.meshgrid(z, y, x, indexing="ij")
        return np.stack([x.ravel(), y.ravel(), z.ravel()], axis=1)

    def write(self, case, names, types, patchOf):
        """constant/polyMesh. patchOf(centres, normals) gives the number of the
        patch of each boundary face; types: name -> entries"""
        (f, own, next), (g, gOwn, d, side) = self.faces()
        nodes = self.nodes()
        centres = nodes[g].mean(axis=1)
        normals = np.zeros((len(g), 3))
        normals[np.arange(len(g)), d] = side
        patch = patchOf(centres, normals)
        order = np.argsort(patch, kind="stable")
        faces = np.concatenate([f, g[order]])
        owner = np.concatenate([own, gOwn[order]])
        counts = np.bincount(patch, minlength=len(names))

        used = np.unique(faces)
        label = np.full(len(nodes), -1)
        label[used] = np.arange(len(used))
        directory = Path(case)/"constant"/"polyMesh"
        directory.mkdir(parents=True, exist_ok=True)

        def save(name, kind, rows, note=None):
            text = foamDict.header(name, kind)
            if note:
                text = text.replace("    object", f"    note        \"{note}\""
                                    ";\n    object")
            (directory/name).write_text(
                text + f"\n{len(rows)}\n(\n" + "\n".join(rows) + "\n)\n")

        save("points", "vectorField",
             ["(%.12g %.12g %.12g)" % tuple(p) for p in nodes[used]])
        save("faces", "faceList",
             ["4(%d %d %d %d)" % tuple(r) for r in label[faces]])
        note = (f"nPoints:{len(used)} nCells:{self.active.sum()} "
                f"nFaces:{len(faces)} nInternalFaces:{len(f)}")
        save("owner", "labelList", list(map(str, owner)), note)
        save("neighbour", "labelList", list(map(str, next)), note)
        start, rows = len(f), []
        for name, count in zip(names, counts):
            entries = {**types[name], "nFaces": int(count),
                       "startFace": int(start)}
            rows.append(f"    {name}\n    {{\n" + "".join(
                f"        {k:<15} {foamDict.text(v)};\n"
                for k, v in entries.items()) + "    }")
            start += count
        save("boundary", "polyBoundaryMesh", rows)
        return dict(zip(names, map(int, counts)))
