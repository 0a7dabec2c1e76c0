"""The rebound of spheres that lose energy, by Tsuji's law: psi2 from psi1, chi and e, by table."""

from contactlab_laws.damped_table.function import rebound

__all__ = ["rebound"]
