"""Viscoelastic spheres, Kuwabara & Kono (1987), Brilliantov et al. (1996)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.kuwabara_kono``."""
    from contactlab_laws.kuwabara_kono.law import KuwabaraKono

    return KuwabaraKono
