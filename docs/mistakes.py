#!/usr/bin/env python3
"""Makes docs/mistakes.md: runs each case of test/cases/test_mistakes.py and
writes down what it prints. After source etc/bashrc:

    $MPMFOAM_PYTHON docs/mistakes.py
"""

import re
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(ROOT/"test"/"cases"), str(ROOT/"etc"/"python")]

from test_mistakes import MISTAKES, make, messages  # noqa: E402

HEAD = """# Mistakes, and what is said of them

What used to run on in silence, or ended with a message that did not help. An
*error* ends the application, a *warning* and what is *said* in the log do not.
Made by `docs/mistakes.py` from the real output of the cases of
`test/cases/test_mistakes.py`, which tests each of them; do not edit.
`test/cases/test_badInput.py` has the misspelt, missing and unknown entries.

| | mistake | where | told | message |
|---|---|---|---|---|
"""


def told(mistake, case):
    """The message in one line of a table, without OpenFOAM's frame"""
    found = messages(mistake, make(mistake, case))
    text = max(found, key=lambda m: sum(
        bool(re.search(p, re.sub(r"\s+", " ", m))) for p in mistake.expect))
    lines = []
    for line in text.splitlines():
        line = line.strip()
        if line.startswith(("--> FOAM", "From ", "in file", "FOAM ")):
            continue
        if line:
            lines.append(line)
    text = "<br>".join(lines).replace(f"{case}/", "").replace("|", "\\|")
    return re.sub(r"<(?!br>)", "&lt;", text)


def main():
    rows = []
    with tempfile.TemporaryDirectory() as directory:
        for i, m in enumerate(MISTAKES):
            message = told(m, Path(directory)/m.name)
            rows.append(f"| {i + 1} | {m.what} | {m.where} | {m.kind} | "
                        f"{message} |\n")
            print(f"{i + 1}/{len(MISTAKES)} {m.name}", flush=True)
    (ROOT/"docs"/"mistakes.md").write_text(HEAD + "".join(rows))


if __name__ == "__main__":
    main()
