"""A contact of two springs with a slider: slip and stick of a whole impact, in closed form.

Scaled: theta = Omega t, Omega² = k_n/M_n; psi = (k_t/k_n) v_x/(mu v1); forces in units of mu times
the greatest normal force; omega = sqrt(k_t/M_t)/Omega. Then psi' = -omega² f, in stick f' = psi, in
slip of sign s f = s p.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from typing import Any, ClassVar, NamedTuple

import attrs
import numpy as np

from contactlab.contracts import NormalMotion, WholeImpact, WholeImpactTangentialLaw
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import POSITIVE, quantity, refuse
from contactlab.numeric.types import Real

#: Bound of the imbalance of the energy books, over the energy at the start.
ROUNDING = 1e-9
#: Share by which the friction load's impulse may exceed that of the spring without a caution.
PULL = 1e-3
#: Above this ratio of the frequencies the oscillations of one impact are not followed: chi = 5e7.
MOST_FREQUENCY = 1e4
#: Changes between slip and stick are fewer than this times 1 + omega: about one an oscillation.
MOST_CHANGES = 8
#: Narrowest interval that is halved, times the root of the second derivative's bound: the function
#: is a straight line there, to 1e-15, and two zeros count as one or none.
NARROWEST = 1e-7
#: Rise or fall of a function over its largest distance from the chord, from which it rises or falls
#: all the way; at 8 the slope may still vanish at an end.
STEEP = 16.0
#: A function value above minus this is no zero: rounding.
ROUNDED = 1e-14


@attrs.frozen(kw_only=True)
class Stronge(WholeImpactTangentialLaw):
    """The lumped contact: a normal and a tangential spring, the tangential one on a slider.

    The normal spring has k_n in compression and k_n/e² in restitution, e that of the normal
    law's motion; the tangential one k_t throughout. Between the changes of slip and stick
    the motion is one of sines and cosines, so nothing is marched. The contact sticks at first if
    v_x < mu v1 k_n/k_t. The true normal motion enters by e alone. The law gives no history.

    Parameters
    ----------
    stiffness_ratio : float, optional
        k_t/k_n, Stronge's 1/eta²; kappa of the bodies, Mindlin's ratio, if not given. With it
        the ratio of the natural frequencies is sqrt(2 chi).

    References
    ----------
    Stronge, Int. J. Impact Eng. 15 (1994) 435-450, doi:10.1016/0734-743X(94)80027-7; Stronge,
    Impact Mechanics (2nd ed., 2018), ch. 5.
    """

    elliptic: ClassVar[bool] = True
    api_version: ClassVar[int] = 2
    expected_failures: ClassVar[Mapping[str, str]] = {
        "impact_reference": "one spring for the whole contact: there is no partial slip",
        "load_impulse": "the normal spring of the lumped contact does not pull",
    }

    stiffness_ratio: float | None = quantity("1", rule=POSITIVE, default=None)

    def books_bound(self, scene: Scene) -> Real:
        """Return the bound of rounding: slip and stick are closed forms."""
        return ROUNDING

    def whole_impacts(self, scene: Scene, normal: NormalMotion) -> tuple[WholeImpact, ...]:
        """Return the outcome of every impact."""
        pair = scene.pair
        ratio = pair.stiffness_ratio if self.stiffness_ratio is None else self.stiffness_ratio
        with np.errstate(all="ignore"):
            unit: Any = scene.friction_coefficient * scene.normal_speed / ratio
            incidence = np.abs(scene.slip_velocity) / unit
            frequency = np.sqrt(ratio * pair.normal_mass / pair.tangential_mass)
            # e from the velocities: adhesion changes the friction load's impulse.
            bounce = -normal.final_rate / scene.normal_speed
        change, work = _of_each(incidence, frequency, np.maximum(bounce, 0.0), scene.shape)
        answer = WholeImpact(
            where=True,
            slip_velocity_change=np.sign(scene.slip_velocity) * change * unit,
            friction_work=pair.tangential_mass * np.square(unit) * work,
            reason="two springs and a slider: sines and cosines between slip and stick",
            psi2_error=0.0,
        )
        return (*super().whole_impacts(scene, normal), answer)

    def cautions(self, scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
        """Return the cautions of a lumped contact and of a normal spring that does not pull."""
        lumped = (
            "lumped contact: springs independent of the contact's area, without partial slip, "
            "which moves psi2 of solid spheres by up to about 0.4 (model, not numerical error)"
        )
        return (lumped, *_pull(scene, normal))


def _pull(scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution that the friction load exceeds the force of the normal spring."""
    momentum = scene.pair.normal_mass * (scene.normal_speed - normal.final_rate)
    largest = float(np.max(normal.total_load_impulse / momentum))
    if not largest > 1.0 + PULL:
        return ()
    return (
        f"lumped contact: its normal spring does not pull; the friction load of the normal law has "
        f"up to {largest:.3g} times the impulse (1 + e) M_n v1 of that spring (model, not "
        "numerical error)",
    )


