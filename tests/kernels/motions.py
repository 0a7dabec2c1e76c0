"""Motions of one contact for the kernels, and what the law in Python answers along them."""

import numpy as np

from contactlab_laws.springs.doubling import Memory, moved

UNIT, MODULUS = 0.7, 3.0e4


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


def by_the_law(springs, rows, sizes):
    """Force along the line and work of each step, shape (K, 2), by ``grid="doubling"``."""
    none, places = np.zeros(1), np.zeros((springs, 1))
    memory, unit, modulus = Memory(none, none, places, places), np.array([UNIT]), MODULUS
    answers = []
    for size, radius, limit in zip(sizes, rows[:, 6], rows[:, 7], strict=True):
        force, work, memory = moved(
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
        if radius <= 0.0:
            size, before, w = 0.0, 0.0, np.zeros((springs, 3))
            forces.append(np.zeros(3))
            continue
        if size == 0.0:
            size = UNIT * 2.0 ** np.ceil(np.log2(radius / UNIT))
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
        compression = np.maximum(radius**2 - places**2, 0.0)
        most = limit * compression / (MODULUS * size / springs * compression.sum())
        for i in range(springs):
            met = radius > before and places[i] > before
            part = (radius - places[i]) / (radius - before) if met else 1.0
            trial = w[i] + max(part, 0.0) * step
            length = np.linalg.norm(trial)
            w[i] = trial * (most[i] / length) if length > most[i] else trial
        before = radius
        forces.append(-MODULUS * size / springs * w.sum(axis=0))
    return np.array(forces)


def write(path, springs, rows, unit=UNIT, modulus=MODULUS):
    """Write a motion for the drivers."""
    head = np.array([springs, len(rows), unit, modulus], float)
    np.concatenate((head, rows.ravel())).tofile(path)
