"""The columns of a result, for text, files, frames, figures, fits and scene files.

Columns are brought by plug-ins with the hook ``contactlab_columns``, ``COLUMNS`` by contactlab's
own; every angle is available in degrees too. The tables for reading show the columns in
``SWEEP_TABLE`` and ``COMPARISON_TABLE``, and those of other plug-ins.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from operator import attrgetter
from typing import TYPE_CHECKING, Any, NamedTuple, overload

import attrs
import numpy as np
from numpy.typing import NDArray

from contactlab.contracts.status import Status
from contactlab.impact import kinetics
from contactlab.impact.scene import Scene, entry_unit
from contactlab.numeric.checks import refuse
from contactlab.numeric.named import split_heading
from contactlab.numeric.names import nearest
from contactlab.numeric.types import Array, Json
from contactlab.registration.bring import by_name, state
from contactlab.registration.hooks import hookimpl

if TYPE_CHECKING:
    from contactlab.outcome.functions_of_results import WithScene


class Column(NamedTuple):
    """A named column of a result.

    Attributes
    ----------
    name : str
    unit : str
        Empty for a column of words.
    path : str
        Attribute of the result, such as ``"scene.chi"``.
    factor : float
        Unit of the attribute over the unit of the column.
    of_scenes : str
        ``"spheres"`` or ``"bodies"`` if only such scenes have the column in a file, ``"turning"``
        if those with spin about the normal have.
    part : int or None
        Component of a vector, from 0.
    value : callable, optional
        Returns the values from a result, in place of ``path``: numbers of the scene's shape.
    meaning : str
        A sentence for ``contactlab plugins show``.
    needs : tuple of str
        What ``value`` reads beside velocities and spins: ``"sizes"`` (duration and maxima of the
        normal motion), ``"motion"`` (what friction does meanwhile, such as its work) or
        ``"history"``. A fit follows impacts for it where its table has none.
    """

    name: str
    unit: str
    path: str = ""
    factor: float = 1.0
    of_scenes: str = ""
    part: int | None = None
    value: Callable[[Any], object] | None = None
    meaning: str = ""
    needs: tuple[str, ...] = ()

    def read(self, result: WithScene) -> object:
        """Return the values with the result's own type, or None if the scene defines no value.

        Where the function of a plug-in fails, its number is NaN, and a warning tells it.
        """
        if self.value is None:
            value = attrgetter(self.path)(result)
        else:
            from contactlab.outcome.functions_of_results import values_of  # for plug-ins alone

            value = values_of(self.name, self.value, self.needs, result, words=not self.unit)
        if self.part is not None and value is not None:
            vectors = np.ndim(value) > len(result.scene.shape)
            value = np.asarray(value)[..., self.part] if vectors else None
        return value if value is None or self.factor == 1.0 else value * self.factor

    def of(self, result: WithScene) -> NDArray[np.float64]:
        """Return the values as an array of the scene's shape, NaN if the scene defines no value.

        A vector is told by its length, a spin by the part that makes slip along ``scene.along``.
        """
        value, scene = self.read(result), result.scene
        number = np.asarray(np.nan if value is None else value, dtype=np.float64)
        if number.ndim > len(scene.shape):
            if scene.along is not None and scene.frame is not None and self.unit == "rad/s":
                number = np.sum(number * np.cross(scene.frame[..., 0, :], scene.along), axis=-1)
            else:
                number = np.linalg.norm(number, axis=-1)
        return np.array(np.broadcast_to(number, result.scene.shape))

    def unit_in(self, scene: Scene) -> str:
        """Return the unit of the values in ``scene``."""
        return unit_in(self.unit, scene)


#: Symbols of units that columns may have: of SI, and degrees.
SYMBOLS = {
    "m", "s", "kg", "K", "A", "mol", "cd", "N", "Pa", "J", "W", "Hz", "V", "C", "F", "T", "H", "Wb",
    "S", "lm", "lx", "sr", "rad", "deg",
}  # fmt: skip
#: Words of ``Column.needs``.
NEEDS = ("sizes", "motion", "history")

#: The columns of every file, in order: name, unit, attribute of the result. A vector or a matrix
#: has one column for each of its components.
COLUMNS = (
    Column("psi1", "1", "psi1"),
    Column("chi", "1", "scene.chi"),
    Column("lam", "1", "scene.lam", of_scenes="bodies"),
    Column("eta", "1", "scene.eta", of_scenes="bodies"),
    Column("rho", "1", "scene.rho", of_scenes="bodies"),
    Column("w1", "1", "scene.w1", of_scenes="turning"),
    Column("chi_w", "1", "scene.chi_w", of_scenes="turning"),
    Column("psi2", "1", "psi2"),
    Column("w2", "1", "w2", of_scenes="turning"),
    Column("normal_speed", "m/s", "scene.normal_speed"),
    Column("slip_velocity", "m/s", "scene.slip_velocity", of_scenes="bodies"),
    Column("tangential_velocity", "m/s", "scene.tangential_velocity", of_scenes="spheres"),
    Column("spin", "rad/s", "scene.spin", of_scenes="spheres"),
    Column("normal_spin", "rad/s", "scene.normal_spin", of_scenes="turning"),
    Column("normal_velocity", "m/s", "normal_velocity", of_scenes="bodies"),
    Column("rebound_normal_velocity", "m/s", "rebound_normal_velocity", of_scenes="spheres"),
    Column(
        "rebound_tangential_velocity", "m/s", "rebound_tangential_velocity", of_scenes="spheres"
    ),
    Column("velocity_in_space", "m/s", "velocity_in_space", of_scenes="bodies"),
    Column("rebound_spin", "rad/s", "rebound_spin"),
    Column("rebound_normal_spin", "rad/s", "rebound_normal_spin", of_scenes="turning"),
    Column(
        "target_rebound_normal_velocity", "m/s", "target_rebound_normal_velocity",
        of_scenes="spheres",
    ),
    Column(
        "target_rebound_tangential_velocity", "m/s", "target_rebound_tangential_velocity",
        of_scenes="spheres",
    ),
    Column("target_velocity_in_space", "m/s", "target_velocity_in_space", of_scenes="bodies"),
    Column("target_rebound_spin", "rad/s", "target_rebound_spin"),
    Column("rebound_slip_velocity", "m/s", "rebound_slip_velocity"),
    Column("impulse", "N s", "impulse", of_scenes="bodies"),
    Column("compressions", "1", "compressions", of_scenes="bodies"),
    Column("normal_restitution", "1", "normal_restitution"),
    Column("tangential_restitution", "1", "tangential_restitution", of_scenes="spheres"),
    Column("beta0", "1", "beta0"),
    Column("incidence_angle", "rad", "incidence_angle", of_scenes="spheres"),
    Column("rebound_angle", "rad", "rebound_angle", of_scenes="spheres"),
    Column("local_rebound_angle", "rad", "local_rebound_angle"),
    Column("contact_time", "s", "motion.duration"),
    Column("normal_loss", "J", "energy.normal_loss"),
    Column("friction_work", "J", "energy.friction_work"),
    Column("shear_loss", "J", "energy.shear_loss"),
    Column("energy_imbalance", "J", "energy.imbalance"),
    Column("status", "", "status"),
)  # fmt: skip

#: The columns of the table of a sweep, and of a comparison of single impacts. Tables leave out a
#: column that no impact defines.
SWEEP_TABLE = (
    "psi1", "psi2", "normal_restitution", "tangential_restitution", "rebound_angle_deg",
    "rebound_spin", "rebound_normal_spin", "compressions", "friction_work",
)  # fmt: skip
COMPARISON_TABLE = (
    "psi2", "normal_restitution", "tangential_restitution", "rebound_angle_deg", "rebound_spin",
    "rebound_normal_spin", "contact_time", "friction_work", "energy_imbalance",
)  # fmt: skip


#: The answers of plug-ins, and their columns in order.
_SORTED: tuple[list[Mapping[str, Column]], list[Column]] = ([], [])


@hookimpl
def contactlab_columns() -> Iterable[Column]:
    """Return contactlab's own columns."""
    return COLUMNS


