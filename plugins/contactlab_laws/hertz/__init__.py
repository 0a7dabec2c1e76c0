"""Hertz's normal contact, the paper's eqs (2)-(9)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.hertz``."""
    from contactlab_laws.hertz.law import Hertz

    return Hertz
