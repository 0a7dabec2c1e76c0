"""Refusals of arguments that a function does not have, lacks, or wants by name."""

from __future__ import annotations

import functools
from collections.abc import Callable
from typing import Any, TypeVar, cast

from contactlab.numeric.checks import nearest, shown

Named = TypeVar("Named", bound=Callable[..., Any])


class ArgumentError(TypeError, ValueError):
    """A call does not fit a signature; Python's own error, and that of all bad input here."""


def named_arguments(example: str) -> Callable[[Named], Named]:
    """Return a decorator of a function, or of a class for its ``__init__``.

    A call that does not fit the signature is refused with the argument, the nearest known
    name (``mu`` is ``friction_coefficient``) and an example, as an ``ArgumentError``. A call
    that fits costs nothing more than the call itself.

    Parameters
    ----------
    example : str
        A call that fits, for the message: ``"Sphere(0.0127, steel)"``.
    """

    def decorate(named: Named) -> Named:
        if isinstance(named, type):
            made: Any = named
            made.__init__ = _refusing(made.__init__, named.__name__, example)
            return cast(Named, named)
        return cast(Named, _refusing(named, named.__name__, example))

    return decorate


def _refusing(function: Callable[..., Any], name: str, example: str) -> Callable[..., Any]:
    @functools.wraps(function)
    def called(*values: Any, **named: Any) -> Any:
        try:
            return function(*values, **named)
        except TypeError as error:
            refused = refusal(function, name, example, values, named)
            if refused is None:  # it fits; what is wrong is inside
                raise
            raise refused from error

    return called


def refusal(
    function: Callable[..., Any],
    name: str,
    example: str,
    values: tuple[Any, ...],
    named: dict[str, Any],
) -> ArgumentError | None:
    """Return the refusal of a call, or None if it fits the signature.

    Parameters
    ----------
    function : callable
        Whose signature counts.
    name, example : str
        What it is called in the message, and a call that fits.
    values, named : tuple, dict
        Arguments by position, with ``self`` where there is one, and by name.
    """
    import inspect  # only for those who err

    parameters = dict(inspect.signature(function).parameters)
    own = 0
    if "self" in parameters or "cls" in parameters:
        parameters.pop(next(iter(parameters)))
        own = 1
    known = [key for key, one in parameters.items() if one.kind is not one.VAR_KEYWORD]
    placed = [key for key in known if parameters[key].kind is not parameters[key].KEYWORD_ONLY]
    given = dict(zip(placed, values[own:], strict=False))
    remedy = f"write it as {example}"
    if not any(one.kind is one.VAR_KEYWORD for one in parameters.values()):
        for key in named:
            if key not in parameters:
                hint = nearest(key, known)
                return ArgumentError(
                    f"{name}: {key} is not an argument; {hint}it takes {', '.join(known)}; {remedy}"
                )
    for value in values[own + len(placed) :]:
        most = f"at most {len(placed)} without a name" if placed else "every one by name"
        return ArgumentError(f"{name}: {shown(value)} is one too many; it takes {most}; {remedy}")
    for key in given:
        if key in named:
            return ArgumentError(
                f"{name}: {key} is given twice, as {shown(given[key])} by its place and as "
                f"{shown(named[key])} by its name; {remedy}"
            )
    needed = [key for key in known if parameters[key].default is inspect.Parameter.empty]
    missing = [key for key in needed if key not in given and key not in named]
    if missing:
        word = "are" if len(missing) > 1 else "is"
        return ArgumentError(f"{name}: {', '.join(missing)} {word} missing; {remedy}")
    return None
