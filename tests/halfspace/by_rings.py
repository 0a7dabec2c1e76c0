"""psi2 of impacts under any normal motions, by the half-space's rings: a referee."""

import numpy as np

from contactlab_halfspace.axisymmetric import STEPS, follow_all
from contactlab_halfspace.instants import Instants, instants


def rebound(motions, which, psi1, chi, count):
    """psi2, extrapolated from ``count`` rings and half as many; ``which`` motion is that of each.

    Motions are those of one impact, which in units of their own are those of many.
    """
    changes = []
    for number in (count, count // 2):
        paths = [instants(motion, number, STEPS) for motion in motions]
        path = paths[0]
        if len(paths) > 1:
            both = zip(*(each[3:] for each in paths), strict=True)
            path = Instants(*path[:3], *map(np.hstack, both)).take(which)
        changes.append(follow_all(number, path, psi1, chi, np.ones(psi1.shape)).change[-1])
    return np.asarray(psi1 + changes[0] + (changes[0] - changes[1]) / 3.0)
