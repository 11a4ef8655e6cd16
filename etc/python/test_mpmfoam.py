"""Tests of the readers:  $MPMFOAM_PYTHON -m pytest etc/python"""

import numpy as np
import pytest

from mpmfoam import foamFile, metrics, postProcessing, reference, runLog, wave
from mpmfoam.case import Case

HEADER = """/*------------*\\
| a banner (with brackets) |
\\*------------*/
FoamFile
{{
    version     2.0;
    format      {form};
    class       {kind};
    arch        "LSB;label=32;scalar=64";
    location    "0";
    object      x;
}}
// * * * * * //

"""


def write(path, kind, body, form="ascii"):
    if isinstance(body, str):
        body = body.encode()
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(HEADER.format(kind=kind, form=form).encode() + body)
    return path


def binary(values, dtype="<f8"):
    values = np.asarray(values)
    return f"{len(values)}\n(".encode() + values.astype(dtype).tobytes() \
        + b")\n"


@pytest.mark.parametrize("body, expected", [
    ("3\n(\n1\n2.5\n-3e-2\n)\n", [1, 2.5, -0.03]),
    ("2(1 2)", [1, 2]),
    ("4{7}", [7, 7, 7, 7]),
    ("0()", []),
    ("0\n", []),
    ("1(5)", [5]),
])
def testAsciiScalars(tmp_path, body, expected):
    values = foamFile.readList(write(tmp_path/"p", "scalarField", body))
    assert values.tolist() == expected


def testVectors(tmp_path):
    expected = np.arange(12.0).reshape(4, 3)
    rows = "\n".join("({} {} {})".format(*row) for row in expected)
    ascii = write(tmp_path/"a", "vectorField", f"4\n(\n{rows}\n)\n")
    uniform = write(tmp_path/"u", "vectorField", "2{(1 2 3)}")
    raw = write(tmp_path/"b", "vectorField", binary(expected), "binary")
    assert np.array_equal(foamFile.readList(ascii), expected)
    assert np.array_equal(foamFile.readList(raw), expected)
    assert foamFile.readList(uniform).tolist() == [[1, 2, 3], [1, 2, 3]]


def testBinaryLabels(tmp_path):
    path = write(tmp_path/"id", "labelField", binary([3, -1], "<i4"), "binary")
    assert foamFile.readList(path).tolist() == [3, -1]


def testCutShort(tmp_path):
    body = binary(np.arange(10.0))
    with pytest.raises(foamFile.FoamFileError, match="cut short"):
        foamFile.readList(
            write(tmp_path/"b", "scalarField", body[:-20], "binary"))
    with pytest.raises(foamFile.FoamFileError, match="cut short"):
        foamFile.readList(write(tmp_path/"a", "scalarField", "3\n(1 2"))
    with pytest.raises(foamFile.FoamFileError, match="2 of 3"):
        foamFile.readList(write(tmp_path/"c", "scalarField", "3(1 2)"))


def testInternalField(tmp_path):
    uniform = write(tmp_path/"u", "volVectorField",
                    "internalField   uniform (1 0 2);\nboundaryField {}")
    raw = write(tmp_path/"n", "volScalarField",
                b"internalField   nonuniform List<scalar> \n"
                + binary([1.0, 2.0]) + b";\nboundaryField {}", "binary")
    assert foamFile.readInternalField(uniform, 2).tolist() == [[1, 0, 2]]*2
    assert foamFile.readInternalField(raw, 2).tolist() == [1, 2]
    with pytest.raises(foamFile.FoamFileError, match="mesh of 3"):
        foamFile.readInternalField(raw, 3)


def testCaseJoinsProcessors(tmp_path):
    write(tmp_path/"system"/"controlDict", "dictionary", "")
    for i in [0, 1, 10, 2]:
        write(tmp_path/f"processor{i}"/"0.5"/"lagrangian"/"water"/"p",
              "scalarField", f"1({i})")
    case = Case(tmp_path)
    assert case.times() == ["0.5"]
    assert case.nearestTime(0.4) == "0.5"
    assert case.cloudField("0.5", "water", "p").tolist() == [0, 1, 2, 10]
    with pytest.raises(FileNotFoundError):
        case.cloudField("0.5", "water", "U")


def testCloudOfProcessorsBesideZero(tmp_path):
    """0 of the case holds fields, but the points are with the processors"""
    write(tmp_path/"system"/"controlDict", "dictionary", "")
    write(tmp_path/"0"/"U.water", "volVectorField", "")
    for i in range(2):
        write(tmp_path/f"processor{i}"/"0"/"lagrangian"/"water"/"p",
              "scalarField", f"1({i})")
    case = Case(tmp_path)
    assert case.hasCloud("0", "water") and not case.hasCloud("0", "soil")
    assert case.cloudField("0", "water", "p").tolist() == [0, 1]


