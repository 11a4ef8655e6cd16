"""The annotated dictionaries: complete, true about defaults, and accepted."""

import itertools
import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
ANNOTATED = ROOT/"etc"/"caseDicts"/"annotated"

# Where the keywords of a source file are explained; the longest path counts
EXPLAINED_IN = {
    "src/interaction/materialPointSystem": "fvSolution",
    "src/interaction/dragModel": "materialPointProperties",
    "src/interaction/bedLoadModel": "materialPointProperties",
    "src/interaction/erosionCriterion": "controlDict",
    "src/interaction/movingFrame": "materialPointProperties",
    "src/interaction/phasePair": "materialPointProperties",
    "src/interaction/relaxationZone": "materialPointProperties",
    "src/interaction/waterSoilInteraction": "materialPointProperties",
    "src/backgroundGrid/backgroundGrid": "fvSolution",
    "src/bodies": "materialPointProperties",
    "src/rigidBodies": "materialPointProperties",
    "src/bodies/closedSurface": "setMaterialPointsDict",
    "src/backgroundGrid/nodeBoundary": "U.water",
    "src/materialPoint/waterCloud": "materialPointProperties",
    "src/materialPoint/soilCloud": "materialPointProperties",
    "src/materialPoint/transfer": "materialPointProperties",
    "src/materialPoint/turbulence": "materialPointProperties",
    "src/materialPoint/viscosity": "materialPointProperties",
    "src/materialPoint/inflowOutflow": "materialPointProperties",
    "src/constitutive": "materialPointProperties",
    "src/constitutive/soilModel": "soilModels",
    "src/constitutive/granularElasticity": "soilModels",
    "src/constitutive/criticalState": "soilModels",
    "src/constitutive/muIRheology": "soilModels",
    "src/constitutive/denseSuspension": "soilModels",
    "src/constitutive/elementTest": "soilElementTestDict",
    "applications/utilities/soilElementTest": "soilElementTestDict",
    "src/materialPoint/pointRegion": "setMaterialPointsDict",
    "src/interaction/placement": "setMaterialPointsDict",
    "src/materialPoint/IO": "controlDict",
    "src/functionObjects": "controlDict",
}

# Of Foam::functionObject: explained by OpenFOAM
FUNCTION_OBJECT = re.compile(
    r"functionObjectLibs|region|enabled|errors|time(Start|End)"
    r"|trigger(Start|End)|controlMode|deltaTCoeff|nStepsToStartTimeChange"
    r"|execute(Control|Interval)|output(Control|Interval)|writeToFile"
    r"|useUserTime|useNamePrefix|updateHeader")


def sources():
    for path in itertools.chain((ROOT/"src").rglob("*.C"),
                                (ROOT/"applications").rglob("*.C")):
        if "lnInclude" not in path.parts:
            yield path.relative_to(ROOT).as_posix(), path.read_text()


def dictionaryOf(source):
    known = [p for p in EXPLAINED_IN if source.startswith(p)]
    return EXPLAINED_IN[max(known, key=len)] if known else None


def explained(name):
    return (ANNOTATED/name).read_text()


def keywords(text):
    """Words in the lists that a source hands to checkKeywords"""
    lists = re.findall(r"(?:checkKeywords|keywords|wordList all|wordList known)"
                       r"\s*\(([^;]*?\{[^;]*?\})", text)
    lists += re.findall(r"keywords\(\) const\s*\{([^}]*\})", text)
    lists += re.findall(r"HashTable<wordList> \w+\s*\(([^;]*)\);", text)
    for body in lists:
        yield from re.findall(r'"(\w+)"', body)


def cases(find):
    """(source, word) of all that find() sees in a source, with its name"""
    for source, text in sources():
        for item in sorted(set(find(text))):
            yield pytest.param(source, item, id=f"{Path(source).stem}-{item}")


def ownKeywords(text):
    return (k for k in keywords(text) if not FUNCTION_OBJECT.fullmatch(k))


def optional(text):
    """(keyword, default) where the default stands in the source as a literal"""
    found = re.findall(
        r'readBoundedOrDefault\s*\(\s*\w+,\s*"(\w+)",[^,]*,\s*([-\d.e]+),', text)
    found += re.findall(
        r'readChoiceOrDefault\s*\(\s*[\w.]+,\s*"(\w+)",\s*"(\w+)"', text)
    found += [(k, "yes" if v == "true" else "no") for k, v in re.findall(
        r'lookupOrDefault<Switch>\(\s*"(\w+)",\s*(true|false)\s*\)', text)]
    return found


