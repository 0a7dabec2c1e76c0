"""Interrupted sweeps within a study."""

from __future__ import annotations

import numpy as np

from contactlab.contracts.status import Status
from contactlab.outcome.result import ImpactResult


def require_all(result: ImpactResult) -> ImpactResult:
    """Return ``result`` unchanged, unless Ctrl-C interrupted the sweep.

    An interrupted sweep returns the impacts that are done. A study would count the others as
    failures, and take the run time for that of the whole sweep.

    Raises
    ------
    KeyboardInterrupt
        If any impact has the status ``INTERRUPTED``.
    """
    if was_interrupted(result):
        raise KeyboardInterrupt
    return result


def was_interrupted(result: ImpactResult) -> bool:
    """Return whether Ctrl-C left impacts out."""
    return Status.INTERRUPTED in np.ravel(np.array(result.status, dtype=object))
