"""Adhesion of stiff spheres, Derjaguin, Muller & Toporov (1975)."""

import contactlab


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``normal.dmt``."""
    from contactlab_laws.dmt.law import DerjaguinMullerToporov

    return DerjaguinMullerToporov
