"""An integrator that chooses its own steps, for any laws."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``integrator.adaptive``."""
    from contactlab_adaptive.adaptive import Adaptive

    return Adaptive
