#!/usr/bin/env pvpython
"""Pictures of a case, of its points or of the surfaces of water and bed, as
ParaView reads them.

    $MPMFOAM_DIR/etc/pvpythonOffscreen \\
        $MPMFOAM_DIR/etc/python/renderPoints.py [--case <dir>] \\
        [--cloud soil] [--output <dir>] [--show surface] 0.05 0.10 0.15

One PNG per time (default: the last), <clouds>_t<time>.png: water coloured by
speed, soil over it in the colour of sand, with the outline of the mesh and the
time. In 2D what the mesh leaves out of its box is solid, and grey; in 3D walls
inside the box are.

--show surface draws instead what the fields on the mesh enclose: water, and
the grains in it, where they fill half of the cells (the contour 0.5 of
alpha.water + alpha.soil), and over it the bed, where grains fill half of what
they do in the bed, darker where water fills more than half of its pores. What
is thinner than a cell, drops and grains in suspension, is in the points alone.
--show both draws those surfaces over the points: lines in 2D, and in 3D
surfaces that one looks through. Files are <clouds>_surface_t<time>.png and
<clouds>_both_t<time>.png; more than one --show makes pictures of each. A case
without time directories of its own is read from its processor directories;
--decomposed asks for that. --animation makes one moving picture,
<clouds>.gif, of the times named (default: all) instead. Prints for each time
how many points ParaView found:
`<time> s: <n> points, <file>`, or with two clouds `<n> points of <cloud>, ...`;
with surfaces the volume [m3] that each encloses:
`<time> s: ..., surface of water <V> m3, <file>`.
"""

import argparse
import math
import re
import sys
import tempfile
from pathlib import Path

import numpy as np
from PIL import Image
from paraview import servermanager
from paraview.simple import (
    CellDatatoPointData, Clip, ColorBy, CreateRenderView,
    ExtractSurface, FeatureEdges, GetColorTransferFunction, GetScalarBar, Hide,
    HideUnusedScalarBars, OpenFOAMReader, Plane, Render, SaveScreenshot, Show,
    Text, TrivialProducer)
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkPoints
from vtkmodules.vtkCommonDataModel import (
    VTK_HEXAHEDRON, vtkCompositeDataSet, vtkUnstructuredGrid)
from vtkmodules.vtkFiltersCore import (
    vtkAppendFilter, vtkCellDataToPointData, vtkContourFilter,
    vtkPolyDataNormals)
from vtkmodules.vtkFiltersGeneral import vtkClipDataSet
from vtkmodules.vtkFiltersGeometry import vtkDataSetSurfaceFilter
from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter

from mpmfoam import foamDict

WIDTH = 1200        # pixels
TEXT = [0.1, 0.1, 0.1]
SAND = [0.80, 0.62, 0.36]
WET_SAND = [0.62, 0.45, 0.24]
LINE = [0.85, 0.10, 0.10]
SOLID = [0.62, 0.62, 0.64]


def parse():
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawTextHelpFormatter)
    parser.add_argument("times", nargs="*", type=float)
    parser.add_argument("--case", default=".", type=Path)
    parser.add_argument("--cloud", action="append", choices=["water", "soil"],
                        help="cloud to show, may be repeated (default: all of"
                             "\nthe case)")
    parser.add_argument("--show", action="append",
                        choices=["points", "surface", "both"],
                        help="what to draw, may be repeated (default: points)")
    parser.add_argument("--output", type=Path,
                        help="directory of the pictures (default: the case)")
    parser.add_argument("--decomposed", action="store_true",
                        help="read the processor directories")
    parser.add_argument("--animation", nargs="?", type=float, const=0.1,
                        metavar="SECONDS",
                        help="one GIF; how long it shows each time"
                             " (default: 0.1)")
    parser.add_argument("--maxSpeed", type=float,
                        help="end of the colour scale in m/s (default: the"
                             "\n99.9 percentile over all pictures)")
    parser.add_argument("--window", nargs=4, type=float,
                        metavar=("X0", "X1", "Y0", "Y1"),
                        help="part of a 2D case to show [m]")
    return parser.parse_args()


