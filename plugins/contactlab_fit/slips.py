"""Mistakes in a column, detected by a far better fit with the column read another way."""

from __future__ import annotations

import math
import shlex
from collections.abc import Callable, Collection, Iterable, Mapping
from typing import NamedTuple

import attrs
import numpy as np

from contactlab.contracts.whole_impact import Tabulated
from contactlab.impact.hertz import slips_throughout
from contactlab.numeric.types import Array, Real
from contactlab.registration.names import short_name
from contactlab.registry.registry import REGISTRY
from contactlab_fit import tabulated
from contactlab_fit.csv_columns import MEASURABLE
from contactlab_fit.f_test import SPARE, chance_of
from contactlab_fit.measurements import Measurements
from contactlab_fit.parameters import (
    RESTITUTION,
    SHEAR_LOSS,
    Parameter,
    Setup,
    find_parameter,
    in_words,
    laws_with,
    those_of,
)
from contactlab_fit.patterns import NO_PATTERN, Pattern
from contactlab_fit.problem import Problem, grid, solve_problem
from contactlab_fit.readings import Reading, readings, turn_scene

#: A mistake is reported if its correction makes the likelihood exp(CERTAIN/2) times greater, which
#: chance does once in 20,000 times, and residuals ``SMALLER`` times smaller. A sign needs no such
#: residuals, and if all impacts then slip throughout exp(SLIDING/2) is enough: turned, numbers look
#: like those of a greater friction, but grow with the angle where those fall.
SMALLER, CERTAIN, SLIDING = 2.0, 20.0, 6.0
#: A reading is fitted if its residuals on the grid of starts are at most this many times the
#: residuals of the fit: the friction coefficients of the grid are far apart.
WORTH_FITTING = 3.0
#: Most readings reported, and difference of scores up to which they are as good as the best.
LISTED, ALIKE = 3, 6.0
#: A tilt, or a loss in shear, is fitted if normal scatter follows its derivative with less than
#: this chance; a tilt that is no less likely and moves a parameter out of its interval is told.
WORTH_FITTING_MORE = 1e-2
#: Largest tilt, in degrees.
TILT = 15.0
#: Start of the search of a restitution.
SOME_LOSS = 0.9
#: Restitutions tried in place of 1, and the difference of scores that excludes one (95 %).
LOSSES, EXCLUDED = (0.95, 0.9, 0.85, 0.8, 0.7, 0.6, 0.5), 3.84
#: Residuals below this share of the largest number are numerical error.
LEAST = 1e-6


class Read(NamedTuple):
    """A reading, its score, and its best values of the parameters."""

    reading: Reading
    score: float
    values: Array


def slips(
    problem: Problem, table: Measurements, values: Array, kept: Mapping[str, Array]
) -> tuple[list[str], list[str]]:
    """Return sentences on certain and on possible mistakes in columns, at most one of them.

    A sentence names the options that read the columns so.

    Readings are tried with the tabulated exact elastic law. Under other laws a reading has to fit
    far better too. A mistake is only possible if the fit to the numbers ``kept``, without
    outliers, is nearly as good as the best reading.
    """
    number = sum(problem.counts.values())
    if problem.model.setup.scene.sphere is None or number < len(values) + SPARE:
        return [], []
    if set(problem.measured) - set(MEASURABLE):  # the table has no columns of plug-ins
        return [], []
    quick = _elastic(problem)
    start = values if quick is problem else solve_problem(quick, _first(quick))
    better = _better(quick, start, readings(quick, table.given))
    if quick is not problem and better:
        again = [_under(problem, read.reading) for read in better]
        better = _better(problem, values, again)
    if not better:
        return [], []
    best = better[0]
    better = [read._replace(reading=_with_options(read.reading, table)) for read in better]
    sentence = _sentence(problem, values, better)
    subsets = [kept] if best.reading.rest is None else [kept, best.reading.rest]
    own = min(_without(problem, values, numbers) for numbers in subsets)
    if own - best.score > CERTAIN:
        return [sentence], []
    return [], [f"or, with every number kept, {sentence}"] if own > best.score else []


def _with_options(reading: Reading, table: Measurements) -> Reading:
    """Return a reading whose words name the options that read the columns of a table so."""
    options = " ".join(
        f"--column {shlex.quote(table.rename(name, alias))}"
        for name, alias in reading.names.items()
    )
    if not options:
        return reading
    return reading._replace(words=f"{reading.words} ({options} reads it so)")


def _under(problem: Problem, reading: Reading) -> Reading:
    """Return a reading under the laws of the problem."""
    model = problem.model.at(reading.problem.model.setup.scene)
    return reading._replace(problem=attrs.evolve(reading.problem, model=model))


