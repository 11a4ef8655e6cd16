#!/usr/bin/env python3
"""Standing wave on three grids, five periods: error of the period and order of
the numerical damping.

The outline cuts whole points: at h = 0.05, where they are 12.5 mm apart, the
wave starts higher than asked (amplitudeStart). Rates and periods are fitted, so
that this matters to them only as far as the wave is not linear."""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

from common import TUTORIALS, study  # noqa: E402
from mpmfoam import metrics, reference, style, wave  # noqa: E402
from mpmfoam.postProcessing import readDat  # noqa: E402

TUTORIAL = TUTORIALS/"standingWave"
sys.path.insert(0, str(TUTORIAL))

from makeWave import gaugePoints, waveSurface  # noqa: E402

LENGTH, HEIGHT, DEPTH, AMPLITUDE = 1, 0.6, 0.5, 0.01
NU = 1e-6
SPACINGS = [0.05, 0.025, 0.0125]


def runs():
    return [study.Run(
        f"h{h:g}", [TUTORIAL], study.MPMFOAM,
        {"system/blockMeshDict": {
            "h": h, "nx": round(LENGTH/h), "ny": round(HEIGHT/h)}},
        {"system/waveSurface": waveSurface(LENGTH, DEPTH, AMPLITUDE, 1),
         "system/gaugePoints": gaugePoints(LENGTH, round(LENGTH/h))},
        about={"h": h}) for h in SPACINGS]


def evaluate(done, results):
    table = reference.data("ana_standing_wave_periods.csv")
    row = (table["L"] == LENGTH) & (table["h"] == DEPTH) & (table["m"] == 1)
    period, omega = table["period"][row][0], table["omega"][row][0]
    viscous = 2*NU*(np.pi/LENGTH)**2    # rate of the amplitude, free slip

    out, columns, rates = {}, {"run": [], "t": [], "amplitude": []}, {}
    fig, axes = style.plt.subplots(
        1, 2, figsize=(9, 3), layout="constrained", width_ratios=[2, 1])
    for name, run in done.items():
        gauge = readDat(run.path, "gauge", "waveGauge.dat")
        t, heights = gauge[:, 0], gauge[:, 1:-1]
        x = (np.arange(heights.shape[1]) + 0.5)*LENGTH/heights.shape[1]
        a = wave.modeAmplitude(heights, x, LENGTH)
        w, rate, start, rest = wave.fit(t, a, omega)
        h = run.about["h"]
        rates[h] = rate - viscous
        out[f"periodError_{name}"] = 2*np.pi/w/period - 1
        out[f"dampingRate_{name}"] = rate
        out[f"amplitudeStart_{name}"] = start
        out[f"fitResidual_{name}"] = rest
        out[f"meanLevelChange_{name}"] = gauge[-1, -1]/gauge[0, -1] - 1
        columns["run"] += [name]*len(t)
        columns["t"] += list(t)
        columns["amplitude"] += list(a)
        axes[0].plot(t, 1e3*a, label=f"h = {1e3*h:g} mm")

    spacings = sorted(rates, reverse=True)
    for coarse, fine in zip(spacings, spacings[1:]):
        if rates[coarse] > 0 and rates[fine] > 0:
            out[f"dampingOrder_h{coarse:g}_h{fine:g}"] = \
                np.log(rates[coarse]/rates[fine])/np.log(coarse/fine)
    out["dampingRateViscous"] = viscous
    out.update(study.provenance(done))

    t = np.linspace(0, 5*period, 500)
    axes[0].plot(t, 1e3*AMPLITUDE*np.cos(omega*t), "--", lw=0.8,
                 color=style.REFERENCE, label="linear theory")
    axes[0].set(xlabel="time [s]", ylabel="amplitude of mode 1 [mm]")
    axes[0].set_ylim(top=20)
    axes[0].legend(ncols=4, loc="upper right")
    h = np.array(spacings)
    shown = np.array([abs(rates[s]) for s in spacings])
    axes[1].loglog(1e3*h, shown, "o-", label="mpmFoam")
    for order, look in [(2, "--"), (3, ":")]:
        axes[1].loglog(1e3*h, shown[0]*(h/h[0])**order, look, lw=0.8,
                       color=style.REFERENCE, label=f"order {order}")
    axes[1].set(xlabel="h [mm]", ylabel="numerical damping rate [1/s]")
    axes[1].legend()
    style.save(fig, results/"standingWave.png")
    reference.writeCsv(results/"standingWave.csv", columns,
                       "amplitude of mode 1 in m over time in s")
    metrics.writeMetrics(results/"metrics.json", out)
    metrics.printTable(out, "asked: order of the damping >= 2, "
                            "|periodError_h0.025| <= 0.005")


if __name__ == "__main__":
    study.main(HERE, runs(), evaluate, __doc__)
