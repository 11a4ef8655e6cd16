"""Points over time in HDF5, one series per cloud: against the lagrangian files,
on two ranks, over restarts and kills, and as ParaView sees them."""

import json
import os
import re
import subprocess
from pathlib import Path

import h5py
import numpy as np
import pytest

from caseBuilder import Setup, box, damBreak, hydrostatic
from test_badInput import CONTROL, refused, words
from test_paraview import needsParaView

HERE = Path(__file__).resolve().parent
LIBS = '("libmpmFunctionObjects.so")'
GEOMETRY = {"positions", "coordinates"}


def history(cloud="water", **entries):
    return {"type": "materialPointHDF5", "libs": LIBS, "cloud": cloud,
            "writeControl": "writeTime", **entries}


def scene(**entries):
    """Water that runs against a saturated bed"""
    functions = {cloud: history(cloud, log=True) for cloud in ["water", "soil"]}
    return Setup(
        cells=(20, 10), h=0.02, points=2, energy=False,
        regions={"column": hydrostatic((0, 0), (0.12, 0.14)),
                 "pores": hydrostatic((0.2, 0), (0.4, 0.06))},
        soilRegions={"bed": box((0.2, 0), (0.4, 0.06), stress="geostatic")},
        functions=functions, **entries)


def path(case, cloud="water", suffix="h5"):
    return (case.path/"postProcessing"/"materialPointHDF5"
            / f"{cloud}.{suffix}")


def read(case, cloud="water"):
    """All of a file: (step, time, {field: values}) by time"""
    with h5py.File(path(case, cloud), "r") as file:
        return [(int(group.attrs["step"]), float(group.attrs["time"]),
                 {name: values[:] for name, values in group.items()})
                for group in (file[name] for name in sorted(file))]


def largestDifference(a, b):
    """Of two times, relative to the largest value of each field"""
    assert sorted(a) == sorted(b)
    worst = 0.0
    for name in a:
        if a[name].shape != b[name].shape:
            return np.inf
        if a[name].size:
            scale = np.abs(a[name]).max() or 1
            worst = max(worst, np.abs(a[name] - b[name]).max()/scale)
    return worst


def equalTimes(figures, what, found, expected):
    figures.equal(f"{what}: steps", [t[0] for t in found],
                  [t[0] for t in expected])
    figures.equal(f"{what}: times", [t[1] for t in found],
                  [t[1] for t in expected])
    figures.equal(f"{what}: largest relative difference of any value",
                  max(largestDifference(a[2], b[2])
                      for a, b in zip(found, expected)), 0)


@pytest.fixture(scope="module")
def run(tmp_path_factory):
    case = scene().until(0.05, write=0.01).write(
        tmp_path_factory.mktemp("hdf5")/"case").prepare()
    case.solve()
    return case


@pytest.mark.parametrize("cloud", ["water", "soil"])
def testValues(run, figures, cloud):
    """All fields of the lagrangian files, to the last bit"""
    found = read(run, cloud)
    figures.equal("times", len(found), len(run.times))
    for (_, time, fields), name in zip(found, run.times):
        files = {p.name for p in
                 (run.path/name/"lagrangian"/cloud).iterdir()} - GEOMETRY
        figures.equal(f"{name} s: fields", sorted(fields), sorted(files))
        figures.equal(f"{name} s: time", time, run.timeValue(name)
                      if name != "0" else 0)
        order = np.argsort(run.case.cloudField(name, cloud, "id"),
                           kind="stable")
        figures.equal(f"{name} s: fields with other values", [
            f for f in sorted(files) if not np.array_equal(
                fields[f],
                run.case.cloudField(name, cloud, f)[order])], [])
    with h5py.File(path(run, cloud), "r") as file:
        figures.equal("cloud", file.attrs["cloud"].decode(), cloud)
        figures.equal("filters of x", [
            file["000001/x"].compression, file["000001/x"].compression_opts,
            file["000001/x"].shuffle], ["gzip", 1, True])


