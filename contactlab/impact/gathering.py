"""Gatherings: bodies that meet at several contacts at once, by vectors (theory §18)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

import attrs
import numpy as np

from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.gathering_scene import Assembly
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.impact.touching_spheres import touches_of_spheres
from contactlab.numeric.arrays import common_shape
from contactlab.numeric.checks import NON_NEGATIVE, Rule, instance, of_kind, quantity, real, refuse
from contactlab.numeric.names import state_arguments
from contactlab.numeric.types import Array, Numbers, Real
from contactlab.numeric.vectors import NOTHING, vector

#: e of a contact: below this no step can follow.
RESTITUTION = Rule(
    lambda value: (value >= 0.01) & (value <= 1.0),
    "must be from 0.01 to 1: rebound over approach velocity of this contact alone",
)
#: Difference of normals, and distance of contacts over the arms, up to which two contacts are one.
SAME = 1e-9
#: Gap over the sum of radii by which positions may differ from what is given: gaps count in
#: micrometres, and positions are rounded.
ROUGHLY = 0.1


@state_arguments
@attrs.frozen(init=False)
class Body:
    """A body of a ``Gathering``, and its motion when the first bodies touch.

    Every vector may be an array of shape ``(..., 3)``.

    Parameters
    ----------
    shape : Sphere or RigidBody
    velocity, spin : vector
        Velocity of the centre of mass in m/s, and spin in rad/s; at rest by default.
    force : vector
        A constant force at the centre of mass in N, such as the weight; none by default.
    position : vector, optional
        Centre of mass in m. Normals and gaps are checked by it; ``Gathering.of_spheres`` needs it.

    Raises
    ------
    ValueError
        If a vector has a wrong shape or a number is not finite. The message names the argument.
    """

    shape: Sphere | RigidBody = instance(
        Sphere, RigidBody, remedy="make one: Sphere(...), or shapes.box(...).body"
    )
    velocity: Array = vector("m/s", default=NOTHING)
    spin: Array = vector("rad/s", default=NOTHING)
    force: Array = vector("N", default=NOTHING)
    position: Array | None = vector("m", default=None)

    def __init__(
        self,
        shape: Sphere | RigidBody,
        *,
        velocity: Numbers = NOTHING,
        spin: Numbers = NOTHING,
        force: Numbers = NOTHING,
        position: Numbers | None = None,
    ) -> None: ...


@state_arguments
@attrs.frozen(init=False)
class Touch:
    """A contact of a ``Gathering``, open or closed when the first bodies touch.

    Every number may be an array of the batch shape, every vector one of shape ``(..., 3)``.

    Parameters
    ----------
    first : int or str
        Place or name of the first body.
    second : int, str or HalfSpace
        Place or name of the second body, or a half-space.
    friction_coefficient : float or array
        Coulomb's mu, at least 0.
    normal : vector
        From the first body into the second; only the direction counts.
    gap : float or array
        Distance between the surfaces at the start, in m; 0 if they touch.
    contact, target_contact : vector
        From the centre of mass of a ``RigidBody`` to the contact, in m, of first and second.
    target_velocity : vector
        Velocity in m/s of the surface of a half-space.
    restitution : float or array
        e of this contact alone at the gathering's largest speed of approach, from 0.01 to 1, on the
        mass 1/W_nn and by ``normal.viscoelastic``.
    loaded : bool
        True if the contact carries the constant forces when the impact begins.

    Raises
    ------
    ValueError
        If a number is out of range. The message names the argument.
    """

    first: int | str
    second: int | str | HalfSpace
    friction_coefficient: Real = quantity("1", rule=NON_NEGATIVE)
    normal: Array = vector("1")
    gap: Real = quantity("m", rule=NON_NEGATIVE, default=0.0, kw_only=True)
    contact: Array = vector("m", default=NOTHING)
    target_contact: Array = vector("m", default=NOTHING)
    target_velocity: Array = vector("m/s", default=NOTHING)
    restitution: Real = quantity("1", rule=RESTITUTION, default=1.0, kw_only=True)
    loaded: bool = instance(bool, default=False, kw_only=True, remedy="give True or False")

    def __init__(
        self,
        first: int | str,
        second: int | str | HalfSpace,
        friction_coefficient: Numbers,
        *,
        normal: Numbers,
        gap: Numbers = 0.0,
        contact: Numbers = NOTHING,
        target_contact: Numbers = NOTHING,
        target_velocity: Numbers = NOTHING,
        restitution: Numbers = 1.0,
        loaded: bool = False,
    ) -> None: ...


@state_arguments
@attrs.frozen(init=False, eq=False)
class Gathering:
    """Bodies that meet at several contacts at once, or a batch of such meetings (theory §18).

    ``collide`` answers it. A batch has one topology: the same bodies touch at the same contacts,
    and vectors and numbers are arrays of the broadcast ``shape``.

    Parameters
    ----------
    bodies : mapping of str to Body, or sequence of Body
    touches : sequence of Touch
        The contacts, open or closed; each names its bodies by place or name.

    Attributes
    ----------
    names : tuple of str
        Names of the bodies; empty for a sequence.
    places : tuple of (int, int or None)
        Places of first and second body of each contact; None is a half-space.
    shape : tuple of int
        Batch shape: () for one gathering.

    Raises
    ------
    ValueError
        If a contact names no body, a body touches itself, two contacts are one, a normal points
        away from the second body, shapes do not broadcast, or a load is undetermined. The message
        names the contact.
    """

    #: The argument, which attrs.evolve passes on.
    _given: Mapping[str, Body] | Sequence[Body] = attrs.field(alias="bodies", repr=False)
    bodies: tuple[Body, ...] = attrs.field(init=False)
    touches: tuple[Touch, ...]
    names: tuple[str, ...] = attrs.field(init=False)
    places: tuple[tuple[int, int | None], ...] = attrs.field(init=False, repr=False)
    shape: tuple[int, ...] = attrs.field(init=False, repr=False)
    _alone: tuple[Encounter, ...] = attrs.field(init=False, repr=False)

    def __init__(
        self, bodies: Mapping[str, Body] | Sequence[Body], touches: Sequence[Touch]
    ) -> None: ...

    def __attrs_post_init__(self) -> None:
        given = self._given
        names = tuple(given) if isinstance(given, Mapping) else ()
        for name in names:
            of_kind("bodies: name", name, str, remedy="give bodies by place as a list")
        bodies = (
            tuple(given.values())
            if isinstance(given, Mapping) and given
            else _as_tuple("bodies", given)
        )
        touches = _as_tuple("touches", self.touches)
        for place, each in zip(names or range(len(bodies)), bodies, strict=True):
            of_kind(f"bodies[{place!r}]", each, Body, remedy="make one: Body(Sphere(...))")
        for k, touch in enumerate(touches):
            of_kind(f"touches[{k}]", touch, Touch, remedy="make one: Touch(0, 1, 0.2, normal=...)")
        for name, value in (("bodies", bodies), ("names", names), ("touches", touches)):
            object.__setattr__(self, name, value)
        places = tuple(
            (self._place(k, "first"), self._place(k, "second")) for k in range(len(touches))
        )
        object.__setattr__(self, "places", places)
        object.__setattr__(self, "shape", self._common_shape())
        self._check_pairs()
        self._check_load()

    def _place(self, contact: int, side: str) -> int | None:
        """Return the place of a body of a contact; None of a half-space."""
        named = getattr(self.touches[contact], side)
        argument = f"touches[{contact}].{side}"
        if isinstance(named, HalfSpace):
            if side == "second":
                return None
            rule = "must be a body that moves, not a half-space"
            remedy = "turn the normal, and name the half-space second"
            if isinstance(self.touches[contact].second, HalfSpace):
                remedy = "two half-spaces do not meet: name a body"
            raise refuse(argument, named, rule, remedy)
        if isinstance(named, str) and named in self.names:
            return self.names.index(named)
        number = isinstance(named, int | np.integer) and not isinstance(named, bool)
        if number and 0 <= named < len(self.bodies):
            return int(named)
        known = ", ".join(map(repr, self.names)) if self.names else f"0 to {len(self.bodies) - 1}"
        rule = "must be the place or name of one body"
        raise refuse(argument, named, rule, f"there are {known}; all of a batch have one topology")

    def _common_shape(self) -> tuple[int, ...]:
        """Return the batch shape, or refuse shapes that do not broadcast."""
        shapes: dict[str, tuple[int, ...]] = {}
        alone = []
        for name, body in zip(self.names or range(len(self.bodies)), self.bodies, strict=True):
            for entry in ("velocity", "spin", "force", "position"):
                if (value := getattr(body, entry)) is not None:
                    shapes[f"bodies[{name!r}].{entry}"] = value.shape[:-1]
        for k, touch in enumerate(self.touches):
            for entry in ("gap", "restitution"):
                shapes[f"touches[{k}].{entry}"] = np.shape(getattr(touch, entry))
            try:
                alone.append(self._make_alone(k))
            except ValueError as error:
                raise ValueError(f"touches[{k}]: {error}") from None
            shapes[f"touches[{k}]"] = alone[k].shape
        object.__setattr__(self, "_alone", tuple(alone))
        remedy = "give one number or vector, or as many as there are gatherings"
        return common_shape(shapes, what="Gathering: the batch shapes", remedy=remedy)

    def alone(self, contact: int) -> Encounter:
        """Return the encounter of the two bodies of a contact, as if it were alone.

        Parameters
        ----------
        contact : int
            Place of the contact among ``touches``.
        """
        return self._alone[contact]

    def _make_alone(self, contact: int) -> Encounter:
        """Return the encounter that ``alone`` returns."""
        touch, (place, other) = self.touches[contact], self.places[contact]
        one, two = self.bodies[place], None if other is None else self.bodies[other]
        target = touch.second if two is None else two.shape
        assert not isinstance(target, int | str)  # its place says so
        return Encounter(
            one.shape,
            target,
            touch.friction_coefficient,
            normal=touch.normal,
            velocity=one.velocity,
            spin=one.spin,
            target_velocity=touch.target_velocity if two is None else two.velocity,
            target_spin=NOTHING if two is None else two.spin,
            contact=touch.contact,
            target_contact=touch.target_contact,
        )

    def _check_pairs(self) -> None:
        """Refuse contacts of a body with itself, one contact given twice, and a turned normal."""
        for k, (touch, (first, second)) in enumerate(zip(self.touches, self.places, strict=True)):
            if first == second:
                rule = "a body does not touch itself"
                raise refuse(f"touches[{k}].second", touch.second, rule, "name another body")
            if second is not None and touch.target_velocity.any():
                rule = "belongs to a half-space"
                remedy = f"give the velocity of bodies[{touch.second!r}]"
                raise refuse(f"touches[{k}].target_velocity", touch.target_velocity, rule, remedy)
            if second is not None:
                self._check_normal(k, first, second)
            for j in range(k):
                if self._is_same(j, k):
                    rule = f"is touches[{j}] given twice"
                    raise refuse(f"touches[{k}]", (touch.first, touch.second), rule, "leave it out")

    def _check_normal(self, contact: int, first: int, second: int) -> None:
        """Refuse a normal from the second sphere to the first, or a gap, against positions."""
        one, other = self.bodies[first], self.bodies[second]
        if one.position is None or other.position is None:
            return
        if not (isinstance(one.shape, Sphere) and isinstance(other.shape, Sphere)):
            return
        touch, apart = self.touches[contact], other.position - one.position
        if not np.all((apart * touch.normal).sum(axis=-1) > 0.0):
            rule = (
                f"must point from {touch.first!r} to {touch.second!r}, and their positions do not"
            )
            raise refuse(f"touches[{contact}].normal", touch.normal.tolist(), rule, "turn it")
        radii: Real = one.shape.radius + other.shape.radius
        gap = np.linalg.norm(apart, axis=-1) - radii
        if not np.all(np.abs(gap - touch.gap) <= ROUGHLY * radii):
            rule = (
                f"must be that of the positions, {np.ravel(gap)[0]:.3g} m, to a tenth of the radii"
            )
            remedy = "positions are of centres, in m; or leave positions out"
            raise refuse(f"touches[{contact}].gap", touch.gap, rule, remedy)

    def _is_same(self, one: int, other: int) -> bool:
        """Return whether two contacts are one: of the same bodies, at one point."""
        pairs = [{*self.places[k]} for k in (one, other)]
        if pairs[0] != pairs[1]:
            return False
        a, b = self.touches[one], self.touches[other]
        turned = -1.0 if self.places[one] != self.places[other] else 1.0
        units = [each.normal / np.linalg.norm(each.normal, axis=-1)[..., None] for each in (a, b)]
        along = (units[0] * units[1]).sum(axis=-1) * turned
        arms = (a.contact, b.contact if turned > 0.0 else b.target_contact)
        apart = np.linalg.norm(arms[0] - arms[1], axis=-1)
        near = apart <= SAME * np.linalg.norm(arms[0], axis=-1)
        return bool(np.any((along > 1.0 - SAME) & near))

    def _check_load(self) -> None:
        """Refuse loads without a force, and loads that statics does not determine."""
        loaded: dict[int, int] = {}
        for k, touch in enumerate(self.touches):
            if not touch.loaded:
                continue
            argument = f"touches[{k}].loaded"
            if np.any(np.asarray(touch.gap) > 0.0):
                raise refuse(argument, True, "an open contact carries nothing", "give gap=0")
            for place in self.places[k]:
                if place is None:
                    continue
                if place in loaded:
                    rule = f"touches[{loaded[place]}] carries the same body: statics does not tell "
                    rule += "how much each"
                    raise refuse(argument, True, rule, "load one contact of a body")
                loaded[place] = k

    @classmethod
    def of_spheres(
        cls,
        bodies: Mapping[str, Body] | Sequence[Body],
        *,
        friction_coefficient: Numbers,
        restitution: Numbers = 1.0,
        walls: Sequence[tuple[HalfSpace, Numbers, Numbers]] = (),
        reach: float,
    ) -> Gathering:
        """Return the gathering of spheres by their positions: contacts, normals and gaps follow.

        Parameters
        ----------
        bodies : mapping of str to Body, or sequence of Body
            Spheres, each with a ``position``.
        friction_coefficient, restitution : float or array
            Coefficients of every contact.
        walls : sequence of (HalfSpace, point, normal)
            A point of the surface in m, and the normal into the half-space.
        reach : float
            Gaps up to this distance in m are contacts that may close.

        Raises
        ------
        ValueError
            If a body is no sphere or has no position, spheres overlap, or nothing is in reach.
        """
        found = touches_of_spheres(bodies, walls, real("reach", reach, rule=NON_NEGATIVE))
        made = [
            Touch(
                first,
                second,
                friction_coefficient,
                normal=normal,
                gap=gap,
                restitution=restitution,
            )
            for first, second, normal, gap in found
        ]
        if not made:
            rule = "no two surfaces are so near"
            raise refuse("reach", reach, rule, "give a longer one, or positions that touch")
        return cls(bodies, made)

    @cached_property
    def assembly(self) -> Assembly:
        """Frames, W and the motion of the contacts, as one axis of gatherings."""
        return Assembly(self)

    @property
    def scene(self) -> Scene:
        """The scene of all contacts, shape (gatherings, C), which ``collide`` alone answers.

        A batch is one flat axis, of length 1 for one gathering.

        Raises
        ------
        ValueError
            If nothing approaches, or a load lifts its contact.
        """
        return self.assembly.scene()


def _as_tuple(name: str, value: object) -> tuple[Any, ...]:
    """Return a sequence as a tuple; refuse an empty one and other objects."""
    if isinstance(value, str | bytes) or not isinstance(value, Sequence):
        raise refuse(name, value, f"must be a list of {name}", f"give {name}=[...]")
    if not len(value):
        raise refuse(name, value, "must hold at least one", f"give {name}=[...]")
    return tuple(value)
