"""The collision of two bodies in space: from an encounter to velocities and spins."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, overload

import numpy as np

from contactlab.collisions import impulses
from contactlab.collisions.collision import Collision
from contactlab.collisions.restituted import run_by_restitution
from contactlab.contracts.restitution import RESTITUTIONS
from contactlab.impact.encounter import Encounter
from contactlab.impact.gathering import Gathering
from contactlab.impact.of_speed import numbers_at, spread_over
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import every, some, take
from contactlab.numeric.checks import of_kind, real, refuse
from contactlab.numeric.types import AnyArray, Array, Mask, Numbers, Real
from contactlab.numeric.vectors import LEAST
from contactlab.runs.simulation import Simulation, run_in_blocks

if TYPE_CHECKING:
    from contactlab.collisions.gathered import GatheringResult

SEPARATING = ("refuse", "pass")
#: Remedies for objects that users give in place of an encounter, or of a simulation.
WITH_ARRAYS = (
    "make a single Encounter with arrays of vectors, shape (..., 3); bodies that touch at several "
    "contacts at once are a Gathering(bodies, touches)"
)
INSTEAD: dict[type, str] = {
    list: WITH_ARRAYS,
    tuple: WITH_ARRAYS,
    Scene: "a scene has a run of its own: simulation.run(scene)",
    float: "or leave it out; a restitution is given by name: restitution={value}",
}


@overload
def collide(
    encounter: Encounter,
    simulation: Simulation | None = None,
    *,
    restitution: Numbers | Callable[[float], Numbers] | Callable[[Array], Numbers] = 1.0,
    separating: str = "refuse",
    history: bool = False,
) -> Collision: ...
@overload
def collide(
    encounter: Gathering, simulation: Simulation | None = None, *, history: bool = False
) -> GatheringResult: ...
def collide(
    encounter: Any,
    simulation: Simulation | None = None,
    *,
    restitution: Numbers | Callable[[float], Numbers] | Callable[[Array], Numbers] = 1.0,
    separating: str = "refuse",
    history: bool = False,
) -> Collision | GatheringResult:
    """Return velocities and spins of both bodies after an encounter, or after each of a batch.

    For a ``Gathering`` it returns velocities and spins of all bodies, and impulses of each contact.
    The contacts march together, by springs in even steps unless a simulation has other laws.

    Between bodies that are no spheres each impact goes its own way: as spheres where friction does
    not change the approach, else by laws that are exact in a plane, psi2 to 1e-9 in 0.2 ms, and by
    springs in space or with a restitution, to 2e-3 in about 1 ms (in a batch a third of it). They
    leave out the friction of spin about the normal, with a caution in the plan;
    ``Simulation(tangential="halfspace")`` answers it.

    Parameters
    ----------
    encounter : Encounter or Gathering
    simulation : Simulation, optional
        The laws; of a gathering any normal law, and a causal tangential law that takes vectors. The
        default is ``contactlab.rebound``, exact for elastic spheres with Hertz
        contact and partial slip: under a microsecond per encounter in a large batch, about 10 us
        for a single one beside 5 to 10 us for its ``Encounter``.
    restitution : float, array of shape (...,), or callable
        e of the normal motion without a simulation, from 0 to 1: one number, one for each
        encounter, or a function that returns either for the normal speeds of approach in m/s, a
        float or an array of shape (...,); where bodies separate the speed reads 1 m/s and the
        answer is not used. Below 1 the law is ``normal.viscoelastic``, one loss for pressure and
        shear, by ``contactlab.rebound``: from a table for chi from 0.3 to 3 (all spheres but those
        with a dense core), at half a microsecond per encounter with any number of different e, and
        by springs elsewhere, in milliseconds; from 0.01 on where friction changes the approach.
        ``Collision.plan`` states the error of psi2.
    separating : "refuse" or "pass"
        For bodies that do not approach each other: an error with the index of the first, or both
        bodies unchanged, with ``Collision.collided`` False.
    history : bool
        Keep the course of the contacts of a gathering.

    Returns
    -------
    Collision or GatheringResult
        Vectors have the shape (..., 3); of N bodies and C contacts (..., N, 3) and (..., C, 3).

    Raises
    ------
    ValueError
        If the input is bad, or if bodies separate and ``separating`` is "refuse". For an array the
        message names the index of the first bad number.

    Notes
    -----
    Velocities of spheres depend on Poisson's ratio and, for unlike bodies, on the ratio of Young's
    moduli: of like bodies any modulus will do, such as that of ``Material.named``. An empty batch
    gives an empty collision. Arrays are float64. Threads may call this function at the same time:
    it keeps no state but tables that never change.

    Examples
    --------
    >>> from contactlab import Encounter, Material, Sphere, collide
    >>> ivory = Material(young_modulus=5e9, poisson_ratio=0.34, density=1700.0)
    >>> ball = Sphere(0.0286, ivory)
    >>> met = Encounter(ball, ball, 0.1, normal=[1, 0, 0], velocity=[2, 0, 0], spin=[0, 0, 40])
    >>> collide(met).target_velocity.round(4)
    array([ 2.    , -0.1144,  0.    ])
    """
    if type(encounter) is not Encounter:  # a call takes longer than this test
        if type(encounter) is Gathering:
            return _solve_gathering(encounter, simulation, restitution, separating, history=history)
        of_kind("encounter", encounter, Encounter, remedy="make one: Encounter(...)", meant=INSTEAD)
    if history:
        remedy = "simulation.run(encounter.scene, history=True)"
        raise refuse("history", history, "belongs to a gathering", remedy)
    if simulation is not None:
        remedy = "or leave it out"
        of_kind("simulation", simulation, Simulation, remedy=remedy, meant=INSTEAD)
    if separating not in SEPARATING:
        raise refuse("separating", separating, "must be 'refuse' or 'pass'")
    e: Real = 1.0
    if type(restitution) is not float or restitution != 1.0:  # the default needs no check
        e = _check_restitution(restitution, encounter)
        if simulation is not None:
            _alone(restitution, e, simulation)
    if simulation is None and encounter.of_spheres:
        strict = separating == "refuse"
        moved = impulses.strike(encounter, restitution=e, strict=strict)
        return Collision(encounter=encounter, **moved, restitution=e)
    met: Mask = np.ones(encounter.shape, dtype=bool) if encounter.shape else True
    if separating == "pass":  # without "pass" the scene refuses them
        met = encounter.approaching
    about: dict[str, Any] = {"simulation": simulation, "restitution": e}
    if not some(met):
        unmoved = impulses.pass_through(encounter)
        return Collision(encounter=encounter, **unmoved, **about)
    if every(met):
        scene = encounter.scene
    else:  # the index of an impact is its place in the whole batch
        places = np.arange(np.size(met)).reshape(np.shape(met))[met]
        scene = encounter.take(met).scene.with_index(places)
        e = take(e, encounter.shape, met)
    if simulation is not None:
        result = run_in_blocks(simulation, scene)
    else:
        result = run_by_restitution(scene, e)
    return Collision.by(encounter, result, met, **about)


def _solve_gathering(
    gathering: Gathering,
    simulation: Simulation | None,
    restitution: object,
    separating: str,
    *,
    history: bool,
) -> GatheringResult:
    """Return the outcome of a gathering; its contacts have their own restitutions."""
    from contactlab.collisions.gathered import collide_all  # encounters need none of this

    if simulation is not None:
        of_kind("simulation", simulation, Simulation, remedy="or leave it out", meant=INSTEAD)
    if some(restitution != 1.0):
        remedy = "give it to each contact: Touch(..., restitution=...)"
        raise refuse("restitution", restitution, "belongs to each contact of a gathering", remedy)
    if separating != "refuse":
        rule = "belongs to encounters: contacts of a gathering may separate"
        raise refuse("separating", separating, rule, "leave it out")
    return collide_all(gathering, simulation, history=history)


def _check_restitution(given: object, encounter: Encounter) -> Real:
    """Return the user's restitution, one number or one for each encounter."""
    numbers: object = _at_speeds(given, encounter) if callable(given) else given
    e = real("restitution", numbers, rule=RESTITUTIONS, remedy="leave it out for 1", empty=True)
    return e if isinstance(e, float) else spread_over("restitution", e, encounter.shape)


def _alone(given: object, restitution: Real, simulation: Simulation) -> None:
    """Refuse a restitution beside a simulation."""
    if np.any(restitution != 1.0):
        remedy = "leave out simulation"
        if isinstance(given, int | float):
            from contactlab.runs.owners import with_restitution  # for a refusal only

            remedy += f", or make it with normal={with_restitution(simulation.normal, given)}"
        raise refuse("restitution", given, "stands in place of a simulation", remedy)


def _at_speeds(restitution: Callable[..., Numbers], encounter: Encounter) -> AnyArray:
    """Return the restitution at the normal speed of each encounter; 1 where bodies separate."""
    shape, approach = encounter.shape, encounter.meeting().approach
    apart = np.broadcast_to(~(np.asarray(approach) >= LEAST), shape)
    speed = np.where(apart, 1.0, approach)
    each = np.array(numbers_at("restitution", restitution, speed, shape))
    if apart.any():
        each[apart] = 1.0
    return each
