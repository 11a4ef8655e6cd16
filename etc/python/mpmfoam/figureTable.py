"""A table of figures of many small runs: a row for each run and figure, with
what was asked of it. A run whose rows are there is not made again.

    main(__doc__, HERE, HERE/"results"/"bodies.csv",
         {"cylinder": lambda name: ...})

Each run is a function of its name that yields (figure, value, asked), and
whether that holds where its text does not tell."""

import argparse
import csv
import fnmatch
import re
import subprocess

FIELDS = ["run", "figure", "value", "asked", "holds", "commit"]


def holds(value, asked):
    """Of bounds and of values with a part in percent; empty for others"""
    bound = re.match(r"([<>])=? ?([-\d.]+)$", asked)
    if bound:
        limit = float(bound[2])
        return abs(value) <= limit if bound[1] == "<" else value >= limit
    near = re.match(r"([\d.]+) \+- (\d+) %", asked)
    if near:
        return abs(value/float(near[1]) - 1) <= float(near[2])/100
    return ""


def read(path):
    """All rows; none without the file"""
    if not path.is_file():
        return []
    with path.open() as file:
        return list(csv.DictReader(file))


def write(path, rows):
    path.parent.mkdir(exist_ok=True)
    with path.open("w", newline="") as file:
        writer = csv.DictWriter(file, FIELDS, lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)


def main(description, here, results, contents):
    """Make the runs that are named on the command line, or all"""
    parser = argparse.ArgumentParser(description=description)
    parser.add_argument("patterns", nargs="*", default=["*"])
    parser.add_argument("--list", action="store_true")
    arguments = parser.parse_args()

    rows = read(results)
    done = {row["run"] for row in rows}
    commit = subprocess.run(
        ["git", "-C", str(here), "describe", "--always", "--dirty"],
        capture_output=True, text=True, check=True).stdout.strip()
    for name, run in contents.items():
        if not any(fnmatch.fnmatch(name, p) for p in arguments.patterns):
            continue
        if arguments.list or name in done:
            print(f"{'finished' if name in done else 'to do':9s} {name}")
            continue
        for figure, value, asked, *verdict in run(name):
            rows.append({"run": name, "figure": figure,
                         "value": f"{value:.4g}", "asked": asked,
                         "holds": verdict[0] if verdict
                         else holds(value, asked), "commit": commit})
            print(f"{name}: {figure} {value:.4g} (asked {asked})", flush=True)
        write(results, rows)
