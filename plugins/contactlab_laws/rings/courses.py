"""A normal motion as a ``Course``: instants at which the contact ends on an edge of a ring."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.contracts.motion import NormalMotion
from contactlab.impact.scene import Scene
from contactlab_laws.rings.rings import Array, Course, rebound

#: Phases in the search of the largest radius, and halvings in that of an instant.
SEARCHED, HALVINGS = 4001, 60
#: Numbers of rings, from whose answers the limit follows to 2e-4 in psi2:
#: ``tests/laws/test_rings.py``.
COUNTS = (48, 64, 80, 96, 112, 128)
#: Rings of impacts beyond the table of Tsuji's law, and psi1 beyond which the change of psi is its
#: limit to 1e-4.
BEYOND, LARGEST = (48, 64, 80), 1e4
#: Largest radius at first touch and at separation that counts as 0, over the largest radius.
NOTHING = 1e-6


def course(motion: NormalMotion, count: int) -> Course:
    """Return the course over ``count`` rings of one impact whose radius grows, then falls."""
    # The edges stand at a sin(i pi/(2 count)), a the largest radius. The edges next to the radii at
    # first touch and at separation are moved to these radii.
    scene = motion.scene
    phases = np.linspace(0.0, math.pi, SEARCHED)
    radius = _radii(motion, phases)
    top = _largest(motion, phases, radius)
    largest = float(motion.at(top).contact.radius)
    first, last = (float(each) if each > NOTHING * largest else 0.0 for each in radius[[0, -1]])
    shares, numbers = _edges(count, [min(each / largest, 1.0) for each in (first, last)])
    loading = np.arange(numbers[0], count + 1)
    unloading = np.arange(count - 1, numbers[1] - 1, -1)
    inside = np.concatenate((loading, unloading))
    wanted = largest * shares
    at = np.concatenate(
        (
            _instants(motion, wanted[loading], 0.0, top, rising=True),
            _instants(motion, wanted[unloading], top, math.pi, rising=False),
        )
    )
    at[0], at[-1], at[len(loading) - 1] = 0.0, math.pi, top
    sample = motion.at(at)
    pair, unit = scene.pair, largest**2 / (scene.pair.radius * scene.normal_speed)
    hertz = (4.0 / 3.0) * pair.effective_modulus * largest**3 / pair.radius
    return Course(
        edges=shares,
        inside=inside,
        time=np.asarray(sample.time) / unit,
        load=np.asarray(sample.contact.friction_load) / hertz,
        impulse=np.asarray(sample.load_impulse) / (pair.normal_mass * scene.normal_speed),
    )


def solve(
    psi1: Array, chi: Array, motion: NormalMotion, *, counts: tuple[int, ...] = COUNTS
) -> Array:
    """Return psi2 in the limit of many rings, shape (impacts,); ``motion`` is scaled for each."""
    # The limit is that of a + b/n². Where a slip front stands between two edges adds an error that
    # differs from one number of rings to the next: several numbers make its mean smaller.
    numbers = np.array(counts, dtype=np.float64)
    answers = np.array([rebound(psi1, chi, course(motion, count)) for count in counts])
    weights = (numbers / numbers.max()) ** 2
    terms = np.stack([weights, weights / numbers**2], axis=1)
    return np.asarray(np.linalg.lstsq(terms, answers * weights[:, None], rcond=None)[0][0])


def tsuji(e: float) -> NormalMotion:
    """Return the normal motion under Tsuji's law, in scaled units that of every impact."""
    law = REGISTRY.create("normal.tsuji", restitution=e)
    return normal_motion(law, Scene.nondimensional(psi1=1.0, chi=1.0))


def by_rings(psi1: Array, chi: Array, e: float, *, counts: tuple[int, ...] = BEYOND) -> Array:
    """Return psi2 of psi1 >= 0 under Tsuji's law, shape (impacts,).

    Parameters
    ----------
    psi1, chi : array, shape (impacts,)
    e : float
        Restitution.
    counts : tuple of int
        Numbers of rings.
    """
    near = np.minimum(psi1, LARGEST)
    change = solve(near, chi, tsuji(e), counts=counts) - near
    # no impact gains energy: not even by an error
    return np.asarray(np.clip(psi1 + change, -psi1, psi1))


def _edges(count: int, marks: list[float]) -> tuple[Array, list[int]]:
    """Return the edges, which include the radii ``marks``, and the numbers of these edges."""
    angles = [2.0 / math.pi * math.asin(mark) for mark in marks]
    numbers = [min(max(round(count * each), 1), count - 1) if each > 0.0 else 0 for each in angles]
    angle_at = {0: 0.0, count: 1.0}
    angle_at.update((number, each) for number, each in zip(numbers, angles, strict=True) if number)
    places = sorted(angle_at)
    at = np.interp(np.arange(count + 1), places, [angle_at[place] for place in places])
    return np.sin(0.5 * np.pi * at), numbers


def _radii(motion: NormalMotion, phases: Any) -> Array:
    """Return the contact radius at ``phases``, in m."""
    sample = motion.at(phases)
    return np.asarray(sample.contact.radius, dtype=np.float64)


def _largest(motion: NormalMotion, phases: Array, radius: Array) -> float:
    """Return the phase of the largest radius, by ternary search."""
    k = int(radius.argmax())
    low, high = float(phases[max(k - 1, 0)]), float(phases[min(k + 1, len(phases) - 1)])
    for _ in range(HALVINGS):
        third = (high - low) / 3.0
        inner, outer = _radii(motion, np.array([low + third, high - third]))
        low, high = (low + third, high) if inner < outer else (low, high - third)
    return 0.5 * (low + high)


def _instants(
    motion: NormalMotion, wanted: Array, start: float, end: float, *, rising: bool
) -> Array:
    """Return the phases at which the contact has the ``wanted`` radii (m), by halving."""
    low, high = np.full(len(wanted), start), np.full(len(wanted), end)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = (_radii(motion, middle) < wanted) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    return np.asarray(0.5 * (low + high))
