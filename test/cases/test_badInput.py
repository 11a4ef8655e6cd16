"""What a user gets wrong: the run ends with a message that names the file (or
the mesh directory), the keyword, the value found and what is allowed."""

import re
from dataclasses import dataclass

import pytest

from caseBuilder import box, damBreak, header, hydrostatic

PROPERTIES = r"constant/materialPointProperties"
SOLUTION = r"system/fvSolution"
CONTROL = r"system/controlDict"
REGIONS = r"system/setMaterialPointsDict"
VELOCITY = r"0/U\.water"
MESH = r"constant/polyMesh"
GRAVITY = r"constant/g\b"


@dataclass
class Bad:
    """name      of the test
    expect    what the message must hold: name -> regular expression
    setup     changes of the case's dictionaries, before it is written
    edit      changes of the case on disk, after it was written
    at        application that must refuse it"""
    name: str
    expect: dict
    setup: object = None
    edit: object = None
    at: str = "setMaterialPoints"


def words(*names):
    """All of them, in any order"""
    return "".join(rf"(?=.*\b{n}\b)" for n in names)


# --- changes --------------------------------------------------------------

def fluid(**entries):
    return lambda s: s.fluid.update(entries)


def water(**entries):
    return lambda s: s.water.update(entries)


def mpm(**entries):
    return lambda s: s.mpm.update(entries)


def placement(**entries):
    return lambda s: s.placement.update(entries)


def region(**entries):
    return lambda s: s.regions["column"].update(entries)


def withoutRegion(key):
    return lambda s: s.regions["column"].pop(key)


def replace(file, old, new, count=1):
    def edit(case):
        path = case.path/file
        text = path.read_text()
        assert re.search(old, text), f"{file} has no {old}"
        path.write_text(re.sub(old, new, text, count=count))
    return edit


def delete(file):
    return lambda case: (case.path/file).unlink()


def sheared(case):
    """The upper vertices of the mesh, 0.05 m to the right"""
    edit = replace("system/blockMeshDict", r"\((\S+) 0\.4 (\S+)\)",
                   lambda m: f"({float(m[1]) + 0.05:g} 0.4 {m[2]})", count=0)
    edit(case)


def emptyHole(setup):
    """A hole whose faces are in no patch that is named: blockMesh puts them
    into one of type empty"""
    setup.solid = [((10, 5), (14, 9))]
    for side in ["xmin", "xmax", "ymin", "ymax"]:
        setup.sides[side] = ("wall", "slip")


def defaultEmpty(case):
    replace("system/blockMeshDict", r"name walls;\s*type wall;",
            "name hole; type empty;")(case)
    replace("0/U.water", r"walls\s*\{\s*type slip;", "hole { type empty;")(
        case)


def subsetHole(case):
    """subsetMesh without -patch does the same"""
    case.run("blockMesh")
    (case.path/"system"/"topoSetDict").write_text(
        header("topoSetDict") + """
actions
(
    { name c; type cellSet; action new; source boxToCell;
      box (0.3 0.1 -1) (0.36 0.16 1); }
    { name c; type cellSet; action invert; }
);
""")
    case.run("topoSet")
    case.run("subsetMesh", "-overwrite", "c")
    replace("0/U.water", r"walls\s*\{",
            "oldInternalFaces { type empty; } walls {")(case)


def polyhedra(case):
    """One cell refined: its neighbours have more faces"""
    case.run("blockMesh")
    (case.path/"system"/"topoSetDict").write_text(
        header("topoSetDict") + """
actions
(
    { name c; type cellSet; action new; source boxToCell;
      box (0.1 0.1 -1) (0.14 0.14 1); }
);
""")
    case.run("topoSet")
    case.run("refineHexMesh", "-overwrite", "c")


def baffles(case):
    """A wall without thickness in the middle"""
    case.run("blockMesh")
    (case.path/"system"/"topoSetDict").write_text(
        header("topoSetDict") + """
actions
(
    { name f; type faceSet; action new; source boxToFace;
      box (0.299 0 -1) (0.301 0.2 1); }
    { name f; type faceZoneSet; action new; source setToFaceZone;
      faceSet f; }
);
""")
    case.run("topoSet")
    (case.path/"system"/"createBafflesDict").write_text(
        header("createBafflesDict") + """
internalFacesOnly true;
baffles
{
    plate
    {
        type faceZone;
        zoneName f;
        patchPairs { type wall; }
    }
}
""")
    # Only faces that look along x
    case.run("createBaffles", "-overwrite")
    replace("0/U.water", r"walls\s*\{",
            '"plate.*" { type slip; } walls {')(case)


def twoLayers(case):
    """Two cells in the empty direction"""
    replace("system/blockMeshDict", r"\((\d+) (\d+) 1\) simple",
            r"(\1 \2 2) simple", count=0)(case)


