"""The caution of an assumed hemispherical pressure."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from contactlab.contracts.motion import NormalMotion

#: Phases at which the friction load is compared with Hertz's, and the relative tolerance.
PHASES = np.linspace(0.1, 0.9, 9) * math.pi
CLOSE = 1e-6


def hemisphere(normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution of an assumed hemispherical pressure, empty if none is assumed."""
    # Without the claim ``hertzian_pressure`` the friction law makes the assumption. With the claim
    # the normal law makes it, unless the friction load is Hertz's at the contact radius.
    if "hertzian_pressure" not in normal.offers:
        return (
            "the friction law assumes a hemispherical pressure over the contact radius, with the "
            "friction load as its sum; the normal law does not declare one (model error)",
        )
    if "elastic_hertz" in normal.offers or _hertzian(normal):
        return ()
    return (
        "the normal law assumes a hemispherical pressure for its damped force; no theory gives "
        "the pressure of the damping (model error)",
    )


def _hertzian(normal: NormalMotion) -> bool:
    """Return whether the friction load is that of a Hertz contact of the same radius."""
    pair, shape = normal.scene.pair, normal.scene.shape
    contact = normal.at(PHASES.reshape(-1, *(1 for _ in shape))).contact
    radius: Any = contact.radius
    hertz = (4.0 / 3.0) * pair.effective_modulus * radius**3 / pair.radius
    off = np.abs(np.asarray(contact.friction_load) - hertz)
    return bool(np.all(~(off > CLOSE * hertz)))
