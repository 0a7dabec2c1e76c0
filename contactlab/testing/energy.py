"""Checks that a stepped law makes no energy from nothing, and keeps its books."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts import SteppedTangentialLaw
from contactlab.testing.bench import (
    Bench,
    Path,
    continue_from,
    drive,
    slack,
    straight,
    wandering,
)
from contactlab.testing.check import check, hold

#: Trapezium rule on the steps of these paths, over mu P_max times the unit of slip.
QUADRATURE = 2e-3
#: What one step of a law with a discretisation of its own may show, in the same units.
DISCRETE_WORK = 1e-3
#: Steps of a leg where work is added up to 1 %: a rigid law's force jumps.
PART = 128
SEEDS = tuple(range(21, 27))


def given_work(path: Path, force: Any) -> Any:
    """Return the work done on the contact up to each step, scaled; F = 0 at the start."""
    mean = force + np.concatenate(([0.0], force[:-1]))
    return np.cumsum(0.5 * mean * np.diff(path.slip, prepend=0.0))


@check(SteppedTangentialLaw)
def closed_cycles(law: Any) -> None:
    """To and fro at any normal load, to the same load: a cycle gives back no energy."""
    bench = Bench.of()
    for low, high in ((0.6, 0.6), (0.2, 0.8), (0.8, 0.2), (0.4, 1.0), (1.0, 0.4)):
        for size in (0.15, 0.5, 2.0):
            cycle = [(size, low), (size, high), (-size, high), (-size, low)]
            path = straight((0.0, low), *(3 * cycle), steps=24)
            work = given_work(path, drive(law, bench, path).force)
            # From the second cycle on, state and force are those of the cycle before.
            gain = work[24 * 5 - 1] - work[24 * 13 - 1]
            hold(
                gain <= QUADRATURE,
                f"Cycles of slip {size} between zeta = {low} and {high} give {gain:.2g} of energy."
                f" Bound: {QUADRATURE:.2g}.",
            )


@check(SteppedTangentialLaw)
def random_paths(law: Any) -> None:
    """From rest, no path gives back more energy than it took (passivity, theory §7)."""
    bench = Bench.of()
    for fixed in (True, False):
        for seed in SEEDS:
            path = wandering(seed, fixed=fixed)
            least = given_work(path, drive(law, bench, path).force).min()
            load = "fixed" if fixed else "varying"
            hold(
                least >= -QUADRATURE,
                f"A random path at {load} normal load gives {-least:.2g} of energy (seed {seed}).",
            )


@check(SteppedTangentialLaw)
def partial_unloading(law: Any) -> None:
    """Sheared, then pressed less or more, then let go: no more comes back than was put in."""
    bench = Bench.of()
    for first, then in ((1.0, 0.4), (1.0, 0.1), (0.4, 1.0), (0.1, 0.8)):
        for size in (0.05, 0.15, 0.4):
            path = straight((0.0, first), (size, first), (size, then), (-2.0 * size, then))
            work = given_work(path, drive(law, bench, path).force)
            hold(
                work.min() >= -max(0.01 * work.max(), 1e-12),
                f"Sheared by {size} at zeta = {first}, let go at {then}: {work.max():.3g} put in, "
                f"{work.max() - work.min():.3g} given back.",
            )


@check(SteppedTangentialLaw)
def friction_work(law: Any) -> None:
    """Friction work is never negative, in no step (TangentialResponse)."""
    allowed = 1e-12 if law.resolution is None else DISCRETE_WORK
    for seed in SEEDS:
        least = drive(law, Bench.of(), wandering(seed)).work.min()
        hold(least >= -allowed, f"Friction work of {least:.2g} in one step (seed {seed}).")


@check(SteppedTangentialLaw)
def books(law: Any) -> None:
    """What is put in is lost to friction once the bodies part: nothing else is left."""
    bench = Bench.of()
    for seed in SEEDS[:3]:
        out = wandering(seed, knots=6, steps=PART)
        path = Path(
            np.concatenate([out.slip, np.full(PART, out.slip[-1])]),
            np.concatenate([out.level, np.linspace(out.level[-1], 0.0, PART + 1)[1:]]),
        )
        found = drive(law, bench, path)
        work, lost = float(given_work(path, found.force)[-1]), float(np.sum(found.work))
        off = abs(work - lost) / max(abs(work), lost, 1e-300)
        hold(
            off <= slack(law, 0.01),
            f"{work:.4g} was put in and {lost:.4g} lost to friction: {off:.1%} of it is not in "
            f"the books (seed {seed})."
            f" Bound: {slack(law, 0.01):.2g}.",
        )


@check(SteppedTangentialLaw)
def work_in_its_step(law: Any) -> None:
    """A small step back after long ones in gross slip has friction work of its own size only."""
    bench, level, long, short = Bench.of(), 0.7, 0.1, 0.002
    slid = drive(law, bench, straight((0.0, level), (4.0, level), steps=40)).state
    back = Path(np.array([4.0 - short]), np.array([level]))
    work = float(continue_from(law, bench, slid, back, slip=4.0, level=level, count=40).work[0])
    most = level**1.5 * short
    hold(
        work <= (1.0 + slack(law)) * most,
        f"A step back by {short} in gross slip has a friction work of {work:.2g}; mu P times its "
        f"displacement is {most:.2g}, and that of the step before, of {long}, "
        f"{level**1.5 * long:.2g}."
        f" Bound: {(1.0 + slack(law)) * most:.2g}.",
    )
