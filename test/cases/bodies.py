"""Bodies of any shape: surfaces for caseBuilder, and what their scenes show."""

import numpy as np


def prism(corners, depth=10.0):
    """A polygon (counter-clockwise, in x and y) drawn out along z, as the text
    of an OBJ file"""
    n = len(corners)
    text = "".join(f"v {x:.12g} {y:.12g} {z:.12g}\n"
                   for z in (-depth, depth) for x, y in corners)
    faces = []
    for i in range(1, n - 1):
        faces.append((1, i + 2, i + 1))
        faces.append((n + 1, n + i + 1, n + i + 2))
    for i in range(n):
        j = (i + 1) % n
        faces.append((i + 1, j + 1, n + j + 1))
        faces.append((i + 1, n + j + 1, n + i + 1))
    return text + "".join("f %d %d %d\n" % f for f in faces)


def surface(name):
    """The body's entry for a file"""
    return {"type": "surface", "file": f'"{name}"'}


def cylinder(centre, radius):
    """Across the plane of a case in x and y"""
    x, y = centre
    return {"type": "cylinder", "point1": (x, y, -10.0), "point2": (x, y, 10.0),
            "radius": radius}


def slope(degrees, through, length=10.0):
    """All that lies below an inclined line through a point, as a polygon. It
    rises with x."""
    t = np.radians(degrees)
    along = np.array([np.cos(t), np.sin(t)])
    normal = np.array([-np.sin(t), np.cos(t)])
    a = np.array(through) - length*along
    b = np.array(through) + length*along
    return [tuple(a - length*normal), tuple(b - length*normal), tuple(b),
            tuple(a)]
