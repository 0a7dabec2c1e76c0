"""The contact of two bodies of any shape: arms, inverse mass and the scene (theory §14)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from contactlab.impact import inverse_mass
from contactlab.impact.bodies import (
    HalfSpace,
    Pair,
    Sphere,
    coupling_compliance,
    normal_compliance,
    shear_compliance,
)
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse

Array = NDArray[np.float64]


class Contact(NamedTuple):
    """Directions and speeds at the contact; vectors are tuples of three components.

    Attributes
    ----------
    normal, along : tuple of three arrays
        Unit vectors from the first body to the target, and along the slip; ``along`` is zero
        without slip.
    approach, slip : array
        Speed of approach, negative where the bodies separate, and speed of slip, in m/s.
    """

    normal: tuple[Any, Any, Any]
    along: tuple[Any, Any, Any]
    approach: Any
    slip: Any


class Frame(NamedTuple):
    """The frame of a contact: n, t1 and t2 as rows, W and the velocity in it.

    Attributes
    ----------
    axes, inverse_mass : array, shape (..., 3, 3)
    velocity : array, shape (..., 3)
        Velocity of the first body over the target at the contact, in m/s.
    """

    axes: Array
    inverse_mass: Array
    velocity: Array


def arms(encounter: Any, normal: Array) -> tuple[Array, Array]:
    """Return the vectors in m from the centres of mass to the contact, zero for a half-space."""
    found = []
    sides = (
        (encounter.body, encounter.contact, 1.0),
        (encounter.target, encounter.target_contact, -1.0),
    )
    for body, given, sense in sides:
        if isinstance(body, RigidBody):
            found.append(given)
        elif isinstance(body, Sphere):
            found.append(sense * np.asarray(body.radius)[..., None] * normal)
        else:
            found.append(np.zeros(3))
    return found[0], found[1]


def turned(body: Any, moment: Array) -> Array:
    """Return J⁻¹ times a moment about the centre of mass, shape (..., 3); 0 for a half-space."""
    if isinstance(body, RigidBody):
        return np.asarray(np.linalg.solve(body.inertia, moment[..., None])[..., 0])
    if isinstance(body, Sphere):
        inertia = body.mass * body.gyration_ratio**2 * body.radius * body.radius
        return np.asarray(moment / np.asarray(inertia)[..., None])
    return np.zeros(3)


def inverse_mass_of(encounter: Any, normal: Array) -> Array:
    """Return W in the frame of the encounter, shape (..., 3, 3), in 1/kg."""
    total: Any = np.zeros((3, 3))
    for body, arm in zip((encounter.body, encounter.target), arms(encounter, normal), strict=True):
        if isinstance(body, HalfSpace):
            continue
        # column j: the velocity at the contact that a unit impulse along j makes
        columns = [
            np.cross(turned(body, np.cross(arm, unit)), arm)[..., None] for unit in np.eye(3)
        ]
        spin = np.concatenate(columns, axis=-1)
        total = total + spin + np.eye(3) / np.asarray(body.mass)[..., None, None]
    return np.asarray(0.5 * (total + np.swapaxes(total, -1, -2)))


def relative_velocity(encounter: Any, normal: Array) -> Array:
    """Return the velocity in m/s of the first body over the target at the contact."""
    first, second = arms(encounter, normal)
    velocity = encounter.velocity + np.cross(encounter.spin, first)
    return np.asarray(
        velocity - encounter.target_velocity - np.cross(encounter.target_spin, second)
    )


def meeting_of_bodies(encounter: Any, normal: tuple[Any, Any, Any]) -> Contact:
    """Return directions and speeds at the contact of bodies that are no spheres."""
    n = np.stack(np.broadcast_arrays(*normal), axis=-1)
    velocity = relative_velocity(encounter, n)
    approach = np.einsum("...i,...i->...", velocity, n)
    slip = velocity - approach[..., None] * n
    size = np.sqrt(np.einsum("...i,...i->...", slip, slip))
    along = slip / (size + (size == 0.0))[..., None]
    x, y, z = (along[..., k] for k in range(3))
    return Contact(normal, (x, y, z), approach, size)


def frame(encounter: Any) -> Frame:
    """Return the frame with t1 along W_nt, or along the slip without coupling."""
    n = np.broadcast_to(encounter.normal, (*encounter.shape, 3))
    n = n / np.sqrt(np.einsum("...i,...i->...", n, n))[..., None]
    W = np.broadcast_to(inverse_mass_of(encounter, n), (*encounter.shape, 3, 3))
    velocity = np.broadcast_to(relative_velocity(encounter, n), n.shape)
    coupling = np.einsum("...ij,...j->...i", W, n)
    pressed = np.einsum("...i,...i->...", coupling, n)
    slip = velocity - np.einsum("...i,...i->...", velocity, n)[..., None] * n
    # the first of coupling, slip and any axis that is not lost in rounding, as ``ways`` judges it
    mean = 0.5 * (np.trace(W, axis1=-2, axis2=-1) - pressed)
    size = np.sqrt(pressed * mean)
    least = np.argmin(np.abs(n), axis=-1)
    axis = np.eye(3)[least]
    candidates = (
        (coupling - pressed[..., None] * n, inverse_mass.ROUNDING * size),
        (slip, inverse_mass.ROUNDING * np.sqrt(np.einsum("...i,...i->...", velocity, velocity))),
        (axis - np.einsum("...i,...i->...", axis, n)[..., None] * n, 0.0),
    )
    t1 = np.zeros_like(n)
    for vector, rounding in reversed(candidates):
        size = np.sqrt(np.einsum("...i,...i->...", vector, vector))
        with np.errstate(all="ignore"):
            t1 = np.where((size > rounding)[..., None], vector / size[..., None], t1)
    axes = np.stack((n, t1, np.cross(n, t1)), axis=-2)
    return Frame(
        axes,
        np.einsum("...ia,...ab,...jb->...ij", axes, W, axes),
        np.einsum("...ia,...a->...i", axes, velocity),
    )


def scene_of_bodies(encounter: Any) -> Scene:
    """Return the scene in numbers; it keeps the inverse mass if any impact needs it."""
    _, W, velocity = frame(encounter)
    speed, slip = velocity[..., 0], velocity[..., 1:]
    ways = np.asarray(inverse_mass.ways(W, speed, slip))
    across = np.abs(slip[..., 1]) > inverse_mass.ROUNDING * (np.abs(speed) + np.abs(slip[..., 0]))
    planar = not (across | (ways == inverse_mass.SPATIAL)).any()
    number: Any = np.asarray if encounter.shape else float
    scene = Scene(
        None,
        None,
        encounter.friction_coefficient,
        number(speed),
        number(slip[..., 0]) if planar else slip,
        pair=pair_of_bodies(encounter, W),
        encounter=encounter,
        inverse_mass=W,
        planar=planar,
    )
    return scene.central if (ways == inverse_mass.CENTRAL).all() else scene


def pair_of_bodies(encounter: Any, inverse: Array) -> Pair:
    """Return the numbers of two bodies that laws need; ``inverse`` is W in the contact's frame."""
    W = inverse
    first, second = encounter.body.material, encounter.target.material
    compliance = normal_compliance(first) + normal_compliance(second)
    curvature: Any = 0.0
    for body in (encounter.body, encounter.target):
        if not isinstance(body, HalfSpace):
            radius = body.radius if isinstance(body, Sphere) else body.curvature_radius
            curvature = curvature + 1.0 / np.asarray(radius)
    if not np.all(curvature > 0.0):
        given = tuple(
            getattr(b, "curvature_radius", math.inf) for b in (encounter.body, encounter.target)
        )
        rule = "one of the bodies must be curved at the contact"
        raise refuse("curvature_radius", given, rule, "a contact of two planes is no Hertz contact")
    number: Any = (lambda v: v) if encounter.shape else float
    return Pair(
        radius=number(1.0 / curvature),
        effective_modulus=1.0 / compliance,
        effective_shear_modulus=1.0 / (shear_compliance(first) + shear_compliance(second)),
        normal_mass=number(1.0 / W[..., 0, 0]),
        tangential_mass=number(2.0 / (W[..., 1, 1] + W[..., 2, 2])),
        dundurs_beta=coupling_compliance(first, second) / compliance,
    )


def pushed(encounter: Any, impulse: Array) -> dict[str, Array]:
    """Return velocities and spins after an impulse in N s on the target, and its opposite.

    ``impulse`` has components along n, t1 and t2 of ``frame``, shape (..., 3).
    """
    axes = frame(encounter).axes
    whole = np.einsum("...ia,...i->...a", axes, impulse)
    moved = {}
    sides = (
        ("", encounter.body, -1.0), ("target_", encounter.target, 1.0),
    )  # fmt: skip
    for (name, body, sense), arm in zip(sides, arms(encounter, axes[..., 0, :]), strict=True):
        push = sense * whole
        velocity = getattr(encounter, f"{name}velocity")
        if not isinstance(body, HalfSpace):
            velocity = velocity + push / np.asarray(body.mass)[..., None]
        spin = getattr(encounter, f"{name}spin") + turned(body, np.cross(arm, push))
        moved[f"{name}velocity"] = np.broadcast_to(velocity, whole.shape)
        moved[f"{name}spin"] = np.broadcast_to(spin, whole.shape)
    return moved
