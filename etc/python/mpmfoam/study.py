"""Runs many cases made from templates, one after the other, resumably.

A study lists its runs and evaluates those that are finished:

    runs = [Run("mpmFoam_h0.01", [template], MPMFOAM,
                {"system/blockMeshDict": {"h": 0.01, "nx": 40, "ny": 30}})]
    main(here, runs, evaluate)

Each run lives in runs/<name> beside the study. A run that is finished is
skipped on the next call as long as its template and its settings are the
same; one that was interrupted or has failed is run again from its start. Each
run notes commit and build of the solver that made it (provenance); --current
runs again what another build made.
"""

import argparse
import fnmatch
import hashlib
import json
import os
import re
import shutil
import subprocess
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

from . import foamFile, runLog
from .case import Case

MPMFOAM = ["blockMesh", "setMaterialPoints", "mpmFoam"]
INTERFOAM = ["blockMesh", "setFields", "interFoam"]

# Fluids and numerics of every interFoam case that is compared with ours
INTERFOAM_CASE = Path(__file__).resolve().parents[2]/"caseDicts"/"interFoam"

_STAMP = "study.json"


class RunError(Exception):
    """A run that could not be made or did not finish"""


class OverLimit(RunError):
    """A run that took more CPU time than it was given"""


@dataclass
class Run:
    """name       directory below runs/
    templates  case directories, or files as (file, place in the case); later
               ones lie over earlier ones
    commands   applications in order, the solver last
    settings   file -> entry -> value, set by foamDictionary; an entry of a
               sub-dictionary is written sub/entry
    files      file -> text, written as it is
    about      what the evaluation wants to know of the run
    optional   runs only when it is named
    ranks      of the solver; with more than one the case is decomposed by its
               system/decomposeParDict before and reconstructed after
    cpuLimit   of each command [s]; beyond it the run is ended (OverLimit)"""
    name: str
    templates: list
    commands: list
    settings: dict = field(default_factory=dict)
    files: dict = field(default_factory=dict)
    about: dict = field(default_factory=dict)
    optional: bool = False
    ranks: int = 1
    path: Path = None
    cpuLimit: float = None

    @property
    def case(self):
        return Case(self.path)

    @property
    def log(self):
        return runLog.readLog(self.path/f"log.{self.commands[-1]}")

    def digest(self):
        """Changes with anything that goes into the case"""
        parts = [json.dumps([self._stages(), self.settings, self.files],
                            default=str, sort_keys=True).encode()]
        for source, place in self._sources():
            parts += [str(place).encode(), source.read_bytes()]
        return hashlib.sha256(b"\0".join(parts)).hexdigest()

    def stamp(self):
        try:
            return json.loads((self.path/_STAMP).read_text())
        except (OSError, ValueError):
            return {}

    def finished(self):
        return self.stamp().get("digest") == self.digest()

    def make(self):
        """A fresh case directory"""
        shutil.rmtree(self.path, ignore_errors=True)
        self.path.mkdir(parents=True)
        for source, place in self._sources():
            target = self.path/place
            target.parent.mkdir(parents=True, exist_ok=True)
            shutil.copyfile(source, target)
        for name, text in self.files.items():
            (self.path/name).write_text(text)
        for name, entries in self.settings.items():
            for entry, value in entries.items():
                setEntry(self.path/name, entry, value)
        shutil.copytree(self.path/"0.orig", self.path/"0")

    def run(self):
        """All commands, each into log.<command>, with progress"""
        start = time.time()
        madeBy = build(self.commands[-1])
        endTime = float(entry(self.path/"system"/"controlDict", "endTime"))
        for command in self._stages():
            words = command.split()
            name = words[3] if words[0] == "mpirun" else words[0]
            suffix = ".weights" if "-weights" in words else ""
            logFile = self.path/f"log.{name}{suffix}"
            with open(logFile, "w") as out:
                process = subprocess.Popen(
                    words, cwd=self.path, stdout=out,
                    stderr=subprocess.STDOUT,
                    env={**os.environ, "PWD": str(self.path)})
                try:
                    while process.poll() is None:
                        time.sleep(0.2)
                        if name == self.commands[-1]:
                            _progress(self.name, logFile, endTime, start)
                        if self.cpuLimit and \
                                cpuTime(process.pid) > self.cpuLimit:
                            raise OverLimit(
                                f"{self.name}: {command} took more than "
                                f"{self.cpuLimit:.3g} s of CPU time")
                except BaseException:
                    process.terminate()
                    process.wait()
                    raise
            if process.returncode != 0:
                tail = logFile.read_text(errors="replace").splitlines()[-15:]
                _progress(self.name, None, endTime, start)
                raise RunError(
                    f"{self.name}: {command} failed "
                    f"({process.returncode}); end of {logFile}:\n    "
                    + "\n    ".join(tail))
        _progress(self.name, None, endTime, start)
        if not self.log.finished:
            raise RunError(f"{self.name}: the log has no End")
        self.sign(madeBy)

    def sign(self, madeBy):
        """It is finished: note what made it"""
        if build(self.commands[-1]) != madeBy:
            raise RunError(f"{self.name}: {self.commands[-1]} was built anew "
                           "during the run")
        (self.path/_STAMP).write_text(json.dumps({
            "digest": self.digest(), "commit": commit(), "build": madeBy,
            "date": time.strftime("%Y-%m-%d")}) + "\n")

    def _stages(self):
        """The commands in full"""
        if self.ranks == 1:
            return self.commands
        return [*self.commands[:-1], "setMaterialPoints -decomposition",
                "decomposePar",
                f"mpirun -np {self.ranks} {self.commands[-1]} -parallel",
                "reconstructPar"]

    def _sources(self):
        for template in self.templates:
            if isinstance(template, tuple):
                yield Path(template[0]), Path(template[1])
                continue
            for part in ["0.orig", "constant", "system"]:
                for source in sorted((Path(template)/part).rglob("*")):
                    place = source.relative_to(template)
                    if source.is_file() and "polyMesh" not in place.parts:
                        yield source, place


