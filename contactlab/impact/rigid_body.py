"""Rigid bodies of any shape, which an impact sees as mass, inertia and curvature."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import attrs
import numpy as np

from contactlab.impact.bodies import MOST_RADIUS
from contactlab.impact.material import A_MATERIAL, Material
from contactlab.numeric.arrays import choose, common_shape, magnitude, none_for_nan, some, take
from contactlab.numeric.checks import (
    POSITIVE,
    Rule,
    check_place,
    instance,
    key,
    quantity,
    real,
    refuse,
)
from contactlab.numeric.names import state_arguments
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Array, Complex, Either, Index, Mask, Numbers, Real, Vector
from contactlab.numeric.vectors import components, dot, factor, rows

#: Asymmetry of an inertia, and excess of a principal moment over the sum of the other two, that
#: count as rounding, over the largest moment.
ROUNDING = 1e-9
#: Least principal moment over the largest: of a smaller one too few digits are left.
SLIGHTEST = 1e-12
#: Products of inverses of smaller moments, in kg m², would overflow.
LEAST_MOMENT = 1e-100
#: A flat surface has an infinite radius; ``real`` refuses infinity, so this one is put in for it.
FLAT = MOST_RADIUS
#: Curvatures of smaller radii, in m, would overflow.
LEAST_RADIUS = 1e-100
CURVED = Rule(
    lambda radius: (abs(radius) >= LEAST_RADIUS) & (abs(radius) <= MOST_RADIUS),
    "must be a number, not zero, of a size up to 1e100",
)
#: Length of an axis in the tangent plane over its length, below which it has no direction there.
LOST = 1e-9
#: Ratio of first bending period to duration of contact from which a body rings: a half-sine pulse
#: leaves the first mode at most 4 r/(4 - r²) of its static bending, a fifth at this ratio r.
RINGING = 0.2


def _tensor(value: Numbers | None, field: attrs.Attribute[object]) -> Array | None:
    """Return a read-only array of shape (..., 3, 3), or (..., 3) of principal moments."""
    if value is None:
        return None
    unit, trailing = field.metadata["unit"], field.metadata["trailing"]
    remedy = f"give an array of shape (..., {str(trailing)[1:-1].rstrip(',')})" + (
        f" in {unit}" if unit != "1" else ""
    )
    name = field.alias or field.name
    array = np.array(real(name, value, remedy=remedy, empty=True))
    if array.shape[-len(trailing) :] != trailing:
        if name == "inertia" and array.shape[-1:] == (3,):
            remedy = f"{remedy}; three moments are principal=[...]"
        raise refuse(f"{name}.shape", array.shape, f"must end with {trailing}", remedy)
    array.flags.writeable = False
    return array


def _array(unit: str, trailing: tuple[int, ...]) -> Any:
    """Return an attrs field for checked arrays that end with the axes ``trailing``."""
    converter = attrs.Converter(_tensor, takes_field=True)
    return attrs.field(
        default=None, converter=converter, eq=key, metadata={"unit": unit, "trailing": trailing}
    )


def _radius(value: Numbers | None, field: attrs.Attribute[object]) -> Real | None:
    """Return a radius of curvature in m: infinite if flat, negative if hollow."""
    if (value is None and field.default is None) or type(value) is Taken:
        return value
    flat = _flat(value)
    remedy = "in m; math.inf if flat, negative if hollow"
    if not np.any(flat):
        return real(field.name, value, rule=CURVED, remedy=remedy)
    check_place(field.name, value)
    finite = np.where(flat, FLAT, np.asarray(value, dtype=np.float64))
    try:
        checked = real(field.name, finite, rule=CURVED, remedy=remedy)
    except ValueError:
        raise refuse(field.name, value, CURVED.sentence, remedy) from None
    return np.where(flat, np.inf, checked) if np.ndim(checked) else np.inf


def _flat(value: object) -> Mask:
    """Return where a number or an array of numbers is infinite; False of anything else."""
    if isinstance(value, float):
        return math.isinf(value)
    try:
        array = np.asarray(value)
    except ValueError:  # rows of unequal length
        return False
    known = array.dtype.kind == "f" and not (hasattr(value, "_mask") and np.ma.is_masked(value))
    return np.isinf(array) if known else False


def _curvature_field(*, default: None) -> Any:
    """Return an attrs field for a radius of curvature."""
    converter = attrs.Converter(_radius, takes_field=True)
    metadata = {"unit": "m", "range": CURVED.sentence}
    return attrs.field(default=default, converter=converter, eq=key, metadata=metadata)


@state_arguments
@attrs.frozen(kw_only=True, init=False)
class RigidBody:
    """A body of any shape that is elastic at its contact only.

    Give ``inertia``, or ``principal`` moments with the ``axes`` they belong to. The frame is that
    of the encounter's vectors. Every entry may be a batch.

    Parameters
    ----------
    mass : float or array
        In kg.
    inertia : array, shape (..., 3, 3), optional
        Inertia about the centre of mass, in kg m².
    material : Material
        Elastic material of the surface.
    curvature_radius : float or array, optional
        Radius of curvature of the surface at the contact, in m: ``math.inf`` for a flat surface,
        negative for a hollow one. With ``cross_radius`` the principal radius along
        ``curvature_axis``. A round contact's radius moves duration and force alone, and no velocity
        under elastic laws or a restitution: the default is that of a solid ball of this mass, and
        the plan says so.
    principal : array, shape (..., 3), optional
        Principal moments of inertia, in kg m².
    axes : array, shape (..., 3, 3), optional
        Unit vectors of the principal axes as columns, in the order of ``principal``; those of the
        frame by default.
    cross_radius : float or array, optional
        The other principal radius at the contact, across ``curvature_axis``, in m; by default that
        of all directions, ``curvature_radius``.
    curvature_axis : array, shape (..., 3), optional
        Direction in which ``curvature_radius`` is measured, in the frame of the encounter; its part
        in the tangent plane counts. Needed where the radii differ.
    bending_period : float or array, optional
        Period of the first bending vibration, in s; the plan cautions where the contact does not
        last long beside it.

    Raises
    ------
    ValueError
        If a number is out of range, no body has such an inertia (it is not symmetric, a
        principal moment is not positive or exceeds the sum of the other two), or the radii differ
        without an axis.
    """

    mass: Either = quantity("kg", rule=POSITIVE)
    _inertia: Array | None = _array("kg m²", (3, 3))
    material: Material = instance(Material, remedy=A_MATERIAL)
    curvature_radius: Either = _curvature_field(default=None)
    principal: Array | None = _array("kg m²", (3,))
    axes: Array | None = _array("1", (3, 3))
    cross_radius: Either = _curvature_field(default=None)
    curvature_axis: Array | None = _array("1", (3,))
    bending_period: Either = quantity("s", rule=POSITIVE, default=None, unknown=True)
    #: Inertia about the centre of mass, in kg m², shape (..., 3, 3), also from principal moments.
    inertia: Array = attrs.field(init=False, eq=False, repr=False)
    #: Factors of the inertia.
    _factors: tuple[Real, ...] = attrs.field(init=False, eq=False, repr=False)
    #: Batch shape of mass, inertia and curvature together.
    shape: tuple[int, ...] = attrs.field(init=False, eq=False, repr=False)

    def __init__(
        self,
        *,
        mass: Numbers,
        inertia: Numbers | None = None,
        material: Material,
        curvature_radius: Numbers | None = None,
        principal: Numbers | None = None,
        axes: Numbers | None = None,
        cross_radius: Numbers | None = None,
        curvature_axis: Numbers | None = None,
        bending_period: Numbers | None = None,
    ) -> None: ...

    def __attrs_post_init__(self) -> None:
        if self.curvature_radius is None:
            object.__setattr__(self, "curvature_radius", self._ball_radius())  # it is frozen
        if (self._inertia is None) == (self.principal is None):
            rule = "give one of the two"
            remedy = "inertia=(..., 3, 3), or principal=(..., 3) with axes=(..., 3, 3)"
            if self.principal is not None:
                remedy += "; attrs.evolve keeps the other one unless you give None for it"
            raise refuse("inertia, principal", (self._inertia, self.principal), rule, remedy)
        inertia = self._inertia
        if self.principal is not None:
            axes = np.eye(3) if self.axes is None else self.axes
            product = np.swapaxes(axes, -1, -2) @ axes
            if not np.allclose(product, np.eye(3), rtol=0.0, atol=1e-6):
                raise refuse("axes", self.axes, "columns must be unit vectors at right angles")
            inertia = np.einsum("...ij,...j,...kj->...ik", axes, self.principal, axes)
            inertia.flags.writeable = False
        elif self.axes is not None:
            raise refuse("axes", self.axes, "belong to principal moments", "leave axes out")
        assert inertia is not None  # one of the two was given
        _check_inertia(inertia, "inertia" if self.principal is None else "principal")
        object.__setattr__(self, "inertia", inertia)
        object.__setattr__(self, "_factors", factor(rows(inertia)))
        shapes = {name: np.shape(getattr(self, name)) for name in ("mass", "curvature_radius")}
        if self.cross_radius is not None:
            shapes["cross_radius"] = np.shape(self.cross_radius)
        if self.curvature_axis is not None:
            shapes["curvature_axis"] = self.curvature_axis.shape[:-1]
        shape = common_shape(
            shapes | {"inertia": self.inertia.shape[:-2]},
            what="RigidBody: the batch shapes",
            remedy="give one number or vector, or as many as there are bodies",
        )
        self._check_axis()
        object.__setattr__(self, "shape", shape)

    def _check_axis(self) -> None:
        """Refuse two radii without an axis, and an axis without two radii."""
        axis = self.curvature_axis
        if axis is None and np.any(np.not_equal(self.curvature_radius, self.crossing)):
            rule = "is needed where curvature_radius and cross_radius differ"
            remedy = "give the direction, (3,), in which curvature_radius is measured"
            raise refuse("curvature_axis", axis, rule, remedy)
        if axis is not None and self.cross_radius is None:
            rule = "belongs to two radii of curvature"
            raise refuse("curvature_axis", axis.tolist(), rule, "give cross_radius= too")
        if axis is not None and not axis.any(axis=-1).all():
            raise refuse("curvature_axis", axis.tolist(), "must not be zero")

    def _ball_radius(self) -> Taken:
        """Return the radius in m of a solid ball of this mass, or refuse an impossible radius."""
        remedy = "give it in m"
        if self.cross_radius is not None or self.curvature_axis is not None:
            raise refuse("curvature_radius", None, "is needed beside cross_radius", remedy)
        density = self.material.density
        if not (isinstance(self.mass, float) and isinstance(density, float)):
            rule = "is taken from one mass and one density, which are not there"
            raise refuse("curvature_radius", None, rule, remedy)
        return Taken(math.cbrt(self.mass / density / (4.0 / 3.0 * math.pi)))

    @property
    def crossing(self) -> Either:
        """Radius of curvature across ``curvature_axis``, in m."""
        return self.curvature_radius if self.cross_radius is None else self.cross_radius

    def curvatures(self, t1: Vector, t2: Vector) -> tuple[Real, Real, Complex]:
        """Return both principal curvatures in 1/m, and the direction of the first.

        Parameters
        ----------
        t1, t2 : three floats or arrays
            Components of unit vectors of the tangent plane at right angles.

        Returns
        -------
        tuple
            Curvatures along and across the axis, and the axis as a complex number of size 1, along
            t1 + i t2.

        Raises
        ------
        ValueError
            If the radii differ and ``curvature_axis`` is at right angles to the surface.
        """
        one, other = 1.0 / self.curvature_radius, 1.0 / self.crossing
        if self.curvature_axis is None:
            return one, other, 1.0 + 0.0j
        axis = self.curvature_axis / np.abs(self.curvature_axis).max(axis=-1)[..., None]
        parts = (dot(components(axis), each) for each in (t1, t2))
        seen = next(parts) + 1j * next(parts)
        size = magnitude(seen)
        if some((size < LOST) & (one != other)):
            rule = "is at right angles to the surface: it has no part in the tangent plane"
            remedy = "give the direction in which curvature_radius is measured"
            raise refuse("curvature_axis", self.curvature_axis.tolist(), rule, remedy)
        return one, other, choose(size < LOST, 1.0 + 0.0j, seen / choose(size < LOST, 1.0, size))

    def __repr__(self) -> str:
        """Return the arguments that were given."""
        given = {
            field.alias: getattr(self, field.name)
            for field in attrs.fields(RigidBody)
            if field.init
        }
        told = (f"{name}={value!r}" for name, value in given.items() if value is not None)
        return f"RigidBody({', '.join(told)})"

    def take(self, shape: tuple[int, ...], part: Index) -> RigidBody:
        """Return the bodies of a batch of ``shape`` that ``part`` indexes.

        Parameters
        ----------
        shape : tuple of int
        part : slice, array of bool or int, int or tuple of int
            Index of an array of ``shape``.
        """
        inertia = np.broadcast_to(self.inertia, (*shape, 3, 3))[part]
        entries: dict[str, Any] = {
            name: none_for_nan(take(getattr(self, name), shape, part))
            for name in ("mass", "material", "curvature_radius", "cross_radius", "bending_period")
        }
        if self.curvature_axis is not None:
            entries["curvature_axis"] = np.broadcast_to(self.curvature_axis, (*shape, 3))[part]
        return RigidBody(inertia=inertia, **entries)

    @staticmethod
    def alike(bodies: Sequence[RigidBody]) -> list[RigidBody]:
        """Return bodies with the same entries, ready to be stacked.

        All have their inertia if any has principal moments, and two radii of curvature if any has.

        Parameters
        ----------
        bodies : sequence of RigidBody
        """
        if any(body.principal is not None for body in bodies):
            bodies = [
                attrs.evolve(body, inertia=body.inertia, principal=None, axes=None)
                for body in bodies
            ]
        if all(body.cross_radius is None for body in bodies):
            return list(bodies)
        any_axis = (1.0, 0.0, 0.0)  # says nothing where both radii are one
        return [
            body
            if body.cross_radius is not None and body.curvature_axis is not None
            else attrs.evolve(body, cross_radius=body.crossing, curvature_axis=any_axis)
            for body in bodies
        ]

    def cautions(self, duration: float) -> list[str]:
        """Return a sentence for each doubt about a rigid body.

        Parameters
        ----------
        duration : float
            Duration of the shortest contact, in s.
        """
        cautions = []
        if self.bending_period is not None:
            ratio = float(np.nanmax(self.bending_period)) / duration
            if ratio > RINGING:
                cautions.append(
                    f"model: the body rings, and bending waves carry off energy. Its bending "
                    f"period is {ratio:.3g} of the contact's duration; waves matter above "
                    f"{RINGING}."
                )
        return cautions


def _check_inertia(inertia: Array, given: str) -> None:
    """Refuse an inertia that no body has."""
    largest = np.abs(inertia).max(axis=(-1, -2), initial=0.0)
    skew = np.abs(inertia - np.swapaxes(inertia, -1, -2)).max(axis=(-1, -2), initial=0.0)
    if np.any(skew > ROUNDING * largest):
        raise refuse("inertia", inertia.tolist(), "must be symmetric", "give J and its transpose")
    moments = np.linalg.eigvalsh(inertia)
    least, middle, most = (moments[..., k] for k in range(3))
    floor = np.maximum(SLIGHTEST * most, LEAST_MOMENT)
    if np.all((least >= floor) & (most <= (least + middle) * (1.0 + ROUNDING))):
        return
    if not np.all(least > 0.0):
        rule = "must be positive definite: every principal moment is positive"
    elif not np.all(least >= LEAST_MOMENT):
        rule = f"must have principal moments of at least {LEAST_MOMENT:g} kg m²"
    elif not np.all(least >= floor):
        rule = f"must have principal moments of at least {SLIGHTEST:g} of the largest"
    else:
        rule = "no body has it: a principal moment exceeds the sum of the other two"
    value = moments.tolist() if given == "principal" else inertia.tolist()
    raise refuse(given, value, rule, f"the principal moments are {moments}")
