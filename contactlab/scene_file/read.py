"""Read a scene file; a refusal names file, key, value, rule and remedy."""

from __future__ import annotations

import os
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import attrs
import numpy as np

from contactlab.impact import batches
from contactlab.impact.encounter import Encounter
from contactlab.impact.gathering import Gathering
from contactlab.impact.scene import Scene
from contactlab.numeric.checks import real, refuse, yes_or_no
from contactlab.numeric.types import Numbers, Real
from contactlab.outcome.files import content
from contactlab.scene_file.build import build_scene
from contactlab.scene_file.entries import (
    BODY_SECTIONS,
    CARTESIAN,
    POLAR,
    entry_path,
    is_option,
    list_materials,
    replace_entry,
    with_materials,
    without_rivals,
)
from contactlab.scene_file.laws import LawChoice, read_laws
from contactlab.scene_file.measured import Measured, read_series
from contactlab.scene_file.quantities import read_units
from contactlab.scene_file.sweep import Sweep, read_sweep
from contactlab.scene_file.table import Table

#: Sections of a file of several contacts at once.
OF_GATHERINGS = ("bodies", "touches")
SECTIONS = (
    "about", "sphere", "body", "target", "impact", "nondimensional",
    "sweep", "simulation", "measured", *OF_GATHERINGS,
)  # fmt: skip
#: Deepest nesting of tables and lists.
DEEPEST = 20
ABOUT_KEYS = ("title", "citation", "notes")


@attrs.frozen(kw_only=True, eq=False)
class SceneFile:
    """The content of a scene file.

    Attributes
    ----------
    path : Path
    title, citation, notes : str
        From ``[about]``; empty by default.
    scene : Scene
        One impact, or the batch of a ``[sweep]``; a product of entries has ``axes``.
    varied : mapping of str to array
        Values of each entry that the sweep varies, shape (n,); empty for one impact.
    laws : LawChoice
        From ``[simulation]``.
    encounter : Encounter or None
        Encounter in space if the file gives vectors; ``scene`` lies in its plane of friction.
    gathering : Gathering or None
        Several contacts at once; ``scene`` is that of its contacts, which ``collide`` answers.
    measured : tuple of Measured
    materials : tuple of str
        Names of the materials that the file takes from the collection.
    defaulted : tuple of str
        Entries that stand in neither the file nor ``entries``, so that a default of the reader
        was taken.
    """

    path: Path
    title: str = ""
    citation: str = ""
    notes: str = ""
    scene: Scene
    varied: Mapping[str, Real]
    laws: LawChoice = attrs.field(factory=LawChoice)
    encounter: Encounter | None = None
    gathering: Gathering | None = None
    measured: tuple[Measured, ...] = ()
    materials: tuple[str, ...] = ()
    defaulted: tuple[str, ...] = ()
    tables: Mapping[str, object] = attrs.field(factory=dict, repr=False)

    @property
    def of_spheres(self) -> Scene:
        """The scene, or a refusal if friction changes the approach of any impact.

        Raises
        ------
        ValueError
            If it does.
        """
        if self.scene.inverse_mass is not None:
            rule = "friction changes the approach of its bodies"
            raise ValueError(
                f"{self.path}: {rule}; contactlab run, sweep, compare and animate run it"
            )
        return self.scene

    def scene_at(self, **entries: Numbers) -> Scene:
        """Return the file's scene without its sweep, with some entries replaced.

        ``scene_at(angle_deg=[5, 10])`` is a batch of two; entries of equal length vary
        together. A dotted entry is written ``**{"sphere.radius": [...]}``.
        """
        if self.gathering is not None:
            from contactlab.scene_file.gathering import read_gathering, read_path

            varied = {read_path(name): real(name, values) for name, values in entries.items()}
            return read_gathering(self.tables, varied).scene
        return _scene_with(self.tables, entries)[0]


