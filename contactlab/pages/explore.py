"""A page with sliders for psi1 and chi: rebound, forces, regions of stick and slip."""

from __future__ import annotations

import json
from importlib import resources
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

import contactlab
from contactlab.numeric.checks import refuse

#: Decimals of psi2 on the page.
DIGITS = 4
#: Springs and steps of the computation in the page. The map has one row for each spring. The
#: error of psi2 of this bundle is below 2e-3: too small to see.
SPRINGS, STEPS = 120, 600


@attrs.frozen
class Axis:
    """Evenly spaced stops of a slider.

    Attributes
    ----------
    start, step : float
    count : int
    first : float
        Value of the slider when the page opens.
    """

    start: float
    step: float
    count: int
    first: float

    @property
    def stops(self) -> NDArray[np.float64]:
        """Return the stops, shape (count,)."""
        return self.start + self.step * np.arange(self.count, dtype=np.float64)

    def nearest(self, value: float, name: str) -> int:
        """Return the index of the stop nearest to ``value``; messages name ``name``."""
        last = self.start + self.step * (self.count - 1)
        if not self.start <= value <= last:
            raise refuse(
                name, value, f"must lie in [{self.start:g}, {last:g}], the range of the slider"
            )
        return round((value - self.start) / self.step)

    def to_dict(self) -> dict[str, float]:
        """Return start, step and count under the names that the page uses."""
        return {"from": self.start, "step": self.step, "count": self.count}


#: psi1 reaches beyond gross slip of a solid sphere; chi goes from thin shells to spheres with a
#: denser core than any real sphere.
PSI1 = Axis(0.0, 0.05, 181, 2.0)
CHI = Axis(0.4, 0.02, 106, 1.44)


def explore_page(*, psi1: float = PSI1.first, chi: float = CHI.first) -> str:
    """Return the page as HTML; the sliders open at the stops nearest to ``psi1`` and ``chi``."""
    first = [PSI1.nearest(psi1, "psi1"), CHI.nearest(chi, "chi")]
    psi2 = contactlab.rebound(PSI1.stops, CHI.stops[:, np.newaxis])
    grid: dict[str, Any] = {
        "psi1": PSI1.to_dict(),
        "chi": CHI.to_dict(),
        "first": first,
        "digits": DIGITS,
        "psi2": np.rint(psi2 * 10**DIGITS).astype(int).tolist(),
    }
    page = resources.files("contactlab").joinpath("pages", "explore.html").read_text("utf-8")
    entries = {
        "/*GRID*/null": json.dumps(grid, separators=(",", ":")),
        "/*SPRINGS*/0": str(SPRINGS),
        "/*STEPS*/0": str(STEPS),
        "DIGITS digits": f"{DIGITS} digits",
        "VERSION": contactlab.__version__,
        "SPRINGS springs": f"{SPRINGS} springs",
        "STEPS steps": f"{STEPS} steps",
    }
    for place, entry in entries.items():
        page = page.replace(place, entry)
    return page
