"""A caution for plans; every run asks for it, so nothing heavy is imported here."""

import numpy as np

from contactlab import Scene
from contactlab.plugin import hookimpl

#: Largest speed of approach in the laboratory, m/s.
FASTEST = 5.0


@hookimpl
def contactlab_cautions(scene: Scene) -> list[str]:
    """Return a sentence on impacts that are faster than any that was measured."""
    fastest = float(np.max(scene.normal_speed))
    return [f"speed of {fastest:.3g} m/s: measured to {FASTEST:g} m/s"] * (fastest > FASTEST)
