"""Free heave of a floating rectangle in water of finite depth, by linear
potential theory.

Added mass and damping by matched eigenfunction expansions, as Lee (1995, On the
heave radiation of a rectangular structure, Ocean Engineering 22, 19-34): below
the box cosines in y that are even in x beside the particular solution, beside it
waves that travel away and modes that decay; matched in potential and velocity.
The motion by the equation of Cummins (1962),

    (M + A_inf) z'' + int_0^t K(t - s) z'(s) ds + rho g B z = 0,
    K(t) = 2/pi int_0^inf b(w) cos(w t) dw.

All is per length of the box, which has the width B, the draught T and floats in
the depth d between walls that are far away."""

import numpy as np
from scipy.optimize import brentq

G, RHO = 9.81, 1000.0


def waveNumbers(omega, depth, n):
    """k of k tanh(k d) = w^2/g, and n - 1 of -kappa tan(kappa d) = w^2/g"""
    K = omega**2/G*depth
    k = brentq(lambda x: x*np.tanh(x) - K, 1e-9, max(K, np.sqrt(K)) + 1)
    decaying = [brentq(lambda x: x*np.sin(x) + K*np.cos(x),
                       (m - 0.5)*np.pi + 1e-9, m*np.pi)
                for m in range(1, n)]
    return k/depth, np.array(decaying)/depth


def coefficients(omega, width, draught, depth, n=40):
    """Added mass [kg/m] and damping [kg/s/m]"""
    b, gap = 0.5*width, depth - draught
    k0, decaying = waveNumbers(omega, depth, n)

    # In y from the floor: outer modes of norm 1 over the depth, inner ones over
    # the gap
    k = np.concatenate([[1j*k0], decaying])     # cos(k y)
    norm = np.sqrt(np.array(
        0.5*(depth + np.sin(2*k*depth)/(2*k)), dtype=complex))
    lam = np.arange(n)*np.pi/gap
    inner = np.where(np.arange(n) == 0, np.sqrt(1/gap), np.sqrt(2/gap))

    # Overlap of both over the gap
    def overlap(p, q):
        s = np.where(abs(p - q) < 1e-12, gap,
                     np.sin((p - q)*gap)/np.where(p == q, 1, p - q))
        return 0.5*(s + np.sin((p + q)*gap)/np.where(
            abs(p + q) < 1e-12, 1, p + q))
    P, Q = np.meshgrid(lam, k, indexing="ij")
    S = overlap(P + 0j, Q)
    S[0] = np.sin(k*gap)/k
    S *= inner[:, None]/norm[None, :]

    # Unit velocity upwards of the box: particular (y^2 - x^2)/(2 gap)
    y = gap*(np.arange(2000) + 0.5)/2000
    dy = gap/2000
    particular = np.array([
        np.sum((y**2 - b**2)/(2*gap)*inner[m]*np.cos(lam[m]*y))*dy
        for m in range(n)])

    # Inner: sum c_m f_m(x) cos_m, f_0 = 1, f_m = cosh(lam x)/cosh(lam b);
    # outer: sum a_j exp(-k_j (x - b)), the first one travels away
    slopeIn = lam*np.tanh(lam*b)
    slopeOut = -k
    slopeOut[0] = -1j*k0
    # Velocity, over the depth: slopeOut a = S^T (slopeIn c) - (b/gap) of the
    # particular one over the gap
    flux = -(b/gap)*np.array([
        np.sum(np.cos(k[j]*y))*dy/norm[j] for j in range(n)])
    # Potential over the gap: c + particular = S a
    A = np.eye(n, dtype=complex) - S @ (S.T*slopeIn[None, :]/slopeOut[:, None])
    c = np.linalg.solve(A, S @ (flux/slopeOut) - particular)

    # Potential on the bottom (y = gap) over its width: of modes and particular
    mean = np.where(np.arange(n) == 0, b, np.tanh(lam*b)/np.maximum(lam, 1e-9))
    total = 2*np.sum(c*inner*np.cos(lam*gap)*mean)
    total += gap*b - b**3/(3*gap)
    # p = -rho dphi/dt of exp(i w t): force = -i w rho int phi V
    #   = -(A i w + B) V
    return RHO*total.real, -RHO*omega*total.imag


def freeHeave(width, draught, depth, mass, times):
    """z/z(0) of a box that is let go at rest"""
    omega = np.geomspace(0.2, 60, 160)
    A, B = np.array([coefficients(w, width, draught, depth)
                     for w in omega]).T
    fine = np.linspace(0, 60, 4001)
    damping = np.interp(fine, omega, B, left=B[0])
    dt = times[1] - times[0]
    K = np.array([np.trapz(damping*np.cos(fine*t), fine)
                  for t in times])*2/np.pi
    infinite = A[-1]
    stiffness = RHO*G*width
    z, v = np.zeros(len(times)), np.zeros(len(times))
    z[0] = 1
    m = mass + infinite

    def acceleration(i):
        memory = dt*(K[i::-1] @ v[:i + 1] - 0.5*(K[i]*v[0] + K[0]*v[i]))
        return -(stiffness*z[i] + memory)/m
    for i in range(len(times) - 1):
        v[i + 1] = v[i] + dt*acceleration(i)
        z[i + 1] = z[i] + dt*v[i + 1]
    return z, (omega, A, B)


if __name__ == "__main__":
    width, draught, depth = 0.2, 0.05, 0.4
    t = np.linspace(0, 3, 3001)
    z, (omega, A, B) = freeHeave(width, draught, depth, RHO*width*draught, t)
    for w in [0.5, 4, 6, 8, 9, 10, 12, 16, 30, 60]:
        print(w, np.interp(w, omega, A)/(RHO*width*draught),
              np.interp(w, omega, B)/(RHO*width*draught*w))
    print("first trough", t[np.argmin(np.where(t < 1, z, 1))], z.min(),
          "later", z[np.argmin(z):].max())
