"""The collision of bodies of any shape: velocities and spins after an encounter."""

from __future__ import annotations

from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose import composition, eccentric
from contactlab.compose.collision_plan import with_normal_spin
from contactlab.compose.rebound import damped
from contactlab.compose.simulation import Simulation
from contactlab.impact.body_contact import arms, frame, turned
from contactlab.impact.cautions import contact_vectors
from contactlab.impact.eccentric import EccentricScene
from contactlab.impact.encounter import Encounter
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse
from contactlab.outcome.answer import TwoBodies
from contactlab.outcome.eccentric import EccentricResult
from contactlab.outcome.energy import EnergyLedger
from contactlab.outcome.plan import Clause, Plan
from contactlab.outcome.result import ImpactResult

Array = NDArray[np.float64]

VECTORS_AFTER = ("velocity", "spin", "target_velocity", "target_spin", "impulse")


@attrs.frozen(kw_only=True, eq=False, repr=False)
class BodyCollision(TwoBodies):
    """Two bodies after an encounter; vectors have the shape ``(..., 3)``.

    Attributes
    ----------
    encounter : Encounter
    velocity, target_velocity : array
        Velocities of the centres of mass, in m/s.
    spin, target_spin : array
        In rad/s. Friction of spin about the normal is left out; the plan tells what it would do.
    impulse : array
        Impulse on the first body, in N s; the target receives the opposite impulse.
    collided : bool or array of bool
        False if the bodies were separating and passed through untouched.
    result : EccentricResult or ImpactResult
        The impacts of the bodies that collided, in order; an ``ImpactResult`` where friction does
        not change the approach.
    """

    encounter: Encounter
    velocity: Array
    spin: Array
    target_velocity: Array
    target_spin: Array
    impulse: Array
    collided: Any
    result: EccentricResult | ImpactResult
    plan: Plan

    @classmethod
    def of(
        cls, encounter: Encounter, result: EccentricResult | ImpactResult, restitution: float = 1.0
    ) -> BodyCollision:
        """Return the collision of ``encounter`` by a result of its scene.

        Parameters
        ----------
        encounter : Encounter
        result : EccentricResult or ImpactResult
            The result of ``encounter.scene``, of those encounters that approach.
        restitution : float
            e that the laws stand for, which the plan tells.
        """
        met: Any = encounter.approaching
        collided = encounter if np.all(met) else encounter.take(met)
        impulse = _impulse(collided, result)
        if collided is not encounter:
            pushed, impulse = impulse, np.zeros((*encounter.shape, 3))
            impulse[met] = pushed
        return cls(
            encounter=encounter,
            **_pushed(encounter, impulse),
            impulse=-impulse,
            collided=met,
            result=result,
            plan=_plan(collided, result, restitution),
        )

    def _impacts(self) -> EccentricResult | ImpactResult:
        return self.result

    def _vectors(self) -> tuple[str, ...]:
        return VECTORS_AFTER

    @property
    def energy(self) -> EnergyLedger:
        """The energy books of the impacts, in J; their loss is the loss of both bodies."""
        return self.result.energy


def collide_bodies(
    encounter: Encounter, simulation: Simulation | None, restitution: Any, separating: str
) -> BodyCollision:
    """Return both bodies after an encounter, under the laws that answer its scene best."""
    met: Any = encounter.approaching
    if not np.all(met):
        if separating == "refuse" or not np.any(met):
            raise encounter.separate()
        collided = encounter.take(met)
    else:
        collided = encounter
    if simulation is None and not (
        isinstance(restitution, float) or np.all(restitution == restitution.flat[0])
    ):
        rule = "must be one number for bodies that are no spheres"
        raise refuse("restitution", restitution, rule, "collide those of each value by themselves")
    e = restitution if isinstance(restitution, float) else float(restitution.flat[0])
    scene = collided.scene
    laws = simulation if simulation is not None else _simulation(scene, e)
    return BodyCollision.of(encounter, laws.run(scene), e)


def _simulation(scene: Scene | EccentricScene, restitution: float) -> Simulation:
    """Return the laws that answer a scene best."""
    if isinstance(scene, Scene):
        return Simulation() if restitution == 1.0 else damped(restitution)
    if restitution == 1.0:
        return Simulation(**eccentric.preferred(scene))
    return Simulation(normal=damped(restitution).normal, **composition.IN_SPACE)


def _plan(encounter: Encounter, result: EccentricResult | ImpactResult, restitution: float) -> Plan:
    """Return the plan of the impacts, with what a restitution stands for and doubtful contacts."""
    plan, everywhere = result.plan, np.ones(result.scene.shape, dtype=bool)
    if restitution != 1.0 and isinstance(result, EccentricResult):
        said = f"restitution {restitution:g}: of a frictionless impact on the mass 1/W_nn, "
        said += "Tsuji's law"
        plan = plan.changed(computed=(*plan.computed, Clause(said, everywhere)))
    if doubts := contact_vectors(encounter):
        clauses = (Clause(text, everywhere) for text in doubts)
        plan = plan.changed(cautions=(*plan.cautions, *clauses))
    return with_normal_spin(plan, encounter)


def _impulse(encounter: Encounter, result: EccentricResult | ImpactResult) -> Array:
    """Return the impulse on the target in the encounter's frame, in N s."""
    if isinstance(result, EccentricResult):
        axes = frame(encounter).axes
        return np.asarray(np.einsum("...ia,...i->...a", axes, result.impulse))
    meeting, pair, motion = encounter.meeting(), result.scene.pair, result.motion
    push = pair.normal_mass * (result.scene.normal_speed - np.asarray(motion.normal_velocity))
    drag = -pair.tangential_mass * np.asarray(motion.slip_velocity_change)
    parts = zip(meeting.normal, meeting.along, strict=True)
    return np.stack([push * n + drag * t for n, t in parts], axis=-1)


def _pushed(encounter: Encounter, impulse: Array) -> dict[str, Array]:
    """Return velocities and spins after an impulse on the target, and its opposite on the body."""
    normal = encounter.normal / np.sqrt(np.sum(encounter.normal**2, axis=-1))[..., None]
    first, second = arms(encounter, normal)
    moved = {}
    for name, body, arm, sense in (
        ("", encounter.body, first, -1.0),
        ("target_", encounter.target, second, 1.0),
    ):
        push = sense * impulse
        velocity = getattr(encounter, f"{name}velocity")
        if hasattr(body, "mass"):
            velocity = velocity + push / np.asarray(body.mass)[..., None]
        spin = getattr(encounter, f"{name}spin") + turned(body, np.cross(arm, push))
        moved[f"{name}velocity"] = np.broadcast_to(velocity, impulse.shape)
        moved[f"{name}spin"] = np.broadcast_to(spin, impulse.shape)
    return moved
