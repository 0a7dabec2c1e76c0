"""The rule of steps of a normal motion: widths, events and ends, of one impact or of many.

``motion_solver`` and ``motion_solver_alone`` follow it, in arrays and in plain numbers.
"""

from __future__ import annotations

import math
from typing import overload

import numpy as np
from numpy.typing import NDArray

from contactlab.contracts import faults
from contactlab.contracts.status import Status
from contactlab.numeric.arrays import choose, greater, magnitude
from contactlab.numeric.types import Array, Kind, Mask, Real
from contactlab.solve.scaled_normal_law import ScaledNormalLaw

#: Error of approach, rate and load impulse in a step, over their scales: far below the default
#: tolerances of the integrators, so that the normal motion does not limit their accuracy.
TOLERANCE = 1e-11
#: First step over the duration of a Hertz impact; the error sets the next ones.
FIRST_STEP = 1e-4
#: Steps after which a contact is abandoned, rejected steps included. Impacts of the laws here take
#: 25 to 250, adhesion that holds 440; 5,000 steps take half a second.
MOST_STEPS = 5_000
#: Sign changes of the rate without separation after which a contact is abandoned: adhesion holds
#: the bodies together.
MOST_TURNS = 16
#: Also abandoned: a contact deeper than this times R, or stationary. It is stationary if the rate,
#: and its change by the present force over the time since first touch, are below this times v1.
DEEPEST, AT_REST = 1e6, 1e-9
#: An event this close to an end of a step, over the time since first touch, is at that end.
NEAR = 1e-11
#: Halvings of the part of a step that holds an event.
HALVINGS = 60
#: Error over the tolerance up to which a rejected step is used to locate an event.
TRUSTED = 1e8
#: The step after a rejected one ends before the event, by a fraction of the way: this many times
#: the error over the width of the rejected step, but at most the second number.
DOUBT, MOST_DOUBT = 10.0, 0.1
#: Factor on the step that the error allows, and limits of the change from one step to the next.
SAFETY, SHRINKAGE, GROWTH = 0.9, 0.2, 10.0
#: Least eighth root of an error over the tolerance that is told from a smaller one.
LEAST_ROOT = SAFETY / GROWTH
#: Shortest step over the time since first touch: rounding error dominates below.
SHORTEST = 1e-15


def doubt(error: Kind, width: Kind) -> Kind:
    """Return the uncertainty of an event's place over the way to it; 1 if it cannot be located."""
    blur = DOUBT * TOLERANCE * error / choose(width > 0.0, width, 1.0)
    least = choose(blur < MOST_DOUBT, blur, MOST_DOUBT)
    return choose(error <= 1.0, 0.0, choose(error < TRUSTED, least, 1.0))


def sure_part(until: Kind, doubt: Kind) -> Kind:
    """Return the fraction of a step that is surely before an event ``until`` its fraction."""
    return choose(until < 1.0, until * (1.0 - doubt), 1.0)


@overload
def sets_width(missed: bool, sure: float, width: float, allowed: float) -> bool: ...
@overload
def sets_width(
    missed: NDArray[np.bool_], sure: Array, width: Array, allowed: Array
) -> NDArray[np.bool_]: ...
def sets_width(missed: Mask, sure: Real, width: Real, allowed: Real) -> object:
    """Return whether a step sets the next width; a step that an event shortened does not."""
    return choose(missed, sure == 1.0, width == allowed)


def next_width(width: Kind, factor: Kind) -> Kind:
    """Return the width after a step, by the factor that its error allows."""
    return width * choose(factor > GROWTH, GROWTH, greater(factor, SHRINKAGE))


@overload
def next_event(width: float, sure: float, rejected: bool) -> float: ...
@overload
def next_event(width: Array, sure: Array, rejected: NDArray[np.bool_]) -> Array: ...
def next_event(width: Real, sure: Real, rejected: Mask) -> Real:
    """Return the time until the event over which a step was rejected; infinite without one."""
    return choose(rejected, choose(sure < 1.0, sure * width, math.inf), math.inf)


def too_short(law: ScaledNormalLaw) -> faults.LawFaultError:
    """Return the fault of steps below the shortest."""
    if law.finite:
        return law.fault(Status.UNRESOLVED, "steps became too short")
    return law.fault(Status.NON_FINITE, "a force that is not finite")


def is_endless(turns: Real, rate: Real, change: Real, approach: Real, radius: Real) -> Mask:
    """Return whether a contact does not end.

    ``change`` is the change of the rate by the present force over the time since first touch.
    """
    at_rest = (magnitude(rate) < AT_REST) & (magnitude(change) < AT_REST)
    return (turns > MOST_TURNS) | at_rest | (approach > DEEPEST * radius)