def swap(old, new):
    """Another name for a keyword of materialPointProperties"""
    return replace("constant/materialPointProperties", rf"\b{old}\b", new)


def farAway(setup):
    """Cells of 6.25 mm 4200 km from the origin, in ascii"""
    setup.origin, setup.h = (4.2e6, 0, 0), 0.00625
    setup.control.update(writeFormat="ascii", writePrecision=10)
    setup.regions["column"] = hydrostatic((4.2e6, 0), (4.2e6 + 0.1, 0.1))


def brokenOwner(face, cell):
    """The file owner of the mesh: one face of another cell; without a face,
    so many of the last ones are missing"""
    def edit(case):
        case.change(control={"writeFormat": "ascii"})
        case.run("blockMesh")
        path = case.path/"constant"/"polyMesh"/"owner"
        lines = path.read_text().splitlines()
        first, last = lines.index("(") + 1, lines.index(")")
        cells = lines[first:last]
        if face is None:
            cells = cells[:-cell]
            lines[first - 2] = str(len(cells))
        else:
            cells[face] = str(cell)
        path.write_text("\n".join(lines[:first] + cells + lines[last:]) + "\n")
    return edit


# --- the cases ------------------------------------------------------------

CASES = [
    # Mesh
    Bad("graded", {
        "mesh": MESH, "cell": r"cell: \d+ at \(", "size": r"extent \(",
        "allowed": r"(?s)axis-aligned hexahedra.*\(0\.0\d+ 0\.02 0\.02\)",
        "cells": "Along x: 25 cells of a size that grows or shrinks from 0 to"
                 " 0.5 .edge x of block 0 in blockMeshDict",
        "spacing": r"within 1 %: 0\.02, with the numbers of cells x \(25\)"
                   r" y \(20\)"},
        edit=replace("system/blockMeshDict", r"simpleGrading \(1 1 1\)",
                     "simpleGrading (2 1 1)")),
    Bad("blocksOfOtherLengths", {
        "mesh": MESH,
        "runs": r"Along x: 10 cells of 0\.021 from 0 to 0\.21 "
                r"\(edge x of blocks 0 1 2 in blockMeshDict\) "
                r"4 cells of 0\.0175 from 0\.21 to 0\.28 "
                r"\(edge x of blocks 3 4 in blockMeshDict\) "
                r"11 cells of 0\.02 from 0\.28 to 0\.5 "
                r"\(edge x of blocks 5 6 7 in blockMeshDict\)",
        "spacing": r"spacing that fits all these lengths within 1 %: 0\.0\d+,"
                   r" with the numbers of cells x \([\d ]+\) y \(\d+\)"},
        setup=lambda s: s.solid.append(((10, 5), (14, 9))),
        edit=replace("system/blockMeshDict", r"\(0\.2 ", "(0.21 ", count=0)),
    Bad("digitsOfTheMesh", {
        "mesh": MESH, "cause": "Only digits keep it from being uniform: along x"
        r", at 4\.2e\+06 m, the 10 digits of the file are steps of 0\.001 m",
        "allowed": "writeFormat binary.*origin of the coordinates"},
        setup=farAway),
    Bad("ownerOfNoCell", {
        "mesh": MESH, "file": r"file owner gives face 10 to cell 999999",
        "allowed": "without gaps"}, edit=brokenOwner(10, 999999)),
    Bad("ownerNegative", {
        "mesh": MESH, "file": r"file owner gives face 10 to cell -1",
        "allowed": "without gaps"}, edit=brokenOwner(10, -1)),
    Bad("ownerOfAnotherCell", {
        "mesh": MESH, "cell": r"\b499 has 3 faces|not uniform"},
        edit=brokenOwner(-1, 3)),
    Bad("ownerTooShort", {
        "mesh": MESH, "file": r"file owner has \d+ faces, but boundary and"
        r" neighbour have \d+"}, edit=brokenOwner(None, 5)),
    Bad("sheared", {
        "mesh": MESH, "cell": r"cell: \d+ at \(", "size": r"extent \(",
        "allowed": r"(?s)axis-aligned hexahedra"}, edit=sheared),
    Bad("polyhedral", {
        "mesh": MESH, "cell": r"cell: \d+ at \(",
        "allowed": r"(?s)axis-aligned hexahedra"}, edit=polyhedra),
    Bad("holeInEmptyPatch", {
        "mesh": MESH, "patch": r"patch hole", "type": "type empty",
        "place": r"face at \(", "allowed": "wall patch"},
        setup=emptyHole, edit=defaultEmpty),
    Bad("holeOfSubsetMesh", {
        "mesh": MESH, "patch": r"patch oldInternalFaces",
        "type": "type empty", "place": r"face at \(",
        "allowed": "-patch"}, edit=subsetHole),
    Bad("wallOfOneCell", {
        "mesh": MESH, "what": "one cell thick, at 1 place",
        "place": r"thin in direction x, from \(0\.28 0 0\) to"
                 r" \(0\.3 0\.12 0\.02\)",
        "allowed": "at least two cells"},
        setup=lambda s: s.solid.append(((14, 0), (15, 6)))),
    Bad("threeWallsOfOneCell", {
        "mesh": MESH, "what": "one cell thick, at 3 places",
        "first": r"direction x, from \(0\.28 0 0\) to"
                 r" \(0\.3 0\.12 0\.02\)",
        "second": r"direction y, from \(0\.34 0\.12 0\) to"
                  r" \(0\.42 0\.14 0\.02\)",
        "third": r"direction x, from \(0\.22 0\.24 0\) to"
                 r" \(0\.24 0\.4 0\.02\)",
        "allowed": "at least two cells"},
        setup=lambda s: s.solid.extend([
            ((14, 0), (15, 6)), ((17, 6), (21, 7)), ((11, 12), (12, 20))])),
    Bad("wallWithoutThickness", {
        "mesh": MESH, "patch": "patch plate", "place": r"at \(",
        "allowed": "at least two"}, edit=baffles),
    Bad("twoLayersOfCells", {
        "mesh": MESH, "value": r"\b2\b.*empty direction",
        "allowed": "one is allowed"}, edit=twoLayers),

    # Missing
    Bad("noProperties", {"file": PROPERTIES},
        edit=delete("constant/materialPointProperties")),
    Bad("noClouds", {"file": PROPERTIES, "keyword": r"\bclouds\b"},
        edit=replace("constant/materialPointProperties",
                     r"clouds \(water\);", "")),
    Bad("emptyClouds", {"file": PROPERTIES, "keyword": r"\bclouds\b",
                        "value": "empty", "allowed": r"\(water\)"},
        edit=replace("constant/materialPointProperties",
                     r"clouds \(water\);", "clouds ();")),
    Bad("noCloudDictionary", {"file": PROPERTIES, "keyword": r"\bwater\b"},
        edit=lambda case: (case.path/"constant"/"materialPointProperties")
        .write_text(header("materialPointProperties")
                    + "clouds (water);\n")),
    Bad("noModel", {"file": PROPERTIES, "keyword": "constitutiveModel"},
        setup=water(constitutiveModel=None)),
    Bad("noCoeffs", {"file": PROPERTIES,
                     "keyword": "weaklyCompressibleNewtonianCoeffs"},
        setup=water(weaklyCompressibleNewtonianCoeffs=None)),
    Bad("noDensity", {"file": PROPERTIES, "keyword": r"\brho0\b"},
        setup=fluid(rho0=None)),
    Bad("noViscosity", {"file": PROPERTIES, "keyword": r"\bmu\b"},
        setup=fluid(mu=None)),
    Bad("noGravityFile", {"file": GRAVITY}, edit=delete("constant/g")),
    Bad("noGravityValue", {"file": GRAVITY, "keyword": r"\bvalue\b"},
        edit=replace("constant/g", r"value [^;]*;", "")),
    Bad("noSetMaterialPointsDict", {"file": REGIONS},
        edit=delete("system/setMaterialPointsDict")),
    Bad("noCloudInSetMaterialPointsDict", {
        "file": REGIONS, "keyword": r"\bwater\b"},
        edit=lambda case: (case.path/"system"/"setMaterialPointsDict")
        .write_text(header("setMaterialPointsDict"))),
    Bad("noPointsPerDirection", {
        "file": REGIONS, "keyword": "pointsPerDirection"},
        setup=placement(pointsPerDirection=None)),
    Bad("noRegions", {"file": REGIONS, "keyword": r"\bregions\b"},
        edit=replace("system/setMaterialPointsDict", r"regions", "regionen")),
    Bad("emptyRegions", {"file": REGIONS, "keyword": r"\bregions\b",
                         "allowed": r"type box"},
        setup=lambda s: s.regions.clear()),
    Bad("noRegionType", {"file": REGIONS, "keyword": r"\btype\b"},
        setup=withoutRegion("type")),
    Bad("noRegionCorner", {"file": REGIONS, "keyword": r"\bmin\b"},
        setup=withoutRegion("min")),
    Bad("noVelocityFile", {"file": VELOCITY}, edit=delete("0/U.water")),
    Bad("noPatchInVelocity", {"file": VELOCITY, "patch": r"\bwalls\b"},
        # Not "wall", which is the group of all patches of type wall
        edit=replace("0/U.water", r"\bwalls\b", "waals")),

    # Misspelt: the right name is suggested
    Bad("misspeltInCloud", {
        "file": PROPERTIES, "keyword": r"\btransfr\b",
        "allowed": "Did you mean transfer"}, setup=water(transfr="FLIP")),
    Bad("misspeltInCloud2", {
        "file": PROPERTIES, "keyword": r"\bapicrate\b",
        "allowed": "Did you mean apicRate"}, setup=water(apicrate=100)),
    Bad("misspeltInCoeffs", {
        "file": PROPERTIES, "keyword": r"\brho\b",
        "allowed": "Did you mean rho0"}, setup=fluid(rho=1000)),
    Bad("misspeltInCoeffs2", {
        "file": PROPERTIES, "keyword": r"\bsoundspeed\b",
        "allowed": "Did you mean soundSpeed"}, setup=fluid(soundspeed=20)),
    Bad("misspeltModel", {
        "file": PROPERTIES, "keyword": r"\bconstitutivModel\b",
        "allowed": "Did you mean constitutiveModel"},
        edit=swap("constitutiveModel", "constitutivModel")),
    Bad("misspeltCoeffs", {
        "file": PROPERTIES,
        "keyword": r"\bweaklyCompressibleNewtonianCoefs\b",
        "allowed": "Did you mean weaklyCompressibleNewtonianCoeffs"},
        edit=swap("weaklyCompressibleNewtonianCoeffs",
                  "weaklyCompressibleNewtonianCoefs")),
    Bad("misspeltClouds", {
        "file": PROPERTIES, "keyword": r"\bcloud\b",
        "allowed": r"clouds"}, edit=swap("clouds", "cloud")),
    Bad("misspeltCloudDictionary", {
        "file": PROPERTIES, "keyword": r"\bWater\b",
        "allowed": "Did you mean water"},
        edit=replace("constant/materialPointProperties", r"\nwater\n",
                     "\nWater\n")),
    Bad("misspeltInMPM", {
        "file": SOLUTION, "keyword": r"\bshapeFuncton\b",
        "allowed": "Did you mean shapeFunction"},
        setup=mpm(shapeFuncton="linear")),
    Bad("misspeltInMPM2", {
        "file": SOLUTION, "keyword": r"\bvolumecorrection\b",
        "allowed": "Did you mean volumeCorrection"},
        setup=mpm(volumecorrection=False)),
    Bad("misspeltInSetMaterialPointsDict", {
        "file": REGIONS, "keyword": r"\bpointPerDirection\b",
        "allowed": "Did you mean pointsPerDirection"},
        setup=placement(pointPerDirection=4)),
    Bad("misspeltInRegion", {
        "file": REGIONS, "keyword": r"\bvelocty\b",
        "allowed": "Did you mean velocity"},
        setup=region(velocty=(1, 0, 0))),
    Bad("misspeltCloudOfPoints", {
        "file": REGIONS, "keyword": r"\bwasser\b", "allowed": r"\bwater\b"},
        edit=replace("system/setMaterialPointsDict", r"water", "wasser")),

    # Unknown
    Bad("cloudWithoutModel", {
        "file": PROPERTIES, "keyword": "constitutiveModel",
        "value": r"\bair\b"},
        edit=replace("constant/materialPointProperties",
                     r"clouds \(water\);", "clouds (water air); air {}")),
    Bad("unknownModel", {
        "file": PROPERTIES, "keyword": "constitutiveModel",
        "value": r"\bnewtonian\b",
        "allowed": r"(?s)Valid.*weaklyCompressibleNewtonian"},
        setup=water(constitutiveModel="newtonian")),
    Bad("unknownTransfer", {
        "file": PROPERTIES, "keyword": r"\btransfer\b", "value": r"\bAPIK\b",
        "allowed": r"(?s)Valid.*" + words("APIC", "FLIP", "PIC", "XPIC")},
        setup=water(transfer="APIK")),
    Bad("affineWithLinear", {
        "file": PROPERTIES, "keyword": r"\btransfer\b", "value": r"\bAPIC\b",
        "allowed": r"(?s)Allowed.*" + words("FLIP", "PIC", "XPIC")},
        setup=lambda s: (s.mpm.update(shapeFunction="linear"),
                         s.water.update(transfer="APIC"))),
    Bad("unknownShapeFunction", {
        "file": SOLUTION, "keyword": "shapeFunction",
        "value": r"\bquadratic\b",
        "allowed": r"(?s)Valid.*" + words(
            "linear", "quadraticBSpline", "cubicBSpline")},
        setup=mpm(shapeFunction="quadratic")),
    Bad("unknownMomentum", {
        "file": SOLUTION, "keyword": "momentum", "value": "projection",
        "allowed": "explicit"},
        setup=mpm(momentum="projection")),
    Bad("unknownRegion", {
        "file": REGIONS, "keyword": r"\btype\b", "value": r"\bball\b",
        "allowed": r"(?s)Valid.*" + words(
            "box", "polygon", "cylinder", "surface", "cellZone")},
        setup=region(type="ball")),
    Bad("unknownPlacement", {
        "file": REGIONS, "keyword": "placement", "value": r"\brandom\b",
        "allowed": r"(?s)Valid.*" + words("regular", "jittered")},
        setup=placement(placement="random")),
    Bad("unknownPressure", {
        "file": REGIONS, "keyword": "pressure", "value": r"\bhydrostatik\b",
        "allowed": r"(?s)Valid.*" + words("uniform", "hydrostatic")},
        setup=region(pressure="hydrostatik")),
    Bad("unknownSoundSpeed", {
        "file": PROPERTIES, "keyword": "soundSpeed", "value": r"\bautomatic\b",
        "allowed": r"(?s)Valid.*auto"}, setup=fluid(soundSpeed="automatic")),

    # Dimensions
    Bad("dimensionsOfDensity", {
        "file": PROPERTIES, "keyword": r"\brho0\b",
        "value": r"\[1 -2 0 0 0 0 0\]", "allowed": r"\[1 -3 0 0 0 0 0\]"},
        setup=fluid(rho0="[1 -2 0 0 0 0 0] 1000")),
    Bad("dimensionsOfViscosity", {
        "file": PROPERTIES, "keyword": r"\bmu\b",
        "value": r"\[0 2 -1 0 0 0 0\]", "allowed": r"\[1 -1 -1 0 0 0 0\]"},
        setup=fluid(mu="[0 2 -1 0 0 0 0] 1e-6")),
    Bad("dimensionsOfSoundSpeed", {
        "file": PROPERTIES, "keyword": r"\bsoundSpeed\b",
        "value": r"\[0 1 -2 0 0 0 0\]", "allowed": r"\[0 1 -1 0 0 0 0\]"},
        setup=fluid(soundSpeed="[0 1 -2 0 0 0 0] 20")),
    Bad("dimensionsOfGravity", {
        "file": GRAVITY, "keyword": r"\bdimensions\b",
        "value": r"\[0 1 -1 0 0 0 0\]", "allowed": r"\[0 1 -2 0 0 0 0\]"},
        edit=replace("constant/g", r"\[0 1 -2 0 0 0 0\]",
                     "[0 1 -1 0 0 0 0]")),
    Bad("dimensionsOfVelocity", {
        "file": VELOCITY, "keyword": r"\bdimensions\b",
        "value": r"\[0 1 -2 0 0 0 0\]", "allowed": r"\[0 1 -1 0 0 0 0\]"},
        edit=replace("0/U.water", r"\[0 1 -1 0 0 0 0\]",
                     "[0 1 -2 0 0 0 0]")),

    Bad("unknownPressureForm", {
        "file": SOLUTION, "keyword": "pressureForm", "value": r"\bgradiant\b",
        "allowed": words("gradient", "divergence")},
        setup=mpm(pressureForm="gradiant")),
    Bad("overlapCorrectionAlone", {
        "file": SOLUTION, "keyword": "overlapCorrection", "value": r"\byes\b",
        "allowed": "volumeCorrection yes"},
        setup=mpm(overlapCorrection=True, volumeCorrection=False)),

    # Values
    Bad("maxDeltaT", {
        "file": CONTROL, "keyword": r"\bmaxDeltaT\b", "value": r"value 0\b",
        "allowed": "0 < maxDeltaT"},
        setup=lambda s: s.control.update(maxDeltaT=0), at="mpmFoam"),
    Bad("negativeDensity", {
        "file": PROPERTIES, "keyword": r"\brho0\b", "value": "-1000",
        "allowed": r"0 < rho0"}, setup=fluid(rho0=-1000)),
    Bad("zeroDensity", {
        "file": PROPERTIES, "keyword": r"\brho0\b", "value": r"value 0\b",
        "allowed": r"0 < rho0"}, setup=fluid(rho0=0)),
    Bad("negativeViscosity", {
        "file": PROPERTIES, "keyword": r"\bmu\b", "value": r"-0\.001",
        "allowed": r"0 <= mu"}, setup=fluid(mu=-1e-3)),
    Bad("wordForANumber", {
        "file": PROPERTIES, "keyword": r"\brho0\b", "value": "heavy"},
        setup=fluid(rho0="heavy")),
    Bad("twoNumbers", {
        "file": PROPERTIES, "keyword": r"\brho0\b", "value": r"1000 2000",
        "allowed": "one number"}, setup=fluid(rho0="1000 2000")),
    Bad("gamma", {
        "file": PROPERTIES, "keyword": r"\bgamma\b", "value": r"0\.5",
        "allowed": r"1 < gamma"}, setup=fluid(gamma=0.5)),
    Bad("zeroSoundSpeed", {
        "file": PROPERTIES, "keyword": "soundSpeed", "value": r"value 0\b",
        "allowed": "0 < soundSpeed"}, setup=fluid(soundSpeed=0)),
    Bad("autoSoundSpeedOfNothing", {
        "file": PROPERTIES, "keyword": "soundSpeed",
        "value": r"\bauto\b", "allowed": "soundSpeed > 0"},
        setup=lambda s: setattr(s, "g", (0, 0, 0))),
    Bad("flipDampingRate", {
        "file": PROPERTIES, "keyword": "flipDampingRate", "value": "-20",
        "allowed": "0 <= flipDampingRate"},
        setup=water(transfer="FLIP", flipDampingRate=-20)),
    Bad("apicRate", {
        "file": PROPERTIES, "keyword": "apicRate", "value": "-1",
        "allowed": "0 <= apicRate"}, setup=water(apicRate=-1)),
    Bad("maxCoZero", {
        "file": SOLUTION, "keyword": "maxCo", "value": r"value 0\b",
        "allowed": r"0 < maxCo < 0\.9"}, setup=mpm(maxCo=0)),
    Bad("maxCoTooLarge", {
        "file": SOLUTION, "keyword": "maxCo", "value": r"1\.5",
        "allowed": r"0 < maxCo < 0\.9"}, setup=mpm(maxCo=1.5)),
    Bad("maxCoInControlDict", {
        "file": CONTROL, "keyword": "maxCo", "value": r"\b2\b",
        "allowed": r"0 < maxCo < 0\.9"},
        setup=lambda s: (s.mpm.update(maxCo=None),
                         s.control.update(maxCo=2))),
    Bad("sortInterval", {
        "file": SOLUTION, "keyword": "sortInterval", "value": r"value 0\b",
        "allowed": "1 <= sortInterval"}, setup=mpm(sortInterval=0)),
    Bad("sortIntervalBroken", {
        "file": SOLUTION, "keyword": "sortInterval", "value": r"value 2\.5",
        "allowed": "whole number, 1 <= sortInterval"},
        setup=mpm(sortInterval=2.5)),
    Bad("logIntervalBroken", {
        "file": SOLUTION, "keyword": "logInterval", "value": r"value 2\.5",
        "allowed": "whole number, 1 <= logInterval"},
        setup=mpm(logInterval=2.5)),
    Bad("seedBroken", {
        "file": REGIONS, "keyword": "seed", "value": r"value 2\.5",
        "allowed": "whole number"}, setup=placement(seed=2.5)),
    Bad("smoothingNoSwitch", {
        "file": SOLUTION, "keyword": "smoothing", "value": "perhaps",
        "allowed": r"(?i)" + words("yes", "no")},
        setup=mpm(smoothing="perhaps")),
    Bad("pointsPerDirection", {
        "file": REGIONS, "keyword": "pointsPerDirection",
        "value": r"value 0\b", "allowed": "1 <= pointsPerDirection"},
        setup=placement(pointsPerDirection=0)),
    Bad("pointsPerDirectionBroken", {
        "file": REGIONS, "keyword": "pointsPerDirection",
        "value": r"value 2\.5", "allowed": "whole number"},
        setup=placement(pointsPerDirection=2.5)),
    Bad("jitter", {
        "file": REGIONS, "keyword": "jitter", "value": r"0\.7",
        "allowed": r"jitter <= 0\.5"},
        setup=placement(placement="jittered", jitter=0.7)),
    Bad("cornersSwapped", {
        "file": REGIONS, "keyword": r"\bmax\b",
        "value": r"\(0\.2 -0\.2 10\)", "allowed": "max > min"},
        setup=region(max=(0.2, -0.2, 10))),
    Bad("regionOutside", {
        "file": REGIONS, "keyword": r"\bcolumn\b", "value": r"\(2 0 -10\)",
        "allowed": r"the mesh \(0 0 0\)"},
        setup=lambda s: s.regions.update(column=box((2, 0), (3, 1)))),
    Bad("regionsOverlap", {
        "file": REGIONS, "keyword": r"\bmore\b", "place": r"at \(",
        "allowed": "do not overlap"},
        setup=lambda s: s.regions.update(more=box((0.1, 0.1), (0.3, 0.3)))),
    Bad("gravityInEmptyDirection", {
        "file": GRAVITY, "keyword": r"\bvalue\b", "value": r"-9\.81",
        "allowed": "must be zero"},
        setup=lambda s: setattr(s, "g", (0, 0, -9.81))),

    # Patches
    Bad("fixedMean", {
        "file": VELOCITY, "patch": r"\bwalls\b", "keyword": r"\btype\b",
        "value": r"\bfixedMean\b",
        "allowed": words("slip", "noSlip", "fixedValue", "zeroGradient",
                         "inletOutlet", "cyclic", "empty")},
        setup=lambda s: setattr(s, "wall", {
            "type": "fixedMean", "meanValue": "(0 0 0)",
            "value": "uniform (0 0 0)"})),
    Bad("fixedValueWithoutValue", {
        "file": VELOCITY, "patch": r"\bwalls\b", "keyword": r"\bvalue\b"},
        setup=lambda s: setattr(s, "wall", {"type": "fixedValue"})),
    Bad("emptyOnAWall", {
        "file": r"U\.water", "patch": r"\bwalls\b", "value": r"\bempty\b"},
        setup=lambda s: setattr(s, "wall", "empty")),

    # What the solver finds
    Bad("noPoints", {
        "file": r"0/uniform/materialPoints|0/lagrangian/water",
        "allowed": "Run setMaterialPoints"},
        edit=lambda case: case.run("blockMesh"), at="mpmFoam"),
    Bad("deltaTTooLarge", {
        "file": CONTROL, "keyword": r"\bdeltaT\b", "value": r"0\.01\b",
        "allowed": r"deltaT <= 0\.000\d+"},
        setup=lambda s: s.control.update(adjustTimeStep=False, deltaT=0.01),
        at="mpmFoam"),
]


