"""What the answers are judged against: each law's own exact answer.

A law that leaves something out (a rigid body has no partial slip) is not unstable for that. So
the laws that converge to the continuum are judged by the exact solution, a rigid body by its
closed form, and any other law by itself at high resolution.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from contactlab.compose.composition import PREFERRED, exact, fixed_steps, misfit
from contactlab.compose.hookspecs import PROJECT
from contactlab.compose.names import full_name, kind_of
from contactlab.compose.normal_motion import normal_motion
from contactlab.compose.registry import REGISTRY, PluginError
from contactlab.compose.simulation import Simulation
from contactlab.contracts import Law, NormalLaw, SteppedTangentialLaw, TangentialLaw
from contactlab.contracts.error_model import range_of
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.impact.scene import Scene

KIND = "tangential"
#: Closer than the default, so that the default can be judged.
REFERENCE_TOLERANCES = (1e-11, 1e-9)
#: Steps that a law's own reference begins with: this many times the stability limit, and no
#: fewer. They are doubled until the answer, extrapolated, stands still to ``SETTLED`` of the
#: range. At chi = 1e3 a fixed 4000 were wrong by 5e-3, more than the adaptive scheme claims.
FINE, FEWEST, MOST = 4, 1000, 200_000
SETTLED = 3e-5
#: Springs or annuli that the reference under normal laws that are not Hertz's begins with, steps
#: for each, and how often both are doubled until the answer stands still to ``AGREED`` of the
#: range: a heavy inertia needs many more than a ball.
FINE_PARTS, STEPS_A_PART, DOUBLINGS = 50, 8, 5
AGREED = 3e-3

#: Change of slip velocity in m/s, or None where there is nothing to judge by.
Reference = Callable[[Scene, TangentialLaw], float | None]


def converges(law: Law | type[Law]) -> bool:
    """Return whether a law converges to the axisymmetric continuum, by what it claims."""
    return "partial_slip" in law.offers


def reference_for(law: TangentialLaw, normal: NormalLaw) -> Reference:
    """Return how answers of a tangential law under a normal law are judged.

    Under a normal law that is not elastic Hertz contact there is no exact solution: laws that
    converge to the continuum are judged by another of them, a rigid body by the impulse of the
    load.
    """
    elastic = "elastic_hertz" in normal.offers
    if "no_friction" in law.offers:
        return none
    if "rigid" in law.offers:
        return rigid if elastic else _rigid_under(normal)
    if converges(law):
        return continuum if elastic else _another(normal, type(law))
    return itself if elastic else nothing


def none(scene: Scene, law: TangentialLaw) -> float:  # noqa: ARG001
    """Return no change."""
    return 0.0


def nothing(scene: Scene, law: TangentialLaw) -> None:
    """Return that there is nothing to judge by."""


def _another(normal: NormalLaw, judged: type[TangentialLaw]) -> Reference:
    name = another_of_the_continuum(normal, judged)
    return nothing if name is None else lambda scene, _: fine_under(scene, normal, name)


def another_of_the_continuum(normal: NormalLaw, judged: type[TangentialLaw]) -> str | None:
    """Return a stepped law of the continuum that fits ``normal`` and is another than ``judged``.

    It needs nothing of the normal contact but its radius. The defaults of elastic bodies come
    first, which are of second order, then the other laws of contactlab by name; None if there is
    none.
    """
    ours = [info.name for info in REGISTRY.installed() if info.distribution == PROJECT]
    for name in (*PREFERRED["elastic"], *(name for name in ours if kind_of(name) == KIND)):
        try:
            found = REGISTRY.create(full_name(KIND, name))
        except (ValueError, PluginError):  # blocked, broken, or it needs options
            continue
        refines = isinstance(found, SteppedTangentialLaw) and found.resolution is not None
        suits = converges(found) and found.needs <= {"radius"} and misfit(normal, found) is None
        if refines and suits and type(found) is not judged:
            return name
    return None


@lru_cache(maxsize=4096)
def fine_under(scene: Scene, normal: NormalLaw, name: str) -> float | None:
    """Return the change under ``normal`` by a fine law of the continuum; None if none settles."""
    law: Any = REGISTRY.law_class(full_name("tangential", name))
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
def load_impulse(scene: Scene, normal: NormalLaw) -> float:
    """Return the impulse of the friction load under ``normal``, in N s."""
    return float(normal_motion(normal, scene).total_load_impulse)


def _rigid_under(normal: NormalLaw) -> Reference:
    def change(scene: Scene, _: TangentialLaw) -> float:
        load = load_impulse(scene, normal)
        most = float(scene.friction_coefficient * load / scene.pair.tangential_mass)
        slip = float(scene.slip_velocity)
        return -float(np.copysign(min(most, abs(slip)), slip))

    return change


def rigid(scene: Scene, law: TangentialLaw) -> float:  # noqa: ARG001
    """Return the change of the rigid-body theory, |change| = min(|psi1|, 4 chi)."""
    unit, width, speed = range_of(scene)
    if speed * 1e-6 > width:  # far inside gross slip, where psi2 would swallow the change
        return -float(np.copysign(width, scene.slip_velocity))
    scale: float = speed if unit * float(scene.chi) == 0.0 else unit
    if scale == 0.0:
        return 0.0
    psi1 = float(scene.slip_velocity) / scale
    ratio = 0.0 if scale != unit else float(scene.chi)
    return (float(rigid_body_rebound(psi1, ratio)) - psi1) * scale


def continuum(scene: Scene, law: TangentialLaw) -> float | None:  # noqa: ARG001
    """Return the change of the exact solution."""
    return _exact(scene)


@lru_cache(maxsize=4096)
def _exact(scene: Scene) -> float | None:
    for tolerance in REFERENCE_TOLERANCES:
        result = Simulation(**exact(tolerance)).run(scene)
        if result.status:
            return float(result.motion.slip_velocity_change)
    return None


def itself(scene: Scene, law: TangentialLaw) -> float | None:
    """Return the change of the same law at many more steps."""
    return _fine(scene, law) if isinstance(law, SteppedTangentialLaw) else None


@lru_cache(maxsize=4096)
def _fine(scene: Scene, law: SteppedTangentialLaw) -> float | None:
    """Return the extrapolated limit of second order, or None if it is not reached."""
    coarse = Simulation(tangential=law, integrator=fixed_steps(FEWEST))
    normal = coarse.normal_motion(scene)
    frequency = np.sqrt(law.stiffness(scene, normal) / scene.pair.tangential_mass)
    steps = max(FINE * (int(0.5 * frequency * normal.duration) + 1), FEWEST)
    width = range_of(scene).width
    answers: list[float] = []
    limits: list[float] = []
    while steps <= MOST:
        fine = Simulation(tangential=law, integrator=fixed_steps(steps)).run(scene)
        if not fine.status:
            return None
        answers.append(float(fine.motion.slip_velocity_change))
        if len(answers) > 1:
            limits.append(answers[-1] + (answers[-1] - answers[-2]) / 3.0)
        if len(limits) > 1 and abs(limits[-1] - limits[-2]) <= SETTLED * width:
            return limits[-1]
        steps = 2 * int(fine.counters.get("steps", steps))  # it may have refined those asked for
    return None
