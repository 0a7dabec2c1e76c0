"""Rod, disc, box and ellipsoid: a ``RigidBody`` and its contact vector for an outward normal.

Each function takes the outward normal at the contact and the orientation of the body, in the frame
of the encounter, and returns ``(body, contact)`` for ``Encounter(body, target, contact=contact)``.
Normals and orientations may be arrays, a pose of the same body in each row: shape (..., 3), and of
``axes`` (..., 3, 3). Body and contacts are then a batch.
"""

from __future__ import annotations

import functools
import math
from collections.abc import Callable, Mapping
from typing import Any, Never, TypeVar

import attrs
import numpy as np

from contactlab.impact.material import A_MATERIAL, Material
from contactlab.impact.rigid_body import RigidBody
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.checks import NON_NEGATIVE, POSITIVE, of_kind, real, refuse
from contactlab.numeric.names import SHAPES, tell_function
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Array, Numbers, Real
from contactlab.registration.bring import by_name
from contactlab.registration.hooks import hookimpl

__all__ = ["box", "disc", "ellipsoid", "flat_box", "flat_rod", "rod"]

Maker = TypeVar("Maker", bound=Callable[..., tuple[RigidBody, Array]])

#: Arguments of a pose, and how many dimensions each has for one.
POSE = {"normal": 1, "axis": 1, "axes": 2}
#: Remedies for a missing direction.
UNIT = {
    "normal": "such as [0, 0, -1], down",
    "axis": "such as [0, 0, 1], up; an angle is tilt_deg of a scene file",
}
#: Cosine of the normal with an edge or face below which the contact is a line or a face.
FLUSH = 1e-9
#: Radius of curvature of an edge that nobody gave, over the longest side.
CROWN = 10.0
#: Gauss points along the quarter circle of a rim: more change nothing.
RIM_POINTS = 32
#: Square of the first root of cos x cosh x = 1: bending of a rod with free ends.
FREE_ENDS = 4.730040744862704**2
#: The same of a needle, an ellipsoid far longer than wide, over its half-length: the root of the
#: least eigenvalue of ((1 - s²)² w'')'' = q² (1 - s²) w that is no rigid motion.
NEEDLE = 8.206954742
#: The same of a thin disc with a free rim that bends about two diameters: radius and thickness in
#: place of length and radius of gyration. It is 1.78 for nu = 0, 1.62 for 0.3, 1.55 for 0.5.
DISC = 1.62


def __getattr__(name: str) -> Never:
    """Refuse a name with the shape that is meant."""
    meant = SHAPES.get(name.lower())
    told = f"that body is made by {meant}; " if meant else ""
    raise AttributeError(f"shapes has no attribute {name!r}; {told}it has {', '.join(__all__)}")


def _pose_each(one: Maker) -> Maker:
    """Return a function of many poses from one of a single pose."""

    @functools.wraps(one)
    def posed(*values: Any, **given: Any) -> tuple[RigidBody, Array]:
        poses = {name: given[name] for name in POSE if given.get(name) is not None}
        try:
            arrays = {name: np.asarray(real(name, pose)) for name, pose in poses.items()}
            fronts = [array.shape[: array.ndim - POSE[name]] for name, array in arrays.items()]
            shape = np.broadcast_shapes(*fronts)
        except ValueError:  # the function of one pose refuses it
            return one(*values, **given)
        if not shape or values:
            return one(*values, **given)
        each = {
            name: np.broadcast_to(array, (*shape, *array.shape[array.ndim - POSE[name] :]))
            for name, array in arrays.items()
        }
        made = []
        for index in np.ndindex(shape):
            try:
                made.append(one(**given | {name: array[index] for name, array in each.items()}))
            except ValueError as error:
                raise ValueError(f"pose {', '.join(map(str, index))}: {error}") from None
        return _stack(made, shape)

    return posed  # type: ignore[return-value]


