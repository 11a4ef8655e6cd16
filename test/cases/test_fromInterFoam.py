"""interFoamToMpmFoam, mpmFoamToInterFoam, compareInterFoam: volume of water and
mesh right to rounding, the cases run, and what cannot be carried over is an
error or a note."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from mpmfoam import foamDict, foamFile, fromInterFoam, metrics, reference
from mpmfoam.case import Case
from mpmfoam.mesh import Mesh

ROOT = Path(__file__).resolve().parents[2]
TUTORIALS = ROOT/"tutorials"


def call(name, *arguments, cwd=None):
    command = ROOT/"bin"/name
    return subprocess.run(
        [str(command) if command.is_file() else name, *map(str, arguments)],
        cwd=cwd, capture_output=True, text=True, timeout=300,
        env={**os.environ, "MPMFOAM_DIR": str(ROOT),
             "PYTHONPATH": str(ROOT/"etc"/"python"),
             **({"PWD": str(cwd)} if cwd else {})})


def openFoamTutorial(name):
    """A case of OpenFOAM's own, multiphase/interFoam/<name>"""
    for root in [os.environ.get("FOAM_TUTORIALS", "/nowhere"),
                 "/usr/share/doc/openfoam-examples/examples"]:
        path = Path(root)/"multiphase"/"interFoam"/name
        if path.is_dir():
            return path
    pytest.skip("no tutorials of OpenFOAM here (openfoam-examples)")


def setEntry(path, entry, value):
    done = call("foamDictionary", path, "-entry", entry, "-set", value)
    assert done.returncode == 0, done.stdout + done.stderr


def testBoxes(figures):
    """Regions of points: any set of places, each once"""
    random = np.random.default_rng(1)
    for shape in [(1, 7, 9), (5, 6, 7)]:
        mask = random.random(shape) > 0.4
        count = np.zeros(shape, dtype=int)
        for (i0, j0, k0), (i1, j1, k1) in fromInterFoam.boxes(mask):
            count[k0:k1, j0:j1, i0:i1] += 1
        figures.holds(f"{shape}", (count == mask).all())
    figures.equal("a full box is one", len(fromInterFoam.boxes(
        np.ones((3, 4, 5), dtype=bool))), 1)


# --- a case of interFoam: tank of 0.4 x 0.2 m with a block on its floor ------

def interFoamCase(path, water="(0 0 -1) (0.12 0.1 1)"):
    """Cells of 0.01 m, the block 0.04 x 0.03 m at x = 0.24"""
    shutil.copytree(ROOT/"etc"/"caseDicts"/"interFoam", path)
    (path/"0.orig").mkdir()

    def write(place, text, kind="dictionary"):
        (path/place).write_text(foamDict.header(Path(place).name, kind)
                                + text)

    x, y = [0, 0.24, 0.28, 0.4], [0, 0.03, 0.2]
    vertices = " ".join(f"({a} {b} {c})" for c in (0, 0.01) for b in y
                        for a in x)
    block = lambda i, j: (f"hex ({i+4*j} {i+1+4*j} {i+5+4*j} {i+4+4*j} "
                          f"{i+12+4*j} {i+13+4*j} {i+17+4*j} {i+16+4*j}) "
                          f"({round(100*(x[i+1]-x[i]))} "
                          f"{round(100*(y[j+1]-y[j]))} 1) "
                          "simpleGrading (1 1 1)")
    write("system/blockMeshDict", f"""
scale 1;
vertices ( {vertices} );
blocks ( {block(0, 0)} {block(2, 0)} {block(0, 1)} {block(1, 1)}
         {block(2, 1)} );
boundary
(
    top {{ type patch; faces ((8 20 21 9) (9 21 22 10) (10 22 23 11)); }}
    frontAndBack {{ type empty; faces (
        (0 4 5 1) (2 6 7 3) (4 8 9 5) (5 9 10 6) (6 10 11 7)
        (12 13 17 16) (14 15 19 18) (16 17 21 20) (17 18 22 21)
        (18 19 23 22)); }}
);
defaultPatch {{ name walls; type wall; }}
""")
    write("system/controlDict", """
application interFoam; startFrom startTime; startTime 0; stopAt endTime;
endTime 0.1; deltaT 1e-4; adjustTimeStep yes; maxCo 0.5; maxAlphaCo 0.5;
maxDeltaT 1; writeControl adjustableRunTime; writeInterval 0.02;
writeFormat ascii; writePrecision 8; timePrecision 6;
""")
    write("system/setFieldsDict", f"""
defaultFieldValues ( volScalarFieldValue alpha.water 0 );
regions ( boxToCell {{ box {water};
    fieldValues ( volScalarFieldValue alpha.water 1 ); }} );
""")
    write("constant/g", "dimensions [0 1 -2 0 0 0 0]; value (0 -9.81 0);",
          "uniformDimensionedVectorField")
    fields = {
        "U": ("[0 1 -1 0 0 0 0]", "(0 0 0)", "noSlip;",
              "pressureInletOutletVelocity; value uniform (0 0 0);"),
        "p_rgh": ("[1 -1 -2 0 0 0 0]", "0",
                  "fixedFluxPressure; value uniform 0;",
                  "totalPressure; p0 uniform 0;"),
        "alpha.water": ("[0 0 0 0 0 0 0]", "0", "zeroGradient;",
                        "inletOutlet; inletValue uniform 0; "
                        "value uniform 0;")}
    for name, (dims, value, wall, top) in fields.items():
        write(f"0.orig/{name}", f"""
dimensions {dims}; internalField uniform {value};
boundaryField
{{
    walls {{ type {wall} }}
    top {{ type {top} }}
    frontAndBack {{ type empty; }}
}}
""", "volVectorField" if name == "U" else "volScalarField")
    return path


