"""Types of the array API standard: the functions that tables and impacts use."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Protocol, TypeAlias, TypeVar, Union

from contactlab.numeric.types import Array, Real


class Traced(Protocol):
    """An array of any library: numbers, bools or indices."""

    @property
    def shape(self) -> tuple[int, ...]:
        """Sizes of its axes."""

    @property
    def dtype(self) -> object:
        """Type of its entries, as the library has it."""

    def __getitem__(self, index: object, /) -> Traced: ...
    def __neg__(self) -> Traced: ...
    def __abs__(self) -> Traced: ...
    def __invert__(self) -> Traced: ...
    def __add__(self, other: Operand, /) -> Traced: ...
    def __radd__(self, other: Operand, /) -> Traced: ...
    def __sub__(self, other: Operand, /) -> Traced: ...
    def __rsub__(self, other: Operand, /) -> Traced: ...
    def __mul__(self, other: Operand, /) -> Traced: ...
    def __rmul__(self, other: Operand, /) -> Traced: ...
    def __truediv__(self, other: Operand, /) -> Traced: ...
    def __rtruediv__(self, other: Operand, /) -> Traced: ...
    def __pow__(self, other: Operand, /) -> Traced: ...
    def __and__(self, other: Operand, /) -> Traced: ...
    def __or__(self, other: Operand, /) -> Traced: ...
    def __lt__(self, other: Operand, /) -> Traced: ...
    def __le__(self, other: Operand, /) -> Traced: ...
    def __gt__(self, other: Operand, /) -> Traced: ...
    def __ge__(self, other: Operand, /) -> Traced: ...


#: The other operand of a sum or a comparison with an array.
Operand: TypeAlias = Union[float, "Traced"]
#: A float, or arrays of any library: the same on both sides of a function.
Computed = TypeVar("Computed", float, Array, Real, Traced)


class Library(Protocol):
    """The functions of the standard that are used."""

    nan: float
    int32: object

    def isfinite(self, x: Traced, /) -> Traced:
        """Return where numbers are finite."""

    def where(self, condition: Traced, x1: Operand, x2: Operand, /) -> Traced:
        """Return ``x1`` where the condition holds, else ``x2``."""

    def stack(self, arrays: Sequence[Traced], /, *, axis: int) -> Traced:
        """Return arrays side by side along a new axis."""

    def sum(self, x: Traced, /, *, axis: int) -> Traced:
        """Return sums along an axis."""

    def ones_like(self, x: Traced, /) -> Traced:
        """Return ones of the shape and type of ``x``."""

    def zeros_like(self, x: Traced, /) -> Traced:
        """Return zeros of the shape and type of ``x``."""

    def full(self, shape: tuple[int, ...], fill_value: float, *, dtype: object) -> Traced:
        """Return an array filled with a number."""

    def astype(self, x: Traced, dtype: object, /) -> Traced:
        """Return the entries in another type."""

    def take(self, x: Traced, indices: Traced, /, *, axis: int) -> Traced:
        """Return the entries at these indices of an axis."""

    def reshape(self, x: Traced, /, shape: tuple[int, ...]) -> Traced:
        """Return the entries in another shape."""