def _without(problem: Problem, values: Array, numbers: Mapping[str, Array]) -> float:
    """Return the score of the measurement with only some of its numbers."""
    fewer = attrs.evolve(problem, measured=numbers)
    ends = (solve_problem(fewer, start) for start in (values, _first(fewer)))
    return min(_score(fewer, end, problem) for end in ends)


def _elastic(problem: Problem) -> Problem:
    """Return the problem under the exact elastic law, whose table is quick."""
    model = problem.model
    if model.setup.simulation is None:
        return problem
    setup = Setup(model.setup.scene, None)
    names = ["friction_coefficient"]
    names += [p.name for p in model.parameters if p.name == "stiffness_ratio"]
    parameters = tuple(find_parameter(name, setup) for name in names)
    return attrs.evolve(problem, model=attrs.evolve(model, setup=setup, parameters=parameters))


def _better(problem: Problem, values: Array, candidates: Iterable[Reading]) -> list[Read]:
    """Return the readings that fit far better than the measurement as it is, best first."""
    number = sum(problem.counts.values())
    own = _score(problem, values, problem)
    times = 2.0 * number * math.log(SMALLER)
    better = []
    for reading in candidates:
        points = grid(reading.problem.model.parameters)
        rough = _scores(reading, points, problem)
        least = int(np.argmin(rough))
        if rough[least] - own > 2.0 * number * math.log(WORTH_FITTING):
            continue
        best = solve_problem(reading.problem, points[least])
        score = float(_scores(reading, best[None], problem)[0])
        gain = max(CERTAIN, times)
        if reading.turned:
            gain = SLIDING if _slides(reading.problem, best) else CERTAIN
        if score < own - gain:
            better.append(Read(reading, score, best))
    better.sort(key=lambda read: read.score)
    return [read for read in better if read.score - better[0].score < ALIKE][:LISTED]


def _slides(problem: Problem, values: Array) -> bool:
    """Return whether all impacts slip throughout."""
    result = problem.model.impacts(values)
    scene = result.scene
    return bool(np.all(slips_throughout(scene.psi1, scene.chi, result.normal_restitution)))


def _first(problem: Problem) -> Array:
    """Return the best point of the grid of starts, shape (parameters,)."""
    points = grid(problem.model.parameters)
    scores = _scores(Reading("", problem, {}), points, problem)
    return np.asarray(points[int(np.argmin(scores))])


def _scores(reading: Reading, points: Array, table: Problem) -> Array:
    """Return -2 log likelihood of the numbers as measured in ``table``, shape (points,).

    The scatter of each quantity is the rms of its residuals, weighted by stated errors.
    """
    problem = reading.problem
    scores = np.zeros(len(points))
    rows_of, counts, sizes = problem.residuals(points), table.counts, table.sizes()
    for (name, rows), own in zip(rows_of.items(), table.measured, strict=True):
        weights = 1.0
        if name in problem.errors:
            error = problem.errors[name]
            weights = error / np.sqrt(np.nanmean(error**2))
        residual = rows / (reading.factors.get(name, 1.0) * weights)
        mean = np.nanmean(residual**2, axis=1)
        scores += counts[own] * np.log(mean + (LEAST * sizes[own]) ** 2)
    return scores


def _score(problem: Problem, values: Array, table: Problem) -> float:
    """Return -2 log likelihood at one point, with the numbers as they are."""
    return float(_scores(Reading("", problem, {}), values[None], table)[0])


def _sentence(problem: Problem, values: Array, better: list[Read], *, more: int = 0) -> str:
    """Return a sentence on the best readings, with the parameters of the first but the last."""
    best = better[0]
    own = _score(problem, values, problem)
    times = math.exp((own - best.score) / (2.0 * sum(problem.counts.values())))
    listed = "; or ".join(read.reading.words for read in better)
    parameters = best.reading.problem.model.parameters
    kept = len(parameters) - more  # without the tried parameters
    estimates = in_words(parameters[:kept], best.values[:kept])
    told = f"{listed}: read so, residuals are {times:.2g} times smaller"
    return f"{told}, and {estimates}" if kept else told


class AngleOffset(Parameter):
    """The common excess of all angles of incidence, in degrees."""

    def apply(self, setup: Setup, value: Real) -> Setup:
        """Return the scene with corrected angles."""
        scene = setup.scene
        angle: Real = np.arctan2(scene.tangential_velocity, scene.normal_speed)
        return setup._replace(scene=turn_scene(scene, angle - np.radians(value), ()))