def read_scene(
    path: str | Path,
    *,
    entries: Mapping[str, Numbers] | None = None,
    defaults: Mapping[str, float] | None = None,
    allow_code: bool = False,
) -> SceneFile:
    """Return scene, sweep, laws and measured values of a TOML file; nothing is imported.

    Parameters
    ----------
    path : path
    entries : mapping of str to float or array, optional
        Values that replace the file's own, and its sweep: ``{"angle_deg": [5, 10]}``.
    defaults : mapping of str to float, optional
        Values of entries that the file leaves out.
    allow_code : bool
        Let ``laws`` run a law in a Python file or in a module that the scene names,
        ``my_law.py:Stribeck``. Without it such a law is refused when it is made, and may be
        replaced before: ``file.laws.choose(tangential="springs")``.

    Raises
    ------
    ValueError
        If the file cannot be read, is not TOML (with the line), has an unknown key (with the
        nearest known key), or holds a value of the wrong type or not physical.
    """
    if not isinstance(path, str | os.PathLike) or not isinstance(os.fspath(path), str):
        raise refuse("path", path, "must be the path of a scene file", "such as 'scene.toml'")
    allow_code = yes_or_no("allow_code", allow_code)
    file = Path(path)
    if "\0" in str(path):
        raise refuse("path", path, "must not hold a null character")
    document = _document(file)
    try:
        document = read_units(document)
        root = Table(document, "", known=SECTIONS)
        about = Table(document.get("about", {}), "about", known=ABOUT_KEYS)
        if any(key in document for key in OF_GATHERINGS):
            return _of_gathering(file, root, about, entries, allow_code=allow_code)
        sweep = read_sweep(document.get("sweep", {}))
        tables = with_materials({key: root.content[key] for key in SECTIONS[1:6] if root.has(key)})
        own = tables
        varied: Mapping[str, Numbers] = sweep.varied
        if defaults:
            tables = _with_defaults(tables, defaults)
        if entries:
            tables = without_rivals(tables, entries)
            varied, sweep = dict(entries), Sweep(varied={}, axes={})
        scene, encounter = _scene_with(tables, varied)
        laws = read_laws(document.get("simulation", {}), file.parent, allow_code=allow_code)
        if of_laws := {name: each for name, each in varied.items() if is_option(name)}:
            laws = laws.set(of_laws)
        texts: dict[str, Any] = {key: about.text(key, default="") for key in ABOUT_KEYS}
        return SceneFile(
            path=file,
            **texts,
            scene=batches.over(scene, sweep.axes) if sweep.axes else batches.varying(scene, varied),
            encounter=encounter,
            varied={name: np.asarray(each, dtype=np.float64) for name, each in varied.items()},
            laws=laws,
            measured=read_series(document.get("measured", [])),
            materials=list_materials(document),
            defaulted=tuple(
                name
                for name in defaults or ()
                if name not in (entries or ()) and _has(tables, name) and not _has(own, name)
            ),
            tables=tables,
        )
    except ValueError as error:
        raise ValueError(f"{file}: {error}") from error


def _of_gathering(
    file: Path,
    root: Table,
    about: Table,
    entries: Mapping[str, Numbers] | None,
    *,
    allow_code: bool,
) -> SceneFile:
    """Return the file of several contacts at once."""
    from contactlab.scene_file.gathering import read_gathering, read_path

    document = root.content
    varied: Mapping[str, Real] = read_sweep(document.get("sweep", {}), read_path).varied
    if entries:
        varied = {read_path(name): real(name, values) for name, values in entries.items()}
    gathering = read_gathering(document, varied)
    bodies = document["bodies"]
    texts: dict[str, Any] = {key: about.text(key, default="") for key in ABOUT_KEYS}
    return SceneFile(
        path=file,
        **texts,
        scene=gathering.scene,
        gathering=gathering,
        varied=varied,
        laws=read_laws(document.get("simulation", {}), file.parent, allow_code=allow_code),
        measured=read_series(document.get("measured", [])),
        materials=list_materials(bodies, of=bodies),
        tables=document,
    )


def _scene_with(
    tables: Mapping[str, object], entries: Mapping[str, Numbers]
) -> tuple[Scene, Encounter | None]:
    """Return scene and encounter of the tables with some entries replaced."""
    size: tuple[int, ...] = ()
    for name, values in entries.items():
        path = entry_path(name)
        if is_option(path):
            size = np.broadcast_shapes(size, np.shape(np.asarray(values)))
            continue
        bodies = [section for section in BODY_SECTIONS if section in tables]
        if path.startswith("nondimensional.") and bodies and "nondimensional" not in tables:
            rule = f"is a number of a scene without bodies, and [{bodies[0]}] is one of bodies"
            remedy = f"vary angle_deg or tangential_velocity; or for {name} write no [{bodies[0]}]"
            raise ValueError(f"{name}: {rule}; {remedy}")
        tables = replace_entry(tables, path, real(path, values))
    scene, encounter = build_scene(tables)
    if not size or scene.shape:
        return scene, encounter
    # Only options of laws vary: one number of the scene is given for each impact.
    section = "nondimensional" if "nondimensional" in tables else "impact"
    inner = tables[section]
    assert isinstance(inner, Mapping)
    for key, value in inner.items():
        if isinstance(value, float | int):
            return build_scene(replace_entry(tables, f"{section}.{key}", np.full(size, value)))
    rule = "varies options of laws alone, and no number of [impact] can stand for each impact"
    raise ValueError(f"sweep: {rule}; give friction_coefficient as a number")


