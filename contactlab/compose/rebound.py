"""psi2 for arrays of (psi1, chi), without scenes, plans and energy books."""

from __future__ import annotations

import math
import os
from collections.abc import Callable
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, overload

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.compose.names import BLOCK_VARIABLE
from contactlab.contracts.restitution import RESTITUTIONS
from contactlab.numeric.checks import POSITIVE, Real, Rule, paired, real, refuse

if TYPE_CHECKING:
    from contactlab.compose.simulation import Simulation
    from contactlab.contracts.whole_impact import Tabulated

Array = NDArray[np.float64]

#: Range of chi in the table of restitutions.
RESTITUTED_CHI = (0.3, 3.0)
#: Largest chi of the law for a restitution below 1; the range of chi and the least restitution of
#: its table, and the largest errors of psi2 in the table and outside, against Coulomb's law at
#: every point: ``tests/laws/test_damped_table.py``.
DAMPED_LARGEST_CHI = 10.0
DAMPED_CHI, DAMPED_RESTITUTION = (0.8, 1.8), 0.5
DAMPED_ERROR, BEYOND_ERROR = 1e-3, 4e-3
#: Number of annuli beyond the largest chi; the steps are four times as many.
ANNULI = 100
#: The table answers up to this chi and for tolerances above this: it holds psi2 to 1e-9.
TABULATED_CHI, TABULATED = 2.5, 1e-9
#: Tolerance of every solution: an answer in an array then equals a single one to 1e-10.
EXACT = 1e-9
TOLERANCE = Rule(
    lambda value: (value >= 1e-9) & (value < 1.0), "must lie between 1e-9 and 1, of max(1, |psi1|)"
)
LARGEST_CHI = 1e4
CHI = Rule(
    lambda value: POSITIVE.holds(value) & (value <= LARGEST_CHI),
    "must be positive and at most 1e4, the range over which answers were checked",
)
#: From this psi1 on every impact with chi in range slips throughout, and psi falls by 4 chi.
SLIPS_THROUGHOUT = 1e5


#: Defaults of ``tolerance`` and ``restitution``, tested by identity: a comparison takes long.
USUAL, ELASTIC = 1e-5, 1.0
#: Arrays that are looked at number by number: NumPy takes longer to begin.
FEW_NUMBERS = 40