def fault_of(column: Column) -> str:
    """Return what is wrong with the column of a plug-in; empty if nothing is."""
    name, unit = column.name, column.unit
    if not (isinstance(name, str) and name.isidentifier()):
        return "whose name must be letters, digits and underscores"
    words = re.findall(r"[^\W\d_]+", unit) if isinstance(unit, str) else ["?"]
    if unknown := [word for word in words if word not in SYMBOLS]:
        told = "" if unknown == ["?"] else f": {unknown[0]!r} is no unit of SI"
        return f"whose unit is {unit!r}{told}; give '1' for a number without unit"
    if strange := set(column.needs) - set(NEEDS):
        return f"which needs {min(strange)!r}, none of {', '.join(NEEDS)}"
    return "" if callable(column.value) or column.path else "which has no value"


def all_columns() -> Sequence[Column]:
    """Return the columns of all plug-ins, contactlab's own first; the status comes last."""
    found = by_name("columns", Column, lambda column: column.name, fault=fault_of, again=False)
    brought, columns = _SORTED
    if not (brought and brought[0] is found):
        named = [column._replace(name=name.replace(":", "_")) for name, column in found.items()]
        brought[:] = [found]
        columns[:] = sorted(named, key=lambda column: column.name == "status")
    return columns


def foreign() -> list[str]:
    """Return the names of the columns of numbers that are not contactlab's own."""
    own = {column.name for column in COLUMNS}
    return [column.name for column in all_columns() if column.unit and column.name not in own]


def _numeric_columns() -> Iterator[Column]:
    for column in all_columns():
        if column.unit:
            yield column
        if column.unit == "rad":
            factor = column.factor * 180.0 / np.pi
            yield column._replace(name=f"{column.name}_deg", unit="deg", factor=factor)
    yield Column("rebound_speed", "m/s", "rebound_speed")


