"""Ranks: any number of them, however the mesh is cut, computes what one
does."""

import re
import shutil

import numpy as np
import pytest

from mpmfoam import foamFile

from caseBuilder import RHO, Setup, box, damBreak

STEPS = 100
BOUND = 1e-10


def differences(points, reference):
    """Largest difference over largest value, points matched by id"""
    assert np.array_equal(points.id, reference.id)
    out = {}
    for name in ["x", "U", "J", "mass"]:
        a, b = getattr(points, name), getattr(reference, name)
        assert np.all(np.isfinite(a))
        out[name] = float(np.abs(a - b).max()/max(np.abs(b).max(), 1e-300))
    return out


def agree(figures, case, serial, bound=BOUND):
    names = [c.timesByStep() for c in (case, serial)]
    last = max(names[1])
    figures.equal("last step", max(names[0]), last)
    for name, value in differences(case.points(names[0][last]),
                                   serial.points(names[1][last])).items():
        figures.atMost(f"{name}: relative difference", value, bound)


def withObstacle(dim, **entries):
    """Water that collapses around an obstacle across the middle of the mesh,
    where most decompositions have a boundary between ranks"""
    if dim == 2:
        setup = damBreak(dim, width=0.3, height=0.26, points=3, **entries)
        setup.solid = [((11, 0), (14, 3))]
    else:
        setup = damBreak(dim, h=0.025, width=0.3, height=0.25, points=2,
                         **entries)
        setup.solid = [((9, 3, 0), (12, 6, 3))]
    return setup.steps(STEPS)


def drop(**entries):
    """Water that crosses both cyclic ends of a box without gravity"""
    return Setup(
        cells=(12, 10), h=0.02, g=(0, 0, 0), fluid={"soundSpeed": 10},
        regions={"drop": {
            "type": "cylinder", "point1": (0.19, 0.16, -1),
            "point2": (0.19, 0.16, 1), "radius": 0.03,
            "velocity": (1, 0.5, 0)},
            "rest": box((0.02, 0.02), (0.1, 0.12))},
        **entries).cyclic("x", "y").steps(STEPS)


def ragged(centres, size):
    """A wavy boundary across the middle, with teeth of one cell"""
    x, y = centres[:, 0]/size[0], centres[:, 1]/size[1]
    rank = (x + 0.1*np.sin(9*y) > 0.5).astype(int)
    teeth = (np.abs(x + 0.1*np.sin(9*y) - 0.5) < 0.06) & (
        np.arange(len(x)) % 3 == 0)
    rank[teeth] = 1 - rank[teeth]
    return rank


def scattered(ranks):
    """Each cell on any rank: the worst that a decomposition can be"""
    def scatter(centres, size):
        return np.random.default_rng(1).integers(0, ranks, len(centres))
    scatter.__name__ = f"scattered{ranks}"
    return scatter


def decompose(case, how):
    """how: parts per direction, or a function for the rank of each cell"""
    if callable(how):
        size = np.subtract(*case.setup.bounds[::-1])
        rank = how(case.case.cellCentres("0"), size)
        case.decompose(int(rank.max()) + 1, cellRank=rank)
    else:
        case.decompose(int(np.prod(how)), n=how)
    counts = [len(foamFile.readList(path)) for path in sorted(
        case.path.glob("processor*/0/lagrangian/water/id"))]
    if counts:
        print("points on each rank", counts)
        assert sum(n > 0 for n in counts) > 1
    return len(case.case.processors)


def name(how):
    return how.__name__ if callable(how) else "x".join(map(str, how))


@pytest.fixture(scope="module")
def serial(tmp_path_factory):
    """Serial runs, each made once: (key, setup) -> case"""
    done = {}

    def get(key, makeSetup):
        if key not in done:
            path = tmp_path_factory.mktemp("serial")/"case"
            case = makeSetup().write(path).prepare()
            start = case.clone(path.parent/"start")
            case.solve()
            done[key] = start, case
        return done[key]
    return get


@pytest.mark.parametrize("how", [
    (2, 1, 1), (1, 2, 1), ragged, scattered(2), (3, 1, 1), scattered(3),
    (2, 2, 1), (4, 1, 1)], ids=name)
def testEqualsSerial2D(tmp_path, figures, serial, how):
    start, whole = serial(2, lambda: withObstacle(2))
    case = start.clone(tmp_path/"case")
    ranks = decompose(case, how)
    case.solve(ranks=ranks)
    agree(figures, case, whole)


@pytest.mark.parametrize("how", [(2, 1, 1), ragged, (1, 2, 2)], ids=name)
def testEqualsSerial3D(tmp_path, figures, serial, how):
    start, whole = serial(3, lambda: withObstacle(3))
    case = start.clone(tmp_path/"case")
    ranks = decompose(case, how)
    case.solve(ranks=ranks)
    agree(figures, case, whole)


