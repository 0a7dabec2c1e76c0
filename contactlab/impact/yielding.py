"""The caution of elastic laws about materials that yield."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.impact.hertz import peak_pressure
from contactlab.impact.scene import Scene
from contactlab.numeric.arrays import for_share
from contactlab.numeric.checks import Real

#: Peak pressure of Hertz's contact at which yield begins beneath the surface, over the yield
#: stress Y (Thornton's law has the same factor).
FIRST_YIELD = 1.6
GPA = 1e9


#: Above this ratio of contact radius to R the theory of half-spaces is doubtful (theory §8).
DOUBTFUL_SIZE_RATIO = 0.1


def large_contact(ratio: float) -> tuple[str, ...]:
    """Return the caution of a contact radius over R that is not small."""
    if not ratio > DOUBTFUL_SIZE_RATIO:
        return ()
    return (
        f"C = {ratio:.3g}, contact radius over R: the contact is not small against the "
        f"radius, the theory of half-spaces is doubtful above {DOUBTFUL_SIZE_RATIO}",
    )


def path_cautions(scene: Scene, deepest: float, *, plastic: bool) -> tuple[str, ...]:
    """Return the cautions of bodies that are pressed together by ``deepest`` m."""
    if scene.sphere is None or not deepest > 0.0:
        return ()
    ratio: Any = np.sqrt(deepest / scene.pair.radius)
    pressure = (2.0 / math.pi) * scene.pair.effective_modulus * ratio
    cautions = () if plastic else yielding(scene, pressure)
    return (*cautions, *large_contact(float(np.max(ratio))))


def yielding(scene: Scene, peak: Real | None = None) -> tuple[str, ...]:
    """Return the caution of a Hertz pressure above 1.6 Y; empty without yield stresses.

    Parameters
    ----------
    scene : Scene
    peak : float or array, optional
        Greatest pressure in Pa; that of the elastic impact by default.
    """
    bodies = {"sphere": scene.sphere, "target": scene.target}
    stresses: dict[str, Any] = {
        name: body.material.yield_stress
        for name, body in bodies.items()
        if body is not None and body.material.yield_stress is not None
    }
    if not stresses:
        return ()
    pressure = np.broadcast_to(peak_pressure(scene) if peak is None else peak, scene.shape)
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
