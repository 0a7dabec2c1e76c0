"""Contacts between spheres, by their positions, and the gaps of their surfaces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Protocol

import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.numeric.checks import of_kind, real, refuse
from contactlab.numeric.types import Array, Numbers, Real

#: Overlap over the radius that is rounding: surfaces then touch.
ROUNDING = 1e-9


class _Placed(Protocol):
    """A body of a gathering, whose module imports this one."""

    @property
    def shape(self) -> object: ...
    @property
    def position(self) -> Array | None: ...


def touches_of_spheres(
    bodies: Mapping[str, _Placed] | Sequence[_Placed],
    walls: Sequence[tuple[HalfSpace, Numbers, Numbers]],
    reach: Real,
) -> Iterator[tuple[Any, Any, Array, Real]]:
    """Yield first, second, normal and gap in m of spheres and walls that are in reach."""
    pairs = bodies.items() if isinstance(bodies, Mapping) else enumerate(bodies)
    named: list[tuple[Any, Any]] = [*pairs]
    for name, body in named:
        if not isinstance(body.shape, Sphere):
            raise refuse(f"bodies[{name!r}]", body.shape, "must be a Sphere", "write its touches")
        if body.position is None:
            rule = "is needed to find what touches"
            raise refuse(f"bodies[{name!r}].position", None, rule, "give position=[x, y, z] in m")
    for k, (name, body) in enumerate(named):
        for other, two in named[k + 1 :]:
            apart = two.position - body.position
            distance = np.linalg.norm(apart, axis=-1)
            reached = body.shape.radius + two.shape.radius
            pair = f"bodies[{name!r}], bodies[{other!r}]"
            gap = _gap(pair, distance - reached, reached)
            if np.any(gap <= reach):
                yield name, other, apart, gap
    for k, (wall, point, normal) in enumerate(walls):
        of_kind(f"walls[{k}]", wall, HalfSpace, remedy="give (HalfSpace(...), point, normal)")
        into = np.asarray(real(f"walls[{k}] normal", normal))
        into = into / np.linalg.norm(into, axis=-1)[..., None]
        place = np.asarray(real(f"walls[{k}] point", point))
        for name, body in named:
            distance = ((place - body.position) * into).sum(axis=-1)
            pair = f"bodies[{name!r}], walls[{k}]"
            gap = _gap(pair, distance - body.shape.radius, body.shape.radius)
            if np.any(gap <= reach):
                yield name, wall, into, gap


def _gap(pair: str, gap: Real, size: Real) -> Real:
    """Return gaps in m, 0 for overlaps that are rounding; refuse others."""
    least = np.min(gap / size)
    if not least > -ROUNDING:
        rule = f"overlap by {-least:.3g} of their radii: bodies touch where an impact begins"
        raise refuse(f"position of {pair}", float(np.min(gap)), rule, "move them apart")
    closed = np.maximum(gap, 0.0)
    return closed if np.ndim(closed) else float(closed)
