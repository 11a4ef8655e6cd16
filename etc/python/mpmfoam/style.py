"""The one look of all figures: import this before drawing."""

import matplotlib

matplotlib.use("Agg")

import matplotlib.pyplot as plt  # noqa: E402

# Blue for mpmFoam, orange for interFoam, black for measurement and theory;
# colours that stay apart for colour-blind readers (Okabe and Ito)
MPM = "#0072B2"
INTERFOAM = "#D55E00"
REFERENCE = "black"
COLOURS = ["#0072B2", "#D55E00", "#009E73", "#CC79A7", "#56B4E9", "#E69F00"]

plt.rcParams.update({
    "figure.dpi": 110,
    "savefig.dpi": 150,
    "font.size": 9,
    "axes.titlesize": 9,
    "axes.prop_cycle": matplotlib.cycler(color=COLOURS),
    "axes.grid": True,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "grid.alpha": 0.3,
    "grid.linewidth": 0.6,
    "legend.frameon": False,
    "legend.fontsize": 8,
    "lines.linewidth": 1.4,
    "lines.markersize": 4,
})


def figure(rows=1, columns=1, width=6.3, height=3.2, **kwargs):
    """Figure and axes, width by height per panel row, in inches"""
    return plt.subplots(
        rows, columns, figsize=(width, height*rows), layout="constrained",
        **kwargs)


def save(fig, path):
    fig.savefig(path)
    plt.close(fig)
    print(f"    wrote {path}")
