"""Truth in space: rings whose tractions are vectors, with Coulomb's law at every ring.

At nu = 0 each component of traction displaces the surface along itself alone, by one kernel that
depends on distance. Tractions that depend on the radius then displace by the radius, so rings
hold the full circle. In each step the tractions minimise the elastic energy of the step below
mu p: a convex problem, solved ring by ring until nothing moves.
"""

import numpy as np

from contactlab_laws.annulus.tables import hertz_pressure, tables

#: Radius of the rings over the greatest contact radius without friction.
ROOM = 1.1
SETTLED = 1e-9
MOST_SWEEPS = 2000


def extrapolated(psi1, chi, lam, rho, *, rings, steps):
    """Return V2 and psi2 from ``steps`` and twice as many, at which the error is half."""
    coarse, fine = (
        impact(psi1, chi, lam, rho, rings=rings, steps=count) for count in (steps, 2 * steps)
    )
    return 2.0 * fine[0] - coarse[0], 2.0 * fine[1] - coarse[1]


def impact(psi1, chi, lam, rho, *, rings, steps):
    """Return V2 and psi2 of theory §14's impact in space, in ``steps`` an approach."""
    table = tables(rings, mean=True)
    matrix, weight = table.compliance, table.weight
    dt = 2.943275 / steps
    zeta, rate, slip = 0.0, 1.0, np.array(psi1, dtype=float)
    lam, chi = np.asarray(lam), np.asarray(chi)
    eta = lam / rho
    lag, pulls, moved = np.zeros((rings, 2)), np.zeros((rings, 2)), np.zeros(2)
    drift = 0.5 * dt
    while True:
        zeta, moved = zeta + rate * drift, moved + slip * drift / ROOM**2
        if zeta <= 0.0:
            return rate, slip
        limit = hertz_pressure(table, np.sqrt(zeta) / ROOM)
        pressure = zeta**1.5
        if (carried := ROOM**3 * weight @ limit) > 0.0:
            limit = limit * (pressure / carried)  # those of the load P, a ring at the rim included
        pulls = tractions(matrix, limit, moved + lag, pulls)
        lag = matrix @ pulls - moved
        force = ROOM**3 * weight @ pulls
        rate = rate - 1.25 * dt * (pressure + lam @ force)
        slip = slip - dt * (1.25 * eta * pressure + 2.5 * chi @ force)
        drift = dt


def tractions(matrix, limit, wanted, pulls):
    """Return tractions below ``limit`` that move the surface as ``wanted``, or slip against it."""
    inside = int(np.count_nonzero(limit))
    pulls = np.where(limit[:, None] > 0.0, pulls, 0.0)
    block, most = matrix[:inside, :inside], limit[:inside]
    now, target = pulls[:inside], wanted[:inside]
    diagonal = np.diag(block)
    for _ in range(MOST_SWEEPS):
        greatest = 0.0
        for ring in range(inside):
            new = now[ring] - (block[ring] @ now - target[ring]) / diagonal[ring]
            size = np.hypot(*new)
            if size > most[ring]:
                new = new * (most[ring] / size)
            greatest = max(greatest, np.abs(new - now[ring]).max())
            now[ring] = new
        if greatest < SETTLED:
            return pulls
    raise AssertionError("the tractions do not settle")
