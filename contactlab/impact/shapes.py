"""Rod, box and ellipsoid: a ``RigidBody`` and its contact vector for an outward normal.

Each function takes the outward normal at the contact and the orientation of the body, in the frame
of the encounter, and returns ``(body, contact)`` for ``Encounter(body, target, contact=contact)``.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from contactlab.impact.material import Material
from contactlab.impact.rigid_body import RigidBody
from contactlab.numeric.checks import POSITIVE, real, refuse

__all__ = ["box", "ellipsoid", "rod"]

Array = NDArray[np.float64]

#: Cosine of the normal with an edge or face below which the contact is a line or a face.
FLUSH = 1e-9
#: Square of the first root of cos x cosh x = 1: bending of a rod with free ends.
FREE_ENDS = 4.730040744862704**2


def rod(
    *,
    length: float,
    radius: float,
    material: Material,
    normal: Any,
    axis: Any,
    end_radius: float | None = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid round rod that touches with a rounded end, and its contact vector in m.

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
        In kg.

    Raises
    ------
    ValueError
        If the contact is a line along the side or the sharp edge of a dome, or a number is out
        of range.
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
    if cosine < FLUSH:
        raise refuse("normal", outward, "contact along a line: the side touches", "tilt the rod")
    if end * math.sqrt(max(1.0 - cosine * cosine, 0.0)) > radius * (1.0 + FLUSH):
        rule = "contact on the sharp edge of the dome: no curvature"
        raise refuse("normal", outward, rule, "tilt the rod less, or take a smaller end_radius")
    contact = along * (0.5 * length - end) + end * outward
    volume, lengthwise, across = _revolved(length, radius, end, dome)
    mass = _mass(mass, material, volume)
    moments = np.full((3, 3), 0.0)
    moments += mass * (across * np.eye(3) + (lengthwise - across) * np.outer(along, along))
    young: Any = 2.0 * material.shear_modulus * (1.0 + material.poisson_ratio)
    speed = np.sqrt(young * volume / mass) * 0.5 * radius
    body = RigidBody(
        mass=mass,
        inertia=0.5 * (moments + moments.T),
        material=material,
        curvature_radius=end,
        bending_period=2.0 * math.pi * length * length / (FREE_ENDS * speed),
    )
    return body, contact


def box(
    *,
    sides: Any,
    corner_radius: float,
    material: Material,
    normal: Any,
    axes: Any = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid box that touches with a rounded corner, and its contact vector in m.

    Mass and inertia are those of the box with sharp edges.

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
    mass : float, optional
        In kg.

    Raises
    ------
    ValueError
        If the contact is a line along an edge or a face, or a number is out of range.
    """
    edges, corner = _three("sides", sides), _size("corner_radius", corner_radius)
    if corner > 0.5 * edges.min():
        raise refuse("corner_radius", corner, "must be at most half the shortest side")
    turn = _axes(axes)
    outward = turn.T @ _unit("normal", normal)
    flush = int((np.abs(outward) < FLUSH).sum())
    if flush:
        what = "contact along a line: an edge" if flush == 1 else "contact along a face: a side"
        raise refuse("normal", turn @ outward, f"{what} of the box touches", "tilt the box")
    contact = np.sign(outward) * (0.5 * edges - corner) + corner * outward
    mass = _mass(mass, material, float(edges.prod()))
    squares = edges * edges
    body = RigidBody(
        mass=mass,
        principal=mass / 12.0 * (squares.sum() - squares),
        axes=turn,
        material=material,
        curvature_radius=corner,
    )
    return body, turn @ contact


def ellipsoid(
    *,
    semi_axes: Any,
    material: Material,
    normal: Any,
    axes: Any = None,
    mass: float | None = None,
) -> tuple[RigidBody, Array]:
    """Return a solid ellipsoid and its contact vector in m.

    ``curvature_radius`` is one over the mean curvature at the contact; ``curvature_ratio`` is that
    of the principal radii.

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
    _, small, large = np.linalg.eigvalsh(second)
    mass = _mass(mass, material, 4.0 / 3.0 * math.pi * float(lengths.prod()))
    body = RigidBody(
        mass=mass,
        principal=mass / 5.0 * (squares.sum() - squares),
        axes=turn,
        material=material,
        curvature_radius=2.0 * small * large / (small + large),
        curvature_ratio=max(1.0, float(large / small)),
    )
    return body, turn @ contact


def _revolved(length: float, radius: float, end: float, dome: float) -> tuple[float, float, float]:
    """Return volume, and moments over mass along and across the axis, of a domed cylinder."""
    # r² is of second degree in z on each part: three Gauss points integrate r⁴ and z² r² exactly.
    points, weights = np.polynomial.legendre.leggauss(3)
    straight = 0.5 * length - dome
    z = np.concatenate((0.5 * straight * (1.0 + points), straight + 0.5 * dome * (1.0 + points)))
    share = np.concatenate((straight * weights, dome * weights))  # both halves of the rod
    depth = 0.5 * length - z[3:]
    square = np.concatenate((np.full(3, radius * radius), depth * (2.0 * end - depth)))
    volume = math.pi * float(share @ square)
    lengthwise = 0.5 * math.pi * float(share @ (square * square)) / volume
    return volume, lengthwise, 0.5 * lengthwise + math.pi * float(share @ (z * z * square)) / volume


def _size(name: str, value: Any) -> float:
    """Return a positive length in m."""
    checked = real(name, value, rule=POSITIVE, remedy="one number in m")
    if np.ndim(checked):
        raise refuse(name, value, "must be one number", "in m")
    return float(checked)


def _three(name: str, value: Any) -> Array:
    """Return three positive lengths in m."""
    checked = np.asarray(real(name, value, rule=POSITIVE, remedy="three lengths in m"))
    if checked.shape != (3,):
        raise refuse(f"{name}.shape", checked.shape, "must be (3,)", "give three lengths in m")
    return checked


def _unit(name: str, value: Any) -> Array:
    """Return a direction as a unit vector."""
    vector = np.asarray(real(name, value, remedy="give a vector of shape (3,)"))
    if vector.shape != (3,) or not vector.any():
        raise refuse(name, value, "must be a vector of shape (3,), not zero")
    vector = vector / np.abs(vector).max()
    return np.asarray(vector / np.linalg.norm(vector))


def _axes(value: Any) -> Array:
    """Return unit vectors at right angles as columns."""
    axes = np.eye(3) if value is None else np.asarray(real("axes", value))
    if axes.shape != (3, 3) or not np.allclose(axes.T @ axes, np.eye(3), rtol=0.0, atol=1e-6):
        raise refuse("axes", value, "must be of shape (3, 3), unit vectors at right angles")
    return axes


def _mass(mass: Any, material: Material, volume: float) -> float:
    """Return the mass in kg, by default from the density."""
    if mass is None and material.density is None:
        rule = "is needed where the material has no density"
        raise refuse("mass", mass, rule, "give mass= in kg or Material(density=...) in kg/m³")
    if mass is None:
        return float(real("density", material.density, rule=POSITIVE)) * volume
    return float(real("mass", mass, rule=POSITIVE, remedy="one number in kg"))
