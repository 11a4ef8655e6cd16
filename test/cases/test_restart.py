"""Restart: two runs in a row are one run, and nothing that was written whole
is lost by the end of a run, whatever its cause."""

import os
import re
import resource
import shutil
import signal
import subprocess
import time

import numpy as np
import pytest

from mpmfoam.postProcessing import readDat

from caseBuilder import damBreak

CLOUD = "lagrangian/water"


def body(path):
    """What follows the header, which names the time directory"""
    data = path.read_bytes()
    return data[data.index(b"}", data.index(b"FoamFile")):]


def differing(first, second, step):
    """Files of the cloud that are not the same bytes in two cases"""
    paths = [c.path/c.timesByStep()[step]/CLOUD for c in (first, second)]
    names = [{p.name for p in path.iterdir()} for path in paths]
    assert names[0] == names[1] and "x" in names[0]
    return sorted(n for n in names[0]
                  if body(paths[0]/n) != body(paths[1]/n))


@pytest.mark.parametrize("control", ["timeStep", "adjustableRunTime"])
@pytest.mark.parametrize("transfer", ["APIC", "FLIP", "XPIC", "XAPIC"])
@pytest.mark.parametrize("dim", [2, 3])
def testTwoRunsAreOne(tmp_path, figures, dim, transfer, control):
    setup = damBreak(dim, points=3 if dim == 2 else 2,
                     water={"transfer": transfer})
    if control == "timeStep":
        setup.steps(45)
    else:
        setup.until(0.03)
    split = setup.write(tmp_path/"split").prepare()
    whole = split.clone(tmp_path/"whole")

    split.solve()
    middle = max(split.timesByStep())
    if control == "adjustableRunTime":
        split.change(control={"endTime": 0.06})
        whole.change(control={"endTime": 0.06})
    else:
        # Writes at twice the step, too, and ends later
        whole.change(control={"stopAt": "endTime", "endTime": 0.08})
    split.solve()
    whole.solve()
    end = max(split.timesByStep())

    figures.show("steps", f"{middle} and {end}")
    figures.equal("files that differ at N", differing(split, whole, middle), [])
    figures.equal("files that differ at 2N", differing(split, whole, end), [])
    names = [c.timesByStep()[end] for c in (split, whole)]
    values = [c.timeValue(name) for c, name in zip((split, whole), names)]
    figures.atMost("relative difference of the time at 2N",
                   abs(values[0]/values[1] - 1), 1e-12)
    states = [c.state(name) for c, name in zip((split, whole), names)]
    for key in ["stepCount", "left", "leftMass", "soundSpeed"]:
        figures.equal(key, states[0][key], states[1][key])
    for key in ["stressWork", "correctionWork"]:
        scale = max(abs(states[1]["stressWork"]), 1e-300)
        figures.atMost(f"{key}: relative difference",
                       abs(states[0][key] - states[1][key])/scale, 1e-9)


def testStateIsExact(tmp_path, figures):
    """What is not a lagrangian field is written with all its digits, too"""
    case = damBreak().steps(20).write(tmp_path/"case").prepare()
    case.solve()
    text = (case.path/case.times[-1]/"uniform"/"materialPoints").read_text()
    for key in ["stressWork", "correctionWork", "soundSpeed"]:
        value = re.search(rf"{key}\s+(\S+);", text)[1]
        digits = re.sub(r"e.*|\D", "", value).strip("0")
        # 17 say which number it is; the last ones may be zeros
        figures.atLeast(f"{key} {value}: digits", len(digits), 15)



def longRun():
    """More steps than any test waits for, a time every 25 steps"""
    return damBreak(h=0.01, points=4).endless(25)


@pytest.fixture(scope="module")
def reference(tmp_path_factory):
    """The run that is not disturbed: 300 steps"""
    case = longRun().write(tmp_path_factory.mktemp("reference")/"case")
    case.prepare()
    case.change(control={"stopAt": "endTime", "endTime": 0.1})
    case.solve()
    return case


