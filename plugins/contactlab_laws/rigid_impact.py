"""Rigid bodies where friction changes the approach: Coulomb's law over the normal impulse.

In the plane Routh's construction: slip of one sign, then stick, or slip the other way. In space
Keller's equations, in which the slip turns. Restitution is energetic (Stronge): the normal impulse
gives back e² of the work that it did in compression.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from contactlab.contracts import Ends, NormalMotion, Scene, TangentialMotion
from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.numeric.arrays import spread, spread_object
from contactlab.numeric.types import Array, Real

#: Tolerance of Keller's equations; slip below this part of the speed has stopped. Steps chatter
#: about a slip that hardly stops, at ten tolerances.
TOLERANCE, STOPPED = 1e-11, 1e-9


def rigid_impacts(scene: Scene, normal: NormalMotion) -> TangentialMotion:
    """Return the motion of rigid bodies with the restitution of the approach without friction."""
    shape = scene.shape
    W = np.broadcast_to(np.asarray(scene.inverse_mass), (*shape, 3, 3)).reshape(-1, 3, 3)
    before = scene.velocity.reshape(-1, 3)
    mu = np.broadcast_to(scene.friction_coefficient, shape).reshape(-1)
    e = np.broadcast_to(-np.asarray(normal.final_rate) / scene.normal_speed, shape).reshape(-1)
    one = _planar if scene.planar else _spatial
    rows = [one(*each) for each in zip(W, before, mu.tolist(), e.tolist(), strict=True)]
    after = np.array([row[0] for row in rows]).reshape(*shape, 3)
    work, loss = (np.array([row[k] for row in rows]).reshape(shape) for k in (1, 2))
    change = after[..., 1:] - scene.velocity[..., 1:]
    number: Callable[[Array], Real] = np.asarray if shape else float
    unknown = spread(math.nan, shape)  # rigid impacts take no time
    return TangentialMotion(
        slip_velocity_change=kinetics.tangent(scene, change),
        friction_work=number(work),
        normal=Ends(unknown, number(after[..., 0]), *3 * (unknown,), number(loss)),
        status=spread_object(Status.SUCCESS, shape),
    )


def _planar(inverse: Array, before: Array, mu: float, e: float) -> tuple[Array, float, float]:
    """Return velocities after, friction work and normal loss of one impact in the plane."""
    rate, slip = float(before[0]), float(before[1])
    n, c, t = float(inverse[0, 0]), float(inverse[0, 1]), float(inverse[1, 1])
    if slip != 0.0:
        sign = math.copysign(1.0, slip)
    else:  # pressure drags the bodies this way unless friction holds them
        sign = 0.0 if abs(c) <= mu * t else -math.copysign(1.0, c)
    books = _Books(rate, e)
    while True:
        # friction over pressure: the limit in slip, what holds the contact in stick
        ratio = sign * mu if sign else -c / t
        fall, drag = n + ratio * c, c + ratio * t
        until = slip / drag if sign and slip * drag > 0.0 else math.inf
        impulse = books.follow(fall, until)
        books.work += ratio * impulse * (slip - 0.5 * drag * impulse)
        slip -= drag * impulse
        if impulse < until:
            return np.array([books.rate, slip, before[2]]), books.work, books.loss
        slip = 0.0
        sign = 0.0 if abs(c) <= mu * t else -math.copysign(1.0, c)


class _Books:
    """The rate of approach over the normal impulse, and the work of that impulse."""

    def __init__(self, rate: float, e: float) -> None:
        self.rate, self.part = rate, e * e
        self.pressed = self.restore = 0.0
        self.work = 0.0

    def follow(self, fall: float, until: float) -> float:
        """Return the impulse to the end of the impact, at most ``until``; dV/dp = -``fall``."""
        impulse = 0.0
        if self.rate > 0.0:
            zero = self.rate / fall if fall > 0.0 else math.inf
            impulse = min(zero, until)
            self.pressed += impulse * (self.rate - 0.5 * fall * impulse)
            self.rate -= fall * impulse
            if zero > until:
                return until
            self.rate = 0.0
        owed = self.part * self.pressed - self.restore
        # -V grows from r as r + fall p: r p + fall p²/2 = owed
        r = -self.rate
        more = (math.sqrt(r * r + 2.0 * fall * owed) - r) / fall
        more = min(more, until - impulse)
        self.restore += more * (r + 0.5 * fall * more)
        self.rate -= fall * more
        return impulse + more if impulse + more < until else until

    @property
    def loss(self) -> float:
        """Loss of the normal impulse: work in compression less work returned."""
        return self.pressed - self.restore


def _spatial(inverse: Array, before: Array, mu: float, e: float) -> tuple[Array, float, float]:
    """Return velocities after, friction work and normal loss of one impact in space."""
    from scipy.integrate import solve_ivp

    W = inverse
    scale = float(np.linalg.norm(before))
    W_nt, W_tt = W[1:, 0], W[1:, 1:]
    held = -np.linalg.solve(W_tt, W_nt)  # the ratio that holds the contact, if mu allows it
    sticks = float(np.hypot(*held)) <= mu
    state = np.array([*before, 0.0, 0.0])  # V, slip, work of the normal impulse, friction work
    pressed = math.nan
    stuck = float(np.hypot(*before[1:])) <= STOPPED * scale and sticks

    def slopes(_: float, y: Array) -> Array:
        size = math.hypot(y[1], y[2])
        ratio = held if stuck else mu * (y[1:3] / size if size > 0.0 else _way_out(W_nt, W_tt, mu))
        drag = W_nt + W_tt @ ratio
        return np.array([-(W[0, 0] + W_nt @ ratio), *-drag, y[0], ratio @ y[1:3]])

    def compress(_: float, y: Array) -> float:
        return float(y[0]) if pressed != pressed else 1.0

    def restore(_: float, y: Array) -> float:
        return float(y[3] - (1.0 - e * e) * pressed) if pressed == pressed else 1.0

    def stop_slip(_: float, y: Array) -> float:
        return 1.0 if stuck else math.hypot(y[1], y[2]) - STOPPED * scale

    events = [compress, restore, stop_slip]
    for event in events:
        event.terminal, event.direction = True, -1.0  # type: ignore[attr-defined]
    reach = 1e3 * scale / float(np.linalg.eigvalsh(W)[0])
    at = 0.0
    for _ in range(20):
        path = solve_ivp(
            slopes, (at, reach), state, "DOP853", events=events, rtol=TOLERANCE,
            atol=TOLERANCE * scale * min(1.0, scale),
        )  # fmt: skip
        assert path.t_events is not None
        at, state = float(path.t[-1]), path.y[:, -1].copy()
        if path.t_events[1].size:
            break
        if path.t_events[0].size:
            pressed = float(state[3])
            if e == 0.0:
                break
        if path.t_events[2].size:
            stuck = sticks
            state[1:3] = 0.0 if stuck else 2.0 * STOPPED * scale * _way_out(W_nt, W_tt, mu)
    loss = pressed * (1.0 - e * e)
    return state[:3], float(state[4]), loss


def _way_out(coupling: Array, drag: Array, mu: float) -> Array:
    """Return the direction in which slip begins where friction cannot hold the contact."""
    # the slip grows along its own direction: -(W_nt + mu W_tt s) = g s with g > 0
    from scipy.optimize import brentq

    def excess(g: float) -> float:
        return float(np.linalg.norm(np.linalg.solve(mu * drag + g * np.eye(2), coupling)) - 1.0)

    # brentq wants an absolute tolerance: this one leaves the root to the relative one
    g = float(brentq(excess, 0.0, float(np.linalg.norm(coupling)), xtol=1e-300, rtol=1e-14))
    return -np.asarray(np.linalg.solve(mu * drag + g * np.eye(2), coupling))
