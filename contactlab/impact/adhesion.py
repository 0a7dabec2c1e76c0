"""Tabor's parameter, which decides between theories of adhesion."""

from __future__ import annotations

import math

import numpy as np

from contactlab.impact.scene import Scene

#: Range of attraction of surfaces in m, about the distance between atoms.
RANGE = 3e-10


def tabor_caution(
    scene: Scene,
    work_of_adhesion: float,
    *,
    other: str,
    least: float = 0.0,
    most: float = math.inf,
) -> tuple[str, ...]:
    """Return the caution if Tabor's parameter lies outside [``least``, ``most``].

    Tabor's parameter is (R Gamma²/(E*² h³))^(1/3), h the range of attraction: Tabor, J. Colloid
    Interface Sci. 58 (1977) 2-13, doi:10.1016/0021-9797(77)90366-6. ``work_of_adhesion`` is Gamma
    in J/m², ``other`` names the law for the other range.
    """
    if scene.sphere is None or work_of_adhesion == 0.0:
        return ()
    pair = scene.pair
    tabor = np.cbrt(pair.radius * (work_of_adhesion / pair.effective_modulus) ** 2) / RANGE
    low, high = float(np.min(tabor)), float(np.max(tabor))
    if least <= low and high <= most:
        return ()
    bound, value = (f"above {least:g}", low) if low < least else (f"below {most:g}", high)
    return (
        f"Tabor's parameter is {value:.2g}, with a range of attraction of {RANGE:g} m: the theory "
        f"holds {bound}; see {other} (model, not numerical error)",
    )
