#!/usr/bin/env python3
"""Element tests of elastoplasticMuI: against its reference integrator, exact
end states, measured tests on Karlsruhe sand, mu(I) and Phi(I), the parameter
sets of the three erosion cases side by side; 1e6 random paths.

Less than a minute of computing; every call runs all of it anew."""

import argparse
import datetime
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from scipy.optimize import brentq

HERE = Path(__file__).resolve().parent
REPOSITORY = HERE.parents[1]
sys.path.insert(0, str(REPOSITORY/"etc"/"python"))

from mpmfoam import (  # noqa: E402
    calibration, metrics, reference, soilElement, style)

RESULTS = HERE/"results"
RUNS = HERE/"runs"
P_AT = 101300

# Sets of the paper's Table 2 (kp of B as elsewhere; its print is ten times
# that, outside Table A1)
COMMON = dict(rhoS=2650, E0=216, nu=0.2, n=0.5, xi=0.365, Ad=0.7, kp=0.0044,
              np=2.4, nd=2.9, I0=0.28, PhiC=0.7, dPhi=0.29)
COMMON["lambda"] = 0.0596
SETS = {
    "A": dict(COMMON, d=0.85e-3, e0=0.695, eRef=0.807, phiC=35, muS=0.7,
              muD=0.77),
    "B": dict(COMMON, d=1e-3, e0=0.695, eRef=0.977, phiC=30, muS=0.577,
              muD=0.66),
    "C": dict(COMMON, d=2e-3, e0=0.818, eRef=0.827, phiC=30, muS=0.577,
              muD=0.66),
}
EXAMPLE = {"A": "Ex3", "B": "Ex4", "C": "Ex5"}

# Chosen by hand from emin, emax, phi_c, and from peak, dilatancy and largest
# contraction of the two tests; not fitted
KARLSRUHE = dict(COMMON, d=0.14e-3, e0=0.9753, eRef=1.06, phiC=33.1, Ad=0.64,
                 kp=0.004, np=1.95, nd=2.9, muS=0.652, muD=0.72)


def soilElementTest(name, soil, tests):
    """Run tests (name -> entries) on a soil; name -> columns"""
    return soilElement.run(RUNS/name, soil, tests)


# --- closed forms, in Python ------------------------------------------------

def slope(tanPhi):
    sine = tanPhi/np.sqrt(1 + tanPhi**2)
    return 6*sine/(3 - sine)


def criticalVoidRatio(soil, p):
    return soil["eRef"]*np.exp(-soil["lambda"]*(p/P_AT)**soil["xi"])


def endState(soil, p0, plasticStrain):
    """p, q, e of a drained test where H(eps_p) = M_pt(e, p), q = 3 (p - p0)"""
    tanC = np.tan(np.radians(soil["phiC"]))
    p = p0
    for _ in range(20):
        # kp goes with the elastic strain, up to atmospheric pressure
        kp = soil["kp"]*(min(p, P_AT)/P_AT)**(1 - soil["n"])
        hard = plasticStrain/(kp + plasticStrain)
        state = brentq(lambda s: hard*slope(np.exp(soil["np"]*s)*tanC)
                       - slope(np.exp(-soil["nd"]*s)*tanC), -0.5, 0.5,
                       xtol=1e-14)
        H = slope(np.exp(-soil["nd"]*state)*tanC)
        p = 3*p0/(3 - H)
    return p, H*p, criticalVoidRatio(soil, p)*np.exp(-state)


# --- parts ------------------------------------------------------------------

KINDS = {
    "drained": ("test drainedTriaxial;", 0.1),
    "drainedExtension": ("test drainedTriaxial; direction extension;", 0.1),
    "undrained": ("test undrainedTriaxial;", 0.1),
    "undrainedExtension": ("test undrainedTriaxial; direction extension;", 0.1),
    "oedometer": ("test oedometer;", 0.02),
    "shearDrained": ("test simpleShear;", 0.1),
    "shearConstantVolume": ("test simpleShear; volume constant;", 0.1),
}
DENSITIES = {"dense": 0.65, "loose": 0.78, "veryLoose": 0.9}
INCREMENTS = [4e-4, 2e-4, 1e-4, 5e-5]


