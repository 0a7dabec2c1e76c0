"""An impact of a body on two springs, in closed form between slip and stick.

Scaled: theta = Omega t, Omega² = k_n/M_n; psi = (k_t/k_n) v_x/(mu v1); forces in units of mu times
the greatest normal force; omega = sqrt(k_t/M_t)/Omega. Then psi' = -omega² f, in stick f' = psi, in
slip of sign s f = s p.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from contactlab_laws.stronge.roots import first_zero

#: Changes between slip and stick are fewer than this times 1 + omega: about one an oscillation.
MOST_CHANGES = 8


class Half(NamedTuple):
    """Compression, p = sin x, or restitution, p = cos x, with theta = scale x, x in [0, pi/2]."""

    scale: float
    closing: bool

    def load(self, x: float) -> float:
        """Return the normal force p."""
        return math.sin(x) if self.closing else math.cos(x)

    def impulse(self, start: float, stop: float) -> float:
        """Return the integral of p over theta."""
        part = (
            math.cos(start) - math.cos(stop) if self.closing else math.sin(stop) - math.sin(start)
        )
        return self.scale * part


class Rebound(NamedTuple):
    """Change of psi, and the friction work: the loss of ½ psi²."""

    change: float
    work: float


class Contact(NamedTuple):
    """psi1, the change of psi, f, the friction work, and the sign of slip (0 for stick)."""

    incidence: float
    change: float
    force: float
    work: float
    sense: int

    @property
    def velocity(self) -> float:
        """Return psi."""
        return self.incidence + self.change


def rebound(incidence: float, frequency: float, restitution: float) -> Rebound:
    """Return the outcome of an impact with psi = ``incidence`` >= 0 and omega = ``frequency``."""
    # Restitution takes e times as long as compression, and has e times its impulse.
    contact = Contact(incidence, 0.0, 0.0, 0.0, int(incidence >= 1.0))
    for half in (Half(1.0, True), Half(restitution, False)):
        x, changes = 0.0, 0
        while half.scale > 0.0 and x < 0.5 * math.pi:
            follow = _slip if contact.sense else _stick
            contact, x = follow(contact, half, frequency, x)
            changes += 1
            if changes > MOST_CHANGES * (1.0 + frequency):
                raise ArithmeticError(f"slip and stick change {changes} times, omega = {frequency}")
    # With e = 0 the load ends at once and the spring, which still holds energy, loses it.
    stored = 0.5 * (frequency * contact.force) ** 2
    return Rebound(contact.change, contact.work + stored)


def _slip(contact: Contact, half: Half, frequency: float, x: float) -> tuple[Contact, float]:
    """Return contact and phase where slip of one sign ends, psi = dp/d theta, or the half ends."""
    sense, square = contact.sense, frequency**2
    end = _slip_ends(sense * contact.velocity, half, square, x)
    change = -sense * square * half.impulse(x, end)
    mean = contact.velocity + 0.5 * change
    # s p against the slip velocity psi - s p': the integral of s p psi is that of psi'.
    force = sense * half.load(end)
    work = -change * mean - 0.5 * square * (force * force - contact.force * contact.force)
    after = contact._replace(
        change=contact.change + change,
        force=force,
        work=contact.work + work,
        sense=sense if end >= 0.5 * math.pi else 0,
    )
    return after, end


def _slip_ends(speed: float, half: Half, square: float, x: float) -> float:
    """Return the phase where s psi = ``speed`` falls to dp/d theta in closed form, else pi/2."""
    whole = 0.5 * math.pi
    if half.closing:
        # speed - square (cos x0 - cos x) = cos x
        if square <= 1.0:
            return whole
        cosine = (square * math.cos(x) - speed) / (square - 1.0)
        return max(math.acos(cosine), x) if 0.0 <= cosine <= 1.0 else whole
    # speed - square e (sin x - sin x0) = -sin x/e
    rise = square * half.scale - 1.0 / half.scale
    if rise <= 0.0:
        return whole
    sine = (speed + square * half.scale * math.sin(x)) / rise
    return max(math.asin(sine), x) if 0.0 <= sine <= 1.0 else whole


def _stick(contact: Contact, half: Half, frequency: float, x: float) -> tuple[Contact, float]:
    """Return contact and phase where the spring force meets the limit, or the half ends."""
    turn = frequency * half.scale
    start, speed = contact.force, contact.velocity / frequency
    swing = math.hypot(start, speed)

    def force(at: float) -> float:
        angle = turn * (at - x)
        return start * math.cos(angle) + speed * math.sin(angle)

    end, sense = 0.5 * math.pi, 0
    for sign in (1, -1):
        # p - abs(f) is not smooth, p - f and p + f are.
        zero = first_zero(
            lambda at, sign=sign: half.load(at) - sign * force(at),  # type: ignore[misc]
            1.0 + turn * turn * swing,
            x,
            end,
        )
        if zero is not None:
            end, sense = zero, sign
    angle = turn * (end - x)
    change = frequency * (speed * (math.cos(angle) - 1.0) - start * math.sin(angle))
    after = contact._replace(change=contact.change + change, force=force(end), sense=sense)
    return after, end