def loosen(problem: Problem, given: Collection[str], values: Array) -> Pattern:
    """Return the chance that scatter looks like an error common to all impacts, and a sentence.

    The possible errors are a common excess of all angles, a wrong restitution and a wrong loss in
    shear.
    """
    if problem.model.setup.scene.sphere is None:
        return NO_PATTERN
    tried = (
        _tilt(problem, given, values),
        _free_restitution(problem, values),
        _free_shear_loss(problem, values),
    )
    return _better_with(problem, values, *tried)


def lossy(problem: Problem, values: Array) -> Pattern:
    """Return the chance that scatter looks like a wrong restitution, and a sentence on it."""
    scene, simulation = problem.model.setup
    if simulation is None or tabulated.holds(simulation):
        return _better_with(problem, values, _free_restitution(problem, values))
    if scene.sphere is None or "elastic_hertz" not in simulation.laws.capability.normal_claims:
        return NO_PATTERN
    quick = _elastic(problem)
    best = solve_problem(quick, _first(quick))
    return _better_with(quick, best, _free_restitution(quick, best))


#: A problem with one more parameter, in last place; its start, and words on its best value.
Wider = tuple[Problem | None, Array, Callable[[float], str]]


def _better_with(problem: Problem, values: Array, *tried: Wider) -> Pattern:
    """Return the chance of the best additional parameter, and a sentence on equally good ones.

    The chance is that of the F test of one parameter, times the number tried.
    """
    if _freedom(problem, values) < SPARE:
        return NO_PATTERN
    own = _score(problem, values, problem)
    found = []
    for wider, start, words in tried:
        if wider is not None:
            best = solve_problem(wider, start)
            reading = Reading(words(float(best[-1])), wider, {})
            found.append(Read(reading, _score(wider, best, problem), best))
    found.sort(key=lambda read: read.score)
    if not found or found[0].score >= own:
        return NO_PATTERN
    alike = [read for read in found if read.score - found[0].score < ALIKE]
    chance = _chance(problem, values, own - found[0].score) * len(found)
    return Pattern(chance, _sentence(problem, values, alike, more=1))


def _freedom(problem: Problem, values: Array) -> int:
    """Return the degrees of freedom that one parameter more leaves."""
    return sum(problem.counts.values()) - len(values) - 1


def _chance(problem: Problem, values: Array, gain: float) -> float:
    """Return the chance that scatter alone makes one parameter more gain so much of the score."""
    from scipy.special import fdtrc  # only a fit needs scipy

    freedom = _freedom(problem, values)
    ratio = math.expm1(gain / sum(problem.counts.values())) * freedom
    return float(fdtrc(1, freedom, ratio))


def _tilt(problem: Problem, given: Collection[str], values: Array) -> Wider:
    """Return the problem with a common excess of all angles; None if scatter looks as much so."""
    name = "angle_deg" if "angle_deg" in given else "the angle of incidence"

    def words(excess: float) -> str:
        size = f"{abs(excess):.2g} degrees too {'large' if excess > 0.0 else 'small'}"
        return f"{name} looks as if all numbers were {size}, as by the zero of a protractor"

    offset = AngleOffset(name=name, unit="deg", least=-TILT, most=TILT, starts=(0.0,))
    return _worth(problem, offset, values, 0.0), np.append(values, 0.0), words


def _worth(problem: Problem, more: Parameter, values: Array, start: float) -> Problem | None:
    """Return the problem with one parameter more; None if scatter follows its derivative as well.

    At ``start`` the parameter leaves the laws as they are.
    """
    model = attrs.evolve(problem.model, parameters=(*problem.model.parameters, more))
    wider = attrs.evolve(problem, model=model)
    scales = problem.scales(problem.residuals(values[None]))
    weighted, slopes = wider.linearise(np.append(values, start), scales)
    chance = chance_of(weighted, slopes[:, :-1], slopes[:, -1:], 0.0)
    return None if chance > WORTH_FITTING_MORE else wider


def _free_shear_loss(problem: Problem, values: Array) -> Wider:
    """Return the problem with a loss in shear to fit; None if the laws have none, or it is told."""
    setup, parameters = problem.model.setup, problem.model.parameters
    own = float(getattr(setup.simulation and setup.simulation.tangential, SHEAR_LOSS, 1.0))

    def words(shear_loss: float) -> str:
        others = ", ".join(f"beta0 of {short_name(law)}" for law in laws_with("beta0"))
        return (
            f"the contact point looks as if it rebounded {'less' if shear_loss > own else 'more'} "
            f"than these laws give: as with {SHEAR_LOSS} = {shear_loss:.3g} (now {own:.3g}). Fit "
            f"{SHEAR_LOSS} too, or {others}, if Poisson's ratios and friction are known"
        )

    fitted = [parameter.name.rpartition(".")[2] for parameter in parameters]
    if setup.simulation is None or SHEAR_LOSS in fitted or not those_of(setup, [SHEAR_LOSS]):
        return None, values, words
    fixed, own_values = _of_the_batch(problem, values)
    wider = _worth(fixed, find_parameter(SHEAR_LOSS, setup), own_values, own)
    return wider, np.append(own_values, own), words