def _stack(made: list[tuple[RigidBody, Array]], shape: tuple[int, ...]) -> tuple[RigidBody, Array]:
    """Return poses of one body as a batch, with their contacts."""
    bodies = RigidBody.alike([body for body, _ in made])
    columns: dict[str, Any] = {
        "inertia": np.array([body.inertia for body in bodies]).reshape(*shape, 3, 3),
        "curvature_radius": _radii([body.curvature_radius for body in bodies], shape),
    }
    if bodies[0].cross_radius is not None:
        columns["cross_radius"] = np.array([body.cross_radius for body in bodies]).reshape(shape)
        axes = [body.curvature_axis for body in bodies]
        columns["curvature_axis"] = np.array(axes).reshape(*shape, 3)
    body = attrs.evolve(bodies[0], principal=None, axes=None, **columns)
    return body, np.reshape([contact for _, contact in made], (*shape, 3))


def _radii(radii: list[Real], shape: tuple[int, ...]) -> Real:
    """Return radii as an array, or as one number if the user gave none."""
    taken = [isinstance(each, Taken) for each in radii]
    if any(taken) and not all(taken):
        rule = "is needed where some poses touch with an edge, and others with a corner"
        raise refuse("crown_radius", None, rule, "give it in m")
    return radii[0] if all(taken) else np.array(radii).reshape(shape)


