"""What the log of mpmFoam, or of any OpenFOAM solver, says about the run."""

import re
from collections import Counter
from dataclasses import dataclass, field

_NUMBER = r"([-+0-9.eE]+)"


@dataclass
class RunLog:
    """One run; None where the log has no such line"""
    finished: bool = False          # ends with "End"
    time: float = None              # last "Time = ", in s
    stepCount: int = 0
    cpuTime: float = None           # "ExecutionTime", in s
    wallTime: float = None          # "ClockTime", in s
    points: int = None
    nsPerPointStep: float = None
    deltaTMin: float = None
    deltaTMax: float = None
    deltaTSum: float = 0.0
    courantMax: float = None
    limiters: Counter = field(default_factory=Counter)
    # By cloud: points that left through openings, or were put back from walls
    leftOf: dict = field(default_factory=dict)
    wallContactsOf: dict = field(default_factory=dict)

    @property
    def left(self):
        return sum(self.leftOf.values())

    @property
    def wallContacts(self):
        return sum(self.wallContactsOf.values())

    @property
    def dtLimiter(self):
        """What limited the time step most often"""
        return self.limiters.most_common(1)[0][0] if self.limiters else None

    @property
    def deltaTMean(self):
        n = sum(self.limiters.values())
        return self.deltaTSum/n if n else None


def readLog(path):
    log = RunLog()
    with open(path, errors="replace") as file:
        for line in file:
            _readLine(log, line)
    return log


def costs(text):
    """Rows of the closing table: name -> seconds, % of run, ns"""
    table = text[text.index("\nCost\n"):]
    return {name.strip(): (float(s), float(p), float(ns)) for name, s, p, ns
            in re.findall(r"^ {4}(\S.*?) +([\d.]+) +([\d.]+) +([\d.]+)$",
                          table, re.MULTILINE)}


def _readLine(log, line):
    found = re.match(r"\s*Time = " + _NUMBER, line)
    if found:
        log.time = float(found[1])
        log.stepCount += 1
        return

    found = re.match(
        rf"\s*deltaT = {_NUMBER}(?:\s+limiter: *(.+?))?(?:\s+step: \d+)?\s*$",
        line)
    if found:
        deltaT = float(found[1])
        log.deltaTMin = min(deltaT, log.deltaTMin or deltaT)
        log.deltaTMax = max(deltaT, log.deltaTMax or deltaT)
        if found[2]:
            log.limiters[found[2]] += 1
            log.deltaTSum += deltaT
        return

    found = re.match(
        rf"ExecutionTime = {_NUMBER} s\s+ClockTime = {_NUMBER} s", line)
    if found:
        log.cpuTime, log.wallTime = float(found[1]), float(found[2])
        return

    found = re.search(rf"^Courant Number.*max: *{_NUMBER}", line)
    if found:
        log.courantMax = max(float(found[1]), log.courantMax or 0)
        return

    found = re.match(r"(\w+): points \d+, max speed", line)
    if found:
        cloud = found[1]
        for counts, text in [(log.leftOf, "left through openings"),
                             (log.wallContactsOf, "put back from walls")]:
            number = re.search(rf"{text} (\d+)", line)
            if number:
                counts[cloud] = int(number[1])
        return

    found = re.search(
        rf"Steps: *(\d+)\s+points: *(\d+)\s+"
        rf"ns per point and step: *{_NUMBER}", line)
    if found:
        # With logInterval the log shows fewer "Time =" than there were steps
        log.stepCount = int(found[1])
        log.points = int(found[2])
        log.nsPerPointStep = float(found[3])
        return

    if line.strip() == "End":
        log.finished = True
