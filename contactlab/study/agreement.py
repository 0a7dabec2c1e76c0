"""One law's answer to a scene, and its distance from measured values."""

from __future__ import annotations

import math
from collections.abc import Mapping

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Status
from contactlab.numeric.types import Array
from contactlab.outcome.columns import QUANTITIES, find_quantity
from contactlab.outcome.result import ImpactResult
from contactlab.scene_file import Measured

#: Factor between mean squares from which the other sign is believed.
MUCH_NEARER = 4.0


@attrs.frozen(kw_only=True, eq=False)
class LawRun:
    """One law's answer to the scene or sweep.

    Attributes
    ----------
    name : str
    result : ImpactResult
    run_time_per_impact : float
        Least wall-clock time of the repeats, over the number of impacts, in s.
    model : str
        What the law takes the bodies for: ``"rigid"``; ``"elastic"`` for a law that converges to
        the elastic continuum; ``"exact"`` if it also declares an error of psi2 below ``EXACT``;
        else empty.
    """

    name: str
    result: ImpactResult
    run_time_per_impact: float = attrs.field(metadata={"unit": "s"})
    model: str = ""


@attrs.frozen(kw_only=True, eq=False)
class Agreement:
    """One measured series, and the results of each law at the measured points.

    Attributes
    ----------
    measured : Measured
    results : mapping of str to ImpactResult
        By law, batches of n impacts.
    """

    measured: Measured
    results: Mapping[str, ImpactResult]

    @property
    def unit(self) -> str:
        """Unit of the quantity; "1" if the scene has no units."""
        scene = next(iter(self.results.values())).scene
        return QUANTITIES[self.measured.quantity].unit_in(scene)

    @property
    def predicted(self) -> dict[str, Array]:
        """Values by law, shape (n,), in the quantity's unit; NaN where an impact failed."""
        quantity = self.measured.quantity
        return {law: values_of(quantity, result) for law, result in self.results.items()}

    def difference(self, law: str) -> Array:
        """Return predicted less measured values, shape (n,)."""
        return self.predicted[law] - self.measured.values

    @property
    def defined(self) -> NDArray[np.bool_]:
        """True where the quantity is defined, shape (n,), even if a law failed there.

        The tangential restitution is undefined without tangential velocity.
        """
        known = np.zeros(len(self.measured.values), dtype=bool)
        failed = np.ones_like(known)
        for law, values in self.predicted.items():
            known |= ~np.isnan(values)
            failed &= np.asarray(self.results[law].status, dtype=object) != Status.SUCCESS
        return known | failed

    def _off(self, law: str) -> Array:
        """Return the absolute differences where the quantity has a number."""
        return np.abs(self.difference(law))[self.defined]

    @property
    def opposite(self) -> str:
        """Sentence on measured values that are opposite in sign to every law's; else empty."""
        defined = self.defined
        measured = self.measured.values[defined]
        for predicted in self.predicted.values():
            values = predicted[defined]
            wrong, right = values + measured, values - measured
            if not np.mean(wrong**2) * MUCH_NEARER < np.mean(right**2):
                return ""
        name = self.measured.quantity
        return (
            f"{name} looks as if of the opposite sign: its numbers turned are nearer to every law "
            f"(--column HEADING=-{name} turns it)"
        )

    def rms(self, law: str) -> float:
        """Return the root mean square difference; NaN if no point has a number."""
        off = self._off(law)
        return float(np.sqrt(np.mean(off**2))) if off.size else math.nan

    def largest(self, law: str) -> float:
        """Return the largest absolute difference; NaN if no point has a number."""
        return float(np.max(self._off(law))) if self.defined.any() else math.nan

    def where_largest(self, law: str) -> float:
        """Return the x of the largest absolute difference; NaN if a value is missing."""
        off = self._off(law)
        if np.isnan(off).any() or not off.size:
            return math.nan
        return float(self.measured.x[self.defined][np.argmax(off)])


def by_rms(rms: Mapping[str, float]) -> list[str]:
    """Return the names of laws by their rms; NaN comes last."""
    return sorted(rms, key=lambda law: (math.isnan(rms[law]), rms[law]))


def values_of(quantity: str, result: ImpactResult) -> Array:
    """Return a quantity of a result, with NaN for impacts that failed."""
    good = np.asarray(result.status, dtype=object) == Status.SUCCESS
    return np.where(good, find_quantity(quantity).of(result), np.nan)
