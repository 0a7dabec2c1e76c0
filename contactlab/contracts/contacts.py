"""Impulses, slip and work of the contacts of a gathering."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Self

import attrs

from contactlab.numeric.arrays import merge_parts
from contactlab.numeric.types import Array, Mask

#: Entries that are vectors along n, t1 and t2.
VECTORS = ("impulse", "moment")


@attrs.frozen(kw_only=True, eq=False)
class Contacts:
    """Results of each contact of a gathering; contacts are the last axis of the batch.

    Attributes
    ----------
    impulse : array, shape (..., C, 3)
        On the second body along n, t1 and t2, in N s.
    moment : array, shape (..., C, 3)
        The impulse of each instant times its time, summed, in N s²: constant forces did work by it.
    pushed : array, shape (..., C)
        Time in s for which constant forces acted.
    touches : array, shape (..., C)
        How often the surfaces met.
    first, last : array, shape (..., C)
        First and last touch in s; NaN of a contact that never closed.
    dissipation : array, shape (..., C)
        Energy in J that the normal law took.
    """

    impulse: Array
    moment: Array
    pushed: Array
    touches: Array
    first: Array
    last: Array
    dissipation: Array

    @classmethod
    def merge(
        cls, parts: Sequence[tuple[slice | Mask, Contacts | None]], shape: tuple[int, ...]
    ) -> Self:
        """Return the contacts of a batch of ``shape`` from places and parts; NaN elsewhere.

        Parameters
        ----------
        parts, shape
            As of ``BatchMotion.merge``.
        """

        def column(name: str) -> Array:
            trailing = (3,) if name in VECTORS else ()
            values = [
                (where, math.nan if part is None else getattr(part, name)) for where, part in parts
            ]
            return merge_parts(values, shape, float, trailing)

        return cls(**{field.name: column(field.name) for field in attrs.fields(cls)})
