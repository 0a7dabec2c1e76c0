"""The three-dimensional elastic half-space on rings and angles."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.halfspace``."""
    from contactlab_laws.halfspace.law import HalfSpace

    return HalfSpace
