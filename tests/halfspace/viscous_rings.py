"""Coulomb's law at every point with loss in pressure and shear: rings, no springs (theory §15).

The traction is (1 + a d/dT) q_e, where q_e is the elastic traction of the same displacement. Over
a step of duration h the traction q is constant, so that q_e grows to E q_e + (1 - E) q,
E = exp(-h/a). Steps end where the edge of the contact passes rings, and half-way in its square.
"""

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from contactlab_halfspace.rings import rings, settle

#: Solutions of a step: the mean slip velocity of a step follows from its friction.
PASSES = 3


def phases(a):
    """Solutions (b, V, T) over x of loading and unloading, dT = 2b dx, and the ends of x."""

    def loading(_, y):
        return y[1], -2.5 * y[0] * (y[0] ** 3 + 1.5 * a * y[1] * y[0]), 2.0 * y[0]

    def unloading(_, y):
        return y[1] - 1.25 * a * y[0] ** 3, -2.5 * y[0] ** 4, 2.0 * y[0]

    found, start = [], (0.0, 1.0, 0.0)
    for slope, which in ((loading, 1), (unloading, 0)):

        def end(_, y, which=which):
            return y[which]

        end.terminal, end.direction = True, -1
        run = solve_ivp(
            slope, (0.0, 1e4), start, method="DOP853", rtol=1e-12, atol=1e-15, events=end,
            dense_output=True,
        )  # fmt: skip
        found.append((run.sol, run.t_events[0][0]))
        start = run.y_events[0][0]
    return found, start


def course(a, edges):
    """Times, squared radii over the largest, and the largest radius, in loading and unloading."""
    (first, last), _ = phases(a)
    largest = last[0](0.0)[0]
    squares = np.concatenate(([0.0], np.repeat(edges[:-1] ** 2, 2)[1:], [1.0]))
    squares[1:-1:2] = 0.5 * (edges[:-1] ** 2 + edges[1:] ** 2)
    radii = largest * np.sqrt(squares)

    def passed(phase, radius):
        return brentq(lambda x: phase[0](x)[0] - radius, 0.0, phase[1], xtol=1e-14)

    up = [0.0, *(first[0](passed(first, r))[2] for r in radii[1:-1]), first[0](first[1])[2]]
    down = [last[0](passed(last, r))[2] for r in radii[-2:0:-1]]
    times = np.array([*up, *down, last[0](last[1])[2]])
    return times, np.concatenate((squares, squares[-2::-1])), largest


def rebound(psi1, chi, a, count):
    """psi2, shape (impacts,), by ``count`` rings."""
    edges = np.sin(0.5 * np.pi * np.arange(count + 1) / count)
    table, (times, squares, largest) = rings(edges), course(a, edges)
    turn, psi, zero = int(squares.argmax()), psi1.copy(), np.zeros((len(psi1), count))
    elastic, pressure, stuck, sense = zero, np.zeros(count), zero == 0.0, zero.copy()
    unit = largest**2  # of displacements; tractions have ``largest``, forces its cube

    def hemisphere(square):
        """The traction over a contact between two edges, at the points, and its rings."""
        number = int(np.searchsorted(edges, np.sqrt(square) - 1e-10))
        if number == 0:
            return np.zeros(count), 0
        outer, inner = (np.sqrt(np.maximum(edges[k] ** 2 - table.points**2, 0.0))
                        for k in (number, number - 1))  # fmt: skip
        share = (square - edges[number - 1] ** 2) / (edges[number] ** 2 - edges[number - 1] ** 2)
        return share * outer + (1.0 - share) * inner, number

    for step, duration in enumerate(np.diff(times)):
        decay = np.exp(-duration / a)
        before, after = squares[step : step + 2]
        (old, rings_before), (new, rings_after) = hemisphere(before), hemisphere(after)
        loads = step < turn
        limit = (new - decay * pressure) / (1.0 - decay) if loads else 0.5 * (old + new)
        pressure, number = new, rings_after if loads else rings_before
        ours, part = table.within(number), (slice(None), slice(number))
        entered = np.ones(number)
        if loads:  # a ring that comes into contact is moved from then on
            late = ours.points**2 > before
            entered[late] = ((after - ours.points**2) / (after - before))[late]
        limit = np.maximum(limit[:number], 0.0)
        held, mean = elastic @ table.compliance[:number].T, psi
        for _ in range(PASSES):
            moved = held + (duration / unit) * mean[:, None] * entered
            aim = (moved - decay * held) / (1.0 - decay)
            traction = settle(ours, aim, limit, stuck[part], sense[part])
            force = largest**3 * (traction @ ours.weights)
            mean = psi - 1.25 * chi * duration * force
        psi = psi - 2.5 * chi * duration * force
        grown = zero.copy()
        grown[part] = traction
        elastic = decay * elastic + (1.0 - decay) * grown
    return psi
