"""Diagnosis of a measurement by its fit: slips, outliers, patterns, unlikely numbers."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Collection, Mapping

import attrs
import numpy as np

from contactlab.impact.cautions import OUTSIDE
from contactlab.impact.coupling import LEFT_OUT, coupling_shift, measures_coupling
from contactlab.numeric.types import Array, Real
from contactlab.outcome.columns import QUANTITIES, foreign
from contactlab_fit import outliers, patterns, plausible, tabulated
from contactlab_fit.f_test import CHANCE
from contactlab_fit.fit_result import Estimate
from contactlab_fit.measurements import Measurements
from contactlab_fit.model import FOLLOWED
from contactlab_fit.parameters import SHEAR_LOSS
from contactlab_fit.problem import Problem, fewer
from contactlab_fit.slips import loosen, lossy, slips
from contactlab_fit.unknown_friction import FRICTIONS, under

#: The chance below which a pattern is reported beside outliers, which explain the residuals better.
POSSIBLE = 1e-5
#: One error common to all impacts is preferred to a curve that is less likely by less than this.
SIMPLER = 100.0
#: Reduced chi square above which stated errors are too small, or the law does not fit.
LARGE_CHI_SQUARE = 2.0
#: Share of the stated errors below which residuals suggest another unit, or limits.
SMALL_RATIO = 0.5
#: A value lies at the end of its range if nearer than this share of the range.
AT_END = 1e-6
#: Least rows of a table from which repeated copies are told.
FEWEST_ROWS = 3


@attrs.frozen(kw_only=True)
class Diagnosis:
    """Sentences on the measurement, and the robust second fit.

    Attributes
    ----------
    slips : tuple of str
        Columns that a fit meets far better if read another way, and implausible numbers.
    others : tuple of str
        Outliers, patterns and leverage; empty after a slip or a loss, which would explain them.
    robust : list of float or None
        Values of the robust fit; None for too few numbers.
    """

    slips: tuple[str, ...]
    others: tuple[str, ...]
    robust: list[float] | list[None]

    @property
    def sentences(self) -> tuple[str, ...]:
        """Sentences of ``slips``, then of ``others``."""
        return self.slips + self.others


def diagnose(
    problem: Problem, table: Measurements, values: Array, *, explained: bool = False
) -> Diagnosis:
    """Return the diagnosis of a measurement at the best values, shape (parameters,).

    With ``explained`` residuals there are no sentences on their pattern.
    """
    robust: list[float] | list[None] = [None] * len(values)
    far = outliers.none(problem, values)
    if sum(problem.counts.values()) >= outliers.LEAST + len(values) - 1:
        robust_values, scales = outliers.robust(problem, values)
        far, robust = outliers.outliers(problem, robust_values, scales), robust_values.tolist()
    few, (kept,) = fewer(problem, far.rest.measured)
    certain, possible = slips(few, table, values, kept)
    unlikely = plausible.unlikely_numbers(problem, table)
    slipped = (*certain, *unlikely)
    others = () if slipped or explained else (*_sentences(problem, table, values, far), *possible)
    return Diagnosis(slips=slipped, others=others, robust=robust)


def _sentences(
    problem: Problem, table: Measurements, values: Array, far: outliers.Outliers
) -> tuple[str, ...]:
    """Return sentences on outliers, patterns and leverage."""
    sentences: list[str] = []
    scales, seen = _judge_errors(problem, table, values)
    if far.places and far.chance <= seen.chance:
        sentences += outliers.describe_outliers(problem, far)
        if seen.chance < POSSIBLE:
            sentences.append(f"or, with every number kept, {seen.words}")
        problem, values = far.rest, far.values
        scales, seen = _judge_errors(problem, table, values)
    if seen.chance < CHANCE:
        sentences.append(seen.words)
    return (*sentences, *patterns.leverage(problem, values, scales))


def _judge_errors(
    problem: Problem, table: Measurements, values: Array
) -> tuple[Mapping[str, Real], patterns.Pattern]:
    """Return the error of each quantity, and the pattern that scatter makes least likely."""
    scales = problem.scales(problem.residuals(values[None]))
    pattern = patterns.pattern(problem, values, scales, table.given)
    common = loosen(fewer(problem)[0], table.given, values)
    return scales, common if common.chance < SIMPLER * pattern.chance else pattern


def tell_loss(problem: Problem, values: Array) -> list[str]:
    """Return a sentence if the measured normal motion has another restitution than the laws."""
    seen = lossy(fewer(problem)[0], values)
    return [seen.words] if seen.chance < CHANCE else []


def cautions(problem: Problem, values: Array, *, of_any_friction: bool = False) -> list[str]:
    """Return the cautions of the impacts, and the known shift of each parameter.

    The shift is the size of the effect of coupling: the shifts of psi2 of all impacts, each in the
    worse direction, times the derivatives of the best values by the measured numbers. With unknown
    friction only cautions ``of_any_friction`` are told.
    """
    result = problem.model.impacts(values)
    said = list(result.cautions)
    if of_any_friction:
        others = [under(problem.model, each).impacts(values).cautions for each in FRICTIONS]
        said = [text for text in said if all(text in other for other in others)]
    said += _caution_of_shear(problem)
    if not (any(text.startswith(LEFT_OUT) for text in said) and result.scene.planar):
        return said
    if theirs := [name for name in problem.measured if name in foreign()]:
        names = ", ".join(theirs)
        return [*said, f"effect of the unlike materials on the values: not known for {names}"]
    if not np.all(measures_coupling(result.scene)):
        return [
            *said,
            f"effect of the unlike materials on the values: {OUTSIDE}",
        ]
    change = coupling_shift(result.scene) / np.asarray(result.scene.psi_scale)
    velocity = result.motion.slip_velocity_change + change
    motion = attrs.evolve(result.motion, slip_velocity_change=velocity)
    shifted = attrs.evolve(result, motion=motion)
    scales = problem.scales(problem.residuals(values[None]))
    inverse = np.asarray(np.linalg.pinv(problem.linearise(values, scales)[1]), dtype=np.float64)
    moves = np.zeros((*result.scene.shape, len(values)))
    for name, part in problem.by_quantity(inverse.T).items():
        off = (QUANTITIES[name].of(shifted) - QUANTITIES[name].of(result)) / scales[name]
        rows = np.isfinite(problem.measured[name])
        moves[rows] += part * off[rows, None]
    sizes = zip(problem.model.parameters, np.abs(moves).sum(axis=0), strict=True)
    moves_by = ", ".join(f"{parameter.name} by up to about {size:.1g}" for parameter, size in sizes)
    return [*said, f"effect of the unlike materials, which is ignored: {moves_by}"]


def _caution_of_shear(problem: Problem) -> list[str]:
    """Return the caution of a loss in shear that is fitted."""
    fitted = {parameter.name.rpartition(".")[2] for parameter in problem.model.parameters}
    if SHEAR_LOSS not in fitted:
        return []
    assumed = "" if "stiffness_ratio" in fitted else " holds for these Poisson's ratios, and it"
    return [
        f"model: {SHEAR_LOSS}{assumed} absorbs everything that changes the tangential "
        "restitution. Poisson's ratios and friction must be known."
    ]


def describe_outlying(estimates: Mapping[str, Estimate]) -> list[str]:
    """Return a sentence for each parameter whose robust value lies outside its interval."""
    return [
        f"outliers: a robust fit gives {name} = {estimate.robust:.4g}, outside the interval. Look "
        "at the impacts with the largest residuals."
        for name, estimate in estimates.items()
        if estimate.robust is not None
        and not estimate.interval[0] <= estimate.robust <= estimate.interval[1]
    ]


def error_notes(problem: Problem, values: Array) -> list[str]:
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
                f"{name}: residuals are {ratio:.2g} times the errors given. The errors are too "
                "small, or the law is wrong; intervals were widened to match."
            )
        alike = np.nanmin(problem.measured[name]) == np.nanmax(problem.measured[name])
        if ratio < SMALL_RATIO and not alike and chdtr(freedom, square) < CHANCE:
            notes.append(
                f"{name}: residuals are {ratio:.2g} times the errors given. The errors are too "
                f"large: check the unit of {name}_error, and that they are standard errors."
            )
    return notes


def table_notes(table: Measurements, parameters: Collection[str]) -> list[str]:
    """Return sentences on the fitted columns, and on a table that repeats itself."""
    notes = [
        f"the column {name} is not used, as {name} is fitted"
        for name in table.given
        if name in parameters
    ]
    columns = [*table.given.values(), *table.measured.values(), *table.errors.values()]
    counts = [*Counter(row.tobytes() for row in np.stack(columns, axis=1)).values()]
    if len(counts) >= FEWEST_ROWS and 1 < min(counts) == max(counts):
        notes.append(
            f"every impact occurs {counts[0]} times. Copies make the intervals too narrow; "
            "remove them."
        )
    return notes


def note_marches(problem: Problem) -> list[str]:
    """Return a sentence on columns for which impacts are followed, not tabulated."""
    model = problem.model
    if model.tabled or not tabulated.holds(model.setup.simulation):
        return []
    names = [name for name in problem.measured if FOLLOWED & {*QUANTITIES[name].needs}]
    needs = sorted(FOLLOWED & model.needs)
    told = f"{', '.join(names)}: read from the {' and '.join(needs)} of an impact"
    return [f"{told}, so the fit follows each impact and takes longer"] if names else []


def end_notes(problem: Problem, values: Array, freedom: int) -> list[str]:
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
        notes.append("as many numbers as parameters: the scatter cannot be estimated")
    return notes
