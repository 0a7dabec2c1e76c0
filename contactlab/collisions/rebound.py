"""psi2 for arrays of (psi1, chi), without scenes, plans and energy books."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterable
from functools import cache
from typing import TYPE_CHECKING, Any, Literal, TypeAlias, TypeGuard, TypeVar, overload

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.restitution import RESTITUTIONS
from contactlab.numeric.checks import FINITE, POSITIVE, Rule, pair_up, real, refuse, yes_or_no
from contactlab.numeric.labels import library_of
from contactlab.numeric.types import Array, Labelled, Many, Number, Plain, Real

if TYPE_CHECKING:
    from contactlab.contracts.whole_impact import Tabulated
    from contactlab.runs.simulation import Simulation

Yes: TypeAlias = Literal[True]
No: TypeAlias = Literal[False]
#: An array of another library; the answer is one of the same library.
Labels = TypeVar("Labels", bound=Labelled)

#: Springs of the laws for a restitution; the steps are four times as many.
SPRINGS = 100
#: The table of elastic impacts answers for tolerances above this: it holds psi2 to 1e-9.
TABULATED = 1e-9
#: Tolerance of every solution: an answer in an array then equals a single one to 1e-10.
EXACT = 1e-9
TOLERANCE = Rule(
    lambda value: np.ndim(value) == 0 and 1e-9 <= value < 1.0,
    "must be one number between 1e-9 and 1, of max(1, |psi1|)",
)
LARGEST_CHI = 1e4
CHI = Rule(
    lambda value: POSITIVE.holds(value) & (value <= LARGEST_CHI),
    "must be positive and at most 1e4, the range over which answers were checked",
)
#: Two single numbers are probably exchanged if the first is a chi of solid spheres, and the second
#: a psi1 that is common and a chi that only a dense core makes.
LIKE_CHI, LIKE_PSI1 = (0.8, 1.75), (4.0, 20.0)
#: From this psi1 on every impact with chi in range slips throughout, and psi falls by 4 chi.
SLIPS_THROUGHOUT = 1e5


#: Up to this restitution the table of restitutions is not joined to the elastic one.
NO_JOIN = 0.99
#: The default of ``tolerance``.
USUAL = 1e-5
#: Libraries of arrays that may be traced, with the functions by which each differentiates.
DIFFERENTIATE = {
    "jax": "jax.grad, jax.jvp and jax.hessian",
    "torch": "torch.autograd and torch.func",
}
#: Arrays up to this size are checked number by number: NumPy takes longer to begin.
FEW_NUMBERS = 40


@overload
def rebound(
    psi1: Number,
    chi: Number,
    *,
    tolerance: float = ...,
    derivatives: No = ...,
    restitution: Number = ...,
) -> float: ...
@overload
def rebound(
    psi1: Many,
    chi: Plain,
    *,
    tolerance: float = ...,
    derivatives: No = ...,
    restitution: Plain = ...,
) -> Array: ...
@overload
def rebound(
    psi1: Plain,
    chi: Many,
    *,
    tolerance: float = ...,
    derivatives: No = ...,
    restitution: Plain = ...,
) -> Array: ...
@overload
def rebound(
    psi1: Number, chi: Number, *, tolerance: float = ..., derivatives: No = ..., restitution: Many
) -> Array: ...
@overload
def rebound(
    psi1: Number, chi: Number, *, tolerance: float = ..., derivatives: Yes
) -> tuple[float, float, float]: ...
@overload
def rebound(
    psi1: Many, chi: Plain, *, tolerance: float = ..., derivatives: Yes
) -> tuple[Array, Array, Array]: ...
@overload
def rebound(
    psi1: Plain, chi: Many, *, tolerance: float = ..., derivatives: Yes
) -> tuple[Array, Array, Array]: ...
@overload
def rebound(
    psi1: Number, chi: Number, *, tolerance: float = ..., derivatives: Yes, restitution: Number
) -> tuple[float, float, float, float]: ...
@overload
def rebound(
    psi1: Many, chi: Plain, *, tolerance: float = ..., derivatives: Yes, restitution: Plain
) -> tuple[Array, Array, Array, Array]: ...
@overload
def rebound(
    psi1: Plain, chi: Many, *, tolerance: float = ..., derivatives: Yes, restitution: Plain
) -> tuple[Array, Array, Array, Array]: ...
@overload
def rebound(
    psi1: Number, chi: Number, *, tolerance: float = ..., derivatives: Yes, restitution: Many
) -> tuple[Array, Array, Array, Array]: ...
@overload
def rebound(
    psi1: Labels,
    chi: Plain | Labels,
    *,
    tolerance: float = ...,
    derivatives: No = ...,
    restitution: Plain | Labels | None = ...,
) -> Labels: ...
@overload
def rebound(
    psi1: Plain,
    chi: Labels,
    *,
    tolerance: float = ...,
    derivatives: No = ...,
    restitution: Plain | Labels | None = ...,
) -> Labels: ...
@overload
def rebound(
    psi1: Labels,
    chi: Plain | Labels,
    *,
    tolerance: float = ...,
    derivatives: Yes,
    restitution: Plain | Labels | None = ...,
) -> tuple[Labels, ...]: ...
@overload
def rebound(
    psi1: Plain | Labelled,
    chi: Plain | Labelled,
    *,
    tolerance: float = ...,
    derivatives: bool = ...,
    restitution: Plain | Labelled | None = ...,
) -> float | Array | Labelled | tuple[float | Array | Labelled, ...]: ...
def rebound(
    psi1: Plain | Labelled,
    chi: Plain | Labelled,
    *,
    tolerance: float = USUAL,
    derivatives: bool = False,
    restitution: Plain | Labelled | None = None,
) -> object:
    """Return the dimensionless rebound psi2 of spheres, a float or an array of the inputs' shape.

    The model is the paper's in its continuum limit: Hertz contact, Coulomb friction. Elastic
    impacts are tabulated to 1e-9 up to chi = 2.5, which covers all spheres except those with a
    dense core. With a restitution below 1 the bodies lose in shear as they lose in pressure, and
    psi2 is tabulated to 5e-5 for chi from 0.3 to 3. An impact takes about 0.1 us in a large array,
    0.5 us with a restitution of its own, and 3 us alone. Out of the tables elastic impacts are
    solved to 1e-12 in about 20 us, and others by springs in 2 to 8 ms; without the compiled laws
    in a hundred times as long.
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
        restitution 1 are within 1e-9 at any tolerance; below 1 it has no effect.
    derivatives : bool
        Return d psi2/d psi1 and d psi2/d chi too, and with ``restitution`` d psi2/d e. Elastic
        ones are tabulated up to chi = 2.5, to 1e-6 (5e-5 for psi1 just above 1, chi 1.83 to 1.92);
        with a restitution below 1 they are tabulated for chi from 0.3 to 3, to 0.02.
    restitution : float or array_like, optional
        e of the normal motion, from 0 (clay) to 1, broadcast against ``psi1``; 1 if left out. Below
        1 the law is ``normal.viscoelastic``: one relaxation time for pressure and shear. In the
        table psi2 holds
        to 5e-5 up to chi = 2, and to 1.5e-4 up to 3. Below chi = 0.3 springs give psi2 to 5e-5,
        above 3 to 3e-4 sqrt(chi/3). Impacts that slip throughout, psi1 >= max(1, 2 chi (1 + e) -
        e), and those of e = 0, are exact. A plan of ``collide`` states how far beta0 =
        -psi2/psi1 is trusted (model error).

    Returns
    -------
    psi2 : float or ndarray
        Tangential velocity of the contact after the impact, scaled and signed as ``psi1``: if
        psi1 and psi2 differ in sign, the slip velocity is reversed. Odd in psi1 to the last bit. A
        float if psi1 and chi are scalars. With ``derivatives`` a tuple (psi2, d psi2/d psi1,
        d psi2/d chi), and d psi2/d e after them if ``restitution`` is given. Other impacts in an
        array change an answer by less than 1e-10. Arrays are float64 and new; inputs of other types
        are converted.

        Labelled arrays are paired by label, and beside them stand numbers or arrays with labels:
        of ``xarray.DataArray`` by the names of dimensions, with their coordinates; of
        ``pandas.Series`` by index. The answer has the same type. Arrays of dask give arrays of
        dask, not computed yet; their bad numbers are refused when they are computed.

        Arrays of JAX and PyTorch give arrays of JAX and PyTorch, under jit, vmap, grad and hessian
        too: from the tables, so chi is at most 2.5, and 0.3 to 3 with a restitution; in float32 to
        2e-6. Where numbers out of these ranges are traced, psi2 is NaN. ``derivatives`` are those
        that the library takes.

    Warns
    -----
    UserWarning
        If two single numbers look exchanged: psi1 from 0.8 to 1.75, chi from 4 to 20.

    Raises
    ------
    ValueError
        For bad input, with the argument, its value, the index of the first bad number, the rule
        and the remedy; also if labels differ.
    ValueError, PluginError
        If ``tangential.fronts``, or ``normal.viscoelastic`` below a restitution of 1, is blocked or
        cannot be imported. The variable that blocks laws is read at the first answer of a process.
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
    if type(restitution) is int:
        restitution = float(restitution)  # 1 is as fast as 1.0
    if isinstance(tolerance, float) and TABULATED < tolerance < 1.0 and derivatives is False:
        if restitution is None or (type(restitution) is float and restitution == 1.0):
            table, span = _table("tangential")
            if _within(psi1, chi, span):
                return table(psi1, chi)
        elif _below_one(restitution, psi1):
            table, span = _table("normal")
            if _within(psi1, chi, span):
                return _by_table(table, psi1, chi, restitution)
    derivatives = yes_or_no("derivatives", derivatives)
    if library_of(psi1) or library_of(chi) or library_of(restitution):
        return _rebound_with_labels(psi1, chi, tolerance, derivatives, restitution)
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
    aim = _tolerance(tolerance)
    e = 1.0 if restitution is None else _restitution(restitution)
    three = derivatives and restitution is not None
    velocity, ratio = pair_up("psi1", "chi", (incidence, inertia))
    if type(psi1) in (float, int) and type(chi) in (float, int):  # typed, not out of an array
        _warn_of_exchange(float(incidence), float(inertia))
    one = not np.ndim(e)  # one restitution for all
    if not one:
        velocity, each = pair_up("psi1", "restitution", (velocity, e))
        velocity, ratio = pair_up("psi1", "chi", (velocity, ratio))
    flat, ratios = velocity.ravel(), ratio.ravel()
    if not flat.size:
        count = 1 + (2 + three) * derivatives
        nothing = tuple(np.empty(velocity.shape) for _ in range(count))
        return nothing if derivatives else nothing[0]
    if not one:
        e = np.broadcast_to(each, velocity.shape).ravel()
        psi2 = _each(flat, ratios, e, aim)
    elif e != 1.0:
        psi2 = np.asarray(_law("normal").rebound(flat, ratios, e))
    else:
        psi2 = _solve(flat, ratios, aim)
    slopes = _slopes(flat, ratios, e if three else None) if derivatives else ()
    arrays = [each.reshape(velocity.shape) for each in (psi2, *slopes)]
    answers: tuple[Real, ...] = (*(arrays if velocity.ndim else map(float, arrays)),)
    return answers if derivatives else answers[0]


