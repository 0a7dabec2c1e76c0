"""A column of results: how hot the contact gets."""

from typing import Any

import numpy as np

from contactlab import ImpactResult
from contactlab.plugin import Column, hookimpl

#: Density times specific heat of steel, J/(m³ K).
HEAT_CAPACITY = 3.6e6


def flash_temperature(result: ImpactResult) -> Any:
    """Return friction work over the heat capacity of a hemisphere on the contact, in K."""
    hemisphere = 2.0 / 3.0 * np.pi * result.motion.maximum_radius**3
    return result.energy.friction_work / (hemisphere * HEAT_CAPACITY)


@hookimpl
def contactlab_columns() -> list[Column]:
    """Return the column; tables, files and data frames show it beside the others."""
    return [
        Column(
            "flash_temperature",
            "K",
            value=flash_temperature,
            meaning="friction work over the heat capacity of a hemisphere on the contact",
            needs=("sizes", "motion"),
        )
    ]
