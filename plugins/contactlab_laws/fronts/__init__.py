"""The paper's model in its continuum limit, solved by following the front of slip."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.fronts``."""
    from contactlab_laws.fronts.law import Fronts

    return Fronts
