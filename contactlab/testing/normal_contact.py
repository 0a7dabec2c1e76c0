"""Checks of a normal law's contact: force, friction load, and the radius that it claims."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import NormalLaw
from contactlab.impact.hertz import hertz_scales
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import check, hold, within
from contactlab.testing.normal import ROUNDING, STEPS, respond, strokes

#: Contact radius squared over R times approach: 1 for an elastic sphere, 2 for a material that
#: neither sinks in nor piles up as it flows (Johnson, Contact Mechanics, §6.3).
ELASTIC, GEOMETRIC = 1.0, 2.0
#: Difference from either value that adhesion and roughness may cause.
ROOM = 0.02
#: Distances from first touch over the largest approach: the nearest, and the farthest outside.
NEAR, BEHIND = 1e-9, 0.5


@check(NormalLaw)
def presses(law: NormalLaw) -> None:
    """Force, radius and friction load vanish out of contact; no friction load is negative.

    In contact the force may be negative, but the friction load may not.
    """
    impact, approach, rate = strokes()
    depth, speed = float(approach.max()), float(impact.normal_speed)
    depths = depth * np.concatenate(([0.0], np.geomspace(NEAR, 1.0, STEPS)))
    behind = -depth * np.geomspace(NEAR, BEHIND, STEPS)
    approach = np.concatenate((depths, depths[::-1], behind))
    rate = speed * np.where(np.arange(len(approach)) < len(depths), 1.0, -1.0)
    force, radius, overlap, load = respond(law, impact, approach, rate)
    hold(load.min() >= 0.0, f"A friction load of {load.min():.3g} N is negative.")
    hold(radius.min() >= 0.0, f"A contact radius of {radius.min():.3g} m is negative.")
    outside = overlap <= 0.0
    hold(np.all(force[outside] == 0.0), "There is force out of contact.")
    hold(np.all(radius[outside] == 0.0), "There is a contact radius out of contact.")
    hold(np.all(load[outside] == 0.0), "There is a friction load out of contact.")
    hold(force.max() > 0.0, "There is no force at any approach.")
    hold(
        overlap[len(depths) - 1] > 0.0,
        "At the deepest approach the overlap says that there is no contact.",
    )
    hold(outside[-1], "Far behind first touch the overlap says that there is still contact.")


@check(NormalLaw)
def grows(law: NormalLaw) -> None:
    """Force, radius and friction load do not fall as the approach grows at a constant rate.

    In an impact a damped force reaches its maximum before the approach does.
    """
    impact, approach, rate = strokes()
    depths = np.linspace(0.0, float(approach[STEPS]), STEPS + 1)
    steady = np.full_like(depths, 0.5 * float(rate.max()))
    force, radius, _, load = respond(law, impact, depths, steady)
    for name, column in (("force", force), ("radius", radius), ("friction load", load)):
        fall = -float(np.min(np.diff(column))) / max(float(column.max()), 1e-300)
        within(fall, ROUNDING, f"The {name} falls by {fall:.2g} of its maximum in compression.")


@check(NormalLaw, claim="radius")
def radius(law: NormalLaw) -> None:
    """A law that offers ``radius`` has a positive contact radius wherever it presses.

    First touch is excepted, because a dashpot presses there on a point.
    """
    impact, approach, rate = strokes()
    force, radii, _, _ = respond(law, impact, approach, rate)
    pressed = (force > 1e-6 * force.max()) & (approach > 0.0)
    hold(
        np.all(radii[pressed] > 0.0),
        "The law offers 'radius', but gives no radius where the bodies press.",
    )
    deepest = int(approach.argmax())
    share = float(radii[deepest] ** 2) / (impact.pair.radius * float(approach[deepest]))
    hold(
        ELASTIC - ROOM <= share <= GEOMETRIC + ROOM,
        f"b² is {share:.3g} R z at greatest compression: {ELASTIC:g} of an elastic sphere (2), "
        f"and {GEOMETRIC:g}, the section of sphere and plane, at most.",
    )


@check(NormalLaw, claim="hertzian_pressure")
def hertzian_pressure(law: NormalLaw) -> None:
    """b² is R z (2) if the law is elastic, and between R z and 2 R z at greatest compression.

    The force does not give the radius of a hemisphere of pressure under a damped or plastic law,
    but geometry bounds the radius. A law without adhesion, and without memory at rest, is elastic
    but for damping: b² = R z (2). If the material flows, b² lies between R z and 2 R z at greatest
    compression, and never exceeds 2 R z_max.
    """
    impact, stroke, rate = strokes()
    R = float(impact.pair.radius)
    depths = np.linspace(0.0, float(stroke.max()), STEPS + 1)
    course = np.concatenate((depths, depths[::-1]))
    for name, approach, speed in (
        ("At rest", course, np.zeros_like(course)),
        ("In an impact", stroke, rate),
    ):
        force, radius, _, _ = respond(law, impact, approach, speed)
        deepest = int(approach.argmax())
        share = float(radius[deepest] ** 2) / (R * float(approach[deepest]))
        hold(
            share >= ELASTIC - ROOM,
            f"{name} b² is {share:.3g} R z at greatest compression: less than an elastic "
            "sphere's (2).",
        )
        share = float(np.max(radius**2)) / (R * float(approach.max()))
        within(
            share,
            GEOMETRIC + ROOM,
            f"{name} b² comes to {share:.3g} R z_max: 2 is the most, the section of sphere and "
            "plane.",
        )
        if name == "At rest":
            forgets = float(np.max(np.abs(force - force[::-1]))) <= ROUNDING * float(force.max())
            pulls = float(force.min()) < 0.0  # adhesion widens an elastic contact too
            hold(
                share <= ELASTIC + ROOM or pulls or not forgets,
                f"{name} its force is that of an elastic body, and b² is {share:.3g} R z, not "
                "that of eq. (2).",
            )


@check(NormalLaw, word=("viscous", True))
def viscous(law: NormalLaw) -> None:
    """A viscous law has Hertz's radius and force at rest, and more in approach (Law, 3)."""
    impact, approach, _ = strokes()
    depths = np.linspace(0.02, 1.0, STEPS) * float(approach.max())
    exact = np.sqrt(impact.pair.radius * depths)
    pressed = (4.0 / 3.0) * impact.pair.effective_modulus * exact * depths
    rest, _, _, _ = respond(law, impact, depths, np.zeros_like(depths))
    gap = float(np.max(np.abs(rest / pressed - 1.0)))
    within(gap, ROUNDING, f"The law is viscous, and its force at rest is {gap:.2g} off Hertz's.")
    rates = np.full_like(depths, float(impact.normal_speed))
    force, radii, _, _ = respond(law, impact, depths, rates)
    gap = float(np.max(np.abs(radii / exact - 1.0)))
    within(
        gap, ROUNDING, f"The law is viscous, and its radius is {gap:.2g} off Hertz's in approach."
    )
    hold(np.all(force > rest), "The law is viscous, and resists an approach no more than rest.")