@pytest.mark.parametrize("shape", ["linear", "cubicBSpline"])
@pytest.mark.parametrize("transfer", ["FLIP", "XPIC"])
def testSchemesEqualSerial(tmp_path, figures, transfer, shape):
    setup = withObstacle(2, water={"transfer": transfer},
                         mpm={"shapeFunction": shape})
    whole = setup.write(tmp_path/"serial").prepare()
    case = whole.clone(tmp_path/"parallel")
    whole.solve()
    decompose(case, ragged)
    case.solve(ranks=2)
    agree(figures, case, whole)


def testNoSlipEqualsSerial(tmp_path, figures):
    setup = withObstacle(2, wall="noSlip", fluid={"mu": 1})
    whole = setup.write(tmp_path/"serial").prepare()
    case = whole.clone(tmp_path/"parallel")
    whole.solve()
    decompose(case, ragged)
    case.solve(ranks=2)
    agree(figures, case, whole)


@pytest.mark.parametrize("how", [
    (2, 1, 1), (1, 2, 1), ragged, scattered(2), (3, 1, 1), (2, 2, 1)],
    ids=name)
def testCyclicEqualsSerial(tmp_path, figures, serial, how):
    start, whole = serial("cyclic", drop)
    case = start.clone(tmp_path/"case")
    ranks = decompose(case, how)
    case.solve(ranks=ranks)
    agree(figures, case, whole)


@pytest.mark.parametrize("dim", [2, 3])
@pytest.mark.parametrize("how", [(2, 1, 1), ragged, (2, 1, 2)], ids=name)
def testSetMaterialPointsInParallel(tmp_path, figures, dim, how):
    """Decomposed before it has points: the same points as in serial"""
    setup = withObstacle(dim, placement={"placement": "jittered"})
    if dim == 2 and how == (2, 1, 2):
        how = (2, 2, 1)
    whole = setup.write(tmp_path/"serial").prepare()
    case = setup.write(tmp_path/"parallel")
    case.run("blockMesh")
    ranks = decompose(case, how)
    case.run("setMaterialPoints", ranks=ranks)

    a, b = case.points("0"), whole.points("0")
    figures.equal("points", len(a.id), len(b.id))
    figures.holds("same positions, bit for bit", np.array_equal(a.x, b.x))
    for field in ["J", "mass"]:
        u, v = getattr(a, field), getattr(b, field)
        figures.atMost(f"{field}: relative difference",
                       np.abs(u/v - 1).max(), 1e-15)
    states = [c.state("0") for c in (case, whole)]
    for key in ["nPoints", "soundSpeed"]:
        figures.equal(key, states[0][key], states[1][key])


def testDecomposeRunReconstruct(tmp_path, figures):
    """Count, mass and momentum through decomposePar and reconstructPar"""
    case = withObstacle(2).write(tmp_path/"case").prepare()
    start = case.points("0")
    decompose(case, ragged)
    case.solve(ranks=2)
    parallel = case.points()
    last = case.times[-1]
    case.run("reconstructPar")
    shutil.rmtree(case.path/"processor0")
    shutil.rmtree(case.path/"processor1")

    points = case.points(last)
    figures.equal("points", len(points.id), len(start.id))
    figures.equal("mass of each point kept",
                  np.abs(points.mass - start.mass).max(), 0)
    for field in ["x", "U", "J"]:
        figures.equal(f"{field}: largest change by reconstructPar", np.abs(
            getattr(points, field) - getattr(parallel, field)).max(), 0)
    scale = (points.mass[:, None]*np.abs(points.U)).sum()
    figures.atMost("momentum: change over sum of m |U|", np.abs(
        points.momentum - parallel.momentum).max()/scale, 1e-15)


def testThereAndBack(tmp_path, figures):
    """Serial, parallel, serial again: the run goes on where it was"""
    setup = withObstacle(2).steps(40)
    whole = setup.write(tmp_path/"serial").prepare()
    case = whole.clone(tmp_path/"case")
    for _ in range(3):
        whole.solve()

    case.solve()
    first = case.times[-1]
    rank = ragged(case.case.cellCentres("0"), (0.5, 0.4))
    case.decompose(2, cellRank=rank, times=first)
    case.solve(ranks=2)
    case.run("reconstructPar", "-latestTime")
    for i in range(2):
        shutil.rmtree(case.path/f"processor{i}")
    case.solve()
    figures.equal("steps", max(case.timesByStep()), 120)
    agree(figures, case, whole)