def openCase(case, clouds, decomposed, surfaces=False):
    """Reader of the clouds named (None: all there are), and of the fields that
    surfaces are made of"""
    # ParaView takes the case directory from any file in it
    stub = case/"case.foam"
    stub.touch()
    reader = OpenFOAMReader(FileName=str(stub.resolve()))
    own = any(re.fullmatch(r"[0-9.]+(e-?[0-9]+)?", p.name)
              and float(p.name) > 0 for p in case.iterdir() if p.is_dir())
    parallel = decomposed or (not own and (case/"processor0").is_dir())
    reader.CaseType = "Decomposed Case" if parallel else "Reconstructed Case"
    # Takes effect with Refresh only
    reader.SkipZeroTime = 0
    reader.Refresh()
    reader.UpdatePipelineInformation()
    available = reader.MeshRegions.Available
    if clouds is None:
        clouds = [c for c in ["water", "soil"]
                  if f"lagrangian/{c}" in available] or ["water"]
    regions = [f"lagrangian/{cloud}" for cloud in clouds]
    for region in regions:
        if region not in available:
            sys.exit(f"{case}: ParaView finds no {region}; there is "
                     + " ".join(available))
    reader.MeshRegions = ["internalMesh", *regions]
    fields = ["bodyDistance"]
    if surfaces:
        fields += [f"{name}.{cloud}" for cloud in clouds
                   for name in ("alpha", "U")]
        for cloud in clouds:
            if f"alpha.{cloud}" not in reader.CellArrays.Available:
                sys.exit(f"{case}: ParaView finds no alpha.{cloud}")
    reader.CellArrays = [n for n in reader.CellArrays.Available
                         if n in fields]
    reader.LagrangianArrays = ["U"]
    return reader


def leaves(data):
    """The data sets of a tree of blocks, with the path of their names"""
    iterator = data.NewIterator()
    iterator.InitTraversal()
    while not iterator.IsDoneWithTraversal():
        name = iterator.GetCurrentMetaData().Get(vtkCompositeDataSet.NAME()) \
            if iterator.HasCurrentMetaData() else ""
        yield name or "", iterator.GetCurrentDataObject()
        iterator.GoToNextItem()


def split(data):
    """(points, mesh): the blocks of what the reader gives; points as pairs
    (name of the cloud, block)"""
    clouds, meshes = [], []
    for name, block in leaves(data):
        if block.IsA("vtkPolyData"):
            clouds.append((name, block))
        elif block.GetNumberOfCells():
            meshes.append(block)
    return clouds, meshes


def upAxis(case):
    """The direction against gravity, y where there is none"""
    try:
        text = (case/"constant"/"g").read_text()
        value = re.search(r"value\s+\(([^)]*)\)", text)[1]
        g = np.array(value.split(), dtype=float)
        if np.linalg.norm(g) > 0:
            return -g/np.linalg.norm(g)
    except (OSError, TypeError, ValueError):
        pass
    return np.array([0.0, 1.0, 0.0])


def isFlat(points, cellSize):
    return np.ptp(points[:, 2]) < 1.5*cellSize


def setCamera(view, points, cellSize, up, window=None):
    """Whole mesh, or a window of it, in view. Returns pixels per metre."""
    low, high = points.min(axis=0), points.max(axis=0)
    flat = isFlat(points, cellSize)
    if window and flat:
        low[0], high[0], low[1], high[1] = window
    centre, extent = (low + high)/2, high - low
    view.CameraParallelProjection = 1
    view.CameraFocalPoint = list(centre)
    if flat:
        view.CameraPosition = list(centre + [0, 0, max(extent)])
        view.CameraViewUp = [0, 1, 0]
        width, height = extent[0], extent[1]
    else:
        across = np.cross([0, 0, 1], up) if abs(up[2]) < 0.9 \
            else np.array([0.0, -1.0, 0.0])
        direction = across + np.array([0.45, 0, 0]) + 0.45*up
        direction /= np.linalg.norm(direction)
        view.CameraPosition = list(centre + 2*np.linalg.norm(extent)*direction)
        view.CameraViewUp = list(up)
        right = np.cross(up, direction)
        right /= np.linalg.norm(right)
        upward = np.cross(direction, right)
        width = np.abs(right) @ extent
        height = np.abs(upward) @ extent
    pixels = WIDTH*0.94/width
    # Room for the time above and the colour scale below
    size = [WIDTH, int(height*pixels + 0.14*WIDTH)]
    view.ViewSize = size
    view.CameraParallelScale = 0.5*size[1]/pixels
    return pixels


def paint(display, colour):
    """One colour, whatever the light"""
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour
    display.Ambient, display.Diffuse, display.Specular = 1, 0, 0


