"""Measured impacts: what was given before, and what was found after."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.fitting.csv_rows import read_rows
from contactlab.fitting.headings import ERROR, Heading, read_heading
from contactlab.numeric.checks import real, refuse
from contactlab.scene_file import SceneFile

Array = NDArray[np.float64]


@attrs.frozen(kw_only=True, eq=False)
class Measurements:
    """A table of measured impacts, a row an impact.

    Attributes
    ----------
    given : mapping of str to array, shape (n,)
        What was set: entries of a scene file such as ``angle_deg``, in its units.
    measured : mapping of str to array, shape (n,)
        What was found: quantities of a result, in their units; NaN where one was not measured.
    errors : mapping of str to array, shape (n,)
        Standard errors of those quantities for which they are known.
    unused : tuple of str
        Columns that a fit does not need.
    source : str
    """

    given: Mapping[str, Array]
    measured: Mapping[str, Array]
    errors: Mapping[str, Array]
    unused: tuple[str, ...] = ()
    source: str = ""

    def __len__(self) -> int:
        """Return the number of impacts."""
        return len(next(iter(self.measured.values())))

    def only(self, quantities: Sequence[str] | None) -> Measurements:
        """Return the measurements of some quantities, and of those impacts that have any.

        Raises
        ------
        ValueError
            If one of them was not measured.
        """
        if quantities is None:
            return self
        for name in quantities:
            if name not in self.measured:
                raise refuse(
                    "quantities", name, "was not measured", f"had: {', '.join(self.measured)}"
                )
        measured = {name: self.measured[name] for name in quantities}
        rows = np.any([np.isfinite(values) for values in measured.values()], axis=0)
        return attrs.evolve(
            self,
            given={name: values[rows] for name, values in self.given.items()},
            measured={name: values[rows] for name, values in measured.items()},
            errors={name: e[rows] for name, e in self.errors.items() if name in measured},
        )


def read_measurements(content: object) -> Measurements:
    """Return measurements from a CSV file, a mapping of columns, or the series of a scene file.

    Parameters
    ----------
    content : path, mapping or SceneFile
        Headings are names with units, ``rebound_spin (rad/s)``: entries of a scene before the
        impact, quantities of a result after it, as exports write them. ``(1)`` may be left out,
        and the unit of what ends in ``_deg``. ``<quantity>_error`` holds standard errors.

    Raises
    ------
    ValueError
        If the file cannot be read, or a heading or a number is not understood, with its place.
    """
    if isinstance(content, Measurements):
        return content
    if isinstance(content, SceneFile):
        return _of_scene_file(content)
    if isinstance(content, Mapping):
        return _made(dict(content), "")
    if isinstance(content, str | Path):
        return _of_csv(Path(content))
    raise refuse("measurements", content, "must be a CSV file, or a mapping of columns")


def _of_csv(path: Path) -> Measurements:
    headings, rows = read_rows(path)
    columns: dict[str, list[float]] = {heading: [] for heading in headings}
    if len(columns) < len(headings):
        raise ValueError(f"{path}: two columns have the same heading")
    try:
        roles = {heading: read_heading(heading) for heading in headings}
        for line, row in rows:
            if len(row) != len(headings):
                told = f"has {len(row)} columns, the headings are {len(headings)}"
                raise ValueError(f"line {line}: {told}")
            for heading, cell in zip(headings, row, strict=True):
                columns[heading].append(_number(cell, heading, roles[heading], line))
        return _made(columns, str(path))
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _number(cell: str, heading: str, role: Heading, line: int) -> float:
    """Return the number in a cell; NaN where it is missing and may be.

    Parameters
    ----------
    cell : str
        As it stands in the file.
    heading : str
        Of its column, for the refusal.
    role : Heading
        What the column is for.
    line : int
        Of the file, the first being 1.
    """
    if role.role == "unused" or (not cell.strip() and role.role != "given"):
        return float("nan")
    try:
        return float(cell)
    except ValueError:
        told = "is empty" if not cell.strip() else f"{cell!r} is not a number"
        raise ValueError(f"line {line}, {heading!r}: {told}") from None


def _made(columns: dict[str, Any], source: str) -> Measurements:
    """Return measurements of columns by their headings."""
    parts: dict[str, dict[str, Array]] = {"given": {}, "measured": {}, "error": {}}
    unused: list[str] = []
    for text, content in columns.items():
        role, name, factor = read_heading(str(text))
        if role == "unused":
            unused.append(str(text))
            continue
        if name in parts[role]:
            raise ValueError(f"heading {text!r}: {name} is there twice")
        parts[role][name] = _column(str(text), content, gaps=role != "given") * factor
    _complete(parts, unused)
    return Measurements(
        given=parts["given"],
        measured=parts["measured"],
        errors=parts["error"],
        unused=tuple(unused),
        source=source,
    )


def _column(text: str, content: Any, *, gaps: bool) -> Array:
    values = np.atleast_1d(np.asarray(content))
    if values.ndim != 1 or values.dtype.kind not in "iuf" or not values.size:
        raise refuse(text, content, "must be a list of numbers", "one for each impact")
    values = values.astype(np.float64)
    if gaps and np.isnan(values).any():
        if np.isinf(values).any():
            raise refuse(text, content, "must be finite", "leave out what was not measured")
        return values
    return np.atleast_1d(real(text, values))


def _complete(parts: dict[str, dict[str, Array]], unused: list[str]) -> None:
    """Check that the columns belong together, and make the velocities from an angle."""
    given, measured, errors = parts["given"], parts["measured"], parts["error"]
    if {"speed", "normal_speed"} & set(given):
        # Formed with the friction and stiffness that are sought, as an export has them.
        for part, name in ((given, "psi1"), (given, "chi"), (measured, "psi2")):
            if part.pop(name, None) is not None:
                unused.append(name)
    if not measured:
        raise ValueError("nothing was measured: no column is a quantity of a rebound")
    lengths = {name: len(values) for part in parts.values() for name, values in part.items()}
    if len(set(lengths.values())) > 1:
        listed = ", ".join(f"{name} {length}" for name, length in lengths.items())
        raise ValueError(f"the columns must be of equal length; they have {listed}")
    for name, values in measured.items():
        if np.isnan(values).all():
            raise ValueError(f"{name}: holds no number at all")
    for name, values in errors.items():
        if name not in measured:
            raise ValueError(f"{name}{ERROR}: there is no column {name}")
        if not np.all(values[np.isfinite(measured[name])] > 0.0):
            raise ValueError(f"{name}{ERROR}: must be positive wherever {name} was measured")
    if "angle_deg" in given and "tangential_velocity" in given:
        unused.append("angle_deg")  # as an export has it, beside the velocities
        del given["angle_deg"]
    elif "angle_deg" in given and "normal_speed" in given:
        slope = np.tan(np.radians(given.pop("angle_deg")))
        given["tangential_velocity"] = given["normal_speed"] * slope


def _of_scene_file(file: SceneFile) -> Measurements:
    """Return the series of a scene file, one below the other."""
    if not file.measured:
        raise ValueError(f"{file.path}: has no [[measured]] values; give a CSV file of them")
    if len({series.against for series in file.measured}) > 1:
        raise ValueError(
            f"{file.path}: its measured series vary different entries; give a CSV file"
        )
    names = list(dict.fromkeys(series.quantity for series in file.measured))
    sizes = [len(series.values) for series in file.measured]
    measured = {name: np.full(sum(sizes), np.nan) for name in names}
    first = 0
    for series, size in zip(file.measured, sizes, strict=True):
        measured[series.quantity][first : first + size] = series.values
        first += size
    return Measurements(
        given={file.measured[0].against: np.concatenate([series.x for series in file.measured])},
        measured=measured,
        errors={},
        source=str(file.path),
    )
