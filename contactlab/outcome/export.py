"""Results as files: JSON, CSV, npz. One table of columns serves all three.

To add a column is a line in ``COLUMNS``: files, ``--quantity``, measured values and figures
take it from there, an angle in degrees too. Tables for reading show those that are named below
it. To add a form of file is a writer and a line in ``WRITERS``.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from contactlab.compose.collision import Collision
from contactlab.impact.grid import Grid, product
from contactlab.impact.scene import Scene
from contactlab.outcome.files import write_table, written
from contactlab.outcome.json_values import json_value
from contactlab.outcome.result import ImpactResult

#: Column name, unit, and where it comes from.
COLUMNS: tuple[tuple[str, str, Callable[[ImpactResult], Any]], ...] = (
    ("psi1", "1", lambda result: result.psi1),
    ("chi", "1", lambda result: result.scene.chi),
    ("psi2", "1", lambda result: result.psi2),
    ("normal_speed", "m/s", lambda result: result.scene.normal_speed),
    ("tangential_velocity", "m/s", lambda result: result.scene.tangential_velocity),
    ("spin", "rad/s", lambda result: result.scene.spin),
    ("rebound_normal_velocity", "m/s", lambda result: result.rebound_normal_velocity),
    ("rebound_tangential_velocity", "m/s", lambda result: result.rebound_tangential_velocity),
    ("rebound_spin", "rad/s", lambda result: result.rebound_spin),
    ("target_rebound_normal_velocity", "m/s", lambda r: r.target_rebound_normal_velocity),
    ("target_rebound_tangential_velocity", "m/s", lambda r: r.target_rebound_tangential_velocity),
    ("target_rebound_spin", "rad/s", lambda result: result.target_rebound_spin),
    ("rebound_slip_velocity", "m/s", lambda result: result.rebound_slip_velocity),
    ("normal_restitution", "1", lambda result: result.normal_restitution),
    ("tangential_restitution", "1", lambda result: result.tangential_restitution),
    ("slip_restitution", "1", lambda result: result.slip_restitution),
    ("incidence_angle", "rad", lambda result: result.incidence_angle),
    ("rebound_angle", "rad", lambda result: result.rebound_angle),
    ("local_rebound_angle", "rad", lambda result: result.local_rebound_angle),
    ("contact_time", "s", lambda result: result.motion.duration),
    ("normal_loss", "J", lambda result: result.energy.normal_loss),
    ("friction_work", "J", lambda result: result.energy.friction_work),
    ("energy_imbalance", "J", lambda result: result.energy.imbalance),
    ("status", "", lambda result: result.status),
)  # fmt: skip

#: Columns of the table of a sweep, and of a comparison of single impacts; those that are
#: undefined for every impact are left out.
SWEEP_TABLE = (
    "psi1", "psi2", "normal_restitution", "tangential_restitution", "rebound_angle_deg",
    "rebound_spin", "friction_work",
)  # fmt: skip
COMPARISON_TABLE = (
    "psi2", "normal_restitution", "tangential_restitution", "rebound_angle_deg", "rebound_spin",
    "contact_time", "friction_work", "energy_imbalance",
)  # fmt: skip


def to_dict(result: ImpactResult) -> dict[str, Any]:
    """Return everything but the history as plain numbers, lists and text."""
    numbers = {name: json_value(values) for name, _, values in columns(result)}
    return numbers | {
        "detail": json_value(result.motion.detail),
        "psi2_error_estimate": json_value(result.psi2_error_estimate),
        "run_time_s": result.run_time,
        "energy": result.energy.to_dict(),
        "counters": dict(result.counters),
        "laws": dict(result.laws),
        "plan": result.plan.to_dict(),
    }


#: Vectors of a collision: name and unit.
VECTORS = (
    ("velocity", "m/s"), ("spin", "rad/s"), ("target_velocity", "m/s"), ("target_spin", "rad/s"),
    ("impulse", "N s"), ("contact_velocity", "m/s"), ("target_contact_velocity", "m/s"),
)  # fmt: skip


def vectors(collision: Collision) -> dict[str, Any]:
    """Return the vectors of both bodies after a collision as plain lists."""
    return {name: json_value(np.asarray(getattr(collision, name))) for name, _ in VECTORS}


def write_json(result: ImpactResult, path: str | Path) -> None:
    """Write ``to_dict`` and the history, if there is one."""
    content = to_dict(result)
    if result.history is not None:
        columns = result.history.columns() | result.history.fields
        content["history"] = {
            name: json_value(np.asarray(column)) for name, column in columns.items()
        }
    text = json.dumps(content, indent=2, allow_nan=False) + "\n"
    with written(path) as stream:
        stream.write(text)


def write_csv(result: ImpactResult, path: str | Path) -> None:
    """Write one row an impact, the unit in each heading."""
    table = columns(result)
    headings = [csv_heading(name, unit, result.scene) for name, unit, _ in table]
    cells = [_spread(values, result.scene.shape) for _, _, values in table]
    write_table(path, headings, list(zip(*cells, strict=True)))


def write_history_csv(result: ImpactResult, path: str | Path) -> None:
    """Write one row an instant of a single impact's history.

    Raises
    ------
    ValueError
        If no history was asked for, or the result is a batch.
    """
    history = result.history
    if history is None or result.scene.shape:
        raise ValueError("result: has no history of a single impact; run(scene, history=True)")
    columns = history.columns()
    headings = [csv_heading(name, history.unit(name), result.scene) for name in columns]
    write_table(path, headings, list(zip(*columns.values(), strict=True)))


def write_npz(result: ImpactResult, path: str | Path) -> None:
    """Write every column, and the history's arrays with the prefix ``history_``."""
    arrays = {name: _flat(values, result.scene.shape) for name, _, values in columns(result)}
    if result.history is not None:
        course = result.history.columns() | result.history.fields
        arrays |= {f"history_{name}": column for name, column in course.items()}
    with written(path, binary=True) as stream:  # a path that ends otherwise would get .npz added
        np.savez_compressed(stream, **arrays)


