#!/usr/bin/env python3
"""Draws the tests of soilElementTest: elementTests.png in the case directory.

    plotElementTests.py [name ...]      (default: all tests of the case)
"""

import sys
from pathlib import Path

from mpmfoam import metrics, reference, style


def main():
    directory = Path("postProcessing")/"soilElementTest"
    names = sys.argv[1:] or sorted(p.stem for p in directory.glob("*.csv"))
    if not names:
        sys.exit(f"no tests in {directory}: run soilElementTest")

    fig, axes = style.plt.subplots(2, 2, figsize=(9, 6.5),
                                   layout="constrained")
    out = {}
    for k, name in enumerate(names):
        t = reference.readCsv(directory/f"{name}.csv")
        look = {"label": name, "color": f"C{k % 6}",
                "ls": ["-", "--", ":"][k//6 % 3]}
        top = t["q"].max() or 1
        axes[0, 0].plot(t["strain"], t["q"]/top, **look)
        axes[0, 1].plot(t["strain"], t["voidRatio"], **look)
        axes[1, 0].plot(t["p"]/1e3, t["q"]/1e3, **look)
        axes[1, 1].semilogx(t["p"].clip(1e-3)/1e3, t["voidRatio"], **look)
        out[f"qMax_{name}"] = float(t["q"].max())
        out[f"pEnd_{name}"] = float(t["p"][-1])
        out[f"qEnd_{name}"] = float(t["q"][-1])
        out[f"voidRatioEnd_{name}"] = float(t["voidRatio"][-1])
    axes[0, 0].set(xlabel="strain", ylabel="q over its maximum")
    axes[0, 1].set(xlabel="strain", ylabel="void ratio")
    axes[1, 0].set(xlabel="p [kPa]", ylabel="q [kPa]")
    axes[1, 1].set(xlabel="p [kPa]", ylabel="void ratio")
    axes[0, 0].legend(fontsize=6)
    style.save(fig, "elementTests.png")
    metrics.writeMetrics("metrics.json", out)


if __name__ == "__main__":
    main()