def testSlidesIntoAnotherRank(tmp_path, figures):
    """A point beside a step that meets the step and comes to another rank in
    one step goes on along the wall, as it does in serial"""
    h, dt = 0.1, 0.01
    speed = (4.5, 1.5)
    setup = Setup(
        cells=(8, 6), h=h, solid=[((4, 0), (8, 4))], points=16, g=(0, 0, 0),
        energy=False, fluid={"soundSpeed": 1},
        regions={"point": box((3.95*h, 2.95*h), (4*h, 3*h),
                              velocity=(*speed, 0))},
        control={"deltaT": dt, "adjustTimeStep": False}).steps(1)
    whole = setup.write(tmp_path/"serial").prepare()
    figures.equal("points", len(whole.points("0").id), 1)
    case = whole.clone(tmp_path/"parallel")
    whole.solve()
    rank = (case.case.cellCentres("0")[:, 1] > 3*h).astype(int)
    case.decompose(2, cellRank=rank)
    case.solve(ranks=2)

    serial, parallel = whole.points().x[0], case.points().x[0]
    figures.atMost("gap to the wall over h, serial",
                   abs(serial[0]/h - 4), 1e-8)
    figures.atLeast("height over h, serial", serial[1]/h, 3.02)
    figures.atMost("parallel and serial: distance over h",
                   np.abs(parallel - serial)[:2].max()/h, 1e-12)
    for c, name in [(whole, "serial"), (case, "parallel")]:
        figures.equal(f"put back from walls, {name}",
                      int(c.state()["wallContacts"]), 1)


@pytest.mark.parametrize("ranks", [3, 4])
def testWrongNumberOfRanks(tmp_path, figures, ranks):
    """Processor directories of another decomposition are refused"""
    case = damBreak().steps(10).write(tmp_path/"case").prepare()
    case.decompose(2)
    result = case.solve(ranks=ranks, check=False)
    figures.holds("status is not 0", result.status != 0, result.status)
    for what, text in [("directories found", "2"), ("ranks", str(ranks))]:
        lines = [line for line in result.text.splitlines()
                 if "processor" in line.lower() and text in line]
        figures.holds(f"message names the {what}", lines,
                      lines[0].strip() if lines else "")


def testFewerRanksThanParts(tmp_path, figures):
    """Two ranks on a case cut into four: points of two parts would be lost"""
    case = damBreak().steps(10).write(tmp_path/"case").prepare()
    case.decompose(4, n=(2, 2, 1))
    result = case.solve(ranks=2, check=False)
    figures.holds("status is not 0", result.status != 0, result.status)
    figures.holds("message names both numbers",
                  "4" in result.text and "2" in result.text
                  and "processor" in result.text)


@pytest.mark.parametrize("how", [(1, 2, 1), (2, 1, 1), ragged], ids=name)
def testFieldsEqualSerial(tmp_path, figures, how):
    """Fields on the mesh, where a surface lies at the margin of a rank"""
    setup = Setup(
        cells=(16, 16), h=0.02, points=3,
        regions={"water": box((0, 0), (0.32, 0.1599)),
                 "drop": box((0.06, 0.25), (0.1, 0.3), velocity=(1, 0, 0))},
    ).steps(7)
    whole = setup.write(tmp_path/"serial").prepare()
    case = whole.clone(tmp_path/"parallel")
    whole.solve()
    decompose(case, how)
    case.solve(ranks=2)
    case.run("reconstructPar")
    last = whole.times[-1]
    for field in ["alpha.water", "p", "U.water"]:
        serial, parallel = (np.asarray(c.case.field(c.times[-1], field))
                            for c in [whole, case])
        figures.atMost(f"{field}: difference over the largest value",
                       np.abs(serial - parallel).max()/np.abs(serial).max(),
                       BOUND)
    figures.atMost("volume in the cells over that of the water, difference",
                   abs(whole.case.field(last, "alpha.water").sum()*0.02**3
                       / (whole.points(last).mass/RHO).sum() - 1), 0.01)


def testOnlyOneRankHasBoth(tmp_path, figures):
    """Water and soil never meet on one of the ranks; the table of costs
    has what each of them did"""
    case = Setup(
        cells=(40, 10), h=0.01, points=2, energy=False,
        regions={"water": box((0, 0), (0.1, 0.05)),
                 "pores": box((0.3, 0), (0.4, 0.05))},
        soilRegions={"bed": box((0.3, 0), (0.4, 0.05), stress="geostatic")},
    ).steps(20).write(tmp_path/"case").prepare().decompose(3, n=(3, 1, 1))
    text = case.solve(ranks=3).text
    for part in ["pore pressure", "water: particle-to-grid", "total"]:
        figures.contains("table of costs", re.search(
            rf"{part} +[0-9.]+", text), part)