def anew(reference, path):
    """A run from the same start that does not end by itself"""
    case = reference.clone(path)
    for t in reference.times[1:]:
        shutil.rmtree(case.path/t)
    # Its log says that it has come far
    (case.path/"log.mpmFoam").unlink()
    case.setup = longRun()
    case.rewrite()
    return case


def continued(case, reference, figures):
    """Goes on to the end of the reference run; all times that both wrote are
    the same"""
    case.change(control={"stopAt": "endTime", "endTime": 0.1})
    case.solve()
    common = sorted(set(case.timesByStep()) & set(reference.timesByStep()))
    figures.show("times compared", len(common))
    figures.equal("steps with files that differ",
                  [k for k in common if differing(case, reference, k)], [])
    figures.equal("last step compared", common[-1],
                  max(reference.timesByStep()))


@pytest.mark.parametrize("name", ["SIGTERM", "SIGINT", "SIGHUP", "SIGUSR1"])
def testTerminate(tmp_path, figures, reference, name):
    """After the step, with a restart; a second signal changes nothing"""
    case = anew(reference, tmp_path/"case")
    process = case.start()
    case.waitForTime(process, 0.02)
    for _ in range(2):
        process.send_signal(getattr(signal, name))
    status = case.waitForEnd(process)
    last = case.times[-1]
    text = (case.path/"log.mpmFoam").read_text()
    figures.equal(f"exit status after {name}", status, 0)
    figures.equal("times the log names it", text.count(f"{name}: writing"), 1)
    figures.holds("log has End", case.log.finished)
    figures.equal("complete state at the last time",
                  "complete" in (case.path/last/"uniform"/"materialPoints")
                  .read_text(), True)
    continued(case, reference, figures)


def wroteOnlyThen(case, process, send, figures, limit=40):
    """A run that writes at its end alone: is that time whole"""
    case.change(control={"writeInterval": 1000000})
    process = process()
    case.waitForTime(process, 0.02)
    send(process)
    end = time.monotonic() + limit
    roots = [p for p in case.path.glob("processor*")] or [case.path]

    def states():
        return [p for root in roots
                for p in root.glob("*/uniform/materialPoints")
                if p.parts[-3] != "0" and "complete" in p.read_text()]
    while len(states()) < len(roots) and time.monotonic() < end:
        time.sleep(0.1)
    case.waitForEnd(process)
    figures.equal("whole times written", len(states()), len(roots))


def testInterruptPipe(tmp_path, figures, reference):
    """Ctrl-C ends who reads the log, too"""
    case = anew(reference, tmp_path/"case")

    def start():
        return subprocess.Popen(
            ["bash", "-c", "mpmFoam 2>&1 | cat > log.mpmFoam"],
            cwd=case.path, start_new_session=True,
            env={**os.environ, "PWD": str(case.path)})
    wroteOnlyThen(case, start,
                  lambda p: os.killpg(p.pid, signal.SIGINT), figures)
    case.change(control={"writeInterval": 25})
    continued(case, reference, figures)


@pytest.mark.parametrize("names", [
    ["SIGINT"], ["SIGINT", "SIGINT"], ["SIGUSR1"]], ids="+".join)
def testInterruptMpirun(tmp_path, figures, reference, names):
    """What mpirun makes of signals that it gets itself: it kills some seconds
    after SIGINT, and ends at once after the second one"""
    case = anew(reference, tmp_path/"case")
    case.decompose(2)

    def send(process):
        for name in names:
            process.send_signal(getattr(signal, name))
            time.sleep(1)
    wroteOnlyThen(case, lambda: case.start("mpmFoam", ranks=2), send, figures)
    case.change(control={"stopAt": "nextWrite", "writeInterval": 25})
    result = case.solve(ranks=2)
    figures.holds("nothing is set aside", "incomplete" not in result.text)


def energySetup(seconds):
    setup = damBreak().until(seconds, write=0.005)
    setup.functions["each"] = {
        "type": "frontPosition", "libs": '("libmpmFunctionObjects.so")',
        "cloud": "water", "direction": (1, 0, 0), "writeControl": "timeStep",
        "writeInterval": 1}
    return setup


