"""Which theory of adhesion holds: Tabor's parameter."""

from __future__ import annotations

import math

import numpy as np

from contactlab.impact.scene import Scene

#: Distance in m over which surfaces attract each other, about that of atoms.
RANGE = 3e-10


def tabor_caution(
    scene: Scene,
    work_of_adhesion: float,
    *,
    other: str,
    least: float = 0.0,
    most: float = math.inf,
) -> tuple[str, ...]:
    """Return the caution of bodies too soft or too stiff for a theory of adhesion.

    Tabor's parameter is (R Gamma²/(E*² h³))^(1/3), h the range of attraction: Tabor, J. Colloid
    Interface Sci. 58 (1977) 2-13, doi:10.1016/0021-9797(77)90366-6.

    Parameters
    ----------
    scene : Scene
        In SI; of a non-dimensional one nothing is known.
    work_of_adhesion : float
        Gamma in J/m².
    other : str
        The law for the other case.
    least, most : float
        Bounds between which the theory holds.
    """
    if scene.sphere is None or work_of_adhesion == 0.0:
        return ()
    pair = scene.pair
    found = np.cbrt(pair.radius * (work_of_adhesion / pair.effective_modulus) ** 2) / RANGE
    low, high = float(np.min(found)), float(np.max(found))
    if least <= low and high <= most:
        return ()
    bound, value = (f"above {least:g}", low) if low < least else (f"below {most:g}", high)
    return (
        f"Tabor's parameter is {value:.2g}, with a range of attraction of {RANGE:g} m: the theory "
        f"holds {bound}; see {other} (model, not numerical error)",
    )
