"""Values as JSON takes them."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.contracts.status import Status


def json_value(value: Any) -> Any:
    """Return ``value`` as JSON takes it: floats, lists, None for what is undefined."""
    if isinstance(value, Status):
        return value.name
    if isinstance(value, np.ndarray):
        return [json_value(item) for item in value.tolist()]
    if isinstance(value, float | np.floating):
        return float(value) if np.isfinite(value) else None
    return value
