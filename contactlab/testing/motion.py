"""Checks of a normal motion in closed form."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts import ClosedFormNormalLaw
from contactlab.testing.bench import scene
from contactlab.testing.check import check, hold
from contactlab.testing.normal import STEPS, respond


@check(ClosedFormNormalLaw)
def motion_agrees(law: Any) -> None:
    """The motion in closed form has the forces of ``respond``, and starts as asked."""
    given = scene(0.0, 1.0)
    pair, speed = given.pair, given.normal_speed
    motion = law.motion(pair, speed)
    phases = np.linspace(0.0, math.pi, STEPS)
    _, approach, rate, contact = motion.at(phases)
    force, radius, _ = respond(law, pair, np.asarray(approach), np.asarray(rate))
    for name, one, other, scale in (
        ("force", contact.force, force, motion.maximum_force),
        ("radius", contact.radius, radius, motion.maximum_radius),
    ):
        gap = float(np.max(np.abs(one - other))) / scale
        hold(gap <= 1e-8, f"The {name} of the motion is {gap:.1e} off that of respond.")
    start = motion.at(0.0)
    hold(abs(start[2] / speed - 1.0) <= 1e-12, f"It starts at {start[2]!r} m/s, not {speed!r}.")
    hold(abs(float(start[1])) <= 1e-12 * motion.maximum_approach, "It does not start at touch.")


@check(ClosedFormNormalLaw)
def motion_obeys_newton(law: Any) -> None:
    """Mass times change of rate is the force, and approach the integral of rate."""
    given = scene(0.0, 1.0)
    motion = law.motion(given.pair, given.normal_speed)
    phases = np.linspace(0.0, math.pi, 2001)
    time, approach, rate, contact = motion.at(phases)
    pace, span = np.asarray(motion.pace(phases)), np.diff(phases)

    def gathered(slope: Any) -> Any:
        return np.concatenate(([0.0], np.cumsum(0.5 * (slope[1:] + slope[:-1]) * span)))

    unit = 2.0 * given.normal_speed
    for name, change, slope, scale in (
        ("rate", np.asarray(rate) - rate[0], -contact.force * pace / given.pair.normal_mass, unit),
        ("approach", np.asarray(approach), rate * pace, motion.maximum_approach),
        ("time", np.asarray(time), pace, motion.duration),
    ):
        gap = float(np.max(np.abs(change - gathered(slope)))) / scale
        hold(gap <= 1e-5, f"The {name} is {gap:.1e} off what its derivative adds up to.")
    hold(abs(time[-1] / motion.duration - 1.0) <= 1e-9, "It does not end at its duration.")
    hold(abs(rate[-1]) <= given.normal_speed * (1.0 + 1e-9), "It ends faster than it began.")


@check(ClosedFormNormalLaw)
def motion_scaled(law: Any) -> None:
    """``course``, ``instant``, ``phase`` and ``phase_at_rate`` say what ``at`` says."""
    given = scene(0.0, 1.0)
    motion = law.motion(given.pair, given.normal_speed)
    phases = np.linspace(0.05, math.pi - 0.05, 41)
    moving, contact = motion.at(phases)[:3], motion.at(phases)[3]
    time, approach, rate = (np.asarray(part) for part in moving)
    course = motion.course(phases)
    unit = motion.maximum_approach / given.normal_speed
    for name, one, other in (
        ("approach", course.approach, approach / motion.maximum_approach),
        ("rate", course.rate, rate / given.normal_speed),
        ("force", course.force, contact.force / motion.maximum_force),
        ("radius", course.radius, contact.radius / motion.maximum_radius),
        ("pace", course.pace, motion.pace(phases) / unit),
    ):
        gap = float(np.max(np.abs(one - other)))
        hold(gap <= 1e-9, f"The scaled {name} is {gap:.1e} off.")
    for place, phase in enumerate(phases.tolist()):
        single = np.array(motion.instant(phase))
        gap = float(np.max(np.abs(single - np.array(course)[:, place])))
        hold(gap <= 1e-12, f"instant({phase:.3g}) is {gap:.1e} off course.")
        gap = abs(motion.phase_at_rate(float(course.rate[place])) - phase)
        hold(gap <= 1e-8, f"phase_at_rate is {gap:.1e} off.")
    gap = float(np.max(np.abs(motion.phase(time / motion.duration) - phases)))
    hold(gap <= 1e-6, f"phase is {gap:.1e} off the inverse of time.")
