"""Encounters: two bodies that meet in space, by vectors, and the scene of their impact."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import cache, lru_cache
from operator import attrgetter
from typing import Any

import attrs
import numpy as np

from contactlab.impact.bodies import HalfSpace, Pair, Sphere
from contactlab.impact.body_contact import (
    Contact,
    inverse_mass_of,
    meeting_of_bodies,
    scene_of_bodies,
    sides,
    spin_about,
)
from contactlab.impact.material import Material
from contactlab.impact.of_speed import LawOfSlip, OfSlip, friction, is_law_of_slip, law_of_slip
from contactlab.impact.rigid_body import RigidBody
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.arrays import every
from contactlab.numeric.checks import first_of, instance, refuse
from contactlab.numeric.named import NOTHING as UNKNOWN
from contactlab.numeric.names import state_arguments
from contactlab.numeric.types import Array, Index, Mask, Numbers, Real
from contactlab.numeric.vectors import (
    LEAST,
    NOTHING,
    ZERO,
    components,
    cross,
    difference,
    dot,
    moving,
    square_root,
    vector,
)

#: Encounters computed at a time: arrays of this length stay in the processor's cache.
ENCOUNTERS_AT_A_TIME = 1 << 14


#: Fields of an encounter that are vectors.
GIVEN = (
    "normal", "velocity", "spin", "target_velocity", "target_spin", "contact", "target_contact",
)  # fmt: skip
_DIMENSIONS = attrgetter(*(f"{name}.ndim" for name in GIVEN))
#: Pairs of bodies: many encounters of the same two follow one another.
_pair_of = lru_cache(maxsize=16)(Pair.of)


@state_arguments
@attrs.frozen(init=False)
class Encounter:
    """Two bodies at first touch, or a batch of such pairs, by vectors in SI units.

    ::

          sphere      target, a sphere        sphere    target, a half-space
          .----.      .----.                  .----.   |////
         |  +--|--n->|   +  |                |  +--|n->|////      n: normal
          '----'      '----'                  '----'   |////

    Every vector may be an array of shape ``(..., 3)``, every number an array; the encounters are
    then a batch of the broadcast ``shape``. Spins follow the right-hand rule. The slip of spheres
    stays in the plane of normal and slip; that of other bodies may leave it.

    Parameters
    ----------
    body : Sphere or RigidBody
        The first body.
    target : Sphere, HalfSpace or RigidBody
        The second body.
    friction_coefficient : float, array, callable or mapping
        Coulomb's mu, at least 0; as a function or a table of the slip speed before the impact, as
        of a ``Scene``.
    normal : vector
        From the first body into the target, at right angles to both surfaces; between spheres
        from centre to centre. Only the direction counts; the length must not be zero.
    velocity, target_velocity : vector
        Velocities of the centres of mass, or of the surface of a half-space, in m/s; by default the
        target is at rest.
    spin, target_spin : vector
        Angular velocities in rad/s; zero by default. A half-space has no spin.
    contact, target_contact : vector
        From the centre of mass of a ``RigidBody`` to the contact, in m, in the frame of all other
        vectors and of its inertia. A sphere's follows from its radius.
    of_slip : OfSlip, optional
        The function or table of the friction coefficient, as of a ``Scene``.

    Raises
    ------
    ValueError
        If a vector has a wrong shape, a number is not finite, the normal has length zero, or a
        half-space has a spin. The message names the argument.
    """

    body: Sphere | RigidBody = instance(Sphere, RigidBody, remedy="make one: Sphere(...)")
    target: Sphere | HalfSpace | RigidBody = instance(
        HalfSpace, Sphere, RigidBody, remedy="make one: HalfSpace(material)"
    )
    friction_coefficient: Real = friction(empty=True)
    normal: Array = vector("1")
    velocity: Array = vector("m/s")
    spin: Array = vector("rad/s", default=NOTHING)
    target_velocity: Array = vector("m/s", default=NOTHING)
    target_spin: Array = vector("rad/s", default=NOTHING)
    contact: Array = vector("m", default=NOTHING)
    target_contact: Array = vector("m", default=NOTHING)
    #: Friction as a function of slip; None where friction is given by numbers.
    of_slip: OfSlip | None = attrs.field(default=None, eq=False, repr=False, kw_only=True)
    #: Batch shape: () for one encounter.
    shape: tuple[int, ...] = attrs.field(init=False, eq=False, repr=False)

    def __init__(
        self,
        body: Sphere | RigidBody,
        target: Sphere | HalfSpace | RigidBody,
        friction_coefficient: Numbers | LawOfSlip,
        *,
        normal: Numbers,
        velocity: Numbers,
        spin: Numbers = NOTHING,
        target_velocity: Numbers = NOTHING,
        target_spin: Numbers = NOTHING,
        contact: Numbers = NOTHING,
        target_contact: Numbers = NOTHING,
        of_slip: OfSlip | None = None,
    ) -> None: ...

    def __attrs_post_init__(self) -> None:
        paths, numbers = _numbers(*map(type, (self.body, self.target)))
        values = numbers(self)
        shape: tuple[int, ...] = ()
        many = getattr(self.body, "shape", ()) or getattr(self.target, "shape", ())
        more: dict[str, tuple[int, ...]] = {}
        one, other = self.body.material, self.target.material
        if one.properties is not UNKNOWN or other.properties is not UNKNOWN:
            more = _properties(self)
        if many or more or np.ndarray in map(type, values) or max(_DIMENSIONS(self)) > 1:
            shapes = {name: getattr(self, name).shape[:-1] for name in GIVEN} | more
            shapes |= {
                path.replace(".material", ""): value.shape
                for path, value in zip(paths, values, strict=True)
                if isinstance(value, np.ndarray)
            }
            for name in ("body", "target"):
                if isinstance(each := getattr(self, name), RigidBody):
                    shapes[f"{name}.inertia"] = each.shape
            shape = batch.common_shape(
                shapes,
                what="Encounter: the batch shapes",
                remedy="give one vector, or as many as there are encounters",
            )
        object.__setattr__(self, "shape", shape)
        if not self.of_spheres or moving(self.contact) or moving(self.target_contact):
            self._check_contacts()
        if isinstance(self.target, HalfSpace) and moving(self.target_spin):
            raise refuse(
                "target_spin",
                self.target_spin,
                "must be zero: a half-space does not spin",
                "give target_velocity, that of its surface at the contact",
            )
        if shape or not math.hypot(*self.normal.tolist()) >= LEAST:
            self._check_normal()
        mu = self.friction_coefficient
        if self.of_slip is not None or (type(mu) is not float and is_law_of_slip(mu)):
            self._set_friction(shape)

    def _set_friction(self, shape: tuple[int, ...]) -> None:
        """Set the friction that follows from the slip, unless numbers took its place."""
        slip = self.meeting().slip
        if is_law_of_slip(self.friction_coefficient):
            found: OfSlip | None = OfSlip.of(law_of_slip(self.friction_coefficient), slip, shape)
        else:
            found = (
                None
                if self.of_slip is None
                else self.of_slip.at(self.friction_coefficient, slip, shape)
            )
        object.__setattr__(self, "of_slip", found)
        if found is not None:
            object.__setattr__(self, "friction_coefficient", found.numbers)

    def _check_normal(self) -> None:
        """Refuse a normal without length."""
        length2 = np.einsum("...i,...i->...", self.normal, self.normal)
        if not math.sqrt(length2.min(initial=math.inf)) >= LEAST:
            where = np.argwhere(~(np.sqrt(length2) >= LEAST))
            rule = f"must be at least {LEAST:g} long, not zero{first_of(where)}"
            first = self.normal[tuple(where[0])].tolist() if where.size else self.normal.tolist()
            raise refuse("normal", first, rule, "two bodies at one place have no normal")

    @property
    def of_spheres(self) -> bool:
        """True if both bodies are spheres, or the target is a half-space."""
        return isinstance(self.body, Sphere) and not isinstance(self.target, RigidBody)

    def _check_contacts(self) -> None:
        """Refuse a rigid body without contact, and any other body with one."""
        for name, body in (("contact", self.body), ("target_contact", self.target)):
            given = moving(getattr(self, name))
            if given and not isinstance(body, RigidBody):
                rule = f"belongs to a RigidBody, not to a {type(body).__name__}"
                raise refuse(name, getattr(self, name).tolist(), rule, "leave it out")
            if not given and isinstance(body, RigidBody):
                rule = "is needed: the vector in m from the centre of mass to the contact"
                value = getattr(self, name)
                told = None if value is ZERO else value.tolist()
                raise refuse(name, told, rule, f"give {name}=[x, y, z]; shapes have theirs")

    def take(self, part: Index) -> Encounter:
        """Return the encounters that ``part`` indexes.

        Parameters
        ----------
        part : slice, array of bool or int, int or tuple of int
            Index of an array of the batch shape.
        """
        taken: Encounter = object.__new__(Encounter)  # every number was checked before
        for name in ("body", "target", "friction_coefficient", "of_slip"):
            value = getattr(self, name)
            if isinstance(value, RigidBody):
                value = value.take(self.shape, part)
            else:
                value = batch.take(value, self.shape, part)
            object.__setattr__(taken, name, value)
        for name in GIVEN:
            vectors = getattr(self, name)
            if vectors.ndim > 1:
                vectors = np.broadcast_to(vectors, (*self.shape, 3))[part]
            object.__setattr__(taken, name, vectors)
        example = np.empty(self.shape, dtype=bool)[part] if self.shape else ()
        object.__setattr__(taken, "shape", np.shape(example))
        return taken

    @property
    def pair(self) -> Pair:
        """The numbers of the two bodies that laws need."""
        body, target = self.body, self.target
        if isinstance(body, RigidBody) or isinstance(target, RigidBody):
            raise refuse("pair", type(body).__name__, "is that of spheres", "take scene.pair")
        many = self.shape and not type(body.radius) is type(body.mass) is float
        return Pair.of(body, target) if many else _pair_of(body, target)

    @property
    def approaching(self) -> Mask:
        """True where the bodies approach, of the batch shape; below 1e-100 m/s they rest."""
        if not self.shape:
            return self.meeting().approach >= LEAST
        approach = np.empty(self.shape)
        for where, part in self.parts():
            approach.reshape(-1)[where] = part.meeting().approach
        return approach >= LEAST

    def parts(self) -> Iterator[tuple[slice, Encounter]]:
        """Yield (slice, encounters): one-dimensional parts and their places in the flat batch."""
        size = math.prod(self.shape)
        flat = self.take(np.full(self.shape, True)) if len(self.shape) > 1 else self
        for first in range(0, size, ENCOUNTERS_AT_A_TIME):
            where = slice(first, min(first + ENCOUNTERS_AT_A_TIME, size))
            yield where, flat.take(where) if size > ENCOUNTERS_AT_A_TIME else flat

    def meeting(self) -> Contact:
        """Return directions and speeds at the contact before the impact.

        The result is a named tuple. ``normal`` and ``along`` are the unit vectors from the sphere
        to the target and along the slip, as three components of the batch shape. ``approach`` and
        ``slip`` are speeds in m/s, of the batch shape.
        """
        n1, n2, n3 = normal = self.unit_normal()
        if not self.of_spheres:
            return meeting_of_bodies(self, normal)
        u1, u2, u3 = difference(self.velocity, self.target_velocity)
        approach = u1 * n1 + u2 * n2 + u3 * n3
        w1, w2, w3 = self._rim()
        u1 = u1 + (w2 * n3 - w3 * n2) - approach * n1
        u2 = u2 + (w3 * n1 - w1 * n3) - approach * n2
        u3 = u3 + (w1 * n2 - w2 * n1) - approach * n3
        slip = square_root(u1 * u1 + u2 * u2 + u3 * u3)
        inverse = 1.0 / (slip + (slip == 0.0))
        along = (u1 * inverse, u2 * inverse, u3 * inverse)
        return Contact(normal, along, approach, slip)

    def unit_normal(self) -> tuple[Real, Real, Real]:
        """Return the unit normal."""
        n1, n2, n3 = components(self.normal)
        length = square_root(n1 * n1 + n2 * n2 + n3 * n3)
        return n1 / length, n2 / length, n3 / length

    def _rim(self) -> tuple[Real, Real, Real]:
        """Return R1 omega1 + R2 omega2 in m/s, whose cross product with the normal is slip."""
        assert isinstance(self.body, Sphere)
        rim = [self.body.radius * component for component in components(self.spin)]
        if isinstance(self.target, Sphere) and moving(self.target_spin):
            radius = self.target.radius
            for k, component in enumerate(components(self.target_spin)):
                rim[k] = rim[k] + radius * component
        return rim[0], rim[1], rim[2]

    @property
    def scene(self) -> Scene:
        """The scene in the plane of friction, relative to a target at rest without spin.

        Bodies that are no spheres have a scene with an inverse mass where friction changes the
        approach or the slip turns, else a scene of numbers without sphere and target.

        The tangential velocity is the relative velocity of the centres along the slip. The spin
        is the part of (R1 omega1 + R2 omega2)/R1 that makes slip in this plane; the spin about the
        normal is that of the first body over the target. Velocities and
        spins of the results are therefore relative to the target; ``Collision.of`` computes those
        of each body. Without slip the scene is a central impact.

        Raises
        ------
        ValueError
            If bodies separate.
        """
        if not self.of_spheres:
            return scene_of_bodies(self, self.unit_normal())
        contact = self.meeting()
        if not every(contact.approach >= LEAST):
            raise self.separate()
        u = difference(self.velocity, self.target_velocity)
        along = dot(u, contact.along)
        if self.shape:
            along = np.broadcast_to(along, self.shape)
        bodies: tuple[Any, Any] = self.body, self.target
        numbers = contact.approach, along, (contact.slip - along) / bodies[0].radius
        about: dict[str, Any] = {"normal_spin": spin_about(self, contact.normal), "encounter": self}
        about["of_slip"] = self.of_slip
        return Scene(*bodies, self.friction_coefficient, *numbers, **about)

    def separate(self) -> ValueError:
        """Return the ValueError for bodies that do not approach each other."""
        approach = np.broadcast_to(self.meeting().approach, self.shape)
        where = np.argwhere(~(approach >= LEAST))
        first = tuple(where[0].tolist())
        state = "bodies separate" if approach[first] < 0.0 else "bodies separate, or rest"
        least = "must be positive"
        if approach[first] > 0.0:
            state, least = "bodies all but rest", f"must be at least {LEAST:g}"
        if approach[first] == 0.0 and (jam := self._jam(first)):
            rule = f"bodies slide without approach{first_of(where)}, and {jam}"
            remedy = "give an approach of 1e-8 of the slip: the impact is the limit of slow ones"
            return refuse("velocity, target_velocity", 0.0, rule, remedy)
        turned = (
            "turn normal from the first body to the target, or " if approach[first] < 0.0 else ""
        )
        return refuse(
            "velocity, target_velocity",
            float(approach[first]),
            f"{state}: the speed of approach, in m/s, {least}{first_of(where)}",
            f"{turned}let such pairs pass: collide(encounter, separating='pass')",
        )

    def _jam(self, index: tuple[int, ...]) -> str:
        """Return a sentence if friction alone presses sliding bodies together, else nothing."""
        if self.of_spheres:
            return ""
        one = self.take(index)
        contact = one.meeting()
        axes = *contact[:2], cross(*contact[:2])
        (pressed, coupling, _), *_ = inverse_mass_of(sides(one, contact.normal), axes)
        lam = one.friction_coefficient * coupling / pressed
        if lam >= -1.0 or not contact.slip:
            return ""
        return f"friction presses them together, lambda = {lam:.3g} below -1 (Painlevé)"


def _properties(encounter: Encounter) -> dict[str, tuple[int, ...]]:
    """Return the batch shapes of the properties of both materials that are arrays, by name."""
    return {
        f"{name}.properties[{heading!r}]": number.shape
        for name in ("body", "target")
        for heading, number in getattr(encounter, name).material.properties.items()
        if isinstance(number, np.ndarray)
    }


@cache
def _numbers(body: type, target: type) -> tuple[list[str], Callable[[Encounter], Any]]:
    """Return the path of every number of an encounter, and the function that returns them all."""
    paths = ["friction_coefficient"]
    parts: dict[str, Any] = {"body": body, "body.material": Material}
    parts |= {"target": target, "target.material": Material}
    for part, kind in parts.items():
        numbers = [one for one in attrs.fields(kind) if "rule" in one.metadata]
        paths += [f"{part}.{one.name}" for one in numbers]
    return paths, attrgetter(*paths)
