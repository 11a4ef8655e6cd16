"""What is hard for bodies: a thin film down a slope, a jet on a cylinder, soil
that falls on an inclined plate, a body pressed into a corner. Judged by what
physics leaves no choice about: the mechanical energy does not grow, no point is
in a body, nothing is faster than its cause allows."""

import numpy as np
import pytest

from bodies import cylinder, prism, slope, surface
from caseBuilder import G, Setup, box


def solved(setup, path):
    case = setup.write(path/"case")
    case.prepare()
    case.solve()
    return case


def cloudAt(case, time, cloud):
    """Position, velocity and mass of the points"""
    return [case.case.cloudField(time, cloud, f) for f in ["x", "U", "mass"]]


def judge(figures, case, distance, rounding, speed, cloud="water"):
    """Over all written times. A body's distance is sampled every h/2, which
    rounds circles and corners by a part of h."""
    energy, deepest, fastest = [], [], []
    for time in case.times:
        x, U, mass = cloudAt(case, time, cloud)
        energy.append(
            (mass*(0.5*(U**2).sum(axis=1) - x @ np.array(case.setup.g))).sum())
        deepest.append(distance(x[:, :2], float(time)).min())
        fastest.append(np.linalg.norm(U, axis=1).max())
    energy = np.array(energy)
    scale = max(energy[0] - energy.min(), 1e-300)
    figures.atMost("growth of the energy between times, % of what was lost",
                   100*np.diff(energy).max()/scale, 1)
    figures.atLeast("deepest point over h", min(deepest)/case.setup.h, -rounding)
    figures.atMost("fastest point, m/s", max(fastest), speed)


@pytest.mark.parametrize("wall", ["slip", "noSlip"])
def testFilmDownASlope(tmp_path, figures, wall):
    """A drop of two by six cells becomes a film thinner than a cell"""
    h, degrees, through = 0.02, 26.6, (0.3, 0.103)
    t = np.radians(degrees)
    normal = np.array([-np.sin(t), np.cos(t)])
    case = solved(Setup(
        cells=(60, 35), h=h, points=2,
        fluid={"soundSpeed": 35},
        regions={"drop": box((0.85, 0.42), (0.97, 0.48))},
        bodies={"slope": {"type": "fixed",
                          "surface": surface("slope.obj"),
                          "water": {"type": wall}}},
        surfaces={"slope.obj": prism(slope(degrees, through))},
        energy=False).until(0.8, 0.05), tmp_path)
    judge(figures, case, lambda x, time: (x - through) @ normal,
          rounding=1e-9, speed=1.1*np.sqrt(2*G*0.48))


@pytest.mark.parametrize("wall", ["slip", "noSlip"])
def testJetOnACylinder(tmp_path, figures, wall):
    h, radius, centre, speed = 0.02, 0.1, np.array([0.507, 0.303]), 4.0
    case = solved(Setup(
        cells=(50, 50), h=h, points=2, fluid={"soundSpeed": 50},
        regions={"jet": box((0.47, 0.45), (0.57, 0.95),
                            velocity=(0, -speed, 0))},
        bodies={"pipe": {"type": "fixed", "surface": cylinder(centre, radius),
                         "water": {"type": wall}}},
        energy=False).until(0.3, 0.02), tmp_path)
    judge(figures, case,
          lambda x, time: np.linalg.norm(x - centre, axis=1) - radius,
          # Sheets at an impact are faster than what hits
          rounding=0.01, speed=2*np.sqrt(speed**2 + 2*G*0.95))


@pytest.mark.parametrize("wall", [{"frictionCoefficient": 0.4},
                                  {"type": "noSlip"}])
def testSoilFallsOnAPlate(tmp_path, figures, wall):
    h, degrees, speed = 0.02, 30, 3.0
    t = np.radians(degrees)
    along = np.array([np.cos(t), np.sin(t)])
    normal = np.array([-np.sin(t), np.cos(t)])
    middle = np.array([0.507, 0.303])
    corners = [tuple(middle + a*along + b*normal)
               for a, b in [(-0.2, -0.06), (0.2, -0.06), (0.2, 0), (-0.2, 0)]]

    def distance(x, time):
        a, b = (x - middle) @ along, (x - middle) @ normal
        return np.maximum(abs(a) - 0.2, abs(b + 0.03) - 0.03)

    case = solved(Setup(
        cells=(50, 50), h=h, points=2, regions={},
        soilRegions={"sand": box((0.42, 0.5), (0.58, 0.7),
                                 velocity=(0, -speed, 0))},
        bodies={"plate": {"type": "fixed", "surface": surface("plate.obj"),
                          "soil": wall}},
        surfaces={"plate.obj": prism(corners)},
        energy=False).until(0.3, 0.02), tmp_path)
    judge(figures, case, distance, cloud="soil", rounding=0.1,
          speed=1.2*np.sqrt(speed**2 + 2*G*0.7))


@pytest.mark.parametrize("cloud", ["water", "soil"])
def testBodyIntoACorner(tmp_path, figures, cloud):
    """A cylinder comes down into the corner of a full tank to half a cell from
    floor and wall, and stays there"""
    h, radius, speed = 0.02, 0.1, 1.0
    first, last = np.array([0.3, 0.5]), np.array([0.11, 0.11])
    way = last - first
    end = np.linalg.norm(way)/speed
    filling = {"pool": box((0, 0), (0.8, 0.3))}
    case = solved(Setup(
        cells=(40, 40), h=h, points=2, fluid={"soundSpeed": 40},
        soilWall="slip",
        regions=filling if cloud == "water" else {},
        soilRegions=filling if cloud == "soil" else {},
        bodies={"pipe": {
            "type": "prescribed", "surface": cylinder(first, radius),
            "motion": {"displacement": "table ("
                       f"(0 (0 0 0)) ({end} ({way[0]} {way[1]} 0))"
                       f" (10 ({way[0]} {way[1]} 0)))"}}},
        energy=False).until(end + 0.1, 0.1), tmp_path)
    deepest, fastest = [], []
    for time in case.times:
        x, U, _ = cloudAt(case, time, cloud)
        centre = first + way*min(1, float(time)/end)
        deepest.append(
            (np.linalg.norm(x[:, :2] - centre, axis=1) - radius).min())
        fastest.append(np.linalg.norm(U, axis=1).max())
    figures.atLeast("deepest point over h", min(deepest)/h, -0.01)
    figures.atMost("fastest point over the body's speed",
                   max(fastest)/speed, 5)
