"""Checked numbers: every quantity a user gives goes through here.

A refusal names the argument, the value, the rule and the remedy, so that a
person can mend the input without reading any code.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

#: A number or an array of numbers: the code of the laws serves both.
Real: TypeAlias = float | NDArray[np.float64]
#: A yes or no, or an array of them.
Mask: TypeAlias = bool | np.bool_ | NDArray[np.bool_]


#: Words for symbols and other names that people try; more than one where it depends.
SYMBOLS: dict[str, tuple[str, ...]] = {
    "mu": ("friction_coefficient",), "friction": ("friction_coefficient", "tangential"),
    "nu": ("poisson_ratio",), "E": ("young_modulus",), "G": ("shear_modulus",),
    "rho": ("density",), "R": ("radius",), "r": ("radius",), "diameter": ("radius",),
    "d": ("radius",), "Y": ("yield_stress",),
    "law": ("tangential",), "theta": ("angle_deg",), "alpha": ("angle_deg",),
    "m": ("mass",), "M": ("mass",), "K": ("gyration_ratio",),
    "v": ("tangential_velocity", "speed", "velocity"), "vx": ("tangential_velocity",),
    "velocity": ("rebound_tangential_velocity", "rebound_normal_velocity"),
    "speed": ("normal_speed",), "v1": ("normal_speed",), "vn": ("normal_speed",),
    "vz": ("normal_speed",), "v2": ("rebound_normal_velocity",),
    "omega": ("spin", "rebound_spin"), "w": ("spin", "rebound_spin"), "spin": ("rebound_spin",),
    "e": ("restitution", "normal_restitution"), "restitution": ("normal_restitution",),
    "e_n": ("normal_restitution",), "e_t": ("tangential_restitution",),
    "et": ("tangential_restitution",), "t": ("time",), "T": ("duration",),
    "force": ("normal_force", "tangential_force"),
    "F": ("tangential_force",), "P": ("normal_force",), "work": ("friction_work",),
    "beta0": ("slip_restitution", "beta"), "kappa": ("stiffness_ratio",),
    "shear_modulus_ratio": ("stiffness_ratio",),
    "angle": ("angle_deg", "rebound_angle"), "psi": ("psi1",), "dt": ("steps",), "n": ("steps",),
}  # fmt: skip


class Rule(NamedTuple):
    """A condition on a number and the sentence that states it.

    Attributes
    ----------
    holds : callable
        Takes a number or an array; True where the condition holds.
    sentence : str
        What a refusal says: ``"must be positive"``.
    """

    holds: Callable[[Any], Any]
    sentence: str


FINITE = Rule(lambda value: value == value, "must be a finite real number")
POSITIVE = Rule(lambda value: value > 0.0, "must be positive and finite")
NON_NEGATIVE = Rule(lambda value: value >= 0.0, "must be zero or positive, and finite")
POISSON = Rule(
    lambda value: (value >= -1.0) & (value <= 0.5),
    "must lie in [-1, 0.5], the range of a stable isotropic solid",
)
GYRATION = Rule(
    lambda value: (value > 0.0) & (value <= 1.0),
    "must lie in (0, 1]: radius of gyration over radius, 1 with all mass at the surface",
)


def shown(value: object, *, most: int = 80) -> str:
    """Return a value for a message, on one line of at most so many characters."""
    try:
        text = " ".join(repr(value).split())
    except Exception:  # an integer of too many digits, lists in lists in lists, anybody's class
        text = f"a {type(value).__name__}"
    return text if len(text) <= most else text[: most - 3] + "..."


def refuse(argument: str, value: object, rule: str, remedy: str = "") -> ValueError:
    """Return the error for a bad argument: name, value, rule and remedy in one sentence.

    Parameters
    ----------
    argument : str
        Its name, or its path in a file.
    value : object
        As it was given.
    rule : str
        What it breaks: ``"must be positive"``.
    remedy : str
        What to do about it.
    """
    return ValueError(f"{argument} = {shown(value)}: {rule}" + (f"; {remedy}" if remedy else ""))


def nearest(name: str, known: Iterable[str], *, cutoff: float = 0.5) -> str:
    """Return "did you mean ...? " with the known name most like ``name``, or nothing.

    A symbol of the paper, or of everybody's, stands for the word used here: mu for
    friction_coefficient.
    """
    import difflib  # only for those who misspell

    names = list(known)
    meant = [word for word in SYMBOLS.get(name, ()) if word in names]
    meant += difflib.get_close_matches(name, names, n=1, cutoff=cutoff)
    return f"did you mean {meant[0]!r}? " if meant else ""


def real(
    argument: str,
    value: object,
    *,
    rule: Rule = FINITE,
    remedy: str = "",
    kept: bool = True,
) -> Real:
    """Return ``value`` as a float or a float64 array, or refuse it.

    Parameters
    ----------
    argument : str
        Name used in the error.
    value : object
        A real number, or an array or list of them. Booleans, text, complex numbers
        and NaN or infinite values are refused; integers and float32 are widened.
    rule : Rule
        What every element must satisfy besides being finite.
    remedy : str
        What to do about a refusal, such as the unit expected.
    kept : bool
        Whether an array outlives the call: then it is a copy, and read-only.

    Raises
    ------
    ValueError
        With argument, value, rule and remedy.
    """
    if type(value) is float:  # the common case, without a detour through numpy
        if math.isfinite(value) and rule.holds(value):
            return value
        raise refuse(argument, value, rule.sentence, remedy)
    if isinstance(value, str | bytes | bool) or value is None:
        raise refuse(argument, value, "must be a real number", remedy)
    try:
        array = np.asarray(value)
    except ValueError:
        raise refuse(argument, value, "must be a number or a regular array", remedy) from None
    if np.ma.is_masked(value):
        raise refuse(argument, value, "must have no masked entries", "fill or drop them")
    if array.dtype.kind not in "iuf":
        raise refuse(argument, value, "must be a real number", remedy)
    if array.size == 0:
        raise refuse(argument, value, "must hold at least one number", remedy)
    widened = array.astype(np.float64, copy=kept)
    if not (np.isfinite(widened) & rule.holds(widened)).all():
        raise refuse(argument, value, rule.sentence, remedy)
    if widened.ndim == 0:
        return float(widened)
    if kept:
        widened.flags.writeable = False  # nobody may change it under those who read it
    return widened


def paired(first: str, second: str, values: tuple[Real, Real]) -> tuple[Any, Any]:
    """Return two quantities as arrays of one shape, or refuse shapes that do not fit."""
    if np.ndim(values[0]) and np.shape(values[0]) == np.shape(values[1]):
        return values  # broadcasting takes longer than this
    if isinstance(values[0], float) and isinstance(values[1], float):
        return np.asarray(values[0]), np.asarray(values[1])
    try:
        one, other = np.broadcast_arrays(*values)
    except ValueError:
        shapes = f"{np.shape(values[0])} and {np.shape(values[1])}"
        remedy = f"one value of {second} for each {first}"
        rule = "must have shapes that fit"
        raise refuse(f"{first} and {second}", shapes, rule, remedy) from None
    return one, other


def whole(argument: str, value: object, *, least: int = 1, most: int = 10_000_000) -> int:
    """Return ``value`` as an int between ``least`` and ``most``, or refuse it.

    Parameters
    ----------
    argument : str
        Name used in the error.
    value : object
    least, most : int
        The range, both ends in it.
    """
    rule = f"must be a whole number from {least} to {most}"
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise refuse(argument, value, rule)
    if not least <= value <= most:
        raise refuse(argument, value, rule)
    return int(value)


def unit_remedy(unit: str) -> str:
    """Return what to do about a refused number that has, or lacks, a unit."""
    return "it has no unit" if unit == "1" else f"give it in {unit}"


def _checked(value: object, owner: object, field: attrs.Attribute[Any]) -> Real | None:
    """Return the checked value of a field; ``owner`` is the object that is being made."""
    if value is None and field.default is None:
        return None
    meta = field.metadata
    number = real(field.name, value, rule=meta["rule"], remedy=unit_remedy(meta["unit"]))
    if isinstance(number, np.ndarray) and getattr(type(owner), "plain_options", False):
        rule = "must be one number: an option of a law holds for every impact"
        raise refuse(field.name, value, rule, "make a law for each value")
    return number


def key(value: Real | None) -> object:
    """Return what equality and hash of a quantity go by; arrays have neither of their own."""
    if value is None or isinstance(value, float):
        return value
    array = np.asarray(value) + 0.0  # -0.0 equals 0.0
    return array.shape, array.tobytes()


def quantity(
    unit: str, *, rule: Rule = FINITE, default: Any = attrs.NOTHING, kw_only: bool = False
) -> Any:
    """Return an attrs field for a checked real quantity with its unit in the metadata.

    A default of None makes it optional: None may be given too. A body or a scene takes an array,
    one value for each impact; a law (``Law.plain_options``) refuses arrays.

    Parameters
    ----------
    unit : str
        In SI; ``"1"`` for none.
    rule : Rule
        What every element must satisfy besides being finite.
    default : float or None, optional
    kw_only : bool
        Whether this field alone is to be given by name.
    """
    keywords: Any = {"kw_only": True} if kw_only else {}  # False would overrule the class
    return attrs.field(
        default=default,
        **keywords,
        converter=attrs.Converter(_checked, takes_self=True, takes_field=True),
        eq=key,
        metadata={"unit": unit, "rule": rule, "range": rule.sentence},
    )


def instance(*kinds: type, remedy: str = "", optional: bool = False, **field: Any) -> Any:
    """Return an attrs field for an object of one of some classes; if optional, None too."""
    rule = f"must be a {' or a '.join(kind.__name__ for kind in kinds)}"

    def validate(_: object, field: attrs.Attribute[Any], value: object) -> None:
        if not (isinstance(value, kinds) or (optional and value is None)):
            raise refuse(field.name, value, rule, remedy)

    return attrs.field(validator=validate, **field)


def _option(checked: Callable[[str, object], Any], default: Any, **metadata: Any) -> Any:
    """Return an attrs field whose value is ``checked(name, value)`` of what is given."""
    return attrs.field(
        default=default,
        converter=attrs.Converter(
            lambda value, field: checked(field.name, value), takes_field=True
        ),
        metadata={"unit": "", **metadata},
    )


def choice(*words: str, default: str) -> Any:
    """Return an attrs field for one of a few words.

    Parameters
    ----------
    *words : str
    default : str
        One of them.
    """
    rule = f"must be one of {', '.join(map(repr, words))}"

    def checked(name: str, value: object) -> str:
        if not isinstance(value, str) or value not in words:
            raise refuse(name, value, rule)
        return value

    return _option(checked, default, range=rule, words=words)


def flag(*, default: bool) -> Any:
    """Return an attrs field for True or False.

    Parameters
    ----------
    default : bool
    """
    rule = "must be True or False"

    def checked(name: str, value: object) -> bool:
        if not isinstance(value, bool):
            raise refuse(name, value, rule)
        return value

    return _option(checked, default, range=rule)


def count(*, default: Any = attrs.NOTHING, least: int = 1, most: int = 10_000_000) -> Any:
    """Return an attrs field for a checked whole number.

    Parameters
    ----------
    default : int, optional
    least, most : int
        The range, both ends in it.
    """

    def checked(name: str, value: object) -> int:
        return whole(name, value, least=least, most=most)

    rule = f"must be a whole number from {least} to {most}"
    return _option(checked, default, range=rule, unit="1")