def base():
    return damBreak().steps(5)


@pytest.mark.parametrize("bad", CASES, ids=lambda bad: bad.name)
def testRefused(tmp_path, figures, bad):
    setup = base()
    if bad.setup:
        bad.setup(setup)
    case = setup.write(tmp_path/"case")
    if bad.edit:
        bad.edit(case)
    if not (case.path/"constant"/"polyMesh"/"points").exists():
        case.run("blockMesh")
    if bad.at == "mpmFoam" and bad.name != "noPoints":
        case.run("setMaterialPoints")
    refused(figures, case.run(bad.at, check=False), bad.expect)


def refused(figures, result, expect):
    text = result.text
    at = text.find("--> FOAM FATAL")
    message = text[at:] if at >= 0 else text[-1500:]
    # Messages wrap; numbers and names do not
    flat = re.sub(r"\s+", " ", message)
    print(message)
    figures.equal("exit status", result.status, 1)
    figures.holds("a FatalError", at >= 0)
    for what, pattern in expect.items():
        found = re.search(pattern, flat, re.DOTALL)
        figures.contains(f"message names the {what}",
                         found and (found[0][:60] or pattern), pattern)


@pytest.mark.parametrize("strict", [True, False])
def testStrictKeywords(tmp_path, figures, strict):
    """With strictKeywords no an unknown keyword is a warning"""
    setup = base()
    setup.mpm.update(strictKeywords=strict, smoothingg=False)
    setup.water.update(transfr="FLIP")
    setup.regions["column"]["velocty"] = (1, 0, 0)
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    result = case.run("setMaterialPoints", check=False)
    if strict:
        figures.equal("exit status", result.status, 1)
        figures.holds("the message tells how to turn it into a warning",
                      "strictKeywords no" in result.text)
        return
    figures.equal("exit status", result.status, 0)
    for keyword, right in [("smoothingg", "smoothing"),
                           ("transfr", "transfer"), ("velocty", "velocity")]:
        figures.holds(f"a warning about {keyword}", re.search(
            rf"Warning(?s:.*)unknown keyword {keyword} (?s:.*)"
            rf"Did you mean {right}", result.text) is not None)
    case.solve()
    figures.holds("the solver runs", case.log.finished)