def accuracy(out, axis):
    """Error of q over its maximum against adaptiveSubstepping"""
    tests = {}
    for kind, (entries, strain) in KINDS.items():
        for density, e in DENSITIES.items():
            for p0 in [50, 500, 5000, 100000]:
                base = f"{entries} p0 {p0}; e0 {e}; strain {strain};"
                for d in INCREMENTS:
                    tests[f"{kind}_{density}_{p0}_{d:g}"] = (
                        f"{base} strainIncrement {d}; "
                        f"writeInterval {round(4e-4/d)};")
                tests[f"{kind}_{density}_{p0}_exact"] = (
                    f"{base} strainIncrement 1e-5; writeInterval 40; "
                    "integrator adaptiveSubstepping;")
    done = soilElementTest("accuracy", SETS["A"], tests)
    columns = {"test": [], "density": [], "p0": [], "qMax": []}
    columns.update({f"error_{d:g}": [] for d in INCREMENTS})
    for kind in KINDS:
        for density in DENSITIES:
            for p0 in [50, 500, 5000, 100000]:
                name = f"{kind}_{density}_{p0}"
                exact = done[f"{name}_exact"]
                for key, value in zip(["test", "density", "p0", "qMax"],
                                      [kind, density, p0, exact["q"].max()]):
                    columns[key].append(value)
                for d in INCREMENTS:
                    found = done[f"{name}_{d:g}"]
                    q = np.interp(found["strain"], exact["strain"], exact["q"])
                    columns[f"error_{d:g}"].append(
                        abs(found["q"] - q).max()/exact["q"].max())
    reference.writeCsv(RESULTS/"accuracy.csv", columns,
                       "largest error of q over the largest q, against "
                       "adaptiveSubstepping, by strain increment; p0, qMax in "
                       "Pa")
    errors = {d: np.array(columns[f"error_{d:g}"]) for d in INCREMENTS}
    loose = np.array(columns["density"]) == "veryLoose"
    out["errorOfQ_denseAndLoose_1e-4_max"] = errors[1e-4][~loose].max()
    out["errorOfQ_veryLoose_1e-4_max"] = errors[1e-4][loose].max()
    means = [np.exp(np.log(errors[d][~loose]).mean()) for d in INCREMENTS]
    out["orderOfConvergence"] = np.log(means[0]/means[-1])/np.log(
        INCREMENTS[0]/INCREMENTS[-1])
    for kind in KINDS:
        rows = np.array(columns["test"]) == kind
        axis.loglog(INCREMENTS, [errors[d][rows].max() for d in INCREMENTS],
                    "o-", label=kind)
    axis.axhline(0.01, color=style.REFERENCE, lw=0.8, ls="--")
    axis.set(xlabel="strain increment", ylabel="worst error of q",
             title="against the reference integrator")
    axis.legend(fontsize=6)


