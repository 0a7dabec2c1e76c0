"""The status of an impact: an enumeration whose values are sentences."""

from __future__ import annotations

from enum import Enum
from typing import TYPE_CHECKING, TypeAlias, TypeVar

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray


class Status(Enum):
    """How the run of an impact ended. Only ``SUCCESS`` has an answer; else numbers are NaN."""

    SUCCESS = "The impact was followed from first touch to separation."
    NON_FINITE = "A law returned a value that is not a finite number."
    TOO_FEW_STEPS = "The steps are too few for the stiffness of the contact."
    UNSETTLED = "The tangential law found no division into stick and slip that passes its tests."
    UNRESOLVED = "The motion could not be followed to the tolerance asked for."
    UNBALANCED = "The energy books do not balance: energy came from nothing, or went nowhere."
    NOT_SEPARATED = "The bodies did not part within the steps allowed."
    MALFORMED = "A law's answer is not real numbers of the batch's shape, or has a wrong sign."
    LAW_RAISED = "A law raised an error in the middle of the run."
    WORKER_DIED = "The process that was to compute this impact ended before it answered."
    INTERRUPTED = "The run was interrupted; this impact was not computed."

    def __bool__(self) -> bool:
        """Return True for ``SUCCESS`` only, so that ``if result.status:`` tests for success."""
        return self is Status.SUCCESS


#: The status of one impact, or those of a batch.
Statuses: TypeAlias = "Status | NDArray[np.object_]"
#: A sentence on the failure of one impact, or of each of a batch; empty for a success.
Details: TypeAlias = "str | NDArray[np.object_]"
#: A status or a sentence.
Word = TypeVar("Word", Status, str)


def succeeded(statuses: Statuses) -> bool:
    """Return whether a status is ``SUCCESS``, or every status of an array."""
    if isinstance(statuses, Status):
        return statuses is Status.SUCCESS
    # a comparison of objects takes three times as long as a count
    return statuses.ravel().tolist().count(Status.SUCCESS) == statuses.size