def mass(case):
    c = Case(case)
    return c.cloudField("0", "water", "mass").sum()


def runMpm(case, endTime=None):
    if endTime:
        setEntry(case/"system"/"controlDict", "endTime", endTime)
        setEntry(case/"system"/"controlDict", "writeInterval", endTime)
    done = call("./Allrun", cwd=case)
    assert done.returncode == 0, done.stdout + done.stderr + "".join(
        p.read_text()[-1500:] for p in case.glob("log.*"))
    return (case/"log.mpmFoam").read_text()


def testToMpmFoam(tmp_path, figures):
    """Lengths that the cells divide: all stays where it was"""
    source = interFoamCase(tmp_path/"tank")
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    figures.equal("exit status", done.returncode, 0)
    for text in ["noSlip becomes slip", "left behind: air", "spacing: 0.01 "]:
        figures.holds(f"says '{text}'", text in done.stdout)
    figures.holds("nothing moved", "moved:" not in done.stdout)
    mesh = Mesh(tmp_path/"new")
    figures.atMost("volume of the mesh, relative error", abs(
        mesh.volumes.sum()/((0.4*0.2 - 0.04*0.03)*0.01) - 1), 1e-12)
    sizes = {p.name: p.size for p in mesh.patches}
    figures.equal("faces", sizes, {"top": 40, "walls": 40 + 2*20 + 2*3,
                                   "frontAndBack": 2*788})
    log = runMpm(tmp_path/"new", "0.002")
    figures.holds("runs to its end", log.rstrip().endswith("End"))
    # Hydrostatic: denser by g H/(2 c^2), c = 10 sqrt(g H)
    points = Case(tmp_path/"new").cloudField("0", "water", "x")
    figures.equal("points", len(points), 12*10*16)
    figures.atMost("mass over rho times the volume, error", abs(
        mass(tmp_path/"new")/(1000*0.12*0.1*0.01) - 1.005), 2e-4)
    check = call("checkMesh", cwd=tmp_path/"new")
    figures.holds("checkMesh", "Mesh OK" in check.stdout)


def testMoved(tmp_path, figures):
    """Another spacing: what moves is named, by how much; the box stays"""
    source = interFoamCase(tmp_path/"tank")
    done = call("interFoamToMpmFoam", source, tmp_path/"new", "--spacing",
                0.0125)
    figures.equal("exit status", done.returncode, 0)
    moved = dict(re.findall(r"moved: (.*?) to \S+ m \((\S+) mm\)",
                            done.stdout))
    # 0.24 is 19.2 cells, 0.28 22.4, 0.03 2.4; 0.12 is 38.4 quarters of one
    for name, value in [("wall at x = 0.24", -2.5),
                        ("wall at x = 0.28", -5), ("wall at y = 0.03", -5),
                        ("edge of the water at x = 0.12", -1.25)]:
        figures.atMost(f"{name}: moved, error [mm]",
                       abs(float(moved.get(name, "nan")) - value), 1e-6)
    mesh = Mesh(tmp_path/"new")
    figures.atMost("corners of the tank", np.abs(np.array(
        mesh.bounds) - [[0, 0, 0], [0.4, 0.2, 0.01]]).max(), 1e-12)
    figures.atMost("volume of the mesh, relative error", abs(
        mesh.volumes.sum()/((0.4*0.2 - 3*2*0.0125**2)*0.01) - 1), 1e-12)
    figures.contains("log keeps it", re.search(
        r"0\.2375 m \(-2\.5 mm\)",
        (tmp_path/"new"/"conversion.log").read_text()), r"0\.2375")


