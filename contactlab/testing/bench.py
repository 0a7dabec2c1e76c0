"""A contact that is loaded at will, as on a testing machine, and the scaled answers of a law.

Slip is in units of mu C²R/kappa and normal load in terms of zeta, so that gross slip
begins at slip = zeta and the forces, in units of mu P_max, are those of theory §§1 and 4.
"""

from __future__ import annotations

import itertools
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.bodies import Pair
from contactlab.contracts import Increment, NormalContact, Problem, SteppedTangentialLaw
from contactlab.contracts.tangential import TangentialLaw
from contactlab.registry import REGISTRY
from contactlab.scene import Scene
from contactlab.testing.check import hold
from contactlab.testing.units import Units

Array = NDArray[np.float64]

#: A body so heavy that the machine, not friction, decides how it moves.
HEAVY = 1e-4


def scene(psi1: Any, chi: Any, *, friction: Any = 0.3, units: Units | None = None) -> Scene:
    """Return a scene like a steel ball's, of given psi1 and chi, in some system of units."""
    length, time, mass = units or Units()
    pressure = mass / (length * time**2)
    pair = Pair(
        radius=0.0127 * length,
        effective_modulus=1.12e11 * pressure,
        effective_shear_modulus=0.823529 * 1.12e11 * pressure,
        normal_mass=0.067 * mass,
        tangential_mass=0.5 * 0.823529 * 0.067 * mass / chi,
    )
    speed = 0.83 * length / time
    return Scene(None, None, friction, speed, psi1 * friction * speed / 0.823529, pair=pair)


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

    problem: Problem
    force: Any
    radius: Any
    approach: Any
    slip: Any
    time: Any

    @classmethod
    def of(
        cls, law: TangentialLaw, shape: tuple[int, ...] = (), units: Units | None = None
    ) -> Bench:
        """Return a bench; the contacts of a batch differ in friction."""
        friction: Any = 0.3
        if shape:
            friction = np.linspace(0.1, 0.7, int(np.prod(shape))).reshape(shape)
        given = scene(0.0, HEAVY, friction=friction, units=units)
        return cls.with_problem(
            Problem(
                normal=REGISTRY.create("normal.hertz"),
                tangential=law,
                pair=given.pair,
                friction_coefficient=given.friction_coefficient,
                normal_speed=given.normal_speed,
                slip_velocity=given.slip_velocity,
                maximum_radius=given.maximum_radius,
                duration=given.duration,
                shape=shape,
            )
        )

    @classmethod
    def with_problem(cls, problem: Problem) -> Bench:
        """Return the bench on which ``problem`` would take place."""
        pair, radius = problem.pair, problem.maximum_radius
        approach = radius * radius / pair.radius
        force = (4.0 / 3.0) * pair.effective_modulus * radius * approach
        slip = problem.friction_coefficient * approach / pair.stiffness_ratio
        return cls(problem, force, radius, approach, slip, problem.duration)

    def contact(self, level: Any) -> NormalContact:
        """Return the Hertz contact at zeta = ``level``; out of contact where it is negative."""
        inside = level * (level > 0.0)
        overlap = self.approach * level
        return NormalContact(self.force * inside**1.5, self.radius * inside**0.5, overlap)

    def increment(self, slip: Any, after: NormalContact, duration: Any) -> Increment:
        """Return the step in which the machine moves the body by ``slip`` (scaled)."""
        displacement = self.slip * slip
        velocity = displacement / duration
        arresting = self.problem.pair.tangential_mass * velocity / duration
        return Increment(displacement, velocity, arresting, after.force, duration)

    @property
    def friction_force(self) -> Any:
        """The unit of tangential force, mu P_max, in N."""
        return self.problem.friction_coefficient * self.force


def drive(law: SteppedTangentialLaw, bench: Bench, path: Path) -> Answers:
    """Take ``law`` along ``path`` from first touch."""
    return continue_from(law, bench, law.start(bench.problem), path)


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
    """Take ``law`` on from ``state``, reached at ``slip`` and ``level``.

    ``count`` is the number of steps of the whole path, if ``path`` is a part of it.
    """
    duration = bench.time / (count or len(path.slip))
    before = bench.contact(level)
    forces, works = [], []
    for now, depth in zip(_rows(path.slip), _rows(path.level), strict=True):
        after = bench.contact(depth)
        response, state = law.advance(
            state, bench.increment(now - slip, after, duration), before, after
        )
        hold(np.all(response.settled), "The law found no answer on a plain load path.")
        forces.append(response.force / bench.friction_force)
        works.append(response.friction_work / (bench.friction_force * bench.slip))
        before, slip = after, now
    return Answers(np.array(forces), np.array(works), state)


def _rows(column: Array) -> Any:
    """Floats for one contact, as an integrator gives; arrays for a batch."""
    return column.tolist() if column.ndim == 1 else column


def straight(*knots: tuple[float, float], steps: int = 40) -> Path:
    """Return the path from 0, 0 through ``knots`` (slip, zeta), ``steps`` to each."""
    points = np.array([(0.0, 0.0), *knots])
    parts = np.linspace(0.0, 1.0, steps + 1)[1:, None]
    legs = [start + parts * (stop - start) for start, stop in itertools.pairwise(points)]
    slip, level = np.concatenate(legs).T
    return Path(slip, level)


def wandering(seed: int, *, knots: int = 12, steps: int = 16, fixed: bool = False) -> Path:
    """Return a path through random knots, in stick, partial and gross slip.

    The first knot only presses; with ``fixed`` the normal load then stays.
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
