"""Equations (30)-(37) written plainly: the oracle of the annulus law and the yardstick of cost.

Nothing is reused between steps but the matrix A. The order within a step: approach (32) and slip
(33) with the old velocities, contact (30) and tractions (33)-(37) there, then (31) and (35).
"""

import numpy as np

#: 4 Gamma(2/5) sqrt(pi) / (5 Gamma(9/10)), eq. (7): the paper prints 2.9432.
DURATION = 2.94327518431757


def influence(annuli):
    """A_ij of eq. (14), row j (place), column i (distribution), shape (annuli, annuli)."""
    i = np.arange(1, annuli + 1)[None, :]
    place = np.arange(1, annuli + 1)[:, None] - 0.5
    inside = np.pi * (2 * i**2 - place**2) / (2 * i * annuli)
    outside = (2 * i**2 - place**2) * np.arcsin(np.minimum(i / place, 1.0)) / (i * annuli)
    outside = outside + np.sqrt(np.maximum(place**2 - i**2, 0.0)) / annuli
    return np.where(place < i, inside, outside)


def shape(annuli):
    """(pi/2) sqrt(1 - (j-1/2)²/i²) for i >= j, else 0: tractions of eq. (34)."""
    i = np.arange(1, annuli + 1)[None, :]
    place = np.arange(1, annuli + 1)[:, None] - 0.5
    return 0.5 * np.pi * np.sqrt(np.maximum(1.0 - place**2 / i**2, 0.0))


def contact(matrix_stick, matrix_slip, radius, moved, beta, sign, stuck):
    """phi of one contact problem, eqs (33), (34), (36), (37), with its stick and slip."""
    square = beta**2 - radius**2
    touching = square > 0.0
    limit = np.sqrt(np.where(touching, square, 0.0))
    stuck = stuck & touching
    sign = np.where(touching, sign, 0.0)
    stuck = stuck | (touching & (sign == 0.0))
    for _ in range(100):
        matrix = np.where(stuck[:, None], matrix_stick, matrix_slip)
        phi = np.linalg.solve(matrix, np.where(stuck, moved, sign * limit))
        traction = matrix_slip @ phi
        slip = moved - matrix_stick @ phi
        begins = stuck & (np.abs(traction) > limit)
        ends = touching & ~stuck & (sign * slip <= 0.0)
        if not (begins.any() or ends.any()):
            return phi, sign, stuck
        sign = np.where(begins, np.sign(traction), np.where(ends, 0.0, sign))
        stuck = (stuck & ~begins) | ends
    raise RuntimeError("division into stick and slip did not settle")


def radii(steps):
    """Return beta after each of ``steps`` even steps, from T(x) by quadrature (theory §3).

    sqrt(zeta) = beta = sin x, dT/dx = 2 beta/g(beta); the second half mirrors the first.
    """
    points, weights = np.polynomial.legendre.leggauss(60)

    def pace(x):
        u = np.sin(x)
        return 2.0 * u / np.sqrt((1.0 + u + u**2 + u**3 + u**4) / (1.0 + u))

    def passed(x):
        return (pace(0.5 * x[:, None] * (1.0 + points)) * weights).sum(axis=1) * 0.5 * x

    fraction = np.arange(1, steps + 1) / steps
    half = np.minimum(fraction, 1.0 - fraction) * DURATION
    x = np.sqrt(half) * 1.05 + 1e-300
    for _ in range(60):
        x = np.clip(x - (passed(x) - half) / pace(x), 0.5 * x, 0.5 * np.pi)
    return np.where(half > 0.0, np.sin(x), 0.0)


def along_the_exact_motion(psi1, chi, *, annuli, steps):
    """Return what ``impact`` does, with the contact (30)-(32) given and not marched.

    The last step ends at separation: there are ``steps`` of them whatever psi1. Steps are such
    that the normal force has its exact impulse, as it has where (31) is marched.
    """
    matrix_stick, matrix_slip = 0.5 * influence(annuli), shape(annuli)
    radius = (np.arange(1, annuli + 1) - 0.5) / annuli
    weight = (np.arange(1, annuli + 1) / annuli) ** 2
    betas, psi = radii(steps), float(psi1)
    step = 2.0 / np.sum(1.25 * betas**3)
    xi, sign, stuck = np.zeros(annuli), np.zeros(annuli), np.zeros(annuli, bool)
    forces = []
    for beta in betas:
        moved = xi + psi * step
        phi, sign, stuck = contact(matrix_stick, matrix_slip, radius, moved, beta, sign, stuck)
        xi = matrix_stick @ phi
        force = weight @ phi
        psi -= 1.25 * np.pi * chi * force * step
        forces.append(0.5 * np.pi * force)
    return psi, np.array(forces)


def impact(psi1, chi, *, annuli=50, steps=500):
    """Return psi2 and the forces F/(mu P_max) after each step."""
    matrix_stick, matrix_slip = 0.5 * influence(annuli), shape(annuli)
    radius = (np.arange(1, annuli + 1) - 0.5) / annuli
    weight = (np.arange(1, annuli + 1) / annuli) ** 2
    step = DURATION / steps
    zeta, velocity, psi = 0.0, 1.0, float(psi1)
    xi, sign, stuck = np.zeros(annuli), np.zeros(annuli), np.zeros(annuli, bool)
    forces = []
    for _ in range(2 * steps):
        drift = psi * step
        zeta += velocity * step
        beta = np.sqrt(max(zeta, 0.0))
        velocity -= 1.25 * beta**3 * step
        phi, sign, stuck = contact(matrix_stick, matrix_slip, radius, xi + drift, beta, sign, stuck)
        xi = matrix_stick @ phi
        force = weight @ phi
        psi -= 1.25 * np.pi * chi * force * step
        forces.append(0.5 * np.pi * force)
        if zeta <= 0.0:
            break
    return psi, np.array(forces)