def _of_each(incidence: Real, frequency: Real, bounce: Real, shape: tuple[int, ...]) -> Rebound:
    """Return change and work of all impacts, arrays of ``shape``, scaled as in this file's head."""
    columns = (incidence, frequency, bounce)
    rows = zip(*(np.broadcast_to(each, shape).ravel().tolist() for each in columns), strict=True)
    change, work = np.array([_of_one(*row) for row in rows]).T.reshape(2, *shape)
    return Rebound(change, work)


def _of_one(incidence: float, frequency: float, bounce: float) -> Rebound:
    if not 0.0 < incidence < np.inf:  # no slip, or no friction: answered by the base class
        return Rebound(0.0, 0.0)
    if not frequency <= MOST_FREQUENCY:
        why = f"must be at most {MOST_FREQUENCY:g}: each oscillation is followed"
        raise refuse("ratio of natural frequencies", frequency, why, "take tangential.fronts")
    return rebound(incidence, frequency, bounce)


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
    """Change of psi, and the friction work: the loss of ½ psi²; of one impact or of many."""

    change: Real
    work: Real


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


def first_zero(
    function: Callable[[float], float], bend: float, start: float, stop: float
) -> float | None:
    """Return the first point of (start, stop] where ``function`` falls below 0, or None."""
    # ``bend`` bounds the absolute second derivative. An interval is passed over only where its ends
    # and this bound leave no room for a zero; else it is halved, its left half first.
    narrowest = NARROWEST / max(bend, 1.0) ** 0.5
    pending = [(start, function(start), stop, function(stop))]
    while pending:
        left, before, right, after = pending.pop()
        width = right - left
        bow = 0.125 * bend * width * width
        rises = before > -ROUNDED and after - before > STEEP * bow
        if rises or min(before, after) > bow:
            continue
        if after < -ROUNDED and before > 0.0 and before - after > STEEP * bow:
            return _only_zero(function, bend, left, before, right, after)
        if width <= narrowest:
            if after < -ROUNDED:
                return _straight_zero(left, before, right, after)
            continue
        middle = 0.5 * (left + right)
        value = function(middle)
        pending += [(middle, value, right, after), (left, before, middle, value)]
    return None


def _only_zero(
    function: Callable[[float], float],
    bend: float,
    left: float,
    before: float,
    right: float,
    after: float,
) -> float:
    """Return the zero of a function that falls all the way, by straight lines and their error."""
    while right - left > NARROWEST / max(bend, 1.0) ** 0.5:
        bow = 0.125 * bend * (right - left) ** 2
        # the slope is nowhere less than that of the chord by more than the bend times the width
        reach = bow * (right - left) / (before - after - 8.0 * bow)
        zero = _straight_zero(left, before, right, after)
        low, high = max(zero - reach, left), min(zero + reach, right)
        if low > left:
            left, before = low, function(low)
        if high < right:
            right, after = high, function(high)
        if before <= 0.0 or after >= 0.0:  # rounding
            break
    return _straight_zero(left, before, right, after)


def _straight_zero(left: float, before: float, right: float, after: float) -> float:
    """Return where a straight line that falls is 0; an end if both have one sign."""
    high = max(before, 0.0)
    return left + (right - left) * high / (high - after) if after < 0.0 else right