def testTwoRanks(tmp_path, figures):
    cases = [scene().steps(80).write(tmp_path/name).prepare()
             for name in ["serial", "parallel"]]
    cases[1].decompose(2)
    for case, ranks in zip(cases, [1, 2]):
        case.solve(ranks=ranks)
    for cloud in ["water", "soil"]:
        a, b = (read(case, cloud) for case in cases)
        figures.equal(f"{cloud}: steps", [t[0] for t in a],
                      [t[0] for t in b])
        figures.equal(f"{cloud}: ids that differ", int(np.sum(
            a[-1][2]["id"] != b[-1][2]["id"])), 0)
        figures.equal(f"{cloud}: difference at the start",
                      largestDifference(a[0][2], b[0][2]), 0)
        for name in ["x", "U", "mass"]:
            figures.atMost(f"{cloud}, {name}: difference at the end",
                           largestDifference({name: a[-1][2][name]},
                                             {name: b[-1][2][name]}), 1e-10)


def testOverRestarts(run, tmp_path, figures):
    """A run in two parts; then from the middle once more"""
    case = scene().until(0.03, write=0.01).write(tmp_path/"case").prepare()
    case.solve()
    case.change(control={"endTime": 0.05})
    case.solve()
    for cloud in ["water", "soil"]:
        equalTimes(figures, cloud, read(case, cloud), read(run, cloud))

    # The scene changed: what comes later is replaced
    case.change(control={"startFrom": "startTime", "startTime": 0.02,
                         "endTime": 0.03},
                functions={"water": {"fields": "(U p)"}})
    case.solve()
    again, whole = read(case), read(run)
    figures.equal("times after a start at 0.02 s",
                  [round(t[1], 6) for t in again], [0, 0.01, 0.02, 0.03])
    figures.equal("fields before", sorted(again[1][2]), sorted(whole[1][2]))
    figures.equal("fields from there on", [sorted(t[2]) for t in again[2:]],
                  [["U", "id", "p", "x"]]*2)
    figures.holds("0.01 s is as it was", all(np.array_equal(
        again[1][2][f], whole[1][2][f]) for f in whole[1][2]))

    # From the start: a new file
    case.change(control={"startFrom": "startTime", "startTime": 0,
                         "endTime": 0.01})
    case.solve()
    figures.equal("times after a start at 0 s", len(read(case)), 2)


def testKilled(tmp_path, figures):
    """kill -9 while each step is written: nothing of it is lost, and the run
    goes on"""
    def setup():
        s = scene()
        s.functions["water"].update(writeControl="timeStep", writeInterval=1,
                                    compressionLevel=9)
        s.functions.pop("soil")
        return s.endless(25)

    case = setup().write(tmp_path/"case").prepare()
    last, between = -1, 0
    for end in [0.005, 0.012, 0.02, 0.027]:
        process = case.start()
        case.waitForTime(process, end)
        process.kill()
        process.wait()
        times = read(case)
        figures.equal(f"killed at {end} s: steps in the file",
                      [t[0] for t in times], list(range(len(times))))
        figures.atLeast(f"killed at {end} s: last step", times[-1][0],
                        last + 1)
        last = times[-1][0]
        between += last % 25 != 0
    figures.atLeast("kills behind the last restart", between, 1)
    # The start finds the step behind which the file goes on
    case.change(control={"stopAt": "nextWrite"})
    case.solve()
    whole = setup().write(tmp_path/"whole").prepare()
    whole.change(control={"stopAt": "endTime"})
    n = read(case)[-1][0]
    whole.setup.steps(n)
    whole.rewrite()
    whole.solve()
    equalTimes(figures, "four kills and none", read(case), read(whole))


def testDuringARun(tmp_path, figures):
    """The file opens at any moment, and what it shows is whole"""
    s = scene().endless(25)
    s.functions["water"].update(writeControl="timeStep", writeInterval=1)
    case = s.write(tmp_path/"case").prepare()
    process = case.start()
    case.waitForTime(process, 0.002)
    # Held open: the run must not mind
    with h5py.File(path(case), "r") as early:
        n = len(early)
        seen = []
        while not seen or (seen[-1] < n + 20 and process.poll() is None):
            times = read(case)
            seen.append(len(times))
            assert all(len(t[2]["x"]) == len(t[2]["id"]) for t in times)
        figures.equal("times in the file that was opened first", len(early), n)
        figures.equal("last of them", len(early[max(early)]["x"]),
                      len(early["000000/x"]))
    process.kill()
    process.wait()
    figures.atLeast("times that came while it was read", seen[-1] - n, 20)
    figures.equal("series that became shorter",
                  sum(a > b for a, b in zip(seen, seen[1:])), 0)


