"""Checks of a normal motion in closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import ClosedFormNormalLaw
from contactlab.testing.bench import scene
from contactlab.testing.check import check, hold
from contactlab.testing.normal import STEPS, respond

#: Phases to which the derivatives of a motion are added up, by the trapezium rule.
PHASES = 2001


@check(ClosedFormNormalLaw)
def motion_agrees(law: Any) -> None:
    """The motion in closed form has the forces of ``respond``, and starts as asked."""
    given: Any = scene(0.0, 1.0)
    speed, motion = given.normal_speed, law.motion(given)
    phases = np.linspace(0.0, math.pi, STEPS)
    _, approach, rate, contact, _ = motion.at(phases)
    force, radius, _, load = respond(law, given, np.asarray(approach), np.asarray(rate))
    for name, one, other, scale in (
        ("force", contact.force, force, motion.maximum_force),
        ("radius", contact.radius, radius, motion.maximum_radius),
        ("friction load", contact.friction_load, load, motion.maximum_force),
    ):
        # At separation the radius is its limit or none, as rounding has it.
        apart = np.abs(one - other)[: -1 if name == "radius" else None]
        gap = float(np.max(apart)) / scale
        hold(
            gap <= 1e-8, f"The {name} of the motion is {gap:.1e} off that of respond. Bound: 1e-8."
        )
    start = motion.at(0.0)
    rate_at_touch = float(start.rate)
    hold(
        abs(rate_at_touch / speed - 1.0) <= 1e-12,
        f"It starts at {rate_at_touch!r} m/s, not {speed!r}. Bound: 1e-12.",
    )
    touches = abs(float(start.approach)) <= 1e-12 * motion.maximum_approach
    hold(touches, "It does not start at touch.")


@check(ClosedFormNormalLaw)
def motion_obeys_newton(law: Any) -> None:
    """Mass times change of rate is the force, and approach the integral of rate."""
    given: Any = scene(0.0, 1.0)
    motion = law.motion(given)
    phases = np.linspace(0.0, math.pi, PHASES)
    time, approach, rate, contact, impulse = motion.at(phases)
    per_time = motion.maximum_approach / given.normal_speed
    time_rate, width = np.asarray(motion.scaled(phases).time_rate) * per_time, np.diff(phases)

    def gathered(slope: Any) -> Any:
        return np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * width)))

    unit = 2.0 * given.normal_speed
    for name, change, slope, scale in (
        (
            "rate",
            np.asarray(rate) - rate[0],
            -contact.force * time_rate / given.pair.normal_mass,
            unit,
        ),
        ("approach", np.asarray(approach), rate * time_rate, motion.maximum_approach),
        ("time", np.asarray(time), time_rate, motion.duration),
        ("load impulse", impulse, contact.friction_load * time_rate, motion.total_load_impulse),
    ):
        gap = float(np.max(np.abs(change - gathered(slope)))) / scale
        hold(
            gap <= 1e-5, f"The {name} is {gap:.1e} off what its derivative adds up to. Bound: 1e-5."
        )
    for name, last, total in (
        ("duration", time[-1], motion.duration),
        ("final rate", rate[-1], motion.final_rate),
        ("total load impulse", impulse[-1], motion.total_load_impulse),
    ):
        hold(abs(float(last) / total - 1.0) <= 1e-9, f"It does not end at its {name}. Bound: 1e-9.")
    mass = motion.maximum_force * per_time / (given.pair.normal_mass * given.normal_speed)
    gap = abs(motion.scaled_mass * mass - 1.0)
    hold(gap <= 1e-9, f"The scaled mass is {gap:.1e} off that of Newton's law. Bound: 1e-9.")


@check(ClosedFormNormalLaw)
def motion_scaled(law: Any) -> None:
    """``scaled``, ``scaled_at``, ``phase`` and ``phase_at_rate`` say what ``at`` says."""
    given: Any = scene(0.0, 1.0)
    motion = law.motion(given)
    phases = np.linspace(0.05, math.pi - 0.05, 41)
    sample = motion.at(phases)
    time, approach, rate = (np.asarray(part) for part in sample[:3])
    contact, scaled = sample.contact, motion.scaled(phases)
    for name, one, other in (
        ("phase", scaled.phase, phases),
        ("approach", scaled.approach, approach / motion.maximum_approach),
        ("rate", scaled.rate, rate / given.normal_speed),
        ("force", scaled.force, contact.force / motion.maximum_force),
        ("radius", scaled.radius, contact.radius / motion.maximum_radius),
    ):
        gap = float(np.max(np.abs(one - other)))
        hold(gap <= 1e-9, f"The scaled {name} is {gap:.1e} off. Bound: 1e-9.")
    for place, phase in enumerate(phases.tolist()):
        single = np.array(motion.scaled_at(phase))
        gap = float(np.max(np.abs(single - np.array(scaled)[:, place])))
        hold(gap <= 1e-12, f"scaled_at({phase:.3g}) is {gap:.1e} off scaled. Bound: 1e-12.")
        gap = abs(motion.phase_at_rate(float(scaled.rate[place])) - phase)
        hold(gap <= 1e-8, f"phase_at_rate is {gap:.1e} off. Bound: 1e-8.")
    gap = float(np.max(np.abs(motion.phase(time / motion.duration) - phases)))
    hold(gap <= 1e-6, f"phase is {gap:.1e} off the inverse of time. Bound: 1e-6.")
