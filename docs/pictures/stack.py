#!/usr/bin/env python3
"""Pictures of a case one below the other, small enough for the repository.

    $MPMFOAM_PYTHON docs/pictures/stack.py <output.png> [--width 1000] [--cut 0] \\
        <picture> ...

From each what is white above and below goes, the time stays; the colour scale stays
with the last. embankment.png: of the case of docs/howto/embankment.md, overtopping.png
and damBreakObstacle3D.png: of the tutorials, water_soil_surface_t4.png, ...
"""

import argparse
from pathlib import Path

import numpy as np
from PIL import Image

# Of renderPoints.py: room for the time above and the scale below, over the width
ABOVE, BELOW = 0.06, 0.08


def panel(path, last, cut):
    picture = Image.open(path).convert("RGB")
    width, height = picture.size
    title = picture.crop((0, 0, width//8, int(0.03*width)))
    low, high = int(0.03*width), height - int(BELOW*width)
    rows = np.flatnonzero(
        (np.asarray(picture)[low:high] < 250).any(axis=(1, 2)))
    top = low + rows[0] - 2 + int(cut*(rows[-1] - rows[0]))
    bottom = height if last else low + rows[-1] + 3
    out = Image.new("RGB", (width, bottom - top + title.height), "white")
    out.paste(title, (0, 0))
    out.paste(picture.crop((0, top, width, bottom)), (0, title.height))
    return out


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("output", type=Path)
    parser.add_argument("--width", type=int, default=1000)
    parser.add_argument("--cut", type=float, default=0,
                        help="part of the height to leave out above")
    parser.add_argument("pictures", nargs="+", type=Path)
    options = parser.parse_args()
    panels = [panel(p, p == options.pictures[-1], options.cut) for p in options.pictures]
    sheet = Image.new("RGB", (max(p.width for p in panels),
                              sum(p.height for p in panels)), "white")
    at = 0
    for picture in panels:
        sheet.paste(picture, (0, at))
        at += picture.height
    size = (options.width, round(sheet.height*options.width/sheet.width))
    # The usual choice of colours would paint fast water in that of sand
    sheet.resize(size, Image.LANCZOS).quantize(
        256, method=Image.MAXCOVERAGE).save(options.output, optimize=True)
    print(f"{options.output}: {options.output.stat().st_size/1000:.0f} kB")


main()
