"""Checks with spheres of unlike radii, moduli and masses, exchanged, and with spin."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import Integrator, NormalLaw, TangentialLaw
from contactlab.impact.bodies import Sphere
from contactlab.impact.hertz import hertz_scales
from contactlab.impact.material import Material
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Array
from contactlab.testing.check import check, within, worst
from contactlab.testing.load_paths import FRICTION
from contactlab.testing.normal import STEPS, respond
from contactlab.testing.ways import Solved, Way, ways

#: Radius (m), shear modulus (Pa), Poisson's ratio and mass (kg) of a ball.
BALL = {"radius": 0.0127, "shear_modulus": 8e10, "poisson_ratio": 0.3, "mass": 0.067}
#: The same quantities of a ball that differs in one of them.
OTHER = {"radius": 0.004, "shear_modulus": 2.6e10, "poisson_ratio": 0.2, "mass": 0.01}
#: Quantities of the pair that a law should use instead of a quantity of one body.
PAIR = {
    "radius": "pair.radius, 1/R = 1/R1 + 1/R2",
    "shear_modulus": "pair.effective_modulus E* and pair.effective_shear_modulus G*",
    "poisson_ratio": "pair.effective_modulus E* and pair.effective_shear_modulus G*",
    "mass": "pair.normal_mass M_n and pair.tangential_mass M_t",
}
#: Normal speed of these impacts in m/s, as of the kit's other scenes.
SPEED = 0.83
#: psi1 of impacts that stick, slip throughout, and slip in part.
ANGLES = (0.5, 9.0, 2.0)
#: Tangential velocity of the centre over v_x; spin makes the rest of v_x.
SHARES = (0.0, 0.4, 2.5, -1.0)
#: Bound of differences of psi2 by rounding.
ROUNDING = 1e-8


def ball(changed: str = "") -> Sphere:
    """Return the ball of these checks; ``changed`` names a quantity in which it differs."""
    numbers = dict(BALL)
    if changed:
        numbers[changed] = OTHER[changed]
    material = Material(
        shear_modulus=numbers["shear_modulus"], poisson_ratio=numbers["poisson_ratio"]
    )
    return Sphere(numbers["radius"], material, mass=numbers["mass"])


def unlike(changed: str, psi1: float) -> tuple[Scene, Scene, Scene]:
    """Return scenes of two unlike balls, of the balls exchanged, and of their pair alone."""
    first, second = ball(), ball(changed)
    still = Scene(first, second, FRICTION, SPEED, 0.0)
    slip = psi1 / float(still.psi_scale)
    return (
        Scene(first, second, FRICTION, SPEED, slip),
        Scene(second, first, FRICTION, SPEED, slip),
        Scene(None, None, FRICTION, SPEED, slip, pair=still.pair),
    )


def _hold_pairs(way: Way) -> None:
    """Hold that the change of slip velocity (m/s) depends on the pair alone."""
    pairs: dict[str, Any] = {}
    for quantity in BALL:
        for psi1 in ANGLES:
            first, exchanged, pair_only = unlike(quantity, psi1)
            expected = way.run(first)
            pairs[quantity] = psi1, first, pair_only, expected
            gap = _gap(first, expected, way.run(exchanged))
            within(
                gap,
                ROUNDING,
                f"Balls unlike in {quantity}, psi1 = {psi1}: exchanged, psi2 differs by {gap:.2g} "
                f"({way}). Take {PAIR[quantity]}, not the {quantity} of one body.",
            )
    for quantity, (psi1, first, pair_only, expected) in pairs.items():
        gap = _gap(first, expected, way.run(pair_only))
        within(
            gap,
            ROUNDING,
            f"Balls unlike in {quantity}, psi1 = {psi1}: psi2 is {gap:.2g} off that of a scene "
            f"with the same pair and no bodies ({way}).",
        )


def _hold_spin(way: Way) -> None:
    """Hold that the change of slip velocity (m/s) depends on v_x = v + omega R alone."""
    sphere = ball()
    for psi1 in ANGLES:
        still = Scene(sphere, sphere, FRICTION, SPEED, 0.0)
        slip = psi1 / float(still.psi_scale)
        expected = way.run(Scene(sphere, sphere, FRICTION, SPEED, slip))
        for share in SHARES:
            spin = (1.0 - share) * slip / float(sphere.radius)
            spun = Scene(sphere, sphere, FRICTION, SPEED, share * slip, spin)
            gap = _gap(still, expected, way.run(spun))
            within(
                gap,
                ROUNDING,
                f"psi1 = {psi1}, of which spin is {1.0 - share:.2g}: psi2 differs by {gap:.2g} "
                f"from an impact without spin ({way}). Take scene.slip_velocity, v + omega R.",
            )


def _gap(scene: Scene, expected: Solved, answer: Solved) -> float:
    """Return the difference of two changes of slip velocity, in psi; infinity for NaN."""
    changes = [each.motion.slip_velocity_change for each in (expected, answer)]
    return worst(changes[0] - changes[1]) * float(scene.psi_scale)


@check(TangentialLaw, Integrator)
def unlike_bodies(law: TangentialLaw | Integrator) -> None:
    """Impacts of unlike balls depend on the pair alone, not on their order (theory §1)."""
    for way in ways(law):
        _hold_pairs(way)


@check(TangentialLaw, Integrator)
def spin(law: TangentialLaw | Integrator) -> None:
    """The rebound depends on the slip velocity, not on the part that is spin, eq. (20)."""
    for way in ways(law):
        _hold_spin(way)


@check(NormalLaw)
def contacts_unlike(law: NormalLaw) -> None:
    """Contacts of unlike balls depend on the pair alone, not on their order (theory §1)."""
    for which, words in ((1, "exchanged, the"), (2, "in a scene of the pair without bodies, the")):
        for quantity in BALL:
            scenes = unlike(quantity, 0.0)
            course, other_course = _course(law, scenes[0]), _course(law, scenes[which])
            for name, expected, value in zip(
                ("force", "radius"), course, other_course, strict=False
            ):
                gap = float(np.max(np.abs(expected - value))) / max(
                    float(np.max(np.abs(expected))), 1e-300
                )
                within(
                    gap,
                    ROUNDING,
                    f"Balls unlike in {quantity}: {words} {name} differs by {gap:.2g} of its "
                    f"maximum. Take {PAIR[quantity]}, not the {quantity} of one body.",
                )


def _course(law: NormalLaw, impact: Scene) -> Array:
    """Return force, radius, overlap and friction load of a press and release, shape (4, K)."""
    x = np.linspace(0.0, math.pi, STEPS)
    depth, speed = float(hertz_scales(impact).approach), float(np.asarray(impact.normal_speed))
    return respond(law, impact, depth * np.sin(x), speed * np.cos(x))