@pytest.mark.parametrize("source, keyword", cases(ownKeywords))
def testExplained(source, keyword):
    name = dictionaryOf(source)
    assert name, f"{source} checks keywords: name its dictionary above"
    # <model>Coeffs
    word = r"\w+Coeffs" if keyword == "Coeffs" else keyword
    assert re.search(rf"\b{word}\b", explained(name)), \
        f"{source} reads {keyword}; {name} does not explain it"


def testKeywordsAreFound():
    """The search above sees what it should"""
    found = {k for _, text in sources() for k in keywords(text)}
    assert {"rho0", "shapeFunction", "transfer", "jitter", "min", "points",
            "minFraction", "level", "apicRate"} <= found


@pytest.mark.parametrize("source, entry", cases(optional))
def testDefault(source, entry):
    """An entry, commented out or not, shows its default, or the comment above
    it says so"""
    keyword, default = entry
    # Some are read from another dictionary than their neighbours
    text = explained(dictionaryOf(source)) + "".join(
        explained(p.name) for p in sorted(ANNOTATED.iterdir()))
    comment, value = re.search(
        rf"((?:^ *//.*\n)*)^ *(?:// *)?{keyword} +(\S+);", text,
        re.M).groups()
    assert value == default or re.search(rf"Default:? {default}\b", comment)


@pytest.mark.parametrize("family, base, name", [
    ("src/materialPoint/transfer", "transferScheme", "materialPointProperties"),
    ("src/materialPoint/turbulence", "turbulenceModel",
     "materialPointProperties"),
    ("src/materialPoint/viscosity", "viscosityModel",
     "materialPointProperties"),
    ("src/materialPoint/pointRegion", "pointRegion", "setMaterialPointsDict"),
    ("src/interaction/placement/initialStress", "initialStress",
     "setMaterialPointsDict"),
    ("src/interaction/placement/initialPressure", "initialPressure",
     "setMaterialPointsDict"),
    ("src/interaction/dragModel", "dragModel", "materialPointProperties"),
    ("src/bodies/bodyMotion", "bodyMotion", "materialPointProperties"),
    ("src/interaction/bedLoadModel", "bedLoadModel",
     "materialPointProperties"),
    ("src/materialPoint/inflowOutflow/outlet", "outlet",
     "materialPointProperties"),
    ("src/interaction/erosionCriterion", "erosionCriterion", "controlDict"),
])
def testModels(family, base, name):
    models = [d.name for d in (ROOT/family).iterdir() if d.is_dir()]
    assert len(models) > 2
    for model in models:
        # The word none is no C++ class name; Ergun and twoEquation are what
        # others have in common, searchable are the shapes of OpenFOAM
        word = {"noDrag": "none", "noBedLoad": "none", "Ergun": base,
                "twoEquation": base,
                "searchable": "sphere",
                "wallDistance": "roughWall"}.get(model, model)
        if model != base and word != base:
            assert re.search(rf"\b{word}\b", explained(name)), model


@pytest.mark.parametrize("kind", ["slip", "fixed", "open"])
def testPatchTypes(kind):
    text = (ROOT/"src/backgroundGrid/nodeBoundary/patchTypes.C").read_text()
    body = re.search(rf"patchTypes::{kind}\s*\(\{{([^}}]*)\}}\)", text)[1]
    for patchType in re.findall(r'"(\w+)"', body):
        ofSoil = patchType in ("frictional", "constrainedWall")
        name = "U.soil" if ofSoil else "U.water"
        assert f"type            {patchType};" in explained(name)


# --- a case made of nothing else ------------------------------------------

HEADER = """FoamFile
{{
    version 2.0;
    format ascii;
    class {};
    object {};
}}
"""


def write(path, text, kind="dictionary"):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(HEADER.format(kind, path.name) + text)