class _Size(Column):
    """The size of a column, for numbers without their sign."""

    def of(self, result: WithScene) -> NDArray[np.float64]:
        """Return the magnitudes as an array of the scene's shape."""
        return np.abs(super().of(result))


class _Quantities(Mapping[str, Column]):
    """The columns of numbers by name; plug-ins are asked for them at the first use.

    ``"|name|"`` is the size of a column; lists leave it out.
    """

    def __init__(self) -> None:
        self._state: object = None
        self._found: dict[str, Column] = {}

    def _read_columns(self) -> dict[str, Column]:
        if self._state != state():
            self._found = {column.name: column for column in _numeric_columns()}
            self._state = state()
        return self._found

    def __getitem__(self, name: str) -> Column:
        if name[:1] == name[-1:] == "|":
            return _Size(*self._read_columns()[name[1:-1]]._replace(name=name))
        return self._read_columns()[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._read_columns())

    def __len__(self) -> int:
        return len(self._read_columns())


#: The columns of numbers by name, with angles in degrees and the rebound speed added.
QUANTITIES = _Quantities()


def find_quantity(name: str, *, where: str = "quantity") -> Column:
    """Return a column of numbers by name: ``"rebound_angle"``, or ``"rebound_angle_deg"``.

    The components of a vector have a place behind: ``"psi2_1"``.

    Raises
    ------
    ValueError
        If no quantity has this name; the message gives the nearest match.
    """
    if name in QUANTITIES:
        return QUANTITIES[name]
    whole, _, place = name.rpartition("_")
    if whole in QUANTITIES and place in ("1", "2", "3"):
        return QUANTITIES[whole]._replace(name=name, part=int(place) - 1)
    remedy = f"{nearest(name, QUANTITIES)}known: {', '.join(QUANTITIES)}"
    raise refuse(where, name, "is not a quantity of a result", remedy)


def columns_of(scene: Scene) -> tuple[Column, ...]:
    """Return the columns that a file of a scene has."""
    coupled = scene.inverse_mass is not None
    of_bodies = scene.sphere is None and (coupled or scene.encounter is not None)
    others = {"spheres" if of_bodies else "bodies", "" if kinetics.turns(scene) else "turning"} - {
        ""
    }
    return tuple(column for column in all_columns() if column.of_scenes not in others)


def columns(result: WithScene, whole: Scene | None = None) -> list[tuple[str, str, object]]:
    """Return name, unit and values of every column; varying entries that are no columns come first.

    A part of a ``whole`` batch has the columns of the batch: the part may lack spin by chance.
    """
    scene, table = result.scene, []
    for column in columns_of(whole or scene):
        parts = components(column.name, column.read(result), scene.shape)
        table += [(name, column.unit, values) for name, values in parts]
    options = {
        split_heading(heading)[0]: (*split_heading(heading), each.numbers)
        for heading, each in scene._options.items()
    }
    if scene._of_slip is not None:
        options["friction_coefficient"] = "friction_coefficient", "1", scene.friction_coefficient
    names = {name for name, *_ in table}
    varied = [
        options.pop(name, (name, entry_unit(name), values))
        for name, values in scene.varied.items()
        if name not in names
    ]
    return varied + list(options.values()) + table


@overload
def components(name: str, values: Array, shape: tuple[int, ...]) -> Sequence[tuple[str, Array]]: ...
@overload
def components(
    name: str, values: object, shape: tuple[int, ...]
) -> Sequence[tuple[str, object]]: ...
def components(name: str, values: object, shape: tuple[int, ...]) -> Sequence[tuple[str, object]]:
    """Return the components of vectors and matrices, each under a name: ``"psi1_2"``."""
    array = np.asarray(values)
    trailing = array.shape[len(shape) :] if array.shape[: len(shape)] == shape else ()
    if not trailing:
        return [(name, values)]
    return [
        (f"{name}_{''.join(str(place + 1) for place in index)}", array[(..., *index)])
        for index in np.ndindex(*trailing)
    ]


def unit_in(unit: str, scene: Scene) -> str:
    """Return the unit of a column in ``scene``; in one without units only angles have one."""
    return unit if scene.has_units or unit in ("rad", "deg") else "1"


def csv_heading(name: str, unit: str, scene: Scene) -> str:
    """Return the heading of a CSV column: name and unit, or name alone for words."""
    return f"{name} ({unit_in(unit, scene)})" if unit else name


def json_value(value: object) -> Json:
    """Return ``value`` for JSON: statuses by name, arrays as lists, None for numbers not finite."""
    if isinstance(value, Status):
        return value.name
    kind = type(value)
    if attrs.has(kind):
        value = {field.name: getattr(value, field.name) for field in attrs.fields(kind)}
    if isinstance(value, Mapping):
        return {name: json_value(item) for name, item in value.items()}
    if isinstance(value, np.ndarray):
        value = value.tolist()
    if isinstance(value, list | tuple):
        return [json_value(item) for item in value]
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float):
        return value if np.isfinite(value) else None
    if value is None or isinstance(value, str | int):
        return value
    raise TypeError(f"{type(value).__name__}: is no number, text, list or table")
