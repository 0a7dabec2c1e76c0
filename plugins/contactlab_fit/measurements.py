"""Measured impacts, read from a CSV file, a mapping of columns, or a scene file."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

import attrs
import numpy as np

from contactlab.numeric.checks import check_place, real, refuse
from contactlab.numeric.names import nearest
from contactlab.numeric.types import Array
from contactlab.scene_file import SceneFile
from contactlab_fit.conventions import ForeignHeadingsError
from contactlab_fit.csv_columns import (
    ERROR,
    UnknownHeadingError,
    list_names,
    measurable,
    name_and_unit,
    read_columns,
    read_heading,
    read_text,
)
from contactlab_fit.drops import TAKEN, find_drops, restitutions, tell_restitutions
from contactlab_fit.foreign_headings import foreign
from contactlab_fit.struck import VELOCITY, to_the_struck_body


@attrs.frozen(kw_only=True, eq=False)
class Measurements:
    """A table of measured impacts, a row an impact.

    Attributes
    ----------
    given : mapping of str to array, shape (n,)
        Entries of a scene before the impact such as ``angle_deg``, in the units of a scene file.
    measured : mapping of str to array, shape (n,)
        Quantities of a result after the impact, in their units; NaN where not measured.
    errors : mapping of str to array, shape (n,)
        Standard errors of measured quantities.
    unused : tuple of str
        Columns that a fit does not need.
    source : str
        Path of the file; empty for a mapping.
    notes : tuple of str
        Sentences on impacts and columns that were left out.
    struck : tuple of str
        Columns of the struck body's motion, to whose surface velocities are relative.
    taken : tuple of str
        Sentences on numbers that were taken where no column has them.
    thrown : mapping of str to array, shape (n,)
        For a film without an angle, the ``velocity`` along the floor in the first flight of each
        throw and its standard ``error``, in m/s; empty otherwise.
    headings : mapping of str to tuple of str
        Heading of each column, sign, ``"-"`` or empty, and unit that its name was given with.
    """

    given: Mapping[str, Array]
    measured: Mapping[str, Array]
    errors: Mapping[str, Array]
    unused: tuple[str, ...] = ()
    source: str = ""
    notes: tuple[str, ...] = ()
    struck: tuple[str, ...] = ()
    taken: tuple[str, ...] = ()
    thrown: Mapping[str, Array] = attrs.field(factory=dict)
    headings: Mapping[str, tuple[str, str, str]] = attrs.field(factory=dict)

    def __len__(self) -> int:
        """Return the number of impacts."""
        return len(next(iter(self.measured.values())))

    def rename(self, name: str, alias: str) -> str:
        """Return HEADING=ALIAS, which reads the column of a quantity under another name.

        A minus sign turns the present numbers.
        """
        heading, sign, unit = self.headings.get(name, ("HEADING", "", ""))
        if unit and not alias.endswith(("_deg", ")")):
            alias = f"{alias} ({unit})"
        return f"{heading}={sign}{alias}".replace("=--", "=")

    def only(self, quantities: Sequence[str] | None) -> Measurements:
        """Return the measurements of some quantities, without impacts that have none of them.

        Raises
        ------
        ValueError
            If a quantity was not measured.
        """
        if quantities is None:
            return self
        for name in quantities:
            if name not in self.measured:
                known = self.measured if name in measurable() else measurable()
                near = nearest(name, self.measured) or nearest(name, known)
                had = f"{near}had: {', '.join(self.measured)}"
                raise refuse("quantities", name, "was not measured", had)
        measured = {name: self.measured[name] for name in quantities}
        rows = np.any([np.isfinite(values) for values in measured.values()], axis=0)
        return attrs.evolve(
            self,
            given={name: values[rows] for name, values in self.given.items()},
            measured={name: values[rows] for name, values in measured.items()},
            errors={name: e[rows] for name, e in self.errors.items() if name in measured},
            thrown={name: values[rows] for name, values in self.thrown.items()},
        )


def read_measurements(
    content: str | Path | Mapping[str, object] | SceneFile | Measurements,
    *,
    columns: Mapping[str, str] | Sequence[str] | None = None,
) -> Measurements:
    """Return measurements from a CSV file, a mapping of columns, or the series of a scene file.

    Parameters
    ----------
    content : path, mapping or SceneFile
        Each heading is a name and its unit, ``rebound_spin (rad/s)`` or ``rebound_spin_rad_s``:
        an entry of a scene before the impact, or a quantity of a result after the impact. The
        unit ``(1)`` may be left out. ``<quantity>_error`` holds standard errors. A column whose
        heading begins with ``#`` is not read. A column of unknown meaning is left out with a
        note; one whose heading looks like other words for a quantity is refused with its name
        here, to be confirmed by ``columns``. For a dropped ball either ``drop_height`` and
        ``bounce_height``, or the times ``t_bounce`` of its taps on the floor, give the normal
        restitution and the speed of each bounce.
    columns : mapping of str to str, or sequence of str, optional
        Names for headings of another kind: ``{"impact angle [deg]": "incidence_angle"}``. The
        unit is that of the name, else that of the heading. ``"-rebound_spin"`` turns the sign,
        ``"#"`` leaves the column unread. A sequence names all columns of a CSV file in their
        order, with headings or without.

    Raises
    ------
    ValueError
        If the file cannot be read, or for a bad heading or number, with its place.
    """
    if isinstance(columns, str):
        raise refuse("columns", columns, "must be a list of names, or a mapping of headings")
    names: Mapping[str, str] | Sequence[str] = {}
    if isinstance(columns, Mapping):
        names = {text.strip(): name for text, name in columns.items()}
    elif columns is not None:
        names = list(columns)
    if isinstance(content, str | Path):
        return _from_csv(Path(content), names)
    if not isinstance(names, Mapping):
        raise refuse("columns", columns, "as a list are for a CSV file", "give a mapping")
    if isinstance(content, Mapping):
        return _from_columns(dict(content), names, "")
    if names:
        raise refuse("columns", names, "need a CSV file, or a mapping of columns")
    if isinstance(content, Measurements):
        return content
    if isinstance(content, SceneFile):
        return _from_scene_file(content)
    remedy = "of a DataFrame give frame.to_dict('list')"
    raise refuse("measurements", content, "must be a CSV file, or a mapping of columns", remedy)


def _from_csv(path: Path, names: Mapping[str, str] | Sequence[str]) -> Measurements:
    """Return the measurements of a CSV file; every refusal begins with its path."""
    text = read_text(path)
    try:
        columns, renamed, left_out = read_columns(text, names)
        table = _from_columns(columns, renamed, str(path))
        return attrs.evolve(table, notes=(*left_out, *table.notes))
    except ForeignHeadingsError as error:
        raise ForeignHeadingsError(f"{path}: {error.said}", error.readings) from None
    except ValueError as error:
        raise ValueError(f"{path}: {error}") from None


def _from_columns(
    columns: Mapping[str, object], names: Mapping[str, str], source: str
) -> Measurements:
    """Return measurements of columns by their headings."""
    headings = [str(text) for text in columns]
    stripped = [text.strip() for text in headings]
    for text in names:
        if text not in stripped:
            raise refuse("columns", text, "is not a heading", f"had: {', '.join(stripped)}")
    if drops := find_drops({text: names.get(text.strip(), text) for text in headings}):
        return _of_drops(columns, drops, source)
    parts: dict[str, dict[str, Array]] = {"given": {}, "measured": {}, "error": {}}
    heads: dict[str, tuple[str, str, str]] = {}
    unused: list[str] = []
    unknown: dict[str, object] = {}
    refused: list[str] = []
    for text, content in zip(headings, columns.values(), strict=True):
        try:
            role, name, factor, offset = read_heading(text, names)
        except UnknownHeadingError as error:
            if text.strip() in names:  # named by the user: no foreign heading
                refused.append(str(error))
            else:
                unknown[text] = content
            continue
        except ValueError as error:
            refused.append(str(error))
            continue
        if role == "unused":
            unused.append(text)
            continue
        if name in parts[role]:
            raise ValueError(f"heading {text!r}: {name} is there twice")
        numbers = column_of(text, content, gaps=role != "given") * factor
        parts[role][name] = numbers + offset if offset else numbers
        if role != "error":
            alias = names.get(text.strip(), "")
            unit = name_and_unit(alias.removeprefix("-"))[2] if alias else ""
            heads[name] = text.strip(), "-" if alias.startswith("-") else "", unit
    notes = foreign(unknown, parts["given"].keys() | parts["measured"].keys(), refused)
    given, measured, errors = parts.values()
    _leave_out_duplicates(given, measured, unused)
    if "psi2" in unused and not measured:
        raise ValueError(
            "nothing was measured: psi2 depends on friction, which was not measured; give "
            "tangential_restitution or rebound_tangential_velocity, or psi1 in place of the speed"
        )
    _check_columns(given, measured, errors, notes)
    struck = tuple(given.keys() & set(VELOCITY))
    if struck:
        to_the_struck_body(given, measured, errors)
    if "angle_deg" in given and "normal_speed" in given:
        slope = np.tan(np.radians(given.pop("angle_deg")))
        given["tangential_velocity"] = given["normal_speed"] * slope
    return Measurements(
        given=given,
        measured=measured,
        errors=errors,
        unused=tuple(unused),
        source=source,
        notes=notes,
        struck=struck,
        headings=heads,
    )


def _of_drops(
    columns: Mapping[str, object], drops: Mapping[str, tuple[str, float]], source: str
) -> Measurements:
    """Return the bounces of a ball that is dropped."""
    si = {
        name: column_of(text, columns[text], gaps=False) * factor
        for name, (text, factor) in drops.items()
    }
    speed, restitution = restitutions(si)
    used = {text for text, _ in drops.values()}
    return Measurements(
        given={"normal_speed": speed, "tangential_velocity": np.zeros_like(speed)},
        measured={"normal_restitution": restitution},
        errors={},
        unused=tuple(text for text in columns if text not in used),
        source=source,
        notes=(tell_restitutions(speed, restitution),),
        taken=TAKEN,
    )


def column_of(text: str, content: object, *, gaps: bool) -> Array:
    """Return the numbers of a column, shape (n,); NaN only if it may have gaps."""
    check_place(text, content)
    try:
        values = np.atleast_1d(np.asarray(content))
    except Exception:  # rows of unequal length, sparse arrays, those of other devices
        values = np.empty(0)
    if values.ndim != 1 or values.dtype.kind not in "iuf" or not values.size:
        raise refuse(text, content, "must be a list of numbers", "one for each impact")
    values = values.astype(np.float64)
    if gaps and np.isnan(values).any():
        if np.isinf(values).any():
            raise refuse(text, content, "must be finite", "leave out what was not measured")
        return values
    return np.atleast_1d(real(text, values))


def _leave_out_duplicates(
    given: dict[str, Array], measured: dict[str, Array], unused: list[str]
) -> None:
    """Move columns of an export that other columns determine to the unused ones."""
    if {"speed", "normal_speed"} & set(given):
        # psi1, chi and psi2 are formed with the friction and stiffness that are fitted.
        for part, name in ((given, "psi1"), (given, "chi"), (measured, "psi2")):
            if part.pop(name, None) is not None:
                unused.append(name)
    if "angle_deg" in given and "tangential_velocity" in given:
        del given["angle_deg"]
        unused.append("angle_deg")


def _check_columns(
    given: dict[str, Array],
    measured: dict[str, Array],
    errors: dict[str, Array],
    notes: tuple[str, ...],
) -> None:
    """Refuse columns that do not belong together."""
    if not measured:
        remedy = "; ".join([*notes, f"{list_names()}name one by --column 'heading=...'"])
        raise ValueError(f"nothing was measured: no column describes a rebound; {remedy}")
    lengths = {name: len(values) for name, values in (given | measured).items()}
    lengths |= {f"{name}{ERROR}": len(values) for name, values in errors.items()}
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


def _from_scene_file(file: SceneFile) -> Measurements:
    """Return the series of a scene file, one below the other."""
    if not file.measured:
        raise ValueError(f"{file.path}: has no [[measured]] values; give a CSV file of them")
    entries = [series.entries for series in file.measured]
    if len({tuple(each) for each in entries}) > 1:
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
        given={name: np.concatenate([each[name] for each in entries]) for name in entries[0]},
        measured=measured,
        errors={},
        source=str(file.path),
    )