def testDatOfRestart(tmp_path):
    first = tmp_path/"postProcessing"/"front"/"0"/"front.dat"
    second = tmp_path/"postProcessing"/"front"/"0.2"/"front.dat"
    for path in [first, second]:
        path.parent.mkdir(parents=True)
    first.write_text("# time x\n0 (1 2)\n0.1 (3 4)\n0.2 (0 0)\n0.3 (0")
    second.write_text("# time x\n0.2 (5 6)\n")
    rows = postProcessing.readDat(tmp_path, "front", "front.dat")
    assert rows.tolist() == [[0, 1, 2], [0.1, 3, 4], [0.2, 5, 6]]
    # The same time, but for its last digit
    second.write_text("# time x\n0.10000000000000002 (5 6)\n")
    rows = postProcessing.readDat(tmp_path, "front", "front.dat")
    assert rows[:, 1].tolist() == [1, 5]
    second.write_text("# time x y\n0.2 5 6\n")
    columns = postProcessing.readColumns(tmp_path, "front", "front.dat")
    assert list(columns) == ["time", "x", "y"]
    assert columns["y"].tolist() == [2, 4, 6]


def testLog(tmp_path):
    path = tmp_path/"log.mpmFoam"
    path.write_text(
        "Courant Number mean: 0.1 max: 0.4\n"
        "deltaT = 0.001 limiter: water sound step: 1\n"
        "water: points 9, max speed 1 m/s, left through openings 5, put back from"
        " walls 3\n"
        "soil: points 4, max speed 0.1 m/s, left through openings 2\n"
        "Time = 0.001\n\n"
        "ExecutionTime = 0.5 s  ClockTime = 1 s\n\n"
        "Courant Number mean: 0.1 max: 0.3\n"
        "deltaT = 0.0005 limiter: advection\nTime = 0.0015\n"
        "deltaT = 0.002 limiter: water sound\nTime = 0.0035\n"
        "ExecutionTime = 0.9 s  ClockTime = 2 s\n"
        "Steps: 3  points: 100  ns per point and step: 41.5\nEnd\n")
    log = runLog.readLog(path)
    assert log.finished
    assert (log.stepCount, log.points, log.nsPerPointStep) == (3, 100, 41.5)
    assert (log.cpuTime, log.wallTime, log.time) == (0.9, 2, 0.0035)
    assert log.dtLimiter == "water sound"
    assert (log.deltaTMin, log.deltaTMax) == (0.0005, 0.002)
    assert log.courantMax == 0.4
    assert (log.wallContacts, log.left) == (3, 7)
    assert log.leftOf == {"water": 5, "soil": 2}


def testMetrics(tmp_path):
    path = tmp_path/"metrics.json"
    metrics.writeMetrics(path, {"a": np.float64(1/3), "n": 2, "none": None,
                                "dtLimiter": "advection"})
    assert metrics.readMetrics(path) == {
        "a": 0.33333333, "n": 2, "dtLimiter": "advection"}
    with pytest.raises(ValueError):
        metrics.writeMetrics(path, {"a": float("nan")})
    with pytest.raises(TypeError):
        metrics.writeMetrics(path, {"a": [1, 2]})


def testCsv(tmp_path):
    path = tmp_path/"a.csv"
    reference.writeCsv(path, {"name": ["x", "y"], "v": [1.5, 2.0]}, "a\nb")
    columns = reference.readCsv(path)
    assert path.read_text().startswith("# a\n# b\nname,v\n")
    assert columns["name"] == ["x", "y"]
    assert columns["v"].tolist() == [1.5, 2]


def testWaveFit():
    omega = wave.omegaLinear(1, 0.5)
    exact = reference.data("ana_standing_wave_periods.csv")["omega"][0]
    assert omega == pytest.approx(exact, rel=1e-6)
    t = np.arange(0, 6, 0.01)
    a = 0.01*np.exp(-0.05*t)*np.cos(1.01*omega*t + 0.1) + 1e-4
    w, rate, start, rest = wave.fit(t, a, omega)
    assert w == pytest.approx(1.01*omega, rel=1e-6)
    assert rate == pytest.approx(0.05, rel=1e-4)
    assert start == pytest.approx(0.01, rel=1e-4)
    assert rest < 1e-6
    x = (np.arange(20) + 0.5)/20
    heights = 0.5 + 0.01*np.cos(np.pi*x) + 0.02*np.cos(2*np.pi*x)
    assert wave.modeAmplitude(heights[None], x, 1) == pytest.approx(0.01)
