"""terrainToSurface: heights become a closed surface, for bodies and regions."""

import numpy as np
import pytest

from mpmfoam import terrain

ASC = """ncols 4
nrows 3
xllcorner 100
yllcorner 200
cellsize 10
NODATA_value -9999
3 2 2 3
2 1 1 2
3 2 2 4
"""


def testTerrain(tmp_path, figures):
    """A closed surface, its faces outwards, through the heights given"""
    (tmp_path/"dem.asc").write_text(ASC)
    (tmp_path/"line.csv").write_text("x,z\n0,1\n2,3\n4,1\n")
    for source, shift, inside, volume in [
            # 2D: up is y; 12 long and across, with the margins, 4 over the
            # bottom and a triangle
            ("line.csv", (0, 0, 0), (2, 3, 2), (12*4 + 4*2/2)*12),
            ("dem.asc", (-100, -200, 0), (35, 5, 4), None)]:
        terrain.main([str(tmp_path/source), str(tmp_path/"out.obj"),
                      "--shift", *map(str, shift), "--depth", "4",
                      "--margin", "4"])
        lines = (tmp_path/"out.obj").read_text().splitlines()
        points = np.array([line.split()[1:] for line in lines
                           if line[0] == "v"], float)
        faces = np.array([line.split()[1:] for line in lines
                          if line[0] == "f"], int) - 1
        edges = [(f[k], f[(k + 1) % 3]) for f in faces.tolist()
                 for k in range(3)]
        figures.equal("edges in one direction twice",
                      len(edges) - len(set(edges)), 0)
        figures.equal("edges of one face only",
                      [e for e in edges if e[::-1] not in set(edges)], [])
        found = terrain.volume(points, faces)
        if volume:
            figures.atMost("volume off", abs(found/volume - 1), 1e-12)
        figures.atLeast("volume", found, 0)
        figures.atMost("nearest to a height that was given", float(
            np.abs(points - inside).sum(axis=1).min()), 1e-9)
    for text, what in [(ASC[:-2], "heights"),
                       (ASC.replace("ncols 4", "ncols"), "line 1"),
                       (ASC.replace("1 1", "1 -9999"), "NODATA"),
                       (ASC.replace("cellsize 10\n", ""), "cellsize")]:
        (tmp_path/"dem.asc").write_text(text)
        with pytest.raises(SystemExit) as error:
            terrain.readGrid(tmp_path/"dem.asc")
        figures.holds(f"error names {what}", what in str(error.value))
