"""``fit``: the one entry to fitting."""

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

#: Both tails of an interval outside which one estimate in twenty lies.
TAIL = 0.025
#: A reduced chi square beyond this says that errors, or the law, do not fit the data.
LARGE_CHI_SQUARE = 2.0
#: Residuals below this share of the errors given say that these are in another unit, or limits.
SMALL_RATIO = 0.5
#: Searches that end so near to each other have found one minimum.
SAME = 1e-3
#: Nearness, of its range, of a value to the end of it.
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
        Columns by their headings, ``{"angle_deg": [...], "tangential_restitution": [...]}``: see
        ``contactlab guide fitting``. A scene file has its ``[[measured]]`` values.
    scene : Scene, SceneFile or path
        Bodies, and what the measurements do not say; may be left out where these are a scene file.
    parameters : sequence of str
        ``friction_coefficient``, ``stiffness_ratio`` (kappa = G*/E*), or an option of a law:
        ``normal.restitution``, ``tangential.beta0``.
    simulation : Simulation, optional
        The laws; by default the exact elastic ones by their table.
    quantities : sequence of str, optional
        Those of the measured quantities that are to be met; all by default.
    bootstrap : int
        Samples of the bootstrap; 0 for none.
    seed : int
        Of the bootstrap's random numbers.
    progress : callable, optional
        Called as ``progress(done, total)`` after each sample; without a bootstrap after each
        search, and after the diagnosis.

    Returns
    -------
    Fit

    Raises
    ------
    ValueError
        For bad input; and where the data do not determine a parameter, with a measurement that
        would.
    ImpactError
        If a law does not follow an impact.

    Notes
    -----
    Known errors (columns ``..._error``) are taken as they are, and intervals widened by the
    square root of the reduced chi square if that is above 1. Where errors are not known, those
    of each quantity are estimated by its residuals.

    Interrupting (Ctrl-C) keeps the samples of the bootstrap from a hundred on; ``samples`` and a
    note of the fit tell how many they are.
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
    told: tuple[str, ...] = ()
    slipped: list[str] = []
    if idle := determined.idle(problem, values):
        told = (f"{', '.join(idle)}: not met, for no parameter moves it under these laws",)
        slipped, _ = slips(problem, table.given, values, problem.measured)
        table = table.only([name for name in table.measured if name not in idle])
        problem = Problem.of(_model(table, scene, parameters, laws), table)
        values, *others = _solutions(problem)
    diagnosis = diagnosed(problem, table, values)
    try:
        determined.check_scatter(problem)
        determined.check_determined(problem, values)
        found, reaches = _outcome(problem, table, values, diagnosis)
        determined.check_precise(problem, values, reaches)
        determined.check_single(problem, [values, *others])
    except ValueError as error:
        said = (*slipped, *diagnosis.sentences, *_of_errors(problem, values))
        if not said:
            raise
        raise ValueError(f"{'. '.join(said)}. As it is, {error}") from None
    found = attrs.evolve(found, notes=(*told, *slipped, *found.notes))
    if counted is not None:
        counted(1, 1)
    if not samples:
        return found
    return _with_bootstrap(found, problem, values, samples, seed=seed, progress=progress)


def _with_bootstrap(
    found: Fit,
    problem: Problem,
    values: Array,
    samples: int,
    *,
    seed: int,
    progress: Callable[[int, int], object] | None,
) -> Fit:
    """Return the fit with the intervals of the bootstrap beside the others.

    Parameters
    ----------
    found : Fit
    problem : Problem
    values : array, shape (parameters,)
        The best values.
    samples, seed, progress
        As ``bootstrap``, ``seed`` and ``progress`` of ``fit``.
    """
    intervals, done = bootstrapped(
        problem, values, samples, seed=seed, tail=TAIL, progress=progress
    )
    estimates = {
        name: attrs.evolve(one, bootstrap=interval)
        for (name, one), interval in zip(found.parameters.items(), intervals, strict=True)
    }
    notes = found.notes
    if done < samples:
        notes += (f"bootstrap: interrupted, intervals are those of {done} samples of {samples}",)
    return attrs.evolve(found, parameters=estimates, notes=notes, samples=done)


def _model(
    table: Measurements, scene: object, parameters: Sequence[str], simulation: Simulation | None
) -> Model:
    """Return the model of the measured impacts with the parameters asked for.

    Parameters
    ----------
    table : Measurements
    scene : Scene, SceneFile or path
        What the columns of the table leave open.
    parameters : list of str
        Names, each once.
    simulation : Simulation or None
        None: the laws of the scene file, or the default ones.
    """
    if isinstance(parameters, str) or not parameters:
        raise refuse(
            "parameters", parameters, "must be a list of names", "['friction_coefficient']"
        )
    setup = Setup(scene_of(scene, table.given, len(table)), simulation)
    found = tuple(parameter_named(name, setup) for name in parameters)
    names = [parameter.name for parameter in found]
    if len(set(names)) < len(names):
        raise refuse("parameters", list(parameters), "names one of them twice")
    return Model(setup=setup, parameters=found)


