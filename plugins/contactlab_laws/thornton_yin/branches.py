"""Loading, unloading and reloading of a contact with partial slip, and the turns between them.

The share theta of the contact radius within which the contact sticks follows from the force T,
with M = mu N, the sense s of slip at the edge, and u = 1 - theta³ (Thornton & Yin 1991):

    loading      s T = M (h + (1 - h) u),   h = 0 from rest
    unloading    T = T* + 2 s M u           from the turning point T*
    reloading    T = T** + 2 s M u          from the turning point T**

and dT = k theta dD + s (1 - theta) dM. With these two epsilon = 1 - theta² obeys

    d(epsilon M^(2/3)) = w s q dD + (1 - w) d(M^(2/3)),   q = (2/3) k M^(-1/3),

w = 1/(1 - h) in loading, ½ after a turn: along a branch a step of any size is exact where q is
constant, as it is for Hertz. Turning points move with the load, dT* = s dM of the sense s before
the turn. Where slip is small epsilon and u are small, so that nothing cancels at huge mu.
"""

from __future__ import annotations

import math
from typing import NamedTuple

#: Branches.
LOADING, UNLOADING, RELOADING = 0, 1, 2
#: Greatest h: a contact so near its limit slips as a whole with the next step.
MOST_HELD = 1.0 - 1e-12


class ContactState(NamedTuple):
    """The memory of one contact.

    Attributes
    ----------
    force, limit : float
        T and M at the last instant, in N.
    slipped : float
        epsilon; the stick radius is sqrt(1 - epsilon) of the contact radius.
    sense : int
        Direction of slip at the edge; 0 where all of the contact sticks.
    branch : int
        ``LOADING``, ``UNLOADING`` or ``RELOADING``.
    held : float
        h: the share of the limit everywhere in a contact that stuck while it grew.
    turn, earlier : float
        The last turning point and the one before, in N.
    outrun : float
        abs(q dD) - d(M^(2/3)) of the last step: how far displacement outran the limit.
    """

    force: float = 0.0
    limit: float = 0.0
    slipped: float = 0.0
    sense: int = 0
    branch: int = LOADING
    held: float = 0.0
    turn: float = 0.0
    earlier: float = 0.0
    outrun: float = 0.0


class Step(NamedTuple):
    """A step: the limit M at its end (N), k (N/m), q (N^(2/3)/m) and dD (m)."""

    limit: float
    stiffness: float
    front_rate: float
    displacement: float

    @property
    def moved(self) -> float:
        """Return q dD."""
        return self.front_rate * self.displacement

    def outruns(self, state: ContactState, sense: int) -> float:
        """Return s q dD - d(M^(2/3)): above zero the edge slips in the sense s."""
        return sense * self.moved - (_square(self.limit) - _square(state.limit))


def follow_step(state: ContactState, step: Step) -> tuple[ContactState, float]:
    """Return the state after a step, and the friction work in J."""
    before = _turn_branch(state, step)
    if not before.sense:
        trial = state.force + step.stiffness * step.displacement
        held = min(max(trial, -step.limit), step.limit)
        ahead = step.outruns(state, _sign(step.displacement))
        return before._replace(force=held, limit=step.limit, slipped=0.0, outrun=ahead), 0.0
    after = _slip(before, step)
    if step.front_rate == 0.0:
        return after, 0.0
    # The traction on the slipping annulus is mu p; it slips by dD - s dM/k all over.
    slid = max(step.outruns(state, before.sense), 0.0) / step.front_rate
    traction = before.limit * _annulus(max(before.slipped, 0.0)) + after.limit * _annulus(
        after.slipped
    )
    return after, 0.5 * traction * slid


