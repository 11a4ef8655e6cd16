"""What all tests share: the environment, and the figures they report."""

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[1]
sys.path.insert(0, str(ROOT/"etc"/"python"))

# A shell's background jobs ignore Ctrl-C, those of nohup a hangup, and so would
# the runs that tests interrupt
signal.signal(signal.SIGINT, signal.default_int_handler)
signal.signal(signal.SIGHUP, signal.SIG_DFL)

_lines = []


def pytest_configure(config):
    """Works without etc/bashrc sourced, too"""
    if "MPMFOAM_DIR" in os.environ:
        return
    result = subprocess.run(
        ["bash", "-c", f". '{ROOT}/etc/bashrc' && env -0"],
        capture_output=True, text=True)
    if result.returncode:
        pytest.exit(result.stderr, returncode=2)
    for line in result.stdout.split("\0"):
        name, found, value = line.partition("=")
        if found:
            os.environ[name] = value


class Figures:
    """Compares figures with their bounds. Each is printed; those with a bound
    and all that do not hold are listed again at the end of the session. A
    test that calls several of them is told of all that do not hold."""

    def __init__(self, test):
        self.test = test
        self.failed = []
        self.compared = 0

    def atMost(self, name, value, bound):
        self._add(name, value, "<=", bound, value <= bound, listed=True)

    def atLeast(self, name, value, bound):
        self._add(name, value, ">=", bound, value >= bound, listed=True)

    def equal(self, name, value, expected):
        self._add(name, value, "==", expected, value == expected)

    def show(self, name, value):
        """A figure without a bound"""
        self._line(f"{name} {_text(value)}", True)

    def holds(self, name, condition, detail=None):
        """A condition; detail says what was found"""
        self._add(name, bool(condition) if detail is None else detail,
                  "->", "right" if condition else "wrong", condition)

    def contains(self, name, found, pattern):
        """What a search for a pattern found in a text, None if nothing"""
        self._add(name, "nothing" if found is None else f"'{found}'",
                  "matches", f"/{pattern}/", found is not None)

    def _add(self, name, value, relation, bound, good, listed=False):
        # Comparison with nan is false, and fails
        good = bool(good)
        self.compared += 1
        self._line(f"{name} {_text(value)} {relation} {_text(bound)}"
                   + ("" if good else "   FAILED"), listed or not good)
        if not good:
            self.failed.append(f"{name}: {_text(value)}, not {relation} "
                               f"{_text(bound)}")

    def _line(self, text, listed):
        print(text)
        if listed:
            _lines.append((self.test, text))


def _text(value):
    if isinstance(value, float) or hasattr(value, "dtype"):
        try:
            return f"{float(value):.4g}"
        except (TypeError, ValueError):
            pass
    return str(value)


@pytest.fixture
def figures(request):
    return Figures(request.node.nodeid.split("/")[-1])


@pytest.hookimpl(trylast=True)
def pytest_runtest_call(item):
    """After the test itself: all figures that do not hold, at once"""
    figures = getattr(item, "funcargs", {}).get("figures")
    if figures is None:
        return
    if figures.failed:
        pytest.fail("\n".join(figures.failed), pytrace=False)
    if not figures.compared:
        pytest.fail("the test compared nothing", pytrace=False)


def pytest_terminal_summary(terminalreporter):
    if not _lines:
        return
    terminalreporter.section("figures and their bounds")
    last = None
    for test, text in _lines:
        if test != last:
            terminalreporter.write_line(test)
        terminalreporter.write_line("    " + text)
        last = test