def leaving(**entries):
    """Water that falls out of the box"""
    return Setup(
        cells=(6, 6), h=0.05, points=2, energy=False,
        regions={"drop": box((0.05, 0.0), (0.25, 0.1), velocity=(0, -1.5, 0))},
        sides={"ymin": ("patch", "zeroGradient")},
        functions={"water": history(**entries)})


@pytest.fixture(scope="module")
def left(tmp_path_factory):
    case = leaving().until(0.15, write=0.025).write(
        tmp_path_factory.mktemp("leaving")/"case").prepare()
    case.solve()
    return case


def testPointsLeave(left, figures):
    """Fewer points at each time, none at last"""
    numbers = [len(t[2]["id"]) for t in read(left)]
    figures.equal("points", numbers, [
        int(left.state(time)["nPoints"]) for time in left.times])
    figures.equal("points at last", numbers[-1], 0)
    figures.atLeast("different numbers", len(set(numbers)), 3)


@needsParaView
def testParaView(run, left, figures):
    """Points, times, arrays and means of XDMFReader"""
    cases = {str(path(case, cloud, "xdmf")): (case, cloud) for case, cloud in [
        (run, "water"), (run, "soil"), (left, "water")]}
    result = subprocess.run(
        [os.environ["MPMFOAM_DIR"] + "/etc/pvpythonOffscreen",
         str(HERE/"readHistory.py"), *cases],
        capture_output=True, text=True, timeout=180)
    assert result.returncode == 0, result.stdout + result.stderr
    print(result.stderr)
    found = json.loads(result.stdout.splitlines()[-1])
    for name, (case, cloud) in cases.items():
        what = f"{Path(name).parents[2].parent.name} {cloud}"
        expected = read(case, cloud)
        figures.equal(f"{what}: times", [t for t, _ in found[name]],
                      [t[1] for t in expected])
        figures.equal(f"{what}: points", [
            s["points"] for _, s in found[name]],
            [len(t[2]["id"]) for t in expected])
        for (time, seen), (_, _, fields) in zip(found[name], expected):
            if not seen["points"]:
                continue
            figures.equal(f"{what}, {time:.3g} s: cells", seen["cells"],
                          seen["points"])
            figures.atMost(f"{what}, {time:.3g} s: mean position, difference",
                           np.abs(np.array(seen["x"])
                                  - fields["x"].mean(axis=0)).max(), 1e-6)
            figures.equal(f"{what}, {time:.3g} s: arrays",
                          sorted(seen["arrays"]),
                          sorted(set(fields) - {"x"}))
            worst = 0.0
            for field, mean in seen["arrays"].items():
                values = fields[field].reshape(len(fields["id"]), -1)
                if values.shape[1] == 6:
                    # ParaView makes whole tensors of symmetric ones
                    values = values[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]]
                difference = np.abs(np.array(mean) - values.mean(axis=0)).max()
                worst = max(worst, difference/(np.abs(values).max() or 1))
            figures.atMost(f"{what}, {time:.3g} s: means, largest difference",
                           worst, 1e-6)


def bytesOf(directory):
    return sum(p.stat().st_size for p in directory.rglob("*") if p.is_file())


@pytest.mark.parametrize("entries, bound", [
    ({}, 1.0), ({"compressionLevel": 0}, 1.0), ({"compressionLevel": 4}, 1.0),
    ({"precision": "single"}, 0.5),
    ({"fields": "(U p)"}, 0.5)],
    ids=["default", "off", "4", "single", "Up"])
