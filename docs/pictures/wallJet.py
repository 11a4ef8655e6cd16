#!/usr/bin/env python3
"""Makes wallJet.png of the README from the pictures of tutorials/wallJet.

    $MPMFOAM_PYTHON docs/pictures/wallJet.py [case]

Run the case's Allrun before.
"""

import sys
from pathlib import Path

from PIL import Image

HERE = Path(__file__).resolve().parent
TIMES = ["0.1", "0.5", "1", "2.5"]
# Fewer would paint fast water in the colour of sand
COLOURS = 220


def panel(path, last):
    """A picture without the air above the flow, its title kept; the scale is
    the same in all and stays with the last"""
    picture = Image.open(path).convert("RGB")
    width, height = picture.size
    title = picture.crop((0, 0, width//8, int(0.06*height)))
    body = picture.crop((0, int(0.36*height), width,
                         height if last else int(0.86*height)))
    body.paste(title, (int(0.42*width), 4))
    return body


def main():
    case = Path(sys.argv[1] if len(sys.argv) > 1
                else HERE.parents[1]/"tutorials"/"wallJet")
    panels = [panel(case/f"water_soil_t{t}.png", t == TIMES[-1])
              for t in TIMES]
    sheet = Image.new("RGB", (panels[0].width,
                              sum(p.height for p in panels)), "white")
    at = 0
    for picture in panels:
        sheet.paste(picture, (0, at))
        at += picture.height

    file = HERE/"wallJet.png"
    sheet.quantize(COLOURS).save(file, optimize=True)
    print(f"{file}: {file.stat().st_size/1000:.0f} kB")


main()
