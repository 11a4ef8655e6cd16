#!/usr/bin/env pvpython
"""What ParaView finds of the cloud water, as JSON on the last line: for each
case and time the number of points, of values of U, and the means.

    $MPMFOAM_DIR/etc/pvpythonOffscreen countPoints.py <case> <case>:decomposed ...
"""

import json
import os
import sys
from pathlib import Path

sys.path.append(os.path.join(os.environ["MPMFOAM_DIR"], "etc", "python"))

import numpy as np  # noqa: E402
from paraview import servermanager  # noqa: E402
from vtkmodules.util.numpy_support import vtk_to_numpy  # noqa: E402

from renderPoints import openCase, split  # noqa: E402


def count(reader, time):
    reader.UpdatePipeline(time)
    x, U = [np.empty((0, 3))], [np.empty((0, 3))]
    for _, cloud in split(servermanager.Fetch(reader))[0]:
        if cloud.GetNumberOfPoints():
            x.append(vtk_to_numpy(cloud.GetPoints().GetData()))
            array = cloud.GetPointData().GetArray("U")
            if array:
                U.append(vtk_to_numpy(array))
    x, U = np.concatenate(x), np.concatenate(U)
    return {"points": len(x), "values": len(U),
            "x": x.mean(axis=0).tolist() if len(x) else None,
            "U": U.mean(axis=0).tolist() if len(U) else None}


def main():
    out = {}
    for case in sys.argv[1:]:
        path, _, decomposed = case.partition(":")
        reader = openCase(Path(path), ["water"], bool(decomposed))
        out[case] = {f"{time:.6g}": count(reader, time)
                     for time in reader.TimestepValues}
    print(json.dumps(out))


if __name__ == "__main__":
    main()
