"""Shared parts of the motions of batches: numbers, statuses, and the joining of parts."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Mapping, Sequence
from functools import cache
from typing import Any, Self

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Details, Status
from contactlab.numeric.arrays import are_zeros, consecutive, merge_parts, spread_object, zeros
from contactlab.numeric.types import Mask, Real

#: Entries of motions that are no numbers.
NO_NUMBERS = ("status", "detail", "counters", "normal", "contacts")


@attrs.frozen(kw_only=True, eq=False, slots=False)  # frozen slots are slow to fill
class BatchMotion:
    """Base of the motions of one impact or of a batch: numbers, and how the runs ended.

    Attributes
    ----------
    status : Status or array of Status
    detail : str or array of str
    counters : mapping of str to int
    """

    status: Any = Status.SUCCESS
    detail: Details = ""
    counters: Mapping[str, int] = attrs.field(factory=dict)

    def __attrs_post_init__(self) -> None:
        if isinstance(self.status, Status):
            return  # faster than np.ndim for one impact
        if isinstance(self.detail, str) and np.ndim(self.status):
            details = np.full(np.shape(self.status), "", dtype=object)
            if self.detail:
                details[self.status != Status.SUCCESS] = self.detail
            object.__setattr__(self, "detail", details)

    @classmethod
    @cache
    def numbers(cls) -> tuple[str, ...]:
        """Return the names of the entries that are numbers."""
        fields = attrs.fields(cls)
        return tuple(field.name for field in fields if field.name not in NO_NUMBERS)

    @classmethod
    @cache
    def _entries_with(cls, word: str) -> frozenset[str]:
        """Return the names of the entries that have a word: ``vectors`` of the plane, ``rare``."""
        fields = attrs.fields(cls)
        return frozenset(field.name for field in fields if word in field.metadata)

    @classmethod
    def join(cls, motions: Sequence[Self], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape`` from the motions of consecutive parts of the batch.

        Parameters
        ----------
        motions : sequence of motions
            Motions of single impacts or of batches, in the order of the impacts.
        shape : tuple of int
            Shape of the whole batch.
        """
        if len(motions) == 1 and shape and np.shape(motions[0].status) == shape:
            return motions[0]
        places = consecutive(np.size(motion.status) for motion in motions)
        return cls.merge(list(zip(places, motions, strict=True)), shape)

    @classmethod
    def merge(cls, parts: Sequence[tuple[slice | Mask, Self]], shape: tuple[int, ...]) -> Self:
        """Return one motion of ``shape`` from pairs of a place and the motion of its impacts.

        An impact in several parts has the motion of the last of these parts.

        Parameters
        ----------
        parts : sequence of (array of bool or slice, motion)
            Masks of shape ``shape``, or slices of the batch in C order, each with the motion of
            its impacts.
        shape : tuple of int
            Shape of the whole batch.
        """
        counters: Counter[str] = Counter()
        for _, motion in parts:
            counters.update(motion.counters)
        entries: dict[str, Any] = {}
        for name in (*cls.numbers(), "status", "detail"):
            columns = [(where, getattr(motion, name)) for where, motion in parts]
            if name in cls._entries_with("rare") and all(are_zeros(value) for _, value in columns):
                entries[name] = zeros(shape)
                continue
            trailing: tuple[int, ...] = ()
            if name in cls._entries_with("vectors"):
                axes = [np.ndim(motion.status) for _, motion in parts]
                columns, trailing = _vectors_alike(columns, axes)
            kind = float if name in cls.numbers() else object
            entries[name] = merge_parts(columns, shape, kind, trailing)
        return cls(**entries, counters=dict(counters))

    @classmethod
    def nothing(
        cls,
        shape: tuple[int, ...],
        status: Status,
        detail: str | Sequence[str] | NDArray[np.object_] = "",
        *,
        axes: tuple[int, ...] = (),
    ) -> Self:
        """Return the motion of impacts without a computation: numbers are NaN, counts 0.

        Parameters
        ----------
        shape : tuple of int
            Batch shape.
        status : Status
            Status of all impacts.
        detail : str, or sequence or array of str
            One sentence for all impacts, or one for each.
        axes : tuple of int
            Axes of a slip velocity beside the batch's: (2,) where the scene has vectors.
        """
        entries: dict[str, Any] = {}
        for name in cls.numbers():
            whole = (*shape, *axes) if name in cls._entries_with("vectors") else shape
            entries[name] = np.full(whole, math.nan) if whole else math.nan
        return cls(
            **entries,
            status=spread_object(status, shape),
            detail=detail if isinstance(detail, str) else np.array(detail, dtype=object),
        )

    def failing(self, where: Mask, status: Status, detail: Details) -> Self:
        """Return this motion with another status for the successful impacts that ``where`` marks.

        Parameters
        ----------
        where : bool or array of bool
            The impacts that fail; those that had failed before keep status and detail.
        status : Status
            New status.
        detail : str or array of str
            One sentence for all these impacts, or one for each impact of the batch.
        """
        statuses = np.array(self.status, dtype=object)
        failing = np.asarray(where) & (statuses == Status.SUCCESS)
        if not failing.any():
            return self
        if not statuses.shape:
            return attrs.evolve(self, status=status, detail=detail)
        statuses[failing] = status
        return attrs.evolve(
            self, status=statuses, detail=np.where(failing, detail, self.detail).astype(object)
        )


def _vectors_alike(
    columns: list[tuple[slice | Mask, Real]], axes: list[int]
) -> tuple[list[tuple[slice | Mask, Real]], tuple[int, ...]]:
    """Return places and values, all as vectors if any value is one, and the axes of each value."""
    longer = [np.ndim(value) > batch for (_, value), batch in zip(columns, axes, strict=True)]
    if not any(longer):
        return columns, ()
    # a part without an answer holds NaN, a number, in place of vectors
    alike = [
        (where, value if own else np.multiply.outer(value, np.ones(2)))
        for (where, value), own in zip(columns, longer, strict=True)
    ]
    return alike, (2,)
