"""Adhesion of soft spheres, Johnson, Kendall & Roberts (1971)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.jkr``."""
    from contactlab_laws.jkr.law import JohnsonKendallRoberts

    return JohnsonKendallRoberts