def testTime(tmp_path, figures):
    """From alpha.water of a time, partly filled cells: volume within a row of
    points; velocity only with --rest"""
    source = interFoamCase(tmp_path/"tank")
    shutil.copytree(source/"0.orig", source/"0")
    assert call("blockMesh", cwd=source).returncode == 0
    mesh = Mesh(source)
    surface = 0.1 + 0.2*mesh.centres[:, 0]
    alpha = np.clip((surface - mesh.lower[:, 1])/0.01, 0, 1)
    shutil.copytree(source/"0", source/"0.5")
    text = (source/"0.5"/"alpha.water").read_text()
    (source/"0.5"/"alpha.water").write_text(text.replace(
        "uniform 0;\nb", f"nonuniform List<scalar> {len(alpha)} ("
        + " ".join(f"{a:.10g}" for a in alpha) + ");\nb"))
    done = call("interFoamToMpmFoam", source, tmp_path/"new", "--time", 0.5)
    figures.equal("exit status", done.returncode, 0)
    volume = re.search(r"water: (\S+) m3, interFoam starts with (\S+) ",
                       done.stdout)
    exact = (alpha*mesh.volumes).sum()
    figures.atMost("interFoam's volume, relative error",
                   abs(float(volume[2])/exact - 1), 1e-5)
    figures.atMost("volume, relative error",
                   abs(float(volume[1])/exact - 1), 0.01)
    done = call("setMaterialPoints", cwd=_started(tmp_path/"new"))
    figures.equal("points are set", done.returncode, 0)
    # A velocity that is not uniform
    U = (source/"0.5"/"U").read_text()
    (source/"0.5"/"U").write_text(U.replace(
        "uniform (0 0 0);\nb", f"nonuniform List<vector> {len(alpha)} ("
        + " ".join(f"({x:.6g} 0 0)" for x in mesh.centres[:, 0])
        + ");\nb"))
    done = call("interFoamToMpmFoam", source, tmp_path/"moving", "--time",
                0.5)
    figures.equal("velocity: exit status", done.returncode, 1)
    figures.contains("names it", re.search(
        r"0\.5/U: the velocity of the water is not uniform.*--rest",
        done.stderr, re.DOTALL), "--rest")
    done = call("interFoamToMpmFoam", source, tmp_path/"moving", "--time",
                0.5, "--rest")
    figures.equal("--rest: exit status", done.returncode, 0)
    figures.holds("--rest is noted", "from rest, as asked" in done.stdout)


def compressed(source):
    for key, value in [("writeFormat", "ascii"), ("writeCompression", "on")]:
        setEntry(source/"system"/"controlDict", key, value)
    return source


def testCompressed(tmp_path, figures):
    """Mesh and fields as blockMesh and setFields leave them with
    writeCompression, there and back"""
    source = compressed(interFoamCase(tmp_path/"tank"))
    shutil.copytree(source/"0.orig", source/"0")
    shutil.rmtree(source/"0.orig")
    for command in ["blockMesh", "setFields"]:
        assert call(command, cwd=source).returncode == 0
    figures.holds("the mesh is compressed", (
        source/"constant"/"polyMesh"/"points.gz").is_file())
    figures.holds("alpha is compressed", (
        source/"0"/"alpha.water.gz").is_file())
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    print(done.stdout + done.stderr)
    figures.equal("exit status", done.returncode, 0)
    new = compressed(_started(tmp_path/"new"))
    assert call("setMaterialPoints", cwd=new).returncode == 0
    c = Case(new)
    figures.holds("points are compressed", (
        new/"0"/"lagrangian"/"water"/"mass.gz").is_file())
    figures.equal("points", len(c.cloudField("0", "water", "x")), 12*10*16)
    figures.equal("points of the state", c.cloudState("0", "water")["nPoints"],
                  12*10*16)
    done = call("mpmFoamToInterFoam", new, tmp_path/"back")
    print(done.stdout + done.stderr)
    figures.equal("back: exit status", done.returncode, 0)


