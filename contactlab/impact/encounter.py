"""Two bodies that meet in space, by vectors, and the scene in their plane of friction."""

from __future__ import annotations

import math
from functools import cache
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.impact.bodies import HalfSpace, Pair, Sphere
from contactlab.impact.scene import Scene
from contactlab.numeric import arrays as batch
from contactlab.numeric.checks import NON_NEGATIVE, Real, instance, quantity, refuse
from contactlab.numeric.vectors import LEAST, components, difference, first_of, square_root, vector

Array = NDArray[np.float64]

NOTHING = (0.0, 0.0, 0.0)
#: Encounters whose directions are found together: arrays of this length stay in the cache.
TOGETHER = 1 << 14


class Contact(NamedTuple):
    """How the surfaces of both bodies meet; vectors have their components first, (3, encounters).

    Attributes
    ----------
    normal, along : tuple of three arrays
        Unit vectors from the sphere to the target, and of the slip; the latter is zero where there
        is no slip.
    approach, slip : array
        Speeds along the normal, negative where the bodies separate, and of slip, in m/s.
    """

    normal: tuple[Any, Any, Any]
    along: tuple[Any, Any, Any]
    approach: Any
    slip: Any


@attrs.frozen
class Encounter:
    """A sphere and a target as they touch, or a batch of such pairs, by vectors in SI units.

    ::

          sphere      target, a sphere        sphere    target, a half-space
          .----.      .----.                  .----.   |////
         |  +--|--n->|   +  |                |  +--|n->|////      n: normal
          '----'      '----'                  '----'   |////

    Every vector may be an array of shape ``(..., 3)``, every number an array; the encounters are
    then a batch of the broadcast ``shape``. Spins turn by the right-hand rule. Friction acts in the
    plane of the normal and of the slip, and for spheres the motion stays in it.

    Parameters
    ----------
    sphere : Sphere
    target : Sphere or HalfSpace
    friction_coefficient : float or array
        Coulomb's mu, at least 0.
    normal : vector
        From the centre of the sphere towards the target: to the target's centre, or at right
        angles into its surface. Of any length but zero: only the direction counts.
    velocity, target_velocity : vector
        Of the centres (of the surface of a half-space), in m/s; by default the target rests.
    spin, target_spin : vector
        In rad/s; zero by default. A half-space has none.

    Raises
    ------
    ValueError
        With the argument's name: a scalar or another shape where a vector is meant, a number that
        is not finite, a normal of length zero, the spin of a half-space.
    """

    sphere: Sphere = instance(Sphere, remedy="make one: Sphere(...)")
    target: Sphere | HalfSpace = instance(HalfSpace, Sphere)
    friction_coefficient: Real = quantity("1", rule=NON_NEGATIVE)
    normal: Array = vector("1")
    velocity: Array = vector("m/s")
    spin: Array = vector("rad/s", default=NOTHING)
    target_velocity: Array = vector("m/s", default=NOTHING)
    target_spin: Array = vector("rad/s", default=NOTHING)
    #: Batch shape: () for one encounter.
    shape: tuple[int, ...] = attrs.field(init=False, eq=False, repr=False)

    def __attrs_post_init__(self) -> None:
        shapes = {name: value.shape[:-1] for name, value in self._vectors().items()}
        shapes |= {name: getattr(value, "shape", ()) for name, value in self._numbers().items()}
        shape = batch.common_shape(
            shapes,
            what="Encounter: the batch shapes",
            remedy="give one vector, or as many as there are encounters",
        )
        object.__setattr__(self, "shape", shape)
        if isinstance(self.target, HalfSpace) and np.any(self.target_spin):
            raise refuse(
                "target_spin",
                self.target_spin,
                "must be zero: a half-space does not spin",
                "give target_velocity, that of its surface at the contact",
            )
        length2 = np.einsum("...i,...i->...", self.normal, self.normal)
        if not math.sqrt(length2.min()) >= LEAST:
            where = np.argwhere(~(np.sqrt(length2) >= LEAST))
            rule = f"must be at least {LEAST:g} long, not zero{first_of(where)}"
            first = self.normal[tuple(where[0])].tolist() if where.size else self.normal.tolist()
            raise refuse("normal", first, rule, "two bodies at one place have no normal")

    def _vectors(self) -> dict[str, Array]:
        return {name: getattr(self, name) for name in _fields(Encounter, "vector")}

    def _numbers(self) -> dict[str, Real]:
        """Return every number, by name."""
        found = {"friction_coefficient": self.friction_coefficient}
        for name, body in (("sphere", self.sphere), ("target", self.target)):
            material = body.material
            parts: list[Any] = [body, material] if isinstance(body, Sphere) else [material]
            for part in parts:
                kind: Any = type(part)
                for own in _fields(kind, "unit"):
                    if getattr(part, own) is not None:
                        found[f"{name}.{own}"] = getattr(part, own)
        return found

    def take(self, part: Any) -> Encounter:
        """Return some of a batch: a slice, mask or indices, or the index of one.

        Parameters
        ----------
        part : slice, array of bool or int, int or tuple of int
            As numpy indexes an array of the batch shape.
        """
        found: Encounter = object.__new__(Encounter)  # every number was checked before
        for name in ("sphere", "target", "friction_coefficient"):
            value = batch.taken(getattr(self, name), self.shape, part)
            object.__setattr__(found, name, value)
        for name, value in self._vectors().items():
            chosen = value
            if value.ndim > 1:
                chosen = np.broadcast_to(value, (*self.shape, 3))[part]
            object.__setattr__(found, name, chosen)
        one = np.empty(self.shape, dtype=bool)[part] if self.shape else ()
        object.__setattr__(found, "shape", np.shape(one))
        return found

    @property
    def pair(self) -> Pair:
        """What the laws need of the two bodies."""
        return Pair.of(self.sphere, self.target)

    @property
    def approaching(self) -> Any:
        """Whether the bodies come nearer, a bool or an array of them; 1e-100 m/s counts as rest."""
        approach = np.empty(self.shape)
        for where, part in self.parts():
            approach.reshape(-1)[where] = part.contact().approach
        found = approach >= LEAST
        return found if self.shape else bool(found)

    def parts(self) -> Any:
        """Iterate over parts of the batch as one-dimensional batches, and where they belong."""
        size = math.prod(self.shape)
        flat = self.take(np.full(self.shape, True)) if len(self.shape) > 1 else self
        for first in range(0, size, TOGETHER):
            where = slice(first, min(first + TOGETHER, size))
            yield where, flat.take(where) if size > TOGETHER else flat

    def contact(self) -> Contact:
        """Return how the surfaces meet, before the impact; of one encounter or a batch.

        A tuple: ``normal`` and ``along``, the unit vectors from the sphere to the target and of the
        slip, each of three components; ``approach`` and ``slip``, speeds in m/s.
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
        one = 1.0 / (slip + (slip == 0.0))
        return Contact((n1, n2, n3), (u1 * one, u2 * one, u3 * one), approach, slip)

    def _rim(self) -> tuple[Any, Any, Any]:
        """Return R1 omega1 + R2 omega2: its product with the normal is slip by spin, in m/s."""
        parts = [self.sphere.radius * each for each in components(self.spin)]
        if isinstance(self.target, Sphere) and self.target_spin.any():
            other = self.target.radius
            for k, each in enumerate(components(self.target_spin)):
                parts[k] = parts[k] + other * each
        return parts[0], parts[1], parts[2]

    @property
    def scene(self) -> Scene:
        """The scene in the plane of friction, in which the target rests and does not spin.

        Its tangential velocity is that of the centres relative to each other, along the slip;
        its spin is that which alone would make the same slip: (R1 omega1 + R2 omega2)/R1. So the
        velocities and spins of its results are relative to the target; ``Collision.of`` gives each
        body its own. Without slip it is the scene of a central impact.

        Raises
        ------
        ValueError
            If bodies separate.
        """
        contact = self.contact()
        if not np.all(contact.approach >= LEAST):
            raise self.separate()
        u = difference(self.velocity, self.target_velocity)
        along = sum(each * direction for each, direction in zip(u, contact.along, strict=True))
        along = np.broadcast_to(along, self.shape)
        spin = (contact.slip - along) / self.sphere.radius
        numbers: list[Any] = [contact.approach, along, spin]
        if not self.shape:
            numbers = [float(number) for number in numbers]
        return Scene(self.sphere, self.target, self.friction_coefficient, *numbers)

    def separate(self) -> ValueError:
        """Return the refusal of bodies that do not approach each other."""
        approach = np.broadcast_to(self.contact().approach, self.shape)
        where = np.argwhere(~(approach >= LEAST))
        first = tuple(where[0].tolist())
        told = "bodies separate" if approach[first] < 0.0 else "bodies separate, or rest"
        turned = "turn normal from the sphere to the target, or " if approach[first] < 0.0 else ""
        return refuse(
            "velocity, target_velocity",
            float(approach[first]),
            f"{told}: the speed of approach, in m/s, must be positive{first_of(where)}",
            f"{turned}let such pairs pass: collide(encounter, separating='pass')",
        )


@cache
def _fields(kind: Any, word: str) -> tuple[str, ...]:
    """Return names of the fields with this word in their metadata."""
    return tuple(field.name for field in attrs.fields(kind) if word in field.metadata)
