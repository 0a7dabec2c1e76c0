"""What a result says of its numerical error: declared, estimated, and whether the two agree."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from contactlab.contracts.error_model import COARSE, range_of
from contactlab.numeric.arrays import for_share

if TYPE_CHECKING:
    from contactlab.outcome.result import ImpactResult

#: An estimate this many times the declared error contradicts it. Estimates are mostly within a
#: factor of three of the true error.
CONTRADICTS = 10.0


def error_words(result: ImpactResult) -> str:
    """Return the numerical error of psi2, estimated and declared, or what is not known of it."""
    estimate, declared = _errors(result)
    known = []
    if np.isfinite(estimate).any():
        known.append(f"{_largest(estimate, 'about')}, estimated{_missing(estimate)}")
    elif result.psi2_error_estimate is None:
        known.append("not estimated")
    else:
        known.append("no estimate: no finer resolution shows one")
    if np.isfinite(declared).any():
        known.append(f"{_largest(declared, 'at most')}, declared{_missing(declared)}")
    else:
        known.append("not declared")
    return "; ".join(known)


def error_cautions(result: ImpactResult) -> list[str]:
    """Return sentences on an estimate that contradicts what is declared, and on coarse answers."""
    estimate, declared = _errors(result)
    with np.errstate(all="ignore"):
        wrong = estimate > CONTRADICTS * declared
        unit, width, _ = range_of(result.scene)
        share = np.fmax(estimate, declared) * np.divide(unit, width)
        share = np.where(result.plan.marched, share, 0.0)
    found = []
    if wrong.any():
        place = int(np.argmax(np.where(wrong, estimate, 0.0)))
        found.append(
            f"the declared numerical error of psi2 is false{for_share(wrong)}: at most "
            f"{declared.flat[place]:.1g} is declared, about {estimate.flat[place]:.1g} is estimated"
        )
    coarse = np.asarray(share > COARSE)
    if coarse.any():
        found.append(
            f"coarse{for_share(coarse)}: the numerical error is {np.nanmax(share):.2g} of the "
            "range of psi2, so that no digit is sure; finer resolutions would help"
        )
    return found


def _errors(result: ImpactResult) -> tuple[Any, Any]:
    """Return the estimated and the declared error, NaN where there is none, of the batch shape."""
    shape = result.scene.shape
    estimate: Any = np.nan if result.psi2_error_estimate is None else result.psi2_error_estimate
    declared = np.broadcast_to(np.asarray(result.plan.psi2_error, dtype=np.float64), shape)
    return np.broadcast_to(np.asarray(estimate, dtype=np.float64), shape), declared


def _largest(error: Any, word: str) -> str:
    return f"{word} {np.nanmax(error):.1g}"


def _missing(error: Any) -> str:
    """Return for how many impacts of a batch an error is known, if not for all."""
    known = np.isfinite(error)
    return "" if known.all() else for_share(known)
