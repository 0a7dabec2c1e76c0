"""The stages of an impact: slip and stick, and where each ends; of one impact or of many."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

from contactlab.numeric.types import Real

#: Changes between slip and stick are fewer than this times 1 + omega: about one an oscillation.
MOST_CHANGES = 8
#: x at the end of a half.
WHOLE = 0.5 * math.pi
#: A slope of s f - p from which the limit may be met, and a step to where it is met: rounding.
FLAT, TINY = 1e-14, 1e-15


class Half(NamedTuple):
    """Compression, p = sin x, or restitution, p = cos x, with theta = scale x, x in [0, pi/2]."""

    scale: float
    closing: bool


class Contact(NamedTuple):
    """psi1, the change of psi, f, the friction work, and the sign of slip (0 for stick)."""

    incidence: Any
    change: Any
    force: Any
    work: Any
    sense: Any


class Numbers(NamedTuple):
    """Functions of numbers or of arrays."""

    sin: Callable[[Any], Any]
    cos: Callable[[Any], Any]
    slip_ends: Callable[..., Any]
    stick_ends: Callable[..., Any]


class Rebound(NamedTuple):
    """Change of psi, and the friction work: the loss of ½ psi²; of one impact or of many."""

    change: Real
    work: Real

    @classmethod
    def of(cls, contact: Contact, frequency: Real) -> Rebound:
        """Return the rebound of a contact at separation."""
        # With e = 0 the load ends at once and the spring, which still holds energy, loses it.
        held: Real = frequency * contact.force
        return cls(contact.change, contact.work + 0.5 * held * held)


def rebound(incidence: float, frequency: float, restitution: float) -> Rebound:
    """Return the outcome of an impact with psi = ``incidence`` >= 0 and omega = ``frequency``."""
    # Restitution takes e times as long as compression, and has e times its impulse.
    contact = Contact(incidence, 0.0, 0.0, 0.0, int(incidence >= 1.0))
    for half in (Half(1.0, True), Half(restitution, False)):
        x, changes = 0.0 if half.scale > 0.0 else WHOLE, 0
        while x < WHOLE:
            contact, x = advance_stage(ONE, contact, half, frequency, x)
            changes += 1
            if changes > MOST_CHANGES * (1.0 + frequency):
                raise ArithmeticError(f"slip and stick change {changes} times, omega = {frequency}")
    return Rebound.of(contact, frequency)


def advance_stage(
    numbers: Numbers, contact: Contact, half: Half, frequency: Real, x: Real
) -> tuple[Contact, Any]:
    """Return contact and phase where a stage that begins at x ends; all are in slip, or none."""
    follow = _slip if (contact.sense if numbers is ONE else contact.sense.all()) else _stick
    return follow(numbers, contact, half, frequency, x)


def _slip(
    numbers: Numbers, contact: Contact, half: Half, frequency: Real, x: Real
) -> tuple[Contact, Any]:
    """Slip of one sign ends where psi = dp/d theta."""
    incidence, before, held, work, sense = contact
    square = frequency * frequency
    velocity = incidence + before
    end = numbers.slip_ends(sense * velocity, half, square, x)
    sin, cos = numbers.sin(end), numbers.cos(end)
    impulse = numbers.cos(x) - cos if half.closing else sin - numbers.sin(x)
    change = -sense * square * half.scale * impulse
    # s p against the slip velocity psi - s p': the integral of s p psi is that of psi'.
    force = sense * (sin if half.closing else cos)
    work = work - change * (velocity + 0.5 * change) - 0.5 * square * (force * force - held * held)
    return Contact(incidence, before + change, force, work, sense * (end >= WHOLE)), end


def _stick(
    numbers: Numbers, contact: Contact, half: Half, frequency: Real, x: Real
) -> tuple[Contact, Any]:
    """Stick ends where the spring force meets the limit."""
    incidence, before, start, work, _ = contact
    turn, speed = frequency * half.scale, (incidence + before) / frequency
    end, sense = numbers.stick_ends(start, speed, half.closing, turn, x)
    angle = turn * (end - x)
    sin, cos = numbers.sin(angle), numbers.cos(angle)
    change = frequency * (speed * (cos - 1.0) - start * sin)
    return Contact(incidence, before + change, start * cos + speed * sin, work, sense), end


def _slip_ends(speed: float, half: Half, square: float, x: float) -> float:
    """Return the phase where s psi = ``speed`` falls to dp/d theta in closed form, else pi/2."""
    if half.closing:
        # speed - square (cos x0 - cos x) = cos x
        if square <= 1.0:
            return WHOLE
        cosine = (square * math.cos(x) - speed) / (square - 1.0)
        return max(math.acos(cosine), x) if 0.0 <= cosine <= 1.0 else WHOLE
    # speed - square e (sin x - sin x0) = -sin x/e
    rise = square * half.scale - 1.0 / half.scale
    if rise <= 0.0:
        return WHOLE
    sine = (speed + square * half.scale * math.sin(x)) / rise
    return max(math.asin(sine), x) if 0.0 <= sine <= 1.0 else WHOLE


def _stick_ends(
    start: float, speed: float, closing: bool, turn: float, begin: float
) -> tuple[float, int]:
    """Return the phase where abs(f) comes to p, and the sign of f there; (pi/2, 0) if it does not.

    f oscillates about zero. While it has one sign s, D = s f - p obeys D'' + D = (1 - turn²) s f,
    which is at most a constant c >= 0. So D, at most zero, stays below c + (D - c) cos h + D' sin h
    for h up to pi (Sturm's comparison): where that is zero the search goes on. With turn >= 1
    c is zero, and D that falls stays negative.
    """
    swing, lead = math.hypot(start, speed), math.atan2(speed, start)
    most = max(0.0, 1.0 - turn * turn) * swing
    lobe, x = math.floor(0.5 - lead / math.pi), begin
    while x < WHOLE:
        sign = -1 if lobe % 2 else 1
        stop = begin + (math.pi * (lobe + 0.5) + lead) / turn
        # where slip has just stopped, D and D' are zero, and turn > 1
        while x < min(stop, WHOLE) and (x > begin or begin == 0.0):
            angle = turn * (x - begin) - lead
            sin, cos = math.sin(x), math.cos(x)
            load, rise = (sin, cos) if closing else (cos, -sin)
            lack = load - sign * swing * math.cos(angle)
            slope = -sign * turn * swing * math.sin(angle) - rise
            if slope <= FLAT and most == 0.0:
                break
            far = most + lack
            root = math.sqrt(max(lack * (far + most), 0.0) + slope * slope)
            step = math.atan2(root, most) - math.atan2(slope, far)
            if slope > FLAT and (lack <= 0.0 or step <= TINY):
                return x, sign
            x += max(step, TINY)
        x, lobe = stop, lobe + 1
    return WHOLE, 0


#: One impact, in plain numbers.
ONE = Numbers(math.sin, math.cos, _slip_ends, _stick_ends)