def cpuTime(pid):
    """Of a process that runs [s]; 0 if it has ended"""
    try:
        words = Path(f"/proc/{pid}/stat").read_text().rsplit(")", 1)[1].split()
    except OSError:
        return 0
    return (int(words[11]) + int(words[12]))/os.sysconf("SC_CLK_TCK")


def setEntry(path, name, value):
    """One entry of a dictionary, which keeps its macros"""
    if isinstance(value, (list, tuple)):
        value = "(" + " ".join(map(str, value)) + ")"
    _foamDictionary(path, "-disableFunctionEntries",
                    "-entry", name, "-set", str(value))


def entry(path, name):
    return _foamDictionary(path, "-entry", name, "-value").strip()


def _foamDictionary(path, *arguments):
    result = subprocess.run(["foamDictionary", str(path), *arguments],
                            capture_output=True, text=True)
    if result.returncode != 0:
        raise RunError(f"foamDictionary {path} {' '.join(arguments)}:\n"
                       + result.stdout + result.stderr)
    return result.stdout


def commit():
    """The commit that is checked out, with + where the tree differs"""
    here = Path(__file__).parent
    try:
        return subprocess.run(
            ["git", "describe", "--always", "--dirty=+", "--abbrev=10"],
            cwd=here, capture_output=True, text=True, check=True
        ).stdout.strip()
    except (OSError, subprocess.CalledProcessError):
        return "unknown"


def build(application):
    """A digest of an application and of our libraries beside those it loads
    (function objects are loaded later)"""
    path = shutil.which(application)
    if not path:
        return "none"
    loaded = subprocess.run(["ldd", path], capture_output=True, text=True)
    libraries = {library for found in re.findall(
        r"=> (\S*/libmpm\S+)", loaded.stdout)
        for library in Path(found).parent.glob("libmpm*.so")}
    files = [path, *sorted(libraries)]
    digest = hashlib.sha256()
    for file in files:
        digest.update(Path(file).read_bytes())
    return digest.hexdigest()[:10]