def showSolids(surface, view, points, cellSize):
    """The box of a 2D mesh in grey, and the mesh on it in white"""
    low, high = points.min(axis=0), points.max(axis=0)
    display = Show(surface, view)
    display.SetRepresentationType("Surface")
    paint(display, [1, 1, 1])
    display.Position = [0, 0, -2*cellSize]
    box = Plane(Origin=[low[0], low[1], low[2]],
                Point1=[high[0], low[1], low[2]],
                Point2=[low[0], high[1], low[2]])
    display = Show(box, view)
    display.SetRepresentationType("Surface")
    paint(display, SOLID)
    display.Position = [0, 0, -3*cellSize]


def showBodies(mesh, view, lift):
    """Where the distance to bodies is negative, in grey"""
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(mesh)
    producer.UpdatePipeline()
    inside = Clip(Input=CellDatatoPointData(Input=producer),
                  ClipType="Scalar", Scalars=["POINTS", "bodyDistance"],
                  Value=0, Invert=1)
    shown = ExtractSurface(Input=inside)
    display = Show(shown, view)
    display.SetRepresentationType("Surface")
    paint(display, SOLID)
    display.Position = lift
    return shown


def plates(case):
    """Corners of the thin plates of a case, which have hardly a negative
    distance"""
    bodies = foamDict.read(
        case/"constant"/"materialPointProperties").get("bodies", {})
    for body in bodies.values():
        surface = body.get("surface", {}) if isinstance(body, dict) else {}
        if surface.get("type") != "plate":
            continue
        start, end = (np.array(surface[key], dtype=float)
                      for key in ["start", "end"])
        across = np.array(surface.get("across", (0, 0, 0)), dtype=float)
        yield start, end, across, float(surface["thickness"])


def showPlates(case, view, meshPoints, pixel, lift):
    """Thin plates in grey, two pixels thick at least"""
    low, high = meshPoints.min(axis=0), meshPoints.max(axis=0)
    flat = np.argmin(high - low)
    for start, end, across, thickness in plates(case):
        if not across.any():
            # Across the plane of the case
            start[flat] = end[flat] = 0.5*(low + high)[flat]
            across[flat] = (high - low)[flat]
        normal = np.cross(end - start, across)
        normal *= max(thickness, 2*pixel)/np.linalg.norm(normal)
        points = vtkPoints()
        for k in (-0.5, 0.5):
            for at, side in [(start, -0.5), (end, -0.5), (end, 0.5),
                             (start, 0.5)]:
                x = at + side*across + k*normal
                points.InsertNextPoint(np.clip(x, low, high))
        solid = vtkUnstructuredGrid()
        solid.SetPoints(points)
        solid.InsertNextCell(VTK_HEXAHEDRON, 8, range(8))
        display = Show(producerOf(solid), view)
        display.SetRepresentationType("Surface")
        paint(display, SOLID)
        display.Position = lift


def showHoles(surface, view):
    """Walls inside the box of a 3D mesh, in grey"""
    surface.UpdatePipeline()
    walls = vtkUnstructuredGrid()
    data = servermanager.Fetch(surface)
    points = vtk_to_numpy(data.GetPoints().GetData())
    low, high = points.min(axis=0), points.max(axis=0)
    tolerance = 1e-6*max(high - low)
    walls.SetPoints(data.GetPoints())
    walls.Allocate(1)
    for i in range(data.GetNumberOfCells()):
        cell = data.GetCell(i)
        corners = vtk_to_numpy(cell.GetPoints().GetData())
        flat = np.ptp(corners, axis=0) < tolerance
        ends = (abs(corners[0] - low) < tolerance) \
            | (abs(corners[0] - high) < tolerance)
        if not (flat & ends).any():
            walls.InsertNextCell(cell.GetCellType(), cell.GetPointIds())
    if not walls.GetNumberOfCells():
        return
    display = Show(producerOf(walls), view)
    display.SetRepresentationType("Surface")
    light(display, SOLID)


# --- surfaces ---------------------------------------------------------------

def producerOf(data):
    producer = TrivialProducer()
    producer.GetClientSideObject().SetOutput(data)
    producer.UpdatePipeline()
    return producer


def light(display, colour):
    """One colour, in the light"""
    display.ColorArrayName = ["POINTS", ""]
    display.AmbientColor = display.DiffuseColor = colour
    display.Ambient, display.Diffuse, display.Specular = 0.35, 0.7, 0.05


def cellArray(mesh, name, default=0.0):
    array = mesh.GetCellData().GetArray(name)
    return vtk_to_numpy(array) if array \
        else np.full(mesh.GetNumberOfCells(), default)