def blockMeshDict():
    """Tank of 2 x 1 m, h = 0.05 m: a patch for each type of U.water, and the
    cellZone pool"""
    bottom = ["smoothWall", "symmetryPlane", "symmetry", "roughWall",
              "slidingWall"]
    top = ["atmosphere"]*2 + ["outlet"]*2 + ["inlet"]
    faces = {name: [] for name in bottom + top
             + ["left", "right", "frontAndBack"]}
    types = {"symmetryPlane": "symmetryPlane", "symmetry": "symmetry",
             "roughWall": "wall", "slidingWall": "wall", "smoothWall": "wall",
             "frontAndBack": "empty",
             "left": "cyclic; neighbourPatch right",
             "right": "cyclic; neighbourPatch left"}

    def vertex(i, j, k):
        return i + 6*(j + 3*k)

    blocks = ""
    for i, j in itertools.product(range(5), range(2)):
        corners = [vertex(i + a, j + b, k) for k in (0, 1)
                   for a, b in [(0, 0), (1, 0), (1, 1), (0, 1)]]
        zone = "pool" if (i, j) == (0, 1) else ""
        blocks += (f"hex ({' '.join(map(str, corners))}) {zone}"
                   f" (8 {16 if j == 0 else 4} 1) simpleGrading (1 1 1)\n")
        c = corners
        faces["frontAndBack"] += [[c[0], c[3], c[2], c[1]],
                                  [c[4], c[5], c[6], c[7]]]
        if i == 0:
            faces["left"].append([c[0], c[4], c[7], c[3]])
        if i == 4:
            faces["right"].append([c[1], c[2], c[6], c[5]])
        if j == 0:
            faces[bottom[i]].append([c[0], c[1], c[5], c[4]])
        if j == 1:
            faces[top[i]].append([c[3], c[7], c[6], c[2]])

    def text(lists):
        return " ".join(f"({' '.join(map(str, row))})" for row in lists)

    vertices = text((0.4*i, y, z) for z in (0, 0.05) for y in (0, 0.8, 1)
                    for i in range(6))
    patches = "".join(
        f"{name} {{ type {types.get(name, 'patch')}; faces ({text(rows)}); }}\n"
        for name, rows in faces.items())
    return (f"scale 1;\nvertices ({vertices});\nblocks ({blocks});\n"
            f"boundary (\n{patches});\n")


def stlBox(lower, upper):
    corner = list(itertools.product(*zip(lower, upper)))
    sides = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6),
             (0, 2, 6, 4), (1, 5, 7, 3)]
    text = "solid body\n"
    for a, b, c, d in sides:
        for triangle in [(a, b, c), (a, c, d)]:
            text += "facet normal 0 0 0\nouter loop\n"
            text += "".join("vertex {} {} {}\n".format(*corner[v])
                            for v in triangle)
            text += "endloop\nendfacet\n"
    return text + "endsolid body\n"


def run(case, *command):
    result = subprocess.run(command, cwd=case, capture_output=True, text=True,
                            timeout=300, env={**os.environ, "PWD": str(case)})
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    return result.stdout


@pytest.mark.parametrize("name", sorted(p.name for p in ANNOTATED.iterdir()))
def testParses(name):
    run(ROOT, "foamDictionary", str(ANNOTATED/name))


def testAccepted(tmp_path):
    for name, place in [("materialPointProperties", "constant"),
                        ("setMaterialPointsDict", "system"),
                        ("fvSolution", "system"), ("controlDict", "system"),
                        ("U.water", "0"), ("U.soil", "0")]:
        (tmp_path/place).mkdir(exist_ok=True)
        shutil.copy(ANNOTATED/name, tmp_path/place)
    write(tmp_path/"constant/g",
          "dimensions [0 1 -2 0 0 0 0];\nvalue (0 -9.81 0);\n",
          "uniformDimensionedVectorField")
    write(tmp_path/"system/fvSchemes", "".join(
        f"{kind}Schemes {{}}\n" for kind in
        ["ddt", "grad", "div", "laplacian", "interpolation", "snGrad"]))
    write(tmp_path/"system/blockMeshDict", blockMeshDict())
    (tmp_path/"constant/triSurface").mkdir()
    (tmp_path/"constant/triSurface/body.stl").write_text(
        stlBox((0.5, 0.6, -1), (0.8, 0.8, 1)))

    run(tmp_path, "blockMesh")
    text = run(tmp_path, "setMaterialPoints")
    for region in ["reservoir", "dam", "drop", "body", "pool", "bed"]:
        assert re.search(rf"region {region}: [1-9]\d* points", text)

    run(tmp_path, "foamDictionary", "system/controlDict",
        "-entry", "endTime", "-set", "0.02")
    text = run(tmp_path, "mpmFoam")
    assert text.rstrip().endswith("End")
    assert "unknown keyword" not in text
    for output in ["energy/0/energy.dat", "front/0/front.dat",
                   "gauge/0/waveGauge.dat", "balance/0/massBalance.dat",
                   "scour/0/scourProfile.dat", "scour/0/profile.csv",
                   "pressure/0/p", "erosion/0/erosionCriteria.dat",
                   "erosion/0/velocityProfiles.csv",
                   "materialPointHDF5/soil.h5",
                   "materialPointHDF5/soil.xdmf"]:
        assert (tmp_path/"postProcessing"/output).stat().st_size > 0
