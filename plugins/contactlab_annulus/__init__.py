"""Partial slip by concentric annuli, the paper's eqs (1), (13)-(18), (22)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.annulus``."""
    from contactlab_annulus.law import Annulus

    return Annulus
