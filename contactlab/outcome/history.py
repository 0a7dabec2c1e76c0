"""The history of an impact, recorded only on request."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.numeric.names import attributes_told
from contactlab.outcome.columns import components

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.figures.style import Width

Array = NDArray[np.float64]


def _column(unit: str) -> Any:
    """Return an attribute with its unit."""
    return attrs.field(metadata={"unit": unit})


@attrs.frozen(kw_only=True, eq=False, repr=False)
class Instants:
    """Base of histories: arrays over the instants of an impact, and fields over the contact."""

    time: Array = _column("s")
    approach: Array = _column("m")
    normal_velocity: Array = _column("m/s")
    normal_force: Array = _column("N")
    contact_radius: Array = _column("m")
    slip_velocity: Array = _column("m/s")
    tangential_force: Array = _column("N")
    fields: dict[str, NDArray[Any]] = attrs.field(factory=dict)

    def columns(self) -> dict[str, Array]:
        """Return the columns with one number for each instant, by name."""
        return {name: getattr(self, name) for name in _names()}

    @staticmethod
    def unit(name: str) -> str:
        """Return the unit of a column."""
        return str(getattr(attrs.fields(Instants), name).metadata["unit"])


@attributes_told
@attrs.frozen(kw_only=True, eq=False, repr=False)
class History(Instants):
    """Arrays over the instants of an impact, shape (K, ...): instants first, then the batch.

    ``tangential_force`` is positive where it opposes a positive slip velocity.
    """

    def __repr__(self) -> str:
        """Return the number of instants, the last time and the fields."""
        if not self.time.size:
            return "History(no instants)"
        fields = ", ".join(self.fields) or "no fields"
        return f"History({len(self.time)} instants to {np.max(self.time):.4g} s; {fields})"

    def plot(self, *, axes: Axes | None = None, width: Width | None = None) -> Axes:
        """Draw the forces over time on ``axes``, or on a new figure of ``matplotlib.pyplot``.

        A new figure fills ``width`` columns of a page, ``"one"`` or ``"two"``.
        """
        from contactlab.figures.results import draw_history  # matplotlib only when drawing

        return draw_history(axes, self, width=width)


@attrs.frozen(kw_only=True, eq=False, repr=False)
class EccentricHistory(Instants):
    """Arrays over the instants of an eccentric impact, shape (K, ...), and (K, ..., 2) of vectors.

    Vectors have components along t1 and t2; a force that opposes the slip is positive.
    """

    def columns(self) -> dict[str, Array]:
        """Return the columns with one number for each instant, by name."""
        named = super().columns().items()
        parts = (components(name, column, self.time.shape) for name, column in named)
        return {name: column for part in parts for name, column in part}

    @staticmethod
    def unit(name: str) -> str:
        """Return the unit of a column."""
        return Instants.unit(next(column for column in _names() if name.startswith(column)))

    def __repr__(self) -> str:
        """Return the number of instants and the last time."""
        last = np.max(self.time, initial=0.0)
        return f"EccentricHistory({len(self.time)} instants to {last:.4g} s)"


class NoHistory:
    """History of a run that kept none: False as a condition; its attributes say what to write."""

    def __bool__(self) -> Literal[False]:
        """Return False."""
        return False

    def __repr__(self) -> str:
        """Return what to write to have a history."""
        return "NoHistory(run(scene, history=True) keeps one)"

    def __getattr__(self, name: str) -> Any:
        """Raise an ``AttributeError`` that says what to write."""
        if name.startswith("__"):  # copying and pickling look for methods
            raise AttributeError(name)
        raise AttributeError(
            f"history.{name}: this run kept no history; write run(scene, history=True), or "
            "history='fields' for traction, stick and slip too"
        )


NO_HISTORY = NoHistory()


def _names() -> list[str]:
    """Return the names of the columns with one number for each instant, in order."""
    return [item.name for item in attrs.fields(Instants) if item.name != "fields"]


class Recorder:
    """An observer that keeps every sample of a flat batch, with fields if ``with_fields``.

    ``stepwise`` asks for a march step by step, which fields need in any case.
    """

    def __init__(
        self, shape: tuple[int, ...], *, with_fields: bool = False, stepwise: bool = False
    ) -> None:
        self._shape, self._with_fields = shape, with_fields
        self.stepwise = stepwise or with_fields
        self._rows: list[tuple[Any, ...]] = []
        self._fields: list[dict[str, Any]] = []

    def __call__(self, sample: Any) -> None:
        """Keep the sample of one instant."""
        time, approach, rate, contact, slip_velocity, force, *_ = sample
        row = (time, approach, rate, contact.force, contact.radius, slip_velocity, force)
        self._rows.append(row)
        if self._with_fields:
            self._fields.append(dict(sample.fields()))

    def history(self, kind: type[Any] = History) -> Any:
        """Return the history of the samples; its arrays have length 0 if there are none."""
        shape, count = self._shape, len(self._rows)
        batch = (math.prod(shape),) if shape else ()  # what is recorded has one axis
        columns = {}
        for index, name in enumerate(_names()):
            first = np.shape(self._rows[0][index]) if count else ()
            column = np.empty((count, *np.broadcast_shapes(first, batch)))
            for instant, row in enumerate(self._rows):
                column[instant] = row[index]
            columns[name] = column.reshape(-1, *shape) if len(shape) > 1 else column
        keys = self._fields[0] if self._fields else {}
        fields = {key: np.array([entry[key] for entry in self._fields]) for key in keys}
        if len(shape) > 1:
            fields = {
                key: field.reshape(-1, *shape, *field.shape[2:]) for key, field in fields.items()
            }
        return kind(**columns, fields=fields)
