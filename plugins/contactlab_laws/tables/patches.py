"""The evaluator of tables: a polynomial of two or three coordinates on each patch.

A patch is a polynomial by powers of its coordinates less an origin of its own. The table knows the
patch of a place, and its coordinates there.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from functools import cache, cached_property
from typing import Any, TypeAlias

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.types import Array

Numbers = NDArray[np.int16]

#: Fewer places than this are computed from gathered terms, a kilobyte for each, so many at once as
#: fit into the cache; more are sorted by patch, which costs some 3 us a patch.
FEW, GATHERED = 2000, 200
#: Sorted places taken together, which fit into the cache.
STRETCH = 8192
#: Single places of a patch after which its polynomial is compiled, which costs a millisecond.
COMPILED = 100


@attrs.frozen(eq=False, slots=False)
class Patches:
    """Polynomials by patch.

    Attributes
    ----------
    origins : array, shape (coordinates, patches)
    terms : array, shape (patches, n, m) or (patches, n, m, l)
        By powers of a (rows), b and c; 0 where they are left out.
    needed : list of list of int
        Powers of a that are left in each patch, and products of powers of the others.
    """

    origins: Array
    terms: Array
    needed: list[list[int]]

    @cached_property
    def table(self) -> Array:
        """The terms as matrices, shape (patches, n, products of powers of the others)."""
        return self.terms.reshape(*self.terms.shape[:2], -1)

    def values(self, patch: Numbers, a: Array, *others: Array) -> Array:
        """Return the values at places, shape (places,)."""
        by = self._sort if patch.size >= FEW else self._gather
        return by(patch, a, *others)

    def _sort(self, patch: Numbers, *at: Array) -> Array:
        """Return values, patch by patch: a product for each, the rest for whole stretches."""
        order = np.argsort(patch, kind="stable")
        counts = np.bincount(patch, minlength=len(self.terms))
        stops = counts.cumsum()
        origins = [np.repeat(origin, counts) for origin in self.origins]
        g = np.empty_like(at[0])
        # room for all stretches: new memory for each would take longer than the rest
        room = np.empty((2, max(self.table.shape[1:]), min(STRETCH, g.size)), g.dtype)
        for first in range(0, g.size, STRETCH):
            stretch = slice(first, first + STRETCH)
            who = order[stretch]
            x, *others = (each[who] for each in at)
            for each, origin in zip((x, *others), origins, strict=True):
                each -= origin[stretch]
            run = slice(patch[who[0]], patch[who[-1]] + 1)
            rows, columns = (max(needed[run]) for needed in self.needed)
            y_powers = self._products(others, room[0, :columns, : x.size])
            sums, start = room[1, :rows, : x.size], 0
            for terms, stop in zip(
                self.table[run, :rows, :columns],
                np.minimum(stops[run] - first, x.size).tolist(),
                strict=True,
            ):
                if stop > start:
                    np.matmul(terms, y_powers[:, start:stop], out=sums[:, start:stop])
                    start = stop
            g[who] = _horner(sums, x)
        return g

    def _products(self, others: Sequence[Array], out: Array) -> Array:
        """Return the products of powers of the coordinates but the first, in ``out``."""
        if len(others) == 1:
            return powers(others[0], out)
        shape = *self.terms.shape[2:], others[0].size
        y, z = (
            powers(each, np.empty((count, each.size), each.dtype))
            for each, count in zip(others, shape[:2], strict=True)
        )
        np.multiply(y[:, None], z, out=out.reshape(shape))
        return out

    def _gather(self, patch: Numbers, *at: Array) -> Array:
        """Return values at places in any order."""
        local, size = np.concatenate(at), patch.size
        local -= self.origins.take(patch, axis=1).reshape(-1)
        room = np.empty((max(self.terms.shape[1:]), local.size), local.dtype)
        all_powers = powers(local, room).reshape(-1, len(at), size).swapaxes(0, 1)
        x_powers, y_powers, *more = (
            each[:count] for each, count in zip(all_powers, self.terms.shape[1:], strict=True)
        )
        for each in more:
            y_powers = (y_powers[:, None] * each).reshape(-1, size)
        y_powers, rows = y_powers.T.copy()[..., None], len(x_powers)
        sums = np.empty((size, rows, 1), local.dtype)
        for first in range(0, size, GATHERED):
            part = slice(first, first + GATHERED)
            np.matmul(self.table.take(patch[part], axis=0), y_powers[part], out=sums[part])
        return np.asarray(np.einsum("nk,kn->n", sums[..., 0], x_powers))

    @cached_property
    def single(self) -> list[Callable[[float, float], float]]:
        """The value of each patch as a function of plain floats a and b."""
        single: list[Callable[[float, float], float]] = []
        for patch, (origin, terms) in enumerate(zip(self.origins.T, self.terms, strict=True)):
            rows, columns = (needed[patch] for needed in self.needed)
            single.append(Single(origin, terms[:rows, :columns], single, patch))
        return single


#: The value of a patch at plain numbers a and b.
Value: TypeAlias = Callable[[float, float], float]


class Single:
    """A patch of two coordinates in plain numbers, until it is worth compiling.

    Parameters
    ----------
    origin : array, shape (2,)
    terms : array, shape (n, m)
    all_of_them : list or dict
        Where it stands at ``patch``, and where its compiled form will.
    patch : int
    """

    def __init__(
        self, origin: Array, terms: Array, all_of_them: list[Value] | dict[int, Value], patch: int
    ) -> None:
        self.left, self.low = origin.tolist()
        self.rows = terms[::-1, ::-1].tolist()  # from the highest power down
        self.patch, self.all_of_them, self.calls = patch, all_of_them, 0

    def __call__(self, a: float, b: float) -> float:
        """Return the value by Horner's rule; soon by one expression, the same to the last bit."""
        self.calls += 1
        if self.calls >= COMPILED:  # of two threads both may
            text = _horner_text([_horner_text(row, "y") for row in self.rows], "x")
            lines = f"x = a - {self.left!r}", f"y = b - {self.low!r}"
            self.all_of_them[self.patch] = _compile("a, b", *lines, f"return {text}")
        x, y, total = a - self.left, b - self.low, 0.0
        for row in self.rows:
            inner = 0.0
            for term in row:
                inner = inner * y + term
            total = total * x + inner
        return total


