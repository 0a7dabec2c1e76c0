"""Tractions and slips over the contact, for histories with fields, in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import NormalMotion
from contactlab.numeric.types import Array, Index, Mask, Real
from contactlab_halfspace.basis import basis
from contactlab_halfspace.groups import Options, groups, signs
from contactlab_halfspace.instants import units
from contactlab_halfspace.modes import SPARE

#: A point is stuck if its traction is below Coulomb's limit by more than this share.
BELOW = 1e-6


class Fields:
    """The fields of the impacts of a normal motion; followed again when first asked for.

    Parameters
    ----------
    options : Options
        Options of the law.
    every : NormalMotion
        Motion of one impact or of a batch.
    left : array of bool
        The impacts of ``every`` that have fields.
    """

    def __init__(self, options: Options, every: NormalMotion, left: Mask) -> None:
        self._options, self._every = options, every
        self._places = [tuple(place) for place in np.argwhere(left).tolist()]
        self._kept: list[tuple[Array, Array, Array, Array]] = []

    def at(self, load_impulse: Real) -> Mapping[str, NDArray[Any]]:
        """Return the fields at the instants with the integrals ``load_impulse`` of the load, N s.

        The last axes are angles and rings. Angles are from the direction x of positive slip, over
        the half circle of positive y; where bodies spin over that of negative x. Along the other
        half both x components are equal, both y components of opposite sign.
        ``radius`` in m, ``angle`` in radians, ``traction_x`` and ``traction_y``, positive where
        they oppose positive slip, and ``pressure`` in Pa, ``slip_x`` and ``slip_y`` in m,
        ``stuck`` True where a point in contact does not slip.

        Parameters
        ----------
        load_impulse : float or array
            Integral of the load at the instant of each impact, in N s, of the batch shape.
        """
        shape, angles = self._every.scene.shape, self._options.angles
        if not self._kept:
            self._kept = [self._follow_rings(place) for place in self._places]
        rings = max(len(radius) for _, radius, _, _ in self._kept)
        tables = np.full((5, *shape, angles, rings), np.nan)
        radii = np.full((*shape, rings), np.nan)
        stuck = np.zeros((*shape, angles, rings), dtype=bool)
        passed, around = np.broadcast_to(load_impulse, shape), np.zeros((*shape, angles))
        for place, (impulse, radius, values, theta) in zip(self._places, self._kept, strict=True):
            around[place] = theta
            one = self._every.take(place) if shape else self._every
            unit, pair, mu = units(one), one.scene.pair, one.scene.friction_coefficient
            wanted = float(passed[place]) / float(pair.normal_mass * one.scene.normal_speed)
            pressure = float(1.5 * unit.force[0] / (math.pi * unit.length[0] ** 2))
            slip = float(mu * unit.length[0] ** 2 / (pair.stiffness_ratio * pair.radius))
            scales = np.array([mu * pressure, mu * pressure, slip, slip, pressure])
            index: Index = (slice(None), *place)
            count = len(radius)
            ends, share = _around(impulse, wanted, values)
            between = (1.0 - share) * ends[:, 0] + share * ends[:, 1]
            tables[index][..., :count] = between * scales[:, None, None]
            # Coulomb's limit is compared at the end of the step about the impulse, or at its
            # beginning where the contact has gone by its end: a mean of two tractions at the limit
            # lies below the limit if they turn.
            below = np.hypot(ends[0], ends[1]) < ends[4] * (1.0 - BELOW)
            stuck[place][..., :count] = np.where(ends[4, 1] > 0.0, below[1], below[0])
            radii[place][..., :count] = radius * unit.length[0]
        along, across, slip_x, slip_y, pressed = tables
        return {
            "radius": radii,
            "angle": around,
            "traction_x": along,
            "traction_y": across,
            "slip_x": slip_x,
            "slip_y": slip_y,
            "pressure": pressed,
            "stuck": stuck & (pressed > 0.0),
        }

    def _follow_rings(self, place: tuple[int, ...]) -> tuple[Array, Array, Array, Array]:
        """Return impulses (K + 1,), radii (rings,), values (5, K + 1, angles, rings), angles."""
        # The values are traction along x and y, slip along x and y, and pressure.
        rings, angles = self._options.rings, self._options.angles
        one = self._every.take(place) if self._every.scene.shape else self._every
        group = next(groups(self._options, one))
        motion = group.follow(rings, angles, fields=True)
        spare = SPARE if motion.departures is not None else 0.0
        radii = basis(rings, 1 if group.plain else angles + 2, spare).edges[:-1]
        values = np.zeros((5, len(motion.impulse), angles, len(radii)))
        theta = (np.arange(angles) + 0.5) * np.pi / angles  # in the middle of equal parts
        if group.spins:
            theta = (theta + 0.5 * np.pi) * signs(group.matter.psi1, group.matter.rim)[1]
        cosine, sine = np.cos(theta)[:, None], np.sin(theta)[:, None]
        for k, (traction, slip, pressure) in enumerate(motion.fields, start=1):
            values[4, k] = pressure
            for first, vector in ((0, traction), (2, slip)):
                if group.plain:
                    values[first, k] = vector
                else:
                    values[first, k] = vector[0] * cosine - vector[1] * sine
                    values[first + 1, k] = vector[0] * sine + vector[1] * cosine
        return motion.impulse[:, 0], radii, values, theta


def _around(knots: Array, impulse: float, values: Array) -> tuple[Array, float]:
    """Return the values at the two instants around an impulse, and the share of the later one."""
    last = int(np.clip(np.searchsorted(knots, impulse), 1, len(knots) - 1))
    width = knots[last] - knots[last - 1]
    share = float(np.clip((impulse - knots[last - 1]) / width, 0.0, 1.0)) if width > 0.0 else 1.0
    return values[:, last - 1 : last + 1], share
