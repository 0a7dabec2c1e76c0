"""Integration along smooth phases, with the events between them located."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``integrator.events``."""
    from contactlab_laws.events.law import Events

    return Events
