"""Cautions with sizes from ``differences.csv``, which ``table_builders.damped`` measures."""

from __future__ import annotations

import csv
from decimal import ROUND_CEILING, Decimal
from functools import cache
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np

from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.impact.scene import Scene

FILE = Path(__file__).with_name("differences.csv")
#: Differences of psi2 below this are not worth a sentence.
LEAST = 1e-3
#: Laws whose least restitution in the table is at most this take any restitution, as Tsuji's does.
SPANNED = 0.1
#: Factor on the sizes in cautions, which are then rounded up to one digit: between the measured
#: impacts and restitutions the differences are up to 5 % larger than at them.
BETWEEN = 1.1
#: The impacts that were measured.
MEASURED = "measured for chi 0.8 to 1.8"


class Row(NamedTuple):
    """Largest differences of psi2 under one normal law at one restitution.

    Attributes
    ----------
    restitution : float
    springs : float
        Between independent springs and Coulomb's law at every point.
    choice : float
        Between this normal law and Tsuji's of the same restitution.
    """

    restitution: float
    springs: float
    choice: float


def key(law: Law) -> str:
    """Return the name of a normal law in the table: the module of the model, and the class."""
    return f"{type(law).__module__}.{type(law).__qualname__}".replace(".law.", ".")


@cache
def rows() -> dict[str, tuple[Row, ...]]:
    """Return the rows of each normal law, in ascending restitution."""
    table: dict[str, list[Row]] = {}
    with FILE.open(encoding="utf-8", newline="") as file:
        for law, *numbers in list(csv.reader(file))[1:]:
            table.setdefault(law.replace(".law.", "."), []).append(Row(*map(float, numbers)))
    return {law: tuple(sorted(each)) for law, each in table.items()}


def springs(scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution that separately limited springs are not Coulomb's law, with its size."""
    if "elastic_hertz" in normal.offers or not _rubs(scene):
        return ()
    measured = rows()
    own = measured.get(key(normal.law))
    laws = measured.values() if own is None else (own,)
    size = max((_largest(normal, each, "springs") for each in laws), default=0.0)
    if not size >= LEAST:
        return ()
    scope = ", of other normal laws of this restitution" if own is None else ""
    return (
        "each spring is limited separately, which is not Coulomb's law at every point under this "
        f"normal law: psi2 is off by up to {_above(size)} ({MEASURED}{scope}; model, not numerical "
        "error); tangential.annulus has the right limit",
    )


def choice(scene: Scene, normal: NormalMotion) -> tuple[str, ...]:
    """Return the caution that another normal law of the same e moves psi2, with its size."""
    if not _rubs(scene):
        return ()
    measured, own = rows(), key(normal.law)
    if own not in measured or "elastic_hertz" in normal.offers:
        return ()
    if own.endswith(".Tsuji"):
        if np.all(_restitution(normal) == 1.0):
            return ()  # no damping: Hertz's motion
        sizes = {
            law.rpartition(".")[2]: _largest(normal, each, "choice")
            for law, each in measured.items()
            if law != own and each[0].restitution <= SPANNED
        }
        least, most = (pick(sizes, key=sizes.__getitem__) for pick in (min, max))
        size_text = f"{_above(sizes[least])} ({least}) to {_above(sizes[most])} ({most})"
    else:
        size = _largest(normal, measured[own], "choice")
        if not size >= LEAST:
            return ()
        size_text = f"{_above(size)} (Tsuji)"
    return (
        "the restitution alone does not decide psi2: under partial slip other normal laws of the "
        f"same restitution move psi2 by up to {size_text} ({MEASURED}; model, not numerical error)",
    )


def _above(size: float) -> str:
    """Return ``BETWEEN`` times a size, rounded up to one digit."""
    above = Decimal(BETWEEN * size)
    digit = above.quantize(Decimal(1).scaleb(above.adjusted()), ROUND_CEILING)
    return f"{float(digit):.1g}"


def _rubs(scene: Scene) -> bool:
    """Return whether any impact has friction and slip velocity."""
    slip: Any = scene.slip_velocity
    friction: Any = scene.friction_coefficient
    return bool(np.any((slip != 0.0) & (friction != 0.0)))


def _largest(normal: NormalMotion, measured: tuple[Row, ...], column: str) -> float:
    """Return the largest difference over the impacts, interpolated in their restitution."""
    e = _restitution(normal)
    tabulated = [row.restitution for row in measured]
    sizes = np.interp(e, tabulated, [getattr(row, column) for row in measured])
    return float(np.nanmax(sizes)) if np.isfinite(sizes).any() else 0.0


def _restitution(normal: NormalMotion) -> Any:
    """Return e of each impact."""
    return -np.asarray(normal.final_rate) / np.asarray(normal.scene.normal_speed)
