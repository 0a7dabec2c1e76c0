"""Conversions of every result: plain numbers, frames, data sets, a notebook's view, a figure."""

from __future__ import annotations

from abc import abstractmethod
from typing import TYPE_CHECKING, overload

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from pandas import DataFrame
    from xarray import Dataset

    from contactlab.numeric.types import Json
    from contactlab.outcome.sheet import Sheet
    from contactlab.outcome.style import Width

    class OwnAxes(Axes):
        """Axes of a new figure, and not of a part of one."""

        figure: Figure


class Tabled:
    """Base of results that have columns: one list of columns serves every conversion."""

    __slots__ = ()

    @abstractmethod
    def _sheet(self) -> Sheet:
        """Return the columns with their axes and units."""

    def to_dict(self) -> dict[str, Json]:
        """Return the columns by name as plain numbers, lists and text, None where not finite."""
        from contactlab.outcome.columns import json_value

        sheet = self._sheet()
        axes = {name: values for name, values in sheet.axes.items() if values is not None}
        return {name: json_value(values) for name, values in (axes | {**sheet.columns}).items()}

    def to_dataframe(self) -> DataFrame:
        """Return a ``pandas.DataFrame``, units in ``.attrs["units"]``; axes are its index."""
        from contactlab.outcome.frames import to_dataframe

        return to_dataframe(self._sheet())

    def to_xarray(self) -> Dataset:
        """Return an ``xarray.Dataset`` with units, one dimension for each axis."""
        from contactlab.outcome.frames import to_xarray

        return to_xarray(self._sheet())

    def _repr_html_(self) -> str:
        """Return what a notebook shows: the words of ``str``."""
        import html  # for notebooks only

        return f"<pre>{html.escape(str(self))}</pre>"


class Plotted(Tabled):
    """Base of results whose columns are drawn over each other."""

    __slots__ = ()

    @overload
    def plot(
        self, x: str | None = ..., y: str | None = ..., *, axes: Axes, width: Width | None = ...
    ) -> Axes: ...
    @overload
    def plot(
        self,
        x: str | None = ...,
        y: str | None = ...,
        *,
        axes: None = ...,
        width: Width | None = ...,
    ) -> OwnAxes: ...
    def plot(
        self,
        x: str | None = None,
        y: str | None = None,
        *,
        axes: Axes | None = None,
        width: Width | None = None,
    ) -> Axes:
        """Return axes with ``y`` over ``x``; without these names, the usual figure of the result.

        The usual figure is psi2 over psi1 of a batch or a folder, forces over time where a history
        was kept, and friction force over displacement of a load path.

        Parameters
        ----------
        x, y : str, optional
            Columns of ``to_dataframe``; of impacts angles also in degrees (``rebound_angle_deg``).
        axes : Axes, optional
            Axes to draw on; a new figure of ``matplotlib.pyplot`` by default.
        width : {"one", "two"}, optional
            Columns of a page that a new figure fills.

        Raises
        ------
        ValueError
            If there is no such column, it holds no numbers, or one impact has no history.
        """
        return self._draw(axes, x, y, width)

    def _draw(self, axes: Axes | None, x: str | None, y: str | None, width: Width | None) -> Axes:
        """Draw one column over another."""
        from contactlab.outcome.sheet_figure import draw_sheet  # matplotlib only when drawing

        return draw_sheet(axes, self._sheet(), x, y, width=width)
