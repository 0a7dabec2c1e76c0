"""Stronge's lumped compliance: a contact of two springs, in closed form."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.stronge``."""
    from contactlab_laws.stronge.law import Stronge

    return Stronge