def endStates(out, axis):
    """Drained compression to a strain of 1.5"""
    closed = reference.data("ana_simsand_critical_states.csv")
    columns = {k: [] for k in ["set", "kp", "p0", "p", "q", "e", "pError",
                               "qError", "eError", "pCritical", "qCritical",
                               "eCritical"]}
    distance = {}
    for name, soil in SETS.items():
        for kp in [0.0044, 0.0011, 0.0003]:
            soil = dict(soil, kp=kp)
            rows = [i for i, c in enumerate(closed["case"])
                    if c == EXAMPLE[name]]
            tests = {f"p{closed['p0_kPa'][i]:g}":
                     f"test drainedTriaxial; p0 {1e3*closed['p0_kPa'][i]}; "
                     "strain 1.5; strainIncrement 2e-4; writeInterval 100;"
                     for i in rows}
            done = soilElementTest(f"end_{name}_{kp:g}", soil, tests)
            for i in rows:
                t = done[f"p{closed['p0_kPa'][i]:g}"]
                p, q, e = endState(soil, 1e3*closed["p0_kPa"][i],
                                   t["plasticStrain"][-1])
                values = [name, kp, 1e3*closed["p0_kPa"][i], t["p"][-1],
                          t["q"][-1], t["voidRatio"][-1], t["p"][-1]/p - 1,
                          t["q"][-1]/q - 1, t["voidRatio"][-1]/e - 1,
                          1e3*closed["pf"][i], 1e3*closed["qf"][i],
                          closed["ef"][i]]
                for key, value in zip(columns, values):
                    columns[key].append(value)
                distance.setdefault(kp, []).append(max(
                    abs(t["q"][-1]/(1e3*closed["qf"][i]) - 1),
                    abs(t["voidRatio"][-1]/closed["ef"][i] - 1)))
                if kp == 0.0044:
                    axis.semilogx(t["p"]/1e3, t["voidRatio"], lw=0.8,
                                  color=f"C{'ABC'.index(name)}")
        p = np.geomspace(0.3e3, 1e6, 100)
        axis.semilogx(p/1e3, criticalVoidRatio(soil, p), "--", lw=0.8,
                      color=style.REFERENCE)
    reference.writeCsv(RESULTS/"endStates.csv", columns,
                       "drained compression at strain 1.5 beside H(eps_p) = "
                       "M_pt(e, p) (relative errors) and the critical state; "
                       "Pa")
    for key in ["pError", "qError", "eError"]:
        out[f"endState_{key}_max"] = abs(np.array(columns[key])).max()
    for kp, values in distance.items():
        out[f"distanceToCriticalState_kp{kp:g}"] = max(values)
    axis.set(xlabel="p [kPa]", ylabel="void ratio",
             title="drained to strain 1.5; critical state lines")


def karlsruhe(out, axes):
    """Measured drained tests at 100 kPa beside hand-chosen parameters"""
    measured = reference.data("karlsruhe_drained_triax_p100.csv")
    columns = {"test": [], "eps_a": [], "q_measured": [], "q": [],
               "eps_v_measured": [], "eps_v": []}
    for name, e0, colour in [("TMD2", 0.9753, "C0"), ("TMD22", 0.7351, "C1")]:
        t = soilElementTest(f"karlsruhe_{name}", KARLSRUHE, {
            name: f"test drainedTriaxial; p0 100e3; e0 {e0}; strain 0.25; "
                  "writeInterval 2;"})[name]
        rows = np.array([i == name for i in measured["test_id"]])
        # Engineering strain, as measured
        eps = measured["eps_a_pct"][rows]/100
        qm = 1e3*(measured["sigma_v"] - measured["sigma_r"])[rows]
        vm = measured["eps_v_pct"][rows]/100
        strain = 1 - np.exp(-t["strain"])
        volume = 1 - np.exp(-t["volumetricStrain"])
        q = np.interp(eps, strain, t["q"])
        v = np.interp(eps, strain, volume)
        out[f"karlsruhe_{name}_qMisfitRms"] = (
            np.sqrt(((q - qm)**2).mean())/qm.max())
        out[f"karlsruhe_{name}_qPeakError"] = q.max()/qm.max() - 1
        out[f"karlsruhe_{name}_volumetricStrainMisfitRms"] = np.sqrt(
            ((v - vm)**2).mean())
        for key, value in zip(columns, [[name]*len(eps), eps, qm, q, vm, v]):
            columns[key] += list(value)
        for axis, model, points, scale in [(axes[0], t["q"], qm, 1e-3),
                                           (axes[1], volume, vm, 100)]:
            axis.plot(100*strain, scale*model, color=colour,
                      label=f"{name}, e0 {e0}")
            axis.plot(100*eps, scale*points, "o", ms=2.5, color=colour)
    reference.writeCsv(RESULTS/"karlsruhe.csv", columns,
                       "Karlsruhe sand, drained at 100 kPa, measured and "
                       "computed; strain engineering, Pa")
    axes[0].set(xlabel="axial strain [%]", ylabel="q [kPa]", xlim=(0, 20),
                title="Karlsruhe sand (points), hand-chosen parameters")
    axes[1].set(xlabel="axial strain [%]", ylabel="contraction [%]",
                xlim=(0, 20))
    axes[0].legend()


