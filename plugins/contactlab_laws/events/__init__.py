"""Paths from event to event, in scaled units, of laws that know theirs."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``integrator.events``."""
    from contactlab_laws.events.law import Events

    return Events