def _warn_of_exchange(psi1: float, chi: float) -> None:
    """Warn of two numbers that look exchanged."""
    if LIKE_CHI[0] <= psi1 <= LIKE_CHI[1] and LIKE_PSI1[0] <= chi <= LIKE_PSI1[1]:
        told = f"psi1 = {psi1:g} and chi = {chi:g} look exchanged: no solid sphere has such a chi"
        remedy = f"was rebound({chi:g}, {psi1:g}) meant? psi1 stands first"
        warnings.warn(f"{told}; {remedy}", UserWarning, stacklevel=3)


def _tolerance(value: object) -> float:
    """Return a checked tolerance."""
    return float(real("tolerance", value, rule=TOLERANCE, remedy="leave it out for 1e-5"))


def _restitution(value: object) -> Real:
    """Return checked restitutions."""
    return real("restitution", value, rule=RESTITUTIONS, remedy="leave it out for 1", empty=True)


def _rebound_with_labels(
    psi1: object, chi: object, tolerance: float, derivatives: bool, restitution: object
) -> object:
    """Return ``rebound`` of labelled or lazy arrays, with their labels."""
    arguments, three = {"psi1": psi1, "chi": chi}, restitution is not None
    if three:
        arguments["restitution"] = restitution
    _tolerance(tolerance)
    if library := traceable(arguments.values()):
        return _by_standard(library, arguments, derivatives)
    from contactlab.collisions.labelled import by_labels  # only for arrays of other libraries

    def answer(*columns: Real) -> object:
        e = columns[2] if three else None
        return rebound(*columns[:2], tolerance=tolerance, derivatives=derivatives, restitution=e)

    return by_labels(answer, 1 + (2 + three) * derivatives, arguments)