@overload
def rebound(
    psi1: object,
    chi: object,
    *,
    tolerance: float = USUAL,
    derivatives: Literal[False] = False,
    restitution: Real = ELASTIC,
) -> Real: ...
@overload
def rebound(
    psi1: object, chi: object, *, tolerance: float = USUAL, derivatives: Literal[True]
) -> tuple[Real, Real, Real]: ...
def rebound(
    psi1: object,
    chi: object,
    *,
    tolerance: float = USUAL,
    derivatives: bool = False,
    restitution: Real = ELASTIC,
) -> Real | tuple[Real, Real, Real]:
    """Return the dimensionless rebound psi2 of spheres, a float or an array of the inputs' shape.

    The model is the paper's in its continuum limit: elastic Hertz contact, Coulomb friction. Up to
    chi = 2.5, which covers all spheres except those with a dense core, psi2 is tabulated to 1e-9,
    at about 0.1 us per impact in a large array. Above, impacts are solved, at about 2 ms each.
    ``contactlab.Simulation`` gives everything else.

    Parameters
    ----------
    psi1 : float or array_like
        Non-dimensional angle of incidence, eq. (29): kappa v_x / (mu v1). Any sign and size. An
        empty array gives an empty array.
    chi : float or array_like
        Eq. (38), broadcast against ``psi1``; positive, at most 1e4.
    tolerance : float
        Largest error over max(1, abs(psi1)), from 1e-9. Answers with
        restitution 1 are within 1e-9 at any tolerance.
    derivatives : bool
        Return d psi2/d psi1 and d psi2/d chi too, for chi up to 2.5. Both are tabulated to 1e-6 at
        any tolerance (5e-5 for psi1 just above 1, chi 1.83 to 1.92).
    restitution : float or array_like
        e of the normal motion, from 0.01 to 1, broadcast against ``psi1``. Below 1 the law is
        Tsuji's (``normal.tsuji``) with Coulomb's law at every point, and ``tolerance`` has no
        effect. For chi from 0.8 to 1.8 and e from 0.5 a table holds psi2 to 1e-3, whether all
        impacts have one e or each its own; elsewhere up to chi = 10 rings give psi2 to 4e-3, in
        three to seven milliseconds per impact of an array, 50 alone; beyond, annuli answer,
        with an error that is not declared. The choice of law is a model error: at the same e other
        laws differ in psi2, for chi up to 1.8 at e = 0.9 the viscoelastic law by up to 0.021, Hunt
        and Crossley's by 0.11, a linear spring by 0.62.

    Returns
    -------
    psi2 : float or ndarray
        Tangential velocity of the contact after the impact, scaled and signed as ``psi1``: if
        psi1 and psi2 differ in sign, the slip velocity is reversed. Odd in psi1 to the last bit. A
        float if psi1 and chi are scalars. With ``derivatives`` a tuple (psi2, d psi2/d psi1,
        d psi2/d chi). Other impacts in an array change an answer by less than 1e-10. Arrays are
        float64 and new; inputs of other types are converted.

    Raises
    ------
    ValueError
        For bad input, with the argument, its value, the index of the first bad number, the rule
        and the remedy.
    ValueError, PluginError
        If ``tangential.fronts``, or ``normal.tsuji`` below a restitution of 1, is blocked or cannot
        be imported.
    ImpactError
        If an impact cannot be solved; no such impact has been found.

    Notes
    -----
    The function keeps no state but tables that never change: threads may call it at the same time.

    Examples
    --------
    >>> round(rebound(1.2, 49 / 34), 6)
    -0.180519
    """
    if (
        not derivatives
        and (restitution is ELASTIC or (type(restitution) is float and restitution == 1.0))
        and (tolerance is USUAL or (isinstance(tolerance, float) and TABULATED < tolerance < 1.0))
        and _in_table(psi1, chi)
    ):
        return _table("tangential")(psi1, chi)  # type: ignore[no-any-return]
    incidence = real(
        "psi1",
        psi1,
        remedy="give the non-dimensional angle of incidence, eq. (29) of the paper",
        kept=False,
        empty=True,
    )
    inertia = real(
        "chi",
        chi,
        rule=CHI,
        remedy="chi of eq. (38); 1.4412 for a solid steel sphere",
        kept=False,
        empty=True,
    )
    aim = real("tolerance", tolerance, rule=TOLERANCE, remedy="leave it out for 1e-5")
    if not isinstance(aim, float):
        raise refuse("tolerance", tolerance, "must be one number", "leave it out for 1e-5")
    e = real("restitution", restitution, rule=RESTITUTIONS, remedy="leave it out for 1", empty=True)
    velocity, ratio = paired("psi1", "chi", (incidence, inertia))
    if not isinstance(e, float):
        velocity, each = paired("psi1", "restitution", (velocity, e))
        velocity, ratio = paired("psi1", "chi", (velocity, ratio))
    if derivatives and np.any(e != 1.0):
        remedy = "take differences of psi2, or leave one of the two out"
        raise refuse("derivatives", derivatives, "are available for restitution = 1 only", remedy)
    flat, ratios = velocity.ravel(), ratio.ravel()
    if not flat.size:
        nothing = (np.empty(velocity.shape), np.empty(velocity.shape), np.empty(velocity.shape))
        return nothing if derivatives else nothing[0]
    if not isinstance(e, float):
        psi2 = _each(flat, ratios, np.broadcast_to(each, velocity.shape).ravel(), aim)
    elif e != 1.0:
        psi2 = _damped(flat, ratios, e)
    else:
        psi2 = _solve(flat, ratios, aim)
    psi2 = psi2.reshape(velocity.shape)
    answer = float(psi2) if psi2.ndim == 0 else psi2
    if not derivatives:
        return answer
    if not (ratios <= TABULATED_CHI).all():
        rule = f"derivatives are tabulated up to chi = {TABULATED_CHI}"
        raise refuse("chi", float(ratios.max()), rule, "take differences of psi2 beyond")
    _, by_psi1, by_chi = _table("tangential")(velocity, ratio, derivatives=True)
    if psi2.ndim == 0:
        return answer, float(by_psi1), float(by_chi)
    return answer, by_psi1, by_chi


def _in_table(psi1: Any, chi: Any) -> bool:
    """Return whether arguments are two floats or two equal arrays of floats in the table's range.

    A quick look: arguments of other kinds, and bad ones, are False.
    """
    if isinstance(psi1, float):
        return isinstance(chi, float) and -math.inf < psi1 < math.inf and 0.0 < chi <= TABULATED_CHI
    if not type(psi1) is type(chi) is np.ndarray or psi1.shape != chi.shape or not psi1.ndim:
        return False
    if not psi1.dtype == chi.dtype == np.float64 or not psi1.size:
        return False
    if psi1.size > FEW_NUMBERS:  # comparisons with NaN are False
        inside = chi.min() > 0.0 and chi.max() <= TABULATED_CHI
        return bool(inside and -math.inf < psi1.min() and psi1.max() < math.inf)
    speeds, ratios = psi1.ravel().tolist(), chi.ravel().tolist()
    return all(map(math.isfinite, speeds)) and all(0.0 < one <= TABULATED_CHI for one in ratios)


def _parted(
    where: Any, inside: Callable[..., Any], outside: Callable[..., Any], *columns: Array
) -> Array:
    """Return psi2, shape (impacts,), by one function of the columns where a mask is True."""
    if where.all():
        return np.asarray(inside(*columns))
    psi2 = np.empty_like(columns[0])
    for mask, answer in ((where, inside), (~where, outside)):
        if mask.any():
            psi2[mask] = answer(*(column[mask] for column in columns))
    return psi2


