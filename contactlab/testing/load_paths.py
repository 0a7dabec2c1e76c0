"""Paths of slip and load, a test bench for a contact, and the scaled answers of a law.

The unit of slip is mu C²R/kappa, the normal load is given by zeta: gross slip begins at
slip = zeta. The unit of force is mu P_max, as in theory §§1 and 4.
"""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.contracts import (
    Increment,
    NormalContact,
    NormalMotion,
    SteppedTangentialLaw,
    claims,
)
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import greater, lock_arrays
from contactlab.numeric.types import Array, Real
from contactlab.paths.path_steps import advance_steps
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing import limits
from contactlab.testing.check import hold
from contactlab.testing.units import Units

#: chi of a body so heavy that friction does not change its motion.
HEAVY = 1e-4
#: Default friction coefficient.
FRICTION = 0.3
#: Steps from one knot of a straight path to the next.
STEPS_TO_KNOT = 40


def scene(
    psi1: Real,
    chi: Real,
    *,
    friction: Real = FRICTION,
    units: Units | None = None,
    bodies: Real = 1.0,
) -> Scene:
    """Return the scene of a ball like one of steel, by psi1 and chi, in a system of units.

    Parameters
    ----------
    psi1, chi, friction : float or array
    units : Units, optional
        System of units of the scene; SI by default.
    bodies : float or array
        1 for the ball; another number changes radius, moduli, mass and speed.
    """
    length, time, mass = units or Units()
    pressure = mass / (length * time**2)
    modulus, kappa = 1.12e11 * pressure / bodies**0.5, 0.823529 / bodies**0.1
    pair = Pair(
        radius=0.0127 * length * bodies,
        effective_modulus=modulus,
        effective_shear_modulus=kappa * modulus,
        normal_mass=0.067 * mass * bodies**1.7,
        tangential_mass=0.5 * kappa * (0.067 * mass * bodies**1.7) / chi,
    )
    speed = 0.83 * length / time / bodies**0.3
    return Scene(None, None, friction, speed, psi1 * friction * speed / kappa, pair=pair)


def bodies(*shape: int) -> Array:
    """Return values of ``bodies`` of ``scene`` for a batch of unlike bodies."""
    return np.linspace(0.6, 1.6, math.prod(shape)).reshape(shape)


#: Quantities in which the contacts of a batch may differ.
QUANTITIES = (
    "friction_coefficient", "normal_speed", "radius", "effective_modulus",
    "effective_shear_modulus", "normal_mass", "tangential_mass",
)  # fmt: skip


def vary(quantity: str) -> Scene:
    """Return a batch of three central impacts of heavy bodies that differ in one quantity."""
    base = scene(0.0, HEAVY)
    factors = np.linspace(0.6, 1.6, 3)
    if quantity in ("friction_coefficient", "normal_speed"):
        return attrs.evolve(base, **{quantity: getattr(base, quantity) * factors})
    pair = attrs.evolve(base.pair, **{quantity: getattr(base.pair, quantity) * factors})
    return attrs.evolve(base, pair=pair)


class Path(NamedTuple):
    """Slip and zeta at the ends of the steps, shape (K,) or (K, *batch); the start is 0, 0."""

    slip: Array
    level: Array


class Answers(NamedTuple):
    """Scaled force and friction work of each step, shape (K, *batch), and the last state."""

    force: Array
    work: Array
    state: object


@attrs.frozen
class Bench:
    """One contact or a batch, with its scales P_max, a, C²R, unit of slip, and duration."""

    scene: Scene
    normal: NormalMotion
    force: Real
    radius: Real
    approach: Real
    slip: Real
    time: Real

    @classmethod
    def of(cls, shape: tuple[int, ...] = (), units: Units | None = None) -> Bench:
        """Return a bench; the contacts of a batch differ in friction and in the bodies."""
        friction: Real = FRICTION
        sizes: Real = 1.0
        if shape:
            friction = np.linspace(0.1, 0.7, math.prod(shape)).reshape(shape)
            sizes = bodies(*shape)
        impacts = scene(0.0, HEAVY, friction=friction, units=units, bodies=sizes)
        return cls.along(normal_motion(REGISTRY.create("normal.hertz"), impacts))

    @classmethod
    def along(cls, normal: NormalMotion) -> Bench:
        """Return the bench of contacts up to the largest contact radius of ``normal``."""
        impacts, radius = normal.scene, normal.maximum_radius
        approach = radius * radius / impacts.pair.radius
        force = (4.0 / 3.0) * impacts.pair.effective_modulus * radius * approach
        slip = impacts.friction_coefficient * approach / impacts.pair.stiffness_ratio
        return cls(impacts, normal, force, radius, approach, slip, normal.duration)

    def alone(self, place: int | tuple[int, ...]) -> Bench:
        """Return the bench of one contact of a batch."""
        return Bench.along(self.normal.take(place))

    def start(self, law: SteppedTangentialLaw) -> object:
        """Return the state of ``law`` at first touch."""
        return law.start(self.scene, self.normal)

    def contact(self, level: Real) -> NormalContact:
        """Return the Hertz contact at zeta = ``level``; negative levels are out of contact."""
        inside = greater(level, 0.0)
        force = lock_arrays(self.force * inside**1.5)
        radius, overlap = lock_arrays(self.radius * inside**0.5), lock_arrays(self.approach * level)
        return NormalContact(force, radius, overlap, force)

    def increment(self, slip: Real, after: NormalContact, duration: Real) -> Increment:
        """Return the increment of a step by ``slip``, scaled."""
        displacement = lock_arrays(self.slip * slip)
        return Increment(
            displacement,
            lock_arrays(displacement / duration),
            after.friction_load,
            duration,
            duration,
        )

    @property
    def friction_force(self) -> Real:
        """Unit of tangential force, mu P_max, in N."""
        return self.scene.friction_coefficient * self.force


