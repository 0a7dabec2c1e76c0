"""The Mindlin spring with Coulomb cap of discrete-element codes."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.mindlin_cap``."""
    from contactlab_laws.mindlin.law import MindlinCap

    return MindlinCap
