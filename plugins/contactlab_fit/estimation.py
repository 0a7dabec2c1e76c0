"""Parameters of scenes and laws from measured impacts, and a ranking of laws by their fits."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from functools import partial
from pathlib import Path

import attrs
import numpy as np

from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import common_shape
from contactlab.numeric.checks import real, refuse, whole
from contactlab.numeric.progress import Count, follow
from contactlab.numeric.types import Array, Numbers, Real
from contactlab.outcome.answer import ImpactError
from contactlab.outcome.columns import QUANTITIES
from contactlab.outcome.result import ImpactResult
from contactlab.runs.simulation import Simulation
from contactlab.scene_file import SceneFile
from contactlab_fit import determined, nearby, tabulated
from contactlab_fit.beside import as_target_sees
from contactlab_fit.diagnosis import (
    Diagnosis,
    cautions,
    describe_outlying,
    diagnose,
    end_notes,
    error_notes,
    note_marches,
    table_notes,
    tell_loss,
)
from contactlab_fit.fit_result import Estimate, Fit
from contactlab_fit.intervals import TAIL, Spread, spread
from contactlab_fit.measurements import Measurements, read_measurements
from contactlab_fit.minima import minima
from contactlab_fit.model import Model, setup_of, simulation_of
from contactlab_fit.parameters import (
    RESTITUTION,
    SHEAR_LOSS,
    asks_for,
    find_parameter,
    those_of,
)
from contactlab_fit.plausible import restitutions, trend_of_restitution, unlikely_parameters
from contactlab_fit.problem import Problem, fewer, solve_problem
from contactlab_fit.slips import SOME_LOSS, slips, state_assumptions
from contactlab_fit.taken import tell_assumptions
from contactlab_fit.unknown_friction import (
    lacks_friction,
    normal_motion_alone,
    without_friction,
)

#: An interruption keeps at least this many samples; fewer make no 95 % interval.
FEWEST = 100


def fit(
    measurements: str | Path | Mapping[str, object] | SceneFile | Measurements,
    scene: Scene | SceneFile | str | Path | None = None,
    *,
    parameters: Sequence[str] = ("friction_coefficient",),
    simulation: Simulation | None = None,
    quantities: Sequence[str] | None = None,
    bootstrap: int = 0,
    seed: int = 1976,
    progress: bool | Count | None = None,
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
        ``normal.restitution``, ``tangential.shear_loss``.
    simulation : Simulation, optional
        The laws; by default the exact elastic ones by their table, and with ``restitution`` among
        the parameters those of one loss for pressure and shear (``normal.viscoelastic``).
    quantities : sequence of str, optional
        Measured quantities to fit; all by default.
    bootstrap : int
        Samples of the bootstrap; 0 for none.
    seed : int
        Seed of the bootstrap's random numbers.
    progress : True or callable, optional
        True prints share and time left on stderr; a function is called as ``progress(done, total)``
        after each sample, without a bootstrap after each search and the diagnosis.

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

    Without a friction coefficient, given or fitted, the numbers that depend on it are left out, and
    a note names them. ``taken`` of the fit lists numbers that the user left open.

    An interruption (Ctrl-C) keeps the finished samples of the bootstrap if there are at least a
    hundred; ``samples`` and a note of the fit state their number.
    """
    with follow(progress, "samples" if bootstrap else "searches") as count:
        return _fit(measurements, scene, parameters, simulation, quantities, bootstrap, seed, count)


