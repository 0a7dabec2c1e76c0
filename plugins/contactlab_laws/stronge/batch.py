"""The stages of many impacts at a time; numbers as of one, but for the last bit of sines."""

from __future__ import annotations

import numpy as np

from contactlab.numeric.types import Array
from contactlab_laws.stronge.stages import (
    FLAT,
    MOST_CHANGES,
    TINY,
    WHOLE,
    Contact,
    Half,
    Numbers,
    Rebound,
    advance_stage,
)


def rebounds(incidence: Array, frequency: Array, restitution: Array) -> Rebound:
    """Return the outcomes of impacts, arrays of shape (impacts,), as ``stages.rebound`` does."""
    change, force, work = np.zeros((3, incidence.size))
    contact = Contact(incidence, change, force, work, np.float64(incidence >= 1.0))
    for scale, closing in ((np.ones_like(restitution), True), (restitution, False)):
        x = np.where(scale > 0.0, 0.0, WHOLE)
        changes, live = 0, np.flatnonzero(x < WHOLE)
        while live.size:
            slips = contact.sense[live] != 0.0
            for who in (live[slips], live[~slips]):
                if who.size:
                    part, half = (
                        Contact(*(each[who] for each in contact)),
                        Half(scale[who], closing),
                    )
                    part, x[who] = advance_stage(MANY, part, half, frequency[who], x[who])
                    for whole, each in zip(contact[1:], part[1:], strict=True):
                        whole[who] = each
            live = live[x[live] < WHOLE]
            changes += 1
            if (changes > MOST_CHANGES * (1.0 + frequency[live])).any():
                raise ArithmeticError(f"slip and stick change {changes} times")
    return Rebound.of(contact, frequency)


@np.errstate(all="ignore")
def _slip_ends(speed: Array, half: Half, square: Array, x: Array) -> Array:
    """Return the phases where slip ends, as of one impact."""
    if half.closing:
        cosine = (square * np.cos(x) - speed) / (square - 1.0)
        ends = (square > 1.0) & (cosine >= 0.0) & (cosine <= 1.0)
        return np.where(ends, np.maximum(np.arccos(cosine), x), WHOLE)
    rise = square * half.scale - 1.0 / half.scale
    sine = (speed + square * half.scale * np.sin(x)) / rise
    ends = (rise > 0.0) & (sine >= 0.0) & (sine <= 1.0)
    return np.where(ends, np.maximum(np.arcsin(sine), x), WHOLE)


def _stick_ends(
    start: Array, speed: Array, closing: bool, turn: Array, begin: Array
) -> tuple[Array, Array]:
    """Return the phases where stick ends and the signs of slip, as of one impact."""
    end, sense = np.full_like(start, WHOLE), np.zeros_like(start)
    swing, lead = np.hypot(start, speed), np.arctan2(speed, start)
    most = np.maximum(0.0, 1.0 - turn * turn) * swing
    lobe = np.floor(0.5 - lead / np.pi)
    stop = begin + (np.pi * (lobe + 0.5) + lead) / turn
    x, after = begin.copy(), begin > 0.0
    x[after], lobe[after] = stop[after], lobe[after] + 1.0
    live = np.flatnonzero(x < WHOLE)
    columns = [each[live] for each in (x, lobe, begin, turn, swing, lead, most)]
    while live.size:
        x, lobe, begin, turn, swing, lead, most = columns
        sign = 1.0 - 2.0 * (lobe % 2.0)
        angle = turn * (x - begin) - lead
        sin, cos = np.sin(x), np.cos(x)
        load, rise = (sin, cos) if closing else (cos, -sin)
        signed = sign * swing
        lack = load - signed * np.cos(angle)
        slope = -turn * signed * np.sin(angle) - rise
        far, rising = most + lack, slope > FLAT
        root = np.sqrt(np.maximum(lack * (far + most), 0.0) + slope * slope)
        step = np.arctan2(root, most) - np.arctan2(slope, far)
        met = rising & ((lack <= 0.0) | (step <= TINY))
        end[live[met]], sense[live[met]] = x[met], sign[met]
        stop = begin + (np.pi * (lobe + 0.5) + lead) / turn
        x = np.where(rising | (most > 0.0), x + np.maximum(step, TINY), stop)
        past = x >= stop
        columns[:2] = np.where(past, stop, x), lobe + past
        on = ~met & (columns[0] < WHOLE)
        live, columns = live[on], [each[on] for each in columns]
    return end, sense


#: Many impacts, as arrays.
MANY = Numbers(np.sin, np.cos, _slip_ends, _stick_ends)