@check(NormalLaw, claim="kelvin_voigt")
def kelvin_voigt(law: NormalLaw) -> None:
    """In unloading the pressure is Hertz's over b² = R (z + A z'), with one relaxation time A."""
    impact, approach, _ = strokes()
    pair, speed = impact.pair, float(impact.normal_speed)
    depth, rates = float(approach.max()), -speed * np.geomspace(1e-3, 1.0, STEPS)
    force, radii, _, _ = respond(law, impact, np.full(STEPS, depth), rates)
    hertz = (4.0 / 3.0) * pair.effective_modulus * radii**3 / pair.radius
    gap = float(np.max(np.abs(force - hertz)) / np.max(hertz))
    within(gap, ROUNDING, f"In unloading its force is {gap:.2g} off Hertz's over its radius.")
    touching = radii > 0.0
    times = (depth - radii**2 / pair.radius)[touching] / -rates[touching]
    gap = float(np.ptp(times) / np.max(times))
    within(gap, 1e-6, f"In unloading its relaxation times differ by {gap:.2g}.")


@check(NormalLaw, claim="elastic_hertz")
def elastic_hertz(law: NormalLaw) -> None:
    """Radius (2), force (4) and impact (7)-(9) agree with elastic Hertz contact."""
    impact, approach, rate = strokes()
    pair, inside = impact.pair, np.maximum(approach, 0.0)
    force, radii, _, load = respond(law, impact, approach, rate)
    exact = np.sqrt(pair.radius * inside)
    pressed = (4.0 / 3.0) * pair.effective_modulus * exact * inside
    scales, motion = hertz_scales(impact), normal_motion(law, impact)
    for name, value, expected in (
        ("radius is", radii, exact),
        ("force is", force, pressed),
        ("friction load is", load, pressed),
        ("duration of an impact is", motion.duration, scales.duration),
        ("greatest radius is", motion.maximum_radius, scales.radius),
        ("greatest force is", motion.maximum_force, scales.force),
        ("greatest approach is", motion.maximum_approach, scales.approach),
        ("rebound velocity is", -np.asarray(motion.final_rate), impact.normal_speed),
    ):
        gap = float(np.max(np.abs(value - expected))) / float(np.max(np.abs(expected)))
        hold(gap <= ROUNDING and math.isfinite(gap), f"The {name} {gap:.2g} off Hertz's.")