def _fit(
    measurements: str | Path | Mapping[str, object] | SceneFile | Measurements,
    scene: Scene | SceneFile | str | Path | None,
    parameters: Sequence[str],
    simulation: Simulation | None,
    quantities: Sequence[str] | None,
    bootstrap: int,
    seed: int,
    progress: Count | None,
) -> Fit:
    """Return the fit; ``progress`` is called after each step."""
    if scene is None and isinstance(measurements, SceneFile):
        scene = measurements
    if scene is None:
        raise refuse("scene", None, "must be given", "a Scene, or a TOML file with the bodies")
    if isinstance(quantities, str):  # a sequence of letters
        raise refuse("quantities", quantities, "must be a list of names", f"write [{quantities!r}]")
    samples = whole("bootstrap", bootstrap, least=0, most=100_000)
    table = as_target_sees(read_measurements(measurements), scene).only(quantities)
    laws = simulation_of(simulation)
    if laws is None:
        laws = default_laws(parameters)
    problem = _problem(table, scene, parameters, laws)
    left_out: tuple[str, ...] = ()
    if unknown := lacks_friction(scene, table.given, parameters):
        table, unmet = without_friction(problem, table)
        left_out = (unmet,) if unmet else ()
        problem = _problem(table, scene, parameters, laws)
    determined.check_enough(problem)
    determined.check_defined(problem)
    said = (*table.notes, *table_notes(table, parameters), *note_marches(problem))
    counted = None if samples else progress
    values, *others = minima(problem, counted)
    slipped: list[str] = []
    every, of_restitution = problem, restitutions(problem, table)
    if idle := determined.idle(problem, values):
        idle_words = f"{', '.join(idle)}: not met, for no parameter moves it under these laws"
        left_out = (*left_out, idle_words)
        few, _ = fewer(problem)
        slipped, _ = slips(few, table, values, few.measured)
        if not slipped and (seen := tell_loss(problem, values)):
            slipped, of_restitution = seen, []
        table = table.only([name for name in table.measured if name not in idle])
        problem = _problem(table, scene, parameters, laws)
        values, *others = minima(problem)
    diagnosis = diagnose(problem, table, values, explained=bool(slipped))
    try:
        determined.check_scatter(problem)
        determined.check_determined(problem, values)
        at = partial(_impacts, scene, problem.model, values)
        outcome, ends = _outcome(problem, table, values, diagnosis, at)
        determined.check_precise(problem, values, ends)
        determined.check_single(problem, [values, *others], ends)
    except ValueError as error:
        causes = (*slipped, *of_restitution, *diagnosis.sentences, *error_notes(problem, values))
        if not causes:
            raise
        raise ValueError(f"{'. '.join(causes)}. As it is, {error}") from None
    trend = () if slipped or diagnosis.slips else trend_of_restitution(every, values)
    notes = (*left_out, *slipped, *of_restitution, *outcome.notes)
    warned = (
        *cautions(problem, values, of_any_friction=unknown),
        *(() if notes else state_assumptions(fewer(every)[0], table.given, values, ends.reaches)),
    )
    aic = every.criterion(values)  # over all numbers, so that laws that leave some out compare
    outcome = attrs.evolve(
        outcome,
        notes=(*said, *notes, *trend),
        cautions=warned,
        aic=aic,
        taken=tell_assumptions(table, scene, problem.model),
    )
    if counted is not None:
        counted(1, 1)
    if not samples:
        return outcome
    return _with_bootstrap(outcome, problem, values, samples, seed=seed, progress=progress)


def default_laws(parameters: Sequence[str], *, restituted: bool = False) -> Simulation | None:
    """Return the default laws of a fit: None, the exact elastic ones, or laws with loss.

    Raises
    ------
    ValueError
        If a loss in shear is to be fitted without a restitution, fitted or ``restituted``.
    """
    sheared = asks_for(SHEAR_LOSS, parameters)
    if asks_for(RESTITUTION, parameters) or (sheared and restituted):
        return tabulated.with_loss(SOME_LOSS)
    if sheared:
        rule = "is a share of the loss in pressure, which is not known"
        remedy = f"fit {RESTITUTION} too, or choose normal={tabulated.LOSSY} with its restitution"
        raise refuse("parameters", SHEAR_LOSS, rule, remedy)
    return None


