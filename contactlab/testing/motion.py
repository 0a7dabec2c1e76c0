"""Checks of a normal motion in closed form."""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import ClosedFormNormalLaw
from contactlab.numeric.types import Array
from contactlab.testing.check import check, hold, within
from contactlab.testing.load_paths import scene
from contactlab.testing.normal import STEPS, respond

#: Number of phases over which derivatives are integrated by the trapezium rule.
PHASES = 2001


@check(ClosedFormNormalLaw)
def motion_agrees(law: ClosedFormNormalLaw) -> None:
    """The motion in closed form has the contacts of ``respond``, and starts at touch with v1."""
    impact = scene(0.0, 1.0)
    speed, motion = impact.normal_speed, law.motion(impact)
    phases = np.linspace(0.0, math.pi, STEPS)
    _, approach, rate, contact, _ = motion.at(phases)
    force, radius, _, load = respond(law, impact, np.asarray(approach), np.asarray(rate))
    for name, value, expected, scale in (
        ("force", contact.force, force, motion.maximum_force),
        ("radius", contact.radius, radius, motion.maximum_radius),
        ("friction load", contact.friction_load, load, motion.maximum_force),
    ):
        # At separation rounding decides between the limit of the radius and zero.
        difference = np.abs(value - expected)[: -1 if name == "radius" else None]
        gap = float(np.max(difference)) / float(scale)
        within(gap, 1e-8, f"The {name} of the motion is {gap:.1e} off that of respond.")
    start = motion.at(0.0)
    rate_at_touch = float(start.rate)
    within(
        abs(rate_at_touch / speed - 1.0),
        1e-12,
        f"The motion starts at {rate_at_touch!r} m/s, not {speed!r}.",
    )
    touches = abs(float(start.approach)) <= 1e-12 * motion.maximum_approach
    hold(touches, "The motion does not start at touch.")


@check(ClosedFormNormalLaw)
def motion_obeys_newton(law: ClosedFormNormalLaw) -> None:
    """Mass times change of rate is the force, and approach the integral of rate."""
    impact = scene(0.0, 1.0)
    motion = law.motion(impact)
    phases = np.linspace(0.0, math.pi, PHASES)
    *columns, contact, load_impulse = motion.at(phases)
    time, approach, rate, impulse = map(np.asarray, (*columns, load_impulse))
    per_time = motion.maximum_approach / impact.normal_speed
    time_rate, width = np.asarray(motion.scaled(phases).time_rate) * per_time, np.diff(phases)

    def gather(slope: Array) -> Array:
        return np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * width)))

    unit = 2.0 * impact.normal_speed
    for name, change, slope, scale in (
        (
            "rate",
            np.asarray(rate) - rate[0],
            -contact.force * time_rate / impact.pair.normal_mass,
            unit,
        ),
        ("approach", np.asarray(approach), rate * time_rate, motion.maximum_approach),
        ("time", np.asarray(time), time_rate, motion.duration),
        ("load impulse", impulse, contact.friction_load * time_rate, motion.total_load_impulse),
    ):
        gap = float(np.max(np.abs(change - gather(slope)))) / float(scale)
        within(gap, 1e-5, f"The {name} is {gap:.1e} off what its derivative adds up to.")
    for name, last, total in (
        ("duration", time[-1], motion.duration),
        ("final rate", rate[-1], motion.final_rate),
        ("total load impulse", impulse[-1], motion.total_load_impulse),
    ):
        within(
            abs(float(last) / float(total) - 1.0), 1e-9, f"The motion does not end at its {name}."
        )
    mass = motion.maximum_force * per_time / (impact.pair.normal_mass * impact.normal_speed)
    gap = abs(motion.scaled_mass * float(mass) - 1.0)
    within(gap, 1e-9, f"The scaled mass is {gap:.1e} off that of Newton's law.")


@check(ClosedFormNormalLaw)
def motion_scaled(law: ClosedFormNormalLaw) -> None:
    """``scaled``, ``scaled_at``, ``phase`` and ``phase_at_rate`` agree with ``at``."""
    impact = scene(0.0, 1.0)
    motion = law.motion(impact)
    phases = np.linspace(0.05, math.pi - 0.05, 41)
    sample = motion.at(phases)
    time, approach, rate = (np.asarray(part) for part in sample[:3])
    contact, scaled = sample.contact, motion.scaled(phases)
    for name, value, expected in (
        ("phase", scaled.phase, phases),
        ("approach", scaled.approach, approach / motion.maximum_approach),
        ("rate", scaled.rate, rate / impact.normal_speed),
        ("force", scaled.force, contact.force / motion.maximum_force),
        ("radius", scaled.radius, contact.radius / motion.maximum_radius),
    ):
        gap = float(np.max(np.abs(value - expected)))
        within(gap, 1e-9, f"The scaled {name} is {gap:.1e} off.")
    for place, phase in enumerate(phases.tolist()):
        single = np.array(motion.scaled_at(phase))
        gap = float(np.max(np.abs(single - np.array(scaled)[:, place])))
        within(gap, 1e-12, f"scaled_at({phase:.3g}) is {gap:.1e} off scaled.")
        gap = abs(motion.phase_at_rate(float(scaled.rate[place])) - phase)
        within(gap, 1e-8, f"phase_at_rate is {gap:.1e} off.")
    gap = float(np.max(np.abs(motion.phase(time / motion.duration) - phases)))
    within(gap, 1e-6, f"phase is {gap:.1e} off the inverse of time.")
