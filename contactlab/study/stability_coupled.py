"""Extreme impacts in which friction changes the approach: jams, stiff contacts."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import lru_cache, partial
from typing import Any

import numpy as np

from contactlab.contracts.integrator import CoupledIntegrator
from contactlab.contracts.law import claims
from contactlab.contracts.status import Status
from contactlab.contracts.tangential import (
    CausalTangentialLaw,
    CoupledTangentialLaw,
    TangentialLaw,
)
from contactlab.impact.bodies import Pair
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array, Real
from contactlab.outcome.result import ImpactResult
from contactlab.registry.composition import fixed_steps
from contactlab.registry.registry import PluginError
from contactlab.runs.simulation import Simulation
from contactlab.solve.solve import accept_scene
from contactlab.study.bench_methods import Method

#: 1 over 1 - lam eta/(2 chi): the condition of the inverse mass, scaled to ones on the diagonal.
CONDITIONS, LAMS, CHIS = (1e2, 1e6), (0.3, -2.0, -1e3), (0.5, 3.0)
PSI1 = (1e-12, 1.5, 1e6)
#: kappa of stiff contacts; rods by angle, friction and slip over approach.
KAPPAS, RODS = (1e2, 1e4, 1e6), ((15.0, 0.3, 0.0), (-30.0, 0.3, 0.5), (75.0, 0.01, 1e-9))
#: Stiff contacts end as rigid bodies do, to this over the root of kappa (5e-3 at 1e4).
STIFF, RIGID_DISTANCE = 1e4, 0.6
#: chi of the impacts in space, whose slip turns, and their psi1.
SPACE_CHIS, QUICK_SPACE_CHIS = (0.05, 0.5, 3.0, 30.0, 1e3), (0.05, 3.0, 1e3)
SPACE_PSI1 = ((0.9, 0.5), (0.3, -0.1))
#: chi, over its first entry, and lam and rho of the impacts in space.
SPACE_CHI, SPACE_LAM, SPACE_RHO = np.array([[1.0, 0.2], [0.2, 1.6]]), (0.1, -0.05), 1.0
#: Steps of the reference in space, over the root of chi, and the fewest: see ``refine_in_space``.
SPACE_FINE, SPACE_FEWEST = 150.0, 1600


def space_scenes(*, quick: bool) -> Iterator[tuple[str, Callable[[], Scene]]]:
    """Iterate over labels and makers of impacts in space, whose slip turns."""
    for chi in QUICK_SPACE_CHIS if quick else SPACE_CHIS:
        for psi1 in SPACE_PSI1[: 1 if quick else None]:
            numbers: dict[str, Any] = {
                "psi1": psi1,
                "chi": chi * SPACE_CHI,
                "lam": SPACE_LAM,
                "rho": SPACE_RHO,
            }
            yield f"psi1={psi1} chi={chi:g}", partial(Scene.nondimensional, **numbers)


def answers_space(method: Method) -> bool:
    """Return whether a method that answers coupled impacts answers those whose slip turns too."""
    _, make = next(space_scenes(quick=True))
    laws = method.simulation({"tangential": {}, "integrator": {}}).laws
    try:
        accept_scene(laws, make())
    except ValueError:
        return False
    return True


def in_space(scene: Scene) -> bool:
    """Return whether the slip of one impact is a vector."""
    return np.ndim(scene.slip_velocity) == 1


@lru_cache(maxsize=64)
def refine_in_space(law: TangentialLaw, scene: Scene) -> Array | None:
    """Return psi2 in space by the same law in many steps; None if the law refuses them.

    Springs are then within 0.001 of psi1 of twice as many steps.
    """
    chi = float(np.max(scene.chi))
    try:
        march = fixed_steps(max(SPACE_FEWEST, round(SPACE_FINE * math.sqrt(chi))))
        result = Simulation(tangential=law, integrator=march).run(scene)
    except (ValueError, PluginError):
        return None
    return np.asarray(result.psi2) if result.status is Status.SUCCESS else None


def coupled_scenes(*, quick: bool) -> Iterator[tuple[str, Callable[[], Scene]]]:
    """Iterate over labels and makers of the scenes; ``quick`` takes those that are soon done."""
    for condition in CONDITIONS[: 1 if quick else None]:
        for lam in LAMS:
            for chi in CHIS[: 1 if quick else None]:
                eta = 2.0 * chi * (1.0 - 1.0 / condition) / lam
                for psi1 in PSI1:
                    label = f"psi1={psi1:g} chi={chi:g} lam={lam:g} condition={condition:g}"
                    numbers = {"psi1": psi1, "chi": chi, "lam": lam, "eta": eta}
                    yield label, partial(Scene.nondimensional, **numbers)
    for kappa in KAPPAS[: 1 if quick else None]:
        for angle, friction, slip in RODS:
            label = f"rod of {angle:g} degrees, mu={friction:g}, kappa={kappa:g}"
            yield label, partial(rod, angle, friction, slip, kappa=kappa)


def rod(angle: float, friction: float, slip: float, *, kappa: float) -> Scene:
    """Return a uniform rod of mass and length 1 that meets a plane with its end.

    Parameters
    ----------
    angle : float
        Between rod and normal, in degrees; positive where friction lessens the approach.
    friction, slip : float
        Coulomb's mu; slip velocity over the speed of approach.
    kappa : float
        G*/E* of the contact.
    """
    a, b = math.sin(math.radians(angle)) / 2.0, math.cos(math.radians(angle)) / 2.0
    W = np.diag((1.0 + 12.0 * a * a, 1.0 + 12.0 * b * b, 1.0))
    W[0, 1] = W[1, 0] = 12.0 * a * b
    pair = Pair(
        radius=1.0,
        effective_modulus=1.0,
        effective_shear_modulus=kappa,
        normal_mass=1.0 / W[0, 0],
        tangential_mass=1.0 / W[1, 1],
    )
    return Scene(None, None, friction, 1.0, slip, pair=pair, inverse_mass=W)


def tries_bodies(method: Method) -> bool:
    """Return whether the method answers coupled impacts, by partial slip or as rigid bodies."""
    simulation = method.simulation({"tangential": {}, "integrator": {}})
    law = simulation.tangential
    if isinstance(law, CoupledTangentialLaw):
        return True
    stepped = isinstance(law, CausalTangentialLaw)
    return (
        stepped
        and "partial_slip" in claims(law)
        and isinstance(simulation.integrator, CoupledIntegrator)
    )


def distance(one: ImpactResult, other: ImpactResult) -> Real:
    """Return the distance of rates and slip velocities after two impacts, over v1."""
    rate = np.subtract(one.normal_restitution, other.normal_restitution)
    slip = np.subtract(one.rebound_slip_velocity, other.rebound_slip_velocity)
    off: Real = np.hypot(rate, slip / one.scene.normal_speed)
    return off