def _with_bootstrap(
    outcome: Fit,
    problem: Problem,
    values: Array,
    samples: int,
    *,
    seed: int,
    progress: Count | None,
) -> Fit:
    """Return the fit with the intervals of the bootstrap added.

    Notes
    -----
    The wild bootstrap: residuals, widened by sqrt(n/(n - p)), are added to the prediction, with
    one random sign for all quantities of an impact. So each impact keeps its own scatter, and the
    quantities of an impact stay correlated: Wu, Ann. Statist. 14 (1986) 1261-1295,
    doi:10.1214/aos/1176350142.

    Laws whose options are fitted run anew for each value, which takes minutes: quantities are then
    polynomials of second order about the best values, and the laws are run at the ends of the
    intervals. Where they contradict the polynomials, each sample is solved by the laws.
    """
    scales = problem.scales(problem.residuals(values[None]))
    quick = problem
    if not problem.model.at_once(list(problem.measured)):
        quick = nearby.nearby(problem, values, scales)
    drawn = _draw_samples(quick, values, samples, np.random.default_rng(seed), progress)
    ends = np.quantile(drawn, [TAIL, 1.0 - TAIL], axis=0)
    if quick is not problem and not nearby.faithful(problem, quick, drawn, ends, scales):
        drawn = _draw_samples(problem, values, samples, np.random.default_rng(seed), progress)
        ends = np.quantile(drawn, [TAIL, 1.0 - TAIL], axis=0)
    estimates = {
        name: attrs.evolve(estimate, bootstrap=(low, high))
        for (name, estimate), (low, high) in zip(
            outcome.parameters.items(), ends.T.tolist(), strict=True
        )
    }
    notes, done = outcome.notes, len(drawn)
    if done < samples:
        notes += (f"bootstrap: interrupted, intervals are those of {done} samples of {samples}",)
    return attrs.evolve(outcome, parameters=estimates, notes=notes, samples=done)


def _draw_samples(
    problem: Problem,
    values: Array,
    samples: int,
    generator: np.random.Generator,
    progress: Count | None,
) -> Array:
    """Return the best values for each sample, shape (m, parameters), fewer if interrupted."""
    residuals = {name: rows[0] for name, rows in problem.residuals(values[None]).items()}
    scales = problem.scales(residuals)
    numbers = sum(problem.counts.values())
    wider = math.sqrt(numbers / max(numbers - len(values), 1))
    drawn: list[Array] = []
    try:
        while len(drawn) < samples:
            signs = wider * generator.choice([-1.0, 1.0], len(next(iter(residuals.values()))))
            changes = {name: (signs - 1.0) * rows for name, rows in residuals.items()}
            drawn.append(_solve_again(problem, changes, values, scales))
            if progress is not None:
                progress(len(drawn), samples)
    except KeyboardInterrupt:
        if len(drawn) < FEWEST:
            raise
    return np.array(drawn)


def _solve_again(
    problem: Problem, changes: Mapping[str, Array], values: Array, scales: Mapping[str, Real]
) -> Array:
    """Return the best values for the measured numbers plus ``changes``."""
    measured = {name: numbers + changes[name] for name, numbers in problem.measured.items()}
    return solve_problem(attrs.evolve(problem, measured=measured), values, scales)


def _problem(
    table: Measurements,
    scene: Scene | SceneFile | str | Path,
    parameters: Sequence[str],
    simulation: Simulation | None,
) -> Problem:
    """Return the measured numbers with the model of the impacts and the named parameters."""
    if isinstance(parameters, str) or not parameters:
        raise refuse(
            "parameters", parameters, "must be a list of names", "['friction_coefficient']"
        )
    setup = setup_of(scene, table.given, len(table), simulation)
    fitted = tuple(find_parameter(name, setup) for name in parameters)
    names = [parameter.name for parameter in fitted]
    if len(set(names)) < len(names):
        raise refuse("parameters", list(parameters), "names one of them twice")
    needs = frozenset(need for name in table.measured for need in QUANTITIES[name].needs)
    model = Model(setup=setup, parameters=fitted, needs=needs)
    return Problem(model=model, measured=table.measured, errors=table.errors)


def _impacts(
    scene: Scene | SceneFile | str | Path,
    model: Model,
    values: Array,
    entries: Mapping[str, Numbers],
) -> ImpactResult:
    """Return the impacts of ``entries`` at values of the parameters."""
    columns = {name: np.atleast_1d(real(name, column)) for name, column in entries.items()}
    size = common_shape(
        {name: column.shape for name, column in columns.items()},
        what="lengths", remedy="give one number, or as many as the others have",
    )  # fmt: skip
    given = {name: np.broadcast_to(column, size) for name, column in columns.items()}
    setup = setup_of(scene, given, size[0], model.setup.simulation)
    result = attrs.evolve(model, setup=setup).impacts(values)
    fitted = [parameter.name for parameter in model.parameters]
    return normal_motion_alone(result) if lacks_friction(scene, given, fitted) else result


