"""Lists and internal fields of OpenFOAM files, ascii or binary, compressed
or not."""

import gzip
import re
import subprocess
from pathlib import Path

import numpy as np

COMPONENTS = {
    "label": 1,
    "scalar": 1,
    "vector": 3,
    "symmTensor": 6,
    "tensor": 9,
}

_HEADER = re.compile(rb"FoamFile\s*\{(.*?)\}", re.DOTALL)
_COMMENT = re.compile(rb"\s*(//[^\n]*|/\*.*?\*/)?\s*", re.DOTALL)


class FoamFileError(Exception):
    """A file that is no OpenFOAM file, or not of the kind asked for."""


def stored(path):
    """Where a file lies: under its name or, with writeCompression on, with
    .gz behind it; None if there is neither"""
    path = Path(path)
    return next((p for p in [path, path.with_name(path.name + ".gz")]
                 if p.is_file()), None)


def read(path):
    """The bytes of a file, compressed or not"""
    data = (stored(path) or Path(path)).read_bytes()
    return gzip.decompress(data) if data.startswith(b"\x1f\x8b") else data


def isBinary(path):
    """Is what a file holds written in binary?"""
    return _open(path)[1]["format"] == "binary"


def readList(path):
    """The array of a file that is one list: a lagrangian field, a labelList,
    mesh points. Shape (n,) for labels and scalars, (n, components) else."""
    data, header, pos = _open(path)
    kind = re.fullmatch(
        r"(label|scalar|vector|symmTensor|tensor)(Field|List|IOList)",
        header["class"])
    if not kind:
        raise FoamFileError(f"{path}: class {header['class']} is no list")
    values, _ = _parseList(path, data, pos, kind[1], header)
    return values


def readInternalField(path, size):
    """The internal field of a vol<Type>Field on a mesh of `size` cells."""
    data, header, pos = _open(path)
    kind = re.fullmatch(
        r"vol(Scalar|Vector|SymmTensor|Tensor)Field", header["class"])
    if not kind:
        raise FoamFileError(f"{path}: class {header['class']} is no volField")
    kind = kind[1][0].lower() + kind[1][1:]

    entry = re.compile(
        rb"internalField\s+(?:(uniform)\s+([^;]*);|nonuniform\s+List<\w+>)"
    ).search(data, pos)
    if not entry:
        raise FoamFileError(f"{path}: no internalField")
    if entry[1]:
        text = entry[2]
        if b"$" in text or b"#" in text:
            text = _expanded(path, "internalField").removeprefix(b"uniform")
        try:
            value = _shape(_numbers(text), kind)
        except ValueError as error:
            raise FoamFileError(
                f"{path}: entry internalField has the value uniform "
                f"{text.decode(errors='replace').strip()}.\n    Allowed: "
                f"uniform and a {kind}") from error
        return np.repeat(value, size, axis=0)

    values, _ = _parseList(path, data, entry.end(), kind, header)
    if len(values) != size:
        raise FoamFileError(
            f"{path}: {len(values)} values on a mesh of {size} cells")
    return values


def readFaces(path):
    """Point labels of the faces, one row each. All need the same number of
    points, as they have on a mesh of hexahedra."""
    data, header, pos = _open(path)
    if header["class"] == "faceCompactList" and header["format"] == "binary":
        starts, pos = _parseList(path, data, pos, "label", header)
        labels, _ = _parseList(path, data, pos, "label", header)
        corners = np.diff(starts)
        if len(corners) and np.ptp(corners):
            raise FoamFileError(f"{path}: faces differ in number of points")
        return labels.reshape(len(corners), -1)

    body = data[pos:]
    faces = re.findall(rb"4\(([-\d\s]+)\)", body)
    size = int(re.match(rb"\s*(\d+)", body)[1])
    if len(faces) != size:
        raise FoamFileError(f"{path}: faces that are no quadrilaterals")
    return np.array([face.split() for face in faces], dtype=int)


