"""The axisymmetric impact by another march than the half-space's, which checks its answers.

Steps end on edges of rings only, at sin(i pi/2n); the edge next to the radius at separation is
moved there. Each step is solved for the displacement of the surfaces, not for their slip. psi2 is
the limit of several numbers of rings by least squares.
"""

import math

import numpy as np

from contactlab import Scene, create
from contactlab.solve.normal_motion import normal_motion
from contactlab_halfspace.rings import rings, settle

HALVINGS = 60
#: Numbers of rings, from whose answers the limit follows to 2e-4 in psi2.
COUNTS = (48, 64, 80, 96, 112, 128)


def motion(name, **options):
    """The motion of one impact, which in units of its own is that of all."""
    law = create(f"normal.{name}", **options)
    return normal_motion(law, Scene.nondimensional(psi1=1.0, chi=1.0))


def instants(normal, count):
    """Edges over the largest radius, and instants and rings inside at which the contact has them.

    Time in units of a²/(R v1), load in (4/3) E* a³/R, impulse in M_n v1, a the largest radius.
    """

    def radius(phase):
        return np.asarray(normal.at(phase).contact.radius, dtype=float)

    phases = np.linspace(0.0, math.pi, 4001)
    top = phases[radius(phases).argmax()]
    width = phases[1]
    for _ in range(HALVINGS):
        places = np.array([top - width, top, top + width])
        top, width = places[radius(places).argmax()], 0.6 * width
    largest, last = radius(np.array([top, math.pi]))
    angle, number = 2.0 / math.pi * math.asin(last / largest), 0
    if angle > 1e-6:
        number = min(max(round(count * angle), 1), count - 1)
    knots = [0.0, angle if number else 1.0 / count, 1.0]
    edges = np.sin(0.5 * np.pi * np.interp(np.arange(count + 1), [0, number or 1, count], knots))
    inside = np.concatenate((np.arange(count + 1), np.arange(count - 1, number - 1, -1)))
    wanted, rising = largest * edges[inside], np.arange(len(inside)) <= count
    low, high = np.where(rising, 0.0, top), np.where(rising, top, math.pi)
    for _ in range(HALVINGS):
        middle = 0.5 * (low + high)
        before = (radius(middle) < wanted) == rising
        low, high = np.where(before, middle, low), np.where(before, high, middle)
    at = 0.5 * (low + high)
    at[[0, count, -1]] = 0.0, top, math.pi
    sample, scene, pair = normal.at(at), normal.scene, normal.scene.pair
    time = sample.time * pair.radius * scene.normal_speed / largest**2
    load = sample.contact.friction_load * 0.75 * pair.radius / pair.effective_modulus / largest**3
    return edges, inside, time, load, sample.load_impulse / (pair.normal_mass * scene.normal_speed)


def rebound(psi1, chi, normal, count):
    """psi2 of impacts that share a normal motion, by ``count`` rings."""
    # The share of Coulomb's limit that acts, F/(mu P), is linear in the impulse of the friction
    # load in a step, so that gross slip is exact. Each step is solved twice: first with the share
    # at its start, then with the shares at both ends.
    edges, inside, time, loads, impulse = instants(normal, count)
    table, psi = rings(edges), psi1
    displaced = np.zeros((len(psi1), count))
    stuck, sense = np.ones(displaced.shape, dtype=bool), np.zeros(displaced.shape)
    share, begun = np.zeros(len(psi1)), False
    for k, duration in enumerate(np.diff(time)):
        gain = 2.0 * chi * (impulse[k + 1] - impulse[k])
        number, load, after = int(inside[k + 1]), float(loads[k + 1]), share
        if number and load > 0.0:
            ours, edge = table.within(number), edges[number]
            limit = load / edge**3 * np.sqrt(edge**2 - ours.points**2)
            part = slice(None), slice(number)
            for _ in range(2):
                share = share if begun else after  # force and load begin in proportion
                moved = duration * (psi - gain * (share / 3.0 + after / 6.0))
                aim = displaced[part] + moved[:, None]
                traction = settle(ours, aim, limit, stuck[part], sense[part])
                after = traction @ ours.weights / load
            displaced = traction @ table.compliance[:, :number].T
            share, begun = share if begun else after, True
        psi = psi - 0.5 * gain * (share + after)
        share = after
    return psi


def limit(psi1, chi, normal, counts=COUNTS):
    """psi2 in the limit of many rings, shape (impacts,): a of a + b/n² by least squares."""
    # Where a slip front stands between two edges adds an error that differs from one number of
    # rings to the next: several numbers make its mean smaller.
    numbers = np.array(counts, dtype=float)
    answers = np.array([rebound(psi1, chi, normal, count) for count in counts])
    weights = (numbers / numbers.max()) ** 2
    terms = np.stack([weights, weights / numbers**2], axis=1)
    return np.linalg.lstsq(terms, answers * weights[:, None], rcond=None)[0][0]
