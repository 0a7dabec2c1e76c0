"""The history of an impact, recorded only on request."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Any, Literal, Never, Protocol

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.tangential_motion import Sample
from contactlab.impact.scene import Scene
from contactlab.numeric.names import tell_attributes
from contactlab.numeric.types import AnyArray, Array, Json, Real
from contactlab.outcome.motion import Motion
from contactlab.outcome.tabled import Plotted

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from contactlab.outcome.sheet import Sheet
    from contactlab.outcome.style import Width


@tell_attributes
@attrs.frozen(kw_only=True, eq=False, repr=False)
class History(Plotted):
    """Arrays over the instants of an impact, shape (K, ...): instants first, then the batch.

    ``tangential_force`` is positive where it opposes a positive slip velocity. Where the scene has
    vectors, both have components along t1 and t2, shape (K, ..., 2). ``last_axis`` is what the last
    axis of ``time`` counts.
    """

    time: Array = attrs.field(metadata={"unit": "s"})
    approach: Array = attrs.field(metadata={"unit": "m"})
    normal_velocity: Array = attrs.field(metadata={"unit": "m/s"})
    normal_force: Array = attrs.field(metadata={"unit": "N"})
    contact_radius: Array = attrs.field(metadata={"unit": "m"})
    slip_velocity: Array = attrs.field(metadata={"unit": "m/s"})
    tangential_force: Array = attrs.field(metadata={"unit": "N"})
    fields: dict[str, NDArray[Any]] = attrs.field(factory=dict)
    last_axis: str = "impact"

    def columns(self) -> dict[str, Array]:
        """Return the columns with one number for each instant, by name."""
        from contactlab.outcome.columns import components  # runs keep no history

        named = ((name, getattr(self, name)) for name in _names())
        parts = (components(name, column, self.time.shape) for name, column in named)
        return {name: column for part in parts for name, column in part}

    @staticmethod
    def unit(name: str) -> str:
        """Return the unit of a column, or of a component of one."""
        column = name if name in _names() else name.rpartition("_")[0]
        return str(getattr(attrs.fields(History), column).metadata["unit"])

    def part(self, index: int | slice) -> History:
        """Return the history of some impacts of a batch."""
        columns = {name: getattr(self, name)[:, index] for name in _names()}
        fields = {name: field[:, index] for name, field in self.fields.items()}
        return History(**columns, fields=fields)

    def _sheet(self) -> Sheet:
        from contactlab.outcome.sheet import Sheet, batch_axes

        shape, columns = self.time.shape, self.columns()
        axes: dict[str, AnyArray | None] = {"instant": None}
        if len(shape) == 1:  # instants that all columns share
            axes = {"time": columns.pop("time")}
        elif self.last_axis == "contact":
            axes |= batch_axes(shape[1:-1], "gathering") | {"contact": None}
        else:
            axes |= batch_axes(shape[1:], self.last_axis)
        units = {name: self.unit(name) for name in ("time", *columns)}
        return Sheet(columns, units, axes, shape, row="instant")

    def to_dict(self) -> dict[str, Json]:
        """Return columns and fields by name as plain lists, None for numbers not finite."""
        from contactlab.outcome.columns import json_value

        return super().to_dict() | {name: json_value(each) for name, each in self.fields.items()}

    def __repr__(self) -> str:
        """Return the number of instants, the last time and the fields."""
        if not self.time.size:
            return "History(no instants)"
        fields = ", ".join(self.fields) or "no fields"
        return f"History({len(self.time)} instants to {np.max(self.time):.4g} s; {fields})"

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw one column over another, by default both forces over time."""
        if x is not None or y is not None:
            from contactlab.outcome.sheet_figure import draw_sheet

            return draw_sheet(axes, self._sheet(), x or "time", y, width=width, course=True)
        from contactlab.outcome.history_figure import draw_history  # matplotlib only when drawing

        return draw_history(axes, self, width=width)