def _solutions(
    problem: Problem, progress: Callable[[int, int], object] | None = None
) -> list[Array]:
    """Return the minima that searches from several starts have come to, the best first."""
    found: list[Array] = []
    starts = starting(problem)
    for done, start in enumerate(starts, start=1):
        values = solved(problem, start)
        if progress is not None:
            progress(done, len(starts) + 1)  # the diagnosis is the last
        if not any(np.allclose(values, known, rtol=SAME, atol=SAME) for known in found):
            found.append(values)
    return sorted(found, key=problem.criterion) if len(found) > 1 else found


def _outcome(
    problem: Problem, table: Measurements, values: Array, diagnosis: Diagnosis
) -> tuple[Fit, Array]:
    """Return the fit with intervals from the covariance, and their half-widths.

    Parameters
    ----------
    problem : Problem
    table : Measurements
    values : array, shape (parameters,)
        The best values.
    diagnosis : Diagnosis
    """
    from scipy.special import stdtrit  # only those who fit pay for it

    parameters = problem.model.parameters
    scales = problem.scales(problem.residuals(values[None]))
    weighted, jacobian = problem.linearised(values, scales)
    freedom = len(weighted) - len(values)
    mean_square = float(weighted @ weighted) / freedom if freedom > 0 else math.nan
    known = all(name in problem.errors for name in problem.measured)
    factor = max(mean_square, 1.0) if known and freedom else 1.0 if known else mean_square
    size = np.sqrt(np.sum(jacobian**2, axis=0))
    covariance = np.linalg.inv((jacobian / size).T @ (jacobian / size)) / np.outer(size, size)
    errors = np.sqrt(factor * np.diag(covariance))
    reaches = errors * (float(stdtrit(freedom, 1.0 - TAIL)) if freedom > 0 else math.nan)
    low, high = problem.bounds()
    estimates = {}
    for place, parameter in enumerate(parameters):
        value, off = float(values[place]), float(reaches[place])
        ends = (float(max(value - off, low[place])), float(min(value + off, high[place])))
        estimates[parameter.name] = Estimate(
            name=parameter.name,
            unit=parameter.unit,
            value=value,
            standard_error=float(errors[place]),
            interval=ends if off == off else (math.nan, math.nan),
            robust=diagnosis.robust[place],
        )
    deviation = np.sqrt(np.diag(covariance))
    predicted = problem.model.predicted(values[None], list(problem.measured))
    found = Fit(
        parameters=estimates,
        correlation=covariance / np.outer(deviation, deviation),
        laws=problem.model.laws(values),
        measurements=table,
        predicted={name: rows[0] for name, rows in predicted.items()},
        aic=problem.criterion(values),
        reduced_chi_square=mean_square if known else None,
        notes=(
            *diagnosis.sentences,
            *unlikely_parameters(problem, {n: one.interval for n, one in estimates.items()}),
            *(() if diagnosis.sentences else _moved(estimates)),
            *_of_errors(problem, values),
            *_notes(problem, values, freedom),
        ),
    )
    return found, reaches


def _moved(estimates: Mapping[str, Estimate]) -> list[str]:
    """Return a sentence for each parameter whose robust value lies outside of its interval."""
    return [
        f"a robust fit, which a few far numbers hardly move, gives {name} = {one.robust:.4g}, "
        "outside of the interval: look at the impacts that are farthest off"
        for name, one in estimates.items()
        if one.robust is not None and not one.interval[0] <= one.robust <= one.interval[1]
    ]


def _of_errors(problem: Problem, values: Array) -> list[str]:
    """Return a sentence for each quantity whose scatter is not that of the errors given."""
    from scipy.special import chdtr, chdtrc  # only those who fit pay for it

    found = []
    for name in problem.errors.keys() & problem.measured.keys():
        rows = problem.residuals(values[None])[name][0] / problem.errors[name]
        freedom = problem.counts[name] - len(values)
        if freedom < 1:
            continue
        square = float(np.nansum(rows**2))
        ratio = math.sqrt(square / freedom)
        if ratio**2 > LARGE_CHI_SQUARE and chdtrc(freedom, square) < CHANCE:
            found.append(
                f"{name}: residuals are {ratio:.2g} times the errors given: these are too small, "
                "or the law is not that of the data; intervals are widened by as much"
            )
        alike = np.nanmin(problem.measured[name]) == np.nanmax(problem.measured[name])
        if ratio < SMALL_RATIO and not alike and chdtr(freedom, square) < CHANCE:
            found.append(
                f"{name}: residuals are {ratio:.2g} times the errors given: these are too large; "
                f"look at the unit of {name}_error, and whether they are standard errors"
            )
    return found


def _notes(problem: Problem, values: Array, freedom: int) -> list[str]:
    """Return what a reader of the estimates should be wary of, a sentence each."""
    found = []
    for parameter, value in zip(problem.model.parameters, values.tolist(), strict=True):
        near = AT_END * parameter.width
        if math.isfinite(near) and min(value - parameter.least, parameter.most - value) <= near:
            found.append(
                f"{parameter.name} lies at the end of its range, {parameter.least:.4g} to "
                f"{parameter.most:.4g}: the law may not be that of the data"
            )
    if freedom == 0:
        found.append("as many numbers as parameters: nothing is left to tell the scatter by")
    return found