def _solve(psi1: Array, chi: Array, tolerance: float) -> Array:
    """Return psi2, shape (impacts,), from the table where chi is in range, else solved."""
    tabulated = (chi <= TABULATED_CHI) & (tolerance > TABULATED)
    return _parted(tabulated, _table("tangential"), _exact, psi1, chi)


def _each(psi1: Array, chi: Array, restitution: Array, tolerance: float) -> Array:
    """Return psi2 of impacts with a restitution each, shape (impacts,)."""

    def elastic(psi1: Array, chi: Array, _: Array) -> Array:
        return _solve(psi1, chi, tolerance)

    return _parted(restitution == 1.0, elastic, _damped, psi1, chi, restitution)


def _damped(psi1: Array, chi: Array, restitution: Real) -> Array:
    """Return psi2, shape (impacts,), under Tsuji's law; by annuli beyond the largest chi."""
    table = _table("normal")
    if not (chi > DAMPED_LARGEST_CHI).any():
        return np.asarray(table(psi1, chi, restitution=restitution))

    def tabulated(psi1: Array, chi: Array, each: Array) -> Any:
        return table(psi1, chi, restitution=each)

    each = np.array(np.broadcast_to(restitution, psi1.shape))
    return _parted(chi <= DAMPED_LARGEST_CHI, tabulated, _annuli, psi1, chi, each)


def _annuli(psi1: Array, chi: Array, restitution: Array) -> Array:
    """Return psi2, shape (impacts,), under Tsuji's law by annuli, for one e after another."""
    psi2 = np.empty_like(psi1)
    for value in np.unique(restitution).tolist():
        part = restitution == value
        change = _change(damped(value), psi1[part], chi[part])
        psi2[part] = np.copysign(1.0, psi1[part]) * (np.abs(psi1[part]) + change)
    return psi2


def damped(restitution: float) -> Simulation:
    """Return the laws for a restitution below 1: ``composition.RESTITUTION``, in fixed steps.

    Where friction changes the approach, others stand in for all but the normal law.
    """
    from contactlab.compose import composition  # a table needs none of this
    from contactlab.compose.simulation import Simulation

    tangential = composition.law("tangential", composition.RESTITUTION["tangential"])
    laws = composition.compose(
        composition.law("normal", composition.RESTITUTION["normal"], restitution=restitution),
        attrs.evolve(tangential, **{str(tangential.resolution): ANNULI}),
        composition.fixed_steps(4 * ANNULI),
    )
    return Simulation.of(laws.changed(named=frozenset({"normal"})))


def damped_error(chi: Real, restitution: Real) -> Any:
    """Return the bound of the error of psi2 below a restitution of 1; NaN if not measured."""
    inside = (chi >= DAMPED_CHI[0]) & (chi <= DAMPED_CHI[1]) & (restitution >= DAMPED_RESTITUTION)
    measured = np.asarray(chi) <= DAMPED_LARGEST_CHI
    return np.where(inside, DAMPED_ERROR, np.where(measured, BEYOND_ERROR, np.nan))


def _table(kind: str) -> Callable[..., Any]:
    """Return psi2 of a law: of the exact tangential law, or of the normal law of a restitution."""
    return _kept_table(kind, os.environ.get(BLOCK_VARIABLE))


@cache
def _kept_table(kind: str, _: Any) -> Callable[..., Any]:
    """Return the function of a law while the blocking is the same."""
    from contactlab.compose import composition  # takes long to import

    names = composition.EXACT if kind == "tangential" else composition.RESTITUTION
    law: Tabulated = composition.law(kind, names[kind])
    return law.rebound


def _exact(psi1: Array, chi: Array) -> Array:
    """Return psi2, shape (impacts,), without a table: the exact solution for abs(psi1)."""
    from contactlab.compose import composition  # a table needs none of this
    from contactlab.compose.simulation import Simulation

    speed = np.abs(psi1)
    change = _change(Simulation(**composition.exact(EXACT)), psi1, chi)
    # clipped so that no rounding error adds energy, or impulse beyond that of slip throughout
    change = np.clip(change, np.maximum(-2.0 * speed, -4.0 * chi), 0.0)
    return np.asarray(np.copysign(1.0, psi1) * (speed + change))


def _change(simulation: Simulation, psi1: Array, chi: Array) -> Array:
    """Return psi2 - psi1 of impacts, shape (impacts,), for abs(psi1)."""
    from contactlab.impact.scene import Scene

    # Beyond SLIPS_THROUGHOUT the energy of slip may overflow.
    scene = Scene.nondimensional(psi1=np.minimum(np.abs(psi1), SLIPS_THROUGHOUT), chi=chi)
    return np.asarray(simulation.sweep(scene).check().psi_change)
