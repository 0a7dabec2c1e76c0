"""Tractions and displacements as Fourier modes over the angle, theory §9.

Traction and displacement have a radial part sum R_m cos(m theta), a tangential part
sum T_m sin(m theta), and a normal part sum P_m cos(m theta). They are given at angles in the middle
of equal parts of the half circle; the other half is its mirror image. Every m stands alone.

Where bodies spin about the normal too the mirror stands along the slip, not across (theory §17):
angles are from the normal to the slip, the radial part is -sum R_m sin(m theta), the tangential
part sum T_m cos(m theta), and m = 0 is torsion.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from contactlab.numeric.types import Array
from contactlab_halfspace.basis import Basis, basis
from contactlab_halfspace.hemispheres import displacement

#: Factor on the local inverse compliance in ``Modes.metric``: the fewest applications of 1 to 8.
METRIC = 2.0
#: How far the rings reach beyond the largest Hertz contact where traction changes the contact.
SPARE = 0.03


class Modes:
    """Compliance of rings and angles, and the inverses that a step needs; made once and kept.

    Fields are arrays of shape (impacts, parts, angles, rings). The parts are radial and tangential,
    and the normal part if there are three.

    Parameters
    ----------
    rings, angles : int
        Rings within the largest Hertz contact, and angles on the half circle.
    poisson : float
        The effective Poisson's ratio of both bodies.
    drag : float
        Lam = kappa beta/mu, how far pressure drags the surfaces sideways.
    lift : float or None
        mu beta, how far traction lifts the surfaces. None: pressure is prescribed, two parts.
    spins : bool
        Whether bodies spin about the normal; then without drag and lift.
    """

    def __init__(
        self,
        rings: int,
        angles: int,
        poisson: float,
        drag: float,
        lift: float | None,
        spins: bool = False,
    ) -> None:
        self.spins = spins
        self.parts = 2 if lift is None else 3
        self.angles = angles
        self.basis = basis(rings, angles + 2, 0.0 if lift is None else SPARE)
        self.points = self.basis.edges[:-1]
        self.count = len(self.points)
        theta = (np.arange(angles) + 0.5) * np.pi / angles
        self.to, self.back = _transforms(theta, self.parts, spins)
        turned = theta + 0.5 * np.pi if spins else theta
        #: A unit displacement along x, shape (2, angles, 1); a unit rotation about the normal.
        self.along = np.stack((np.cos(turned), -np.sin(turned)))[:, :, None]
        self.turn = np.stack((0.0 * self.points, self.points))[:, None]
        self.compliance = _compliance(self.basis, angles, poisson, drag, lift, spins)
        local = np.diag(self.basis.compliance(0, 0))
        self._metric = METRIC / local
        self._resolvents: dict[int, Array] = {}
        #: Drag of the pressure sqrt(e_i² - r²) for each edge, shape (edges, 2, 1, rings).
        self.drags = np.zeros((self.count, 2, 1, self.count))
        self.drags[:, 0, 0] = -drag * displacement(1, 0, self.points, self.basis.edges[1:, None])

    def metric(self, number: int) -> Array:
        """Return the factor that takes displacements to tractions, shape (number,)."""
        return self._metric[:number]

    def resolvent(self, number: int) -> Array:
        """Return the inverses of 1 + metric compliance of the first rings, for every mode."""
        if number not in self._resolvents:
            size = self.parts * number
            block = self.compliance[:, :, :number, :, :number].reshape(-1, size, size)
            scaled = np.tile(self.metric(number), self.parts)[:, None] * block
            self._resolvents[number] = np.asarray(np.linalg.inv(np.eye(size) + scaled), float)
        return self._resolvents[number]

    def force(self, number: int) -> Array:
        """Return the weights of F, the mean over the angles, shape (2, angles, number)."""
        return self.along * self.basis.force[:number] / self.angles

    def moment(self, traction: Array) -> Array:
        """Return the moments about the normal, over mu a times the force of the largest contact."""
        edges = self.basis.edges[1 : traction.shape[3] + 1]
        inner = self.basis.coefficients[1][: len(edges), : len(edges)]
        return np.asarray(self.to[1, 0] @ traction[:, 1] @ (0.4 * edges**4 @ inner))

    def displace(self, traction: Array) -> Array:
        """Return the displacements at all rings, shape (impacts, parts, angles, rings)."""
        number = traction.shape[3]
        full = self.compliance[:, :, :, :, :number]
        blocks = full.reshape(self.angles + 1, self.parts * self.count, self.parts * number)
        return self.through(blocks, traction)

    def through(self, blocks: Array, fields: Array) -> Array:
        """Return the fields that a matrix for every mode makes of ``fields``.

        Parameters
        ----------
        blocks : array, shape (modes, parts * rings of the result, parts * rings)
        fields : array, shape (impacts, parts, angles, rings)
        """
        # A product for each impact: one for all would round an impact by its place in the batch.
        shape = len(fields), self.angles + 1
        columns = (self.to @ fields).swapaxes(1, 2).reshape(*shape, -1, 1)
        made = (blocks @ columns).reshape(*shape, self.parts, -1)
        return np.asarray(self.back @ made.swapaxes(1, 2))

    def work(self, traction: Array, slip: Array) -> Array:
        """Return the integrals of traction times slip over the contact, over 2 pi."""
        ours, moved = self.to[:2] @ traction, self.to[:2] @ slip
        even, works = int(self.spins), self.basis.work
        pairs = [(moved[:, even, 0] @ works[1], ours[:, even, 0])]
        outer, outer_slip = 0.5 * (ours[:, 0] + ours[:, 1]), 0.5 * (moved[:, 0] + moved[:, 1])
        inner, inner_slip = 0.5 * (ours[:, 0] - ours[:, 1]), 0.5 * (moved[:, 0] - moved[:, 1])
        for m in range(1, self.angles + 1):
            pairs.append((outer_slip[:, m] @ works[m + 1], outer[:, m]))
            pairs.append((inner_slip[:, m] @ works[m - 1], inner[:, m]))
        return np.asarray(sum(np.einsum("nr,nr->n", *pair) for pair in pairs))


modes = lru_cache(maxsize=6)(Modes)


def _transforms(theta: Array, parts: int, spins: bool) -> tuple[Array, Array]:
    """Return the matrices from values to modes and back, shape (parts, modes, angles) and back."""
    count = len(theta)
    order = np.arange(count + 1)[:, None]
    cosines, sines = np.cos(order * theta), np.sin(order * theta)
    even, odd = cosines * (2.0 / count), sines * (2.0 / count)
    even[0] *= 0.5
    odd[-1] *= 0.5
    for table in (even, cosines):
        table[-1] = 0.0  # the angles are its zeros
    chosen, inverse = [even, odd, even][:parts], [cosines, sines, cosines][:parts]
    if spins:
        chosen, inverse = [-odd, even], [-sines, cosines]
    return np.stack(chosen), np.stack([each.T for each in inverse])


def _compliance(
    table: Basis, angles: int, poisson: float, drag: float, lift: float | None, spins: bool
) -> Array:
    """Return the blocks of every m, shape (modes, parts, rings, parts, rings)."""
    # The complex modes 1 + m and 1 - m are (R_m + T_m)/2 and (R_m - T_m)/2.
    count, parts = len(table.force), 2 if lift is None else 3
    blocks = np.zeros((angles + 1, parts, count, parts, count))
    cross = poisson / (2.0 - poisson)
    same = [table.compliance(order, order) for order in range(angles + 2)]
    even = int(spins)
    blocks[0, even, :, even] = (1.0 + cross if spins else 1.0 - cross) * same[1]
    for m in range(1, angles + 1):
        outer, inner = same[m + 1], same[m - 1]
        rise = cross * table.compliance(m + 1, m - 1)
        fall = cross * table.compliance(m - 1, m + 1)
        blocks[m, 0, :, 0] = 0.5 * (outer + inner + rise + fall)
        blocks[m, 0, :, 1] = 0.5 * (outer - inner - rise + fall)
        blocks[m, 1, :, 0] = 0.5 * (outer - inner + rise - fall)
        blocks[m, 1, :, 1] = 0.5 * (outer + inner - rise - fall)
    if lift is not None:
        blocks[0, 2, :, 2] = same[0]
        blocks[0, 0, :, 2] = -drag * table.compliance(1, 0)
        blocks[0, 2, :, 0] = -lift * table.compliance(0, 1)
        for m in range(1, angles):
            outer, inner = (table.compliance(m + by, m) for by in (1, -1))
            blocks[m, 0, :, 2] = 0.5 * drag * (inner - outer)
            blocks[m, 1, :, 2] = -0.5 * drag * (inner + outer)
            outer, inner = (table.compliance(m, m + by) for by in (1, -1))
            blocks[m, 2, :, 0] = 0.5 * lift * (inner - outer)
            blocks[m, 2, :, 1] = -0.5 * lift * (inner + outer)
            blocks[m, 2, :, 2] = same[m]
    blocks[angles, even] = 0.0
    blocks[angles, :, :, even] = 0.0
    return blocks
