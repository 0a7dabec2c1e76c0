"""The rebound of elastic spheres as a special function: psi2 from psi1 and chi, by table."""

import contactlab
from contactlab_laws.tabulated.function import rebound

__all__ = ["rebound"]


@contactlab.hookimpl
def contactlab_law() -> type:
    """Return the class of ``tangential.tabulated``."""
    from contactlab_laws.tabulated.law import Tabulated

    return Tabulated
