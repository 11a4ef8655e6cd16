"""Thin plates: bodies for caseBuilder, and on which side of them points are."""

import numpy as np


def plate(start, end, thickness, **entries):
    """A fixed plate"""
    def point(x):
        return tuple(float(c) for c in x) + (0.0,)*(3 - len(x))
    across = {"across": entries.pop("across")} if "across" in entries else {}
    return {"type": "fixed", "surface": {
        "type": "plate", "start": point(start), "end": point(end),
        "thickness": thickness, **across}, **entries}


def inclined(foot, degrees, length):
    """Start and end of a plate that rises from its foot"""
    t = np.radians(degrees)
    foot = np.array(foot, dtype=float)
    return foot, foot + length*np.array([np.cos(t), np.sin(t)])


def height(x, start, end):
    """Distance from the middle plane, positive to the left of the way from
    start to end"""
    along = (end - start)/np.linalg.norm(end - start)
    return (x[:, :2] - start) @ np.array([-along[1], along[0]])


def polygon(*corners, **entries):
    """A region"""
    return {"type": "polygon", "points": [tuple(float(v) for v in c) for c in corners],
            **entries}
