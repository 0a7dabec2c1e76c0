"""A contact that is loaded at will, as on a testing machine, and the scaled answers of a law.

Slip is in units of mu C²R/kappa and normal load in terms of zeta, so that gross slip
begins at slip = zeta and the forces, in units of mu P_max, are those of theory §§1 and 4.
"""

from __future__ import annotations

import itertools
import math
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY
from contactlab.contracts import Increment, NormalContact, NormalMotion, SteppedTangentialLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import locked
from contactlab.testing import limits
from contactlab.testing.check import hold
from contactlab.testing.units import Units

Array = NDArray[np.float64]

#: chi of a body so heavy that the machine, not friction, decides how it moves.
HEAVY = 1e-4
#: Friction coefficient, where nothing else is said.
FRICTION = 0.3
#: Of a straight path.
STEPS_TO_KNOT = 40


def scene(
    psi1: Any, chi: Any, *, friction: Any = FRICTION, units: Units | None = None, bodies: Any = 1.0
) -> Scene:
    """Return a scene like a steel ball's, of given psi1 and chi, in some system of units.

    Parameters
    ----------
    psi1, chi, friction : float or array
    units : Units, optional
        In which the numbers are given; SI by default.
    bodies : float or array
        1 for the ball; other numbers give bodies of other radius, moduli, mass and speed.
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


def bodies(*shape: int) -> Any:
    """Return what makes each body of a batch another one."""
    return np.linspace(0.6, 1.6, math.prod(shape)).reshape(shape)


#: What the contacts of a batch may differ in.
QUANTITIES = (
    "friction_coefficient", "normal_speed", "radius", "effective_modulus",
    "effective_shear_modulus", "normal_mass", "tangential_mass",
)  # fmt: skip


def varied(quantity: str, *, count: int = 3) -> Scene:
    """Return a batch of central impacts of heavy bodies that differ in one quantity only."""
    one = scene(0.0, HEAVY)
    factors = np.linspace(0.6, 1.6, count)
    if quantity in ("friction_coefficient", "normal_speed"):
        return attrs.evolve(one, **{quantity: getattr(one, quantity) * factors})
    pair = attrs.evolve(one.pair, **{quantity: getattr(one.pair, quantity) * factors})
    return attrs.evolve(one, pair=pair)


class Path(NamedTuple):
    """Slip and zeta at the ends of the steps, shape (K,) or (K, *batch); it starts at 0, 0."""

    slip: Array
    level: Array


class Answers(NamedTuple):
    """Scaled forces and friction works of the steps, shape (K, *batch), and the last state."""

    force: Array
    work: Array
    state: Any


@attrs.frozen
class Bench:
    """One contact (or a batch) with its scales: P_max, a, C²R, the unit of slip, a duration."""

    scene: Scene
    normal: NormalMotion
    force: Any
    radius: Any
    approach: Any
    slip: Any
    time: Any

    @classmethod
    def of(cls, shape: tuple[int, ...] = (), units: Units | None = None) -> Bench:
        """Return a bench; the contacts of a batch differ in friction and in the bodies."""
        friction, other = (
            (np.linspace(0.1, 0.7, math.prod(shape)).reshape(shape), bodies(*shape))
            if shape
            else (FRICTION, 1.0)
        )
        given = scene(0.0, HEAVY, friction=friction, units=units, bodies=other)
        return cls.along(normal_motion(REGISTRY.create("normal.hertz"), given))

    @classmethod
    def along(cls, normal: NormalMotion) -> Bench:
        """Return the bench of contacts that are at most as large as those of ``normal``."""
        given, radius = normal.scene, normal.maximum_radius
        approach = radius * radius / given.pair.radius
        force = (4.0 / 3.0) * given.pair.effective_modulus * radius * approach
        slip = given.friction_coefficient * approach / given.pair.stiffness_ratio
        return cls(given, normal, force, radius, approach, slip, normal.duration)

    def alone(self, place: int | tuple[int, ...]) -> Bench:
        """Return the bench of one contact of a batch."""
        return Bench.along(self.normal.take(place))

    def start(self, law: SteppedTangentialLaw) -> Any:
        """Return the state of ``law`` at first touch."""
        return law.start(self.scene, self.normal)

    def contact(self, level: Any) -> NormalContact:
        """Return the Hertz contact at zeta = ``level``; out of contact where it is negative."""
        inside = level * (level > 0.0)
        force = locked(self.force * inside**1.5)
        radius, overlap = locked(self.radius * inside**0.5), locked(self.approach * level)
        return NormalContact(force, radius, overlap, force)

    def increment(self, slip: Any, after: NormalContact, duration: Any) -> Increment:
        """Return the step in which the machine moves the body by ``slip`` (scaled)."""
        displacement = locked(self.slip * slip)
        return Increment(
            displacement, locked(displacement / duration), after.friction_load, duration
        )

    @property
    def friction_force(self) -> Any:
        """The unit of tangential force, mu P_max, in N."""
        return self.scene.friction_coefficient * self.force


def drive(law: SteppedTangentialLaw, bench: Bench, path: Path) -> Answers:
    """Take ``law`` along ``path`` from first touch."""
    return continue_from(law, bench, bench.start(law), path)


def continue_from(
    law: SteppedTangentialLaw,
    bench: Bench,
    state: Any,
    path: Path,
    *,
    slip: Any = 0.0,
    level: Any = 0.0,
    count: int | None = None,
) -> Answers:
    """Return the answers of ``law`` along ``path``, from ``state`` on.

    Parameters
    ----------
    law : SteppedTangentialLaw
    bench : Bench
    state : object
        The law's, reached at ``slip`` and ``level``.
    path : Path
    slip, level : float or array
        Where the path begins.
    count : int, optional
        Steps of the whole path, if ``path`` is a part of it.
    """
    duration = locked(bench.time / (count or len(path.slip)))
    before = bench.contact(level)
    forces, works = [], []
    limits.begin(f"a path of {len(path.slip)} steps")
    for now, depth in zip(_rows(path.slip), _rows(path.level), strict=True):
        after = bench.contact(depth)
        limits.DOING.steps += 1
        response, state = law.advance(
            state, bench.increment(now - slip, after, duration), before, after
        )
        hold(np.all(response.settled), "The law found no answer on a straight load path.")
        forces.append(response.force / bench.friction_force)
        works.append(response.friction_work / (bench.friction_force * bench.slip))
        before, slip = after, now
    return Answers(np.array(forces), np.array(works), state)


def _rows(column: Array) -> Any:
    """Floats for one contact, as an integrator gives; arrays for a batch."""
    return column.tolist() if column.ndim == 1 else column


def straight(*knots: tuple[float, float], steps: int = STEPS_TO_KNOT) -> Path:
    """Return the path from 0, 0 through ``knots`` (slip, zeta), ``steps`` to each."""
    points = np.array([(0.0, 0.0), *knots])
    parts = np.linspace(0.0, 1.0, steps + 1)[1:, None]
    legs = [start + parts * (stop - start) for start, stop in itertools.pairwise(points)]
    slip, level = np.concatenate(legs).T
    return Path(slip, level)


def wandering(seed: int, *, knots: int = 12, steps: int = 16, fixed: bool = False) -> Path:
    """Return a path through random knots, in stick, partial and gross slip; the first only presses.

    Parameters
    ----------
    seed : int
    knots : int
    steps : int
        From one knot to the next.
    fixed : bool
        Whether the normal load stays after the first knot.
    """
    draw = np.random.default_rng(seed)
    slips = draw.normal(0.0, 0.8, knots)
    levels = np.full(knots, 0.7) if fixed else draw.uniform(0.05, 1.0, knots)
    slips[0] = 0.0
    return straight(*zip(slips.tolist(), levels.tolist(), strict=True), steps=steps)


#: What a law with a discretisation of its own may be off, over the largest force or energy.
DISCRETE = 0.02


def slack(law: TangentialLaw, exact: float = 1e-9) -> float:
    """Return ``exact`` for a law without a discretisation of its own, else ``DISCRETE``."""
    return exact if law.resolution is None else DISCRETE