def testBinaryAndMacros(tmp_path, figures):
    """As setFields leaves it with writeFormat binary; a velocity by a macro;
    a patch that only the case's Allrun would make"""
    source = interFoamCase(tmp_path/"tank")
    setEntry(source/"system"/"controlDict", "writeFormat", "binary")
    shutil.copytree(source/"0.orig", source/"0")
    shutil.rmtree(source/"0.orig")
    for command in ["blockMesh", "setFields"]:
        assert call(command, cwd=source).returncode == 0
    figures.holds("alpha is binary", b"binary;" in (
        source/"0"/"alpha.water").read_bytes())
    U = (source/"0"/"U")
    text = U.read_text(errors="replace")
    text = text.replace("internalField uniform (0 0 0)",
                        "along 0.1;\ninternalField uniform ($along 0 0)")
    U.write_text(text.replace("boundaryField\n{", "boundaryField\n{\n"
                              "    baffle { type noSlip; }"))
    figures.holds("a macro", "$along" in U.read_text())
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    print(done.stdout + done.stderr)
    figures.equal("exit status", done.returncode, 0)
    figures.contains("the baffle", re.search(
        "left behind: patch baffle of 0/U", done.stdout), "baffle")
    done = call("setMaterialPoints", cwd=_started(tmp_path/"new"))
    figures.equal("points are set", done.returncode, 0)
    c = Case(tmp_path/"new")
    figures.equal("points", len(c.cloudField("0", "water", "x")), 12*10*16)
    figures.atMost("velocity, error", np.abs(
        c.cloudField("0", "water", "U") - [0.1, 0, 0]).max(), 1e-12)


def testMud(tmp_path, figures):
    """A liquid with a yield stress keeps its coefficients, and sticks to the
    walls as long as they say so"""
    source = interFoamCase(tmp_path/"tank")
    path = source/"constant"/"transportProperties"
    text = path.read_text()
    assert "transportModel  Newtonian;" in text
    path.write_text(text.replace("transportModel  Newtonian;", """
    transportModel  HerschelBulkley;
    HerschelBulkleyCoeffs { tau0 0.05; k [0 2 -1 0 0 0 0] 0.01; n 0.5; nu0 10; }
""", 1))
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    print(done.stdout + done.stderr)
    figures.equal("exit status", done.returncode, 0)
    water = foamDict.read(
        tmp_path/"new"/"constant"/"materialPointProperties")["water"]
    figures.equal("model", water["viscosityModel"], "HerschelBulkley")
    figures.equal("coefficients", water["HerschelBulkleyCoeffs"],
                  {"tau0": "0.05", "k": "0.01", "n": "0.5", "nu0": "10"})
    figures.equal("mu", water["weaklyCompressibleNewtonianCoeffs"]["mu"], "0")
    figures.holds("walls hold it", "noSlip becomes slip" not in done.stdout)
    log = runMpm(tmp_path/"new", "0.0002")
    figures.holds("runs to its end", log.rstrip().endswith("End"))


def _started(case):
    shutil.copytree(case/"0.orig", case/"0")
    return case


# --- OpenFOAM's own tutorials -------------------------------------------------

@pytest.mark.parametrize("name, water, steps, notes", [
    # What interFoam's cells hold: 12 x (8 + 19) cells of its graded mesh
    ("laminar/damBreak/damBreak", 6.46099e-4, "0.002",
     ["noSlip becomes slip", "surface tension", "sampleSets"]),
    ("RAS/weirOverflow", 369.65, "0.02",
     ["75 m3/s are 75 m2/s", "kEpsilon", "become steps", "inletWall"]),
])
def testTutorials(tmp_path, figures, name, water, steps, notes):
    done = call("interFoamToMpmFoam", openFoamTutorial(name), tmp_path/"new")
    figures.equal("exit status", done.returncode, 0)
    for note in notes:
        figures.holds(f"says '{note}'", note in done.stdout)
    volume = float(re.search(r"water: (\S+) m3", done.stdout)[1])
    figures.atMost("water, relative error", abs(volume/water - 1), 0.01)
    log = runMpm(tmp_path/"new", steps)
    figures.holds("runs to its end", log.rstrip().endswith("End"))
    figures.atMost("mass of the points, relative error",
                   abs(mass(tmp_path/"new")/(1000*volume) - 1), 0.01)


