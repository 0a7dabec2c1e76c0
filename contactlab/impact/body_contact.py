"""The contact of two bodies of any shape: arms, inverse mass, gap and scene (theory §14, §16)."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple, Protocol

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
from contactlab.impact.of_speed import OfSlip
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene, of_bodies
from contactlab.numeric.arrays import choose, every, lock_arrays, magnitude, some
from contactlab.numeric.checks import refuse
from contactlab.numeric.types import AnyArray, Array, Complex, Mask, Real, Rows, Vector
from contactlab.numeric.vectors import (
    LEAST,
    components,
    cross,
    difference,
    dot,
    hypotenuse,
    join_components,
    moving,
    over,
    rows,
    solve_factored,
    square_root,
)

#: Velocities and spins of both bodies.
VELOCITIES = ("velocity", "spin", "target_velocity", "target_spin")
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
    def of_slip(self) -> OfSlip | None: ...
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
    def separate(self) -> ValueError: ...


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

    normal: Vector
    along: Vector
    approach: Real
    slip: Real


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

    least: Real
    most: Real
    major: Complex
    elliptic: Mask
    minor: Mask = False


class Frame(NamedTuple):
    """The frame of a contact, W and the velocity in it.

    Attributes
    ----------
    axes : three vectors
        n, t1 and t2, by their components.
    inverse_mass : three rows
        W in 1/kg along these axes.
    velocity : vector
        Velocity of the first body over the target at the contact, along these axes, in m/s.
    gap : Gap
    """

    axes: tuple[Vector, Vector, Vector]
    inverse_mass: Rows
    velocity: Vector
    gap: Gap


class Side(NamedTuple):
    """A body of an encounter that moves, and how the contact acts on it.

    Attributes
    ----------
    name : str
        What the names of its vectors begin with.
    body : Sphere or RigidBody
    arm : vector
        From the centre of mass to the contact, in m.
    sense : float
        1 of the first body, -1 of the target.
    """

    name: str
    body: Sphere | RigidBody
    arm: Vector
    sense: float


def sides(encounter: _Meeting, normal: Vector) -> list[Side]:
    """Return the bodies that move; a half-space does not."""
    found = []
    for name, body, contact, sense in (
        ("", encounter.body, encounter.contact, 1.0),
        ("target_", encounter.target, encounter.target_contact, -1.0),
    ):
        if isinstance(body, RigidBody):
            found.append(Side(name, body, components(contact), sense))
        elif isinstance(body, Sphere):
            reach = sense * body.radius
            found.append(Side(name, body, tuple(reach * each for each in normal), sense))
    return found


def turn_body(body: Sphere | RigidBody, *moments: Vector) -> list[Vector]:
    """Return J⁻¹ times moments about the centre of mass."""
    if isinstance(body, RigidBody):
        return solve_factored(body._factors, *moments)
    inertia = body.mass * body.gyration_ratio**2 * body.radius * body.radius
    return [tuple(each / inertia for each in moment) for moment in moments]


def inverse_mass_of(bodies: Sequence[Side], axes: Sequence[Vector]) -> Rows:
    """Return the rows of W in 1/kg along three unit vectors at right angles."""
    a: Real = 0.0
    b, c, d, e, f = a, a, a, a, a
    for _, body, arm, _ in bodies:
        # an impulse p turns the body by J⁻¹ (arm x p), and moves the contact by that x its arm
        first, second, third = moments = [cross(arm, axis) for axis in axes]
        x, y, z = turn_body(body, *moments)
        lightness = 1.0 / body.mass
        a = a + lightness + dot(first, x)
        b, c = b + dot(second, x), c + lightness + dot(second, y)
        d, e, f = d + dot(third, x), e + dot(third, y), f + lightness + dot(third, z)
    return (a, b, d), (b, c, e), (d, e, f)


def add_coupling(
    inverse: list[list[Real]],
    one: tuple[Side, Sequence[Vector]],
    other: tuple[Side, Sequence[Vector]],
) -> None:
    """Add to rows of W in 1/kg the motion of one contact of a body by forces at another.

    A contact is its body and its axes.
    """
    (here, axes), (there, across) = one, other
    mass, sense = here.body.mass, here.sense * there.sense
    moments = [cross(here.arm, axis) for axis in axes]
    turns = turn_body(here.body, *[cross(there.arm, axis) for axis in across])
    for row, axis, moment in zip(inverse, axes, moments, strict=True):
        for j, turn in enumerate(turns):
            row[j] = row[j] + sense * (dot(axis, across[j]) / mass + dot(moment, turn))


def relative_velocity(encounter: _Meeting, bodies: Sequence[Side]) -> Vector:
    """Return the velocity in m/s of the first body over the target at the contact."""
    velocity: Vector = difference(encounter.velocity, encounter.target_velocity)
    for name, _, arm, sense in bodies:
        spin = encounter.target_spin if name else encounter.spin
        if moving(spin):
            rim = cross(components(spin), arm)
            velocity = [v + sense * each for v, each in zip(velocity, rim, strict=True)]
    return velocity


def spin_about(encounter: _Meeting, normal: Sequence[Real]) -> Real:
    """Return the spin about the normal of the first body over the target, in rad/s."""
    if encounter.shape and not (moving(encounter.spin) or moving(encounter.target_spin)):
        return 0.0  # for one encounter a product is quicker
    spins = [components(spin) for spin in (encounter.spin, encounter.target_spin)]
    omega: Real = 0.0
    for n, one, other in zip(normal, *spins, strict=True):
        omega = omega + (one - other) * n
    if not some(omega != 0.0):
        return 0.0
    whole = sum(magnitude(one) for spin in spins for one in spin)
    omega = choose(magnitude(omega) > TURNING * whole, omega, 0.0)
    return np.broadcast_to(omega, encounter.shape) if encounter.shape else omega


def _spin_alone(encounter: _Meeting, bodies: Sequence[Side], n: Vector, round_: Mask) -> Real:
    """Return the spin about the normal that a couple alone changes; ``round_`` where it can.

    The spin counts as 0 where a body is off centre, or the normal no principal axis of its inertia.
    """
    if not some(round_):
        return 0.0
    spin = choose(round_, spin_about(encounter, n), 0.0)
    for _, body, arm, _ in bodies:
        if isinstance(body, RigidBody) and some(spin != 0.0):
            for vector in (arm, *turn_body(body, n)):
                least = inverse_mass.ROUNDING * square_root(dot(vector, vector))
                x, y, z = (magnitude(each) > least for each in cross(vector, n))
                spin = choose(x | y | z, 0.0, spin)
    return spin if some(spin != 0.0) else 0.0


def turning_compliance(bodies: Sequence[Side], normal: Vector, radius: Real) -> Real:
    """Return radius² n·J⁻¹·n of both bodies, in 1/kg."""
    total: Real = 0.0
    for _, body, _, _ in bodies:
        if isinstance(body, Sphere):
            total = total + inverse_turning_mass(body, radius)
        else:
            total = total + radius * radius * dot(normal, *turn_body(body, normal))
    return total


def meeting_of_bodies(encounter: _Meeting, normal: Vector) -> Contact:
    """Return directions and speeds at the contact of bodies that are no spheres."""
    velocity = relative_velocity(encounter, sides(encounter, normal))
    approach = dot(velocity, normal)
    slip = [v - approach * n for v, n in zip(velocity, normal, strict=True)]
    size = square_root(dot(slip, slip))
    x, y, z = (each / (size + (size == 0.0)) for each in slip)
    return Contact(normal, (x, y, z), approach, size)


def _tangents(normal: Vector) -> tuple[Vector, Vector]:
    """Return unit vectors of the tangent plane at right angles: along an axis, and n times that."""
    (x, y, z), (a, b, c) = normal, map(magnitude, normal)
    # the axis of the least component: one of the three is 1
    i = choose((a <= b) & (a <= c), 1.0, 0.0)
    j = choose((b < a) & (b <= c), 1.0, 0.0)
    k = 1.0 - i - j
    part = i * x + j * y + k * z
    u, v, w = i - part * x, j - part * y, k - part * z
    size = square_root(u * u + v * v + w * w)
    one = u / size, v / size, w / size
    return one, cross(normal, one)


def frame(encounter: _Meeting, bodies: Sequence[Side], normal: Vector) -> Frame:
    """Return the frame with t1 along W_nt, or along the slip without coupling.

    For an ellipse t1 is the axis that holds both, or else the major one.
    """
    one, other = _tangents(normal)
    (pressed, p, q), (_, a, b), (_, _, d) = inverse_mass_of(bodies, (normal, one, other))
    velocity = relative_velocity(encounter, bodies)
    approach = dot(velocity, normal)
    # vectors of the tangent plane are complex numbers
    coupling = p + 1j * q
    slip = dot(velocity, one) + 1j * dot(velocity, other)
    # half the trace of the tangential part, and the rest, which turns twice as far
    mean, rest = 0.5 * (a + d), 0.5 * (a - d) + 1j * b
    # the first of coupling, slip and any axis that is not lost in rounding, as ``ways`` judges it
    candidates = (
        (coupling, inverse_mass.ROUNDING * square_root(pressed * mean)),
        (slip, inverse_mass.ROUNDING * square_root(dot(velocity, velocity))),
    )
    turn: Complex = 1.0 + 0.0j
    for vector, rounding in reversed(candidates):
        size = magnitude(vector)
        turn = choose(size > rounding, vector / (size + (size == 0.0)), turn)
    gap = gap_of(encounter, one, other)
    if some(gap.elliptic):
        turn, gap = _along_an_axis(gap, turn, candidates)
    back: Any = turn.conjugate()
    coupling, slip = coupling * back, slip * back
    rest = rest * back * back
    c, s, (x, y, z), (u, v, w) = turn.real, turn.imag, one, other
    axes = (
        normal,
        (c * x + s * u, c * y + s * v, c * z + s * w),
        (c * u - s * x, c * v - s * y, c * w - s * z),
    )
    tensor = (
        (pressed, coupling.real, coupling.imag),
        (coupling.real, mean + rest.real, rest.imag),
        (coupling.imag, rest.imag, mean - rest.real),
    )
    return Frame(axes, tensor, (approach, slip.real, slip.imag), gap)


def gap_of(encounter: _Meeting, t1: Vector, t2: Vector) -> Gap:
    """Return the curvatures of the gap between the bodies, the sum of both (theory §16).

    Raises
    ------
    ValueError
        If the bodies do not curve apart in every direction: they touch along a line or a face.
    """
    one, other, axis = _curvatures(encounter.body, t1, t2)
    two, another, across = _curvatures(encounter.target, t1, t2)
    mean = 0.5 * ((one + other) + (two + another))
    uneven = 0.5 * ((one - other) * axis * axis + (two - another) * across * across)
    size = magnitude(uneven)
    elliptic = size > ROUND * magnitude(mean)
    if not some(elliptic):
        if not every(mean > 0.0):
            rule = "one of the bodies must be curved, and both curve apart"
            _refuse_gap(encounter, rule, "two planes")
        return Gap(mean, mean, 1.0 + 0.0j, elliptic)
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


def _curvatures(
    body: Sphere | HalfSpace | RigidBody, t1: Vector, t2: Vector
) -> tuple[Real, Real, Complex]:
    """Return both principal curvatures of a body in 1/m, and the direction of the first."""
    if isinstance(body, RigidBody):
        return body.curvatures(t1, t2)
    curvature: Real = 0.0 if isinstance(body, HalfSpace) else 1.0 / body.radius
    return curvature, curvature, 1.0 + 0.0j


def _refuse_gap(encounter: _Meeting, rule: str, what: str) -> None:
    """Refuse bodies that touch along a line or a face."""
    bodies = encounter.body, encounter.target
    given = tuple(_radii(body) for body in bodies)
    hollow = any(
        np.any(np.less(radius, 0.0))
        for body in bodies
        if isinstance(body, RigidBody)
        for radius in (body.curvature_radius, body.crossing)
    )
    remedy = f"a contact of {what} is no Hertz contact; give a finite curvature_radius, or "
    remedy += "crown_radius= of a shape"
    if hollow:
        remedy = "a hollow must be less curved than what it touches; take a flatter one"
    name = "curvature_radius"
    if any(isinstance(radii, tuple) for radii in given):
        name += ", cross_radius"
    raise refuse(f"{name} of body and target", given, rule, remedy)


def _radii(body: Sphere | HalfSpace | RigidBody) -> object:
    """Return the radius of a body at the contact, or both principal radii, in m."""
    if isinstance(body, HalfSpace):
        return math.inf
    if isinstance(body, Sphere):
        return body.radius
    one, other = body.curvature_radius, body.crossing
    return one if body.cross_radius is None else (one, other)


def _along_an_axis(
    gap: Gap, turn: complex | AnyArray, holds: Sequence[tuple[Any, Real]]
) -> tuple[Complex, Gap]:
    """Return t1 along the axis of the ellipse that holds coupling and slip, and the gap there."""
    parts = [(vector * np.conj(gap.major), rounding) for vector, rounding in holds]
    along, aside = (
        np.logical_or(*(magnitude(side(part)) > rounding for part, rounding in parts))
        for side in (np.real, np.imag)
    )
    minor = gap.elliptic & aside & ~along
    # t1 points along the coupling, or along the slip
    sense = [(part * np.where(minor, -1j, 1.0)).real for part, _ in parts]
    pressed = magnitude(sense[0]) > parts[0][1]
    back = np.where(pressed, sense[0], sense[1]) < 0.0
    first = np.where(minor, 1j, 1.0) * gap.major
    first = np.where(gap.elliptic, np.where(back, -first, first), turn)
    return first if first.ndim else first.item(), gap._replace(minor=minor)


def scene_of_bodies(encounter: _Meeting, normal: Vector) -> Scene:
    """Return the scene in numbers, with the inverse mass if any impact needs it."""
    shape, bodies = encounter.shape, sides(encounter, normal)
    axes, W, (speed, *slip), gap = frame(encounter, bodies, normal)
    if not every(speed >= LEAST):
        raise encounter.separate()
    contact = elastic_numbers(encounter, gap)
    ways = inverse_mass.ways(W, speed, slip, contact.get("cross_stiffness_ratio", 1.0))
    central = ways == inverse_mass.CENTRAL
    across = magnitude(slip[1]) > inverse_mass.ROUNDING * (magnitude(speed) + magnitude(slip[0]))
    planar = not some(across | (ways == inverse_mass.SPATIAL))
    along = slip[0] if planar else join_components(slip, shape)
    tangential = W[1][1] if planar else 0.5 * (W[1][1] + W[2][2])
    entries: dict[str, Any] = {
        "inverse_mass": lock_arrays(join_components(W, shape)),
        "planar": planar,
    }
    if every(central):
        along, entries = hypotenuse(*slip), {}
        unit = along + (along == 0.0)
        tangential = inverse_mass.along(W, (slip[0] + (along == 0.0)) / unit, slip[1] / unit)
    round_ = central > gap.elliptic  # central, and no ellipse
    spin = _spin_alone(encounter, bodies, normal, round_)
    if some(spin != 0.0):
        turning = turning_compliance(bodies, normal, contact["radius"])
        contact |= {"inverse_spin_mass": turning}
    entries |= {
        "friction_coefficient": encounter.friction_coefficient,
        "normal_speed": speed,
        "tangential_velocity": lock_arrays(along),
        "normal_spin": spin,
        "encounter": encounter,
        "frame": join_components(axes, shape),
    }
    try:
        contact |= {"normal_mass": 1.0 / W[0][0], "tangential_mass": 1.0 / tangential}
        entries["pair"] = Pair.of_numbers(contact)
        if shape or encounter.of_slip is not None:
            return Scene(None, None, **entries, of_slip=encounter.of_slip)
        if not every(central):
            inverse_mass.check(entries["inverse_mass"])
        return of_bodies(entries)
    except (ValueError, ZeroDivisionError):
        try:
            inverse_mass.check(join_components(W, shape))
        except (ValueError, FloatingPointError):
            raise _find_loss(bodies) from None
        raise


def _find_loss(bodies: Sequence[Side]) -> ValueError:
    """Return the ValueError of a mass and an inertia beside each other that rounding loses."""
    for name, body, arm, _ in bodies:
        if isinstance(body, RigidBody):
            moments = np.linalg.eigvalsh(body.inertia).reshape(-1, 3)[0].tolist()
            mass, length = np.ravel(body.mass)[0].item(), square_root(dot(arm, arm))
            least = f"{mass * np.ravel(length)[0].item() ** 2:.2g} kg m²"
            side = "target" if name else "body"
            rule = f"is lost in rounding beside mass times contact², {least}"
            return refuse(f"{side}.inertia, principal", moments, rule, "check the units")
    raise AssertionError("spheres have a scene of their own")


def elastic_numbers(encounter: _Meeting, gap: Gap) -> dict[str, Any]:
    """Return the entries of ``Pair`` that follow from the materials and the gap."""
    first, second = encounter.body.material, encounter.target.material
    compliance = normal_compliance(first) + normal_compliance(second)
    shear = 1.0 / (shear_compliance(first) + shear_compliance(second))
    round_ = {
        "radius": 1.0 / gap.most,
        "effective_modulus": 1.0 / compliance,
        "effective_shear_modulus": shear,
        "dundurs_beta": coupling_compliance(first, second) / compliance,
    }
    if not some(gap.elliptic):
        return round_
    from contactlab.impact.elliptic import ellipse  # scipy, which few scenes need

    # t1 differs from impact to impact where one pair of bodies meets at many velocities
    flatness = np.where(gap.elliptic, gap.least / gap.most, 1.0) + np.zeros(np.shape(gap.minor))
    shape = ellipse(flatness)
    weights = np.where(gap.minor, (shape.weight_minor, shape.weight_major), shape[4:])
    along, across = (
        (1.0 - first.poisson_ratio * weight) / (2.0 * first.shear_modulus)
        + (1.0 - second.poisson_ratio * weight) / (2.0 * second.shear_modulus)
        for weight in weights
    )
    ratio, size = shape.axis_ratio, 2.0 * shape.radius / (gap.least + gap.most)
    return round_ | {
        "radius": np.where(gap.elliptic, size, round_["radius"]),
        "effective_shear_modulus": np.where(gap.elliptic, 1.0 / along, shear),
        "cross_stiffness_ratio": np.where(gap.elliptic, along / across, 1.0),
        "axis_ratio": np.where(gap.elliptic, np.where(gap.minor, 1.0 / ratio, ratio), 1.0),
    }


def in_space(axes: Array, vectors: Array) -> Array:
    """Return vectors along n, t1 and t2, the rows of ``axes``, in the frame of the encounter."""
    return np.asarray(np.einsum("...ia,...i->...a", axes, vectors))


def resolve_velocity(scene: Scene, velocity: Array) -> tuple[Real, Real]:
    """Return the components along the normal and ``scene.along`` of a velocity of the first body.

    Components are relative to the surface that the body strikes, in m/s, numbers for one impact.
    """
    encounter, axes, along = scene.encounter, scene.frame, scene.along
    assert axes is not None
    assert along is not None
    normal = components(axes[..., 0, :])
    off: Vector = difference(velocity, encounter.target_velocity)
    for name, _, arm, _ in sides(encounter, normal):
        if name:
            rim = cross(components(encounter.target_spin), arm)
            off = [one - other for one, other in zip(off, rim, strict=True)]
    first, second = dot(off, normal), dot(off, along)
    if not scene.shape:
        return first, second
    return np.broadcast_to(first, scene.shape), np.broadcast_to(second, scene.shape)


def push_bodies(
    encounter: _Meeting, axes: Array, impulse: Array, couple: Real = 0.0
) -> dict[str, Array]:
    """Return velocities and spins after an impulse in N s on the target, and its opposite.

    ``impulse`` has components along n, t1 and t2, the rows of ``axes``, shape (..., 3). ``couple``
    is the angular impulse on the target about the normal, in N m s, of the batch shape.
    """
    shape, moved = encounter.shape, {}
    for side, changes in changes_of(encounter, axes, impulse, couple):
        for entry, change in changes.items():
            name = side.name + entry
            (x, y, z), (u, v, w) = components(getattr(encounter, name)), change
            moved[name] = join_components((x + u, y + v, z + w), shape)
    for name in VELOCITIES:
        if name not in moved:
            moved[name] = over(getattr(encounter, name), impulse.shape)
    return moved


def changes_of(
    encounter: _Meeting, axes: Array, impulse: Array, couple: Real = 0.0
) -> Iterator[tuple[Side, dict[str, Vector]]]:
    """Yield each body that moves, and the changes of its velocity and spin, as of ``push_bodies``.

    Changes are vectors by their components.
    """
    (normal, (a, b, c), (d, e, f)), (p, q, r) = rows(axes), components(impulse)
    n, m, k = normal
    x, y, z = p * n + q * a + r * d, p * m + q * b + r * e, p * k + q * c + r * f
    for side in sides(encounter, normal):
        # the impulse on this body, and its angular impulse about the centre of mass
        sense, mass = side.sense, side.body.mass
        push = -sense * x, -sense * y, -sense * z
        (u, v, w), turn = cross(side.arm, push), sense * couple
        moment = u - turn * n, v - turn * m, w - turn * k
        velocity = push[0] / mass, push[1] / mass, push[2] / mass
        yield side, {"velocity": velocity, "spin": turn_body(side.body, moment)[0]}
