"""The rebound of elastic spheres as a special function: psi2 from psi1 and chi, by table."""

from contactlab_tabulated.function import rebound

__all__ = ["rebound"]
