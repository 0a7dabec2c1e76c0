"""Checks of a stepped law's answers: their form, and a state that is a value."""

from __future__ import annotations

import copy
from typing import Any

import numpy as np

from contactlab.contracts import SteppedTangentialLaw
from contactlab.numeric.arrays import lock_arrays
from contactlab.numeric.types import Array, Real
from contactlab.registry.registry import REGISTRY
from contactlab.solve.normal_motion import normal_motion
from contactlab.testing.check import check, hold, within, worst
from contactlab.testing.compare import has_numbers, hold_read_only, same
from contactlab.testing.load_paths import (
    QUANTITIES,
    Bench,
    Path,
    continue_from,
    drive,
    straight,
    vary,
    wandering,
)

#: Rounding of forces, over mu P_max: a batch may sum in another order.
ROUNDING = 1e-9


@check(SteppedTangentialLaw)
def answers(law: SteppedTangentialLaw) -> None:
    """Every answer holds real, finite numbers of the batch's shape (TangentialResponse)."""
    for shape in ((), (3,), (2, 3)):
        bench = Bench.of(shape)
        state = bench.start(law)
        path = _spread(wandering(1, knots=5, steps=6), shape)
        before, slip = bench.contact(0.0 * path.level[0]), 0.0 * path.slip[0]
        for step in range(len(path.slip)):
            next_slip, level = _row(path.slip, step), _row(path.level, step)
            after = bench.contact(level)
            increment = bench.increment(next_slip - slip, after, lock_arrays(bench.time / 100.0))
            answer = law.advance(state, increment, before, after)
            where = f"at step {step + 1} of a batch of shape {shape}"
            hold(
                isinstance(answer, tuple) and len(answer) == 2,
                f"advance returned {_short(answer)} {where}, not (TangentialResponse, state).",
            )
            response, state = answer
            for name in ("force", "friction_work"):
                value = getattr(response, name, None)
                good = has_numbers(value, shape) and np.all(np.isfinite(np.asarray(value)))
                hold(good, f"{name} = {_short(value)} {where}.")
            before, slip = after, next_slip


@check(SteppedTangentialLaw)
def batch(law: SteppedTangentialLaw) -> None:
    """A batch of unlike bodies gives the same as each contact alone (Integrator, 3)."""
    short = wandering(2, knots=4, steps=8)
    for quantity in QUANTITIES:
        various = Bench.along(normal_motion(REGISTRY.create("normal.hertz"), vary(quantity)))
        _alike(law, various, [short] * 3, f"of a batch that differs in {quantity} only")
    paths = [wandering(seed, knots=8) for seed in (2, 3, 4, 5)]
    _alike(law, Bench.of((4,)), paths, "of a batch")
    paths = [wandering(seed, knots=4) for seed in range(2, 8)]
    _alike(law, Bench.of((2, 3)), paths, "of a batch of shape (2, 3)")


def _alike(law: SteppedTangentialLaw, whole: Bench, paths: list[Path], words: str) -> None:
    """Hold that the contacts of a batch, each along its path, answer as each does alone."""
    shape = whole.scene.shape
    slips, levels = (np.stack(each, 1) for each in zip(*paths, strict=True))
    path = Path(slips.reshape(-1, *shape), levels.reshape(-1, *shape))
    together = drive(law, whole, path)
    for place, own_path in zip(np.ndindex(shape), paths, strict=True):
        alone = drive(law, whole.alone(place), own_path)
        gap = worst(alone.force - together.force[(slice(None), *place)])
        name = place[0] if len(place) == 1 else place
        within(gap, ROUNDING, f"Contact {name} {words} is off by {gap:.1e} of mu P_max.")


@check(SteppedTangentialLaw)
def pure(law: SteppedTangentialLaw) -> None:
    """``advance`` changes neither the state passed to it nor the law (stepped contract, 1)."""
    law_before = copy.deepcopy(law)
    _pure(law, (), knots=6)
    _pure(law, (3,), knots=3)
    hold(same(law, law_before), "The law itself was changed by a run.")


