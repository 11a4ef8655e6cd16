"""Period and damping of a standing wave from its wave gauges."""

import numpy as np


def modeAmplitude(heights, x, length, mode=1):
    """Amplitude of cos(mode pi x/length) in the surface, one for each row of
    heights[time, gauge]. The gauges lie evenly in the middle of cells, where
    the modes are orthogonal sums."""
    shape = np.cos(mode*np.pi*np.asarray(x)/length)
    return 2*heights @ shape/len(shape)


def fit(time, amplitude, omega):
    """Least squares fit of  mean + a exp(-rate t) cos(omega t + phase).

    omega is a first guess. Returns omega, rate, a, and the rms of what is
    left over a. Linear in mean, cosine and sine part; Gauss-Newton for omega
    and rate."""
    def solve(p):
        decay = np.exp(-p[1]*time)
        basis = np.stack([np.ones_like(time), decay*np.cos(p[0]*time),
                          decay*np.sin(p[0]*time)], axis=1)
        c = np.linalg.lstsq(basis, amplitude, rcond=None)[0]
        return amplitude - basis @ c, c

    p = np.array([omega, 0.0])
    step = np.array([1e-5*omega, 1e-5*omega])
    residual, c = solve(p)
    for _ in range(50):
        jacobian = np.stack([(solve(p + np.eye(2)[k]*step[k])[0] - residual)
                             / step[k] for k in range(2)], axis=1)
        change = np.linalg.lstsq(jacobian, -residual, rcond=None)[0]
        for _ in range(20):
            trial, cTrial = solve(p + change)
            if trial @ trial <= residual @ residual:
                break
            change = change/2
        p, residual, c = p + change, trial, cTrial
        if np.all(np.abs(change) < 1e-10*omega):
            break
    a = np.hypot(c[1], c[2])
    return p[0], p[1], a, np.sqrt(np.mean(residual**2))/a


def omegaLinear(length, depth, mode=1, g=9.81):
    """Linear theory, as in ana_standing_wave_periods.csv"""
    k = mode*np.pi/length
    return np.sqrt(g*k*np.tanh(k*depth))