def _of_the_batch(problem: Problem, values: Array) -> tuple[Problem, Array]:
    """Return the problem with other options of laws fixed at their values, to save time."""
    model = problem.model
    setup, kept = model.setup, []
    for place, parameter in enumerate(model.parameters):
        if parameter.batched:
            kept.append(place)
        else:
            setup = parameter.apply(setup, float(values[place]))
    parameters = tuple(model.parameters[place] for place in kept)
    fixed = attrs.evolve(model, setup=setup, parameters=parameters)
    return attrs.evolve(problem, model=fixed), values[kept]


def _free_restitution(problem: Problem, values: Array) -> Wider:
    """Return the problem with a restitution to fit; None without a table of such impacts."""
    setup, parameters = problem.model.setup, problem.model.parameters
    laws = setup.simulation or tabulated.with_loss(SOME_LOSS)
    names = [parameter.name for parameter in parameters]
    own = getattr(setup.simulation and laws.normal, RESTITUTION, 1.0)

    def words(restitution: float) -> str:
        return (
            f"the impacts look as if their restitution were {restitution:.3g} in place of "
            f"{own:.3g} ({tabulated.fit_restitution(setup.scene, names)})"
        )

    table = REGISTRY.law_class("normal.viscoelastic")
    assert issubclass(table, Tabulated)
    low, high = table.chi_range
    chi = np.asarray(setup.scene.chi)
    known = np.all((chi >= low) & (chi <= high)) and tabulated.holds(laws)
    if f"normal.{RESTITUTION}" in names or not known:
        return None, values, words
    wider = setup._replace(simulation=laws)
    parameters = (*parameters, find_parameter(RESTITUTION, wider))
    model = attrs.evolve(problem.model, setup=wider, parameters=parameters)
    return attrs.evolve(problem, model=model), np.append(values, SOME_LOSS), words


def state_assumptions(
    problem: Problem, given: Collection[str], values: Array, reaches: Array
) -> list[str]:
    """Return sentences on what is assumed, where another value moves a parameter as much."""
    return [*_zero(problem, given, values, reaches), *_elasticity(problem, values, reaches)]


def _zero(problem: Problem, given: Collection[str], values: Array, reaches: Array) -> list[str]:
    """Return a sentence on the zero of the angles if another one is likely, though not certain."""
    if problem.model.setup.scene.sphere is None or _freedom(problem, values) < SPARE:
        return []
    wider, start, words = _tilt(problem, given, values)
    if wider is None:
        return []
    best = solve_problem(wider, start)
    own = _score(problem, values, problem)
    chance = _chance(problem, values, own - _score(wider, best, problem))
    moved = np.any(np.abs(best[:-1] - values) > reaches)
    if chance > WORTH_FITTING_MORE or not moved:
        return []
    estimates = in_words(problem.model.parameters, best[:-1])
    return [
        f"{words(float(best[-1]))}: read so, {estimates}; scatter alone looks so with a chance of "
        f"{chance:.1g}"
    ]


def _elasticity(problem: Problem, values: Array, reaches: Array) -> list[str]:
    """Return a sentence on an assumed restitution if another one moves a parameter as much.

    The sentence tells the least restitution of a few that the data do not exclude, if a parameter
    then lies outside of its interval, of half-widths ``reaches``.
    """
    # where friction changes the approach a loss is followed in steps, for minutes
    quick = problem.model.setup.simulation is None and problem.model.tabled
    wider = _free_restitution(problem, values)[0] if quick else None
    if wider is None:
        return []
    limit = _score(problem, values, problem) + EXCLUDED
    *parameters, more = wider.model.parameters
    sentence: list[str] = []
    for restitution in LOSSES:
        laws = more.apply(wider.model.setup, restitution)
        fixed = attrs.evolve(
            problem, model=attrs.evolve(problem.model, setup=laws, parameters=tuple(parameters))
        )
        best = solve_problem(fixed, values)
        if _score(fixed, best, problem) > limit:
            break
        if np.any(np.abs(best - values) > reaches):
            sentence = [
                f"restitution 1 is assumed; {restitution:g} meets the data as well: "
                f"{in_words(parameters, best)} (model, not scatter)"
            ]
    return sentence
