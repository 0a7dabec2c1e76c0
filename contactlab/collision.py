"""The collision of two bodies in space: what any law makes of an encounter."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.batch import filled, locked
from contactlab.bodies import Pair, Sphere
from contactlab.checks import Real, refuse
from contactlab.encounter import LEAST, Contact, Encounter, components
from contactlab.energy import EnergyLedger, books
from contactlab.plan import Plan, Sentence
from contactlab.rebounds import rebound
from contactlab.registry import REGISTRY
from contactlab.result import ImpactResult
from contactlab.signatures import named_arguments
from contactlab.simulation import Simulation
from contactlab.status import Status

Array = NDArray[np.float64]

#: The law with the answers of ``rebound``, for plans and results of collisions without one of
#: their own; where it is not installed the default takes its place.
SAME_ANSWERS = "tangential.tabulated"
SEPARATING = ("refuse", "pass")
#: Spin about the normal over the whole spin below which it is rounding.
TURNING = 1e-12

#: Rate of approach after the impact, change of slip velocity (m/s) and friction work (J) of a part
#: of a batch.
Answer = Callable[[slice, Encounter, Contact, Pair], tuple[Any, Any, Any]]


@attrs.frozen(kw_only=True, eq=False, repr=False, slots=False)
class Collision:
    """Both bodies after an encounter; vectors have the shape ``(..., 3)``, numbers the batch's.

    Attributes
    ----------
    encounter : Encounter
    velocity, target_velocity : ndarray
        Of the centres, in m/s. A half-space goes on as it was.
    spin, target_spin : ndarray
        In rad/s. Spin about the normal is that of before.
    normal_velocity : float or array
        Rate of approach after the impact, in m/s; negative: the bodies separate.
    slip_velocity_change : float or array
        Change of the slip velocity along the slip of before, in m/s.
    friction_work : float or array
        In J.
    collided : bool or array of bool
        False where the bodies separated before, and passed through untouched.
    """

    encounter: Encounter
    velocity: Array
    spin: Array
    target_velocity: Array
    target_spin: Array
    normal_velocity: Real
    slip_velocity_change: Real
    friction_work: Real
    collided: Any
    simulation: Simulation | None = None
    known: ImpactResult | None = None

    @classmethod
    def of(cls, encounter: Encounter, result: ImpactResult) -> Collision:
        """Return the collision of ``encounter`` by a result of its scene.

        Raises
        ------
        ValueError
            If the result is that of another scene.
        """
        scene = encounter.scene
        if result.scene is not scene and result.scene != scene:
            why = "must be the result of encounter.scene"
            raise refuse("result", result, why, "run that: simulation.run(encounter.scene)")
        return _moved(encounter, _answer_of(encounter, result, None), known=result)

    def __repr__(self) -> str:
        """Return how many collided, and how it went."""
        statuses = {status.name for status in np.ravel(np.array(self.status, dtype=object))}
        told = ", ".join(sorted(statuses))
        if not self.encounter.shape:
            return f"Collision(velocity={self.velocity}, spin={self.spin}; {told})"
        count = int(np.sum(self.collided))
        return f"Collision({count} of {np.size(self.collided)} encounters collided; {told})"

    @cached_property
    def result(self) -> ImpactResult:
        """The impacts in their planes of friction: of those that collided, one after another.

        Without a simulation of its own the collision's numbers came from ``rebound`` directly; the
        impacts are then run once more, by the law that gives the same answers.
        """
        if self.known is not None:
            return self.known
        return _run(self._simulation, self._met.scene)

    @cached_property
    def plan(self) -> Plan:
        """What was computed, what was left out, and what to be wary of."""
        known = self.known
        plan = self._simulation.plan(self._met.scene) if known is None else known.plan
        left_out = list(plan.left_out)
        met = self._met
        turning = np.array(np.broadcast_to(_turns(met), met.shape))
        if turning.any():
            text = "spin about the normal: friction makes no moment about it, it passes unchanged"
            left_out.append(Sentence(text, turning))
        if not np.all(self.collided):
            text = "collision: the bodies separate, they pass through untouched"
            left_out.append(Sentence(text, ~np.asarray(self.collided)))
        return attrs.evolve(plan, left_out=tuple(left_out))

    @property
    def status(self) -> Any:
        """A ``Status``, or an array of them; ``SUCCESS`` where bodies passed through."""
        if self.known is None:
            return filled(Status.SUCCESS, self.encounter.shape)
        if np.all(self.collided):
            return self.known.status
        found = filled(Status.SUCCESS, self.encounter.shape)
        found[self.collided] = self.known.status
        return found

    def check(self) -> Collision:
        """Return this collision if every impact succeeded.

        Raises
        ------
        ImpactError
            With the sentence of the first impact that failed.
        """
        if self.known is not None:
            self.known.check()
        return self

    @property
    def energy(self) -> EnergyLedger:
        """The energy books of the relative motion, in J; what both bodies lose is what it loses."""
        contact = self.encounter.contact()
        before = (contact.approach, contact.slip)
        after = (self.normal_velocity, self.slip_velocity_change)
        return books(self.encounter.pair, before, after, self.friction_work)

    @property
    def impulse(self) -> Array:
        """On the sphere, in N s; on the target it is the opposite."""
        contact, pair = self.encounter.contact(), self.encounter.pair
        push: Any = pair.normal_mass * (self.normal_velocity - contact.approach)
        drag: Any = pair.tangential_mass * self.slip_velocity_change
        parts = zip(contact.normal, contact.along, strict=True)
        shape = self.encounter.shape
        return np.stack([np.broadcast_to(push * n + drag * t, shape) for n, t in parts], axis=-1)

    @property
    def contact_velocity(self) -> Array:
        """Velocity of the sphere's surface at the contact after the impact, in m/s."""
        return self.velocity + _rim(self.encounter.sphere, self.spin, self._normal)

    @property
    def target_contact_velocity(self) -> Array:
        """Velocity of the target's surface at the contact after the impact, in m/s."""
        target = self.encounter.target
        if not isinstance(target, Sphere):
            return self.target_velocity
        return self.target_velocity - _rim(target, self.target_spin, self._normal)

    @property
    def _normal(self) -> Array:
        parts = np.stack(self.encounter.contact().normal, axis=-1)
        return np.broadcast_to(parts, (*self.encounter.shape, 3))

    @property
    def _met(self) -> Encounter:
        """The encounters that collided."""
        if np.all(self.collided):
            return self.encounter
        if not np.any(self.collided):
            raise refuse("encounter", self.encounter, "no bodies met: all separate")
        return self.encounter.take(self.collided)

    @property
    def _simulation(self) -> Simulation:
        if self.simulation is not None:
            return self.simulation
        installed = SAME_ANSWERS in REGISTRY.names()
        return Simulation(tangential=SAME_ANSWERS) if installed else Simulation()


