"""Bodies of any shape: surfaces for caseBuilder, and what their scenes show."""

import re

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


def solved(setup, path):
    case = setup.write(path)
    case.prepare()
    case.solve()
    return case


def sameOnTwoRanks(figures, scene, path, cuts=((2, 1, 1),)):
    """What two ranks find, for each way to part the mesh, and one"""
    one = solved(scene(), path/"one")
    for n in cuts:
        two = scene().write(path/f"two{n[0]}")
        two.prepare()
        two.decompose(2, n)
        two.solve(ranks=2)
        a, b = one.points(), two.points()
        figures.atMost("positions, m", abs(a.x - b.x).max(), 1e-10)
        figures.atMost("velocities, m/s", abs(a.U - b.U).max(), 1e-10)


def sameAfterRestart(figures, scene, path):
    """Two halves of a run to 0.04 s and the whole; scene takes its end"""
    whole = solved(scene(), path/"whole")
    parts = solved(scene(0.02), path/"parts")
    control = parts.path/"system"/"controlDict"
    control.write_text(re.sub(
        r"endTime [^;]*;", "endTime 0.04;", control.read_text()))
    parts.solve()
    for cloud in whole.setup.clouds:
        for name in ["x", "U"]:
            a, b = (case.case.cloudField("0.04", cloud, name)
                    for case in [whole, parts])
            figures.holds(f"{name} of {cloud} the same to the last bit",
                          (a == b).all())
