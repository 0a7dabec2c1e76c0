"""Checks of laws that claim to be rigid or without friction."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from contactlab.contracts import TangentialLaw
from contactlab.impact.hertz import rigid_body_rebound
from contactlab.numeric.types import Real
from contactlab.testing.check import check, hold
from contactlab.testing.ways import meet, ways

#: Rounding of psi2, over max(1, psi1).
ROUNDING = 1e-9
PSI1 = (0.0, 0.3, 1.2, -2.0, 4.5, 30.0)
CHI = (0.3, 1.4412, 3.0)


@check(TangentialLaw, claim="rigid")
def rigid_body(law: TangentialLaw) -> None:
    """Impacts end as rigid bodies do: abs(psi) falls by 4 chi, or to zero (theory §2)."""
    _ends(law, rigid_body_rebound)


@check(TangentialLaw, claim="no_friction")
def no_friction(law: TangentialLaw) -> None:
    """Impacts do not change the slip velocity."""
    _ends(law, lambda psi1, _: psi1)


def _ends(law: TangentialLaw, expected: Callable[[float, float], Real]) -> None:
    """Hold that psi2 of elastic impacts is ``expected(psi1, chi)``."""
    for way in ways(law):
        for chi in CHI:
            for psi1 in PSI1:
                psi2 = psi1 + meet(way, psi1, chi)[0]
                error = abs(psi2 - float(np.asarray(expected(psi1, chi))))
                sentence = f"psi1 = {psi1}, chi = {chi}: psi2 is {error:.2g} off ({way})."
                hold(error <= ROUNDING * max(1.0, abs(psi1)), sentence)