def setArray(data, name, values):
    array = numpy_to_vtk(np.ascontiguousarray(values, dtype=float), deep=True)
    array.SetName(name)
    data.AddArray(array)


def merged(meshes):
    """One mesh of those of all ranks"""
    append = vtkAppendFilter()
    append.MergePointsOn()
    for mesh in meshes:
        append.AddInputData(mesh)
    append.Update()
    mesh = vtkUnstructuredGrid()
    mesh.ShallowCopy(append.GetOutput())
    return mesh


def nodalFields(meshes):
    """One mesh, with the means of its cells at its points: filled by liquid
    and grains, grains, saturation of the pores and speed of the liquid (these
    two weighted by what is there)"""
    mesh = merged(meshes)
    water, soil = cellArray(mesh, "alpha.water"), cellArray(mesh, "alpha.soil")
    U = mesh.GetCellData().GetArray("U.water")
    speed = np.linalg.norm(vtk_to_numpy(U), axis=1) if U \
        else np.zeros_like(water)
    for name, values in {"water": water, "soil": soil, "momentum": water*speed,
                         }.items():
        setArray(mesh.GetCellData(), name, values)
    toPoints = vtkCellDataToPointData()
    toPoints.SetInputData(mesh)
    toPoints.Update()
    mesh = vtkUnstructuredGrid()
    mesh.ShallowCopy(toPoints.GetOutput())

    data = mesh.GetPointData()
    water, soil, momentum = (vtk_to_numpy(data.GetArray(n)).astype(float)
                             for n in ("water", "soil", "momentum"))
    setArray(data, "filled", water + soil)
    setArray(data, "saturation",
             water/np.maximum(1 - np.minimum(soil, 0.95), 0.05))
    setArray(data, "speed", momentum/np.maximum(water, 1e-6))
    return mesh


def bedLevel(meshes):
    """Half of the solid fraction of beds; nan without"""
    alpha = np.concatenate([cellArray(m, "alpha.soil") for m in meshes])
    if not alpha.max() > 0.1:
        return float("nan")
    return 0.5*float(np.percentile(alpha[alpha > 0.5*alpha.max()], 50))


def enclosed(mesh, name, level):
    """What a contour encloses, and its volume"""
    clip = vtkClipDataSet()
    clip.SetInputData(mesh)
    clip.SetInputArrayToProcess(0, 0, 0, 0, name)
    clip.SetValue(level)
    clip.Update()
    size = vtkCellSizeFilter()
    size.SetInputData(clip.GetOutput())
    size.ComputeVertexCountOff()
    size.ComputeLengthOff()
    size.ComputeAreaOff()
    size.Update()
    volume = size.GetOutput().GetCellData().GetArray("Volume")
    surface = vtkDataSetSurfaceFilter()
    surface.SetInputData(clip.GetOutput())
    normals = vtkPolyDataNormals()
    normals.SetInputConnection(surface.GetOutputPort())
    normals.SetFeatureAngle(45)
    normals.Update()
    return normals.GetOutput(), \
        float(vtk_to_numpy(volume).sum()) if volume else 0.0


def contour(mesh, name, level):
    """The contour itself, without what walls cut off"""
    line = vtkContourFilter()
    line.SetInputData(mesh)
    line.SetInputArrayToProcess(0, 0, 0, 0, name)
    line.SetValue(0, level)
    line.Update()
    return line.GetOutput()


def colourBySpeed(display, view, name, maxSpeed):
    ColorBy(display, ("POINTS", name, "Magnitude") if name == "U"
            else ("POINTS", name))
    scale = GetColorTransferFunction(name)
    scale.ApplyPreset("Viridis (matplotlib)", True)
    scale.VectorMode = "Magnitude"
    scale.RescaleTransferFunction(0, maxSpeed)
    bar = GetScalarBar(scale, view)
    bar.Title, bar.ComponentTitle = "speed of the water [m/s]", ""
    bar.Orientation = "Horizontal"
    bar.WindowLocation = "Any Location"
    bar.Position = [0.30, 0.03]
    bar.ScalarBarLength = 0.4
    bar.ScalarBarThickness = 12
    bar.TitleFontSize = bar.LabelFontSize = 12
    bar.TitleColor = bar.LabelColor = TEXT
    bar.AddRangeLabels = 1
    bar.RangeLabelFormat = bar.LabelFormat = "%.3g"
    display.SetScalarBarVisibility(view, True)


