"""Damping in proportion to Hertz's force, Hunt & Crossley (1975)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.hunt_crossley``."""
    from contactlab_laws.hunt_crossley.law import HuntCrossley

    return HuntCrossley