def _outcome(
    problem: Problem,
    table: Measurements,
    values: Array,
    diagnosis: Diagnosis,
    impacts: Callable[[Mapping[str, Numbers]], ImpactResult],
) -> tuple[Fit, Spread]:
    """Return the fit with its intervals, and these as arrays."""
    parameters = problem.model.parameters
    found = spread(problem, values)
    freedom = sum(problem.counts.values()) - len(values)
    stated = all(name in problem.errors for name in problem.measured)
    estimates = {}
    for place, parameter in enumerate(parameters):
        ends = float(found.low[place]), float(found.high[place])
        estimates[parameter.name] = Estimate(
            name=parameter.name,
            unit=parameter.unit,
            value=float(values[place]),
            standard_error=float(found.errors[place]),
            interval=ends,
            robust=diagnosis.robust[place],
        )
    deviation = np.sqrt(np.diag(found.covariance))
    predicted = problem.model.predict(values[None], list(problem.measured))
    intervals = {name: estimate.interval for name, estimate in estimates.items()}
    outcome = Fit(
        parameters=estimates,
        correlation=found.covariance / np.outer(deviation, deviation),
        laws=problem.model.laws(values),
        measurements=table,
        predicted={name: rows[0] for name, rows in predicted.items()},
        aic=problem.criterion(values),
        reduced_chi_square=found.mean_square if stated else None,
        notes=(
            *diagnosis.sentences,
            *unlikely_parameters(problem, intervals),
            *(() if diagnosis.sentences else describe_outlying(estimates)),
            *error_notes(problem, values),
            *end_notes(problem, values, freedom),
        ),
        impacts=impacts,
    )
    return outcome, found


@attrs.frozen(kw_only=True)
class Ranked:
    """A law and its fit; without a fit, ``refusal`` gives the reason."""

    name: str
    fit: Fit | None
    refusal: str = ""


def rank(
    measurements: str | Path | Mapping[str, object] | SceneFile | Measurements,
    scene: Scene | SceneFile | str | Path,
    simulations: Mapping[str, Simulation | None],
    *,
    progress: bool | Count | None = None,
    parameters: Sequence[str] = ("friction_coefficient",),
    quantities: Sequence[str] | None = None,
    bootstrap: int = 0,
    seed: int = 1976,
) -> list[Ranked]:
    """Return laws in the order of Akaike's criterion, the best first, laws without a fit last.

    Parameters
    ----------
    measurements, scene, parameters
        As for ``fit``. A parameter that some of the laws have is fitted under those alone.
    simulations : mapping of str to Simulation
        Laws by the names to report; None stands for the exact elastic laws.
    progress : True or callable, optional
        As for ``fit``, counted by laws.
    quantities, bootstrap, seed
        As for ``fit``.

    Raises
    ------
    ValueError
        If the measurements cannot be read. The failure of a single law is in its ``refusal``.
    """
    table = as_target_sees(read_measurements(measurements), scene)
    own = parameters_of(table, scene, simulations, parameters)
    ranked = []
    with follow(progress, "laws") as count:
        for done, (name, simulation) in enumerate(simulations.items(), start=1):
            try:
                fitted = fit(
                    table,
                    scene,
                    parameters=own[name],
                    simulation=simulation,
                    quantities=quantities,
                    bootstrap=bootstrap,
                    seed=seed,
                )
                ranked.append(Ranked(name=name, fit=fitted))
            except (ValueError, ImpactError) as error:
                ranked.append(Ranked(name=name, fit=None, refusal=str(error)))
            if count is not None:
                count(done, len(simulations))
    return in_order(ranked)


def parameters_of(
    measurements: Measurements,
    scene: Scene | SceneFile | str | Path,
    simulations: Mapping[str, Simulation | None],
    parameters: Sequence[str],
) -> dict[str, list[str]]:
    """Return the parameters to fit under each law; a parameter of no law stays, to be refused."""
    size = len(measurements)
    having = {
        name: those_of(setup_of(scene, measurements.given, size, simulation), parameters)
        for name, simulation in simulations.items()
    }
    nowhere = set(parameters).difference(*having.values())
    return {
        name: [each for each in parameters if each in had or each in nowhere]
        for name, had in having.items()
    }


def in_order(ranked: Iterable[Ranked]) -> list[Ranked]:
    """Return laws with the lowest Akaike criterion first, laws without a fit last."""
    return sorted(ranked, key=lambda law: (law.fit is None, law.fit.aic if law.fit else 0.0))