@named_arguments("collide(encounter, Simulation(tangential='springs'))")
def collide(
    encounter: Encounter, simulation: Simulation | None = None, *, separating: str = "refuse"
) -> Collision:
    """Return both bodies after an encounter, or after each of a batch.

    Parameters
    ----------
    encounter : Encounter
    simulation : Simulation, optional
        The laws. By default the exact answer for elastic spheres, Hertz contact with partial slip,
        by ``contactlab.rebound``: under a microsecond an encounter in a large batch.
    separating : "refuse" or "pass"
        What to do with bodies that do not approach each other: an error with the index of the
        first, or let them pass through untouched, which ``Collision.collided`` tells.

    Raises
    ------
    ValueError
        For bad input, or bodies that separate.

    Examples
    --------
    >>> from contactlab import Encounter, Material, Sphere, collide
    >>> ivory = Material(young_modulus=5e9, poisson_ratio=0.34, density=1700.0)
    >>> ball = Sphere(0.0286, ivory)
    >>> met = Encounter(ball, ball, 0.1, normal=[1, 0, 0], velocity=[2, 0, 0], spin=[0, 0, 40])
    >>> collide(met).target_velocity.round(4)
    array([ 2.    , -0.1144,  0.    ])
    """
    if not isinstance(encounter, Encounter):
        raise refuse("encounter", encounter, "must be an Encounter", "make one: Encounter(...)")
    if simulation is not None and not isinstance(simulation, Simulation):
        raise refuse("simulation", simulation, "must be a Simulation", "or leave it out")
    if separating not in SEPARATING:
        raise refuse("separating", separating, "must be 'refuse' or 'pass'")
    if simulation is None:
        return _moved(encounter, _elastic, strict=separating == "refuse")
    met = encounter.approaching
    if np.all(met):
        known = _run(simulation, encounter.scene)
        answer = _answer_of(encounter, known, None)
        return _moved(encounter, answer, simulation=simulation, known=known)
    if separating == "refuse":
        raise encounter.separate()
    if not np.any(met):
        return _moved(encounter, _elastic, strict=False)
    known = _run(simulation, encounter.take(met).scene)
    answer = _answer_of(encounter, known, met)
    return _moved(encounter, answer, simulation=simulation, known=known)


def _run(simulation: Simulation, scene: Any) -> ImpactResult:
    return simulation.sweep(scene) if len(scene.shape) == 1 else simulation.run(scene)


def _elastic(where: slice, part: Encounter, contact: Contact, pair: Pair) -> tuple[Any, Any, Any]:
    """Return what becomes of elastic bodies, from ``rebound``.

    Slip throughout, eq. (46), is the same from psi1 = 4 chi + 1 on, so that psi1 is cut there:
    whatever slip and friction are, it is finite and keeps its digits.
    """
    chi = pair.inertia_ratio
    unit: Any = part.friction_coefficient * contact.approach / pair.stiffness_ratio  # of psi, m/s
    with np.errstate(all="ignore"):
        psi1: Any = np.fmin(np.divide(contact.slip, unit), 4.0 * chi + 1.0)
        psi1 = np.where(contact.approach >= LEAST, psi1, 0.0)
        psi2: Any = rebound(psi1, chi) if part.shape else rebound(float(psi1), float(chi))
        change = (psi2 - psi1) * unit
        work = -pair.tangential_mass * change * (contact.slip + 0.5 * change)
    return -contact.approach, change, np.maximum(work, 0.0)


