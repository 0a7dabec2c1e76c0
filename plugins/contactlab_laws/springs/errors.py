"""Bounds of the numerical error of springs, as measured on random impacts.

With x = chi + abs(eta), n springs and m steps the error of psi2 is at most 0.46 x/n² of the springs
and 18 x^1.5/m² of the steps: of impacts of spheres and of bodies, in the plane and in space, chi to
1,000, beside the exact law or four times finer ones. It falls as the squares of both.
"""

from __future__ import annotations

import math

import numpy as np

from contactlab.contracts import Errors, NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import choose, greater, lesser, plain
from contactlab.numeric.types import Real
from contactlab.numeric.vectors import square_root
from contactlab_laws.march.coupled_steps import deepest
from contactlab_laws.springs.doubling import SPARE

#: Error of psi2 by springs, over x/n².
BY_SPRINGS = 0.46
#: Error by steps, over x^1.5/m². Steps beside a loss are graded, and longer in the middle.
BY_STEPS, BY_GRADED_STEPS = 18.0, 24.0
#: Error by steps below x = 1, over x/m^1.5: springs that enter within a step. A grid that doubles
#: meets more of them, and beside a loss they enter with a force.
BY_ENTERING, BY_ENTERING_DOUBLED = 2.5, 5.0
#: Springs of a doubling grid, over the least number of them that carry its largest contact.
DOUBLING = 2.0
#: Slip (psi1, and eta) below which errors fall with it: all of the contact but its edge sticks.
LITTLE_SLIP = 0.125
#: Fewest springs beside a loss of which errors were measured; fewer are noise.
LEAST_MEASURED = 8
#: Duration over largest approach and speed up to which a loss was measured: 2.94 without one. Hunt
#: and Crossley's contact creeps apart below e = 0.19, and even steps pass over its begin. Bodies of
#: Kelvin and Voigt were measured beyond, spheres of them down to e = 0.05.
LONGEST = 8.0
#: Measured up to these lam, and where friction can jam, abs(lam) > 1, down to this free share.
LARGEST_LAM, JAMS, LEAST_FREE = 3.0, 1.0, 0.1
#: Errors of bodies with loss, of the normal restitution: over the squares of springs and of steps,
#: times the root of ``deepest``; that of psi2 half of 1 + chi + abs(eta) times as large. Measured
#: up to this chi: at most .9 of it in 600 random planar impacts and 100 in space, e .02 to .999.
LOSS_BY_SPRINGS, LOSS_BY_STEPS, LOSS_CHI = 2.0, 4.0, 20.0
#: Springs and steps that leave an error of 2.1e-3, half of it each: over the root of x, and over
#: its power 3/4; the fewest; and x up to which they follow it, the largest at which errors were
#: measured, in powers of ``LEVEL``, so that impacts of a batch share them.
SPRINGS, STEPS, FEWEST_SPRINGS, FEWEST_STEPS = 21.0, 134.0, 20, 184
#: abs(lam) from which friction may press a contact beyond its grid, which then doubles: they are
#: twice as many springs.
OUTGROWS = 0.21
LARGEST, LEVEL = 1000.0, math.sqrt(2.0)


def resolve(scene: Scene) -> tuple[Real, Real]:
    """Return springs, an even number, and steps that leave an error of 2.1e-3 in psi2.

    With a loss it is 2.4e-3, as steps are graded. Fewer do not suffice: near slip throughout 50
    springs and 200 steps were off by up to 0.15 from x = 30 on, in 900 random impacts, e 0.3 to
    0.98.
    """
    lam, eta, _ = kinetics.sizes(scene)
    x = kinetics.largest_chi(scene) + eta
    # the infinite eta of an impact without friction is none
    x = lesser(greater(choose(x < math.inf, x, 0.0), LEVEL**-1), LARGEST)
    x = lesser(LEVEL ** np.ceil(np.log(x) / math.log(LEVEL) - 1e-9), LARGEST)
    fewest = greater(SPRINGS * square_root(x), FEWEST_SPRINGS)
    springs = 2.0 * np.ceil(0.5 * choose(lam > OUTGROWS, 2.0 * fewest, fewest))
    return plain(springs), plain(np.ceil(greater(STEPS * x**0.75, FEWEST_STEPS)))


