"""Encounters: two bodies that meet in space, by vectors, and the scene of their impact."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from operator import attrgetter
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.impact.bodies import HalfSpace, Pair, Sphere
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import NON_NEGATIVE, Real, first_of, instance, quantity, refuse
from contactlab.numeric.names import arguments_told
from contactlab.numeric.vectors import (
    LEAST,
    NOTHING,
    components,
    difference,
    moving,
    square_root,
    vector,
)

Array = NDArray[np.float64]

#: Encounters computed at a time: arrays of this length stay in the processor's cache.
TOGETHER = 1 << 14


class Contact(NamedTuple):
    """Directions and speeds at the contact; vectors are tuples of three components.

    Attributes
    ----------
    normal, along : tuple of three arrays
        Unit vectors from the sphere to the target, and along the slip; ``along`` is zero without
        slip.
    approach, slip : array
        Speed of approach, negative where the bodies separate, and speed of slip, in m/s.
    """

    normal: tuple[Any, Any, Any]
    along: tuple[Any, Any, Any]
    approach: Any
    slip: Any


#: Fields of an encounter that are vectors.
VECTORS = ("normal", "velocity", "spin", "target_velocity", "target_spin")
_DIMENSIONS = attrgetter(*(f"{name}.ndim" for name in VECTORS))
#: The bodies of the last single encounter, and their pair.
_last: Any = (None, None, None)


@arguments_told
@attrs.frozen
class Encounter:
    """A sphere and a target at first touch, or a batch of such pairs, by vectors in SI units.

    ::

          sphere      target, a sphere        sphere    target, a half-space
          .----.      .----.                  .----.   |////
         |  +--|--n->|   +  |                |  +--|n->|////      n: normal
          '----'      '----'                  '----'   |////

    Every vector may be an array of shape ``(..., 3)``, every number an array; the encounters are
    then a batch of the broadcast ``shape``. Spins follow the right-hand rule. Friction acts in the
    plane of the normal and the slip, and the slip of spheres stays in this plane.

    Parameters
    ----------
    sphere : Sphere
        The first body.
    target : Sphere or HalfSpace
        The second body.
    friction_coefficient : float or array
        Coulomb's mu, at least 0.
    normal : vector
        From the centre of the sphere towards the target: to the target's centre, or at right
        angles into its surface. Only the direction counts; the length must not be zero.
    velocity, target_velocity : vector
        Velocities of the centres, or of the surface of a half-space, in m/s; by default the
        target is at rest.
    spin, target_spin : vector
        Angular velocities in rad/s; zero by default. A half-space has no spin.

    Raises
    ------
    ValueError
        If a vector has a wrong shape, a number is not finite, the normal has length zero, or a
        half-space has a spin. The message names the argument.
    """

    sphere: Sphere = instance(Sphere, remedy="make one: Sphere(...)")
    target: Sphere | HalfSpace = instance(HalfSpace, Sphere)
    friction_coefficient: Real = quantity("1", rule=NON_NEGATIVE, empty=True)
    normal: Array = vector("1")
    velocity: Array = vector("m/s")
    spin: Array = vector("rad/s", default=NOTHING)
    target_velocity: Array = vector("m/s", default=NOTHING)
    target_spin: Array = vector("rad/s", default=NOTHING)
    #: Batch shape: () for one encounter.
    shape: tuple[int, ...] = attrs.field(init=False, eq=False, repr=False)

    def __attrs_post_init__(self) -> None:
        paths, numbers = _numbers(isinstance(self.target, Sphere))
        values, shape = numbers(self), ()
        if np.ndarray in map(type, values) or max(_DIMENSIONS(self)) > 1:
            shapes = {name: getattr(self, name).shape[:-1] for name in VECTORS}
            shapes |= {
                path.replace(".material", ""): value.shape
                for path, value in zip(paths, values, strict=True)
                if isinstance(value, np.ndarray)
            }
            shape = batch.common_shape(
                shapes,
                what="Encounter: the batch shapes",
                remedy="give one vector, or as many as there are encounters",
            )
        object.__setattr__(self, "shape", shape)
        if isinstance(self.target, HalfSpace) and moving(self.target_spin):
            raise refuse(
                "target_spin",
                self.target_spin,
                "must be zero: a half-space does not spin",
                "give target_velocity, that of its surface at the contact",
            )
        if not shape and math.hypot(*self.normal.tolist()) >= LEAST:
            return
        length2 = np.einsum("...i,...i->...", self.normal, self.normal)
        if not math.sqrt(length2.min(initial=math.inf)) >= LEAST:
            where = np.argwhere(~(np.sqrt(length2) >= LEAST))
            rule = f"must be at least {LEAST:g} long, not zero{first_of(where)}"
            first = self.normal[tuple(where[0])].tolist() if where.size else self.normal.tolist()
            raise refuse("normal", first, rule, "two bodies at one place have no normal")

    def take(self, part: Any) -> Encounter:
        """Return the encounters that ``part`` indexes.

        Parameters
        ----------
        part : slice, array of bool or int, int or tuple of int
            Index of an array of the batch shape.
        """
        taken: Encounter = object.__new__(Encounter)  # every number was checked before
        for name in ("sphere", "target", "friction_coefficient"):
            value = batch.taken(getattr(self, name), self.shape, part)
            object.__setattr__(taken, name, value)
        for name in VECTORS:
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
        global _last  # many encounters of two bodies follow one another
        sphere, target, last = _last
        pair: Pair = last
        if sphere is not self.sphere or target is not self.target:
            pair = Pair.of(self.sphere, self.target)
            if not self.shape:
                _last = self.sphere, self.target, pair
        return pair

    @property
    def approaching(self) -> Any:
        """True where the bodies approach, of the batch shape; below 1e-100 m/s they rest."""
        approach = np.empty(self.shape)
        for where, part in self.parts():
            approach.reshape(-1)[where] = part.contact().approach
        approaching = approach >= LEAST
        return approaching if self.shape else bool(approaching)

    def parts(self) -> Any:
        """Yield (slice, encounters): one-dimensional parts and their places in the flat batch."""
        size = math.prod(self.shape)
        flat = self.take(np.full(self.shape, True)) if len(self.shape) > 1 else self
        for first in range(0, size, TOGETHER):
            where = slice(first, min(first + TOGETHER, size))
            yield where, flat.take(where) if size > TOGETHER else flat

    def contact(self) -> Contact:
        """Return directions and speeds at the contact before the impact.

        The result is a named tuple. ``normal`` and ``along`` are the unit vectors from the sphere
        to the target and along the slip, as three components of the batch shape. ``approach`` and
        ``slip`` are speeds in m/s, of the batch shape.
        """
        n1, n2, n3 = components(self.normal)
        length = square_root(n1 * n1 + n2 * n2 + n3 * n3)
        n1, n2, n3 = n1 / length, n2 / length, n3 / length
        u1, u2, u3 = difference(self.velocity, self.target_velocity)
        approach = u1 * n1 + u2 * n2 + u3 * n3
        w1, w2, w3 = self._rim()
        u1 = u1 + (w2 * n3 - w3 * n2) - approach * n1
        u2 = u2 + (w3 * n1 - w1 * n3) - approach * n2
        u3 = u3 + (w1 * n2 - w2 * n1) - approach * n3
        slip = square_root(u1 * u1 + u2 * u2 + u3 * u3)
        inverse = 1.0 / (slip + (slip == 0.0))
        along = (u1 * inverse, u2 * inverse, u3 * inverse)
        return Contact((n1, n2, n3), along, approach, slip)

    def _rim(self) -> tuple[Any, Any, Any]:
        """Return R1 omega1 + R2 omega2 in m/s, whose cross product with the normal is slip."""
        rim = [self.sphere.radius * component for component in components(self.spin)]
        if isinstance(self.target, Sphere) and moving(self.target_spin):
            radius = self.target.radius
            for k, component in enumerate(components(self.target_spin)):
                rim[k] = rim[k] + radius * component
        return rim[0], rim[1], rim[2]

    @property
    def scene(self) -> Scene:
        """The scene in the plane of friction, relative to a target at rest without spin.

        The tangential velocity is the relative velocity of the centres along the slip. The spin
        is the part of (R1 omega1 + R2 omega2)/R1 that makes slip in this plane. Velocities and
        spins of the results are therefore relative to the target; ``Collision.of`` computes those
        of each body. Without slip the scene is a central impact.

        Raises
        ------
        ValueError
            If bodies separate.
        """
        contact = self.contact()
        if not np.all(contact.approach >= LEAST):
            raise self.separate()
        u = difference(self.velocity, self.target_velocity)
        along = sum(component * axis for component, axis in zip(u, contact.along, strict=True))
        along = np.broadcast_to(along, self.shape)
        spin = (contact.slip - along) / self.sphere.radius
        numbers: list[Any] = [contact.approach, along, spin]
        if not self.shape:
            numbers = [float(number) for number in numbers]
        return Scene(self.sphere, self.target, self.friction_coefficient, *numbers)

    def separate(self) -> ValueError:
        """Return the ValueError for bodies that do not approach each other."""
        approach = np.broadcast_to(self.contact().approach, self.shape)
        where = np.argwhere(~(approach >= LEAST))
        first = tuple(where[0].tolist())
        state = "bodies separate" if approach[first] < 0.0 else "bodies separate, or rest"
        turned = "turn normal from the sphere to the target, or " if approach[first] < 0.0 else ""
        return refuse(
            "velocity, target_velocity",
            float(approach[first]),
            f"{state}: the speed of approach, in m/s, must be positive{first_of(where)}",
            f"{turned}let such pairs pass: collide(encounter, separating='pass')",
        )


@cache
def _numbers(two_spheres: bool) -> tuple[list[str], Callable[[Encounter], Any]]:
    """Return the path of every number of an encounter, and the function that returns them all."""
    paths = ["friction_coefficient"]
    parts: dict[str, Any] = {"sphere": Sphere, "sphere.material": Material}
    parts |= {"target": Sphere if two_spheres else HalfSpace, "target.material": Material}
    for part, kind in parts.items():
        paths += [f"{part}.{one.name}" for one in attrs.fields(kind) if "unit" in one.metadata]
    return paths, attrgetter(*paths)
