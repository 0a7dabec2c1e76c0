"""The contact of two bodies of any shape: arms, inverse mass, gap and scene (theory §14, §16)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import attrs
import numpy as np

from contactlab.impact import inverse_mass
from contactlab.impact.bodies import (
    HalfSpace,
    Pair,
    Sphere,
    coupling_compliance,
    inverse_turning_mass,
    normal_compliance,
    shear_compliance,
)
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import chosen, some
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import Array, Mask, Real
from contactlab.numeric.vectors import components, cross, moving, solved

#: Difference of principal curvatures over their sum that is a circle's rounding.
ROUND = 1e-9
#: Ratio of the curvatures of a gap up to which bodies touch along a line.
LINE = 1e-12
#: Spin about the normal over the whole spin of both bodies below which it is rounding.
TURNING = 1e-12


class _Meeting(Protocol):
    """An encounter, which imports this module: two bodies and their vectors."""

    @property
    def body(self) -> Sphere | RigidBody: ...
    @property
    def target(self) -> Sphere | HalfSpace | RigidBody: ...
    @property
    def friction_coefficient(self) -> Real: ...
    @property
    def shape(self) -> tuple[int, ...]: ...
    @property
    def normal(self) -> Array: ...
    @property
    def velocity(self) -> Array: ...
    @property
    def spin(self) -> Array: ...
    @property
    def target_velocity(self) -> Array: ...
    @property
    def target_spin(self) -> Array: ...
    @property
    def contact(self) -> Array: ...
    @property
    def target_contact(self) -> Array: ...


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


class Gap(NamedTuple):
    """Curvatures of the gap between two bodies, h = (least x² + most y²)/2.

    Attributes
    ----------
    least, most : array
        Principal curvatures in 1/m; the mean where the contact is a circle.
    major : array of complex
        Direction of the least curvature, which is that of the major axis, along t1 + i t2.
    elliptic, minor : array of bool
        True where the contact is no circle, and where t1 is its minor axis.
    """

    least: Any
    most: Any
    major: Any
    elliptic: Any
    minor: Any = False


class Frame(NamedTuple):
    """The frame of a contact: n, t1 and t2 as rows, W and the velocity in it.

    Attributes
    ----------
    axes, inverse_mass : array, shape (..., 3, 3)
    velocity : array, shape (..., 3)
        Velocity of the first body over the target at the contact, in m/s.
    gap : Gap
    """

    axes: Array
    inverse_mass: Array
    velocity: Array
    gap: Gap


def arms(encounter: _Meeting, normal: Array) -> tuple[Array, Array]:
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


def turned(body: Sphere | HalfSpace | RigidBody, moment: Array) -> Array:
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


def inverse_mass_of(encounter: _Meeting, normal: Array) -> Array:
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


def relative_velocity(encounter: _Meeting, normal: Array) -> Array:
    """Return the velocity in m/s of the first body over the target at the contact."""
    first, second = arms(encounter, normal)
    velocity = encounter.velocity + cross(encounter.spin, first)
    return np.asarray(velocity - encounter.target_velocity - cross(encounter.target_spin, second))


def spin_about(encounter: _Meeting, normal: Sequence[Real]) -> Any:
    """Return the spin about the normal of the first body over the target, in rad/s."""
    if encounter.shape and not (moving(encounter.spin) or moving(encounter.target_spin)):
        return 0.0  # of one encounter three products take less
    spins = [components(spin) for spin in (encounter.spin, encounter.target_spin)]
    omega: Any = 0.0
    for n, one, other in zip(normal, *spins, strict=True):
        omega = omega + (one - other) * n
    if not some(omega != 0.0):
        return 0.0
    whole = sum(abs(one) for spin in spins for one in spin)
    omega = chosen(abs(omega) > TURNING * whole, omega, 0.0)
    return np.broadcast_to(omega, encounter.shape) if encounter.shape else omega


def _spin_alone(encounter: _Meeting, n: Array, round_: Mask) -> Any:
    """Return the spin about the normal that a couple alone moves; ``round_`` where it may.

    It is 0 where a body is off centre, or the normal is no principal axis of its inertia.
    """
    spin: Any = np.where(round_, spin_about(encounter, components(n)), 0.0)
    for body, arm in zip((encounter.body, encounter.target), arms(encounter, n), strict=True):
        if isinstance(body, RigidBody) and np.any(spin):
            for vector in (arm, turned(body, n)):
                size = np.sqrt(np.einsum("...i,...i->...", vector, vector))
                aside = np.abs(cross(np.asarray(vector), n)).max(axis=-1)
                spin = np.where(aside <= inverse_mass.ROUNDING * size, spin, 0.0)
    if not np.any(spin):
        return 0.0
    return spin if encounter.shape else float(spin)


def turning_compliance(encounter: _Meeting, normal: Array, radius: Real) -> Any:
    """Return radius² n·J⁻¹·n of both bodies, in 1/kg."""
    total: Any = 0.0
    for body in (encounter.body, encounter.target):
        if isinstance(body, Sphere):
            total = total + inverse_turning_mass(body, radius)
        elif isinstance(body, RigidBody):
            along = np.einsum("...i,...i->...", normal, turned(body, normal))
            total = total + radius * radius * along
    return total


def meeting_of_bodies(encounter: _Meeting, normal: tuple[Real, Real, Real]) -> Contact:
    """Return directions and speeds at the contact of bodies that are no spheres."""
    n = np.stack(np.broadcast_arrays(*normal), axis=-1)
    velocity = relative_velocity(encounter, n)
    approach = np.einsum("...i,...i->...", velocity, n)
    slip = velocity - approach[..., None] * n
    size = np.sqrt(np.einsum("...i,...i->...", slip, slip))
    along = slip / (size + (size == 0.0))[..., None]
    x, y, z = (along[..., k] for k in range(3))
    return Contact(normal, (x, y, z), approach, size)


def frame(encounter: _Meeting) -> Frame:
    """Return the frame with t1 along W_nt, or along the slip without coupling.

    For an ellipse t1 is the axis that holds both, or else the major one.
    """
    n = np.broadcast_to(encounter.normal, (*encounter.shape, 3))
    n = n / np.sqrt(np.einsum("...i,...i->...", n, n))[..., None]
    W = np.broadcast_to(inverse_mass_of(encounter, n), (*encounter.shape, 3, 3))
    velocity = np.broadcast_to(relative_velocity(encounter, n), n.shape)
    coupling = np.einsum("...ij,...j->...i", W, n)
    pressed = np.einsum("...i,...i->...", coupling, n)
    coupling = coupling - pressed[..., None] * n
    slip = velocity - np.einsum("...i,...i->...", velocity, n)[..., None] * n
    # the first of coupling, slip and any axis that is not lost in rounding, as ``ways`` judges it
    mean = 0.5 * (np.trace(W, axis1=-2, axis2=-1) - pressed)
    axis = np.eye(3)[np.argmin(np.abs(n), axis=-1)]
    rounding = (
        inverse_mass.ROUNDING * np.sqrt(pressed * mean),
        inverse_mass.ROUNDING * np.sqrt(np.einsum("...i,...i->...", velocity, velocity)),
    )
    any_axis = axis - np.einsum("...i,...i->...", axis, n)[..., None] * n
    candidates = ((coupling, rounding[0]), (slip, rounding[1]), (any_axis, 0.0))
    t1 = np.zeros_like(n)
    for vector, least in reversed(candidates):
        size = np.sqrt(np.einsum("...i,...i->...", vector, vector))
        with np.errstate(all="ignore"):
            t1 = np.where((size > least)[..., None], vector / size[..., None], t1)
    t2 = cross(n, t1)
    gap = gap_of(encounter, t1, t2)
    if np.any(gap.elliptic):
        holds = candidates[:2]
        t1, gap = _along_an_axis(gap, t1, t2, holds)
        t2 = cross(n, t1)
    axes = np.stack((n, t1, t2), axis=-2)
    return Frame(
        axes,
        np.einsum("...ia,...ab,...jb->...ij", axes, W, axes),
        np.einsum("...ia,...a->...i", axes, velocity),
        gap,
    )


def gap_of(encounter: _Meeting, t1: Array, t2: Array) -> Gap:
    """Return the curvatures of the gap between the bodies, the sum of both (theory §16).

    Raises
    ------
    ValueError
        If the bodies do not curve apart in every direction: they touch along a line or a face.
    """
    bodies = encounter.body, encounter.target
    (one, other, axis), (two, another, across) = (_curvatures(body, t1, t2) for body in bodies)
    mean = 0.5 * ((one + other) + (two + another))
    elliptic: Any = False
    if any(getattr(body, "cross_radius", None) is not None for body in bodies):
        uneven: Any = 0.5 * ((one - other) * axis * axis + (two - another) * across * across)
        size = np.abs(uneven)
        elliptic = size > ROUND * np.abs(mean)
    if not np.any(elliptic):
        if not np.all(mean > 0.0):
            rule = "one of the bodies must be curved, and both curve apart"
            _refuse_gap(encounter, rule, "two planes")
        return Gap(mean, mean, np.asarray(1.0 + 0.0j), elliptic)
    # the determinant of the sum, of which no term is negative between convex bodies
    turned = axis * np.conj(across)
    sine, cosine = np.square(turned.imag), np.square(turned.real)
    product = one * other + two * another
    product = product + (one * two + other * another) * sine
    product = product + (one * another + other * two) * cosine
    most = np.where(elliptic, mean + size, mean)
    with np.errstate(all="ignore"):
        least = np.where(elliptic, product / most, mean)
    if not np.all((most > 0.0) & (least > LINE * most)):
        _refuse_gap(encounter, "the bodies must curve apart in every direction", "a line")
    with np.errstate(all="ignore"):
        major = np.where(elliptic, np.sqrt(-uneven / size), 1.0)
    return Gap(least, most, major, elliptic)


def _curvatures(body: Sphere | HalfSpace | RigidBody, t1: Array, t2: Array) -> tuple[Any, Any, Any]:
    """Return both principal curvatures of a body in 1/m, and the direction of the first."""
    if isinstance(body, RigidBody):
        return body.curvatures(t1, t2)
    curvature: Any = 0.0 if isinstance(body, HalfSpace) else 1.0 / np.asarray(body.radius)
    return np.asarray(curvature), np.asarray(curvature), np.asarray(1.0 + 0.0j)


def _refuse_gap(encounter: _Meeting, rule: str, what: str) -> None:
    """Refuse bodies that touch along a line or a face."""
    given = tuple(
        getattr(body, "curvature_radius", getattr(body, "radius", math.inf))
        for body in (encounter.body, encounter.target)
    )
    hollow = any(
        np.any(np.less(radius, 0.0))
        for body in (encounter.body, encounter.target)
        if isinstance(body, RigidBody)
        for radius in (body.curvature_radius, body.crossing)
    )
    remedy = f"a contact of {what} is no Hertz contact; round the face or edge: crown_radius="
    if hollow:
        remedy = "a hollow must be less curved than what it touches; take a flatter one"
    raise refuse("curvature_radius", given, rule, remedy)


def _along_an_axis(
    gap: Gap, t1: Array, t2: Array, holds: Sequence[tuple[Array, Real]]
) -> tuple[Array, Gap]:
    """Return t1 along the axis of the ellipse that holds coupling and slip, and the gap there."""
    parts = []
    for vector, rounding in holds:
        seen = np.einsum("...i,...i->...", vector, t1) + 1j * np.einsum(
            "...i,...i->...", vector, t2
        )
        parts.append((seen * np.conj(gap.major), rounding))
    along = np.any([abs(part.real) > rounding for part, rounding in parts], axis=0)
    aside = np.any([abs(part.imag) > rounding for part, rounding in parts], axis=0)
    minor = gap.elliptic & aside & ~along
    first = np.where(minor, 1j * gap.major, gap.major)
    # t1 points along the coupling, or along the slip
    sense = [(part * np.where(minor, -1j, 1.0)).real for part, _ in parts]
    pressed = np.abs(sense[0]) > parts[0][1]
    back = np.where(pressed, sense[0], sense[1]) < 0.0
    first = np.where(gap.elliptic, np.where(back, -first, first), 1.0)[..., None]
    return first.real * t1 + first.imag * t2, gap._replace(minor=minor)


def scene_of_bodies(encounter: _Meeting) -> Scene:
    """Return the scene in numbers; it keeps the inverse mass if any impact needs it."""
    axes, W, velocity, gap = frame(encounter)
    pair = pair_of_bodies(encounter, W, gap)
    speed, slip = velocity[..., 0], velocity[..., 1:]
    ways = np.asarray(inverse_mass.ways(W, speed, slip, pair.cross_stiffness_ratio))
    across = np.abs(slip[..., 1]) > inverse_mass.ROUNDING * (np.abs(speed) + np.abs(slip[..., 0]))
    planar = not (across | (ways == inverse_mass.SPATIAL)).any()
    number: Any = np.asarray if encounter.shape else float
    along = number(slip[..., 0]) if planar else slip
    entries: dict[str, Any] = {"inverse_mass": W, "planar": planar}
    if (ways == inverse_mass.CENTRAL).all():
        mass = inverse_mass.mass_along(W, inverse_mass.along(slip))
        pair = attrs.evolve(pair, tangential_mass=number(mass))
        along, entries = number(np.hypot(slip[..., 0], slip[..., 1])), {}
    friction = encounter.friction_coefficient
    where: dict[str, Any] = {"encounter": encounter, "frame": axes}
    n, round_ = axes[..., 0, :], (ways == inverse_mass.CENTRAL) & np.logical_not(gap.elliptic)
    where["normal_spin"] = spin = _spin_alone(encounter, n, round_)
    if np.any(spin):
        inverse = number(turning_compliance(encounter, n, pair.radius))
        pair = attrs.evolve(pair, inverse_spin_mass=inverse)
    return Scene(None, None, friction, number(speed), along, pair=pair, **where, **entries)


def pair_of_bodies(encounter: _Meeting, inverse: Array, gap: Gap) -> Pair:
    """Return the numbers of two bodies that laws need; ``inverse`` is W in the contact's frame."""
    W = inverse
    first, second = encounter.body.material, encounter.target.material
    compliance = normal_compliance(first) + normal_compliance(second)
    number: Any = (lambda v: v) if encounter.shape else float
    shear = 1.0 / (shear_compliance(first) + shear_compliance(second))
    pair = Pair(
        radius=number(1.0 / gap.most),
        effective_modulus=1.0 / compliance,
        effective_shear_modulus=shear,
        normal_mass=number(1.0 / W[..., 0, 0]),
        tangential_mass=number(2.0 / (W[..., 1, 1] + W[..., 2, 2])),
        dundurs_beta=coupling_compliance(first, second) / compliance,
    )
    if not np.any(gap.elliptic):
        return pair
    from contactlab.impact.elliptic import ellipse  # scipy, which few scenes need

    shape = ellipse(np.where(gap.elliptic, gap.least / gap.most, 1.0))
    weights = np.where(gap.minor, (shape.weight_minor, shape.weight_major), shape[4:])
    along, across = (
        (1.0 - first.poisson_ratio * weight) / (2.0 * first.shear_modulus)
        + (1.0 - second.poisson_ratio * weight) / (2.0 * second.shear_modulus)
        for weight in weights
    )
    ratio = shape.axis_ratio
    round_, one = ~gap.elliptic, np.ones(np.shape(along))
    return attrs.evolve(
        pair,
        radius=number(np.where(round_, pair.radius, 2.0 * shape.radius / (gap.least + gap.most))),
        effective_shear_modulus=number(np.where(round_, shear, 1.0 / along)),
        cross_stiffness_ratio=number(np.where(round_, one, along / across)),
        axis_ratio=number(np.where(round_, one, np.where(gap.minor, 1.0 / ratio, ratio))),
    )