def testSize(tmp_path, figures, entries, bound):
    """Against what the run writes to lagrangian. Times are shown only"""
    setup = damBreak(h=0.005, points=4)
    setup.energy = False
    setup.functions = {"water": history(log=True, **entries)}
    case = setup.steps(40).write(tmp_path/"case").prepare()
    case.solve()
    time = case.times[-1]
    n = int(case.state(time)["nPoints"])
    lagrangian = bytesOf(case.path/time/"lagrangian")
    lines = [line.split() for line in
             (case.path/"log.mpmFoam").read_text().splitlines()
             if line.startswith("materialPointHDF5")]
    first, last = ({k: float(v) for k, v in zip(line[2::2], line[3::2])}
                   for line in (lines[0], lines[-1]))
    figures.equal("points", int(last["points"]), n)
    figures.show("lagrangian, bytes per point", lagrangian/n)
    figures.show("HDF5, bytes per point at the start", first["bytes"]/n)
    figures.show("HDF5, bytes per point", last["bytes"]/n)
    figures.atMost("HDF5 over lagrangian", last["bytes"]/lagrangian, bound)
    figures.show("HDF5, s per million points", last["seconds"]/n*1e6)
    output = re.search(r"^ +output +([\d.]+)",
                       (case.path/"log.mpmFoam").read_text(), re.MULTILINE)
    figures.show("lagrangian and fields on the mesh, s per million points",
                 float(output[1])/n*1e6)


def testPrecision(tmp_path, figures):
    setup = damBreak()
    setup.energy = False
    setup.functions = {"water": history(precision="single",
                                        compressionLevel=0)}
    case = setup.steps(20).write(tmp_path/"case").prepare()
    case.solve()
    fields = read(case)[-1][2]
    figures.equal("types", [str(fields[f].dtype) for f in ["id", "x", "p"]],
                  ["int64", "float32", "float32"])
    points = case.points()
    figures.atMost("x: largest difference over 0.5 m",
                   np.abs(fields["x"] - points.x).max()/0.5, 1e-7)


@pytest.mark.parametrize("entries, expect", [
    ({"fields": "(U rhoo)"}, {"keyword": "fields", "value": r"\brhoo\b",
                              "allowed": words("rho", "velocityGradient")}),
    ({"compressionLevel": 12}, {"keyword": "compressionLevel", "value": "12",
                                "allowed": r"\b9\b"}),
    ({"precision": "half"}, {"keyword": "precision", "value": "half",
                             "allowed": words("double", "single")}),
    ({"field": "(U)"}, {"keyword": r"\bfield\b", "allowed": "fields"}),
    ({"cloud": "sand"}, {"keyword": "cloud", "value": "sand",
                         "allowed": "water"}),
], ids=lambda e: next(iter(e)))
def testBadEntries(tmp_path, figures, entries, expect):
    setup = damBreak(functions={"history": history(**entries)})
    case = setup.steps(1).write(tmp_path/"case").prepare()
    refused(figures, case.run("mpmFoam", check=False),
            {"file": CONTROL, "function object": "history", **expect})


def testTwoOfACloud(tmp_path, figures):
    setup = damBreak(functions={"a": history(), "b": history(fields="(U)")})
    case = setup.steps(1).write(tmp_path/"case").prepare()
    refused(figures, case.run("mpmFoam", check=False),
            {"file": CONTROL, "keyword": "cloud", "other": r"\bb\b",
             "allowed": "one materialPointHDF5 per cloud"})


@pytest.mark.parametrize("ranks", [1, 2])
def testForeignFile(tmp_path, figures, ranks):
    """A file of that name that is none of ours is left alone; all ranks end"""
    setup = damBreak(functions={"water": history()})
    case = setup.steps(1).write(tmp_path/"case").prepare()
    if ranks > 1:
        case.decompose(ranks)
    path(case).parent.mkdir(parents=True)
    path(case).write_text("notes")
    result = case.run("mpmFoam", ranks=ranks, check=False)
    # Each line of a rank begins with its number
    result.text = re.sub(r"^\[\d+\] ?", "", result.text, flags=re.MULTILINE)
    refused(figures, result,
            {"file": r"file: \S*water\.h5", "what": "cannot open",
             "reason": "signature"})
    figures.equal("its content", path(case).read_text(), "notes")
