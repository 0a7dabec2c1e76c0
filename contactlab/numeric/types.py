"""Types of numbers, and where each is written.

Inside the house a number, or an array with one value for each impact, is a ``Real``; where only
arrays come it is an ``Array``, and where only numbers come a ``float``. ``Mask`` is the same of
bool; ``Index`` takes a part of a batch; ``Places`` are indices in an array. A function that gives a
float for a float and an array for an array is annotated with ``Kind`` on both sides, and one that
gives back whatever it is given with ``Tree``. Numbers of a result and of its motion are ``Each``,
those of rigid bodies ``Either``. At a door, where a user's numbers are checked, an argument is
``Numbers``: whatever NumPy makes real numbers of. An array of any type of NumPy is ``AnyArray``.
A value of any type is an ``object``; ``Any`` stays where the code uses a value of unknown type.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from types import EllipsisType
from typing import TYPE_CHECKING, Any, Protocol, TypeAlias, TypeVar

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[np.float64]
#: A number or an array of numbers: laws accept both.
Real: TypeAlias = float | Array
#: A bool or an array of bool.
Mask: TypeAlias = bool | np.bool_ | NDArray[np.bool_]
#: Vectors of a plane as complex numbers: one, or one for each impact; those along x are real.
Complex: TypeAlias = complex | NDArray[np.inexact]
#: Indices in an array.
Places: TypeAlias = NDArray[np.intp]
#: A ``Real`` of a rigid body, which programs read: checkers take it for either.
#: The user knows which it is, and of a ``Real`` would have to say so in each line.
Either: TypeAlias = Any
#: What takes a part of a batch.
_Place: TypeAlias = int | slice | EllipsisType
Index: TypeAlias = _Place | tuple[_Place, ...] | Mask | Places
#: Components of a vector, or of one for each impact; and the rows of a tensor.
Vector: TypeAlias = Sequence[Real]
Rows: TypeAlias = Sequence[Vector]
#: An array of any type of NumPy: numbers, bools, codes, words.
AnyArray: TypeAlias = NDArray[np.generic]

#: A number of Python or NumPy; a bool is none, but checkers take it for an int.
Number: TypeAlias = float | np.floating | np.integer
_Row: TypeAlias = Number | NDArray[np.floating | np.integer]
#: Arrays, lists and tuples of real numbers; ranges too.
Many: TypeAlias = (
    NDArray[np.floating | np.integer]
    | Sequence[_Row]
    | Sequence[Sequence[_Row]]
    | Sequence[Sequence[Sequence[_Row]]]
)


class Labelled(Protocol):
    """An array of another library: of xarray, pandas, dask, JAX or PyTorch."""

    def __array__(self) -> NDArray[np.generic]: ...


class Column(Labelled, Protocol):
    """A column of a table, of pandas or xarray; an array of NumPy is none, for its kind counts."""

    @property
    def values(self) -> object: ...  # noqa: D102


#: Arguments that are read as real numbers where the answer is of NumPy.
Plain: TypeAlias = Number | Many
#: Arguments that are read as real numbers, columns of tables too.
Numbers: TypeAlias = Plain | Column

#: Numbers, words, lists and tables, as a file of JSON has them.
Json: TypeAlias = "bool | int | float | str | Sequence[Json] | Mapping[str, Json] | None"

#: A float, or an array: the same on both sides of a function.
Kind = TypeVar("Kind", float, Array, Real)
#: A number, an array, or an object of such: the same on both sides of a function.
Tree = TypeVar("Tree")
#: Numbers of a result: ``float`` of one impact, ``Array`` of a batch, and ``Any`` where no checker
#: knows which: a scene is one impact or a batch by its numbers, and by those of its bodies and
#: their materials.
if TYPE_CHECKING:  # a default needs Python 3.13, or a checker
    from typing_extensions import TypeVar as WithDefault

    Each = WithDefault("Each", bound=Real, default=Any, covariant=True)
else:
    Each = TypeVar("Each", covariant=True)