def drive(law: SteppedTangentialLaw, bench: Bench, path: Path) -> Answers:
    """Return the answers of ``law`` along ``path``, from first touch."""
    return continue_from(law, bench, bench.start(law), path)


def continue_from(
    law: SteppedTangentialLaw,
    bench: Bench,
    state: object,
    path: Path,
    *,
    slip: Real = 0.0,
    level: Real = 0.0,
    count: int | None = None,
) -> Answers:
    """Return the answers of ``law`` along ``path``, beginning at ``state``.

    Parameters
    ----------
    law : SteppedTangentialLaw
    bench : Bench
    state : object
        State of the law at ``slip`` and ``level``.
    path : Path
    slip, level : float or array
        Scaled slip and zeta at which the path begins.
    count : int, optional
        Number of steps of the whole path, if ``path`` is a part of it.
    """
    duration = lock_arrays(bench.time / (count or len(path.slip)))
    at_one_speed = "slip_speed" in claims(law)
    limits.begin(f"a path of {len(path.slip)} steps")
    rows = zip(_rows(path.slip), _rows(path.level), strict=True)

    def steps() -> Iterator[tuple[Increment, NormalContact]]:
        here = slip
        for next_slip, next_level in rows:
            after = bench.contact(next_level)
            limits.DOING.steps += 1
            moved = next_slip - here
            lasts = duration
            if at_one_speed:  # a unit of slip in the duration of an impact
                lasts = lock_arrays(np.where(moved == 0.0, duration, bench.time * abs(moved))[()])
            yield bench.increment(moved, after, lasts), after
            here = next_slip

    answers, states = advance_steps(law, state, bench.contact(level), steps())
    for _, _, settled in answers:
        hold(np.all(settled), "The law found no answer on a straight load path.")
    forces = [force / bench.friction_force for force, _, _ in answers]
    works = [work / (bench.friction_force * bench.slip) for _, work, _ in answers]
    return Answers(np.array(forces), np.array(works), states[-1] if states else state)


def _rows(column: Array) -> Sequence[Real] | Array:
    """Return the rows of a column: floats for one contact, arrays for a batch."""
    return column.tolist() if column.ndim == 1 else column


def straight(*knots: tuple[float, float], steps: int = STEPS_TO_KNOT) -> Path:
    """Return the path from 0, 0 through ``knots`` (slip, zeta), with ``steps`` to each knot."""
    points = np.array([(0.0, 0.0), *knots])
    parts = np.linspace(0.0, 1.0, steps + 1)[1:, None]
    legs = [start + parts * (stop - start) for start, stop in itertools.pairwise(points)]
    slip, level = np.concatenate(legs).T
    return Path(slip, level)


def wandering(seed: int, *, knots: int = 12, steps: int = 16, fixed: bool = False) -> Path:
    """Return a path through random knots, with stick, partial and gross slip.

    The leg to the first knot only presses.

    Parameters
    ----------
    seed : int
    knots : int
    steps : int
        Steps from one knot to the next.
    fixed : bool
        Keep the normal load constant after the first knot.
    """
    draw = np.random.default_rng(seed)
    slips = draw.normal(0.0, 0.8, knots)
    levels = np.full(knots, 0.7) if fixed else draw.uniform(0.05, 1.0, knots)
    slips[0] = 0.0
    return straight(*zip(slips.tolist(), levels.tolist(), strict=True), steps=steps)


#: Bound of the error of a law that has a resolution, over the largest force or energy.
DISCRETE = 0.02


def slack(law: TangentialLaw, exact: float = 1e-9) -> float:
    """Return the bound of a law's error: ``exact`` without a resolution, else ``DISCRETE``."""
    return exact if law.resolution is None else DISCRETE
