"""Checks of what a normal law claims of its contact: force, friction load, radius."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.compose.normal_motion import normal_motion
from contactlab.contracts import NormalLaw
from contactlab.impact.hertz import hertz_scales
from contactlab.testing.check import check, hold
from contactlab.testing.normal import ROUNDING, STEPS, respond, strokes

#: Contact radius squared over R times approach: 1 of an elastic sphere, 2 where the material
#: neither sinks in nor piles up as it flows (Johnson, Contact Mechanics, §6.3).
ELASTIC, GEOMETRIC = 1.0, 2.0
#: What adhesion and roughness may add to either.
ROOM = 0.02
#: Over the deepest approach: how near first touch a law is asked, and how far behind it.
NEAR, BEHIND = 1e-9, 0.5


@check(NormalLaw)
def presses(law: Any) -> None:
    """Force, radius and friction load vanish out of contact; no friction load is negative.

    A law may pull while the surfaces are in contact: Coulomb's limit is not taken of a pull.
    """
    given, approach, rate = strokes()
    depth, speed = float(approach.max()), float(given.normal_speed)
    depths = depth * np.concatenate(([0.0], np.geomspace(NEAR, 1.0, STEPS)))
    behind = -depth * np.geomspace(NEAR, BEHIND, STEPS)
    approach = np.concatenate((depths, depths[::-1], behind))
    rate = speed * np.where(np.arange(len(approach)) < len(depths), 1.0, -1.0)
    force, radius, overlap, load = respond(law, given, approach, rate)
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
def grows(law: Any) -> None:
    """Deeper is not weaker nor narrower: force and radius do not fall in compression.

    At a steady rate: in an impact a damped force is greatest before the approach is.
    """
    given, approach, rate = strokes()
    depths = np.linspace(0.0, float(approach[STEPS]), STEPS + 1)
    steady = np.full_like(depths, 0.5 * float(rate.max()))
    force, radius, _, load = respond(law, given, depths, steady)
    for name, column in (("force", force), ("radius", radius), ("friction load", load)):
        fall = -float(np.min(np.diff(column))) / max(float(column.max()), 1e-300)
        hold(
            fall <= ROUNDING,
            f"The {name} falls by {fall:.2g} of its maximum in compression. Bound: {ROUNDING:.2g}.",
        )


@check(NormalLaw, claim="radius")
def radius(law: Any) -> None:
    """A law that offers ``radius`` has one wherever it presses.

    But at first touch, where a dashpot presses on a point.
    """
    given, approach, rate = strokes()
    force, found, _, _ = respond(law, given, approach, rate)
    pressed = (force > 1e-6 * force.max()) & (approach > 0.0)
    hold(np.all(found[pressed] > 0.0), "It offers 'radius', and has none where it presses.")
    deepest = int(approach.argmax())
    share = float(found[deepest] ** 2) / (given.pair.radius * float(approach[deepest]))
    hold(
        ELASTIC - ROOM <= share <= GEOMETRIC + ROOM,
        f"b² is {share:.3g} R z at greatest compression: {ELASTIC:g} of an elastic sphere (2), "
        f"and {GEOMETRIC:g}, the section of sphere and plane, at most.",
    )


@check(NormalLaw, claim="hertzian_pressure")
def hertzian_pressure(law: Any) -> None:
    """The radius is that of a sphere pressed in: R z (2) if elastic, at most 2 R z if plastic.

    A hemisphere of pressure is said to act over that radius, whatever its height: the force tells
    nothing of a damped or plastic law's. Geometry does. A law without adhesion that forgets its
    history where the bodies stand still is elastic but for damping, and b² = R z (2). Where the
    material flows, b² lies between R z and 2 R z at greatest compression, and is never more than
    2 R z_max.
    """
    given, stroke, rate = strokes()
    depths = np.linspace(0.0, float(stroke.max()), STEPS + 1)
    course = np.concatenate((depths, depths[::-1]))
    for name, approach, speed in (
        ("At rest", course, np.zeros_like(course)),
        ("In an impact", stroke, rate),
    ):
        force, radius, _, _ = respond(law, given, approach, speed)
        deepest = int(approach.argmax())
        share = float(radius[deepest] ** 2) / (given.pair.radius * float(approach[deepest]))
        hold(
            share >= ELASTIC - ROOM,
            f"{name} b² is {share:.3g} R z at greatest compression: less than an elastic "
            "sphere's (2).",
        )
        share = float(np.max(radius**2)) / (given.pair.radius * float(approach.max()))
        hold(
            share <= GEOMETRIC + ROOM,
            f"{name} b² comes to {share:.3g} R z_max: 2 is the most, the section of sphere and "
            "plane."
            f" Bound: {GEOMETRIC + ROOM:.2g}.",
        )
        if name == "At rest":
            forgets = float(np.max(np.abs(force - force[::-1]))) <= ROUNDING * float(force.max())
            pulls = float(force.min()) < 0.0  # adhesion widens an elastic contact
            hold(
                share <= ELASTIC + ROOM or pulls or not forgets,
                f"{name} its force is that of an elastic body, and b² is {share:.3g} R z, not "
                "that of eq. (2).",
            )


@check(NormalLaw, claim="elastic_hertz")
def elastic_hertz(law: Any) -> None:
    """Radius (2), force (4) and impact (7)-(9) are those of elastic Hertz contact."""
    given, approach, rate = strokes()
    pair, inside = given.pair, np.maximum(approach, 0.0)
    force, found, _, load = respond(law, given, approach, rate)
    exact = np.sqrt(pair.radius * inside)
    pressed = (4.0 / 3.0) * pair.effective_modulus * exact * inside
    scales, motion = hertz_scales(given), normal_motion(law, given)
    for name, one, other in (
        ("radius is", found, exact),
        ("force is", force, pressed),
        ("friction load is", load, pressed),
        ("duration of an impact is", motion.duration, scales.duration),
        ("greatest radius is", motion.maximum_radius, scales.radius),
        ("greatest force is", motion.maximum_force, scales.force),
        ("greatest approach is", motion.maximum_approach, scales.approach),
        ("rebound velocity is", -np.asarray(motion.final_rate), given.normal_speed),
    ):
        gap = float(np.max(np.abs(one - other))) / float(np.max(np.abs(other)))
        hold(gap <= ROUNDING and math.isfinite(gap), f"The {name} {gap:.2g} off Hertz's.")
