"""Checks with real bodies of unlike radii, moduli and masses, exchanged, and with spin."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from functools import partial
from typing import Any

import numpy as np

from contactlab.compose.simulation import Simulation
from contactlab.contracts import Integrator, NormalLaw, TangentialLaw
from contactlab.impact.bodies import Sphere
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.testing.bench import FRICTION
from contactlab.testing.check import check, hold
from contactlab.testing.integrators import marched, sound
from contactlab.testing.normal import STEPS, respond
from contactlab.testing.ways import Way, ways

#: Bodies of a scene: radius (m), shear modulus (Pa), Poisson's ratio and mass (kg) of one ball.
BALL = {"radius": 0.0127, "shear_modulus": 8e10, "poisson_ratio": 0.3, "mass": 0.067}
#: The other ball, where it is unlike in that quantity.
OTHER = {"radius": 0.004, "shear_modulus": 2.6e10, "poisson_ratio": 0.2, "mass": 0.01}
#: What of the pair a law should take in place of each quantity of one body.
PAIR = {
    "radius": "pair.radius, 1/R = 1/R1 + 1/R2",
    "shear_modulus": "pair.effective_modulus E* and pair.effective_shear_modulus G*",
    "poisson_ratio": "pair.effective_modulus E* and pair.effective_shear_modulus G*",
    "mass": "pair.normal_mass M_n and pair.tangential_mass M_t",
}
SPEED = 0.83
#: psi1 of the impacts: they stick, slip throughout, and slip in part.
ANGLES = (0.5, 9.0, 2.0)
#: Tangential velocity of the centre over v_x; the rest of v_x is spin.
SHARES = (0.0, 0.4, 2.5, -1.0)
#: What rounding may do to psi, over max(1, psi1).
ROUNDING = 1e-8


def ball(changed: str = "") -> Sphere:
    """Return the ball of these checks, unlike in one quantity."""
    numbers = dict(BALL)
    if changed:
        numbers[changed] = OTHER[changed]
    material = Material(
        shear_modulus=numbers["shear_modulus"], poisson_ratio=numbers["poisson_ratio"]
    )
    return Sphere(numbers["radius"], material, mass=numbers["mass"])


def unlike(changed: str, psi1: float) -> tuple[Scene, Scene, Scene]:
    """Return a scene of two balls unlike in one quantity, the same exchanged, and of their pair."""
    one, other = ball(), ball(changed)
    still = Scene(one, other, FRICTION, SPEED, 0.0)
    slip = psi1 / float(still.psi_scale)
    return (
        Scene(one, other, FRICTION, SPEED, slip),
        Scene(other, one, FRICTION, SPEED, slip),
        Scene(None, None, FRICTION, SPEED, slip, pair=still.pair),
    )


def _hold_pairs(change: Callable[[Scene], Any], how: str) -> None:
    """Hold that a change of slip velocity (m/s) is that of the pair, whichever ball is first."""
    pairs: dict[str, Any] = {}
    for quantity in BALL:
        for psi1 in ANGLES:
            here, there, alone = unlike(quantity, psi1)
            expected = change(here)
            pairs[quantity] = psi1, here, alone, expected
            gap = _gap(here, expected, change(there))
            hold(
                gap <= ROUNDING,
                f"Balls unlike in {quantity}, psi1 = {psi1}: exchanged, psi2 differs by {gap:.2g} "
                f"({how}). Take {PAIR[quantity]}, not the {quantity} of one body."
                f" Bound: {ROUNDING:.2g}.",
            )
    for quantity, (psi1, here, alone, expected) in pairs.items():
        gap = _gap(here, expected, change(alone))
        hold(
            gap <= ROUNDING,
            f"Balls unlike in {quantity}, psi1 = {psi1}: psi2 is {gap:.2g} off that of a scene "
            f"with the same pair and no bodies ({how})."
            f" Bound: {ROUNDING:.2g}.",
        )


def _hold_spin(change: Callable[[Scene], Any], how: str) -> None:
    """Hold that a change of slip velocity (m/s) depends on v_x = v + omega R alone."""
    one = ball()
    for psi1 in ANGLES:
        still = Scene(one, one, FRICTION, SPEED, 0.0)
        slip = psi1 / float(still.psi_scale)
        expected = change(Scene(one, one, FRICTION, SPEED, slip))
        for share in SHARES:
            spin = (1.0 - share) * slip / float(one.radius)
            spun = Scene(one, one, FRICTION, SPEED, share * slip, spin)
            gap = _gap(still, expected, change(spun))
            hold(
                gap <= ROUNDING,
                f"psi1 = {psi1}, of which spin is {1.0 - share:.2g}: psi2 differs by {gap:.2g} "
                f"from an impact without spin ({how}). Take scene.slip_velocity, v + omega R."
                f" Bound: {ROUNDING:.2g}.",
            )


def _gap(scene: Scene, one: Any, other: Any) -> float:
    """Return the difference of two changes of slip velocity in psi; NaN is infinitely far off."""
    gap = abs(float(np.asarray(one)) - float(np.asarray(other))) * float(scene.psi_scale)
    return math.inf if math.isnan(gap) else gap


def _run(way: Way, given: Scene) -> Any:
    """Return the change of slip velocity in a way of running a law, in m/s."""
    return way.run(given).motion.slip_velocity_change


def _march(simulation: Simulation, given: Scene) -> Any:
    """Return the change of slip velocity by the integrator alone, in m/s."""
    return marched(simulation, given).slip_velocity_change


def _changes(law: Any) -> Iterator[tuple[Callable[[Scene], Any], str]]:
    """Iterate over the ways of a tangential law: its change of slip velocity, and words."""
    for way in ways(law):
        yield partial(_run, way), str(way)


def _marches(integrator: Any) -> Iterator[tuple[Callable[[Scene], Any], str]]:
    """Iterate over the same of an integrator under the sound laws of the kit."""
    for simulation in sound(integrator):
        yield partial(_march, simulation), type(simulation.tangential).__name__


@check(TangentialLaw)
def unlike_bodies(law: Any) -> None:
    """Unlike balls rebound as their pair does, whichever is called the sphere (theory §1)."""
    for change, how in _changes(law):
        _hold_pairs(change, how)


@check(TangentialLaw)
def spin(law: Any) -> None:
    """Of one slip velocity it does not matter what part of it is spin, eq. (20)."""
    for change, how in _changes(law):
        _hold_spin(change, how)


@check(Integrator)
def unlike_bodies_by(integrator: Any) -> None:
    """Unlike balls are followed as their pair is, whichever is called the sphere (theory §1)."""
    for change, how in _marches(integrator):
        _hold_pairs(change, how)


@check(Integrator)
def spin_by(integrator: Any) -> None:
    """Of one slip velocity it does not matter what part of it is spin, eq. (20)."""
    for change, how in _marches(integrator):
        _hold_spin(change, how)


@check(NormalLaw)
def contacts_unlike(law: Any) -> None:
    """Unlike balls press as their pair does, whichever is called the sphere (theory §1)."""
    for which, words in ((1, "exchanged, the"), (2, "in a scene of the pair without bodies, the")):
        for quantity in BALL:
            scenes = unlike(quantity, 0.0)
            here, there = _course(law, scenes[0]), _course(law, scenes[which])
            for name, one, other in zip(("force", "radius"), here, there, strict=False):
                gap = float(np.max(np.abs(one - other))) / max(float(np.max(np.abs(one))), 1e-300)
                hold(
                    gap <= ROUNDING,
                    f"Balls unlike in {quantity}: {words} {name} differs by {gap:.2g} of its "
                    f"maximum. Take {PAIR[quantity]}, not the {quantity} of one body."
                    f" Bound: {ROUNDING:.2g}.",
                )


def _course(law: Any, given: Scene) -> Any:
    """Return force, radius and so on as two balls are pressed together and let go."""
    x = np.linspace(0.0, math.pi, STEPS)
    depth, speed = float(hertz_scales(given).approach), float(np.asarray(given.normal_speed))
    return respond(law, given, depth * np.sin(x), speed * np.cos(x))