@pytest.mark.parametrize("transfer, told", [
    ("PIC", ["apicRate", "flipDampingRate"]), ("FLIP", ["apicRate"]),
    ("APIC", ["flipDampingRate"])])
def testRateOfAnotherTransfer(tmp_path, figures, transfer, told):
    """A rate that the chosen transfer does not have is a warning"""
    setup = base()
    setup.water.update(transfer=transfer, apicRate=100, flipDampingRate=20)
    result = setup.write(tmp_path/"case").prepare().solve()
    figures.equal("keywords told to have no effect", sorted(set(re.findall(
        r"keyword (\w+) has no effect", result.text))), told)


@pytest.mark.parametrize("how", ["smaller", "obstacle"])
def testMeshChangedAfterwards(tmp_path, figures, how):
    """Points that lie in no cell any more; with the record of the mesh (see
    test_changedCase.py) and without it"""
    case = base().write(tmp_path/"case").prepare()
    if how == "smaller":
        case.setup.cells = (8, 20)
    else:
        case.setup.solid = [((2, 2), (5, 5))]
    case.rewrite()
    case.run("blockMesh")
    refused(figures, case.solve(check=False), {
        "file": r"0/uniform/materialPoints", "mesh": r"mesh/cells was 500, is",
        "allowed": "(?i)setMaterialPoints"})

    replace("0/uniform/materialPoints", r"\ncase\n", "\nolder\n")(case)
    refused(figures, case.solve(check=False), {
        "file": r"0/lagrangian/water", "point": r"point \d+ at \(",
        "allowed": "(?i)setMaterialPoints"})


