"""A law in other units: parameters that have a unit are converted."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from typing import NamedTuple, TypeVar

import attrs

from contactlab.contracts import Law
from contactlab.testing.check import hold


class Units(NamedTuple):
    """The values of one metre, one second and one kilogram in other units."""

    length: float = 1.0
    time: float = 1.0
    mass: float = 1.0


#: Not powers of two, nor of each other, so that rounding and wrong dimensions show.
ODD_UNITS = Units(7.3, 0.0137, 41.1)
#: Powers of length, time and mass in the units of parameters.
POWERS = {
    "1": (0, 0, 0), "rad": (0, 0, 0), "m": (1, 0, 0), "s": (0, 1, 0), "kg": (0, 0, 1),
    "N": (1, -2, 1), "Pa": (-1, -2, 1), "J": (2, -2, 1), "W": (2, -3, 1), "Hz": (0, -1, 0),
}  # fmt: skip
_TOKEN = re.compile(r"([A-Za-z]+|1)(?:\^(-?\d+(?:\.\d+)?))?")


SameLaw = TypeVar("SameLaw", bound=Law)


def in_units(law: SameLaw, units: Units) -> SameLaw:
    """Return ``law`` with its parameters in ``units``.

    The metadata of a field states its unit, as ``contactlab.numeric.checks.quantity`` writes it:
    products with a space, one quotient, powers with ^, as in "N s/m", "m/s" or "N/m^1.5".

    Raises
    ------
    CheckFailedError
        If a unit is not understood.
    """
    kind: type[object] = type(law)
    if not attrs.has(kind):
        return law
    changed = {}
    for field in attrs.fields(kind):
        value, unit = getattr(law, field.name), field.metadata.get("unit", "")
        if field.init and unit not in ("", "1") and isinstance(value, float):
            changed[field.name] = value * factor(unit, units)
    return with_parameters(law, changed) if changed else law


def with_parameters(law: SameLaw, values: Mapping[str, object]) -> SameLaw:
    """Return a law with other values of some parameters; ValueError if the law refuses one."""
    evolve: Callable[..., SameLaw] = attrs.evolve  # not every law is an attrs class to a checker
    return evolve(law, **values)


def factor(unit: str, units: Units) -> float:
    """Return the value of one ``unit`` in ``units``."""
    product = 1.0
    for part, sense in zip(unit.split("/"), (1.0, -1.0), strict=False):
        for token in part.split():
            match = _TOKEN.fullmatch(token)
            understood = match is not None and match[1] in POWERS and unit.count("/") <= 1
            hold(understood, f"The unit {unit!r} is not understood: write SI, as in 'N s/m'.")
            assert match is not None
            for size, power in zip(units, POWERS[match[1]], strict=True):
                product *= size ** (sense * power * float(match[2] or 1.0))
    return product