def colourByWetness(display):
    ColorBy(display, ("POINTS", "saturation"))
    scale = GetColorTransferFunction("saturation")
    scale.RGBPoints = [0.4, *SAND, 0.6, *WET_SAND]


def showSurfaces(mesh, clouds, level, view, flat, lift, maxSpeed):
    """Filled, in the light in 3D. Returns what is shown and the volumes"""
    shown, volumes = [], {}
    for name, field, value in [("water", "filled", 0.5),
                               ("soil", "soil", level)]:
        if name not in clouds or not np.isfinite(value):
            continue
        surface, volumes[name] = enclosed(mesh, field, value)
        if not surface.GetNumberOfCells():
            continue
        producer = producerOf(surface)
        display = Show(producer, view)
        display.SetRepresentationType("Surface")
        if name == "water":
            colourBySpeed(display, view, "speed", maxSpeed)
        else:
            colourByWetness(display)
            display.SetScalarBarVisibility(view, False)
            display.Position = lift
        if flat:
            display.Ambient, display.Diffuse, display.Specular = 1, 0, 0
        else:
            display.Ambient, display.Diffuse = 0.35, 0.7
            display.Specular = 0.05
        shown.append(producer)
    return shown, volumes


def showContours(mesh, clouds, level, view, flat, lift):
    """Over the points: lines in 2D, else what one looks through"""
    shown, volumes = [], {}
    for name, field, value, colour in [
            ("water", "filled", 0.5, LINE), ("soil", "soil", level, TEXT)]:
        if name not in clouds or not np.isfinite(value):
            continue
        volumes[name] = enclosed(mesh, field, value)[1]
        surface = contour(mesh, field, value)
        if not surface.GetNumberOfCells():
            continue
        producer = producerOf(surface)
        display = Show(producer, view)
        if flat:
            # Seen from the side a surface is a line
            display.SetRepresentationType("Wireframe")
            display.LineWidth = 2
            paint(display, colour)
            display.Position = [2*v for v in lift]
        else:
            display.SetRepresentationType("Surface")
            light(display, SAND if name == "soil" else [0.4, 0.6, 0.9])
            display.Opacity = 0.35
        shown.append(producer)
    return shown, volumes


# --- points -----------------------------------------------------------------

def showSoil(points, view, pixelSize, lift):
    """In front of the water in its pores"""
    display = Show(points, view)
    display.SetRepresentationType("Points")
    display.PointSize = pixelSize
    paint(display, SAND)
    display.Position = lift
    return display


def showWater(points, view, maxSpeed, pixelSize):
    display = Show(points, view)
    display.SetRepresentationType("Points")
    display.PointSize = pixelSize
    colourBySpeed(display, view, "U", maxSpeed)
    return display


