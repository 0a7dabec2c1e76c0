"""A normal motion as instants at which the contact ends on an edge of a ring, or between two.

Steps end on edges, as a ring then enters the contact exactly where a step begins. Between two edges
the pressure is the two hemispheres of both edges that carry the same b².
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import ClosedFormMotion, NormalMotion
from contactlab.numeric.types import Array, Places
from contactlab_halfspace.basis import edge_at

#: Phases at which the radius is sampled, and halvings in the search of an instant.
SEARCHED, HALVINGS = 257, 50


class Instants(NamedTuple):
    """Instants of the normal motions of one impact or more; scaled, see ``units``.

    Attributes
    ----------
    inside : array of int, shape (K + 1,)
        Rings that the contact reaches into at each instant, from first touch to separation.
    share : array, shape (K + 1,)
        Share of the hemisphere of the outer edge; the rest is that of the edge before.
    radius : array, shape (K + 1,)
        Contact radius over its largest.
    time, impulse : array, shape (K + 1, impacts) or (K + 1, 1)
        Since first touch: time, and the integral of the friction load.
    pressure : array, shape (K + 1, impacts) or (K + 1, 1)
        Friction load over that of a Hertz contact of the radius; 0 out of contact.
    phase : array, shape (K + 1, impacts) or (K + 1, 1)
        Phases of the normal motion.
    """

    inside: NDArray[np.int64]
    share: Array
    radius: Array
    time: Array
    impulse: Array
    pressure: Array
    phase: Array

    def take(self, items: Places | list[int]) -> Instants:
        """Return the instants of the impacts with these places."""
        columns = {
            name: column[:, items if column.shape[1] > 1 else np.zeros_like(items)]
            for name, column in self._asdict().items()
            if column.ndim == 2
        }
        return self._replace(**columns)


class Units(NamedTuple):
    """Units of each impact: time in s, force in N of the largest Hertz contact of its radius."""

    time: Array
    force: Array
    length: Array


def units(normal: NormalMotion) -> Units:
    """Return a²/(R v1) and (4/3) E* a³/R, a the largest contact radius, and a, of each impact."""
    scene, radius = normal.scene, np.atleast_1d(np.asarray(normal.maximum_radius, float))
    pair = scene.pair
    time = radius**2 / np.atleast_1d(pair.radius * scene.normal_speed)
    force = (4.0 / 3.0) * np.atleast_1d(pair.effective_modulus / pair.radius) * radius**3
    return Units(time, force, radius)


def instants(normal: NormalMotion, rings: int, parts: int) -> Instants:
    """Return the instants over ``rings`` rings, each passed in ``parts`` steps.

    Parameters
    ----------
    normal : NormalMotion
        Motion of one impact, or of a batch of shape (impacts,), whose radius grows, then falls.
    rings, parts : int
        Rings within the largest contact, and steps from one edge to the next.
    """
    count = rings * parts
    steps = np.concatenate((np.arange(count + 1), np.arange(count - 1, -1, -1)))
    places = edge_at(np.arange(count + 1) / count)[steps]
    inside = -(-steps // parts)
    edges = edge_at(np.arange(rings + 1) / rings)
    outer, inner = edges[inside] ** 2, edges[np.maximum(inside - 1, 0)] ** 2
    share = np.where(
        inside > 0, (places**2 - inner) / np.where(inside > 0, outer - inner, 1.0), 1.0
    )
    phase = _phases(normal, places, count)
    shape = normal.scene.shape
    sample = normal.at(phase if shape else phase[:, 0])
    unit = units(normal)
    scene = normal.scene
    momentum = np.atleast_1d(scene.pair.normal_mass * scene.normal_speed)
    columns = [
        np.asarray(each, float).reshape(len(steps), -1)
        for each in (sample.time, sample.load_impulse, sample.contact.friction_load)
    ]
    touching = (phase > 0.0) & (phase < math.pi) & (inside > 0)[:, None]
    hertz = unit.force * np.where(inside > 0, places, 1.0)[:, None] ** 3
    return Instants(
        inside=inside,
        share=share,
        radius=places,
        time=columns[0] / unit.time,
        impulse=columns[1] / momentum,
        pressure=np.where(touching, columns[2], 0.0) / hertz,
        phase=phase,
    )


def _phases(normal: NormalMotion, places: Array, top: int) -> Array:
    """Return the phases at which the radius over its largest is ``places``, shape (K + 1, n)."""
    # Radii below those at first touch or at separation get the phase of that end.
    if isinstance(normal, ClosedFormMotion) and "elastic_hertz" in normal.claims:
        rate = np.sqrt(1.0 - places**5)  # energy: V² + b⁵ = 1
        rate[top + 1 :] *= -1.0
        phases = np.asarray(normal.phase_at_rate(rate), float)[:, None]
        phases[[0, top, -1], 0] = 0.0, 0.5 * math.pi, math.pi
        return phases
    if isinstance(normal, ClosedFormMotion):

        def scaled(phase: Array) -> Array:  # over the largest, which all impacts share
            return np.asarray(normal.scaled(phase[:, 0]).radius)[:, None]

        return _halve(scaled, places, top, 0.5 * math.pi)
    single = not normal.scene.shape

    def radius(phase: Array) -> Array:
        radii = normal.at(phase[..., 0] if single else phase).contact.radius
        return np.asarray(radii, float).reshape(phase.shape)

    impacts = 1 if single else normal.scene.shape[0]
    table = np.broadcast_to(np.linspace(0.0, math.pi, SEARCHED)[:, None], (SEARCHED, impacts))
    highest = radius(table).argmax(axis=0)
    step = math.pi / (SEARCHED - 1)
    low, high = np.maximum(highest - 1, 0) * step, np.minimum(highest + 1, SEARCHED - 1) * step
    for _ in range(HALVINGS):
        third = (high - low) / 3.0
        inner, outer = radius(np.stack((low + third, high - third)))
        rises = inner < outer
        low, high = np.where(rises, low + third, low), np.where(rises, high, high - third)
    return _halve(radius, places, top, 0.5 * (low + high))


def _halve(
    radius: Callable[[Array], Array], places: Array, top: int, greatest: Array | float
) -> Array:
    """Return the phases with radii ``places`` by halving, given that of the ``greatest``."""
    peak = np.atleast_1d(np.asarray(greatest))
    wanted = places[:, None] * np.asarray(radius(peak[None]))
    rising = np.arange(len(places))[:, None] <= top
    low = np.where(rising, 0.0, peak) + np.zeros(wanted.shape)
    high = np.where(rising, peak, math.pi) + np.zeros(wanted.shape)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = (radius(middle) < wanted) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    phases = np.where(rising, high, low)
    ends = radius(np.array([[0.0], [math.pi]]) + np.zeros((2, peak.size)))
    phases = np.where(rising & (wanted <= ends[0]), 0.0, phases)
    phases = np.where(~rising & (wanted <= ends[1]), math.pi, phases)
    phases[0], phases[top], phases[-1] = 0.0, peak, math.pi
    return np.asarray(phases)