def testObstacle3D(tmp_path, figures):
    """A mesh that topoSet and subsetMesh made: refused without it"""
    source = tmp_path/"case"
    shutil.copytree(openFoamTutorial("laminar/damBreakWithObstacle"), source)
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    figures.equal("without the mesh: exit status", done.returncode, 1)
    figures.holds("says why", "system/topoSetDict changes what blockMesh"
                  in done.stderr)
    # Coarser, to be quick: the obstacle is a cube of 1/4
    dict = source/"system"/"blockMeshDict"
    dict.write_text(dict.read_text().replace("(32 32 32)", "(16 16 16)"))
    for command in [["blockMesh"], ["topoSet"],
                    ["subsetMesh", "-overwrite", "c0", "-patch", "walls"]]:
        assert call(*command, cwd=source).returncode == 0
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    figures.equal("exit status", done.returncode, 0)
    figures.holds("refinement is noted", "refinement during the run"
                  in done.stdout)
    mesh = Mesh(tmp_path/"new")
    figures.atMost("volume of the mesh, relative error",
                   abs(mesh.volumes.sum()/(1 - 0.25**3) - 1), 1e-9)
    volume = float(re.search(r"water: (\S+) m3", done.stdout)[1])
    # Centres within 0.6, 0.1875, 0.75: 10 x 3 x 12 cells
    figures.atMost("water, relative error",
                   abs(volume/(10*3*12/16**3) - 1), 1e-5)
    log = runMpm(tmp_path/"new", "0.001")
    figures.holds("runs to its end", log.rstrip().endswith("End"))


# --- from mpmFoam ---------------------------------------------------------

def prepared(name, path):
    if name == "gateSlot":
        shutil.copytree(TUTORIALS/"damBreak", path)
        shutil.copytree(ROOT/"validation"/"gateSlot"/"case", path,
                        dirs_exist_ok=True)
    else:
        shutil.copytree(TUTORIALS/name, path)
    if name == "standingWave":
        done = subprocess.run([os.environ["MPMFOAM_PYTHON"], "makeWave.py"],
                              cwd=path)
        assert done.returncode == 0
    return path


@pytest.mark.parametrize("name, volume, tolerance, end", [
    ("damBreak", 0.1*0.2*0.004, 1e-9, "2e-3"),
    # Cosine: no part of its own in the mean; 12 parts of a cell
    ("standingWave", 1*0.5*0.025, 1e-4, "2e-2"),
    ("openChannel", 3*0.18*0.02, 1e-9, "2e-2"),
    ("gateSlot", 0.7*0.15*0.01, 1e-9, "2e-3"),
    ("damBreakObstacle3D", 1.2*1*0.56, 1e-9, None),
])
def testToInterFoam(tmp_path, figures, name, volume, tolerance, end):
    source = prepared(name, tmp_path/name)
    done = call("mpmFoamToInterFoam", source, tmp_path/"new")
    figures.equal("exit status", done.returncode, 0)
    mesh = Mesh(tmp_path/"new")
    alpha = foamFile.readInternalField(
        tmp_path/"new"/"0.orig"/"alpha.water", mesh.nCells)
    figures.atMost("water, relative error",
                   abs((alpha*mesh.volumes).sum()/volume - 1), tolerance)
    # A lid would shut the air in; that of standingWave is part of its walls
    figures.equal("lids become openings", done.stdout.count(
        "the lid becomes an opening"), name not in ("standingWave",
                                                    "openChannel") and 1 or 0)
    if not end:
        return
    control = tmp_path/"new"/"system"/"controlDict"
    setEntry(control, "endTime", end)
    setEntry(control, "writeInterval", end)
    done = call("./Allrun", cwd=tmp_path/"new")
    log = tmp_path/"new"/"log.interFoam"
    figures.holds("interFoam runs to its end", log.is_file() and
                  log.read_text().rstrip().endswith("End"),
                  None if done.returncode == 0 else done.stdout)


def testThereAndBack(tmp_path, figures):
    """Ours to interFoam and back: the same mesh and water"""
    a = call("mpmFoamToInterFoam", TUTORIALS/"damBreak", tmp_path/"inter")
    b = call("interFoamToMpmFoam", tmp_path/"inter", tmp_path/"mpm")
    figures.equal("exit status", (a.returncode, b.returncode), (0, 0))
    figures.holds("nothing moved", "moved:" not in b.stdout)
    figures.contains("spacing", re.search(r"spacing: 0\.004 m", b.stdout),
                     "0.004")
    region = foamDict.read(tmp_path/"mpm"/"system"/"setMaterialPointsDict")[
        "water"]["regions"]["water"]
    figures.equal("x, y of the box", [region["min"][:2], region["max"][:2]],
                  [["0", "0"], ["0.1", "0.2"]])
    figures.equal("level", region["level"], "0.2")