def testSeriesOverRestarts(tmp_path, figures):
    """Each time once, after restarts from earlier times: the series is that of
    a run without them, where it was not overtaken"""
    case = energySetup(0.03).write(tmp_path/"case").prepare()
    whole = case.clone(tmp_path/"whole")
    whole.solve()
    # The second one starts before the first one did, and ends before it
    for start, end in [(None, 0.02), ("0.015", 0.03), ("0.01", 0.025)]:
        for t in case.times[1:]:
            if start and float(t) > float(start):
                shutil.rmtree(case.path/t)
        case.change(control={"endTime": end})
        case.solve()
    a, b = (readDat(c.path, "each", "front.dat") for c in (case, whole))
    figures.atLeast("steps in the series", len(a), 20)
    figures.holds("each time once", (np.diff(a[:, 0]) > 0).all())
    b = b[b[:, 0] < 0.025*(1 + 1e-9)]
    figures.equal("number of times", len(a), len(b))
    if len(a) == len(b):
        figures.atMost("difference to the run without restarts",
                       float(np.max(np.abs(a - b))), 1e-12)


def testSeriesOfShortSteps(tmp_path, figures):
    """Steps shorter than names of times tell apart"""
    case = energySetup(0.01).write(tmp_path/"case").prepare()
    case.solve()
    case.change(control={
        "adjustTimeStep": False, "deltaT": 1e-7, "timePrecision": 3,
        "writeControl": "timeStep", "writeInterval": 1000,
        "endTime": 0.010002})
    case.solve()
    a = readDat(case.path, "each", "front.dat")
    figures.equal("times from 0.01 s on",
                  len(np.unique(a[a[:, 0] > 0.00999999, 0])), 21)


@pytest.mark.parametrize("control", ["run", "functionObject"])
def testTinyWriteInterval(tmp_path, figures, control):
    """An interval that no name of a time can show is refused, one that is
    hardly longer costs no more than another"""
    case = energySetup(0.02).write(tmp_path/"case").prepare()
    case.solve()

    def change(interval):
        entries = {"writeControl": "adjustableRunTime",
                   "writeInterval": interval}
        if control == "run":
            case.change(control={**entries, "endTime": 0.04})
        else:
            case.change(control={"endTime": 0.04},
                        functions={"each": entries})
    for interval, text in [(1e-20, "1e-20"), (1e-12, "1e-12")]:
        change(interval)
        result = case.solve(check=False)
        figures.holds(f"{text} s: ends with an error", result.status != 0)
        where = (r"controlDict\.functions\.each" if control ==
                 "functionObject" else "controlDict")
        flat = re.sub(r"\s+", " ", result.text)
        pattern = (rf"writeInterval is {text} s, less .*Allowed: writeInterval"
                   rf" >= 1e-0?7.*{where}")
        figures.contains(f"{text} s: message", (re.search(
            pattern, flat) or [None])[0], pattern)
    change(1e-5)
    case.change(control={"endTime": 0.022})
    case.solve()
    figures.equal("steps of 1e-5 s", case.log.stepCount, 200)


def testTerminateParallel(tmp_path, figures, reference):
    """SIGTERM to mpirun reaches the ranks; they end with a restart"""
    case = anew(reference, tmp_path/"case")
    case.decompose(2)
    process = case.start("mpmFoam", ranks=2)
    case.waitForTime(process, 0.02)
    # As a batch system does it: each process gets the signal
    for rank in children(process.pid):
        os.kill(rank, signal.SIGTERM)
    status = case.waitForEnd(process)
    last = case.times[-1]
    figures.equal("exit status after SIGTERM", status, 0)
    figures.holds("log has End", case.log.finished)
    points = case.points(last)
    figures.equal("points at the last time", len(points.id),
                  len(reference.points("0").id))
    case.change(control={"stopAt": "nextWrite"})
    case.solve(ranks=2)
    figures.holds("run goes on after it", float(case.times[-1]) > float(last),
                  f"{last} -> {case.times[-1]} s")


def children(pid):
    """Processes that mpirun started"""
    path = f"/proc/{pid}/task/{pid}/children"
    return [int(p) for p in open(path).read().split()]


