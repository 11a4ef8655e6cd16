"""The Markdown files say what is there: links and paths lead somewhere, sections
that sources point to exist, commands have the options that are named, and those
of README run. docs/howto: test_howto.py."""

import os
import re
import shutil
import subprocess
from functools import lru_cache
from pathlib import Path
from urllib.parse import unquote

import pytest

ROOT = Path(__file__).resolve().parents[2]
FOLDERS = ["applications", "bin", "docs", "etc", "src", "test", "tutorials",
           "validation"]


@lru_cache
def documents():
    """All that are part of the repository, or will be with the next commit"""
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard", "*.md"],
        cwd=ROOT, capture_output=True, text=True)
    if listed.returncode:
        pytest.skip("not a git repository")
    return [ROOT/line for line in listed.stdout.splitlines()
            if (ROOT/line).exists()]


def prose(text):
    """Without blocks of code"""
    text = re.sub(r"^```.*?^```$", "", text, flags=re.M | re.S)
    return re.sub(r"^(?: {4}|\t).*$", "", text, flags=re.M)


def anchors(path):
    """Names of the headings, as forges make them"""
    found = set()
    for heading in re.findall(r"^#+ +(.+?) *#*$", prose(path.read_text()),
                              re.M):
        name = re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-")
        n = 0
        while (name if not n else f"{name}-{n}") in found:
            n += 1
        found.add(name if not n else f"{name}-{n}")
    return found


def testLinks(figures):
    lost, n = [], 0
    for path in documents():
        text = re.sub(r"`[^`\n]*`", "", prose(path.read_text()))
        for link in re.findall(r"\]\(([^)\s]+)\)", text):
            n += 1
            if re.match(r"(https?|mailto):", link):
                if not re.match(r"https?://[\w.-]+\.\w+(/\S*)?$", link):
                    lost.append(f"{path.relative_to(ROOT)}: {link}")
                continue
            name, _, anchor = link.partition("#")
            target = (path.parent/unquote(name)).resolve() if name else path
            if not target.exists() or (
                    anchor and anchor not in anchors(target)):
                lost.append(f"{path.relative_to(ROOT)}: {link}")
    figures.atLeast("links", n, 50)
    figures.holds("all lead somewhere", not lost, "\n".join(lost))


def testPaths(figures):
    """`docs/howto/bodies.md`, `validation/bodies`, ..."""
    lost, n = [], 0
    start = re.compile(rf"({'|'.join(FOLDERS)})/[\w./*-]*$")
    for path in documents():
        if path.name == "CHANGELOG.md":
            continue    # of what there was
        for quoted in re.findall(r"`([^`\s]+)`", prose(path.read_text())):
            if not start.match(quoted):
                continue
            n += 1
            if not list(path.parent.glob(quoted)) \
                    and not list(ROOT.glob(quoted.rstrip("/"))):
                lost.append(f"{path.relative_to(ROOT)}: {quoted}")
    figures.atLeast("paths", n, 100)
    figures.holds("all are there", not lost, "\n".join(lost))


def testSections(figures):
    """docs/theory.md, section 4.2: in sources"""
    theory = (ROOT/"docs"/"theory.md").read_text()
    numbers = set(re.findall(r"^#+ (\d+(?:\.\d+)?) ", theory, re.M))
    lost, n = [], 0
    for path in [*ROOT.glob("src/**/*.[HC]"), *ROOT.glob("applications/**/*.[HC]")]:
        if "lnInclude" in path.parts:
            continue
        for named in re.findall(r"docs/theory\.md, sections? ([\d., and]+)",
                                path.read_text()):
            for number in re.findall(r"\d+(?:\.\d+)?", named):
                n += 1
                if number not in numbers:
                    lost.append(f"{path.relative_to(ROOT)}: {number}")
    figures.atLeast("sections named", n, 20)
    figures.holds("all are there", not lost, "\n".join(lost))

    # Equations: numbered once, and those referred to exist
    equations = re.findall(r" \((\d+\.\d+)\)$", theory, re.M)
    used = set(re.findall(r"\(([1-9]\d*\.\d+)\)", prose(theory)))
    figures.equal("numbered twice", len(equations) - len(set(equations)), 0)
    figures.equal("without an equation", sorted(used - set(equations)), [])