def _turn_branch(state: ContactState, step: Step) -> ContactState:
    """Return the state with the sense and the branch of a step."""
    # The edge slips while its displacement outruns the limit. Where the displacement no longer
    # outruns it, the edge turns if it slips the other way, or sticks. Under a falling load it may
    # slip both ways, and goes on as before.
    sense = state.sense
    if sense and step.outruns(state, sense) > 0.0:
        return state
    if sense and step.outruns(state, -sense) > 0.0:
        turned = state._replace(sense=-sense, slipped=0.0, turn=state.force)
        if state.branch == UNLOADING:
            return turned._replace(branch=RELOADING, earlier=state.turn)
        return turned._replace(branch=UNLOADING)
    begun = 0 if sense else _sign(step.displacement) or _sign(state.force)
    ahead = step.outruns(state, begun)
    if not (begun and ahead > 0.0):
        return state._replace(sense=0)
    held = slipped = 0.0
    if state.limit > 0.0:
        # Slip began between the middles of the last step and of this one, at the instant at which
        # the gap to the limit stood still.
        began = -state.outrun / (ahead - state.outrun) if state.outrun < 0.0 else 0.5
        later = max((began - 0.5) * (step.limit - state.limit), -0.5 * state.limit)
        held = min((begun * state.force + later) / (state.limit + later), MOST_HELD)
        slipped = _edge((begun * state.force / state.limit - held) / (1.0 - held))
    return state._replace(sense=begun, branch=LOADING, slipped=slipped, held=held)


def _slip(state: ContactState, step: Step) -> ContactState:
    """Return the state after a step in which the edge slips."""
    old, limit, sense, branch = state.limit, step.limit, state.sense, state.branch
    pressed, square = limit - old, _square(limit)
    # The last turn was made from slip in the sense -s, the earlier one from s: both move with the
    # load.
    turn, earlier = state.turn - sense * pressed, state.earlier + sense * pressed
    held, loading = state.held, branch == LOADING
    # w and 1 - w, which cancels where h is tiny.
    weight, rest = (1.0 / (1.0 - held), -held / (1.0 - held)) if loading else (0.5, 0.5)
    grown = square - _square(old)
    ahead = state.slipped * _square(old) + weight * sense * step.moved + rest * grown
    slipped = max(ahead / square, 0.0) if square > 0.0 else 0.0
    if loading:
        force = sense * limit * (held + (1.0 - held) * _share_of_slip(slipped))
    else:
        force = turn + 2.0 * sense * limit * _share_of_slip(slipped)
        goal = earlier if branch == RELOADING else -turn
        if limit > 0.0 and sense * force > sense * goal:  # beyond its starting point: loading
            beyond = 2.0 * (slipped - _edge(0.5 * sense * (goal - turn) / limit))
            slipped, branch, held = _edge(sense * goal / limit) + beyond, LOADING, 0.0
            force = sense * limit * _share_of_slip(slipped)
    if slipped >= 1.0:  # gross slip: the memory is lost
        branch, held, force = LOADING, 0.0, sense * limit
    return state._replace(
        force=min(max(force, -limit), limit),
        limit=limit,
        slipped=min(slipped, 1.0),
        sense=sense if slipped > 0.0 else 0,  # 0: the slip zone has vanished
        branch=branch,
        held=held,
        turn=turn,
        earlier=earlier,
        outrun=0.0,
    )


def _square(limit: float) -> float:
    """Return M^(2/3)."""
    return math.cbrt(limit) ** 2


def _share_of_slip(slipped: float) -> float:
    """Return u = 1 - (1 - epsilon)^(3/2)."""
    if slipped >= 1.0:
        return 1.0
    return -math.expm1(1.5 * math.log1p(-slipped))


def _edge(used: float) -> float:
    """Return epsilon = 1 - (1 - u)^(2/3)."""
    if used >= 1.0:
        return 1.0
    return -math.expm1(math.log1p(-used) / 1.5)


def _annulus(slipped: float) -> float:
    """Return 1 - (3/2) theta + ½ theta³: mu p along the slipping part of the radius, over M."""
    theta = math.sqrt(1.0 - slipped)
    return (slipped / (1.0 + theta)) ** 2 * (1.0 + 0.5 * theta)


def _sign(value: float) -> int:
    return (value > 0.0) - (value < 0.0)
