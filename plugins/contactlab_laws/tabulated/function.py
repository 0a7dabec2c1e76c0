"""``rebound``: the table up to chi = 2.5, the exact solution beyond."""

from __future__ import annotations

import math
from functools import cache
from typing import Literal, overload

import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.checks import POSITIVE, paired, real, refuse
from contactlab_laws.tabulated import evaluate
from contactlab_laws.tabulated.coordinates import LARGEST_CHI
from contactlab_laws.tabulated.derivatives import gradient
from contactlab_laws.tabulated.scalar import ScalarTable
from contactlab_laws.tabulated.table import SHIPPED, Table, read

Array = NDArray[np.float64]
Real = float | Array

#: Fewer impacts than this are computed one by one: 6 us each, where arrays begin at 220 us.
FEW = 40


@cache
def shipped() -> Table:
    """Return the table that came with the package."""
    return read(SHIPPED)


@cache
def _scalars() -> ScalarTable:
    return ScalarTable(shipped())


@overload
def rebound(psi1: object, chi: object, *, derivatives: Literal[False] = False) -> Real: ...
@overload
def rebound(
    psi1: object, chi: object, *, derivatives: Literal[True]
) -> tuple[Real, Real, Real]: ...
def rebound(
    psi1: object, chi: object, *, derivatives: bool = False
) -> Real | tuple[Real, Real, Real]:
    """Return the tangential rebound psi2 of elastic spheres.

    Parameters
    ----------
    psi1 : float or array_like
        Non-dimensional angle of incidence, eq. (29) of [1]_; any sign and size.
    chi : float or array_like
        Eq. (38), broadcast against ``psi1``; positive. Up to 2.5 from the table, to 1e-9 of
        max(1, |psi1|); beyond by the exact solution of many impacts, to the same.
    derivatives : bool
        Whether d psi2/d psi1 and d psi2/d chi are wanted too, to 1e-6, for chi up to 2.5. Just
        above psi1 = 1 (by less than 3e-5) and for chi from 1.83 to 1.92 d psi2/d psi1 is known
        to 5e-5 only: there slip changes sign again and again, and what that does to psi2 is 1e-10.

    Returns
    -------
    psi2 : float or ndarray
        Odd in psi1 to the last bit, |psi2| <= |psi1|. With ``derivatives`` a tuple
        (psi2, d psi2/d psi1, d psi2/d chi).

    Raises
    ------
    ValueError
        For bad input, or a table file that is damaged.

    References
    ----------
    .. [1] Maw, Barber & Fawcett, Wear 38 (1976) 101-114, doi:10.1016/0043-1648(76)90201-5.
    """
    if type(psi1) is float and type(chi) is float and not derivatives:
        speed = abs(psi1)
        if 0.0 < chi <= LARGEST_CHI and speed < math.inf:
            psi2 = _scalars().rebound(speed, chi)
            return psi2 if psi1 >= 0.0 else -psi2
    return _any(psi1, chi, derivatives)


@np.errstate(under="ignore")  # small numbers may vanish, whatever a user has asked for
def _any(psi1: object, chi: object, derivatives: bool) -> Real | tuple[Real, Real, Real]:
    """Return what ``rebound`` returns, for anything."""
    incidence = real(
        "psi1", psi1, remedy="give the non-dimensional angle of incidence (29)", kept=False
    )
    inertia = real(
        "chi", chi, rule=POSITIVE, remedy="chi of eq. (38); 1.4412 for a steel sphere", kept=False
    )
    velocity, ratio = paired("psi1", "chi", (incidence, inertia))
    shape, velocity, ratio = velocity.shape, velocity.ravel(), ratio.ravel()
    if derivatives and not (ratio <= LARGEST_CHI).all():
        rule = f"derivatives are tabulated up to chi = {LARGEST_CHI}"
        raise refuse("chi", float(ratio.max()), rule, "take differences of psi2 beyond")
    psi2 = _shaped(_signed(velocity, ratio), shape)
    if not derivatives:
        return psi2
    by_psi1, by_chi = gradient(shipped(), np.abs(velocity), ratio)
    by_chi *= np.copysign(1.0, velocity)
    return psi2, _shaped(by_psi1, shape), _shaped(by_chi, shape)


def _shaped(values: Array, shape: tuple[int, ...]) -> Real:
    return values.reshape(shape) if shape else float(values[0])


def _signed(psi1: Array, chi: Array) -> Array:
    """Return psi2, shape (impacts,)."""
    tabulated = chi <= LARGEST_CHI
    if tabulated.all():
        psi2 = _tabulated(np.abs(psi1), chi)
        return np.negative(psi2, out=psi2, where=psi1 < 0.0)
    from contactlab_laws.tabulated.exact import together  # no law before it is needed

    psi2 = np.empty_like(psi1)
    psi2[tabulated] = _signed(psi1[tabulated], chi[tabulated])
    beyond = ~tabulated
    psi2[beyond] = np.copysign(1.0, psi1[beyond]) * together(np.abs(psi1[beyond]), chi[beyond])
    return psi2


def _tabulated(speed: Array, chi: Array) -> Array:
    if speed.size >= FEW:
        return evaluate.rebound(shipped(), speed, chi)
    one = _scalars().rebound
    return np.array([one(*pair) for pair in zip(speed.tolist(), chi.tolist(), strict=True)])
