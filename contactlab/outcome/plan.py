"""The plan of an impact: what is computed, what is left out, and cautions."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any, NamedTuple, TypeAlias, TypeVar

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.arrays import consecutive, every, merge_parts, share, some, take
from contactlab.numeric.types import Index, Json, Real

Mask = NDArray[np.bool_]
T = TypeVar("T")
#: Parts of a batch: masks or slices, each with what belongs to its impacts.
Parts: TypeAlias = Sequence[tuple[Any, T]]

#: Codes of clauses that programs look for: the march of the tangential motion, the declared or
#: undeclared numerical error of psi2, and spin about the normal.
TANGENTIAL_MOTION, PSI2_ERROR = "tangential_motion", "psi2_error"
NORMAL_SPIN = "normal_spin"
#: Words beside an error of psi2 where bodies spin about the normal.
WITHOUT_SPIN = "without spin about the normal"
#: Codes of impacts without a whole-impact answer: marched, without an end of the normal motion, and
#: unknown. Other codes are places in the reasons.
MARCHED, ENDLESS, UNKNOWN = -1, -2, -3


class Reason(NamedTuple):
    """The reason why impacts are not marched.

    Attributes
    ----------
    text : str
    unchecked : bool
        True if the energy books close by construction.
    fields : bool
        True if there are fields for a history all the same.
    """

    text: str
    unchecked: bool = False
    fields: bool = False


class PlanColumns(NamedTuple):
    """The plan of each impact as numbers.

    Attributes
    ----------
    code : int or array of int
        Place in ``reasons``, or ``MARCHED``, ``ENDLESS``, ``UNKNOWN``.
    psi2_error : float or array
        Declared bound of the numerical error of psi2; NaN where it is not declared.
    reasons : tuple of Reason
    restitution_error : float or array
        Declared bound of the numerical error of the normal restitution; NaN as before.
    """

    code: int | NDArray[np.integer]
    psi2_error: Real
    reasons: tuple[Reason, ...] = ()
    restitution_error: Real = math.nan

    @classmethod
    def nothing(cls, shape: tuple[int, ...]) -> PlanColumns:
        """Return the columns of impacts without a plan."""
        code = np.full(shape, UNKNOWN, dtype=np.int16)
        unknown = np.full(shape, math.nan) if shape else math.nan
        return cls(code, unknown, (), unknown)

    @classmethod
    def join(cls, parts: Sequence[PlanColumns], shape: tuple[int, ...]) -> PlanColumns:
        """Return the columns of a batch of ``shape`` from those of its parts, in order."""
        if len(parts) == 1 and np.shape(parts[0].code) == shape == np.shape(parts[0].psi2_error):
            return parts[0]
        places = consecutive(np.size(part.code) for part in parts)
        return cls.merge(list(zip(places, parts, strict=True)), shape)

    @classmethod
    def merge(cls, parts: Parts[PlanColumns], shape: tuple[int, ...]) -> PlanColumns:
        """Return the columns of a batch of ``shape`` from places and the columns of parts."""
        reasons = tuple(dict.fromkeys(reason for _, part in parts for reason in part.reasons))
        codes = []
        for where, part in parts:
            numbers = [reasons.index(reason) for reason in part.reasons]
            codes.append((where, np.array([*numbers, UNKNOWN, ENDLESS, MARCHED])[part.code]))
        errors = (
            merge_parts([(where, getattr(part, name)) for where, part in parts], shape)
            for name in ("psi2_error", "restitution_error")
        )
        psi2_error, restitution_error = errors
        code = np.asarray(merge_parts(codes, shape, np.int16), dtype=np.int16)
        return cls(code, psi2_error, reasons, restitution_error)

    def take(self, part: Index) -> PlanColumns:
        """Return the columns of some impacts of a batch."""
        psi2, restitution = (
            take(error, np.shape(self.code), part)
            for error in (self.psi2_error, self.restitution_error)
        )
        return PlanColumns(np.asarray(self.code)[part], psi2, self.reasons, restitution)

    @property
    def marched(self) -> Mask:
        """True for impacts whose tangential motion an integrator follows."""
        return np.asarray(self.code == MARCHED)

    @property
    def unchecked(self) -> bool | NDArray[np.bool_]:
        """True for impacts whose energy books close by construction; an array for a batch."""
        each = [reason.unchecked for reason in self.reasons]
        where = np.array([*each, False, False, False])[self.code]
        return where if where.ndim else bool(where)

    def to_arrays(self) -> dict[str, Any]:
        """Return arrays of numbers and text, for a file."""
        return self._asdict() | {"reasons": np.array(json.dumps(self.reasons))}

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Any]) -> PlanColumns:
        """Return the columns from the arrays of ``to_arrays``."""
        reasons = tuple(Reason(*each) for each in json.loads(str(arrays["reasons"])))
        return cls(arrays["code"], arrays["psi2_error"], reasons, arrays["restitution_error"])


class Clause(NamedTuple):
    """A statement of a plan: its words, its impacts, and the values in the words.

    Attributes
    ----------
    text : str
        The words; if there are ``values``, a format string for them.
    where : array of bool
        Impacts that the statement is about; an array of the batch shape.
    values : tuple of float or array, or None
        Numbers to format into ``text``; an array of the batch shape stands for its largest entry
        among the impacts. None if ``text`` is not a format string.
    code : str
        Subject of the statement, for programs: a constant of this module, or empty.
    """

    text: str
    where: Mask
    values: tuple[Any, ...] | None = None
    code: str = ""

    @property
    def words(self) -> str:
        """The statement without its share of a batch."""
        if self.values is None:
            return self.text
        return self.text.format(*(_largest(value, self.where) for value in self.values))

    def __str__(self) -> str:
        """Return the statement with its share of a batch."""
        if every(self.where):
            return self.words
        head, colon, tail = self.words.partition(": ")
        return f"{head} ({share(self.where)}){colon}{tail}"

    def take(self, part: Index) -> Clause:
        """Return the clause for some of the impacts."""
        values = self.values
        if values is not None:
            values = tuple(take(value, self.where.shape, part) for value in values)
        return self._replace(where=np.asarray(self.where[part]), values=values)


Clauses = tuple[Clause, ...]
#: Clauses of the three kinds.
Words = tuple[Clauses, Clauses, Clauses]
#: The attributes of a plan that hold clauses.
KINDS = ("computed", "left_out", "cautions")


@attrs.frozen(eq=False, slots=False)  # frozen slots are slow to fill
class Plan:
    """The plan of an impact or a batch: what is computed, what is left out and why, and cautions.

    Parameters
    ----------
    columns : PlanColumns
    words : tuple of tuples of Clause, or callable
        Statements on what is computed, what is left out, and cautions; or a function that returns
        them, which is called when they are first read.
    """

    columns: PlanColumns
    _words: Words | Callable[[], Words] = ((), (), ())

    @property
    def words(self) -> Words:
        """The clauses of the three kinds."""
        words = self._words
        if callable(words):
            words = words()
            object.__setattr__(self, "_words", words)
        return words

    @property
    def marched(self) -> Mask:
        """Impacts whose tangential motion an integrator follows, an array of the batch shape."""
        return self.columns.marched

    @property
    def psi2_error(self) -> Real:
        """Bound of the numerical error of psi2, as the laws and the integrator declare it.

        NaN where it is not declared. The errors of the model are not in it: see ``cautions``.
        """
        return self.columns.psi2_error

    @property
    def restitution_error(self) -> Real:
        """Bound of the numerical error of ``normal_restitution``; NaN where it is not declared."""
        return self.columns.restitution_error

    @property
    def unchecked(self) -> bool | NDArray[np.bool_]:
        """True for impacts whose energy books close by construction; an array for a batch."""
        return self.columns.unchecked

    @property
    def computed(self) -> Clauses:
        """Statements on what is computed; ``str`` of a clause gives its words."""
        return self.words[0]

    @property
    def left_out(self) -> Clauses:
        """Statements on what is left out, and why."""
        return self.words[1]

    @property
    def cautions(self) -> Clauses:
        """Doubts about the model or its numbers; each says which of the two."""
        return self.words[2]

    def change(
        self,
        *,
        computed: Clauses | None = None,
        left_out: Clauses | None = None,
        cautions: Clauses | None = None,
        psi2_error: Real | None = None,
    ) -> Plan:
        """Return the plan with other clauses of a kind, or another ``psi2_error``.

        Parameters
        ----------
        computed, left_out, cautions : tuple of Clause, optional
        psi2_error : float or array, optional
        """
        columns, words = self.columns, self.words
        if psi2_error is not None:
            columns = columns._replace(psi2_error=psi2_error)
        new = (
            words[0] if computed is None else computed,
            words[1] if left_out is None else left_out,
            words[2] if cautions is None else cautions,
        )
        return Plan(columns, new)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how a copy is made: with the clauses as they are when read."""
        return Plan, (self.columns, self.words)

    def __str__(self) -> str:
        """Return the plan in words, a line a sentence."""
        lines = [f"computed: {sentence}" for sentence in self.computed]
        lines += [f"left out: {sentence}" for sentence in self.left_out]
        lines += [f"caution: {sentence}" for sentence in self.cautions]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the words of ``str``."""
        import html  # for notebooks only

        return f"<pre>{html.escape(str(self))}</pre>"

    def to_dict(self) -> dict[str, Json]:
        """Return the sentences as plain lists, and the declared error."""
        from contactlab.outcome.columns import json_value  # a run needs none of this

        words = {kind: list(map(str, getattr(self, kind))) for kind in KINDS}
        errors = ("psi2_error", "restitution_error")
        return {**words, **{name: json_value(getattr(self, name)) for name in errors}}

    def __getitem__(self, index: Index) -> Plan:
        """Return the plan of some impacts of a batch: the clauses that hold for any of them."""
        parts = (tuple(clause.take(index) for clause in kind) for kind in self.words)
        computed, left_out, cautions = (
            tuple(part for part in kind if some(part.where)) for kind in parts
        )
        return Plan(self.columns.take(index), (computed, left_out, cautions))

    @classmethod
    def merge(cls, parts: Parts[Plan], shape: tuple[int, ...]) -> Plan:
        """Return the plan of a batch of ``shape`` from places and the plans of parts."""
        columns = PlanColumns.merge([(where, plan.columns) for where, plan in parts], shape)
        said = ([(where, getattr(plan, kind)) for where, plan in parts] for kind in KINDS)
        computed, left_out, cautions = (_merge_clauses(clauses, shape) for clauses in said)
        return cls(columns, (computed, left_out, cautions))


def _merge_clauses(parts: Parts[Clauses], shape: tuple[int, ...]) -> Clauses:
    """Return the clauses of all parts; those of the same text and code are one."""
    same: dict[tuple[str, str], Clause] = {}
    for place, clauses in parts:
        for clause in clauses:
            values = clause.values and tuple(np.full(shape, math.nan) for _ in clause.values)
            empty = clause._replace(where=np.zeros(shape, dtype=bool), values=values)
            whole = same.setdefault((clause.text, clause.code), empty)
            whole.where[place] |= clause.where
            for entries, more in zip(whole.values or (), clause.values or (), strict=True):
                entries[place] = np.fmax(entries[place], more)
    return tuple(same.values())


def _largest(value: Real, where: Mask) -> float:
    """Return the largest entry of an array among the impacts; a plain number as it is."""
    if isinstance(value, float):
        return value
    chosen = value[np.broadcast_to(where, value.shape)]
    return float(np.fmax.reduce(chosen, initial=math.nan))  # NaN if no entry is known