@pytest.mark.parametrize("how", ["writeNow", "noWriteNow", "nextWrite"])
def testStopAt(tmp_path, figures, reference, how):
    """controlDict edited while it runs"""
    case = anew(reference, tmp_path/"case")
    process = case.start()
    case.waitForTime(process, 0.02)
    case.change(control={"stopAt": how})
    # OpenFOAM reads the file again if it is 10 s newer than before
    late = time.time() + 60
    os.utime(case.path/"system"/"controlDict", (late, late))
    status = case.waitForEnd(process)
    last = case.times[-1]
    figures.equal("exit status", status, 0)
    figures.holds("log has End", case.log.finished)
    continued(case, reference, figures)


def testKill(tmp_path, figures, reference):
    """kill -9 loses nothing that was written before"""
    case = anew(reference, tmp_path/"case")
    process = case.start()
    case.waitForTime(process, 0.03)
    process.kill()
    process.wait()
    # The last one may be half-written
    steps = sorted(case.timesByStep())[1:-1]
    figures.atLeast("times written before the kill", len(steps), 2)
    figures.equal("of them, with files that differ",
                  [k for k in steps if differing(case, reference, k)], [])
    continued(case, reference, figures)


def deleteState(path):
    (path/"uniform"/"materialPoints").unlink()


def emptyState(path):
    (path/"uniform"/"materialPoints").write_bytes(b"")


def cutState(path):
    state = path/"uniform"/"materialPoints"
    text = state.read_bytes()
    state.write_bytes(text[:text.index(b"stressWork")])


def cutField(name):
    def cut(path):
        file = path/CLOUD/name
        file.write_bytes(file.read_bytes()[:-2000])
    cut.__name__ = f"cut_{name}"
    return cut


def deleteField(name):
    def delete(path):
        (path/CLOUD/name).unlink()
    delete.__name__ = f"delete_{name}"
    return delete


@pytest.mark.parametrize("damage", [
    deleteState, emptyState, cutState, cutField("x"), cutField("U"),
    cutField("J"), cutField("velocityGradient"), deleteField("mass")],
    ids=lambda f: f.__name__)
def testHalfWritten(tmp_path, figures, reference, damage):
    """A time directory that is not whole is named, set aside and skipped"""
    case = reference.clone(tmp_path/"case")
    for t in reference.times[4:]:
        shutil.rmtree(case.path/t)
    whole, broken = case.times[-2:]
    damage(case.path/broken)

    text = case.solve(check=False).text
    figures.holds("log names the time directory",
                  f"Time directory {broken} is incomplete" in text)
    figures.holds("renamed",
                  (case.path/f"{broken}.incomplete").is_dir())
    figures.equal("runs to its end", case.log.finished, True)
    if case.log.finished:
        steps = sorted(reference.timesByStep())
        figures.equal("steps", sorted(case.timesByStep()), steps)
        figures.equal("steps with files that differ", [
            k for k in steps if differing(case, reference, k)], [])


@pytest.mark.parametrize("damage", [deleteState, cutField("x")],
                         ids=lambda f: f.__name__)
def testHalfWrittenOnOneRank(tmp_path, figures, reference, damage):
    """The same for one of two ranks: both go back to the last whole time"""
    case = reference.clone(tmp_path/"case")
    for t in reference.times[1:]:
        shutil.rmtree(case.path/t)
    # Both with water
    case.decompose(2, cellRank=case.case.cellCentres("0")[:, 0] > 0.1)
    case.change(control={"endTime": 0.03})
    case.solve(ranks=2)
    broken = case.times[-1]
    damage(case.path/"processor1"/broken)

    text = case.solve(ranks=2, check=False).text
    figures.holds("log names the time directory",
                  f"Time directory {broken} is incomplete" in text)
    figures.holds("renamed on both ranks", all(
        (case.path/f"processor{i}"/f"{broken}.incomplete").is_dir()
        for i in range(2)))
    figures.equal("runs to its end", case.log.finished, True)


