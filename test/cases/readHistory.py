#!/usr/bin/env pvpython
"""What ParaView's XDMFReader finds in indices of materialPointHDF5, as JSON on
the last line: for each file and time the number of points and cells, the
arrays with their components, and means.

    $MPMFOAM_DIR/etc/pvpythonOffscreen readHistory.py water.xdmf soil.xdmf
"""

import json
import sys

import numpy as np
from paraview import servermanager, simple
from vtkmodules.util.numpy_support import vtk_to_numpy


def look(reader, time):
    reader.UpdatePipeline(time)
    data = servermanager.Fetch(reader)
    if data is None or data.GetNumberOfPoints() == 0:
        return {"points": 0}
    arrays = [data.GetPointData().GetArray(i)
              for i in range(data.GetPointData().GetNumberOfArrays())]
    return {"points": data.GetNumberOfPoints(),
            "cells": data.GetNumberOfCells(),
            "arrays": {a.GetName(): vtk_to_numpy(a).reshape(
                data.GetNumberOfPoints(), -1).mean(axis=0).tolist()
                for a in arrays},
            "x": np.asarray(vtk_to_numpy(
                data.GetPoints().GetData())).mean(axis=0).tolist()}


def main():
    out = {}
    for path in sys.argv[1:]:
        reader = simple.XDMFReader(FileNames=[path])
        out[path] = [[time, look(reader, time)]
                     for time in reader.TimestepValues]
    print(json.dumps(out))


if __name__ == "__main__":
    main()
