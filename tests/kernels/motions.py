"""Motions of one contact for the kernels, and what the law in Python answers along them."""

import numpy as np
from scipy.integrate import quad

from contactlab_laws.springs.doubling import Memory, move_springs

UNIT, MODULUS, TIME = 0.7, 3.0e4, 0.02


def sliding(seed, steps=600):
    """A motion along one line in a fixed plane: rows of moved, normal, radius and limit.

    Radii cross many doublings both ways; the contact ends and begins again.
    """
    random = np.random.default_rng(seed)
    normal = random.normal(size=3)
    normal /= np.linalg.norm(normal)
    along = np.cross(normal, random.normal(size=3))
    along /= np.linalg.norm(along)
    radius = 0.05 * np.exp(np.cumsum(random.normal(0.0, 0.15, steps)))
    radius[random.uniform(size=steps) < 0.01] = 0.0
    radius[100:110] = 0.0
    sizes = random.normal(0.0, 1e-3, steps) * radius**2 * 3.0
    limit = 4.0 * radius**3 * random.uniform(0.9, 1.1, steps)
    limit[200:220] = 0.0  # a contact without normal force
    rows = np.zeros((steps, 8))
    rows[:, :3], rows[:, 3:6] = np.outer(sizes, along), normal
    rows[:, 6], rows[:, 7] = radius, limit
    return rows, along, sizes


def wandering(seed, steps=600):
    """A motion in space whose normal turns, with parts of the displacement along the normal."""
    rows, _, _ = sliding(seed, steps)
    random = np.random.default_rng(seed + 1000)
    turning = np.cumsum(random.normal(0.0, 0.02, (steps, 3)), axis=0) + random.normal(size=3)
    rows[:, 3:6] = turning / np.linalg.norm(turning, axis=1, keepdims=True)
    rows[:, :3] = random.normal(0.0, 1e-3, (steps, 3)) * rows[:, 6:7] ** 2
    return rows