def traceable(values: Iterable[object]) -> str:
    """Return the package of the first array of JAX or PyTorch; empty if there is none."""
    return next((name for name in map(library_of, values) if name in DIFFERENTIATE), "")


def _by_standard(library: str, arguments: dict[str, object], derivatives: bool) -> object:
    """Return ``rebound`` of arrays of JAX or PyTorch, traced or not."""
    from contactlab.collisions.traced import by_standard  # only for such arrays

    if derivatives:
        remedy = f"leave it out: {DIFFERENTIATE[library]} differentiate rebound"
        raise refuse("derivatives", derivatives, "is for NumPy arrays", remedy)
    e = arguments.get("restitution")
    if type(e) in (int, float) and e == 1.0:
        e = arguments.pop("restitution")
    lossy = "restitution" in arguments
    law = _law("normal" if lossy else "tangential")
    low, high = law.chi_range
    span = f"lie from {low} to" if lossy else "be positive and at most"
    rules = {
        "psi1": FINITE,
        "chi": Rule(
            lambda value: POSITIVE.holds(value) & (value >= low) & (value <= high),
            f"must {span} {high} with arrays of {library}",
        ),
        "restitution": RESTITUTIONS,
    }
    joined = not (isinstance(e, float) and e <= NO_JOIN)
    return by_standard(library, law, arguments, rules, joined=joined)