def readFaceLists(path):
    """Point labels of faces of any number of points: starts, labels"""
    data, header, pos = _open(path)
    if header["class"] == "faceCompactList":
        starts, pos = _parseList(path, data, pos, "label", header)
        labels, _ = _parseList(path, data, pos, "label", header)
        return starts, labels
    body = data[pos:]
    sizes, labels = [], []
    for size, face in re.findall(rb"(\d+)\(([-\d\s]+)\)", body):
        sizes.append(int(size))
        labels.append(face)
    labels = np.array(b" ".join(labels).split(), dtype=int)
    starts = np.concatenate([[0], np.cumsum(sizes)])
    if starts[-1] != len(labels):
        raise FoamFileError(f"{path}: faces that cannot be read")
    return starts, labels


def _open(path):
    """Content, header entries, and the position behind the header"""
    data = read(path)
    found = _HEADER.search(data[:4096])
    if not found:
        raise FoamFileError(f"{path}: no FoamFile header")
    header = {name: quoted or word for name, quoted, word in re.findall(
        r'(\w+)\s+(?:"([^"]*)"|([^";]*));', found[1].decode("ascii"))}
    header.setdefault("format", "ascii")
    header["arch"] = dict(
        re.findall(r"(label|scalar)=(\d+)", header.get("arch", "")))
    return data, header, _skip(data, found.end())


def _expanded(path, entry):
    """The value of an entry whose macros foamDictionary has replaced"""
    done = subprocess.run(
        ["foamDictionary", str(path), "-entry", entry, "-value"],
        capture_output=True)
    if done.returncode:
        raise FoamFileError(
            f"{path}: entry {entry}: foamDictionary cannot read it:\n"
            + (done.stderr or done.stdout).decode(errors="replace").strip())
    return done.stdout.strip()


def _skip(data, pos):
    """The position behind white space and comments"""
    while True:
        end = _COMMENT.match(data, pos).end()
        if end == pos:
            return pos
        pos = end


def _parseList(path, data, pos, kind, header):
    """The list that starts at pos, and the position behind it"""
    pos = _skip(data, pos)
    size = re.compile(rb"(\d+)\s*").match(data, pos)
    if not size:
        raise FoamFileError(f"{path}: no list size at byte {pos}")
    n, pos = int(size[1]), size.end()
    opening = data[pos:pos + 1]

    if opening == b"{":
        end = data.index(b"}", pos)
        value = _shape(_numbers(data[pos + 1:end]), kind)
        return np.repeat(value, n, axis=0), end + 1

    if n == 0:
        end = pos + 2 if data[pos:pos + 2] == b"()" else pos
        return _shape(np.empty(0), kind), end

    if opening != b"(":
        raise FoamFileError(f"{path}: no list at byte {pos}")

    if header["format"] == "binary":
        dtype = _dtype(kind, header)
        count = n*COMPONENTS[kind]
        end = pos + 1 + count*dtype.itemsize
        if data[end:end + 1] != b")":
            raise FoamFileError(f"{path}: list of {n} is cut short")
        values = np.frombuffer(data, dtype, count, pos + 1)
        return _shape(values.astype(dtype.newbyteorder("=")), kind), end + 1

    end = _closing(path, data, pos)
    values = _shape(_numbers(data[pos + 1:end]), kind)
    if len(values) != n:
        raise FoamFileError(f"{path}: {len(values)} of {n} values")
    return values, end + 1


def _closing(path, data, pos):
    """The position of the bracket that closes the one at pos"""
    depth = 0
    for bracket in re.compile(rb"[()]").finditer(data, pos):
        depth += 1 if bracket[0] == b"(" else -1
        if depth == 0:
            return bracket.start()
    raise FoamFileError(f"{path}: list is cut short")


def _dtype(kind, header):
    bits = header["arch"].get(
        "label" if kind == "label" else "scalar",
        "32" if kind == "label" else "64")
    return np.dtype(("<i" if kind == "label" else "<f") + str(int(bits)//8))


def _numbers(text):
    """All numbers of an ascii text, brackets ignored"""
    words = text.replace(b"(", b" ").replace(b")", b" ").split()
    return np.array(words, dtype=float)


def _shape(values, kind):
    if kind == "label":
        values = values.astype(int)
    if COMPONENTS[kind] == 1:
        return values
    return values.reshape(-1, COMPONENTS[kind])