#: Form of file by the end of its name.
WRITERS = {".json": write_json, ".csv": write_csv, ".npz": write_npz}


def columns(result: ImpactResult) -> list[tuple[str, str, Any]]:
    """Return name, unit and values of every column, those entries of a grid first that are none."""
    found = [(name, unit, read(result)) for name, unit, read in COLUMNS]
    if not isinstance(result.scene, Grid):
        return found
    from contactlab.scene_file.entries import UNITS  # only for those who have a grid

    varied = product(result.scene.axes)
    for name, _, _ in COLUMNS:
        varied.pop(name, None)
    units = {name: UNITS.get(name.rpartition(".")[2], "") for name in varied}
    return [(name, units[name], values) for name, values in varied.items()] + found


def csv_heading(name: str, unit: str, scene: Scene) -> str:
    """Return the heading of a CSV column: its name, and its unit unless it holds words."""
    return f"{name} ({unit_in(unit, scene)})" if unit else name


def unit_in(unit: str, scene: Scene) -> str:
    """Return the unit that a column has in ``scene``: the paper's own have only angles."""
    return "1" if scene.sphere is None and unit not in ("rad", "deg") else unit


def _flat(value: Any, shape: tuple[int, ...]) -> Any:
    """Return a column as an array of numbers, or of the names of statuses."""
    array = np.asarray(math.nan if value is None else value)
    if array.dtype == object:
        return np.array(_spread(value, shape))
    return np.broadcast_to(array.astype(np.float64), shape).ravel()


def _spread(value: Any, shape: tuple[int, ...]) -> list[Any]:
    items = np.broadcast_to(np.asarray(value, dtype=object), shape).ravel().tolist()
    return [math.nan if item is None else getattr(item, "name", item) for item in items]