def karlsruheFit(out):
    """The same sand with the parameters that calibrateSoil finds, with tests at
    other pressures and densities that it does not see"""
    fit = calibration.Calibration(REPOSITORY/"tutorials"/"calibrateSoil")
    fit.fit()
    table = fit.table()
    # By hand, in the same measure
    hand = fit.simulate(KARLSRUHE, fit.tests, RUNS/"karlsruheFit")
    misfits = [r for t in fit.tests for r in fit.misfits(hand, t)]
    table["misfitByHand"] = [np.sqrt(np.mean(r**2)) for r in misfits]
    table["rmsByHand"] = [m*c for m, c in zip(table["misfitByHand"],
                                              table["largest"])]
    reference.writeCsv(RESULTS/"karlsruheFit.csv", table,
                       "tutorials/calibrateSoil: misfit: rms over the largest "
                       "measured value; Start: before the fit; SI units, "
                       "strain logarithmic")
    fit.draw(RESULTS/"karlsruheFit.png")
    for i, name in enumerate(table["test"]):
        if table["quantity"][i] == "q":
            out[f"karlsruheFit_{name}_qMisfitRms"] = table["misfit"][i]
    for p in fit.parameters:
        out[f"karlsruheFit_{p.name}"] = p.value


def rheology(out, axes):
    """Shear of grains without skeleton stress: mu(I) and Phi(I)"""
    columns = {k: [] for k in ["set", "Phi", "I", "mu", "muExact",
                               "PhiExact"]}
    for k, (name, soil) in enumerate(SETS.items()):
        tests = {f"e{e:.4g}": f"test simpleShear; volume constant; p0 0; "
                 f"e0 {e}; strain 1e-3; strainRate 50;"
                 for e in np.linspace(0.6, 1.45, 18)}
        for t in soilElementTest(f"rheology_{name}", soil, tests).values():
            p, tau = t["p"][-1], -t["sigma_xy"][-1]
            inertial = soil["d"]*50/np.sqrt(p/soil["rhoS"])
            values = [name, 1/(1 + t["voidRatio"][-1]), inertial, tau/p,
                      soil["muS"] + (soil["muD"] - soil["muS"])*inertial
                      / (soil["I0"] + inertial),
                      soil["PhiC"] - soil["dPhi"]*inertial]
            for key, value in zip(columns, values):
                columns[key].append(value)
        rows = np.array([s == name for s in columns["set"]])
        get = {key: np.array(columns[key])[rows] for key in
               ["I", "mu", "Phi", "muExact", "PhiExact"]}
        order = np.argsort(get["I"])
        axes[0].plot(get["I"], get["mu"], "o", ms=3, color=f"C{k}",
                     label=f"set {name}")
        axes[0].plot(get["I"][order], get["muExact"][order], "-", lw=0.8,
                     color=style.REFERENCE)
        axes[1].plot(get["I"], get["Phi"], "o", ms=3, color=f"C{k}")
        axes[1].plot(get["I"][order], get["PhiExact"][order], "-", lw=0.8,
                     color=style.REFERENCE)
    reference.writeCsv(RESULTS/"rheology.csv", columns,
                       "simple shear at 50/s, viscous part alone")
    out["muOfI_errorMax"] = abs(np.array(columns["mu"])
                                - columns["muExact"]).max()
    out["PhiOfI_errorMax"] = abs(np.array(columns["Phi"])
                                 - columns["PhiExact"]).max()
    axes[0].set(xlabel="I", ylabel="mu", title="viscous part alone")
    axes[1].set(xlabel="I", ylabel="solid fraction")
    axes[0].legend()


