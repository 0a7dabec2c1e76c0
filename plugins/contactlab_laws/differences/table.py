"""Cautions with sizes from ``differences.csv``, which ``table_builders.differences`` measures."""

from __future__ import annotations

import csv
import math
import re
from decimal import ROUND_CEILING, Decimal
from functools import cache
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contactlab.contracts.law import Law
from contactlab.contracts.motion import NormalMotion
from contactlab.impact import kinetics
from contactlab.impact.cautions import OUTSIDE
from contactlab.impact.scene import Scene
from contactlab.numeric.types import Mask, Real

FILE = Path(__file__).with_name("differences.csv")
#: Differences of psi2 below this are not worth a sentence.
LEAST = 1e-3
#: Laws whose least restitution in the table is at most this take any restitution, as Tsuji's does.
SPANNED = 0.1
#: Restitutions in the table are rounded to this.
ROUNDED = 1e-5
#: Factor on the sizes in cautions, which are then rounded up to one digit: between the measured
#: impacts and restitutions the differences are up to 5 % larger than at them.
BETWEEN = 1.1
#: The same for springs: beside the measured psi1 and chi their error is up to a half larger.
AROUND = 1.6
#: The impacts that were measured, for the choice of a law.
CHI = (0.8, 1.8)
#: chi at which the error of springs was measured, each over all psi1.
NODES = (0.05, 0.1, 0.2, 0.4, 0.8, 1.2, 1.8, 2.5, 3.5, 5.0, 7.0, 10.0)


class Row(NamedTuple):
    """Largest differences of psi2 under one normal law at one restitution.

    Attributes
    ----------
    restitution : float
    choice : float
        Between this normal law and Tsuji's of the same restitution, with elastic shear.
    shared : float
        The same where shear shares the loss of viscous normal laws.
    springs : tuple of float
        Between independent springs and Coulomb's law at every point, at the chi of ``NODES``.
    """

    restitution: float
    choice: float
    shared: float
    springs: tuple[float, ...]


def key(law: Law) -> str:
    """Return the name of a normal law in the table: the module of the model, and the class."""
    return f"{type(law).__module__}.{type(law).__qualname__}".replace(".law.", ".")


def _name_law(law: str) -> str:
    """Return the name of a law by that of its class: ``kuwabara_kono`` for ``KuwabaraKono``."""
    return re.sub(r"(?<=[a-z])(?=[A-Z])", "_", law).lower()


@cache
def rows() -> dict[str, tuple[Row, ...]]:
    """Return the rows of each normal law, in ascending restitution."""
    table: dict[str, list[Row]] = {}
    with FILE.open(encoding="utf-8", newline="") as file:
        for law, *numbers in list(csv.reader(file))[1:]:
            e, choice, shared, *springs = map(float, numbers)
            row = Row(e, choice, shared, tuple(springs))
            table.setdefault(law.replace(".law.", "."), []).append(row)
    return {law: tuple(sorted(each)) for law, each in table.items()}


def springs(scene: Scene, normal: NormalMotion, *, part: str = "spring") -> tuple[str, ...]:
    """Return the caution that separately limited parts are not Coulomb's law, with its size."""
    if "elastic_hertz" in normal.claims or not kinetics.rubs(scene):
        return ()
    own, e, chi = rows().get(key(normal.law)), _restitution(normal), np.asarray(scene.chi)
    beyond = np.min(chi) < NODES[0] or np.max(chi) > NODES[-1]
    if own is None or not np.all(_within(e, own)) or beyond:
        told = f"psi2 is off by an amount {OUTSIDE}"
    else:
        size = _by_springs(own, e, chi)
        if not size >= LEAST:
            return ()
        told = f"psi2 is off by up to {_above(size, AROUND)}"
    name = _name_law(type(normal.law).__name__)
    return (
        f"model: under {name} each {part} is limited separately, which "
        f"violates Coulomb's law locally; {told}. annulus has the right limit.",
    )


def _within(e: Real, rows: tuple[Row, ...]) -> Mask:
    """Return which restitutions lie within those of a law's rows."""
    least, most = rows[0].restitution - ROUNDED, rows[-1].restitution + ROUNDED
    within: Mask = (np.asarray(e) >= least) & (np.asarray(e) <= most)
    return within


def _by_springs(measured: tuple[Row, ...], e: Real, chi: Real) -> float:
    """Return the largest error of springs at the measured e and chi next to the impacts' own."""
    sizes = np.array([row.springs for row in measured])
    known = np.array([row.restitution for row in measured])
    largest = 0.0
    for value, ratio in np.unique(np.stack(np.broadcast_arrays(e, chi)).reshape(2, -1), axis=1).T:
        low, left = np.searchsorted(known, value, "right") - 1, np.searchsorted(NODES, ratio) - 1
        around = sizes[max(low, 0) : low + 2, max(left, 0) : left + 2]
        largest = max(largest, float(around.max(initial=0.0)))
    return largest


def choice(scene: Scene, normal: NormalMotion, *, shared: bool = False) -> tuple[str, ...]:
    """Return the caution that another normal law of the same e moves psi2, with its size.

    ``shared`` is True if shear shares the loss of viscous normal laws.
    """
    if not kinetics.rubs(scene):
        return ()
    measured, own = rows(), key(normal.law)
    if own not in measured or "elastic_hertz" in normal.claims:
        return ()
    e, chi = _restitution(normal), np.asarray(scene.chi)
    if np.all(e == 1.0) and own.endswith(".Tsuji"):
        return ()  # no damping: Hertz's motion
    known = _within(e, measured[own]) & (chi >= CHI[0]) & (chi <= CHI[1])
    shear = "With damped shear" if shared else "With elastic shear"
    head = f"model: psi2 depends on the damping law, not only on e. {shear} other laws of this e "
    e = np.where(known, e, math.nan)
    if not np.any(known):
        ends = f"chi from {CHI[0]:g} to {CHI[1]:g}"
        return (f"{head}change psi2 by an amount {OUTSIDE} ({ends}).",)
    if own.endswith(".Tsuji"):
        sizes = {
            law.rpartition(".")[2]: _largest(e, each, shared)
            for law, each in measured.items()
            if law != own and each[0].restitution <= SPANNED
        }
        least, most = (pick(sizes, key=sizes.__getitem__) for pick in (min, max))
        size_text = (
            f"{_above(sizes[least])} ({_name_law(least)}) to "
            f"{_above(sizes[most])} ({_name_law(most)})"
        )
    else:
        size = _largest(e, measured[own], shared)
        if not size >= LEAST:
            return ()
        size_text = f"{_above(size)} (tsuji)"
    others = "" if np.all(known) else f"; some impacts are {OUTSIDE}"
    return (f"{head}change psi2 by up to {size_text}{others}.",)


def _above(size: float, factor: float = BETWEEN) -> str:
    """Return ``factor`` times a size, rounded up to one digit."""
    above = Decimal(factor * size)
    digit = above.quantize(Decimal(1).scaleb(above.adjusted()), ROUND_CEILING)
    return f"{float(digit):.1g}"


def _largest(e: Real, measured: tuple[Row, ...], shared: bool) -> float:
    """Return the largest difference from Tsuji's law, interpolated in the restitution."""
    tabulated = [row.restitution for row in measured]
    largest = [row.shared if shared else row.choice for row in measured]
    sizes = np.interp(e, tabulated, largest)
    return float(np.nanmax(sizes)) if np.isfinite(sizes).any() else 0.0


def _restitution(normal: NormalMotion) -> Real:
    """Return e of each impact."""
    e: Real = -np.asarray(normal.final_rate) / np.asarray(normal.scene.normal_speed)
    return e
