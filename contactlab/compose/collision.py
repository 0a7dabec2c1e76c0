"""The collision of two bodies in space: velocities and spins after an encounter."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose import impulses
from contactlab.compose.collision_plan import by_rebound, collision_plan
from contactlab.compose.rebound import damped
from contactlab.compose.simulation import Simulation
from contactlab.contracts.restitution import RESTITUTIONS
from contactlab.impact.bodies import Sphere
from contactlab.impact.encounter import Encounter
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import Real, real, refuse
from contactlab.numeric.names import attributes_told
from contactlab.numeric.vectors import LEAST
from contactlab.outcome.answer import TwoBodies
from contactlab.outcome.energy import EnergyLedger, books
from contactlab.outcome.motion import Motion
from contactlab.outcome.plan import Plan, PlanColumns
from contactlab.outcome.result import ImpactResult

if TYPE_CHECKING:
    from contactlab.compose.body_collision import BodyCollision

Array = NDArray[np.float64]

SEPARATING = ("refuse", "pass")
#: Different restitutions beyond which a plan has one statement, and the cautions of the least, for
#: all damped impacts.
MOST_STATEMENTS = 20
#: Vectors after a collision, name and unit.
VECTORS_AFTER = (
    ("velocity", "m/s"), ("spin", "rad/s"), ("target_velocity", "m/s"), ("target_spin", "rad/s"),
    ("impulse", "N s"), ("contact_velocity", "m/s"), ("target_contact_velocity", "m/s"),
)  # fmt: skip


@attributes_told
@attrs.frozen(kw_only=True, eq=False, repr=False, slots=False)
class Collision(TwoBodies):
    """Both bodies after an encounter; vectors have the shape ``(..., 3)``, numbers the batch's.

    Attributes
    ----------
    encounter : Encounter
    velocity, target_velocity : ndarray
        Velocities of the centres, in m/s. A half-space keeps its velocity.
    spin, target_spin : ndarray
        In rad/s. Friction of spin about the normal is left out: that spin does not change, and the
        plan tells how far it would, and how far it would move slip and the other spin.
    normal_velocity : float or array
        Rate of approach after the impact, in m/s; negative: the bodies separate.
    slip_velocity_change : float or array
        Change of the slip velocity in the direction of the slip before, in m/s.
    friction_work : float or array
        In J.
    collided : bool or array of bool
        False if the bodies were separating and passed through untouched.
    restitution : float or array
        e of the normal motion given to ``contactlab.rebound``; 1 with a simulation.
    simulation : Simulation or None
        The laws; None for ``contactlab.rebound``.
    known : ImpactResult or None
        The simulation's result for the encounters that collided.
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
            The result of ``encounter.scene``.

        Raises
        ------
        ValueError
            If the result has another scene.
        """
        if not isinstance(result, ImpactResult) or result.scene != encounter.scene:
            why = "must be the result of encounter.scene"
            raise refuse("result", result, why, "run that: simulation.run(encounter.scene)")
        moved = impulses.moved(encounter, _columns(encounter, result))
        return cls(encounter=encounter, **moved, known=result)

    def _impacts(self) -> ImpactResult | None:
        return self.known

    def _vectors(self) -> list[str]:
        return [name for name, _ in VECTORS_AFTER]

    @cached_property
    def result(self) -> ImpactResult:
        """The impacts in their planes of friction: one for each encounter that collided, in order.

        If the collision came from ``contactlab.rebound``, the impacts are run now, by the law that
        gives the same answers.
        """
        if self.known is not None:
            return self.known
        scene = self._met.scene
        if isinstance(self.restitution, float):
            return _run(_simulation(self.restitution), scene)
        parts = [
            (mask, _run(_simulation(value), scene.take(mask)))
            for mask, value in _alike(self._restitutions)
        ]
        return ImpactResult(
            scene=scene,
            plan=Plan.merged([(mask, part.plan) for mask, part in parts], scene.shape),
            motion=Motion.merged([(mask, part.motion) for mask, part in parts], scene.shape),
            laws=parts[0][1].laws,
            run_time=sum(part.run_time for _, part in parts),
        )

    @cached_property
    def plan(self) -> Plan:
        """The plan of the collision: what is computed, what is left out, and the cautions."""
        passed = ~np.asarray(self.collided)
        if passed.all():
            return collision_plan(Plan(PlanColumns.nothing(passed.shape)), None, passed)
        met = self._met
        if self.known is not None:
            plan = self.known.plan
        elif isinstance(self.restitution, float):
            plan = _planned(met.scene, self.restitution, self.restitution)
        else:
            each = self._restitutions
            groups = _alike(each)
            if len(groups) > MOST_STATEMENTS:
                masks = [mask for mask in (each == 1.0, each < 1.0) if mask.any()]
                groups = [(mask, float(each[mask].min())) for mask in masks]
            plans = [
                (mask, _planned(met.scene.take(mask), value, each[mask])) for mask, value in groups
            ]
            plan = Plan.merged(plans, met.shape)
        return collision_plan(plan, met, passed)

    @property
    def _restitutions(self) -> Array:
        """The restitution of each encounter that collided."""
        each = np.broadcast_to(self.restitution, self.encounter.shape)
        return np.asarray(each if np.all(self.collided) else each[self.collided])

    @property
    def energy(self) -> EnergyLedger:
        """The energy books of the relative motion, in J; its loss is the loss of both bodies."""
        contact = self.encounter.meeting()
        before = (contact.approach, contact.slip)
        after = (self.normal_velocity, self.slip_velocity_change)
        checked: Any = False
        exchange: Any = 0.0
        if self.known is not None:
            checked = np.ones(self.encounter.shape, dtype=bool)
            checked[self.collided] = self.known.energy.checked
            exchange = np.zeros(self.encounter.shape)
            exchange[self.collided] = self.known.motion.exchange
        return books(self.encounter.pair, before, after, self.friction_work, exchange, checked)

    @property
    def impulse(self) -> Array:
        """Impulse on the sphere, in N s; the target receives the opposite impulse."""
        contact, pair = self.encounter.meeting(), self.encounter.pair
        push: Any = pair.normal_mass * (self.normal_velocity - contact.approach)
        drag: Any = pair.tangential_mass * self.slip_velocity_change
        parts = zip(contact.normal, contact.along, strict=True)
        shape = self.encounter.shape
        return np.stack([np.broadcast_to(push * n + drag * t, shape) for n, t in parts], axis=-1)

    @property
    def contact_velocity(self) -> Array:
        """Velocity of the sphere's surface at the contact after the impact, in m/s."""
        return self.velocity + _rim(self.encounter.body, self.spin, self._normal)

    @property
    def target_contact_velocity(self) -> Array:
        """Velocity of the target's surface at the contact after the impact, in m/s."""
        target = self.encounter.target
        if not isinstance(target, Sphere):
            return self.target_velocity
        return self.target_velocity - _rim(target, self.target_spin, self._normal)

    @property
    def _normal(self) -> Array:
        """Unit vectors along the normals, shape (..., 3)."""
        parts = np.stack(self.encounter.meeting().normal, axis=-1)
        return np.broadcast_to(parts, (*self.encounter.shape, 3))

    @property
    def _met(self) -> Encounter:
        """The encounters that collided."""
        if np.all(self.collided):
            return self.encounter
        if not np.any(self.collided):
            raise refuse("encounter", self.encounter, "no bodies met: all separate")
        return self.encounter.take(self.collided)


