"""Partial slip by concentric annuli, the paper's eqs (1), (13)-(18), (22)."""

import contactlab


@contactlab.hookimpl
def contactlab_law(name: str) -> type:
    """Return the class of ``tangential.annulus`` or ``tangential.sharp_annulus``."""
    if name == "tangential.sharp_annulus":
        from contactlab_laws.annulus.sharp import SharpAnnulus

        return SharpAnnulus
    from contactlab_laws.annulus.law import Annulus

    return Annulus