def provenance(done):
    """Commits, builds and dates of the runs of mpmFoam, as metrics. More than
    one build means that the runs are not comparable to the last digit."""
    stamps = [run.stamp() for run in done.values()
              if run.commands[-1] == "mpmFoam"]
    return {key: " ".join(sorted({str(s.get(key)) for s in stamps}))
            for key in ["commit", "build", "date"]} if stamps else {}


def main(here, runs, evaluate, description=None):
    """Command line of a study. evaluate(done, results): done maps the names
    of the finished runs to their Run, results is the directory for CSV,
    metrics.json and figures."""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("names", nargs="*", metavar="run",
                        help="runs to do, wildcards allowed (default: all)")
    parser.add_argument("--list", action="store_true",
                        help="list the runs and their state")
    parser.add_argument("--evaluate", action="store_true",
                        help="evaluate what is finished, run nothing")
    parser.add_argument("--current", action="store_true",
                        help="run again what another build of the solver made")
    arguments = parser.parse_args()

    here = Path(here)
    for run in runs:
        run.path = here/"runs"/run.name

    if arguments.names:
        chosen = [run for run in runs if any(
            fnmatch.fnmatch(run.name, name) for name in arguments.names)]
        if not chosen:
            parser.error(f"no run is named {' '.join(arguments.names)}")
    else:
        chosen = [run for run in runs
                  if not run.optional or arguments.list]

    if arguments.list:
        for run in chosen:
            print(f"{'finished' if run.finished() else 'to do':<10}{run.name}")
        return

    failed = []
    if not arguments.evaluate:
        for run in chosen:
            if run.finished() and not (
                    arguments.current and
                    run.stamp().get("build") != build(run.commands[-1])):
                continue
            if not shutil.which(run.commands[-1]):
                failed.append(f"{run.name}: no {run.commands[-1]} in PATH")
                continue
            try:
                run.make()
                run.run()
            except (RunError, foamFile.FoamFileError) as error:
                failed.append(str(error))
                print(error, file=sys.stderr)
            except KeyboardInterrupt:
                sys.exit(f"\n{run.name}: interrupted; the next call makes it "
                         "again and goes on from there")

    done = {run.name: run for run in runs if run.finished()}
    if done:
        results = here/"results"
        results.mkdir(exist_ok=True)
        evaluate(done, results)
        if " " in provenance(done).get("build", ""):
            print("CAUTION: these runs come from more than one build of "
                  "mpmFoam; ./Allrun --current makes them anew")
    if failed:
        sys.exit("Not finished:\n" + "\n".join(
            f"    {line.splitlines()[0]}" for line in failed))


_shown = {}


def _progress(name, logFile, endTime, start):
    """A line with the fraction done; on a terminal it is rewritten in place,
    else one line per tenth. No logFile: the run is over."""
    if logFile is None:
        if sys.stdout.isatty():
            print()
        _shown.pop(name, None)
        return
    with open(logFile, "rb") as file:
        file.seek(0, os.SEEK_END)
        file.seek(max(0, file.tell() - 4096))
        tail = file.read().decode(errors="replace").splitlines()
    times = [line.split("=")[1].split()[0] for line in tail
             if line.strip().startswith("Time = ")]
    if not times:
        return
    fraction = float(times[-1])/endTime
    elapsed = time.time() - start
    text = f"{name}: {100*fraction:3.0f} %, {elapsed:.0f} s"
    if sys.stdout.isatty():
        print("\r" + text, end="", flush=True)
    elif int(10*fraction) > _shown.get(name, -1):
        _shown[name] = int(10*fraction)
        print(text, flush=True)
