"""Makes cases of mpmFoam from parameters, and runs them.

    setup = Setup(cells=(20, 15), h=0.02, regions={"column": box((0, 0), (0.1, 0.2))})
    case = setup.write(tmp_path/"case")
    case.prepare()              # blockMesh, setMaterialPoints
    case.solve()
    points = case.points("0.1")

All of a case is a dictionary in Setup: change it before write().
"""

import copy
import itertools
import os
import re
import shutil
import signal
import subprocess
import time
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from mpmfoam.case import Case
from mpmfoam.postProcessing import readDat
from mpmfoam.runLog import readLog

AXES = "xyz"
SIDES = [a + end for a in AXES for end in ("min", "max")]
G = 9.81
RHO = 1000
RHO_S = 2650

# No single application of these tests takes longer, in s
TIMEOUT = 600


class CaseError(AssertionError):
    """An application that should have run and did not"""


# --- dictionaries as OpenFOAM writes them ---------------------------------

def foamText(value, indent=0):
    """A dictionary, list, number or word in OpenFOAM's syntax"""
    if isinstance(value, dict):
        pad = " "*4*indent
        text = ""
        for key, entry in value.items():
            if isinstance(entry, dict):
                text += (f"{pad}{key}\n{pad}{{\n"
                         f"{foamText(entry, indent + 1)}{pad}}}\n")
            else:
                text += f"{pad}{key} {foamText(entry)};\n"
        return text
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, (list, tuple, np.ndarray)):
        return "(" + " ".join(foamText(v) for v in value) + ")"
    if isinstance(value, (float, np.floating)):
        return f"{value:.16g}"
    return str(value)


def header(name, kind="dictionary"):
    return ("FoamFile\n{\n    version 2.0;\n    format ascii;\n"
            f"    class {kind};\n    object {name};\n}}\n\n")


def merge(base, changes):
    """Entries of nested dictionaries; None removes one"""
    for key, value in changes.items():
        if value is None:
            base.pop(key, None)
        elif isinstance(value, dict) and isinstance(base.get(key), dict):
            merge(base[key], value)
        else:
            base[key] = copy.deepcopy(value)


# --- regions --------------------------------------------------------------

def box(lower, upper, **entries):
    """A box; without a third component it spans all of z"""
    lower, upper = tuple(lower), tuple(upper)
    if len(lower) == 2:
        lower, upper = lower + (-10,), upper + (10,)
    return {"type": "box", "min": lower, "max": upper, **entries}


def hydrostatic(lower, upper, **entries):
    """A box of water at rest under its own surface"""
    level = upper[1] if len(upper) == 2 else upper[2]
    return box(lower, upper, pressure="hydrostatic", level=level, **entries)


# --- setups ---------------------------------------------------------------

