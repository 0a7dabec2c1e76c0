"""The outcome of an encounter of two bodies in space: velocities, spins and the impulse."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Mapping
from functools import cached_property
from typing import TYPE_CHECKING, Any, ClassVar, Generic

import attrs
import numpy as np

from contactlab.collisions import impulses
from contactlab.collisions.collision_plan import collision_plan
from contactlab.collisions.restituted import plan_rebounds, run_by_restitution
from contactlab.collisions.velocities import Velocities, velocities
from contactlab.contracts.status import Details, Status, Statuses, Word
from contactlab.impact import kinetics
from contactlab.impact.bodies import HalfSpace, Sphere
from contactlab.impact.body_contact import in_space, push_bodies
from contactlab.impact.encounter import Encounter
from contactlab.impact.rigid_body import RigidBody
from contactlab.numeric.arrays import every, fill, of_each, plain, spread_object, take
from contactlab.numeric.checks import of_kind, refuse
from contactlab.numeric.names import tell_attributes
from contactlab.numeric.types import Array, Each, Json, Labelled, Mask, Numbers, Real, Vector
from contactlab.numeric.vectors import NOTHING, components, cross, join_components
from contactlab.outcome.answer import Answer
from contactlab.outcome.columns import components as parts_of
from contactlab.outcome.columns import json_value
from contactlab.outcome.energy import EnergyLedger, books
from contactlab.outcome.plan import Plan, PlanColumns
from contactlab.outcome.result import ImpactResult
from contactlab.outcome.sheet import (
    MOST_TOLD,
    Sheet,
    along_axes,
    batch_axes,
    moving,
    names_of,
)
from contactlab.runs.simulation import Simulation

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from numpy.typing import NDArray

    from contactlab.outcome.style import Width

#: Vectors after a collision, name and unit.
VECTORS_AFTER = (
    ("velocity", "m/s"), ("spin", "rad/s"), ("target_velocity", "m/s"), ("target_spin", "rad/s"),
    ("impulse", "N s"), ("contact_velocity", "m/s"), ("target_contact_velocity", "m/s"),
)  # fmt: skip
#: Numbers after a collision, by name and unit.
NUMBERS_AFTER = (
    ("normal_velocity", "m/s"), ("slip_velocity_change", "m/s"), ("friction_work", "J"),
    ("collided", ""),
)  # fmt: skip


@tell_attributes
@attrs.frozen(kw_only=True, eq=False, repr=False, slots=False)
class Collision(Answer, Generic[Each]):
    """Both bodies after an encounter; vectors have the shape ``(..., 3)``, numbers the batch's.

    To type checkers numbers are as of an ``ImpactResult``: floats of ``Collision[float]``, arrays
    of ``Collision[Array]``, and either of ``collide``, as encounters are one or a batch by their
    arrays. ``collided`` and ``status`` are ``Any``: those of one, or an array of them.

    Attributes
    ----------
    encounter : Encounter
    velocity, target_velocity : ndarray
        Velocities of the centres of mass, in m/s. A half-space keeps its velocity.
    spin, target_spin : ndarray
        In rad/s. Friction of spin about the normal needs a law that answers it, such as
        ``tangential.halfspace``, and bodies whose centre is on the normal; else that spin does not
        change, and the plan tells how far it would, and how far it would move slip.
    normal_velocity : float or array
        Rate of approach of the contact points after the impact, in m/s; negative: they part.
    slip_velocity_change : float or array
        Change of the slip velocity in m/s: in the direction of the slip before; between bodies that
        are no spheres as ``result.motion`` has it.
    friction_work : float or array
        In J. For spheres with a restitution it includes the loss in shear; a ``Simulation`` tells
        the two apart.
    collided : bool or array of bool
        False if the bodies were separating and passed through untouched.
    restitution : float or array
        e of the normal motion given to ``contactlab.rebound``; 1 with a simulation.
    simulation : Simulation or None
        The laws; None for ``contactlab.rebound``.
    known : ImpactResult or None
        The result of the encounters that collided; None where ``contactlab.rebound`` answered.
    """

    #: Objects whose attributes users look for on a collision, by name.
    _within: ClassVar[Mapping[str, type]] = {"result": ImpactResult}
    encounter: Encounter
    velocity: Array
    spin: Array
    target_velocity: Array
    target_spin: Array
    normal_velocity: Each
    slip_velocity_change: Real
    friction_work: Each
    collided: Mask
    restitution: Real = 1.0
    simulation: Simulation | None = None
    known: ImpactResult | None = None

    @classmethod
    def of(cls, encounter: Encounter, result: ImpactResult) -> Collision:
        """Return the collision of ``encounter`` by a result of its scene.

        Parameters
        ----------
        encounter : Encounter
        result : ImpactResult
            The result of ``encounter.scene``, of those encounters whose bodies approach.

        Raises
        ------
        ValueError
            If the result has another scene.
        """
        met = encounter.approaching
        part = encounter if np.all(met) else encounter.take(met)
        rule = "must be the result of encounter.scene"
        remedy = "run that: simulation.run(encounter.scene)"
        if of_kind("result", result, ImpactResult, rule=rule, remedy=remedy).scene != part.scene:
            raise refuse("result", result, rule, remedy)
        return cls.by(encounter, result, met)

    @classmethod
    def by(cls, encounter: Encounter, result: ImpactResult, met: Mask, **about: Any) -> Collision:
        """Return the collision of ``encounter`` by the result of the encounters that ``met``.

        Parameters
        ----------
        encounter : Encounter
        result : ImpactResult
        met : bool or array of bool
            True where the bodies approach.
        **about
            ``simulation`` and ``restitution`` of the collision.
        """
        if encounter.of_spheres:
            motion = result.motion
            told = motion.normal_velocity, motion.slip_velocity_change, motion.friction_work
            moved = impulses.strike(encounter, _columns(encounter, met, *told).reshape(3, -1))
            if kinetics.turns(result.scene):
                (change,) = _columns(encounter, met, motion.normal_spin_change)
                moved = impulses.turn_bodies(encounter, moved, change)
        else:
            moved = _attributes(encounter, result, met)
        entries = {"encounter": encounter, "restitution": 1.0, "simulation": None, "known": result}
        return fill(cls, entries | moved | about)

    @staticmethod
    def of_arrays(
        body: Sphere,
        target: Sphere | HalfSpace,
        friction_coefficient: Numbers | Labelled,
        *,
        normal: Numbers | Labelled,
        velocity: Numbers | Labelled,
        spin: Numbers | Labelled = NOTHING,
        target_velocity: Numbers | Labelled = NOTHING,
        target_spin: Numbers | Labelled = NOTHING,
        restitution: Numbers | Labelled | Callable[..., object] = 1.0,
    ) -> Velocities:
        """Return velocities and spins after impacts of spheres, as arrays of JAX or PyTorch.

        This is ``collide`` for arrays that may be traced: it can be compiled and differentiated, by
        jit, vmap and grad.

        Parameters
        ----------
        body : Sphere
        target : Sphere or HalfSpace
        friction_coefficient : float or array
            Coulomb's mu, at least 0.
        normal, velocity, spin, target_velocity, target_spin : array, shape (..., 3)
            As of ``Encounter``; lists, and arrays of NumPy, may stand beside arrays of JAX or
            PyTorch.
        restitution : float, array of shape (...,), or callable
            As of ``collide``.

        Returns
        -------
        Velocities
            A named tuple of both bodies. Where they separate they pass through untouched, and a
            half-space keeps its velocity. psi2 is that of ``rebound`` with such arrays, 3e-10 from
            NumPy's; it is NaN where a traced number is out of range.

        Raises
        ------
        ValueError
            For bad input whose numbers are known, with the argument, its value, the rule and the
            remedy; also where chi of the bodies is out of the table, and if no array is of JAX or
            PyTorch.
        """
        vectors = {
            "normal": normal,
            "velocity": velocity,
            "spin": spin,
            "target_velocity": target_velocity,
            "target_spin": target_spin,
        }
        return velocities(body, target, friction_coefficient, vectors, restitution)

    @cached_property
    def result(self) -> ImpactResult:
        """The impacts in their planes of friction: one for each encounter that collided, in order.

        If the collision came from ``contactlab.rebound``, the impacts are run now, by the law that
        gives the same answers.
        """
        if self.known is not None:
            return self.known
        return run_by_restitution(self._hits.scene, self._restitutions)

    @cached_property
    def plan(self) -> Plan:
        """The plan of the collision: what is computed, what is left out, and the cautions."""
        passed = ~np.asarray(self.collided)
        if passed.all():
            return collision_plan(Plan(PlanColumns.nothing(passed.shape)), None, passed)
        met = self._hits
        known, e = self.known, self._restitutions
        plan = plan_rebounds(met.scene, e) if known is None else known.plan
        return collision_plan(plan, met, passed)

    @property
    def _restitutions(self) -> Real:
        """The restitution of each encounter that collided, or a number that all share."""
        met = ... if np.all(self.collided) else self.collided
        restitutions: Real = take(self.restitution, self.encounter.shape, met)
        return restitutions

    @property
    def energy(self) -> EnergyLedger[Each]:
        """The energy books of the relative motion, in J; its loss is the loss of both bodies.

        All entries are 0 for bodies that are no spheres and passed through.
        """
        if not self.encounter.of_spheres:
            return self._energy_of_bodies()
        known, contact = self.known, self.encounter.meeting()
        told: tuple[Any, ...] = (0.0, 0.0, True)
        if known is not None:
            unchecked = np.logical_not(known.energy.checked)
            told = known.motion.exchange, known.motion.shear_loss, unchecked
        exchange, shear, unread = self._spread(*told)
        after = self.normal_velocity, self.slip_velocity_change
        with np.errstate(over="ignore", under="ignore", invalid="ignore"):
            start, lost, slip = self.encounter.pair.energies(contact.approach, contact.slip, *after)
            if np.any(self.collided) and kinetics.turns(scene := self._hits.scene):
                change = 0.0 if known is None else known.motion.normal_spin_change
                whole, rubbed = self._spread(*kinetics.spin_energies(scene, change))
                start, slip = start + whole, slip + rubbed
            energies = of_each(start, self.encounter.shape), lost, slip
            return books(energies, (self.friction_work, shear), exchange, unread == 0.0)

    def _spread(self, *quantities: Real | Mask) -> list[Real]:
        """Return quantities of all encounters, 0 for those without a collision."""
        return [plain(row) for row in _columns(self.encounter, self.collided, *quantities)]

    def _energy_of_bodies(self) -> EnergyLedger:
        """Return the books of the impacts, spread over the encounters."""
        if self.known is not None and np.all(self.collided):
            return self.known.energy
        names = ("start", "end", "normal_loss", "friction_work", "shear_loss", "imbalance")
        told: dict[str, Any] = dict.fromkeys(names, 0.0)
        unchecked: Mask = False
        if self.known is not None:
            books = self.known.energy
            told = {name: getattr(books, name) for name in names}
            unchecked = np.logical_not(books.checked)
        *entries, unread = self._spread(*told.values(), unchecked)
        return EnergyLedger(**dict(zip(names, entries, strict=True)), checked=unread == 0.0)

    @property
    def impulse(self) -> Array:
        """Impulse on the first body, in N s; the target receives the opposite impulse."""
        shape = self.encounter.shape
        if not self.encounter.of_spheres:
            impulse = np.zeros((*shape, 3))
            if self.known is not None:
                axes = self.known.scene.frame
                assert axes is not None
                impulse[self.collided] = -in_space(axes, self.known.impulse)
            return impulse
        contact, pair = self.encounter.meeting(), self.encounter.pair
        push: Real = pair.normal_mass * (self.normal_velocity - contact.approach)
        drag: Real = pair.tangential_mass * self.slip_velocity_change
        parts = zip(contact.normal, contact.along, strict=True)
        return np.stack([np.broadcast_to(push * n + drag * t, shape) for n, t in parts], axis=-1)

    @property
    def contact_velocity(self) -> Array:
        """Velocity of the first body's surface at the contact after the impact, in m/s."""
        return self.velocity + self._rim(0, self.encounter.body, self.spin)

    @property
    def target_contact_velocity(self) -> Array:
        """Velocity of the target's surface at the contact after the impact, in m/s."""
        return self.target_velocity + self._rim(1, self.encounter.target, self.target_spin)

    def _rim(self, side: int, body: Sphere | HalfSpace | RigidBody, spin: Array) -> Array:
        """Return the velocity in m/s, relative to the centre, of the surface at the contact."""
        encounter = self.encounter
        arm: Vector = components(encounter.target_contact if side else encounter.contact)
        if isinstance(body, Sphere):
            radius = -body.radius if side else body.radius
            arm = [radius * each for each in encounter.meeting().normal]
        return join_components(cross(components(spin), arm), encounter.shape)

    @property
    def _hits(self) -> Encounter:
        """The encounters that collided."""
        if np.all(self.collided):
            return self.encounter
        if not np.any(self.collided):
            raise refuse("encounter", self.encounter, "no bodies met: all separate")
        return self.encounter.take(self.collided)

    def __repr__(self) -> str:
        """Return velocity and spin of a single collision, or the count in a batch, and statuses."""
        statuses = np.ravel(np.array(self.status, dtype=object))
        outcome = ", ".join(sorted({status.name for status in statuses}))
        if self.encounter.shape:
            count = f"{int(np.sum(self.collided))} of {np.size(self.collided)}"
            return f"Collision({count} encounters collided; {outcome})"
        outcome = outcome if self.collided else "separate, passed through"
        return f"Collision(velocity={self.velocity}, spin={self.spin}; {outcome})"

    def _first_lines(self) -> list[str]:
        """Return ``repr``, and how the bodies move, of a batch in its first encounters."""
        shape, both = self.encounter.shape, not isinstance(self.encounter.target, HalfSpace)
        lines = [repr(self)]
        if not shape and not both:
            return lines  # the failure is told
        for index in itertools.islice(np.ndindex(shape), MOST_TOLD):
            where = f"encounter {', '.join(map(str, index))}, " if shape else ""
            lines.append(moving(f"{where}body", self.velocity[index], self.spin[index]))
            if both:
                motion = self.target_velocity[index], self.target_spin[index]
                lines.append(moving(f"{where}target", *motion))
        if (more := math.prod(shape) - MOST_TOLD) > 0:
            lines.append(f"  ... and {more} more: to_dataframe()")
        return lines

    def _statuses(self) -> tuple[Statuses, Details]:
        if self.known is None:
            return Status.SUCCESS, ""
        statuses, details = self.known._statuses()
        return self._of_encounters(Status.SUCCESS, statuses), self._of_encounters("", details)

    def _of_encounters(
        self, passed: Word, collided: Word | NDArray[np.object_]
    ) -> Word | NDArray[np.object_]:
        """Return words of each encounter: ``collided`` in order, ``passed`` of the others."""
        if np.all(self.collided):
            return collided
        each = np.full(self.encounter.shape, passed, dtype=object)
        each[self.collided] = collided
        return each

    @property
    def status(self) -> Statuses:
        """A ``Status``, or an array of statuses; ``SUCCESS`` if the bodies passed through."""
        if self.known is None:
            return spread_object(Status.SUCCESS, self.encounter.shape)
        return self._statuses()[0]

    @property
    def cautions(self) -> list[str]:
        """Cautions of the plan."""
        return [*map(str, self.plan.cautions)]

    def vectors(self) -> dict[str, Any]:
        """Return the vectors of both bodies after the collision as plain lists."""
        return {name: json_value(np.asarray(getattr(self, name))) for name, _ in VECTORS_AFTER}

    def to_dict(self) -> dict[str, Json]:
        """Return vectors and numbers as plain lists, with energy, status and plan."""
        numbers = {name: json_value(getattr(self, name)) for name, _ in NUMBERS_AFTER}
        told = {
            "status": json_value(self.status),
            "detail": json_value(self._statuses()[1]),
            "energy": self.energy.to_dict(),
            "laws": self._laws(),
            "plan": self.plan.to_dict(),
        }
        return self.vectors() | numbers | told

    def _laws(self) -> dict[str, str]:
        """Return the names of the laws, or of the function that answered in their place."""
        return {"normal": "contactlab.rebound"} if self.known is None else {**self.known.laws}

    def _sheet(self) -> Sheet:
        shape = self.encounter.shape
        found: dict[str, Any] = {}
        units = {"status": ""}
        for name, unit in (*VECTORS_AFTER, *NUMBERS_AFTER):
            vectors = (name, unit) in VECTORS_AFTER
            value = np.asarray(getattr(self, name))
            parts = along_axes(name, value) if vectors else dict(parts_of(name, value, shape))
            found |= parts
            units |= dict.fromkeys(parts, unit)
        found["status"] = names_of(self.status, shape)
        return Sheet(found, units, batch_axes(shape, "encounter"), shape, self._laws(), "encounter")

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw one column over another, for a batch by default psi2 over psi1."""
        if not self.encounter.shape:
            remedy = "for its forces: simulation.run(encounter.scene, history=True).plot()"
            raise refuse("collision", self, "is a single one, which has no curve", remedy)
        if x is None and y is None:
            return self.result.plot(axes=axes, width=width)
        return super()._draw(axes, x, y, width)


def _columns(encounter: Encounter, met: Mask, *quantities: Real | Mask) -> Array:
    """Return quantities of the encounters that met as rows, 0 without a collision."""
    columns = np.zeros((len(quantities), *encounter.shape))
    for k, quantity in enumerate(quantities):
        columns[k, met] = quantity
    return columns


def _attributes(encounter: Encounter, result: ImpactResult, met: Mask) -> dict[str, Any]:
    """Return the attributes of a collision of bodies that are no spheres."""
    motion, part = result.motion, encounter if every(met) else encounter.take(met)
    axes = result.scene.frame
    assert axes is not None
    couple = result.couple if kinetics.turns(result.scene) else 0.0
    moved: dict[str, Any] = push_bodies(part, axes, result.impulse, couple) | {
        "normal_velocity": motion.normal_velocity,
        "slip_velocity_change": motion.slip_velocity_change,
        "friction_work": motion.friction_work,
    }
    if part is not encounter:
        for name, value in moved.items():
            before = getattr(encounter, name, 0.0)
            if name == "normal_velocity":
                before = encounter.meeting().approach
            trailing = np.shape(value)[1:]
            whole = np.array(np.broadcast_to(before, (*encounter.shape, *trailing)))
            whole[met] = value
            moved[name] = whole
    return moved | {"collided": met}