class NoHistory:
    """History of a run that kept none: False as a condition; its attributes say what to write."""

    def __reduce__(self) -> str:
        """Return the name of the one object there is, for copies."""
        return "NO_HISTORY"

    def __bool__(self) -> Literal[False]:
        """Return False."""
        return False

    def __repr__(self) -> str:
        """Return what to write to have a history."""
        return "NoHistory(history=True keeps one)"

    def __getattr__(self, name: str) -> Never:
        """Raise an ``AttributeError`` that says what to write."""
        if name.startswith("__"):  # copying and pickling look for methods
            raise AttributeError(name)
        raise AttributeError(
            f"history.{name}: this run kept no history; write run(scene, history=True), or "
            "history='fields' for traction, stick and slip too; of several contacts "
            "collide(gathering, history=True)"
        )


NO_HISTORY = NoHistory()


def _names() -> list[str]:
    """Return the names of the columns with one number for each instant, in order."""
    return [item.name for item in attrs.fields(History) if "unit" in item.metadata]


class WithHistory(Protocol):
    """A result with a history."""

    @property
    def scene(self) -> Scene:
        """The scene."""

    @property
    def motion(self) -> Motion:
        """Its motion, with the duration and the greatest force."""

    @property
    def history(self) -> History | NoHistory:
        """The history."""


def scale_forces(result: WithHistory) -> tuple[Array, Array, Array]:
    """Return t/duration, F/(mu P_max) and P/P_max of an impact with a history, from first touch.

    In space F is the length of the force.
    """
    scene, history = result.scene, result.history
    peak = float(result.motion.maximum_force)
    time = np.concatenate([[0.0], history.time / result.motion.duration])
    force = history.tangential_force
    force = np.linalg.norm(force, axis=-1) if force.ndim > history.time.ndim else force
    tangential = force / (scene.friction_coefficient * peak)
    normal = history.normal_force / peak
    return time, np.concatenate([[0.0], tangential]), np.concatenate([[0.0], normal])


class Recorder:
    """An observer that keeps every sample of a flat batch, with fields if ``with_fields``.

    ``stepwise`` asks for a march step by step, which fields need in any case.
    """

    def __init__(
        self, shape: tuple[int, ...], *, with_fields: bool = False, stepwise: bool = False
    ) -> None:
        self._shape, self._with_fields = shape, with_fields
        self.stepwise = stepwise or with_fields
        self._rows: list[tuple[Real, ...]] = []
        self._fields: list[dict[str, NDArray[Any]]] = []

    def __call__(self, sample: Sample) -> None:
        """Keep the sample of one instant."""
        time, approach, rate, contact, slip_velocity, force, *_ = sample
        row = (time, approach, rate, contact.force, contact.radius, slip_velocity, force)
        self._rows.append(row)
        if self._with_fields:
            self._fields.append(dict(sample.fields()))

    def history(self) -> History:
        """Return the history of the samples; its arrays have length 0 if there are none."""
        shape, count = self._shape, len(self._rows)
        batch = (math.prod(shape),) if shape else ()  # records have one axis
        columns: dict[str, Array] = {}
        for index, name in enumerate(_names()):
            first = np.shape(self._rows[0][index]) if count else ()
            vectors = first[len(batch) :]  # of a slip velocity or force in space
            whole = np.broadcast_shapes(first[: len(batch)], batch)
            column = np.empty((count, *whole, *vectors))
            for instant, row in enumerate(self._rows):
                column[instant] = row[index]
            columns[name] = column.reshape(-1, *shape, *vectors) if len(shape) > 1 else column
        keys = self._fields[0] if self._fields else {}
        fields = {key: np.array([entry[key] for entry in self._fields]) for key in keys}
        if len(shape) > 1:
            fields = {
                key: field.reshape(-1, *shape, *field.shape[2:]) for key, field in fields.items()
            }
        return History(**columns, fields=fields, last_axis="impact")