def sets(out, axes):
    """The soils of the three cases at 1 and 100 kPa"""
    columns = {k: [] for k in ["set", "p0", "strain", "q", "voidRatio"]}
    for k, (name, soil) in enumerate(SETS.items()):
        done = soilElementTest(f"sets_{name}", soil, {
            f"p{p0:g}": f"test drainedTriaxial; p0 {p0}; strain 0.3; "
            "writeInterval 20;" for p0 in [1e3, 1e5]})
        for p0, look in [(1e3, "-"), (1e5, "--")]:
            t = done[f"p{p0:g}"]
            axes[0].plot(t["strain"], t["q"]/t["p"], look, color=f"C{k}",
                         label=f"{name}, {p0/1e3:g} kPa")
            axes[1].plot(t["strain"], t["voidRatio"], look, color=f"C{k}")
            for i in range(0, len(t["strain"]), 5):
                for key, value in zip(columns, [
                        name, p0, t["strain"][i], t["q"][i],
                        t["voidRatio"][i]]):
                    columns[key].append(value)
            ratio = (t["q"]/t["p"]).max()
            out[f"peakFrictionAngle_{name}_{p0/1e3:g}kPa"] = np.degrees(
                np.arcsin(3*ratio/(6 + ratio)))
    reference.writeCsv(RESULTS/"sets.csv", columns,
                       "drained compression of the three sets; Pa")
    axes[0].set(xlabel="strain", ylabel="q/p", title="sets A, B, C, drained")
    axes[1].set(xlabel="strain", ylabel="void ratio")
    axes[0].legend(fontsize=6)


def randomPaths(out, count):
    """The unit test of random paths, with more of them"""
    done = subprocess.run(
        ["mpmUnitTests", "elastoplasticMuI: random paths"],
        capture_output=True, text=True,
        env={**os.environ, "MPM_RANDOM_PATHS": str(count)})
    names = {"paths": "randomPaths_count",
             "steps with nan, inf or tension": "randomPaths_badSteps",
             "stress over the strength, less 1": "randomPaths_overStrength"}
    for line in done.stdout.splitlines():
        fields = line.split("\t")
        if fields[0] == "figure" and fields[1] in names:
            out[names[fields[1]]] = float(fields[2])
    out["randomPaths_status"] = done.returncode


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--paths", type=int, default=1000000,
                        help="random paths (default: 1e6)")
    arguments = parser.parse_args()

    # Before the results change
    commit = subprocess.run(
        ["git", "describe", "--always", "--dirty"], cwd=HERE,
        capture_output=True, text=True).stdout.strip()
    RESULTS.mkdir(exist_ok=True)
    fig, axes = style.plt.subplots(2, 4, figsize=(15, 7),
                                   layout="constrained")
    out = {}
    accuracy(out, axes[0, 0])
    endStates(out, axes[1, 0])
    karlsruhe(out, axes[:, 1])
    karlsruheFit(out)
    rheology(out, axes[:, 2])
    sets(out, axes[:, 3])
    randomPaths(out, arguments.paths)
    out["date"] = datetime.date.today().isoformat()
    out["commit"] = commit
    style.save(fig, RESULTS/"elementTests.png")
    metrics.writeMetrics(RESULTS/"metrics.json", out)
    metrics.printTable(out, "asked: errors of q <= 0.01, of end states <= 0.01,"
                            " of mu(I), Phi(I) <= 1e-6, no bad steps")


if __name__ == "__main__":
    main()
