"""The caution of elastic laws about materials that yield."""

from __future__ import annotations

from typing import Any

import numpy as np

from contactlab.impact.hertz import peak_pressure
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import for_share

#: Peak pressure of Hertz's contact at which yield begins beneath the surface, over the yield
#: stress Y (Thornton's law has the same factor).
FIRST_YIELD = 1.6
GPA = 1e9


def yielding(scene: Scene) -> tuple[str, ...]:
    """Return the caution of a Hertz pressure above 1.6 Y; empty without yield stresses."""
    bodies = {"sphere": scene.sphere, "target": scene.target}
    stresses: dict[str, Any] = {
        name: body.material.yield_stress
        for name, body in bodies.items()
        if body is not None and body.material.yield_stress is not None
    }
    if not stresses:
        return ()
    pressure = np.broadcast_to(peak_pressure(scene), scene.shape)
    limits = np.stack(
        [np.broadcast_to(FIRST_YIELD * stress, scene.shape) for stress in stresses.values()]
    )
    limit = limits.min(axis=0)
    yields = pressure > limit
    if not yields.any():
        return ()
    worst = np.unravel_index(np.argmax(pressure / limit), scene.shape) if scene.shape else ()
    softest = list(stresses)[int(np.argmin([each[worst] for each in limits]))]
    return (
        f"yield{for_share(yields)}: the peak pressure of Hertz's contact is "
        f"{pressure[worst] / GPA:.2g} GPa, above 1.6 Y = {limit[worst] / GPA:.2g} GPa of the "
        f"{softest}, which would deform plastically; the normal law leaves that out "
        "(model, not numerical error)",
    )
