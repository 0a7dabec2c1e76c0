"""Velocities and spins of spheres after an impact, from arrays of JAX and PyTorch too."""

from __future__ import annotations

from typing import Any, NamedTuple

import numpy as np

from contactlab.collisions.namespaces import find_library, read_numbers
from contactlab.collisions.rebound import rebound, traceable
from contactlab.contracts.restitution import RESTITUTIONS
from contactlab.impact.bodies import HalfSpace, Pair, Sphere
from contactlab.numeric.array_api import Library, Traced
from contactlab.numeric.checks import NON_NEGATIVE, of_kind, refuse
from contactlab.numeric.vectors import LEAST, RANGE

#: psi1 in place of 0, where psi2 over psi1 has a limit and 0/0 has none.
SMALL = 1e-12


class Velocities(NamedTuple):
    """Velocities (m/s) and spins (rad/s) of both bodies, arrays of shape (..., 3)."""

    velocity: Any
    spin: Any
    target_velocity: Any
    target_spin: Any


def velocities(
    body: Sphere,
    target: Sphere | HalfSpace,
    friction: object,
    vectors: dict[str, Any],
    restitution: object,
) -> Velocities:
    """Return ``Collision.of_arrays``."""
    library = traceable((*vectors.values(), friction, restitution))
    if not library:
        shapes = {name: (*np.shape(value),) for name, value in vectors.items()}
        raise refuse("arrays", shapes, "must hold one of JAX or PyTorch", "collide takes NumPy's")
    remedy = f"arrays of {library} are for spheres and half-spaces: collide takes other bodies"
    of_kind("body", body, Sphere, remedy=remedy)
    of_kind("target", target, Sphere, HalfSpace, remedy=remedy)
    _check(library, target, friction, vectors)
    if not callable(restitution):
        read_numbers(library, "restitution", restitution, RESTITUTIONS)
    pair, e = Pair.of(body, target), 1.0 if callable(restitution) else restitution
    masses = pair.normal_mass, pair.tangential_mass
    spheres = [each for each in (body, target) if isinstance(each, Sphere)]
    sizes = [n for each in spheres for n in (each.mass, each.radius, each.gyration_ratio)]
    numbers = [friction, e, *masses, pair.stiffness_ratio, pair.inertia_ratio, *sizes]
    xp, together = find_library(library).xp, find_library(library).arrays
    arrays = together([*vectors.values(), *numbers])
    arrays = _of_one_shape(xp, dict(zip(vectors, arrays, strict=False)), arrays[len(vectors) :])
    n, velocity, spin, target_velocity, target_spin, mu, e, *arrays = arrays
    normal_mass, tangential_mass, kappa, chi, *sizes = arrays

    n = n / _dot(n, n) ** 0.5
    u, rim = velocity - target_velocity, sizes[1] * spin
    if len(spheres) > 1:
        rim = rim + sizes[4] * target_spin
    approach = _dot(u, n)
    slip = u - approach * n + _cross(xp, rim, n)
    meets = ~(approach < LEAST)  # NaN too, which spreads to all answers
    before = xp.where(meets, approach, 1.0)
    if callable(restitution):
        (e,) = together([restitution(before[..., 0]) + 0.0 * before[..., 0]])
        restitution, e = e, e[..., None]
    e, mu = xp.where((e >= 0.0) & (e <= 1.0), e, xp.nan), xp.where(mu >= 0.0, mu, xp.nan)
    change = _change(xp, slip, mu * before / kappa, chi, (pair.inertia_ratio, restitution))
    push = xp.where(meets, -normal_mass * (1.0 + e) * before, 0.0) * n
    drag = xp.where(meets, tangential_mass * change, 0.0)
    turn = _cross(xp, n, drag)
    speeds, turning = [velocity, target_velocity], [spin, target_spin]
    for k, sense in enumerate((1.0, -1.0)[: len(spheres)]):
        mass, radius, gyration = sizes[3 * k : 3 * k + 3]
        speeds[k] = speeds[k] + sense * (push + drag) / mass
        # divided step by step: the moment of inertia of a tiny body underflows
        turning[k] = turning[k] + turn / mass / (gyration * gyration * radius)
    return Velocities(speeds[0], turning[0], speeds[1], turning[1])


def _check(
    library: str, target: Sphere | HalfSpace, friction: object, vectors: dict[str, Any]
) -> None:
    """Refuse bad numbers that are known, and spin of a half-space."""
    read_numbers(library, "friction_coefficient", friction, NON_NEGATIVE)
    for name, value in vectors.items():
        numbers = read_numbers(library, name, value, RANGE)
        if np.shape(value)[-1:] != (3,):
            raise refuse(f"{name}.shape", (*np.shape(value),), "must end with 3")
        if name == "normal" and numbers is not None and not (numbers != 0.0).any(axis=-1).all():
            raise refuse(name, value, "must not be zero", "two bodies at one place have no normal")
        flat = name == "target_spin" and isinstance(target, HalfSpace)
        if flat and (numbers is None or numbers.any()):
            rule = "must be left out: a half-space does not spin"
            raise refuse(name, value, rule, "give target_velocity, that of its surface")


def _change(xp: Any, slip: Any, unit: Any, chi: Any, impact: tuple[Any, Any]) -> Any:
    """Return the change of the slip velocity by ``rebound``; ``unit`` is the velocity of psi 1."""
    square = _dot(slip, slip)
    moves = square > 0.0
    speed = xp.where(moves, square, 1.0) ** 0.5
    # From psi1 = 4 chi + 1 on bodies slip throughout, and the change of psi is constant.
    end = 4.0 * chi + 1.0
    beyond = speed >= end * unit
    inside = moves & ~beyond
    psi1 = xp.where(inside, speed, 1.0) / xp.where(inside, unit, 1.0)
    psi1 = xp.where(moves, xp.where(beyond, end, psi1), SMALL)
    inertia_ratio, e = impact
    psi2 = rebound(psi1[..., 0], inertia_ratio, restitution=e)[..., None]
    # The direction of no slip does not exist; the change over slip has a limit, by which gradients
    # are right there too.
    over = xp.where(moves, speed, SMALL * xp.where(unit > 0.0, unit, 1.0))
    return (psi2 - psi1) * unit / over * slip


def _of_one_shape(xp: Any, vectors: dict[str, Any], numbers: list[Any]) -> list[Any]:
    """Return vectors of one shape (..., 3), and numbers as (..., 1)."""
    shapes = {name: (*vector.shape,) for name, vector in vectors.items()}
    try:
        shape = xp.broadcast_shapes(*shapes.values(), *((*each.shape, 3) for each in numbers))
    except (ValueError, RuntimeError):  # of JAX, of PyTorch
        raise refuse("shapes", shapes, "must fit", "give one of each for each impact") from None
    flat = [xp.broadcast_to(each[..., None], (*shape[:-1], 1)) for each in numbers]
    return [*(xp.broadcast_to(vector, shape) for vector in vectors.values()), *flat]


def _dot(one: Traced, other: Traced) -> Traced:
    """Return products of vectors, shape (..., 1)."""
    each = one * other
    return each[..., 0:1] + each[..., 1:2] + each[..., 2:3]


def _cross(xp: Library, one: Traced, other: Traced) -> Traced:
    """Return vector products, shape (..., 3)."""
    (a, b, c), (d, e, f) = ([each[..., k] for k in range(3)] for each in (one, other))
    return xp.stack([b * f - c * e, c * d - a * f, a * e - b * d], axis=-1)