@tell_function
@_pose_each
def rod(
    *,
    length: float,
    radius: float,
    material: Material,
    normal: Numbers,
    axis: Numbers,
    end_radius: float | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid round rod and its contact vector in m.

    It touches with a rounded end, or, where the normal is at right angles to it, with its side: in
    the middle, as far as this rod knows; add a multiple of ``axis`` to the contact for another
    place. The side touches balls and rods that cross it; a plane it touches along a line, which an
    ``Encounter`` refuses.

    Parameters
    ----------
    length : float
        From tip to tip, in m.
    radius : float
        Radius of the cross-section, in m.
    material : Material
        Its density is needed if no mass is given.
    normal : array, shape (3,)
        Outward normal at the contact.
    axis : array, shape (3,)
        Direction of the rod, of either sign.
    end_radius : float, optional
        Radius of the sphere that rounds both ends, in m, at least ``radius``, the default: half
        a sphere. A cylinder with a domed end has a larger one.
    mass : float, optional
        In kg; one below that of the solid rod, as of a tube, lowers the bending period.

    Raises
    ------
    ValueError
        If the contact is the sharp edge of a dome, or a number is out of range.
    """
    length, radius = _size("length", length), _size("radius", radius)
    end = radius if end_radius is None else _size("end_radius", end_radius)
    if end < radius:
        raise refuse("end_radius", end, "must be at least radius", f"radius = {radius} m")
    dome = end - math.sqrt((end - radius) * (end + radius))
    if length < 2.0 * dome:
        raise refuse("length", length, f"must hold both rounded ends, {2.0 * dome:.6g} m")
    outward, along = _unit("normal", normal), _unit("axis", axis)
    along = along * (1.0 if along @ outward > 0.0 else -1.0)
    cosine = float(along @ outward)
    side = cosine < FLUSH
    if not side and end * math.sqrt(max(1.0 - cosine * cosine, 0.0)) > radius * (1.0 + FLUSH):
        rule = "contact on the sharp edge of the dome: no curvature"
        raise refuse("normal", outward, rule, "tilt the rod less, or take a smaller end_radius")
    contact = radius * outward if side else along * (0.5 * length - end) + end * outward
    volume, lengthwise, across = _revolve(length, radius, end, dome)
    mass = _mass(mass, material, volume)
    density = mass / volume
    inner = 0.0
    if material.density is not None and density < material.density:  # a tube, of radius² inner
        inner = radius * radius * (1.0 - density / material.density)
        density = material.density
    gyration = 0.5 * math.sqrt(radius * radius + float(inner))
    body = RigidBody(
        mass=mass,
        inertia=mass * _about(along, lengthwise, across),
        material=material,
        **(_two(math.inf, radius, along) if side else {"curvature_radius": end}),
        bending_period=_bending(length, gyration, material, density),
    )
    return body, contact


@tell_function
@_pose_each
def disc(
    *,
    radius: float,
    thickness: float,
    rim_radius: float,
    material: Material,
    normal: Numbers,
    axis: Numbers,
    crown_radius: float | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid disc with rounded rims, such as a puck or a coin, and its contact vector in m.

    It touches with a rim, or, where the normal is at right angles to its axis, with its side.

    Parameters
    ----------
    radius, thickness : float
        In m.
    rim_radius : float
        Radius that rounds the rims between side and faces, in m, at most half the thickness.
    material : Material
        Its density is needed if no mass is given.
    normal : array, shape (3,)
        Outward normal at the contact.
    axis : array, shape (3,)
        Axis of the disc, of either sign.
    crown_radius : float, optional
        Radius of curvature of the side along the axis, in m, at least half the thickness; by
        default the side is straight, and touches a plane along a line, which an ``Encounter``
        refuses. Mass and inertia are those without crown.
    mass : float, optional
        In kg.

    Raises
    ------
    ValueError
        If a face touches, or a number is out of range.
    """
    radius, thickness = _size("radius", radius), _size("thickness", thickness)
    rim = _size("rim_radius", rim_radius)
    if rim > min(0.5 * thickness, radius):
        raise refuse("rim_radius", rim, "must be at most half the thickness, and the radius")
    crown = _crown(crown_radius, 0.5 * thickness)
    outward, along = _unit("normal", normal), _unit("axis", axis)
    along = along * (1.0 if along @ outward > 0.0 else -1.0)
    sine = float(along @ outward)
    aside = outward - sine * along
    cosine = float(np.linalg.norm(aside))
    if cosine < FLUSH:
        raise refuse("normal", outward, "contact along a face of the disc", "tilt the disc")
    aside = aside / cosine
    straight = 0.5 * thickness - rim
    if straight > 0.0 and (sine < FLUSH or (crown < math.inf and crown * sine <= straight)):
        bulge = crown * (outward - aside) if crown < math.inf else 0.0 * aside
        contact, lengthwise = radius * aside + bulge, crown
    else:
        contact, lengthwise = (radius - rim) * aside + straight * along + rim * outward, rim
    around = float(contact @ aside) / cosine
    tangent = (outward * sine - along) / cosine  # along the side, across the rim
    volume, own, across = _round_rim(radius, straight, rim)
    mass = _mass(mass, material, volume)
    body = RigidBody(
        mass=mass,
        inertia=mass * _about(along, own, across),
        material=material,
        bending_period=_bending(radius, thickness, material, mass / volume, number=DISC),
        **_two(lengthwise, around, tangent),
    )
    return body, contact


@tell_function
@_pose_each
def box(
    *,
    sides: Numbers,
    corner_radius: float,
    material: Material,
    normal: Numbers,
    axes: Numbers | None = None,
    crown_radius: float | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid box and its contact vector in m.

    It touches with a rounded corner, or with an edge that bulges a little, as a barrel does. Mass
    and inertia are those of a box whose corners and edges are all rounded, without bulges: with
    half the side of a cube as ``corner_radius`` those of a ball.

    Parameters
    ----------
    sides : array, shape (3,)
        Lengths of the edges, in m.
    corner_radius : float
        Radius of the sphere that rounds the corner, in m, at most half the shortest side.
    material : Material
        Its density is needed if no mass is given.
    normal : array, shape (3,)
        Outward normal at the contact.
    axes : array, shape (3, 3), optional
        Unit vectors along the edges as columns, in the order of ``sides``; those of the frame by
        default.
    crown_radius : float, optional
        Radius of curvature of the edges along their length, in m, at least half the longest side.
        With it the box touches with an edge where the normal is nearly at right angles to it. By
        default it touches with corners; where an edge lies flat on the surface, ten times the
        longest side is taken, and the plan says so. ``flat_box`` gives both ends of an edge for a
        ``Gathering``.
    mass : float, optional
        In kg.

    Raises
    ------
    ValueError
        If a face touches, or a number is out of range.
    """
    edges, corner = _three("sides", sides), _size("corner_radius", corner_radius)
    if corner > 0.5 * edges.min():
        raise refuse("corner_radius", corner, "must be at most half the shortest side")
    turn = _axes(axes)
    outward = turn.T @ _unit("normal", normal)
    crown = _crown(crown_radius, 0.5 * float(edges.max()))
    flush = int((np.abs(outward) < FLUSH).sum())
    if flush == 2:
        remedy = "tilt the box; as it lands flat flat_box gives its corners for a Gathering"
        raise refuse("normal", turn @ outward, "contact along a face of the box", remedy)
    if flush and crown == math.inf:
        crown = Taken(CROWN * float(edges.max()))
    contact = np.sign(outward) * (0.5 * edges - corner) + corner * outward
    curvature: dict[str, Any] = {"curvature_radius": corner}
    along = int(np.argmin(np.abs(outward)))
    if crown * abs(outward[along]) <= 0.5 * edges[along] - corner:
        direction = np.eye(3)[along]
        across = _unit("normal", outward - outward[along] * direction)
        contact = np.sign(across) * (0.5 * edges - corner) + corner * across
        contact = contact + crown * (outward - across)
        curvature = _two(crown, corner, turn @ direction)
    volume, squares = _round_box(0.5 * edges - corner, corner)
    mass = _mass(mass, material, volume)
    gyration = float(edges.min()) / math.sqrt(12.0)
    body = RigidBody(
        mass=mass,
        principal=mass * (squares.sum() - squares),
        axes=turn,
        material=material,
        bending_period=_bending(float(edges.max()), gyration, material, mass / volume),
        **curvature,
    )
    return body, turn @ contact


@tell_function
def flat_box(
    *,
    sides: Numbers,
    corner_radius: float,
    material: Material,
    normal: Numbers,
    reach: float,
    axes: Numbers | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array, Array]:
    """Return a box that lands flat, contact vectors of its corners (K, 3) in m, and gaps (K,) in m.

    They make the touches of a ``Gathering``: ``Touch("box", floor, 0.3, normal=normal, contact=c,
    gap=g)`` of each. A face has four, an edge two, in the order of their gaps by the tilt.

    Parameters
    ----------
    sides, corner_radius, material, mass
        As of ``box``.
    normal : array, shape (3,)
        Into the plane that the box lands on.
    reach : float
        Corners whose gap is up to this distance in m touch, or may do so.
    axes : array, shape (3, 3), optional
        As of ``box``; a tilt opens gaps.

    Raises
    ------
    ValueError
        If a number is out of range.
    """
    outward = _unit("normal", normal)
    turn, edges, corner = _axes(axes), _three("sides", sides), _size("corner_radius", corner_radius)
    seen = turn.T @ outward
    toward = np.where(seen < 0.0, -1.0, 1.0)
    body, _ = box(
        sides=sides, corner_radius=corner_radius, material=material, normal=turn @ toward,
        axes=axes, mass=mass,
    )  # fmt: skip
    signs = np.array([[x, y, z] for x in (1.0, -1.0) for y in (1.0, -1.0) for z in (1.0, -1.0)])
    corners = (signs * toward * (0.5 * edges - corner)) @ turn.T + corner * outward
    return body, *_in_reach(corners, outward, reach)


@tell_function
def flat_rod(
    *,
    length: float,
    radius: float,
    material: Material,
    normal: Numbers,
    axis: Numbers,
    reach: float,
    end_radius: float | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array, Array]:
    """Return a rod that lands on its side, contact vectors of its rounded ends, and gaps in m.

    The vectors have the shape (K, 3), the gaps (K,): two ends, or one if the other is out of reach.
    Ends are half spheres; the line of contact between them is left out.

    Parameters
    ----------
    length, radius, material, end_radius, mass
        As of ``rod``.
    normal : array, shape (3,)
        Into the plane that the rod lands on.
    axis : array, shape (3,)
        Direction of the rod; a tilt opens a gap.
    reach : float
        Ends whose gap is up to this distance in m touch, or may do so.

    Raises
    ------
    ValueError
        If ends are no half spheres, or a number is out of range.
    """
    outward, along = _unit("normal", normal), _unit("axis", axis)
    if end_radius is not None and end_radius != radius:
        rule = "must be radius where a rod lands on its side: its dome does not reach the plane"
        raise refuse("end_radius", end_radius, rule, "leave it out")
    body, _ = rod(
        length=length, radius=radius, material=material, normal=along, axis=axis, mass=mass
    )
    centres = np.array([1.0, -1.0])[:, None] * along * (0.5 * length - radius)
    return body, *_in_reach(centres + radius * outward, outward, reach)


def _in_reach(contacts: Array, outward: Array, reach: float) -> tuple[Array, Array]:
    """Return the contacts whose gap is in reach, the nearest first, and their gaps in m."""
    least = real("reach", reach, rule=NON_NEGATIVE, remedy="in m, such as 1e-5")
    depth = contacts @ outward
    gaps = depth.max() - depth
    gaps = np.where(gaps < FLUSH * np.abs(contacts).max(), 0.0, gaps)
    order = np.argsort(gaps, kind="stable")
    order = order[gaps[order] <= least]
    return contacts[order], gaps[order]


@tell_function
@_pose_each
def ellipsoid(
    *,
    semi_axes: Numbers,
    material: Material,
    normal: Numbers,
    axes: Numbers | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid ellipsoid and its contact vector in m.

    The principal radii and their axis are exact at any point.

    Parameters
    ----------
    semi_axes : array, shape (3,)
        In m.
    material : Material
        Its density is needed if no mass is given.
    normal : array, shape (3,)
        Outward normal at the contact.
    axes : array, shape (3, 3), optional
        Unit vectors of the axes as columns, in the order of ``semi_axes``; those of the frame by
        default.
    mass : float, optional
        In kg.

    Raises
    ------
    ValueError
        If a number is out of range.
    """
    lengths, turn = _three("semi_axes", semi_axes), _axes(axes)
    outward = turn.T @ _unit("normal", normal)
    squares = lengths * lengths
    # The support function h(n) = |diag(a) n|: its gradient is the contact, and its second
    # derivatives have the principal radii as eigenvalues, and zero along n.
    height = float(np.linalg.norm(lengths * outward))
    contact = squares * outward / height
    second = (np.diag(squares) - np.outer(contact, contact)) / height
    radii, directions = np.linalg.eigh(second)
    volume = 4.0 / 3.0 * math.pi * float(lengths.prod())
    mass = _mass(mass, material, volume)
    longest, gyration = float(lengths.max()), 0.5 * float(lengths.min())
    body = RigidBody(
        mass=mass,
        principal=mass / 5.0 * (squares.sum() - squares),
        axes=turn,
        material=material,
        bending_period=_bending(longest, gyration, material, mass / volume, number=NEEDLE),
        **_two(float(radii[2]), float(radii[1]), turn @ directions[:, 2]),
    )
    return body, turn @ contact


def _bending(
    length: float, gyration: float, material: Material, density: Real, *, number: float = FREE_ENDS
) -> Real:
    """Return the period in s of the first bending of a slender body with free ends.

    ``gyration`` is that of the section in the middle, in m, and ``density`` mass over volume.
    """
    young = 2.0 * material.shear_modulus * (1.0 + material.poisson_ratio)
    speed: Real = np.sqrt(young / density) * gyration
    return 2.0 * math.pi * length * length / (number * speed)


def _round_box(half: Array, r: float) -> tuple[float, Array]:
    """Return volume, and mean squares of x, y, z, of all points within r of a box.

    ``half`` are the half-lengths of that inner box. The parts are the box itself, slabs on its
    faces, quarters of a cylinder along its edges and eighths of a ball at its corners.
    """
    a = half
    b, c = np.roll(a, -1), np.roll(a, -2)
    ball, ring = 4.0 / 3.0 * math.pi * r**3, math.pi * r * r
    volume = float(8.0 * a.prod() + 8.0 * r * (a * b).sum() + 2.0 * ring * a.sum() + ball)
    inside = 8.0 / 3.0 * a**3 * b * c + 8.0 / 3.0 * a**3 * r * (b + c)
    faces = 8.0 / 3.0 * b * c * ((a + r) ** 3 - a**3)
    along = 2.0 / 3.0 * ring * a**3
    around = 2.0 * (b + c) * (ring * a * a + 8.0 / 3.0 * a * r**3 + 0.25 * ring * r * r)
    corners = ball * a * a + math.pi * r**4 * a + 0.2 * ball * r * r
    return volume, (inside + faces + along + around + corners) / volume


@functools.cache  # NumPy takes longer here than for the rest of a body
def _gauss(count: int) -> tuple[Array, Array]:
    """Return points and weights of Gauss's rule on [-1, 1]."""
    points, weights = np.polynomial.legendre.leggauss(count)
    return lock_arrays(points), lock_arrays(weights)


def _revolve(length: float, radius: float, end: float, dome: float) -> tuple[float, float, float]:
    """Return volume, and moments over mass along and across the axis, of a domed cylinder."""
    # r² is of second degree in z on each part: three Gauss points integrate r⁴ and z² r² exactly.
    points, weights = _gauss(3)
    straight = 0.5 * length - dome
    z = np.concatenate((0.5 * straight * (1.0 + points), straight + 0.5 * dome * (1.0 + points)))
    share = np.concatenate((straight * weights, dome * weights))  # both halves of the rod
    depth = 0.5 * length - z[3:]
    square = np.concatenate((np.full(3, radius * radius), depth * (2.0 * end - depth)))
    volume = math.pi * float(share @ square)
    lengthwise = 0.5 * math.pi * float(share @ (square * square)) / volume
    return volume, lengthwise, 0.5 * lengthwise + math.pi * float(share @ (z * z * square)) / volume


def _round_rim(radius: float, straight: float, rim: float) -> tuple[float, float, float]:
    """Return volume, and moments over mass along and across the axis, of a rounded disc."""
    points, weights = _gauss(RIM_POINTS)
    angle = 0.25 * math.pi * (1.0 + points)
    z = np.concatenate((0.5 * straight * (1.0 + points), straight + rim * np.sin(angle)))
    square = np.concatenate(
        (np.full(RIM_POINTS, radius * radius), np.square(radius - rim + rim * np.cos(angle)))
    )
    share = np.concatenate((straight * weights, 0.5 * math.pi * rim * np.cos(angle) * weights))
    volume = math.pi * float(share @ square)
    own = 0.5 * math.pi * float(share @ (square * square)) / volume
    return volume, own, 0.5 * own + math.pi * float(share @ (z * z * square)) / volume


def _about(axis: Array, along: float, across: float) -> Array:
    """Return the tensor of a body of revolution from its moments along and across the axis."""
    return across * np.eye(3) + (along - across) * np.outer(axis, axis)


def _two(radius: float, cross: float, axis: Array) -> dict[str, Any]:
    """Return the entries of two radii of curvature, the first along ``axis``."""
    return {"curvature_radius": radius, "cross_radius": cross, "curvature_axis": axis}


def _crown(value: float | None, least: float) -> float:
    """Return the radius of a crown in m; infinite of none."""
    if value is None:
        return math.inf
    crown = _size("crown_radius", value)
    if crown < least:
        raise refuse("crown_radius", crown, f"must be at least half the length, {least:.6g} m")
    return crown


def _size(name: str, value: object) -> float:
    """Return a positive length in m."""
    checked = real(name, value, rule=POSITIVE, remedy="one number in m")
    if np.ndim(checked):
        raise refuse(name, value, "must be one number", "in m")
    return float(checked)


def _three(name: str, value: object) -> Array:
    """Return three positive lengths in m."""
    checked = np.asarray(real(name, value, rule=POSITIVE, remedy="three lengths in m"))
    if checked.shape != (3,):
        raise refuse(f"{name}.shape", checked.shape, "must be (3,)", "give three lengths in m")
    return checked


def _unit(name: str, value: object) -> Array:
    """Return a direction as a unit vector."""
    vector = np.asarray(real(name, value, remedy="give a vector of shape (3,)"))
    if vector.shape != (3,) or not vector.any():
        raise refuse(name, value, "must be a vector of shape (3,), not zero", UNIT[name])
    vector = vector / np.abs(vector).max()
    return np.asarray(vector / np.linalg.norm(vector))


def _axes(value: Numbers | None) -> Array:
    """Return unit vectors at right angles as columns."""
    if hasattr(value, "as_matrix"):
        rule = "must be an array of shape (3, 3): a rotation has it as axes.as_matrix()"
        raise refuse("axes", value, rule)
    axes = np.eye(3) if value is None else np.asarray(real("axes", value))
    if axes.shape != (3, 3) or not np.allclose(axes.T @ axes, np.eye(3), rtol=0.0, atol=1e-6):
        raise refuse("axes", value, "must be of shape (3, 3), unit vectors at right angles")
    return axes


def _mass(mass: Numbers | None, material: Material, volume: float) -> float:
    """Return the mass in kg, by default from the density."""
    of_kind("material", material, Material, remedy=A_MATERIAL)
    if mass is None and material.density is None:
        rule = "is needed where the material has no density"
        raise refuse("mass", mass, rule, "give mass= in kg or Material(density=...) in kg/m³")
    if mass is None:
        return float(real("density", material.density, rule=POSITIVE)) * volume
    return float(real("mass", mass, rule=POSITIVE, remedy="one number in kg"))


@attrs.frozen(kw_only=True)
class Shape:
    """A shape that ``shape = "..."`` of a scene file names.

    Attributes
    ----------
    name : str
    make : callable
        Takes the keys, ``material``, ``normal`` and ``axis`` or ``axes`` by name, and returns
        ``(body, contact)``; one that lands flat ``(body, contacts, gaps)``.
    needed, further : tuple of str
        Keys of numbers that must be given, and that may be, beside mass and material.
    oriented : str
        ``"axis"`` of a body that is round about it, else ``"axes"``.
    example : mapping
        Numbers for ``contactlab plugins check``.
    """

    name: str
    make: Callable[..., tuple[RigidBody, *tuple[Array, ...]]]
    needed: tuple[str, ...]
    further: tuple[str, ...] = ()
    oriented: str = "axes"
    example: Mapping[str, Any] = attrs.field(factory=dict)

    @property
    def keys(self) -> tuple[str, ...]:
        """The keys of a scene file."""
        return (*self.needed, *self.further, self.oriented, "mass", "material")


@hookimpl
def contactlab_shapes() -> list[Shape]:
    """Return contactlab's own shapes."""
    return [
        Shape(
            name="rod", make=rod, needed=("length", "radius"), further=("end_radius",),
            oriented="axis", example={"length": 0.2, "radius": 0.01},
        ),
        Shape(
            name="disc", make=disc, needed=("radius", "thickness", "rim_radius"),
            further=("crown_radius",), oriented="axis",
            example={"radius": 0.03, "thickness": 0.01, "rim_radius": 0.002},
        ),
        Shape(
            name="box", make=box, needed=("sides", "corner_radius"), further=("crown_radius",),
            example={"sides": (0.1, 0.1, 0.1), "corner_radius": 0.01, "crown_radius": 0.2},
        ),
        Shape(
            name="ellipsoid", make=ellipsoid, needed=("semi_axes",),
            example={"semi_axes": (0.03, 0.02, 0.01)},
        ),
    ]  # fmt: skip


#: Shapes that land flat, with several contacts: of ``[bodies.NAME]``.
FLAT = {
    "flat_box": Shape(name="flat_box", make=flat_box, needed=("sides", "corner_radius", "reach")),
    "flat_rod": Shape(
        name="flat_rod", make=flat_rod, needed=("length", "radius", "reach"),
        further=("end_radius",), oriented="axis",
    ),
}  # fmt: skip


def shapes_by_name() -> Mapping[str, Shape]:
    """Return the shapes of all plug-ins by name."""
    return by_name("shapes", Shape, lambda shape: shape.name)