def main():
    arguments = parse()
    case = arguments.case
    target = arguments.output or case
    target.mkdir(parents=True, exist_ok=True)
    # Pictures of a film leave no files, and replace none
    frames = tempfile.TemporaryDirectory() if arguments.animation else None
    output = Path(frames.name) if frames else target
    modes = arguments.show or ["points"]
    surfaces = modes != ["points"]
    reader = openCase(case, arguments.cloud, arguments.decomposed, surfaces)
    cloudNames = [r.split("/")[1] for r in reader.MeshRegions
                  if r.startswith("lagrangian/")]
    names = "_".join(cloudNames)

    available = list(reader.TimestepValues)
    if not available:
        sys.exit(f"{case}: no times")
    times = [min(available, key=lambda t: abs(t - wanted))
             for wanted in arguments.times] \
        or (available if arguments.animation else available[-1:])

    # One pass to know the colour scale and the spacing of the points
    found, meshesOf, speeds = {}, {}, []
    for time in times:
        reader.UpdatePipeline(time)
        clouds, meshes = split(servermanager.Fetch(reader))
        found[time], meshesOf[time] = clouds, meshes
        speeds += [np.linalg.norm(vtk_to_numpy(
            block.GetPointData().GetArray("U")), axis=1)
            for name, block in clouds
            if name == "water" and block.GetNumberOfPoints()]
    speeds = np.concatenate(speeds or [np.zeros(1)])
    maxSpeed = arguments.maxSpeed or float(np.percentile(speeds, 99.9)) or 1.0

    meshPoints = np.concatenate([vtk_to_numpy(m.GetPoints().GetData())
                                 for m in meshes])
    corners = vtk_to_numpy(
        next(m for m in meshes).GetCell(0).GetPoints().GetData())
    cellSize = float(np.ptp(corners, axis=0).max())

    view = CreateRenderView()
    view.Background = [1, 1, 1]
    view.UseColorPaletteForBackground = 0
    view.OrientationAxesVisibility = 0
    up = upAxis(case)
    pixels = setCamera(view, meshPoints, cellSize, up, arguments.window)

    surface = ExtractSurface(Input=producerOf(merged(meshes)))
    outline = Show(FeatureEdges(Input=surface, BoundaryEdges=0,
                                FeatureAngle=30), view)
    outline.AmbientColor = outline.DiffuseColor = TEXT
    outline.LineWidth = 1.5
    flat = isFlat(meshPoints, cellSize)
    if flat:
        showSolids(surface, view, meshPoints, cellSize)
    else:
        showHoles(surface, view)
    # Of the first time: grains that have spread are no bed
    level = bedLevel(meshesOf[times[0]]) if surfaces else float("nan")

    # In front of the water as the camera sees it
    towards = np.array(view.CameraPosition) - np.array(view.CameraFocalPoint)
    lift = list(cellSize*towards/np.linalg.norm(towards)) \
        if flat else [0, 0, 0]
    showPlates(case, view, meshPoints, 1/pixels, [2*c for c in lift])

    label = Text()
    labelDisplay = Show(label, view)
    labelDisplay.WindowLocation = "Upper Left Corner"
    labelDisplay.FontSize = 16
    labelDisplay.Color = TEXT

    for mode in modes:
        shown = names if mode == "points" else f"{names}_{mode}"
        pictures = []
        for time in times:
            blocks = [(name, b) for name, b in found[time]
                      if b.GetNumberOfPoints()]
            counts = {}
            view.ViewTime = time
            reader.UpdatePipeline(time)
            label.Text = f"t = {time:.4g} s"

            producers = [
                showBodies(mesh, view, lift) for mesh in meshesOf[time]
                if mesh.GetCellData().HasArray("bodyDistance")]
            volumes = {}
            if mode != "points":
                mesh = nodalFields(meshesOf[time])
                more, volumes = \
                    showSurfaces(mesh, cloudNames, level, view, flat, lift,
                                 maxSpeed) \
                    if mode == "surface" \
                    else showContours(mesh, cloudNames, level, view, flat, lift)
                producers += more
            for name, block in blocks:
                counts[name] = counts.get(name, 0) + block.GetNumberOfPoints()
                if mode == "surface":
                    continue
                producer = producerOf(block)
                points = vtk_to_numpy(block.GetPoints().GetData())
                size = max(1.5, pointSpacing(points, corners)*pixels)
                if name == "soil":
                    showSoil(producer, view, size, lift)
                else:
                    showWater(producer, view, maxSpeed, size)
                producers.append(producer)

            # The first rendering of a view moves its camera
            Render(view)
            setCamera(view, meshPoints, cellSize, up, arguments.window)
            path = output/f"{shown}_t{time:.10g}.png"
            SaveScreenshot(str(path), view, ImageResolution=view.ViewSize)
            pictures.append(path)
            for producer in producers:
                Hide(producer, view)
            HideUnusedScalarBars(view)
            number = ", ".join(f"{n} points of {name}" if len(counts) > 1
                               else f"{n} points" for name, n in counts.items())
            enclosing = "".join(f", surface of {n} {V:.6g} m3"
                                for n, V in volumes.items())
            print(f"{time:.10g} s: {number or '0 points'}{enclosing}, {path}")

        if arguments.animation:
            animate(pictures, target/f"{shown}.gif", arguments.animation)


def animate(pictures, path, seconds):
    """One GIF of the pictures"""
    frames = [Image.open(picture).convert("P", palette=Image.ADAPTIVE)
              for picture in pictures]
    frames[0].save(path, save_all=True, append_images=frames[1:],
                   duration=1000*seconds, loop=0)
    print(f"{len(frames)} times, {path}")


def pointSpacing(points, corners):
    """Mean distance of points: a cell's size over the root of how many it
    holds, in the median of the cells that hold any"""
    size = np.ptp(corners, axis=0)
    cells = np.floor(points/size).astype(np.int64)
    _, counts = np.unique(cells, axis=0, return_counts=True)
    flat = np.ptp(points[:, 2]) < size[2]
    return float(size.max())/math.pow(np.median(counts), 1/2 if flat else 1/3)


if __name__ == "__main__":
    main()
