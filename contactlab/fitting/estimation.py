"""``fit``: parameters of scenes and laws from measured impacts."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.simulation import Simulation
from contactlab.fitting import determined
from contactlab.fitting.bootstrap import bootstrapped
from contactlab.fitting.diagnosis import CHANCE, Diagnosis, diagnosed
from contactlab.fitting.measurements import Measurements, read_measurements
from contactlab.fitting.model import Model, scene_of, simulation_of
from contactlab.fitting.outcome import Estimate, Fit
from contactlab.fitting.parameters import Setup, parameter_named
from contactlab.fitting.plausible import unlikely_parameters
from contactlab.fitting.problem import Problem, solved, starting
from contactlab.fitting.slips import slips
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import refuse, whole
from contactlab.scene_file import SceneFile

Array = NDArray[np.float64]

#: Share of each tail beyond a 95 % interval.
TAIL = 0.025
#: Reduced chi square above which stated errors are too small, or the law does not fit.
LARGE_CHI_SQUARE = 2.0
#: Share of the stated errors below which residuals suggest another unit, or limits.
SMALL_RATIO = 0.5
#: Relative and absolute distance below which two searches have reached the same minimum.
SAME = 1e-3
#: A value lies at the end of its range if nearer than this share of the range.
AT_END = 1e-6


def fit(
    measurements: object,
    scene: Scene | SceneFile | str | Path | None = None,
    *,
    parameters: Sequence[str] = ("friction_coefficient",),
    simulation: Simulation | None = None,
    quantities: Sequence[str] | None = None,
    bootstrap: int = 0,
    seed: int = 1976,
    progress: Callable[[int, int], object] | None = None,
) -> Fit:
    """Fit numbers of a scene and of laws to measured impacts, by least squares.

    Parameters
    ----------
    measurements : path of a CSV file, mapping, or SceneFile
        Columns by their headings: ``{"angle_deg": [...], "tangential_restitution": [...]}``, see
        ``contactlab guide fitting``; or the ``[[measured]]`` values of a scene file.
    scene : Scene, SceneFile or path
        Bodies, and entries without a column; may be left out if ``measurements`` is a scene file.
    parameters : sequence of str
        ``friction_coefficient``, ``stiffness_ratio`` (kappa = G*/E*), or an option of a law:
        ``normal.restitution``, ``tangential.beta0``.
    simulation : Simulation, optional
        The laws; by default the exact elastic ones by their table.
    quantities : sequence of str, optional
        Measured quantities to fit; all by default.
    bootstrap : int
        Samples of the bootstrap; 0 for none.
    seed : int
        Seed of the bootstrap's random numbers.
    progress : callable, optional
        Called as ``progress(done, total)`` after each sample; without a bootstrap after each
        search, and after the diagnosis.

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        For bad input; or if the data do not determine a parameter, with a measurement that
        would.
    ImpactError
        If a law does not follow an impact.

    Notes
    -----
    Errors of columns ``..._error`` weight the residuals; a reduced chi square above 1 widens the
    intervals by its square root. Without such a column the error of a quantity is estimated
    from its residuals.

    An interruption (Ctrl-C) keeps the finished samples of the bootstrap if there are at least a
    hundred; ``samples`` and a note of the fit state their number.
    """
    if scene is None and isinstance(measurements, SceneFile):
        scene = measurements
    if scene is None:
        raise refuse("scene", None, "must be given", "a Scene, or a TOML file with the bodies")
    samples = whole("bootstrap", bootstrap, least=0, most=100_000)
    table = read_measurements(measurements).only(quantities)
    laws = simulation_of(simulation)
    problem = Problem.of(_model(table, scene, parameters, laws), table)
    determined.check_enough(problem)
    counted = None if samples else progress
    values, *others = _solutions(problem, counted)
    left_out: tuple[str, ...] = ()
    slipped: list[str] = []
    if idle := determined.idle(problem, values):
        left_out = (f"{', '.join(idle)}: not met, for no parameter moves it under these laws",)
        slipped, _ = slips(problem, table.given, values, problem.measured)
        table = table.only([name for name in table.measured if name not in idle])
        problem = Problem.of(_model(table, scene, parameters, laws), table)
        values, *others = _solutions(problem)
    diagnosis = diagnosed(problem, table, values)
    try:
        determined.check_scatter(problem)
        determined.check_determined(problem, values)
        outcome, reaches = _outcome(problem, table, values, diagnosis)
        determined.check_precise(problem, values, reaches)
        determined.check_single(problem, [values, *others])
    except ValueError as error:
        causes = (*slipped, *diagnosis.sentences, *_error_notes(problem, values))
        if not causes:
            raise
        raise ValueError(f"{'. '.join(causes)}. As it is, {error}") from None
    outcome = attrs.evolve(outcome, notes=(*left_out, *slipped, *outcome.notes))
    if counted is not None:
        counted(1, 1)
    if not samples:
        return outcome
    return _with_bootstrap(outcome, problem, values, samples, seed=seed, progress=progress)


def _with_bootstrap(
    outcome: Fit,
    problem: Problem,
    values: Array,
    samples: int,
    *,
    seed: int,
    progress: Callable[[int, int], object] | None,
) -> Fit:
    """Return the fit with the intervals of the bootstrap added."""
    intervals, done = bootstrapped(
        problem, values, samples, seed=seed, tail=TAIL, progress=progress
    )
    estimates = {
        name: attrs.evolve(estimate, bootstrap=interval)
        for (name, estimate), interval in zip(outcome.parameters.items(), intervals, strict=True)
    }
    notes = outcome.notes
    if done < samples:
        notes += (f"bootstrap: interrupted, intervals are those of {done} samples of {samples}",)
    return attrs.evolve(outcome, parameters=estimates, notes=notes, samples=done)


def _model(
    table: Measurements, scene: object, parameters: Sequence[str], simulation: Simulation | None
) -> Model:
    """Return the model of the measured impacts with the named parameters."""
    if isinstance(parameters, str) or not parameters:
        raise refuse(
            "parameters", parameters, "must be a list of names", "['friction_coefficient']"
        )
    setup = Setup(scene_of(scene, table.given, len(table)), simulation)
    fitted = tuple(parameter_named(name, setup) for name in parameters)
    names = [parameter.name for parameter in fitted]
    if len(set(names)) < len(names):
        raise refuse("parameters", list(parameters), "names one of them twice")
    return Model(setup=setup, parameters=fitted)


def _solutions(
    problem: Problem, progress: Callable[[int, int], object] | None = None
) -> list[Array]:
    """Return the minima of searches from several starts, the best first."""
    minima: list[Array] = []
    starts = starting(problem)
    for done, start in enumerate(starts, start=1):
        values = solved(problem, start)
        if progress is not None:
            progress(done, len(starts) + 1)  # the diagnosis is the last
        if not any(np.allclose(values, minimum, rtol=SAME, atol=SAME) for minimum in minima):
            minima.append(values)
    return sorted(minima, key=problem.criterion) if len(minima) > 1 else minima


def _outcome(
    problem: Problem, table: Measurements, values: Array, diagnosis: Diagnosis
) -> tuple[Fit, Array]:
    """Return the fit with intervals from the covariance, and their half-widths."""
    from scipy.special import stdtrit  # only a fit needs scipy

    parameters = problem.model.parameters
    scales = problem.scales(problem.residuals(values[None]))
    weighted, jacobian = problem.linearised(values, scales)
    freedom = len(weighted) - len(values)
    mean_square = float(weighted @ weighted) / freedom if freedom > 0 else math.nan
    stated = all(name in problem.errors for name in problem.measured)
    factor = max(mean_square, 1.0) if stated and freedom else 1.0 if stated else mean_square
    size = np.sqrt(np.sum(jacobian**2, axis=0))
    covariance = np.linalg.inv((jacobian / size).T @ (jacobian / size)) / np.outer(size, size)
    errors = np.sqrt(factor * np.diag(covariance))
    reaches = errors * (float(stdtrit(freedom, 1.0 - TAIL)) if freedom > 0 else math.nan)
    low, high = problem.bounds()
    estimates = {}
    for place, parameter in enumerate(parameters):
        value, reach = float(values[place]), float(reaches[place])
        ends = (float(max(value - reach, low[place])), float(min(value + reach, high[place])))
        estimates[parameter.name] = Estimate(
            name=parameter.name,
            unit=parameter.unit,
            value=value,
            standard_error=float(errors[place]),
            interval=ends if not math.isnan(reach) else (math.nan, math.nan),
            robust=diagnosis.robust[place],
        )
    deviation = np.sqrt(np.diag(covariance))
    predicted = problem.model.predicted(values[None], list(problem.measured))
    intervals = {name: estimate.interval for name, estimate in estimates.items()}
    outcome = Fit(
        parameters=estimates,
        correlation=covariance / np.outer(deviation, deviation),
        laws=problem.model.laws(values),
        measurements=table,
        predicted={name: rows[0] for name, rows in predicted.items()},
        aic=problem.criterion(values),
        reduced_chi_square=mean_square if stated else None,
        notes=(
            *diagnosis.sentences,
            *unlikely_parameters(problem, intervals),
            *(() if diagnosis.sentences else _moved(estimates)),
            *_error_notes(problem, values),
            *_notes(problem, values, freedom),
        ),
    )
    return outcome, reaches


def _moved(estimates: Mapping[str, Estimate]) -> list[str]:
    """Return a sentence for each parameter whose robust value lies outside its interval."""
    return [
        f"a robust fit, which a few far numbers hardly move, gives {name} = {estimate.robust:.4g}, "
        "outside of the interval: look at the impacts that are farthest off"
        for name, estimate in estimates.items()
        if estimate.robust is not None
        and not estimate.interval[0] <= estimate.robust <= estimate.interval[1]
    ]


def _error_notes(problem: Problem, values: Array) -> list[str]:
    """Return a sentence for each quantity whose scatter contradicts its stated errors."""
    from scipy.special import chdtr, chdtrc  # only a fit needs scipy

    notes = []
    for name in problem.errors.keys() & problem.measured.keys():
        rows = problem.residuals(values[None])[name][0] / problem.errors[name]
        freedom = problem.counts[name] - len(values)
        if freedom < 1:
            continue
        square = float(np.nansum(rows**2))
        ratio = math.sqrt(square / freedom)
        if ratio**2 > LARGE_CHI_SQUARE and chdtrc(freedom, square) < CHANCE:
            notes.append(
                f"{name}: residuals are {ratio:.2g} times the errors given: these are too small, "
                "or the law is not that of the data; intervals are widened by as much"
            )
        alike = np.nanmin(problem.measured[name]) == np.nanmax(problem.measured[name])
        if ratio < SMALL_RATIO and not alike and chdtr(freedom, square) < CHANCE:
            notes.append(
                f"{name}: residuals are {ratio:.2g} times the errors given: these are too large; "
                f"look at the unit of {name}_error, and whether they are standard errors"
            )
    return notes


def _notes(problem: Problem, values: Array, freedom: int) -> list[str]:
    """Return sentences on values at the end of their range, and on missing scatter."""
    notes = []
    for parameter, value in zip(problem.model.parameters, values.tolist(), strict=True):
        near = AT_END * parameter.width
        if math.isfinite(near) and min(value - parameter.least, parameter.most - value) <= near:
            notes.append(
                f"{parameter.name} lies at the end of its range, {parameter.least:.4g} to "
                f"{parameter.most:.4g}: the law may not be that of the data"
            )
    if freedom == 0:
        notes.append("as many numbers as parameters: nothing is left to tell the scatter by")
    return notes
