#!/usr/bin/env python3
"""Period and damping of the wave against linear theory: adds them to
metrics.json and draws the amplitude over time."""

import os
import sys
from pathlib import Path

import numpy as np

sys.path.insert(0, os.path.join(os.environ["MPMFOAM_DIR"], "etc", "python"))

from mpmfoam import metrics, style, wave  # noqa: E402
from mpmfoam.postProcessing import readDat  # noqa: E402

LENGTH, DEPTH = 1, 0.5

gauge = readDat(".", "gauge", "waveGauge.dat")
time, heights = gauge[:, 0], gauge[:, 1:-1]
x = (np.arange(heights.shape[1]) + 0.5)*LENGTH/heights.shape[1]
amplitude = wave.modeAmplitude(heights, x, LENGTH)
theory = wave.omegaLinear(LENGTH, DEPTH)
omega, rate, start, rest = wave.fit(time, amplitude, theory)

own = {
    "period": 2*np.pi/omega,
    "periodTheory": 2*np.pi/theory,
    "periodError": theory/omega - 1,
    "dampingRate": rate,
    "amplitudeStart": start,
    "amplitudeLeftAfterFivePeriods": np.exp(-rate*10*np.pi/omega),
    "fitResidual": rest,
}
metrics.printTable(own, "Wave:")
path = Path("metrics.json")
known = metrics.readMetrics(path) if path.is_file() else {}
metrics.writeMetrics(path, {**known, **own})

fig, ax = style.plt.subplots(figsize=(6.3, 2.8), layout="constrained")
ax.plot(time, 1e3*amplitude, label="mpmFoam")
ax.plot(time, 1e3*start*np.cos(theory*time), "--", color=style.REFERENCE,
        lw=0.9, label="linear theory, no damping")
ax.set(xlabel="time [s]", ylabel="amplitude of mode 1 [mm]")
ax.set_ylim(top=16)
ax.legend(loc="upper right", ncols=2)
style.save(fig, "standingWave.png")