def _answer_of(encounter: Encounter, result: ImpactResult, met: Any) -> Answer:
    """Return the answers of a result, one after another; of the encounters ``met`` if not of all."""
    motion = result.motion
    columns = []
    for column in (motion.normal_velocity, motion.slip_velocity_change, motion.friction_work):
        whole = np.ravel(column)
        if met is not None:
            whole = np.zeros(encounter.shape)
            whole[met] = np.ravel(column)
        columns.append(whole.reshape(-1))

    def answer(where: slice, part: Encounter, contact: Contact, pair: Pair) -> tuple[Any, Any, Any]:
        after, change, work = (column[where] for column in columns)
        return after, change, work

    return answer


def _moved(encounter: Encounter, answer: Answer, *, strict: bool = False, **rest: Any) -> Collision:
    """Return the collision with these answers; bodies that separate move on, or are refused."""
    shape = encounter.shape
    moved = {
        name: np.empty((*shape, 3))
        for name in ("velocity", "spin", "target_velocity", "target_spin")
    }
    flat = {name: array.reshape(-1, 3) for name, array in moved.items()}
    numbers = np.empty((3, *shape))
    columns = numbers.reshape(3, -1)
    collided = np.empty(shape, dtype=bool)
    for where, part in encounter.parts():
        contact, pair = part.contact(), part.pair
        meets = contact.approach >= LEAST
        if strict and not np.all(meets):
            raise encounter.separate()
        after, change, work = answer(where, part, contact, pair)
        if not np.all(meets):
            after = np.where(meets, after, contact.approach)
            change, work = np.where(meets, change, 0.0), np.where(meets, work, 0.0)
        columns[0, where], columns[1, where], columns[2, where] = after, change, work
        collided.reshape(-1)[where] = meets
        push, drag = pair.normal_mass * (after - contact.approach), pair.tangential_mass * change
        _push({name: array[where] for name, array in flat.items()}, part, contact, push, drag)
    after, change, work = (locked(each) if shape else float(each) for each in numbers)
    return Collision(
        encounter=encounter,
        **{name: locked(array) for name, array in moved.items()},
        normal_velocity=after,
        slip_velocity_change=change,
        friction_work=work,
        collided=locked(collided) if shape else bool(collided),
        **rest,
    )


def _push(moved: dict[str, Array], part: Encounter, contact: Contact, push: Any, drag: Any) -> None:
    """Write velocities and spins after impulses along the normal and along the slip.

    Parameters
    ----------
    moved : dict of arrays
        To be written, each of shape (encounters, 3).
    part : Encounter
    contact : Contact
    push, drag : array
        Impulses on the sphere, in N s.
    """
    (n1, n2, n3), (t1, t2, t3) = contact.normal, contact.along
    across = (n2 * t3 - n3 * t2, n3 * t1 - n1 * t3, n1 * t2 - n2 * t1)
    bodies: list[tuple[str, Any, float]] = [("", part.sphere, 1.0), ("target_", part.target, -1.0)]
    for name, body, sense in bodies:
        velocity, spin = getattr(part, f"{name}velocity"), getattr(part, f"{name}spin")
        if not isinstance(body, Sphere):
            moved[f"{name}velocity"][:], moved[f"{name}spin"][:] = velocity, spin
            continue
        inertia = body.mass * body.gyration_ratio * body.gyration_ratio * body.radius
        ahead, aside, turn = sense * push / body.mass, sense * drag / body.mass, drag / inertia
        for k, (v, w) in enumerate(zip(components(velocity), components(spin), strict=True)):
            moved[f"{name}velocity"][:, k] = v + (
                ahead * contact.normal[k] + aside * contact.along[k]
            )
            moved[f"{name}spin"][:, k] = w + turn * across[k]


def _rim(body: Sphere, spin: Array, normal: Array) -> Array:
    """Return the velocity that spin gives to the surface in the direction of ``normal``."""
    radius: Any = np.asarray(body.radius)[..., None]
    return np.asarray(radius * np.cross(spin, normal))


def _turns(encounter: Encounter) -> Any:
    """Return whether either body spins about the normal."""
    found: Any = False
    normal = encounter.contact().normal
    for spin in (encounter.spin, encounter.target_spin):
        parts = components(spin)
        about = sum(one * n for one, n in zip(parts, normal, strict=True))
        whole = np.sqrt(sum(one * one for one in parts))
        found = found | (np.abs(about) > TURNING * whole)
    return found