@dataclass
class Setup:
    """cells    per direction; two of them make a case in x and y
    h        spacing, one number or one per direction
    origin   lower corner of the mesh
    solid    boxes of cells that are left out: (first, behind the last)
    sides    side (xmin, ...) -> (type of patch, condition of U.water); a side
             that is not named belongs to the patch walls
    wall     condition of U.water on the patch walls
    points   per cell and direction
    energy   with the function object materialPointEnergy, each 10 steps
    soilRegions  with a cloud soil; without regions of water it is alone
    bodies   as in materialPointProperties
    surfaces  file in constant/triSurface -> its text"""
    cells: tuple
    h: object
    regions: dict
    origin: tuple = (0, 0, 0)
    solid: list = field(default_factory=list)
    sides: dict = field(default_factory=dict)
    wall: object = "slip"
    points: int = 3
    g: tuple = None
    water: dict = field(default_factory=dict)
    fluid: dict = field(default_factory=dict)
    mpm: dict = field(default_factory=dict)
    control: dict = field(default_factory=dict)
    placement: dict = field(default_factory=dict)
    functions: dict = field(default_factory=dict)
    energy: bool = True
    soilRegions: dict = field(default_factory=dict)
    soil: dict = field(default_factory=dict)
    soilWall: object = "noSlip"
    interaction: dict = field(default_factory=lambda: {
        "drag": "DarcyForchheimer"})
    bodies: dict = field(default_factory=dict)
    surfaces: dict = field(default_factory=dict)

    # Name of the cloud of water
    liquid = "water"

    def __post_init__(self):
        # Several setups may be given the same one, which steps() changes
        self.control = dict(self.control)
        if self.g is None:
            self.g = (0, -G, 0) if self.dim == 2 else (0, 0, -G)

    @property
    def clouds(self):
        if not self.soilRegions:
            return ["water"]
        return ["water", "soil"] if self.regions else ["soil"]

    @property
    def dim(self):
        return len(self.cells)

    @property
    def spacing(self):
        h = self.h if isinstance(self.h, (tuple, list)) else [self.h]*3
        return tuple(h)

    @property
    def cells3(self):
        return tuple(self.cells) + (1,)*(3 - self.dim)

    @property
    def bounds(self):
        """Lower and upper corner of the mesh"""
        lower = np.array(self.origin, dtype=float)
        return lower, lower + np.array(self.cells3)*np.array(self.spacing)

    def cyclic(self, *axes):
        """The two sides of each axis joined"""
        for a in axes:
            for end in ["min", "max"]:
                self.sides[a + end] = ("cyclic", "cyclic")
        return self

    def steps(self, n):
        """Ends after n steps, and writes then"""
        self.control.update(stopAt="nextWrite", endTime=1e6,
                            writeControl="timeStep", writeInterval=n)
        return self

    def endless(self, write):
        """Goes on until it is stopped, with a time each `write` steps"""
        self.control.update(stopAt="endTime", endTime=1e6,
                            writeControl="timeStep", writeInterval=write)
        return self

    def until(self, endTime, write=None):
        """Ends at a time, with a time written each `write` s"""
        self.control.update(endTime=endTime, writeInterval=write or endTime)
        return self

    # The files, as dictionaries

    def properties(self):
        bodies = {"bodies": self.bodies} if self.bodies else {}
        return {**self.cloudProperties(), **bodies}

    def cloudProperties(self):
        fluid = {"rho0": RHO, "mu": 1e-3, "soundSpeed": "auto", "gamma": 7}
        merge(fluid, self.fluid)
        water = {"constitutiveModel": "weaklyCompressibleNewtonian",
                 "weaklyCompressibleNewtonianCoeffs": fluid,
                 "transfer": "APIC"}
        merge(water, self.water)
        if self.clouds == ["water"]:
            return {"clouds": "(water)", "water": water}

        soil = {"constitutiveModel": "DruckerPrager",
                "DruckerPragerCoeffs": {
                    "rhoS": RHO_S, "d": 0.85e-3, "e0": 0.695, "E0": 216,
                    "n": 0.5, "nu": 0.2, "phi": 35, "psi": 0}}
        if self.soil.get("constitutiveModel", "DruckerPrager") in (
                k[:-len("Coeffs")] for k in self.soil if k.endswith("Coeffs")):
            # Those of another model
            del soil["DruckerPragerCoeffs"]
        merge(soil, self.soil)
        if self.clouds == ["soil"]:
            return {"clouds": "(soil)", "soil": soil}
        return {"clouds": "(water soil)", "water": water, "soil": soil,
                "interaction": self.interaction}

    def controlDict(self):
        control = {
            "application": "mpmFoam", "startFrom": "latestTime",
            "startTime": 0, "stopAt": "endTime", "endTime": 0.1,
            "deltaT": 1e-4, "adjustTimeStep": True, "maxDeltaT": 0.01,
            "writeControl": "adjustableRunTime", "writeInterval": 0.1,
            "purgeWrite": 0, "writeFormat": "binary", "writePrecision": 12,
            "writeCompression": "off", "timeFormat": "general",
            "timePrecision": 6, "runTimeModifiable": True}
        merge(control, self.control)
        functions = dict(self.functions)
        if self.energy:
            functions["energy"] = {
                "type": "materialPointEnergy", "cloud": "water",
                "libs": '("libmpmFunctionObjects.so")',
                "writeControl": "timeStep", "writeInterval": 10}
        if functions:
            control["functions"] = functions
        return control

    def setMaterialPointsDict(self):
        water = {"pointsPerDirection": self.points, "placement": "regular"}
        merge(water, self.placement)
        regions = {"water": self.regions, "soil": self.soilRegions}
        return {cloud: {**water, "regions": regions[cloud]}
                for cloud in self.clouds}

    def fvSolution(self):
        mpm = {"shapeFunction": "quadraticBSpline", "maxCo": 0.5}
        merge(mpm, self.mpm)
        return {"MPM": mpm}

    def velocity(self, wall):
        """0/U.<cloud>"""
        def condition(text):
            return text if isinstance(text, dict) else {"type": text}

        patches = {"walls": condition(wall)}
        patches.update({side: condition(kind[1])
                        for side, kind in self.sides.items()})
        if self.dim == 2:
            patches["frontAndBack"] = {"type": "empty"}
        return {"dimensions": "[0 1 -1 0 0 0 0]",
                "internalField": "uniform (0 0 0)", "boundaryField": patches}

    def gravity(self):
        return {"dimensions": "[0 1 -2 0 0 0 0]", "value": self.g}

    def blockMeshDict(self):
        """Blocks between all planes at which a solid begins or ends"""
        cuts = []
        for d in range(3):
            planes = {0, self.cells3[d]}
            for lower, upper in self.solid:
                if d < self.dim:
                    planes |= {lower[d], upper[d]}
            cuts.append(sorted(planes))
        shape = tuple(len(c) for c in cuts)

        def vertex(i, j, k):
            return i + shape[0]*(j + shape[1]*k)

        def isSolid(block):
            return any(all(lower[d] <= cuts[d][block[d]] < upper[d]
                           for d in range(self.dim))
                       for lower, upper in self.solid)

        # Corners of a block's side, seen from outside
        corners = {
            "xmin": [(0, 0, 0), (0, 0, 1), (0, 1, 1), (0, 1, 0)],
            "xmax": [(1, 0, 0), (1, 1, 0), (1, 1, 1), (1, 0, 1)],
            "ymin": [(0, 0, 0), (1, 0, 0), (1, 0, 1), (0, 0, 1)],
            "ymax": [(0, 1, 0), (0, 1, 1), (1, 1, 1), (1, 1, 0)],
            "zmin": [(0, 0, 0), (0, 1, 0), (1, 1, 0), (1, 0, 0)],
            "zmax": [(0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]}

        blocks = [b for b in itertools.product(
            *(range(n - 1) for n in shape)) if not isSolid(b)]
        hexes, faces = [], {side: [] for side in SIDES}
        for b in blocks:
            at = [vertex(*(np.array(b) + c)) for c in [
                (0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0),
                (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]]
            n = [cuts[d][b[d] + 1] - cuts[d][b[d]] for d in range(3)]
            hexes.append(f"hex {foamText(at)} {foamText(n)} "
                         "simpleGrading (1 1 1)")
            for side in SIDES:
                d, end = AXES.index(side[0]), side[1:] == "max"
                if b[d] == (shape[d] - 2 if end else 0):
                    faces[side].append(
                        [vertex(*(np.array(b) + c)) for c in corners[side]])

        patches = {}
        for side, (kind, _) in self.sides.items():
            patches[side] = {"type": kind, "faces": faces[side]}
            if kind == "cyclic":
                patches[side]["neighbourPatch"] = side[0] + (
                    "min" if side[1:] == "max" else "max")
        if self.dim == 2:
            patches["frontAndBack"] = {
                "type": "empty", "faces": faces["zmin"] + faces["zmax"]}

        lower, h = np.array(self.origin), np.array(self.spacing)
        points = [tuple(float(v) for v in lower + h*(x, y, z))
                  for z in cuts[2] for y in cuts[1] for x in cuts[0]]
        boundary = "(\n" + foamText(patches, 1) + ")"
        return {"scale": 1, "vertices": points,
                "blocks": "(\n    " + "\n    ".join(hexes) + "\n)",
                "defaultPatch": {"name": "walls", "type": "wall"},
                "boundary": boundary}

    def files(self):
        """Text of all files of the case by their place in it"""
        files = {
            **{f"0/U.{cloud}": (self.velocity(
                self.wall if cloud == self.liquid else self.soilWall),
                "volVectorField") for cloud in self.clouds},
            "constant/g": (self.gravity(), "uniformDimensionedVectorField"),
            "constant/materialPointProperties":
                (self.properties(), "dictionary"),
            "system/blockMeshDict": (self.blockMeshDict(), "dictionary"),
            "system/controlDict": (self.controlDict(), "dictionary"),
            "system/fvSchemes": (
                {f"{kind}Schemes": {} for kind in [
                    "ddt", "grad", "div", "laplacian", "interpolation",
                    "snGrad"]}, "dictionary"),
            "system/fvSolution": (self.fvSolution(), "dictionary"),
            "system/setMaterialPointsDict":
                (self.setMaterialPointsDict(), "dictionary")}
        return {name: header(name.split("/")[-1], kind) + foamText(content)
                for name, (content, kind) in files.items()}

    def write(self, path):
        """The case directory; returns the case to run"""
        path = Path(path)
        for name, text in self.files().items():
            (path/name).parent.mkdir(parents=True, exist_ok=True)
            (path/name).write_text(text)
        for name, text in self.surfaces.items():
            file = path/"constant"/"triSurface"/name
            file.parent.mkdir(parents=True, exist_ok=True)
            file.write_text(text)
        return self.caseAt(path)

    def caseAt(self, path):
        """One that was written before"""
        return RunningCase(path, self)


# --- cases on disk --------------------------------------------------------

@dataclass
class Result:
    status: int
    text: str


@dataclass
class Points:
    """Points of one time in the order of their id"""
    id: np.ndarray
    x: np.ndarray
    U: np.ndarray
    J: np.ndarray
    mass: np.ndarray
    p: np.ndarray

    @property
    def totalMass(self):
        return self.mass.sum()

    @property
    def momentum(self):
        return (self.mass[:, None]*self.U).sum(axis=0)

    @property
    def centre(self):
        return (self.mass[:, None]*self.x).sum(axis=0)/self.totalMass

    @property
    def kinetic(self):
        return 0.5*(self.mass*(self.U**2).sum(axis=1)).sum()

    def potential(self, g):
        return -(self.mass*(self.x @ np.array(g, dtype=float))).sum()


def _command(command, ranks):
    if ranks == 1:
        return command
    return ["mpirun", "-np", str(ranks), *command, "-parallel"]


def _killAll(process):
    """A process and the ranks it started, which share its session"""
    for stat in Path("/proc").glob("[0-9]*/stat"):
        try:
            session = int(stat.read_text().rsplit(")", 1)[1].split()[3])
            if session == process.pid:
                os.kill(int(stat.parent.name), signal.SIGKILL)
        except (OSError, ValueError):
            # Ended meanwhile
            continue
    process.wait()


class RunningCase:
    """A case directory and the applications that run in it"""

    def __init__(self, path, setup):
        self.path = Path(path)
        self.setup = setup

    def run(self, application, *arguments, ranks=1, check=True):
        """Runs to its end; output in log.<application>, which the next run
        of the same application replaces"""
        command = _command([application, *arguments], ranks)
        log = self.path/f"log.{application}"
        with open(log, "w") as out:
            process = subprocess.Popen(
                command, cwd=self.path, stdout=out, stderr=subprocess.STDOUT,
                stdin=subprocess.DEVNULL, start_new_session=True,
                env={**os.environ, "PWD": str(self.path)})
            try:
                process.wait(TIMEOUT)
            except BaseException:
                _killAll(process)
                raise
        result = Result(process.returncode, log.read_text(errors="replace"))
        if check and result.status != 0:
            raise CaseError(
                f"{' '.join(command)} in {self.path} ended with "
                f"{result.status}:\n" + result.text[-3000:])
        return result

    def clone(self, path):
        """A copy of the case and of its setup"""
        shutil.copytree(self.path, path)
        return RunningCase(path, copy.deepcopy(self.setup))

    def start(self, application="mpmFoam", ranks=1):
        """Starts an application and returns its process"""
        command = _command([application], ranks)
        with open(self.path/f"log.{application}", "w") as out:
            return subprocess.Popen(
                command, cwd=self.path, stdout=out,
                stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                start_new_session=True,
                env={**os.environ, "PWD": str(self.path)})

    def prepare(self):
        self.run("blockMesh")
        # test_forecast has the forecasts
        self.run("setMaterialPoints", "-noForecast")
        return self

    def cellZone(self, name, lower, upper):
        """A zone of the cells between two corners in x and y; after
        blockMesh"""
        corners = box(lower, upper)
        (self.path/"system"/"topoSetDict").write_text(
            header("topoSetDict") + f"""
actions
(
    {{ name {name}; type cellSet; action new; source boxToCell;
      box {foamText(corners["min"])} {foamText(corners["max"])}; }}
    {{ name {name}; type cellZoneSet; action new; source setToCellZone;
      set {name}; }}
);
""")
        self.run("topoSet")
        return self

    def solve(self, ranks=1, check=True):
        result = self.run("mpmFoam", ranks=ranks, check=check)
        if check and not self.log.finished:
            raise CaseError(f"{self.path}: the log of mpmFoam has no End")
        return result

    def decompose(self, ranks, n=None, cellRank=None, times=None):
        """By planes into n parts per direction, or by the rank of each cell;
        the time of the start, or the times given"""
        entries = {"numberOfSubdomains": ranks}
        if cellRank is not None:
            entries.update(method="manual", manualCoeffs={
                "dataFile": '"cellRank"'})
            (self.path/"constant"/"cellRank").write_text(
                header("cellRank", "labelList") + f"{len(cellRank)}\n(\n"
                + "\n".join(str(int(r)) for r in cellRank) + "\n)\n")
        else:
            entries.update(method="simple", simpleCoeffs={
                "n": n or (ranks, 1, 1), "delta": 0.001})
        (self.path/"system"/"decomposeParDict").write_text(
            header("decomposeParDict") + foamText(entries))
        self.run("decomposePar", *(["-time", times] if times else []))
        return self

    def change(self, **sections):
        """Other parameters in the dictionaries of a case that exists"""
        for name, entries in sections.items():
            target = getattr(self.setup, name)
            merge(target, entries)
        self.rewrite()

    def rewrite(self):
        """The dictionaries again; 0 and the mesh stay"""
        keep = {path: path.read_bytes()
                for path in (self.path/"0").glob("U.*")}
        self.setup.write(self.path)
        for path, content in keep.items():
            path.write_bytes(content)

    def waitForEnd(self, process, limit=30):
        """Exit status; None if it had to be killed"""
        try:
            return process.wait(limit)
        except subprocess.TimeoutExpired:
            _killAll(process)
            return None

    def waitForTime(self, process, time_, limit=60):
        """Until the log of mpmFoam has come to a time"""
        end = time.monotonic() + limit
        while time.monotonic() < end:
            log = self.path/"log.mpmFoam"
            text = log.read_text(errors="replace") if log.exists() else ""
            times = re.findall(r"^Time = (\S+)", text, re.MULTILINE)
            if times and float(times[-1]) >= time_:
                return
            if process.poll() is not None:
                raise CaseError(f"{self.path}: mpmFoam ended early:\n"
                                + text[-2000:])
            time.sleep(0.02)
        _killAll(process)
        raise CaseError(f"{self.path}: no time {time_} in {limit} s")

    # What is on disk

    @property
    def case(self):
        return Case(self.path)

    @property
    def log(self):
        return readLog(self.path/"log.mpmFoam")

    @property
    def times(self):
        return self.case.times()

    def points(self, time_=None):
        """Points at a time (default: the last one)"""
        case = self.case
        name = case.times()[-1] if time_ is None else str(time_)
        values = {f: case.cloudField(name, "water", f)
                  for f in ["id", "x", "U", "J", "mass", "p"]}
        order = np.argsort(values["id"], kind="stable")
        return Points(**{f: v[order] for f, v in values.items()})

    def state(self, time_=None, cloud="water"):
        """uniform/materialPoints of a cloud: numbers by keyword"""
        case = self.case
        name = case.times()[-1] if time_ is None else str(time_)
        return case.cloudState(name, cloud)

    def mechanicalEnergy(self, time_=None):
        """Kinetic and potential energy; this from the mesh's lower corner"""
        points = self.points(time_)
        return points.kinetic, points.potential(self.setup.g) - self.floor

    @property
    def floor(self):
        """Potential energy of all points in the mesh's lower corner"""
        return -self.points("0").totalMass*np.dot(
            self.setup.g, self.setup.bounds[0])

    def energies(self):
        """postProcessing/energy as columns by name"""
        path = next((self.path/"postProcessing"/"energy").rglob("energy.dat"))
        names = [line for line in path.read_text().splitlines()
                 if line.startswith("#")][-1].strip("# ").split()
        rows = readDat(self.path, "energy", "energy.dat")
        return dict(zip([n.lower() for n in names], rows.T))

    def timesByStep(self):
        """Name of the time directory by number of the step. Names can differ
        in their last digit between runs that were started differently."""
        names = {0: "0"} if "0" in self.times else {}
        for name in self.times:
            for root in [self.path, self.path/"processor0"]:
                path = root/name/"uniform"/"time"
                if path.is_file():
                    index = re.search(r"index\s+(\d+);", path.read_text())
                    # A killed run may leave its last one cut off
                    if index:
                        names[int(index[1])] = name
        return names

    def timeValue(self, name):
        """The exact time of a time directory"""
        return float(re.search(
            r"value\s+(\S+);",
            (self.path/name/"uniform"/"time").read_text())[1])

    def outside(self, points):
        """How many points are in no cell of the mesh"""
        lower, upper = self.setup.bounds
        dim = self.setup.dim
        x = points.x[:, :dim]
        out = np.any((x < lower[:dim]) | (x > upper[:dim]), axis=1)
        for first, last in self.setup.solid:
            h = np.array(self.setup.spacing)[:dim]
            a = lower[:dim] + h*first
            b = lower[:dim] + h*last
            out |= np.all((x > a) & (x < b), axis=1)
        return int(np.sum(out | ~np.all(np.isfinite(x), axis=1)))


def damBreak(dim=2, h=0.02, width=0.2, height=0.2, **entries):
    """A small dam break: a column of width x height in a box of 0.5 x 0.4
    (3D: 0.2 wide)"""
    size = (0.5, 0.4) if dim == 2 else (0.5, 0.2, 0.4)
    cells = tuple(round(length/h) for length in size)
    top = (width, height) if dim == 2 else (width, 0.2, height)
    return Setup(cells=cells, h=h,
                 regions={"column": hydrostatic((0,)*dim, top)}, **entries)
