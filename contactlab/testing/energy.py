"""Checks that a stepped law makes no energy from nothing, and closes its energy books."""

from __future__ import annotations

import numpy as np

from contactlab.contracts import SteppedTangentialLaw
from contactlab.numeric.types import Array
from contactlab.testing.check import CHANGES, GROWS, check, hold, within
from contactlab.testing.load_paths import (
    Bench,
    Path,
    continue_from,
    drive,
    slack,
    straight,
    wandering,
)

#: Error of the trapezium rule on these paths, over mu P_max times the unit of slip.
QUADRATURE = 2e-3
#: Bound of negative friction work in a step of a law that has a resolution, in the same unit.
DISCRETE_WORK = 1e-3
#: Steps of a leg that give the work to 1 %, although a rigid law's force jumps.
PART = 128
SEEDS = tuple(range(21, 27))


def sum_work(path: Path, force: Array) -> Array:
    """Return the work done on the contact up to each step, scaled, shape (K,)."""
    mean = force + np.concatenate(([0.0], force[:-1]))
    return np.cumsum(0.5 * mean * np.diff(path.slip, prepend=0.0))


@check(SteppedTangentialLaw, nature=GROWS)
def closed_cycles(law: SteppedTangentialLaw) -> None:
    """A closed cycle of slip and normal load gives no energy."""
    bench = Bench.of()
    for low, high in ((0.6, 0.6), (0.2, 0.8), (0.8, 0.2), (0.4, 1.0), (1.0, 0.4)):
        for size in (0.15, 0.5, 2.0):
            cycle = [(size, low), (size, high), (-size, high), (-size, low)]
            path = straight((0.0, low), *(3 * cycle), steps=24)
            work = sum_work(path, drive(law, bench, path).force)
            # State and force repeat from the second cycle on.
            gain = work[24 * 5 - 1] - work[24 * 13 - 1]
            within(
                gain,
                QUADRATURE,
                f"Cycles of slip {size} between zeta = {low} and {high} give {gain:.2g} of energy.",
            )


@check(SteppedTangentialLaw, nature=GROWS)
def random_paths(law: SteppedTangentialLaw) -> None:
    """No path from rest returns more energy than was put in (passivity, theory §7)."""
    bench = Bench.of()
    for fixed in (True, False):
        for seed in SEEDS:
            path = wandering(seed, fixed=fixed)
            least = sum_work(path, drive(law, bench, path).force).min()
            load = "fixed" if fixed else "varying"
            hold(
                least >= -QUADRATURE,
                f"A random path at {load} normal load gives {-least:.2g} of energy (seed {seed}).",
            )


@check(SteppedTangentialLaw, nature=GROWS)
def partial_unloading(law: SteppedTangentialLaw) -> None:
    """A contact sheared, loaded or unloaded, and released returns no more energy than put in."""
    bench = Bench.of()
    for first, then in ((1.0, 0.4), (1.0, 0.1), (0.4, 1.0), (0.1, 0.8)):
        for size in (0.05, 0.15, 0.4):
            path = straight((0.0, first), (size, first), (size, then), (-2.0 * size, then))
            work = sum_work(path, drive(law, bench, path).force)
            hold(
                work.min() >= -max(0.01 * work.max(), 1e-12),
                f"Sheared by {size} at zeta = {first}, let go at {then}: {work.max():.3g} put in, "
                f"{work.max() - work.min():.3g} given back.",
            )


@check(SteppedTangentialLaw)
def friction_work(law: SteppedTangentialLaw) -> None:
    """The friction work of a step is never negative (TangentialResponse)."""
    allowed = 1e-12 if law.resolution is None else DISCRETE_WORK
    for seed in SEEDS:
        least = drive(law, Bench.of(), wandering(seed)).work.min()
        hold(least >= -allowed, f"Friction work of {least:.2g} in one step (seed {seed}).")


@check(SteppedTangentialLaw, nature=CHANGES)
def books(law: SteppedTangentialLaw) -> None:
    """All the work put in is friction work by the time that the bodies part."""
    bench = Bench.of()
    for seed in SEEDS[:3]:
        course = wandering(seed, knots=6, steps=PART)
        path = Path(
            np.concatenate([course.slip, np.full(PART, course.slip[-1])]),
            np.concatenate([course.level, np.linspace(course.level[-1], 0.0, PART + 1)[1:]]),
        )
        driven = drive(law, bench, path)
        work, lost = float(sum_work(path, driven.force)[-1]), float(np.sum(driven.work))
        missing = abs(work - lost) / max(abs(work), lost, 1e-300)
        within(
            missing,
            slack(law, 0.01),
            f"{work:.4g} was put in and {lost:.4g} lost to friction: {missing:.1%} of it is not in "
            f"the books (seed {seed}).",
        )


@check(SteppedTangentialLaw)
def work_in_its_step(law: SteppedTangentialLaw) -> None:
    """A small step back after long steps in gross slip has small friction work."""
    bench, level, long, short = Bench.of(), 0.7, 0.1, 0.002
    slid = drive(law, bench, straight((0.0, level), (4.0, level), steps=40)).state
    back = Path(np.array([4.0 - short]), np.array([level]))
    work = float(continue_from(law, bench, slid, back, slip=4.0, level=level, count=40).work[0])
    largest = level**1.5 * short
    within(
        work,
        (1.0 + slack(law)) * largest,
        f"A step back by {short} in gross slip has a friction work of {work:.2g}; mu P times its "
        f"displacement is {largest:.2g}, and that of the step before, of {long}, "
        f"{level**1.5 * long:.2g}.",
    )
