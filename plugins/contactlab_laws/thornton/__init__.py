"""Elastic, perfectly plastic spheres, Thornton (1997)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.thornton``."""
    from contactlab_laws.thornton.law import Thornton

    return Thornton