def damped(rows, seed):
    """A motion with the columns of loss: elastic part, damping and slip velocity, steps of TIME.

    Damping presses, pulls and pulls the contact apart; the relaxation time goes from a hundredth
    of a step to a hundred steps, and is zero now and then.
    """
    random, steps = np.random.default_rng(seed + 2000), len(rows)
    shares = np.exp(random.normal(0.0, 0.7, steps))  # of the limit that is elastic
    shares[150:155] = 0.0  # a contact that damping alone presses
    elastic = rows[:, 7] * shares
    limit = np.where(random.uniform(size=steps) < 0.02, 0.0, rows[:, 7])
    lag = TIME * 10.0 ** np.repeat(random.uniform(-2.0, 2.0, steps // 20 + 1), 20)[:steps]
    lag[random.uniform(size=steps) < 0.02] = 0.0
    sizes = np.repeat(10.0 ** random.uniform(-3.0, 0.0, steps // 20 + 1), 20)[:steps]
    moved = rows[:, :3] * sizes[:, None]
    velocity = moved / TIME * random.uniform(0.5, 1.5, (steps, 1))
    damping = lag * MODULUS * rows[:, 6]
    return np.column_stack([moved, rows[:, 3:7], limit, elastic, damping, velocity])


def by_the_law(springs, rows, sizes):
    """Force along the line and work of each step, shape (K, 2), by ``grid="doubling"``."""
    none, places = np.zeros(1), np.zeros((springs, 1))
    memory, unit, modulus = Memory(none, none, places, places), np.array([UNIT]), MODULUS
    answers = []
    for size, radius, limit in zip(sizes, rows[:, 6], rows[:, 7], strict=True):
        force, work, memory = move_springs(
            memory,
            np.array([size]),
            np.array([radius]),
            np.array([limit]),
            unit=unit,
            modulus=np.array([modulus]),
        )
        answers.append((force[0], work[0]))
    return np.array(answers)


def by_vectors(springs, rows):
    """Forces on the first body, shape (K, 3): the rules of theory §13 for vectors, one by one."""
    size, before, w, forces = 0.0, 0.0, np.zeros((springs, 3)), []
    for row in rows:
        step, normal, radius, limit = row[:3], row[3:6], row[6], row[7]
        elastic, damping, *velocity = row[8:] if len(row) > 8 else (limit, 0.0, *step)
        lag = damping / (MODULUS * radius) if radius > 0.0 else 0.0
        if lag > 0.0 and limit < elastic:
            radius *= (limit / elastic) ** (1.0 / 3.0)
        if radius <= 0.0:
            size, before, w = 0.0, 0.0, np.zeros((springs, 3))
            forces.append(np.zeros(3))
            continue
        if size == 0.0:
            size = UNIT * 2.0 ** np.ceil(np.log2(radius / UNIT))
        while lag > 0.0 and radius > size:
            w = widened(w)
            size *= 1.25
        while radius > size:
            w = np.concatenate((0.5 * (w[::2] + w[1::2]), np.zeros((springs // 2, 3))))
            size *= 2.0
        while radius <= size / 4.0:
            w = np.repeat(w[: springs // 2], 2, axis=0)
            size /= 2.0
        places = (np.arange(springs) + 0.5) * size / springs
        length = np.linalg.norm(w)
        w = w - np.outer(w @ normal, normal)
        w *= length / np.linalg.norm(w) if length > 0.0 else 1.0  # a turn keeps the energy
        step = step - (step @ normal) * normal
        velocity = velocity - (velocity @ normal) * normal
        jump = 0.0
        if lag > 0.0 and limit > elastic:
            jump = 2.0 / 3.0 * radius**2 * min(limit / elastic - 1.0 if elastic else 1e9, 1e9)
        compression = np.where(places < radius, radius**2 - places**2 + jump, 0.0)
        steep = limit / (MODULUS * size / springs * compression.sum())
        most, least = steep * compression, steep * (np.maximum(before**2 - places**2, 0.0) + jump)
        force = np.zeros(3)
        for i in range(springs):
            met = radius > before and places[i] > before
            part = max((radius - places[i]) / (radius - before), 0.0) if met else 1.0
            trial = w[i] + part * step
            if lag > 0.0 and places[i] < radius:
                w[i] = relaxing(w[i], trial, part * TIME / lag, least[i], most[i])
                force += cut(w[i] + lag * velocity, most[i])
            else:
                w[i] = cut(trial, most[i])
                force += w[i]
        before = radius
        forces.append(-MODULUS * size / springs * force)
    return np.array(forces)


def widened(w):
    """Return w in cells of 5/4 of the width: means over what they cover, by the integral of w."""
    edges = np.arange(len(w) + 1.0)
    sums = np.concatenate((np.zeros((1, 3)), np.cumsum(w, axis=0)))
    integral = np.transpose([np.interp(1.25 * edges, edges, each) for each in sums.T])
    return np.diff(integral, axis=0) / 1.25


def cut(vector, most):
    """Return a vector of at most a length."""
    length = np.linalg.norm(vector)
    return vector * (most / length) if length > most else vector


def relaxing(held, trial, x, before, after):
    """Return w after x relaxation times: w' = (f - w)/A, abs(f) up to a limit on a line."""
    left, gone = np.exp(-x), -np.expm1(-x)
    mean = quad(lambda t: (before + (after - before) * t) * x * np.exp(-x * (1.0 - t)), 0.0, 1.0,
                epsabs=0.0, epsrel=1e-13)[0]  # fmt: skip
    moved, grown = left * held + cut(trial - left * held, mean), after * gone
    if mean > grown:  # where w grows, the limit of the end counts
        least = left * held + cut(trial - left * held, grown)
        moved = cut(moved, max(np.linalg.norm(held), np.linalg.norm(least)))
    return moved


def write(path, springs, rows, unit=UNIT, modulus=MODULUS, time=TIME):
    """Write a motion for the drivers."""
    head = np.array([springs, len(rows), unit, modulus, time * (rows.shape[1] > 8)], float)
    np.concatenate((head, rows.ravel())).tofile(path)