@pytest.mark.parametrize("format_", ["stl", "obj"])
def testSurfaceFarFromTheOrigin(tmp_path, figures, format_):
    """OpenFOAM reads STL in single precision: said where it matters"""
    at = 4.2e6
    setup = base()
    setup.origin = (at, 0, 0)
    setup.regions = {"column": {"type": "surface",
                                "file": f'"box.{format_}"'}}
    case = setup.write(tmp_path/"case")
    case.run("blockMesh")
    corners = [(at + 0.2*(i & 1), 0.2*(i >> 1 & 1), 0.4*(i >> 2) - 0.1)
               for i in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3),
             (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [t for a, b, c, d in quads for t in [(a, b, c), (a, c, d)]]
    if format_ == "obj":
        text = "".join("v %.12g %.12g %.12g\n" % c for c in corners) + "".join(
            "f %d %d %d\n" % tuple(i + 1 for i in t) for t in triangles)
    else:
        text = "solid box\n" + "".join(
            "facet normal 0 0 0\nouter loop\n" + "".join(
                "vertex %.12g %.12g %.12g\n" % corners[i] for i in t)
            + "endloop\nendfacet\n" for t in triangles) + "endsolid box\n"
    folder = case.path/"constant"/"triSurface"
    folder.mkdir()
    (folder/f"box.{format_}").write_text(text)
    result = case.run("setMaterialPoints", check=False)
    if format_ == "stl":
        refused(figures, result, {
            "file": r"box\.stl", "what": "not closed",
            "cause": r"single precision: at 4200000[.\d]* m it holds steps of"
                     r" 0\.5\d* m only", "allowed": "format obj"})
    else:
        figures.equal("exit status", result.status, 0)
        figures.equal("points", len(case.points("0").id), 900)


def testPositiveVolume(tmp_path, figures):
    """A J that is not positive, edited into a file"""
    setup = base()
    setup.control.update(writeFormat="ascii", writePrecision=12)
    case = setup.write(tmp_path/"case").prepare()
    path = case.path/"0"/"lagrangian"/"water"/"J"
    lines = path.read_text().splitlines()
    k = lines.index("(") + 4
    lines[k] = "-0.5"
    path.write_text("\n".join(lines) + "\n")
    refused(figures, case.solve(check=False), {
        "file": r"0/lagrangian/water", "keyword": r"\bJ\b",
        "value": r"-0\.5", "point": r"point \d+",
        "allowed": "must be positive"})


def testDefaultsWork(tmp_path, figures):
    """All that has a default left out: the same as with it written"""
    full = base()
    full.fluid.update(gamma=7, soundSpeed="auto")
    full.mpm = {"shapeFunction": "quadraticBSpline", "maxCo": 0.5,
                "smoothing": True, "volumeCorrection": True,
                "overlapCorrection": False, "looseningCorrection": False,
                "sortInterval": 10, "logInterval": 10, "momentum": "explicit",
                "strictKeywords": True}
    full.placement = {"placement": "regular"}
    bare = base()
    bare.fluid = {"gamma": None, "soundSpeed": None}
    bare.water = {"transfer": None}
    bare.mpm = {"shapeFunction": None, "maxCo": None}
    bare.placement = {"placement": None}
    points = []
    for name, setup in [("full", full), ("bare", bare)]:
        case = setup.write(tmp_path/name).prepare()
        case.solve()
        points.append(case.points())
    figures.equal("largest difference of x", float(abs(
        points[0].x - points[1].x).max()), 0)


def testDimensionsGiven(tmp_path, figures):
    """Right dimensions are as good as none"""
    points = []
    for name, entries in [("without", {"rho0": 1000, "mu": 1e-3,
                                       "soundSpeed": 20}),
                          ("with", {"rho0": "[1 -3 0 0 0 0 0] 1000",
                                    "mu": "[1 -1 -1 0 0 0 0] 1e-3",
                                    "soundSpeed": "[0 1 -1 0 0 0 0] 20"})]:
        setup = base()
        setup.fluid = entries
        case = setup.write(tmp_path/name).prepare()
        case.solve()
        points.append(case.points())
    figures.equal("largest difference of x", float(abs(
        points[0].x - points[1].x).max()), 0)