def _with_defaults(
    tables: Mapping[str, object], defaults: Mapping[str, float]
) -> dict[str, object]:
    """Return the tables with defaults for missing entries; ``[nondimensional]`` takes none.

    Velocities by size and angle are no defaults beside components, and neither beside vectors.
    """
    completed = dict(tables)
    if "nondimensional" in completed:
        return completed
    impact = tables.get("impact", {})
    vectors: set[str] = set()
    if isinstance(impact, Mapping) and "velocity" in impact:
        vectors = {*POLAR, *CARTESIAN}
    for name, value in defaults.items():
        if name in vectors or without_rivals(completed, [name]) != completed:
            continue
        path = entry_path(name)
        section, _, key = path.partition(".")
        table = completed.get(section, {})
        if isinstance(table, Mapping) and key not in table:
            completed = replace_entry(completed, path, value)
    return completed


def _has(tables: Mapping[str, object], name: str) -> bool:
    """Return whether an entry stands in tables."""
    section, _, key = entry_path(name).partition(".")
    table = tables.get(section)
    return isinstance(table, Mapping) and key in table


def _document(file: Path) -> dict[str, Any]:
    """Return the tables of a TOML file."""
    text = _text(file)
    try:
        document = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        if file.suffix.lower() in (".csv", ".txt", ".dat"):
            rule = "holds no scene; measured impacts go to contactlab fit"
            raise ValueError(f"{file}: {rule} {file.name} bodies.toml") from None
        twice = "; is a key or a table written twice?" * ("overwrite" in str(error))
        raise ValueError(f"{file}, {_place(str(error), text)}{_rewrite(text) or twice}") from None
    except ValueError as error:  # an integer with thousands of digits
        raise ValueError(f"{file}: {error}") from None
    except RecursionError:
        document = None
    if document is None or _deep(document):
        raise ValueError(f"{file}: is nested more than {DEEPEST} deep; a scene file needs less")
    return document


def _text(file: Path) -> str:
    """Return the text of a scene file with line ends as newlines."""
    remedy = "give the path of a scene in TOML"
    if file.suffix in (".csv", ".json", ".npz", ".png"):
        remedy += "; --out or --figure name files to write"
    try:
        # "sig": some editors begin a file with a byte-order mark
        text = content(file, kind="a scene", remedy=remedy).decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ValueError(
            f"{file}: is not UTF-8 text ({error.reason} at byte {error.start}); save it as UTF-8"
        ) from None
    return text.replace("\r\n", "\n").replace("\r", "\n")


def _deep(document: Mapping[str, object]) -> bool:
    """Return whether tables and lists are nested deeper than ``DEEPEST``."""
    level: list[Any] = [document]
    for _ in range(DEEPEST):
        inner = (value.values() if isinstance(value, dict) else value for value in level)
        level = [item for items in inner for item in items if isinstance(item, dict | list)]
    return bool(level)


def _rewrite(text: str) -> str:
    """Return what to write in place of the first value that is not TOML; empty if none is known."""
    for line in text.splitlines():
        key, equals, value = (part.strip() for part in line.partition("#")[0].partition("="))
        if not equals:
            continue
        if re.fullmatch(r"[+-]?\d+,\d+", value):
            return f"; write numbers with a point: {key} = {value.replace(',', '.')}"
        if re.fullmatch(r"[+-]?\.\d+(e[+-]?\d+)?", value, re.IGNORECASE):
            return f"; write {key} = {value.replace('.', '0.', 1)}"
        if re.fullmatch(r"[A-Za-z][\w -]*", value) and value not in ("true", "false", "inf", "nan"):
            return f'; put words in quotes: {key} = "{value}"'
    return ""


def _place(message: str, text: str) -> str:
    """Return tomllib's message with the line first, the last line for "end of document"."""
    position = re.search(r" \(at line (\d+), column (\d+)\)", message)
    if position:
        return f"line {position[1]}, column {position[2]}: not TOML: {message[: position.start()]}"
    lines = max(len(text.splitlines()), 1)
    return f"line {lines}: not TOML: {message.replace(' (at end of document)', '')}"