def of_spheres(
    scene: Scene,
    springs: int,
    steps: Real,
    *,
    shared: bool,
    doubling: bool,
    restitution: Real | None = None,
) -> Errors:
    """Return the errors of impacts whose approach friction leaves as it is.

    ``shared`` is True for springs that share a loss, of Kelvin and Voigt's bodies with a
    ``restitution``. Their oscillations die away: the error was at most 0.5/((1 - e) chi) of that
    without loss, on 1,200 impacts of e 0.3 to 0.98 and chi to 300, wherever the latter is small.
    """
    chi: Real = scene.chi
    count = springs / DOUBLING if doubling else springs
    entering = BY_ENTERING_DOUBLED if doubling or shared else BY_ENTERING
    even = BY_GRADED_STEPS if shared else BY_STEPS
    slip: Real = abs(scene.psi1)
    if not scene.shape:  # as plain numbers a run pays nothing for it
        steps = float(steps)
        whole, entered = chi * math.sqrt(chi) / steps**2, min(chi, 1.0) / steps**1.5
        by_steps = max(even * whole, entering * entered)
        error = BY_SPRINGS * chi / count**2 + by_steps
        if restitution is not None:
            error *= float(_leave(error, chi, restitution))
        return Errors(error * min(slip / LITTLE_SLIP, 1.0))
    error = BY_SPRINGS * chi / count**2 + _by_steps(chi, steps, even, entering)
    if restitution is not None:
        error = error * _leave(error, chi, restitution)
    return Errors(error * np.minimum(slip / LITTLE_SLIP, 1.0))


def _leave(error: Real, chi: Real, restitution: Real) -> Real:
    """Return the share of an error that a loss leaves: less of a small error."""
    return np.minimum(1.0 / np.maximum((1.0 - restitution) * chi, 1.0) + error, 1.0)


def of_bodies(scene: Scene, springs: int, steps: Real, *, shared: bool) -> Errors:
    """Return the errors of impacts whose approach friction changes, or whose slip turns."""
    chi = kinetics.largest_chi(scene)
    lam, eta, psi1 = kinetics.sizes(scene)
    x = chi + eta
    depth: Real = deepest(scene)
    free = (lam <= JAMS) | (kinetics.free_share(scene) >= LEAST_FREE)
    known = (lam <= LARGEST_LAM) & free & (x < math.inf) & (psi1 < math.inf)
    # the contact radius grows as the fifth root of the energy that presses it; the grid doubles
    # where friction presses the contact beyond, and half of the springs remain
    doublings = np.ceil(np.log2(greater(depth**0.2 / SPARE, 1.0)))
    by_springs = BY_SPRINGS * x * 4.0**doublings / springs**2
    even = BY_GRADED_STEPS if shared else BY_STEPS
    root = square_root(depth)
    by_steps = _by_steps(x, steps, even, BY_ENTERING) * choose(lam > JAMS, root, 1.0)
    psi2: Real = (by_springs + by_steps) * lesser((psi1 + eta) / LITTLE_SLIP, 1.0)
    psi2 = plain(choose(known, psi2, math.nan))
    if not shared:
        return Errors(psi2)
    known = known & (chi <= LOSS_CHI) & (scene.pair.cross_stiffness_ratio == 1.0)
    own = LOSS_BY_SPRINGS / springs**2 + LOSS_BY_STEPS / (steps * steps)
    restitution = plain(choose(known, own * root, math.nan))
    return Errors(plain(np.fmin(psi2, 0.5 * (1.0 + x) * restitution)), restitution)


def where_measured(found: Errors, scene: Scene, normal: NormalMotion) -> Errors:
    """Return errors of impacts with loss, NaN where the contact lasts longer than was measured."""
    if scene.inverse_mass is not None and "kelvin_voigt" in normal.claims:
        return found
    length: Real = normal.duration * scene.normal_speed / normal.maximum_approach
    psi2, restitution = (plain(choose(length <= LONGEST, each, math.nan)) for each in found[:2])
    return Errors(psi2, restitution)


def _by_steps(x: Real, steps: Real, even: float, entering: float) -> Real:
    """Return the error by steps."""
    whole, entered = even * x**1.5 / steps**2, entering * lesser(x, 1.0) / steps**1.5
    return max(whole, entered) if isinstance(whole, float) else np.maximum(whole, entered)