def _slopes(psi1: Array, chi: Array, restitution: Real | None) -> tuple[Array, ...]:
    """Return d psi2/d psi1, d psi2/d chi, and d psi2/d e unless the restitution is left out."""
    if restitution is None:
        law = _law("tangential")
        _require_range(chi, *law.chi_range)
        return law.rebound(psi1, chi, derivatives=True)[1:]  # type: ignore[no-any-return]
    law = _law("normal")
    _require_range(chi, *law.chi_range)
    elastic = np.broadcast_to(np.equal(restitution, 1.0), chi.shape)
    _require_range(chi[elastic], *_law("tangential").chi_range)
    return law.rebound(psi1, chi, restitution, derivatives=True)[1:]  # type: ignore[no-any-return]


def _require_range(chi: Array, low: float, high: float) -> None:
    """Refuse chi out of the range of a table of derivatives."""
    out = chi[(chi < low) | (chi > high)]
    if out.size:
        least = f"from {low} " if low > math.ulp(0.0) else ""
        rule = f"derivatives are tabulated {least}up to chi = {high}"
        raise refuse("chi", float(out[0]), rule, "take differences of psi2 beyond")


def _by_table(table: Callable[..., Any], psi1: Any, chi: Any, restitution: Real) -> Real:
    """Return psi2 of checked floats or arrays in the table of restitutions."""
    if isinstance(psi1, float):
        one: float = table(float(psi1), float(chi), restitution)  # NumPy's floats are slow
        return one
    e = restitution if isinstance(restitution, float) else restitution.ravel()
    psi2: Array = table(psi1.ravel(), chi.ravel(), e).reshape(psi1.shape)
    return psi2


