#!/usr/bin/env python3
"""Makes damBreak.png of the README from the pictures of tutorials/damBreak.

    $MPMFOAM_PYTHON docs/pictures/damBreak.py [case]

Run the case's Allrun before.
"""

import sys
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent
WIDTH = 560             # of one of the four pictures, in pixels
COLOURS = 160


def panel(path):
    """A picture without the empty upper part of the tank, its title kept"""
    picture = Image.open(path).convert("RGB")
    width, height = picture.size
    title = picture.crop((0, 0, width//8, height//30))
    body = picture.crop((0, int(0.30*height), width, int(0.925*height)))
    small = body.resize((WIDTH, WIDTH*body.height//width), Image.LANCZOS)
    small.paste(title, (WIDTH//20, WIDTH//60))
    return small


def legend(path):
    picture = Image.open(path).convert("RGB")
    width, height = picture.size
    scale = picture.crop((width//4, int(0.925*height), width*3//4, height))
    return scale.resize((WIDTH, WIDTH*scale.height//scale.width), Image.LANCZOS)


def main():
    case = Path(sys.argv[1] if len(sys.argv) > 1
                else HERE.parents[1]/"tutorials"/"damBreak")
    files = [case/f"water_t{t}.png" for t in ("0.05", "0.1", "0.15", "0.18")]
    panels = [panel(f) for f in files]
    width, height = panels[0].size
    scale = legend(files[0])

    sheet = Image.new("RGB", (2*width, 2*height + scale.height), "white")
    for i, picture in enumerate(panels):
        sheet.paste(picture, (width*(i % 2), height*(i//2)))
    sheet.paste(scale, (width//2, 2*height))

    file = HERE/"damBreak.png"
    sheet.quantize(COLOURS).save(file, optimize=True)
    print(f"{file}: {file.stat().st_size/1000:.0f} kB")


main()
