"""An interruption within a study: a sweep keeps it to itself, and a study must not."""

from __future__ import annotations

import numpy as np

from contactlab.contracts.status import Status
from contactlab.outcome.result import ImpactResult


def uninterrupted(result: ImpactResult) -> ImpactResult:
    """Return the result of a sweep that was followed to its end, well or not.

    Raises
    ------
    KeyboardInterrupt
        If it was interrupted: a sweep then returns what is done, and a study would take the
        rest for failures, or its run time for that of the whole.
    """
    if Status.INTERRUPTED in np.ravel(np.array(result.status, dtype=object)):
        raise KeyboardInterrupt
    return result
