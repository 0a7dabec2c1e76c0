"""Tractions and slips over the contact, for histories with fields, in SI units."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import NormalMotion
from contactlab_laws.halfspace.axisymmetric import follow_all, table_of
from contactlab_laws.halfspace.course import course, units
from contactlab_laws.halfspace.hemispheres import Array
from contactlab_laws.halfspace.impacts import Matter, Options, kinds, pressure_of
from contactlab_laws.halfspace.march import follow

#: A point is stuck if its traction is below Coulomb's limit by more than this share.
BELOW = 1e-6


class Picture(NamedTuple):
    """One impact in dimensionless units, at instants with the impulses ``impulse``.

    Attributes
    ----------
    impulse : array, shape (K + 1,)
    radius : array, shape (rings,)
    values : array, shape (5, K + 1, angles, rings)
        Traction along x and y, slip along x and y, pressure.
    """

    impulse: Array
    radius: Array
    values: Array


class Pictures:
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

    def __init__(self, options: Options, every: NormalMotion, left: Any) -> None:
        self._options, self._every = options, every
        self._places = [tuple(place) for place in np.argwhere(left).tolist()]
        self._kept: list[Picture] = []

    def at(self, load_impulse: Any) -> Mapping[str, NDArray[Any]]:
        """Return the fields at the instants with the integrals ``load_impulse`` of the load, N s.

        The last axes are angles and rings. Angles are from the direction x of positive slip.
        ``radius`` in m, ``angle`` in radians, ``traction_x`` and ``traction_y``, positive where
        they oppose positive slip, and ``pressure`` in Pa, ``slip_x`` and ``slip_y`` in m,
        ``stuck`` True where a point in contact does not slip.

        Parameters
        ----------
        load_impulse : float or array
            Integral of the load at the instant of each impact, in N s, of the batch shape.
        """
        shape = self._every.scene.shape
        if not self._kept:
            self._kept = [self._picture(place) for place in self._places]
        rings, angles = max(len(each.radius) for each in self._kept), self._options.angles
        tables = np.full((5, *shape, angles, rings), np.nan)
        radii = np.full((*shape, rings), np.nan)
        stuck = np.zeros((*shape, angles, rings), dtype=bool)
        passed = np.broadcast_to(load_impulse, shape)
        for place, picture in zip(self._places, self._kept, strict=True):
            one = self._every.take(place) if shape else self._every
            unit, pair, mu = units(one), one.scene.pair, one.scene.friction_coefficient
            wanted = float(passed[place]) / float(pair.normal_mass * one.scene.normal_speed)
            pressure = float(1.5 * unit.force[0] / (math.pi * unit.length[0] ** 2))
            slip = float(mu * unit.length[0] ** 2 / (pair.stiffness_ratio * pair.radius))
            scales = np.array([mu * pressure, mu * pressure, slip, slip, pressure])
            values = _between(picture, wanted) * scales[:, None, None]
            count = len(picture.radius)
            index: Any = (slice(None), *place)
            tables[index][..., :count] = values
            stuck[place][..., :count] = _stuck(picture, wanted)
            radii[place][..., :count] = picture.radius * unit.length[0]
        along, across, slip_x, slip_y, pressed = tables
        angle = (np.arange(angles) + 0.5) * np.pi / angles
        return {
            "radius": radii,
            "angle": np.broadcast_to(angle, (*shape, angles)),
            "traction_x": along,
            "traction_y": across,
            "slip_x": slip_x,
            "slip_y": slip_y,
            "pressure": pressed,
            "stuck": stuck & (pressed > 0.0),
        }

    def _picture(self, place: tuple[int, ...]) -> Picture:
        """Return one impact, followed with its fields."""
        options, shape = self._options, self._every.scene.shape
        one = self._every.take(place) if shape else self._every
        matter = Matter.of(one)
        kind = kinds(options, matter)
        path = course(one, options.rings, int(kind.parts[0]))
        if kind.plain[0]:
            motion = follow_all(
                options.rings, path, matter.psi1, matter.chi, matter.stiffness, fields=True
            )
            rows = np.array([(traction[0], slip[0]) for traction, slip, _ in motion.fields])
            values = np.zeros((5, len(rows) + 1, options.angles, options.rings))
            values[0, 1:], values[2, 1:] = rows[:, 0, None], rows[:, 1, None]
            values[4, 1:] = np.array([limit[0] for _, _, limit in motion.fields])[:, None]
            return Picture(path.impulse[:, 0], table_of(options.rings).points, values)
        coupling = options.coupling if kind.dragged[0] else "none"
        pressure = pressure_of(path, matter, 0, options.rings, options.angles, coupling)
        followed = follow(pressure, float(matter.psi1[0]), float(matter.chi[0]), fields=True)
        along, table = pressure.table.along[:, :, 0], pressure.table
        values = np.zeros((5, len(followed.impulse), options.angles, table.count))
        for k, (traction, slip) in enumerate(followed.fields, start=1):
            for first, vector in ((0, traction), (2, slip)):
                cosine, sine = along[0][:, None], -along[1][:, None]
                values[first, k] = vector[0] * cosine - vector[1] * sine
                values[first + 1, k] = vector[0] * sine + vector[1] * cosine
            values[4, k] = traction[2] if len(traction) == 3 else pressure.limit(k)
        return Picture(followed.impulse, table.points, values)


def _around(picture: Picture, impulse: float) -> tuple[int, float]:
    """Return the instant after an impulse, and the share of the way to it from the one before."""
    knots = picture.impulse
    last = int(np.clip(np.searchsorted(knots, impulse), 1, len(knots) - 1))
    width = knots[last] - knots[last - 1]
    share = float(np.clip((impulse - knots[last - 1]) / width, 0.0, 1.0)) if width > 0.0 else 1.0
    return last, share


def _between(picture: Picture, impulse: float) -> Array:
    """Return the values at an impulse, linear between instants, shape (5, angles, rings)."""
    last, share = _around(picture, impulse)
    return np.asarray((1.0 - share) * picture.values[:, last - 1] + share * picture.values[:, last])


def _stuck(picture: Picture, impulse: float) -> NDArray[np.bool_]:
    """Return where the step about an impulse sticks, shape (angles, rings).

    Coulomb's limit is compared at the end of the step, or at its beginning where the contact has
    gone by its end: a mean of two tractions at the limit lies below the limit if they turn.
    """
    last, _ = _around(picture, impulse)
    ends = picture.values[:, last - 1 : last + 1]
    below = np.hypot(ends[0], ends[1]) < ends[4] * (1.0 - BELOW)
    return np.asarray(np.where(ends[4, 1] > 0.0, below[1], below[0]))