def in_space(axes: Array, vectors: Array) -> Array:
    """Return vectors along n, t1 and t2, the rows of ``axes``, in the frame of the encounter."""
    return np.asarray(np.einsum("...ia,...i->...a", axes, vectors))


def seen(scene: Scene, velocity: Array) -> tuple[Any, Any]:
    """Return the components along the normal and ``scene.along`` of a velocity of the first body.

    They are relative to the surface that it strikes, in m/s, numbers for one impact.
    """
    encounter, axes, t = scene.encounter, scene.frame, np.asarray(scene.along)
    assert axes is not None
    n = axes[..., 0, :]
    _, arm = arms(encounter, n)
    struck = encounter.target_velocity + cross(encounter.target_spin, np.asarray(arm))
    off = np.broadcast_to(velocity - struck, n.shape)
    normal, along = np.einsum("...i,...i->...", off, n), off @ t
    return (normal, along) if scene.shape else (float(normal), float(along))


def pushed(
    encounter: _Meeting, axes: Array, impulse: Array, couple: Real = 0.0
) -> dict[str, Array]:
    """Return velocities and spins after an impulse in N s on the target, and its opposite.

    ``impulse`` has components along n, t1 and t2, the rows of ``axes``, shape (..., 3). ``couple``
    is the angular impulse on the target about the normal, in N m s, of the batch shape.
    """
    about = np.asarray(couple)[..., None] * axes[..., 0, :]
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
        moment = cross(np.asarray(arm), push) + sense * about
        spin = getattr(encounter, f"{name}spin") + turned(body, moment)
        moved[f"{name}velocity"] = np.broadcast_to(velocity, whole.shape)
        moved[f"{name}spin"] = np.broadcast_to(spin, whole.shape)
    return moved
