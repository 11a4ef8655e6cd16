"""Dry mu(I) flow down an incline, steady: Bagnold's profile.

    u(y) = 2/3 (I/d) sqrt(phi g cos(theta)) (H^1.5 - (H - y)^1.5)
"""

import numpy as np

from . import reference

G = 9.81


def row(theta, tag="Jop2006_const_phi"):
    """The row of ana_bagnold.csv of a slope in degrees, name -> number"""
    table = reference.data("ana_bagnold.csv")
    for i, name in enumerate(table["tag"]):
        if name == tag and table["theta_deg"][i] == theta:
            return {key: column[i] for key, column in table.items()}
    raise ValueError(f"ana_bagnold.csv: no row {tag} at {theta} degrees")


def velocity(y, flow):
    """u at heights above the bed, for a row"""
    H = flow["H"]
    depth = H - np.clip(y, 0, H)
    return 2/3*flow["I"]/flow["d"]*np.sqrt(
        flow["phi"]*G*np.cos(np.radians(flow["theta_deg"])))*(
            H**1.5 - depth**1.5)


def compare(case, time, flow, h, cloud="soil"):
    """Mean velocity of layers of height h, up to H, beside the closed form:
    heights, velocities, their exact values; and the errors over the surface
    velocity (profileError, the largest) and over their own value
    (surfaceError, of the last layer, and meanError, of all grains)"""
    x, U, mass = (case.cloudField(time, cloud, f) for f in ["x", "U", "mass"])
    exact = velocity(x[:, 1], flow)
    n = round(flow["H"]/h)
    layer = (x[:, 1]/h).astype(int)
    weight = np.bincount(layer, weights=mass, minlength=n)[:n]

    def mean(values):
        return np.bincount(layer, weights=mass*values, minlength=n)[:n]/weight

    y, u, uExact = mean(x[:, 1]), mean(U[:, 0]), mean(exact)
    return y, u, uExact, {
        "profileError": np.abs(u - uExact).max()/flow["u_surface"],
        "surfaceError": u[-1]/uExact[-1] - 1,
        "meanError": (mass*U[:, 0]).sum()/mass.sum()/flow["u_mean"] - 1}
