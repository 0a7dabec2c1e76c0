"""Checks of every number that a user gives.

A refusal is a ValueError that names the argument, the value, the rule and the remedy.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from math import isfinite
from typing import Any, NamedTuple, Protocol, TypeVar

import attrs
import numpy as np

from contactlab.numeric.labels import forbid_position
from contactlab.numeric.names import quote as quote  # with what refuses
from contactlab.numeric.taken import Taken
from contactlab.numeric.types import Array, Numbers, Places, Real

T = TypeVar("T")


class Rule(NamedTuple):
    """A condition on a number and the sentence that states it.

    Attributes
    ----------
    holds : callable
        Takes a number or an array and returns True where the condition holds.
    sentence : str
        The condition in words, for messages: ``"must be positive"``.
    """

    holds: Callable[[Any], Any]
    sentence: str


class Combination(Protocol):
    """How an option of a law follows from the property of that name of two materials."""

    @property
    def sentence(self) -> str:
        """The combination in words, for messages."""


#: Classes whose objects have no labels: ``real`` does not look for any.
UNLABELLED = frozenset({np.ndarray, list, tuple, int, float, np.float64})
#: The rule for an option that is on or off.
YES_OR_NO = "must be True or False"
#: Number of entries of a list that are searched for labels: all rows are mostly of one class.
FEW_ENTRIES = 8

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


def refuse(argument: str, value: object, rule: str, remedy: str = "") -> ValueError:
    """Return the ValueError for a bad argument: name, value, rule and remedy in one sentence."""
    return ValueError(f"{argument} = {quote(value)}: {rule}" + (f"; {remedy}" if remedy else ""))


def of_kind(
    argument: str,
    value: object,
    *kinds: type,
    rule: str = "",
    remedy: str = "",
    meant: Mapping[type, str] | None = None,
) -> Any:
    """Return an object of one of the classes ``kinds``, or refuse it.

    ``rule`` names the classes unless it is given. ``meant`` has the remedies for objects of other
    classes that users give, with ``{value}`` where the object belongs.
    """
    if isinstance(value, kinds):
        return value
    for kind, told in (meant or {}).items():
        if isinstance(value, kind):
            remedy = told.format(value=value)
    raise refuse(argument, value, rule or f"must be {_name_kinds(kinds)}", remedy)


def _name_kinds(kinds: tuple[type, ...]) -> str:
    """Return "a HalfSpace or a Sphere"."""
    names = (kind.__name__ for kind in kinds)
    return " or ".join(f"{'an' if name[0] in 'AEIOU' else 'a'} {name}" for name in names)


def real(
    argument: str,
    value: object,
    *,
    rule: Rule = FINITE,
    remedy: str = "",
    kept: bool = True,
    empty: bool = False,
) -> Real:
    """Return ``value`` as a finite float or float64 array that obeys ``rule``, or raise ValueError.

    An array that outlives the call (``kept``) is copied and made read-only. Arrays without
    numbers are accepted if ``empty``.
    """
    if type(value) is float:  # the common case; numpy is slower
        if isfinite(value) and rule.holds(value):
            return value
        raise refuse(argument, value, rule.sentence, remedy)
    if isinstance(value, str | bytes | bool) or value is None:
        raise refuse(argument, value, "must be a real number", remedy)
    if type(value) not in UNLABELLED:
        check_place(argument, value)
    elif isinstance(value, list | tuple):
        for entry in value[:FEW_ENTRIES]:
            if type(entry) not in UNLABELLED:
                check_place(argument, entry)
    try:
        array = np.asarray(value)
    except ValueError:
        raise refuse(argument, value, "must be a number or a regular array", remedy) from None
    except Exception as error:  # sparse arrays, other devices, types that NumPy lacks
        raise refuse(argument, value, f"cannot be read by NumPy: {error}", remedy) from error
    if array.dtype.kind not in "iuf":
        raise refuse(argument, value, "must be a real number", remedy)
    if array.size == 0 and not empty:
        raise refuse(argument, value, "must hold at least one number", remedy)
    widened = array.astype(np.float64, copy=kept)
    good = np.isfinite(widened) & rule.holds(widened)
    if not good.all():
        where = np.argwhere(~np.asarray(good))
        named = first_of(where) if widened.size > 1 and len(where) < widened.size else ""
        raise refuse(argument, value, rule.sentence + named, remedy)
    if widened.ndim == 0:
        return float(widened)
    if kept:
        widened.flags.writeable = False
    return widened


def derive(name: str, value: object, remedy: str, **given: object) -> Real:
    """Return a positive number computed from ``given`` ones; refuse an overflow or underflow."""
    try:
        return real(name, value, rule=POSITIVE, empty=True)
    except ValueError:
        numbers = tuple(given.values())
        rule = f"floating point cannot hold the {name} that follows"
        first = numbers[0] if len(numbers) == 1 else numbers
        raise refuse(", ".join(given), first, rule, remedy) from None


def check_place(argument: str, value: object) -> None:
    """Refuse an array whose labels, unit or mask would be lost, or that has no numbers yet."""
    try:
        why = forbid_position(value)
    except TypeError as error:  # sparse tensors raise
        raise refuse(argument, value, f"cannot be read by NumPy: {error}") from error
    if why:
        raise refuse(argument, value, *why)


def first_of(where: Places) -> str:
    """Return " (the first of 3 has index [0])" for indices ``where``; empty for one number."""
    return f" (the first of {len(where)} has index {where[0].tolist()})" if where.shape[1] else ""


def pair_up(first: str, second: str, values: tuple[Real, Real]) -> tuple[Any, Any]:
    """Return two quantities as arrays of one shape, or refuse shapes that do not broadcast."""
    if np.ndim(values[0]) and np.shape(values[0]) == np.shape(values[1]):
        return values  # broadcasting is slower than this comparison
    if isinstance(values[0], float) and isinstance(values[1], float):
        return np.asarray(values[0]), np.asarray(values[1])
    try:
        broadcast = np.broadcast_arrays(*values)
    except ValueError:
        shapes = np.shape(values[0]), np.shape(values[1])
        remedy = f"one value of {second} for each {first}"
        rule = "must broadcast to one"
        raise refuse(f"shapes of {first} and {second}", shapes, rule, remedy) from None
    return broadcast[0], broadcast[1]


def yes_or_no(argument: str, value: object, *, remedy: str = "") -> bool:
    """Return True or False, or refuse any other value: the text "no" would be taken for yes."""
    if isinstance(value, bool | np.bool_):
        return bool(value)
    raise refuse(argument, value, YES_OR_NO, remedy)


def whole(argument: str, value: object, *, least: int = 1, most: int = 10_000_000) -> int:
    """Return ``value`` as an int from ``least`` to ``most``, both included, or refuse it."""
    rule = f"must be a whole number from {least} to {most}"
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value[()]
    if isinstance(value, bool) or not isinstance(value, int | np.integer):
        raise refuse(argument, value, rule)
    if not least <= value <= most:
        raise refuse(argument, value, rule)
    return int(value)


def unit_remedy(unit: str) -> str:
    """Return the remedy for a refused number: the unit to give it in, or that it has none."""
    return "it has no unit" if unit == "1" else f"give it in {unit}"


def _check_field(
    value: Numbers | None, owner: object, field: attrs.Attribute[object]
) -> Real | None:
    """Return the checked value of a field of ``owner``, the object that is being made."""
    if type(value) is float and isfinite(value) and field.metadata["rule"].holds(value):
        return value  # writing the remedy of a refusal takes longer than this check
    if value is None and field.default is None:
        return None
    if type(value) is Taken:
        return value  # the class's own default
    meta = field.metadata
    if "instead" in meta and meta["instead"](value):
        return value  # type: ignore[return-value]  # the class converts it
    remedy = unit_remedy(meta["unit"])
    if "unknown" in meta:
        return real_or_nan(field.name, value, rule=meta["rule"], remedy=remedy, empty=meta["empty"])
    number = real(field.name, value, rule=meta["rule"], remedy=remedy, empty=meta["empty"])
    one_number = getattr(type(owner), "_plain_options", False) and "per_impact" not in meta
    if one_number and isinstance(number, np.ndarray):
        rule = "must be one number: this option of a law holds for every impact"
        raise refuse(field.name, value, rule, "make a law for each value")
    return number


def real_or_nan(
    argument: str, value: object, *, rule: Rule = FINITE, remedy: str = "", empty: bool = False
) -> Real:
    """Return what ``real`` does; NaN in an array marks an impact without the number."""
    if (numbers := _read_gaps(value)) is None:
        return real(argument, value, rule=rule, remedy=remedy, empty=empty)
    real(argument, numbers[~np.isnan(numbers)], rule=rule, remedy=remedy, empty=True)
    numbers = np.array(numbers, dtype=np.float64)
    numbers.setflags(write=False)
    return numbers


def _read_gaps(value: object) -> Array | None:
    """Return numbers with NaN among them as an array; None for any other value."""
    if not isinstance(value, np.ndarray | list | tuple):
        return None
    try:
        numbers = np.asanyarray(value)  # masked arrays are refused later
    except Exception:  # lists of unequal lengths are refused later
        return None
    some = numbers.ndim > 0 and numbers.dtype.kind == "f" and bool(np.isnan(numbers).any())
    return numbers if some else None


def key(value: Real | None) -> object:
    """Return a key for equality and hash of a quantity; arrays have no usable one.

    A default of class ``Taken`` differs from the same number from a user.
    """
    if type(value) is Taken:
        return Taken, float(value)
    if value is None or isinstance(value, float):
        return value
    array = np.asarray(value) + 0.0  # -0.0 equals 0.0
    return array.shape, array.tobytes()


def quantity(
    unit: str,
    *,
    rule: Rule = FINITE,
    default: object = attrs.NOTHING,
    kw_only: bool = False,
    empty: bool = False,
    unknown: bool = False,
    per_impact: bool = False,
    material: Combination | None = None,
    instead: Callable[[object], bool] | None = None,
) -> Any:
    """Return an attrs field for a checked real quantity with its unit in the metadata.

    If the default is None, the quantity is optional and may be None. A body or a scene accepts an
    array with one value for each impact; a law refuses arrays.

    Parameters
    ----------
    unit : str
        SI unit; ``"1"`` for a quantity without unit.
    rule : Rule
        Condition that every element must satisfy besides being finite.
    default : float or None, optional
        Value if none is given; without a default the quantity is required. ``Taken(0.9)`` is one
        that results caution of.
    kw_only : bool
        Whether the field is keyword-only, in a class whose other fields are not.
    empty : bool
        Whether an array without numbers is accepted.
    unknown : bool
        Whether an array may hold NaN, of an impact for which the quantity is not known.
    per_impact : bool
        Whether an option of a law may be an array, one number an impact of the scene's shape. The
        law then reads it by ``contactlab.contracts.number_in``.
    material : Combined, optional
        How an option of a law follows from the property of that name of two materials. Without a
        default the option or the properties must be given.
    instead : callable, optional
        True of a value that stands in place of numbers; the class makes numbers of it.
    """
    keywords: Any = {"kw_only": True} if kw_only else {}  # False would override the class's True
    further: dict[str, Any] = {"unknown": True} if unknown else {}
    read = ["one number, or one an impact"] if per_impact else []
    if per_impact:
        further["per_impact"] = True
    if instead is not None:
        further["instead"] = instead
    if material is not None:
        further |= {"material": material, "required": default is attrs.NOTHING}
        default = None if default is attrs.NOTHING else default
        read.append(f"or a property of the materials: {material.sentence}")
    if read:
        further["read"] = ", ".join(read)
    return attrs.field(
        default=default,
        **keywords,
        converter=attrs.Converter(_check_field, takes_self=True, takes_field=True),
        eq=key,
        metadata={
            "unit": unit,
            "rule": rule,
            "range": rule.sentence,
            "empty": empty,
            **further,
        },
    )


def instance(*kinds: type, remedy: str = "", optional: bool = False, **field: Any) -> Any:
    """Return an attrs field that accepts objects of the classes ``kinds``; None too if optional."""
    rule = f"must be {_name_kinds(kinds)}"

    def validate(_: object, field: attrs.Attribute[object], value: object) -> None:
        if not (isinstance(value, kinds) or (optional and value is None)):
            raise refuse(field.name, value, rule, remedy)

    return attrs.field(validator=validate, **field)


def _option(
    kind: type[T],
    check_value: Callable[[str, object], T | None],
    default: object,
    **metadata: object,
) -> Any:
    """Return an attrs field of ``kind`` with the converter ``check_value(name, value)``."""

    def convert(value: object, field: attrs.Attribute[object]) -> T | None:
        return check_value(field.name, value)

    convert.__annotations__["value"] = kind.__name__  # what signatures show
    return attrs.field(
        default=default,
        converter=attrs.Converter(convert, takes_field=True),
        metadata={"unit": "", **metadata},
    )


def choice(*words: str, default: str) -> Any:
    """Return an attrs field whose value is one of ``words``.

    Parameters
    ----------
    *words : str
        The accepted values.
    default : str
        The word used if none is given.
    """
    rule = f"must be one of {', '.join(map(repr, words))}"

    def check_value(name: str, value: object) -> str:
        if not isinstance(value, str) or value not in words:
            raise refuse(name, value, rule)
        return value

    return _option(str, check_value, default, range=rule, words=words)


def flag(*, default: object) -> Any:
    """Return an attrs field whose value is True or False.

    Parameters
    ----------
    default : bool or None
        The value used if none is given. None may be given where it is the default.
    """

    def check_value(name: str, value: object) -> bool | None:
        if value is None and default is None:
            return None
        remedy = "without quotes; in a scene file true or false" if isinstance(value, str) else ""
        return yes_or_no(name, value, remedy=remedy)

    return _option(bool, check_value, default, range=YES_OR_NO)


def count(
    *,
    default: object = attrs.NOTHING,
    least: int = 1,
    most: int = 10_000_000,
    usual: int | None = None,
) -> Any:
    """Return an attrs field for a checked whole number.

    Parameters
    ----------
    default : int, optional
        Value if none is given; without a default the number is required. None may be given where
        it is the default.
    least, most : int
        Smallest and largest accepted value.
    usual : int, optional
        What a default of None stands for, where nothing else is chosen.
    """

    def check_value(name: str, value: object) -> int | None:
        if value is None and default is None:
            return None
        return whole(name, value, least=least, most=most)

    rule = f"must be a whole number from {least} to {most}"
    return _option(int, check_value, default, range=rule, unit="1", usual=usual)
