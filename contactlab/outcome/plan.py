"""The plan of an impact: statements on what is computed and what is left out, and cautions."""

from __future__ import annotations

import html
import json
import math
import re
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.arrays import every, share, some, taken
from contactlab.numeric.checks import Real
from contactlab.outcome.columns import json_value

Mask = NDArray[np.bool_]

#: Codes of clauses that programs look for: the march of the tangential motion, the declared or
#: undeclared numerical error of psi2, and energy books that check nothing.
TANGENTIAL_MOTION, PSI2_ERROR, BOOKS = "tangential_motion", "psi2_error", "unchecked_books"
#: Entry of a plan whose friction work is a difference of energies.
UNCHECKED = (
    "check of the energy books: closed by construction, not checked; the friction work is the "
    "energy that the velocities lose"
)
#: A number within words: no part of a name or of another number.
NUMBER = re.compile(r"(?<![\w.{])\d+(?:\.\d+)?(?:e[+-]?\d+)?(?![\w}])")


class Span(NamedTuple):
    """A number in the words of a law, over all parts of a batch that say them.

    Attributes
    ----------
    low, high : float
    text : str
        The number as the law wrote it, shown while ``low`` is ``high``.
    """

    low: float
    high: float
    text: str

    def __str__(self) -> str:
        """Return the number, or the range as ``low..high``."""
        return self.text if self.low == self.high else f"{self.low:.4g}..{self.high:.4g}"


class Clause(NamedTuple):
    """A statement of a plan: words, the impacts that they are said of, and the values in them.

    Words are made when they are read. Clauses that differ in their numbers only are one.

    Attributes
    ----------
    text : str
        The words; if there are ``values``, a format string for them.
    where : array of bool
        Impacts that the statement is about; an array of the batch shape.
    values : tuple or None
        Values to format into ``text``: a ``Span``, a law, or an array of the batch shape, whose
        largest entry among the impacts is shown. None if ``text`` is not a format string.
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

    def take(self, part: Any) -> Clause:
        """Return the clause for some of the impacts."""
        values = self.values
        if values is not None:
            values = tuple(
                np.asarray(taken(value, self.where.shape, part))
                if isinstance(value, np.ndarray)
                else value
                for value in values
            )
        return self._replace(where=np.asarray(self.where[part]), values=values)

    @property
    def template(self) -> Clause:
        """The clause with every number of its words a value."""
        if self.values is not None and any(isinstance(v, np.ndarray | Span) for v in self.values):
            return self
        words = self.words
        numbers = NUMBER.findall(words)
        text = NUMBER.sub("{}", words.replace("{", "{{").replace("}", "}}"))
        spans = tuple(Span(float(number), float(number), number) for number in numbers)
        return Clause(text, self.where, spans, self.code)


Clauses = tuple[Clause, ...]
#: The attributes of a plan that hold clauses.
KINDS = ("computed", "left_out", "cautions")
ENTRIES = (*KINDS, "marched", "psi2_error")


@attrs.frozen(init=False, eq=False)
class Plan:
    """What will be computed, what is left out, and what to be wary of.

    Attributes
    ----------
    marched : bool or array of bool
        Impacts whose tangential motion an integrator follows.
    psi2_error : float or array
        Bound of the numerical error of psi2, as the laws and the integrator declare it; NaN where
        it is not declared. The errors of the model are not in it: see ``cautions``.
    """

    marched: Mask
    psi2_error: Real
    _clauses: tuple[Clauses, Clauses, Clauses] | None
    _late: Callable[[], tuple[Clauses, Clauses, Clauses]] | None

    def __init__(
        self,
        *,
        computed: Clauses = (),
        left_out: Clauses = (),
        cautions: Clauses = (),
        marched: Mask,
        psi2_error: Real = math.nan,
        late: Callable[[], tuple[Clauses, Clauses, Clauses]] | None = None,
    ) -> None:
        # ``late`` returns the clauses when they are first read, in place of those given.
        clauses = None if late is not None else (computed, left_out, cautions)
        self.__attrs_init__(marched, psi2_error, clauses, late)

    def _read(self) -> tuple[Clauses, Clauses, Clauses]:
        """Return the clauses of the three kinds."""
        if self._clauses is None:
            assert self._late is not None
            object.__setattr__(self, "_clauses", self._late())
            object.__setattr__(self, "_late", None)
            assert self._clauses is not None
        return self._clauses

    @property
    def computed(self) -> Clauses:
        """Statements on what is computed; ``str`` of a clause gives its words."""
        return self._read()[0]

    @property
    def left_out(self) -> Clauses:
        """Statements on what is left out, and why."""
        return self._read()[1]

    @property
    def cautions(self) -> Clauses:
        """Doubts about the model or its numbers; each says which of the two."""
        return self._read()[2]

    def changed(self, **entries: Any) -> Plan:
        """Return the plan with other clauses of a kind, or another ``psi2_error``.

        Parameters
        ----------
        **entries
            New values of ``computed``, ``left_out``, ``cautions``, ``marched`` or ``psi2_error``.
        """
        return Plan(**{name: getattr(self, name) for name in ENTRIES} | entries)

    def __reduce__(self) -> tuple[Any, ...]:
        """Return how a copy is made: with the clauses as they are when read."""
        return partial(Plan, **{name: getattr(self, name) for name in ENTRIES}), ()

    def __str__(self) -> str:
        """Return the plan in words, a line a sentence."""
        lines = [f"computed: {sentence}" for sentence in self.computed]
        lines += [f"left out: {sentence}" for sentence in self.left_out]
        lines += [f"caution:  {sentence}" for sentence in self.cautions]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the words of ``str``."""
        return f"<pre>{html.escape(str(self))}</pre>"

    @property
    def unchecked(self) -> Any:
        """True for impacts whose energy books close by construction; an array for a batch."""
        where = np.zeros(self.marched.shape, dtype=bool)
        for clause in self.left_out:
            if clause.code == BOOKS:
                where |= clause.where
        return where if where.ndim else bool(where)

    def to_dict(self) -> dict[str, Any]:
        """Return the sentences as plain lists, and the declared error."""
        return {
            "computed": list(map(str, self.computed)),
            "left_out": list(map(str, self.left_out)),
            "cautions": list(map(str, self.cautions)),
            "psi2_error": json_value(self.psi2_error),
        }

    def __getitem__(self, index: Any) -> Plan:
        """Return the plan of some impacts of a batch: the clauses that hold for any of them."""
        parts: dict[str, Any] = {
            kind: tuple(
                part
                for part in (clause.take(index) for clause in getattr(self, kind))
                if some(part.where)
            )
            for kind in KINDS
        }
        error = taken(self.psi2_error, self.marched.shape, index)
        return Plan(**parts, marched=self.marched[index], psi2_error=error)

    def to_arrays(self) -> dict[str, Any]:
        """Return the plan of a batch as arrays of numbers and text, for a file."""
        arrays: dict[str, Any] = {"marched": self.marched, "psi2_error": self.psi2_error}
        for kind in KINDS:
            clauses = [clause.template for clause in getattr(self, kind)]
            said = [
                (c.code, c.text, [None if isinstance(v, np.ndarray) else v for v in c.values or ()])
                for c in clauses
            ]
            arrays[kind] = np.array(json.dumps(said))
            arrays[f"{kind}_where"] = np.array([clause.where for clause in clauses], dtype=bool)
            values = [v for c in clauses for v in c.values or () if isinstance(v, np.ndarray)]
            arrays[f"{kind}_values"] = np.array(values, dtype=np.float64)
        return arrays

    @classmethod
    def from_arrays(cls, arrays: Mapping[str, Any]) -> Plan:
        """Return the plan that ``to_arrays`` was called of."""
        kinds: dict[str, Any] = {}
        for kind in KINDS:
            entries = iter(arrays[f"{kind}_values"])
            kinds[kind] = tuple(
                Clause(
                    text,
                    where,
                    tuple(next(entries) if v is None else Span(*v) for v in values),
                    code,
                )
                for (code, text, values), where in zip(
                    json.loads(str(arrays[kind])), arrays[f"{kind}_where"], strict=True
                )
            )
        return cls(**kinds, marched=arrays["marched"], psi2_error=arrays["psi2_error"])

    @classmethod
    def nothing(cls, shape: tuple[int, ...]) -> Plan:
        """Return the plan of impacts of which nothing is known."""
        return cls(computed=(), left_out=(), marched=np.zeros(shape, dtype=bool))

    @classmethod
    def joined(cls, plans: Sequence[Plan], shape: tuple[int, ...] = (-1,)) -> Plan:
        """Return the plan of a batch of ``shape`` from those of its parts, in order."""
        sizes = [plan.marched.size for plan in plans]
        if len(plans) == 1 and shape == (-1,) and np.shape(plans[0].psi2_error) == (*sizes,):
            return plans[0]
        errors = [
            np.broadcast_to(plan.psi2_error, size) for plan, size in zip(plans, sizes, strict=True)
        ]
        kinds: dict[str, Any] = {
            kind: _joined([getattr(plan, kind) for plan in plans], sizes) for kind in KINDS
        }
        return cls(
            **kinds,
            marched=np.concatenate([np.ravel(plan.marched) for plan in plans]).reshape(shape),
            psi2_error=np.concatenate(errors).reshape(shape),
        )