@pytest.mark.parametrize("damage", [None, "x.gz", "materialPoints.gz"])
def testCompressed(tmp_path, figures, damage):
    """Compressed times are whole, too, unless they were cut off"""
    case = damBreak().steps(10).write(tmp_path/"case").prepare()
    case.solve()
    case.change(control={"writeFormat": "ascii", "writeCompression": "on",
                         "stopAt": "nextWrite"})
    case.solve()
    last = case.times[-1]
    figures.holds("compressed",
                  (case.path/last/CLOUD/"x.gz").is_file())
    if damage:
        file = next((case.path/last).rglob(damage))
        file.write_bytes(file.read_bytes()[:-40])
    text = case.solve().text
    figures.equal("set aside", (case.path/f"{last}.incomplete").is_dir(),
                  bool(damage))
    figures.equal("named", f"Time directory {last} is incomplete" in text,
                  bool(damage))


@pytest.mark.parametrize("handler", ["collated", "masterUncollated"])
def testFileHandler(tmp_path, figures, monkeypatch, handler):
    """Files of all ranks in one, and files that the master reads for all: the
    same run, also where one rank has no water; a time that was cut off is set
    aside"""
    plain = damBreak().steps(10).write(tmp_path/"plain").prepare()
    case = plain.clone(tmp_path/"case")
    plain.decompose(2).solve(ranks=2)
    plain.run("reconstructPar")

    monkeypatch.setenv("FOAM_FILEHANDLER", handler)
    case.decompose(2).solve(ranks=2)
    case.run("reconstructPar")
    steps = sorted(plain.timesByStep())
    figures.equal("steps", sorted(case.timesByStep()), steps)
    figures.equal("steps with files that differ", [
        k for k in steps if differing(case, plain, k)], [])

    last = case.timesByStep()[steps[-1]]
    ranks = case.path/("processors2" if handler == "collated"
                       else "processor0")
    whole = (ranks/last/CLOUD/"x").read_bytes()
    (ranks/last/CLOUD/"x").write_bytes(whole[:-200])
    for name in case.timesByStep().values():
        if float(name) > 0:
            shutil.rmtree(case.path/name)
    text = case.solve(ranks=2).text
    figures.holds("named", f"Time directory {last} is incomplete" in text)
    figures.holds("set aside", (ranks/f"{last}.incomplete").is_dir())
    figures.holds("the same again",
                  (ranks/last/CLOUD/"x").read_bytes() == whole)


def limitFileSize(bytes_):
    """For a child process: no file grows beyond this, as on a full disk"""
    def limit():
        signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
        resource.setrlimit(resource.RLIMIT_FSIZE, (bytes_, bytes_))
    return limit


def testFullDisk(tmp_path, figures, reference):
    """Writing fails: a clear error, the last whole time kept"""
    case = anew(reference, tmp_path/"case")
    case.change(control={"endTime": 0.02})
    case.solve()
    kept = case.times
    size = max(p.stat().st_size
               for p in (case.path/kept[-1]/CLOUD).iterdir())
    case.change(control={"endTime": 1e6})
    process = subprocess.run(
        ["mpmFoam"], cwd=case.path, capture_output=True, text=True,
        timeout=60, preexec_fn=limitFileSize(size//2),
        env={**os.environ, "PWD": str(case.path)})
    text = process.stdout + process.stderr
    figures.equal("exit status", process.returncode, 1)
    found = re.search(
        r"FOAM FATAL(?s:.*?)((error in IOstream|cannot write) \S+)", text)
    figures.contains("message", found and found[1],
                     "error in IOstream <file>, or cannot write <file>")
    figures.equal("times written before it with files that differ", [
        k for k, t in case.timesByStep().items() if t in kept
        and differing(case, reference, k)], [])
    continued(case, reference, figures)


def testNoWholeTime(tmp_path, figures):
    """Where no time is whole there is nothing to go back to: a clear end"""
    case = damBreak().steps(10).write(tmp_path/"case").prepare()
    deleteState(case.path/"0")
    result = case.solve(check=False)
    figures.holds("status is not 0", result.status != 0, result.status)
    figures.holds("message says what to do",
                  "Run setMaterialPoints" in result.text)
    figures.holds("0 is left where it is", (case.path/"0").is_dir())
