"""Partial slip by a bundle of springs, the continuum limit of the paper's annuli."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.springs``."""
    from contactlab_laws.springs.law import Springs

    return Springs
