"""Friction of rigid bodies: Coulomb's law with rolling, and no friction at all."""

import contactlab


@contactlab.hookimpl
def contactlab_law(name: str) -> type:
    """Return the class of ``tangential.coulomb`` or ``tangential.frictionless``."""
    from contactlab_laws.coulomb.law import Coulomb, Frictionless

    return {"tangential.coulomb": Coulomb, "tangential.frictionless": Frictionless}[name]
