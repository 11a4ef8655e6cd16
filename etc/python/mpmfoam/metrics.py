"""metrics.json: flat, name -> number (or a word, such as dtLimiter); SI."""

import json
import math
from pathlib import Path


def writeMetrics(path, metrics):
    """Writes name -> value; None is left out, nan and nesting refused"""
    out = {}
    for name, value in metrics.items():
        if value is None:
            continue
        if isinstance(value, str):
            out[name] = value
            continue
        value = value.item() if hasattr(value, "item") else value
        if not isinstance(value, (int, float)):
            raise TypeError(f"metric {name}: {value!r} is no number")
        if not math.isfinite(value):
            raise ValueError(f"metric {name} is {value}")
        # Enough digits to compare runs, few enough to read
        out[name] = float(f"{value:.8g}") if isinstance(value, float) \
            else value
    Path(path).write_text(json.dumps(out, indent=4) + "\n")


def readMetrics(path):
    return json.loads(Path(path).read_text())


def printTable(metrics, title=None):
    """A short table for the terminal"""
    if title:
        print(title)
    width = max(map(len, metrics), default=0)
    for name, value in metrics.items():
        if value is None:
            continue
        text = f"{value:.5g}" if isinstance(value, float) else str(value)
        print(f"    {name:<{width}}  {text}")
