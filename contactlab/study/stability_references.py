"""References of the stability study: each law's own exact answer.

A law that converges to the continuum is judged by the exact solution, a rigid body by its closed
form, and any other law by itself at high resolution. What a law's model leaves out (a rigid body
has no partial slip) is therefore not counted as numerical error.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache, partial

import numpy as np

from contactlab.contracts import (
    Law,
    NormalLaw,
    SteppedTangentialLaw,
    TangentialLaw,
    WholeImpactTangentialLaw,
)
from contactlab.contracts.law import claims, requirements, resolution_of
from contactlab.contracts.tangential import shares_loss
from contactlab.impact.error_model import range_of
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.impact.scene import Scene
from contactlab.registration.names import PROJECT, kind_of
from contactlab.registry import composition
from contactlab.registry.composition import PREFERRED, exact, fixed_steps, misfit
from contactlab.registry.registry import REGISTRY, PluginError
from contactlab.runs.simulation import Simulation
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.units import with_parameters

#: Tolerances of the exact solution, the finer first; both finer than the default, which they judge.
REFERENCE_TOLERANCES = (1e-11, 1e-9)
#: First number of steps of a law's own reference, over the stability limit; the least and the
#: largest number. Steps are doubled until the extrapolated answer changes by less than ``SETTLED``
#: of the range. At chi = 1e3 a fixed 4000 steps were wrong by 5e-3 of the range, more than the
#: adaptive scheme claims.
FINE, FEWEST, MOST = 4, 1000, 200_000
SETTLED = 3e-5
#: First number of springs or annuli of the reference under normal laws other than Hertz's, steps
#: for each, and the largest number of doublings of both. The answer has settled when a doubling
#: changes it by less than ``AGREED`` of the range; heavy inertia needs more doublings than a ball.
FINE_PARTS, STEPS_A_PART, DOUBLINGS = 50, 8, 5
AGREED = 3e-3
#: A law fails this check of the kit if its limit under damped normal laws is not Coulomb's law at
#: every point: two laws of which one fails the check have different limits there.
POINTWISE = "coulomb_at_a_point_damped"

#: Returns the exact change of slip velocity in m/s, or None if there is no reference.
Reference = Callable[[Scene, TangentialLaw], float | None]


def converges(law: Law) -> bool:
    """Return whether a law claims to converge to the axisymmetric continuum."""
    return "partial_slip" in claims(law)


def reference_for(law: TangentialLaw, normal: NormalLaw) -> Reference:
    """Return the reference of a tangential law under a normal law.

    Under a normal law other than elastic Hertz contact there is no exact solution. A law that
    converges to the continuum is then judged by another law with the same limit, or else by itself
    at high resolution, a rigid body by the impulse of the friction load. A law of whole impacts
    that has a resolution is judged by itself at twice that.
    """
    elastic = "elastic_hertz" in claims(normal)
    if "no_friction" in claims(law):
        return lambda *_: 0.0
    if "rigid" in claims(law):
        return rigid if elastic else partial(_rigid_under, normal)
    if isinstance(law, WholeImpactTangentialLaw) and law.resolution is not None:
        return partial(finer, normal)
    if converges(law):
        return continuum if elastic else partial(_other_law, normal, judging_laws(normal, law))
    return itself if elastic else lambda *_: None


def rigid(scene: Scene, _: TangentialLaw) -> float:
    """Return the change by the rigid-body theory, min(|psi1|, 4 chi) in psi, as m/s."""
    unit, width, speed = range_of(scene)
    if speed * 1e-6 > width:  # psi1 >> 4 chi: psi2 - psi1 would cancel
        return -float(np.copysign(width, scene.slip_velocity))
    chi = float(scene.chi) if unit * float(scene.chi) else 0.0
    scale = float(unit if chi else speed)
    if scale == 0.0:
        return 0.0
    psi1 = float(scene.slip_velocity) / scale
    return (float(rigid_body_rebound(psi1, chi)) - psi1) * scale


def _rigid_under(normal: NormalLaw, scene: Scene, _: TangentialLaw) -> float:
    """Return the change of a rigid body by the impulse of the friction load, in m/s."""
    impulse = load_impulse(scene, normal)
    sliding = float(scene.friction_coefficient * impulse / scene.pair.tangential_mass)
    slip = float(scene.slip_velocity)
    return -float(np.copysign(min(sliding, abs(slip)), slip))


@lru_cache(maxsize=4096)
def load_impulse(scene: Scene, normal: NormalLaw) -> float:
    """Return the impulse of the friction load under ``normal``, in N s."""
    return float(normal_motion(normal, scene).total_load_impulse)


def continuum(scene: Scene, _: TangentialLaw) -> float | None:
    """Return the change by the exact solution, in m/s; None if it fails."""
    return _exact(scene)


@lru_cache(maxsize=4096)
def _exact(scene: Scene) -> float | None:
    for tolerance in REFERENCE_TOLERANCES:
        result = Simulation(**exact(tolerance)).run(scene)
        if result.status:
            return float(result.motion.slip_velocity_change)
    return None


def _other_law(
    normal: NormalLaw, candidates: list[type[TangentialLaw]], scene: Scene, _: TangentialLaw
) -> float | None:
    """Return the change by the first candidate that settles, in m/s; None if none does."""
    answers = (fine_under(scene, normal, candidate) for candidate in candidates)
    return next((answer for answer in answers if answer is not None), None)


def judging_laws(normal: NormalLaw, judged: TangentialLaw) -> list[type[TangentialLaw]]:
    """Return the classes of stepped laws that ``judged`` may be judged by, the best first.

    A law fits ``normal``, and needs only the contact radius. First come other laws with the limit
    of ``judged``, or ``judged`` itself if there is none; then laws with another limit. The default
    laws of elastic bodies are tried first, because they are of second order.
    """
    ours = [info.name for info in REGISTRY.installed() if info.distribution == PROJECT]
    same_limit: list[type[TangentialLaw]] = []
    other_limit: list[type[TangentialLaw]] = []
    names = (name for name in ours if kind_of(name) == "tangential")
    for name in (*PREFERRED["elastic"], *names):
        try:
            law = composition.law("tangential", name)
        except (ValueError, PluginError):  # blocked, broken, or an option has no default
            continue
        suits = converges(law) and requirements(law) <= {"radius"} and misfit(normal, law) is None
        suits = suits and shares_loss(law, normal) is shares_loss(judged, normal)
        if suits and _refines(law) and type(law) is not type(judged):
            pointwise = (POINTWISE in law.expected_failures, POINTWISE in judged.expected_failures)
            (same_limit if pointwise[0] is pointwise[1] else other_limit).append(type(law))
    itself_too = [type(judged)] if not same_limit and _refines(judged) else []
    return [*same_limit, *itself_too, *other_limit]


def _refines(law: TangentialLaw) -> bool:
    """Return whether a law is stepped and has a resolution."""
    return isinstance(law, SteppedTangentialLaw) and law.resolution is not None


@lru_cache(maxsize=4096)
def fine_under(scene: Scene, normal: NormalLaw, law: type[TangentialLaw]) -> float | None:
    """Return the change in m/s by a fine law of class ``law``; None if it does not settle."""
    assert law.resolution is not None
    width = range_of(scene).width
    before = np.inf
    for parts in FINE_PARTS * 2 ** np.arange(DOUBLINGS + 1):
        fine = law(**{law.resolution: int(parts)})
        march = fixed_steps(STEPS_A_PART * int(parts))
        result = Simulation(normal=normal, tangential=fine, integrator=march).run(scene)
        if not result.status:
            return None
        change = float(result.motion.slip_velocity_change)
        if abs(change - before) <= AGREED * width:
            return change
        before = change
    return None


@lru_cache(maxsize=4096)
def finer(normal: NormalLaw, scene: Scene, law: TangentialLaw) -> float | None:
    """Return the change by a law of whole impacts at twice its resolution, in m/s; None if none."""
    assert law.resolution is not None
    try:
        fine = with_parameters(law, {law.resolution: 2 * resolution_of(law)})
    except ValueError:  # the law does not accept the finer value
        return None
    result = Simulation(normal=normal, tangential=fine).run(scene)
    return float(result.motion.slip_velocity_change) if result.status else None


@lru_cache(maxsize=4096)
def itself(scene: Scene, law: TangentialLaw) -> float | None:
    """Return the change by the law itself at many more steps, in m/s; None if not settled.

    It is extrapolated at second order.
    """
    if not isinstance(law, SteppedTangentialLaw):
        return None
    coarse = Simulation(tangential=law, integrator=fixed_steps(FEWEST))
    normal = coarse.normal_motion(scene)
    frequency = np.sqrt(law.stiffness(scene, normal) / scene.pair.tangential_mass)
    steps = max(FINE * (int(0.5 * frequency * normal.duration) + 1), FEWEST)
    width = range_of(scene).width
    before = limit = np.nan
    while steps <= MOST:
        fine = Simulation(tangential=law, integrator=fixed_steps(steps)).run(scene)
        if not fine.status:
            return None
        change = float(fine.motion.slip_velocity_change)
        last, limit = limit, change + (change - before) / 3.0
        if abs(limit - last) <= SETTLED * width:
            return limit
        before = change
        steps = 2 * int(fine.counters.get("steps", steps))  # the integrator may have refined them
    return None