def _below_one(restitution: Any, psi1: Any) -> TypeGuard[Real]:
    """Return whether a restitution is a float from 0 to 1, 1 excluded, or an array like psi1."""
    if type(restitution) is float:
        return 0.0 <= restitution < 1.0
    if not type(restitution) is type(psi1) is np.ndarray or restitution.shape != psi1.shape:
        return False
    if restitution.dtype != np.float64 or not restitution.size:
        return False
    return bool(restitution.min() >= 0.0 and restitution.max() < 1.0)


def _within(psi1: Any, chi: Any, span: tuple[float, float]) -> bool:
    """Return whether arguments are two floats or two equal arrays of floats, chi in a range.

    This is a quick test: other kinds of argument, and bad ones, give False.
    """
    low, high = span
    if isinstance(psi1, float):
        return isinstance(chi, float) and -math.inf < psi1 < math.inf and low <= chi <= high
    if not type(psi1) is type(chi) is np.ndarray or psi1.shape != chi.shape or not psi1.ndim:
        return False
    if not psi1.dtype == chi.dtype == np.float64 or not psi1.size:
        return False
    if psi1.size > FEW_NUMBERS:  # comparisons with NaN are False
        inside = chi.min() >= low and chi.max() <= high
        return bool(inside and -math.inf < psi1.min() and psi1.max() < math.inf)
    speeds, ratios = psi1.ravel().tolist(), chi.ravel().tolist()
    return all(map(math.isfinite, speeds)) and all(low <= one <= high for one in ratios)


def _rebound_by_parts(
    where: NDArray[np.bool_],
    inside: Callable[..., Array],
    outside: Callable[..., Array],
    *columns: Array,
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
    table, (_, high) = _table("tangential")
    return _rebound_by_parts((chi <= high) & (tolerance > TABULATED), table, _exact, psi1, chi)


def _each(psi1: Array, chi: Array, restitution: Array, tolerance: float) -> Array:
    """Return psi2 of impacts with a restitution each, shape (impacts,)."""

    def elastic(psi1: Array, chi: Array, _: Array) -> Array:
        return _solve(psi1, chi, tolerance)

    return _rebound_by_parts(
        restitution == 1.0, elastic, _law("normal").rebound, psi1, chi, restitution
    )


def laws_of(restitution: float) -> Simulation:
    """Return the laws for a restitution below 1: ``composition.RESTITUTION``, in fixed steps.

    Where friction changes the approach, others stand in for all but the normal law.
    """
    from contactlab.registry import composition  # a table needs none of this
    from contactlab.runs.simulation import Simulation

    tangential = composition.law("tangential", composition.RESTITUTION["tangential"])
    laws = composition.compose(
        composition.viscous(restitution),
        attrs.evolve(  # type: ignore[misc]  # a law with options is a class of attrs
            tangential, table=True, **{str(tangential.resolution): SPRINGS}
        ),
        composition.fixed_steps(4 * SPRINGS),
    )
    return Simulation.of(laws.change(named=frozenset({"normal"})))


def bound_restitution_error(chi: Real, restitution: Real) -> Real:
    """Return the bound of the error of psi2 below a restitution of 1, as its law declares it."""
    return _law("normal").rebound_error(chi, restitution)


@cache
def _table(kind: str) -> tuple[Callable[..., Any], tuple[float, float]]:
    """Return psi2 of the law of a kind as in ``_law``, and the range of chi of its table."""
    law = _law(kind)
    return law.rebound, law.chi_range


@cache  # to ask the environment what is blocked takes as long as half an answer
def _law(kind: str) -> Tabulated:
    """Return the exact tangential law, or the normal law of a restitution."""
    from contactlab.registry import composition  # takes long to import

    names = composition.EXACT if kind == "tangential" else composition.RESTITUTION
    return composition.law(kind, names[kind])  # type: ignore[return-value]  # both have tables


def _exact(psi1: Array, chi: Array) -> Array:
    """Return psi2, shape (impacts,), without a table: the exact solution for abs(psi1)."""
    speed = np.abs(psi1)
    change = _law("tangential").solved(speed, chi)
    if change is None:
        from contactlab.registry import composition  # a table needs none of this
        from contactlab.runs.simulation import Simulation

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
