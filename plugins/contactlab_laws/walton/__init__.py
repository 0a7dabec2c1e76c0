"""Walton's three-parameter law of hard spheres."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.walton``."""
    from contactlab_laws.walton.law import Walton

    return Walton