def collide(
    encounter: Encounter,
    simulation: Simulation | None = None,
    *,
    restitution: Real | Callable[[Any], Any] = 1.0,
    separating: str = "refuse",
) -> Collision | BodyCollision:
    """Return velocities and spins of both bodies after an encounter, or after each of a batch.

    Between bodies that are no spheres the laws are exact where the motion stays in a plane, and
    springs in space; the result is a ``BodyCollision``.

    Parameters
    ----------
    encounter : Encounter
    simulation : Simulation, optional
        The laws. The default is ``contactlab.rebound``, exact for elastic spheres with Hertz
        contact and partial slip: under a microsecond per encounter in a large batch, 0.2 ms for a
        single one.
    restitution : float, array of shape (...,), or callable
        e of the normal motion without a simulation, from 0.01 to 1: one number, one for each
        encounter, or a function that returns either for the normal speeds of approach in m/s, a
        float or an array of shape (...,); where bodies separate the speed reads 1 m/s and the
        answer is not used. Below 1 the law is Tsuji's, with Coulomb's law at every point: from a
        table for e from 0.5 and chi from 0.8 to 1.8 (solid spheres), at half a microsecond per
        encounter with any number of different e, and by rings elsewhere, in milliseconds.
        ``Collision.plan`` states the error of psi2. Other laws of the same e give another psi2, at
        e = 0.9 by up to 0.021 (viscoelastic) or 0.62 (a linear spring): see ``contactlab.rebound``.
    separating : "refuse" or "pass"
        For bodies that do not approach each other: an error with the index of the first, or both
        bodies unchanged, with ``Collision.collided`` False.

    Raises
    ------
    ValueError
        If the input is bad, or if bodies separate and ``separating`` is "refuse". Of an array the
        index of the first bad number is named.

    Notes
    -----
    The laws leave out the friction of spin about the normal, which moves psi2 by 0.3 at psi1 = 1
    where the rim of the contact turns half as fast as it slips; ``plan`` tells the size.

    An empty batch gives an empty collision. Arrays are float64. Threads may call this function at
    the same time: it keeps no state but tables that never change.

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
        remedy = "make one: Encounter(...)"
        if isinstance(encounter, list | tuple):
            remedy = "make a single Encounter with arrays of vectors, shape (..., 3)"
        raise refuse("encounter", encounter, "must be an Encounter", remedy)
    if simulation is not None and not isinstance(simulation, Simulation):
        remedy = "or leave it out"
        if isinstance(simulation, float):
            remedy += f"; a restitution is given by name: restitution={simulation}"
        raise refuse("simulation", simulation, "must be a Simulation", remedy)
    if separating not in SEPARATING:
        raise refuse("separating", separating, "must be 'refuse' or 'pass'")
    if callable(restitution):
        restitution = _at_speeds(restitution, encounter)
    e = real("restitution", restitution, rule=RESTITUTIONS, remedy="leave it out for 1", empty=True)
    if not isinstance(e, float):
        e = _spread(e, encounter.shape)
    if not encounter.of_spheres:
        from contactlab.compose.body_collision import collide_bodies  # spheres need none of it

        _alone(simulation, restitution, e)
        return collide_bodies(encounter, simulation, e, separating)
    if simulation is None:
        strict = separating == "refuse"
        moved = impulses.moved(encounter, restitution=e, strict=strict)
        return Collision(encounter=encounter, **moved, restitution=e)
    _alone(simulation, restitution, e)
    met: Any = encounter.approaching
    if separating == "refuse" and not np.all(met):
        raise encounter.separate()
    if not np.any(met):
        moved = impulses.moved(encounter)
        return Collision(encounter=encounter, **moved, simulation=simulation)
    if np.all(met):
        scene = encounter.scene
    else:  # the index of an impact is its place in the whole batch
        places = np.arange(np.size(met)).reshape(np.shape(met))[met]
        scene = encounter.take(met).scene.numbered(places)
    result = _run(simulation, scene)
    moved = impulses.moved(encounter, _columns(encounter, result, met))
    return Collision(encounter=encounter, **moved, simulation=simulation, known=result)


def _alone(simulation: Simulation | None, given: Any, restitution: Any) -> None:
    """Refuse a restitution beside a simulation."""
    if simulation is not None and np.any(restitution != 1.0):
        remedy = "give it to the normal law: create('normal.tsuji', restitution=0.9)"
        raise refuse("restitution", given, "stands in place of a simulation", remedy)


def _simulation(restitution: float) -> Simulation:
    """Return laws with the answers of ``contactlab.rebound``."""
    return Simulation() if restitution == 1.0 else damped(restitution)


def _planned(scene: Scene, restitution: float, each: Real) -> Plan:
    """Return the plan of impacts, with the cautions of one restitution and the errors of each."""
    plan = _simulation(restitution).plan(scene)
    return plan if restitution == 1.0 else by_rebound(plan, scene.chi, each)


def _alike(restitution: Array) -> list[tuple[Any, float]]:
    """Return masks of equal restitutions, and the restitution of each mask."""
    return [(restitution == value, value) for value in np.unique(restitution).tolist()]


def _spread(restitution: Any, shape: tuple[int, ...]) -> Any:
    """Return a restitution for each encounter, read-only, or refuse another shape."""
    try:
        return np.broadcast_to(restitution, shape)
    except ValueError:
        rule = f"must be one number, or of the shape {shape} of the encounters"
        raise refuse("restitution", restitution, rule) from None


def _at_speeds(restitution: Callable[[Any], Any], encounter: Encounter) -> Any:
    """Return the restitution at the normal speed of each encounter; 1 where bodies separate."""
    shape, approach = encounter.shape, encounter.meeting().approach
    apart = np.broadcast_to(~(np.asarray(approach) >= LEAST), shape)
    speed = np.where(apart, 1.0, approach)
    each = np.array(_spread(restitution(speed if shape else float(speed)), shape))
    each[apart] = 1.0
    return each


def _run(simulation: Simulation, scene: Any) -> ImpactResult:
    """Return the result of a scene, by blocks if the scene has one axis."""
    result: ImpactResult
    result = simulation.sweep(scene) if len(scene.shape) == 1 else simulation.run(scene)
    return result


def _columns(encounter: Encounter, result: ImpactResult, met: Any = True) -> Array:
    """Return rebound rate, slip change and friction work, shape (3, n); 0 without a collision."""
    motion = result.motion
    columns = np.zeros((3, *encounter.shape))
    quantities = (motion.normal_velocity, motion.slip_velocity_change, motion.friction_work)
    for k, quantity in enumerate(quantities):
        columns[k, met] = quantity
    return columns.reshape(3, -1)


def _rim(body: Any, spin: Array, normal: Array) -> Array:
    """Return the velocity in m/s, relative to the centre, of the surface at ``normal``."""
    radius: Any = np.asarray(body.radius)[..., None]
    return np.asarray(radius * np.cross(spin, normal))
