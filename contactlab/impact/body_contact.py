"""The contact of two bodies of any shape: arms, inverse mass and the scene (theory §14)."""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import attrs
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
from contactlab.numeric.vectors import cross, solved

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
        return np.asarray(solved(body.inertia, moment[..., None])[..., 0])
    if isinstance(body, Sphere):
        return np.asarray(moment / _moment(body)[..., None])
    return np.zeros(3)


def _moment(sphere: Sphere) -> Any:
    """Return the moment of inertia of a sphere, in kg m²."""
    return np.asarray(sphere.mass * sphere.gyration_ratio**2 * sphere.radius * sphere.radius)


def _crossing(vectors: Array) -> Array:
    """Return the matrices K, shape (..., 3, 3), with K v = vectors x v."""
    x, y, z = (vectors[..., k] for k in range(3))
    matrix = np.zeros((*vectors.shape, 3))
    matrix[..., 0, 1], matrix[..., 0, 2], matrix[..., 1, 2] = -z, y, -x
    return matrix - np.swapaxes(matrix, -1, -2)


def inverse_mass_of(encounter: Any, normal: Array) -> Array:
    """Return W in the frame of the encounter, shape (..., 3, 3), in 1/kg."""
    total: Any = np.zeros((3, 3))
    for body, arm in zip((encounter.body, encounter.target), arms(encounter, normal), strict=True):
        if isinstance(body, HalfSpace):
            continue
        # K v = arm x v: an impulse p turns the body by J⁻¹ K p, and moves the contact by -K of it
        K = _crossing(np.asarray(arm))
        if isinstance(body, Sphere):
            spin = -(K @ K) / _moment(body)[..., None, None]
        else:
            spin = -K @ solved(body.inertia, K)
        total = total + spin + np.eye(3) / np.asarray(body.mass)[..., None, None]
    return np.asarray(0.5 * (total + np.swapaxes(total, -1, -2)))


def relative_velocity(encounter: Any, normal: Array) -> Array:
    """Return the velocity in m/s of the first body over the target at the contact."""
    first, second = arms(encounter, normal)
    velocity = encounter.velocity + cross(encounter.spin, first)
    return np.asarray(velocity - encounter.target_velocity - cross(encounter.target_spin, second))


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
    axes = np.stack((n, t1, cross(n, t1)), axis=-2)
    return Frame(
        axes,
        np.einsum("...ia,...ab,...jb->...ij", axes, W, axes),
        np.einsum("...ia,...a->...i", axes, velocity),
    )


def scene_of_bodies(encounter: Any) -> Scene:
    """Return the scene in numbers; it keeps the inverse mass if any impact needs it."""
    axes, W, velocity = frame(encounter)
    speed, slip = velocity[..., 0], velocity[..., 1:]
    ways = np.asarray(inverse_mass.ways(W, speed, slip))
    across = np.abs(slip[..., 1]) > inverse_mass.ROUNDING * (np.abs(speed) + np.abs(slip[..., 0]))
    planar = not (across | (ways == inverse_mass.SPATIAL)).any()
    number: Any = np.asarray if encounter.shape else float
    along = number(slip[..., 0]) if planar else slip
    entries: dict[str, Any] = {"inverse_mass": W, "planar": planar}
    pair = pair_of_bodies(encounter, W)
    if (ways == inverse_mass.CENTRAL).all():
        mass = inverse_mass.mass_along(W, inverse_mass.along(slip))
        pair = attrs.evolve(pair, tangential_mass=number(mass))
        along, entries = number(np.hypot(slip[..., 0], slip[..., 1])), {}
    friction = encounter.friction_coefficient
    where = {"encounter": encounter, "frame": axes}
    return Scene(None, None, friction, number(speed), along, pair=pair, **where, **entries)


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


def in_space(axes: Array, vectors: Array) -> Array:
    """Return vectors along n, t1 and t2, the rows of ``axes``, in the frame of the encounter."""
    return np.asarray(np.einsum("...ia,...i->...a", axes, vectors))


def pushed(encounter: Any, axes: Array, impulse: Array) -> dict[str, Array]:
    """Return velocities and spins after an impulse in N s on the target, and its opposite.

    ``impulse`` has components along n, t1 and t2, the rows of ``axes``, shape (..., 3).
    """
    whole = in_space(axes, impulse)
    moved = {}
    sides = (
        ("", encounter.body, -1.0), ("target_", encounter.target, 1.0),
    )  # fmt: skip
    for (name, body, sense), arm in zip(sides, arms(encounter, axes[..., 0, :]), strict=True):
        push = sense * whole
        velocity = getattr(encounter, f"{name}velocity")
        if not isinstance(body, HalfSpace):
            velocity = velocity + push / np.asarray(body.mass)[..., None]
        spin = getattr(encounter, f"{name}spin") + turned(body, cross(np.asarray(arm), push))
        moved[f"{name}velocity"] = np.broadcast_to(velocity, whole.shape)
        moved[f"{name}spin"] = np.broadcast_to(spin, whole.shape)
    return moved
