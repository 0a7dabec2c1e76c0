"""JAX and PyTorch as libraries of the array API standard, and in what the two differ."""

from __future__ import annotations

import importlib
from collections.abc import Callable, Iterable, Mapping
from functools import cache, reduce
from typing import Any, Protocol

import numpy as np

from contactlab.numeric.array_api import Traced
from contactlab.numeric.checks import Rule, real, refuse
from contactlab.numeric.labels import library_of, numbers_of
from contactlab.numeric.types import AnyArray

#: Parts of names of types that are not of real numbers.
NO_NUMBERS = ("complex", "bool")
#: The shortest type that answers are computed in; shorter ones are widened.
SHORTEST = "float32"


class TracingLibrary(Protocol):
    """A library of arrays.

    Attributes
    ----------
    xp : module or object
        Functions of the array API standard.
    """

    xp: Any

    def arrays(self, values: Iterable[object]) -> list[Any]:
        """Return numbers and arrays as arrays of one type, that of the arrays among them."""

    def constants(self, numbers: Mapping[str, AnyArray], like: Any) -> dict[str, Any]:
        """Return arrays of NumPy as arrays of the type and place of ``like``, or integers."""

    def compile_late(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return a function that may be compiled when it is called."""

    def with_slopes(
        self, value: Callable[..., Any], slopes: Callable[..., Any], fixed: int
    ) -> Callable[..., Any]:
        """Return a function; ``slopes`` by its arguments but the first, ``fixed`` ones, if used."""


class _Jax:
    """JAX."""

    def __init__(self) -> None:
        self.jax = importlib.import_module("jax")
        self.xp = importlib.import_module("jax.numpy")
        self.compile_late: Callable[..., Any] = self.jax.jit

    def arrays(self, values: Iterable[object]) -> list[Any]:
        """Return numbers and arrays as arrays of one type, that of the arrays among them."""
        given = [*map(_plain, values)]
        kind = self.xp.result_type(*filter(_is_array, given))
        if not self.xp.issubdtype(kind, self.xp.floating):
            kind = self.xp.result_type(float)
        kind = self.xp.promote_types(kind, SHORTEST)
        return [self.xp.asarray(value, kind) for value in given]

    def constants(self, numbers: Mapping[str, AnyArray], like: Any) -> dict[str, Any]:
        """Return arrays of NumPy as arrays of the type of ``like``, or integers."""
        with self.jax.ensure_compile_time_eval():  # else a constant of a trace would outlive it
            return {
                name: self.xp.asarray(each, like.dtype if each.dtype.kind == "f" else "int32")
                for name, each in numbers.items()
            }

    def with_slopes(
        self, value: Callable[..., Any], slopes: Callable[..., Any], fixed: int
    ) -> Callable[..., Any]:
        """Return a function that JAX differentiates by its slopes."""
        function = self.jax.custom_jvp(value)

        @function.defjvp  # type: ignore[untyped-decorator]  # JAX may not be there
        def slope(given: Any, moved: Any) -> Any:
            steps = zip(slopes(*given), moved[fixed:], strict=True)
            return function(*given), sum(steep * step for steep, step in steps)

        return function  # type: ignore[no-any-return]


class _Torch:
    """PyTorch, whose names are those of the standard but for ``take`` and ``astype``."""

    def __init__(self) -> None:
        self.torch = importlib.import_module("torch")
        self.xp = self

    def __getattr__(self, name: str) -> Any:
        """Return a function of PyTorch."""
        return getattr(self.torch, name)

    def take(self, values: Traced, index: Any, axis: int) -> Traced:
        """Return values at an index of one axis."""
        taken: Traced = self.torch.index_select(values, axis, index.long())
        return taken

    def astype(self, values: Any, kind: object) -> Traced:
        """Return values of another type."""
        changed: Traced = values.to(kind)
        return changed

    def arrays(self, values: Iterable[object]) -> list[Any]:
        """Return numbers and arrays as arrays of one type and place."""
        given = [*map(_plain, values)]
        tensors = [v if library_of(v) else self.torch.tensor(v) for v in filter(_is_array, given)]
        kind = reduce(self.torch.promote_types, (tensor.dtype for tensor in tensors))
        if not kind.is_floating_point:
            kind = self.torch.get_default_dtype()
        kind = self.torch.promote_types(kind, getattr(self.torch, SHORTEST))
        place = next(value.device for value in given if library_of(value))
        return [
            value.to(place, kind)
            if library_of(value)
            else self.torch.tensor(value, dtype=kind, device=place)
            for value in given
        ]

    def constants(self, numbers: Mapping[str, AnyArray], like: Any) -> dict[str, Any]:
        """Return arrays of NumPy as arrays of the type and place of ``like``, or integers."""
        with self.torch.inference_mode(False):  # else no gradient could pass them later
            return {
                name: self.torch.tensor(
                    each,
                    dtype=like.dtype if each.dtype.kind == "f" else self.torch.int32,
                    device=like.device,
                )
                for name, each in numbers.items()
            }

    def compile_late(self, function: Callable[..., Any]) -> Callable[..., Any]:
        """Return the function unchanged: a user who compiles calls torch.compile."""
        return function

    def with_slopes(
        self, value: Callable[..., Any], slopes: Callable[..., Any], fixed: int
    ) -> Callable[..., Any]:
        """Return a function as it is: PyTorch differentiates what it has computed."""
        return value


def _plain(value: Any) -> Any:
    """Return an array of NumPy of a type that other libraries have; other values as they are."""
    if isinstance(value, np.ndarray | np.generic) and not (
        value.dtype.isnative and value.dtype.itemsize <= 8
    ):
        return value.astype(np.float64)
    return value


def _is_array(value: object) -> bool:
    """Return whether a value sets the type of the answer: numbers and lists beside it do not."""
    return isinstance(value, np.ndarray) or bool(library_of(value))


@cache
def find_library(name: str) -> TracingLibrary:
    """Return the library of a package, ``"jax"`` or ``"torch"``, which is imported."""
    return _Torch() if name == "torch" else _Jax()


def read_numbers(library: str, name: str, value: Any, rule: Rule, remedy: str = "") -> Any:
    """Return the checked numbers of an argument; None if they are traced, hence unknown.

    Raises
    ------
    ValueError
        If a number breaks the rule, or the array is of another library.
    """
    if library_of(value) not in ("", library):
        other = f"must be numbers or an array of {library}, as the others"
        raise refuse(name, value, other, "give arrays of one package")
    if not library_of(value):
        return real(name, value, rule=rule, remedy=remedy, empty=True)
    try:
        numbers = numbers_of(value)
    except TypeError as error:  # sparse tensors raise
        raise refuse(name, value, f"cannot be read: {error}", remedy) from error
    if numbers is not None:
        return real(name, numbers, rule=rule, remedy=remedy, empty=True)
    if any(word in str(value.dtype) for word in NO_NUMBERS):  # a traced array has a type
        raise refuse(name, value, "must be a real number", remedy)
    return None
