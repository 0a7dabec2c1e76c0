"""The numerical error of a result in words: declared, estimated, and whether the two agree."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np

from contactlab.impact.error_model import COARSE, range_of
from contactlab.numeric.arrays import for_share
from contactlab.numeric.types import Array, Real
from contactlab.outcome.functions_of_results import WithScene
from contactlab.outcome.plan import NORMAL_SPIN, WITHOUT_SPIN, Plan

#: Ratio of estimated to declared error above which the declaration is false. Estimates are mostly
#: within a factor of three of the true error.
CONTRADICTS = 10.0


class WithPlan(WithScene, Protocol):
    """A result that has a plan with declared errors, and may have an estimate."""

    @property
    def plan(self) -> Plan:
        """The plan."""

    @property
    def psi2_error_estimate(self) -> Real | None:
        """Estimate of the error of psi2; None if there is none."""


def error_words(result: WithPlan) -> str:
    """Return the numerical error of psi2 in words, estimated and declared."""
    if result.psi2_error_estimate is None and isinstance(result.plan.psi2_error, float):
        error = result.plan.psi2_error  # one number for all needs no array
        told = "not declared" if math.isnan(error) else f"at most {error:.1g}, declared"
        return "; ".join(["not estimated", told, *_of_spin(result.plan)])
    estimate, declared = _errors(result)
    parts = []
    if np.isfinite(estimate).any():
        parts.append(f"{_largest(estimate, 'about')}, estimated{_missing(estimate)}")
    elif result.psi2_error_estimate is None:
        parts.append("not estimated")
    else:
        parts.append("no estimate: no finer resolution shows one")
    if np.isfinite(declared).any():
        parts.append(f"{_largest(declared, 'at most')}, declared{_missing(declared)}")
    else:
        parts.append("not declared")
    return "; ".join([*parts, *_of_spin(result.plan)])


def _of_spin(plan: Plan) -> list[str]:
    """Return words on spin about the normal if it is left out, else nothing."""
    return [WITHOUT_SPIN] if any(clause.code == NORMAL_SPIN for clause in plan.left_out) else []


def error_cautions(result: WithPlan) -> list[str]:
    """Return cautions about a false declared error and about coarse answers."""
    if _is_fine(result):
        return []
    estimate, declared = _errors(result)
    with np.errstate(all="ignore"):
        contradicted = estimate > CONTRADICTS * declared
        unit, width, _ = range_of(result.scene)
        share: Real = error_of(result) * np.divide(unit, width)
        share = np.where(result.plan.marched, share, 0.0)
    cautions = []
    if contradicted.any():
        worst = int(np.argmax(np.where(contradicted, estimate, 0.0)))
        cautions.append(
            f"the stated bound of the error of psi2 is wrong{for_share(contradicted)}: stated "
            f"{declared.flat[worst]:.1g}, estimated {estimate.flat[worst]:.1g}. Trust the estimate."
        )
    coarse = np.asarray(share > COARSE)
    if coarse.any():
        cautions.append(
            f"coarse{for_share(coarse)}: no digit of psi2 is sure, as its error is "
            f"{np.nanmax(share):.2g} of the range. Use a finer resolution."
        )
    return cautions


def _is_fine(result: WithPlan) -> bool:
    """Return whether a single answer has no estimate and a small declared error, by floats."""
    plan = result.plan
    if result.scene.shape or result.psi2_error_estimate is not None:
        return False
    if not plan.marched:  # no steps, no estimate
        return True
    unit, width, _ = range_of(result.scene)
    return isinstance(plan.psi2_error, float) and bool(plan.psi2_error * unit <= COARSE * width)


def _errors(result: WithPlan) -> tuple[Array, Array]:
    """Return estimated and declared error in the batch shape, NaN where there is none."""
    shape = result.scene.shape
    estimate = np.nan if result.psi2_error_estimate is None else result.psi2_error_estimate
    declared = np.broadcast_to(np.asarray(result.plan.psi2_error, dtype=np.float64), shape)
    return np.broadcast_to(np.asarray(estimate, dtype=np.float64), shape), declared


def error_of(result: WithPlan) -> Array:
    """Return the estimated error of psi2, else the declared one; NaN if neither, batch shape."""
    estimate, declared = _errors(result)
    return np.where(np.isnan(estimate), declared, estimate)  # a bound may be far larger


def _largest(error: Array, word: str) -> str:
    """Return the largest error of a batch with ``word`` before it."""
    return f"{word} {np.nanmax(error):.1g}"


def _missing(error: Array) -> str:
    """Return the share of impacts with an error in words, empty if all have one."""
    finite = np.isfinite(error)
    return "" if finite.all() else for_share(finite)