# --- commands -------------------------------------------------------------

SOLVERS = ["mpmFoam", "setMaterialPoints", "soilElementTest"]


@lru_cache
def help_(name):
    """What a command says of itself; None if it is none of ours"""
    script = ROOT/"etc"/"python"/name
    if script.is_file():
        # Some run in pvpython only
        return script.read_text()
    own = ROOT/"bin"/name
    if own.is_file():
        command = [own, "-h"]
    elif name in SOLVERS:
        command = [name, "-help-full"]
    else:
        return None
    done = subprocess.run(
        command, capture_output=True, text=True,
        env={**os.environ, "MPMFOAM_DIR": str(ROOT),
             "PYTHONPATH": str(ROOT/"etc"/"python")})
    return done.stdout + done.stderr


def commandLines(text):
    """Lines of blocks of code, joined where they go on, and quoted words"""
    blocks = re.findall(r"^```(?:sh|bash)?\n(.*?)^```$", text, re.M | re.S)
    blocks += re.findall(r"^(?: {4}.*\n)+", text, re.M)
    for block in blocks:
        for line in re.sub(r"\\\n", " ", block).splitlines():
            yield re.sub(r"\s#.*", "", line.strip())
    yield from re.findall(r"`([^`\n]+)`", prose(text))


def testOptions(figures):
    lost, n = [], 0
    for path in documents():
        if path.name == "CHANGELOG.md":
            continue
        for line in commandLines(path.read_text()):
            words = [w for w in line.split() if w]
            names = [i for i, w in enumerate(words)
                     if help_(w.rsplit("/", 1)[-1]) is not None]
            for i in names:
                name = words[i].rsplit("/", 1)[-1]
                for word in words[i + 1:]:
                    if word in ("|", "&&", ";", ">", "&"):
                        break
                    option = re.match(r"--?[a-zA-Z][\w-]*", word)
                    if not option:
                        continue
                    n += 1
                    if not re.search(re.escape(option[0]) + r"(?![\w-])",
                                     help_(name)):
                        lost.append(
                            f"{path.relative_to(ROOT)}: {line}: {word}")
            for word in words:
                script = re.fullmatch(
                    r"\"?\$(?:\{?MPMFOAM_DIR\}?)/([\w./-]+)\"?", word)
                if script:
                    n += 1
                    if not (ROOT/script[1]).exists():
                        lost.append(f"{path.relative_to(ROOT)}: {word}")
    figures.atLeast("options and scripts", n, 15)
    figures.holds("all are known", not lost, "\n".join(lost))


def testReadme(tmp_path, figures):
    """Its case, a few steps of it, and its two commands"""
    text = (ROOT/"README.md").read_text()
    figures.atMost("lines of README", len(text.splitlines()), 150)
    for script in ["Allrun", "Alltest", "Allwmake", "etc/provision"]:
        figures.holds(f"{script} can be run", os.access(ROOT/script, os.X_OK))

    block = re.search(r"## A case.*?\n\n((?: {4}[^\n]*\n)+)", text, re.S)[1]
    lines = [line.strip() for line in block.splitlines()
             if "paraview" not in line]
    solve = lines.index("mpmFoam")
    lines[solve:solve] = [
        f"foamDictionary -entry {entry} -set 0.002 system/controlDict"
        " > /dev/null" for entry in ("endTime", "writeInterval")]
    done = subprocess.run(
        ["bash", "-e", "-c", f"cp -r {ROOT}/tutorials .\n" + "\n".join(lines)],
        cwd=tmp_path, capture_output=True, text=True, timeout=600,
        env={**os.environ, "HOME": str(tmp_path)})
    print(done.stdout[-3000:] + done.stderr[-3000:])
    figures.equal("exit status", done.returncode, 0)
    figures.holds("points were written", list(
        (tmp_path/"myCase").glob("0.*/lagrangian/water/positions")))
    shutil.rmtree(tmp_path/"tutorials")