def _horner_text(terms: Sequence[object], argument: str) -> str:
    """Return Horner's rule in Python, of numbers or texts from the highest power down."""
    text = f"{terms[0]}"
    for term in terms[1:]:
        text = f"({text}) * {argument}" + (f" + ({term})" if term else "")
    return text


def _compile(arguments: str, *lines: str) -> Callable[..., float]:
    """Return a function of the lines."""
    names: dict[str, Any] = {}
    exec("\n ".join((f"def function({arguments}):", *lines)), names)
    function: Callable[..., float] = names["function"]
    return function


def compile_polynomial(terms: Array) -> Callable[[float], float]:
    """Return the polynomial with ``terms``, lowest first, as a function of a plain float."""
    text = _horner_text(terms[::-1].tolist(), "x")
    function: Callable[[float], float] = _compile("x", f"return {text}")
    return function


def powers(argument: Array, out: Array) -> Array:
    """Return powers from 0, a row each, in ``out``, two rows at least."""
    out[0] = 1.0
    out[1] = argument
    for power in range(2, len(out)):
        np.multiply(out[power - 1], argument, out=out[power])
    return out


def _horner(terms: Array, argument: Array) -> Array:
    """Return polynomials with ``terms`` of their own, lowest first; ``terms`` are lost."""
    total: Array = terms[-1]
    for term in terms[-2::-1]:
        total *= argument
        total += term
    return total


def polynomial(terms: Array, argument: Array) -> Array:
    """Return the polynomial with ``terms``, lowest first, by Horner's rule."""
    total = np.full_like(argument, terms[-1])
    for term in terms[-2::-1].tolist():
        total *= argument
        total += term
    return total


@cache
def powers_of_chebyshev(count: int, *, stretch: float, shift: float) -> Array:
    """Return the matrix from terms by T_k(stretch x - shift) to terms by powers of x, exact."""
    matrix = np.zeros((count, count))
    matrix[0, 0] = 1.0
    matrix[:2, 1] = -shift, stretch
    for k in range(2, count):
        matrix[1:, k] = 2.0 * stretch * matrix[:-1, k - 1]
        matrix[:, k] -= 2.0 * shift * matrix[:, k - 1] + matrix[:, k - 2]
    return matrix


@cache
def nodes(count: int) -> Array:
    """Return Chebyshev's nodes in [0, 1], ascending."""
    return np.asarray(0.5 - 0.5 * np.cos(np.pi * (np.arange(count) + 0.5) / count))


@cache
def chebyshev_of_values(count: int) -> Array:
    """Return the matrix from values at the nodes to Chebyshev coefficients."""
    k = np.arange(count)
    matrix = np.cos(np.pi * np.outer(k, k + 0.5) / count) * (2.0 / count)
    matrix[0] *= 0.5
    return matrix * (-1.0) ** k[:, None]


def count_terms(sizes: Array, small: float) -> NDArray[np.intp]:
    """Return how many Chebyshev terms are needed, one at least; those left out sum to ``small``.

    Parameters
    ----------
    sizes : array, shape (patches, terms)
        Sizes of the terms along a coordinate.
    small : float
    """
    left = np.cumsum(sizes[:, ::-1], axis=1)[:, ::-1]
    return np.asarray(np.maximum(np.count_nonzero(left > small, axis=1), 1))