# --- what cannot be carried over ----------------------------------------------

@pytest.mark.parametrize("place, old, new, expected", [
    ("0.orig/U", "noSlip;", "codedFixedValue; value uniform (0 0 0);",
     [r"0/U: entry boundaryField/walls/type", "codedFixedValue", "noSlip"]),
    ("0.orig/p_rgh", "p0 uniform 0", "p0 uniform 500",
     ["p_rgh: entry boundaryField/top/p0", "value 500", "Allowed: 0"]),
    ("0.orig/alpha.water", "inletValue uniform 0", "inletValue uniform 1",
     ["alpha.water: entry boundaryField/top/inletValue", "value 1"]),
    ("constant/transportProperties", "Newtonian", "CrossPowerLaw",
     ["entry water/transportModel", "CrossPowerLaw", "Allowed: Newtonian",
      "HerschelBulkley"]),
    ("0.orig/U", "uniform (0 0 0)", "uniform (still 0 0)",
     ["U: entry internalField has the value uniform \\(still 0 0\\)",
      "Allowed: uniform and a vector"]),
    ("constant/transportProperties", "(water air)", "(water)",
     ["entry phases", "two phases"]),
    ("system/controlDict", "application interFoam",
     "application interPhaseChangeFoam",
     ["entry application", "interPhaseChangeFoam", "interFoam"]),
    ("system/setFieldsDict", "(0.12 0.1 1)", "(0.001 0.001 1)",
     ["no water, and no inlet"]),
])
def testRefused(tmp_path, figures, place, old, new, expected):
    source = interFoamCase(tmp_path/"tank")
    text = (source/place).read_text()
    assert old in text
    (source/place).write_text(text.replace(old, new, 1))
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    figures.equal("exit status", done.returncode, 1)
    for e in expected:
        figures.contains("message", re.search(e, done.stderr, re.DOTALL), e)
    figures.holds("nothing is left", not (tmp_path/"new").exists())


def testOthersRefused(tmp_path, figures):
    source = interFoamCase(tmp_path/"tank")
    (source/"constant"/"dynamicMeshDict").write_text(foamDict.header(
        "dynamicMeshDict") + "dynamicFvMesh dynamicMotionSolverFvMesh;\n")
    done = call("interFoamToMpmFoam", source, tmp_path/"new")
    figures.contains("mesh that moves", re.search(
        "dynamicFvMesh has the value dynamicMotionSolverFvMesh",
        done.stderr), "dynamicMotionSolverFvMesh")
    (source/"constant"/"dynamicMeshDict").unlink()
    # The block one cell thick
    done = call("interFoamToMpmFoam", source, tmp_path/"new", "--spacing",
                0.04)
    figures.contains("thin solid", re.search(
        r"one cell thick along x.*--spacing 0\.02", done.stderr, re.DOTALL),
        "one cell thick")
    done = call("mpmFoamToInterFoam", TUTORIALS/"wallJet", tmp_path/"new")
    figures.contains("soil", re.search(
        r"entry clouds has the value \(.*soil.*\).*no soil", done.stderr,
        re.DOTALL), "clouds")
    done = call("compareInterFoam", tmp_path)
    figures.contains("no case", re.search("no system/controlDict",
                                          done.stderr), "controlDict")


# --- comparison -----------------------------------------------------------

def testCompare(tmp_path, figures):
    """A small dam break by both: table, figure, and results that agree as
    well as cells of 1 cm let them. interFoam's files are compressed"""
    source = compressed(interFoamCase(tmp_path/"tank"))
    done = call("compareInterFoam", source, "--endTime", 0.15,
                "--writeInterval", 0.03)
    print(done.stdout[-2500:] + done.stderr[-2500:])
    figures.equal("exit status", done.returncode, 0)
    out = source/"compareInterFoam"
    m = metrics.readMetrics(out/"metrics.json")
    table = reference.readCsv(out/"comparison.csv")
    figures.equal("times", len(table["time"]), 5)
    figures.atMost("volume, largest difference", m["volumeDifferenceMax"],
                   0.01)
    figures.atMost("front, largest difference", m["frontDifferenceMax"], 0.06)
    figures.atMost("profiles, rms over the depth",
                   m["profileDifferenceRms"], 0.08)
    figures.holds("figure", (out/"comparison.png").stat().st_size > 20000)
    figures.holds("compressed", any(out.rglob("alpha.water.gz")))
    again = call("compareInterFoam", source)
    figures.equal("a second call runs nothing", again.stdout.count(
        "finished before"), 2)
