"""Linear loading and stiffer unloading, Walton & Braun (1986)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.walton_braun``."""
    from contactlab_laws.walton_braun.law import WaltonBraun

    return WaltonBraun