def _pure(law: SteppedTangentialLaw, shape: tuple[int, ...], *, knots: int) -> None:
    """Hold that steps tried and discarded change nothing, for one contact or a batch."""
    bench, path = Bench.of(shape), _spread(wandering(6, knots=knots), shape)
    before, slip, state = bench.contact(0.0 * path.level[0]), 0.0 * path.slip[0], bench.start(law)
    duration = lock_arrays(bench.time / len(path.slip))
    of_batch = f" of a batch of shape {shape}" if shape else ""
    for step in range(len(path.slip)):
        next_slip, level = _row(path.slip, step), _row(path.level, step)
        kept, after = copy.deepcopy(state), bench.contact(level)
        increment = bench.increment(next_slip - slip, after, duration)
        # A response may share its arrays with a state that is changed later.
        first, new = copy.deepcopy(law.advance(state, increment, before, after))
        hold(same(state, kept), f"The state that went in was changed at step {step + 1}{of_batch}.")
        tried = bench.increment(5.0 - slip, after, duration)
        law.advance(state, tried, before, after)
        again, _ = law.advance(state, increment, before, after)
        hold(
            same(first, again),
            f"A step tried and thrown away changed the next one, at step {step + 1}{of_batch}.",
        )
        before, slip, state = after, next_slip, new


@check(SteppedTangentialLaw)
def read_only(law: SteppedTangentialLaw) -> None:
    """The law does not write into its arguments (Law, 1)."""
    bench = Bench.of((3,))
    path = _spread(wandering(9, knots=5, steps=6), (3,))
    hold_read_only(lambda: drive(law, bench, path), bench.scene)


@check(SteppedTangentialLaw)
def repeatable(law: SteppedTangentialLaw) -> None:
    """Interleaved runs of one law do not change each other's forces (Law, 1)."""
    bench, paths = Bench.of(), (wandering(7, knots=6), wandering(8, knots=6))
    alone = [drive(law, bench, path).force for path in paths]
    parts: list[list[Any]] = [[], []]
    states, places = [bench.start(law) for _ in paths], [(0.0, 0.0), (0.0, 0.0)]
    for part in range(0, len(paths[0].slip), 8):
        for run, path in enumerate(paths):
            piece = Path(path.slip[part : part + 8], path.level[part : part + 8])
            slip, level = places[run]
            answers_of_piece = continue_from(
                law, bench, states[run], piece, slip=slip, level=level, count=len(path.slip)
            )
            parts[run].extend(answers_of_piece.force)
            states[run] = answers_of_piece.state
            places[run] = (float(piece.slip[-1]), float(piece.level[-1]))
    for run, force in enumerate(alone):
        hold(
            same(np.array(parts[run]), force), "Interleaved with another, a run gives other forces."
        )


@check(SteppedTangentialLaw)
def fields(law: SteppedTangentialLaw) -> None:
    """``fields`` returns arrays by name and changes no state."""
    bench = Bench.of()
    state = drive(law, bench, straight((0.0, 0.7), (0.3, 0.7), steps=8)).state
    kept = copy.deepcopy(state)
    named = law.fields(state)
    for name, value in named.items():
        hold(isinstance(name, str), f"fields: {name!r} is not a name.")
        hold(np.asarray(value).dtype.kind in "fiub", f"fields[{name!r}] = {_short(value)}.")
    hold(same(state, kept), "Asking for the fields changed the state.")


def _spread(path: Path, shape: tuple[int, ...]) -> Path:
    """Return a path for a batch, with another amplitude for each contact."""
    factor = np.linspace(0.5, 1.0, int(np.prod(shape))).reshape(shape)
    return Path(np.multiply.outer(path.slip, factor), np.multiply.outer(path.level, factor))


def _row(column: Array, step: int) -> Real:
    row = column[step]
    return row if isinstance(row, np.ndarray) and row.ndim else float(row)


def _short(value: object) -> str:
    shown = " ".join(repr(value).split())
    return shown if len(shown) <= 60 else shown[:57] + "..."
