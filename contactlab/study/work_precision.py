"""Error against run time: every method at every resolution, against the exact solution.

Errors and times come from separate runs. A time is the least of repeated runs after a warm-up,
which other load of the machine disturbs least. A failed run is a gap with its status, and is never
dropped.
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterable, Sequence
from functools import lru_cache, partial
from typing import Any, NamedTuple

import attrs
import numpy as np

from contactlab.collisions.rebound import rebound
from contactlab.contracts.law import claims
from contactlab.impact.scene import Scene
from contactlab.outcome.result import ImpactResult
from contactlab.registry import composition
from contactlab.runs.simulation import Simulation
from contactlab.study.bench_methods import Method, Options, scenes
from contactlab.study.benchmark import ALIKE, ROUNDING, Benchmark, Row
from contactlab.study.posed import need_units, pose
from contactlab.study.stability_references import converges, reference_for
from contactlab.study.time_limit import TimeLimitError, end_of, in_time

#: Tolerance of the exact answers: finer than the default, which is measured too.
EXACT_TOLERANCE = 1e-12
#: Repeats of a timed run; fewer after ``LONG`` seconds at one resolution of a method.
REPEATS, LONG = 5, 1.0
#: Impacts in the sweep whose time per impact is measured: fewer, but ``FEWEST``, if they would take
#: longer one by one than ``SWEEP_BUDGET`` seconds.
SWEEP, FEWEST, SWEEP_BUDGET = 1000, 50, 2.0
#: Multiples of this number spread evenly over [0, 1].
GOLDEN = 0.6180339887498949
#: Name of the row of ``contactlab.rebound``, and its calls for one time.
REBOUND, CALLS = "rebound()", 20
#: A method with a longer run time per impact, in s, is not refined further.
SLOW, SLOW_QUICK = 0.1, 0.05
#: A method whose log error falls by less than this over its resolutions has no order.
LEAST_GAIN = 0.5


def bench(
    methods: Sequence[Method],
    *,
    quick: bool = False,
    with_rebound: bool = False,
    time_limit: float | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> Benchmark:
    """Return errors and run times of every method at every resolution.

    Parameters
    ----------
    methods : sequence of Method
    quick : bool
        Fewer scenes and resolutions.
    with_rebound : bool
        Whether ``contactlab.rebound`` is measured too, before the methods.
    time_limit : float, optional
        Seconds of clock after which the report ends; ``complete`` then is False.
    progress : callable, optional
        Called as ``progress(done, total)`` after each resolution.

    Returns
    -------
    Benchmark
        Ctrl-C keeps the resolutions that are done.
    """
    until = end_of(time_limit)
    resolutions = [
        (method, resolution) for method in methods for resolution in method.resolutions(quick=quick)
    ]
    rows: list[Row] = []
    slow: set[str] = set()
    limit = SLOW_QUICK if quick else SLOW
    interrupted = False
    try:
        keys = {_limit(method) for method in methods}
        truths = in_time(lambda: {key: _truths(*key, quick=quick) for key in keys}, until)
        if with_rebound:
            rows.append(in_time(partial(_rebound_row, quick=quick), until))
        for done, (method, resolution) in enumerate(resolutions, start=1):
            if method.name in slow:
                rows.append(_left_out(method, resolution))
            else:
                row = partial(_row, method, resolution, truths[_limit(method)], quick=quick)
                rows.append(in_time(row, until))
            if rows[-1].time_s > limit:
                slow.add(method.name)
            if progress is not None:
                progress(done, len(resolutions))
    except TimeLimitError:
        pass
    except KeyboardInterrupt:
        interrupted = True
    orders = {
        method.name: _order([row for row in rows if row.method == method.name])
        for method in methods
    }
    return Benchmark(
        rows=tuple(_with_nearer(rows)),
        orders=orders,
        complete=len(rows) == len(resolutions) + with_rebound,
        interrupted=interrupted,
    )


class Truth(NamedTuple):
    """A scene, its true change of psi or NaN, and the exact result with history or None."""

    scene: Scene
    psi_change: float
    result: ImpactResult | None


def _limit(method: Method) -> tuple[str, str, bool]:
    """Return the normal law of a method, the friction law of its limit, and whether it needs units.

    The limit is the law's own if it converges to the continuum, and that of the default law
    otherwise. Under elastic Hertz contact all limits are one; the name is empty.
    """
    laws = method.simulation({"tangential": {}, "integrator": {}}).laws
    normal, sized = laws.normal, method.normal != composition.DEFAULT_NORMAL or need_units(laws)
    if "elastic_hertz" in laws.capability.normal_claims:
        return method.normal, "", sized
    own = converges(composition.law("tangential", method.tangential))
    other = method.tangential if own else composition.prefer_law("tangential", normal)
    return method.normal, other, sized


def _truths(
    normal: str, tangential: str, sized: bool, *, quick: bool, elsewhere: bool = False
) -> list[Truth]:
    """Return scenes with true answers: exact, or by a fine law of the same limit."""
    law = composition.law("normal", normal)
    truths = []
    elastic = "elastic_hertz" in claims(law)
    for scene in scenes(quick=quick, sized=sized, elsewhere=elsewhere):
        if elastic:
            exact = Simulation(normal=law, **composition.exact(EXACT_TOLERANCE))
            result = exact.run(scene, history=True).check()
            truths.append(Truth(scene, float(np.asarray(result.psi_change)), result))
            continue
        friction = composition.law("tangential", tangential)
        change = reference_for(friction, law)(scene, friction)
        psi_change = np.nan if change is None else float(np.asarray(scene.psi(change)))
        truths.append(Truth(scene, psi_change, None))
    return truths


@lru_cache(maxsize=4)
def _elsewhere(*, sized: bool, quick: bool) -> list[Truth]:
    """Return the scenes beyond solid spheres under elastic Hertz contact, with exact answers."""
    return _truths(composition.DEFAULT_NORMAL, "", sized, quick=quick, elsewhere=True)


def _elsewhere_rms(simulation: Simulation, method: Method, *, quick: bool) -> float:
    """Return the rms error beyond solid spheres; NaN under other normal laws than the default."""
    if method.normal != composition.DEFAULT_NORMAL:
        return np.nan
    truths = _elsewhere(sized=need_units(simulation.laws), quick=quick)
    results = [simulation.run(truth.scene) for truth in truths]
    if not all(result.status for result in results):
        return np.nan
    return _rms(
        result.psi_change - truth.psi_change for result, truth in zip(results, truths, strict=True)
    )


def _rms(errors: Iterable[float]) -> float:
    """Return the root of the mean square."""
    return float(np.sqrt(np.mean(np.square(list(errors)))))


def _rebound_row(*, quick: bool) -> Row:
    """Return error and run time of ``contactlab.rebound``, which no simulation runs."""
    truths = _truths(composition.DEFAULT_NORMAL, "", False, quick=quick)
    pairs = [(float(truth.scene.psi1), float(truth.scene.chi)) for truth in truths]

    def off(truth: Truth) -> Any:
        psi1, chi = float(truth.scene.psi1), float(truth.scene.chi)
        return rebound(psi1, chi) - psi1 - truth.psi_change

    def one_by_one() -> None:
        for pair in pairs:
            for _ in range(CALLS):
                rebound(*pair)

    errors = [off(truth) for truth in truths]
    batch = _swept_scenes()
    psi1, chi = np.asarray(batch.psi1), np.asarray(batch.chi)
    return Row(
        method=REBOUND,
        error_rms=_rms(errors),
        error_worst=float(np.max(np.abs(errors))),
        elsewhere_rms=_rms(off(truth) for truth in _elsewhere(sized=False, quick=quick)),
        time_s=_least(one_by_one, repeats=REPEATS) / (CALLS * len(pairs)),
        sweep_time_s=_least(lambda: rebound(psi1, chi), repeats=CALLS) / SWEEP,
    )


def _least(call: Callable[[], object], *, repeats: int) -> float:
    """Return the least time of several calls, in s."""
    least = np.inf
    for _ in range(repeats):
        before = time.perf_counter()
        call()
        least = min(least, time.perf_counter() - before)
    return least


def _row(method: Method, resolution: Options, truths: list[Truth], *, quick: bool) -> Row:
    """Return error and run time of a method at one resolution."""
    simulation = method.simulation(resolution)
    impacts = [truth.scene for truth in truths]
    # Timed are runs without history: a law may answer those in another way than it follows one.
    results = [simulation.run(scene) for scene in impacts]
    followed = [simulation.run(scene, history=True) for scene in impacts]
    row = Row(
        method=method.name, options=_words(resolution), converges=converges(simulation.tangential)
    )
    if failed := [result for result in (*results, *followed) if not result.status]:
        return attrs.evolve(row, failed=len(failed), status=failed[0].status.name)
    errors: list[Any] = [
        result.psi_change - true.psi_change for result, true in zip(results, truths, strict=True)
    ]
    forces = [
        _force_error(result, true.result) for result, true in zip(followed, truths, strict=True)
    ]
    books: list[Any] = [
        abs(result.energy.relative_imbalance) if np.all(result.energy.checked) else np.nan
        for result in results
    ]
    least = _least_time(simulation, impacts)
    return attrs.evolve(
        row,
        error_rms=_rms(errors),
        error_worst=float(np.max(np.abs(errors))),
        force_error_rms=_rms(forces),
        books_worst=float(np.max(books)),
        time_s=least,
        sweep_time_s=_sweep_time(simulation, least) if least < SLOW else np.nan,
        elsewhere_rms=_elsewhere_rms(simulation, method, quick=quick),
    )


def _with_nearer(rows: list[Row]) -> list[Row]:
    """Return the rows, those of methods that come nearer to the continuum marked as such."""
    errors: dict[str, list[float]] = {}
    for row in rows:
        if row.ok:
            errors.setdefault(row.method, []).append(row.error_rms)
    nearer = {method for method, each in errors.items() if each[-1] * ALIKE < each[0]}
    return [attrs.evolve(row, converges=row.converges or row.method in nearer) for row in rows]


def _left_out(method: Method, resolution: Options) -> Row:
    """Return the row of a resolution that is not run because it would take too long."""
    return Row(
        method=method.name,
        options=_words(resolution),
        failed=1,
        status="NOT_RUN",
        converges=converges(composition.law("tangential", method.tangential)),
    )


def _words(resolution: Options) -> str:
    options = {key: value for part in resolution.values() for key, value in part.items()}
    return ", ".join(f"{key}={value:g}" for key, value in options.items())


def _force_error(result: ImpactResult, exact: ImpactResult | None) -> float:
    """Return the rms error of the force over time, over mu P_max; NaN without exact result."""
    if exact is None:
        return np.nan
    history, true = result.history, exact.history
    assert history
    assert true is not None
    scene = exact.scene
    from scipy.interpolate import PchipInterpolator  # a few 1e-7 of the peak at 200 instants

    instants, first = np.unique(true.time, return_index=True)  # an event may occur twice
    inside = np.clip(history.time, instants[0], instants[-1])
    expected = PchipInterpolator(instants, true.tangential_force[first])(inside)
    scale = float(np.asarray(scene.friction_coefficient * exact.motion.maximum_force))
    return float(np.sqrt(np.mean((history.tangential_force - expected) ** 2))) / scale


def _least_time(simulation: Simulation, impacts: list[Scene]) -> float:
    """Return the mean over the scenes of the least time of one run, in s."""
    total = 0.0
    started = time.perf_counter()
    for scene in impacts:
        simulation.run(scene)  # warm-up
        least = np.inf
        for _ in range(REPEATS):
            before = time.perf_counter()
            simulation.run(scene)
            least = min(least, time.perf_counter() - before)
            if time.perf_counter() - started > LONG:
                break
        total += least
    return total / len(impacts)


def _swept_scenes(size: int = SWEEP) -> Scene:
    """Return impacts of solid spheres without slip throughout, one batch."""
    chi = 1.17 + 0.58 * (np.arange(size) * GOLDEN % 1.0)  # all chi beside all psi1
    psi1 = 0.01 + np.linspace(0.0, 1.0, size) * (4.0 * chi - 1.02)
    return Scene.nondimensional(psi1=psi1, chi=chi)


def _sweep_time(simulation: Simulation, alone: float) -> float:
    """Return the least time per impact of a sweep of solid spheres; ``alone`` is one's, in s."""
    size = int(np.clip(SWEEP_BUDGET / alone, FEWEST, SWEEP))
    batch = pose(_swept_scenes(size), simulation.laws)
    return _least(lambda: simulation.sweep(batch), repeats=2) / size


def _order(rows: list[Row]) -> float:
    """Return the order of the rms error in steps or parts; NaN under a tolerance or without one."""
    points = []
    for row in rows:
        sizes = [float(word.partition("=")[2]) for word in row.options.split(", ") if "=" in word]
        if row.ok and sizes and row.error_rms > ROUNDING and "tolerance" not in row.options:
            points.append((np.log(sizes[0]), np.log(row.error_rms)))
    if len(points) < 3 or points[0][1] - points[-1][1] < LEAST_GAIN:
        return float("nan")
    x, y = np.array(points).T
    return float(-np.polyfit(x, y, 1)[0])