def _joined(parts: Sequence[Clauses], sizes: Sequence[int]) -> Clauses:
    """Return the clauses of all parts; clauses that differ in their numbers only are one."""
    same: dict[tuple[str, str], list[tuple[int, Clause]]] = {}
    for place, clauses in enumerate(parts):
        for clause in clauses:
            template = clause.template
            same.setdefault((template.code, template.text), []).append((place, template))
    ends = np.cumsum([0, *sizes])
    joined = []
    for (code, text), members in same.items():
        where = np.zeros(ends[-1], dtype=bool)
        columns = [
            list(column) for column in zip(*(m.values or () for _, m in members), strict=True)
        ]
        for place, member in members:
            where[ends[place] : ends[place + 1]] |= member.where
        slices = [slice(ends[place], ends[place + 1]) for place, _ in members]
        values = tuple(_value(column, slices, ends[-1]) for column in columns)
        joined.append(Clause(text, where, values, code))
    return tuple(joined)


def _value(column: Sequence[Any], slices: Sequence[slice], size: int) -> Any:
    """Return one value of a joined clause: the range of spans, or an array, NaN in other parts."""
    if isinstance(column[0], Span):
        low, high = min(span.low for span in column), max(span.high for span in column)
        return Span(low, high, column[0].text)
    values = np.full(size, np.nan)
    for part, entries in zip(slices, column, strict=True):
        values[part] = np.fmax(values[part], entries)
    return values


def _largest(value: Any, where: Mask) -> Any:
    """Return the largest entry of an array among the impacts; other values as they are."""
    if not isinstance(value, np.ndarray):
        return value
    chosen = value[np.broadcast_to(where, value.shape)]
    return float(np.fmax.reduce(chosen, initial=math.nan))  # NaN if no entry is known
