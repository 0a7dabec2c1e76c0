"""One impact from the table, in plain floats: NumPy takes longer to begin than this to end."""

from __future__ import annotations

import math
from collections.abc import Sequence

from contactlab_laws.tabulated.coordinates import (
    CUT_END,
    CUT_TOP,
    LARGEST_CHI,
    SLIP_BACK,
    SLIP_LATE,
    SLIP_LONG,
    SLIP_ON,
    SMALL_FAR,
    SMALL_NEAR,
    STUCK_BACK,
    STUCK_ON,
)
from contactlab_laws.tabulated.polynomials import polynomials_of
from contactlab_laws.tabulated.table import DEEPEST, Table

#: Twelve terms of one row.
Row = tuple[float, ...]
SIZE = 1 << DEEPEST


class ScalarTable:
    """A table in lists and tuples.

    Parameters
    ----------
    table : Table
    """

    def __init__(self, table: Table) -> None:
        self.stuck: list[float] = table.cuts.stuck[::-1].tolist()
        self.slip: list[float] = table.cuts.slip[::-1].tolist()
        polynomials = polynomials_of(table)
        self.grid: list[int] = polynomials.grid.tolist()
        self.corners: list[list[float]] = polynomials.corners.T.tolist()
        # rows from the highest power of x down, terms from the lowest power of y up
        self.rows: list[tuple[Row, ...]] = [
            tuple(map(tuple, terms[count - 1 :: -1].tolist()))
            for terms, count in zip(polynomials.terms, polynomials.needed[0], strict=True)
        ]

    def rebound(self, speed: float, chi: float) -> float:
        """Return psi2 for psi1 = speed >= 0 and 0 < chi <= LARGEST_CHI."""
        full = speed - 4.0 * chi
        if speed > 1.0:
            if speed >= 4.0 * chi - 1.0:
                return full
            measure = 2.0 * chi - 1.0
            region, a, b = self._slips_first((speed - 1.0) / measure, chi)
        elif chi >= 0.5:
            measure = 2.0 * chi - 1.0
            region, a, b = self._sticks_first(speed, chi)
        else:
            measure, epsilon = 1.0 - speed, 1.0 - 2.0 * chi
            if measure < epsilon:
                region, a, b = SMALL_NEAR, (measure / epsilon) ** 0.2, epsilon
                measure = epsilon
            else:
                region, a, b = SMALL_FAR, epsilon / measure, measure
        psi2 = speed * (measure * self._patch(region, a, b) - 1.0)
        return max(min(max(psi2, full), speed), -speed)

    def _sticks_first(self, speed: float, chi: float) -> tuple[int, float, float]:
        cut = _horner(self.stuck, speed)
        if chi >= cut:
            return STUCK_ON, speed, math.sqrt((chi - cut) / (LARGEST_CHI - cut))
        return STUCK_BACK, speed, (chi - 0.5) / (cut - 0.5)

    def _slips_first(self, ratio: float, chi: float) -> tuple[int, float, float]:
        height = (chi - 0.5) * (1.0 / (LARGEST_CHI - 0.5))
        if ratio > 1.0:
            return SLIP_LATE, ratio - 1.0, height
        t = ratio**0.2
        if t > CUT_END:
            return SLIP_LONG, (t - CUT_END) * (1.0 / (1.0 - CUT_END)), height
        cut = _horner(self.slip, t)
        t *= 1.0 / CUT_END
        if chi >= cut:
            return SLIP_ON, t, math.sqrt((chi - cut) / (CUT_TOP - cut))
        return SLIP_BACK, t, (chi - 0.5) / (cut - 0.5)

    def _patch(self, region: int, a: float, b: float) -> float:
        """Return g at a place."""
        i, j = min(int(a * SIZE), SIZE - 1), min(int(b * SIZE), SIZE - 1)
        patch = self.grid[(region * SIZE + i) * SIZE + j]
        left, low = self.corners[patch]
        x, y = a - left, b - low
        total = 0.0
        for c0, c1, c2, c3, c4, c5, c6, c7, c8, c9, c10, c11 in self.rows[patch]:
            upper = ((((c11 * y + c10) * y + c9) * y + c8) * y + c7) * y + c6
            row = (((((upper * y + c5) * y + c4) * y + c3) * y + c2) * y + c1) * y + c0
            total = total * x + row
        return total


def _horner(terms: Sequence[float], argument: float) -> float:
    """Return a polynomial, its terms from the highest down."""
    total = 0.0
    for term in terms:
        total = total * argument + term
    return total
