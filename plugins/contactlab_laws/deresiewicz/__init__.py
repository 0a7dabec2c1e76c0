"""Mindlin and Deresiewicz's partial slip, increment by increment, with turning points."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.mindlin_deresiewicz``."""
    from contactlab_laws.deresiewicz.law import MindlinDeresiewicz

    return MindlinDeresiewicz
