"""Units that people write, and the factors to those in which numbers are computed."""

from __future__ import annotations

import math

#: Factors from the unit that is written to the unit of a quantity.
CONVERSIONS = {
    ("rad", "deg"): math.degrees(1.0), ("deg", "rad"): math.radians(1.0),
    ("mm/s", "m/s"): 1e-3, ("cm/s", "m/s"): 1e-2, ("mm", "m"): 1e-3, ("g", "kg"): 1e-3,
    ("km/h", "m/s"): 1.0 / 3.6, ("mph", "m/s"): 0.44704, ("ft/s", "m/s"): 0.3048,
    ("cm", "m"): 1e-2, ("in", "m"): 0.0254, ("ft", "m"): 0.3048,
    ("oz", "kg"): 0.028349523125, ("lb", "kg"): 0.45359237,
    ("rpm", "rad/s"): 2.0 * math.pi / 60.0, ("rev/s", "rad/s"): 2.0 * math.pi,
    ("1/min", "rad/s"): 2.0 * math.pi / 60.0, ("deg/s", "rad/s"): math.radians(1.0),
    ("ms", "s"): 1e-3, ("µs", "s"): 1e-6, ("us", "s"): 1e-6,
    ("kPa", "Pa"): 1e3, ("MPa", "Pa"): 1e6, ("GPa", "Pa"): 1e9, ("g/cm³", "kg/m³"): 1e3,
}  # fmt: skip
#: Other ways to write a unit.
SAME_UNITS = {
    "°": "deg", "degrees": "deg", "degree": "deg", "-": "1", "°/s": "deg/s", "dps": "deg/s",
    "mps": "m/s", "kph": "km/h", "kmh": "km/h", "fps": "ft/s", "inch": "in", "inches": "in",
    "rps": "rev/s", "r/min": "rpm", "kg/m3": "kg/m³", "kg/m^3": "kg/m³", "g/cm3": "g/cm³",
    "g/cm^3": "g/cm³",
}  # fmt: skip


def factor(unit: str, own: str) -> float | None:
    """Return the factor from a unit to that of a quantity; None if it measures another one."""
    return 1.0 if unit == own else CONVERSIONS.get((unit, own))


def convertible(own: str) -> str:
    """Return the units that convert to ``own``, as ``m, mm, cm, in or ft``."""
    *units, last = own, *(unit for unit, to in CONVERSIONS if to == own)
    return f"{', '.join(units)} or {last}" if units else last
